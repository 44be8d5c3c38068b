/* The renderer of the view: what it draws, when, and what comes back. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../console.h"
#include "../wipe.h"
#include "view.h"

static const uint64_t SEEK_NS = 40 * 1000000ull; /* of a long way, until the window answers again */
static const float NS_TO_MS = 1e-6f;

/* ---- frames that are on their way ---- */

bool sf_picture_pending(const struct sf_view *view)
{
    return view->flight_count > 0;
}

/* The pictures of a ticket: the scene's method's, and the second's when there is one. A second method that cannot is
 * given up. */
static enum sf_status wait_for(struct sf_view *view, uint64_t ticket, struct sf_frame frames[2])
{
    enum sf_status status = sf_renderer_wait(view->renderer, ticket, &frames[0]), other = SF_OK;

    frames[1] = (struct sf_frame){.progress = 1};
    if (view->beside[0] && !status)
        other = sf_renderer_wait(view->renderer, ticket | SF_BESIDE, &frames[1]);
    if (other == SF_ERROR_DEVICE) { /* it has been said why */
        sf_wipe_give_up(view);
        frames[1] = (struct sf_frame){.progress = 1};
        return SF_OK;
    }
    return status ? status : other;
}

/* Sum of the passes that draw. */
static float drawing_ms(const struct sf_pass_timing *timings, uint32_t count)
{
    static const char simulation[] = "sim.";
    uint64_t ns = 0;

    for (uint32_t i = 0; i < count; i++)
        if (strncmp(timings[i].name, simulation, sizeof simulation - 1) != 0)
            ns += timings[i].end_ns - timings[i].begin_ns;
    return (float)ns * NS_TO_MS;
}

/* Hands a frame that came back to the files' writer, as it is seen. */
static enum sf_status store(struct sf_view *view, const struct sf_frame frames[2])
{
    struct sf_frame seen = frames[0];
    char stem[SF_NAME_BYTES];
    enum sf_status status = frames[1].width > 0 ? sf_wipe_join(&seen, &frames[1], view->wipe.at, &view->joined) : SF_OK;

    if (status)
        return status;
    sf_view_stem(view, stem, sizeof stem);
    return sf_shots_take(view->shots, stem, &seen, view->model.info.tone, view->model.info.exposure,
                         view->model.info.fps, view->model.info.hash);
}

/* Takes up the oldest. */
static enum sf_status land(struct sf_view *view)
{
    struct sf_flight flight = view->flights[0];
    const struct sf_pass_timing *timings, *others;
    struct sf_frame frames[2];
    const struct sf_frame *frame = &frames[0];
    uint32_t count = 0, other_count = 0;
    uint64_t now;
    enum sf_status status;

    view->flight_count--;
    memmove(&view->flights[0], &view->flights[1], view->flight_count * sizeof flight);
    status = wait_for(view, flight.ticket, frames);
    if (status == SF_ERROR_DEVICE) { /* the method cannot; it has been said why */
        view->progress = 1;
        return SF_OK;
    }
    if (!status)
        status = sf_renderer_timings(view->renderer, flight.ticket, &timings, &count);
    if (!status && view->beside[0])
        status = sf_renderer_timings(view->renderer, flight.ticket | SF_BESIDE, &others, &other_count);
    if (status)
        return status;
    view->wipe.ms[0] = drawing_ms(timings, count);
    view->wipe.ms[1] = other_count > 0 ? drawing_ms(others, other_count) : 0;
    now = sf_now_ns();
    view->live = frame->live;
    view->dropped = frame->dropped;
    memcpy(view->bounds_min, frame->bounds_min, sizeof view->bounds_min);
    memcpy(view->bounds_max, frame->bounds_max, sizeof view->bounds_max);
    view->settle = true;
    sf_stats_add(&view->stats, timings, count, flight.cpu_ms,
                 view->landed_ns ? (float)(now - view->landed_ns) * NS_TO_MS : 0, flight.record_ms);
    view->landed_ns = now;
    sf_against_land(view, frame);
    if (view->looking.name[0] && strcmp(view->looking.name, view->inspected) == 0)
        sf_looking_take(&view->looking, frame);
    /* A frame that cannot be kept (it has been said why) ends the recording, not the viewer. */
    if (sf_shots_recording(view->shots) && view->options.returned && frames[0].progress >= 1 &&
        frames[1].progress >= 1 && store(view, frames) != SF_OK)
        sf_view_record(view);
    return SF_OK;
}

enum sf_status sf_picture_collect(struct sf_view *view, unsigned left)
{
    enum sf_status status = SF_OK;

    while (view->flight_count > left && !status)
        status = land(view);
    return status;
}

/* ---- the renderer as it should be ---- */

