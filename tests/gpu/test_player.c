/* Playing plans: what comes out of passes, and that nothing of it draws a message from validation or synchronization
 * validation. */
#include "gpu_kit.h"
#include "base/thread.h"

enum { WORDS = 1000 };

static void test_round_trip(void **state)
{
    struct sf_gpu *gpu = kit_gpu(0);
    struct sf_gpu_buffer *buffer = NULL;
    uint32_t words[WORDS], got[WORDS];

    (void)state;
    for (uint32_t i = 0; i < WORDS; i++)
        words[i] = i * 2654435761u;
    for (int history = 0; history < 2; history++) {
        assert_int_equal(
            sf_gpu_buffer_create(gpu, "words", sizeof words, history, SF_ACCESS_STORAGE_READ, NULL, &buffer), SF_OK);
        memset(got, 0xff, sizeof got);
        assert_int_equal(sf_gpu_buffer_read(buffer, 0, got, sizeof got), SF_OK);
        for (uint32_t i = 0; i < WORDS; i++)
            assert_int_equal(got[i], 0);
        assert_int_equal(sf_gpu_buffer_write(buffer, 8, words + 2, sizeof words - 8), SF_OK);
        assert_int_equal(sf_gpu_buffer_read(buffer, 0, got, sizeof got), SF_OK);
        assert_int_equal(got[1], 0);
        assert_memory_equal(got + 2, words + 2, sizeof words - 8);
        sf_gpu_buffer_destroy(&buffer);
        assert_null(buffer);
    }
    assert_int_equal(sf_gpu_buffer_create(gpu, "words", sizeof words, false, SF_ACCESS_STORAGE_READ, words, &buffer),
                     SF_OK);
    assert_int_equal(sf_gpu_buffer_read(buffer, 4, got, 8), SF_OK);
    assert_int_equal(got[1], words[2]);
    assert_int_equal(sf_gpu_buffer_read(buffer, 4, got, sizeof words), SF_ERROR_USAGE);
    assert_non_null(strstr(kit_record.last, "'words'"));
    kit_forget();
    sf_gpu_buffer_destroy(&buffer);
    kit_finish(&gpu);
}

/* Eight passes in a row over transients, which share memory two by two. */
static void test_chain(void **state)
{
    enum { LINKS = 8 };
    static const char *const names[LINKS] = {"a", "b", "c", "d", "e", "f", "g", "h"};
    static const char *const passes[LINKS] = {"to a", "to b", "to c", "to d", "to e", "to f", "to g", "to h"};
    uint32_t words[WORDS], addends[LINKS], sum = 0;
    struct sf_gpu *gpu = kit_gpu(0);
    struct sf_gpu_buffer *source = NULL;
    struct sf_graph *graph = kit_graph("chain");
    struct sf_plan *plan = NULL;
    struct sf_player *player;
    sf_resource in, link, out;
    const uint32_t *got;

    (void)state;
    for (uint32_t i = 0; i < WORDS; i++)
        words[i] = i;
    in = sf_graph_buffer(
        graph, &(struct sf_buffer_desc){
                   .name = "in", .lifetime = SF_IMPORTED, .bytes = sizeof words, .outside = SF_ACCESS_STORAGE_READ});
    link = in;
    for (uint32_t i = 0; i < LINKS; i++) {
        sf_resource next = kit_buffer(graph, names[i], SF_TRANSIENT, sizeof words);

        addends[i] = 1u << i;
        sum += addends[i];
        kit_add(graph, passes[i], link, false, next, WORDS, &addends[i]);
        link = next;
    }
    out = kit_buffer(graph, "out", SF_READBACK, sizeof words);
    kit_copy(graph, "read", link, out);
    player = kit_player(gpu, graph, &plan);
    assert_true(plan->heap_bytes < plan->unaliased_bytes);
    assert_int_equal(sf_gpu_buffer_create(gpu, "in", sizeof words, false, SF_ACCESS_STORAGE_READ, words, &source),
                     SF_OK);
    sf_player_bind_buffer(player, in, source);
    for (int round = 0; round < 5; round++) {
        got = sf_player_readback(player, out, kit_play(gpu, player));
        assert_non_null(got);
        for (uint32_t i = 0; i < WORDS; i++)
            assert_int_equal(got[i], words[i] + sum);
    }
    kit_drop(&player, &plan, &graph);
    sf_gpu_buffer_destroy(&source);
    kit_finish(&gpu);
}

