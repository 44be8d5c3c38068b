#include "comparison.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "../console.h"
#include "log_line.h"

static const float LUMINANCE[3] = {0.2126f, 0.7152f, 0.0722f}; /* ITU-R BT.709 */

struct sf_comparison {
    struct sf_log log; /* to `heard_by`, and errors into `message` */
    struct sf_reference *reference;
    float *smoke, *depths; /* the method's, of all pixels */
    uint32_t width, height, stride;
    uint64_t begin_ns;

    pthread_mutex_t lock; /* of all that follows */
    pthread_cond_t asked;
    unsigned users; /* threads, and whoever began it: the last one frees it */
    const struct sf_log *heard_by;
    enum sf_comparison_stage stage;
    bool stop, rendering, probing;
    uint64_t done, total, version;
    char message[SF_COMPARISON_MESSAGE];
    bool wanted; /* a probe of this pixel */
    uint32_t wanted_at[2];
    struct sf_probe probe;
    bool probed;
    struct sf_reference_picture *picture; /* by the thread that renders, until the stage is DONE */
    struct sf_errors errors;
    double seconds;
};

static void hear(void *user, enum sf_log_level level, const char *message)
{
    struct sf_comparison *comparison = user;

    pthread_mutex_lock(&comparison->lock);
    if (level == SF_LOG_ERROR)
        snprintf(comparison->message, sizeof comparison->message, "%s", message);
    sf_log_line(comparison->heard_by, level, "%s", message); /* locked: who listens may be gone after it */
    pthread_mutex_unlock(&comparison->lock);
}

/* Holding the lock, which is given back. */
static void leave(struct sf_comparison *comparison)
{
    bool last = --comparison->users == 0;

    pthread_mutex_unlock(&comparison->lock);
    if (!last)
        return;
    pthread_cond_destroy(&comparison->asked);
    pthread_mutex_destroy(&comparison->lock);
    sf_reference_picture_destroy(&comparison->picture);
    sf_reference_destroy(&comparison->reference);
    free(comparison->smoke);
    free(comparison->depths);
    free(comparison);
}

/* ---- the reference's picture ---- */

static bool tell(void *user, uint64_t done, uint64_t total)
{
    struct sf_comparison *comparison = user;
    bool go_on;

    pthread_mutex_lock(&comparison->lock);
    comparison->version += done != comparison->done;
    comparison->done = done;
    comparison->total = total;
    go_on = !comparison->stop;
    pthread_mutex_unlock(&comparison->lock);
    return go_on;
}

static void *render(void *user)
{
    struct sf_comparison *comparison = user;
    const struct sf_layers layers = {comparison->width, comparison->height, comparison->smoke, comparison->depths};
    struct sf_reference_picture *picture = NULL;
    struct sf_errors errors = {0};
    enum sf_status status = sf_reference_render(comparison->reference, NULL, comparison->width, comparison->height,
                                                comparison->stride, tell, comparison, &picture);

    if (!status)
        status = sf_errors_measure(&layers, picture, comparison->stride, &errors);
    pthread_mutex_lock(&comparison->lock);
    comparison->picture = picture;
    comparison->errors = errors;
    comparison->seconds = (double)(sf_now_ns() - comparison->begin_ns) * 1e-9;
    comparison->rendering = false;
    if (comparison->stop)
        comparison->stage = comparison->stage == SF_COMPARISON_FAILED ? SF_COMPARISON_FAILED : SF_COMPARISON_STOPPED;
    else
        comparison->stage = status ? SF_COMPARISON_FAILED : SF_COMPARISON_DONE;
    if (status && !comparison->message[0])
        snprintf(comparison->message, sizeof comparison->message, "the reference cannot be computed");
    comparison->version++;
    leave(comparison);
    return NULL;
}

/* ---- probes ---- */

/* Not locked: what it reads never changes. */
static void make_probe(struct sf_comparison *comparison, struct sf_probe *probe)
{
    size_t at = 4 * ((size_t)probe->y * comparison->width + probe->x);

    memcpy(probe->smoke, &comparison->smoke[at], sizeof probe->smoke);
    memcpy(probe->depths, &comparison->depths[at], sizeof probe->depths);
    probe->failed = sf_reference_probe(comparison->reference, NULL, comparison->width, comparison->height, probe->x,
                                       probe->y, probe->points, SF_PROBE_POINTS) != SF_OK;
    probe->empty = !probe->failed && probe->points[0].depth >= SF_NO_DEPTH;
}

