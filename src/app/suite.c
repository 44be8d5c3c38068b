/* sfumato bench --suite: the rows of a published table, one after the other and that several times over, so that what else
 * the machine does falls on all of them. The devices differ, so what can be compared are ratios within a column. */
#include "suite.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench.h"
#include "console.h"
#include "files.h"
#include "progress.h"
#include "session.h"

enum { CEILING_REPEATS = 5, QUICK_SHARE = 8, QUICK_FRAMES = 2, LABEL_COLUMNS = 30 };
static const double NS = 1e-9;

/* What a row came to. */
struct result {
    struct sf_samples spans; /* ns on the device, a frame */
    double copy;             /* ns of a compute copy of its size, the least that was found */
    uint32_t width, height;
    char hash[17];
};

struct run {
    const struct sf_arguments *arguments;
    const char *name;
    const struct sf_suite *suite;
    char *scene; /* path */
    struct sf_device *device;
    struct sf_device_info info;
    uint32_t *frames;
    size_t frame_count;
    uint32_t rounds, warmup;
    struct result *results;
    struct sf_progress progress;
    uint64_t done;
};

/* ---- measuring ---- */

static enum sf_status load_row(struct run *run, const struct sf_suite_row *row, struct sf_scene **scene)
{
    struct sf_arguments arguments = *run->arguments;
    size_t count = arguments.sets.count;
    const char **sets = calloc(count + SF_SUITE_SETS, sizeof *sets);
    enum sf_status status;

    if (!sets)
        return sf_console_fail(SF_ERROR_MEMORY, "out of memory");
    if (count > 0)
        memcpy(sets, arguments.sets.items, count * sizeof *sets);
    for (size_t i = 0; i < SF_SUITE_SETS && row->sets[i]; i++)
        sets[count++] = row->sets[i];
    arguments.sets = (struct sf_argument_list){.items = sets, .count = count};
    status = sf_session_scene(&arguments, run->scene, scene);
    free(sets);
    return status;
}

/* One frame; its time is kept unless it only warms up. */
static enum sf_status draw(struct run *run, struct sf_renderer *renderer, uint32_t number, struct result *result)
{
    const struct sf_pass_timing *timings;
    struct sf_frame frame;
    uint64_t ticket;
    uint32_t count;
    enum sf_status status = sf_renderer_render(renderer, number, &ticket);

    if (!status)
        status = sf_renderer_wait(renderer, ticket, &frame);
    if (!status)
        status = sf_renderer_timings(renderer, ticket, &timings, &count);
    if (!status && result && count > 0)
        status = sf_samples_add(&result->spans, (double)(timings[count - 1].end_ns - timings[0].begin_ns));
    if (!status && sf_interrupted())
        status = SF_ERROR_INTERRUPTED;
    sf_progress_show(&run->progress, ++run->done);
    return status;
}

static enum sf_status measure_row(struct run *run, const struct sf_suite_row *row, struct result *result)
{
    const struct sf_renderer_options options = {.width = result->width,
                                                .height = result->height,
                                                .aovs = run->arguments->aovs ? SF_AOV_SMOKE | SF_AOV_DEPTHS : 0,
                                                .timing = true,
                                                .frames_kept = 1,
                                                .no_readback = true};
    uint32_t first = run->frames[0] >= run->warmup ? run->frames[0] - run->warmup : 0;
    struct sf_renderer *renderer = NULL;
    struct sf_scene *scene = NULL;
    struct sf_scene_info info;
    enum sf_status status = load_row(run, row, &scene);

    if (!status) {
        sf_scene_describe(scene, &info);
        snprintf(result->hash, sizeof result->hash, "%016llx", (unsigned long long)info.hash);
        status = sf_renderer_create(run->device, scene, &options, sf_console_log(), &renderer);
    }
    if (!status)
        status = sf_renderer_seek(renderer, first, NULL, NULL);
    for (uint32_t i = 0; i < run->warmup && !status; i++)
        status = draw(run, renderer, first + i, NULL);
    if (!status)
        status = sf_renderer_seek(renderer, run->frames[0], NULL, NULL);
    for (size_t i = 0; i < run->frame_count && !status; i++)
        status = draw(run, renderer, run->frames[i], result);
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
    return status;
}

/* The compute copy of every size in the table. */
static enum sf_status measure_copies(struct run *run)
{
    enum sf_status status = SF_OK;

    for (size_t i = 0; i < run->suite->row_count && !status; i++) {
        struct result *result = &run->results[i];
        struct sf_ceilings ceilings;
        size_t same = 0;

        while (run->results[same].width != result->width || run->results[same].height != result->height)
            same++;
        if (same < i) {
            result->copy = run->results[same].copy;
            continue;
        }
        status = sf_measure_ceilings(run->device, result->width, result->height, CEILING_REPEATS, sf_console_log(),
                                     &ceilings);
        if (!status && (result->copy <= 0 || (double)ceilings.compute_copy_ns < result->copy))
            result->copy = (double)ceilings.compute_copy_ns;
    }
    return status;
}

