#include "session.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "console.h"
#include "progress.h"

void sf_session_sets_finish(char **sets, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        free(sets[i]);
    free(sets);
}

static char *join(const char *a, const char *b)
{
    size_t room = strlen(a) + strlen(b) + 1;
    char *text = malloc(room);

    if (text)
        snprintf(text, room, "%s%s", a, b);
    return text;
}

enum sf_status sf_session_sets(const struct sf_arguments *arguments, char ***sets, uint32_t *count)
{
    size_t wanted = arguments->sets.count + (arguments->method ? 1 : 0);
    bool failed;

    *count = 0;
    *sets = malloc((wanted + 1) * sizeof **sets);
    failed = !*sets;
    for (size_t i = 0; i < wanted && !failed; i++) {
        bool last = i == arguments->sets.count;
        char *text = join(last ? "method=" : "", last ? arguments->method : arguments->sets.items[i]);

        failed = !text;
        if (text)
            (*sets)[(*count)++] = text;
    }
    if (!failed)
        return SF_OK;
    sf_session_sets_finish(*sets, *count);
    *sets = NULL;
    *count = 0;
    return sf_console_fail(SF_ERROR_MEMORY, "out of memory");
}

enum sf_status sf_session_scene(const struct sf_arguments *arguments, const char *path, struct sf_scene **scene)
{
    char **sets;
    uint32_t count;
    enum sf_status status = sf_session_sets(arguments, &sets, &count);

    if (status)
        return status;
    status = sf_scene_load(path, (const char *const *)sets, count, sf_console_log(), scene);
    sf_session_sets_finish(sets, count);
    return status;
}

enum sf_status sf_session_device(const struct sf_arguments *arguments, const struct sf_surface_source *surface,
                                 struct sf_device **device)
{
    struct sf_device_options options = {.device = arguments->device,
                                        .validate = arguments->validate,
                                        .budget_bytes = (uint64_t)arguments->memory << 20,
                                        .no_cache = arguments->no_cache,
                                        .surface = surface};

    return sf_device_create(&options, sf_console_log(), device);
}

enum sf_status sf_session_size(const struct sf_arguments *arguments, const struct sf_device *device)
{
    struct sf_argument_size size = arguments->size;
    struct sf_device_info info;

    sf_device_describe(device, &info);
    if (size.width > info.max_image_side || size.height > info.max_image_side)
        return sf_console_fail(SF_ERROR_USAGE, "--size %ux%u: each side must be 1 to %u pixels on %s", size.width,
                               size.height, info.max_image_side, info.name);
    return SF_OK;
}

enum sf_status sf_session_validated(const struct sf_arguments *arguments, const struct sf_device *device)
{
    uint32_t messages = arguments->validate && device ? sf_device_validation_messages(device) : 0;

    if (messages)
        return sf_console_fail(SF_ERROR_INTERNAL, "the validation layers gave %u message%s", messages,
                               messages == 1 ? "" : "s");
    return SF_OK;
}

enum sf_status sf_session_frames(const struct sf_arguments *arguments, uint32_t **frames, size_t *count)
{
    return sf_frames_parse(arguments->frames, sf_console_log(), frames, count);
}

static bool show(struct sf_progress *progress, const char *what, const char *unit, uint64_t done, uint64_t total)
{
    if (!progress->what)
        sf_progress_begin(progress, what, unit, total);
    progress->total = total;
    sf_progress_show(progress, done);
    return !sf_interrupted();
}

static bool show_steps(void *user, uint64_t done, uint64_t total)
{
    return show(user, "simulating", "steps", done, total);
}

static bool show_plays(void *user, uint64_t done, uint64_t total)
{
    return show(user, "refining", "steps", done, total);
}

enum sf_status sf_session_seek(struct sf_renderer *renderer, uint32_t frame)
{
    struct sf_progress progress = {0};
    enum sf_status status = sf_renderer_seek(renderer, frame, show_steps, &progress);

    sf_progress_end(&progress);
    return status;
}

enum sf_status sf_session_refine(struct sf_renderer *renderer, uint32_t frame)
{
    struct sf_progress progress = {0};
    enum sf_status status = sf_renderer_refine(renderer, frame, show_plays, &progress);

    if (progress.what)
        sf_progress_end(&progress);
    return status;
}
