/* Thick smoke against closed forms and properties, through the public interface, with validation. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "sfumato/sfumato.h"

static const double SF_PI = 3.14159265358979323846;
static struct sf_device *device;

static void write_log(void *user, enum sf_log_level level, const char *message)
{
    (void)user;
    if (level <= SF_LOG_WARNING)
        fprintf(stderr, "%s\n", message);
}
static const struct sf_log test_log = {.write = write_log, .level = SF_LOG_WARNING};

/* Renders frame 0 of a scene given as JSON, with AOVs, and hands it to `check`. */
static void with_frame(const char *json, uint32_t width, uint32_t height, void (*check)(const struct sf_frame *frame))
{
    struct sf_scene *scene = NULL;
    struct sf_renderer *renderer = NULL;
    struct sf_frame frame;
    uint64_t ticket = 0;
    assert_int_equal(sf_scene_parse("test", json, strlen(json), NULL, 0, &test_log, &scene), SF_OK);
    const struct sf_renderer_options options = {
        .width = width, .height = height, .aovs = SF_AOV_SMOKE | SF_AOV_DEPTHS, .float_color = true};
    assert_int_equal(sf_renderer_create(device, scene, &options, &test_log, &renderer), SF_OK);
    assert_int_equal(sf_renderer_render(renderer, 0, &ticket), SF_OK);
    assert_int_equal(sf_renderer_wait(renderer, ticket, &frame), SF_OK);
    check(&frame);
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
    assert_int_equal(sf_device_validation_messages(device), 0);
}

#define SPHERES(camera, list)                                                                                          \
    "{\"method\":\"thick\",\"thick\":{\"resolution\":\"full\",\"detail\":0,\"steps\":8},"                              \
    "\"camera\":{" camera "},\"medium\":{\"albedo\":[1,1,1],\"g\":0},"                                                 \
    "\"lights\":[{\"type\":\"directional\",\"direction\":[-1,-1,0],\"intensity\":3}],"                                 \
    "\"emitters\":[{\"type\":\"list\",\"still\":true,\"particles\":[" list "]}]}"

/* Optical depth of the ray through a pixel's middle for spheres (x, y, z, r, extinction) seen from (0, 0, 4) along -z,
 * vertical field of view 40 deg. */
static double optical_depth(const struct sf_frame *frame, uint32_t x, uint32_t y, const double (*spheres)[5],
                            size_t count, double eye_z)
{
    double tangent = tan(20 * SF_PI / 180);
    double ray[3] = {((x + 0.5) / frame->width * 2 - 1) * tangent * frame->width / frame->height,
                     (1 - (y + 0.5) / frame->height * 2) * tangent, -1};
    double length = sqrt(ray[0] * ray[0] + ray[1] * ray[1] + 1), sum = 0;
    for (size_t i = 0; i < count; i++) {
        double to[3] = {spheres[i][0], spheres[i][1], spheres[i][2] - eye_z}, b = 0, c = 0;
        for (int k = 0; k < 3; k++) {
            b += ray[k] / length * to[k];
            c += to[k] * to[k];
        }
        double square = spheres[i][3] * spheres[i][3] - (c - b * b);
        if (square > 0) {
            double near = fmax(b - sqrt(square), 0.01 * length), far = b + sqrt(square);
            sum += far > near ? spheres[i][4] * (far - near) : 0;
        }
    }
    return sum;
}

static void compare_transmittance(const struct sf_frame *frame, const double (*spheres)[5], size_t count, double eye_z)
{
    double worst = 0;
    uint32_t smoky = 0;
    for (uint32_t y = 0; y < frame->height; y++)
        for (uint32_t x = 0; x < frame->width; x++) {
            const float *depths = frame->smoke_depths + 4 * ((size_t)y * frame->width + x);
            double truth = exp(-optical_depth(frame, x, y, spheres, count, eye_z));
            worst = fmax(worst, fabs(truth - (double)depths[3]));
            smoky += truth < 1;
            if (depths[2] > 0)
                assert_true(depths[0] <= depths[1]);
        }
    printf("  worst transmittance error %.2e over %u smoky pixels\n", worst, smoky);
    assert_true(smoky > 100);
    assert_true(worst < 1e-4);
}

static const double one[][5] = {{0, 0, 0, 1, 2}};
static void check_one(const struct sf_frame *frame)
{
    compare_transmittance(frame, one, 1, 4);
}

static void test_sphere_transmittance(void **state)
{
    (void)state;
    with_frame(SPHERES("\"eye\":[0,0,4],\"target\":[0,0,0],\"fov\":40,\"near\":0.01",
                       "{\"centre\":[0,0,0],\"radius\":1,\"extinction\":2}"),
               160, 120, check_one);
}

