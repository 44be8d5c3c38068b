/* What bench measured, as a table for people, JSON and CSV for programs, and a trace for chrome://tracing or Perfetto.
 */
#include "bench.h"

#include <jansson.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "console.h"
#include "files.h"

static const double NS_TO_MS = 1e-6;

/* ---- the table ---- */

/* One line: `total` is what the share is of; `bytes` of a frame, 0: no rates. */
static void print_row(const struct sf_bench *bench, const char *name, struct sf_statistics s, double share,
                      double bytes)
{
    double rate = s.median > 0 ? bytes / s.median : 0, copy = sf_bench_copy_rate(bench);

    printf("%-28s %8.3f %8.3f %8.3f %6.1f%%", name, s.min * NS_TO_MS, s.median * NS_TO_MS, s.p95 * NS_TO_MS,
           share * 100);
    if (bytes > 0)
        printf(" %9.3f %7.2f %6.1f%%", bytes * 1e-6, rate, copy > 0 ? rate / copy * 100 : 0);
    putchar('\n');
}

static void print_passes(const struct sf_bench *bench, bool simulation, double all)
{
    for (size_t i = 0; i < bench->pass_count; i++) {
        const struct sf_bench_pass *pass = &bench->passes[i];
        double frames = (double)pass->times.count;

        if (pass->simulation == simulation)
            print_row(bench, pass->name, pass->statistics, all > 0 ? pass->total / all : 0,
                      (pass->read_bytes + pass->written_bytes) / frames);
    }
}

static double pass_total(const struct sf_bench *bench, bool simulation)
{
    double total = 0;

    for (size_t i = 0; i < bench->pass_count; i++)
        total += bench->passes[i].simulation == simulation ? bench->passes[i].total : 0;
    return total;
}

static void print_ceilings(const struct sf_bench *bench)
{
    const struct sf_ceilings *b = &bench->before, *a = &bench->after;
    struct sf_argument_size size = bench->arguments->size;

    printf("\nceilings before and after: one %ux%u RGBA32F image, %.1f MB read and written\n", size.width, size.height,
           (double)b->bytes * 1e-6);
    printf("  image copy %.3f, %.3f ms (%.1f GB/s)   compute copy %.3f, %.3f ms (%.1f GB/s)   arithmetic %.1f, %.1f "
           "GFLOP/s\n",
           (double)b->image_copy_ns * NS_TO_MS, (double)a->image_copy_ns * NS_TO_MS, sf_bench_copy_rate(bench),
           (double)b->compute_copy_ns * NS_TO_MS, (double)a->compute_copy_ns * NS_TO_MS,
           sf_bench_compute_copy(bench) > 0 ? (double)b->bytes / sf_bench_compute_copy(bench) : 0, b->flops * 1e-9,
           a->flops * 1e-9);
}

static void print_frame(struct sf_bench *bench)
{
    struct sf_statistics span = sf_samples_describe(&bench->span), wall = sf_samples_describe(&bench->wall);
    struct sf_statistics sum = sf_samples_describe(&bench->sum), record = sf_samples_describe(&bench->record);
    struct sf_statistics pipelined = sf_samples_describe(&bench->pipelined);
    double all = sum.mean, copy = sf_bench_compute_copy(bench);

    printf("\n");
    print_row(bench, "sum of passes", sum, 1, 0);
    print_row(bench, "frame on the device", span, all > 0 ? span.mean / all : 0, 0);
    print_row(bench, "wall, one frame at a time", wall, all > 0 ? wall.mean / all : 0, 0);
    print_row(bench, "wall, two in flight", pipelined, all > 0 ? pipelined.mean / all : 0, 0);
    print_row(bench, "CPU, recording", record, all > 0 ? record.mean / all : 0, 0);
    printf(
        "passes account for %.1f%% of the wall time; %.2f frames/s with two in flight; %u passes recorded in %.3f ms\n",
        wall.median > 0 ? sum.median / wall.median * 100 : 0, pipelined.median > 0 ? 1e9 / pipelined.median : 0,
        bench->recorded_passes, record.median * NS_TO_MS);
    print_ceilings(bench);
    printf("frame = %.2fx compute copy of an %ux%u RGBA32F image", copy > 0 ? span.median / copy : 0,
           bench->arguments->size.width, bench->arguments->size.height);
    if (bench->goal > 0)
        printf(" (goal of %s %.1fx: 800x800, half resolution, 512 particles)", bench->scene.method, bench->goal);
    putchar('\n');
}

