/* Shaders that take the place of the library's at run time: players go on with the new ones, whatever does not fit is
 * refused by name and changes nothing, and the library's own come back. */
#include "gpu_kit.h"
#include "gpu/fault.h"
#include "gpu/shaders.h"
#include "sfumato/sfumato.h"

enum { COUNT = 64, SIDE = 8 };

static const uint32_t ADDEND = 2;

/* sum[i] = 5 + 2 by test/add.comp, in two passes with a pipeline each. */
struct adder {
    struct sf_gpu *gpu;
    struct sf_graph *graph;
    struct sf_plan *plan;
    struct sf_player *player;
    sf_resource out[2];
};

/* `constants` tells one pipeline from the other; the shader has none. */
static void declare_add(struct adder *adder, const char *name, sf_resource from, sf_resource to, uint32_t constants)
{
    const struct sf_use uses[] = {
        {.resource = from, .access = SF_ACCESS_STORAGE_READ, .binding = 0},
        {.resource = to, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 1},
    };

    sf_graph_pass(adder->graph, &(struct sf_pass_desc){.name = name,
                                                       .kind = SF_PASS_COMPUTE,
                                                       .uses = uses,
                                                       .use_count = 2,
                                                       .shader = "test/add.comp",
                                                       .constant_count = constants,
                                                       .push = &ADDEND,
                                                       .push_bytes = sizeof ADDEND,
                                                       .groups = {1, 1, 1}});
}

static struct adder adder_make(struct sf_gpu *gpu)
{
    struct adder adder = {.gpu = gpu, .graph = kit_graph("adder")};
    sf_resource from = kit_buffer(adder.graph, "from", SF_TRANSIENT, COUNT * 4),
                first = kit_buffer(adder.graph, "first", SF_PERSISTENT, COUNT * 4),
                second = kit_buffer(adder.graph, "second", SF_PERSISTENT, COUNT * 4);

    adder.out[0] = kit_buffer(adder.graph, "out.first", SF_READBACK, COUNT * 4);
    adder.out[1] = kit_buffer(adder.graph, "out.second", SF_READBACK, COUNT * 4);
    kit_fill(adder.graph, "fill", from, 5);
    declare_add(&adder, "add.first", from, first, 0);
    declare_add(&adder, "add.second", from, second, 1);
    kit_copy(adder.graph, "read.first", first, adder.out[0]);
    kit_copy(adder.graph, "read.second", second, adder.out[1]);
    adder.player = kit_player(gpu, adder.graph, &adder.plan);
    return adder;
}

static void assert_sums(struct adder *adder, uint32_t want)
{
    uint64_t serial = kit_play(adder->gpu, adder->player);

    for (int k = 0; k < 2; k++) {
        const uint32_t *sums = sf_player_readback(adder->player, adder->out[k], serial);

        assert_non_null(sums);
        for (int i = 0; i < COUNT; i++)
            assert_int_equal(sums[i], want);
    }
}

static enum sf_status set(struct sf_gpu *gpu, const char *name, const char *other)
{
    const struct sf_shader *shader = sf_shader_find(other);

    assert_non_null(shader);
    return sf_gpu_set_shader(gpu, name, shader->words, shader->bytes);
}

/* Refused, with all of these words in the message. */
static void expect_refused(enum sf_status status, const char *const *parts)
{
    assert_int_equal(status, SF_ERROR_USAGE);
    assert_int_equal(kit_record.errors, 1);
    for (; *parts; parts++)
        if (!strstr(kit_record.last, *parts))
            fail_msg("no '%s' in: %s", *parts, kit_record.last);
    kit_forget();
}
#define EXPECT_REFUSED(status, ...) expect_refused(status, (const char *const[]){__VA_ARGS__, NULL})

static void test_swap(void **state)
{
    struct sf_gpu *gpu = kit_gpu(0);
    struct adder adder = adder_make(gpu), late;

    (void)state;
    assert_sums(&adder, 7);
    assert_int_equal(set(gpu, "test/add.comp", "test/accumulate.comp"), SF_OK);
    assert_sums(&adder, 12);
    assert_sums(&adder, 17);
    late = adder_make(gpu); /* finds the pipelines that are there */
    assert_sums(&late, 5);
    assert_int_equal(sf_gpu_set_shader(gpu, "test/add.comp", NULL, 0), SF_OK);
    assert_sums(&adder, 7);
    assert_sums(&late, 7);
    assert_int_equal(sf_gpu_set_shader(gpu, "test/add.comp", NULL, 0), SF_OK);
    assert_sums(&adder, 7);
    kit_drop(&late.player, &late.plan, &late.graph);
    kit_drop(&adder.player, &adder.plan, &adder.graph);
    kit_finish(&gpu);
}

