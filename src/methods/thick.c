/* Thick smoke with volumetric lighting, as passes of the frame's graph.
 *
 * The lights' part: fit each light's view to the smoke, draw the particles as imaginary spheres into a map of (near,
 * -far, -, optical depth) by MIN and ADD blending, blur it. The scene's shading reads the map for the smoke's shadow.
 * The camera's part: list the tiles that smoke touches; only there empty the targets, draw the spheres likewise, blur,
 * march from near to far with the lights' maps giving the way to each light, and lay the result over the scene. */
#include "methods/thick.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include "shared/frame.h"
#include "shared/particle.h"

_Static_assert(sizeof(struct sf_thick_push) <= SF_PUSH_BYTES_MAX, "push constants");
_Static_assert(sizeof(struct sf_thick_blur_push) <= SF_PUSH_BYTES_MAX, "push constants");
_Static_assert(offsetof(struct sf_particle_counts, draw) == SF_COUNTS_DRAW_OFFSET, "shared layout");
_Static_assert(offsetof(struct sf_particle_counts, dispatch) == SF_COUNTS_DISPATCH_OFFSET, "shared layout");
_Static_assert(offsetof(struct sf_thick_args, draw_tiles) == SF_THICK_DRAW_TILES_OFFSET, "shared layout");
_Static_assert(offsetof(struct sf_thick_args, dispatch_tiles) == SF_THICK_DISPATCH_TILES_OFFSET, "shared layout");

static uint32_t divide_up(uint32_t a, uint32_t b)
{
    return (a + b - 1) / b;
}

/* The blur reaches 2.5 sigma; what is cut off is 1.2% of the weight. */
static uint32_t blur_radius(float sigma)
{
    uint32_t radius = (uint32_t)ceilf(2.5f * sigma);
    return radius < SF_THICK_BLUR_MAX ? radius : SF_THICK_BLUR_MAX;
}

static void blur_weights(float sigma, float weight[SF_THICK_BLUR_MAX + 1])
{
    uint32_t radius = blur_radius(sigma);
    double sum = 0;
    for (uint32_t i = 0; i <= SF_THICK_BLUR_MAX; i++) {
        double x = sigma > 0 ? i / (double)sigma : 0;
        weight[i] = i > radius ? 0.0f : (float)exp(-0.5 * x * x);
        sum += (i == 0 ? 1 : 2) * (double)weight[i];
    }
    for (uint32_t i = 0; i <= radius; i++)
        weight[i] = (float)(weight[i] / sum);
}

static uint32_t scale_of(const struct sf_scene *scene)
{
    return 1u << scene->thick.resolution;
}

/* Sigma in pixels of the smoke's image. */
static float camera_sigma(const struct sf_scene *scene)
{
    return scene->thick.blur / (float)scale_of(scene);
}

void sf_thick_update(const struct sf_method_frame *frame, void *state)
{
    struct sf_thick *thick = state;
    const struct sf_thick_settings *settings = &frame->scene->thick;
    uint32_t scale = scale_of(frame->scene);
    uint32_t width = divide_up(frame->width, scale), height = divide_up(frame->height, scale);
    uint32_t cells = frame->scene->light_count > 0 ? frame->scene->light_count : 1;
    thick->push = (struct sf_thick_push){
        .width = width,
        .height = height,
        .scale = scale,
        .tiles_x = divide_up(width, SF_THICK_TILE),
        .tiles_y = divide_up(height, SF_THICK_TILE),
        .reach = settings->density_blur > 0 ? blur_radius(camera_sigma(frame->scene)) : 0,
        .cells = cells,
        .cell_size = (uint32_t)settings->light_size,
        .detail = settings->detail,
        .detail_scale = settings->detail_scale,
        .density_blur = settings->density_blur,
        .ambient = settings->ambient,
        .soft = settings->soft,
        .life_fade = settings->life_fade,
        .thin = settings->thin,
        .light_margin = (float)blur_radius(settings->light_blur) + 1.0f,
    };
    thick->camera_blur = (struct sf_thick_blur_push){.width = width, .height = height, .tiles_x = thick->push.tiles_x};
    blur_weights(camera_sigma(frame->scene), thick->camera_blur.weight);
    thick->light_blur = (struct sf_thick_blur_push){
        .width = cells * thick->push.cell_size, .height = thick->push.cell_size, .cell = thick->push.cell_size};
    blur_weights(settings->light_blur, thick->light_blur.weight);
}

