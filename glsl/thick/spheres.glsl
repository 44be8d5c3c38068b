// The spheres of a tile, and where a camera's ray crosses them. Include it where these are declared:
//   constant TURN: 8, or 4 where subgroups are smaller; Spheres { sf_thick_sphere spheres[]; }, List { uint list[]; }, sampler2D atlas, push
//
// A list is walked by a whole subgroup together, TURN spheres a turn: each lane reads one of them and hands it to all others. So every lane must be
// there: no early return, no loop that some lanes leave. (A software device reads storage lane by lane; and a GPU reads memory once.) The loops over a
// turn are unrolled: lavapipe ends an invocation's loops after 65,535 turns in all.
#ifndef SF_THICK_SPHERES_GLSL
#define SF_THICK_SPHERES_GLSL
#include "thick/kept.glsl"

// A ray of the camera with unit view depth.
struct thick_ray {
    vec2 way;      // and 1
    float inverse; // 1 / (way^2 + 1)
    float root;    // of that
    float speed;   // m of way for each metre of view depth
    float nearest; // view depths between which it sees
    float farthest;
};

// What a ray crosses of a sphere: from .. to in view depth, from == to on a miss.
struct thick_chord {
    float from, to;
};

// The spheres of this turn, one a lane.
struct thick_turn {
    vec4 ball;
    float extinction;
    vec3 tint;
    vec4 detail;
};
uint thick_live; // particles; set it first

thick_ray thick_sight(vec2 way, float nearest, float farthest)
{
    float root = inversesqrt(dot(way, way) + 1.0);
    return thick_ray(way, root * root, root, (dot(way, way) + 1.0) * root, nearest, max(farthest, nearest));
}

// The share of its diameter that the ray crosses. clamp(x, 0, 1) is two instructions on a software device, any other clamp is six.
float thick_share(vec3 centre, thick_ray ray)
{
    vec3 beside = vec3(centre.y - centre.z * ray.way.y, centre.z * ray.way.x - centre.x, centre.x * ray.way.y - centre.y * ray.way.x);
    return sqrt(clamp(1.0 - dot(beside, beside) * ray.inverse, 0.0, 1.0));
}

// A list of spheres: a tile's, or what a subgroup has kept of it.
struct thick_list {
    uint first, count;
    bool kept;
};

uint thick_number(thick_list spheres_of, uint at)
{
    if (spheres_of.kept)
        return kept_words[spheres_of.first + at];
    // Where the lists' memory was full all particles are taken; beyond the last stands one that is empty.
    return spheres_of.first == SF_THICK_ALL ? (at < thick_live ? at : push.capacity) : list[spheres_of.first + at];
}

// Of the tile's list (`range`: its first element and how many it has) those that may meet the rays of this subgroup, which lie between `low` and
// `high`.
thick_list thick_keep(uvec2 range, vec2 low, vec2 high)
{
    thick_list whole = thick_list(range.x, range.y, false);
    thick_kept kept = kept_begin();
    low = subgroupMin(low);
    high = subgroupMax(high);
    vec2 middle = 0.5 * (low + high);
    float spread = 0.501 * length(high - low), length_of_way = sqrt(dot(middle, middle) + 1.0);
    for (uint i = 0u; i < range.y; i += gl_SubgroupSize) {
        uint at = i + gl_SubgroupInvocationID;
        uint number = at < range.y ? thick_number(whole, at) : push.capacity;
        vec3 centre = spheres[number].ball.xyz;
        vec3 beside = vec3(centre.y - centre.z * middle.y, centre.z * middle.x - centre.x, centre.x * middle.y - centre.y * middle.x);
        // Rays at most `spread` apart at unit depth: as far from each other as the sphere is away, at most.
        float reach = 1.001 + spread * (length(centre) + 1.0);
        kept_add(kept, dot(beside, beside) <= reach * reach * length_of_way * length_of_way, number);
    }
    return kept_end(kept, push.capacity) ? thick_list(kept.first, kept.count, true) : whole;
}

// Elements i .. i + TURN - 1 of a list.
thick_turn thick_read(thick_list spheres_of, uint i, bool detailed, bool tinted)
{
    uint number = thick_number(spheres_of, i + (gl_SubgroupInvocationID & (TURN - 1u)));
    thick_turn turn;
    turn.ball = spheres[number].ball;
    turn.extinction = spheres[number].matter.x;
    turn.tint = tinted ? spheres[number].matter.yzw : vec3(0.0);
    turn.detail = detailed ? spheres[number].detail : vec4(0.0);
    return turn;
}

// What the atlas leaves of a sphere's chord, 0..1 (L 3.3.6): it dents the sphere about its middle plane.
float thick_dent(vec3 centre, vec4 detail, vec2 way)
{
    vec2 beside = way * centre.z - centre.xy;
    ivec2 at = ivec2(floor(vec2(detail.x * beside.x - detail.y * beside.y, detail.y * beside.x + detail.x * beside.y) + detail.zw)) & (SF_THICK_ATLAS - 1);
    return 1.0 - push.detail * (1.0 - texelFetch(atlas, at, 0).r);
}

// The chord, when the share of the diameter is known.
thick_chord thick_cross(vec4 ball, thick_ray ray, float share)
{
    float along = ball.w * ray.inverse * (ball.x * ray.way.x + ball.y * ray.way.y + ball.z), half_chord = ball.w * ray.root * share;
    return thick_chord(max(along - half_chord, ray.nearest), min(along + half_chord, ray.farthest));
}

// Sphere k of the turn, for this lane's ray: its chord, and the optical depth of that.
thick_chord thick_take(thick_turn turn, uint k, thick_ray ray, bool detailed, out float depth)
{
    vec4 ball = subgroupShuffle(turn.ball, k);
    float share = thick_share(ball.xyz, ray);
    if (detailed)
        share *= thick_dent(ball.xyz, subgroupShuffle(turn.detail, k), ray.way);
    thick_chord chord = thick_cross(ball, ray, share);
    depth = share > 0.0 ? subgroupShuffle(turn.extinction, k) * max(chord.to - chord.from, 0.0) * ray.speed : 0.0;
    return chord;
}

#endif
