/* What the two methods of thick smoke share. */
#include "methods/thick_parts.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include "shared/frame.h"
#include "shared/particle.h"
#include "shared/probe.h"

_Static_assert(sizeof(struct sf_thick_push) <= SF_PUSH_BYTES_MAX, "push constants");
_Static_assert(sizeof(struct sf_thick_blur_push) <= SF_PUSH_BYTES_MAX, "push constants");
_Static_assert(offsetof(struct sf_particle_counts, draw) == SF_COUNTS_DRAW_OFFSET, "shared layout");
_Static_assert(offsetof(struct sf_particle_counts, dispatch) == SF_COUNTS_DISPATCH_OFFSET, "shared layout");
_Static_assert(offsetof(struct sf_thick_args, draw_tiles) == SF_THICK_DRAW_TILES_OFFSET, "shared layout");
_Static_assert(offsetof(struct sf_thick_args, dispatch_tiles) == SF_THICK_DISPATCH_TILES_OFFSET, "shared layout");

uint32_t sf_thick_scale(const struct sf_scene *scene)
{
    return 1u << scene->thick.resolution;
}

uint32_t sf_thick_blur_radius(float sigma)
{
    uint32_t radius = (uint32_t)ceilf(2.5f * sigma);
    return radius < SF_THICK_BLUR_MAX ? radius : SF_THICK_BLUR_MAX;
}

void sf_thick_blur_weights(float sigma, float weight[SF_THICK_BLUR_MAX + 1])
{
    uint32_t radius = sf_thick_blur_radius(sigma);
    double sum = 0;
    for (uint32_t i = 0; i <= SF_THICK_BLUR_MAX; i++) {
        double x = sigma > 0 ? i / (double)sigma : 0;
        weight[i] = i > radius ? 0.0f : (float)exp(-0.5 * x * x);
        sum += (i == 0 ? 1 : 2) * (double)weight[i];
    }
    for (uint32_t i = 0; i <= radius; i++)
        weight[i] = (float)(weight[i] / sum);
}

void sf_thick_fill(const struct sf_method_frame *frame, struct sf_thick *thick)
{
    const struct sf_thick_settings *settings = &frame->scene->thick;
    uint32_t scale = sf_thick_scale(frame->scene);
    uint32_t width = sf_divide_up(frame->width, scale), height = sf_divide_up(frame->height, scale);
    uint32_t cells = frame->scene->light_count > 0 ? frame->scene->light_count : 1;
    thick->push = (struct sf_thick_push){
        .width = width,
        .height = height,
        .scale = scale,
        .tiles_x = sf_divide_up(width, SF_THICK_TILE),
        .tiles_y = sf_divide_up(height, SF_THICK_TILE),
        .cells = cells,
        .cell_size = (uint32_t)settings->light_size,
        .detail = settings->detail,
        .detail_scale = settings->detail_scale,
        .ambient = settings->ambient,
        .light_margin = (float)sf_thick_blur_radius(settings->light_blur) + 1.0f,
        .capacity = (uint32_t)frame->scene->sim.capacity,
        .probe = frame->probe_at[1] / scale * width + frame->probe_at[0] / scale,
    };
    thick->light_blur = (struct sf_thick_blur_push){
        .width = cells * thick->push.cell_size, .height = thick->push.cell_size, .cell = thick->push.cell_size};
    sf_thick_blur_weights(settings->light_blur, thick->light_blur.weight);
}

void sf_thick_pass(struct sf_method_frame *frame, const struct sf_thick *thick, const struct sf_use *uses,
                   uint32_t use_count, struct sf_pass_desc desc)
{
    desc.uses = uses;
    desc.use_count = use_count;
    desc.push = &thick->push;
    desc.push_bytes = sizeof thick->push;
    sf_graph_pass(frame->graph, &desc);
}

void sf_thick_probe(struct sf_method_frame *frame, const struct sf_thick *thick, struct sf_use *uses,
                    uint32_t use_count, struct sf_pass_desc march)
{
    frame->probe = sf_thick_buffer(frame->graph, "probe", SF_PROBE_BYTES((uint32_t)frame->scene->thick.steps + 1));
    for (uint32_t i = 0; i < use_count; i++)
        if (uses[i].resource == thick->smoke)
            uses[i] = (struct sf_use){
                .resource = frame->probe, .access = SF_ACCESS_STORAGE_WRITE, .binding = uses[i].binding};
    march.indirect = 0;
    march.groups[0] = march.groups[1] = march.groups[2] = 1;
    sf_thick_pass(frame, thick, uses, use_count, march);
}

