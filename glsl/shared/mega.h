/* Mega particles (METHODS B8): push constants and buffers, for src/methods/mega.c and glsl/mega. */
#ifndef SF_SHARED_MEGA_H
#define SF_SHARED_MEGA_H
#include "types.h"

/* Follows struct sf_thick_push in the block of push constants. */
struct sf_mega_push {
    SF_FLOAT(amplitude); /* px of the smoke's image for each unit of the noise's x or y */
    SF_FLOAT(limit);     /* px of it: no displacement is longer */
    SF_FLOAT(frequency); /* of the noise: 1/m; over the screen: 1/px of the smoke's image */
    SF_FLOAT(speed);     /* 1/s */
    SF_FLOAT(soft);      /* m */
    SF_FLOAT(diffuse);
    SF_FLOAT(specular);
    SF_FLOAT(shininess);
};

/* A particle as an opaque ball. */
struct sf_mega_ball {
    SF_VEC4(sphere); /* centre in the world, and radius, m; 0: not drawn */
    SF_VEC4(albedo); /* rgb */
};
#endif
