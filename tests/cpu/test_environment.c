/* Environments: radiance by direction, pictures read and shrunk, ambient light by spherical harmonics. */
#include "scene_kit.h"

#include <math.h>
#include "base/file.h"
#include "output/exr.h"

static const double PI = 3.14159265358979323846;

/* A panorama or a face as an EXR file of floats. */
typedef void (*paint_fn)(int x, int y, float rgb[3]);

static void write_exr(const char *name, int width, int height, paint_fn paint)
{
    float *pixels = calloc((size_t)width * (size_t)height * 3, sizeof *pixels);
    struct sf_exr_channel channels[3];

    assert_non_null(pixels);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            paint(x, y, pixels + ((size_t)y * (size_t)width + (size_t)x) * 3);
    for (int c = 0; c < 3; c++)
        channels[c] = (struct sf_exr_channel){.name = c == 0   ? "R"
                                                      : c == 1 ? "G"
                                                               : "B",
                                              .pixels = pixels + c,
                                              .pixel_stride = 3 * sizeof *pixels,
                                              .row_stride = (size_t)width * 3 * sizeof *pixels,
                                              .source = SF_EXR_FLOAT,
                                              .stored = SF_EXR_FLOAT};
    assert_int_equal(sf_exr_write(name,
                                  &(struct sf_exr_frame){.width = (uint32_t)width,
                                                         .height = (uint32_t)height,
                                                         .channels = channels,
                                                         .channel_count = 3,
                                                         .compression = SF_EXR_NONE},
                                  NULL),
                     SF_OK);
    free(pixels);
}

static void grey(int x, int y, float rgb[3])
{
    (void)x;
    (void)y;
    rgb[0] = rgb[1] = 0.5f;
    rgb[2] = 0.25f;
}

/* Quarters from left to right: behind left, left of the middle, right of the middle, behind right. */
static void quarters(int x, int y, float rgb[3])
{
    (void)y;
    rgb[x / 2 % 4 > 2 ? 2 : x / 2 % 4] = 0.5f;
}

static void upper_half(int x, int y, float rgb[3])
{
    (void)x;
    if (y < 8)
        rgb[0] = rgb[1] = rgb[2] = 0.5f;
}

static void look(const struct sf_scene *scene, float x, float y, float z, float rgb[3])
{
    const float length = sqrtf(x * x + y * y + z * z), d[3] = {x / length, y / length, z / length};

    sf_environment_radiance(&scene->environment, d, rgb);
}

static void same(const float rgb[3], double r, double g, double b, double tolerance)
{
    if (fabs(rgb[0] - r) > tolerance || fabs(rgb[1] - g) > tolerance || fabs(rgb[2] - b) > tolerance)
        fail_msg("(%g, %g, %g), not (%g, %g, %g)", rgb[0], rgb[1], rgb[2], r, g, b);
}

/* Irradiance over pi by brute force. */
static void integrate(const struct sf_scene *scene, const float normal[3], double rgb[3])
{
    enum { ROWS = 400, COLUMNS = 800 };

    rgb[0] = rgb[1] = rgb[2] = 0;
    for (int j = 0; j < ROWS; j++) {
        for (int i = 0; i < COLUMNS; i++) {
            double y = 1 - 2 * (j + 0.5) / ROWS, phi = 2 * PI * (i + 0.5) / COLUMNS, s = sqrt(1 - y * y);
            float d[3] = {(float)(s * cos(phi)), (float)y, (float)(s * sin(phi))}, seen[3];
            double cosine = (double)d[0] * normal[0] + (double)d[1] * normal[1] + (double)d[2] * normal[2];

            if (cosine <= 0)
                continue;
            sf_environment_radiance(&scene->environment, d, seen);
            for (int c = 0; c < 3; c++)
                rgb[c] += cosine * seen[c] * 4 / (ROWS * COLUMNS);
        }
    }
}

static const float directions[][3] = {{0, 1, 0},        {0, -1, 0},           {1, 0, 0}, {0, 0, -1}, {0.6f, 0.8f, 0},
                                      {-0.6f, 0, 0.8f}, {0.48f, -0.6f, 0.64f}};

static void test_constant_light_gives_itself(void **state)
{
    struct sf_scene *scenes[3];
    float rgb[3];

    (void)state;
    write_exr("grey.exr", 4, 2, grey);
    scenes[0] = parse("{\"environment\":{\"type\":\"color\",\"color\":[0.5,0.5,0.25],\"intensity\":2}}");
    scenes[1] = parse("{\"environment\":{\"type\":\"sky\",\"zenith\":[0.5,0.5,0.25],\"horizon\":[0.5,0.5,0.25],"
                      "\"ground\":[0.5,0.5,0.25],\"intensity\":2}}");
    scenes[2] = parse("{\"environment\":{\"type\":\"latlong\",\"file\":\"grey.exr\",\"rotation\":33,\"intensity\":2}}");
    for (int s = 0; s < 3; s++) {
        for (size_t i = 0; i < SF_COUNT(directions); i++) {
            sf_environment_ambient(&scenes[s]->environment, directions[i], rgb);
            same(rgb, 1, 1, 0.5, 2e-5);
            sf_environment_radiance(&scenes[s]->environment, directions[i], rgb);
            same(rgb, 1, 1, 0.5, 1e-6);
        }
        sf_scene_destroy(&scenes[s]);
    }
}

