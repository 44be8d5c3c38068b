#include "session.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "console.h"
#include "progress.h"

enum sf_status sf_session_scene(const struct sf_arguments *arguments, const char *path, struct sf_scene **scene)
{
    size_t count = arguments->sets.count, room = arguments->method ? strlen(arguments->method) + sizeof "method=" : 1;
    const char **sets = malloc((count + 1) * sizeof *sets);
    char *method = malloc(room);
    enum sf_status status;

    if (!sets || !method) {
        free(sets);
        free(method);
        return sf_console_fail(SF_ERROR_MEMORY, "out of memory");
    }
    for (size_t i = 0; i < count; i++)
        sets[i] = arguments->sets.items[i];
    if (arguments->method) {
        snprintf(method, room, "method=%s", arguments->method);
        sets[count++] = method;
    }
    status = sf_scene_load(path, sets, (uint32_t)count, sf_console_log(), scene);
    free(sets);
    free(method);
    return status;
}

enum sf_status sf_session_device(const struct sf_arguments *arguments, struct sf_device **device)
{
    struct sf_device_options options = {.device = arguments->device,
                                        .validate = arguments->validate,
                                        .budget_bytes = (uint64_t)arguments->memory << 20,
                                        .no_cache = arguments->no_cache};

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

static bool show_steps(void *user, uint64_t done, uint64_t total)
{
    struct sf_progress *progress = user;

    if (!progress->what)
        sf_progress_begin(progress, "simulating", "steps", total);
    progress->total = total;
    sf_progress_show(progress, done);
    return !sf_interrupted();
}

enum sf_status sf_session_seek(struct sf_renderer *renderer, uint32_t frame)
{
    struct sf_progress progress = {0};
    enum sf_status status = sf_renderer_seek(renderer, frame, show_steps, &progress);

    sf_progress_end(&progress);
    return status;
}
