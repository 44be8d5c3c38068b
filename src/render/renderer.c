/* Simulation up to a frame, its picture, and what comes back of it.
 *
 * Frame n is at time n/fps, and the simulation takes whole fixed steps: preroll fps substeps + n substeps of them before frame n. So a frame has the
 * same bits however one comes to it. A frame's last steps and its picture are one submit; longer ways go ahead in batches. */
#include "render/renderer.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include "base/log.h"
#include "output/half.h"
#include "shared/particle.h"

/* The public particle is the device's own behind another name: the list is handed out as it comes back. */
_Static_assert(sizeof(struct sf_frame_particle) == sizeof(struct sf_particle), "layout");
_Static_assert(offsetof(struct sf_frame_particle, position) == offsetof(struct sf_particle, x), "layout");
_Static_assert(offsetof(struct sf_frame_particle, radius) == offsetof(struct sf_particle, radius), "layout");
_Static_assert(offsetof(struct sf_frame_particle, velocity) == offsetof(struct sf_particle, vx), "layout");
_Static_assert(offsetof(struct sf_frame_particle, extinction) == offsetof(struct sf_particle, extinction), "layout");
_Static_assert(offsetof(struct sf_frame_particle, age) == offsetof(struct sf_particle, age), "layout");
_Static_assert(offsetof(struct sf_frame_particle, lifetime) == offsetof(struct sf_particle, lifetime), "layout");
_Static_assert(offsetof(struct sf_frame_particle, rotation) == offsetof(struct sf_particle, rotation), "layout");
_Static_assert(offsetof(struct sf_frame_particle, temperature) == offsetof(struct sf_particle, temperature), "layout");
_Static_assert(offsetof(struct sf_frame_particle, birth_radius) == offsetof(struct sf_particle, radius0), "layout");
_Static_assert(offsetof(struct sf_frame_particle, birth_extinction) == offsetof(struct sf_particle, extinction0),
               "layout");
_Static_assert(offsetof(struct sf_frame_particle, id) == offsetof(struct sf_particle, id), "layout");
_Static_assert(offsetof(struct sf_frame_particle, look) == offsetof(struct sf_particle, look), "layout");

enum { BATCH = 16 };

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

/* The host wanted it so, and knows: no error. */
static enum sf_status stopped(const struct sf_renderer *renderer, uint64_t step, uint64_t target)
{
    sf_log(renderer->log, SF_LOG_DEBUG, "the simulation was stopped at step %llu of %llu", (unsigned long long)step,
           (unsigned long long)target);
    return SF_ERROR_INTERRUPTED;
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
            return stopped(renderer, now, target);
        status = sf_frame_begin(gpu);
        if (status)
            return status;
        status = record_steps(renderer, count);
        enum sf_status ended = sf_frame_end(gpu, &serial);
        status = status ? status : ended;
    }
    if (progress && !status && target > start && !progress(user, target - start, target - start))
        return stopped(renderer, target, target);
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

/* How many plays of the frame's graph the picture takes. */
static uint32_t plays_of(const struct sf_renderer *renderer)
{
    const struct sf_method_row *row = renderer->assets.row;

    return row->plays ? row->plays(renderer->scene) : 1;
}

/* What the picture is of; a picture of something else begins anew. */
static void compare_still(struct sf_renderer *renderer, const struct sf_gpu_frame *frame)
{
    struct sf_still *still = &renderer->still;
    uint64_t steps = sf_particles_steps(renderer->particles), shaders = renderer->device->shaders_set;

    if (!still->valid || still->steps != steps || still->shaders_set != shaders ||
        memcmp(&still->frame, frame, sizeof *frame) != 0)
        still->plays = 0;
    *still = (struct sf_still){
        .valid = true, .plays = still->plays, .steps = steps, .shaders_set = shaders, .frame = *frame};
}

/* The next play of the picture. */
static enum sf_status record_picture(struct sf_renderer *renderer, struct sf_queued *queued)
{
    struct sf_assembly *assembly = renderer->stage.assembly;
    struct sf_player *player = renderer->stage.player;
    const struct sf_method_row *row = renderer->assets.row;
    struct sf_gpu_frame *frame = sf_player_upload(player, assembly->method.frame);
    void *objects = sf_player_upload(player, assembly->objects_upload);
    struct sf_gpu_frame filled;
    enum sf_status status;

