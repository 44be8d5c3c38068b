/* The sort's bench, which is its test as well: every timed run is compared. */
#include "sim/sort.h"

#include <stdlib.h>
#include <string.h>
#include "base/hash.h"
#include "base/thread.h"

enum { WARM_UPS = 2 };
static const char NAME[] = "sort";

struct bench {
    struct sf_gpu *gpu;
    const struct sf_log *log;
    uint32_t pairs, repeats;
    struct sf_graph *graph;
    struct sf_plan *plan;
    struct sf_player *player;
    struct sf_gpu_buffer *list, *count;
    sf_resource list_in, count_in, out;
    struct sf_sort_tuning tuning;
    struct sf_sort sort;
    struct sf_sort_pair
        *input;       /* payloads are the pairs' numbers, so that sorting the words below is stable in the keys */
    uint64_t *sorted; /* key in the upper half, payload in the lower */
    uint64_t *gpu_ns, *cpu_ns; /* [repeats] */
};

static enum sf_status make_input(struct bench *bench)
{
    bench->input = malloc(bench->pairs * sizeof *bench->input);
    bench->sorted = malloc(bench->pairs * sizeof *bench->sorted);
    bench->gpu_ns = calloc(bench->repeats, sizeof *bench->gpu_ns);
    bench->cpu_ns = calloc(bench->repeats, sizeof *bench->cpu_ns);
    if (!bench->input || !bench->sorted || !bench->gpu_ns || !bench->cpu_ns)
        return sf_fail(bench->log, SF_ERROR_MEMORY, "sort of %u pairs: out of memory", bench->pairs);
    for (uint32_t i = 0; i < bench->pairs; i++)
        bench->input[i] = (struct sf_sort_pair){.key = sf_random_u32(bench->pairs, i, 0), .payload = i};
    return SF_OK;
}

static sf_resource import(struct sf_graph *graph, const char *name, uint64_t bytes, enum sf_access outside)
{
    return sf_graph_buffer(graph, &(struct sf_buffer_desc){
                                      .name = name,
                                      .lifetime = SF_IMPORTED,
                                      .bytes = bytes,
                                      .outside = outside,
                                  });
}

static void add_copy(struct sf_graph *graph, const char *name, sf_resource from, sf_resource to)
{
    const struct sf_use uses[] = {
        {.resource = from, .access = SF_ACCESS_TRANSFER_READ},
        {.resource = to, .access = SF_ACCESS_TRANSFER_WRITE},
    };

    sf_graph_pass(graph, &(struct sf_pass_desc){
                             .name = name,
                             .kind = SF_PASS_TRANSFER,
                             .uses = uses,
                             .use_count = 2,
                             .transfer = SF_TRANSFER_COPY,
                         });
}

static void declare(struct bench *bench)
{
    uint64_t bytes = (uint64_t)bench->pairs * sizeof *bench->input;
    sf_resource work = sf_graph_buffer(bench->graph, &(struct sf_buffer_desc){
                                                         .name = "pairs",
                                                         .lifetime = SF_TRANSIENT,
                                                         .bytes = sf_sort_bytes(&bench->tuning, bench->pairs),
                                                     });
    sf_resource sorted;

    bench->list_in = import(bench->graph, "list", bytes, SF_ACCESS_TRANSFER_READ);
    bench->count_in = import(bench->graph, "count", sizeof(uint32_t), SF_ACCESS_STORAGE_READ);
    add_copy(bench->graph, "fill", bench->list_in, work);
    sorted = sf_sort_declare(bench->graph,
                             &(struct sf_sort_desc){
                                 .name = NAME,
                                 .capacity = bench->pairs,
                                 .pairs = work,
                                 .count = bench->count_in,
                                 .tuning = &bench->tuning,
                             },
                             &bench->sort);
    bench->out = sf_graph_buffer(bench->graph, &(struct sf_buffer_desc){
                                                   .name = "out",
                                                   .lifetime = SF_READBACK,
                                                   .bytes = sf_graph_buffer_at(bench->graph, sorted)->bytes,
                                               });
    add_copy(bench->graph, "read", sorted, bench->out);
}

static enum sf_status open_bench(struct bench *bench)
{
    struct sf_plan_memory memory = {.needs = sf_gpu_memory_needs, .user = bench->gpu};
    uint64_t bytes = (uint64_t)bench->pairs * sizeof *bench->input;
    enum sf_status status;

