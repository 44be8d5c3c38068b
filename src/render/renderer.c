/* Simulation up to a frame, its picture, and what comes back of it.
 *
 * Frame n is at time n/fps, and the simulation takes whole fixed steps: preroll fps substeps + n substeps of them before frame n. So a frame has the
 * same bits however one comes to it. A frame's last steps and its picture are one submit; longer ways go ahead in batches. */
#include "render/internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/log.h"
#include "render/assemble.h"
#include "render/assets.h"
#include "shared/particle.h"
#include "sim/particles.h"

enum { BATCH = 16, FRAMES_KEPT_MAX = 8, TICKETS = 16 };

/* A frame that was queued. */
struct queued {
    uint64_t ticket, serial;
    uint32_t number;
    double time;
    bool stepped; /* simulation steps went with it */
    float world_to_camera[16], world_to_clip[16];
};

struct sf_renderer {
    struct sf_device *device;
    const struct sf_scene *scene;
    const struct sf_log *log;
    struct sf_renderer_options options;
    struct sf_particles *particles;
    struct sf_assembly *assembly;
    struct sf_assets assets;
    struct sf_player *player;
    struct queued queued[TICKETS];     /* by ticket */
    uint64_t tickets;                  /* given so far */
    float *inspected[FRAMES_KEPT_MAX]; /* by ticket; NULL until the first is asked for */
    uint64_t inspected_ticket[FRAMES_KEPT_MAX];
    struct sf_pass_timing *timings;
    uint64_t record_ns;
    uint32_t recorded; /* passes */
};

/* ---- making ---- */

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
    if (options->frames_kept > FRAMES_KEPT_MAX)
        return sf_fail(log, SF_ERROR_USAGE, "frames_kept is %u; it can be 1 to %d, or 0 for 2", options->frames_kept,
                       FRAMES_KEPT_MAX);
    if (options->inspect && options->no_readback)
        return sf_fail(log, SF_ERROR_USAGE, "inspecting '%s' needs what no_readback leaves out", options->inspect);
    return SF_OK;
}

static enum sf_status create_parts(struct sf_renderer *renderer)
{
    struct sf_gpu *gpu = renderer->device->gpu;
    const struct sf_plan_memory memory = {.needs = sf_gpu_memory_needs, .user = gpu};
    enum sf_status status = sf_particles_create(gpu, renderer->scene, renderer->log, &renderer->particles);

    if (status)
        return status;
    const struct sf_assembly_options options = {.width = renderer->options.width,
                                                .height = renderer->options.height,
                                                .float_color = renderer->options.float_color,
                                                .no_readback = renderer->options.no_readback,
                                                .aovs = renderer->options.aovs,
                                                .inspect = renderer->options.inspect,
                                                .capacity = sf_particles_capacity(renderer->particles)};
    status =
        sf_assembly_create(renderer->scene, &options, sf_gpu_tuning(gpu), &memory, renderer->log, &renderer->assembly);
    if (!status)
        status = sf_assets_init(gpu, renderer->assembly, renderer->log, &renderer->assets);
    if (!status)
        status = sf_player_create(gpu, renderer->assembly->plan, &renderer->player);
    if (status)
        return status;
    sf_assets_bind(&renderer->assets, renderer->assembly, renderer->player);
    sf_player_bind_buffer(renderer->player, renderer->assembly->method.particles,
                          sf_particles_list(renderer->particles));
    sf_player_bind_buffer(renderer->player, renderer->assembly->method.counts,
                          sf_particles_counts(renderer->particles));
    sf_player_set_readback_depth(renderer->player, renderer->options.frames_kept);
    if (renderer->options.timing) {
        sf_player_set_timing(renderer->player, true);
        sf_player_set_timing(sf_particles_player(renderer->particles), true);
        sf_player_set_readback_depth(sf_particles_player(renderer->particles), renderer->options.frames_kept);
    }
    renderer->timings =
        calloc(sf_particles_plan(renderer->particles)->pass_count + renderer->assembly->plan->pass_count,
               sizeof *renderer->timings);
    return renderer->timings ? SF_OK : sf_fail(renderer->log, SF_ERROR_MEMORY, "renderer: out of memory");
}

