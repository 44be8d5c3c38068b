/* The overlay in a window: triangles, clip rectangles to the pixel, blending against the CPU's, the font's coverage. */
#include "window_kit.h"
#include "base/array.h"
#include "base/hash.h"

/* A rectangle as two triangles from vertex 4 n on. */
static void put_rectangle(struct sf_overlay_vertex *vertices, uint32_t *indices, uint32_t n, const float rectangle[4],
                          uint32_t color)
{
    static const uint32_t order[6] = {0, 1, 2, 0, 2, 3};

    for (uint32_t i = 0; i < 4; i++)
        vertices[4 * n + i] = (struct sf_overlay_vertex){.x = rectangle[i == 1 || i == 2 ? 2 : 0],
                                                         .y = rectangle[i >= 2 ? 3 : 1],
                                                         .u = i == 1 || i == 2 ? 1 : 0,
                                                         .v = i >= 2 ? 1 : 0,
                                                         .color = color};
    for (uint32_t i = 0; i < 6; i++)
        indices[6 * n + i] = 4 * n + order[i];
}

/* Laid over `under` (codes), as straight alpha says. */
static void over(uint8_t under[3], uint32_t color, float coverage)
{
    float alpha = (float)(color >> 24) / 255.0f * coverage;

    for (int c = 0; c < 3; c++)
        under[c] = (uint8_t)((float)(color >> 8 * c & 255) * alpha + (float)under[c] * (1 - alpha) + 0.5f);
}

/* Two opaque batches with clip rectangles, the second made of the first one's very vertices and partly over it, and a
 * third that is clipped away. */
static void test_clip(void **state)
{
    static const float whole[4] = {0, 0, WIDTH, HEIGHT};
    struct sf_overlay_vertex vertices[8];
    uint32_t indices[12];
    const struct sf_overlay_batch batches[] = {
        {{10, 20, 47, 33}, 0, 6}, {{40.5f, 5, 60.5f, 25.75f}, 6, 6}, {{80, 60, 70, 65}, 0, 6}, {{5, 60, 6, 61}, 0, 6}};
    const struct sf_overlay overlay = {vertices, indices, batches, 8, 12, SF_COUNT(batches)};
    struct stage stage;

    (void)state;
    setup(&stage);
    put_rectangle(vertices, indices, 0, whole, 0xff204060u);
    put_rectangle(vertices, indices, 1, whole, 0xffa0b0c0u);
    stage.frame.overlay = &overlay;
    play(&stage);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            static const uint8_t first[3] = {0x60, 0x40, 0x20}, second[3] = {0xc0, 0xb0, 0xa0};
            const uint8_t *want = BACKGROUND;

            if (within(x, y, 10, 20, 37, 13) || within(x, y, 5, 60, 1, 1))
                want = first;
            if (within(x, y, 40, 5, 20, 21)) /* pixels whose centre is inside */
                want = second;
            assert_pixel(&stage, x, y, want, 0);
        }
    finish(&stage);
}

/* A triangle covers half of its rectangle: the pixels whose centres are below the diagonal, give or take those on it. */
static void test_triangle(void **state)
{
    enum { LEG = 40 };
    const struct sf_overlay_vertex vertices[] = {
        {10, 10, 0, 0, 0xff0000ffu}, {10, 10 + LEG, 0, 0, 0xff0000ffu}, {10 + LEG, 10 + LEG, 0, 0, 0xff0000ffu}};
    const uint32_t indices[] = {2, 0, 1};
    const struct sf_overlay_batch batch = {{0, 0, WIDTH, HEIGHT}, 0, 3};
    const struct sf_overlay overlay = {vertices, indices, &batch, 3, 3, 1};
    static const uint8_t red[3] = {255, 0, 0};
    struct stage stage;

    (void)state;
    setup(&stage);
    stage.frame.overlay = &overlay;
    play(&stage);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            if (!within(x, y, 10, 10, LEG, LEG) || x > y)
                assert_pixel(&stage, x, y, BACKGROUND, 0);
            else if (x < y)
                assert_pixel(&stage, x, y, red, 0);
    finish(&stage);
}

/* Layers of straight alpha over a picture, in their order. */
static void test_blend(void **state)
{
    enum { LAYERS = 24 };
    static const float light[4] = {0.4f, 0.1f, 0.02f, 1};
    struct sf_overlay_vertex vertices[4 * LAYERS];
    uint32_t indices[6 * LAYERS], colors[LAYERS];
    float rectangles[LAYERS][4];
    const struct sf_overlay_batch batches[] = {{{0, 0, WIDTH, HEIGHT}, 0, 6 * 10},
                                               {{0, 0, WIDTH, HEIGHT}, 6 * 10, 6 * (LAYERS - 10)}};
    const struct sf_overlay overlay = {vertices, indices, batches, 4 * LAYERS, 6 * LAYERS, 2};
    const struct sf_tone tone = {.mode = SF_TONE_LINEAR};
    struct stage stage;
    uint8_t lit[3];

    (void)state;
    setup(&stage);
    set_picture(&stage, light, true, 1, 1);
    sf_tone_encode8(&tone, light, 1, 3, lit);
    stage.frame.x = stage.frame.y = 20;
    stage.frame.width = stage.frame.height = 30;
    stage.frame.tone = "linear";
    for (uint32_t i = 0; i < LAYERS; i++) {
        uint32_t left = sf_random_u32(1, i, 0) % (WIDTH - 5), top = sf_random_u32(1, i, 1) % (HEIGHT - 5);
        const float rectangle[4] = {(float)left, (float)top, (float)(left + 5 + sf_random_u32(1, i, 2) % 50),
                                    (float)(top + 5 + sf_random_u32(1, i, 3) % 50)};

        memcpy(rectangles[i], rectangle, sizeof rectangle);
        colors[i] = sf_random_u32(1, i, 4);
        put_rectangle(vertices, indices, i, rectangle, colors[i]);
    }
    stage.frame.overlay = &overlay;
    play(&stage);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            bool inside = within(x, y, 20, 20, 30, 30);
            uint8_t want[3];
            int layers = 1;

            memcpy(want, inside ? lit : BACKGROUND, sizeof want);
            for (uint32_t i = 0; i < LAYERS; i++)
                if ((float)x >= rectangles[i][0] && (float)y >= rectangles[i][1] && (float)x < rectangles[i][2] &&
                    (float)y < rectangles[i][3]) {
                    over(want, colors[i], 1);
                    layers++;
                }
            assert_pixel(&stage, x, y, want, layers > 2 ? 2 : 1); /* each layer rounds anew */
        }
    finish(&stage);
}

