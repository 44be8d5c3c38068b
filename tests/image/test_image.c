/* Frames of small scenes against golden ones in tests/image/golden: EXR, half, R G B A and Z.
 *
 * Compared is what an eye would see: colour tone-mapped (Reinhard, exposure 0) and encoded for sRGB, alpha, and
 * 1/(1 + Z), all within 0..1. Drivers differ in rounding, in the sampler's weights and in where an edge falls, and so:
 *
 * - the mean difference of each channel is at most MEAN_MAX;
 * - each pixel lies within EACH_MAX of what the golden frame holds in the 3 x 3 pixels around it, from its least to its
 *   greatest value there: an edge may move by a pixel, a value may not.
 *
 * SF_UPDATE_GOLDEN=1 writes the golden frames anew. A test that fails writes NAME-difference.png (golden, found, and
 * ten times the difference, side by side) to the folder SF_IMAGE_OUT, or to the current one. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "base/array.h"
#include "output/exr.h"
#include "output/half.h"
#include "output/png.h"
#include "output/tone.h"
#include "sfumato/sfumato.h"

enum { SKIP = 77, SIDE = 96, CHANNELS = 5, ZOOM = 3 };
static const char *const CHANNEL_NAMES[CHANNELS] = {"R", "G", "B", "A", "Z"};

/* A quarter of an 8-bit step, and three steps. On the driver that made the golden frames the differences are those of
 * rounding to half, below 0.00005. */
static const double MEAN_MAX = 0.001, EACH_MAX = 0.012;

static const struct picture {
    const char *name, *scene;
    uint32_t frame;
} pictures[] = {
    {"plume", "tests/image/plume.json", 6},      /* smoke that shadows itself and the ground */
    {"panorama", "scenes/tiny/latlong.json", 0}, /* a textured environment */
    {"lights", "scenes/tiny/all.json", 16},      /* four lights, solids, every emitter and force */
    {"mesh", "scenes/tiny/mesh.json", 8},        /* meshes, and smoke from one */
};

static struct sf_device *device;

static void write_log(void *user, enum sf_log_level level, const char *message)
{
    (void)user;
    (void)level;
    fprintf(stderr, "%s\n", message);
}
static const struct sf_log test_log = {.write = write_log, .level = SF_LOG_WARNING};

static void must(enum sf_status status)
{
    if (status)
        fail_msg("status %d", (int)status);
}

static void in_source(char path[1024], const char *name)
{
    const char *root = getenv("SF_SOURCE_ROOT");

    snprintf(path, 1024, "%s/%s", root ? root : ".", name);
}

/* ---- frames as [SIDE][SIDE][CHANNELS] floats ---- */

static void render(const struct picture *picture, float *pixels)
{
    const struct sf_renderer_options options = {.width = SIDE, .height = SIDE};
    struct sf_scene *scene = NULL;
    struct sf_renderer *renderer = NULL;
    struct sf_frame frame;
    uint64_t ticket;
    char path[1024];

    in_source(path, picture->scene);
    must(sf_scene_load(path, NULL, 0, &test_log, &scene));
    must(sf_renderer_create(device, scene, &options, &test_log, &renderer));
    must(sf_renderer_render(renderer, picture->frame, &ticket));
    must(sf_renderer_wait(renderer, ticket, &frame));
    for (size_t i = 0; i < (size_t)SIDE * SIDE; i++) {
        for (size_t c = 0; c < 4; c++)
            pixels[CHANNELS * i + c] = sf_half_to_float(frame.color[4 * i + c]);
        pixels[CHANNELS * i + 4] = frame.depth[i];
    }
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
    assert_int_equal(sf_device_validation_messages(device), 0);
}

static void write_golden(const char *path, const float *pixels)
{
    struct sf_exr_channel channels[CHANNELS];
    struct sf_exr_frame frame = {
        .width = SIDE, .height = SIDE, .channels = channels, .channel_count = CHANNELS, .compression = SF_EXR_ZIP};

    for (size_t c = 0; c < CHANNELS; c++)
        channels[c] = (struct sf_exr_channel){
            .name = CHANNEL_NAMES[c],
            .pixels = pixels + c,
            .pixel_stride = CHANNELS * sizeof *pixels,
            .row_stride = SIDE * CHANNELS * sizeof *pixels,
            .source = SF_EXR_FLOAT,
            .stored = SF_EXR_HALF,
        };
    must(sf_exr_write(path, &frame, &test_log));
}

static void read_golden(const char *path, float *pixels)
{
    struct sf_exr exr;

    if (sf_exr_read(path, CHANNEL_NAMES, CHANNELS, &exr, &test_log))
        fail_msg("no golden frame; SF_UPDATE_GOLDEN=1 writes it");
    assert_int_equal(exr.width, SIDE);
    assert_int_equal(exr.height, SIDE);
    for (size_t c = 0; c < CHANNELS; c++) {
        const float *plane = sf_exr_pixels(&exr, CHANNEL_NAMES[c]);

        for (size_t i = 0; i < (size_t)SIDE * SIDE; i++)
            pixels[CHANNELS * i + c] = plane[i];
    }
    sf_exr_finish(&exr);
}

