// View rays of the camera: a point of the frame and the direction that has unit view depth.
#ifndef SF_THICK_VIEW_GLSL
#define SF_THICK_VIEW_GLSL

// `ndc`: -1..1, y up. The ray in view space with depth 1 (view space looks along -z; here depth counts positive, so z is +1).
vec3 view_ray(vec2 ndc)
{
    return vec3(ndc * vec2(frame.right.w, frame.up.w), 1.0);
}

// The same in the world: eye + depth * world_ray.
vec3 world_ray(vec2 ndc)
{
    return frame.forward.xyz + ndc.x * frame.right.xyz + ndc.y * frame.up.xyz;
}

// Middle of smoke pixel `pixel`, as seen in the frame (the last row and column of a reduced image may reach beyond the frame).
vec2 smoke_ndc(vec2 pixel)
{
    vec2 at = (pixel + 0.5) * float(push.scale) * frame.size.zw * 2.0 - 1.0;
    return vec2(at.x, -at.y);
}

// World to (x right, y up, depth).
vec3 to_view(vec3 world)
{
    vec3 v = (frame.world_to_view * vec4(world, 1.0)).xyz;
    return vec3(v.xy, -v.z);
}

#endif
