#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// The integral along a pixel's ray (docs/methods/reference.md), some samples of it in every play. One group a tile, one thread a pixel.
//
// The ray is cut into push.samples cells at the boundaries t(k / samples). The light that a cell sends to the eye is its weight, T at its
// beginning less T at its end, both exact, times what its matter sends on from where its middle is; so the weights of all cells add up to 1 - T.
// The map t gives cells about equal shares of a measure that is for the most part the light which reaches the eye, and for the rest the way: it is
// linear between knots, where its inverse is exact. SF_REFERENCE_ROW cells next to each other are taken at once.
#include "shared/frame.h"
#include "shared/particle.h"
#include "shared/reference.h"

layout(constant_id = 0) const uint LIGHTS = 1u;
layout(constant_id = 1) const uint SOLIDS = 0u; // that cast shadows, in the list of objects from
layout(constant_id = 2) const uint FIRST_SOLID = 0u;
layout(constant_id = 3) const uint MESHES = 0u; // 0: none; 1: by their triangles; 2: by the lights' shadow maps, with all else
layout(constant_id = 4) const uint CASTING = 0u; // one bit a light: objects cast shadows in it
layout(local_size_x = SF_REFERENCE_TILE, local_size_y = SF_REFERENCE_TILE) in;
layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
layout(set = 0, binding = 1, std140) uniform Objects { sf_gpu_object objects[SF_FRAME_OBJECTS]; };
layout(set = 0, binding = 2, std430) readonly buffer Spheres { sf_reference_sphere spheres[]; };
layout(set = 0, binding = 3, std430) readonly buffer Lists { uvec2 lists[]; };
layout(set = 0, binding = 4, std430) readonly buffer Entries { uint entries[]; };
layout(set = 0, binding = 5, std430) readonly buffer Ranges { vec2 ranges[]; };
layout(set = 0, binding = 6, std430) readonly buffer Counts { sf_particle_counts counts; };
layout(set = 0, binding = 7) uniform sampler2D depths;
layout(set = 0, binding = 8) uniform sampler2D shadow_map;
layout(set = 0, binding = 9, std430) readonly buffer Nodes { sf_reference_node nodes[]; };
layout(set = 0, binding = 10, std430) readonly buffer Corners { vec4 corners[]; };
layout(set = 0, binding = 11, std430) buffer Verdict { sf_reference_verdict verdict; };
layout(set = 0, binding = 12, rgba32f) uniform image2D sums; // weighted radiance; A: the weights
layout(push_constant) uniform Push { sf_reference_push push; };
#include "lib/environment.glsl"
#include "lib/lighting.glsl"
#include "lib/order.glsl"
#include "lib/phase.glsl"
#include "lib/shadow.glsl"
#include "lib/solid.glsl"
#include "lib/sphere.glsl"
#include "reference/mesh.glsl"
#include "reference/view.glsl"

const uint KNOTS = SF_REFERENCE_KNOTS, ROW = SF_REFERENCE_ROW, UNROLL = SF_REFERENCE_UNROLL;
const float BY_LIGHT = 0.75; // of the measure; the rest is by the way, so that no cell is long

// The ray, which all functions are about.
vec3 ray;
float ray_length, near, far, whole; // whole: 1 - T
uvec2 list;

// Behind the list's end: its last.
uint list_entry(uvec2 of, uint i)
{
    uint inside = min(i, of.y - 1u);
    return of.x == SF_REFERENCE_ALL ? inside : entries[of.x + inside];
}

// 0 behind the list's end.
float list_extinction(uvec2 of, uint i, uint index)
{
    return i < of.y ? spheres[index].matter.x : 0.0;
}

// Where the matter of a sphere begins and ends on near..far (the end not before the beginning), and its optical depth for each metre of view
// depth.
vec3 sphere_part(uint index, float extinction)
{
    vec4 ball = spheres[index].ball;
    // A little more than the sphere, so that none is missed whose chord reference/depths.comp, which is more exact, has found.
    vec2 chord = sphere_chord(ray, ball.xyz, ball.w * 1.000002);
    float from = clamp(chord.x - chord.y, near, far);
    return vec3(from, clamp(chord.x + chord.y, from, far), chord.y > 0.0 ? extinction * ray_length : 0.0);
}

// 1 - exp(-depth)
float opaque(float depth)
{
    return depth < 1e-3 ? depth * (1.0 - 0.5 * depth) : 1.0 - exp(-depth);
}

