#include "methods/atlas_shape.h"

#include <stdlib.h>
#include "methods/thick_parts.h"
#include "texture/texels.h"

struct assets {
    void *detail; /* of sf_thick_assets_create */
    struct sf_gpu_image *color, *shape;
    struct sf_gpu_buffer *means;
};

/* Which channels the scene's method reads: bits of enum sf_texture_channels. */
static uint32_t needs(const struct sf_scene *scene)
{
    if (scene->method == SF_METHOD_EXTENT)
        return SF_TEXTURE_ALPHA | (scene->extent.lighting > 0 ? SF_TEXTURE_NORMAL : 0u) |
               (scene->extent.deviation > 0 ? SF_TEXTURE_HEIGHT : 0u);
    if (scene->method == SF_METHOD_LIT)
        return SF_TEXTURE_ALPHA | SF_TEXTURE_NORMAL;
    return SF_TEXTURE_ALPHA | SF_TEXTURE_NORMAL | SF_TEXTURE_HEIGHT;
}

static enum sf_status check_channels(const struct sf_scene *scene, const struct sf_log *log)
{
    static const struct {
        uint32_t channel;
        const char *name;
    } rows[] = {{SF_TEXTURE_ALPHA, "alpha (A)"},
                {SF_TEXTURE_NORMAL, "normals (N.x, N.y, N.z)"},
                {SF_TEXTURE_HEIGHT, "heights (height)"}};
    struct sf_texture_info info;

    if (scene->atlas.kind != SF_ATLAS_FILE)
        return SF_OK;
    sf_texture_describe(scene->atlas.texture, &info);
    for (size_t i = 0; i < SF_COUNT(rows); i++)
        if (needs(scene) & ~info.channels & rows[i].channel)
            return sf_fail(
                log, SF_ERROR_SCENE,
                "%s: /atlas/file: '%s' has no %s, which the method %s reads; 'sfumato texture' writes atlases "
                "with all channels, and the atlas type made needs no file",
                scene->path ? scene->path : "scene", scene->atlas.file, rows[i].name, sf_methods[scene->method].name);
    return SF_OK;
}

/* What is to be made where the scene names no file. */
static enum sf_status make_texture(const struct sf_scene *scene, const struct sf_log *log, struct sf_texture **texture)
{
    struct sf_texture_options options;

    if (scene->atlas.kind == SF_ATLAS_MADE) {
        sf_scene_atlas_options(&scene->atlas, &options);
    } else {
        /* Half as fine as the layers: a fifth of the time, and bulges in the light rather than grain. */
        sf_texture_options_init(&options);
        options.kind = "fbm";
        options.width = options.height = SF_ATLAS_SIDE / 2;
        options.octaves = 3;
        options.scale = 3;
        options.softness = 1.2f;
        options.density = 2; /* opacity nearly in proportion to what the puff is thick */
        options.seed = (uint32_t)scene->sim.seed;
    }
    return sf_texture_create(&options, NULL, NULL, log, texture);
}

static float mean_alpha(const uint8_t *layer)
{
    uint64_t sum = 0;

    for (size_t i = 3; i < (size_t)SF_ATLAS_SIDE * SF_ATLAS_SIDE * 4; i += 4)
        sum += layer[i];
    return (float)((double)sum / (255.0 * SF_ATLAS_SIDE * SF_ATLAS_SIDE));
}

/* Both images of the texture, and the means. */
static enum sf_status upload(struct sf_gpu *gpu, const struct sf_texture *texture, const struct sf_log *log,
                             struct assets *assets)
{
    const size_t layer = (size_t)SF_ATLAS_SIDE * SF_ATLAS_SIDE * 4;
    uint8_t *color = malloc(layer * SF_ATLAS_LAYERS);
    uint8_t *shape = malloc(layer * SF_ATLAS_LAYERS);
    enum sf_status status = color && shape ? SF_OK : sf_fail(log, SF_ERROR_MEMORY, "the atlas: out of memory");
    struct sf_texture_info info;
    float means[SF_ATLAS_LAYERS] = {0};

