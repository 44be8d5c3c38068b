/* What the two methods of thick smoke share, thick.c and larsson.c, and with them those of billboards. */
#ifndef SF_METHODS_THICK_PARTS_H
#define SF_METHODS_THICK_PARTS_H

#include "methods/method.h"
#include "shared/thick.h"

/* A method's memory. Resources are of the frame's graph. */
struct sf_thick {
    struct sf_thick_push push;
    struct sf_thick_blur_push camera_blur, light_blur;
    sf_resource args, smoke, smoke_depth, tiles, mask, atlas;
    sf_resource raw, blurred;                                    /* thick-larsson: the camera's view */
    sf_resource spheres, ranges, list, slices, light_raw, whole; /* thick */
};

static inline uint32_t sf_divide_up(uint32_t a, uint32_t b)
{
    return (a + b - 1) / b;
}

/* Frame pixels for each pixel of the smoke. */
uint32_t sf_thick_scale(const struct sf_scene *scene);
/* The blur reaches 2.5 sigma; what is cut off is 1.2% of the weight. */
uint32_t sf_thick_blur_radius(float sigma);
void sf_thick_blur_weights(float sigma, float weight[SF_THICK_BLUR_MAX + 1]);

/* Fills what both methods need of the push constants and the lights' blur, from the scene's settings. */
void sf_thick_fill(const struct sf_method_frame *frame, struct sf_thick *thick);

/* A pass with the push constants, its uses and the rest as `desc` has them. */
void sf_thick_pass(struct sf_method_frame *frame, const struct sf_thick *thick, const struct sf_use *uses,
                   uint32_t use_count, struct sf_pass_desc desc);
/* A raster pass over the listed tiles, drawn as rectangles by thick/tile.vert: over the smoke's image, each wider by a
 * pixel, or over the frame's (`to_frame`). `choice` as in tile.vert. `desc` has name, fragment shader and blending. */
void sf_thick_tile_pass(struct sf_method_frame *frame, const struct sf_thick *thick, const struct sf_use *uses,
                        uint32_t use_count, bool to_frame, uint32_t choice, struct sf_pass_desc desc);
/* The march of the probed pixel alone, by one group: `march` has name and shader and is else the march's, `uses` are its
 * uses, in which the smoke's image gives way to frame->probe. */
void sf_thick_probe(struct sf_method_frame *frame, const struct sf_thick *thick, struct sf_use *uses,
                    uint32_t use_count, struct sf_pass_desc march);
/* Whether some light stands somewhere, so that its way and strength change along a ray. */
bool sf_thick_positional(const struct sf_scene *scene);
sf_resource sf_thick_image(struct sf_graph *graph, const char *name, enum sf_format format, uint32_t width,
                           uint32_t height);
sf_resource sf_thick_buffer(struct sf_graph *graph, const char *name, uint64_t bytes);

/* Both directions of the blur, images[0] -> images[1] -> images[2]; over the listed tiles when `tiled`, else over the
 * whole. */
void sf_thick_blur(struct sf_method_frame *frame, const struct sf_thick *thick, const char *const names[2],
                   const sf_resource images[3], bool tiled, const struct sf_thick_blur_push *push, uint32_t radius);

/* The first pass of the lights' part: their views, fitted to the smoke; `around`: a light in the smoke looks all around.
 * Makes thick->args and frame->smoke_views. */
void sf_thick_fit(struct sf_method_frame *frame, struct sf_thick *thick, bool around);
/* The first steps of the camera's part: images of the smoke, in `format`, and of the reduced depth, the atlas.
 * SF_ERROR_USAGE: too many tiles. */
enum sf_status sf_thick_targets(struct sf_method_frame *frame, struct sf_thick *thick, enum sf_format format,
                                const struct sf_log *log);
/* Lists the tiles that spheres may touch, in two passes of these names. */
void sf_thick_tiles(struct sf_method_frame *frame, struct sf_thick *thick, const char *const names[2]);
/* Empties the smoke's image where smoke will be, and takes the scene's depth down. */
void sf_thick_prepare(struct sf_method_frame *frame, struct sf_thick *thick, const char *name);
/* What takes the smoke's image up to the frame's pixels: a fragment shader with the bindings of larsson/over.frag. */
enum { SF_THICK_FULL_READS = 2 };
struct sf_thick_full {
    const char *names[3]; /* of the pass; of the two of reduced smoke: where no surface cuts it, and where one may */
    const char *fragment;
    struct sf_use reads[SF_THICK_FULL_READS]; /* beyond those bindings */
    uint32_t read_count;
    uint32_t choice; /* as in tile.vert; other than 0: for all tiles at once */
};
/* Lays the smoke over the frame. */
void sf_thick_over(struct sf_method_frame *frame, const struct sf_thick *thick, const struct sf_thick_full *full);
/* Makes frame->aov_radiance, of that format, and frame->aov_depths, by names[0] alone. */
void sf_thick_aovs(struct sf_method_frame *frame, const struct sf_thick *thick, enum sf_format format,
                   const struct sf_thick_full *full);
/* Fills a buffer of a word a tile with 0. */
void sf_thick_empty(struct sf_method_frame *frame, const struct sf_thick *thick, const char *name, sf_resource buffer);

/* The detail atlas: as the graph has it, and as a device object, see method.h. */
sf_resource sf_thick_atlas_resource(struct sf_graph *graph);
enum sf_status sf_thick_assets_create(struct sf_gpu *gpu, const struct sf_scene *scene, const struct sf_log *log,
                                      void **assets);
void sf_thick_assets_destroy(void **assets);
bool sf_thick_assets_same(const struct sf_scene *a, const struct sf_scene *b);
void sf_thick_assets_bind(const struct sf_graph *graph, struct sf_player *player, void *assets);

/* The 2 x 2 atlas of density detail (L 3.3.6), made of fractal noise that thins out towards each tile's rim.
 * [size][size], 0..255, mean of each tile's disc near 0.6 of its greatest value. `size` is even, at most
 * SF_THICK_ATLAS. The same seed gives the same texels. */
void sf_thick_atlas(uint32_t seed, uint32_t size, unsigned char *texels);
/* The atlas that the scene asks for: that one, or the alpha of the first four tiles of smoke that is made or was read (of
 * fewer, again from the first), each brought to its quarter. */
enum sf_status sf_thick_scene_atlas(const struct sf_scene *scene, uint32_t size, const struct sf_log *log,
                                    unsigned char *texels);

#endif
