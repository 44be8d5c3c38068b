/* Making a renderer, and changing it while it runs. What a change needs is made beside what is there; only when all of it
 * stands does it take the place of the old, by steps that cannot fail. */
#include "render/renderer.h"

#include <stdlib.h>
#include <string.h>
#include "base/log.h"
#include "params/params.h"

/* ---- the stage ---- */

static enum sf_status check_options(const struct sf_device *device, const struct sf_renderer_options *options,
                                    const struct sf_log *log)
{
    uint32_t limit = sf_gpu_info(device->gpu)->max_image_side;

    if (options->width == 0 || options->height == 0)
        return sf_fail(log, SF_ERROR_USAGE, "a frame of %ux%u has no pixels; width and height are at least 1",
                       options->width, options->height);
    if (options->width > limit || options->height > limit)
        return sf_fail(log, SF_ERROR_USAGE, "a frame of %ux%u is too large: '%s' takes at most %u along a side",
                       options->width, options->height, sf_gpu_info(device->gpu)->name, limit);
    if (options->frames_kept > SF_FRAMES_KEPT_MAX)
        return sf_fail(log, SF_ERROR_USAGE, "frames_kept is %u; it can be 1 to %d, or 0 for 2", options->frames_kept,
                       SF_FRAMES_KEPT_MAX);
    if (options->inspect && options->no_readback)
        return sf_fail(log, SF_ERROR_USAGE, "inspecting '%s' needs what no_readback leaves out", options->inspect);
    if (options->particles && options->no_readback)
        return sf_fail(log, SF_ERROR_USAGE, "the list of particles needs what no_readback leaves out");
    if (options->probe && options->no_readback)
        return sf_fail(log, SF_ERROR_USAGE, "a probe needs what no_readback leaves out");
    return SF_OK;
}

/* Checked, with our own copy of the name. */
static enum sf_status copy_options(const struct sf_renderer *renderer, const struct sf_renderer_options *from,
                                   struct sf_renderer_options *options)
{
    enum sf_status status = check_options(renderer->device, from, renderer->log);

    *options = *from;
    options->inspect = NULL;
    if (status)
        return status;
    if (options->frames_kept == 0)
        options->frames_kept = 2;
    if (from->inspect && !(options->inspect = strdup(from->inspect)))
        return sf_fail(renderer->log, SF_ERROR_MEMORY, "renderer: out of memory");
    return SF_OK;
}

/* The image that the picture is drawn into: the one in use when it serves, so that it can be looked at until the next
 * picture. */
static enum sf_status find_shown(const struct sf_renderer *renderer, struct sf_stage *stage)
{
    const struct sf_assembly *assembly = stage->assembly, *other = renderer->stage.assembly;
    sf_resource color = assembly->method.color;
    enum sf_format format = assembly->plan->resources[color - 1].format;
    uint32_t accesses = assembly->plan->resources[color - 1].usage | 1u << SF_ACCESS_SAMPLED;

    if (renderer->stage.shown && other->width == assembly->width && other->height == assembly->height &&
        other->float_color == assembly->float_color && (accesses & ~renderer->stage.shown_accesses) == 0) {
        stage->shown = renderer->stage.shown;
        stage->shown_accesses = renderer->stage.shown_accesses;
        stage->drawn = renderer->stage.drawn;
        return SF_OK;
    }
    stage->shown_accesses = accesses;
    return sf_gpu_image_create_target(renderer->device->gpu, "color", format, assembly->width, assembly->height,
                                      accesses, SF_ACCESS_SAMPLED, &stage->shown);
}