enum sf_status sf_renderer_create(struct sf_device *device, const struct sf_scene *scene,
                                  const struct sf_renderer_options *options, const struct sf_log *log,
                                  struct sf_renderer **out)
{
    struct sf_renderer *renderer;
    enum sf_status status = check_options(device, options, log);

    *out = NULL;
    if (status)
        return status;
    renderer = calloc(1, sizeof *renderer);
    if (!renderer)
        return sf_fail(log, SF_ERROR_MEMORY, "renderer: out of memory");
    renderer->device = device;
    renderer->scene = scene;
    renderer->log = log;
    renderer->options = *options;
    if (options->frames_kept == 0)
        renderer->options.frames_kept = 2;
    status = create_parts(renderer);
    renderer->options.inspect = NULL; /* the caller's, who may free it now */
    if (status)
        sf_renderer_destroy(&renderer);
    *out = renderer;
    return status;
}

void sf_renderer_destroy(struct sf_renderer **out)
{
    struct sf_renderer *renderer = out ? *out : NULL;

    if (!renderer)
        return;
    sf_player_destroy(&renderer->player);
    sf_assets_finish(&renderer->assets);
    sf_assembly_destroy(&renderer->assembly);
    sf_particles_destroy(&renderer->particles);
    for (int i = 0; i < FRAMES_KEPT_MAX; i++)
        free(renderer->inspected[i]);
    free(renderer->timings);
    free(renderer);
    *out = NULL;
}

/* ---- time ---- */

/* Steps that the simulation has made when frame `number` is drawn. Without emitters nothing ever changes. */
static uint64_t steps_at(const struct sf_scene *scene, uint32_t number)
{
    const struct sf_sim_settings *sim = &scene->sim;
    uint64_t substeps = (uint64_t)sim->substeps;

    if (scene->emitter_count == 0)
        return 0;
    return (uint64_t)llround((double)sim->preroll * sim->fps * sim->substeps) + number * substeps;
}

/* Records `count` steps into the frame in hand. */
static enum sf_status record_steps(struct sf_renderer *renderer, uint64_t count)
{
    enum sf_status status = SF_OK;

    for (uint64_t i = 0; i < count && !status; i++) {
        status = sf_particles_step(renderer->particles);
        renderer->record_ns += sf_player_record_ns(sf_particles_player(renderer->particles));
        renderer->recorded += sf_particles_plan(renderer->particles)->pass_count;
    }
    return status;
}

/* Steps to `target` in batches, each its own submit. */
static enum sf_status advance(struct sf_renderer *renderer, uint64_t target, sf_progress_fn progress, void *user)
{
    struct sf_gpu *gpu = renderer->device->gpu;
    uint64_t start = sf_particles_steps(renderer->particles), now, serial;
    enum sf_status status = SF_OK;

    if (start > target) {
        status = sf_particles_reset(renderer->particles);
        start = 0;
    }
    for (now = start; now < target && !status; now = sf_particles_steps(renderer->particles)) {
        uint64_t count = target - now < BATCH ? target - now : BATCH;
        if (progress && !progress(user, now - start, target - start))
            return sf_fail(renderer->log, SF_ERROR_INTERRUPTED, "the simulation was stopped at step %llu of %llu",
                           (unsigned long long)now, (unsigned long long)target);
        status = sf_frame_begin(gpu);
        if (status)
            return status;
        status = record_steps(renderer, count);
        enum sf_status ended = sf_frame_end(gpu, &serial);
        status = status ? status : ended;
    }
    if (progress && !status && target > start && !progress(user, target - start, target - start))
        return sf_fail(renderer->log, SF_ERROR_INTERRUPTED, "the simulation was stopped");
    return status;
}

/* The last steps are left to the frame itself. */
static uint64_t steps_before(const struct sf_scene *scene, uint32_t number)
{
    uint64_t steps = steps_at(scene, number), substeps = (uint64_t)scene->sim.substeps;

    return steps > substeps ? steps - substeps : 0;
}

enum sf_status sf_renderer_seek(struct sf_renderer *renderer, uint32_t frame, sf_progress_fn progress, void *user)
{
    uint64_t at = sf_particles_steps(renderer->particles);

