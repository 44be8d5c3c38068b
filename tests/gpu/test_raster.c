/* Drawing: blending to the last bit, depth, orientation, and what a pass does to its attachments when it draws nothing.
 */
#include "gpu_kit.h"

enum { SIDE = 32, PIXELS = SIDE * SIDE };

/* As test/quad.vert wants it. */
struct quad {
    float rect[4], color[4], depth, step;
};

struct scene {
    struct sf_gpu *gpu;
    struct sf_graph *graph;
    struct sf_plan *plan;
    struct sf_player *player;
    sf_resource target, depth, out;
    const float *pixels; /* of the last play, RGBA */
};

static void setup(struct scene *scene, enum sf_format format)
{
    *scene = (struct scene){.gpu = kit_gpu(0), .graph = kit_graph("raster")};
    scene->target = kit_image(scene->graph, "target", format, SF_TRANSIENT, SIDE, SIDE);
    scene->depth = kit_image(scene->graph, "depth", SF_FORMAT_D32F, SF_TRANSIENT, SIDE, SIDE);
    scene->out = kit_buffer(scene->graph, "out", SF_READBACK, PIXELS * 16);
}

static void play(struct scene *scene)
{
    if (!scene->player) {
        kit_copy(scene->graph, "read", scene->target, scene->out);
        scene->player = kit_player(scene->gpu, scene->graph, &scene->plan);
    }
    scene->pixels = sf_player_readback(scene->player, scene->out, kit_play(scene->gpu, scene->player));
    assert_non_null(scene->pixels);
}

static void finish(struct scene *scene)
{
    kit_drop(&scene->player, &scene->plan, &scene->graph);
    kit_finish(&scene->gpu);
}

/* Draws `instances` of a quad into the target; `clear` NULL keeps what is there. */
static void draw(struct scene *scene, const char *name, const struct quad *quad, uint32_t instances,
                 enum sf_blend blend, const float clear[4], enum sf_depth_test test, enum sf_load depth_load)
{
    struct sf_use uses[2] = {
        {.resource = scene->target, .access = SF_ACCESS_COLOR, .load = clear ? SF_LOAD_CLEAR : SF_LOAD_KEEP},
        {.resource = scene->depth, .access = SF_ACCESS_DEPTH, .load = depth_load},
    };

    if (clear)
        memcpy(uses[0].clear, clear, sizeof uses[0].clear);
    sf_graph_pass(scene->graph,
                  &(struct sf_pass_desc){.name = name,
                                         .kind = SF_PASS_RASTER,
                                         .uses = uses,
                                         .use_count = test == SF_DEPTH_OFF ? 1 : 2,
                                         .shader = "test/quad.vert",
                                         .fragment = "test/flat.frag",
                                         .push = quad,
                                         .push_bytes = sizeof *quad,
                                         .vertices = 4,
                                         .instances = instances,
                                         .raster = {.blend = {blend}, .depth = test, .triangle_strip = true}});
}

static void assert_pixel(const struct scene *scene, uint32_t x, uint32_t y, const float want[4])
{
    const float *got = scene->pixels + (y * SIDE + x) * 4;

    if (memcmp(got, want, 4 * sizeof *got) != 0)
        fail_msg("pixel %u, %u is %a %a %a %a and should be %a %a %a %a", x, y, (double)got[0], (double)got[1],
                 (double)got[2], (double)got[3], (double)want[0], (double)want[1], (double)want[2], (double)want[3]);
}

/* Left half as `inside`, right half as `outside`. */
static void assert_halves(const struct scene *scene, const float inside[4], const float outside[4])
{
    for (uint32_t y = 0; y < SIDE; y++)
        for (uint32_t x = 0; x < SIDE; x++)
            assert_pixel(scene, x, y, x < SIDE / 2 ? inside : outside);
}

/* Values with full mantissas, so that a detour by way of half floats or 8 bits would show. */
static const float A[4] = {0.1234567f, 7654.321f, -1.0e-7f, 0.7654321f},
                   B[4] = {0.7654321f, -3.3333333e6f, 2.2222222f, 0.1111111f};

