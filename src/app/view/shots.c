#include "shots.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "log_line.h"

enum { WAITING_MAX = 4, NAME_MAX_BYTES = 64, NUMBERS_MAX = 100000 };

/* A frame that is to be written; it owns all that it points to. */
struct shot {
    char *base; /* "shots/plume.0048", without number and ending */
    struct sf_frame frame;
    char tone[NAME_MAX_BYTES];
    float exposure;
    double fps;
    uint64_t scene_hash;
    bool recorded;
};

struct sf_shots {
    const struct sf_log *log;
    char *folder;
    char *sequence; /* folder of the one that is being recorded; NULL: none */
    uint32_t recorded;
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t arrived, written;
    struct shot waiting[WAITING_MAX]; /* a ring; the first one is being written */
    unsigned first, count;
    bool closing;
};

static void finish_shot(struct shot *shot)
{
    free(shot->base);
    free((void *)shot->frame.color);
    free((void *)shot->frame.color_float);
    free((void *)shot->frame.depth);
    free((void *)shot->frame.smoke);
    free((void *)shot->frame.smoke_depths);
    *shot = (struct shot){0};
}

/* ---- the writer ---- */

/* Takes the name for us with an empty file. */
static bool reserve(const char *path)
{
    int file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);

    if (file >= 0)
        close(file);
    return file >= 0;
}

/* The first pair of names that is free, reserved: paths[0] PNG, paths[1] EXR, each with `room` bytes. False: errno says
 * why. */
static bool reserve_pair(const char *base, char *const paths[2], size_t room)
{
    static const char *const endings[] = {"png", "exr"};

    for (unsigned number = 1; number < NUMBERS_MAX; number++) {
        int kept = 0;

        for (int i = 0; i < 2; i++) {
            if (number > 1)
                snprintf(paths[i], room, "%s-%u.%s", base, number, endings[i]);
            else
                snprintf(paths[i], room, "%s.%s", base, endings[i]);
        }
        while (kept < 2 && reserve(paths[kept]))
            kept++;
        if (kept == 2)
            return true;
        int error = errno;
        if (kept == 1)
            unlink(paths[0]);
        errno = error;
        if (error != EEXIST)
            return false;
    }
    return false;
}

static void write_shot(const struct sf_shots *shots, const struct shot *shot)
{
    size_t room = strlen(shot->base) + 32;
    char *text = malloc(2 * room), *const paths[2] = {text, text ? text + room : NULL}, hash[17];
    struct sf_exr_options exr = {
        .compression = "zip", .half = shot->frame.color != NULL, .fps = shot->fps, .scene_hash = hash};
    enum sf_log_level level = shot->recorded ? SF_LOG_DEBUG : SF_LOG_INFO;

    if (!text) {
        sf_log_fail(shots->log, SF_ERROR_MEMORY, "%s: out of memory", shot->base);
        return;
    }
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)shot->scene_hash);
    if (!reserve_pair(shot->base, paths, room)) {
        sf_log_fail(shots->log, SF_ERROR_IO, "%s: cannot be written: %s", paths[0], strerror(errno));
        free(text);
        return;
    }
    /* The writers have said what went wrong; a name that was reserved for nothing is given back. */
    if (sf_frame_write_png(&shot->frame, paths[0], shot->tone, shot->exposure, shots->log) == SF_OK)
        sf_log_line(shots->log, level, "wrote %s", paths[0]);
    else
        unlink(paths[0]);
    if (sf_frame_write_exr(&shot->frame, paths[1], &exr, shots->log) == SF_OK)
        sf_log_line(shots->log, level, "wrote %s", paths[1]);
    else
        unlink(paths[1]);
    free(text);
}

