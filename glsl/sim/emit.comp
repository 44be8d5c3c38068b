#version 460
#extension GL_GOOGLE_include_directive : require
// Third pass of a step, when there are births: makes them, one a lane, moves them for what is left of the step, and appends them in order.
layout(local_size_x_id = 0) in; // before the includes, which use gl_WorkGroupSize
#include "sim/list.glsl"
#include "sim/motion.glsl"
#include "sim/bounds.glsl"

layout(set = 0, binding = 1, std430) writeonly buffer After { uvec4 after[]; };
layout(set = 0, binding = 2, std430) buffer Counts { sf_particle_counts counts; };
layout(set = 0, binding = 3, std430) readonly buffer Triangles { sf_sim_triangle triangles[]; };
layout(set = 0, binding = 4, std430) readonly buffer Listed { uvec4 listed[]; };
layout(set = 0, binding = 5, std430) readonly buffer Births { sf_sim_births births; };

const float TAU = 6.28318531;

float random(uint id, uint purpose)
{
    return sf_random_float(now.seed, id, purpose);
}

// (1 - exp(-z)) / z, for z >= 0.
float decay_integral(float z)
{
    float series = 1.0 - z * (1.0 / 2.0 - z * (1.0 / 6.0 - z * (1.0 / 24.0 - z * (1.0 / 120.0 - z * (1.0 / 720.0)))));

    return z < 0.5 ? series : (1.0 - exp(-z)) / max(z, 0.5);
}

// The coefficients of motion.glsl for a part of a step. c2 has no form that is stable everywhere: Gauss-Legendre with 4 points.
sf_motion motion_over(float h, float k, float c)
{
    const vec2 point = vec2(0.3399810436, 0.8611363116), weight = vec2(0.3260725774, 0.1739274226);
    float z = k * h;
    float s1 = h * decay_integral(z);
    float series = 1.0 / 2.0 - z * (1.0 / 6.0 - z * (1.0 / 24.0 - z * (1.0 / 120.0 - z * (1.0 / 720.0))));
    float s2 = h * h * (z < 0.5 ? series : (z - 1.0 + exp(-z)) / max(z * z, 0.25));
    float c1 = h * exp(-min(k, c) * h) * decay_integral(abs(k - c) * h);
    float c2 = 0.0;

    for (int i = 0; i < 4; i++) {
        float t = 0.5 + ((i & 1) == 0 ? -0.5 : 0.5) * (i < 2 ? point.x : point.y);

        c2 += (i < 2 ? weight.x : weight.y) * (1.0 - t) * decay_integral(z * (1.0 - t)) * exp(-c * h * t);
    }
    return sf_motion(vec3(exp(-z), s1, s2), vec3(exp(-c * h), c1, h * h * c2));
}

// A unit vector, even over the cap of directions within the angle about the axis.
vec3 direction_in_cone(vec3 axis, float cosine, vec2 r)
{
    // Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
    float sign_z = axis.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (sign_z + axis.z);
    float b = axis.x * axis.y * a;
    vec3 side = vec3(1.0 + sign_z * axis.x * axis.x * a, sign_z * b, -sign_z * axis.x);
    vec3 other = vec3(b, sign_z + axis.y * axis.y * a, -axis.y);
    float along = 1.0 - r.x * (1.0 - cosine);
    float across = sqrt(max(1.0 - along * along, 0.0));

    return axis * along + (side * cos(TAU * r.y) + other * sin(TAU * r.y)) * across;
}

// A point of the box's surface, every part of equal area as likely, and the face's normal.
vec3 point_on_box(vec3 reach, float face, vec3 r, out vec3 normal)
{
    vec3 areas = vec3(reach.y * reach.z, reach.z * reach.x, reach.x * reach.y);
    float pick = face * 2.0 * (areas.x + areas.y + areas.z);
    float side = pick < areas.x + areas.y + areas.z ? -1.0 : 1.0;

    pick -= side > 0.0 ? areas.x + areas.y + areas.z : 0.0;
    normal = (pick < areas.x ? vec3(1.0, 0.0, 0.0) : (pick < areas.x + areas.y ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0))) * side;
    return reach * mix(2.0 * r - 1.0, normal, equal(abs(normal), vec3(1.0)));
}

vec3 point_on_mesh(uint first, uint count, uint pick, vec2 r, out vec3 normal)
{
    uint low = 0u, high = count - 1u;

    // The first triangle whose share ends above the random word.
    while (low < high) {
        uint middle = (low + high) / 2u;
        bool above = triangles[first + middle].share > pick;

        low = above ? low : middle + 1u;
        high = above ? middle : high;
    }
    sf_sim_triangle triangle = triangles[first + low];
    vec3 edge1 = triangle.edge1.xyz, edge2 = triangle.edge2.xyz;

    r = r.x + r.y > 1.0 ? 1.0 - r : r;
    normal = normalize(cross(edge1, edge2));
    return vec3(triangle.x, triangle.y, triangle.z) + edge1 * r.x + edge2 * r.y;
}