// The measure from near up to each of the depths t.
void measure(float t[KNOTS + 1u], out float measured[KNOTS + 1u])
{
    float depth[KNOTS + 1u];
    [[unroll]] for (uint k = 0u; k <= KNOTS; k++)
        depth[k] = 0.0;
    for (uint i = 0u; i < list.y; i += UNROLL) {
        [[unroll]] for (uint n = 0u; n < UNROLL; n++) {
            uint index = list_entry(list, i + n);
            vec3 part = sphere_part(index, list_extinction(list, i + n, index));
            [[unroll]] for (uint k = 1u; k < KNOTS; k++)
                depth[k] += part.z * (clamp(t[k], part.x, part.y) - part.x);
        }
    }
    measured[0] = 0.0;
    [[unroll]] for (uint k = 1u; k < KNOTS; k++)
        measured[k] = BY_LIGHT * min(opaque(depth[k]) / whole, 1.0) + (1.0 - BY_LIGHT) * (t[k] - near) / (far - near);
    measured[KNOTS] = 1.0;
}

// The map: depths at knots, and the measure there, as the share of a piece that a unit of the measure is.
struct ray_map {
    float t[KNOTS + 1u], measured[KNOTS + 1u], inverse[KNOTS];
};

ray_map map_of(float t[KNOTS + 1u])
{
    ray_map map;
    map.t = t;
    measure(t, map.measured);
    [[unroll]] for (uint k = 0u; k < KNOTS; k++)
        map.inverse[k] = 1.0 / max(map.measured[k + 1u] - map.measured[k], 1e-9);
    return map;
}

// The depth at which the measure is `wanted`, linear between knots.
float depth_of(ray_map map, float wanted)
{
    float at = near;
    [[unroll]] for (uint k = 0u; k < KNOTS; k++)
        at += (map.t[k + 1u] - map.t[k]) * clamp((wanted - map.measured[k]) * map.inverse[k], 0.0, 1.0);
    return wanted < 1.0 ? min(at, far) : far;
}

// Optical depth of the smoke between the light and each point of a row, from a list.
void smoke_between(uint light, uvec2 of, float t[ROW], out float depth[ROW])
{
    vec4 position = frame.lights[light].position;
    bool directional = uint(position.w) == SF_LIGHT_KIND_DIRECTIONAL;
    [[unroll]] for (uint j = 0u; j < ROW; j++)
        depth[j] = 0.0;

    // Along the light everything is seen from its own axes: x and y across, z towards it.
    vec3 z = -frame.lights[light].direction.xyz;
    vec3 x = normalize(cross(z, abs(z.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0))), y = cross(z, x);
    vec3 seen = vec3(dot(ray, x), dot(ray, y), dot(ray, z)), at[ROW];
    [[unroll]] for (uint j = 0u; j < ROW; j++)
        at[j] = t[j] * seen;
    for (uint i = 0u; i < (directional ? of.y : 0u); i += UNROLL) {
        [[unroll]] for (uint n = 0u; n < UNROLL; n++) {
            uint index = list_entry(of, i + n);
            vec4 ball = spheres[index].ball;
            float extinction = list_extinction(of, i + n, index), squared = ball.w * ball.w;
            vec3 c = vec3(dot(ball.xyz, x), dot(ball.xyz, y), dot(ball.xyz, z));
            [[unroll]] for (uint j = 0u; j < ROW; j++) {
                vec3 way = c - at[j];
                float chord = sqrt(max(squared - way.x * way.x - way.y * way.y, 0.0));
                depth[j] += extinction * (max(way.z + chord, 0.0) - max(way.z - chord, 0.0));
            }
        }
    }

    // From a lamp: its direction to each point, and how far that is.
    vec3 lamp = position.xyz - frame.eye.xyz, to_point[ROW];
    float reach[ROW];
    [[unroll]] for (uint j = 0u; j < ROW; j++) {
        to_point[j] = t[j] * ray - lamp;
        reach[j] = length(to_point[j]);
        to_point[j] /= max(reach[j], 1e-12);
    }
    for (uint i = 0u; i < (directional ? 0u : of.y); i += UNROLL) {
        [[unroll]] for (uint n = 0u; n < UNROLL; n++) {
            uint index = list_entry(of, i + n);
            vec4 ball = spheres[index].ball;
            float extinction = list_extinction(of, i + n, index), squared = ball.w * ball.w;
            vec3 c = ball.xyz - lamp;
            [[unroll]] for (uint j = 0u; j < ROW; j++) {
                float along = dot(c, to_point[j]);
                vec3 miss = c - along * to_point[j];
                float chord = sqrt(max(squared - dot(miss, miss), 0.0));
                depth[j] += extinction * max(min(along + chord, reach[j]) - max(along - chord, 0.0), 0.0);
            }
        }
    }
}