void sf_thick_blur(struct sf_method_frame *frame, const struct sf_thick *thick, const char *const names[2],
                   const sf_resource images[3], bool tiled, const struct sf_thick_blur_push *push, uint32_t radius)
{
    for (uint32_t vertical = 0; vertical < 2; vertical++) {
        const struct sf_use uses[] = {
            {.resource = images[vertical], .access = SF_ACCESS_SAMPLED, .binding = 0},
            {.resource = images[vertical + 1], .access = SF_ACCESS_STORAGE_WRITE, .binding = 1},
            {.resource = thick->tiles, .access = SF_ACCESS_STORAGE_READ, .binding = 2},
            {.resource = thick->mask, .access = SF_ACCESS_STORAGE_READ, .binding = 3},
        };
        sf_graph_pass(frame->graph,
                      &(struct sf_pass_desc){
                          .name = names[vertical],
                          .kind = SF_PASS_COMPUTE,
                          .shader = tiled ? "larsson/blur_tiles.comp" : "thick/blur.comp",
                          .uses = uses,
                          .use_count = tiled ? 4 : 2,
                          .constants = {vertical, radius},
                          .constant_count = 2,
                          .push = push,
                          .push_bytes = sizeof *push,
                          .groups = {tiled ? 0 : sf_divide_up(push->width, SF_THICK_TILE),
                                     tiled ? 0 : sf_divide_up(push->height, SF_THICK_TILE), tiled ? 0 : 1},
                          .indirect = tiled ? thick->args : 0,
                          .indirect_offset = SF_THICK_DISPATCH_TILES_OFFSET,
                      });
    }
}

void sf_thick_tile_pass(struct sf_method_frame *frame, const struct sf_thick *thick, const struct sf_use *uses,
                        uint32_t use_count, bool to_frame, uint32_t choice, struct sf_pass_desc desc)
{
    desc.kind = SF_PASS_RASTER;
    desc.shader = "thick/tile.vert";
    desc.constants[0] = !to_frame;
    desc.constants[1] = to_frame;
    desc.constants[2] = thick->push.scale;
    desc.constants[3] = choice;
    desc.constant_count = 4;
    desc.indirect = thick->args;
    desc.indirect_offset = SF_THICK_DRAW_TILES_OFFSET;
    desc.raster.triangle_strip = true;
    sf_thick_pass(frame, thick, uses, use_count, desc);
}

bool sf_thick_positional(const struct sf_scene *scene)
{
    bool positional = false;
    for (uint32_t i = 0; i < scene->light_count; i++)
        positional |= scene->lights[i].kind != SF_LIGHT_DIRECTIONAL;
    return positional;
}

sf_resource sf_thick_image(struct sf_graph *graph, const char *name, enum sf_format format, uint32_t width,
                           uint32_t height)
{
    return sf_graph_image(graph, &(struct sf_image_desc){.name = name,
                                                         .format = format,
                                                         .lifetime = SF_TRANSIENT,
                                                         .size = {.width = width, .height = height}});
}

sf_resource sf_thick_buffer(struct sf_graph *graph, const char *name, uint64_t bytes)
{
    return sf_graph_buffer(graph, &(struct sf_buffer_desc){.name = name, .lifetime = SF_TRANSIENT, .bytes = bytes});
}

void sf_thick_empty(struct sf_method_frame *frame, const struct sf_thick *thick, const char *name, sf_resource buffer)
{
    const struct sf_use uses[] = {{.resource = buffer, .access = SF_ACCESS_STORAGE_WRITE, .binding = 0}};
    sf_thick_pass(frame, thick, uses, SF_COUNT(uses),
                  (struct sf_pass_desc){.name = name,
                                        .kind = SF_PASS_COMPUTE,
                                        .shader = "thick/empty.comp",
                                        .groups = {sf_divide_up(thick->push.tiles_x * thick->push.tiles_y, 64), 1, 1}});
}

void sf_thick_fit(struct sf_method_frame *frame, struct sf_thick *thick, bool around)
{
    thick->args = sf_thick_buffer(frame->graph, "thick.args", sizeof(struct sf_thick_args));
    frame->smoke_views =
        sf_thick_buffer(frame->graph, "thick.views", SF_FRAME_LIGHTS * sizeof(struct sf_gpu_light_view));
    const struct sf_use fit[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = frame->counts, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = frame->smoke_views, .access = SF_ACCESS_STORAGE_WRITE, .binding = 2},
        {.resource = thick->args, .access = SF_ACCESS_STORAGE_WRITE, .binding = 3},
    };
    sf_thick_pass(frame, thick, fit, SF_COUNT(fit),
                  (struct sf_pass_desc){.name = "thick.fit",
                                        .kind = SF_PASS_COMPUTE,
                                        .shader = "thick/fit.comp",
                                        .constants = {around},
                                        .constant_count = 1,
                                        .groups = {1, 1, 1}});
}