static enum sf_status measure(struct run *run)
{
    const struct sf_suite *suite = run->suite;
    enum sf_status status = measure_copies(run);

    sf_progress_begin(&run->progress, "timing the suite", "frames",
                      (uint64_t)run->rounds * suite->row_count * (run->warmup + run->frame_count));
    for (uint32_t round = 0; round < run->rounds && !status; round++)
        for (size_t i = 0; i < suite->row_count && !status; i++)
            status = measure_row(run, &suite->rows[i], &run->results[i]);
    sf_progress_end(&run->progress);
    if (!status)
        status = measure_copies(run);
    return status;
}

/* ---- the table ---- */

/* Frames a second. */
struct rates {
    double min, max, average, median;
};

static struct rates rates_of(struct result *result)
{
    struct sf_statistics s = sf_samples_describe(&result->spans);
    double slowest = 0;

    if (result->spans.count == 0)
        return (struct rates){0};
    slowest = result->spans.values[result->spans.count - 1]; /* they are sorted now */
    return (struct rates){.min = 1 / (slowest * NS),
                          .max = 1 / (s.min * NS),
                          .average = 1 / (s.mean * NS),
                          .median = 1 / (s.median * NS)};
}

static void print_head(const struct run *run)
{
    const struct sf_suite *suite = run->suite;

    printf("%s\n%s, %zu frames of %s, %u round%s\n%s, %s\n\n", suite->title, run->scene, run->frame_count,
           run->arguments->frames, run->rounds, run->rounds == 1 ? "" : "s", run->info.name, run->info.driver);
    printf("%-*s %9s %8s %8s %8s %8s %7s %7s  |", LABEL_COLUMNS, "frames a second", "", "min", "max", "average",
           "median", "copies", "ratio");
    for (const char *const *column = suite->columns; *column; column++)
        printf(" %9s %5s", *column, "ratio");
    printf("\n");
}

static void print_row(const struct run *run, size_t number, struct rates base)
{
    const struct sf_suite *suite = run->suite;
    const struct sf_suite_row *row = &suite->rows[number];
    struct result *result = &run->results[number];
    struct rates rates = rates_of(result);
    char size[24];

    snprintf(size, sizeof size, "%ux%u", result->width, result->height);
    printf("%-*s %9s %8.2f %8.2f %8.2f %8.2f %7.2f %7.2f  |", LABEL_COLUMNS, row->label, size, rates.min, rates.max,
           rates.average, rates.median, result->copy > 0 ? 1 / (rates.median * NS * result->copy) : 0,
           rates.median / base.median);
    for (size_t i = 0; suite->columns[i]; i++) {
        if (row->published[i] > 0)
            printf(" %9g %5.2f", row->published[i], row->published[i] / suite->rows[0].published[i]);
        else
            printf(" %9s %5s", "-", "-");
    }
    printf("\n");
}

static void print_table(const struct run *run)
{
    struct rates base = rates_of(&run->results[0]);

    print_head(run);
    for (size_t i = 0; i < run->suite->row_count; i++)
        print_row(run, i, base);
    printf(
        "\nLeft of the line this run, by the device's clock; right of it what was published. Ratios are to %s, of the\n"
        "medians and in each published column; copies: a median frame's time in compute copies of its size.\n",
        run->suite->base);
    for (const char *const *note = run->suite->notes; *note; note++)
        printf("%s\n", *note);
}

/* ---- JSON ---- */

static json_t *published_json(const struct sf_suite *suite, const struct sf_suite_row *row)
{
    json_t *list = json_array();

    for (size_t i = 0; suite->columns[i]; i++)
        if (row->published[i] > 0)
            json_array_append_new(list,
                                  json_pack("{s:s, s:f, s:f}", "column", suite->columns[i], "fps", row->published[i],
                                            "ratio", row->published[i] / suite->rows[0].published[i]));
    return list;
}

static json_t *row_json(const struct run *run, size_t number, struct rates base)
{
    const struct sf_suite_row *row = &run->suite->rows[number];
    struct result *result = &run->results[number];
    struct rates rates = rates_of(result);
    json_t *sets = json_array();

    for (size_t i = 0; i < SF_SUITE_SETS && row->sets[i]; i++)
        json_array_append_new(sets, json_string(row->sets[i]));
    return json_pack("{s:s, s:o, s:s, s:i, s:i, s:I, s:{s:f, s:f, s:f, s:f}, s:f, s:f, s:o}", "row", row->label, "sets",
                     sets, "scene_hash", result->hash, "width", (int)result->width, "height", (int)result->height,
                     "samples", (json_int_t)result->spans.count, "fps", "min", rates.min, "max", rates.max, "average",
                     rates.average, "median", rates.median, "ratio", rates.median / base.median, "compute_copies",
                     result->copy > 0 ? 1 / (rates.median * NS * result->copy) : 0, "published",
                     published_json(run->suite, row));
}