static void *work(void *user)
{
    struct sf_shots *shots = user;

    pthread_mutex_lock(&shots->lock);
    for (;;) {
        struct shot *shot = &shots->waiting[shots->first];

        while (!shots->count && !shots->closing)
            pthread_cond_wait(&shots->arrived, &shots->lock);
        if (!shots->count)
            break;
        pthread_mutex_unlock(&shots->lock);
        write_shot(shots, shot);
        finish_shot(shot);
        pthread_mutex_lock(&shots->lock);
        shots->first = (shots->first + 1) % WAITING_MAX;
        shots->count--;
        pthread_cond_broadcast(&shots->written);
    }
    pthread_mutex_unlock(&shots->lock);
    return NULL;
}

enum sf_status sf_shots_create(const char *folder, const struct sf_log *log, struct sf_shots **shots)
{
    struct sf_shots *made = calloc(1, sizeof *made);

    *shots = NULL;
    if (!made || !(made->folder = strdup(folder))) {
        free(made);
        return sf_log_fail(log, SF_ERROR_MEMORY, "out of memory");
    }
    made->log = log;
    pthread_mutex_init(&made->lock, NULL);
    pthread_cond_init(&made->arrived, NULL);
    pthread_cond_init(&made->written, NULL);
    if (pthread_create(&made->thread, NULL, work, made) == 0) {
        *shots = made;
        return SF_OK;
    }
    pthread_cond_destroy(&made->arrived);
    pthread_cond_destroy(&made->written);
    pthread_mutex_destroy(&made->lock);
    free(made->folder);
    free(made);
    return sf_log_fail(log, SF_ERROR_MEMORY, "no thread can be started");
}

void sf_shots_destroy(struct sf_shots **shots)
{
    struct sf_shots *gone = *shots;

    if (!gone)
        return;
    pthread_mutex_lock(&gone->lock);
    gone->closing = true;
    pthread_cond_broadcast(&gone->arrived);
    pthread_mutex_unlock(&gone->lock);
    pthread_join(gone->thread, NULL);
    pthread_cond_destroy(&gone->arrived);
    pthread_cond_destroy(&gone->written);
    pthread_mutex_destroy(&gone->lock);
    free(gone->sequence);
    free(gone->folder);
    free(gone);
    *shots = NULL;
}

/* ---- folders ---- */

/* Is it a folder now? False: errno says why not. */
static bool make_folder(const char *path)
{
    struct stat info;
    int error = mkdir(path, 0777) == 0 ? 0 : errno;

    if (!error)
        return true;
    if (stat(path, &info) == 0) {
        if (S_ISDIR(info.st_mode))
            return true;
        error = ENOTDIR;
    }
    errno = error;
    return false;
}

/* With those above it. */
static bool make_folders(const char *folder)
{
    char *path = strdup(folder);
    bool ok = path != NULL;

    for (char *at = path; ok && *at; at++) {
        if (*at != '/' || at == path)
            continue;
        *at = '\0';
        ok = make_folder(path);
        *at = '/';
    }
    free(path);
    return ok && make_folder(folder);
}

static enum sf_status prepare_folder(const struct sf_shots *shots)
{
    if (make_folders(shots->folder))
        return SF_OK;
    return sf_log_fail(shots->log, SF_ERROR_IO, "folder %s: cannot be made: %s", shots->folder, strerror(errno));
}

enum sf_status sf_shots_record(struct sf_shots *shots, const char *stem)
{
    size_t room = strlen(shots->folder) + strlen(stem) + 16;
    char *path = malloc(room);
    enum sf_status status;
    bool made = false;

    sf_shots_stop(shots);
    status = path ? prepare_folder(shots) : sf_log_fail(shots->log, SF_ERROR_MEMORY, "out of memory");
    for (unsigned number = 1; number < NUMBERS_MAX && !status && !made; number++) {
        snprintf(path, room, "%s/%s-%03u", shots->folder, stem, number);
        made = mkdir(path, 0777) == 0;
        if (!made && errno != EEXIST)
            break;
    }
    if (!status && !made)
        status = sf_log_fail(shots->log, SF_ERROR_IO, "folder %s: cannot be made: %s", path, strerror(errno));
    if (status) {
        free(path);
        return status;
    }
    shots->sequence = path;
    shots->recorded = 0;
    sf_log_line(shots->log, SF_LOG_INFO, "recording into %s", path);
    return SF_OK;
}

