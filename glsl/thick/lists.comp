#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
// Of every tile that smoke touches, the list of spheres that touch it, in the order of the particles. One subgroup a tile, each lane asking
// one particle at a time, so that the order needs no barrier.
#include "shared/particle.h"
#include "shared/thick.h"

layout(local_size_x = 32) in;
layout(set = 0, binding = 0, std430) readonly buffer Counts { sf_particle_counts counts; };
layout(set = 0, binding = 1, std430) readonly buffer Tiles { uint tiles[]; };
layout(set = 0, binding = 2, std430) readonly buffer Ranges { uvec2 ranges[]; };
layout(set = 0, binding = 3, std430) readonly buffer Rectangles { uvec2 rectangles[]; };
layout(set = 0, binding = 4, std430) writeonly buffer List { uint list[]; };
layout(push_constant) uniform Push { sf_thick_push push; };

void main()
{
    uvec2 range = ranges[gl_WorkGroupID.x];
    if (gl_SubgroupID != 0u || range.x == SF_THICK_ALL)
        return;
    uint tile = tiles[gl_WorkGroupID.x];
    uvec2 here = uvec2(tile % push.tiles_x, tile / push.tiles_x);
    uint lanes = min(gl_SubgroupSize, gl_WorkGroupSize.x);
    uint at = range.x;
    for (uint base = 0u; base < counts.live; base += 4u * lanes) {
        for (uint k = 0u; k < 4u; k++) {
            uint index = base + k * lanes + gl_SubgroupInvocationID;
            uvec2 span = index < counts.live ? rectangles[index] : uvec2(1u, 0u);
            uvec2 first = uvec2(span.x & 0xffffu, span.x >> 16), last = uvec2(span.y & 0xffffu, span.y >> 16);
            bool touches = all(greaterThanEqual(here, first)) && all(lessThanEqual(here, last));
            uvec4 ballot = subgroupBallot(touches);
            if (touches)
                list[at + subgroupBallotExclusiveBitCount(ballot)] = index;
            at += subgroupBallotBitCount(ballot);
        }
    }
    uint end = range.x + range.y;
    for (uint i = at + gl_SubgroupInvocationID; i < end; i += lanes)
        list[i] = push.capacity;
}
