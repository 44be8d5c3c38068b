/* The picture in a window: its colours against the CPU's, texels to the pixel; what is refused, and when a graph is made
 * anew. */
#include "window_kit.h"
#include <math.h>
#include "base/array.h"
#include "base/hash.h"
#include "output/half.h"

enum { SIDE = 64, PAD = 7 };

/* ---- the picture ---- */

/* Light from 0 to 1000, evenly spread over its logarithm, of all hues; and the values that are special. */
static void make_light(float *rgba)
{
    static const float special[][4] = {
        {0, 0, 0, 0},          {0.0031308f, 0.0031309f, 0.003f, 1}, {1, 1, 1, 1},    {1000, 1000, 1000, 1},
        {-1, 0.5f, -1e-3f, 1}, {0.75f, 0.76f, 0.77f, 0.5f},         {1000, 0, 0, 1}, {0, 1e-6f, 1000, 0.25f},
        {60000, 1, 60000, 1},  {0.08f, 0.08f, 0.0801f, 0},
    };

    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        float value = powf(10.0f, -5.0f + 8.0f * (float)i / (SIDE * SIDE - 1));

        for (uint32_t c = 0; c < 3; c++)
            rgba[4 * i + c] = value * (i % 3 == 0 ? 1.0f : sf_random_float(7, i, c));
        rgba[4 * i + 3] = sf_random_float(7, i, 3); /* nothing to do with what is shown */
    }
    memcpy(rgba, special, sizeof special);
}

/* Every code is the PNG writer's or its neighbour, and nearly all are the same. */
static void check_tone(struct stage *stage, const float *light, const char *name, float exposure)
{
    static uint8_t want[SIDE * SIDE * 3];
    struct sf_tone tone = {.exposure = exposure};
    uint32_t off = 0;

    assert_int_equal(sf_tone_parse(name, &tone.mode, &kit_log), SF_OK);
    sf_tone_encode8(&tone, light, SIDE * SIDE, 3, want);
    stage->frame.tone = name;
    stage->frame.exposure = exposure;
    play(stage);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            bool inside = within(x, y, PAD, PAD - 2, SIDE, SIDE);
            const uint8_t *code = inside ? want + ((y - PAD + 2) * SIDE + x - PAD) * 3 : BACKGROUND;

            assert_pixel(stage, x, y, code, inside ? 1 : 0);
            off += memcmp(stage->pixels + (y * WIDTH + x) * 4, code, 3) != 0;
        }
    if (off > SIDE * SIDE / 50)
        fail_msg("%s at %g stops: %u pixels of %d are off by one", name, (double)exposure, off, SIDE * SIDE);
}

static void test_tone(void **state)
{
    static const char *const names[] = {"linear", "reinhard", "aces", "neutral"};
    static const float exposures[] = {-10, -2, 0, 1.5f, 6};
    static float light[SIDE * SIDE * 4];
    static uint16_t halves[SIDE * SIDE * 4];
    struct stage stage;

    (void)state;
    setup(&stage);
    stage.frame.x = PAD;
    stage.frame.y = PAD - 2;
    stage.frame.width = stage.frame.height = SIDE;
    make_light(light);
    set_picture(&stage, light, true, SIDE, SIDE);
    for (size_t i = 0; i < SF_COUNT(names); i++)
        for (size_t j = 0; j < SF_COUNT(exposures); j++)
            check_tone(&stage, light, names[i], exposures[j]);
    for (size_t i = 0; i < SF_COUNT(halves); i++) {
        halves[i] = sf_half_from_float(light[i]);
        light[i] = sf_half_to_float(halves[i]);
    }
    set_picture(&stage, halves, false, SIDE, SIDE);
    for (size_t i = 0; i < SF_COUNT(names); i++)
        check_tone(&stage, light, names[i], 0.5f);
    finish(&stage);
}

