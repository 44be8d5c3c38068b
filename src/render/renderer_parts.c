/* Making a renderer, and changing it while it runs. What a change needs is made beside what is there; only when all of it
 * stands does it take the place of the old, by steps that cannot fail. */
#include "render/renderer.h"

#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/log.h"
#include "base/suggest.h"
#include "params/params.h"

enum { METHODS_MAX = 64 }; /* that an error lists */

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
static enum sf_status find_shown(const struct sf_renderer *renderer, const struct sf_stage *now, struct sf_stage *stage)
{
    const struct sf_assembly *assembly = stage->assembly, *other = now->assembly;
    sf_resource color = assembly->method.color;
    enum sf_format format = assembly->plan->resources[color - 1].format;
    uint32_t accesses = assembly->plan->resources[color - 1].usage | 1u << SF_ACCESS_SAMPLED;

    if (now->shown && other->width == assembly->width && other->height == assembly->height &&
        other->float_color == assembly->float_color && (accesses & ~now->shown_accesses) == 0) {
        stage->shown = now->shown;
        stage->shown_accesses = now->shown_accesses;
        stage->drawn = now->drawn;
        return SF_OK;
    }
    stage->shown_accesses = accesses;
    return sf_gpu_image_create_target(renderer->device->gpu, "color", format, assembly->width, assembly->height,
                                      accesses, SF_ACCESS_SAMPLED, &stage->shown);
}

/* A stage for that side, beside what it has. Leaves what it has made after a failure: for leave_stage. What is the same
 * for both sides comes back with the first. */
static enum sf_status make_stage(const struct sf_renderer *renderer, uint32_t side, const struct sf_scene *scene,
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
                                               .particles = options->particles && side == 0,
                                               .probe = options->probe,
                                               .inspect = side == 0 ? options->inspect : NULL,
                                               .capacity = (uint32_t)scene->sim.capacity};
    enum sf_status status =
        sf_assembly_create(scene, &wanted, sf_gpu_tuning(gpu), &memory, renderer->log, &stage->assembly);

    if (!status)
        status = sf_player_create(gpu, stage->assembly->plan, &stage->player);
    if (!status && options->shown)
        status = find_shown(renderer, &renderer->sides[side].stage, stage);
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
static void take_stage(struct sf_renderer *renderer, struct sf_side *side, struct sf_stage *stage)
{
    struct sf_stage old = side->stage;

    side->stage = *stage;
    side->still.valid = renderer->begun = false;
    side->void_tickets = renderer->tickets;
    leave_stage(&old, stage);
}

/* ---- all parts together ---- */

static void bind_parts(struct sf_renderer *renderer)
{
    struct sf_player *simulation = sf_particles_player(renderer->particles);

    for (uint32_t i = 0; i < renderer->side_count; i++) {
        const struct sf_side *side = &renderer->sides[i];
        const struct sf_assembly *assembly = side->stage.assembly;
        struct sf_player *player = side->stage.player;

        sf_assets_bind(&side->assets, assembly, player);
        sf_player_bind_buffer(player, assembly->method.particles, sf_particles_list(renderer->particles));
        sf_player_bind_buffer(player, assembly->method.counts, sf_particles_counts(renderer->particles));
        if (side->stage.shown)
            sf_player_bind_image(player, assembly->method.color, side->stage.shown);
    }
    /* As many timers as any options may want: they outlive these. */
    sf_player_set_readback_depth(simulation, SF_FRAMES_KEPT_MAX);
    sf_player_set_timing(simulation, renderer->options.timing);
}

enum sf_status sf_renderer_create(struct sf_device *device, const struct sf_scene *scene,
                                  const struct sf_renderer_options *options, const struct sf_log *log,
                                  struct sf_renderer **out)
{
    struct sf_renderer *renderer = calloc(1, sizeof *renderer);
    struct sf_side *side;
    enum sf_status status;

    *out = NULL;
    if (!renderer)
        return sf_fail(log, SF_ERROR_MEMORY, "renderer: out of memory");
    renderer->device = device;
    renderer->scene = scene;
    renderer->log = log;
    renderer->side_count = 1;
    side = &renderer->sides[0];
    side->scene = scene;
    status = copy_options(renderer, options, &renderer->options);
    renderer->probe[0] = options->width / 2;
    renderer->probe[1] = options->height / 2;
    if (!status)
        status = sf_particles_create(device->gpu, scene, log, &renderer->particles);
    if (!status)
        status = make_stage(renderer, 0, scene, &renderer->options, &side->stage);
    if (!status)
        status = sf_assets_init(device->gpu, &side->stage.assembly->drawn, NULL, log, &side->assets);
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
    sf_renderer_set_beside(renderer, NULL);
    leave_stage(&renderer->sides[0].stage, &none);
    sf_assets_finish(&renderer->sides[0].assets);
    sf_particles_destroy(&renderer->particles);
    free((char *)renderer->options.inspect);
    free(renderer);
    *out = NULL;
}