/* Leaves what it has made after a failure: for leave_stage. */
static enum sf_status make_stage(const struct sf_renderer *renderer, const struct sf_scene *scene,
                                 const struct sf_renderer_options *options, struct sf_stage *stage)
{
    struct sf_gpu *gpu = renderer->device->gpu;
    const struct sf_plan_memory memory = {.needs = sf_gpu_memory_needs, .user = gpu};
    const struct sf_assembly_options wanted = {.width = options->width,
                                               .height = options->height,
                                               .float_color = options->float_color,
                                               .no_readback = options->no_readback,
                                               .shown = options->shown,
                                               .returned = options->returned,
                                               .aovs = options->aovs,
                                               .particles = options->particles,
                                               .probe = options->probe,
                                               .inspect = options->inspect,
                                               .capacity = (uint32_t)scene->sim.capacity};
    enum sf_status status =
        sf_assembly_create(scene, &wanted, sf_gpu_tuning(gpu), &memory, renderer->log, &stage->assembly);

    if (!status)
        status = sf_player_create(gpu, stage->assembly->plan, &stage->player);
    if (!status && options->shown)
        status = find_shown(renderer, stage);
    if (status)
        return status;
    sf_player_set_readback_depth(stage->player, options->frames_kept);
    sf_player_set_timing(stage->player, options->timing);
    return SF_OK;
}

/* The new options in place of the old. The probe stays where it is unless the size is another. */
static void take_options(struct sf_renderer *renderer, const struct sf_renderer_options *options)
{
    if (options->width != renderer->options.width || options->height != renderer->options.height) {
        renderer->probe[0] = options->width / 2;
        renderer->probe[1] = options->height / 2;
    }
    free((char *)renderer->options.inspect);
    renderer->options = *options;
}

/* Destroys it but for what `other` has as well. */
static void leave_stage(struct sf_stage *stage, const struct sf_stage *other)
{
    sf_player_destroy(&stage->player);
    sf_assembly_destroy(&stage->assembly);
    if (stage->shown != other->shown)
        sf_gpu_image_destroy(&stage->shown);
    for (int i = 0; i < SF_FRAMES_KEPT_MAX; i++)
        free(stage->inspected[i]);
    for (int i = 0; i < SF_FRAMES_KEPT_MAX; i++)
        free(stage->smoke[i]);
    free(stage->timings);
    *stage = (struct sf_stage){0};
}

/* The new stage in place of the old. */
static void take_stage(struct sf_renderer *renderer, struct sf_stage *stage)
{
    struct sf_stage old = renderer->stage;

    renderer->stage = *stage;
    renderer->still.valid = renderer->begun = false;
    renderer->void_tickets = renderer->tickets;
    leave_stage(&old, stage);
}

/* ---- all parts together ---- */

static void bind_parts(struct sf_renderer *renderer)
{
    const struct sf_assembly *assembly = renderer->stage.assembly;
    struct sf_player *player = renderer->stage.player, *simulation = sf_particles_player(renderer->particles);

    sf_assets_bind(&renderer->assets, assembly, player);
    sf_player_bind_buffer(player, assembly->method.particles, sf_particles_list(renderer->particles));
    sf_player_bind_buffer(player, assembly->method.counts, sf_particles_counts(renderer->particles));
    if (renderer->stage.shown)
        sf_player_bind_image(player, assembly->method.color, renderer->stage.shown);
    /* As many timers as any options may want: they outlive these. */
    sf_player_set_readback_depth(simulation, SF_FRAMES_KEPT_MAX);
    sf_player_set_timing(simulation, renderer->options.timing);
}

enum sf_status sf_renderer_create(struct sf_device *device, const struct sf_scene *scene,
                                  const struct sf_renderer_options *options, const struct sf_log *log,
                                  struct sf_renderer **out)
{
    struct sf_renderer *renderer = calloc(1, sizeof *renderer);
    enum sf_status status;

    *out = NULL;
    if (!renderer)
        return sf_fail(log, SF_ERROR_MEMORY, "renderer: out of memory");
    renderer->device = device;
    renderer->scene = scene;
    renderer->log = log;
    status = copy_options(renderer, options, &renderer->options);
    renderer->probe[0] = options->width / 2;
    renderer->probe[1] = options->height / 2;
    if (!status)
        status = sf_particles_create(device->gpu, scene, log, &renderer->particles);
    if (!status)
        status = make_stage(renderer, scene, &renderer->options, &renderer->stage);
    if (!status)
        status = sf_assets_init(device->gpu, &renderer->stage.assembly->drawn, NULL, log, &renderer->assets);
    if (!status)
        bind_parts(renderer);
    else
        sf_renderer_destroy(&renderer);
    *out = renderer;
    return status;
}

