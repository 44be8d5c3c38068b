/* What the methods of billboards share (METHODS B1-B7, B9, B10): particles sorted back to front, each lit at its centre, drawn as
 * rectangles with premultiplied blending into an image of the smoke's size, which is laid over the scene, both in the tiles alone that smoke touches. A
 * method adds what one fragment of a particle is: struct sf_billboard_look, and a shader. */
#ifndef SF_METHODS_BILLBOARD_H
#define SF_METHODS_BILLBOARD_H

#include "methods/method.h"
#include "methods/thick_parts.h"
#include "shared/billboard.h"
#include "sim/sort.h"

/* A method's memory. */
struct sf_billboards {
    struct sf_thick thick; /* first: the smoke's shadow on the scene is thick-larsson's */
    struct sf_billboard_push push;
    struct sf_sort sort;
    struct sf_sort_tuning sort_tuning;
    sf_resource list; /* storage: struct sf_billboard[], back to front */
};

/* How a method draws one particle. */
struct sf_billboard_look {
    const char *name;     /* of the method's own pass: "hard.draw" */
    const char *fragment; /* includes billboard/particle.glsl */
    bool whole;           /* the rectangle covers the sphere, and not the disc through its centre */
    bool dims_itself; /* the fragment says how light comes through its own particle: `lit` is what others leave, octaves
                             of thick added up */
    /* What the fragment reads beyond that, at bindings from 4 on; specialization constants from id 2 on. */
    const struct sf_use *uses;
    uint32_t use_count;
    uint32_t constants[4];
    uint32_t constant_count;
    enum sf_blend blend; /* 0: premultiplied */
};

/* The callbacks of method.h that do not depend on the look; sf_thick_assets_* are the others. */
enum sf_status sf_billboard_light(struct sf_method_frame *frame, void *state, const struct sf_log *log);
void sf_billboard_update(const struct sf_method_frame *frame, void *state);
/* The passes after the scene's shading, for `view`. */
enum sf_status sf_billboard_view(struct sf_method_frame *frame, void *state, const struct sf_billboard_look *look,
                                 const struct sf_log *log);

#endif