/* ---- a second method ---- */

static enum sf_status find_method(const char *name, const struct sf_log *log, uint32_t *method)
{
    const char *names[METHODS_MAX], *near;
    struct sf_text text = {0};
    enum sf_status status;

    for (uint32_t i = 0; i < sf_method_count && i < METHODS_MAX; i++) {
        if (strcmp(name, sf_methods[i].name) == 0) {
            *method = i;
            return SF_OK;
        }
        names[i] = sf_methods[i].name;
        sf_text_printf(&text, "%s%s", i > 0 ? ", " : "", names[i]);
    }
    near = sf_suggest(name, names, sf_method_count < METHODS_MAX ? sf_method_count : METHODS_MAX);
    status = sf_fail(log, SF_ERROR_USAGE, "there is no method '%.64s'%s%s%s; there are %s", name,
                     near ? "; did you mean '" : "", near ? near : "", near ? "'?" : "",
                     text.data && !text.failed ? text.data : "others");
    sf_text_finish(&text);
    return status;
}

static enum sf_status copy_scene(const struct sf_renderer *renderer, const struct sf_scene *scene, int32_t method,
                                 struct sf_scene **copy)
{
    *copy = malloc(sizeof **copy);
    if (!*copy)
        return sf_fail(renderer->log, SF_ERROR_MEMORY, "the second method: out of memory");
    **copy = *scene;
    (*copy)->method = method;
    return SF_OK;
}

/* All of the second side that `other` does not have as well. */
static void leave_beside(struct sf_side *side, const struct sf_side *other)
{
    leave_stage(&side->stage, &other->stage);
    sf_assets_leave_method(&side->assets, &other->assets);
    free(side->own);
    *side = (struct sf_side){0};
}

enum sf_status sf_renderer_set_beside(struct sf_renderer *renderer, const char *method)
{
    static const struct sf_assets none;
    static const struct sf_assets_before nothing = {.assets = &none};
    const struct sf_side *first = &renderer->sides[0];
    const struct sf_assets_before before = {
        .assets = &first->assets, .drawn = &first->stage.assembly->drawn, .method = &nothing};
    struct sf_side side = {.void_tickets = renderer->tickets}, old = renderer->sides[1];
    uint32_t number = 0;
    enum sf_status status = method ? find_method(method, renderer->log, &number) : SF_OK;

    if (status || (method && old.own && old.own->method == (int32_t)number) || (!method && !old.own))
        return status;
    if (method) {
        status = copy_scene(renderer, renderer->scene, (int32_t)number, &side.own);
        side.scene = side.own;
        if (!status)
            status = make_stage(renderer, 1, side.scene, &renderer->options, &side.stage);
        if (!status)
            status = sf_assets_init(renderer->device->gpu, &side.stage.assembly->drawn, &before, renderer->log,
                                    &side.assets);
    }
    if (status) {
        leave_beside(&side, &old);
        return status;
    }
    renderer->sides[1] = side;
    renderer->side_count = method ? 2 : 1;
    renderer->begun = false;
    leave_beside(&old, &side);
    bind_parts(renderer);
    return SF_OK;
}

/* ---- changing ---- */

/* Whether a picture of one scene is a picture of the other: `output` is for those who show it. */
static bool same_picture(const struct sf_scene *a, const struct sf_scene *b)
{
    struct sf_scene other = *b;

    other.output = a->output;
    return sf_scene_difference(a, &other) == 0;
}

/* A side as it will be for another scene. */
struct change {
    const struct sf_scene *scene;
    struct sf_scene *own; /* as the side's */
    struct sf_drawn drawn;
    struct sf_assets assets;
    struct sf_stage stage; /* when: */
    bool graph;            /* the old one does not serve */
    bool same;             /* the old picture does */
};