void sf_report_print(struct sf_bench *bench)
{
    const struct sf_arguments *arguments = bench->arguments;
    double simulation = pass_total(bench, true), picture = pass_total(bench, false), all = simulation + picture;

    printf("%s (%s), %ux%u, frames %s, %u times\n%s, %s\n", bench->scene.path, bench->scene.method,
           arguments->size.width, arguments->size.height, arguments->frames, arguments->repeats, bench->device.name,
           bench->device.driver);
    printf("%u live particles in the first frame, %u in the last\n\n", bench->live_first, bench->live_last);
    printf("%-28s %8s %8s %8s %7s %9s %7s %7s\n", "pass, a frame", "min ms", "median", "p95", "share", "MB", "GB/s",
           "of copy");
    print_passes(bench, true, all);
    print_row(bench, "simulation", sf_samples_describe(&bench->simulation), all > 0 ? simulation / all : 0, 0);
    print_passes(bench, false, all);
    print_row(bench, "picture", sf_samples_describe(&bench->picture), all > 0 ? picture / all : 0, 0);
    print_frame(bench);
}

/* ---- JSON ---- */

static json_t *statistics_json(struct sf_statistics s)
{
    return json_pack("{s:f, s:f, s:f, s:f}", "min_ns", s.min, "median_ns", s.median, "p95_ns", s.p95, "mean_ns",
                     s.mean);
}

static json_t *ceilings_json(const struct sf_ceilings *c)
{
    return json_pack("{s:I, s:I, s:I, s:f}", "image_copy_ns", (json_int_t)c->image_copy_ns, "compute_copy_ns",
                     (json_int_t)c->compute_copy_ns, "bytes", (json_int_t)c->bytes, "flops", c->flops);
}

static json_t *passes_json(const struct sf_bench *bench)
{
    json_t *list = json_array();
    double all = pass_total(bench, true) + pass_total(bench, false), copy = sf_bench_copy_rate(bench);

    for (size_t i = 0; i < bench->pass_count; i++) {
        const struct sf_bench_pass *pass = &bench->passes[i];
        double frames = (double)pass->times.count, bytes = (pass->read_bytes + pass->written_bytes) / frames;
        double rate = pass->statistics.median > 0 ? bytes / pass->statistics.median : 0;
        json_t *row = statistics_json(pass->statistics);

        json_object_set_new(row, "name", json_string(pass->name));
        json_object_set_new(row, "kind", json_string(pass->simulation ? "simulation" : "picture"));
        json_object_set_new(row, "samples", json_integer((json_int_t)pass->times.count));
        json_object_set_new(row, "runs_per_frame", json_real(pass->runs / frames));
        json_object_set_new(row, "share", json_real(all > 0 ? pass->total / all : 0));
        json_object_set_new(row, "bytes_read", json_real(pass->read_bytes / frames));
        json_object_set_new(row, "bytes_written", json_real(pass->written_bytes / frames));
        json_object_set_new(row, "gb_per_s", json_real(rate));
        json_object_set_new(row, "of_copy", json_real(copy > 0 ? rate / copy : 0));
        json_array_append_new(list, row);
    }
    return list;
}

enum sf_status sf_report_write_json(json_t *root, size_t flags, const char *path)
{
    char *text = root ? json_dumps(root, flags | JSON_REAL_PRECISION(12)) : NULL;
    enum sf_status status;
    size_t length;

    json_decref(root);
    if (!text)
        return sf_console_fail(SF_ERROR_MEMORY, "%s: out of memory", path);
    length = strlen(text);
    /* Room for the last line's end is where the terminator was. */
    text[length] = '\n';
    status = sf_report_write(path, text, length + 1);
    free(text);
    return status;
}

enum sf_status sf_report_json(struct sf_bench *bench, const char *path)
{
    const struct sf_arguments *arguments = bench->arguments;
    struct sf_statistics span = sf_samples_describe(&bench->span);
    double copy = sf_bench_compute_copy(bench);
    json_t *root =
        json_pack("{s:s, s:s, s:s, s:s, s:{s:s, s:s, s:s, s:s}, s:i, s:i, s:s, s:i, s:i}", "sfumato", SF_VERSION,
                  "scene", bench->scene.path, "scene_hash", bench->hash, "method", bench->scene.method, "device",
                  "name", bench->device.name, "driver", bench->device.driver, "uuid", bench->device.uuid, "kind",
                  bench->device.kind, "width", (int)arguments->size.width, "height", (int)arguments->size.height,
                  "frames", arguments->frames, "warmup", (int)arguments->warmup, "repeats", (int)arguments->repeats);

