#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_EXT_control_flow_attributes : require
// What march.comp does along one pixel's ray, sample by sample. One group, all of whose threads look along that ray: thread i takes those of its
// samples that stand before the end of the (i + 1)-th part of the light.
#include "shared/frame.h"
#include "shared/particle.h"
#include "shared/thick.h"

layout(local_size_x = SF_THICK_TILE * SF_THICK_TILE) in;
#define PROBE_BINDING 9
#include "lib/probe.glsl"
#include "thick/march.glsl"

const uint NONE = 0xffffffffu;
shared uint found; // the number of the pixel's tile in the list

// View depth of the boundary behind the first `count` samples, and the transmittance to it. A lamp's samples stand elsewhere.
vec2 boundary(uint count)
{
    if (count == STEPS)
        return vec2(seen.far, 1.0 - opaque);
    if (PLACEMENT == SF_THICK_PLACEMENT_UNIFORM) {
        float at = mix(seen.near, seen.far, float(count) / float(STEPS));
        return vec2(at, exp(-depth_at(at)));
    }
    course samples;
    float u = 0.0;
    for (uint i = 0u; i < count; i++) {
        samples = next_of(samples, i, PLACEMENT != SF_THICK_PLACEMENT_EQUAL, 0.5);
        u += samples.part;
    }
    return vec2(place_seen(u), 1.0 - u * opaque);
}

void main()
{
    uint thread = gl_SubgroupID * gl_SubgroupSize + gl_SubgroupInvocationID;
    ivec2 pixel = ivec2(push.probe % push.width, push.probe / push.width);
    uint wanted = uint(pixel.y) / SF_THICK_TILE * push.tiles_x + uint(pixel.x) / SF_THICK_TILE;
    if (thread == 0u)
        found = NONE;
    barrier();
    for (uint i = thread; i < args.dispatch_tiles.x; i += SF_THICK_TILE * SF_THICK_TILE)
        if (tiles[i] == wanted)
            found = i;
    barrier();
    looked at = look(pixel, found != NONE ? ranges[found] : uvec2(0u));
    bool smoke = seen.whole > 0.0;
    uint count = min(thread + 1u, STEPS);
    vec2 end = boundary(count);
    vec3 radiance = sent(at, pixel, smoke ? STEPS : 0u, count < STEPS ? end.x : SF_DEPTH_FAR, 1.0 - end.y);
    if (thread == 0u) {
        probe_count = smoke ? STEPS + 1u : 0u;
        probe_store(0u, seen.near, 1.0, vec3(0.0));
    }
    if (thread < STEPS)
        probe_store(thread + 1u, end.x, end.y, radiance);
}
