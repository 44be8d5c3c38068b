// The smoke's shadow: what a light-view map says about the light that reaches a point (L 3.3.7, with the depth comparison that L left out).
#ifndef SF_LIB_SMOKE_SHADOW_GLSL
#define SF_LIB_SMOKE_SHADOW_GLSL

// Of a point q in the light's view space: uv in 0..1 of the light's cell, v down, and depth along the light, m, as struct sf_gpu_light_view
// (shared/frame.h) has it. Behind a perspective light uv lies outside of 0..1.
vec3 light_map_of(bool perspective, vec3 q, vec4 window)
{
    if (perspective)
        return q.z > 1e-4 ? vec3(q.xy / q.z * window.xy + window.zw, length(q)) : vec3(-1.0);
    return vec3(q.xy * window.xy + window.zw, q.z);
}

vec3 light_map_at(sf_gpu_light_view view, vec3 world)
{
    return light_map_of(view.info.x > 0.5, (view.view * vec4(world, 1.0)).xyz, view.window);
}

// Optical depth that lies before depth d: the interval near..far (R, G) holds A, spread evenly.
float light_map_depth(vec4 texel, float d)
{
    return texel.a * clamp((d - texel.r) / max(texel.g - texel.r, 1e-6), 0.0, 1.0);
}

#endif