/* Pipelines that are made only afterwards use the new words, too. */
static void test_before(void **state)
{
    struct sf_gpu *gpu = kit_gpu(0);
    struct adder adder;

    (void)state;
    assert_int_equal(set(gpu, "test/add.comp", "test/accumulate.comp"), SF_OK);
    adder = adder_make(gpu);
    assert_sums(&adder, 5);
    assert_sums(&adder, 10);
    kit_drop(&adder.player, &adder.plan, &adder.graph);
    kit_finish(&gpu);
}

/* The words are copied, and belong to the device. */
static void test_copied(void **state)
{
    struct sf_gpu *gpu = kit_gpu(0);
    struct adder adder = adder_make(gpu);
    const struct sf_shader *other = sf_shader_find("test/accumulate.comp");
    uint32_t *words = malloc(other->bytes);

    (void)state;
    assert_non_null(words);
    memcpy(words, other->words, other->bytes);
    assert_int_equal(sf_gpu_set_shader(gpu, "test/add.comp", words, other->bytes), SF_OK);
    memset(words, 0xff, other->bytes);
    free(words);
    kit_drop(&adder.player, &adder.plan, &adder.graph);
    adder = adder_make(gpu);
    assert_sums(&adder, 5);
    kit_drop(&adder.player, &adder.plan, &adder.graph);
    kit_finish(&gpu);
}

static void test_raster(void **state)
{
    struct sf_gpu *gpu = kit_gpu(0);
    struct sf_graph *graph = kit_graph("raster");
    struct sf_plan *plan = NULL;
    struct sf_player *player;
    const float push[10] = {-1, -1, 1, 1, 0.5f, 0.25f, 8, 16, 0.5f, 0};
    sf_resource target = kit_image(graph, "target", SF_FORMAT_RGBA32F, SF_TRANSIENT, SIDE, SIDE),
                out = kit_buffer(graph, "out", SF_READBACK, SIDE * SIDE * 16);
    const struct sf_use use = {.resource = target, .access = SF_ACCESS_COLOR, .load = SF_LOAD_CLEAR};
    const float *pixels;

    (void)state;
    sf_graph_pass(graph, &(struct sf_pass_desc){.name = "draw",
                                                .kind = SF_PASS_RASTER,
                                                .uses = &use,
                                                .use_count = 1,
                                                .shader = "test/quad.vert",
                                                .fragment = "test/flat.frag",
                                                .push = push,
                                                .push_bytes = sizeof push,
                                                .vertices = 4,
                                                .instances = 1,
                                                .raster = {.triangle_strip = true}});
    kit_copy(graph, "read", target, out);
    player = kit_player(gpu, graph, &plan);
    pixels = sf_player_readback(player, out, kit_play(gpu, player));
    assert_true(pixels[0] == 0.5f && pixels[3] == 16);
    /* A fragment shader that samples what the pass does not bind. */
    EXPECT_REFUSED(set(gpu, "test/flat.frag", "test/depth.frag"), "'test/flat.frag'", "binding 0", "has: none");
    EXPECT_REFUSED(set(gpu, "test/flat.frag", "test/quad.vert"), "'test/flat.frag'", "stage");
    assert_int_equal(set(gpu, "test/quad.vert", "test/triangle.vert"), SF_OK);
    pixels = sf_player_readback(player, out, kit_play(gpu, player));
    assert_true(pixels[0] == 1 && pixels[3] == 4);
    kit_drop(&player, &plan, &graph);
    kit_finish(&gpu);
}

/* Words that are no shader, cut anywhere, or of another kind. */
static void test_broken(void **state)
{
    struct sf_gpu *gpu = kit_gpu(0);
    struct adder adder = adder_make(gpu);
    const struct sf_shader *other = sf_shader_find("test/accumulate.comp");
    uint32_t *words = malloc(other->bytes);

    (void)state;
    assert_non_null(words);
    EXPECT_REFUSED(sf_gpu_set_shader(gpu, "test/none.comp", other->words, other->bytes), "test/none.comp");
    EXPECT_REFUSED(sf_gpu_set_shader(gpu, "test/add.comp", other->words, 0), "test/add.comp", "SPIR-V");
    EXPECT_REFUSED(sf_gpu_set_shader(gpu, "test/add.comp", other->words, other->bytes - 2), "SPIR-V");
    EXPECT_REFUSED(sf_gpu_set_shader(gpu, "test/add.comp", other->words, 5 * 4), "main");
    for (size_t bytes = 6 * 4; bytes < other->bytes; bytes += 4)
        EXPECT_REFUSED(sf_gpu_set_shader(gpu, "test/add.comp", other->words, bytes), "cannot be used");
    memcpy(words, other->words, other->bytes);
    words[0] ^= 1;
    EXPECT_REFUSED(sf_gpu_set_shader(gpu, "test/add.comp", words, other->bytes), "SPIR-V");
    words[0] ^= 1;
    words[3] = UINT32_MAX;
    EXPECT_REFUSED(sf_gpu_set_shader(gpu, "test/add.comp", words, other->bytes), "ids");
    words[3] = 0;
    EXPECT_REFUSED(sf_gpu_set_shader(gpu, "test/add.comp", words, other->bytes), "ids");
    EXPECT_REFUSED(set(gpu, "test/add.comp", "test/flat.frag"), "stage");
    assert_sums(&adder, 7);
    free(words);
    kit_drop(&adder.player, &adder.plan, &adder.graph);
    kit_finish(&gpu);
}