    if (!frame || !objects)
        return sf_fail(renderer->log, SF_ERROR_MEMORY, "frame %u: no memory for its uploads", queued->number);
    sf_uniforms_fill(renderer->scene, assembly->width, assembly->height, queued->number, queued->time, &filled);
    if (renderer->posed)
        queued->pose = renderer->pose;
    else
        sf_scene_camera(renderer->scene, queued->time, &queued->pose);
    if (renderer->posed)
        sf_uniforms_view(&renderer->pose, assembly->width, assembly->height, &filled);
    sf_shadow_fill(&assembly->drawn.shadow, &filled);
    memcpy(frame, &filled, sizeof filled); /* once: upload memory is slow to read, and writes may be combined */
    memcpy(objects, assembly->drawn.objects, sizeof assembly->drawn.objects);
    sf_matrix_transpose(filled.world_to_view, queued->world_to_camera);
    sf_matrix_transpose(filled.world_to_clip, queued->world_to_clip);
    sf_assembly_set_time(assembly, queued->time);
    compare_still(renderer, &filled);
    assembly->method.play = renderer->still.plays;
    if (row->update)
        row->update(&assembly->method, assembly->state);
    if (renderer->begun)
        sf_player_continue(player);
    status = sf_player_play(player);
    renderer->record_ns += sf_player_record_ns(player);
    renderer->recorded += assembly->plan->pass_count;
    if (!status && renderer->still.plays < plays_of(renderer))
        renderer->still.plays++;
    return status;
}

/* A play of the picture and, before the first, the last steps to it: one submit. */
static enum sf_status play_picture(struct sf_renderer *renderer, uint32_t number)
{
    struct sf_queued *coming = &renderer->coming;
    uint64_t target = steps_at(renderer->scene, number);
    enum sf_status status = sf_frame_begin(renderer->device->gpu), ended;
    bool steps;

    if (status)
        return status;
    if (!renderer->begun || coming->number != number)
        *coming = (struct sf_queued){.number = number, .time = (double)number / renderer->scene->sim.fps};
    steps = sf_particles_steps(renderer->particles) < target;
    status = record_steps(renderer, target - sf_particles_steps(renderer->particles));
    if (!status)
        status = record_picture(renderer, coming);
    renderer->begun = !status;
    ended = sf_frame_end(renderer->device->gpu, &coming->serial);
    status = status ? status : ended;
    if (steps)
        coming->stepped = coming->serial;
    if (status)
        renderer->still.valid = renderer->begun = false;
    else
        renderer->stage.drawn = true;
    return status;
}

enum sf_status sf_renderer_refine(struct sf_renderer *renderer, uint32_t frame, sf_progress_fn progress, void *user)
{
    uint32_t last = plays_of(renderer) - 1, done;
    enum sf_status status = last > 0 ? sf_renderer_seek(renderer, frame, NULL, NULL) : SF_OK;

    if (!renderer->options.progressive)
        renderer->still.valid = false;
    for (done = 0; done < last && !status; done = renderer->still.plays) {
        if (progress && !progress(user, done, last)) {
            sf_log(renderer->log, SF_LOG_DEBUG, "the picture was stopped at %u of %u", done, last + 1);
            return SF_ERROR_INTERRUPTED;
        }
        status = play_picture(renderer, frame);
    }
    if (progress && !status && last > 0 && !progress(user, last, last))
        status = SF_ERROR_INTERRUPTED;
    return status;
}

enum sf_status sf_renderer_render(struct sf_renderer *renderer, uint32_t frame, uint64_t *ticket)
{
    uint32_t plays = plays_of(renderer);
    enum sf_status status = sf_renderer_seek(renderer, frame, NULL, NULL);

    *ticket = 0;
    renderer->record_ns = 0;
    renderer->recorded = 0;
    if (!renderer->options.progressive && !renderer->begun)
        renderer->still.valid = false;
    do {
        status = status ? status : play_picture(renderer, frame);
    } while (!status && !renderer->options.progressive && renderer->still.plays < plays);
    if (status)
        return status;
    renderer->coming.ticket = ++renderer->tickets;
    renderer->coming.progress = (float)renderer->still.plays / (float)plays;
    renderer->queued[renderer->coming.ticket % SF_TICKETS] = renderer->coming;
    renderer->begun = false;
    *ticket = renderer->coming.ticket;
    return SF_OK;
}

float sf_renderer_progress(const struct sf_renderer *renderer)
{
    return renderer->tickets > 0 ? renderer->queued[renderer->tickets % SF_TICKETS].progress : 0;
}

/* NULL, with a message, when its results are gone or it never was. */
static const struct sf_queued *find(const struct sf_renderer *renderer, uint64_t ticket)
{
    bool kept = ticket > 0 && ticket <= renderer->tickets && renderer->tickets - ticket < renderer->options.frames_kept;

    if (kept && ticket > renderer->void_tickets)
        return &renderer->queued[ticket % SF_TICKETS];
    if (kept)
        sf_fail(renderer->log, SF_ERROR_USAGE, "ticket %llu: the renderer's graph was made anew since",
                (unsigned long long)ticket);
    else
        sf_fail(renderer->log, SF_ERROR_USAGE, "ticket %llu: the last frame queued has %llu, and %u are kept",
                (unsigned long long)ticket, (unsigned long long)renderer->tickets, renderer->options.frames_kept);
    return NULL;
}