static struct sf_renderer_options wanted_options(const struct sf_view *view)
{
    const struct sf_renderer_options *has = &view->options;
    uint32_t width = (uint32_t)view->picture[2], height = (uint32_t)view->picture[3];
    bool recording = sf_shots_recording(view->shots);
    /* Frames of a sequence are all as large as its first; meanwhile they are shown stretched. */
    bool keep = (recording && has->returned) || (view->refused[0] == width && view->refused[1] == height);

    return (struct sf_renderer_options){.width = keep ? has->width : width,
                                        .height = keep ? has->height : height,
                                        .timing = true,
                                        .frames_kept = SF_FLIGHT + 1,
                                        .shown = true,
                                        .returned = recording || view->shooting || view->comparing,
                                        .particles = view->comparing,
                                        .probe = sf_against_probes(view),
                                        .float_aovs = view->comparing,
                                        .aovs = view->comparing ? SF_AOV_SMOKE | SF_AOV_DEPTHS : 0,
                                        .progressive = true,
                                        .inspect = view->looking.name[0] ? view->looking.name : NULL};
}

static bool same_options(const struct sf_view *view, const struct sf_renderer_options *wanted)
{
    const struct sf_renderer_options *has = &view->options;

    return wanted->width == has->width && wanted->height == has->height && wanted->returned == has->returned &&
           wanted->particles == has->particles && wanted->probe == has->probe &&
           strcmp(wanted->inspect ? wanted->inspect : "", view->inspected) == 0;
}

static enum sf_status set_options(struct sf_view *view, const struct sf_renderer_options *wanted)
{
    enum sf_status status = sf_picture_collect(view, 0);

    if (status)
        return status;
    status = sf_renderer_set_options(view->renderer, wanted);
    if (status)
        return status;
    view->options = *wanted;
    view->options.inspect = NULL;
    snprintf(view->inspected, sizeof view->inspected, "%s", wanted->inspect ? wanted->inspect : "");
    view->graph_version++;
    view->dirty = true;
    return SF_OK;
}

/* The second method that is wanted. One that cannot be (it has been said why) is no reason to stop. */
static enum sf_status update_beside(struct sf_view *view)
{
    const char *wanted = view->wipe.on ? view->wipe.method : "";
    enum sf_status status = SF_OK;

    if (strcmp(wanted, view->beside) == 0)
        return SF_OK;
    status = sf_picture_collect(view, 0);
    if (status)
        return status;
    status = sf_renderer_set_beside(view->renderer, wanted[0] ? wanted : NULL);
    if (status == SF_ERROR_DEVICE_LOST || status == SF_ERROR_INTERNAL)
        return status;
    if (status) {
        sf_wipe_give_up(view);
        return update_beside(view); /* without one */
    }
    snprintf(view->beside, sizeof view->beside, "%s", wanted);
    view->dirty = view->dirty || wanted[0];
    view->settle = true;
    return SF_OK;
}

/* An image that another method does not have, a size that the device cannot take, or no memory for a recording is no
 * reason to stop: the first of them that is new is given up. */
static enum sf_status update_options(struct sf_view *view)
{
    struct sf_renderer_options wanted = wanted_options(view);
    enum sf_status status = same_options(view, &wanted) ? SF_OK : set_options(view, &wanted);

    if (status != SF_ERROR_USAGE && status != SF_ERROR_MEMORY)
        return status;
    if (status == SF_ERROR_MEMORY && view->beside[0]) {
        sf_wipe_give_up(view);
        status = update_beside(view);
        if (status)
            return status;
    } else if (wanted.inspect && strcmp(wanted.inspect, view->inspected) != 0) {
        sf_view_look(view, "");
    } else if (wanted.width != view->options.width || wanted.height != view->options.height) {
        view->refused[0] = wanted.width;
        view->refused[1] = wanted.height;
    } else if (wanted.returned && !view->options.returned) {
        sf_view_record(view);
    } else {
        return status;
    }
    return update_options(view);
}

/* ---- scenes ---- */

static void drop_coarse(struct sf_view *view)
{
    sf_scene_destroy(&view->coarse);
    view->governor.level = 0;
}

static enum sf_status give_scene(struct sf_view *view, const struct sf_scene *scene)
{
    enum sf_status status = sf_picture_collect(view, 0);

    if (!status)
        status = sf_renderer_set_scene(view->renderer, scene);
    if (status)
        return status;
    view->graph_version++;
    view->dirty = true;
    return SF_OK;
}

/* The scene that cannot be with both methods may be with its own; else both go on with the old one. */
static enum sf_status give_without_beside(struct sf_view *view, const struct sf_scene *scene)
{
    enum sf_status status = sf_renderer_set_beside(view->renderer, NULL), back;

    if (!status)
        status = give_scene(view, scene);
    if (!status) {
        view->beside[0] = '\0';
        sf_wipe_give_up(view);
        return SF_OK;
    }
    back = sf_renderer_set_beside(view->renderer, view->beside);
    return back ? back : status;
}

