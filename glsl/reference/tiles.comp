#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the spheres that a tile of the frame may touch, and the depths between which they lie. One group a tile.
#include "shared/frame.h"
#include "shared/particle.h"
#include "shared/reference.h"

layout(local_size_x = SF_REFERENCE_RUN) in;
layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
layout(set = 0, binding = 1, std430) readonly buffer Counts { sf_particle_counts counts; };
layout(set = 0, binding = 2, std430) readonly buffer Spheres { sf_reference_sphere spheres[]; };
layout(set = 0, binding = 3, std430) readonly buffer Rects { vec4 rects[]; };
layout(set = 0, binding = 4, std430) buffer Lists { uvec2 lists[]; };
layout(set = 0, binding = 5, std430) buffer Entries { uint entries[]; };
layout(set = 0, binding = 6, std430) buffer Ranges { vec2 ranges[]; }; // m of view depth
layout(set = 0, binding = 7, std430) buffer Verdict { sf_reference_verdict verdict; };
layout(push_constant) uniform Push { sf_reference_push push; };
#include "reference/list.glsl"

shared vec2 depths[SF_REFERENCE_RUN];

bool touches(vec4 rect, vec2 low)
{
    return rect.x < low.x + float(SF_REFERENCE_TILE) && rect.y < low.y + float(SF_REFERENCE_TILE) && rect.z > low.x && rect.w > low.y;
}

void main()
{
    uint tile = gl_WorkGroupID.y * push.tiles_x + gl_WorkGroupID.x;
    vec2 low = vec2(gl_WorkGroupID.xy) * float(SF_REFERENCE_TILE);
    uvec2 run = list_run(counts.live);
    vec2 range = vec2(SF_DEPTH_FAR, 0.0);
    uint here = 0u;
    for (uint i = run.x; i < run.y; i++) {
        bool touched = touches(rects[i], low);
        vec4 ball = spheres[i].ball;
        float depth = dot(ball.xyz, frame.forward.xyz);
        here += touched ? 1u : 0u;
        range = touched ? vec2(min(range.x, depth - ball.w), max(range.y, depth + ball.w)) : range;
    }
    depths[gl_LocalInvocationID.x] = range;
    uint at = list_place(here, tile * push.lists);
    if (at != SF_REFERENCE_ALL)
        for (uint i = run.x; i < run.y; i++)
            if (touches(rects[i], low))
                entries[at++] = i;
    if (gl_LocalInvocationID.x == 0u) {
        for (uint i = 1u; i < SF_REFERENCE_RUN; i++)
            range = vec2(min(range.x, depths[i].x), max(range.y, depths[i].y));
        // A little more, for what rounding puts on the wrong side.
        float more = 1e-4 * max(range.y - range.x, 1e-3) + 1e-6 * range.y;
        ranges[tile] = vec2(max(range.x - more, frame.eye.w), range.y + more);
        atomicMax(verdict.longest_view, lists[tile * push.lists].y);
    }
}