/* Pixels up, through the sampler and a storage image, and down again; and the plain copies between images and buffers.
 */
static void test_images(void **state)
{
    enum { W = 37, H = 19, PIXELS = W * H };
    static float pixels[PIXELS][4];
    struct sf_gpu *gpu = kit_gpu(0);
    struct sf_gpu_image *image = NULL;
    struct sf_graph *graph = kit_graph("images");
    struct sf_plan *plan = NULL;
    struct sf_player *player;
    sf_resource in, storage, copied, between, sampled_out, copied_out, between_out, buffer, from_buffer, buffer_out;
    uint64_t serial;
    const float *got;

    (void)state;
    for (uint32_t i = 0; i < PIXELS; i++)
        for (uint32_t c = 0; c < 4; c++)
            pixels[i][c] = (float)(i * 4 + c) - 100.0f;
    in = sf_graph_image(graph, &(struct sf_image_desc){.name = "in",
                                                       .format = SF_FORMAT_RGBA32F,
                                                       .lifetime = SF_IMPORTED,
                                                       .size = {.width = W, .height = H},
                                                       .outside = SF_ACCESS_SAMPLED});
    storage = kit_image(graph, "storage", SF_FORMAT_RGBA32F, SF_TRANSIENT, W, H);
    between = kit_image(graph, "between", SF_FORMAT_RGBA32F, SF_TRANSIENT, W, H);
    copied = kit_image(graph, "copied", SF_FORMAT_RGBA32F, SF_TRANSIENT, W, H);
    from_buffer = kit_image(graph, "from buffer", SF_FORMAT_RGBA32F, SF_TRANSIENT, W, H);
    buffer = kit_buffer(graph, "buffer", SF_TRANSIENT, sizeof pixels);
    sampled_out = kit_buffer(graph, "sampled.out", SF_READBACK, sizeof pixels);
    between_out = kit_buffer(graph, "between.out", SF_READBACK, sizeof pixels);
    copied_out = kit_buffer(graph, "copied.out", SF_READBACK, sizeof pixels);
    buffer_out = kit_buffer(graph, "buffer.out", SF_READBACK, sizeof pixels);
    kit_sample(graph, "sample", in, false, SF_SAMPLER_NEAREST, storage, 0);
    kit_sample(graph, "sample between", in, false, SF_SAMPLER_LINEAR, between, 1);
    kit_copy(graph, "copy", storage, copied);
    kit_copy(graph, "to buffer", in, buffer);
    kit_copy(graph, "to image", buffer, from_buffer);
    kit_copy(graph, "read sampled", storage, sampled_out);
    kit_copy(graph, "read between", between, between_out);
    kit_copy(graph, "read copied", copied, copied_out);
    kit_copy(graph, "read buffer", from_buffer, buffer_out);
    player = kit_player(gpu, graph, &plan);
    assert_int_equal(sf_gpu_image_create(gpu, "in", SF_FORMAT_RGBA32F, W, H, 1, SF_ACCESS_SAMPLED, pixels, &image),
                     SF_OK);
    sf_player_bind_image(player, in, image);
    for (int round = 0; round < 2; round++) {
        serial = kit_play(gpu, player);
        assert_memory_equal(sf_player_readback(player, sampled_out, serial), pixels, sizeof pixels);
        assert_memory_equal(sf_player_readback(player, copied_out, serial), pixels, sizeof pixels);
        assert_memory_equal(sf_player_readback(player, buffer_out, serial), pixels, sizeof pixels);
        got = sf_player_readback(player, between_out, serial);
        for (uint32_t i = 0; i < PIXELS; i++) /* half way to the right neighbour; the last column is clamped */
            assert_float_equal(got[i * 4], pixels[i][0] + (i % W == W - 1 ? 0.0f : 2.0f), 0.02f);
    }
    kit_drop(&player, &plan, &graph);
    sf_gpu_image_destroy(&image);
    kit_finish(&gpu);
}

