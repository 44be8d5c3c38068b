/* sfumato bench: the same frames again and again, every pass timed by the device itself, between two measurements of
 * what the device can do at most. Latency is taken one frame at a time, throughput with two in flight and without
 * timestamps. */
#include "bench.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "console.h"
#include "files.h"
#include "progress.h"
#include "session.h"
#include "suite.h"

enum { CEILING_REPEATS = 15, IN_FLIGHT = 2, COUNTING_SIDE = 16, SIDE = 800 };

/* ---- samples ---- */

static enum sf_status grow(void **data, size_t count, size_t *capacity, size_t size)
{
    size_t wanted = *capacity ? *capacity * 2 : 64;
    void *more;

    if (count < *capacity)
        return SF_OK;
    more = realloc(*data, wanted * size);
    if (!more)
        return sf_console_fail(SF_ERROR_MEMORY, "out of memory");
    *data = more;
    *capacity = wanted;
    return SF_OK;
}

enum sf_status sf_samples_add(struct sf_samples *samples, double value)
{
    enum sf_status status =
        grow((void **)&samples->values, samples->count, &samples->capacity, sizeof *samples->values);

    if (!status)
        samples->values[samples->count++] = value;
    return status;
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

struct sf_statistics sf_samples_describe(struct sf_samples *samples)
{
    struct sf_statistics s = {0};
    size_t n = samples->count;

    if (n == 0)
        return s;
    qsort(samples->values, n, sizeof *samples->values, compare_doubles);
    for (size_t i = 0; i < n; i++)
        s.mean += samples->values[i] / (double)n;
    s.min = samples->values[0];
    s.median = (samples->values[(n - 1) / 2] + samples->values[n / 2]) / 2;
    /* The nearest rank: the smallest sample that at least 95 % do not exceed. */
    s.p95 = samples->values[(n * 95 + 99) / 100 - 1];
    return s;
}

double sf_bench_copy_rate(const struct sf_bench *bench)
{
    uint64_t best = bench->before.image_copy_ns < bench->after.image_copy_ns ? bench->before.image_copy_ns
                                                                             : bench->after.image_copy_ns;

    return best ? (double)bench->before.bytes / (double)best : 0;
}

double sf_bench_compute_copy(const struct sf_bench *bench)
{
    return ((double)bench->before.compute_copy_ns + (double)bench->after.compute_copy_ns) / 2;
}

/* ---- one frame's passes ---- */

static enum sf_status find_pass(struct sf_bench *bench, const char *name, size_t *index)
{
    enum sf_status status;
    struct sf_bench_pass *pass;

