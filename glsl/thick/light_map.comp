#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_EXT_control_flow_attributes : require
// What a light sees of the smoke, exactly: for each texel of its map the interval near..far and, at SLICES depths evenly spaced in it, how much optical depth
// lies before. One group a tile, one thread a texel.
#include "shared/frame.h"
#include "shared/particle.h"
#include "shared/thick.h"

layout(constant_id = 0) const uint SLICES = 16u; // a multiple of 16
layout(constant_id = 1) const uint TURN = 8u; // spheres read together, as in spheres.glsl
layout(local_size_x = SF_THICK_TILE * SF_THICK_TILE) in;
layout(set = 0, binding = 0, std430) readonly buffer Particles { sf_particle particles[]; };
layout(set = 0, binding = 1, std430) readonly buffer Counts { sf_particle_counts counts; };
layout(set = 0, binding = 2, std430) readonly buffer Views { sf_gpu_light_view views[]; };
layout(set = 0, binding = 3, std430) readonly buffer Lengths { uint lengths[]; };
layout(set = 0, binding = 4, std430) readonly buffer List { uint list[]; };
layout(set = 0, binding = 5, std430) writeonly buffer Slices { uint slices[]; }; // texel-major: the depths before and behind a slice, as halves
layout(set = 0, binding = 6, rgba32f) writeonly uniform image2D target; // near, -far, 1, whole optical depth
layout(push_constant) uniform Push { sf_thick_push push; };
#include "lib/smoke_shadow.glsl"
#include "thick/light_ray.glsl"
#include "thick/kept.glsl"

struct spheres_read {
    vec4 ball; // centre from the light, in radii; radius
    float matter; // optical depth across
} turn; // one a lane

struct lit_list {
    uint first, count;
    bool kept, all_of_them;
} touching;

uint number_of(uint at)
{
    if (touching.kept)
        return kept_words[touching.first + at];
    return touching.all_of_them ? at : list[touching.first + at];
}

void read(uint i, vec3 light)
{
    uint at = i + (gl_SubgroupInvocationID & (TURN - 1u));
    uint number = number_of(min(at, touching.count - 1u));
    bool there = at < touching.count && number != SF_THICK_ALL;
    number = there ? number : 0u;
    float radius = particles[number].radius;
    vec3 centre = vec3(particles[number].x, particles[number].y, particles[number].z) - light;
    there = there && radius > 0.0;
    turn.ball = there ? vec4(centre / radius, radius) : vec4(vec3(SF_THICK_NOWHERE), 0.0);
    turn.matter = there ? 2.0 * radius * particles[number].extinction : 0.0;
}

// Keeps the spheres that this subgroup's rays may meet: none is farther from the middle ray than `apart` where they start, and `spread` more for each metre.
void keep(vec3 light, vec3 start, vec3 way)
{
    vec3 middle = 0.5 * (subgroupMin(start) + subgroupMax(start)), ahead = normalize(0.5 * (subgroupMin(way) + subgroupMax(way)));
    float apart = subgroupMax(length(start - middle)), spread = subgroupMax(length(way - ahead));
    thick_kept kept = kept_begin();
    for (uint i = 0u; i < touching.count; i += gl_SubgroupSize) {
        uint number = number_of(min(i + gl_SubgroupInvocationID, touching.count - 1u));
        vec3 centre = vec3(particles[number].x, particles[number].y, particles[number].z) - light - middle;
        float radius = particles[number].radius;
        vec3 beside = cross(centre, ahead);
        float reach = 1.001 * (radius + apart + spread * (length(centre) + radius));
        kept_add(kept, i + gl_SubgroupInvocationID < touching.count && radius > 0.0 && dot(beside, beside) <= reach * reach, number);
    }
    if (kept_end(kept, SF_THICK_ALL))
        touching = lit_list(kept.first, kept.count, true, false);
}

// From and to of sphere k of the turn, as distances along the ray from `start` (from the light) not below `least`; and the optical depth between.
vec2 take(uint k, vec3 start, vec3 way, float least, out float depth)
{
    vec4 ball = subgroupShuffle(turn.ball, k);
    vec3 c = ball.xyz - start / max(ball.w, 1e-9);
    vec3 beside = cross(c, way);
    float share = sqrt(clamp(1.0 - dot(beside, beside), 0.0, 1.0)), along = ball.w * dot(c, way), half_chord = ball.w * share;
    vec2 chord = vec2(max(along - half_chord, least), along + half_chord);
    float crossed = chord.y - chord.x;
    depth = share > 0.0 && crossed > 0.0 ? subgroupShuffle(turn.matter, k) * share * crossed / (2.0 * half_chord) : 0.0;
    return chord;
}

