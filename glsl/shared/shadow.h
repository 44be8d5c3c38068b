/* How the exponential shadow maps are drawn: src/light/shadow.c and glsl/light. */
#ifndef SF_SHARED_SHADOW_H
#define SF_SHARED_SHADOW_H
#include "types.h"

/* What a light's cell looks at. The ray of cell point (u, v), -1..1, v down, starts at origin + (perspective ? 0 : u
 * right + v down) and goes along forward + (perspective ? u right + v down : 0); the distance along it, in units of
 * that vector, is the depth t, and the map's depth is d = (t - range.x) range.y, 0..1. */
struct sf_gpu_shadow_cell {
    SF_VEC4(origin);  /* xyz m; w: 1 perspective */
    SF_VEC4(right);   /* xyz; w: half the cell's width in m, or its tangent */
    SF_VEC4(down);    /* xyz, as long as right */
    SF_VEC4(forward); /* xyz unit */
    SF_VEC4(range);   /* x: least depth, m; y: 1 / depth range; z: exponent; w: unused */
};

struct sf_shadow_push {
    SF_UINT(cell); /* px: edge of a cell */
    SF_UINT(cells);
    SF_FLOAT(sigma); /* px */
    SF_UINT(radius); /* px */
};

/* Of a draw of a mesh, for the camera and for the lights. */
struct sf_mesh_push {
    SF_UINT(object); /* in the object list */
    SF_UINT(first_index);
    SF_UINT(first_vertex);
    SF_UINT(cells); /* lights: cells in the map */
};
#endif
