#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
// For every tile of the lights' maps the list of particles that its rays may meet, in their order: one subgroup a tile, as in lists.comp. The rays lie
// within a cone about the middle one, or a beam where the light is directional.
#include "shared/frame.h"
#include "shared/particle.h"
#include "shared/thick.h"

layout(local_size_x = 32) in;
layout(set = 0, binding = 0, std430) readonly buffer Particles { sf_particle particles[]; };
layout(set = 0, binding = 1, std430) readonly buffer Counts { sf_particle_counts counts; };
layout(set = 0, binding = 2, std430) readonly buffer Views { sf_gpu_light_view views[]; };
layout(set = 0, binding = 3, std430) writeonly buffer Lengths { uint lengths[]; }; // SF_THICK_ALL: too many to list
layout(set = 0, binding = 4, std430) writeonly buffer List { uint list[]; };
layout(push_constant) uniform Push { sf_thick_push push; };
#include "lib/smoke_shadow.glsl"
#include "thick/light_ray.glsl"

void main()
{
    uint side = (push.cell_size + SF_THICK_TILE - 1u) / SF_THICK_TILE;
    uint tile = gl_WorkGroupID.x, light = gl_WorkGroupID.y;
    sf_gpu_light_view view = views[light];
    if (gl_SubgroupID != 0u)
        return;
    vec2 low = vec2(tile % side, tile / side) * float(SF_THICK_TILE), high = min(low + float(SF_THICK_TILE), float(push.cell_size));
    bool beam = view.info.x < 0.5;
    // A cone about the middle ray that holds the four corners' rays; a little wider, for the octahedral map's rays do not lie on straight lines.
    vec3 axis = normalize(light_ray_way(view, 0.5 * (low + high)));
    float cosine = 1.0;
    for (uint i = 0u; i < 4u; i++)
        cosine = min(cosine, dot(axis, normalize(light_ray_way(view, vec2((i & 1u) != 0u ? high.x : low.x, (i & 2u) != 0u ? high.y : low.y)))));
    float sine = min(1.05 * sqrt(max(1.0 - cosine * cosine, 0.0)) + 1e-4, 1.0);
    bool all_around = cosine <= 0.0; // more than a half space
    cosine = sqrt(1.0 - sine * sine);
    vec2 middle = 0.5 * (light_ray_start(view, low).xy + light_ray_start(view, high).xy);
    vec2 reach = 0.5 * abs(light_ray_start(view, high).xy - light_ray_start(view, low).xy);

    uint lanes = min(gl_SubgroupSize, gl_WorkGroupSize.x);
    uint slot = light * side * side + tile, first = slot * push.light_list, at = 0u;
    uint live = view.info.y > 0.5 ? counts.live : 0u;
    for (uint base = 0u; base < live; base += 4u * lanes) {
        for (uint k = 0u; k < 4u; k++) {
            uint index = base + k * lanes + gl_SubgroupInvocationID;
            uint safe = min(index, live - 1u);
            vec3 q = (view.view * vec4(particles[safe].x, particles[safe].y, particles[safe].z, 1.0)).xyz;
            float radius = particles[safe].radius, distance = length(q);
            // cos(a + b), for the sphere seen under the half angle b.
            float sine_b = radius / max(distance, 1e-20), cosine_b = sqrt(max(1.0 - sine_b * sine_b, 0.0));
            float limit = cosine * cosine_b - sine * sine_b;
            bool within = all_around || distance <= radius || dot(axis, q) >= limit * distance;
            bool touches = index < live && particles[safe].extinction > 0.0 && (beam ? all(lessThanEqual(abs(q.xy - middle), reach + radius)) : within);
            uvec4 ballot = subgroupBallot(touches);
            uint place = at + subgroupBallotExclusiveBitCount(ballot);
            if (touches && place < push.light_list)
                list[first + place] = index;
            at += subgroupBallotBitCount(ballot);
        }
    }
    // Not padded: thick/light_map.comp takes none beyond the length.
    if (gl_SubgroupInvocationID == 0u)
        lengths[slot] = at > push.light_list ? SF_THICK_ALL : at;
}
