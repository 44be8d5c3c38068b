/* sfumato texture: an atlas of smoke, made once and written to every file that was named. */
#include "texture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "console.h"
#include "files.h"
#include "progress.h"
#include "sfumato/sfumato.h"

enum { FILES_MAX = 2 * SF_TEXTURE_OUTPUTS_MAX };

struct file {
    char *path;
    bool exr;
    uint32_t channels; /* enum sf_texture_channels bits */
};

struct files {
    struct file items[FILES_MAX];
    size_t count;
};

/* ---- which files ---- */

static uint32_t channels_of(const char *word)
{
    static const struct {
        const char *word;
        uint32_t channels;
    } known[] = {{"all", SF_TEXTURE_ALL},
                 {"color", SF_TEXTURE_COLOR | SF_TEXTURE_ALPHA},
                 {"alpha", SF_TEXTURE_ALPHA},
                 {"normal", SF_TEXTURE_NORMAL},
                 {"height", SF_TEXTURE_HEIGHT}};

    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(known[i].word, word) == 0)
            return known[i].channels;
    return 0;
}

/* `part` goes between the name's stem, of that length, and its ending. */
static enum sf_status add_file(struct files *files, const char *output, size_t stem, const char *part, bool exr,
                               uint32_t channels)
{
    size_t room = strlen(output) + strlen(part) + 1;
    struct file *file = &files->items[files->count];

    *file = (struct file){.path = malloc(room), .exr = exr, .channels = channels};
    if (!file->path)
        return sf_console_fail(SF_ERROR_MEMORY, "out of memory");
    files->count++;
    snprintf(file->path, room, "%.*s%s%s", (int)stem, output, part, output + stem);
    for (size_t i = 0; i + 1 < files->count; i++)
        if (strcmp(files->items[i].path, file->path) == 0)
            return sf_console_fail(SF_ERROR_USAGE, "%s: would be written twice", file->path);
    return SF_OK;
}

static enum sf_status add_output(struct files *files, const char *output, uint32_t channels)
{
    const char *slash = strrchr(output, '/'), *name = slash ? slash + 1 : output, *dot = strrchr(name, '.');
    size_t stem = dot ? (size_t)(dot - output) : 0;
    enum sf_status status;

    if (dot && dot > name && strcasecmp(dot, ".exr") == 0)
        return add_file(files, output, stem, "", true, channels);
    if (!dot || dot == name || strcasecmp(dot, ".png") != 0)
        return sf_console_fail(SF_ERROR_USAGE, "%s: the name must end in .exr or .png", output);
    if (channels != SF_TEXTURE_ALL)
        return add_file(files, output, stem, "", false, channels);
    status = add_file(files, output, stem, ".color", false, SF_TEXTURE_COLOR | SF_TEXTURE_ALPHA);
    if (!status)
        status = add_file(files, output, stem, ".normal", false, SF_TEXTURE_NORMAL | SF_TEXTURE_HEIGHT);
    return status;
}

static enum sf_status name_files(const struct sf_arguments *arguments, struct files *files)
{
    enum sf_status status = SF_OK;

    for (size_t i = 0; i < arguments->files.count && !status; i++)
        status = add_output(files, arguments->files.items[i], channels_of(arguments->channels));
    for (size_t i = 0; i < files->count && !status; i++)
        status = sf_new_file_check(files->items[i].path, arguments->overwrite);
    return status;
}

/* ---- making and writing ---- */

static bool show_progress(void *user, uint64_t done, uint64_t total)
{
    struct sf_progress *progress = user;

    progress->total = total;
    sf_progress_show(progress, done);
    return !sf_interrupted();
}

static enum sf_status make(const struct sf_arguments *arguments, struct sf_texture **texture)
{
    struct sf_texture_options options = {.kind = arguments->kind,
                                         .tiles_x = arguments->tiles.width,
                                         .tiles_y = arguments->tiles.height,
                                         .width = arguments->size.width,
                                         .height = arguments->size.height,
                                         .seed = arguments->seed,
                                         .octaves = arguments->octaves,
                                         .lacunarity = (float)arguments->lacunarity.value,
                                         .roughness = (float)arguments->roughness.value,
                                         .scale = (float)arguments->scale.value,
                                         .ragged = (float)arguments->ragged.value,
                                         .softness = (float)arguments->softness.value,
                                         .density = (float)arguments->density.value,
                                         .mottle = (float)arguments->mottle.value,
                                         .clones = arguments->clones,
                                         .loop = arguments->loop,
                                         .changes = arguments->changes,
                                         .tileable = arguments->tileable,
                                         .threads = arguments->threads};
    struct sf_progress progress;
    enum sf_status status;

    sf_progress_begin(&progress, "making", "rows", (uint64_t)options.tiles_x * options.tiles_y * options.height);
    status = sf_texture_create(&options, show_progress, &progress, sf_console_log(), texture);
    sf_progress_end(&progress);
    if (status == SF_ERROR_INTERRUPTED)
        sf_console_note("interrupted: nothing is written");
    return status;
}

static enum sf_status write_file(const struct sf_arguments *arguments, const struct sf_texture *texture,
                                 const struct file *file)
{
    struct sf_exr_options exr = {.compression = arguments->compression, .half = strcmp(arguments->type, "half") == 0};

    if (file->exr)
        return sf_texture_write_exr(texture, file->path, file->channels, &exr, sf_console_log());
    return sf_texture_write_png(texture, file->path, file->channels, strcmp(arguments->bits, "16") == 0 ? 16 : 8,
                                sf_console_log());
}

static void report(const struct sf_texture *texture, double seconds)
{
    struct sf_texture_info info;
    double slope, correlation;
    char time[32];

    sf_texture_describe(texture, &info);
    sf_texture_lighting(texture, &slope, &correlation);
    sf_duration_print(seconds, time, sizeof time);
    sf_console_note("%ux%u tiles of %ux%u in %s; light in the colour: slope %.3f, correlation %.2f", info.tiles_x,
                    info.tiles_y, info.width / info.tiles_x, info.height / info.tiles_y, time, slope, correlation);
}

enum sf_status sf_texture_run(const struct sf_arguments *arguments)
{
    struct files files = {.count = 0};
    struct sf_texture *texture = NULL;
    uint64_t begin = sf_now_ns();
    enum sf_status status = name_files(arguments, &files);

    if (!status)
        status = make(arguments, &texture);
    for (size_t i = 0; i < files.count && !status; i++) {
        status = write_file(arguments, texture, &files.items[i]);
        if (!status)
            sf_console_note("wrote %s", files.items[i].path);
    }
    if (!status)
        report(texture, (double)(sf_now_ns() - begin) * 1e-9);
    sf_texture_destroy(&texture);
    for (size_t i = 0; i < files.count; i++)
        free(files.items[i].path);
    return status;
}