static void test_constants(void **state)
{
    const float offset = 0.5f;
    struct sf_gpu *gpu = kit_gpu(0);
    struct sf_graph *graph = kit_graph("constants");
    struct sf_plan *plan = NULL;
    struct sf_player *player;
    sf_resource result = kit_buffer(graph, "result", SF_TRANSIENT, 64 * 4),
                out = kit_buffer(graph, "out", SF_READBACK, 64 * 4);
    const struct sf_use use = {.resource = result, .access = SF_ACCESS_STORAGE_WRITE, .binding = 3};
    struct sf_pass_desc pass = {.name = "constants",
                                .kind = SF_PASS_COMPUTE,
                                .uses = &use,
                                .use_count = 1,
                                .shader = "test/constants.comp",
                                .constants = {16, 3},
                                .constant_count = 3,
                                .groups = {4, 1, 1}};
    const float *got;

    (void)state;
    memcpy(&pass.constants[2], &offset, sizeof offset);
    sf_graph_pass(graph, &pass);
    kit_copy(graph, "read", result, out);
    player = kit_player(gpu, graph, &plan);
    got = sf_player_readback(player, out, kit_play(gpu, player));
    for (int i = 0; i < 64; i++)
        assert_float_equal(got[i], (float)(i * 3) + 0.5f + 16000.0f, 0.0f);
    kit_drop(&player, &plan, &graph);
    kit_finish(&gpu);
}

static void count_pass(struct sf_graph *graph, const char *name, sf_resource count, sf_resource indirect,
                       uint64_t offset, const uint32_t *live)
{
    const struct sf_use use = {.resource = count, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 0};

    sf_graph_pass(graph, &(struct sf_pass_desc){.name = name,
                                                .kind = SF_PASS_COMPUTE,
                                                .uses = &use,
                                                .use_count = 1,
                                                .shader = "test/count.comp",
                                                .indirect = indirect,
                                                .indirect_offset = offset,
                                                .groups_live = live});
}

/* Group counts from the device, and from the CPU at each play; zero runs nothing, too many are refused. */
static void test_groups(void **state)
{
    uint32_t live[3] = {3, 1, 2};
    struct sf_gpu *gpu = kit_gpu(0);
    struct sf_graph *graph = kit_graph("groups");
    struct sf_plan *plan = NULL;
    struct sf_player *player;
    sf_resource count = kit_buffer(graph, "count", SF_PERSISTENT, 4),
                arguments = kit_buffer(graph, "arguments", SF_TRANSIENT, 64);
    sf_resource out = kit_buffer(graph, "out", SF_READBACK, 4);
    const struct sf_use uses[] = {{.resource = count, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 0},
                                  {.resource = arguments, .access = SF_ACCESS_STORAGE_WRITE, .binding = 1}};
    uint32_t expected = 0;

    (void)state;
    sf_graph_pass(graph, &(struct sf_pass_desc){.name = "arguments",
                                                .kind = SF_PASS_COMPUTE,
                                                .uses = uses,
                                                .use_count = 2,
                                                .shader = "test/groups.comp",
                                                .groups = {7, 1, 1}});
    count_pass(graph, "indirect", count, arguments, 0, NULL);
    count_pass(graph, "live", count, 0, 0, live);
    kit_copy(graph, "read", count, out);
    player = kit_player(gpu, graph, &plan);
    for (uint32_t round = 0; round < 3; round++) {
        live[1] = round;
        expected += 7 + 5 * 2 * 1 + 3 * round * 2;
        assert_int_equal(*(const uint32_t *)sf_player_readback(player, out, kit_play(gpu, player)), expected);
    }
    live[0] = UINT32_MAX;
    assert_int_equal(sf_frame_begin(gpu), SF_OK);
    assert_int_equal(sf_player_play(player), SF_ERROR_USAGE);
    assert_non_null(strstr(kit_record.last, "'live'"));
    kit_forget();
    assert_int_equal(sf_frame_end(gpu, NULL), SF_OK);
    kit_drop(&player, &plan, &graph);
    kit_finish(&gpu);
}