static const void *read_back(struct sf_renderer *renderer, sf_resource resource, uint64_t serial,
                             enum sf_status *status)
{
    const void *data = resource ? sf_player_readback(renderer->stage.player, resource, serial) : NULL;

    if (resource && !data)
        *status = SF_ERROR_INTERNAL;
    return data;
}

/* The inspected image as floats, once a ticket. */
static enum sf_status convert_inspected(struct sf_renderer *renderer, const struct sf_queued *queued, const void *data,
                                        struct sf_frame *frame)
{
    const struct sf_inspected *inspected = &renderer->stage.assembly->inspected;
    uint32_t slot = (uint32_t)(queued->ticket % renderer->options.frames_kept);
    float **values = &renderer->stage.inspected[slot];

    if (!*values)
        *values = malloc(sf_inspect_values(inspected) * sizeof **values);
    if (!*values)
        return SF_ERROR_MEMORY;
    if (renderer->stage.inspected_ticket[slot] != queued->ticket)
        sf_inspect_convert(inspected, data, *values);
    renderer->stage.inspected_ticket[slot] = queued->ticket;
    frame->inspected = *values;
    frame->inspected_width = inspected->width;
    frame->inspected_height = inspected->height;
    frame->inspected_channels = inspected->channels;
    return SF_OK;
}

static enum sf_status take_inspected(struct sf_renderer *renderer, const struct sf_queued *queued,
                                     struct sf_frame *frame)
{
    const struct sf_inspected *inspected = &renderer->stage.assembly->inspected;
    enum sf_status status = SF_OK;
    const void *data = read_back(renderer, inspected->readback, queued->serial, &status);

    if (!data)
        return status;
    if (inspected->words == 0)
        return convert_inspected(renderer, queued, data, frame);
    frame->inspected_words = data;
    frame->inspected_word_count = inspected->words;
    return SF_OK;
}

/* As the other kind of number, once a ticket; NULL when memory is out. */
static const void *convert_smoke(struct sf_renderer *renderer, const struct sf_queued *queued, const void *data)
{
    const struct sf_assembly *assembly = renderer->stage.assembly;
    uint32_t slot = (uint32_t)(queued->ticket % renderer->options.frames_kept);
    size_t count = (size_t)assembly->width * assembly->height * 4;
    bool to_float = assembly->smoke_format == SF_FORMAT_RGBA16F;
    const uint16_t *halves = data;
    void **values = &renderer->stage.smoke[slot];
    float *floats;

    if (!*values)
        *values = malloc(count * (to_float ? sizeof(float) : sizeof(uint16_t)));
    if (!*values || renderer->stage.smoke_ticket[slot] == queued->ticket)
        return *values;
    floats = *values;
    for (size_t i = 0; i < count && to_float; i++)
        floats[i] = sf_half_to_float(halves[i]);
    if (!to_float)
        sf_half_row(data, sizeof(float), count, *values);
    renderer->stage.smoke_ticket[slot] = queued->ticket;
    return *values;
}

static enum sf_status take_smoke(struct sf_renderer *renderer, const struct sf_queued *queued, struct sf_frame *frame)
{
    const struct sf_assembly *assembly = renderer->stage.assembly;
    enum sf_status status = SF_OK;
    const void *data = read_back(renderer, assembly->read_smoke, queued->serial, &status);

    if (!data)
        return status;
    if ((assembly->smoke_format == SF_FORMAT_RGBA32F) != renderer->options.float_aovs)
        data = convert_smoke(renderer, queued, data);
    if (!data)
        return SF_ERROR_MEMORY;
    if (renderer->options.float_aovs)
        frame->smoke_float = data;
    else
        frame->smoke = data;
    return SF_OK;
}

/* As glsl/lib/order.glsl. */
static float float_from_order(uint32_t order)
{
    uint32_t bits = order & 0x80000000u ? order & 0x7fffffffu : ~order;
    float value;

    memcpy(&value, &bits, sizeof value);
    return value;
}

/* `counts` NULL: they did not come back. */
static void take_counts(const struct sf_particle_counts *counts, struct sf_frame *frame)
{
    bool any = counts && counts->live > 0;

    for (int i = 0; i < 3; i++) {
        frame->bounds_min[i] = any ? float_from_order(counts->bounds_min[i]) : INFINITY;
        frame->bounds_max[i] = any ? float_from_order(counts->bounds_max[i]) : -INFINITY;
    }
    frame->live = counts ? counts->live : 0;
    frame->dropped = counts ? counts->dropped : 0;
}

static void fill_view(const struct sf_camera_pose *pose, struct sf_camera_view *view)
{
    memcpy(view->eye, pose->eye, sizeof view->eye);
    memcpy(view->target, pose->target, sizeof view->target);
    memcpy(view->up, pose->up, sizeof view->up);
    view->fov = pose->fov;
    view->near_clip = pose->near_clip;
}

