#version 460
#extension GL_GOOGLE_include_directive : require
// What march.comp does along one pixel's ray, sample by sample. One group, thread i takes the first i + 1 samples.
#include "shared/frame.h"
#include "shared/thick.h"

layout(local_size_x = SF_THICK_TILE * SF_THICK_TILE) in;
layout(set = 0, binding = 1, std430) readonly buffer Mask { uint mask[]; };
#define PROBE_BINDING 9
#include "lib/probe.glsl"
#include "larsson/march.glsl"

void main()
{
    uint thread = gl_LocalInvocationID.x;
    ivec2 pixel = ivec2(push.probe % push.width, push.probe / push.width);
    bool listed = mask[uint(pixel.y) / SF_THICK_TILE * push.tiles_x + uint(pixel.x) / SF_THICK_TILE] != 0u; // elsewhere the maps hold nothing
    interval smoke = interval_of(pixel);
    bool any_smoke = listed && smoke.steps > 0u;
    if (thread == 0u) {
        probe_count = any_smoke ? STEPS + 1u : 0u;
        probe_store(0u, smoke.near, 1.0, vec3(0.0));
    }
    if (!any_smoke || thread >= STEPS)
        return;
    float u = float(thread + 1u) / float(STEPS);
    float s = thread + 1u == STEPS || smoke.opaque <= 1e-4 ? u : -log(1.0 - u * smoke.opaque) / smoke.tau;
    probe_store(thread + 1u, mix(smoke.near, smoke.far, s), 1.0 - u * smoke.opaque, sent(smoke, pixel, thread + 1u, u));
}
