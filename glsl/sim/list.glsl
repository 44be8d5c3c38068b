/* Particles as they lie in memory: four words of 16 bytes each, so that a lane reads and writes whole vectors, and ids pass through untouched. */
#ifndef SF_SIM_LIST_GLSL
#define SF_SIM_LIST_GLSL
#include "shared/sim.h"

sf_particle particle_from_words(uvec4 a, uvec4 b, uvec4 c, uvec4 d)
{
    vec4 place = uintBitsToFloat(a), motion = uintBitsToFloat(b), life = uintBitsToFloat(c);

    return sf_particle(place.x, place.y, place.z, place.w, motion.x, motion.y, motion.z, motion.w, life.x, life.y, life.z, life.w,
                       uintBitsToFloat(d.x), uintBitsToFloat(d.y), d.z, d.w);
}

uvec4 words_of_place(sf_particle p)
{
    return floatBitsToUint(vec4(p.x, p.y, p.z, p.radius));
}

uvec4 words_of_motion(sf_particle p)
{
    return floatBitsToUint(vec4(p.vx, p.vy, p.vz, p.extinction));
}

uvec4 words_of_life(sf_particle p)
{
    return floatBitsToUint(vec4(p.age, p.lifetime, p.rotation, p.temperature));
}

uvec4 words_of_birth(sf_particle p)
{
    return uvec4(floatBitsToUint(p.radius0), floatBitsToUint(p.extinction0), p.id, p.look);
}

/* Whether it lives on after dt more seconds. Two passes ask and must agree, hence the precise sum. */
bool survives(float age, float lifetime, uint look, float dt)
{
    precise float next = age + dt;

    return (look & SF_LOOK_STILL) != 0u || lifetime <= 0.0 || next < lifetime;
}

/* The run of the list that this lane has to itself. */
void lane_range(uint live, out uint begin, out uint end)
{
    uint chunk = (live + gl_NumWorkGroups.x - 1u) / gl_NumWorkGroups.x;
    uint run = (chunk + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x;
    uint chunk_end = min((gl_WorkGroupID.x + 1u) * chunk, live);

    begin = min(gl_WorkGroupID.x * chunk + gl_LocalInvocationIndex * run, chunk_end);
    end = min(begin + run, chunk_end);
}

#endif
