#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the spheres that may stand on a way from a piece of a tile to a light: those that come near enough to the middle way. Slices are as
// wide as two steps from one to the next, so that samples next to each other, which lie within one step, have one list. One group a list.
#include "shared/frame.h"
#include "shared/particle.h"
#include "shared/reference.h"

layout(local_size_x = SF_REFERENCE_RUN) in;
layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
layout(set = 0, binding = 1, std430) readonly buffer Counts { sf_particle_counts counts; };
layout(set = 0, binding = 2, std430) readonly buffer Spheres { sf_reference_sphere spheres[]; };
layout(set = 0, binding = 3, std430) readonly buffer Ranges { vec2 ranges[]; };
layout(set = 0, binding = 4, std430) buffer Lists { uvec2 lists[]; };
layout(set = 0, binding = 5, std430) buffer Entries { uint entries[]; };
layout(set = 0, binding = 6, std430) buffer Verdict { sf_reference_verdict verdict; };
layout(push_constant) uniform Push { sf_reference_push push; };
#include "reference/list.glsl"
#include "reference/view.glsl"

// From `middle` at most `reach` (infinite for directional lights) along `to_light`, with `radius` to all sides.
bool near(vec4 ball, vec3 middle, vec3 to_light, float reach, float radius)
{
    vec3 way = ball.xyz - middle;
    vec3 miss = way - clamp(dot(way, to_light), 0.0, reach) * to_light;
    float sum = ball.w + radius;
    return ball.w > 0.0 && dot(miss, miss) <= sum * sum;
}

void main()
{
    uint tile = gl_WorkGroupID.z * push.tiles_x + gl_WorkGroupID.y, piece = gl_WorkGroupID.x;
    uint light = piece / push.slices, slice = piece % push.slices;
    uint list = tile * push.lists + 1u + light * SF_REFERENCE_SLICES + slice;
    bool wanted = lists[tile * push.lists].y > 0u && any(greaterThan(frame.lights[light].color.rgb, vec3(0.0)));

    // The sphere around the piece.
    vec2 range = ranges[tile];
    float first = mix(range.x, range.y, float(slice) / float(push.slices));
    float last = mix(range.x, range.y, min(float(slice + 2u) / float(push.slices), 1.0));
    vec2 corner = vec2(gl_WorkGroupID.yz) * float(SF_REFERENCE_TILE);
    vec3 middle = 0.5 * (first + last) * pixel_ray(corner + 0.5 * float(SF_REFERENCE_TILE));
    float radius = 0.0;
    for (uint i = 0u; i < 8u; i++) {
        vec3 ray = pixel_ray(corner + vec2(i & 1u, i >> 1u & 1u) * float(SF_REFERENCE_TILE));
        radius = max(radius, distance((i & 4u) != 0u ? first * ray : last * ray, middle));
    }
    radius = radius * 1.001 + 1e-5 * length(middle);

    vec4 position = frame.lights[light].position;
    bool directional = uint(position.w) == SF_LIGHT_KIND_DIRECTIONAL;
    vec3 to_light = directional ? -frame.lights[light].direction.xyz : position.xyz - frame.eye.xyz - middle;
    float reach = directional ? 1e15 : length(to_light);
    to_light /= max(length(to_light), 1e-12);
    uvec2 run = wanted ? list_run(counts.live) : uvec2(0u);
    uint here = 0u;
    for (uint i = run.x; i < run.y; i++)
        here += near(spheres[i].ball, middle, to_light, reach, radius) ? 1u : 0u;
    uint at = list_place(here, list);
    if (at != SF_REFERENCE_ALL)
        for (uint i = run.x; i < run.y; i++)
            if (near(spheres[i].ball, middle, to_light, reach, radius))
                entries[at++] = i;
    if (gl_LocalInvocationID.x == 0u)
        atomicMax(verdict.longest_way, lists[list].y);
}