// The unit vector from a point (seen from the eye) to the light, and how far it is.
vec4 way_to(uint light, vec3 point)
{
    vec4 position = frame.lights[light].position;
    vec3 way = position.xyz - frame.eye.xyz - point;
    float far_away = length(way);
    return uint(position.w) == SF_LIGHT_KIND_DIRECTIONAL ? vec4(-frame.lights[light].direction.xyz, 1e15) : vec4(way / max(far_away, 1e-12), far_away);
}

// One bit a point of the row: a solid stands between it and the light.
uint solids_between(uint light, float t[ROW])
{
    uint hidden = 0u;
    for (uint i = 0u; i < SOLIDS; i++) {
        sf_gpu_object object = objects[FIRST_SOLID + i];
        uint kind = uint(object.shape.w);
        mat3 turn = transpose(mat3(object.row0.xyz, object.row1.xyz, object.row2.xyz));
        vec3 eye = turn * frame.eye.xyz + vec3(object.row0.w, object.row1.w, object.row2.w), along = turn * ray;
        vec4 reach = solid_reach(kind, object.shape);
        [[unroll]] for (uint j = 0u; j < ROW; j++) {
            vec4 way = way_to(light, t[j] * ray);
            vec2 span = solid_span(reach, solid_ball(kind), eye + t[j] * along, turn * way.xyz);
            // From within, its far side hides the light, unless the light is within as well.
            bool met = span.x > 0.0 && span.x < way.w || span.y > 0.0 && span.y < way.w;
            hidden |= span.x <= span.y && met ? 1u << j : 0u;
        }
    }
    return hidden;
}

// The same for meshes.
uint meshes_between(uint light, float t[ROW])
{
    uint hidden = 0u;
    for (uint j = 0u; j < ROW; j++) {
        float at = 0.0; // t[j], by its number in a way that leaves the array in registers
        [[unroll]] for (uint k = 0u; k < ROW; k++)
            at = k == j ? t[k] : at;
        vec3 point = at * ray;
        vec4 way = way_to(light, point);
        hidden |= mesh_stands_between(frame.eye.xyz + point, way.xyz, way.w) ? 1u << j : 0u;
    }
    return hidden;
}

// Radiance that each point of the row sends to the eye for each unit of scattering, from one light.
void add_light(uint light, uvec2 of, float t[ROW], uint hidden, inout vec3 lit[ROW])
{
    float depth[ROW];
    vec3 direction = ray / ray_length;
    smoke_between(light, of, t, depth);
    [[unroll]] for (uint j = 0u; j < ROW; j++) {
        vec3 world = frame.eye.xyz + t[j] * ray, to_light;
        vec3 irradiance = light_irradiance(frame.lights[light], world, to_light);
        float share = phase_henyey_greenstein(dot(direction, to_light), frame.albedo.w) * exp(-depth[j]);
        if (MESHES == 2u)
            share *= scene_visibility(light, world);
        lit[j] += (hidden >> j & 1u) != 0u ? vec3(0.0) : share * irradiance;
    }
}

// Of a row's cells: their weights, what share of their extinction scatters, and where the middle of their matter is.
void weigh(float ends[ROW + 1u], out float weight[ROW], out vec3 albedo[ROW], out float t[ROW])
{
    float depth[ROW + 1u], moment[ROW + 1u];
    vec3 scattering[ROW + 1u];
    [[unroll]] for (uint k = 0u; k <= ROW; k++) {
        depth[k] = 0.0;
        moment[k] = 0.0;
        scattering[k] = vec3(0.0);
    }
    for (uint i = 0u; i < list.y; i += UNROLL) {
        [[unroll]] for (uint n = 0u; n < UNROLL; n++) {
            uint index = list_entry(list, i + n);
            vec3 part = sphere_part(index, list_extinction(list, i + n, index));
            vec3 own = spheres[index].matter.yzw;
            [[unroll]] for (uint k = 0u; k <= ROW; k++) {
                float end = clamp(ends[k], part.x, part.y), added = part.z * (end - part.x);
                depth[k] += added;
                moment[k] += added * (end - ends[0] + (part.x - ends[0]));
                scattering[k] += added * own;
            }
        }
    }
    [[unroll]] for (uint j = 0u; j < ROW; j++) {
        float within = depth[j + 1u] - depth[j];
        weight[j] = exp(-depth[j]) * opaque(max(within, 0.0));
        albedo[j] = (scattering[j + 1u] - scattering[j]) / max(within, 1e-30);
        float centre = ends[0] + 0.5 * (moment[j + 1u] - moment[j]) / max(within, 1e-30);
        t[j] = within > 0.0 ? clamp(centre, ends[j], ends[j + 1u]) : 0.5 * (ends[j] + ends[j + 1u]);
    }
}