sf_resource sf_thick_atlas_resource(struct sf_graph *graph)
{
    return sf_graph_image(graph, &(struct sf_image_desc){.name = "thick.atlas",
                                                         .format = SF_FORMAT_R8_UNORM,
                                                         .lifetime = SF_IMPORTED,
                                                         .size = {.width = SF_THICK_ATLAS, .height = SF_THICK_ATLAS},
                                                         .outside = SF_ACCESS_SAMPLED});
}

enum sf_status sf_thick_targets(struct sf_method_frame *frame, struct sf_thick *thick, enum sf_format format,
                                const struct sf_log *log)
{
    struct sf_graph *graph = frame->graph;
    uint32_t width = thick->push.width, height = thick->push.height;
    uint32_t tiles = thick->push.tiles_x * thick->push.tiles_y;
    if (tiles > SF_THICK_TILES_MAX)
        return sf_fail(log, SF_ERROR_USAGE,
                       "%s: a smoke image of %ux%u has more than %d tiles; lower thick.resolution or the size",
                       sf_methods[frame->scene->method].name, width, height, SF_THICK_TILES_MAX);
    thick->smoke = sf_thick_image(graph, "smoke", format, width, height);
    thick->smoke_depth = sf_thick_image(graph, "smoke.scene_depth", SF_FORMAT_R32F, width, height);
    thick->atlas = sf_thick_atlas_resource(graph);
    thick->mask = sf_thick_buffer(graph, "thick.mask", 4ull * tiles);
    thick->tiles = sf_thick_buffer(graph, "thick.tile_list", 4ull * tiles);
    sf_thick_empty(frame, thick, "thick.unmark", thick->mask);
    return SF_OK;
}

void sf_thick_tiles(struct sf_method_frame *frame, struct sf_thick *thick, const char *const names[2])
{
    const struct sf_use mark[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = frame->particles, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = frame->counts, .access = SF_ACCESS_STORAGE_READ, .binding = 2},
        {.resource = thick->mask, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 3},
    };
    sf_thick_pass(frame, thick, mark, SF_COUNT(mark),
                  (struct sf_pass_desc){.name = names[0],
                                        .kind = SF_PASS_COMPUTE,
                                        .shader = "larsson/mark.comp",
                                        .indirect = frame->counts,
                                        .indirect_offset = SF_COUNTS_DISPATCH_OFFSET});
    const struct sf_use list[] = {
        {.resource = thick->mask, .access = SF_ACCESS_STORAGE_READ, .binding = 0},
        {.resource = thick->tiles, .access = SF_ACCESS_STORAGE_WRITE, .binding = 1},
        {.resource = thick->args, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 2},
    };
    sf_thick_pass(frame, thick, list, SF_COUNT(list),
                  (struct sf_pass_desc){
                      .name = names[1], .kind = SF_PASS_COMPUTE, .shader = "larsson/tiles.comp", .groups = {1, 1, 1}});
}

void sf_thick_prepare(struct sf_method_frame *frame, struct sf_thick *thick, const char *name)
{
    const struct sf_use uses[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = thick->tiles, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = frame->depth, .access = SF_ACCESS_SAMPLED, .binding = 2},
        {.resource = thick->args, .access = SF_ACCESS_STORAGE_READ, .binding = 7},
        {.resource = thick->mask, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 8},
        {.resource = thick->smoke, .access = SF_ACCESS_COLOR, .binding = 0, .load = SF_LOAD_DISCARD},
        {.resource = thick->smoke_depth, .access = SF_ACCESS_COLOR, .binding = 1, .load = SF_LOAD_DISCARD},
    };
    sf_thick_tile_pass(frame, thick, uses, SF_COUNT(uses), false, 0,
                       (struct sf_pass_desc){.name = name, .fragment = "thick/prepare.frag"});
}

/* A raster pass over the frame's pixels of the listed tiles. `more`: what it reads beyond the smoke's image and the depths,
 * and its targets. `choice` as in tile.vert. */