    sf_texture_describe(texture, &info);
    for (uint32_t i = 0; i < SF_ATLAS_LAYERS && !status; i++) {
        uint32_t tile = i % (info.tiles_x * info.tiles_y);

        sf_texels_rgba8(texture, SF_TEXELS_COLOR, tile, SF_ATLAS_SIDE, color + i * layer);
        sf_texels_rgba8(texture, SF_TEXELS_SHAPE, tile, SF_ATLAS_SIDE, shape + i * layer);
        means[i] = mean_alpha(color + i * layer);
    }
    if (!status)
        status = sf_gpu_image_create(gpu, "atlas.color", SF_FORMAT_RGBA8_UNORM, SF_ATLAS_SIDE, SF_ATLAS_SIDE,
                                     SF_ATLAS_LAYERS, SF_ACCESS_SAMPLED, color, &assets->color);
    if (!status)
        status = sf_gpu_image_create(gpu, "atlas.shape", SF_FORMAT_RGBA8_UNORM, SF_ATLAS_SIDE, SF_ATLAS_SIDE,
                                     SF_ATLAS_LAYERS, SF_ACCESS_SAMPLED, shape, &assets->shape);
    if (!status)
        status =
            sf_gpu_buffer_create(gpu, "atlas.means", sizeof means, false, SF_ACCESS_UNIFORM, means, &assets->means);
    free(color);
    free(shape);
    return status;
}

enum sf_status sf_atlas_assets_create(struct sf_gpu *gpu, const struct sf_scene *scene, const struct sf_log *log,
                                      void **out)
{
    struct assets *assets = calloc(1, sizeof *assets);
    struct sf_texture *made = NULL;
    enum sf_status status;

    *out = assets;
    if (!assets)
        return sf_fail(log, SF_ERROR_MEMORY, "the atlas: out of memory");
    status = check_channels(scene, log);
    if (!status && scene->atlas.kind != SF_ATLAS_FILE)
        status = make_texture(scene, log, &made);
    if (!status)
        status = upload(gpu, made ? made : scene->atlas.texture, log, assets);
    if (!status)
        status = sf_thick_assets_create(gpu, scene, log, &assets->detail);
    sf_texture_destroy(&made);
    if (status)
        sf_atlas_assets_destroy(out);
    return status;
}

void sf_atlas_assets_destroy(void **out)
{
    struct assets *assets = out ? *out : NULL;

    if (!assets)
        return;
    sf_thick_assets_destroy(&assets->detail);
    sf_gpu_image_destroy(&assets->color);
    sf_gpu_image_destroy(&assets->shape);
    sf_gpu_buffer_destroy(&assets->means);
    free(assets);
    *out = NULL;
}

bool sf_atlas_assets_same(const struct sf_scene *a, const struct sf_scene *b)
{
    return sf_thick_assets_same(a, b) && (a->atlas.kind != SF_ATLAS_FILE || needs(a) == needs(b));
}

struct sf_atlas_images sf_atlas_declare(struct sf_graph *graph)
{
    struct sf_image_desc color = {.name = "atlas.color",
                                  .format = SF_FORMAT_RGBA8_UNORM,
                                  .lifetime = SF_IMPORTED,
                                  .size = {.width = SF_ATLAS_SIDE, .height = SF_ATLAS_SIDE},
                                  .layers = SF_ATLAS_LAYERS,
                                  .outside = SF_ACCESS_SAMPLED};
    struct sf_image_desc shape = color;

    shape.name = "atlas.shape";
    return (struct sf_atlas_images){
        .color = sf_graph_image(graph, &color),
        .shape = sf_graph_image(graph, &shape),
        .means = sf_graph_buffer(graph, &(struct sf_buffer_desc){.name = "atlas.means",
                                                                 .lifetime = SF_IMPORTED,
                                                                 .bytes = SF_ATLAS_LAYERS * sizeof(float),
                                                                 .outside = SF_ACCESS_UNIFORM})};
}

void sf_atlas_uses(const struct sf_atlas_images *images, struct sf_use uses[SF_ATLAS_USES])
{
    uses[0] = (struct sf_use){
        .resource = images->color, .access = SF_ACCESS_SAMPLED, .binding = 4, .sampler = SF_SAMPLER_LINEAR};
    uses[1] = (struct sf_use){
        .resource = images->shape, .access = SF_ACCESS_SAMPLED, .binding = 5, .sampler = SF_SAMPLER_LINEAR};
    uses[2] = (struct sf_use){.resource = images->means, .access = SF_ACCESS_UNIFORM, .binding = 6};
}

void sf_atlas_assets_bind(const struct sf_graph *graph, struct sf_player *player, void *data)
{
    const struct assets *assets = data;
    sf_resource color = sf_graph_find(graph, "atlas.color"), shape = sf_graph_find(graph, "atlas.shape"),
                means = sf_graph_find(graph, "atlas.means");

    sf_thick_assets_bind(graph, player, assets->detail);
    if (color)
        sf_player_bind_image(player, color, assets->color);
    if (shape)
        sf_player_bind_image(player, shape, assets->shape);
    if (means)
        sf_player_bind_buffer(player, means, assets->means);
}
