// The smoke's shadow: what a light-view map says about the light that reaches a point (L 3.3.7, with the depth comparison that L left out).
#ifndef SF_LIB_SMOKE_SHADOW_GLSL
#define SF_LIB_SMOKE_SHADOW_GLSL

// All directions on a square, -1..1 (Meyer et al. 2010): the octahedron |x| + |y| + |z| = 1, its far half folded out.
vec2 octahedral(vec3 way)
{
    vec3 v = way / max(abs(way.x) + abs(way.y) + abs(way.z), 1e-20);
    vec2 folded = (1.0 - abs(v.yx)) * vec2(v.x < 0.0 ? -1.0 : 1.0, v.y < 0.0 ? -1.0 : 1.0);
    return v.z < 0.0 ? folded : v.xy;
}

// The other way round; not of unit length.
vec3 octahedral_way(vec2 at)
{
    float z = 1.0 - abs(at.x) - abs(at.y);
    float fold = max(-z, 0.0);
    return vec3(at.x + (at.x < 0.0 ? fold : -fold), at.y + (at.y < 0.0 ? fold : -fold), z);
}

// Of a point q in the light's view space: uv in 0..1 of the light's cell, v down, and depth along the light, m, as struct sf_gpu_light_view
// (shared/frame.h) has it. Behind a perspective light uv lies outside of 0..1.
vec3 light_map_of(bool positional, vec3 q, vec4 window)
{
    if (positional) {
        vec2 ahead = q.z > 1e-4 ? q.xy / q.z * window.xy + window.zw : vec2(-1.0);
        return vec3(window.x == 0.0 ? octahedral(q) * 0.5 + 0.5 + window.zw : ahead, length(q));
    }
    return vec3(q.xy * window.xy + window.zw, q.z);
}

// Optical depth that lies before depth d: the interval near..far (R, G) holds A, spread evenly.
float light_map_depth(vec4 texel, float d)
{
    return texel.a * clamp((d - texel.r) / max(texel.g - texel.r, 1e-6), 0.0, 1.0);
}

#endif