static void add_full(struct sf_method_frame *frame, const struct sf_thick *thick, const struct sf_use *more,
                     uint32_t more_count, uint32_t choice, struct sf_pass_desc desc)
{
    struct sf_use uses[7 + SF_THICK_FULL_READS + 2] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = thick->tiles, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = thick->smoke, .access = SF_ACCESS_SAMPLED, .binding = 2, .sampler = SF_SAMPLER_LINEAR},
        {.resource = thick->smoke_depth, .access = SF_ACCESS_SAMPLED, .binding = 3},
        {.resource = frame->depth, .access = SF_ACCESS_SAMPLED, .binding = 4},
        {.resource = thick->args, .access = SF_ACCESS_STORAGE_READ, .binding = 7},
        {.resource = thick->mask, .access = SF_ACCESS_STORAGE_READ, .binding = 8},
    };
    uint32_t count = 7;

    for (uint32_t i = 0; i < more_count; i++)
        uses[count++] = more[i];
    sf_thick_tile_pass(frame, thick, uses, count, true, choice, desc);
}

void sf_thick_over(struct sf_method_frame *frame, const struct sf_thick *thick, const struct sf_thick_full *full)
{
    const char *const *names = full->names;
    struct sf_use uses[SF_THICK_FULL_READS + 1] = {
        {.resource = frame->color, .access = SF_ACCESS_COLOR, .binding = 0, .load = SF_LOAD_KEEP}};
    struct sf_pass_desc desc = {
        .name = names[0], .fragment = full->fragment, .raster = {.blend = {SF_BLEND_PREMULTIPLIED}}};

    for (uint32_t i = 0; i < full->read_count; i++)
        uses[1 + i] = full->reads[i];
    if (thick->push.scale == 1 || full->choice != 0) {
        add_full(frame, thick, uses, 1 + full->read_count, full->choice, desc);
        return;
    }
    for (uint32_t choice = 1; choice < 3; choice++) {
        desc.name = names[choice];
        add_full(frame, thick, uses, 1 + full->read_count, choice, desc);
    }
}

void sf_thick_aovs(struct sf_method_frame *frame, const struct sf_thick *thick, enum sf_format format,
                   const struct sf_thick_full *full)
{
    frame->aov_radiance = sf_thick_image(frame->graph, "aov.smoke", format, frame->width, frame->height);
    frame->aov_depths = sf_thick_image(frame->graph, "aov.depths", SF_FORMAT_RGBA32F, frame->width, frame->height);
    struct sf_use uses[SF_THICK_FULL_READS + 2] = {
        {.resource = frame->aov_radiance, .access = SF_ACCESS_COLOR, .binding = 0, .load = SF_LOAD_CLEAR},
        {.resource = frame->aov_depths,
         .access = SF_ACCESS_COLOR,
         .binding = 1,
         .load = SF_LOAD_CLEAR,
         .clear = {SF_DEPTH_FAR, SF_DEPTH_FAR, 0, 1}},
    };

    for (uint32_t i = 0; i < full->read_count; i++)
        uses[2 + i] = full->reads[i];
    add_full(frame, thick, uses, 2 + full->read_count, full->choice,
             (struct sf_pass_desc){.name = full->names[0], .fragment = full->fragment});
}

enum sf_status sf_thick_assets_create(struct sf_gpu *gpu, const struct sf_scene *scene, const struct sf_log *log,
                                      void **assets)
{
    unsigned char *texels = malloc((size_t)SF_THICK_ATLAS * SF_THICK_ATLAS);
    if (!texels)
        return sf_fail(log, SF_ERROR_MEMORY, "thick.atlas: out of memory");
    struct sf_gpu_image *image = NULL;
    enum sf_status status = sf_thick_scene_atlas(scene, SF_THICK_ATLAS, log, texels);
    if (status == SF_OK)
        status = sf_gpu_image_create(gpu, "thick.atlas", SF_FORMAT_R8_UNORM, SF_THICK_ATLAS, SF_THICK_ATLAS, 1,
                                     SF_ACCESS_SAMPLED, texels, &image);
    free(texels);
    *assets = image;
    return status;
}

bool sf_thick_assets_same(const struct sf_scene *a, const struct sf_scene *b)
{
    const struct sf_atlas *x = &a->atlas, *y = &b->atlas;
    bool same = x->kind == y->kind && x->across == y->across && x->down == y->down && x->hash == y->hash;

    if (x->kind == SF_ATLAS_MADE)
        return same && x->smoke == y->smoke && x->size == y->size && x->seed == y->seed;
    return same && (x->kind == SF_ATLAS_FILE || a->sim.seed == b->sim.seed);
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
