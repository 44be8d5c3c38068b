/* Push constants and limits of thick smoke, for src/methods/thick.c and glsl/thick. */
#ifndef SF_SHARED_THICK_H
#define SF_SHARED_THICK_H
#include "types.h"

#define SF_THICK_TILE                                                                                                  \
    16 /* smoke pixels along a tile's edge: the unit in which the frame is cleared, blurred, marched */
#define SF_THICK_BLUR_MAX 24 /* the blur's largest radius in pixels: a tile and its neighbours hold it */
#define SF_THICK_TILES_MAX                                                                                             \
    65000 /* lavapipe ends an invocation's loops after 65,535 turns; thick/mark.comp takes one a tile */
#define SF_THICK_TILE_CUT 3u  /* in the mask: smoke, and a surface of the scene before its back. 1: smoke only */
#define SF_THICK_ATLAS    512 /* texels along the detail atlas, a power of two */

struct sf_thick_push {
    SF_UINT(width); /* of the smoke's targets, px */
    SF_UINT(height);
    SF_UINT(scale); /* frame pixels per smoke pixel: 1, 2, 4 */
    SF_UINT(tiles_x);
    SF_UINT(tiles_y);
    SF_UINT(reach); /* smoke px that smoke spreads beyond its spheres: the blur's radius when the depth is blurred */
    SF_UINT(cells); /* lights */
    SF_UINT(cell_size); /* px of a light's cell */
    SF_FLOAT(detail);   /* 0..1 */
    SF_FLOAT(detail_scale);
    SF_FLOAT(density_blur); /* 0..1 */
    SF_FLOAT(ambient);
    SF_FLOAT(soft); /* m */
    SF_FLOAT(life_fade);
    SF_FLOAT(light_margin); /* px around the smoke in a light's cell, for the blur */
    SF_FLOAT(thin);         /* optical depth across a particle below which its surfaces recede */
};

struct sf_thick_blur_push {
    SF_UINT(width); /* of the image, px */
    SF_UINT(height);
    SF_UINT(cell);                           /* px: a cell's edge that the blur must not cross; 0: none */
    SF_UINT(tiles_x);                        /* 0: groups in a grid over the image; else from the tile list */
    SF_FLOAT(weight[SF_THICK_BLUR_MAX + 1]); /* of the tap at distance i; they sum to 1 over both sides */
};

/* Written by thick/fit.comp and thick/tiles.comp. */
struct sf_thick_args {
    SF_UVEC4(draw_light);     /* 4 vertices, live x lights instances */
    SF_UVEC4(draw_tiles);     /* 4 vertices, tiles instances */
    SF_UVEC4(dispatch_tiles); /* tiles, 1, 1 */
    SF_VEC4(centre);          /* xyz of the smoke's bounds; w: radius of their sphere */
};
#define SF_THICK_DRAW_LIGHT_OFFSET     0
#define SF_THICK_DRAW_TILES_OFFSET     16
#define SF_THICK_DISPATCH_TILES_OFFSET 32
#endif