// Four slices, of which each word has the depths before and behind.
void store(uint to, float before, vec4 ends)
{
    ends = min(ends, 60000.0);
    slices[to] = packHalf2x16(vec2(min(before, 60000.0), ends.x));
    slices[to + 1u] = packHalf2x16(ends.xy);
    slices[to + 2u] = packHalf2x16(ends.yz);
    slices[to + 3u] = packHalf2x16(ends.zw);
}

void main()
{
    uint side = (push.cell_size + SF_THICK_TILE - 1u) / SF_THICK_TILE;
    uint tile = gl_WorkGroupID.x, light = gl_WorkGroupID.y;
    uvec2 texel = uvec2(tile % side, tile / side) * SF_THICK_TILE + thick_corner(gl_SubgroupID * gl_SubgroupSize + gl_SubgroupInvocationID);
    bool within = all(lessThan(texel, uvec2(push.cell_size)));
    sf_gpu_light_view view = views[light];
    bool positional = view.info.x > 0.5;
    // Into the world: the rows of the rotation are the light's axes.
    mat3 turned = transpose(mat3(view.view));
    vec3 way = turned * normalize(light_ray_way(view, vec2(texel) + 0.5));
    vec3 light_at = turned * -view.view[3].xyz, start = turned * light_ray_start(view, vec2(texel) + 0.5);
    float least = positional ? 0.0 : -SF_DEPTH_FAR;

    uint slot = light * side * side + tile, listed = lengths[slot];
    touching = lit_list(slot * push.light_list, listed == SF_THICK_ALL ? counts.live : listed, false, listed == SF_THICK_ALL);
    keep(light_at, start, way);
    float near = SF_DEPTH_FAR, far = -SF_DEPTH_FAR, whole = 0.0;
    for (uint i = 0u; i < touching.count; i += TURN) {
        read(i, light_at);
        [[unroll]] for (uint k = 0u; k < TURN; k++) {
            float depth;
            vec2 chord = take(k, start, way, least, depth);
            near = min(near, depth > 0.0 ? chord.x : SF_DEPTH_FAR);
            far = max(far, depth > 0.0 ? chord.y : -SF_DEPTH_FAR);
            whole += depth;
        }
    }
    bool smoke = far > near;
    uvec2 pixel = uvec2(light * push.cell_size + texel.x, texel.y);
    if (within)
        imageStore(target, ivec2(pixel), smoke ? vec4(near, -far, 1.0, whole) : vec4(SF_DEPTH_FAR, SF_DEPTH_FAR, 1.0, 0.0));

    uint to = (pixel.y * push.cell_size * push.cells + pixel.x) * SLICES;
    float step = max(far - near, 0.0) / float(SLICES), before = 0.0;
    for (uint block = 0u; block < SLICES; block += 16u) {
        vec4 s0 = vec4(0.0), s1 = s0, s2 = s0, s3 = s0;
        for (uint i = 0u; i < touching.count; i += TURN) {
            read(i, light_at);
            [[unroll]] for (uint k = 0u; k < TURN; k++) {
                float depth;
                vec2 chord = take(k, start, way, least, depth);
                // clamp(x, 0, 1) is two instructions on a software device, any other clamp is six.
                float inverse = 1.0 / max(chord.y - chord.x, 1e-9), on = step * inverse;
                vec4 at = (near - chord.x) * inverse + (float(block) + vec4(1.0, 2.0, 3.0, 4.0)) * on;
                s0 += depth * clamp(at, 0.0, 1.0);
                s1 += depth * clamp(at + 4.0 * on, 0.0, 1.0);
                s2 += depth * clamp(at + 8.0 * on, 0.0, 1.0);
                s3 += depth * clamp(at + 12.0 * on, 0.0, 1.0);
            }
        }
        if (within) {
            store(to + block, before, s0);
            store(to + block + 4u, s0.w, s1);
            store(to + block + 8u, s1.w, s2);
            store(to + block + 12u, s2.w, s3);
        }
        before = s3.w;
    }
}