/* `changes`: those of the sides before are made. */
static enum sf_status make_change(const struct sf_renderer *renderer, uint32_t number, const struct sf_scene *scene,
                                  struct change *changes)
{
    const struct sf_side *side = &renderer->sides[number];
    struct change *change = &changes[number];
    enum sf_status status = number > 0 ? copy_scene(renderer, scene, side->scene->method, &change->own) : SF_OK;
    unsigned rebuild;

    if (status)
        return status;
    change->scene = number > 0 ? change->own : scene;
    rebuild = sf_scene_difference(side->scene, change->scene);
    const struct sf_drawn *now = &side->stage.assembly->drawn;
    const struct sf_assets_before mine = {.assets = &side->assets, .drawn = now, .files = rebuild & SF_REBUILD_ASSETS};
    const struct sf_assets_before first = {.assets = &changes[0].assets, .drawn = &changes[0].drawn, .method = &mine};

    sf_drawn_fill(change->scene, &change->drawn);
    change->graph = rebuild & SF_REBUILD_GRAPH || !sf_drawn_alike(now, &change->drawn);
    change->same = same_picture(side->scene, change->scene);
    status = sf_assets_init(renderer->device->gpu, &change->drawn, number > 0 ? &first : &mine, renderer->log,
                            &change->assets);
    if (!status && change->graph)
        status = make_stage(renderer, number, change->scene, &renderer->options, &change->stage);
    return status;
}

/* All that the sides do not have as well: everything stays as it is. */
static void drop_changes(const struct sf_renderer *renderer, struct change changes[SF_SIDES])
{
    for (uint32_t i = renderer->side_count; i-- > 0;) {
        const struct sf_side *side = &renderer->sides[i];

        leave_stage(&changes[i].stage, &side->stage);
        if (i > 0)
            sf_assets_leave_method(&changes[i].assets, &side->assets);
        else
            sf_assets_leave(&changes[i].assets, &side->assets);
        free(changes[i].own);
    }
}

/* In the old one's place; what is left of that becomes the change's. */
static void take_change(struct sf_renderer *renderer, struct sf_side *side, struct change *change)
{
    struct sf_assets assets = side->assets;
    struct sf_scene *own = side->own;

    side->still.valid = side->still.valid && change->same;
    side->scene = change->scene;
    side->own = change->own;
    side->assets = change->assets;
    if (change->graph)
        take_stage(renderer, side, &change->stage);
    else
        sf_assembly_set_scene(side->stage.assembly, &change->drawn);
    change->stage = (struct sf_stage){0};
    change->assets = assets;
    change->own = own;
}

enum sf_status sf_renderer_set_scene(struct sf_renderer *renderer, const struct sf_scene *scene)
{
    unsigned rebuild = sf_scene_difference(renderer->scene, scene);
    struct change changes[SF_SIDES] = {0};
    enum sf_status status = SF_OK;

    for (uint32_t i = 0; i < renderer->side_count && !status; i++)
        status = make_change(renderer, i, scene, changes);
    if (!status && rebuild & SF_REBUILD_SIM)
        status = sf_particles_restart(renderer->particles, scene);
    if (status) {
        drop_changes(renderer, changes);
        return status;
    }
    renderer->scene = scene;
    sf_particles_set_scene(renderer->particles, scene);
    for (uint32_t i = 0; i < renderer->side_count; i++)
        take_change(renderer, &renderer->sides[i], &changes[i]);
    bind_parts(renderer);
    drop_changes(renderer, changes); /* what is left of the old */
    /* The player that timed earlier frames' steps is gone. */
    for (int i = 0; i < SF_TICKETS && rebuild & SF_REBUILD_SIM; i++)
        renderer->queued[i].stepped = 0;
    return SF_OK;
}

enum sf_status sf_renderer_set_options(struct sf_renderer *renderer, const struct sf_renderer_options *options)
{
    struct sf_renderer_options copied;
    struct sf_stage stages[SF_SIDES] = {0};
    enum sf_status status = copy_options(renderer, options, &copied);

    for (uint32_t i = 0; i < renderer->side_count && !status; i++)
        status = make_stage(renderer, i, renderer->sides[i].scene, &copied, &stages[i]);
    if (status) {
        for (uint32_t i = 0; i < renderer->side_count; i++)
            leave_stage(&stages[i], &renderer->sides[i].stage);
        free((char *)copied.inspect);
        return status;
    }
    take_options(renderer, &copied);
    for (uint32_t i = 0; i < renderer->side_count; i++)
        take_stage(renderer, &renderer->sides[i], &stages[i]);
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