    if (!root)
        return sf_console_fail(SF_ERROR_MEMORY, "%s: out of memory", path);
    json_object_set_new(
        root, "live",
        json_pack("{s:I, s:I}", "first", (json_int_t)bench->live_first, "last", (json_int_t)bench->live_last));
    json_object_set_new(
        root, "ceilings",
        json_pack("{s:o, s:o}", "before", ceilings_json(&bench->before), "after", ceilings_json(&bench->after)));
    json_object_set_new(root, "passes", passes_json(bench));
    json_object_set_new(root, "simulation", statistics_json(sf_samples_describe(&bench->simulation)));
    json_object_set_new(root, "picture", statistics_json(sf_samples_describe(&bench->picture)));
    json_object_set_new(root, "sum", statistics_json(sf_samples_describe(&bench->sum)));
    json_object_set_new(root, "frame", statistics_json(span));
    json_object_set_new(root, "wall", statistics_json(sf_samples_describe(&bench->wall)));
    json_object_set_new(root, "pipelined", statistics_json(sf_samples_describe(&bench->pipelined)));
    json_object_set_new(root, "record", statistics_json(sf_samples_describe(&bench->record)));
    json_object_set_new(root, "recorded_passes", json_integer(bench->recorded_passes));
    json_object_set_new(root, "frame_in_compute_copies", json_real(copy > 0 ? span.median / copy : 0));
    json_object_set_new(root, "goal_in_compute_copies", bench->goal > 0 ? json_real(bench->goal) : json_null());
    return sf_report_write_json(root, JSON_INDENT(2), path);
}

/* ---- CSV ---- */

enum sf_status sf_report_csv(const struct sf_bench *bench, const char *path)
{
    static const char head[] =
        "pass,kind,samples,runs_per_frame,min_ns,median_ns,p95_ns,mean_ns,bytes_read,bytes_written\n";
    size_t line = 256, room = sizeof head, used;
    enum sf_status status;
    char *text;

    for (size_t i = 0; i < bench->pass_count; i++)
        room += line + strlen(bench->passes[i].name);
    text = malloc(room);
    if (!text)
        return sf_console_fail(SF_ERROR_MEMORY, "%s: out of memory", path);
    used = (size_t)snprintf(text, room, "%s", head);
    for (size_t i = 0; i < bench->pass_count; i++) {
        const struct sf_bench_pass *pass = &bench->passes[i];
        struct sf_statistics s = pass->statistics;
        double frames = (double)pass->times.count;

        used +=
            (size_t)snprintf(text + used, room - used, "%s,%s,%zu,%g,%.0f,%.0f,%.0f,%.0f,%.0f,%.0f\n", pass->name,
                             pass->simulation ? "simulation" : "picture", pass->times.count, pass->runs / frames, s.min,
                             s.median, s.p95, s.mean, pass->read_bytes / frames, pass->written_bytes / frames);
    }
    status = sf_report_write(path, text, used);
    free(text);
    return status;
}

/* ---- trace ---- */

static json_t *name_json(const char *what, int thread, const char *name)
{
    return json_pack("{s:s, s:s, s:i, s:i, s:{s:s}}", "name", what, "ph", "M", "pid", 1, "tid", thread, "args", "name",
                     name);
}

/* A span on the device's clock from `origin`, in microseconds as the format wants them. */
static json_t *span_json(const char *name, const char *kind, int thread, uint64_t origin, uint64_t begin, uint64_t end)
{
    return json_pack("{s:s, s:s, s:s, s:i, s:i, s:f, s:f}", "name", name, "cat", kind, "ph", "X", "pid", 1, "tid",
                     thread, "ts", (double)(begin - origin) * 1e-3, "dur", (double)(end - begin) * 1e-3);
}

enum sf_status sf_report_trace(const struct sf_bench *bench, const char *path)
{
    json_t *list = json_array();
    uint64_t origin = bench->event_count ? bench->events[0].begin_ns : 0;

    json_array_append_new(list, name_json("process_name", 0, bench->device.name));
    json_array_append_new(list, name_json("thread_name", 1, "frames"));
    json_array_append_new(list, name_json("thread_name", 2, "passes"));
    for (size_t i = 0; i < bench->event_count;) {
        size_t first = i;
        char name[32];

        for (; i < bench->event_count && bench->events[i].frame_index == bench->events[first].frame_index; i++) {
            const struct sf_bench_event *event = &bench->events[i];
            const struct sf_bench_pass *pass = &bench->passes[event->pass];
            json_t *span = span_json(pass->name, pass->simulation ? "simulation" : "picture", 2, origin,
                                     event->begin_ns, event->end_ns);

            json_object_set_new(span, "args", json_pack("{s:I}", "bytes", (json_int_t)event->bytes));
            json_array_append_new(list, span);
        }
        snprintf(name, sizeof name, "frame %u", bench->events[first].frame);
        json_array_append_new(
            list, span_json(name, "frame", 1, origin, bench->events[first].begin_ns, bench->events[i - 1].end_ns));
    }
    return sf_report_write_json(json_pack("{s:o, s:s}", "traceEvents", list, "displayTimeUnit", "ms"), JSON_COMPACT,
                                path);
}
