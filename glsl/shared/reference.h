/* Push constants, lists and limits of the method reference, for src/methods/reference.c and glsl/reference. */
#ifndef SF_SHARED_REFERENCE_H
#define SF_SHARED_REFERENCE_H
#include "types.h"

#define SF_REFERENCE_TILE   16 /* pixels along a tile's edge */
#define SF_REFERENCE_SLICES 16 /* of a tile's depth, for the ways to the lights */
#define SF_REFERENCE_KNOTS  16 /* pieces of the map from samples to depths */
#define SF_REFERENCE_ROW    8  /* samples next to each other, which are taken together */
#define SF_REFERENCE_UNROLL 4  /* entries of a list in one turn of a loop */
#define SF_REFERENCE_RUN    64 /* invocations that make a list, each of a run of neighbours */
#define SF_REFERENCE_RAMP   16 /* keys, as SF_RAMP_MAX */

struct sf_reference_push {
    SF_UINT(tiles_x);
    SF_UINT(tiles_y);
    SF_UINT(lists);     /* a tile has: its own, then one for each light and slice */
    SF_UINT(entries);   /* that all lists together may have */
    SF_UINT(slices);    /* used, of SF_REFERENCE_SLICES */
    SF_UINT(samples);   /* of the finished picture */
    SF_UINT(first_row); /* of this play, and how far it is from a row to the next */
    SF_UINT(row_stride);
    SF_UINT(rows);        /* in this play */
    SF_UINT(play);        /* 0: sums begin anew */
    SF_UINT(budget);      /* turns of loops that meshes may take of an invocation */
    SF_FLOAT(ambient);    /* times the environment's */
    SF_UINT(shadow_cell); /* px of a light's cell in the shadow's map */
    SF_UINT(spare0);
    SF_UINT(spare1);
    SF_UINT(spare2);
};

/* A list: `count` entries from `first` on, or SF_REFERENCE_ALL: there was no room, and every particle is in it. */
#define SF_REFERENCE_ALL 0xffffffffu

/* A sphere, from the eye, 32 bytes; nothing where extinction is 0. */
struct sf_reference_sphere {
    SF_VEC4(ball);   /* xyz m; w: radius, m */
    SF_VEC4(matter); /* x: extinction, 1/m; yzw: albedo */
};

/* What came of the lists and the march, for the CPU's judgement. */
struct sf_reference_verdict {
    SF_UINT(used);           /* entries asked for */
    SF_UINT(longest_view);   /* list of a tile */
    SF_UINT(longest_way);    /* list of a way to a light */
    SF_UINT(longest_shadow); /* particles that a square of the shadow's map meets */
    SF_UINT(over);           /* invocations whose meshes took more turns than the budget */
    SF_UINT(spare0);
    SF_UINT(spare1);
    SF_UINT(spare2);
};

/* A box of the hierarchy over the meshes' triangles, in the order of a walk that goes into every one: the next is the following one
 * when the ray crosses it, else `skip`. 32 bytes. */
struct sf_reference_node {
    SF_FLOAT(min_x);
    SF_FLOAT(min_y);
    SF_FLOAT(min_z);
    SF_UINT(skip);
    SF_FLOAT(max_x);
    SF_FLOAT(max_y);
    SF_FLOAT(max_z);
    SF_UINT(leaf); /* first triangle times 8 plus how many; 0: not a leaf */
};
#endif