    /* Already between the frame before and this one. */
    if (at >= steps_before(renderer->scene, frame) && at <= steps_at(renderer->scene, frame))
        return SF_OK;
    return advance(renderer, steps_before(renderer->scene, frame), progress, user);
}

/* ---- frames ---- */

static enum sf_status record_picture(struct sf_renderer *renderer, struct queued *queued)
{
    struct sf_assembly *assembly = renderer->assembly;
    struct sf_player *player = renderer->player;
    const struct sf_method_row *row = renderer->assets.row;
    struct sf_gpu_frame *frame = sf_player_upload(player, assembly->method.frame);
    void *objects = sf_player_upload(player, assembly->objects_upload);
    struct sf_gpu_frame filled;
    enum sf_status status;

    if (!frame || !objects)
        return sf_fail(renderer->log, SF_ERROR_MEMORY, "frame %u: no memory for its uploads", queued->number);
    sf_uniforms_fill(renderer->scene, assembly->width, assembly->height, queued->number, queued->time, &filled);
    sf_shadow_fill(&assembly->shadow, &filled);
    memcpy(frame, &filled, sizeof filled); /* once: upload memory is slow to read, and writes may be combined */
    memcpy(objects, assembly->objects, sizeof assembly->objects);
    sf_matrix_transpose(filled.world_to_view, queued->world_to_camera);
    sf_matrix_transpose(filled.world_to_clip, queued->world_to_clip);
    if (row->update)
        row->update(&assembly->method, assembly->state);
    status = sf_player_play(player);
    renderer->record_ns += sf_player_record_ns(player);
    renderer->recorded += assembly->plan->pass_count;
    return status;
}

enum sf_status sf_renderer_render(struct sf_renderer *renderer, uint32_t frame, uint64_t *ticket)
{
    struct sf_gpu *gpu = renderer->device->gpu;
    struct queued queued = {.number = frame, .time = (double)frame / renderer->scene->sim.fps};
    uint64_t target = steps_at(renderer->scene, frame);
    enum sf_status status = sf_renderer_seek(renderer, frame, NULL, NULL);

    *ticket = 0;
    if (status)
        return status;
    renderer->record_ns = 0;
    renderer->recorded = 0;
    status = sf_frame_begin(gpu);
    if (status)
        return status;
    queued.stepped = sf_particles_steps(renderer->particles) < target;
    status = record_steps(renderer, target - sf_particles_steps(renderer->particles));
    if (!status)
        status = record_picture(renderer, &queued);
    enum sf_status ended = sf_frame_end(gpu, &queued.serial);
    status = status ? status : ended;
    if (status)
        return status;
    queued.ticket = ++renderer->tickets;
    renderer->queued[queued.ticket % TICKETS] = queued;
    *ticket = queued.ticket;
    return SF_OK;
}

/* NULL, with a message, when its results are gone or it never was. */
static const struct queued *find(const struct sf_renderer *renderer, uint64_t ticket)
{
    bool kept = ticket > 0 && ticket <= renderer->tickets && renderer->tickets - ticket < renderer->options.frames_kept;

    if (!kept)
        sf_fail(renderer->log, SF_ERROR_USAGE, "ticket %llu: the last frame queued has %llu, and %u are kept",
                (unsigned long long)ticket, (unsigned long long)renderer->tickets, renderer->options.frames_kept);
    return kept ? &renderer->queued[ticket % TICKETS] : NULL;
}

static const void *read_back(struct sf_renderer *renderer, sf_resource resource, uint64_t serial,
                             enum sf_status *status)
{
    const void *data = resource ? sf_player_readback(renderer->player, resource, serial) : NULL;

    if (resource && !data)
        *status = SF_ERROR_INTERNAL;
    return data;
}

/* The inspected image as floats, once a ticket. */
static enum sf_status convert_inspected(struct sf_renderer *renderer, const struct queued *queued,
                                        struct sf_frame *frame)
{
    const struct sf_inspected *inspected = &renderer->assembly->inspected;
    uint32_t slot = (uint32_t)(queued->ticket % renderer->options.frames_kept);
    enum sf_status status = SF_OK;
    const void *data = read_back(renderer, inspected->readback, queued->serial, &status);

