#version 460
#extension GL_GOOGLE_include_directive : require
// The tiles that spheres touch as a list in order, where each one's list of spheres stands, and the arguments of the passes that run over the tiles.
// One group, each thread a contiguous run.
#include "shared/particle.h"
#include "shared/thick.h"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Touching { uint touching[]; }; // spheres, a tile
layout(set = 0, binding = 1, std430) writeonly buffer Tiles { uint tiles[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Args { sf_thick_args args; };
layout(set = 0, binding = 3, std430) writeonly buffer Ranges { uvec2 ranges[]; };
layout(set = 0, binding = 4, std430) readonly buffer Counts { sf_particle_counts counts; };
layout(push_constant) uniform Push { sf_thick_push push; };

shared uvec2 found[64]; // tiles, and elements of lists

uint padded(uint count)
{
    return (count + SF_THICK_TURN - 1u) / SF_THICK_TURN * SF_THICK_TURN;
}

void main()
{
    uint thread = gl_LocalInvocationID.x;
    uint count = push.tiles_x * push.tiles_y;
    uint run = (count + 63u) / 64u;
    uint first = min(thread * run, count);
    uint last = min(first + run, count);
    uvec2 here = uvec2(0u);
    for (uint tile = first; tile < last; tile++)
        // Saturating, so that a sum too large for a word does not come round: every share that matters is smaller.
        here = uvec2(here.x + (touching[tile] != 0u ? 1u : 0u), min(here.y + padded(min(touching[tile], push.list_words)), 0x1000000u));
    found[thread] = here;
    barrier();
    uvec2 at = uvec2(0u);
    uint total = 0u;
    for (uint i = 0u; i < 64u; i++) {
        at += i < thread ? found[i] : uvec2(0u);
        total += found[i].x;
    }
    for (uint tile = first; tile < last; tile++) {
        if (touching[tile] == 0u)
            continue;
        uint wanted = padded(min(touching[tile], push.list_words));
        // What no longer fits reads all particles: slow, but right.
        ranges[at.x] = at.y + wanted <= push.list_words ? uvec2(at.y, wanted) : uvec2(SF_THICK_ALL, padded(counts.live));
        at.y += wanted;
        tiles[at.x++] = tile;
    }
    if (thread == 0u) {
        args.draw_tiles = uvec4(4u, total, 0u, 0u);
        args.dispatch_tiles = uvec4(total, 1u, 1u, counts.live);
    }
}