    for (*index = 0; *index < bench->pass_count; ++*index)
        if (strcmp(bench->passes[*index].name, name) == 0)
            return SF_OK;
    status = grow((void **)&bench->passes, bench->pass_count, &bench->pass_capacity, sizeof *bench->passes);
    if (status)
        return status;
    pass = &bench->passes[bench->pass_count];
    *pass = (struct sf_bench_pass){.name = strdup(name), .simulation = strncmp(name, "sim.", 4) == 0};
    if (!pass->name)
        return sf_console_fail(SF_ERROR_MEMORY, "out of memory");
    bench->pass_count++;
    return SF_OK;
}

static enum sf_status add_event(struct sf_bench *bench, size_t pass, uint32_t frame,
                                const struct sf_pass_timing *timing)
{
    enum sf_status status =
        grow((void **)&bench->events, bench->event_count, &bench->event_capacity, sizeof *bench->events);

    if (!status)
        bench->events[bench->event_count++] =
            (struct sf_bench_event){.pass = pass,
                                    .frame_index = bench->wall.count,
                                    .frame = frame,
                                    .begin_ns = timing->begin_ns,
                                    .end_ns = timing->end_ns,
                                    .bytes = timing->bytes_read + timing->bytes_written};
    return status;
}

/* Adds up the passes of one frame, then closes the frame: each pass that ran gets one sample. */
static enum sf_status add_passes(struct sf_bench *bench, uint32_t frame, const struct sf_pass_timing *timings,
                                 uint32_t count)
{
    double simulation = 0, picture = 0;
    enum sf_status status = SF_OK;

    for (uint32_t i = 0; i < count && !status; i++) {
        const struct sf_pass_timing *timing = &timings[i];
        struct sf_bench_pass *pass;
        size_t index;

        status = find_pass(bench, timing->name, &index);
        if (!status)
            status = add_event(bench, index, frame, timing);
        if (status)
            break;
        pass = &bench->passes[index];
        pass->frame_time += (double)(timing->end_ns - timing->begin_ns);
        pass->frame_runs++;
        pass->frame_bytes_read += (double)timing->bytes_read;
        pass->frame_bytes_written += (double)timing->bytes_written;
    }
    for (size_t i = 0; i < bench->pass_count && !status; i++) {
        struct sf_bench_pass *pass = &bench->passes[i];

        if (pass->frame_runs == 0)
            continue;
        *(pass->simulation ? &simulation : &picture) += pass->frame_time;
        status = sf_samples_add(&pass->times, pass->frame_time);
        pass->total += pass->frame_time;
        pass->runs += pass->frame_runs;
        pass->read_bytes += pass->frame_bytes_read;
        pass->written_bytes += pass->frame_bytes_written;
        pass->frame_time = pass->frame_runs = pass->frame_bytes_read = pass->frame_bytes_written = 0;
    }
    if (!status)
        status = sf_samples_add(&bench->simulation, simulation);
    if (!status)
        status = sf_samples_add(&bench->picture, picture);
    if (!status)
        status = sf_samples_add(&bench->sum, simulation + picture);
    if (!status && count)
        status = sf_samples_add(&bench->span, (double)(timings[count - 1].end_ns - timings[0].begin_ns));
    return status;
}

static enum sf_status measure_frame(struct sf_bench *bench, struct sf_renderer *renderer, uint32_t number)
{
    const struct sf_pass_timing *timings;
    struct sf_frame frame;
    uint64_t ticket, begin = sf_now_ns(), end, record;
    uint32_t count;
    enum sf_status status = sf_session_refine(renderer, number);

    if (!status)
        status = sf_renderer_render(renderer, number, &ticket);
    if (!status)
        status = sf_renderer_wait(renderer, ticket, &frame);
    end = sf_now_ns();
    if (!status)
        status = sf_renderer_timings(renderer, ticket, &timings, &count);
    if (!status)
        status = add_passes(bench, number, timings, count);
    if (status)
        return status;
    record = sf_renderer_record_ns(renderer, &bench->recorded_passes);
    status = sf_samples_add(&bench->record, (double)record);
    if (!status)
        status = sf_samples_add(&bench->wall, (double)(end - begin));
    return status;
}

/* ---- runs ---- */

static enum sf_status open_renderer(const struct sf_bench *bench, struct sf_device *device,
                                    const struct sf_scene *scene, bool timing, struct sf_renderer **renderer)
{
    const struct sf_arguments *arguments = bench->arguments;
    struct sf_renderer_options options = {.width = arguments->size.width,
                                          .height = arguments->size.height,
                                          .aovs = arguments->aovs ? SF_AOV_SMOKE | SF_AOV_DEPTHS : 0,
                                          .timing = timing,
                                          .frames_kept = IN_FLIGHT,
                                          .no_readback = true};

    return sf_renderer_create(device, scene, &options, sf_console_log(), renderer);
}

static enum sf_status interrupted(void)
{
    return sf_interrupted() ? SF_ERROR_INTERRUPTED : SF_OK;
}

/* The frames just before the first one; where there are too few, those from the start on, after which the simulation
 * begins anew. */
static enum sf_status warm_up(const struct sf_bench *bench, struct sf_renderer *renderer)
{
    uint32_t count = bench->arguments->warmup, first = bench->frames[0] >= count ? bench->frames[0] - count : 0;
    enum sf_status status = sf_session_seek(renderer, first);

    for (uint32_t i = 0; i < count && !status; i++) {
        struct sf_frame frame;
        uint64_t ticket;

        status = sf_session_refine(renderer, first + i);
        if (!status)
            status = sf_renderer_render(renderer, first + i, &ticket);
        if (!status)
            status = sf_renderer_wait(renderer, ticket, &frame);
        if (!status)
            status = interrupted();
    }
    return status;
}

static enum sf_status run_timed(struct sf_bench *bench, struct sf_renderer *renderer, struct sf_progress *progress)
{
    enum sf_status status = warm_up(bench, renderer);
    uint64_t done = 0;

