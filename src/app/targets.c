#include "targets.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "console.h"
#include "files.h"
#include "session.h"

static const struct {
    const char *extension;
    enum sf_target_kind kind;
} formats[] = {{".exr", SF_TARGET_EXR}, {".png", SF_TARGET_PNG}};

static enum sf_status out_of_memory(void)
{
    return sf_console_fail(SF_ERROR_MEMORY, "out of memory");
}

/* "scenes/plume.json" -> "plume.####.exr", in the current folder. */
static char *default_pattern(const char *scene_path)
{
    static const char tail[] = ".####.exr";
    const char *slash = strrchr(scene_path, '/'), *stem = slash ? slash + 1 : scene_path, *dot = strrchr(stem, '.');
    size_t length = dot && dot > stem ? (size_t)(dot - stem) : strlen(stem);
    char *pattern = malloc(length + sizeof tail);

    if (pattern)
        snprintf(pattern, length + sizeof tail, "%.*s%s", (int)length, stem, tail);
    return pattern;
}

static enum sf_status add_target(struct sf_targets *targets, char *pattern)
{
    const char *slash, *name, *dot;
    struct sf_target *target = &targets->items[targets->count];

    if (!pattern)
        return out_of_memory();
    target->pattern = pattern;
    targets->count++;
    slash = strrchr(pattern, '/');
    name = slash ? slash + 1 : pattern;
    dot = strrchr(name, '.');
    for (size_t i = 0; dot && dot > name && i < sizeof formats / sizeof *formats; i++)
        if (strcasecmp(dot, formats[i].extension) == 0) {
            target->kind = formats[i].kind;
            return SF_OK;
        }
    return sf_console_fail(SF_ERROR_USAGE, "--output %s: the name must end in .exr or .png", pattern);
}

static enum sf_status collect_targets(const struct sf_arguments *arguments, const char *scene_path,
                                      struct sf_targets *targets)
{
    enum sf_status status = SF_OK;

    if (arguments->outputs.count > SF_TARGETS_MAX)
        return sf_console_fail(SF_ERROR_USAGE, "--output: at most %d can be given", (int)SF_TARGETS_MAX);
    if (arguments->outputs.count == 0)
        return add_target(targets, default_pattern(scene_path));
    for (size_t i = 0; i < arguments->outputs.count && !status; i++)
        status = add_target(targets, strdup(arguments->outputs.items[i]));
    return status;
}

static enum sf_status name_files(struct sf_targets *targets)
{
    bool many = targets->frame_count > 1;

    targets->paths = calloc(targets->frame_count * targets->count, sizeof *targets->paths);
    if (!targets->paths)
        return out_of_memory();
    for (size_t f = 0; f < targets->frame_count; f++) {
        char **paths = targets->paths + f * targets->count;

        for (size_t t = 0; t < targets->count; t++) {
            enum sf_status status =
                sf_sequence_name(targets->items[t].pattern, targets->frames[f], many, sf_console_log(), &paths[t]);

            if (status)
                return status;
            for (size_t other = 0; other < t; other++)
                if (strcmp(paths[other], paths[t]) == 0)
                    return sf_console_fail(SF_ERROR_USAGE, "--output %s: is given twice", paths[t]);
        }
    }
    return SF_OK;
}

/* Folders of neighbouring frames are mostly the same, so only a change of folder is looked at. */
static enum sf_status check_folders(const struct sf_targets *targets)
{
    for (size_t t = 0; t < targets->count; t++) {
        const char *last = NULL;
        size_t last_length = 0;

        for (size_t f = 0; f < targets->frame_count; f++) {
            const char *path = targets->paths[f * targets->count + t], *slash = strrchr(path, '/');
            size_t length = slash ? (size_t)(slash - path) + 1 : 0;
            enum sf_status status = SF_OK;

            if (!last || length != last_length || strncmp(path, last, length) != 0)
                status = sf_folder_check(path);
            if (status)
                return status;
            last = path;
            last_length = length;
        }
    }
    return SF_OK;
}

static enum sf_status check_existing(const struct sf_arguments *arguments, struct sf_targets *targets)
{
    const char *first = NULL;
    size_t existing = 0, count = targets->frame_count * targets->count;

    for (size_t i = 0; i < count; i++) {
        struct stat info;

        /* A dangling link is there as well: the rename would replace it. */
        if (lstat(targets->paths[i], &info) != 0)
            continue;
        if (S_ISDIR(info.st_mode))
            return sf_console_fail(SF_ERROR_IO, "%s: is a folder", targets->paths[i]);
        if (arguments->skip_existing) {
            free(targets->paths[i]);
            targets->paths[i] = NULL;
            targets->skipped++;
            continue;
        }
        if (!existing++)
            first = targets->paths[i];
    }
    if (existing == 0 || arguments->overwrite)
        return SF_OK;
    if (existing == 1)
        return sf_console_fail(SF_ERROR_IO, "%s: exists (--overwrite replaces it, --skip-existing leaves it)", first);
    return sf_console_fail(SF_ERROR_IO,
                           "%s: exists, and %zu more (--overwrite replaces them, --skip-existing leaves them)", first,
                           existing - 1);
}

/* Frames of which every file is skipped go out of the list. */
static void drop_done_frames(struct sf_targets *targets)
{
    size_t kept = 0;

    for (size_t f = 0; f < targets->frame_count; f++) {
        char **paths = targets->paths + f * targets->count;
        size_t files = 0;

        for (size_t t = 0; t < targets->count; t++)
            files += paths[t] != NULL;
        if (files == 0)
            continue;
        memmove(targets->paths + kept * targets->count, paths, targets->count * sizeof *paths);
        targets->frames[kept++] = targets->frames[f];
        targets->files += files;
    }
    targets->frame_count = kept;
}

enum sf_status sf_targets_init(const struct sf_arguments *arguments, const char *scene_path, struct sf_targets *targets)
{
    enum sf_status status;

    *targets = (struct sf_targets){0};
    if (arguments->overwrite && arguments->skip_existing)
        return sf_console_fail(SF_ERROR_USAGE, "--overwrite and --skip-existing exclude each other");
    status = collect_targets(arguments, scene_path, targets);
    if (!status)
        status = sf_session_frames(arguments, &targets->frames, &targets->frame_count);
    if (!status)
        status = name_files(targets);
    if (!status)
        status = check_folders(targets);
    if (!status)
        status = check_existing(arguments, targets);
    if (!status)
        drop_done_frames(targets);
    return status;
}

void sf_targets_finish(struct sf_targets *targets)
{
    for (size_t i = 0; targets->paths && i < targets->frame_count * targets->count; i++)
        free(targets->paths[i]);
    for (size_t t = 0; t < targets->count; t++)
        free(targets->items[t].pattern);
    free(targets->paths);
    free(targets->frames);
    *targets = (struct sf_targets){0};
}