/* What is no light at all: as on the CPU, NaN is 0 and infinity is as bright as can be. */
static void test_senseless_light(void **state)
{
    const float light[4][4] = {
        {NAN, 0.5f, 1, 1}, {INFINITY, 0, 0, 1}, {0.5f, -INFINITY, NAN, 1}, {3e38f, 3e38f, 3e38f, 1}};
    static const char *const names[] = {"linear", "reinhard", "aces", "neutral"};
    struct stage stage;

    (void)state;
    setup(&stage);
    stage.frame.width = 4;
    stage.frame.height = 1;
    set_picture(&stage, light, true, 4, 1);
    for (size_t i = 0; i < SF_COUNT(names); i++) {
        struct sf_tone tone = {.exposure = 1};
        uint8_t want[4][3];

        assert_int_equal(sf_tone_parse(names[i], &tone.mode, &kit_log), SF_OK);
        sf_tone_encode8(&tone, light[0], 4, 3, want[0]);
        stage.frame.tone = names[i];
        stage.frame.exposure = tone.exposure;
        play(&stage);
        for (int x = 0; x < 4; x++)
            assert_pixel(&stage, x, 0, want[x], 1);
    }
    finish(&stage);
}

static float texel(const float *rgba, int side, int x, int y, int c)
{
    x = x < 0 ? 0 : x >= side ? side - 1 : x;
    y = y < 0 ? 0 : y >= side ? side - 1 : y;
    return rgba[(y * side + x) * 4 + c];
}

/* Bilinear in light, edges repeated. Light is bright enough for an 8-bit filter weight not to show. */
static void test_scaled(void **state)
{
    enum { SMALL = 8, LEFT = -5, TOP = 9, WIDE = 70, HIGH = 44 };
    float light[SMALL * SMALL * 4];
    struct stage stage;

    (void)state;
    setup(&stage);
    for (uint32_t i = 0; i < SF_COUNT(light); i++)
        light[i] = 0.2f + 0.7f * sf_random_float(3, i, 0);
    set_picture(&stage, light, true, SMALL, SMALL);
    stage.frame.x = LEFT;
    stage.frame.y = TOP;
    stage.frame.width = WIDE;
    stage.frame.height = HIGH;
    stage.frame.tone = "linear";
    play(&stage);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            float u = ((float)(x - LEFT) + 0.5f) / WIDE * SMALL - 0.5f,
                  v = ((float)(y - TOP) + 0.5f) / HIGH * SMALL - 0.5f;
            int i = (int)floorf(u), j = (int)floorf(v);
            float a = u - (float)i, b = v - (float)j;
            uint8_t want[3];

            for (int c = 0; c < 3; c++) {
                float top = texel(light, SMALL, i, j, c) * (1 - a) + texel(light, SMALL, i + 1, j, c) * a;
                float bottom = texel(light, SMALL, i, j + 1, c) * (1 - a) + texel(light, SMALL, i + 1, j + 1, c) * a;

                want[c] = (uint8_t)(sf_srgb_encode((double)(top * (1 - b) + bottom * b)) * 255.0 + 0.5);
            }
            if (within(x, y, LEFT, TOP, WIDE, HIGH))
                assert_pixel(&stage, x, y, want, 2);
            else
                assert_pixel(&stage, x, y, BACKGROUND, 0);
        }
    finish(&stage);
}

/* The host's pixels come out as they are, each in its sharp rectangle, whatever their alpha; the renderer's picture is
 * not looked at then. */
static void check_pixels(struct stage *stage, const uint8_t *pixels, int side, int left, int top, int scale)
{
    stage->frame.x = (float)left;
    stage->frame.y = (float)top;
    stage->frame.width = stage->frame.height = (float)(side * scale);
    play(stage);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            bool inside = within(x, y, left, top, side * scale, side * scale);

            assert_pixel(stage, x, y,
                         inside ? pixels + ((y - top) / scale * side + (x - left) / scale) * 4 : BACKGROUND, 0);
        }
}