/* The font's texels are coverage: one to a pixel they come out as they are, between them they are mixed. */
static void test_font(void **state)
{
    enum { CELLS = 8, LEFT = 30, TOP = 20, LARGE = 4 };
    uint8_t coverage[CELLS * CELLS];
    float rectangle[4] = {LEFT, TOP, LEFT + CELLS, TOP + CELLS};
    struct sf_overlay_vertex vertices[8];
    uint32_t indices[12];
    const struct sf_overlay_batch batch = {{0, 0, WIDTH, HEIGHT}, 0, 12};
    const struct sf_overlay overlay = {vertices, indices, &batch, 8, 12, 1};
    const uint32_t color = 0xc010e0ffu;
    struct stage stage;

    (void)state;
    setup(&stage);
    for (uint32_t i = 0; i < sizeof coverage; i++)
        coverage[i] = (uint8_t)(i == 0 ? 0 : i == 1 ? 255 : sf_random_u32(9, i, 0) & 255);
    set_font(&stage, coverage, CELLS, CELLS);
    put_rectangle(vertices, indices, 0, rectangle, color);
    rectangle[0] = rectangle[1] = 0; /* a pixel is four texels wide: its centre is half way between two */
    rectangle[2] = rectangle[3] = (float)CELLS / LARGE;
    put_rectangle(vertices, indices, 1, rectangle, color);
    stage.frame.overlay = &overlay;
    play(&stage);
    for (int y = 0; y < CELLS; y++)
        for (int x = 0; x < CELLS; x++) {
            uint8_t want[3];

            memcpy(want, BACKGROUND, sizeof want);
            over(want, color, (float)coverage[y * CELLS + x] / 255.0f);
            assert_pixel(&stage, LEFT + x, TOP + y, want, 1);
        }
    for (int y = 0; y < CELLS / LARGE; y++)
        for (int x = 0; x < CELLS / LARGE; x++) {
            const uint8_t *corner = coverage + (y * LARGE + LARGE / 2 - 1) * CELLS + x * LARGE + LARGE / 2 - 1;
            uint8_t want[3];

            memcpy(want, BACKGROUND, sizeof want);
            over(want, color, (float)(corner[0] + corner[1] + corner[CELLS] + corner[CELLS + 1]) / (4 * 255.0f));
            assert_pixel(&stage, x, y, want, 1);
        }
    finish(&stage);
}

/* More than a graph has room for at first, in batches of one rectangle: every pixel of the window is a batch. */
static void test_many(void **state)
{
    enum { COUNT = WIDTH * HEIGHT };
    struct sf_overlay_vertex *vertices = calloc(4 * COUNT, sizeof *vertices);
    uint32_t *indices = calloc(6 * COUNT, sizeof *indices);
    struct sf_overlay_batch *batches = calloc(COUNT, sizeof *batches);
    struct sf_overlay overlay = {vertices, indices, batches, 4 * COUNT, 6 * COUNT, COUNT};
    struct stage stage;

    (void)state;
    setup(&stage);
    assert_true(vertices && indices && batches);
    for (uint32_t i = 0; i < COUNT; i++) {
        float x = (float)(i % WIDTH), y = (float)(i / WIDTH);
        const float rectangle[4] = {x - 1, y - 1, x + 2, y + 2};

        put_rectangle(vertices, indices, i, rectangle, 0xff000000u | i * 2654435761u >> 8);
        batches[i] = (struct sf_overlay_batch){{x, y, x + 1, y + 1}, 6 * i, 6};
    }
    stage.frame.overlay = &overlay;
    play(&stage);
    for (uint32_t i = 0; i < COUNT; i++) {
        uint32_t color = i * 2654435761u >> 8;
        const uint8_t want[3] = {color & 255, color >> 8 & 255, color >> 16 & 255};

        assert_pixel(&stage, (int)(i % WIDTH), (int)(i / WIDTH), want, 0);
    }
    assert_true(stage.graph.shape.vertices >= 4 * COUNT && stage.graph.shape.vertices < 8 * COUNT);
    assert_true(stage.graph.shape.corners >= 6 * COUNT && stage.graph.shape.clips >= COUNT);
    free(vertices);
    free(indices);
    free(batches);
    finish(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_clip), cmocka_unit_test(test_triangle), cmocka_unit_test(test_blend),
        cmocka_unit_test(test_font), cmocka_unit_test(test_many),
    };
    int skip = kit_probe();

    return skip ? skip : cmocka_run_group_tests(tests, NULL, NULL);
}
