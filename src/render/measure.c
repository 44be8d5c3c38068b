/* What the device can do at most: an image copied by the transfer engine, by a compute shader, and multiply-adds. Each
 * probe is a graph of one pass, so it is timed by the same timestamps as a frame's passes. */
#include "render/internal.h"

#include <stdlib.h>
#include "base/hash.h"
#include "methods/method.h"
#include "sim/sort.h"

enum {
    WARM_UPS = 2,
    REPEATS_MAX = 10000,
    ARITHMETIC_LOCAL = 64, /* bench/arith.comp: threads in a group, */
    ARITHMETIC_OPERATIONS =
        64, /* and operations of a thread in a step: 8 chains of 4 multiply-adds, each counted as two */
    ARITHMETIC_STEPS_MAX = 32768 /* some drivers end loops at 65,535 */
};
static const uint64_t ARITHMETIC_NS = 2000000; /* a measurement at least this long: timestamps cost microseconds */

struct probe {
    struct sf_gpu *gpu;
    const struct sf_log *log;
    struct sf_graph *graph;
    struct sf_plan *plan;
    struct sf_player *player;
};

double sf_measure_goal(const struct sf_scene *scene)
{
    return sf_methods[scene->method].goal;
}

static void close_probe(struct probe *probe)
{
    sf_player_destroy(&probe->player);
    sf_plan_destroy(&probe->plan);
    sf_graph_destroy(&probe->graph);
}

/* Compiles the graph that was declared. */
static enum sf_status open_probe(struct probe *probe)
{
    struct sf_plan_memory memory = {.needs = sf_gpu_memory_needs, .user = probe->gpu};
    enum sf_status status = sf_plan_create(probe->graph, &memory, probe->log, &probe->plan);

    if (!status)
        status = sf_player_create(probe->gpu, probe->plan, &probe->player);
    if (!status)
        sf_player_set_timing(probe->player, true);
    return status;
}

/* Plays once and gives the time of the one pass. */
static enum sf_status time_once(const struct probe *probe, uint64_t *ns)
{
    const struct sf_pass_time *times = NULL;
    uint32_t count = 0;
    uint64_t serial;
    enum sf_status status = sf_frame_begin(probe->gpu), played, ended;

    if (status)
        return status;
    played = sf_player_play(probe->player);
    ended = sf_frame_end(probe->gpu, &serial);
    status = played ? played : ended;
    if (!status)
        status = sf_frame_wait(probe->gpu, serial);
    if (!status)
        status = sf_player_times(probe->player, serial, &times, &count);
    if (!status)
        *ns = times[0].end_ns - times[0].begin_ns;
    return status;
}

static int compare_ns(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;

    return (x > y) - (x < y);
}

static enum sf_status time_median(const struct probe *probe, uint32_t repeats, uint64_t *median)
{
    uint64_t *samples = calloc(repeats, sizeof *samples);
    enum sf_status status = SF_OK;

    if (!samples)
        return sf_fail(probe->log, SF_ERROR_MEMORY, "%s: out of memory", sf_graph_name(probe->graph));
    for (uint32_t i = 0; i < WARM_UPS && !status; i++)
        status = time_once(probe, &samples[0]);
    for (uint32_t i = 0; i < repeats && !status; i++)
        status = time_once(probe, &samples[i]);
    qsort(samples, repeats, sizeof *samples, compare_ns);
    *median = samples[repeats / 2];
    free(samples);
    return status;
}

/* Noise, so that no device can pass off a compressed or cleared image as a copied one. */
static enum sf_status create_source(struct sf_gpu *gpu, uint32_t width, uint32_t height, const struct sf_log *log,
                                    struct sf_gpu_image **source)
{
    size_t count = (size_t)width * height * 4;
    float *noise = malloc(count * sizeof *noise);
    enum sf_status status;

    if (!noise)
        return sf_fail(log, SF_ERROR_MEMORY, "measure.source, %ux%u: out of memory", width, height);
    for (size_t i = 0; i < count; i++)
        noise[i] = sf_random_float(0, (uint32_t)i, 0);
    status = sf_gpu_image_create(gpu, "measure.source", SF_FORMAT_RGBA32F, width, height, 1, SF_ACCESS_STORAGE_READ,
                                 noise, source);
    free(noise);
    return status;
}

