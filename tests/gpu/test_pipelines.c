/* How long the device keeps pipelines: those of living players always, of the others the ones that were used last. */
#include "gpu_kit.h"
#include "gpu/fault.h"
#include "gpu/vk.h"

enum {
    COUNT = 64,
    GROUP = 16,
    VALUES = 300,   /* of a constant, a pipeline each */
    KEPT_VALUE = 1, /* those start behind it */
    FIRST_VALUE = 2,
    OBJECTS = 3, /* of a pipeline: itself, its layout, its set layout */
};

/* Two passes by one pipeline, or by two when their values differ: result[i] = i * value + GROUP * 1000. */
struct scaler {
    struct sf_gpu *gpu;
    struct sf_graph *graph;
    struct sf_plan *plan;
    struct sf_player *player;
    uint32_t values[2];
    sf_resource out[2];
};

static void declare_scale(struct sf_graph *graph, const char *name, sf_resource result, uint32_t value)
{
    const struct sf_use use = {.resource = result, .access = SF_ACCESS_STORAGE_WRITE, .binding = 3};

    sf_graph_pass(graph, &(struct sf_pass_desc){.name = name,
                                                .kind = SF_PASS_COMPUTE,
                                                .uses = &use,
                                                .use_count = 1,
                                                .shader = "test/constants.comp",
                                                .constants = {GROUP, value},
                                                .constant_count = 3,
                                                .groups = {COUNT / GROUP, 1, 1}});
}

static struct scaler scaler_plan(struct sf_gpu *gpu, uint32_t first, uint32_t second)
{
    const struct sf_plan_memory memory = {.needs = sf_gpu_memory_needs, .user = gpu};
    struct scaler scaler = {.gpu = gpu, .graph = kit_graph("scaler"), .values = {first, second}};
    sf_resource results[2] = {kit_buffer(scaler.graph, "first", SF_TRANSIENT, COUNT * 4),
                              kit_buffer(scaler.graph, "second", SF_TRANSIENT, COUNT * 4)};

    scaler.out[0] = kit_buffer(scaler.graph, "out.first", SF_READBACK, COUNT * 4);
    scaler.out[1] = kit_buffer(scaler.graph, "out.second", SF_READBACK, COUNT * 4);
    declare_scale(scaler.graph, "scale.first", results[0], first);
    declare_scale(scaler.graph, "scale.second", results[1], second);
    kit_copy(scaler.graph, "read.first", results[0], scaler.out[0]);
    kit_copy(scaler.graph, "read.second", results[1], scaler.out[1]);
    assert_int_equal(sf_plan_create(scaler.graph, &memory, &kit_log, &scaler.plan), SF_OK);
    return scaler;
}

static struct scaler scaler_make(struct sf_gpu *gpu, uint32_t value)
{
    struct scaler scaler = scaler_plan(gpu, value, value);

    assert_int_equal(sf_player_create(gpu, scaler.plan, &scaler.player), SF_OK);
    return scaler;
}

static void scaler_drop(struct scaler *scaler)
{
    kit_drop(&scaler->player, &scaler->plan, &scaler->graph);
}

static void assert_scales(struct scaler *scaler)
{
    uint64_t serial = kit_play(scaler->gpu, scaler->player);

    for (int k = 0; k < 2; k++) {
        const float *got = sf_player_readback(scaler->player, scaler->out[k], serial);

        assert_non_null(got);
        for (uint32_t i = 0; i < COUNT; i++)
            assert_float_equal(got[i], (float)(i * scaler->values[k]) + GROUP * 1000.0f, 0.0f);
    }
}

/* Makes and destroys a player of that value; was its pipeline still there? */
static bool found(struct sf_gpu *gpu, uint32_t value, bool play)
{
    size_t before = gpu->pipelines_made;
    struct scaler scaler = scaler_make(gpu, value);
    bool there = gpu->pipelines_made == before;

    assert_int_equal(gpu->pipelines_made, there ? before : before + 1);
    if (play)
        assert_scales(&scaler);
    scaler_drop(&scaler);
    return there;
}

static void leave_values(struct sf_gpu *gpu, uint32_t first, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        assert_false(found(gpu, first + i, i % 16 == 0));
}