/* A pass with thick's push constants. Transfers take none. */
static void add_pass(struct sf_method_frame *frame, const struct sf_thick *thick, const struct sf_use *uses,
                     uint32_t use_count, struct sf_pass_desc desc)
{
    desc.uses = uses;
    desc.use_count = use_count;
    if (desc.kind != SF_PASS_TRANSFER) {
        desc.push = &thick->push;
        desc.push_bytes = sizeof thick->push;
    }
    sf_graph_pass(frame->graph, &desc);
}

/* Both directions of the blur, images[0] -> images[1] -> images[2]; over the listed tiles when `tiles` is given, else
 * over the whole. */
static void add_blur(struct sf_method_frame *frame, const struct sf_thick *thick, const char *const names[2],
                     const sf_resource images[3], bool tiled, const struct sf_thick_blur_push *push, uint32_t radius)
{
    for (uint32_t vertical = 0; vertical < 2; vertical++) {
        const struct sf_use uses[] = {
            {.resource = images[vertical], .access = SF_ACCESS_SAMPLED, .binding = 0},
            {.resource = images[vertical + 1], .access = SF_ACCESS_STORAGE_WRITE, .binding = 1},
            {.resource = thick->tiles, .access = SF_ACCESS_STORAGE_READ, .binding = 2},
            {.resource = thick->mask, .access = SF_ACCESS_STORAGE_READ, .binding = 3},
        };
        sf_graph_pass(frame->graph, &(struct sf_pass_desc){
                                        .name = names[vertical],
                                        .kind = SF_PASS_COMPUTE,
                                        .shader = tiled ? "thick/blur_tiles.comp" : "thick/blur.comp",
                                        .uses = uses,
                                        .use_count = tiled ? 4 : 2,
                                        .constants = {vertical, radius},
                                        .constant_count = 2,
                                        .push = push,
                                        .push_bytes = sizeof *push,
                                        .groups = {tiled ? 0 : divide_up(push->width, SF_THICK_TILE),
                                                   tiled ? 0 : divide_up(push->height, SF_THICK_TILE), tiled ? 0 : 1},
                                        .indirect = tiled ? thick->args : 0,
                                        .indirect_offset = SF_THICK_DISPATCH_TILES_OFFSET,
                                    });
    }
}

static sf_resource add_image(struct sf_graph *graph, const char *name, enum sf_format format, uint32_t width,
                             uint32_t height)
{
    return sf_graph_image(graph, &(struct sf_image_desc){.name = name,
                                                         .format = format,
                                                         .lifetime = SF_TRANSIENT,
                                                         .size = {.width = width, .height = height}});
}

static sf_resource add_buffer(struct sf_graph *graph, const char *name, uint64_t bytes)
{
    return sf_graph_buffer(graph, &(struct sf_buffer_desc){.name = name, .lifetime = SF_TRANSIENT, .bytes = bytes});
}

enum sf_status sf_thick_light(struct sf_method_frame *frame, void *state, const struct sf_log *log)
{
    (void)log;
    struct sf_thick *thick = state;
    struct sf_graph *graph = frame->graph;
    sf_thick_update(frame, thick);
    uint32_t width = thick->light_blur.width, height = thick->light_blur.height;

    thick->args = add_buffer(graph, "thick.args", sizeof(struct sf_thick_args));
    frame->smoke_views = add_buffer(graph, "thick.views", SF_FRAME_LIGHTS * sizeof(struct sf_gpu_light_view));
    sf_resource raw = add_image(graph, "light.raw", SF_FORMAT_RGBA32F, width, height);
    sf_resource half_way = add_image(graph, "light.half", SF_FORMAT_RGBA32F, width, height);
    frame->smoke_map = add_image(graph, "light.map", SF_FORMAT_RGBA32F, width, height);