/* Shaders that want more than their passes give, before and after those are there. */
static void test_misfits(void **state)
{
    struct sf_gpu *gpu = kit_gpu(0);
    const struct sf_plan_memory memory = {.needs = sf_gpu_memory_needs, .user = gpu};
    struct adder adder = adder_make(gpu);
    struct sf_graph *graph = kit_graph("count");
    struct sf_plan *plan = NULL;
    struct sf_player *player = NULL;
    sf_resource count = kit_buffer(graph, "count", SF_PERSISTENT, 256);
    const struct sf_use use = {.resource = count, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 0};

    (void)state;
    sf_graph_pass(graph, &(struct sf_pass_desc){.name = "count",
                                                .kind = SF_PASS_COMPUTE,
                                                .uses = &use,
                                                .use_count = 1,
                                                .shader = "test/count.comp",
                                                .groups = {1, 1, 1}});
    EXPECT_REFUSED(set(gpu, "test/add.comp", "test/sample.comp"), "'test/add.comp'", "binding ", "image",
                   "has a storage buffer there");
    EXPECT_REFUSED(set(gpu, "test/add.comp", "test/fill_image.comp"), "binding 0", "a storage image");
    EXPECT_REFUSED(set(gpu, "test/add.comp", "test/uniform.comp"), "binding 0", "a uniform buffer");
    assert_sums(&adder, 7);
    /* Nobody uses it yet, so it stands until a pass wants it. */
    assert_int_equal(set(gpu, "test/count.comp", "test/accumulate.comp"), SF_OK);
    assert_int_equal(sf_plan_create(graph, &memory, &kit_log, &plan), SF_OK);
    EXPECT_REFUSED(sf_player_create(gpu, plan, &player), "'test/count.comp'", "binding 1", "'count'", "has: 0");
    assert_null(player);
    assert_int_equal(sf_gpu_set_shader(gpu, "test/count.comp", NULL, 0), SF_OK);
    assert_int_equal(sf_player_create(gpu, plan, &player), SF_OK);
    kit_play(gpu, player);
    EXPECT_REFUSED(set(gpu, "test/count.comp", "test/accumulate.comp"), "binding 1");
    kit_play(gpu, player);
    kit_drop(&player, &plan, &graph);
    kit_drop(&adder.player, &adder.plan, &adder.graph);
    kit_finish(&gpu);
}

static void test_push(void **state)
{
    struct sf_gpu *gpu = kit_gpu(0);
    struct sf_graph *graph = kit_graph("triangle");
    struct sf_plan *plan = NULL;
    struct sf_player *player;
    sf_resource target = kit_image(graph, "target", SF_FORMAT_RGBA32F, SF_TRANSIENT, SIDE, SIDE);
    const struct sf_use use = {.resource = target, .access = SF_ACCESS_COLOR, .load = SF_LOAD_CLEAR};

    (void)state;
    sf_graph_output(graph, target);
    sf_graph_pass(graph, &(struct sf_pass_desc){.name = "draw",
                                                .kind = SF_PASS_RASTER,
                                                .uses = &use,
                                                .use_count = 1,
                                                .shader = "test/triangle.vert",
                                                .fragment = "test/flat.frag",
                                                .vertices = 3,
                                                .instances = 1});
    player = kit_player(gpu, graph, &plan);
    EXPECT_REFUSED(set(gpu, "test/triangle.vert", "test/quad.vert"), "40 bytes of push constants", "gives 0");
    kit_play(gpu, player);
    kit_drop(&player, &plan, &graph);
    kit_finish(&gpu);
}