/* Two pictures: every pixel is that of the one on its side of the line, bit for bit, exact and scaled. */
static void test_beside(void **state)
{
    static const float wipes[] = {0, 0.3f, 0.5f, 1, -2, 7, NAN};
    static const float ends[] = {0, 0.3f, 0.5f, 1, 0, 1, 0};
    static float light[2][SIDE * SIDE * 4];
    static uint8_t alone[2][WIDTH * HEIGHT * 4];
    struct sf_gpu_image *first;
    struct stage stage;

    (void)state;
    setup(&stage);
    make_light(light[0]);
    for (int i = 0; i < SIDE * SIDE * 4; i++)
        light[1][i] = light[0][SIDE * SIDE * 4 - 1 - i];
    stage.frame.tone = "aces";
    stage.frame.x = stage.frame.y = PAD;
    for (float side = SIDE; side >= SIDE / 2; side -= SIDE / 2 - 5) {
        int left = PAD, width = (int)side;

        stage.frame.width = stage.frame.height = side;
        for (int p = 1; p >= 0; p--) {
            set_picture(&stage, light[p], true, SIDE, SIDE);
            play(&stage);
            memcpy(alone[p], stage.pixels, sizeof alone[p]);
        }
        first = stage.picture;
        stage.picture = NULL;
        set_picture(&stage, light[1], true, SIDE, SIDE);
        stage.input.beside = stage.picture;
        stage.input.picture = first;
        for (size_t i = 0; i < SF_COUNT(wipes); i++) {
            int line = left + (int)roundf(ends[i] * (float)width);

            stage.frame.wipe = wipes[i];
            play(&stage);
            for (int y = 0; y < HEIGHT; y++)
                for (int x = 0; x < WIDTH; x++)
                    assert_memory_equal(stage.pixels + (y * WIDTH + x) * 4, alone[x >= line] + (y * WIDTH + x) * 4, 4);
        }
        stage.input.beside = NULL;
        sf_gpu_image_destroy(&first);
    }
    finish(&stage);
}

static void test_pixels(void **state)
{
    enum { FEW = 13 };
    static const float light[4] = {1, 1, 1, 1};
    uint8_t pixels[FEW * FEW * 4];
    struct stage stage;

    (void)state;
    setup(&stage);
    for (uint32_t i = 0; i < sizeof pixels; i++)
        pixels[i] = (uint8_t)(sf_random_float(5, i, 0) * 255.9f);
    set_picture(&stage, light, true, 1, 1);
    stage.frame.pixels = pixels;
    stage.frame.pixels_width = stage.frame.pixels_height = FEW;
    check_pixels(&stage, pixels, FEW, 3, 2, 1);
    check_pixels(&stage, pixels, FEW, -4, 11, 5); /* over the left edge */
    check_pixels(&stage, pixels, FEW, 20, -300, 31);
    finish(&stage);
}

/* Without a picture, or with one that has no area, there is the background. */
static void test_nothing(void **state)
{
    static const float light[4] = {1, 1, 1, 1};
    struct stage stage;

    (void)state;
    setup(&stage);
    stage.frame.tone = "aces";
    for (int round = 0; round < 3; round++) {
        stage.frame.width = round == 0 ? 30 : round == 1 ? 0 : NAN;
        stage.frame.height = 40;
        play(&stage);
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++)
                assert_pixel(&stage, x, y, BACKGROUND, 0);
        set_picture(&stage, light, true, 1, 1);
    }
    finish(&stage);
}

/* ---- misuse, and when a graph is made anew ---- */

static void refuse(struct stage *stage, const char *says)
{
    struct sf_window_shape shape;

    kit_forget();
    assert_int_equal(sf_window_shape_of(&stage->input, &stage->graph.shape, &kit_log, &shape), SF_ERROR_USAGE);
    if (kit_record.errors != 1 || !strstr(kit_record.last, says))
        fail_msg("'%s' should speak of '%s'", kit_record.last, says);
    kit_forget();
}