    const struct sf_use fit[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = frame->counts, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = frame->smoke_views, .access = SF_ACCESS_STORAGE_WRITE, .binding = 2},
        {.resource = thick->args, .access = SF_ACCESS_STORAGE_WRITE, .binding = 3},
    };
    add_pass(frame, thick, fit, SF_COUNT(fit),
             (struct sf_pass_desc){
                 .name = "thick.fit", .kind = SF_PASS_COMPUTE, .shader = "thick/fit.comp", .groups = {1, 1, 1}});
    const struct sf_use draw[] = {
        {.resource = frame->particles, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = frame->counts, .access = SF_ACCESS_STORAGE_READ, .binding = 2},
        {.resource = frame->smoke_views, .access = SF_ACCESS_STORAGE_READ, .binding = 3},
        {.resource = raw,
         .access = SF_ACCESS_COLOR,
         .binding = 0,
         .load = SF_LOAD_CLEAR,
         .clear = {SF_DEPTH_FAR, SF_DEPTH_FAR, 1, 0}},
    };
    add_pass(frame, thick, draw, SF_COUNT(draw),
             (struct sf_pass_desc){.name = "thick.light",
                                   .kind = SF_PASS_RASTER,
                                   .shader = "thick/light.vert",
                                   .fragment = "thick/light.frag",
                                   .indirect = thick->args,
                                   .indirect_offset = SF_THICK_DRAW_LIGHT_OFFSET,
                                   .raster = {.blend = {SF_BLEND_MIN_ADD}, .triangle_strip = true}});
    frame->smoke_shadows = frame->scene->thick.ground_shadow;
    const sf_resource images[] = {raw, half_way, frame->smoke_map};
    static const char *const names[] = {"thick.light_blur_x", "thick.light_blur_y"};
    add_blur(frame, thick, names, images, false, &thick->light_blur, blur_radius(frame->scene->thick.light_blur));
    return SF_OK;
}

/* The list of tiles that smoke may touch, in order. */
static void add_tiles(struct sf_method_frame *frame, struct sf_thick *thick)
{
    struct sf_graph *graph = frame->graph;
    uint64_t bytes = 4ull * thick->push.tiles_x * thick->push.tiles_y;
    thick->mask = add_buffer(graph, "thick.mask", bytes);
    thick->tiles = add_buffer(graph, "thick.tile_list", bytes);
    const struct sf_use fill[] = {{.resource = thick->mask, .access = SF_ACCESS_TRANSFER_WRITE}};
    add_pass(frame, thick, fill, SF_COUNT(fill),
             (struct sf_pass_desc){.name = "thick.unmark", .kind = SF_PASS_TRANSFER, .transfer = SF_TRANSFER_FILL});
    const struct sf_use mark[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = frame->particles, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = frame->counts, .access = SF_ACCESS_STORAGE_READ, .binding = 2},
        {.resource = thick->mask, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 3},
    };
    add_pass(frame, thick, mark, SF_COUNT(mark),
             (struct sf_pass_desc){.name = "thick.mark",
                                   .kind = SF_PASS_COMPUTE,
                                   .shader = "thick/mark.comp",
                                   .indirect = frame->counts,
                                   .indirect_offset = SF_COUNTS_DISPATCH_OFFSET});
    const struct sf_use list[] = {
        {.resource = thick->mask, .access = SF_ACCESS_STORAGE_READ, .binding = 0},
        {.resource = thick->tiles, .access = SF_ACCESS_STORAGE_WRITE, .binding = 1},
        {.resource = thick->args, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 2},
    };
    add_pass(frame, thick, list, SF_COUNT(list),
             (struct sf_pass_desc){
                 .name = "thick.tiles", .kind = SF_PASS_COMPUTE, .shader = "thick/tiles.comp", .groups = {1, 1, 1}});
}