static void test_open_frame(void **state)
{
    struct sf_gpu *gpu = kit_gpu(0);
    struct adder adder = adder_make(gpu);

    (void)state;
    assert_int_equal(sf_frame_begin(gpu), SF_OK);
    assert_int_equal(sf_player_play(adder.player), SF_OK);
    EXPECT_REFUSED(set(gpu, "test/add.comp", "test/accumulate.comp"), "frame is open");
    assert_int_equal(sf_frame_end(gpu, NULL), SF_OK);
    assert_sums(&adder, 7);
    kit_drop(&adder.player, &adder.plan, &adder.graph);
    kit_finish(&gpu);
}

/* Whatever the driver refuses on the way, all pipelines stay as they were. */
static void test_faults(void **state)
{
    struct sf_gpu *gpu;
    struct adder adder;
    uint32_t calls;

    (void)state;
    sf_gpu_fail_after(SF_FAULT_OBJECT, UINT32_MAX);
    gpu = kit_gpu(0);
    adder = adder_make(gpu);
    sf_gpu_fail_after(SF_FAULT_OBJECT, UINT32_MAX);
    assert_int_equal(set(gpu, "test/add.comp", "test/accumulate.comp"), SF_OK);
    calls = sf_gpu_fault_calls();
    assert_true(calls >= 4);
    assert_int_equal(sf_gpu_set_shader(gpu, "test/add.comp", NULL, 0), SF_OK);
    for (uint32_t n = 1; n <= calls; n++) {
        sf_gpu_fail_after(SF_FAULT_OBJECT, n);
        assert_int_equal(set(gpu, "test/add.comp", "test/accumulate.comp"), SF_ERROR_MEMORY);
        sf_gpu_fail_after(SF_FAULT_NONE, 0);
        assert_true(kit_record.errors > 0);
        kit_forget();
        assert_sums(&adder, 7);
    }
    kit_drop(&adder.player, &adder.plan, &adder.graph);
    kit_finish(&gpu);
    assert_int_equal(sf_gpu_fault_alive(), 0);
}

static void draw(struct sf_renderer *renderer, uint32_t frame, uint16_t *pixels)
{
    struct sf_frame drawn;
    uint64_t ticket;

    assert_int_equal(sf_renderer_render(renderer, frame, &ticket), SF_OK);
    assert_int_equal(sf_renderer_wait(renderer, ticket, &drawn), SF_OK);
    memcpy(pixels, drawn.color, (size_t)drawn.width * drawn.height * 8);
}

/* By the public calls, in a scene with every feature: no shader of the library is refused by the passes that it was
 * written for, and the picture stays the same. */
static void test_own(void **state)
{
    enum { WIDTH = 48, HEIGHT = 40, FRAME = 6 };
    static uint16_t before[WIDTH * HEIGHT * 4], after[WIDTH * HEIGHT * 4];
    const struct sf_renderer_options options = {.width = WIDTH, .height = HEIGHT, .aovs = SF_AOV_SMOKE | SF_AOV_DEPTHS};
    const char *root = getenv("SF_SOURCE_ROOT"), *name;
    struct sf_device *device = NULL;
    struct sf_scene *scene = NULL;
    struct sf_renderer *renderer = NULL;
    char path[1024];
    uint32_t count = 0;

    (void)state;
    kit_forget();
    snprintf(path, sizeof path, "%s/scenes/tiny/all.json", root ? root : ".");
    assert_int_equal(
        sf_device_create(&(struct sf_device_options){.validate = true, .no_cache = true}, &kit_log, &device), SF_OK);
    assert_int_equal(sf_scene_load(path, NULL, 0, &kit_log, &scene), SF_OK);
    assert_int_equal(sf_renderer_create(device, scene, &options, &kit_log, &renderer), SF_OK);
    draw(renderer, FRAME, before);
    for (; (name = sf_shader_name(count)) != NULL; count++) {
        const struct sf_shader *shader = sf_shader_find(name);

        assert_ptr_equal(shader->name, name);
        if (sf_device_set_shader(device, name, shader->words, shader->bytes) != SF_OK)
            fail_msg("%s", kit_record.last);
    }
    assert_true(count > 30);
    assert_null(sf_shader_name(count + 1));
    assert_null(sf_shader_name(UINT32_MAX));
    draw(renderer, FRAME, after);
    assert_memory_equal(before, after, sizeof before);
    assert_int_equal(sf_device_validation_messages(device), 0);
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
    sf_device_destroy(&device);
    assert_int_equal(kit_record.errors, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_swap),       cmocka_unit_test(test_before), cmocka_unit_test(test_copied),
        cmocka_unit_test(test_raster),     cmocka_unit_test(test_broken), cmocka_unit_test(test_misfits),
        cmocka_unit_test(test_push),       cmocka_unit_test(test_faults), cmocka_unit_test(test_own),
        cmocka_unit_test(test_open_frame),
    };
    int skip = kit_probe();

    return skip ? skip : cmocka_run_group_tests(tests, NULL, NULL);
}
