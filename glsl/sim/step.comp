#version 460
#extension GL_GOOGLE_include_directive : require
// Second pass of a step: moves the survivors, and writes them without gaps, in their order, into the other copy of the list. Also the counts,
// with this step's births, which the third pass appends.
layout(local_size_x_id = 0) in; // before the includes, which use gl_WorkGroupSize
#include "sim/list.glsl"
#include "sim/motion.glsl"
#include "sim/bounds.glsl"

layout(constant_id = 4) const uint EMITTERS = 16;
layout(set = 0, binding = 1, std430) readonly buffer Before { uvec4 before[]; };
layout(set = 0, binding = 2, std430) writeonly buffer After { uvec4 after[]; };
layout(set = 0, binding = 3, std430) buffer Counts { sf_particle_counts counts; };
layout(set = 0, binding = 4, std430) readonly buffer Scratch { uint scratch[]; };
layout(set = 0, binding = 5, std430) readonly buffer Births { sf_sim_births births; };

shared uint chunks_before, chunks_all;

void write_counts(uint live, uint survivors)
{
    uint accepted = min(now.births, counts.capacity - survivors);

    counts.live = survivors + accepted;
    counts.survivors = survivors;
    counts.dropped += now.refused + now.births - accepted;
    counts.births += now.births + now.refused;
    counts.deaths += live - survivors;
    counts.step += 1u;
    counts.draw = uvec4(4u, survivors + accepted, 0u, 0u);
    counts.dispatch = uvec4((survivors + accepted + 63u) / 64u, 1u, 1u, 0u);
}

void main()
{
    uint lane = gl_LocalInvocationIndex;
    uint live = scratch[SF_SIM_SCRATCH_LIVE];
    uint before_mine = 0u, all = 0u;
    uint at, i, end;
    vec3 low = vec3(1.0e30), high = vec3(-1.0e30);

    empty_bounds();
    if (lane == 0u) {
        chunks_before = 0u;
        chunks_all = 0u;
    }
    barrier();
    for (uint chunk = lane; chunk < gl_NumWorkGroups.x; chunk += gl_WorkGroupSize.x) {
        uint survivors = scratch[SF_SIM_SCRATCH_CHUNKS + chunk];

        all += survivors;
        before_mine += chunk < gl_WorkGroupID.x ? survivors : 0u;
    }
    if (all > 0u) {
        atomicAdd(chunks_all, all);
        atomicAdd(chunks_before, before_mine);
    }
    barrier();
    at = chunks_before + scratch[SF_SIM_SCRATCH_CHUNKS + gl_NumWorkGroups.x + gl_WorkGroupID.x * gl_WorkGroupSize.x + lane];
    if (gl_WorkGroupID.x == 0u && lane == 0u)
        write_counts(live, chunks_all);

    float dt = now.dt;
    vec3 free = now.motion.xyz;
    vec4 turn = births.emitters[0].turn, change = births.emitters[0].change;

    fetch_world();
    lane_range(live, i, end);
    // Tested at its end: a software device runs a loop's body once more, masked, when it is tested at its beginning.
    do {
        if (i < end) {
            sf_particle p = particle_from_words(before[4u * i], before[4u * i + 1u], before[4u * i + 2u], before[4u * i + 3u]);

            if (survives(p.age, p.lifetime, p.look, dt)) {
                if ((p.look & SF_LOOK_STILL) == 0u) {
                    if (EMITTERS > 1u) {
                        uint emitter = (p.look >> SF_LOOK_EMITTER_SHIFT) & 0xffu;

                        turn = births.emitters[emitter].turn;
                        change = births.emitters[emitter].change;
                    }
                    advance(p, dt, sf_motion(free, turn.yzw), change, turn.x);
                }
                after[4u * at] = words_of_place(p);
                after[4u * at + 1u] = words_of_motion(p);
                after[4u * at + 2u] = words_of_life(p);
                after[4u * at + 3u] = words_of_birth(p);
                at++;
                low = min(low, vec3(p.x, p.y, p.z) - p.radius);
                high = max(high, vec3(p.x, p.y, p.z) + p.radius);
            }
        }
        i++;
    } while (i < end);
    JOIN_BOUNDS(low, high, counts)
}