enum sf_status sf_picture_accept(void *user, const struct sf_scene *scene)
{
    struct sf_view *view = user;
    struct sf_scene_info info;
    enum sf_status status = view->renderer ? give_scene(view, scene) : SF_OK;

    if (status == SF_ERROR_USAGE && view->inspected[0]) { /* another method has other images */
        sf_view_look(view, "");
        status = update_options(view);
        status = status ? status : give_scene(view, scene);
    }
    if (status && status != SF_ERROR_DEVICE_LOST && view->beside[0])
        status = give_without_beside(view, scene);
    if (status)
        return status;
    drop_coarse(view);
    view->content++;
    view->refused[0] = view->refused[1] = 0; /* what another scene needs is another matter */
    sf_scene_describe(scene, &info);
    view->playback.fps = info.fps;
    return SF_OK;
}

/* The names of thick.resolution from the scene's own on: coarser ones follow. */
static unsigned coarser(const struct sf_view *view)
{
    const struct sf_control *resolution = sf_model_control(&view->model, "thick.resolution");
    unsigned count = 0;

    if (!resolution || strcmp(view->model.info.method, "thick") != 0)
        return 0;
    while (resolution->choices[count])
        count++;
    return count - 1 - (unsigned)resolution->value[0];
}

/* The model's scene with smoke so many levels coarser. */
static enum sf_status make_coarse(struct sf_view *view, unsigned level, struct sf_scene **scene)
{
    const struct sf_control *resolution = sf_model_control(&view->model, "thick.resolution");
    const struct sf_model *model = &view->model;
    const char **sets = malloc((model->set_count + 1) * sizeof *sets);
    char set[SF_NAME_BYTES];
    enum sf_status status;

    if (!sets)
        return SF_ERROR_MEMORY;
    for (uint32_t i = 0; i < model->set_count; i++)
        sets[i] = model->sets[i];
    snprintf(set, sizeof set, "thick.resolution=%s", resolution->choices[(unsigned)resolution->value[0] + level]);
    sets[model->set_count] = set;
    status = sf_scene_parse(model->path, model->text, model->bytes, sets, model->set_count + 1, &view->log, scene);
    free(sets);
    return status;
}

/* Draws on with smoke at that level of coarseness. */
static enum sf_status set_level(struct sf_view *view, unsigned level)
{
    struct sf_scene *scene = NULL;
    enum sf_status status = level > 0 ? make_coarse(view, level, &scene) : SF_OK;

    if (!status)
        status = give_scene(view, level > 0 ? scene : view->model.scene);
    if (status) {
        sf_scene_destroy(&scene);
        view->governor.level = view->coarse ? view->governor.level : 0;
        return status;
    }
    sf_scene_destroy(&view->coarse);
    view->coarse = scene;
    view->governor.level = level;
    return SF_OK;
}

static enum sf_status govern(struct sf_view *view)
{
    const struct sf_stats *stats = &view->stats;
    unsigned newest = (stats->next + SF_STATS_FRAMES - 1) % SF_STATS_FRAMES, before = view->governor.level;
    double other = view->beside[0] ? (double)view->wipe.ms[1] : 0;
    double cost = stats->frame_count ? (double)stats->gpu_ms[newest] + stats->cpu_ms[newest] + other : 0;

    if (sf_shots_recording(view->shots) || view->looking.name[0]) {
        view->moved = false;
        return before ? set_level(view, 0) : SF_OK;
    }
    if (!sf_governor_update(&view->governor, sf_now_ns(), view->moved, cost, coarser(view)))
        return SF_OK;
    unsigned level = view->governor.level;
    view->governor.level = before;
    return set_level(view, level);
}

/* ---- drawing ---- */

struct budget {
    struct sf_view *view;
    uint64_t until_ns;
};

static bool within_budget(void *user, uint64_t done, uint64_t total)
{
    struct budget *budget = user;

    budget->view->seek_done = done;
    budget->view->seek_total = total;
    return sf_now_ns() < budget->until_ns;
}

/* Whether the simulation is at the frame now; else some of the way is done. */
static enum sf_status go_to(struct sf_view *view, uint32_t frame, bool *there)
{
    struct budget budget = {view, sf_now_ns() + SEEK_NS};
    enum sf_status status = sf_renderer_seek(view->renderer, frame, within_budget, &budget);

    *there = !status;
    if (!status)
        view->seek_total = 0;
    return status == SF_ERROR_INTERRUPTED ? SF_OK : status;
}

static void aim(struct sf_view *view)
{
    struct sf_camera_view scene, own;

    sf_scene_view(view->model.scene, view->playback.frame / view->model.info.fps, &scene);
    sf_rig_follow(&view->rig, &scene);
    sf_rig_view(&view->rig, &own);
    sf_renderer_set_view(view->renderer, view->rig.own ? &own : NULL);
    sf_against_aim(view);
}

