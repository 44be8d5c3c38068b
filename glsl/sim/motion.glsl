/* How a particle moves for h seconds: dv/dt = g + b(t) up + k (air - v), with the air's velocity sampled at the middle of the way and held, and
 * the buoyancy b(t) = lift T exp(-c t) of a cooling particle. Exact for a constant air:
 *   v' = v e + A s1 + B c1 up,   x' = x + v s1 + A s2 + B c2 up,   with A = g + k air, B = lift T,
 *   e = exp(-k h),  s1 = integral of exp(-k t) over 0..h,  s2 = integral of s1,
 *   c1 = integral of exp(-k (h - t)) exp(-c t),  c2 = integral of c1.
 * For a whole step src/sim/feed.c has computed them in double precision. */
#ifndef SF_SIM_MOTION_GLSL
#define SF_SIM_MOTION_GLSL
#include "lib/noise.glsl"
#include "lib/sdf.glsl"
#include "shared/sim.h"

/* The lists of the scene have fixed lengths, so that loops over short ones are unrolled. */
layout(constant_id = 1) const uint TURBULENCES = 0;
layout(constant_id = 2) const uint VORTICES = 0;
layout(constant_id = 3) const uint OBJECTS = 0;
const uint TURBULENCES_ROOM = TURBULENCES > 0 ? TURBULENCES : 1;
const uint VORTICES_ROOM = VORTICES > 0 ? VORTICES : 1;
const uint OBJECTS_ROOM = OBJECTS > 0 ? OBJECTS : 1;

layout(set = 0, binding = 0, std140) uniform Now { sf_sim_now now; };

/* What every particle needs, fetched once before a lane's loop: a software device reads uniforms lane by lane, and does so again each time. */
struct sf_world {
    float drag, lift, quiet;
    vec3 acceleration, wind;
    sf_sim_turbulence turbulences[TURBULENCES_ROOM];
    sf_sim_vortex vortices[VORTICES_ROOM];
    sf_gpu_object objects[OBJECTS_ROOM];
} world;

void fetch_world()
{
    world.drag = now.drag;
    world.lift = now.lift;
    world.quiet = now.quiet;
    world.acceleration = now.acceleration.xyz;
    world.wind = now.wind.xyz;
    for (uint i = 0u; i < TURBULENCES; i++)
        world.turbulences[i] = now.turbulences[i];
    for (uint i = 0u; i < VORTICES; i++)
        world.vortices[i] = now.vortices[i];
    for (uint i = 0u; i < OBJECTS; i++)
        world.objects[i] = now.objects[i];
}

struct sf_motion {
    vec3 free; /* e, s1, s2 */
    vec3 cool; /* exp(-c h), c1, c2 */
};

/* Kaufmann's vortex (1962): still on its axis, fastest at its radius, falling as 1/r beyond; the pull has the same profile. */
vec3 vortex_velocity(sf_sim_vortex vortex, vec3 x)
{
    vec3 away = x - vortex.position.xyz;

    away -= vortex.axis.xyz * dot(away, vortex.axis.xyz);
    away *= vortex.position.w;
    return (cross(vortex.axis.xyz, away) * vortex.axis.w - away * vortex.pull.x) * (2.0 / (1.0 + dot(away, away)));
}

vec3 air_velocity(vec3 x)
{
    vec3 air = world.wind;

    for (uint i = 0u; i < TURBULENCES; i++)
        air += world.turbulences[i].amplitude * sf_curl_noise_octaves(x * world.turbulences[i].frequency, world.turbulences[i].seed,
                                                                    world.turbulences[i].octaves, world.turbulences[i].cosines,
                                                                    world.turbulences[i].sines);
    for (uint i = 0u; i < VORTICES; i++)
        air += vortex_velocity(world.vortices[i], x);
    return air;
}

/* Distance to the nearest object, its outward normal, and its bounce. */
float nearest_object(vec3 x, out vec3 normal, out vec2 bounce)
{
    float nearest = 1.0e30;

    normal = vec3(0.0, 1.0, 0.0);
    bounce = vec2(0.0);
    for (uint i = 0u; i < OBJECTS; i++) {
        vec3 n;
        float d = sf_object_distance(world.objects[i], x, n);

        normal = d < nearest ? n : normal;
        bounce = d < nearest ? world.objects[i].bounce.xy : bounce;
        nearest = min(nearest, d);
    }
    return nearest;
}