/* Empties the targets where smoke will be, and takes the scene's depth down. */
static void add_prepare(struct sf_method_frame *frame, struct sf_thick *thick)
{
    const struct sf_use prepare[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = thick->tiles, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = frame->depth, .access = SF_ACCESS_SAMPLED, .binding = 2},
        {.resource = thick->args, .access = SF_ACCESS_STORAGE_READ, .binding = 7},
        {.resource = thick->mask, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 8},
        {.resource = thick->raw, .access = SF_ACCESS_COLOR, .binding = 0, .load = SF_LOAD_DISCARD},
        {.resource = thick->smoke, .access = SF_ACCESS_COLOR, .binding = 1, .load = SF_LOAD_DISCARD},
        {.resource = thick->smoke_depth, .access = SF_ACCESS_COLOR, .binding = 2, .load = SF_LOAD_DISCARD},
    };
    add_pass(frame, thick, prepare, SF_COUNT(prepare),
             (struct sf_pass_desc){.name = "thick.prepare",
                                   .kind = SF_PASS_RASTER,
                                   .shader = "thick/tile.vert",
                                   .fragment = "thick/prepare.frag",
                                   .constants = {1, 0},
                                   .constant_count = 2,
                                   .indirect = thick->args,
                                   .indirect_offset = SF_THICK_DRAW_TILES_OFFSET,
                                   .raster = {.triangle_strip = true}});
}

/* Draws the spheres that a surface may cut off (`cut`), or the others, into the near/far/life/depth target. */
static void add_camera(struct sf_method_frame *frame, struct sf_thick *thick, const char *name, bool cut)
{
    const struct sf_use uses[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = frame->particles, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = thick->smoke_depth, .access = SF_ACCESS_SAMPLED, .binding = 2},
        {.resource = thick->atlas, .access = SF_ACCESS_SAMPLED, .binding = 3},
        {.resource = thick->mask, .access = SF_ACCESS_STORAGE_READ, .binding = 4},
        {.resource = thick->raw, .access = SF_ACCESS_COLOR, .binding = 0, .load = SF_LOAD_KEEP},
    };
    add_pass(frame, thick, uses, SF_COUNT(uses),
             (struct sf_pass_desc){.name = name,
                                   .kind = SF_PASS_RASTER,
                                   .shader = "thick/camera.vert",
                                   .fragment = "thick/camera.frag",
                                   .constants = {frame->scene->thick.detail > 0, cut},
                                   .constant_count = 2,
                                   .indirect = frame->counts,
                                   .indirect_offset = SF_COUNTS_DRAW_OFFSET,
                                   .raster = {.blend = {SF_BLEND_MIN_ADD}, .triangle_strip = true}});
}

static void add_march(struct sf_method_frame *frame, struct sf_thick *thick)
{
    const struct sf_thick_settings *settings = &frame->scene->thick;
    bool positional = false;
    for (uint32_t i = 0; i < frame->scene->light_count; i++)
        positional |= frame->scene->lights[i].kind != SF_LIGHT_DIRECTIONAL;
    const struct sf_use uses[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = thick->tiles, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = thick->args, .access = SF_ACCESS_UNIFORM, .binding = 2},
        {.resource = frame->smoke_views, .access = SF_ACCESS_UNIFORM, .binding = 3},
        {.resource = thick->raw, .access = SF_ACCESS_SAMPLED, .binding = 4},
        {.resource = thick->blurred, .access = SF_ACCESS_SAMPLED, .binding = 5},
        {.resource = frame->smoke_map, .access = SF_ACCESS_SAMPLED, .binding = 6},
        {.resource = frame->shadow_map, .access = SF_ACCESS_SAMPLED, .binding = 7},
        {.resource = thick->smoke_depth, .access = SF_ACCESS_SAMPLED, .binding = 8},
        {.resource = thick->smoke, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 9},
    };
    add_pass(frame, thick, uses, SF_COUNT(uses),
             (struct sf_pass_desc){.name = "thick.march",
                                   .kind = SF_PASS_COMPUTE,
                                   .shader = "thick/march.comp",
                                   .constants = {(uint32_t)settings->steps, frame->scene->light_count,
                                                 settings->scene_shadow, (uint32_t)settings->octaves, positional,
                                                 settings->soft > 0},
                                   .constant_count = 6,
                                   .indirect = thick->args,
                                   .indirect_offset = SF_THICK_DISPATCH_TILES_OFFSET});
}