/* From the scene's units to what is compared, in place. A NaN becomes -1, far from everything. */
static void show(float *pixels)
{
    const struct sf_tone tone = {.mode = SF_TONE_REINHARD};

    for (size_t i = 0; i < (size_t)SIDE * SIDE; i++) {
        float *pixel = pixels + CHANNELS * i, display[3];
        bool odd = false;

        for (size_t c = 0; c < CHANNELS; c++)
            odd = odd || !isfinite(pixel[c]);
        sf_tone_map(&tone, pixel, display);
        for (size_t c = 0; c < 3; c++)
            pixel[c] = odd ? -1 : (float)sf_srgb_encode((double)display[c]);
        pixel[3] = odd ? -1 : pixel[3];
        pixel[4] = odd ? -1 : 1 / (1 + pixel[4]);
    }
}

/* ---- comparing ---- */

/* How far `value` is from what `golden` holds of this channel around (x, y). */
static double distance_around(const float *golden, int x, int y, size_t channel, float value)
{
    float least = INFINITY, greatest = -INFINITY;

    for (int v = y > 0 ? y - 1 : 0; v <= y + 1 && v < SIDE; v++)
        for (int u = x > 0 ? x - 1 : 0; u <= x + 1 && u < SIDE; u++) {
            float there = golden[CHANNELS * ((size_t)v * SIDE + (size_t)u) + channel];

            least = there < least ? there : least;
            greatest = there > greatest ? there : greatest;
        }
    return fmax(0, fmax((double)(least - value), (double)(value - greatest)));
}

struct difference {
    double mean, each; /* of the worst channel */
    size_t channel;    /* of `each` */
    int x, y;
};

static struct difference compare(const float *golden, const float *found)
{
    struct difference worst = {0};

    for (size_t c = 0; c < CHANNELS; c++) {
        double sum = 0;

        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                size_t at = CHANNELS * ((size_t)y * SIDE + (size_t)x) + c;
                double around = distance_around(golden, x, y, c, found[at]);

                sum += fabs((double)found[at] - (double)golden[at]);
                if (around > worst.each)
                    worst = (struct difference){worst.mean, around, c, x, y};
            }
        worst.mean = fmax(worst.mean, sum / (SIDE * SIDE));
    }
    return worst;
}

static uint8_t level(double value)
{
    return (uint8_t)lround(255 * fmin(fmax(value, 0), 1));
}

/* Golden, found, and ten times the difference; where colours agree, the difference of alpha and depth shows as grey. */
static void write_difference(const char *name, const float *golden, const float *found, char path[1024])
{
    const char *folder = getenv("SF_IMAGE_OUT");
    const uint32_t width = 3 * SIDE * ZOOM, height = SIDE * ZOOM;
    uint8_t *bytes = calloc((size_t)width * height, 3), *to = bytes;

    assert_non_null(bytes);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++, to += 3) {
            size_t at = CHANNELS * (y / ZOOM * (size_t)SIDE + x / ZOOM % SIDE);
            double others = fmax(fabs((double)golden[at + 3] - (double)found[at + 3]),
                                 fabs((double)golden[at + 4] - (double)found[at + 4]));

            for (size_t c = 0; c < 3; c++) {
                double a = (double)golden[at + c], b = (double)found[at + c];
                uint32_t panel = x / (SIDE * ZOOM);

                to[c] = level(panel == 0 ? a : panel == 1 ? b : 10 * fmax(fabs(a - b), others));
            }
        }
    snprintf(path, 1024, "%s/%s-difference.png", folder ? folder : ".", name);
    must(sf_png_write(
        path, &(struct sf_png_frame){.width = width, .height = height, .channels = 3, .bits = 8, .pixels = bytes},
        &test_log));
    free(bytes);
}

static void test_picture(void **state)
{
    const struct picture *picture = *state;
    const char *update = getenv("SF_UPDATE_GOLDEN");
    size_t bytes = (size_t)SIDE * SIDE * CHANNELS * sizeof(float);
    float *golden = malloc(bytes), *found = malloc(bytes);
    char path[1024], name[128];
    struct difference difference;

    assert_non_null(golden);
    assert_non_null(found);
    render(picture, found);
    snprintf(name, sizeof name, "tests/image/golden/%s.exr", picture->name);
    in_source(path, name);
    if (update && strcmp(update, "1") == 0)
        write_golden(path, found);
    read_golden(path, golden);
    show(golden);
    show(found);
    difference = compare(golden, found);
    printf("  %s: mean difference %.5f, greatest %.5f\n", picture->name, difference.mean, difference.each);
    if (difference.mean > MEAN_MAX || difference.each > EACH_MAX) {
        write_difference(picture->name, golden, found, path);
        fail_msg("%s: mean difference %.5f (at most %.5f), greatest %.5f (at most %.5f) in %s at (%d, %d): see %s",
                 picture->name, difference.mean, MEAN_MAX, difference.each, EACH_MAX, CHANNEL_NAMES[difference.channel],
                 difference.x, difference.y, path);
    }
    free(golden);
    free(found);
}

int main(void)
{
    const struct sf_device_options options = {.validate = true};
    struct CMUnitTest tests[SF_COUNT(pictures)];
    enum sf_status status = sf_device_create(&options, &test_log, &device);
    int failed;

    if (status)
        return status == SF_ERROR_DEVICE ? SKIP : 1;
    for (size_t i = 0; i < SF_COUNT(pictures); i++)
        tests[i] = (struct CMUnitTest){
            .name = pictures[i].name, .test_func = test_picture, .initial_state = (void *)&pictures[i]};
    failed = cmocka_run_group_tests(tests, NULL, NULL);
    sf_device_destroy(&device);
    return failed;
}