static void test_min_add(void **state)
{
    struct scene scene;
    const struct quad quad = {.rect = {-1, -1, 0, 1}, .color = {A[0], A[1], A[2], A[3]}};
    float want[4];

    (void)state;
    setup(&scene, SF_FORMAT_RGBA32F);
    draw(&scene, "draw", &quad, 3, SF_BLEND_MIN_ADD, B, SF_DEPTH_OFF, SF_LOAD_KEEP);
    play(&scene);
    for (int c = 0; c < 3; c++) {
        want[c] = B[c];
        for (int i = 1; i <= 3; i++)
            if (A[c] * (float)i < want[c])
                want[c] = A[c] * (float)i;
    }
    want[3] = ((B[3] + A[3]) + A[3] * 2.0f) + A[3] * 3.0f;
    assert_halves(&scene, want, B);
    finish(&scene);
}

static void test_blends(void **state)
{
    static const struct {
        enum sf_blend blend;
        float source[4], target[4], want[4]; /* all steps are exact */
    } cases[] = {
        {SF_BLEND_NONE, {0.5f, 2, -1, 0.25f}, {4, 8, 16, 0.5f}, {0.5f, 2, -1, 0.25f}},
        {SF_BLEND_PREMULTIPLIED, {0.5f, 2, -1, 0.25f}, {4, 8, 16, 0.5f}, {3.5f, 8, 11, 0.625f}},
        {SF_BLEND_ADD, {0.5f, 2, -1, 0.25f}, {4, 8, 16, 0.5f}, {4.5f, 10, 15, 0.75f}},
        {SF_BLEND_MULTIPLY, {0.5f, 2, -1, 0.25f}, {4, 8, 16, 0.5f}, {2, 16, -16, 0.125f}},
        {SF_BLEND_MIN_ADD, {0.5f, 2, -1, 0.25f}, {4, 8, 16, 0.5f}, {0.5f, 2, -1, 0.75f}},
    };

    (void)state;
    for (size_t i = 0; i < SF_COUNT(cases); i++) {
        struct scene scene;
        struct quad quad = {.rect = {-1, -1, 0, 1}};

        memcpy(quad.color, cases[i].source, sizeof quad.color);
        setup(&scene, SF_FORMAT_RGBA32F);
        draw(&scene, "draw", &quad, 1, cases[i].blend, cases[i].target, SF_DEPTH_OFF, SF_LOAD_KEEP);
        play(&scene);
        assert_halves(&scene, cases[i].want, cases[i].target);
        finish(&scene);
    }
}

/* Two attachments in one pass, blended in two ways: two triangles, since every one of their pixels writes both. */
static void test_two_targets(void **state)
{
    struct scene scene;
    const struct quad quad = {.rect = {-1, -1, 0, 1}, .color = {1, 2, 3, 4}};
    const float one[4] = {1, 1, 1, 1}, added[4] = {2, 3, 4, 5}, replaced[4] = {1, 2, 3, 4};
    sf_resource second, second_out;
    struct sf_use uses[2];
    uint64_t serial;

    (void)state;
    setup(&scene, SF_FORMAT_RGBA32F);
    second = kit_image(scene.graph, "second", SF_FORMAT_RGBA32F, SF_TRANSIENT, SIDE, SIDE);
    second_out = kit_buffer(scene.graph, "second.out", SF_READBACK, PIXELS * 16);
    uses[0] = (struct sf_use){
        .resource = second, .access = SF_ACCESS_COLOR, .binding = 1, .load = SF_LOAD_CLEAR, .clear = {1, 1, 1, 1}};
    uses[1] = (struct sf_use){.resource = scene.target,
                              .access = SF_ACCESS_COLOR,
                              .binding = 0,
                              .load = SF_LOAD_CLEAR,
                              .clear = {1, 1, 1, 1}};
    sf_graph_pass(scene.graph,
                  &(struct sf_pass_desc){.name = "draw",
                                         .kind = SF_PASS_RASTER,
                                         .uses = uses,
                                         .use_count = 2,
                                         .shader = "test/quad.vert",
                                         .fragment = "test/two.frag",
                                         .push = &quad,
                                         .push_bytes = sizeof quad,
                                         .vertices = 4,
                                         .instances = 1,
                                         .raster = {.blend = {SF_BLEND_ADD, SF_BLEND_NONE}, .triangle_strip = true}});
    kit_copy(scene.graph, "read", scene.target, scene.out);
    kit_copy(scene.graph, "read second", second, second_out);
    scene.player = kit_player(scene.gpu, scene.graph, &scene.plan);
    serial = kit_play(scene.gpu, scene.player);
    scene.pixels = sf_player_readback(scene.player, scene.out, serial);
    assert_halves(&scene, added, one);
    scene.pixels = sf_player_readback(scene.player, second_out, serial);
    assert_halves(&scene, replaced, one);
    finish(&scene);
}