static enum sf_status draw(struct sf_view *view, struct sf_flight *flight)
{
    uint64_t begin = sf_now_ns();
    enum sf_status status;

    aim(view);
    *flight = (struct sf_flight){0};
    status = sf_renderer_render(view->renderer, view->playback.frame, &flight->ticket);
    flight->cpu_ms = (float)(sf_now_ns() - begin) * NS_TO_MS;
    flight->record_ms = (float)sf_renderer_record_ns(view->renderer, NULL) * NS_TO_MS;
    view->drawn_frame = view->playback.frame;
    view->progress = status ? 1 : sf_renderer_progress(view->renderer);
    view->counted.pictures++;
    return status;
}

/* As the scene says, at full quality, with everything back that `*drawing` (of `shooting` and `comparing`) asks for,
 * handed to `take`, the second method's behind the scene's. A picture that takes many steps takes as many turns of the loop. Then, and when it cannot be, it is
 * `*due` no more. */
static enum sf_status draw_once(struct sf_view *view, bool *due, bool *drawing,
                                void (*take)(struct sf_view *view, const struct sf_frame *frames), bool *drawn)
{
    struct sf_renderer_options wanted;
    struct sf_flight flight;
    struct sf_frame frames[2];
    enum sf_status status = view->governor.level ? set_level(view, 0) : SF_OK;

    if (!status && !*drawing) {
        *drawing = true;
        wanted = wanted_options(view);
        status = set_options(view, &wanted);
    }
    if (status == SF_ERROR_MEMORY) { /* it has been said; everything is as it was */
        *due = *drawing = false;
        return SF_OK;
    }
    if (!status)
        status = draw(view, &flight);
    if (!status)
        status = wait_for(view, flight.ticket, frames);
    if (!status && (frames[0].progress < 1 || (view->shooting && frames[1].progress < 1))) {
        *drawn = true;
        return SF_OK;
    }
    *due = *drawing = false;
    if (!status)
        take(view, frames);
    wanted = wanted_options(view);
    return status && status != SF_ERROR_DEVICE ? status : set_options(view, &wanted);
}

static void shoot(struct sf_view *view, const struct sf_frame *frames)
{
    store(view, frames);
}

/* After a failure that may be the second method's: it is given up, and the next turn tries without. */
static enum sf_status fall_back(struct sf_view *view, enum sf_status status)
{
    if (!view->beside[0] || status == SF_ERROR_DEVICE_LOST)
        return status;
    sf_wipe_give_up(view);
    view->dirty = true;
    return update_beside(view);
}

enum sf_status sf_picture_update(struct sf_view *view, bool *drawn)
{
    bool there = true;
    enum sf_status status;

    *drawn = false;
    view->comparing = view->comparing && sf_against_due(view); /* it may have been called off */
    status = update_beside(view);
    if (!status)
        status = update_options(view);
    if (!status)
        status = govern(view);
    /* A way that was begun is gone to its end, also when that is the frame drawn last: the simulation has left it. */
    if (status || !(view->dirty || view->shot || sf_against_due(view) || view->seek_total > 0 || view->progress < 1 ||
                    view->playback.frame != view->drawn_frame))
        return status;
    status = go_to(view, view->playback.frame, &there);
    if (status || !there)
        return status ? fall_back(view, status) : SF_OK;
    if (view->shot && !sf_shots_recording(view->shots))
        return draw_once(view, &view->shot, &view->shooting, shoot, drawn);
    if (sf_against_due(view) && !sf_shots_recording(view->shots))
        return draw_once(view, &view->against.wanted, &view->comparing, sf_against_take, drawn);
    view->shot = view->shooting = false; /* a recording has the picture already */
    status = sf_picture_collect(view, SF_FLIGHT - 1);
    if (!status)
        status = draw(view, &view->flights[view->flight_count]);
    if (status)
        return fall_back(view, status);
    view->flight_count++;
    view->dirty = false;
    view->moved = false;
    *drawn = true;
    return SF_OK;
}

enum sf_status sf_picture_open(struct sf_view *view)
{
    struct sf_renderer_options wanted = wanted_options(view);
    enum sf_status status = sf_renderer_create(view->device, view->model.scene, &wanted, &view->log, &view->renderer);

    view->options = wanted;
    view->options.inspect = NULL;
    snprintf(view->inspected, sizeof view->inspected, "%s", view->looking.name);
    view->dirty = true;
    view->progress = 1;
    return status;
}

void sf_picture_close(struct sf_view *view)
{
    sf_renderer_destroy(&view->renderer);
    sf_scene_destroy(&view->coarse);
}
