#version 460
#extension GL_GOOGLE_include_directive : require
// Phong's light on the ball that each pixel sees (L 3.2), once a pixel; and what the later passes need: the scene's depth at this size, and empty images
// where the blur will not write.
#include "shared/frame.h"
#include "shared/thick.h"
#include "shared/mega.h"
#include "lib/sphere.glsl"

layout(constant_id = 4) const uint LIGHTS = 1u;
layout(constant_id = 5) const uint SCENE_SHADOW = 0u;
layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
layout(set = 0, binding = 2) uniform sampler2D scene_depth;
layout(set = 0, binding = 3, std430) readonly buffer Balls { sf_mega_ball balls[]; };
layout(set = 0, binding = 4) uniform sampler2D numbers;
layout(set = 0, binding = 5) uniform sampler2D shadow_map;
layout(set = 0, binding = 8, std430) writeonly buffer Mask { uint mask[]; };
layout(push_constant) uniform Push { sf_thick_push push; sf_mega_push own; };
layout(location = 0) flat in vec4 behind;
layout(location = 1) flat in uint number;
layout(location = 0) out vec4 raw; // rgb: radiance; a: view depth, SF_DEPTH_FAR where there is no ball
layout(location = 1) out float depth;
layout(location = 2) out vec4 blurred;
layout(location = 3) out float blurred_depth;
#include "thick/reduce.glsl"
#include "thick/view.glsl"
#include "lib/environment.glsl"
#include "lib/lighting.glsl"
#include "lib/shadow.glsl"

// Phong's reflectance with its lobe normalised (Lafortune and Willems 1994): albedo / pi + specular (shininess + 2) / (2 pi) cos^shininess.
vec3 reflected(vec3 at, vec3 normal, vec3 direction, vec3 albedo)
{
    vec3 mirrored = reflect(direction, normal);
    float lobe = own.specular * (own.shininess + 2.0) * 0.159154943;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < LIGHTS; i++) {
        vec3 to_light;
        vec3 irradiance = light_irradiance(frame.lights[i], at, to_light) * max(dot(normal, to_light), 0.0);
        float lit = SCENE_SHADOW != 0u ? scene_visibility(i, at) : 1.0;
        float shine = lobe * pow(max(dot(mirrored, to_light), 1e-6), own.shininess);
        sum += lit * irradiance * (albedo * (own.diffuse * 0.318309886) + shine);
    }
    return sum + albedo * environment_blurred(normal) * push.ambient + frame.emission.rgb;
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 reduced = reduced_depth(pixel);
    if (reduced.y < behind.x)
        mask[number] = SF_THICK_TILE_CUT;
    depth = min(reduced.x, behind.x);
    blurred = vec4(0.0);
    blurred_depth = 0.0;

    float which = texelFetch(numbers, pixel, 0).r;
    sf_mega_ball ball = balls[uint(max(which, 0.0))];
    vec3 direction = world_ray(smoke_ndc(vec2(pixel)));
    vec2 chord = sphere_chord(direction, ball.sphere.xyz - frame.eye.xyz, ball.sphere.w);
    float reached = chord.x - max(chord.y, 0.0);
    vec3 at = frame.eye.xyz + reached * direction;
    vec3 radiance = reflected(at, normalize(at - ball.sphere.xyz), normalize(direction), ball.albedo.rgb);
    raw = which >= 0.0 ? vec4(radiance, reached) : vec4(0.0, 0.0, 0.0, SF_DEPTH_FAR);
}
