/* bench --compare: this run against an older report, pass by pass. It never fails for being slower. */
#include "bench.h"

#include <errno.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "console.h"

struct sf_baseline {
    const char *path;
    json_t *root;
};

static double number(const json_t *object, const char *key)
{
    return json_number_value(json_object_get(object, key));
}

enum sf_status sf_baseline_load(const char *path, struct sf_baseline **baseline)
{
    FILE *file = fopen(path, "rb");
    json_error_t error;
    json_t *root;

    *baseline = NULL;
    if (!file)
        return sf_console_fail(SF_ERROR_IO, "--compare %s: %s", path, strerror(errno));
    root = json_loadf(file, JSON_REJECT_DUPLICATES, &error);
    fclose(file);
    if (!root)
        return sf_console_fail(SF_ERROR_USAGE, "--compare %s: line %d: %s", path, error.line, error.text);
    if (!json_is_array(json_object_get(root, "passes")) || !json_is_object(json_object_get(root, "frame"))) {
        json_decref(root);
        return sf_console_fail(SF_ERROR_USAGE, "--compare %s: is not a report of sfumato bench --json", path);
    }
    *baseline = calloc(1, sizeof **baseline);
    if (!*baseline) {
        json_decref(root);
        return sf_console_fail(SF_ERROR_MEMORY, "out of memory");
    }
    **baseline = (struct sf_baseline){.path = path, .root = root};
    return SF_OK;
}

void sf_baseline_destroy(struct sf_baseline **baseline)
{
    if (!*baseline)
        return;
    json_decref((*baseline)->root);
    free(*baseline);
    *baseline = NULL;
}

static void warn_difference(const struct sf_baseline *baseline, const char *what, const char *old, const char *now)
{
    if (!old || strcmp(old, now) != 0)
        sf_console_say(SF_LOG_WARNING, "--compare %s: its %s is %s, not %s: the times are of different things",
                       baseline->path, what, old ? old : "missing", now);
}

static void check_sameness(const struct sf_baseline *baseline, const struct sf_bench *bench)
{
    const json_t *root = baseline->root, *device = json_object_get(root, "device");
    char old[64], now[64];

    warn_difference(baseline, "device", json_string_value(json_object_get(device, "name")), bench->device.name);
    warn_difference(baseline, "scene's hash", json_string_value(json_object_get(root, "scene_hash")), bench->hash);
    warn_difference(baseline, "frame list", json_string_value(json_object_get(root, "frames")),
                    bench->arguments->frames);
    snprintf(old, sizeof old, "%.0fx%.0f", number(root, "width"), number(root, "height"));
    snprintf(now, sizeof now, "%ux%u", bench->arguments->size.width, bench->arguments->size.height);
    warn_difference(baseline, "size", old, now);
}

static void print_row(const char *name, const json_t *old, const struct sf_statistics *now)
{
    double old_min = number(old, "min_ns"), old_median = number(old, "median_ns");

    if (!old || old_min <= 0 || old_median <= 0) {
        printf("%-28s %10s %10.3f %9s %9s\n", name, "-", now->median * 1e-6, "new", "");
        return;
    }
    printf("%-28s %10.3f %10.3f %8.2fx %8.2fx\n", name, old_median * 1e-6, now->median * 1e-6, now->median / old_median,
           now->min / old_min);
}

static const json_t *find_pass(const json_t *passes, const char *name)
{
    size_t index;
    const json_t *row;

    json_array_foreach(passes, index, row)
    {
        const char *other = json_string_value(json_object_get(row, "name"));

        if (other && strcmp(other, name) == 0)
            return row;
    }
    return NULL;
}

static bool ran(const struct sf_bench *bench, const char *name)
{
    for (size_t i = 0; i < bench->pass_count; i++)
        if (strcmp(bench->passes[i].name, name) == 0)
            return true;
    return false;
}

void sf_baseline_compare(const struct sf_baseline *baseline, struct sf_bench *bench)
{
    const struct {
        const char *key, *title;
        struct sf_samples *samples;
    } wholes[] = {
        {"simulation", "simulation", &bench->simulation},        {"picture", "picture", &bench->picture},
        {"frame", "frame on the device", &bench->span},          {"wall", "wall, one frame at a time", &bench->wall},
        {"pipelined", "wall, two in flight", &bench->pipelined}, {"record", "CPU, recording", &bench->record}};
    const json_t *passes = json_object_get(baseline->root, "passes");
    double copy = sf_bench_compute_copy(bench), old_frame = number(baseline->root, "frame_in_compute_copies");
    size_t index;
    json_t *row;

    check_sameness(baseline, bench);
    printf("\nagainst %s (below 1 is faster)\n%-28s %10s %10s %9s %9s\n", baseline->path, "", "old ms", "now ms",
           "medians", "minima");
    for (size_t i = 0; i < bench->pass_count; i++)
        print_row(bench->passes[i].name, find_pass(passes, bench->passes[i].name), &bench->passes[i].statistics);
    json_array_foreach((json_t *)passes, index, row)
    {
        const char *name = json_string_value(json_object_get(row, "name"));

        if (name && !ran(bench, name))
            printf("%-28s %10.3f %10s %9s\n", name, number(row, "median_ns") * 1e-6, "-", "gone");
    }
    for (size_t i = 0; i < sizeof wholes / sizeof *wholes; i++) {
        struct sf_statistics now = sf_samples_describe(wholes[i].samples);

        print_row(wholes[i].title, json_object_get(baseline->root, wholes[i].key), &now);
    }
    if (old_frame > 0 && copy > 0)
        printf("frame in compute copies: %.2fx then, %.2fx now\n", old_frame,
               sf_samples_describe(&bench->span).median / copy);
}
