/* The sort on the device, in every way it can be tuned, against what stable and sorted mean: keys ascend, equal keys
 * keep their order, and each payload, the number of its pair, still has its key. */
#include "gpu_kit.h"
#include <math.h>
#include "base/hash.h"
#include "sim/sort.h"

/* A list that is sorted again and again, with other contents and counts. */
struct fixture {
    struct sf_gpu *gpu;
    struct sf_graph *graph;
    struct sf_plan *plan;
    struct sf_player *player;
    struct sf_gpu_buffer *list, *count;
    sf_resource out;
    struct sf_sort_tuning tuning;
    struct sf_sort sort;
    uint32_t capacity;
    struct sf_sort_pair *input;
};

enum { COUNT_WORD = 3, COUNT_WORDS = 8 };

static void open_fixture(struct fixture *f, struct sf_gpu *gpu, const struct sf_sort_tuning *tuning, uint32_t capacity)
{
    uint64_t bytes = capacity * sizeof *f->input;
    sf_resource list, count, pairs, sorted;

    *f = (struct fixture){.gpu = gpu, .tuning = *tuning, .capacity = capacity};
    f->input = malloc(bytes);
    assert_non_null(f->input);
    f->graph = kit_graph("sort");
    list = sf_graph_buffer(
        f->graph, &(struct sf_buffer_desc){
                      .name = "list", .lifetime = SF_IMPORTED, .bytes = bytes, .outside = SF_ACCESS_TRANSFER_READ});
    count = sf_graph_buffer(f->graph, &(struct sf_buffer_desc){.name = "count",
                                                               .lifetime = SF_IMPORTED,
                                                               .bytes = 4 * COUNT_WORDS,
                                                               .outside = SF_ACCESS_STORAGE_READ});
    pairs = kit_buffer(f->graph, "pairs", SF_TRANSIENT, sf_sort_bytes(tuning, capacity));
    kit_copy(f->graph, "fill", list, pairs);
    sorted = sf_sort_declare(f->graph,
                             &(struct sf_sort_desc){.name = "sort",
                                                    .capacity = capacity,
                                                    .pairs = pairs,
                                                    .count = count,
                                                    .count_word = COUNT_WORD,
                                                    .tuning = &f->tuning},
                             &f->sort);
    f->out = kit_buffer(f->graph, "out", SF_READBACK, sf_graph_buffer_at(f->graph, sorted)->bytes);
    kit_copy(f->graph, "read", sorted, f->out);
    f->player = kit_player(gpu, f->graph, &f->plan);
    assert_int_equal(sf_gpu_buffer_create(gpu, "list", bytes, false, SF_ACCESS_TRANSFER_READ, NULL, &f->list), SF_OK);
    assert_int_equal(
        sf_gpu_buffer_create(gpu, "count", 4 * COUNT_WORDS, false, SF_ACCESS_STORAGE_READ, NULL, &f->count), SF_OK);
    sf_player_bind_buffer(f->player, list, f->list);
    sf_player_bind_buffer(f->player, count, f->count);
}

static void close_fixture(struct fixture *f)
{
    kit_drop(&f->player, &f->plan, &f->graph);
    sf_gpu_buffer_destroy(&f->list);
    sf_gpu_buffer_destroy(&f->count);
    free(f->input);
}

/* Sorts what stands in f->input, `count` pairs of it. The result is good until two frames on. */
static const struct sf_sort_pair *sort(struct fixture *f, uint32_t count)
{
    uint32_t counts[COUNT_WORDS];
    const struct sf_sort_pair *result;

    for (uint32_t i = 0; i < COUNT_WORDS; i++)
        counts[i] = i == COUNT_WORD ? count : 0xabcdef01u;
    assert_int_equal(sf_gpu_buffer_write(f->list, 0, f->input, f->capacity * sizeof *f->input), SF_OK);
    assert_int_equal(sf_gpu_buffer_write(f->count, 0, counts, sizeof counts), SF_OK);
    result = sf_player_readback(f->player, f->out, kit_play(f->gpu, f->player));
    assert_non_null(result);
    return result;
}

