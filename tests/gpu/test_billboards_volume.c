/* Billboards that stand for volumes: average-density and density-extent (METHODS B5, B6). */
#include "volume_kit.h"

#include "output/png.h"

/* ---- B5 ---- */

/* The optical depth of the sphere where its disc, seen from the front, is met. */
static double disc_depth(const struct view *view)
{
    double x = (view->ray[0] * view->centre[2] - view->centre[0]) / RADIUS,
           y = (view->ray[1] * view->centre[2] - view->centre[1]) / RADIUS;

    return 2 * RADIUS * EXTINCTION * sqrt(fmax(1 - x * x - y * y, 0));
}

/* A slab `deep` metres deep, `before` of them before the centre. */
static double slab(const struct view *view, double deep, double before, double opacity)
{
    double front = view->centre[2] - before, back = fmin(front + deep, view->centre[2] + RADIUS);
    double seen = clamp((view->wall - front) / deep, 0, 1), passed = clamp((NEAR_PLANE - front) / (back - front), 0, 1);

    return opacity * (1 - exp(-disc_depth(view))) * fmax(seen - passed, 0);
}

static double average_form(const struct view *view)
{
    return slab(view, 2 * RADIUS, RADIUS, 1);
}

static double average_form_set(const struct view *view)
{
    return slab(view, 0.8 * RADIUS, 0.25 * 0.8 * RADIUS, 0.6);
}

static double average_form_talk(const struct view *view)
{
    return slab(view, 2 * RADIUS, 0, 1);
}

#define AVERAGE ",\"method\":\"average-density\""

static void test_average(void **state)
{
    (void)state;
    /* At the outline opacity is as the root of the distance to it. */
    assert_true(compare(AVERAGE, average_form, 5e-5) > 3000);
    assert_true(compare(AVERAGE ",\"average_density\":{\"depth\":0.8,\"plane\":0.25,\"opacity\":0.6}", average_form_set,
                        5e-5) > 3000);
    assert_true(compare(AVERAGE ",\"average_density\":{\"plane\":0}", average_form_talk, 5e-5) > 3000);
    check_over(AVERAGE);
    check_order(AVERAGE);
}

/* ---- B6 ---- */

/* A file of 2x2 tiles, 16x16 texels each; `texel` says what is at (x, y) of tile number `tile`: R, G, B, A. */
static void write_plane(const char *name, void (*texel)(unsigned tile, unsigned x, unsigned y, uint8_t rgba[4]))
{
    static uint8_t pixels[32][32][4];
    const struct sf_png_frame png = {.width = 32, .height = 32, .channels = 4, .bits = 8, .pixels = &pixels[0][0][0]};

    for (unsigned y = 0; y < 32; y++)
        for (unsigned x = 0; x < 32; x++)
            texel(y / 16 * 2 + x / 16, x % 16, y % 16, pixels[y][x]);
    assert_int_equal(sf_png_write(name, &png, &test_log), SF_OK);
}

static void even_color(unsigned tile, unsigned x, unsigned y, uint8_t rgba[4])
{
    (void)x;
    (void)y;
    memset(rgba, 255, 3);
    rgba[3] = (uint8_t)(51 + 51 * tile);
}

static void even_shape(unsigned tile, unsigned x, unsigned y, uint8_t rgba[4])
{
    (void)x;
    (void)y;
    rgba[0] = tile == 1 ? 255 : 128;
    rgba[1] = rgba[2] = 128;
    rgba[3] = (uint8_t)(tile == 1 ? 128 : 0);
}

/* Of tile 1, one quarter: right and above. */
static void corner_color(unsigned tile, unsigned x, unsigned y, uint8_t rgba[4])
{
    memset(rgba, 255, 3);
    rgba[3] = tile == 1 && x >= 8 && y < 8 ? 255 : 0;
}

/* Where the pixel lies in the particle's picture: to the right, up. False where the rectangle need not reach. */
static bool in_picture(const struct view *view, double at[2])
{
    double x = (view->ray[0] * view->centre[2] - view->centre[0]) / RADIUS,
           y = (view->ray[1] * view->centre[2] - view->centre[1]) / RADIUS;

    at[0] = cos(0.6) * x - sin(0.6) * y;
    at[1] = sin(0.6) * x + cos(0.6) * y;
    return fabs(x) < 0.999 && fabs(y) < 0.999;
}

/* Tile 1 of the even atlas, which covers 102/255, with a height of 128/255. `deep`: D, m. */
static double extent_of(const struct view *view, double deep, double deviation, double opacity)
{
    double alpha = 102 / 255., at[2];

    if (!in_picture(view, at) || fabs(fmax(fabs(at[0]), fabs(at[1])) - 1) < 0.01)
        return NAN;
    if (fmax(fabs(at[0]), fabs(at[1])) > 1)
        return 0;
    double plane = view->centre[2] - deviation * RADIUS * 128 / 255;
    double behind = 0.5 + 0.5 * clamp((view->wall - plane) / deep / alpha, -1, 1);
    double before = 0.5 + 0.5 * clamp((NEAR_PLANE - plane) / deep / alpha, -1, 1);

    /* As much matter as in the sphere, spread over the square. */
    return opacity * (1 - exp(-EXTINCTION * RADIUS * 3.14159265358979323846 / 3)) * (behind - before);
}

static double extent_form(const struct view *view)
{
    return extent_of(view, RADIUS, 0, 1);
}

static double extent_form_set(const struct view *view)
{
    return extent_of(view, 0.5 * RADIUS, 0.7, 0.8);
}