/* A fill, and a copy of less than the whole. */
static void test_fill(void **state)
{
    struct sf_gpu *gpu = kit_gpu(0);
    struct sf_graph *graph = kit_graph("fill");
    struct sf_plan *plan = NULL;
    struct sf_player *player;
    sf_resource buffer = kit_buffer(graph, "buffer", SF_TRANSIENT, WORDS * 4),
                out = kit_buffer(graph, "out", SF_READBACK, WORDS * 8);
    const uint32_t *got;

    (void)state;
    kit_fill(graph, "fill", buffer, 0xabcd1234);
    kit_copy(graph, "read", buffer, out);
    player = kit_player(gpu, graph, &plan);
    got = sf_player_readback(player, out, kit_play(gpu, player));
    for (uint32_t i = 0; i < WORDS; i++)
        assert_int_equal(got[i], 0xabcd1234);
    kit_drop(&player, &plan, &graph);
    kit_finish(&gpu);
}

/* Passes in order, one after the other, within the time that the CPU saw go by. */
static void test_timing(void **state)
{
    enum { PASSES = 6 };
    static const char *const names[PASSES] = {"one", "two", "three", "four", "five", "six"};
    const uint32_t one = 1;
    struct sf_gpu *gpu = kit_gpu(0);
    struct sf_graph *graph = kit_graph("timing");
    struct sf_plan *plan = NULL;
    struct sf_player *player;
    sf_resource buffer = kit_buffer(graph, "state", SF_HISTORY, 1 << 20);
    const struct sf_pass_time *times;
    uint32_t count = 0;
    uint64_t serial;

    (void)state;
    kit_add(graph, names[0], buffer, true, buffer, 1 << 18, &one);
    for (int i = 1; i < PASSES; i++) {
        const struct sf_use uses[] = {
            {.resource = buffer, .access = SF_ACCESS_STORAGE_READ, .binding = 0, .previous = true},
            {.resource = buffer, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 1},
        };

        sf_graph_pass(graph, &(struct sf_pass_desc){.name = names[i],
                                                    .kind = SF_PASS_COMPUTE,
                                                    .uses = uses,
                                                    .use_count = 2,
                                                    .shader = "test/accumulate.comp",
                                                    .groups = {1 << 12, 1, 1}});
    }
    player = kit_player(gpu, graph, &plan);
    serial = kit_play(gpu, player);
    assert_int_equal(sf_player_times(player, serial, &times, &count), SF_ERROR_USAGE);
    kit_forget();
    sf_player_set_timing(player, true);
    for (int round = 0; round < 3; round++) {
        uint64_t before = sf_clock_ns(), wall, sum = 0;

        serial = kit_play(gpu, player);
        wall = sf_clock_ns() - before;
        assert_int_equal(sf_player_times(player, serial, &times, &count), SF_OK);
        assert_int_equal(count, PASSES);
        for (uint32_t i = 0; i < count; i++) {
            assert_string_equal(times[i].name, names[i]);
            assert_true(times[i].end_ns > times[i].begin_ns);
            if (i > 0)
                assert_true(times[i].begin_ns == times[i - 1].end_ns);
            sum += times[i].end_ns - times[i].begin_ns;
        }
        assert_true(sum == times[PASSES - 1].end_ns - times[0].begin_ns);
        assert_true(sum < wall);
    }
    assert_int_equal(sf_player_times(player, serial - 2, &times, &count), SF_ERROR_USAGE);
    kit_forget();
    kit_drop(&player, &plan, &graph);
    kit_finish(&gpu);
}

