/* sfumato capture: frames to files. The device draws frame n + 1 while worker threads encode frame n from the
 * renderer's own memory; a frame's slot in the encoder is the slot of its memory, so a frame is queued only once the
 * files of the one before it there are written. */
#include "capture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "console.h"
#include "encoder.h"
#include "progress.h"
#include "session.h"
#include "wipe.h"

enum {
    IN_FLIGHT = 2,       /* frames that the device has at once */
    LONG_WAY = 16,       /* frames simulated without a picture that deserve a progress line */
    THREADS_AUTO_MAX = 4 /* beyond that the disk is the limit */
};
static const uint64_t KEPT_BYTES_MAX = 512u << 20; /* results kept for the encoder, where more than IN_FLIGHT are */

struct capture {
    const struct sf_arguments *arguments;
    struct sf_targets targets;
    struct sf_scene *scene;
    struct sf_scene_info info;
    char hash[17];
    struct sf_device *device;
    struct sf_renderer *renderer;
    struct sf_encoder *encoder;
    unsigned threads, slots;
    uint64_t tickets[SF_ENCODER_SLOTS_MAX];
    size_t queued, waited;              /* frames of the list */
    bool smoke;                         /* some frame had live particles */
    void *joined[SF_ENCODER_SLOTS_MAX]; /* frames of two methods, as they are seen */
};

/* Color, depth and AOVs of one frame in memory; of two methods there are both and what is seen of them. */
static uint64_t frame_bytes(const struct sf_arguments *arguments)
{
    uint64_t pixel = (strcmp(arguments->type, "float") == 0 ? 16u : 8u) + 4u + (arguments->aovs ? 8u + 16u : 0u);

    return (arguments->beside ? 3 : 1) * pixel * arguments->size.width * arguments->size.height;
}

static void choose_threads(struct capture *capture)
{
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    uint64_t fit = KEPT_BYTES_MAX / frame_bytes(capture->arguments);

    capture->threads = capture->arguments->threads;
    if (!capture->threads)
        capture->threads = cores < 1 ? 1 : cores > THREADS_AUTO_MAX ? THREADS_AUTO_MAX : (unsigned)cores;
    capture->slots = capture->threads + IN_FLIGHT;
    if (capture->slots > SF_ENCODER_SLOTS_MAX)
        capture->slots = SF_ENCODER_SLOTS_MAX;
    if (capture->slots > fit)
        capture->slots = fit > IN_FLIGHT ? (unsigned)fit : IN_FLIGHT;
}

static enum sf_status open_renderer(struct capture *capture)
{
    const struct sf_arguments *arguments = capture->arguments;
    struct sf_renderer_options options = {.width = arguments->size.width,
                                          .height = arguments->size.height,
                                          .float_color = strcmp(arguments->type, "float") == 0,
                                          .aovs = arguments->aovs ? SF_AOV_SMOKE | SF_AOV_DEPTHS : 0,
                                          .inspect = arguments->inspect,
                                          .frames_kept = capture->slots};

    enum sf_status status;

    if (arguments->wipe.given && !arguments->beside)
        return sf_console_fail(SF_ERROR_USAGE, "--wipe says where the picture of --compare METHOD begins");
    if (arguments->beside && arguments->inspect)
        return sf_console_fail(SF_ERROR_USAGE, "--compare shows two pictures, --inspect one image: name one of them");
    status = sf_renderer_create(capture->device, capture->scene, &options, sf_console_log(), &capture->renderer);
    if (!status && arguments->beside)
        status = sf_renderer_set_beside(capture->renderer, arguments->beside);
    return status;
}

static enum sf_status open_encoder(struct capture *capture)
{
    const struct sf_arguments *arguments = capture->arguments;
    struct sf_encoder_settings settings = {.exr = {.compression = arguments->compression,
                                                   .half = strcmp(arguments->type, "half") == 0,
                                                   .fps = capture->info.fps,
                                                   .scene_hash = capture->hash},
                                           .tone = arguments->tone ? arguments->tone : capture->info.tone,
                                           .exposure = arguments->exposure.given ? (float)arguments->exposure.value
                                                                                 : capture->info.exposure,
                                           .inspected = arguments->inspect != NULL,
                                           .targets = capture->targets.items,
                                           .target_count = capture->targets.count};

    return sf_encoder_create(capture->threads, &settings, &capture->encoder);
}

static enum sf_status open_capture(struct capture *capture)
{
    const struct sf_arguments *arguments = capture->arguments;
    enum sf_status status = sf_session_scene(arguments, arguments->files.items[0], &capture->scene);

    if (status)
        return status;
    sf_scene_describe(capture->scene, &capture->info);
    snprintf(capture->hash, sizeof capture->hash, "%016llx", (unsigned long long)capture->info.hash);
    choose_threads(capture);
    status = sf_session_device(arguments, NULL, &capture->device);
    if (!status)
        status = sf_session_size(arguments, capture->device);
    if (!status)
        status = open_renderer(capture);
    if (!status)
        status = open_encoder(capture);
    return status;
}

/* Queues the next frame of the list. */
static enum sf_status queue_frame(struct capture *capture)
{
    const struct sf_targets *targets = &capture->targets;
    unsigned slot = (unsigned)(capture->queued % capture->slots);
    uint32_t frame = targets->frames[capture->queued],
             before = capture->queued ? targets->frames[capture->queued - 1] : 0;
    enum sf_status status = sf_encoder_wait(capture->encoder, slot);

    if (!status && (capture->queued == 0 || frame - before > LONG_WAY))
        status = sf_session_seek(capture->renderer, frame);
    if (!status)
        status = sf_session_refine(capture->renderer, frame);
    if (!status)
        status = sf_renderer_render(capture->renderer, frame, &capture->tickets[slot]);
    if (!status)
        capture->queued++;
    return status;
}

