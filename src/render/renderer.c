/* Simulation up to a frame, and its picture by every side.
 *
 * Frame n is at time n/fps, and the simulation takes whole fixed steps: preroll fps substeps + n substeps of them before frame n. So a frame has the
 * same bits however one comes to it. A frame's last steps and its picture are one submit; longer ways go ahead in batches. */
#include "render/renderer.h"

#include <math.h>
#include <string.h>
#include "base/log.h"

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

/* How many plays of its graph the side's picture takes. */
static uint32_t plays_of(const struct sf_side *side)
{
    const struct sf_method_row *row = side->assets.row;

    return row->plays ? row->plays(side->scene) : 1;
}

/* Of the side that takes the most. */
static uint32_t most_plays(const struct sf_renderer *renderer)
{
    uint32_t most = 0;

    for (uint32_t i = 0; i < renderer->side_count; i++)
        most = plays_of(&renderer->sides[i]) > most ? plays_of(&renderer->sides[i]) : most;
    return most;
}

/* Until every side's picture is finished. */
static uint32_t plays_left(const struct sf_renderer *renderer)
{
    uint32_t most = 0;

    for (uint32_t i = 0; i < renderer->side_count; i++) {
        const struct sf_side *side = &renderer->sides[i];
        uint32_t plays = plays_of(side), left = plays > side->still.plays ? plays - side->still.plays : 0;

        most = left > most ? left : most;
    }
    return most;
}

/* The pictures in hand, if any, are given up, or begin anew with the next play. */
static void forget_stills(struct sf_renderer *renderer)
{
    for (uint32_t i = 0; i < renderer->side_count; i++)
        renderer->sides[i].still.valid = false;
}

/* What the picture is of; a picture of something else begins anew. */
static void compare_still(const struct sf_renderer *renderer, struct sf_still *still, const struct sf_gpu_frame *frame)
{
    uint64_t steps = sf_particles_steps(renderer->particles), shaders = renderer->device->shaders_set;

    if (!still->valid || still->steps != steps || still->shaders_set != shaders ||
        memcmp(&still->frame, frame, sizeof *frame) != 0)
        still->plays = 0;
    *still = (struct sf_still){
        .valid = true, .plays = still->plays, .steps = steps, .shaders_set = shaders, .frame = *frame};
}

/* What both sides draw. */
static void fill_frame(const struct sf_renderer *renderer, struct sf_queued *queued, struct sf_gpu_frame *filled)
{
    uint32_t width = renderer->options.width, height = renderer->options.height;

    sf_uniforms_fill(renderer->scene, width, height, queued->number, queued->time, filled);
    if (renderer->posed)
        queued->pose = renderer->pose;
    else
        sf_scene_camera(renderer->scene, queued->time, &queued->pose);
    memcpy(queued->probe, renderer->probe, sizeof queued->probe);
    if (renderer->posed)
        sf_uniforms_view(&renderer->pose, width, height, filled);
    sf_shadow_fill(&renderer->sides[0].stage.assembly->drawn.shadow, filled);
    sf_matrix_transpose(filled->world_to_view, queued->world_to_camera);
    sf_matrix_transpose(filled->world_to_clip, queued->world_to_clip);
}

/* The next play of the side's picture. */
static enum sf_status record_side(struct sf_renderer *renderer, struct sf_side *side, uint32_t number,
                                  const struct sf_gpu_frame *filled)
{
    struct sf_assembly *assembly = side->stage.assembly;
    struct sf_player *player = side->stage.player;
    struct sf_gpu_frame *frame = sf_player_upload(player, assembly->method.frame);
    void *objects = sf_player_upload(player, assembly->objects_upload);
    enum sf_status status;

    if (!frame || !objects)
        return sf_fail(renderer->log, SF_ERROR_MEMORY, "frame %u: no memory for its uploads", number);
    memcpy(frame, filled, sizeof *filled); /* once: upload memory is slow to read, and writes may be combined */
    memcpy(objects, assembly->drawn.objects, sizeof assembly->drawn.objects);
    assembly->method.play = side->still.plays;
    sf_assembly_set_time(assembly, renderer->coming.time);
    memcpy(assembly->method.probe_at, renderer->probe, sizeof renderer->probe);
    if (side->assets.row->update)
        side->assets.row->update(&assembly->method, assembly->state);
    if (side->begun)
        sf_player_continue(player);
    status = sf_player_play(player);
    renderer->record_ns += sf_player_record_ns(player);
    renderer->recorded += assembly->plan->pass_count;
    side->begun = !status;
    if (!status && side->still.plays < plays_of(side))
        side->still.plays++;
    return status;
}