static const double three[][5] = {{-0.3, 0.1, 0, 0.8, 1.5}, {0.5, -0.2, 1.0, 0.6, 3}, {0.2, 0.4, -2, 1.1, 0.7}};
static void check_three(const struct sf_frame *frame)
{
    compare_transmittance(frame, three, 3, 4);
}

static void test_overlapping_spheres_add(void **state)
{
    (void)state;
    with_frame(SPHERES("\"eye\":[0,0,4],\"target\":[0,0,0],\"fov\":40,\"near\":0.01",
                       "{\"centre\":[-0.3,0.1,0],\"radius\":0.8,\"extinction\":1.5},"
                       "{\"centre\":[0.5,-0.2,1.0],\"radius\":0.6,\"extinction\":3},"
                       "{\"centre\":[0.2,0.4,-2],\"radius\":1.1,\"extinction\":0.7}"),
               161, 119, check_three);
}

static const double around[][5] = {{0, 0, 0, 1, 0.8}, {0.2, 0.1, -3, 0.7, 1}};
static void check_inside(const struct sf_frame *frame)
{
    compare_transmittance(frame, around, 2, 0.5);
}

static void test_camera_inside_a_sphere(void **state)
{
    (void)state;
    with_frame(SPHERES("\"eye\":[0,0,0.5],\"target\":[0,0,-1],\"fov\":40,\"near\":0.01",
                       "{\"centre\":[0,0,0],\"radius\":1,\"extinction\":0.8},"
                       "{\"centre\":[0.2,0.1,-3],\"radius\":0.7,\"extinction\":1}"),
               120, 120, check_inside);
}

/* A thin sphere of albedo 1 scatters p E tau where nothing shadows it: radiance is known to first order in tau. The eye
 * looks along -z; a light that travels along +z comes towards it, which is forward scattering. */
static double expected_phase;
static void check_thin(const struct sf_frame *frame)
{
    const double thin[][5] = {{0, 0, 0, 1, 1e-3}};
    size_t middle = (size_t)(frame->height / 2) * frame->width + frame->width / 2;
    double tau = optical_depth(frame, frame->width / 2, frame->height / 2, thin, 1, 4);
    double truth = 3 * tau * expected_phase; /* intensity 3 */
    const uint16_t *half = frame->smoke + 4 * middle;
    double found = ldexp((double)((half[0] & 1023) | 1024), (half[0] >> 10) - 25);
    printf("  thin sphere: radiance %.6g, closed form %.6g\n", found, truth);
    assert_true(fabs(found - truth) < 0.01 * truth);
}

#define THIN(g, direction)                                                                                             \
    "{\"method\":\"thick\",\"thick\":{\"resolution\":\"full\",\"detail\":0,\"octaves\":1,"                             \
    "\"ambient\":0},"                                                                                                  \
    "\"camera\":{\"eye\":[0,0,4],\"target\":[0,0,0],\"fov\":40,\"near\":0.01},\"medium\":{\"albedo\":[1,1,1],\"g\":" g \
    "},"                                                                                                               \
    "\"lights\":[{\"type\":\"directional\",\"direction\":" direction ",\"intensity\":3}],"                             \
    "\"emitters\":[{\"type\":\"list\",\"still\":true,\"particles\":[{\"centre\":[0,0,0],\"radius\":1,\"extinction\":"  \
    "0.001}]}]}"

static void test_thin_sphere_radiance(void **state)
{
    (void)state;
    expected_phase = 1 / (4 * SF_PI);
    with_frame(THIN("0", "[-1,-1,0]"), 101, 101, check_thin);
    const double g = 0.6;
    expected_phase = (1 - g * g) / (4 * SF_PI * pow(1 + g * g - 2 * g, 1.5));
    with_frame(THIN("0.6", "[0,0,1]"), 101, 101, check_thin);
    expected_phase = (1 - g * g) / (4 * SF_PI * pow(1 + g * g + 2 * g, 1.5));
    with_frame(THIN("0.6", "[0,0,-1]"), 101, 101, check_thin);
}

static int setup(void **state)
{
    (void)state;
    const struct sf_device_options options = {.validate = true};
    enum sf_status status = sf_device_create(&options, &test_log, &device);
    if (status == SF_ERROR_DEVICE)
        exit(77);
    return status;
}

static int teardown(void **state)
{
    (void)state;
    sf_device_destroy(&device);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sphere_transmittance),
        cmocka_unit_test(test_overlapping_spheres_add),
        cmocka_unit_test(test_camera_inside_a_sphere),
        cmocka_unit_test(test_thin_sphere_radiance),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