void sf_shots_stop(struct sf_shots *shots)
{
    free(shots->sequence);
    shots->sequence = NULL;
}

bool sf_shots_recording(const struct sf_shots *shots)
{
    return shots->sequence != NULL;
}

uint32_t sf_shots_recorded(const struct sf_shots *shots)
{
    return shots->recorded;
}

/* ---- taking ---- */

/* `values` of the pixels, copied; NULL stays NULL. */
static bool copy_pixels(const struct sf_frame *frame, const void *pixels, size_t bytes, const void **copy)
{
    size_t size = (size_t)frame->width * frame->height * bytes;
    void *to;

    *copy = NULL;
    if (!pixels)
        return true;
    if (!(to = malloc(size)))
        return false;
    memcpy(to, pixels, size);
    *copy = to;
    return true;
}

static bool copy_frame(const struct sf_frame *frame, struct sf_frame *to)
{
    const void *color, *color_float, *depth, *smoke, *depths;
    bool ok;

    /* All are asked for, so that all are either a copy or NULL. */
    ok = copy_pixels(frame, frame->color, 4 * sizeof(uint16_t), &color);
    ok &= copy_pixels(frame, frame->color_float, 4 * sizeof(float), &color_float);
    ok &= copy_pixels(frame, frame->depth, sizeof(float), &depth);
    ok &= copy_pixels(frame, frame->smoke, 4 * sizeof(uint16_t), &smoke);
    ok &= copy_pixels(frame, frame->smoke_depths, 4 * sizeof(float), &depths);
    *to = *frame;
    to->color = color;
    to->color_float = color_float;
    to->depth = depth;
    to->smoke = smoke;
    to->smoke_depths = depths;
    to->inspected = NULL;
    to->inspected_words = NULL;
    return ok;
}

static char *base_of(const struct sf_shots *shots, const char *stem, uint32_t frame)
{
    const char *folder = shots->sequence ? shots->sequence : shots->folder;
    size_t room = strlen(folder) + strlen(stem) + 16;
    char *base = malloc(room);

    if (base && shots->sequence)
        snprintf(base, room, "%s/%04u", folder, frame);
    else if (base)
        snprintf(base, room, "%s/%s.%04u", folder, stem, frame);
    return base;
}

enum sf_status sf_shots_take(struct sf_shots *shots, const char *stem, const struct sf_frame *frame, const char *tone,
                             float exposure, double fps, uint64_t scene_hash)
{
    struct shot shot = {
        .exposure = exposure, .fps = fps, .scene_hash = scene_hash, .recorded = shots->sequence != NULL};
    enum sf_status status = shots->sequence ? SF_OK : prepare_folder(shots);

    if (status)
        return status;
    if (!frame->color && !frame->color_float)
        return sf_log_fail(shots->log, SF_ERROR_INTERNAL, "frame %u has no picture to write", frame->frame);
    snprintf(shot.tone, sizeof shot.tone, "%s", tone);
    shot.base = base_of(shots, stem, frame->frame);
    if (!copy_frame(frame, &shot.frame) || !shot.base) {
        finish_shot(&shot);
        return sf_log_fail(shots->log, SF_ERROR_MEMORY, "frame %u: out of memory", frame->frame);
    }
    pthread_mutex_lock(&shots->lock);
    while (shots->count == WAITING_MAX)
        pthread_cond_wait(&shots->written, &shots->lock);
    shots->waiting[(shots->first + shots->count++) % WAITING_MAX] = shot;
    pthread_cond_broadcast(&shots->arrived);
    pthread_mutex_unlock(&shots->lock);
    if (shots->sequence)
        shots->recorded++;
    return SF_OK;
}