/* As somebody who drags a parameter that is compiled in. */
static void test_bound(void **state)
{
    enum { LAST = FIRST_VALUE + VALUES - 1, OLDEST = LAST + 1 - SF_PIPELINES_UNUSED_MAX };
    struct sf_gpu *gpu;
    struct scaler kept, twin;
    int64_t alive;

    (void)state;
    sf_gpu_fail_after(SF_FAULT_OBJECT, UINT32_MAX); /* to count objects */
    gpu = kit_gpu(0);
    kept = scaler_make(gpu, KEPT_VALUE);
    assert_true(found(gpu, KEPT_VALUE, true)); /* another player with the same pipeline, which goes */
    for (int i = 0; i < SF_FRAMES_IN_FLIGHT; i++)
        assert_scales(&kept); /* now each slot has its pools */
    alive = sf_gpu_fault_alive();
    assert_int_equal(gpu->pipelines_made, 1);
    for (uint32_t i = 0; i < VALUES; i++) {
        size_t want = 1 + (i + 1 < SF_PIPELINES_UNUSED_MAX ? i + 1 : SF_PIPELINES_UNUSED_MAX);

        leave_values(gpu, FIRST_VALUE + i, 1);
        assert_int_equal(gpu->pipelines_made, want);
        assert_int_equal(gpu->pipeline_count, want);
        assert_int_equal(sf_gpu_fault_alive() - alive, (int64_t)(want - 1) * OBJECTS);
        if (i % 50 == 0)
            assert_scales(&kept);
    }
    /* All that were used last are there, and these become the youngest one after the other: the first is the next to
     * go, though it was made last. */
    for (uint32_t value = LAST; value >= OLDEST; value--)
        assert_true(found(gpu, value, false));
    assert_false(found(gpu, OLDEST - 1, true));
    assert_true(found(gpu, LAST - 1, true));
    assert_false(found(gpu, LAST, true));
    assert_int_equal(gpu->pipelines_made, 1 + SF_PIPELINES_UNUSED_MAX);
    /* What is in use does not count. */
    twin = scaler_make(gpu, OLDEST);
    assert_false(found(gpu, LAST + 1, true));
    assert_int_equal(gpu->pipelines_made, 2 + SF_PIPELINES_UNUSED_MAX);
    assert_scales(&kept);
    assert_scales(&twin);
    scaler_drop(&twin);
    assert_int_equal(gpu->pipelines_made, 1 + SF_PIPELINES_UNUSED_MAX);
    assert_scales(&kept);
    scaler_drop(&kept);
    kit_finish(&gpu);
    assert_int_equal(sf_gpu_fault_alive(), 0);
    sf_gpu_fail_after(SF_FAULT_NONE, 0);
}

/* A player that cannot be made takes nothing, whatever fails: neither the pipeline that another one uses or has used,
 * nor the one that would be new. */
static void fail_to_make(uint32_t old)
{
    enum { UNUSED = FIRST_VALUE, NEW, OTHERS };
    enum sf_status status = SF_ERROR_MEMORY;
    struct scaler kept, wanted;
    struct sf_gpu *gpu;
    uint32_t calls = 0;

    sf_gpu_fail_after(SF_FAULT_OBJECT, UINT32_MAX);
    gpu = kit_gpu(0);
    kept = scaler_make(gpu, KEPT_VALUE);
    leave_values(gpu, UNUSED, 1);
    wanted = scaler_plan(gpu, old, NEW);
    while (status) {
        sf_gpu_fail_after(SF_FAULT_OBJECT, ++calls);
        status = sf_player_create(gpu, wanted.plan, &wanted.player);
        sf_gpu_fail_after(SF_FAULT_NONE, 0);
        assert_int_equal(gpu->pipelines_made, status ? 2 : 3);
        assert_int_equal(gpu->pipeline_count, gpu->pipelines_made);
        assert_scales(&kept);
    }
    assert_true(calls > OBJECTS);
    kit_forget();
    assert_scales(&wanted);
    scaler_drop(&wanted);
    leave_values(gpu, OTHERS, SF_PIPELINES_UNUSED_MAX);
    assert_int_equal(gpu->pipelines_made, SF_PIPELINES_UNUSED_MAX + 1);
    assert_scales(&kept);
    scaler_drop(&kept);
    assert_int_equal(gpu->pipelines_made, SF_PIPELINES_UNUSED_MAX);
    assert_true(found(gpu, KEPT_VALUE, true));
    kit_finish(&gpu);
    assert_int_equal(sf_gpu_fault_alive(), 0);
}

static void test_failures(void **state)
{
    (void)state;
    fail_to_make(KEPT_VALUE);
    fail_to_make(FIRST_VALUE);
}

