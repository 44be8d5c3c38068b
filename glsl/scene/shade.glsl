// What all passes of the scene share: bindings, constants, and the light that a surface sends to the eye.
// Surfaces are Lambertian: L = albedo (1/pi sum_lights visibility E cos + SH(n)).
//
// On a software device each component that a fragment loads from a buffer costs about as much as ten multiplications, and one that the
// vertex shader hands over flat costs next to nothing. So the passes of large surfaces get what the first lights need in that way (struct
// near_light); the lights after them are read from the frame's block (far_lights).
#ifndef SF_SCENE_SHADE_GLSL
#define SF_SCENE_SHADE_GLSL
#include "shared/frame.h"

layout(constant_id = 0) const uint PLANES = 0u;      // objects 0..PLANES-1 are planes
layout(constant_id = 1) const uint LIGHTS = 0u;
layout(constant_id = 2) const uint LIGHT_KINDS = 0u; // two bits a light
layout(constant_id = 3) const uint SHADOWED = 0u;    // one bit a light: its exponential shadow map is read
layout(constant_id = 4) const uint SMOKE = 0u;       // one bit a light: the smoke's shadow in it is read
layout(constant_id = 5) const uint CHECKERED = 0u;   // 1: some plane has a checker
layout(constant_id = 6) const uint ENVIRONMENT = 0u; // what is drawn: kind, as frame.background.w
layout(constant_id = 7) const uint LEVEL = 0u;       // 1: ambient light depends on the normal's y alone
layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
layout(set = 0, binding = 1, std140) uniform Objects { sf_gpu_object objects[SF_FRAME_OBJECTS]; };
layout(set = 0, binding = 2) uniform sampler2D shadow_map;
layout(set = 0, binding = 3) uniform sampler2D smoke_map;
layout(set = 0, binding = 4, std140) uniform Views { sf_gpu_light_view views[SF_FRAME_LIGHTS]; };
#include "lib/environment.glsl"
#include "lib/lighting.glsl"
#include "lib/shadow.glsl"
#include "lib/smoke_shadow.glsl"

const float INVERSE_PI = 0.318309886;

// -1..1, y up.
vec2 pixel_ndc(vec2 size_inverse, vec2 coordinate)
{
    vec2 at = coordinate * size_inverse * 2.0 - 1.0;
    return vec2(at.x, -at.y);
}

// Depth of plane `i` along a ray of unit view depth; SF_DEPTH_FAR when it is not met.
float plane_depth(uint i, vec3 ray)
{
    vec4 row = objects[i].row1;
    float t = -(dot(row.xyz, frame.eye.xyz) + row.w) / dot(row.xyz, ray);
    return t >= frame.eye.w && t < SF_DEPTH_FAR ? t : SF_DEPTH_FAR;
}

uint light_kind(uint i)
{
    return LIGHT_KINDS >> (2u * i) & 3u;
}

// Share of light `i` that objects let through; `at`: the point in its map.
float object_share(uint i, vec4 at, float exponent)
{
    if ((SHADOWED >> i & 1u) == 0u)
        return 1.0;
    return shadow_share(light_kind(i) != SF_LIGHT_KIND_DIRECTIONAL, at, exponent, float(bitCount(SHADOWED & (1u << i) - 1u)), float(bitCount(SHADOWED)));
}

// The light's window on the smoke, or one that shows none of it when there is none. (Written without a branch: lavapipe compiles a
// shader anew for every draw when a branch of it depends on a buffer's contents alone.)
vec4 smoke_window(uint i)
{
    return mix(vec4(0.0, 0.0, -1.0, -1.0), views[i].window, views[i].info.y);
}

// Share of light `i` that the smoke lets through; `q`: the point as the light sees it.
float smoke_share(uint i, vec3 q, vec4 window)
{
    if ((SMOKE >> i & 1u) == 0u)
        return 1.0;
    vec3 at = light_map_of(light_kind(i) != SF_LIGHT_KIND_DIRECTIONAL, q, window);
    vec2 inner = clamp(at.xy, 0.0, 0.9999);
    // Filtered: the edge of a shadow on a surface shows each texel. The blur has spread the depths beyond where A has died away, so that
    // the filter mixes no emptiness in.
    vec4 texel = textureLod(smoke_map, vec2(inner.x + float(i), inner.y) * vec2(1.0 / float(LIGHTS), 1.0), 0.0);
    float through = exp(-light_map_depth(texel, at.z));
    return inner == at.xy ? through : 1.0;
}

// Irradiance over pi from lights FIRST and on.
vec3 far_lights(uint first, vec3 world, vec3 normal)
{
    vec3 sum = vec3(0.0);
    for (uint i = first; i < LIGHTS; i++) {
        vec3 to_light;
        vec3 irradiance = light_irradiance_of(light_kind(i), frame.lights[i], world, to_light);
        float share = max(dot(normal, to_light), 0.0) * INVERSE_PI;
        if ((SHADOWED >> i & 1u) != 0u)
            share *= object_share(i, frame.lights[i].world_to_map * vec4(world, 1.0), frame.lights[i].shadow.y);
        if ((SMOKE >> i & 1u) != 0u)
            share *= smoke_share(i, (views[i].view * vec4(world, 1.0)).xyz, views[i].window);
        sum += irradiance * share;
    }
    return sum;
}

#endif
