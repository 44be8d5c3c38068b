/* What lives longer than a play, or is exchanged with the CPU: histories, uploads, results. */
#include "gpu_kit.h"

enum { WORDS = 1000 };

/* A state that counts its plays, and an image that shows the last play's. */
static void test_history(void **state)
{
    enum { SIDE = 16 };
    const uint32_t one = 1;
    struct sf_gpu *gpu = kit_gpu(0);
    struct sf_graph *graph = kit_graph("history");
    struct sf_plan *plan = NULL;
    struct sf_player *player;
    sf_resource count = kit_buffer(graph, "count", SF_HISTORY, WORDS * 4);
    sf_resource out = kit_buffer(graph, "count.out", SF_READBACK, WORDS * 4);
    sf_resource image = kit_image(graph, "image", SF_FORMAT_RGBA32F, SF_HISTORY, SIDE, SIDE);
    sf_resource last = kit_image(graph, "last", SF_FORMAT_RGBA32F, SF_TRANSIENT, SIDE, SIDE);
    sf_resource last_out = kit_buffer(graph, "last.out", SF_READBACK, SIDE * SIDE * 16);
    uint64_t serial = 0;

    (void)state;
    kit_add(graph, "count", count, true, count, WORDS, &one);
    kit_copy(graph, "read count", count, out);
    kit_sample(graph, "look back", image, true, SF_SAMPLER_NEAREST, last, 0);
    kit_fill_image(graph, "fill", image);
    kit_copy(graph, "read last", last, last_out);
    player = kit_player(gpu, graph, &plan);
    for (uint32_t round = 1; round <= 4; round++) {
        const uint32_t *words;
        const float *pixels;

        /* Two plays in one frame, so that the copies change places within a command buffer as well. */
        assert_int_equal(sf_frame_begin(gpu), SF_OK);
        assert_int_equal(sf_player_play(player), SF_OK);
        if (round > 2)
            assert_int_equal(sf_player_play(player), SF_OK);
        assert_int_equal(sf_frame_end(gpu, &serial), SF_OK);
        assert_int_equal(sf_frame_wait(gpu, serial), SF_OK);
        words = sf_player_readback(player, out, serial);
        for (uint32_t i = 0; i < WORDS; i++)
            assert_int_equal(words[i], round <= 2 ? round : 2 + (round - 2) * 2);
        pixels = sf_player_readback(player, last_out, serial);
        assert_float_equal(pixels[(3 * SIDE + 5) * 4], round == 1 ? 0.0f : 5.0f, 0.0f);
        assert_float_equal(pixels[(3 * SIDE + 5) * 4 + 3], round == 1 ? 0.0f : 1.0f, 0.0f);
    }
    kit_drop(&player, &plan, &graph);
    kit_finish(&gpu);
}

/* Two graphs, one buffer: the first steps a history on, twice a frame; the second reads what it finds. */
static void test_shared_history(void **state)
{
    const uint32_t one = 1, hundred = 100;
    struct sf_gpu *gpu = kit_gpu(0);
    struct sf_graph *step = kit_graph("step"), *look = kit_graph("look");
    struct sf_plan *step_plan = NULL, *look_plan = NULL;
    struct sf_player *step_player, *look_player;
    struct sf_gpu_buffer *buffer = NULL;
    const struct sf_buffer_desc desc = {.name = "state",
                                        .lifetime = SF_IMPORTED,
                                        .bytes = WORDS * 4,
                                        .outside = SF_ACCESS_STORAGE_READ,
                                        .history = true};
    struct sf_buffer_desc plain = desc;
    sf_resource stepped = sf_graph_buffer(step, &desc), looked, seen, out;
    uint32_t words[WORDS];

    (void)state;
    plain.history = false;
    looked = sf_graph_buffer(look, &plain);
    seen = kit_buffer(look, "seen", SF_TRANSIENT, WORDS * 4);
    out = kit_buffer(look, "out", SF_READBACK, WORDS * 4);
    kit_add(step, "step", stepped, true, stepped, WORDS, &one);
    kit_add(look, "look", looked, false, seen, WORDS, &hundred);
    kit_copy(look, "read", seen, out);
    step_player = kit_player(gpu, step, &step_plan);
    look_player = kit_player(gpu, look, &look_plan);
    assert_int_equal(sf_gpu_buffer_create(gpu, "state", WORDS * 4, true, SF_ACCESS_STORAGE_READ, NULL, &buffer), SF_OK);
    sf_player_bind_buffer(step_player, stepped, buffer);
    sf_player_bind_buffer(look_player, looked, buffer);
    for (uint32_t frame = 1; frame <= 5; frame++) {
        const uint32_t *got;
        uint64_t serial = 0;

        assert_int_equal(sf_frame_begin(gpu), SF_OK);
        assert_int_equal(sf_player_play(step_player), SF_OK);
        assert_int_equal(sf_player_play(step_player), SF_OK);
        if (frame == 4)
            assert_int_equal(sf_player_play(step_player), SF_OK);
        assert_int_equal(sf_player_play(look_player), SF_OK);
        assert_int_equal(sf_frame_end(gpu, &serial), SF_OK);
        assert_int_equal(sf_frame_wait(gpu, serial), SF_OK);
        got = sf_player_readback(look_player, out, serial);
        for (uint32_t i = 0; i < WORDS; i++)
            assert_int_equal(got[i], 100 + frame * 2 + (frame >= 4));
    }
    assert_int_equal(sf_gpu_buffer_read(buffer, 0, words, sizeof words), SF_OK);
    assert_int_equal(words[WORDS - 1], 11);
    kit_drop(&step_player, &step_plan, &step);
    kit_drop(&look_player, &look_plan, &look);
    sf_gpu_buffer_destroy(&buffer);
    kit_finish(&gpu);
}

