/* Thick smoke with volumetric lighting the thesis's way (Larsson 3.3): one interval a ray, as passes of the frame's graph.
 *
 * The lights' part: fit each light's view to the smoke, draw the particles as imaginary spheres into a map of (near,
 * -far, -, optical depth) by MIN and ADD blending, blur it. The scene's shading reads the map for the smoke's shadow.
 * The camera's part: list the tiles that smoke touches; only there empty the targets, draw the spheres likewise, blur,
 * march from near to far with the lights' maps giving the way to each light, and lay the result over the scene. */
#include "methods/larsson.h"

#include <math.h>
#include "shared/frame.h"
#include "shared/particle.h"

/* Sigma in pixels of the smoke's image. */
static float camera_sigma(const struct sf_scene *scene)
{
    return scene->larsson.blur / (float)sf_thick_scale(scene);
}

void sf_larsson_update(const struct sf_method_frame *frame, void *state)
{
    struct sf_thick *thick = state;
    const struct sf_larsson_settings *settings = &frame->scene->larsson;
    sf_thick_fill(frame, thick);
    thick->push.reach = settings->density_blur > 0 ? sf_thick_blur_radius(camera_sigma(frame->scene)) : 0;
    thick->push.density_blur = settings->density_blur;
    thick->push.soft = settings->soft;
    thick->push.life_fade = settings->life_fade;
    thick->push.thin = settings->thin;
    thick->camera_blur = (struct sf_thick_blur_push){
        .width = thick->push.width, .height = thick->push.height, .tiles_x = thick->push.tiles_x};
    sf_thick_blur_weights(camera_sigma(frame->scene), thick->camera_blur.weight);
}

enum sf_status sf_larsson_light(struct sf_method_frame *frame, void *state, const struct sf_log *log)
{
    (void)log;
    struct sf_thick *thick = state;
    struct sf_graph *graph = frame->graph;
    sf_larsson_update(frame, thick);
    uint32_t width = thick->light_blur.width, height = thick->light_blur.height;

    sf_thick_fit(frame, thick, false);
    sf_resource raw = sf_thick_image(graph, "light.raw", SF_FORMAT_RGBA32F, width, height);
    sf_resource half_way = sf_thick_image(graph, "light.half", SF_FORMAT_RGBA32F, width, height);
    frame->smoke_map = sf_thick_image(graph, "light.map", SF_FORMAT_RGBA32F, width, height);
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
    sf_thick_pass(frame, thick, draw, SF_COUNT(draw),
                  (struct sf_pass_desc){.name = "larsson.light",
                                        .kind = SF_PASS_RASTER,
                                        .shader = "larsson/light.vert",
                                        .fragment = "larsson/light.frag",
                                        .indirect = thick->args,
                                        .indirect_offset = SF_THICK_DRAW_LIGHT_OFFSET,
                                        .raster = {.blend = {SF_BLEND_MIN_ADD}, .triangle_strip = true}});
    frame->smoke_shadows = frame->scene->thick.ground_shadow;
    const sf_resource images[] = {raw, half_way, frame->smoke_map};
    static const char *const names[] = {"larsson.light_blur_x", "larsson.light_blur_y"};
    sf_thick_blur(frame, thick, names, images, false, &thick->light_blur,
                  sf_thick_blur_radius(frame->scene->thick.light_blur));
    return SF_OK;
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
    sf_thick_tile_pass(frame, thick, prepare, SF_COUNT(prepare), false, 0,
                       (struct sf_pass_desc){.name = "larsson.prepare", .fragment = "larsson/prepare.frag"});
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
    sf_thick_pass(frame, thick, uses, SF_COUNT(uses),
                  (struct sf_pass_desc){.name = name,
                                        .kind = SF_PASS_RASTER,
                                        .shader = "larsson/camera.vert",
                                        .fragment = "larsson/camera.frag",
                                        .constants = {frame->scene->thick.detail > 0, cut},
                                        .constant_count = 2,
                                        .indirect = frame->counts,
                                        .indirect_offset = SF_COUNTS_DRAW_OFFSET,
                                        .raster = {.blend = {SF_BLEND_MIN_ADD}, .triangle_strip = true}});
}