static void check(const struct fixture *f, const struct sf_sort_pair *result, uint32_t count, const char *what)
{
    for (uint32_t i = 0; i < count; i++) {
        if (result[i].payload >= count || f->input[result[i].payload].key != result[i].key)
            fail_msg("%s, %u pairs: pair %u is none of the list's", what, count, i);
        if (i > 0 && result[i - 1].key > result[i].key)
            fail_msg("%s, %u pairs: pair %u is out of order", what, count, i);
        /* Payloads that ascend strictly under each key are also all different. */
        if (i > 0 && result[i - 1].key == result[i].key && result[i - 1].payload >= result[i].payload)
            fail_msg("%s, %u pairs: pairs %u and %u, which are equal, changed places", what, count, i - 1, i);
    }
}

static const char *const KINDS[] = {"random",   "all equal",       "all greatest", "sorted", "reversed",
                                    "two keys", "mostly greatest", "third digit",  "runs"};
enum { KIND_COUNT = sizeof KINDS / sizeof *KINDS };

static uint32_t key_of(uint32_t kind, uint32_t i, uint32_t count)
{
    uint32_t random = sf_random_u32(count, i, kind);
    const uint32_t keys[KIND_COUNT] = {random,
                                       0x01010101u,
                                       UINT32_MAX,
                                       i,
                                       count - i,
                                       random & 1 ? 0x80000000u : 0x7fffffffu,
                                       random % 5 ? UINT32_MAX : random,
                                       random & 0xff0000u,
                                       (i % 77) << 20};

    return keys[kind];
}

static void sort_all(struct sf_gpu *gpu, const struct sf_sort_tuning *tuning, const char *what)
{
    /* Slices, whose barriers are slow on a CPU, get by with the first ones. */
    static const uint32_t counts[] = {4099, 0, 1, 257, 1000, 2, 3, 7, 8, 31, 64, 65, 255, 256, 4095};
    size_t count_count = tuning->blocks ? sizeof counts / sizeof *counts : 5;
    struct fixture f;

    open_fixture(&f, gpu, tuning, 4099);
    for (size_t c = 0; c < count_count; c++)
        for (uint32_t kind = 0; kind < KIND_COUNT; kind++) {
            char where[64];

            snprintf(where, sizeof where, "%s, %s", what, KINDS[kind]);
            for (uint32_t i = 0; i < f.capacity; i++)
                f.input[i] = (struct sf_sort_pair){.key = key_of(kind, i, counts[c]), .payload = i};
            check(&f, sort(&f, counts[c]), counts[c], where);
        }
    /* A count beyond the capacity is cut to it. */
    check(&f, sort(&f, f.capacity + 1), f.capacity, what);
    check(&f, sort(&f, UINT32_MAX), f.capacity, what);
    close_fixture(&f);
}

static struct sf_sort_tuning tuned(struct sf_gpu *gpu, uint32_t capacity)
{
    struct sf_sort_tuning tuning;

    sf_sort_tune(sf_gpu_tuning(gpu), capacity, &tuning);
    return tuning;
}

static void test_as_tuned(void **state)
{
    struct sf_gpu *gpu = kit_gpu(0);
    struct sf_sort_tuning tuning = tuned(gpu, 4099);

    (void)state;
    sort_all(gpu, &tuning, "as tuned");
    kit_finish(&gpu);
}

static void test_blocks(void **state)
{
    /* groups, local, merge groups, ways: one block; some runs without partners; two and three merges; subgroups less
     * than workgroups and only partly filled */
    static const uint32_t shapes[][4] = {{1, 8, 1, 4},  {3, 8, 2, 4}, {4, 1, 5, 4}, {6, 64, 1, 2},
                                         {16, 8, 2, 4}, {2, 8, 1, 2}, {37, 5, 4, 4}};
    struct sf_gpu *gpu = kit_gpu(0);

    (void)state;
    for (size_t s = 0; s < sizeof shapes / sizeof *shapes; s++)
        for (int int64 = 0; int64 <= sf_gpu_tuning(gpu)->int64; int64++) {
            const struct sf_sort_tuning tuning = {.blocks = true,
                                                  .int64 = int64,
                                                  .groups = shapes[s][0],
                                                  .local = shapes[s][1],
                                                  .merge_groups = shapes[s][2],
                                                  .ways = shapes[s][3]};
            char what[64];

            snprintf(what, sizeof what, "%u blocks%s", tuning.groups, int64 ? " of words" : "");
            sort_all(gpu, &tuning, what);
        }
    kit_finish(&gpu);
}

