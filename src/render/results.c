/* What comes back of frames that were queued: pictures, particles, times. */
#include "render/renderer.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include "base/log.h"
#include "output/half.h"
#include "shared/particle.h"
#include "shared/probe.h"

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

_Static_assert(sizeof(struct sf_probe_point) == 4 * SF_PROBE_POINT_WORDS, "layout");
_Static_assert(offsetof(struct sf_probe_point, depth) == 0, "layout");
_Static_assert(offsetof(struct sf_probe_point, transmittance) == 4, "layout");
_Static_assert(offsetof(struct sf_probe_point, radiance) == 8, "layout");

/* What a ticket names: a frame that was queued and one of its sides. */
struct found {
    const struct sf_queued *queued; /* NULL, with a message, when its results are gone or it never was */
    struct sf_side *side;
    uint64_t serial;
};

static struct found find(struct sf_renderer *renderer, uint64_t named)
{
    uint64_t ticket = named & ~SF_BESIDE;
    uint32_t number = named & SF_BESIDE ? 1 : 0;
    const struct sf_queued *queued = &renderer->queued[ticket % SF_TICKETS];
    bool kept = ticket > 0 && ticket <= renderer->tickets && renderer->tickets - ticket < renderer->options.frames_kept;

    if (number >= renderer->side_count)
        sf_fail(renderer->log, SF_ERROR_USAGE, "ticket %llu: no second method draws beside the scene's",
                (unsigned long long)ticket);
    else if (kept && ticket > renderer->sides[number].void_tickets)
        return (struct found){queued, &renderer->sides[number], queued->serials[number]};
    else if (kept)
        sf_fail(renderer->log, SF_ERROR_USAGE, "ticket %llu: the renderer's graph was made anew since",
                (unsigned long long)ticket);
    else
        sf_fail(renderer->log, SF_ERROR_USAGE, "ticket %llu: the last frame queued has %llu, and %u are kept",
                (unsigned long long)ticket, (unsigned long long)renderer->tickets, renderer->options.frames_kept);
    return (struct found){0};
}

static const void *read_back(const struct found *found, sf_resource resource, enum sf_status *status)
{
    const void *data = resource ? sf_player_readback(found->side->stage.player, resource, found->serial) : NULL;

    if (resource && !data)
        *status = SF_ERROR_INTERNAL;
    return data;
}

/* The inspected image as floats, once a ticket. */
static enum sf_status convert_inspected(const struct sf_renderer *renderer, const struct found *found, const void *data,
                                        struct sf_frame *frame)
{
    struct sf_stage *stage = &found->side->stage;
    const struct sf_inspected *inspected = &stage->assembly->inspected;
    uint32_t slot = (uint32_t)(found->queued->ticket % renderer->options.frames_kept);
    float **values = &stage->inspected[slot];

    if (!*values)
        *values = malloc(sf_inspect_values(inspected) * sizeof **values);
    if (!*values)
        return SF_ERROR_MEMORY;
    if (stage->inspected_ticket[slot] != found->queued->ticket)
        sf_inspect_convert(inspected, data, *values);
    stage->inspected_ticket[slot] = found->queued->ticket;
    frame->inspected = *values;
    frame->inspected_width = inspected->width;
    frame->inspected_height = inspected->height;
    frame->inspected_channels = inspected->channels;
    return SF_OK;
}

static enum sf_status take_inspected(const struct sf_renderer *renderer, const struct found *found,
                                     struct sf_frame *frame)
{
    const struct sf_inspected *inspected = &found->side->stage.assembly->inspected;
    enum sf_status status = SF_OK;
    const void *data = read_back(found, inspected->readback, &status);

    if (!data)
        return status;
    if (inspected->words == 0)
        return convert_inspected(renderer, found, data, frame);
    frame->inspected_words = data;
    frame->inspected_word_count = inspected->words;
    return SF_OK;
}

/* The points lie in the buffer as they are handed out. */
static enum sf_status take_probe(const struct found *found, struct sf_frame *frame)
{
    enum sf_status status = SF_OK;
    const uint32_t *words = read_back(found, found->side->stage.assembly->read_probe, &status);

    if (!words)
        return status;
    frame->probe = (const struct sf_probe_point *)(const void *)(words + 1);
    frame->probe_count = words[0];
    memcpy(frame->probe_at, found->queued->probe, sizeof frame->probe_at);
    return SF_OK;
}

/* As the other kind of number, once a ticket; NULL when memory is out. */
static const void *convert_smoke(const struct sf_renderer *renderer, const struct found *found, const void *data)
{
    struct sf_stage *stage = &found->side->stage;
    const struct sf_assembly *assembly = stage->assembly;
    uint32_t slot = (uint32_t)(found->queued->ticket % renderer->options.frames_kept);
    size_t count = (size_t)assembly->width * assembly->height * 4;
    bool to_float = assembly->smoke_format == SF_FORMAT_RGBA16F;
    const uint16_t *halves = data;
    void **values = &stage->smoke[slot];
    float *floats;

    if (!*values)
        *values = malloc(count * (to_float ? sizeof(float) : sizeof(uint16_t)));
    if (!*values || stage->smoke_ticket[slot] == found->queued->ticket)
        return *values;
    floats = *values;
    for (size_t i = 0; i < count && to_float; i++)
        floats[i] = sf_half_to_float(halves[i]);
    if (!to_float)
        sf_half_row(data, sizeof(float), count, *values);
    stage->smoke_ticket[slot] = found->queued->ticket;
    return *values;
}