static void add_march(struct sf_method_frame *frame, struct sf_thick *thick)
{
    const struct sf_thick_settings *settings = &frame->scene->thick;
    bool positional = sf_thick_positional(frame->scene);
    struct sf_use uses[] = {
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
    struct sf_pass_desc march = {.name = "larsson.march",
                                 .kind = SF_PASS_COMPUTE,
                                 .shader = "larsson/march.comp",
                                 .constants = {(uint32_t)settings->steps, frame->scene->light_count,
                                               settings->scene_shadow, (uint32_t)settings->octaves, positional,
                                               frame->scene->larsson.soft > 0},
                                 .constant_count = 6,
                                 .indirect = thick->args,
                                 .indirect_offset = SF_THICK_DISPATCH_TILES_OFFSET};
    sf_thick_pass(frame, thick, uses, SF_COUNT(uses), march);
    if (!frame->want_probe)
        return;
    march.name = "larsson.probe";
    march.shader = "larsson/probe.comp";
    uses[1].resource = thick->mask; /* whether the pixel's tile is among those listed */
    sf_thick_probe(frame, thick, uses, SF_COUNT(uses), march);
}

enum sf_status sf_larsson_shadow(struct sf_method_frame *frame, struct sf_thick *thick, const struct sf_log *log)
{
    if (frame->scene->thick.ground_shadow && frame->scene->light_count > 0)
        return sf_larsson_light(frame, thick, log);
    sf_thick_fit(frame, thick, false);
    return SF_OK;
}

enum sf_status sf_larsson_view(struct sf_method_frame *frame, void *state, const struct sf_log *log)
{
    struct sf_thick *thick = state;
    struct sf_graph *graph = frame->graph;
    uint32_t width = thick->push.width, height = thick->push.height;
    enum sf_status status = sf_thick_targets(frame, thick, SF_FORMAT_RGBA16F, log);

    if (status)
        return status;
    thick->raw = sf_thick_image(graph, "camera.raw", SF_FORMAT_RGBA32F, width, height);
    static const char *const tile_names[] = {"larsson.mark", "larsson.tiles"};
    sf_thick_tiles(frame, thick, tile_names);
    add_prepare(frame, thick);
    add_camera(frame, thick, "larsson.camera", false);
    add_camera(frame, thick, "larsson.camera_cut", true);
    uint32_t radius = sf_thick_blur_radius(camera_sigma(frame->scene));
    sf_resource half_way = sf_thick_image(graph, "camera.half", SF_FORMAT_RGBA32F, width, height);
    thick->blurred = sf_thick_image(graph, "camera.map", SF_FORMAT_RGBA32F, width, height);
    const sf_resource images[] = {thick->raw, half_way, thick->blurred};
    static const char *const names[] = {"larsson.blur_x", "larsson.blur_y"};
    sf_thick_blur(frame, thick, names, images, true, &thick->camera_blur, radius);
    add_march(frame, thick);
    const struct sf_thick_full over = {.names = {"larsson.over", "larsson.over_plain", "larsson.over_cut"},
                                       .fragment = "larsson/over.frag"};
    const struct sf_thick_full aovs = {
        .names = {"larsson.aovs"},
        .fragment = "larsson/aovs.frag",
        .reads = {{.resource = thick->raw, .access = SF_ACCESS_SAMPLED, .binding = 5},
                  {.resource = thick->blurred, .access = SF_ACCESS_SAMPLED, .binding = 6}},
        .read_count = 2};
    sf_thick_over(frame, thick, &over);
    if (frame->want_aovs)
        sf_thick_aovs(frame, thick, SF_FORMAT_RGBA16F, &aovs);
    return SF_OK;
}