    if (!data)
        return status;
    if (!renderer->inspected[slot])
        renderer->inspected[slot] = malloc(sf_inspect_values(inspected) * sizeof(float));
    if (!renderer->inspected[slot])
        return SF_ERROR_MEMORY;
    if (renderer->inspected_ticket[slot] != queued->ticket)
        sf_inspect_convert(inspected, data, renderer->inspected[slot]);
    renderer->inspected_ticket[slot] = queued->ticket;
    frame->inspected = renderer->inspected[slot];
    frame->inspected_width = inspected->width;
    frame->inspected_height = inspected->height;
    frame->inspected_channels = inspected->channels;
    return SF_OK;
}

enum sf_status sf_renderer_wait(struct sf_renderer *renderer, uint64_t ticket, struct sf_frame *frame)
{
    const struct queued *queued = find(renderer, ticket);
    const struct sf_assembly *assembly = renderer->assembly;
    enum sf_status status = queued ? sf_frame_wait(renderer->device->gpu, queued->serial) : SF_ERROR_USAGE;

    memset(frame, 0, sizeof *frame);
    if (status)
        return status;
    frame->frame = queued->number;
    frame->width = assembly->width;
    frame->height = assembly->height;
    frame->time = queued->time;
    memcpy(frame->world_to_camera, queued->world_to_camera, sizeof frame->world_to_camera);
    memcpy(frame->world_to_clip, queued->world_to_clip, sizeof frame->world_to_clip);
    const void *color = read_back(renderer, assembly->read_color, queued->serial, &status);
    if (assembly->float_color)
        frame->color_float = color;
    else
        frame->color = color;
    frame->depth = read_back(renderer, assembly->read_depth, queued->serial, &status);
    frame->smoke = read_back(renderer, assembly->read_smoke, queued->serial, &status);
    frame->smoke_depths = read_back(renderer, assembly->read_depths, queued->serial, &status);
    const struct sf_particle_counts *counts = read_back(renderer, assembly->read_counts, queued->serial, &status);
    if (counts) {
        frame->live = counts->live;
        frame->dropped = counts->dropped;
    }
    if (!status)
        status = convert_inspected(renderer, queued, frame);
    if (status)
        return sf_fail(renderer->log, status, "frame %u: %s", queued->number,
                       status == SF_ERROR_MEMORY ? "out of memory" : "its results are gone");
    return SF_OK;
}

static enum sf_status add_timings(struct sf_renderer *renderer, struct sf_player *player, const struct sf_plan *plan,
                                  uint64_t serial, uint32_t *count)
{
    const struct sf_pass_time *times;
    uint32_t passes;
    enum sf_status status = sf_player_times(player, serial, &times, &passes);

    for (uint32_t i = 0; !status && i < passes && i < plan->pass_count; i++)
        renderer->timings[(*count)++] = (struct sf_pass_timing){.name = times[i].name,
                                                                .begin_ns = times[i].begin_ns,
                                                                .end_ns = times[i].end_ns,
                                                                .bytes_read = plan->passes[i].bytes_read,
                                                                .bytes_written = plan->passes[i].bytes_written};
    return status;
}

enum sf_status sf_renderer_timings(struct sf_renderer *renderer, uint64_t ticket, const struct sf_pass_timing **timings,
                                   uint32_t *count)
{
    const struct queued *queued = find(renderer, ticket);
    enum sf_status status = SF_OK;

    *timings = renderer->timings;
    *count = 0;
    if (!queued)
        return SF_ERROR_USAGE;
    if (!renderer->options.timing)
        return sf_fail(renderer->log, SF_ERROR_USAGE, "the renderer was made without timing");
    if (queued->stepped)
        status = add_timings(renderer, sf_particles_player(renderer->particles), sf_particles_plan(renderer->particles),
                             queued->serial, count);
    if (!status)
        status = add_timings(renderer, renderer->player, renderer->assembly->plan, queued->serial, count);
    return status;
}

uint64_t sf_renderer_record_ns(const struct sf_renderer *renderer, uint32_t *passes)
{
    if (passes)
        *passes = renderer->recorded;
    return renderer->record_ns;
}