static void uniform_pass(struct sf_graph *graph, sf_resource block, sf_resource result)
{
    const struct sf_use uses[] = {
        {.resource = block, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = result, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 1},
    };

    sf_graph_pass(graph, &(struct sf_pass_desc){.name = "put",
                                                .kind = SF_PASS_COMPUTE,
                                                .uses = uses,
                                                .use_count = 2,
                                                .shader = "test/uniform.comp",
                                                .groups = {1, 1, 1}});
}

/* Many plays in a frame, each with an upload of its own; a play without one is refused. */
static void test_uploads(void **state)
{
    enum { PLAYS = 40 };
    struct sf_gpu *gpu = kit_gpu(0);
    struct sf_graph *graph = kit_graph("uploads");
    struct sf_plan *plan = NULL;
    struct sf_player *player;
    sf_resource block =
        kit_buffer(graph, "block", SF_UPLOAD, 16 * 1024); /* larger than it needs: 40 do not fit one chunk */
    sf_resource result = kit_buffer(graph, "result", SF_PERSISTENT, PLAYS * 4);
    sf_resource out = kit_buffer(graph, "out", SF_READBACK, PLAYS * 4);
    uint64_t serial = 0;
    const uint32_t *got;

    (void)state;
    uniform_pass(graph, block, result);
    kit_copy(graph, "read", result, out);
    player = kit_player(gpu, graph, &plan);
    assert_null(sf_player_upload(player, block));
    for (uint32_t frame = 0; frame < 4; frame++) {
        assert_int_equal(sf_frame_begin(gpu), SF_OK);
        for (uint32_t play = 0; play < PLAYS; play++) {
            uint32_t *words = sf_player_upload(player, block);

            assert_non_null(words);
            assert_ptr_equal(words, sf_player_upload(player, block));
            words[0] = play;
            words[1] = frame * 1000 + play;
            assert_int_equal(sf_player_play(player), SF_OK);
        }
        assert_int_equal(sf_frame_end(gpu, &serial), SF_OK);
    }
    assert_int_equal(sf_frame_wait(gpu, serial), SF_OK);
    got = sf_player_readback(player, out, serial);
    for (uint32_t play = 0; play < PLAYS; play++)
        assert_int_equal(got[play], 3000 + play);
    assert_int_equal(sf_frame_begin(gpu), SF_OK);
    assert_int_equal(sf_player_play(player), SF_ERROR_USAGE);
    assert_non_null(strstr(kit_record.last, "'block'"));
    kit_forget();
    assert_int_equal(sf_frame_end(gpu, &serial), SF_OK);
    kit_drop(&player, &plan, &graph);
    kit_finish(&gpu);
}

/* Frames that nobody waits for keep as many results as were asked for, and no more. */
static void test_readback_ring(void **state)
{
    enum { DEPTH = 3, FRAMES = 7 };
    uint32_t addend = 0;
    struct sf_gpu *gpu = kit_gpu(0);
    struct sf_graph *graph = kit_graph("ring");
    struct sf_plan *plan = NULL;
    struct sf_player *player;
    sf_resource zeros = kit_buffer(graph, "zeros", SF_TRANSIENT, WORDS * 4);
    sf_resource sum = kit_buffer(graph, "sum", SF_TRANSIENT, WORDS * 4);
    sf_resource out = kit_buffer(graph, "out", SF_READBACK, WORDS * 4);
    uint64_t serials[FRAMES], other;

    (void)state;
    kit_fill(graph, "zero", zeros, 0);
    kit_add(graph, "add", zeros, false, sum, WORDS, &addend);
    kit_copy(graph, "read", sum, out);
    player = kit_player(gpu, graph, &plan);
    sf_player_set_readback_depth(player, DEPTH);
    assert_null(sf_player_readback(player, out, 1));
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        addend = 10 * frame;
        assert_int_equal(sf_frame_begin(gpu), SF_OK);
        assert_int_equal(sf_player_play(player), SF_OK);
        assert_int_equal(sf_frame_end(gpu, &serials[frame]), SF_OK);
        assert_int_equal(serials[frame], frame + frame / 2 + 1);
        /* A frame in which the player does not play uses up no result. */
        if (frame % 2) {
            assert_int_equal(sf_frame_begin(gpu), SF_OK);
            assert_int_equal(sf_frame_end(gpu, &other), SF_OK);
        }
    }
    assert_int_equal(sf_frame_wait(gpu, serials[FRAMES - 1]), SF_OK);
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        const uint32_t *got = sf_player_readback(player, out, serials[frame]);

        if (frame < FRAMES - DEPTH)
            assert_null(got);
        else
            for (uint32_t i = 0; i < WORDS; i++)
                assert_int_equal(got[i], 10 * frame);
    }
    assert_int_equal(sf_frame_wait(gpu, serials[FRAMES - 1] + 1), SF_ERROR_USAGE);
    kit_forget();
    kit_drop(&player, &plan, &graph);
    kit_finish(&gpu);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_history),
        cmocka_unit_test(test_shared_history),
        cmocka_unit_test(test_uploads),
        cmocka_unit_test(test_readback_ring),
    };
    int skip = kit_probe();

    return skip ? skip : cmocka_run_group_tests(tests, NULL, NULL);
}