static void test_slices(void **state)
{
    /* groups, local, items */
    static const uint32_t shapes[][3] = {{1, 64, 1}, {5, 16, 8}, {3, 256, 8}, {70, 32, 3}};
    struct sf_gpu *gpu = kit_gpu(0);

    (void)state;
    for (size_t s = 0; s < sizeof shapes / sizeof *shapes; s++) {
        const struct sf_sort_tuning tuning = {.groups = shapes[s][0], .local = shapes[s][1], .items = shapes[s][2]};
        char what[64];

        snprintf(what, sizeof what, "%u slices", tuning.groups);
        sort_all(gpu, &tuning, what);
    }
    kit_finish(&gpu);
}

static void sort_million(struct sf_gpu *gpu, const struct sf_sort_tuning *tuning, const char *what)
{
    static const uint32_t counts[] = {1 << 20, 1000003, 65536, 65535};
    size_t count_count = tuning->blocks ? sizeof counts / sizeof *counts : 1;
    struct fixture f;

    open_fixture(&f, gpu, tuning, 1 << 20);
    for (uint32_t i = 0; i < f.capacity; i++)
        f.input[i] = (struct sf_sort_pair){.key = key_of(0, i, 0), .payload = i};
    for (size_t c = 0; c < count_count; c++)
        check(&f, sort(&f, counts[c]), counts[c], what);
    /* all on one side of one merge */
    for (uint32_t i = 0; i < f.capacity; i++)
        f.input[i].key = UINT32_MAX - (i >> 16);
    check(&f, sort(&f, f.capacity), f.capacity, what);
    close_fixture(&f);
}

static void test_million(void **state)
{
    struct sf_gpu *gpu = kit_gpu(0);
    const struct sf_gpu_tuning like_gpu = {.subgroup_size = 32,
                                           .workers = 128,
                                           .max_group_invocations = 256,
                                           .shared_bytes = sf_gpu_tuning(gpu)->shared_bytes};
    struct sf_sort_tuning tuning = tuned(gpu, 1 << 20);

    (void)state;
    sort_million(gpu, &tuning, "as tuned");
    tuning.int64 = false;
    sort_million(gpu, &tuning, "without 64-bit words");
    sf_sort_tune(&like_gpu, 1 << 20, &tuning);
    sort_million(gpu, &tuning, "as on a GPU");
    kit_finish(&gpu);
}