    sf_progress_begin(progress, "timing passes", "frames", (uint64_t)bench->arguments->repeats * bench->frame_count);
    for (uint32_t repeat = 0; repeat < bench->arguments->repeats && !status; repeat++) {
        status = sf_session_seek(renderer, bench->frames[0]);
        for (size_t i = 0; i < bench->frame_count && !status; i++) {
            status = measure_frame(bench, renderer, bench->frames[i]);
            if (!status)
                status = interrupted();
            sf_progress_show(progress, ++done);
        }
    }
    sf_progress_end(progress);
    return status;
}

static enum sf_status run_pipelined(struct sf_bench *bench, struct sf_renderer *renderer, struct sf_progress *progress)
{
    enum sf_status status = warm_up(bench, renderer);
    uint64_t tickets[IN_FLIGHT], done = 0;

    sf_progress_begin(progress, "timing throughput", "frames",
                      (uint64_t)bench->arguments->repeats * bench->frame_count);
    for (uint32_t repeat = 0; repeat < bench->arguments->repeats && !status; repeat++) {
        uint64_t begin;
        struct sf_frame frame;

        status = sf_session_seek(renderer, bench->frames[0]);
        begin = sf_now_ns();
        for (size_t i = 0; i < bench->frame_count + IN_FLIGHT && !status; i++) {
            if (i >= IN_FLIGHT && i - IN_FLIGHT < bench->frame_count)
                status = sf_renderer_wait(renderer, tickets[i % IN_FLIGHT], &frame);
            if (i < bench->frame_count && !status)
                status = sf_session_refine(renderer, bench->frames[i]);
            if (i < bench->frame_count && !status)
                status = sf_renderer_render(renderer, bench->frames[i], &tickets[i % IN_FLIGHT]);
            if (!status)
                status = interrupted();
        }
        if (!status)
            status = sf_samples_add(&bench->pipelined, (double)(sf_now_ns() - begin) / (double)bench->frame_count);
        sf_progress_show(progress, done += bench->frame_count);
    }
    sf_progress_end(progress);
    return status;
}

/* The timed renderers read nothing back, not even counts; a small one says how many particles the first and the last
 * frame have. */
static enum sf_status count_live(struct sf_bench *bench, struct sf_device *device)
{
    struct sf_arguments arguments = *bench->arguments;
    struct sf_renderer_options options = {.width = COUNTING_SIDE, .height = COUNTING_SIDE, .frames_kept = IN_FLIGHT};
    const uint32_t numbers[] = {bench->frames[0], bench->frames[bench->frame_count - 1]};
    uint32_t live[2] = {0};
    struct sf_renderer *renderer = NULL;
    struct sf_scene *scene = NULL;
    enum sf_status status;

    arguments.method = "none"; /* how they are drawn does not matter */
    status = sf_session_scene(&arguments, arguments.files.items[0], &scene);
    if (!status)
        status = sf_renderer_create(device, scene, &options, sf_console_log(), &renderer);
    for (size_t i = 0; i < 2 && !status; i++) {
        struct sf_frame frame;
        uint64_t ticket;

        status = sf_session_seek(renderer, numbers[i]);
        if (!status)
            status = sf_renderer_render(renderer, numbers[i], &ticket);
        if (!status)
            status = sf_renderer_wait(renderer, ticket, &frame);
        if (!status)
            live[i] = frame.live;
    }
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
    bench->live_first = live[0];
    bench->live_last = live[1];
    return status;
}

static enum sf_status measure(struct sf_bench *bench, struct sf_device *device, const struct sf_scene *scene)
{
    struct sf_argument_size size = bench->arguments->size;
    struct sf_renderer *renderer = NULL;
    struct sf_progress progress;
    enum sf_status status =
        sf_measure_ceilings(device, size.width, size.height, CEILING_REPEATS, sf_console_log(), &bench->before);

    if (!status)
        status = open_renderer(bench, device, scene, true, &renderer);
    if (!status)
        status = run_timed(bench, renderer, &progress);
    sf_renderer_destroy(&renderer);
    if (!status)
        status = open_renderer(bench, device, scene, false, &renderer);
    if (!status)
        status = run_pipelined(bench, renderer, &progress);
    sf_renderer_destroy(&renderer);
    if (!status)
        status = sf_measure_ceilings(device, size.width, size.height, CEILING_REPEATS, sf_console_log(), &bench->after);
    if (!status)
        status = count_live(bench, device);
    return status;
}

static enum sf_status check_arguments(const struct sf_arguments *arguments)
{
    const char *const files[] = {arguments->json_file, arguments->csv_file, arguments->trace_file};
    enum sf_status status = SF_OK;