/* Reversed: the larger depth is the nearer. Cleared to 0, the far end. */
static void test_depth(void **state)
{
    struct scene scene;
    const float zero[4] = {0}, quarter[4] = {0.25f};
    const struct quad near = {.rect = {-1, -1, 0, 1}, .color = {1, 1, 1, 1}, .depth = 0.5f};
    const struct quad far = {.rect = {-1, -1, 1, 1}, .color = {2, 2, 2, 2}, .depth = 0.25f};
    const float ones[4] = {1, 1, 1, 1}, twos[4] = {2, 2, 2, 2};
    sf_resource sampled, sampled_out;
    uint64_t serial;
    struct sf_use uses[3];
    static const float black[4];

    (void)state;
    setup(&scene, SF_FORMAT_RGBA32F);
    draw(&scene, "near", &near, 1, SF_BLEND_NONE, zero, SF_DEPTH_GREATER_EQUAL, SF_LOAD_CLEAR);
    draw(&scene, "far", &far, 1, SF_BLEND_NONE, NULL, SF_DEPTH_GREATER_EQUAL, SF_LOAD_KEEP);
    /* Tested against and looked at in one pass. */
    sampled = kit_image(scene.graph, "sampled", SF_FORMAT_RGBA32F, SF_TRANSIENT, SIDE, SIDE);
    sampled_out = kit_buffer(scene.graph, "sampled.out", SF_READBACK, PIXELS * 16);
    uses[0] = (struct sf_use){.resource = sampled, .access = SF_ACCESS_COLOR, .load = SF_LOAD_CLEAR};
    uses[1] = (struct sf_use){.resource = scene.depth, .access = SF_ACCESS_DEPTH_READ};
    uses[2] = (struct sf_use){.resource = scene.depth, .access = SF_ACCESS_SAMPLED, .binding = 0};
    sf_graph_pass(scene.graph, &(struct sf_pass_desc){.name = "look",
                                                      .kind = SF_PASS_RASTER,
                                                      .uses = uses,
                                                      .use_count = 3,
                                                      .shader = "test/quad.vert",
                                                      .fragment = "test/depth.frag",
                                                      .push = &far,
                                                      .push_bytes = sizeof far,
                                                      .vertices = 4,
                                                      .instances = 1,
                                                      .raster = {.depth = SF_DEPTH_EQUAL, .triangle_strip = true}});
    /* And once more, with no barrier on the depth between the two: testing alone writes nothing. */
    uses[0].load = SF_LOAD_KEEP;
    sf_graph_pass(scene.graph, &(struct sf_pass_desc){.name = "look again",
                                                      .kind = SF_PASS_RASTER,
                                                      .uses = uses,
                                                      .use_count = 3,
                                                      .shader = "test/quad.vert",
                                                      .fragment = "test/depth.frag",
                                                      .push = &far,
                                                      .push_bytes = sizeof far,
                                                      .vertices = 4,
                                                      .instances = 1,
                                                      .raster = {.depth = SF_DEPTH_EQUAL, .triangle_strip = true}});
    kit_copy(scene.graph, "read", scene.target, scene.out);
    kit_copy(scene.graph, "read sampled", sampled, sampled_out);
    scene.player = kit_player(scene.gpu, scene.graph, &scene.plan);
    for (int round = 0; round < 2; round++) {
        serial = kit_play(scene.gpu, scene.player);
        scene.pixels = sf_player_readback(scene.player, scene.out, serial);
        assert_halves(&scene, ones, twos);
        scene.pixels = sf_player_readback(scene.player, sampled_out, serial);
        assert_halves(&scene, black, quarter); /* EQUAL to 0.25 is true on the right only, where depth reads 0.25 */
    }
    finish(&scene);
}