static void test_sky(void **state)
{
    struct sf_scene *scene =
        parse("{\"environment\":{\"zenith\":[0,0,1],\"horizon\":[1,1,1],\"ground\":[0.2,0,0],\"intensity\":3}}");
    float rgb[3];

    (void)state;
    look(scene, 0, 1, 0, rgb);
    same(rgb, 0, 0, 3, 1e-6);
    look(scene, 1, 0, 0, rgb);
    same(rgb, 3, 3, 3, 1e-6);
    look(scene, 0, -1, 0, rgb);
    same(rgb, 0.6, 0, 0, 1e-6);
    look(scene, 0.8f, 0.6f, 0, rgb); /* smoothstep of 0.6 is 0.648 */
    same(rgb, 3 * (1 - 0.648), 3 * (1 - 0.648), 3, 1e-5);
    look(scene, 0, -0.125f, 0.9921567f, rgb); /* half way down to the ground's colour */
    same(rgb, 3 * 0.6, 1.5, 1.5, 1e-4);
    sf_scene_destroy(&scene);
}

/* Order 2 holds the irradiance of any sky to within a few per cent (Ramamoorthi and Hanrahan); of this smooth one, to
 * one. */
static void test_ambient_of_the_sky(void **state)
{
    struct sf_scene *scene = parse("{}");
    float rgb[3];
    double truth[3];

    (void)state;
    for (size_t i = 0; i < SF_COUNT(directions); i++) {
        sf_environment_ambient(&scene->environment, directions[i], rgb);
        integrate(scene, directions[i], truth);
        same(rgb, truth[0], truth[1], truth[2], 0.012);
    }
    sf_scene_destroy(&scene);
}

static void test_ambient_of_a_half(void **state)
{
    struct sf_scene *scene;
    float rgb[3];

    (void)state;
    /* Light 1/2 from the upper half: bands 0 and 1 are known by heart, band 2 is none. sh0 = 1/4, sh1 = 1/2 3/(4 pi)
     * 2/3 pi = 1/4. */
    write_exr("half.exr", 32, 16, upper_half);
    scene = parse("{\"environment\":{\"type\":\"latlong\",\"file\":\"half.exr\"}}");
    same(scene->environment.sh[0], 0.25, 0.25, 0.25, 1e-5);
    same(scene->environment.sh[1], 0.25, 0.25, 0.25, 1e-5);
    for (int i = 2; i < 9; i++)
        same(scene->environment.sh[i], 0, 0, 0, 1e-5);
    sf_environment_ambient(&scene->environment, directions[0], rgb);
    same(rgb, 0.5, 0.5, 0.5, 1e-5);
    sf_scene_destroy(&scene);
}

/* What is where in a panorama, and which way rotation turns it. */
static void test_panorama(void **state)
{
    static const char format[] = "{\"environment\":{\"type\":\"latlong\",\"file\":\"quarters.exr\",\"rotation\":%d}}";
    static const float middles[4][3] = {
        {-1, 0, 1}, {-1, 0, -1}, {1, 0, -1}, {1, 0, 1}}; /* of the quarters, from the left edge */
    float rgb[3], ambient[3];
    double truth[3];
    char text[256];

    (void)state;
    write_exr("quarters.exr", 8, 4, quarters);
    for (int turn = 0; turn < 4; turn++) {
        struct sf_scene *scene;

        snprintf(text, sizeof text, format, 90 * turn);
        scene = parse(text);
        assert_int_equal(scene->environment.width, 8);
        for (int i = 0; i < 4; i++) {
            /* Turning counter-clockwise from above takes the quarter at +x to -z, one place to the left. */
            const float *d = middles[(i - turn + 4) % 4];

            look(scene, d[0], d[1], d[2], rgb);
            same(rgb, i == 0 ? 0.5 : 0, i == 1 ? 0.5 : 0, i >= 2 ? 0.5 : 0, 1e-6);
        }
        for (size_t i = 0; i < SF_COUNT(directions); i++) {
            sf_environment_ambient(&scene->environment, directions[i], ambient);
            integrate(scene, directions[i], truth);
            same(ambient, truth[0], truth[1], truth[2], 0.03);
        }
        sf_scene_destroy(&scene);
    }
}

static void black(int x, int y, float rgb[3])
{
    (void)x;
    (void)y;
    rgb[0] = nanf(""); /* what is no light is none */
    rgb[1] = -1;
}

static int face_number;
static void numbered(int x, int y, float rgb[3])
{
    rgb[0] = (float)(face_number + 1);
    rgb[1] = x < 8 ? 0 : 0.5f; /* the right half */
    rgb[2] = y < 8 ? 0 : 0.5f; /* the lower half */
}

