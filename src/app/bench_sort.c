/* sfumato bench --sort: the radix sort against a comparison sort on one thread, each run checked. */
#include "bench.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "console.h"
#include "files.h"
#include "progress.h"
#include "session.h"

enum { PAIRS_MAX = 1 << 26 };
static const char SIZES[] = "16384,65536,262144,1048576";

struct rows {
    uint32_t *pairs;
    struct sf_sort_timing *timings;
    size_t count;
};

static double rate(uint32_t pairs, uint64_t ns)
{
    return ns ? (double)pairs * 1e3 / (double)ns : 0;
}

static double ratio(const struct sf_sort_timing *t)
{
    return t->gpu_min_ns ? (double)t->cpu_min_ns / (double)t->gpu_min_ns : 0;
}

static void print_table(const struct sf_device_info *device, const struct rows *rows, uint32_t repeats)
{
    printf("sorting 32-bit keys with 32-bit payloads, %u times each\n%s, %s\n\n", repeats, device->name,
           device->driver);
    printf("%10s %9s %9s %10s %9s %9s %10s %10s %s\n", "pairs", "min ms", "median", "M pairs/s", "CPU min", "median",
           "M pairs/s", "CPU / GPU", " sorted");
    for (size_t i = 0; i < rows->count; i++) {
        const struct sf_sort_timing *t = &rows->timings[i];

        printf("%10u %9.3f %9.3f %10.2f %9.3f %9.3f %10.2f %9.2fx  %s\n", rows->pairs[i], (double)t->gpu_min_ns * 1e-6,
               (double)t->gpu_median_ns * 1e-6, rate(rows->pairs[i], t->gpu_min_ns), (double)t->cpu_min_ns * 1e-6,
               (double)t->cpu_median_ns * 1e-6, rate(rows->pairs[i], t->cpu_min_ns), ratio(t),
               t->correct ? "yes" : "NO");
    }
    printf("\nCPU: a comparison sort of the same pairs on one thread; rates and CPU / GPU are of the minima\n");
}

static enum sf_status write_json(const struct sf_device_info *device, const struct rows *rows, uint32_t repeats,
                                 const char *path)
{
    json_t *list = json_array(), *root;
    enum sf_status status;
    char *text;

    for (size_t i = 0; i < rows->count; i++) {
        const struct sf_sort_timing *t = &rows->timings[i];

        json_array_append_new(list,
                              json_pack("{s:I, s:I, s:I, s:I, s:I, s:b}", "pairs", (json_int_t)rows->pairs[i],
                                        "gpu_min_ns", (json_int_t)t->gpu_min_ns, "gpu_median_ns",
                                        (json_int_t)t->gpu_median_ns, "cpu_min_ns", (json_int_t)t->cpu_min_ns,
                                        "cpu_median_ns", (json_int_t)t->cpu_median_ns, "correct", (int)t->correct));
    }
    root = json_pack("{s:s, s:{s:s, s:s, s:s}, s:i, s:o}", "sfumato", SF_VERSION, "device", "name", device->name,
                     "driver", device->driver, "uuid", device->uuid, "repeats", (int)repeats, "sort", list);
    text = root ? json_dumps(root, JSON_INDENT(2)) : NULL;
    json_decref(root);
    if (!text)
        return sf_console_fail(SF_ERROR_MEMORY, "%s: out of memory", path);
    status = sf_report_write(path, text, strlen(text));
    free(text);
    return status;
}

static enum sf_status measure(const struct sf_arguments *arguments, struct sf_device *device, struct rows *rows)
{
    struct sf_progress progress;
    enum sf_status status = SF_OK;

    sf_progress_begin(&progress, "timing sorts", "sizes", rows->count);
    for (size_t i = 0; i < rows->count && !status; i++) {
        status = sf_measure_sort(device, rows->pairs[i], arguments->repeats, sf_console_log(), &rows->timings[i]);
        if (!status && sf_interrupted())
            status = SF_ERROR_INTERRUPTED;
        sf_progress_show(&progress, i + 1);
    }
    sf_progress_end(&progress);
    return status;
}

static enum sf_status check_arguments(const struct sf_arguments *arguments)
{
    if (arguments->files.count)
        return sf_console_fail(SF_ERROR_USAGE, "bench --sort: takes no scene: %s", arguments->files.items[0]);
    if (arguments->csv_file || arguments->trace_file || arguments->compare_file)
        return sf_console_fail(SF_ERROR_USAGE, "bench --sort: of the reports only --json is there");
    if (arguments->json_file && strcmp(arguments->json_file, "-") != 0)
        return sf_folder_check(arguments->json_file);
    return SF_OK;
}

enum sf_status sf_bench_sort_run(const struct sf_arguments *arguments)
{
    struct rows rows = {0};
    struct sf_device_info info;
    struct sf_device *device = NULL;
    enum sf_status status = check_arguments(arguments);

    if (!status)
        status = sf_numbers_parse("--sizes", arguments->sizes ? arguments->sizes : SIZES, 1, PAIRS_MAX, &rows.pairs,
                                  &rows.count);
    if (!status && !(rows.timings = calloc(rows.count, sizeof *rows.timings)))
        status = sf_console_fail(SF_ERROR_MEMORY, "out of memory");
    if (!status)
        status = sf_session_device(arguments, NULL, &device);
    if (!status)
        status = measure(arguments, device, &rows);
    if (!status)
        status = sf_session_validated(arguments, device);
    if (!status) {
        sf_device_describe(device, &info);
        if (!arguments->json_file || strcmp(arguments->json_file, "-") != 0)
            print_table(&info, &rows, arguments->repeats);
        if (arguments->json_file)
            status = write_json(&info, &rows, arguments->repeats, arguments->json_file);
    }
    for (size_t i = 0; i < rows.count && !status; i++)
        if (!rows.timings[i].correct)
            status = sf_console_fail(SF_ERROR_INTERNAL, "the sort of %u pairs is wrong", rows.pairs[i]);
    sf_device_destroy(&device);
    free(rows.pairs);
    free(rows.timings);
    return status;
}