/* A front face is counter-clockwise as seen; row 0 is on top, where clip space has y = -1. */
static void test_orientation(void **state)
{
    static const float drawn[4] = {1, 2, 3, 4}, empty[4] = {0};
    static const struct {
        enum sf_cull cull;
        const float *want;
    } cases[] = {{SF_CULL_NONE, drawn}, {SF_CULL_BACK, drawn}, {SF_CULL_FRONT, empty}};
    struct scene scene;
    const struct quad corner = {.rect = {-1, -1, 0, 0}, .color = {1, 2, 3, 4}};

    (void)state;
    for (size_t i = 0; i < SF_COUNT(cases); i++) {
        setup(&scene, SF_FORMAT_RGBA32F);
        sf_graph_pass(scene.graph, &(struct sf_pass_desc){.name = "draw",
                                                          .kind = SF_PASS_RASTER,
                                                          .uses = &(struct sf_use){.resource = scene.target,
                                                                                   .access = SF_ACCESS_COLOR,
                                                                                   .load = SF_LOAD_CLEAR},
                                                          .use_count = 1,
                                                          .shader = "test/triangle.vert",
                                                          .fragment = "test/flat.frag",
                                                          .vertices = 3,
                                                          .instances = 1,
                                                          .raster = {.cull = cases[i].cull}});
        play(&scene);
        assert_halves(&scene, cases[i].want, cases[i].want);
        finish(&scene);
    }
    setup(&scene, SF_FORMAT_RGBA32F);
    draw(&scene, "draw", &corner, 1, SF_BLEND_NONE, empty, SF_DEPTH_OFF, SF_LOAD_KEEP);
    play(&scene);
    assert_pixel(&scene, 0, 0, drawn);
    assert_pixel(&scene, SIDE / 2 - 1, SIDE / 2 - 1, drawn);
    assert_pixel(&scene, SIDE / 2, 0, empty);
    assert_pixel(&scene, 0, SIDE / 2, empty);
    finish(&scene);
}

/* Counts of vertices and instances from the CPU at each play, and from the device. Nothing to draw still clears. */
static void test_counts(void **state)
{
    uint32_t live[2] = {4, 0}, arguments[4] = {4, 3, 0, 0};
    const struct quad quad = {.rect = {-1, -1, 0, 1}, .color = {1, 1, 1, 1}};
    struct scene scene;
    struct sf_gpu_buffer *buffer = NULL;
    struct sf_pass_desc pass = {.kind = SF_PASS_RASTER,
                                .use_count = 1,
                                .shader = "test/quad.vert",
                                .fragment = "test/flat.frag",
                                .push = &quad,
                                .push_bytes = sizeof quad,
                                .raster = {.blend = {SF_BLEND_ADD}, .triangle_strip = true}};
    struct sf_use use;
    sf_resource indirect;

    (void)state;
    setup(&scene, SF_FORMAT_RGBA32F);
    use = (struct sf_use){
        .resource = scene.target, .access = SF_ACCESS_COLOR, .load = SF_LOAD_CLEAR, .clear = {10, 10, 10, 10}};
    indirect = sf_graph_buffer(scene.graph, &(struct sf_buffer_desc){.name = "arguments",
                                                                     .lifetime = SF_IMPORTED,
                                                                     .bytes = sizeof arguments,
                                                                     .outside = SF_ACCESS_STORAGE_READ});
    pass.uses = &use;
    pass.name = "live";
    pass.draw_live = live;
    sf_graph_pass(scene.graph, &pass);
    use.load = SF_LOAD_KEEP;
    pass.name = "indirect";
    pass.draw_live = NULL;
    pass.indirect = indirect;
    sf_graph_pass(scene.graph, &pass);
    assert_int_equal(sf_gpu_buffer_create(scene.gpu, "arguments", sizeof arguments, false, SF_ACCESS_STORAGE_READ,
                                          arguments, &buffer),
                     SF_OK);
    kit_copy(scene.graph, "read", scene.target, scene.out);
    scene.player = kit_player(scene.gpu, scene.graph, &scene.plan);
    sf_player_bind_buffer(scene.player, indirect, buffer);
    for (uint32_t instances = 0; instances < 3; instances++) {
        static const float sums[3] = {0, 1, 3}, outside[4] = {10, 10, 10, 10};
        float value = 10 + sums[instances] + 6, inside[4] = {value, value, value, value};

        live[1] = instances;
        play(&scene);
        assert_halves(&scene, inside, outside);
    }
    kit_drop(&scene.player, &scene.plan, &scene.graph);
    sf_gpu_buffer_destroy(&buffer);
    kit_finish(&scene.gpu);
}