/* What a touch leaves of the velocity. `was` is the velocity before the step and `share` the part of the step made so far: so the speed at the
 * touch itself is turned round, and a ball neither gains nor loses height by the length of the step. */
vec3 touched(vec3 v, vec3 was, float share, vec3 normal, vec2 bounce, out float back)
{
    float at_touch = dot(mix(was, v, share), normal);
    float across = dot(v, normal);
    vec3 along = (v - normal * across) * (1.0 - bounce.y);

    back = -at_touch > world.quiet ? bounce.x : 0.0;

    /* After a bounce the forces go on as before; without one nothing is left that points inward. */
    return across >= 0.0 ? v : along + normal * (back > 0.0 ? max(across - (1.0 + back) * at_touch, 0.0) : 0.0);
}

/* Moves x by `way` among the objects, and leaves it outside all of them. Far from any it is one look at the distances. Near one it is walked up to
 * (a step as long as the distance passes through nothing), touched and slid along; it rests a skin's breadth off. Where solids meet so
 * narrowly that pushing from one lands in the other, it goes back and stops; a particle born inside such a knot rises out of it. */
void move_among_objects(inout vec3 x, vec3 way, inout vec3 v, vec3 was)
{
    const uint WALK = 10u, PUSH = 16u;
    vec3 start = x;
    float whole = max(length(way), 1.0e-20);
    uint tries = 0u;
    bool again;

    do {
        vec3 normal;
        vec2 bounce;
        float d = nearest_object(x, normal, bounce);
        float skin = 1.0e-3 + 1.0e-6 * (abs(x.x) + abs(x.y) + abs(x.z));
        float ahead = length(way);
        float inward = min(dot(way, normal), 0.0);
        bool touch = d < 0.5 * skin || (d < 2.0 * skin && inward < 0.0);
        bool clear = !touch && ahead <= d;
        /* Walk up to the surface; after too many small steps take the rest at once, the push will mend it. */
        float part = clear || tries >= WALK ? 1.0 : d / max(ahead, 1.0e-20);

        if (touch) {
            float back;

            v = touched(v, was, 1.0 - ahead / whole, normal, bounce, back);
            x += way + normal * (max(skin - d, 0.0) - (1.0 + back) * inward);
            way = vec3(0.0);
        } else {
            x += way * part;
            way *= 1.0 - part;
        }
        again = !clear;
        tries++;
        if (again && tries >= PUSH) {
            x = tries == PUSH ? start : x + vec3(0.0, 1.5 * max(-d, skin), 0.0);
            v = vec3(0.0);
            way = vec3(0.0);
            again = tries < SF_SIM_TOUCHES;
        }
    } while (again);
}

/* Share of the extinction at this moment of life: rises over the first part, falls over the last. */
float life_fade(float age, float lifetime, vec2 fade)
{
    float life = lifetime > 0.0 ? age / lifetime : 0.5;
    float rise = fade.x > 0.0 ? smoothstep(0.0, fade.x, life) : 1.0;
    float fall = fade.y > 0.0 ? 1.0 - smoothstep(1.0 - fade.y, 1.0, life) : 1.0;

    return lifetime > 0.0 ? rise * fall : 1.0;
}

void advance(inout sf_particle p, float h, sf_motion motion, vec4 change, float spin)
{
    vec3 x = vec3(p.x, p.y, p.z);
    vec3 v = vec3(p.vx, p.vy, p.vz);
    vec3 was = v;
    vec3 steady = world.acceleration + world.drag * air_velocity(x + 0.5 * h * v);
    float rising = world.lift * p.temperature;
    vec3 way = v * motion.free.y + steady * motion.free.z + vec3(0.0, rising * motion.cool.z, 0.0);

    v = v * motion.free.x + steady * motion.free.y + vec3(0.0, rising * motion.cool.y, 0.0);
    if (OBJECTS > 0u)
        move_among_objects(x, way, v, was);
    else
        x += way;
    p.x = x.x;
    p.y = x.y;
    p.z = x.z;
    p.vx = v.x;
    p.vy = v.y;
    p.vz = v.z;
    p.temperature *= motion.cool.x;
    p.age += h;
    p.radius += change.x * h;
    p.rotation += ((p.look & SF_LOOK_SPIN_BACK) != 0u ? -spin : spin) * h;
    float thin = change.y > 0.0 ? pow(p.radius0 / p.radius, change.y) : 1.0;
    p.extinction = p.extinction0 * thin * life_fade(p.age, p.lifetime, change.zw);
}

#endif