/* `choice` as in tile.vert. */
static void add_over(struct sf_method_frame *frame, struct sf_thick *thick, const char *name, uint32_t choice)
{
    const struct sf_use uses[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = thick->tiles, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = thick->smoke, .access = SF_ACCESS_SAMPLED, .binding = 2, .sampler = SF_SAMPLER_LINEAR},
        {.resource = thick->smoke_depth, .access = SF_ACCESS_SAMPLED, .binding = 3},
        {.resource = frame->depth, .access = SF_ACCESS_SAMPLED, .binding = 4},
        {.resource = thick->args, .access = SF_ACCESS_STORAGE_READ, .binding = 7},
        {.resource = thick->mask, .access = SF_ACCESS_STORAGE_READ, .binding = 8},
        {.resource = frame->color, .access = SF_ACCESS_COLOR, .binding = 0, .load = SF_LOAD_KEEP},
    };
    add_pass(frame, thick, uses, SF_COUNT(uses),
             (struct sf_pass_desc){.name = name,
                                   .kind = SF_PASS_RASTER,
                                   .shader = "thick/tile.vert",
                                   .fragment = "thick/over.frag",
                                   .constants = {0, 1, thick->push.scale, choice},
                                   .constant_count = 4,
                                   .indirect = thick->args,
                                   .indirect_offset = SF_THICK_DRAW_TILES_OFFSET,
                                   .raster = {.blend = {SF_BLEND_PREMULTIPLIED}, .triangle_strip = true}});
}

static void add_aovs(struct sf_method_frame *frame, struct sf_thick *thick)
{
    frame->aov_radiance = add_image(frame->graph, "aov.smoke", SF_FORMAT_RGBA16F, frame->width, frame->height);
    frame->aov_depths = add_image(frame->graph, "aov.depths", SF_FORMAT_RGBA32F, frame->width, frame->height);
    const struct sf_use uses[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = thick->tiles, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = thick->smoke, .access = SF_ACCESS_SAMPLED, .binding = 2, .sampler = SF_SAMPLER_LINEAR},
        {.resource = thick->smoke_depth, .access = SF_ACCESS_SAMPLED, .binding = 3},
        {.resource = frame->depth, .access = SF_ACCESS_SAMPLED, .binding = 4},
        {.resource = thick->raw, .access = SF_ACCESS_SAMPLED, .binding = 5},
        {.resource = thick->blurred, .access = SF_ACCESS_SAMPLED, .binding = 6},
        {.resource = thick->args, .access = SF_ACCESS_STORAGE_READ, .binding = 7},
        {.resource = thick->mask, .access = SF_ACCESS_STORAGE_READ, .binding = 8},
        {.resource = frame->aov_radiance, .access = SF_ACCESS_COLOR, .binding = 0, .load = SF_LOAD_CLEAR},
        {.resource = frame->aov_depths,
         .access = SF_ACCESS_COLOR,
         .binding = 1,
         .load = SF_LOAD_CLEAR,
         .clear = {SF_DEPTH_FAR, SF_DEPTH_FAR, 0, 1}},
    };
    add_pass(frame, thick, uses, SF_COUNT(uses),
             (struct sf_pass_desc){.name = "thick.aovs",
                                   .kind = SF_PASS_RASTER,
                                   .shader = "thick/tile.vert",
                                   .fragment = "thick/aovs.frag",
                                   .constants = {0, 1, thick->push.scale},
                                   .constant_count = 3,
                                   .indirect = thick->args,
                                   .indirect_offset = SF_THICK_DRAW_TILES_OFFSET,
                                   .raster = {.triangle_strip = true}});
}