#define EXTENT ",\"method\":\"density-extent\",\"density_extent\":"
#define FILED  ",\"atlas\":{\"type\":\"file\",\"file\":\"a.color.png\"}"
#define FLAT   EXTENT "{\"deviation\":0,\"lighting\":0}"

static void test_extent(void **state)
{
    (void)state;
    write_plane("a.color.png", even_color);
    write_plane("a.normal.png", even_shape);
    assert_true(compare(FILED FLAT, extent_form, 2e-5) > 3000);
    /* Heights have 8 bits on the device. */
    assert_true(compare(FILED EXTENT "{\"depth\":0.5,\"deviation\":0.7,\"opacity\":0.8,\"lighting\":1}",
                        extent_form_set, 5e-4) > 3000);
    check_over(EXTENT "{}");
    check_order(EXTENT "{}");
    check_over(",\"atlas\":{\"type\":\"made\",\"size\":32}" EXTENT "{}");
}

/* The picture stands upright, and turns with the particle. */
static void test_extent_picture(void **state)
{
    static float smoke[PIXELS][4];
    size_t covered = 0;

    (void)state;
    write_plane("a.color.png", corner_color);
    draw(scene_at(&places[0], FILED FLAT), smoke, NULL);
    for (size_t i = 0; i < PIXELS; i++) {
        struct view view = view_of(&places[0], i);
        double at[2];

        if (!in_picture(&view, at) || fmax(fabs(at[0]), fabs(at[1])) > 0.99 || fmin(fabs(at[0]), fabs(at[1])) < 0.1)
            continue;
        covered += at[0] > 0 && at[1] > 0;
        /* All matter in a quarter of the square: four times as dense. */
        assert_float_equal(smoke[i][3],
                           at[0] > 0 && at[1] > 0 ? 1 - exp(-EXTINCTION * RADIUS * 4 * 3.14159265358979323846 / 3) : 0,
                           2e-3);
    }
    assert_true(covered > 20);
}

/* Of one particle with its normals to the right, and no light but that of a lamp from there or elsewhere: radiance for each
 * unit of opacity. */
static double lit(const char *direction, double rotation, double lighting)
{
    static float smoke[PIXELS][4];
    char json[1024];
    const float *middle = smoke[SIDE / 2 * SIDE + SIDE / 2];

    snprintf(json, sizeof json,
             "{\"camera\":{\"eye\":[0,0,3],\"target\":[0,0,0]},\"environment\":{\"type\":\"color\",\"color\":[0,0,0]},"
             "\"lights\":[{\"type\":\"directional\",\"direction\":[%s]}],\"sim\":{\"capacity\":8},"
             "\"thick\":{\"resolution\":\"full\"},"
             "\"atlas\":{\"type\":\"file\",\"file\":\"a.color.png\"}"
             ",\"emitters\":[{\"type\":\"list\",\"still\":true,"
             "\"particles\":[{\"centre\":[0,0,0],\"radius\":0.7,\"tile\":1,\"rotation\":%.9g}]}]"
             ",\"method\":\"density-extent\",\"density_extent\":{\"lighting\":%g}}",
             direction, rotation, lighting);
    draw(parse(json), smoke, NULL);
    assert_true(middle[3] > 0.3f);
    return (double)(middle[1] / middle[3]);
}

static void test_extent_lighting(void **state)
{
    static const double quarter = 1.57079632679489662;
    double plain, back;

    (void)state;
    write_plane("a.color.png", even_color);
    write_plane("a.normal.png", even_shape);
    plain = lit("-1,0,0", 0, 0);
    assert_true(plain > 0);
    assert_float_equal(lit("-1,0,0", 0, 1) / plain, 2, 0.02);
    assert_float_equal(lit("-1,0,0", 0, 0.5) / plain, 1.5, 0.02);
    assert_float_equal(lit("-1,0,0", 2 * quarter, 1) / plain, 0, 0.02);
    /* The picture turns clockwise: right becomes down. */
    plain = lit("0,1,0", 0, 0);
    assert_float_equal(lit("0,1,0", quarter, 1) / plain, 2, 0.02);
    /* From the viewer to the smoke, against a normal to the right. */
    back = lit("0,0,-1", 0, 0);
    assert_float_equal(lit("0,0,-1", 0, 1) / back, 1, 0.02);
}

/* Why the scene cannot be drawn. */
static void refuse(const char *settings, const char *reason)
{
    const struct sf_renderer_options options = {.width = SIDE, .height = SIDE};
    struct sf_scene *scene = scene_at(&places[0], settings);
    struct sf_renderer *renderer = NULL;

    assert_int_equal(sf_renderer_create(device, scene, &options, &test_log, &renderer), SF_ERROR_SCENE);
    assert_non_null(strstr(message, reason));
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
}

/* Channels are asked for only where they are used. */
static void test_extent_channels(void **state)
{
    static float smoke[PIXELS][4];

    (void)state;
    scratch_empty(".");
    write_plane("a.color.png", even_color);
    refuse(FILED EXTENT "{}", "'a.color.png' has no normals");
    refuse(FILED EXTENT "{\"lighting\":0}", "'a.color.png' has no heights");
    draw(scene_at(&places[0], FILED FLAT), smoke, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_average), cmocka_unit_test(test_extent),
                                       cmocka_unit_test(test_extent_picture), cmocka_unit_test(test_extent_lighting),
                                       cmocka_unit_test(test_extent_channels)};

    return cmocka_run_group_tests(tests, setup, teardown);
}
