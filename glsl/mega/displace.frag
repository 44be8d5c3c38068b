#version 460
#extension GL_GOOGLE_include_directive : require
// The blurred balls, looked up at places that an animated noise has moved, and cut off by the scene (L 3.2). The noise is over the screen, as in the thesis, where it
// stays when the smoke moves in the picture; or in the world, at the blurred surface, where it goes with the picture.
#include "shared/frame.h"
#include "shared/thick.h"
#include "shared/mega.h"
#include "lib/noise.glsl"

layout(constant_id = 4) const uint ON_SCREEN = 0u;
layout(constant_id = 5) const uint OCTAVES = 3u; // 0: no displacement
layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
layout(set = 0, binding = 2) uniform sampler2D blurred;
layout(set = 0, binding = 3) uniform sampler2D blurred_depth;
layout(set = 0, binding = 4) uniform sampler2D scene_depth; // of the smoke's size
layout(push_constant) uniform Push { sf_thick_push push; sf_mega_push own; };
layout(location = 0) flat in vec4 behind;
layout(location = 0) out vec4 smoke;
layout(location = 1) out float cut; // as mega/upsample.glsl reads it
#include "thick/view.glsl"

// At the rim, where coverage is thinner than this, the displacement fades out: beyond it there is no surface for the noise to be at.
const float FAINT = 0.02;
const float STEEP = 3.0; // depth over width of a surface from which on the displacement is shortened: noise would be torn into streaks
// Turns of the noise's corners for each unit of time, as those of turbulence (src/sim/feed.c): a quarter of a turn each.
const vec4 SPEEDS = 1.57079633 * vec4(0.36, -0.71, 1.23, -1.4);

// Pixels of the smoke's image.
vec2 displacement(ivec2 pixel)
{
    float turn = own.speed * frame.forward.w;
    float covered = texelFetch(blurred, pixel, 0).a;
    float share = smoothstep(0.0, FAINT, covered);
    uint octaves = covered > 0.0 ? OCTAVES : 1u;
    vec2 noise;
    if (ON_SCREEN != 0u) {
        noise = sf_curl_noise_octaves(vec3(gl_FragCoord.xy * own.frequency, turn), frame.seed, octaves, vec4(1.0), vec4(0.0)).xy;
    } else {
        float depth = texelFetch(blurred_depth, pixel, 0).r;
        float slope = max(abs(dFdx(depth)), abs(dFdy(depth))) * float(push.height);
        slope /= STEEP * 2.0 * frame.up.w * max(depth, 1e-6);
        share /= 1.0 + slope * slope;
        vec3 at = frame.eye.xyz + depth * world_ray(smoke_ndc(vec2(pixel)));
        vec3 moved = sf_curl_noise_octaves(at * own.frequency, frame.seed, octaves, cos(turn * SPEEDS), sin(turn * SPEEDS));
        noise = vec2(dot(moved, frame.right.xyz) / frame.right.w, -dot(moved, frame.up.xyz) / frame.up.w);
    }
    vec2 offset = noise * own.amplitude;
    return offset * (share * min(1.0, own.limit * inversesqrt(max(dot(offset, offset), 1e-12))));
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 from = gl_FragCoord.xy;
    if (OCTAVES > 0u)
        from += displacement(pixel);
    ivec2 limit = textureSize(blurred, 0) - 1;
    float at = texelFetch(blurred_depth, clamp(ivec2(from), ivec2(0), limit), 0).r;
    float scene = texelFetch(scene_depth, pixel, 0).r, ahead = scene - at;
    float share = own.soft > 0.0 ? clamp(ahead / own.soft, 0.0, 1.0) : (ahead > 0.0 ? 1.0 : 0.0);
    smoke = textureLod(blurred, from / vec2(push.width, push.height), 0.0) * share;
    cut = share < 1.0 ? scene : -max(at + own.soft, 1e-6);
}