/* The next play of each side's picture; one that is finished waits for the other: its results stay where they are.
 * `played`: bit set of the sides. */
static enum sf_status record_picture(struct sf_renderer *renderer, struct sf_queued *queued, unsigned *played)
{
    struct sf_gpu_frame filled;
    enum sf_status status = SF_OK;
    bool going_on;

    fill_frame(renderer, queued, &filled);
    for (uint32_t i = 0; i < renderer->side_count; i++)
        compare_still(renderer, &renderer->sides[i].still, &filled);
    going_on = plays_left(renderer) > 0;
    for (uint32_t i = 0; i < renderer->side_count && !status; i++) {
        struct sf_side *side = &renderer->sides[i];

        if (going_on && side->still.plays >= plays_of(side))
            continue;
        status = record_side(renderer, side, queued->number, &filled);
        *played |= 1u << i;
    }
    return status;
}

static void begin_picture(struct sf_renderer *renderer, uint32_t number)
{
    for (uint32_t i = 0; i < renderer->side_count && !renderer->begun; i++)
        renderer->sides[i].begun = false;
    if (!renderer->begun || renderer->coming.number != number)
        renderer->coming = (struct sf_queued){.number = number, .time = (double)number / renderer->scene->sim.fps};
}

/* After the submit in which the sides of the bit set were played. */
static void end_play(struct sf_renderer *renderer, unsigned played, uint64_t serial)
{
    struct sf_queued *coming = &renderer->coming;

    for (uint32_t i = 0; i < renderer->side_count; i++) {
        struct sf_side *side = &renderer->sides[i];

        if (played & 1u << i) {
            side->serial = serial;
            side->stage.drawn = true;
        }
        coming->serials[i] = side->serial;
        coming->progress[i] = (float)side->still.plays / (float)plays_of(side);
    }
}

/* A play of the picture and, before the first, the last steps to it: one submit. */
static enum sf_status play_picture(struct sf_renderer *renderer, uint32_t number)
{
    uint64_t target = steps_at(renderer->scene, number), serial = 0;
    enum sf_status status = sf_frame_begin(renderer->device->gpu), ended;
    unsigned played = 0;
    bool steps;

    if (status)
        return status;
    begin_picture(renderer, number);
    steps = sf_particles_steps(renderer->particles) < target;
    status = record_steps(renderer, target - sf_particles_steps(renderer->particles));
    if (!status)
        status = record_picture(renderer, &renderer->coming, &played);
    renderer->begun = !status;
    ended = sf_frame_end(renderer->device->gpu, &serial);
    status = status ? status : ended;
    if (steps)
        renderer->coming.stepped = serial;
    if (!status) {
        end_play(renderer, played, serial);
        return SF_OK;
    }
    forget_stills(renderer);
    renderer->begun = false;
    return status;
}

enum sf_status sf_renderer_refine(struct sf_renderer *renderer, uint32_t frame, sf_progress_fn progress, void *user)
{
    uint32_t last = most_plays(renderer) - 1, done;
    enum sf_status status = last > 0 ? sf_renderer_seek(renderer, frame, NULL, NULL) : SF_OK;

    if (!renderer->options.progressive)
        forget_stills(renderer);
    for (done = 0; done < last && !status; done = last + 1 - plays_left(renderer)) {
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
    enum sf_status status = sf_renderer_seek(renderer, frame, NULL, NULL);

    *ticket = 0;
    renderer->record_ns = 0;
    renderer->recorded = 0;
    if (!renderer->options.progressive && !renderer->begun)
        forget_stills(renderer);
    do {
        status = status ? status : play_picture(renderer, frame);
    } while (!status && !renderer->options.progressive && plays_left(renderer) > 0);
    if (status)
        return status;
    renderer->coming.ticket = ++renderer->tickets;
    renderer->queued[renderer->coming.ticket % SF_TICKETS] = renderer->coming;
    renderer->begun = false;
    *ticket = renderer->coming.ticket;
    return SF_OK;
}

float sf_renderer_progress(const struct sf_renderer *renderer)
{
    const struct sf_queued *last = &renderer->queued[renderer->tickets % SF_TICKETS];
    float least = renderer->tickets > 0 ? 1 : 0;

    for (uint32_t i = 0; i < renderer->side_count; i++)
        least = fminf(least, renderer->tickets > 0 ? last->progress[i] : 0);
    return least;
}

uint64_t sf_renderer_record_ns(const struct sf_renderer *renderer, uint32_t *passes)
{
    if (passes)
        *passes = renderer->recorded;
    return renderer->record_ns;
}
