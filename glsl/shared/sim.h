/* What one step of the particle simulation reads, and the scratch between its passes. Filled by src/sim/feed.c, read by
 * glsl/sim. */
#ifndef SF_SHARED_SIM_H
#define SF_SHARED_SIM_H
#include "frame.h"
#include "particle.h"

#define SF_SIM_EMITTERS    128
#define SF_SIM_RECORDS     384 /* at most three of an emitter in a step */
#define SF_SIM_TURBULENCES 16
#define SF_SIM_VORTICES    16
#define SF_SIM_TOUCHES     40 /* looks at the objects' distances, at most, for one particle in one step */

/* Kinds of emitter, as enum sf_emitter_kind. */
#define SF_SIM_CONE   0
#define SF_SIM_SPHERE 1
#define SF_SIM_BOX    2
#define SF_SIM_MESH   3
#define SF_SIM_LIST   4

/* Bits of sf_particle.look. */
#define SF_LOOK_EMITTER_SHIFT 8
#define SF_LOOK_STILL         0x10000u
#define SF_LOOK_SPIN_BACK     0x20000u /* turns clockwise */

/* What a random number of a particle is for: the third argument of sf_random. */
#define SF_RANDOM_LIFETIME  0u
#define SF_RANDOM_SPEED     1u
#define SF_RANDOM_RADIUS    2u
#define SF_RANDOM_TILE      3u
#define SF_RANDOM_ROTATION  4u
#define SF_RANDOM_SPIN      5u
#define SF_RANDOM_DIRECTION 6u /* and 7 */
#define SF_RANDOM_PLACE     8u /* to 10 */
#define SF_RANDOM_FACE      11u
#define SF_RANDOM_LOOK      12u /* of the picture alone */

/* Births of one emitter in this step. Birth i (from 0) happens at the fraction moment + i interval of the step, kept
 * within 0..1. */
struct sf_sim_record {
    SF_UINT(first); /* number of its first birth within the step */
    SF_UINT(count);
    SF_UINT(emitter);
    SF_UINT(listed); /* list: first element in the buffer of listed particles */
    SF_VEC4(begin);  /* xyz: where the emitter is when the step begins; w: moment */
    SF_VEC4(end);    /* xyz: where it is when the step ends; w: interval */
    SF_VEC4(drift);  /* xyz: the velocity that particles inherit, m/s; w: unused */
};

struct sf_sim_emitter {
    SF_VEC4(direction); /* xyz: unit, or 0 for outward; w: cosine of the cone of directions about it */
    SF_VEC4(
        shape); /* xyz: cone, sphere: radius, -, -; box: half edges; mesh: scale, -, -; w: extinction at birth, 1/m */
    SF_VEC4(start);  /* lifetime: least, span (s); speed: least, span (m/s) */
    SF_VEC4(body);   /* radius at birth: least, span (m); temperature, K; cooling, 1/s */
    SF_VEC4(change); /* growth, m/s; 3 dilution; fade in; fade out (shares of life) */
    SF_VEC4(turn);   /* spin, rad/s; over a whole step: exp(-cooling dt), and what buoyancy's K s and K s^2 come to (see
                        motion.glsl) */
    SF_VEC4(facing); /* xy: cosine and sine of its turn about +y */
    SF_UINT(kind);
    SF_UINT(surface);
    SF_UINT(triangles); /* mesh: first element in the buffer of triangles, and how many */
    SF_UINT(triangle_count);
};

struct sf_sim_turbulence {
    SF_VEC4(cosines); /* of the four speeds' phases, see noise.glsl */
    SF_VEC4(sines);
    SF_FLOAT(frequency); /* 1/m */
    SF_FLOAT(amplitude); /* m/s, of the first octave */
    SF_UINT(octaves);
    SF_UINT(seed);
};

struct sf_sim_vortex {
    SF_VEC4(position); /* xyz; w: 1 / radius */
    SF_VEC4(axis);     /* xyz: unit; w: speed at the radius, m/s */
    SF_VEC4(pull);     /* x: m/s inward at the radius */
};

/* A uniform block: kept below 16 KiB, which every device offers. */
struct sf_sim_now {
    SF_UINT(births);   /* to make in this step */
    SF_UINT(refused);  /* more births that the capacity refuses before they are made */
    SF_UINT(first_id); /* of this step's births */
    SF_UINT(seed);
    SF_UINT(record_count);
    SF_UINT(turbulence_count);
    SF_UINT(vortex_count);
    SF_UINT(object_count); /* those that collide */
    SF_FLOAT(dt);          /* s */
    SF_FLOAT(drag);        /* 1/s */
    SF_FLOAT(lift);        /* buoyancy, m/s2 per K */
    SF_FLOAT(quiet);       /* m/s: slower touches do not bounce */
    SF_UINT(capacity);     /* particles: no more births than that are made in a step */
    SF_UINT(spare0);
    SF_UINT(spare1);
    SF_UINT(spare2);
    SF_VEC4(acceleration); /* xyz: m/s2 */
    SF_VEC4(wind);         /* xyz: m/s */
    SF_VEC4(
        motion); /* over a whole step: exp(-drag dt), and what velocities and accelerations come to (see motion.glsl) */
    SF_STRUCT(sf_sim_turbulence) turbulences[SF_SIM_TURBULENCES];
    SF_STRUCT(sf_sim_vortex) vortices[SF_SIM_VORTICES];
    SF_STRUCT(sf_gpu_object) objects[SF_FRAME_OBJECTS];
};

/* Emitters, and what they make in this step: too much for a uniform block. Only the records that are there are written. */
struct sf_sim_births {
    SF_STRUCT(sf_sim_emitter) emitters[SF_SIM_EMITTERS];
    SF_STRUCT(sf_sim_record) records[SF_SIM_RECORDS];
};

/* The list is cut into as many chunks as there are workgroups, and a chunk into one run of neighbours for each lane: so
 * the survivors keep their order without a scan inside the loop, at any workgroup and subgroup size. Scratch words: */
#define SF_SIM_SCRATCH_LIVE 0 /* particles before the step */
#define SF_SIM_SCRATCH_CHUNKS                                                                                          \
    1 /* survivors of each chunk; then, for each lane of each chunk, survivors of the lanes before it */

/* A triangle of a mesh emitter, 48 bytes: corner and the upper end of its share of the area (in 2^-32, so that a random
 * word picks it), edges. */
struct sf_sim_triangle {
    SF_FLOAT(x);
    SF_FLOAT(y);
    SF_FLOAT(z);
    SF_UINT(share);
    SF_VEC4(edge1);
    SF_VEC4(edge2);
};
#endif