/* Faces and their axes, after the table in the Vulkan specification. */
static void test_cube(void **state)
{
    static const struct {
        float axis[3], s[3], t[3];
    } faces[6] = {
        {{1, 0, 0}, {0, 0, -1}, {0, -1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}}, {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
        {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}}, {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}},
    };
    struct sf_scene *scene;
    char name[32];

    (void)state;
    for (face_number = 0; face_number < 6; face_number++) {
        snprintf(name, sizeof name, "f%d.exr", face_number);
        write_exr(name, 16, 16, numbered);
    }
    scene = parse("{\"environment\":{\"type\":\"cube\",\"files\":[\"f0.exr\",\"f1.exr\",\"f2.exr\",\"f3.exr\",\"f4."
                  "exr\",\"f5.exr\"]}}");
    assert_int_equal(scene->environment.width, 64);
    assert_int_equal(scene->environment.height, 32);
    for (int f = 0; f < 6; f++) {
        for (int corner = 0; corner < 4; corner++) {
            float rgb[3], d[3], u = corner % 2 ? 0.5f : -0.5f, v = corner / 2 ? 0.5f : -0.5f;

            for (int i = 0; i < 3; i++)
                d[i] = faces[f].axis[i] + u * faces[f].s[i] + v * faces[f].t[i];
            look(scene, d[0], d[1], d[2], rgb);
            same(rgb, f + 1, corner % 2 ? 0.5 : 0, corner / 2 ? 0.5 : 0, 1e-5);
        }
    }
    sf_scene_destroy(&scene);
}

static void speck(int x, int y, float rgb[3])
{
    rgb[0] = rgb[1] = rgb[2] = (x / 3 + y) % 2 ? 0.5f : 0.125f;
}

/* Large pictures shrink to 1024 x 512 and keep their mean. */
static void test_large_picture(void **state)
{
    struct sf_scene *scene;
    double sum = 0;
    size_t count;

    (void)state;
    write_exr("large.exr", 2500, 1250, speck);
    scene = parse("{\"environment\":{\"type\":\"latlong\",\"file\":\"large.exr\"}}");
    assert_int_equal(scene->environment.width, 1024);
    assert_int_equal(scene->environment.height, 512);
    count = (size_t)1024 * 512 * 3;
    for (size_t i = 0; i < count; i++)
        sum += scene->environment.pixels[i];
    assert_float_equal(sum / (double)count, 0.3125, 1e-4);
    sf_scene_destroy(&scene);
    write_exr("black.exr", 4, 2, black);
    scene = parse("{\"environment\":{\"type\":\"latlong\",\"file\":\"black.exr\"}}");
    for (int i = 0; i < 9; i++)
        same(scene->environment.sh[i], 0, 0, 0, 0);
    sf_scene_destroy(&scene);
}

static void test_faults(void **state)
{
    (void)state;
    write_exr("square.exr", 4, 4, grey);
    write_exr("wide.exr", 8, 4, grey);
    write_exr("black.exr", 4, 4, black);
    assert_int_equal(sf_file_write("junk.exr", "\x76\x2f\x31\x01junk", 8, NULL), SF_OK);
    assert_int_equal(sf_file_write("junk.png", "\x89PNG\r\n\x1a\njunk", 12, NULL), SF_OK);
    assert_int_equal(sf_file_write("junk.hdr", "#?RADIANCE\n\n-Y 999999 +X 999999\n", 32, NULL), SF_OK);
    refuse("{\"environment\":{\"type\":\"latlong\",\"file\":\"square.exr\"}}",
           "test.json: /environment/file: 'square.exr' is 4x4; a panorama is twice as wide as high");
    refuse("{\"environment\":{\"type\":\"latlong\",\"file\":\"junk.exr\"}}", "test.json: /environment/file: ");
    refuse("{\"environment\":{\"type\":\"latlong\",\"file\":\"junk.png\"}}", "test.json: /environment/file: ");
    refuse("{\"environment\":{\"type\":\"latlong\",\"file\":\"junk.hdr\"}}", "test.json: /environment/file: ");
    refuse(
        "{\"environment\":{\"type\":\"cube\",\"files\":[\"square.exr\",\"black.exr\",\"wide.exr\",\"a\",\"b\",\"c\"]}}",
        "test.json: /environment/files/2: 'wide.exr' is 8x4; the six pictures of a cube are squares of one size");
    refuse(
        "{\"environment\":{\"type\":\"cube\",\"files\":[\"square.exr\",\"black.exr\",\"none.exr\",\"a\",\"b\",\"c\"]}}",
        "test.json: /environment/files/2: ");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_constant_light_gives_itself),
        cmocka_unit_test(test_sky),
        cmocka_unit_test(test_ambient_of_the_sky),
        cmocka_unit_test(test_ambient_of_a_half),
        cmocka_unit_test(test_panorama),
        cmocka_unit_test(test_cube),
        cmocka_unit_test(test_large_picture),
        cmocka_unit_test(test_faults),
    };
    return cmocka_run_group_tests(tests, scratch_enter, scratch_leave);
}