vec3 ambient_at(vec3 world)
{
    vec3 low = vec3(float_from_order(counts.bounds_min.x), float_from_order(counts.bounds_min.y), float_from_order(counts.bounds_min.z));
    vec3 high = vec3(float_from_order(counts.bounds_max.x), float_from_order(counts.bounds_max.y), float_from_order(counts.bounds_max.z));
    vec3 outward = world - 0.5 * (low + high);
    return environment_blurred(outward / max(length(outward), 1e-6)) * push.ambient;
}

// Weighted radiance of SF_REFERENCE_ROW cells from cell number `first` on; A: their weights.
vec4 row_of(ray_map map, uint first, uint tile)
{
    float ends[ROW + 1u], t[ROW], weight[ROW];
    vec3 albedo[ROW], lit[ROW];
    [[unroll]] for (uint k = 0u; k <= ROW; k++)
        ends[k] = depth_of(map, float(first + k) / float(push.samples));
    [[unroll]] for (uint j = 0u; j < ROW; j++)
        lit[j] = vec3(0.0);
    weigh(ends, weight, albedo, t);
    vec2 range = ranges[tile];
    uint slice = min(uint(max((ends[0] - range.x) / (range.y - range.x), 0.0) * float(push.slices)), push.slices - 1u);
    for (uint light = 0u; light < LIGHTS; light++) {
        bool casts = (CASTING >> light & 1u) != 0u;
        uint hidden = SOLIDS > 0u && MESHES < 2u && casts ? solids_between(light, t) : 0u;
        if (MESHES == 1u)
            hidden |= casts ? meshes_between(light, t) : 0u;
        add_light(light, lists[tile * push.lists + 1u + light * SF_REFERENCE_SLICES + slice], t, hidden, lit);
    }
    vec4 sum = vec4(0.0);
    [[unroll]] for (uint j = 0u; j < ROW; j++) {
        vec3 sent = albedo[j] * (lit[j] + ambient_at(frame.eye.xyz + t[j] * ray)) + frame.emission.rgb;
        sum += weight[j] * vec4(sent, 1.0);
    }
    return sum;
}

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    uint tile = gl_WorkGroupID.y * push.tiles_x + gl_WorkGroupID.x;
    if (pixel.x >= uint(frame.size.x) || pixel.y >= uint(frame.size.y))
        return;
    vec4 seen = texelFetch(depths, ivec2(pixel), 0);
    ray = pixel_ray(vec2(pixel) + 0.5);
    ray_length = length(ray);
    near = seen.x;
    far = max(seen.y, near + 1e-6 * near);
    whole = max(opaque(seen.z), 1e-30);
    list = lists[tile * push.lists];
    list.y = seen.z > 0.0 ? list.y : 0u;

    float knots[KNOTS + 1u];
    [[unroll]] for (uint k = 0u; k <= KNOTS; k++)
        knots[k] = mix(near, far, float(k) / float(KNOTS));
    ray_map map = map_of(knots);
    [[unroll]] for (uint k = 0u; k <= KNOTS; k++)
        knots[k] = depth_of(map, float(k) / float(KNOTS));
    map = map_of(knots);

    vec4 sum = vec4(0.0);
    for (uint row = 0u; row < (seen.z > 0.0 ? push.rows : 0u); row++)
        sum += row_of(map, (push.first_row + row * push.row_stride) * ROW, tile);
    if (push.play > 0u)
        sum += imageLoad(sums, ivec2(pixel));
    imageStore(sums, ivec2(pixel), sum);
    if (MESHES == 1u && mesh_turns >= push.budget)
        atomicAdd(verdict.over, 1u);
}