static void *probe_when_asked(void *user)
{
    struct sf_comparison *comparison = user;

    pthread_mutex_lock(&comparison->lock);
    while (!comparison->stop) {
        struct sf_probe probe = {.x = comparison->wanted_at[0], .y = comparison->wanted_at[1]};

        if (!comparison->wanted) {
            pthread_cond_wait(&comparison->asked, &comparison->lock);
            continue;
        }
        comparison->wanted = false;
        comparison->probing = true;
        pthread_mutex_unlock(&comparison->lock);
        make_probe(comparison, &probe);
        pthread_mutex_lock(&comparison->lock);
        comparison->probing = false;
        comparison->probe = probe;
        comparison->probed = true;
        comparison->version++;
    }
    leave(comparison);
    return NULL;
}

void sf_comparison_probe(struct sf_comparison *comparison, uint32_t x, uint32_t y)
{
    if (x >= comparison->width || y >= comparison->height)
        return;
    pthread_mutex_lock(&comparison->lock);
    comparison->wanted = comparison->stage != SF_COMPARISON_FAILED && !comparison->stop;
    comparison->wanted_at[0] = x;
    comparison->wanted_at[1] = y;
    pthread_cond_broadcast(&comparison->asked);
    pthread_mutex_unlock(&comparison->lock);
}

bool sf_comparison_probed(struct sf_comparison *comparison, struct sf_probe *probe)
{
    bool probed;

    pthread_mutex_lock(&comparison->lock);
    probed = comparison->probed;
    if (probed)
        *probe = comparison->probe;
    pthread_mutex_unlock(&comparison->lock);
    return probed;
}

/* ---- beginning and end ---- */

static float *copied(const float *values, const struct sf_frame *frame)
{
    size_t bytes = (size_t)frame->width * frame->height * 4 * sizeof *values;
    float *copy = malloc(bytes);

    return copy ? memcpy(copy, values, bytes) : NULL;
}

static enum sf_status take(struct sf_comparison *comparison, const struct sf_scene *scene, const struct sf_frame *frame,
                           unsigned threads)
{
    const struct sf_reference_options options = {.threads = threads};
    struct sf_scene_info info;

    sf_scene_describe(scene, &info);
    if (!frame->smoke_float || !frame->smoke_depths)
        return sf_log_fail(&comparison->log, SF_ERROR_USAGE,
                           "method %s has no layers of the smoke alone to be compared", info.method);
    comparison->smoke = copied(frame->smoke_float, frame);
    comparison->depths = copied(frame->smoke_depths, frame);
    if (!comparison->smoke || !comparison->depths)
        return sf_log_fail(&comparison->log, SF_ERROR_MEMORY, "no memory to compare a picture of %ux%u", frame->width,
                           frame->height);
    return sf_reference_create(scene, frame, &options, &comparison->log, &comparison->reference);
}

static bool begin_thread(struct sf_comparison *comparison, void *(*work)(void *user))
{
    pthread_t thread;
    bool begun;

    pthread_mutex_lock(&comparison->lock); /* until it is counted */
    begun = pthread_create(&thread, NULL, work, comparison) == 0;
    comparison->users += begun;
    if (begun)
        pthread_detach(thread);
    pthread_mutex_unlock(&comparison->lock);
    return begun;
}

static enum sf_status begin_threads(struct sf_comparison *comparison)
{
    comparison->rendering = true; /* nobody else is there yet */
    if (!begin_thread(comparison, render))
        comparison->rendering = false;
    else if (begin_thread(comparison, probe_when_asked))
        return SF_OK;
    sf_comparison_stop(comparison);
    return sf_log_fail(&comparison->log, SF_ERROR_MEMORY, "no thread can be started");
}

struct sf_comparison *sf_comparison_begin(const struct sf_scene *scene, const struct sf_frame *frame, uint32_t stride,
                                          unsigned threads, const struct sf_log *log)
{
    struct sf_comparison *comparison = calloc(1, sizeof *comparison);
    enum sf_status status;

    if (!comparison)
        return NULL;
    comparison->heard_by = log;
    comparison->log = (struct sf_log){.write = hear, .user = comparison, .level = log ? log->level : SF_LOG_ERROR};
    comparison->width = frame->width;
    comparison->height = frame->height;
    comparison->stride = stride > 0 ? stride : 1;
    comparison->begin_ns = sf_now_ns();
    pthread_mutex_init(&comparison->lock, NULL);
    pthread_cond_init(&comparison->asked, NULL);
    comparison->users = 1;
    status = take(comparison, scene, frame, threads);
    if (!status)
        status = begin_threads(comparison);
    if (status) {
        pthread_mutex_lock(&comparison->lock);
        comparison->stage = SF_COMPARISON_FAILED;
        pthread_mutex_unlock(&comparison->lock);
    }
    return comparison;
}

