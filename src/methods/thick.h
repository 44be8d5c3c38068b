/* Thick smoke with volumetric lighting (Larsson 3.3): the rows of the method table; see method.h. */
#ifndef SF_METHODS_THICK_H
#define SF_METHODS_THICK_H

#include "methods/method.h"
#include "shared/thick.h"

struct sf_thick {
    struct sf_thick_push push;
    struct sf_thick_blur_push camera_blur, light_blur;
    sf_resource args, raw, blurred, smoke, smoke_depth, tiles, mask, atlas;
};

enum sf_status sf_thick_light(struct sf_method_frame *frame, void *state, const struct sf_log *log);
enum sf_status sf_thick_view(struct sf_method_frame *frame, void *state, const struct sf_log *log);
void sf_thick_update(const struct sf_method_frame *frame, void *state);
enum sf_status sf_thick_assets_create(struct sf_gpu *gpu, const struct sf_scene *scene, const struct sf_log *log,
                                      void **assets);
void sf_thick_assets_destroy(void **assets);
bool sf_thick_assets_same(const struct sf_scene *a, const struct sf_scene *b);
void sf_thick_assets_bind(const struct sf_graph *graph, struct sf_player *player, void *assets);

/* The 2 x 2 atlas of density detail (L 3.3.6), made of fractal noise that thins out towards each tile's rim.
 * [size][size], 0..255, mean of each tile's disc near 0.6 of its greatest value. `size` is even, at most
 * SF_THICK_ATLAS. The same seed gives the same texels. */
void sf_thick_atlas(uint32_t seed, uint32_t size, unsigned char *texels);

#endif
