#version 460
#extension GL_GOOGLE_include_directive : require
// First pass of a step: how many particles of each lane's run live on, summed up within each chunk. Also empties the bounds for the next passes.
layout(local_size_x_id = 0) in; // before the includes, which use gl_WorkGroupSize
#include "sim/list.glsl"

layout(set = 0, binding = 0, std140) uniform Now { sf_sim_now now; };
layout(set = 0, binding = 1, std430) readonly buffer Before { uvec4 before[]; };
layout(set = 0, binding = 2, std430) buffer Counts { sf_particle_counts counts; };
layout(set = 0, binding = 3, std430) writeonly buffer Scratch { uint scratch[]; };

shared uint sums[2][gl_WorkGroupSize.x];

void main()
{
    uint lane = gl_LocalInvocationIndex;
    uint live = counts.live;
    uint begin, end, mine = 0u;
    float dt = now.dt;

    lane_range(live, begin, end);
    for (uint i = begin; i < end; i++) {
        vec2 life = uintBitsToFloat(before[4u * i + 2u].xy);

        mine += survives(life.x, life.y, before[4u * i + 3u].w, dt) ? 1u : 0u;
    }
    // Inclusive sums, doubling the reach each time; two rows, so that one barrier a round is enough.
    uint row = 0u;
    sums[0][lane] = mine;
    barrier();
    for (uint reach = 1u; reach < gl_WorkGroupSize.x; reach *= 2u) {
        uint sum = sums[row][lane] + (lane >= reach ? sums[row][lane - reach] : 0u);

        row = 1u - row;
        sums[row][lane] = sum;
        barrier();
    }
    scratch[SF_SIM_SCRATCH_CHUNKS + gl_NumWorkGroups.x + gl_WorkGroupID.x * gl_WorkGroupSize.x + lane] = sums[row][lane] - mine;
    if (lane == gl_WorkGroupSize.x - 1u)
        scratch[SF_SIM_SCRATCH_CHUNKS + gl_WorkGroupID.x] = sums[row][lane];
    if (gl_WorkGroupID.x == 0u && lane == 0u) {
        scratch[SF_SIM_SCRATCH_LIVE] = live;
        counts.bounds_min = uvec4(0xffffffffu, 0xffffffffu, 0xffffffffu, 0u);
        counts.bounds_max = uvec4(0u);
    }
}
