// Shadows of the scene's finite objects, by exponential shadow map (Annen et al. 2008). Include it where `sampler2D shadow_map` and, for
// scene_visibility, `frame` are declared.
//
// A cell holds the blurred exp(c (d - 1/2)) of the depth d, 0..1, of the first surface. The point at depth e is lit by the share
// exp(c (d - 1/2)) exp(c (1/2 - e)), at most 1. The outermost texels of a cell hold so much that they are lit, and so is what lies outside.
#ifndef SF_LIB_SHADOW_GLSL
#define SF_LIB_SHADOW_GLSL

// 0: in shadow .. 1: lit. `at`: the point by the light's world_to_map (w is 1 unless `perspective`); `cell` of `cells`.
float shadow_share(bool perspective, vec4 at, float exponent, float cell, float cells)
{
    vec2 uv = clamp(perspective ? at.xy / at.w : at.xy, 0.0, 0.9999);
    vec2 texel = vec2(uv.x + cell, uv.y) * vec2(1.0 / cells, 1.0) * vec2(textureSize(shadow_map, 0));
    float first = texelFetch(shadow_map, ivec2(texel), 0).r;
    float lit = min(first * exp(exponent * (0.5 - min(at.z, 1.0))), 1.0);
    return perspective && at.w <= 0.0 ? 1.0 : lit;
}

float shadow_share(vec4 at, float exponent, float cell, float cells)
{
    return shadow_share(true, at, exponent, cell, cells);
}

// The same for a point of the world; 1 for a light that has no map.
float scene_visibility(uint light, vec3 world)
{
    vec4 info = frame.lights[light].shadow;
    float lit = shadow_share(frame.lights[light].world_to_map * vec4(world, 1.0), info.y, info.z, info.w);
    return info.x > 0.0 ? lit : 1.0;
}

#endif
