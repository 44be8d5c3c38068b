/* A particle, and the counts that go with the list. Written by glsl/sim, read by every method. */
#ifndef SF_SHARED_PARTICLE_H
#define SF_SHARED_PARTICLE_H
#include "types.h"

/* 64 bytes. The list is compact: indices 0..live-1, in order of birth. */
struct sf_particle {
    SF_FLOAT(x);
    SF_FLOAT(y);
    SF_FLOAT(z);
    SF_FLOAT(radius); /* m, now */
    SF_FLOAT(vx);
    SF_FLOAT(vy);
    SF_FLOAT(vz);
    SF_FLOAT(
        extinction); /* 1/m, now: dilution and fades applied. Methods need nothing else of the life but `life` below */
    SF_FLOAT(age);   /* s */
    SF_FLOAT(lifetime);    /* s; 0: does not die */
    SF_FLOAT(rotation);    /* rad, of the atlas tile, now */
    SF_FLOAT(temperature); /* K above ambient, now */
    SF_FLOAT(radius0);     /* m at birth */
    SF_FLOAT(extinction0); /* 1/m at birth */
    SF_UINT(id);           /* number of its birth, counted over all emitters */
    SF_UINT(look);         /* bits 0-7 atlas tile, 8-15 emitter, bit 16 still, bit 17 its tile turns clockwise */
};

/* 96 bytes; at the start of the counts buffer. Bounds are of the spheres, as order-preserving unsigned floats
 * (glsl/lib/order.glsl); with no particle min is 0xffffffff and max 0. */
struct sf_particle_counts {
    SF_UINT(live);
    SF_UINT(dropped); /* births refused by the capacity, since the start */
    SF_UINT(capacity);
    SF_UINT(step);        /* fixed steps made */
    SF_UVEC4(bounds_min); /* xyz, w unused */
    SF_UVEC4(bounds_max);
    SF_UVEC4(draw);     /* VkDrawIndirectCommand of billboards: 4 vertices (strip), live instances, 0, 0 */
    SF_UVEC4(dispatch); /* VkDispatchIndirectCommand of one thread a particle in groups of 64: x, 1, 1, unused */
    SF_UINT(births);    /* asked for since the start, explicit lists included: live + dropped + deaths */
    SF_UINT(deaths);    /* since the start */
    SF_UINT(survivors); /* of the last step: its births follow them in the list */
    SF_UINT(spare);
};
#define SF_COUNTS_DRAW_OFFSET     48
#define SF_COUNTS_DISPATCH_OFFSET 64
#endif
