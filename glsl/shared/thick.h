/* Push constants, buffers and limits of thick smoke, for src/methods/thick*.c, src/methods/larsson.c, glsl/thick and
 * glsl/larsson. */
#ifndef SF_SHARED_THICK_H
#define SF_SHARED_THICK_H
#include "types.h"

#define SF_THICK_TILE                                                                                                  \
    16 /* pixels along a tile's edge: the unit in which smoke is listed, blurred, marched; in the smoke's image and in the \
          lights' maps */
#define SF_THICK_BLUR_MAX 24 /* the blur's largest radius in pixels: a tile and its neighbours hold it */
#define SF_THICK_TILES_MAX                                                                                             \
    65000 /* lavapipe ends an invocation's loops after 65,535 turns; the marking of a particle takes one a tile */
#define SF_THICK_TILE_CUT 3u    /* in the mask: smoke, and a surface of the scene before its back. 1: smoke only */
#define SF_THICK_ATLAS    512   /* texels along the detail atlas, a power of two */
#define SF_THICK_TURN     8u    /* lists are padded to a multiple of this; see thick/spheres.glsl */
#define SF_THICK_KEPT     4096u /* words of a workgroup's memory for the spheres that its subgroups keep of their lists */
#define SF_THICK_ALL      0xffffffffu /* for a list's first element: all particles, since the lists' memory was full */

/* Where samples stand along a ray: enum sf_thick_placement. */
#define SF_THICK_PLACEMENT_EQUAL    0u
#define SF_THICK_PLACEMENT_UNIFORM  1u
#define SF_THICK_PLACEMENT_JITTERED 2u

#define SF_THICK_GUIDE 8u /* slices of a ray, at whose ends its optical depth is known */

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
    SF_UINT(capacity);      /* particles; the sphere of that number is an empty one, to pad lists with */
    SF_UINT(list_words);    /* room for the camera's lists, particles */
    SF_UINT(light_list);    /* room for the list of one tile of a light's map, particles */
    SF_UINT(probe);         /* the smoke's pixel that is probed: y * width + x */
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
    SF_UVEC4(dispatch_tiles); /* tiles, 1, 1; live particles (thick only) */
    SF_VEC4(centre);          /* xyz of the smoke's bounds; w: radius of their sphere */
};
#define SF_THICK_DRAW_LIGHT_OFFSET     0
#define SF_THICK_DRAW_TILES_OFFSET     16
#define SF_THICK_DISPATCH_TILES_OFFSET 32

/* A particle as the camera sees it. Its centre is held in radii: the ray along v (unit view depth) crosses it where
 * |centre x v|^2 < v^2, and the share of its diameter that the ray crosses is sqrt(1 - |centre x v|^2 / v^2). */
struct sf_thick_sphere {
    SF_VEC4(ball);   /* xyz: centre (right, up, view depth) over radius; w: radius, m */
    SF_VEC4(matter); /* x: extinction, 1/m; yzw: the ramp's colour at its age */
    SF_VEC4(detail); /* from (x, y) / depth of a ray, over the centre's depth, to the atlas: cosine, sine (texels a
                        radius); the tile's middle, texels */
};
#define SF_THICK_NOWHERE 1.0e8 /* a centre's x and y that no ray meets */
#endif