    sf_sort_tune(sf_gpu_tuning(bench->gpu), bench->pairs, &bench->tuning);
    if (sf_sort_bytes(&bench->tuning, bench->pairs) > sf_gpu_info(bench->gpu)->max_storage_bytes)
        return sf_fail(
            bench->log, SF_ERROR_USAGE, "sort of %u pairs: the device's largest buffer holds %llu", bench->pairs,
            (unsigned long long)(sf_gpu_info(bench->gpu)->max_storage_bytes / sf_sort_bytes(&bench->tuning, 1)));
    status = make_input(bench);
    if (!status)
        status = sf_graph_create(NAME, bench->log, &bench->graph);
    if (status)
        return status;
    declare(bench);
    status = sf_plan_create(bench->graph, &memory, bench->log, &bench->plan);
    if (!status)
        status = sf_player_create(bench->gpu, bench->plan, &bench->player);
    if (!status)
        status = sf_gpu_buffer_create(bench->gpu, "sort.list", bytes, false, SF_ACCESS_TRANSFER_READ, bench->input,
                                      &bench->list);
    if (!status)
        status = sf_gpu_buffer_create(bench->gpu, "sort.count", sizeof bench->pairs, false, SF_ACCESS_STORAGE_READ,
                                      &bench->pairs, &bench->count);
    if (status)
        return status;
    sf_player_bind_buffer(bench->player, bench->list_in, bench->list);
    sf_player_bind_buffer(bench->player, bench->count_in, bench->count);
    sf_player_set_timing(bench->player, true);
    return SF_OK;
}

static void close_bench(struct bench *bench)
{
    sf_player_destroy(&bench->player);
    sf_plan_destroy(&bench->plan);
    sf_graph_destroy(&bench->graph);
    sf_gpu_buffer_destroy(&bench->list);
    sf_gpu_buffer_destroy(&bench->count);
    free(bench->input);
    free(bench->sorted);
    free(bench->gpu_ns);
    free(bench->cpu_ns);
}

static void sort_on_cpu(struct bench *bench, uint64_t *ns)
{
    uint64_t start;

    for (uint32_t i = 0; i < bench->pairs; i++)
        bench->sorted[i] = (uint64_t)bench->input[i].key << 32 | bench->input[i].payload;
    start = sf_clock_ns();
    sf_sort_words(bench->sorted, bench->pairs);
    *ns = sf_clock_ns() - start;
}

static bool is_correct(const struct bench *bench, const struct sf_sort_pair *result)
{
    for (uint32_t i = 0; i < bench->pairs; i++)
        if (bench->sorted[i] != ((uint64_t)result[i].key << 32 | result[i].payload))
            return false;
    return true;
}

static enum sf_status sort_on_device(struct bench *bench, uint64_t *ns, bool *correct)
{
    const struct sf_pass_time *times = NULL;
    const struct sf_sort_pair *result;
    uint64_t serial = 0, begin = 0, end = 0;
    uint32_t count = 0;
    enum sf_status status = sf_frame_begin(bench->gpu), played, ended;

    if (status)
        return status;
    played = sf_player_play(bench->player);
    ended = sf_frame_end(bench->gpu, &serial);
    status = played ? played : ended;
    if (!status)
        status = sf_frame_wait(bench->gpu, serial);
    if (!status)
        status = sf_player_times(bench->player, serial, &times, &count);
    if (status)
        return status;
    for (uint32_t i = 0; i < count; i++)
        if (strncmp(times[i].name, NAME, sizeof NAME - 1) == 0) {
            begin = end ? begin : times[i].begin_ns;
            end = times[i].end_ns;
        }
    *ns = end - begin;
    result = sf_player_readback(bench->player, bench->out, serial);
    *correct = *correct && result && is_correct(bench, result);
    return SF_OK;
}

static int compare_ns(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;

    return (x > y) - (x < y);
}

static void summarize(uint64_t *samples, uint32_t count, uint64_t *min, uint64_t *median)
{
    qsort(samples, count, sizeof *samples, compare_ns);
    *min = samples[0];
    *median = samples[count / 2];
}

enum sf_status sf_sort_measure(struct sf_gpu *gpu, uint32_t pairs, uint32_t repeats, const struct sf_log *log,
                               struct sf_sort_timing *timing)
{
    struct bench bench = {.gpu = gpu, .log = log, .pairs = pairs, .repeats = repeats};
    enum sf_status status = open_bench(&bench);

    *timing = (struct sf_sort_timing){.correct = true};
    if (!status)
        sort_on_cpu(&bench, &bench.cpu_ns[0]);
    for (uint32_t i = 0; i < WARM_UPS && !status; i++)
        status = sort_on_device(&bench, &bench.gpu_ns[0], &timing->correct);
    /* By turns, so that a busy machine slows both. */
    for (uint32_t i = 0; i < repeats && !status; i++) {
        sort_on_cpu(&bench, &bench.cpu_ns[i]);
        status = sort_on_device(&bench, &bench.gpu_ns[i], &timing->correct);
    }
    if (!status) {
        summarize(bench.gpu_ns, repeats, &timing->gpu_min_ns, &timing->gpu_median_ns);
        summarize(bench.cpu_ns, repeats, &timing->cpu_min_ns, &timing->cpu_median_ns);
    }
    close_bench(&bench);
    return status;
}