/* Keys made on the device from floats of every kind sort as `<` says, stably, with NaNs last. */
static void test_floats(void **state)
{
    static const uint32_t edges[] = {0x7fc00000, 0xffc00001, 0x7f800001, 0x7f800000, 0xff800000, 0x00000000,
                                     0x80000000, 0x00000001, 0x80000001, 0x80000000, 0x00000000, 0x7f7fffff,
                                     0xff7fffff, 0x3f800000, 0xbf800000, 0x7fc00000};
    enum { EDGES = sizeof edges / sizeof *edges, COUNT = 1000 };
    struct sf_gpu *gpu = kit_gpu(0);
    struct sf_graph *graph = kit_graph("floats");
    struct sf_sort_tuning tuning = tuned(gpu, COUNT);
    struct sf_sort sort;
    struct sf_plan *plan = NULL;
    struct sf_player *player;
    struct sf_gpu_buffer *buffers[2] = {NULL, NULL};
    const uint32_t count = COUNT;
    uint32_t bits[COUNT];
    float floats[COUNT];
    const struct sf_sort_pair *result;
    sf_resource in, counter, pairs, sorted, out;

    (void)state;
    for (uint32_t i = 0; i < COUNT; i++)
        bits[i] = i % 3 ? edges[sf_random_u32(0, i, 0) % EDGES] : sf_random_u32(0, i, 1);
    memcpy(floats, bits, sizeof floats);
    in = sf_graph_buffer(graph, &(struct sf_buffer_desc){.name = "floats",
                                                         .lifetime = SF_IMPORTED,
                                                         .bytes = sizeof floats,
                                                         .outside = SF_ACCESS_STORAGE_READ});
    counter = sf_graph_buffer(
        graph, &(struct sf_buffer_desc){
                   .name = "count", .lifetime = SF_IMPORTED, .bytes = 4, .outside = SF_ACCESS_STORAGE_READ});
    pairs = kit_buffer(graph, "pairs", SF_TRANSIENT, sf_sort_bytes(&tuning, COUNT));
    sf_graph_pass(
        graph,
        &(struct sf_pass_desc){
            .name = "keys",
            .kind = SF_PASS_COMPUTE,
            .uses = (const struct sf_use[]){{.resource = in, .access = SF_ACCESS_STORAGE_READ, .binding = 0},
                                            {.resource = pairs, .access = SF_ACCESS_STORAGE_WRITE, .binding = 1}},
            .use_count = 2,
            .shader = "test/sort_key.comp",
            .groups = {(COUNT + 63) / 64, 1, 1}});
    sorted = sf_sort_declare(
        graph,
        &(struct sf_sort_desc){.name = "sort", .capacity = COUNT, .pairs = pairs, .count = counter, .tuning = &tuning},
        &sort);
    out = kit_buffer(graph, "out", SF_READBACK, sf_graph_buffer_at(graph, sorted)->bytes);
    kit_copy(graph, "read", sorted, out);
    player = kit_player(gpu, graph, &plan);
    assert_int_equal(
        sf_gpu_buffer_create(gpu, "floats", sizeof floats, false, SF_ACCESS_STORAGE_READ, bits, &buffers[0]), SF_OK);
    assert_int_equal(sf_gpu_buffer_create(gpu, "count", 4, false, SF_ACCESS_STORAGE_READ, &count, &buffers[1]), SF_OK);
    sf_player_bind_buffer(player, in, buffers[0]);
    sf_player_bind_buffer(player, counter, buffers[1]);
    result = sf_player_readback(player, out, kit_play(gpu, player));
    assert_non_null(result);
    for (uint32_t i = 0; i < COUNT; i++) {
        float b = floats[result[i].payload], a = i ? floats[result[i - 1].payload] : -INFINITY;

        assert_int_equal(result[i].key, sf_sort_key(b));
        assert_true(isnan(b) || a <= b);
        if (i > 0 && (a == b || (isnan(a) && isnan(b))))
            assert_true(result[i - 1].payload < result[i].payload);
    }
    kit_drop(&player, &plan, &graph);
    sf_gpu_buffer_destroy(&buffers[0]);
    sf_gpu_buffer_destroy(&buffers[1]);
    kit_finish(&gpu);
}

static void test_measure(void **state)
{
    struct sf_gpu *gpu = kit_gpu(0);
    struct sf_sort_timing timing;

    (void)state;
    assert_int_equal(sf_sort_measure(gpu, 10000, 3, &kit_log, &timing), SF_OK);
    assert_true(timing.correct);
    assert_in_range(timing.gpu_min_ns, 1, timing.gpu_median_ns);
    assert_in_range(timing.cpu_min_ns, 1, timing.cpu_median_ns);
    assert_int_equal(sf_sort_measure(gpu, UINT32_MAX, 1, &kit_log, &timing), SF_ERROR_USAGE);
    assert_non_null(strstr(kit_record.last, "4294967295 pairs"));
    kit_forget();
    kit_finish(&gpu);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_as_tuned), cmocka_unit_test(test_blocks), cmocka_unit_test(test_slices),
        cmocka_unit_test(test_million),  cmocka_unit_test(test_floats), cmocka_unit_test(test_measure),
    };
    int skip = kit_probe();

    return skip ? skip : cmocka_run_group_tests(tests, NULL, NULL);
}