static enum sf_status write_report(const struct run *run)
{
    struct rates base = rates_of(&run->results[0]);
    json_t *rows = json_array();

    for (size_t i = 0; i < run->suite->row_count; i++)
        json_array_append_new(rows, row_json(run, i, base));
    return sf_report_write_json(json_pack("{s:s, s:s, s:s, s:s, s:{s:s, s:s, s:s}, s:s, s:i, s:b, s:o}", "sfumato",
                                          SF_VERSION, "suite", run->name, "title", run->suite->title, "scene",
                                          run->scene, "device", "name", run->info.name, "driver", run->info.driver,
                                          "uuid", run->info.uuid, "frames", run->arguments->frames, "rounds",
                                          (int)run->rounds, "quick", (int)run->arguments->quick, "rows", rows),
                                JSON_INDENT(2), run->arguments->json_file);
}

/* ---- the command ---- */

static enum sf_status check_arguments(const struct sf_arguments *arguments)
{
    if (arguments->files.count)
        return sf_console_fail(SF_ERROR_USAGE, "bench --suite: takes no scene: %s", arguments->files.items[0]);
    if (arguments->sort)
        return sf_console_fail(SF_ERROR_USAGE, "bench: --suite or --sort, not both");
    if (arguments->size.width > 0)
        return sf_console_fail(SF_ERROR_USAGE, "bench --suite: has sizes of its own (--quick makes them small)");
    if (arguments->method)
        return sf_console_fail(SF_ERROR_USAGE, "bench --suite: has methods of its own");
    if (arguments->csv_file || arguments->trace_file || arguments->compare_file)
        return sf_console_fail(SF_ERROR_USAGE, "bench --suite: of the reports only --json is there");
    if (arguments->json_file && strcmp(arguments->json_file, "-") != 0)
        return sf_folder_check(arguments->json_file);
    return SF_OK;
}

static enum sf_status prepare(struct run *run)
{
    const struct sf_arguments *arguments = run->arguments;
    size_t number = 0;
    enum sf_status status = check_arguments(arguments);

    if (status)
        return status;
    while (strcmp(sf_suite_names[number], arguments->suite) != 0)
        number++; /* the option takes no others */
    run->name = sf_suite_names[number];
    run->suite = &sf_suites[number];
    run->rounds = arguments->quick ? 1 : arguments->repeats;
    run->warmup = arguments->quick ? 1 : arguments->warmup;
    run->results = calloc(run->suite->row_count, sizeof *run->results);
    if (!run->results)
        return sf_console_fail(SF_ERROR_MEMORY, "out of memory");
    for (size_t i = 0; i < run->suite->row_count; i++) {
        run->results[i].width = run->suite->rows[i].width / (arguments->quick ? QUICK_SHARE : 1);
        run->results[i].height = run->suite->rows[i].height / (arguments->quick ? QUICK_SHARE : 1);
    }
    run->scene = sf_file_beside_program(run->suite->scene);
    if (!run->scene)
        return sf_console_fail(SF_ERROR_IO, "bench --suite %s: there is no %s here or beside the program", run->name,
                               run->suite->scene);
    status = sf_session_frames(arguments, &run->frames, &run->frame_count);
    if (!status && arguments->quick && run->frame_count > QUICK_FRAMES)
        run->frame_count = QUICK_FRAMES;
    return status;
}

enum sf_status sf_suite_run(const struct sf_arguments *arguments)
{
    struct run run = {.arguments = arguments};
    bool alone = arguments->json_file && strcmp(arguments->json_file, "-") == 0;
    enum sf_status status = prepare(&run);

    if (!status)
        status = sf_session_device(arguments, NULL, &run.device);
    if (!status) {
        sf_device_describe(run.device, &run.info);
        status = measure(&run);
    }
    if (!status)
        status = sf_session_validated(arguments, run.device);
    if (!status && !alone)
        print_table(&run);
    if (!status && arguments->json_file)
        status = write_report(&run);
    if (status == SF_ERROR_INTERRUPTED)
        sf_console_note("interrupted: nothing is reported");
    sf_device_destroy(&run.device);
    for (size_t i = 0; run.results && i < run.suite->row_count; i++)
        free(run.results[i].spans.values);
    free(run.results);
    free(run.frames);
    free(run.scene);
    return status;
}