/* What is kept from play to play begins with zeros and grows by each. */
static void test_persistent(void **state)
{
    struct scene scene;
    const struct quad quad = {.rect = {-1, -1, 0, 1}, .color = {1, 2, 3, 4}, .depth = 0.5f};
    static const float zero[4];

    (void)state;
    setup(&scene, SF_FORMAT_RGBA32F);
    scene.target = kit_image(scene.graph, "kept", SF_FORMAT_RGBA32F, SF_PERSISTENT, SIDE, SIDE);
    scene.depth = kit_image(scene.graph, "kept depth", SF_FORMAT_D32F, SF_PERSISTENT, SIDE, SIDE);
    draw(&scene, "draw", &quad, 1, SF_BLEND_ADD, NULL, SF_DEPTH_GREATER_EQUAL, SF_LOAD_KEEP);
    for (int round = 1; round <= 3; round++) {
        float n = (float)round, want[4] = {n, 2 * n, 3 * n, 4 * n};

        play(&scene);
        assert_halves(&scene, want, zero);
    }
    finish(&scene);
}

/* Every format that can be drawn to takes a colour and gives it back as well as it can hold it. */
static void test_formats(void **state)
{
    static const struct {
        enum sf_format format;
        int channels;
        float tolerance;
    } cases[] = {
        {SF_FORMAT_R8_UNORM, 1, 0.002f},
        {SF_FORMAT_RGBA8_UNORM, 4, 0.002f},
        {SF_FORMAT_RGBA8_SRGB, 4, 0.004f},
        {SF_FORMAT_R16F, 1, 0.0005f},
        {SF_FORMAT_RG16F, 2, 0.0005f},
        {SF_FORMAT_RGBA16F, 4, 0.0005f},
        {SF_FORMAT_R32F, 1, 0},
        {SF_FORMAT_RG32F, 2, 0},
        {SF_FORMAT_RGBA32F, 4, 0},
    };
    const struct quad quad = {.rect = {-1, -1, 1, 1}, .color = {0.123f, 0.456f, 0.789f, 0.9f}};
    const float zero[4] = {0};

    (void)state;
    for (size_t i = 0; i < SF_COUNT(cases); i++) {
        struct scene scene;
        sf_resource copy;

        setup(&scene, cases[i].format);
        draw(&scene, "draw", &quad, 1, SF_BLEND_NONE, zero, SF_DEPTH_OFF, SF_LOAD_KEEP);
        copy = kit_image(scene.graph, "copy", SF_FORMAT_RGBA32F, SF_TRANSIENT, SIDE, SIDE);
        kit_sample(scene.graph, "sample", scene.target, false, SF_SAMPLER_NEAREST, copy, 0);
        scene.target = copy;
        play(&scene);
        for (int c = 0; c < cases[i].channels; c++)
            assert_float_equal(scene.pixels[77 * 4 + c], quad.color[c], cases[i].tolerance);
        finish(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_min_add),    cmocka_unit_test(test_blends),      cmocka_unit_test(test_two_targets),
        cmocka_unit_test(test_depth),      cmocka_unit_test(test_orientation), cmocka_unit_test(test_counts),
        cmocka_unit_test(test_persistent), cmocka_unit_test(test_formats),
    };
    int skip = kit_probe();

    return skip ? skip : cmocka_run_group_tests(tests, NULL, NULL);
}