/* Leaving a barrier of a chain out is noticed by the layers: what the mutation test of whole scenes rests on. */
static void test_dropped_barrier(void **state)
{
    const uint32_t one = 1;
    struct sf_gpu *gpu;
    uint32_t noticed = 0, barriers = 0;

    (void)state;
    for (uint32_t drop = 0; drop == 0 || drop < barriers; drop++) {
        struct sf_graph *graph = kit_graph("mutant");
        struct sf_plan *plan = NULL;
        struct sf_player *player;
        sf_resource a = kit_buffer(graph, "a", SF_TRANSIENT, WORDS * 4),
                    b = kit_buffer(graph, "b", SF_TRANSIENT, WORDS * 4);
        sf_resource out = kit_buffer(graph, "out", SF_READBACK, WORDS * 4);

        gpu = kit_gpu(0);
        kit_fill(graph, "fill", a, 0);
        kit_add(graph, "add", a, false, b, WORDS, &one);
        kit_copy(graph, "read", b, out);
        player = kit_player(gpu, graph, &plan);
        barriers = plan->final_count;
        for (uint32_t i = 0; i < plan->pass_count; i++)
            barriers += plan->passes[i].barrier_count;
        sf_player_drop_barrier(player, drop);
        kit_play(gpu, player);
        noticed += sf_gpu_validation_messages(gpu, NULL) > 0;
        kit_drop(&player, &plan, &graph);
        sf_gpu_destroy(&gpu);
    }
    assert_true(barriers >= 3);
    assert_true(noticed >= 2);
}

/* Named errors for what cannot be played; nothing is recorded then. */
static void test_misuse(void **state)
{
    struct sf_gpu *gpu = kit_gpu(0);
    struct sf_graph *graph = kit_graph("misuse");
    struct sf_plan *plan = NULL;
    struct sf_player *player;
    const uint32_t one = 1;
    const struct sf_buffer_desc desc = {
        .name = "in", .lifetime = SF_IMPORTED, .bytes = WORDS * 4, .outside = SF_ACCESS_STORAGE_READ};
    sf_resource in = sf_graph_buffer(graph, &desc), out = kit_buffer(graph, "out", SF_PERSISTENT, WORDS * 4);
    struct sf_gpu_buffer *small = NULL, *other = NULL;

    (void)state;
    kit_add(graph, "add", in, false, out, WORDS, &one);
    player = kit_player(gpu, graph, &plan);
    assert_int_equal(sf_gpu_buffer_create(gpu, "small", 16, false, SF_ACCESS_STORAGE_READ, NULL, &small), SF_OK);
    assert_int_equal(sf_gpu_buffer_create(gpu, "other", WORDS * 4, false, SF_ACCESS_TRANSFER_READ, NULL, &other),
                     SF_OK);
    assert_int_equal(sf_player_play(player), SF_ERROR_USAGE); /* no frame */
    assert_int_equal(sf_frame_end(gpu, NULL), SF_ERROR_USAGE);
    assert_int_equal(sf_frame_begin(gpu), SF_OK);
    assert_int_equal(sf_frame_begin(gpu), SF_ERROR_USAGE);
    assert_int_equal(sf_player_play(player), SF_ERROR_USAGE);
    assert_non_null(strstr(kit_record.last, "nothing bound to 'in'"));
    sf_player_bind_buffer(player, in, small);
    assert_int_equal(sf_player_play(player), SF_ERROR_USAGE);
    assert_non_null(strstr(kit_record.last, "'small'"));
    sf_player_bind_buffer(player, in, other);
    assert_int_equal(sf_player_play(player), SF_ERROR_USAGE);
    assert_non_null(strstr(kit_record.last, "'other'"));
    assert_int_equal(sf_frame_end(gpu, NULL), SF_OK);
    kit_drop(&player, &plan, &graph);
    kit_forget();

    graph = kit_graph("shaderless");
    out = kit_buffer(graph, "out", SF_PERSISTENT, WORDS * 4);
    sf_graph_pass(graph, &(struct sf_pass_desc){
                             .name = "pass",
                             .kind = SF_PASS_COMPUTE,
                             .uses = &(struct sf_use){.resource = out, .access = SF_ACCESS_STORAGE_WRITE},
                             .use_count = 1,
                             .shader = "test/none.comp",
                             .groups = {1, 1, 1},
                         });
    assert_int_equal(
        sf_plan_create(graph, &(struct sf_plan_memory){.needs = sf_gpu_memory_needs, .user = gpu}, &kit_log, &plan),
        SF_OK);
    assert_int_equal(sf_player_create(gpu, plan, &player), SF_ERROR_INTERNAL);
    assert_null(player);
    assert_non_null(strstr(kit_record.last, "'test/none.comp'"));
    kit_drop(&player, &plan, &graph);
    kit_forget();
    sf_gpu_buffer_destroy(&small);
    sf_gpu_buffer_destroy(&other);
    kit_finish(&gpu);
}