static void test_misuse(void **state)
{
    static const float light[4];
    static const uint8_t pixel[4];
    const struct sf_overlay_vertex vertices[3] = {{0}};
    uint32_t indices[6] = {0, 1, 2, 2, 1, 3};
    struct sf_overlay_batch batches[2] = {{{0, 0, 9, 9}, 0, 3}, {{0, 0, 9, 9}, 3, 3}};
    struct sf_overlay overlay = {vertices, indices, batches, 3, 6, 2};
    struct stage stage;

    (void)state;
    setup(&stage);
    stage.frame.overlay = &overlay;
    refuse(&stage, "batch 1 draws vertex 3, but there are 3");
    indices[5] = UINT32_MAX;
    refuse(&stage, "batch 1 draws vertex 4294967295");
    indices[5] = 0;
    play(&stage);
    batches[1].first_index = 4;
    refuse(&stage, "batch 1 draws 3 indices from number 4 on");
    batches[1].first_index = UINT32_MAX - 1;
    refuse(&stage, "batch 1");
    batches[1] = (struct sf_overlay_batch){{0, 0, 9, 9}, 3, 2};
    refuse(&stage, "triangles");
    overlay.indices = NULL;
    refuse(&stage, "NULL");
    stage.frame.overlay = NULL;
    stage.frame.pixels = pixel;
    refuse(&stage, "0x0 pixels");
    stage.frame.pixels = NULL;
    set_picture(&stage, light, true, 1, 1);
    refuse(&stage, "without a tone mapping");
    stage.frame.tone = "filmic";
    refuse(&stage, "filmic");
    finish(&stage);
}

static struct sf_player *fit(struct stage *stage)
{
    struct sf_window_shape shape;

    if (sf_window_shape_of(&stage->input, &stage->graph.shape, &kit_log, &shape) != SF_OK)
        fail_msg("%s", kit_record.last);
    shape.width = WIDTH;
    shape.height = HEIGHT;
    shape.format = SF_FORMAT_BGRA8_UNORM;
    if (sf_window_graph_fit(&stage->graph, stage->gpu, &shape, &kit_log) != SF_OK)
        fail_msg("%s", kit_record.last);
    return stage->graph.player;
}

/* What changes from frame to frame makes no new graph, an overlay that shrinks neither; its room doubles. */
static void test_fit(void **state)
{
    const struct sf_overlay_vertex vertices[1] = {{0}};
    struct sf_overlay overlay = {.vertices = vertices};
    uint8_t pixels[64] = {0};
    struct sf_player *first;
    struct stage stage;

    (void)state;
    setup(&stage);
    stage.frame.overlay = &overlay;
    first = fit(&stage);
    uint32_t room = stage.graph.shape.vertices;
    overlay.vertex_count = room;
    stage.frame.x = 5;
    stage.frame.width = 50;
    stage.frame.exposure = 2;
    assert_ptr_equal(fit(&stage), first);
    overlay.vertex_count = room + 1;
    fit(&stage);
    assert_int_equal(stage.graph.shape.vertices, 2 * room);
    overlay.vertex_count = 1;
    fit(&stage);
    assert_int_equal(stage.graph.shape.vertices, 2 * room);
    stage.frame.pixels = pixels;
    stage.frame.pixels_width = stage.frame.pixels_height = 4;
    fit(&stage);
    assert_int_equal(stage.graph.shape.source_width, 4);
    assert_int_equal(stage.graph.plan->pass_count, 2); /* one draw for the picture, one for the overlay */
    finish(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tone),   cmocka_unit_test(test_senseless_light),
        cmocka_unit_test(test_scaled), cmocka_unit_test(test_beside),
        cmocka_unit_test(test_pixels), cmocka_unit_test(test_nothing),
        cmocka_unit_test(test_misuse), cmocka_unit_test(test_fit),
    };
    int skip = kit_probe();

    return skip ? skip : cmocka_run_group_tests(tests, NULL, NULL);
}
