#version 460
#extension GL_GOOGLE_include_directive : require
// The marked tiles as a list in order, and the arguments of the passes that run over it. One group, each thread a contiguous run.
#include "shared/thick.h"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Mask { uint mask[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Tiles { uint tiles[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Args { sf_thick_args args; };
layout(push_constant) uniform Push { sf_thick_push push; };

shared uint found[64];

void main()
{
    uint thread = gl_LocalInvocationID.x;
    uint count = push.tiles_x * push.tiles_y;
    uint run = (count + 63u) / 64u;
    uint first = min(thread * run, count);
    uint last = min(first + run, count);
    uint here = 0u;
    for (uint tile = first; tile < last; tile++)
        here += mask[tile];
    found[thread] = here;
    barrier();
    uint at = 0u, total = 0u;
    for (uint i = 0u; i < 64u; i++) {
        at += i < thread ? found[i] : 0u;
        total += found[i];
    }
    for (uint tile = first; tile < last; tile++)
        if (mask[tile] != 0u)
            tiles[at++] = tile;
    if (thread == 0u) {
        args.draw_tiles = uvec4(4u, total, 0u, 0u);
        args.dispatch_tiles = uvec4(total, 1u, 1u, 0u);
    }
}