/* A player may go while its commands wait in an open frame, if all that they touch stays: so does its pipeline. */
static void test_open_frame(void **state)
{
    enum { PLAYERS = SF_PIPELINES_UNUSED_MAX + 10 };
    struct sf_gpu *gpu = kit_gpu(0);
    struct sf_gpu_buffer *buffer = NULL;
    struct sf_graph *graphs[PLAYERS];
    struct sf_plan *plans[PLAYERS];
    struct sf_player *players[PLAYERS];
    float got[COUNT];

    (void)state;
    assert_int_equal(sf_gpu_buffer_create(gpu, "result", sizeof got, false, SF_ACCESS_STORAGE_READ, NULL, &buffer),
                     SF_OK);
    for (uint32_t i = 0; i < PLAYERS; i++) {
        sf_resource result;

        graphs[i] = kit_graph("imported");
        result = sf_graph_buffer(graphs[i], &(struct sf_buffer_desc){.name = "result",
                                                                     .lifetime = SF_IMPORTED,
                                                                     .bytes = sizeof got,
                                                                     .outside = SF_ACCESS_STORAGE_READ});
        declare_scale(graphs[i], "scale", result, FIRST_VALUE + i);
        players[i] = kit_player(gpu, graphs[i], &plans[i]);
        sf_player_bind_buffer(players[i], result, buffer);
    }
    assert_int_equal(gpu->pipelines_made, PLAYERS);
    assert_int_equal(sf_frame_begin(gpu), SF_OK);
    assert_int_equal(sf_player_play(players[0]), SF_OK);
    for (uint32_t i = 0; i < PLAYERS - 1; i++)
        kit_drop(&players[i], &plans[i], &graphs[i]);
    assert_int_equal(gpu->pipelines_made, PLAYERS);
    assert_int_equal(sf_frame_end(gpu, NULL), SF_OK);
    kit_drop(&players[PLAYERS - 1], &plans[PLAYERS - 1], &graphs[PLAYERS - 1]); /* waits for the frame */
    assert_int_equal(gpu->pipelines_made, SF_PIPELINES_UNUSED_MAX);
    assert_int_equal(sf_gpu_buffer_read(buffer, 0, got, sizeof got), SF_OK);
    for (uint32_t i = 0; i < COUNT; i++)
        assert_float_equal(got[i], (float)(i * FIRST_VALUE) + GROUP * 1000.0f, 0.0f);
    sf_gpu_buffer_destroy(&buffer);
    kit_finish(&gpu);
}

/* A shader that is set anew is compiled for who uses it, checked for who did, and the unused pipelines go. */
static void test_shader(void **state)
{
    enum { UNUSED = 20, CALLS = 2 /* a module and a pipeline */ };
    const char *name = "test/constants.comp";
    const struct sf_shader *own = sf_shader_find(name), *misfit = sf_shader_find("test/accumulate.comp");
    struct sf_gpu *gpu;
    struct scaler kept;

    (void)state;
    sf_gpu_fail_after(SF_FAULT_OBJECT, UINT32_MAX);
    gpu = kit_gpu(0);
    leave_values(gpu, FIRST_VALUE, UNUSED);
    assert_int_equal(sf_gpu_set_shader(gpu, name, misfit->words, misfit->bytes), SF_ERROR_USAGE);
    assert_non_null(strstr(kit_record.last, "binding 1"));
    kit_forget();
    assert_int_equal(gpu->pipelines_made, UNUSED);
    /* Among the unused ones, so that its place changes. */
    kept = scaler_make(gpu, KEPT_VALUE);
    leave_values(gpu, FIRST_VALUE + UNUSED, UNUSED);
    sf_gpu_fail_after(SF_FAULT_OBJECT, CALLS);
    assert_int_equal(sf_gpu_set_shader(gpu, name, own->words, own->bytes), SF_ERROR_MEMORY);
    sf_gpu_fail_after(SF_FAULT_NONE, 0);
    kit_forget();
    assert_int_equal(gpu->pipelines_made, 2 * UNUSED + 1);
    assert_scales(&kept);
    sf_gpu_fail_after(SF_FAULT_OBJECT, CALLS + 1);
    assert_int_equal(sf_gpu_set_shader(gpu, name, own->words, own->bytes), SF_OK);
    sf_gpu_fail_after(SF_FAULT_NONE, 0);
    assert_int_equal(gpu->pipelines_made, 1);
    assert_int_equal(gpu->pipeline_count, 1);
    assert_scales(&kept);
    assert_true(found(gpu, KEPT_VALUE, true));
    leave_values(gpu, FIRST_VALUE, UNUSED);
    assert_int_equal(sf_gpu_set_shader(gpu, name, NULL, 0), SF_OK);
    assert_int_equal(gpu->pipelines_made, 1);
    assert_scales(&kept);
    scaler_drop(&kept);
    kit_finish(&gpu);
    assert_int_equal(sf_gpu_fault_alive(), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bound),
        cmocka_unit_test(test_failures),
        cmocka_unit_test(test_open_frame),
        cmocka_unit_test(test_shader),
    };
    int skip = kit_probe();

    return skip ? skip : cmocka_run_group_tests(tests, NULL, NULL);
}
