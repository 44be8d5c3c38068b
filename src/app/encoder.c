#include "encoder.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "console.h"

struct slot {
    struct sf_frame frame;
    char *const *paths;
    unsigned pending; /* files that are not written yet */
};
struct job {
    unsigned slot, target;
};
enum { JOBS_MAX = SF_ENCODER_SLOTS_MAX * SF_TARGETS_MAX };

struct sf_encoder {
    struct sf_encoder_settings settings;
    pthread_mutex_t lock;
    pthread_cond_t arrived, written;
    pthread_t *threads;
    unsigned thread_count;
    struct slot slots[SF_ENCODER_SLOTS_MAX];
    struct job jobs[JOBS_MAX]; /* a ring: never full, as a slot has a job a target at most */
    unsigned first, waiting;
    uint64_t frames;
    enum sf_status status;
    bool closing;
};

static enum sf_status write_file(const struct sf_encoder_settings *settings, const struct sf_frame *frame,
                                 enum sf_target_kind kind, const char *path)
{
    if (settings->inspected && kind == SF_TARGET_PNG)
        return sf_frame_write_inspected_png(frame, path, sf_console_log());
    if (settings->inspected)
        return sf_frame_write_inspected_exr(frame, path, &settings->exr, sf_console_log());
    if (kind == SF_TARGET_PNG)
        return sf_frame_write_png(frame, path, settings->tone, settings->exposure, sf_console_log());
    return sf_frame_write_exr(frame, path, &settings->exr, sf_console_log());
}

static void *work(void *user)
{
    struct sf_encoder *encoder = user;

    pthread_mutex_lock(&encoder->lock);
    for (;;) {
        struct job job;
        struct slot *slot;
        enum sf_status status;

        while (!encoder->waiting && !encoder->closing)
            pthread_cond_wait(&encoder->arrived, &encoder->lock);
        if (!encoder->waiting)
            break;
        job = encoder->jobs[encoder->first];
        encoder->first = (encoder->first + 1) % JOBS_MAX;
        encoder->waiting--;
        slot = &encoder->slots[job.slot];
        status = encoder->status;
        if (!status) {
            pthread_mutex_unlock(&encoder->lock);
            status = write_file(&encoder->settings, &slot->frame, encoder->settings.targets[job.target].kind,
                                slot->paths[job.target]);
            pthread_mutex_lock(&encoder->lock);
        }
        if (status && !encoder->status)
            encoder->status = status;
        slot->pending--;
        if (!slot->pending && !encoder->status)
            encoder->frames++;
        pthread_cond_broadcast(&encoder->written);
    }
    pthread_mutex_unlock(&encoder->lock);
    return NULL;
}

enum sf_status sf_encoder_create(unsigned threads, const struct sf_encoder_settings *settings,
                                 struct sf_encoder **encoder)
{
    struct sf_encoder *made = calloc(1, sizeof *made);

    *encoder = NULL;
    if (!made)
        return sf_console_fail(SF_ERROR_MEMORY, "out of memory");
    made->settings = *settings;
    pthread_mutex_init(&made->lock, NULL);
    pthread_cond_init(&made->arrived, NULL);
    pthread_cond_init(&made->written, NULL);
    *encoder = made;
    made->threads = calloc(threads, sizeof *made->threads);
    for (; made->threads && made->thread_count < threads; made->thread_count++)
        if (pthread_create(&made->threads[made->thread_count], NULL, work, made) != 0)
            break;
    if (made->thread_count > 0)
        return SF_OK;
    sf_encoder_destroy(encoder);
    return sf_console_fail(SF_ERROR_MEMORY, "no thread can be started");
}

void sf_encoder_push(struct sf_encoder *encoder, unsigned slot, const struct sf_frame *frame, char *const *paths)
{
    pthread_mutex_lock(&encoder->lock);
    encoder->slots[slot] = (struct slot){.frame = *frame, .paths = paths};
    for (unsigned t = 0; t < encoder->settings.target_count; t++) {
        if (!paths[t])
            continue;
        encoder->jobs[(encoder->first + encoder->waiting++) % JOBS_MAX] = (struct job){.slot = slot, .target = t};
        encoder->slots[slot].pending++;
    }
    pthread_cond_broadcast(&encoder->arrived);
    pthread_mutex_unlock(&encoder->lock);
}

enum sf_status sf_encoder_wait(struct sf_encoder *encoder, unsigned slot)
{
    enum sf_status status;

    pthread_mutex_lock(&encoder->lock);
    while (encoder->slots[slot].pending)
        pthread_cond_wait(&encoder->written, &encoder->lock);
    status = encoder->status;
    pthread_mutex_unlock(&encoder->lock);
    return status;
}

uint64_t sf_encoder_frames(struct sf_encoder *encoder)
{
    uint64_t frames;

    pthread_mutex_lock(&encoder->lock);
    frames = encoder->frames;
    pthread_mutex_unlock(&encoder->lock);
    return frames;
}

enum sf_status sf_encoder_destroy(struct sf_encoder **encoder)
{
    struct sf_encoder *gone = *encoder;
    enum sf_status status;

    if (!gone)
        return SF_OK;
    pthread_mutex_lock(&gone->lock);
    gone->closing = true;
    pthread_cond_broadcast(&gone->arrived);
    pthread_mutex_unlock(&gone->lock);
    for (unsigned i = 0; i < gone->thread_count; i++)
        pthread_join(gone->threads[i], NULL);
    status = gone->status;
    pthread_cond_destroy(&gone->arrived);
    pthread_cond_destroy(&gone->written);
    pthread_mutex_destroy(&gone->lock);
    free(gone->threads);
    free(gone);
    *encoder = NULL;
    return status;
}
