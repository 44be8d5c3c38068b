/* How long the frames take on the device. The entries take turns, so that what else the machine does at the time meets all
 * of them alike. One renderer is handed from scene to scene: only the graph is made anew. */
#include "verify.h"

#include <stdlib.h>
#include <string.h>

#include "../bench.h"
#include "../console.h"
#include "../session.h"

/* Of wall time: a frame that takes so long needs none before it to warm up, and an entry that has taken so much in all has
 * had its turns. */
static const double LONG_FRAME_MS = 500, LONG_ENTRY_MS = 3000;

/* The passes of the picture in ms, the simulation's not. */
static enum sf_status time_frame(struct sf_renderer *renderer, uint32_t number, double *ms)
{
    const struct sf_pass_timing *timings;
    struct sf_frame frame;
    uint64_t ticket;
    uint32_t count;
    enum sf_status status = sf_renderer_render(renderer, number, &ticket);

    if (!status)
        status = sf_renderer_wait(renderer, ticket, &frame);
    if (!status)
        status = sf_renderer_timings(renderer, ticket, &timings, &count);
    *ms = 0;
    for (uint32_t i = 0; i < count && !status; i++)
        if (strncmp(timings[i].name, "sim.", 4) != 0)
            *ms += (double)(timings[i].end_ns - timings[i].begin_ns) * 1e-6;
    return status;
}

static enum sf_status take_turn(struct sf_renderer *renderer, uint32_t number, struct sf_samples *samples,
                                double *spent)
{
    uint64_t begin = sf_now_ns();
    double ms;
    enum sf_status status = time_frame(renderer, number, &ms);

    if (!status && (double)(sf_now_ns() - begin) * 1e-6 < LONG_FRAME_MS)
        status = time_frame(renderer, number, &ms);
    *spent += (double)(sf_now_ns() - begin) * 1e-6;
    return status ? status : sf_samples_add(samples, ms);
}

static enum sf_status take_turns(struct sf_verify *verify, struct sf_renderer *renderer, struct sf_scene *const *scenes,
                                 uint32_t number, struct sf_samples *samples, double *spent)
{
    enum sf_status status = SF_OK;

    for (uint32_t turn = 0; turn < verify->arguments->repeats && !status; turn++) {
        for (size_t i = 0; i < verify->entry_count && !status; i++) {
            if (spent[i] > LONG_ENTRY_MS)
                continue;
            status = sf_renderer_set_scene(renderer, scenes[i]);
            if (!status)
                status = take_turn(renderer, number, &samples[i], &spent[i]);
            if (!status && sf_interrupted())
                status = SF_ERROR_INTERRUPTED;
        }
    }
    return status;
}

enum sf_status sf_verify_time(struct sf_verify *verify, struct sf_scene *const *scenes, struct sf_verify_case *result)
{
    struct sf_argument_size size = verify->arguments->time_size;
    const struct sf_renderer_options options = {
        .width = size.width, .height = size.height, .timing = true, .no_readback = true};
    struct sf_samples *samples = calloc(verify->entry_count, sizeof *samples);
    double *spent = calloc(verify->entry_count, sizeof *spent);
    struct sf_renderer *renderer = NULL;
    enum sf_status status = samples && spent ? SF_OK : sf_console_fail(SF_ERROR_MEMORY, "out of memory");

    if (!status)
        status = sf_renderer_create(verify->device, scenes[0], &options, sf_console_log(), &renderer);
    if (!status)
        status = sf_session_seek(renderer, result->frame);
    if (!status)
        status = take_turns(verify, renderer, scenes, result->frame, samples, spent);
    for (size_t i = 0; i < verify->entry_count && samples; i++) {
        struct sf_statistics statistics = sf_samples_describe(&samples[i]);

        result->rows[i].ms = statistics.median;
        result->rows[i].ms_least = statistics.min;
        result->rows[i].samples = (uint32_t)samples[i].count;
        free(samples[i].values);
    }
    sf_renderer_destroy(&renderer);
    free(samples);
    free(spent);
    return status;
}