void sf_renderer_destroy(struct sf_renderer **out)
{
    const struct sf_stage none = {0};
    struct sf_renderer *renderer = out ? *out : NULL;

    if (!renderer)
        return;
    leave_stage(&renderer->stage, &none);
    sf_assets_finish(&renderer->assets);
    sf_particles_destroy(&renderer->particles);
    free((char *)renderer->options.inspect);
    free(renderer);
    *out = NULL;
}

/* ---- changing ---- */

/* Whether a picture of one scene is a picture of the other: `output` is for those who show it. */
static bool same_picture(const struct sf_scene *a, const struct sf_scene *b)
{
    struct sf_scene other = *b;

    other.output = a->output;
    return sf_scene_difference(a, &other) == 0;
}

enum sf_status sf_renderer_set_scene(struct sf_renderer *renderer, const struct sf_scene *scene)
{
    unsigned rebuild = sf_scene_difference(renderer->scene, scene);
    const struct sf_drawn *now = &renderer->stage.assembly->drawn;
    const struct sf_assets_before before = {
        .assets = &renderer->assets, .drawn = now, .files = rebuild & SF_REBUILD_ASSETS};
    struct sf_drawn drawn;
    struct sf_assets assets = {0};
    struct sf_stage stage = {0};
    enum sf_status status;

    sf_drawn_fill(scene, &drawn);
    bool graph = rebuild & SF_REBUILD_GRAPH || !sf_drawn_alike(now, &drawn);
    status = sf_assets_init(renderer->device->gpu, &drawn, &before, renderer->log, &assets);
    if (!status && graph)
        status = make_stage(renderer, scene, &renderer->options, &stage);
    if (!status && rebuild & SF_REBUILD_SIM)
        status = sf_particles_restart(renderer->particles, scene);
    if (status) {
        leave_stage(&stage, &renderer->stage);
        sf_assets_leave(&assets, &renderer->assets);
        return status;
    }
    struct sf_assets old = renderer->assets;
    renderer->still.valid = renderer->still.valid && same_picture(renderer->scene, scene);
    renderer->scene = scene;
    renderer->assets = assets;
    sf_particles_set_scene(renderer->particles, scene);
    if (graph)
        take_stage(renderer, &stage);
    else
        sf_assembly_set_scene(renderer->stage.assembly, &drawn);
    bind_parts(renderer);
    sf_assets_leave(&old, &assets);
    /* The player that timed earlier frames' steps is gone. */
    for (int i = 0; i < SF_TICKETS && rebuild & SF_REBUILD_SIM; i++)
        renderer->queued[i].stepped = 0;
    return SF_OK;
}

enum sf_status sf_renderer_set_options(struct sf_renderer *renderer, const struct sf_renderer_options *options)
{
    struct sf_renderer_options copied;
    struct sf_stage stage = {0};
    enum sf_status status = copy_options(renderer, options, &copied);

    if (!status)
        status = make_stage(renderer, renderer->scene, &copied, &stage);
    if (status) {
        leave_stage(&stage, &renderer->stage);
        free((char *)copied.inspect);
        return status;
    }
    take_options(renderer, &copied);
    take_stage(renderer, &stage);
    bind_parts(renderer);
    return SF_OK;
}

void sf_renderer_set_view(struct sf_renderer *renderer, const struct sf_camera_view *view)
{
    struct sf_camera_pose pose;

    if (!view) {
        renderer->posed = false;
    } else if (sf_pose_from_view(view, &pose)) {
        renderer->posed = true;
        renderer->pose = pose;
    } else {
        sf_log(renderer->log, SF_LOG_WARNING,
               "a view is not taken: its eye is at its target, or a number is out of range");
    }
}

enum sf_status sf_renderer_set_probe(struct sf_renderer *renderer, uint32_t x, uint32_t y)
{
    const struct sf_renderer_options *options = &renderer->options;

    if (!options->probe)
        return sf_fail(renderer->log, SF_ERROR_USAGE, "the renderer was made without probe");
    if (x >= options->width || y >= options->height)
        return sf_fail(renderer->log, SF_ERROR_USAGE, "a frame of %ux%u has no pixel (%u, %u) to probe", options->width,
                       options->height, x, y);
    renderer->probe[0] = x;
    renderer->probe[1] = y;
    return SF_OK;
}