enum sf_status sf_thick_view(struct sf_method_frame *frame, void *state, const struct sf_log *log)
{
    struct sf_thick *thick = state;
    struct sf_graph *graph = frame->graph;
    uint32_t width = thick->push.width, height = thick->push.height;
    if (thick->push.tiles_x * thick->push.tiles_y > SF_THICK_TILES_MAX)
        return sf_fail(log, SF_ERROR_USAGE,
                       "thick: a smoke image of %ux%u has more than %d tiles; lower thick.resolution or the size",
                       width, height, SF_THICK_TILES_MAX);
    thick->raw = add_image(graph, "camera.raw", SF_FORMAT_RGBA32F, width, height);
    thick->smoke = add_image(graph, "smoke", SF_FORMAT_RGBA16F, width, height);
    thick->smoke_depth = add_image(graph, "smoke.scene_depth", SF_FORMAT_R32F, width, height);
    thick->atlas =
        sf_graph_image(graph, &(struct sf_image_desc){.name = "thick.atlas",
                                                      .format = SF_FORMAT_R8_UNORM,
                                                      .lifetime = SF_IMPORTED,
                                                      .size = {.width = SF_THICK_ATLAS, .height = SF_THICK_ATLAS},
                                                      .outside = SF_ACCESS_SAMPLED});
    add_tiles(frame, thick);
    add_prepare(frame, thick);
    add_camera(frame, thick, "thick.camera", false);
    add_camera(frame, thick, "thick.camera_cut", true);
    uint32_t radius = blur_radius(camera_sigma(frame->scene));
    sf_resource half_way = add_image(graph, "camera.half", SF_FORMAT_RGBA32F, width, height);
    thick->blurred = add_image(graph, "camera.map", SF_FORMAT_RGBA32F, width, height);
    const sf_resource images[] = {thick->raw, half_way, thick->blurred};
    static const char *const names[] = {"thick.blur_x", "thick.blur_y"};
    add_blur(frame, thick, names, images, true, &thick->camera_blur, radius);
    add_march(frame, thick);
    if (thick->push.scale > 1) {
        add_over(frame, thick, "thick.over_plain", 1);
        add_over(frame, thick, "thick.over_cut", 2);
    } else {
        add_over(frame, thick, "thick.over", 0);
    }
    if (frame->want_aovs)
        add_aovs(frame, thick);
    return SF_OK;
}

enum sf_status sf_thick_assets_create(struct sf_gpu *gpu, const struct sf_scene *scene, const struct sf_log *log,
                                      void **assets)
{
    unsigned char *texels = malloc((size_t)SF_THICK_ATLAS * SF_THICK_ATLAS);
    if (!texels)
        return sf_fail(log, SF_ERROR_MEMORY, "thick.atlas: out of memory");
    sf_thick_atlas((uint32_t)scene->sim.seed, SF_THICK_ATLAS, texels);
    struct sf_gpu_image *image = NULL;
    enum sf_status status = sf_gpu_image_create(gpu, "thick.atlas", SF_FORMAT_R8_UNORM, SF_THICK_ATLAS, SF_THICK_ATLAS,
                                                1, SF_ACCESS_SAMPLED, texels, &image);
    free(texels);
    *assets = image;
    return status;
}

bool sf_thick_assets_same(const struct sf_scene *a, const struct sf_scene *b)
{
    return a->sim.seed == b->sim.seed;
}

void sf_thick_assets_destroy(void **assets)
{
    if (!assets)
        return;
    struct sf_gpu_image *image = *assets;
    sf_gpu_image_destroy(&image);
    *assets = NULL;
}

void sf_thick_assets_bind(const struct sf_graph *graph, struct sf_player *player, void *assets)
{
    sf_resource atlas = sf_graph_find(graph, "thick.atlas");
    if (atlas)
        sf_player_bind_image(player, atlas, assets);
}