void sf_comparison_stop(struct sf_comparison *comparison)
{
    pthread_mutex_lock(&comparison->lock);
    comparison->stop = true;
    if (comparison->stage == SF_COMPARISON_RUNS)
        comparison->stage = SF_COMPARISON_STOPPED;
    pthread_cond_broadcast(&comparison->asked);
    pthread_mutex_unlock(&comparison->lock);
}

void sf_comparison_destroy(struct sf_comparison **out)
{
    struct sf_comparison *comparison = *out;

    if (!comparison)
        return;
    sf_comparison_stop(comparison);
    pthread_mutex_lock(&comparison->lock);
    comparison->heard_by = NULL;
    leave(comparison);
    *out = NULL;
}

/* ---- how it stands ---- */

bool sf_comparison_busy(struct sf_comparison *comparison)
{
    bool busy;

    pthread_mutex_lock(&comparison->lock);
    busy = comparison->rendering || comparison->probing || (comparison->wanted && !comparison->stop);
    pthread_mutex_unlock(&comparison->lock);
    return busy;
}

enum sf_comparison_stage sf_comparison_stage(struct sf_comparison *comparison)
{
    enum sf_comparison_stage stage;

    pthread_mutex_lock(&comparison->lock);
    stage = comparison->stage;
    pthread_mutex_unlock(&comparison->lock);
    return stage;
}

uint64_t sf_comparison_progress(struct sf_comparison *comparison, uint64_t *total)
{
    uint64_t done;

    pthread_mutex_lock(&comparison->lock);
    done = comparison->done;
    *total = comparison->total;
    pthread_mutex_unlock(&comparison->lock);
    return done;
}

uint64_t sf_comparison_version(struct sf_comparison *comparison)
{
    uint64_t version;

    pthread_mutex_lock(&comparison->lock);
    version = comparison->version;
    pthread_mutex_unlock(&comparison->lock);
    return version;
}

void sf_comparison_message(struct sf_comparison *comparison, char text[SF_COMPARISON_MESSAGE])
{
    pthread_mutex_lock(&comparison->lock);
    memcpy(text, comparison->message, SF_COMPARISON_MESSAGE);
    pthread_mutex_unlock(&comparison->lock);
}

const char *sf_comparison_note(const struct sf_comparison *comparison, uint32_t index)
{
    return comparison->reference ? sf_reference_note(comparison->reference, index) : NULL;
}

void sf_comparison_size(const struct sf_comparison *comparison, uint32_t size[2], uint32_t compared[2])
{
    size[0] = comparison->width;
    size[1] = comparison->height;
    for (int i = 0; i < 2; i++)
        compared[i] = (uint32_t)(((uint64_t)size[i] + comparison->stride - 1) / comparison->stride);
}

uint32_t sf_comparison_stride(const struct sf_comparison *comparison)
{
    return comparison->stride;
}

const struct sf_errors *sf_comparison_errors(struct sf_comparison *comparison, uint32_t *unconverged, double *seconds)
{
    if (sf_comparison_stage(comparison) != SF_COMPARISON_DONE)
        return NULL;
    *unconverged = comparison->picture->unconverged;
    *seconds = comparison->seconds;
    return &comparison->errors;
}

static float luminance(const float rgb[3])
{
    return LUMINANCE[0] * rgb[0] + LUMINANCE[1] * rgb[1] + LUMINANCE[2] * rgb[2];
}

bool sf_comparison_difference(struct sf_comparison *comparison, enum sf_difference kind, float *values)
{
    const struct sf_reference_picture *picture = comparison->picture;

    if (sf_comparison_stage(comparison) != SF_COMPARISON_DONE)
        return false;
    for (uint32_t row = 0; row < picture->height; row++) {
        uint32_t y = sf_errors_pixel(row, comparison->stride, comparison->height);

        for (uint32_t column = 0; column < picture->width; column++) {
            uint32_t x = sf_errors_pixel(column, comparison->stride, comparison->width);
            size_t at = 4 * ((size_t)y * comparison->width + x), to = (size_t)row * picture->width + column;
            const struct sf_reference_pixel *truth = &picture->pixels[to];
            float off = kind == SF_DIFFERENCE_RADIANCE ? luminance(&comparison->smoke[at]) - luminance(truth->radiance)
                                                       : comparison->depths[at + 3] - truth->transmittance;

            values[to] = isfinite(off) ? off : NAN;
        }
    }
    return true;
}