enum sf_status sf_renderer_wait(struct sf_renderer *renderer, uint64_t ticket, struct sf_frame *frame)
{
    const struct sf_queued *queued = find(renderer, ticket);
    const struct sf_assembly *assembly = renderer->stage.assembly;
    enum sf_status status = queued ? sf_frame_wait(renderer->device->gpu, queued->serial) : SF_ERROR_USAGE;

    memset(frame, 0, sizeof *frame);
    if (status)
        return status;
    frame->frame = queued->number;
    frame->width = assembly->width;
    frame->height = assembly->height;
    frame->time = queued->time;
    fill_view(&queued->pose, &frame->view);
    frame->progress = queued->progress;
    memcpy(frame->world_to_camera, queued->world_to_camera, sizeof frame->world_to_camera);
    memcpy(frame->world_to_clip, queued->world_to_clip, sizeof frame->world_to_clip);
    const void *color = read_back(renderer, assembly->read_color, queued->serial, &status);
    if (assembly->float_color)
        frame->color_float = color;
    else
        frame->color = color;
    frame->depth = read_back(renderer, assembly->read_depth, queued->serial, &status);
    frame->smoke_depths = read_back(renderer, assembly->read_depths, queued->serial, &status);
    frame->particles = read_back(renderer, assembly->read_particles, queued->serial, &status);
    take_counts(read_back(renderer, assembly->read_counts, queued->serial, &status), frame);
    if (!status)
        status = take_smoke(renderer, queued, frame);
    if (!status)
        status = take_inspected(renderer, queued, frame);
    const void *verdict = read_back(renderer, assembly->read_verdict, queued->serial, &status);
    if (!status && verdict && sf_methods[assembly->drawn.scene->method].judge)
        return sf_methods[assembly->drawn.scene->method].judge(&assembly->method, verdict, renderer->log);
    if (status)
        return sf_fail(renderer->log, status, "frame %u: %s", queued->number,
                       status == SF_ERROR_MEMORY ? "out of memory" : "its results are gone");
    return SF_OK;
}

struct sf_gpu_image *sf_renderer_shown(const struct sf_renderer *renderer, uint32_t *width, uint32_t *height,
                                       bool *float_color)
{
    *width = renderer->stage.assembly->width;
    *height = renderer->stage.assembly->height;
    *float_color = renderer->stage.assembly->float_color;
    return renderer->stage.drawn ? renderer->stage.shown : NULL;
}

/* ---- times ---- */

static enum sf_status add_timings(struct sf_renderer *renderer, struct sf_player *player, const struct sf_plan *plan,
                                  uint64_t serial, uint32_t *count)
{
    const struct sf_pass_time *times;
    uint32_t passes;
    enum sf_status status = sf_player_times(player, serial, &times, &passes);

    for (uint32_t i = 0; !status && i < passes && i < plan->pass_count; i++)
        renderer->stage.timings[(*count)++] = (struct sf_pass_timing){.name = times[i].name,
                                                                      .begin_ns = times[i].begin_ns,
                                                                      .end_ns = times[i].end_ns,
                                                                      .bytes_read = plan->passes[i].bytes_read,
                                                                      .bytes_written = plan->passes[i].bytes_written};
    return status;
}

enum sf_status sf_renderer_timings(struct sf_renderer *renderer, uint64_t ticket, const struct sf_pass_timing **timings,
                                   uint32_t *count)
{
    const struct sf_queued *queued = find(renderer, ticket);
    const struct sf_plan *simulation = sf_particles_plan(renderer->particles), *plan = renderer->stage.assembly->plan;
    struct sf_pass_timing *room;
    enum sf_status status = SF_OK;

    *timings = NULL;
    *count = 0;
    if (!queued)
        return SF_ERROR_USAGE;
    if (!renderer->options.timing)
        return sf_fail(renderer->log, SF_ERROR_USAGE, "the renderer was made without timing");
    /* The simulation's passes may be others than the last time. */
    room = realloc(renderer->stage.timings, (simulation->pass_count + plan->pass_count) * sizeof *room);
    if (!room)
        return sf_fail(renderer->log, SF_ERROR_MEMORY, "timings: out of memory");
    renderer->stage.timings = room;
    if (queued->stepped)
        status = add_timings(renderer, sf_particles_player(renderer->particles), simulation, queued->stepped, count);
    if (!status)
        status = add_timings(renderer, renderer->stage.player, plan, queued->serial, count);
    *timings = room;
    return status;
}

uint64_t sf_renderer_record_ns(const struct sf_renderer *renderer, uint32_t *passes)
{
    if (passes)
        *passes = renderer->recorded;
    return renderer->record_ns;
}
