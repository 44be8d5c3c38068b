/* What the methods of billboards share (METHODS B1-B7, B9, B10): for src/methods/billboard.c and glsl/billboard. */
#ifndef SF_SHARED_BILLBOARD_H
#define SF_SHARED_BILLBOARD_H
#include "types.h"

#define SF_BILLBOARD_OCCLUDERS 2048u /* particles, at most, that one particle's light is followed past */

struct sf_billboard_push {
    SF_UINT(width); /* of the smoke's targets, px */
    SF_UINT(height);
    SF_UINT(scale);         /* frame pixels per smoke pixel: 1, 2, 4 */
    SF_FLOAT(density);      /* multiplies the medium's extinction */
    SF_FLOAT(detail);       /* 0..1: what the atlas may take away */
    SF_FLOAT(detail_scale); /* tiles across a particle */
    SF_FLOAT(ambient);
    SF_FLOAT(near_fade); /* radii before the near plane in which a flat billboard fades */
    SF_VEC4(own);        /* the method's settings, as its shader has them */
    SF_VEC4(lit[2]);     /* what lit smoke has beyond that */
};

/* A particle as it is drawn, back to front. A view's coordinates are x right, y up, z view depth. */
struct sf_billboard {
    SF_VEC4(sphere); /* centre, and radius, m */
    SF_VEC4(light);  /* rgb: radiance for each unit of opacity; w: extinction, 1/m, 0 for one that is not to be drawn */
    SF_VEC4(tile);   /* cosine and sine of the tile's turn; the tile's number; life, 1 at birth to 0 */
    SF_VEC4(albedo); /* rgb; w: share of opacity that the near plane leaves of a flat billboard */
    SF_VEC4(lit[2]); /* of lights 0-3 and 4-7: the share that reaches it, by smoke and scene */
};
#endif