    if (arguments->quick)
        return sf_console_fail(SF_ERROR_USAGE, "bench: --quick needs --suite");
    if (arguments->sizes)
        return sf_console_fail(SF_ERROR_USAGE, "bench: --sizes needs --sort");
    if (arguments->files.count == 0)
        return sf_console_fail(SF_ERROR_USAGE, "bench: needs SCENE (sfumato bench --help)");
    for (size_t i = 0; i < sizeof files / sizeof *files && !status; i++)
        if (files[i] && strcmp(files[i], "-") != 0)
            status = sf_folder_check(files[i]);
    return status;
}

static enum sf_status report(struct sf_bench *bench, const struct sf_baseline *baseline)
{
    const struct sf_arguments *arguments = bench->arguments;
    const char *const files[] = {arguments->json_file, arguments->csv_file, arguments->trace_file};
    bool table = true;
    enum sf_status status = SF_OK;

    for (size_t i = 0; i < bench->pass_count; i++)
        bench->passes[i].statistics = sf_samples_describe(&bench->passes[i].times);
    /* A report on standard output stands there alone. */
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
        table = table && !(files[i] && strcmp(files[i], "-") == 0);
    if (table)
        sf_report_print(bench);
    if (table && baseline)
        sf_baseline_compare(baseline, bench);
    if (arguments->json_file)
        status = sf_report_json(bench, arguments->json_file);
    if (arguments->csv_file && !status)
        status = sf_report_csv(bench, arguments->csv_file);
    if (arguments->trace_file && !status)
        status = sf_report_trace(bench, arguments->trace_file);
    return status;
}

static void finish(struct sf_bench *bench)
{
    struct sf_samples *const all[] = {&bench->simulation, &bench->picture,   &bench->sum,   &bench->span,
                                      &bench->wall,       &bench->pipelined, &bench->record};

    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        free(all[i]->values);
    for (size_t i = 0; i < bench->pass_count; i++) {
        free(bench->passes[i].name);
        free(bench->passes[i].times.values);
    }
    free(bench->passes);
    free(bench->events);
    free(bench->frames);
}

enum sf_status sf_bench_run(const struct sf_arguments *given)
{
    struct sf_arguments own = *given;
    const struct sf_arguments *arguments = &own;
    struct sf_bench bench = {.arguments = arguments};
    struct sf_baseline *baseline = NULL;
    struct sf_scene *scene = NULL;
    struct sf_device *device = NULL;
    enum sf_status status;

    if (arguments->suite)
        return sf_suite_run(arguments);
    if (arguments->sort)
        return sf_bench_sort_run(arguments);
    if (own.size.width == 0)
        own.size = (struct sf_argument_size){.width = SIDE, .height = SIDE};
    status = check_arguments(arguments);
    if (!status)
        status = sf_session_frames(arguments, &bench.frames, &bench.frame_count);
    if (!status && arguments->compare_file)
        status = sf_baseline_load(arguments->compare_file, &baseline);
    if (!status)
        status = sf_session_scene(arguments, arguments->files.items[0], &scene);
    if (!status)
        status = sf_session_device(arguments, NULL, &device);
    if (!status)
        status = sf_session_size(arguments, device);
    if (!status) {
        sf_scene_describe(scene, &bench.scene);
        bench.goal = sf_measure_goal(scene);
        sf_device_describe(device, &bench.device);
        snprintf(bench.hash, sizeof bench.hash, "%016llx", (unsigned long long)bench.scene.hash);
        status = measure(&bench, device, scene);
    }
    if (!status)
        status = sf_session_validated(arguments, device);
    if (!status)
        status = report(&bench, baseline);
    if (status == SF_ERROR_INTERRUPTED)
        sf_console_note("interrupted: nothing is reported");
    sf_device_destroy(&device);
    sf_scene_destroy(&scene);
    sf_baseline_destroy(&baseline);
    finish(&bench);
    return status;
}