/* What recording 30 passes costs the CPU, without the layers. */
static void test_record_cost(void **state)
{
    enum { PASSES = 30 };
    const struct sf_gpu_options options = {.no_cache = true};
    const uint32_t one = 1;
    char names[PASSES][2][32];
    struct sf_gpu *gpu = NULL;
    struct sf_graph *graph = kit_graph("thirty");
    struct sf_plan *plan = NULL;
    struct sf_player *player;
    sf_resource link = kit_buffer(graph, "first", SF_TRANSIENT, WORDS * 4),
                out = kit_buffer(graph, "out", SF_READBACK, WORDS * 4);
    uint64_t least = UINT64_MAX;

    (void)state;
    kit_forget();
    assert_int_equal(sf_gpu_create(&options, &kit_log, &gpu), SF_OK);
    kit_fill(graph, "fill", link, 0);
    for (int i = 0; i < PASSES - 2; i++) {
        sf_resource next;

        snprintf(names[i][0], sizeof names[i][0], "buffer %d", i);
        snprintf(names[i][1], sizeof names[i][1], "pass %d", i);
        next = kit_buffer(graph, names[i][0], SF_TRANSIENT, WORDS * 4);
        kit_add(graph, names[i][1], link, false, next, WORDS, &one);
        link = next;
    }
    kit_copy(graph, "read", link, out);
    player = kit_player(gpu, graph, &plan);
    assert_int_equal(plan->pass_count, PASSES);
    sf_player_set_timing(player, true);
    for (int round = 0; round < 50; round++) {
        uint64_t serial = kit_play(gpu, player);

        if (round > 2 && sf_player_record_ns(player) < least)
            least = sf_player_record_ns(player);
        assert_int_equal(*(const uint32_t *)sf_player_readback(player, out, serial), PASSES - 2);
    }
    print_message("recording %d passes takes %.1f us\n", PASSES, (double)least * 1e-3);
#ifndef __SANITIZE_ADDRESS__ /* whose own cost is many times that of the work */
    assert_true(least < 200000);
#endif
    kit_drop(&player, &plan, &graph);
    kit_finish(&gpu);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trip),  cmocka_unit_test(test_chain),           cmocka_unit_test(test_images),
        cmocka_unit_test(test_constants),   cmocka_unit_test(test_groups),          cmocka_unit_test(test_fill),
        cmocka_unit_test(test_timing),      cmocka_unit_test(test_dropped_barrier), cmocka_unit_test(test_misuse),
        cmocka_unit_test(test_record_cost),
    };
    int skip = kit_probe();

    return skip ? skip : cmocka_run_group_tests(tests, NULL, NULL);
}