static enum sf_status measure_copy(struct sf_gpu *gpu, struct sf_gpu_image *source, uint32_t width, uint32_t height,
                                   bool compute, uint32_t repeats, const struct sf_log *log, uint64_t *median)
{
    const char *name = compute ? "measure.compute_copy" : "measure.image_copy";
    struct probe probe = {.gpu = gpu, .log = log};
    struct sf_image_desc image = {.name = "source",
                                  .format = SF_FORMAT_RGBA32F,
                                  .lifetime = SF_IMPORTED,
                                  .size = {.width = width, .height = height},
                                  .outside = SF_ACCESS_STORAGE_READ};
    struct sf_use uses[2] = {{.access = compute ? SF_ACCESS_STORAGE_READ : SF_ACCESS_TRANSFER_READ, .binding = 0},
                             {.access = compute ? SF_ACCESS_STORAGE_WRITE : SF_ACCESS_TRANSFER_WRITE, .binding = 1}};
    struct sf_pass_desc pass = {.name = name,
                                .kind = compute ? SF_PASS_COMPUTE : SF_PASS_TRANSFER,
                                .uses = uses,
                                .use_count = 2,
                                .transfer = SF_TRANSFER_COPY};
    enum sf_status status = sf_graph_create(name, log, &probe.graph);

    if (status)
        return status;
    uses[0].resource = sf_graph_image(probe.graph, &image);
    image.name = "target";
    image.lifetime = SF_PERSISTENT;
    image.outside = SF_ACCESS_NONE;
    uses[1].resource = sf_graph_image(probe.graph, &image);
    if (compute) {
        pass.shader = "bench/copy_image.comp";
        pass.domain = uses[1].resource;
        pass.local[0] = pass.local[1] = 8;
    }
    sf_graph_pass(probe.graph, &pass);
    status = open_probe(&probe);
    if (!status) {
        sf_player_bind_image(probe.player, uses[0].resource, source);
        status = time_median(&probe, repeats, median);
    }
    close_probe(&probe);
    return status;
}

static enum sf_status measure_arithmetic(struct sf_gpu *gpu, uint32_t repeats, const struct sf_log *log, double *flops)
{
    struct {
        float factor, offset;
        uint32_t steps;
    } push = {.factor = 0.999f, .offset = 0.001f, .steps = 128}; /* stays near 1: neither infinite nor denormal */
    uint32_t groups = sf_gpu_tuning(gpu)->workers * 16;
    uint64_t threads, ns = 0;
    struct probe probe = {.gpu = gpu, .log = log};
    struct sf_buffer_desc buffer = {.name = "result", .lifetime = SF_PERSISTENT};
    struct sf_use use = {.access = SF_ACCESS_STORAGE_WRITE};
    struct sf_pass_desc pass = {.name = "measure.arithmetic",
                                .kind = SF_PASS_COMPUTE,
                                .uses = &use,
                                .use_count = 1,
                                .shader = "bench/arith.comp",
                                .push = &push,
                                .push_bytes = sizeof push,
                                .groups = {groups, 1, 1}};
    enum sf_status status = sf_graph_create(pass.name, log, &probe.graph);

    if (status)
        return status;
    threads = (uint64_t)groups * ARITHMETIC_LOCAL;
    buffer.bytes = threads * 4 * sizeof(float);
    use.resource = sf_graph_buffer(probe.graph, &buffer);
    sf_graph_pass(probe.graph, &pass);
    status = open_probe(&probe);
    for (uint32_t i = 0; i < WARM_UPS && !status; i++)
        status = time_once(&probe, &ns);
    while (!status && ns < ARITHMETIC_NS && push.steps < ARITHMETIC_STEPS_MAX) {
        push.steps *= 2;
        status = time_once(&probe, &ns);
    }
    if (!status)
        status = time_median(&probe, repeats, &ns);
    if (!status)
        *flops = ns ? (double)threads * push.steps * ARITHMETIC_OPERATIONS / ((double)ns * 1e-9) : 0;
    close_probe(&probe);
    return status;
}

enum sf_status sf_measure_ceilings(struct sf_device *device, uint32_t width, uint32_t height, uint32_t repeats,
                                   const struct sf_log *log, struct sf_ceilings *ceilings)
{
    struct sf_gpu_image *source = NULL;
    enum sf_status status;

    *ceilings = (struct sf_ceilings){.bytes = 2 * (uint64_t)width * height * 4 * sizeof(float)};
    if (repeats == 0 || repeats > REPEATS_MAX)
        return sf_fail(log, SF_ERROR_USAGE, "ceilings: repeats must be 1 to %d, not %u", (int)REPEATS_MAX, repeats);
    status = create_source(device->gpu, width, height, log, &source);
    if (!status)
        status = measure_copy(device->gpu, source, width, height, false, repeats, log, &ceilings->image_copy_ns);
    if (!status)
        status = measure_copy(device->gpu, source, width, height, true, repeats, log, &ceilings->compute_copy_ns);
    if (!status)
        status = measure_arithmetic(device->gpu, repeats, log, &ceilings->flops);
    sf_gpu_image_destroy(&source);
    return status;
}

enum sf_status sf_measure_sort(struct sf_device *device, uint32_t pairs, uint32_t repeats, const struct sf_log *log,
                               struct sf_sort_timing *timing)
{
    if (pairs == 0 || repeats == 0 || repeats > REPEATS_MAX)
        return sf_fail(log, SF_ERROR_USAGE, "sort of %u pairs, %u times: there must be some pairs, and 1 to %d repeats",
                       pairs, repeats, (int)REPEATS_MAX);
    return sf_sort_measure(device->gpu, pairs, repeats, log, timing);
}
