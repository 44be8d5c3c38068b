// Box, sphere or cylinder, met exactly by the pixel's ray.
#ifndef SF_SCENE_SOLIDS_FRAGMENT_GLSL
#define SF_SCENE_SOLIDS_FRAGMENT_GLSL
#include "scene/shade.glsl"
#include "scene/solids.glsl"
#include "lib/solid.glsl"

SOLID_VARYINGS(in)
#include "scene/targets.glsl"
invariant gl_FragDepth; // a pass that is to draw where the depth is equal finds it so

// Depth of the nearest plane.
float planes_depth(vec2 ndc, vec3 ray)
{
    float nearer = ground.z + ndc.x * ground.x + ndc.y * ground.y;
    float least = SF_DEPTH_FAR, first = ground.w / nearer;
    if (PLANES > 0u && nearer > 0.0 && first >= up.w)
        least = first;
    for (uint i = 1u; i < PLANES; i++)
        least = min(least, plane_depth(i, vec3(dot(ray, axes[0]), dot(ray, axes[1]), dot(ray, axes[2]))));
    return least;
}

vec3 near_light(vec2 ndc, vec3 ray, vec3 normal)
{
    if (LIGHTS == 0u)
        return vec3(0.0);
    sf_gpu_light source;
    source.position = light_position;
    source.direction = light_direction;
    source.color = light_color;
    vec3 to_light;
    vec3 irradiance = light_irradiance_of(light_kind(0u), source, depth * ray, to_light);
    float share = max(dot(normal, to_light), 0.0) * INVERSE_PI;
    share *= object_share(0u, depth * (map[0] + ndc.x * map[1] + ndc.y * map[2]) + map[3], eye.w);
    vec3 q = depth * (smoke[0].xyz + ndc.x * smoke[1].xyz + ndc.y * smoke[2].xyz) + smoke[3].xyz;
    return irradiance * share * smoke_share(0u, q, vec4(smoke[0].w, smoke[1].w, smoke[2].w, smoke[3].w));
}

void main()
{
    vec2 ndc = pixel_ndc(vec2(forward.w, right.w), gl_FragCoord.xy);
    vec3 ray = forward.xyz + ndc.x * right.xyz + ndc.y * up.xyz;
    vec2 span = solid_span(reach, level[0].w, eye.xyz, ray);
    depth = span.x >= up.w ? span.x : span.y; // from within, or cut open by the near plane: the far side
    if (span.x > span.y || depth < up.w || depth >= planes_depth(ndc, ray))
        discard;
    vec3 normal = solid_normal(reach, level[0].w, eye.xyz + depth * ray);
    normal = dot(normal, ray) > 0.0 ? -normal : normal;
    vec3 light = near_light(ndc, ray, normal);
    vec3 upright = vec3(dot(normal, axes[0]), dot(normal, axes[1]), dot(normal, axes[2]));
    if (LEVEL != 0u)
        light += max(level[0].rgb + upright.y * (level[1].rgb + upright.y * level[2].rgb), 0.0);
    else
        light += environment_blurred(upright);
    if (LIGHTS > NEAR) {
        vec3 world_ray = vec3(dot(ray, axes[0]), dot(ray, axes[1]), dot(ray, axes[2]));
        light += far_lights(NEAR, frame.eye.xyz + depth * world_ray, upright);
    }
    color = vec4(albedo.rgb * light, 1.0);
    gl_FragDepth = up.w / depth;
}

#endif
