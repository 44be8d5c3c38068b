/* What stands in a tile: a density in space, as the camera of the tile sees it. */
#ifndef SF_TEXTURE_BODY_H
#define SF_TEXTURE_BODY_H

#include <stdbool.h>
#include "sfumato/sfumato.h"
#include "texture/field.h"

/* Units: half the tile's shorter side is 1, the origin is its middle, x to the right, y up, z to the viewer. */
struct sf_clone {
    float middle[3], radius;
    float turn[3][3]; /* into the base shape's coordinates, of radius 1 */
    float shade;      /* 0..1 */
    uint32_t moment;  /* which of the fields */
};

enum { SF_BODY_MOMENTS = 8 }; /* clones in a cycle of time are not all at the same moment of it */

struct sf_body {
    struct sf_field fields[SF_BODY_MOMENTS]; /* the first; clones in a cycle take all */
    struct sf_clone *clones;                 /* the nearest first; NULL: noise weighted by the distance to the middle */
    uint32_t clone_count;
    bool repeats;        /* in x and y: weighted by the distance to the plane z = 0 */
    uint32_t columns;    /* of pixels */
    float width, height; /* of the tile */
    float bend[4];       /* phases of waves, where it repeats */
    float pixel;         /* a pixel's side */
    float reach;         /* nothing is farther than this from the middle, or the plane */
    float ragged, soft, mottle;
    float middle;     /* how far inside the middle is where the noise is 0 */
    float extinction; /* of density 1, in 1/unit */
};

/* The body of tile number `tile`, row by row from the top. SF_ERROR_MEMORY without a message. Finish in either case. */
enum sf_status sf_body_init(const struct sf_texture_options *options, uint32_t tile, struct sf_body *body);
void sf_body_finish(struct sf_body *body);

/* What a pixel shows. */
struct sf_body_pixel {
    float alpha;  /* 0..1 */
    float height; /* of what is seen above the plane z = 0, weighted by how much it covers; what lies below, and nothing
                     at all, count as 0 */
    float shade;  /* 0..1, mean of what is seen; 1 where nothing is */
};

/* Looks at the body along a row's lines, from z = +infinity. `list`: room for the body's clones. */
void sf_body_look(const struct sf_body *body, uint32_t row, uint32_t *list, struct sf_body_pixel *pixels);

#endif