static enum sf_status take_smoke(const struct sf_renderer *renderer, const struct found *found, struct sf_frame *frame)
{
    const struct sf_assembly *assembly = found->side->stage.assembly;
    enum sf_status status = SF_OK;
    const void *data = read_back(found, assembly->read_smoke, &status);

    if (!data)
        return status;
    if ((assembly->smoke_format == SF_FORMAT_RGBA32F) != renderer->options.float_aovs)
        data = convert_smoke(renderer, found, data);
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
    const struct found found = find(renderer, ticket);
    const struct sf_queued *queued = found.queued;
    enum sf_status status = queued ? sf_frame_wait(renderer->device->gpu, found.serial) : SF_ERROR_USAGE;

    memset(frame, 0, sizeof *frame);
    if (status)
        return status;
    const struct sf_assembly *assembly = found.side->stage.assembly;
    frame->frame = queued->number;
    frame->width = assembly->width;
    frame->height = assembly->height;
    frame->time = queued->time;
    fill_view(&queued->pose, &frame->view);
    frame->progress = queued->progress[found.side - renderer->sides];
    memcpy(frame->world_to_camera, queued->world_to_camera, sizeof frame->world_to_camera);
    memcpy(frame->world_to_clip, queued->world_to_clip, sizeof frame->world_to_clip);
    const void *color = read_back(&found, assembly->read_color, &status);
    if (assembly->float_color)
        frame->color_float = color;
    else
        frame->color = color;
    frame->depth = read_back(&found, assembly->read_depth, &status);
    frame->smoke_depths = read_back(&found, assembly->read_depths, &status);
    frame->particles = read_back(&found, assembly->read_particles, &status);
    take_counts(read_back(&found, assembly->read_counts, &status), frame);
    if (!status)
        status = take_smoke(renderer, &found, frame);
    if (!status)
        status = take_inspected(renderer, &found, frame);
    if (!status)
        status = take_probe(&found, frame);
    const void *verdict = read_back(&found, assembly->read_verdict, &status);
    if (!status && verdict && found.side->assets.row->judge)
        return found.side->assets.row->judge(&assembly->method, verdict, renderer->log);
    if (status)
        return sf_fail(renderer->log, status, "frame %u: %s", queued->number,
                       status == SF_ERROR_MEMORY ? "out of memory" : "its results are gone");
    return SF_OK;
}

struct sf_gpu_image *sf_renderer_shown(const struct sf_renderer *renderer, uint32_t *width, uint32_t *height,
                                       bool *float_color)
{
    const struct sf_stage *stage = &renderer->sides[0].stage;

    *width = stage->assembly->width;
    *height = stage->assembly->height;
    *float_color = stage->assembly->float_color;
    return stage->drawn ? stage->shown : NULL;
}

struct sf_gpu_image *sf_renderer_shown_beside(const struct sf_renderer *renderer)
{
    const struct sf_stage *stage = &renderer->sides[1].stage;

    return stage->drawn ? stage->shown : NULL;
}

/* ---- times ---- */

static enum sf_status add_timings(struct sf_pass_timing *to, struct sf_player *player, const struct sf_plan *plan,
                                  uint64_t serial, uint32_t *count)
{
    const struct sf_pass_time *times;
    uint32_t passes;
    enum sf_status status = sf_player_times(player, serial, &times, &passes);

    for (uint32_t i = 0; !status && i < passes && i < plan->pass_count; i++)
        to[(*count)++] = (struct sf_pass_timing){.name = times[i].name,
                                                 .begin_ns = times[i].begin_ns,
                                                 .end_ns = times[i].end_ns,
                                                 .bytes_read = plan->passes[i].bytes_read,
                                                 .bytes_written = plan->passes[i].bytes_written};
    return status;
}

enum sf_status sf_renderer_timings(struct sf_renderer *renderer, uint64_t ticket, const struct sf_pass_timing **timings,
                                   uint32_t *count)
{
    const struct found found = find(renderer, ticket);
    const struct sf_plan *simulation = sf_particles_plan(renderer->particles), *plan;
    struct sf_pass_timing *room;
    enum sf_status status = SF_OK;

    *timings = NULL;
    *count = 0;
    if (!found.queued)
        return SF_ERROR_USAGE;
    if (!renderer->options.timing)
        return sf_fail(renderer->log, SF_ERROR_USAGE, "the renderer was made without timing");
    plan = found.side->stage.assembly->plan;
    /* The simulation's passes may be others than the last time. */
    room = realloc(found.side->stage.timings, (simulation->pass_count + plan->pass_count) * sizeof *room);
    if (!room)
        return sf_fail(renderer->log, SF_ERROR_MEMORY, "timings: out of memory");
    found.side->stage.timings = room;
    if (found.queued->stepped && found.side == renderer->sides)
        status = add_timings(room, sf_particles_player(renderer->particles), simulation, found.queued->stepped, count);
    if (!status)
        status = add_timings(room, found.side->stage.player, plan, found.serial, count);
    *timings = room;
    return status;
}