vec3 turned(vec3 v, vec2 facing)
{
    return vec3(facing.x * v.x + facing.y * v.z, v.y, facing.x * v.z - facing.y * v.x);
}

// Where it is born, relative to the emitter, and which way is outward there.
vec3 birth_place(sf_sim_emitter emitter, uint id, out vec3 outward)
{
    vec3 r = vec3(random(id, SF_RANDOM_PLACE), random(id, SF_RANDOM_PLACE + 1u), random(id, SF_RANDOM_PLACE + 2u));
    vec3 reach = emitter.shape.xyz;
    vec3 unit = direction_in_cone(vec3(0.0, 0.0, 1.0), -1.0, r.xy);
    vec3 place, normal;

    outward = emitter.direction.xyz;
    if (emitter.kind == SF_SIM_CONE) {
        vec3 on_disc = direction_in_cone(emitter.direction.xyz, 0.0, vec2(1.0, r.y));

        place = on_disc * (reach.x * sqrt(r.x));
    } else if (emitter.kind == SF_SIM_SPHERE) {
        place = unit * (emitter.surface != 0u ? reach.x : reach.x * pow(r.z, 1.0 / 3.0));
        outward = unit;
    } else if (emitter.kind == SF_SIM_BOX) {
        place = point_on_box(reach, random(id, SF_RANDOM_FACE), r, normal);
        if (emitter.surface == 0u) {
            place = reach * (2.0 * r - 1.0);
            normal = dot(place, place) > 0.0 ? normalize(place) : vec3(0.0, 1.0, 0.0);
        }
        place = turned(place, emitter.facing.xy);
        outward = turned(normal, emitter.facing.xy);
    } else {
        place = point_on_mesh(emitter.triangles, emitter.triangle_count, sf_random_u32(now.seed, id, SF_RANDOM_FACE), r.xy, normal) * reach.x;
        place = turned(place, emitter.facing.xy);
        outward = turned(normal, emitter.facing.xy);
    }
    return place;
}

sf_particle newborn(sf_sim_record record, sf_sim_emitter emitter, uint id, float moment)
{
    vec3 outward, x = mix(record.begin.xyz, record.end.xyz, moment) + birth_place(emitter, id, outward);
    vec3 axis = emitter.direction.xyz == vec3(0.0) ? outward : emitter.direction.xyz;
    vec2 r = vec2(random(id, SF_RANDOM_DIRECTION), random(id, SF_RANDOM_DIRECTION + 1u));
    float speed = emitter.start.z + emitter.start.w * random(id, SF_RANDOM_SPEED);
    vec3 v = direction_in_cone(axis, emitter.direction.w, r) * speed + record.drift.xyz;
    float radius = emitter.body.x + emitter.body.y * random(id, SF_RANDOM_RADIUS);
    uint look = (sf_random_u32(now.seed, id, SF_RANDOM_TILE) & 3u) | (record.emitter << SF_LOOK_EMITTER_SHIFT) |
                ((sf_random_u32(now.seed, id, SF_RANDOM_SPIN) & 1u) != 0u ? SF_LOOK_SPIN_BACK : 0u);

    return sf_particle(x.x, x.y, x.z, radius, v.x, v.y, v.z, emitter.shape.w, 0.0,
                       emitter.start.x + emitter.start.y * random(id, SF_RANDOM_LIFETIME), TAU * random(id, SF_RANDOM_ROTATION),
                       emitter.body.z, radius, emitter.shape.w, id, look);
}

void main()
{
    uint birth = gl_GlobalInvocationID.x;
    uint at = counts.survivors + birth;
    vec3 low = vec3(1.0e30), high = vec3(-1.0e30);

    empty_bounds();
    barrier();
    fetch_world();
    if (birth < now.births && at < counts.capacity) {
        uint which = 0u;

        while (which + 1u < now.record_count && births.records[which + 1u].first <= birth)
            which++;
        sf_sim_record record = births.records[which];
        sf_sim_emitter emitter = births.emitters[record.emitter];
        uint number = birth - record.first, id = now.first_id + birth;
        float moment = clamp(record.begin.w + float(number) * record.end.w, 0.0, 1.0);
        float rest = (1.0 - moment) * now.dt;
        bool in_list = emitter.kind == SF_SIM_LIST;
        sf_particle p;

        if (in_list) {
            uint i = 4u * (record.listed + number);

            p = particle_from_words(listed[i], listed[i + 1u], listed[i + 2u], listed[i + 3u]);
            p.id = id;
        } else {
            p = newborn(record, emitter, id, moment);
        }
        if ((p.look & SF_LOOK_STILL) == 0u)
            advance(p, rest, motion_over(rest, now.drag, emitter.body.w), emitter.change, emitter.turn.x);
        after[4u * at] = words_of_place(p);
        after[4u * at + 1u] = words_of_motion(p);
        after[4u * at + 2u] = words_of_life(p);
        after[4u * at + 3u] = words_of_birth(p);
        low = vec3(p.x, p.y, p.z) - p.radius;
        high = vec3(p.x, p.y, p.z) + p.radius;
    }
    JOIN_BOUNDS(low, high, counts)
}
