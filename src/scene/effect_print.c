/* An effect file as people read it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/file.h"
#include "params/number.h"
#include "scene/effect.h"
#include "scene/load.h"
#include "scene/table_inner.h"

enum { FILE_BYTES_MAX = 4 << 20 };

struct line {
    double begin; /* s */
    size_t order;
    char *text;
};

struct listing {
    struct line *lines;
    size_t count, capacity;
    bool failed; /* memory is out */
};

static void show(struct sf_text *text, const char *before, double value, const char *after)
{
    char number[SF_NUMBER_BYTES];

    sf_number_show(value, number);
    sf_text_printf(text, "%s%s%s", before, number, after);
}

/* When, how long and how often. `what` is taken over, and added to the line. */
static void add_line(struct listing *listing, const struct sf_timing *timing, struct sf_text *what)
{
    const struct sf_clock *clock = &timing->clocks[timing->clock_count - 1];
    struct line line = {.order = listing->count};
    struct sf_text text = {0}, run = {0};

    for (uint32_t i = 0; i < timing->clock_count; i++)
        line.begin += timing->clocks[i].start;
    if (isfinite(sf_clock_run(clock)))
        show(&run, "for ", sf_clock_run(clock), " s");
    else
        sf_text_append(&run, "for ever");
    sf_text_printf(&text, "  %8.3f s  %-14s %s", line.begin, run.data ? run.data : "", what->data ? what->data : "");
    for (uint32_t i = 0; i < timing->clock_count; i++) {
        if (timing->clocks[i].every > 0)
            show(&text, "; every ", timing->clocks[i].every, " s");
        if (timing->clocks[i].times > 0)
            sf_text_printf(&text, ", %d times", (int)timing->clocks[i].times);
    }
    if (timing->fade_in > 0)
        show(&text, "; rises in ", timing->fade_in, " s");
    if (timing->fade_out > 0)
        show(&text, "; falls in ", timing->fade_out, " s");
    listing->failed = listing->failed || text.failed || run.failed || what->failed ||
                      !sf_array_reserve((void **)&listing->lines, listing->count, &listing->capacity, 1, sizeof line);
    sf_text_finish(&run);
    sf_text_finish(what);
    line.text = text.data;
    if (listing->failed)
        sf_text_finish(&text);
    else
        listing->lines[listing->count++] = line;
}

static int compare(const void *a, const void *b)
{
    const struct line *x = a, *y = b;

    if (x->begin != y->begin)
        return x->begin < y->begin ? -1 : 1;
    return x->order < y->order ? -1 : 1;
}

static const char *kind_name(const struct sf_param_group *group, int32_t kind)
{
    return sf_param_kind(group)->names[kind];
}

static void list_steps(const struct sf_scene *scene, struct listing *listing)
{
    for (uint32_t i = 0; i < scene->emitter_count; i++) {
        const struct sf_emitter *emitter = &scene->emitters[i];
        struct sf_text what = {0};

        sf_text_printf(&what, "emitter: %s", kind_name(&sf_scene_emitter_group, emitter->kind));
        if (emitter->burst)
            sf_text_printf(&what, ", %d at once", (int)emitter->burst);
        if (emitter->rate > 0)
            show(&what, ", ", emitter->rate, " a second");
        if (emitter->path_count)
            sf_text_append(&what, ", along a path");
        add_line(listing, emitter->timing, &what);
    }
    for (uint32_t i = 0; i < scene->light_count; i++) {
        struct sf_text what = {0};

        sf_text_printf(&what, "light: %s", kind_name(&sf_scene_light_group, scene->lights[i].kind));
        show(&what, ", intensity ", scene->lights[i].intensity, scene->lights[i].flicker > 0 ? ", flickering" : "");
        add_line(listing, scene->lights[i].timing, &what);
    }
    for (uint32_t i = 0; i < scene->flash_count; i++) {
        struct sf_text what = {0};

        show(&what, "flash: strength ", scene->flashes[i].strength, "");
        add_line(listing, scene->flashes[i].timing, &what);
    }
    for (uint32_t i = 0; i < scene->shake_count; i++) {
        struct sf_text what = {0};

        show(&what, "shake: ", scene->shakes[i].amplitude, " m");
        show(&what, ", ", scene->shakes[i].angle, " deg");
        add_line(listing, scene->shakes[i].timing, &what);
    }
}

static enum sf_status print_scene(struct sf_scene *scene, const char *path, const struct sf_log *log, char **out)
{
    struct listing listing = {0};
    struct sf_text text = {0};

    list_steps(scene, &listing);
    if (listing.count)
        qsort(listing.lines, listing.count, sizeof *listing.lines, compare);
    sf_text_printf(&text, "%s: ok: %u emitter%s, %u light%s, %u flash%s, %u shake%s\n", path,
                   (unsigned)scene->emitter_count, scene->emitter_count == 1 ? "" : "s", (unsigned)scene->light_count,
                   scene->light_count == 1 ? "" : "s", (unsigned)scene->flash_count,
                   scene->flash_count == 1 ? "" : "es", (unsigned)scene->shake_count,
                   scene->shake_count == 1 ? "" : "s");
    for (size_t i = 0; i < listing.count; i++) {
        sf_text_printf(&text, "%s\n", listing.lines[i].text);
        free(listing.lines[i].text);
    }
    free(listing.lines);
    if (text.failed || listing.failed) {
        sf_text_finish(&text);
        return sf_fail(log, SF_ERROR_MEMORY, "%s: out of memory", path);
    }
    *out = text.data;
    return SF_OK;
}

/* A scene that has the effect and nothing else. */
static enum sf_status load(struct sf_scene *scene, const char *path, const struct sf_log *log)
{
    struct sf_param_reader reader = {.name = path, .log = log, .arena = &scene->arena};
    const char *slash = strrchr(path, '/');
    enum sf_status status;

    sf_param_defaults(&sf_scene_group, scene);
    scene->path = path;
    scene->effects[scene->effect_count++] = (struct sf_placed_effect){.file = slash ? slash + 1 : path, .scale = 1};
    status = sf_scene_load_effects(scene, &reader);
    if (status == SF_OK)
        status = sf_scene_load_assets(scene, &reader);
    return status;
}

enum sf_status sf_effect_print(const char *path, const struct sf_log *log, char **text)
{
    struct sf_scene *scene = calloc(1, sizeof *scene);
    char *data = NULL;
    size_t bytes = 0;
    enum sf_status status;

    *text = NULL;
    if (!scene)
        return sf_fail(log, SF_ERROR_MEMORY, "%s: out of memory", path);
    /* First by itself: a file that is not there is no fault of a scene. */
    status = sf_file_read(path, FILE_BYTES_MAX, log, &data, &bytes);
    free(data);
    if (status == SF_OK)
        status = load(scene, path, log);
    if (status == SF_OK)
        status = print_scene(scene, path, log, text);
    sf_scene_destroy(&scene);
    return status;
}