/* Waits for the oldest frame on the device and hands it to the encoder. */
static enum sf_status take_frame(struct capture *capture)
{
    unsigned slot = (unsigned)(capture->waited % capture->slots);
    const struct sf_argument_real *wipe = &capture->arguments->wipe;
    struct sf_frame frame, beside;
    enum sf_status status = sf_renderer_wait(capture->renderer, capture->tickets[slot], &frame);

    if (!status && capture->arguments->beside)
        status = sf_renderer_wait(capture->renderer, capture->tickets[slot] | SF_BESIDE, &beside);
    if (!status && capture->arguments->beside)
        status = sf_wipe_join(&frame, &beside, wipe->given ? (float)wipe->value : 0.5f, &capture->joined[slot]);
    if (status)
        return status;
    if (frame.live > 0)
        capture->smoke = true;
    if (frame.dropped > 0)
        sf_console_say(SF_LOG_INFO, "frame %u: %u particles found no room so far (sim.capacity)", frame.frame,
                       frame.dropped);
    sf_encoder_push(capture->encoder, slot, &frame, capture->targets.paths + capture->waited * capture->targets.count);
    capture->waited++;
    return sf_session_validated(capture->arguments, capture->device);
}

static enum sf_status render_frames(struct capture *capture)
{
    size_t count = capture->targets.frame_count;
    struct sf_progress progress;
    enum sf_status status = SF_OK, taken = SF_OK;
    bool shown = false;

    while (!status && capture->waited < count && !sf_interrupted()) {
        if (capture->queued < count && capture->queued - capture->waited < IN_FLIGHT)
            status = queue_frame(capture);
        else
            status = take_frame(capture);
        /* The way to the first frame is the simulation's own line, and no measure of the frames to come. */
        if (!shown)
            sf_progress_begin(&progress, "rendering", "frames", count);
        shown = true;
        sf_progress_show(&progress, sf_encoder_frames(capture->encoder));
    }
    /* What the device has in hand is finished after Ctrl-C too, but not for a disk that is full or a device that is
     * lost. */
    while (!taken && (!status || status == SF_ERROR_INTERRUPTED) && capture->waited < capture->queued)
        taken = take_frame(capture);
    for (unsigned slot = 0; slot < capture->slots; slot++) {
        sf_encoder_wait(capture->encoder, slot);
        if (shown)
            sf_progress_show(&progress, sf_encoder_frames(capture->encoder));
    }
    if (shown)
        sf_progress_end(&progress);
    return taken ? taken : status;
}

static void report_files(const struct capture *capture, double seconds)
{
    const struct sf_targets *targets = &capture->targets;
    double bytes = 0;
    char time[32];

    for (size_t t = 0; t < targets->count; t++) {
        const char *first = NULL, *last = NULL;
        size_t files = 0;

        for (size_t f = 0; f < targets->frame_count; f++) {
            const char *path = targets->paths[f * targets->count + t];
            struct stat info;

            if (!path)
                continue;
            if (stat(path, &info) == 0)
                bytes += (double)info.st_size;
            first = first ? first : path;
            last = path;
            files++;
        }
        if (files == 1)
            sf_console_note("wrote %s", first);
        else if (files > 1)
            sf_console_note("wrote %s to %s, %zu files", first, last, files);
    }
    sf_duration_print(seconds, time, sizeof time);
    sf_console_note("%zu frame%s of %ux%u in %s (%.3g frames/s), %.1f MB", targets->frame_count,
                    targets->frame_count == 1 ? "" : "s", capture->arguments->size.width,
                    capture->arguments->size.height, time, (double)targets->frame_count / seconds, bytes * 1e-6);
    if (targets->skipped)
        sf_console_note("%zu file%s existed and stayed as they were", targets->skipped,
                        targets->skipped == 1 ? "" : "s");
    if (!capture->smoke && (capture->info.emitters > 0 || capture->info.listed > 0))
        sf_console_say(SF_LOG_WARNING, "no frame shows any smoke: later ones may (--frames)");
}

enum sf_status sf_capture_run(const struct sf_arguments *arguments)
{
    struct capture capture = {.arguments = arguments};
    enum sf_status status = sf_targets_init(arguments, arguments->files.items[0], &capture.targets), ended;
    uint64_t begin = sf_now_ns();

    if (!status && capture.targets.frame_count == 0) {
        sf_console_note("nothing to do: all %zu files exist", capture.targets.skipped);
        sf_targets_finish(&capture.targets);
        return SF_OK;
    }
    if (!status)
        status = open_capture(&capture);
    if (!status)
        status = render_frames(&capture);
    if (!status && capture.waited < capture.targets.frame_count)
        status = SF_ERROR_INTERRUPTED;
    if (status == SF_ERROR_INTERRUPTED && capture.encoder)
        sf_console_note("interrupted: %llu of %zu frames are written; --skip-existing goes on from there",
                        (unsigned long long)sf_encoder_frames(capture.encoder), capture.targets.frame_count);
    ended = sf_encoder_destroy(&capture.encoder);
    sf_renderer_destroy(&capture.renderer);
    for (int slot = 0; slot < SF_ENCODER_SLOTS_MAX; slot++)
        free(capture.joined[slot]);
    if (!status || status == SF_ERROR_INTERRUPTED)
        status = ended ? ended : status;
    if (!status)
        status = sf_session_validated(arguments, capture.device);
    if (!status)
        report_files(&capture, (double)(sf_now_ns() - begin) * 1e-9);
    sf_device_destroy(&capture.device);
    sf_scene_destroy(&capture.scene);
    sf_targets_finish(&capture.targets);
    return status;
}
