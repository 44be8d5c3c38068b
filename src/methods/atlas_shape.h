/* The scene's atlas as pictures for particles that carry them (METHODS B6, B9, B10): what the detail atlas of thick_parts.h is
 * not, colour and alpha, normals and heights. Each of the first four tiles (of fewer, again from the first) is a layer, so
 * that filtering never reaches into the next.
 *
 * A method of billboards that draws with them declares them in its `view`, takes the sf_atlas_assets_* into its row in
 * place of the sf_thick_assets_*, says in `needs` of atlas_shape.c what it reads, and includes
 * glsl/billboard/picture.glsl. */
#ifndef SF_METHODS_ATLAS_SHAPE_H
#define SF_METHODS_ATLAS_SHAPE_H

#include "methods/method.h"

enum {
    SF_ATLAS_SIDE = 256, /* texels along a layer: tiles are brought to it */
    SF_ATLAS_LAYERS = 4,
};

/* In the frame's graph; images are sampled as sampler2DArray, layer: the particle's tile. */
struct sf_atlas_images {
    sf_resource color; /* "atlas.color", RGBA8: linear R, G, B premultiplied by A; A */
    /* "atlas.shape", RGBA8, whose filtering costs lavapipe a quarter of halves': (n + 1) / 2 of the unit normal to the
     * right, up, to the viewer; height 0..1, of which 1 is half a tile's side above the particle's plane */
    sf_resource shape;
    sf_resource means; /* "atlas.means", uniform: vec4, the mean alpha of each tile */
};
enum { SF_ATLAS_USES = 3 };
/* Their uses by a fragment, at the bindings of glsl/billboard/picture.glsl. */
void sf_atlas_uses(const struct sf_atlas_images *images, struct sf_use uses[SF_ATLAS_USES]);
struct sf_atlas_images sf_atlas_declare(struct sf_graph *graph);

/* For a method's row: these images and the detail atlas. The plain atlas is puffs of noise made from the scene's seed, in
 * little time. SF_ERROR_SCENE names the channel that the scene's file lacks, and the remedy. */
enum sf_status sf_atlas_assets_create(struct sf_gpu *gpu, const struct sf_scene *scene, const struct sf_log *log,
                                      void **assets);
void sf_atlas_assets_destroy(void **assets);
bool sf_atlas_assets_same(const struct sf_scene *a, const struct sf_scene *b);
void sf_atlas_assets_bind(const struct sf_graph *graph, struct sf_player *player, void *assets);

#endif
