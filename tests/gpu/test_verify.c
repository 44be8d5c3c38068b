/* verify on a device: its numbers for one ball of smoke against a direct computation, and numbers that are none found where
 * they are made; with validation. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "app/verify/verify.h"
#include "gpu/shaders.h"
#include "sfumato/sfumato.h"

enum { SIDE = 48, STEPS = 1500 };

static const double PI = 3.14159265358979323846;
static struct sf_device *device;
static char last_message[1024];

static void write_log(void *user, enum sf_log_level level, const char *message)
{
    (void)user;
    if (level <= SF_LOG_WARNING)
        snprintf(last_message, sizeof last_message, "%s", message);
}
static const struct sf_log test_log = {.write = write_log, .level = SF_LOG_WARNING};

static const struct sf_renderer_options options = {.width = SIDE,
                                                   .height = SIDE,
                                                   .float_color = true,
                                                   .float_aovs = true,
                                                   .aovs = SF_AOV_SMOKE | SF_AOV_DEPTHS,
                                                   .particles = true};

struct shot {
    struct sf_scene *scene;
    struct sf_renderer *renderer;
    struct sf_frame frame;
};

static struct shot draw(void)
{
    struct shot shot = {NULL, NULL, {0}};
    char path[1024];
    uint64_t ticket;

    snprintf(path, sizeof path, "%s/scenes/truth/one-puff.json", getenv("SF_SOURCE_ROOT"));
    if (sf_scene_load(path, NULL, 0, &test_log, &shot.scene) != SF_OK ||
        sf_renderer_create(device, shot.scene, &options, &test_log, &shot.renderer) != SF_OK ||
        sf_renderer_render(shot.renderer, 0, &ticket) != SF_OK ||
        sf_renderer_wait(shot.renderer, ticket, &shot.frame) != SF_OK)
        fail_msg("%s", last_message);
    return shot;
}

static void drop(struct shot *shot)
{
    sf_renderer_destroy(&shot->renderer);
    sf_scene_destroy(&shot->scene);
    assert_int_equal(sf_device_validation_messages(device), 0);
}

/* ---- one ball, by hand ---- */

/* How far a ray from x along the unit vector w goes inside the unit ball about (0, 1, 0), and where it enters. */
static double chord(const double x[3], const double w[3], double *enters)
{
    const double m[3] = {x[0], x[1] - 1, x[2]};
    double b = 0, c = -1;

    for (int i = 0; i < 3; i++) {
        b += m[i] * w[i];
        c += m[i] * m[i];
    }
    if (b * b <= c)
        return 0;
    *enters = fmax(0, -b - sqrt(b * b - c));
    return -b + sqrt(b * b - c) - *enters;
}

/* As scenes/truth/one-puff.json has it: extinction 2, albedo 0.95, even scattering, irradiance 9 along (-0.6, -1, -0.5),
 * light of (0.06, 0.075, 0.1) from everywhere, the eye at (0, 1, 6) looking along -z with 40 degrees. Equal steps. */
static double by_hand(uint32_t i, uint32_t j, double radiance[3])
{
    static const double around[3] = {0.06, 0.075, 0.1}, eye[3] = {0, 1, 6};
    double tangent = tan(20 * PI / 180), light[3] = {0.6, 1, 0.5}, w[3], enters = 0, unused, way;
    double length = sqrt(0.36 + 1 + 0.25), size;

    w[0] = (2 * (i + 0.5) / SIDE - 1) * tangent;
    w[1] = (1 - 2 * (j + 0.5) / SIDE) * tangent;
    w[2] = -1;
    size = sqrt(w[0] * w[0] + w[1] * w[1] + 1);
    for (int c = 0; c < 3; c++) {
        w[c] /= size;
        light[c] /= length;
        radiance[c] = 0;
    }
    way = chord(eye, w, &enters);
    for (int k = 0; k < STEPS; k++) {
        double t = way * (k + 0.5) / STEPS, x[3];

        for (int c = 0; c < 3; c++)
            x[c] = eye[c] + (enters + t) * w[c];
        double lit = 9 / (4 * PI) * exp(-2 * chord(x, light, &unused));
        for (int c = 0; c < 3; c++)
            radiance[c] += 2 * 0.95 * (lit + around[c]) * exp(-2 * t) * way / STEPS;
    }
    return exp(-2 * way);
}

static void assert_share(double found, double want, double share, const char *what)
{
    printf("  %s: %.6g, by hand %.6g\n", what, found, want);
    if (!(fabs(found - want) <= share * fabs(want)))
        fail_msg("%s is %.9g, not %.9g", what, found, want);
}

/* Every number that the table shows, from sums made here. */
static void test_numbers(void **state)
{
    struct shot shot = draw();
    const struct sf_layers layers = {SIDE, SIDE, shot.frame.smoke_float, shot.frame.smoke_depths};
    struct sf_reference *reference = NULL;
    struct sf_reference_picture *picture = NULL;
    struct sf_errors errors;
    double squares = 0, power = 0, difference = 0, light = 0, t_sum = 0, t_max = 0, alpha_max = 0;

    (void)state;
    for (uint32_t y = 0; y < SIDE; y++) {
        for (uint32_t x = 0; x < SIDE; x++) {
            const float *smoke = &layers.smoke[4 * (y * SIDE + x)];
            double radiance[3], through = by_hand(x, y, radiance);
            double t_off = fabs((double)layers.depths[4 * (y * SIDE + x) + 3] - through);

            for (int c = 0; c < 3; c++) {
                squares += pow((double)smoke[c] - radiance[c], 2);
                power += radiance[c] * radiance[c];
                difference += (double)smoke[c] - radiance[c];
                light += radiance[c];
            }
            t_sum += t_off;
            t_max = fmax(t_max, t_off);
            alpha_max = fmax(alpha_max, fabs(1 - (double)smoke[3] - through));
        }
    }
    assert_int_equal(sf_reference_create(shot.scene, &shot.frame, &(struct sf_reference_options){.tolerance = 1e-6},
                                         &test_log, &reference),
                     SF_OK);
    assert_int_equal(sf_reference_render(reference, NULL, SIDE, SIDE, 1, NULL, NULL, &picture), SF_OK);
    assert_int_equal(sf_errors_measure(&layers, picture, 1, &errors), SF_OK);
    assert_int_equal(errors.pixels, SIDE * SIDE);
    assert_int_equal(errors.not_finite, 0);
    assert_true(errors.smoky > SIDE * SIDE / 20);
    assert_share(errors.relative_mse, squares / power, 1e-3, "relative MSE");
    assert_share(errors.bias, difference / light, 1e-3, "bias");
    assert_share(errors.alpha_max, alpha_max, 1e-2, "largest error of 1 - alpha");
    /* Of float's own size: the reference's are floats too. */
    printf("  T: mean %.3g, max %.3g; by hand %.3g, %.3g\n", errors.transmittance_mean, errors.transmittance_max,
           t_sum / (SIDE * SIDE), t_max);
    assert_true(fabs(errors.transmittance_mean - t_sum / (SIDE * SIDE)) < 1e-7);
    assert_true(fabs(errors.transmittance_max - t_max) < 1e-6);
    sf_reference_picture_destroy(&picture);
    sf_reference_destroy(&reference);
    drop(&shot);
}

/* ---- numbers that are none ---- */

static struct sf_verify_fault trace_with(const char *shader, bool thorough)
{
    const struct sf_shader *other = shader ? sf_shader_find(shader) : NULL;
    struct sf_verify_fault fault;
    struct shot shot;

    assert_int_equal(
        sf_device_set_shader(device, "scene/sky.frag", other ? other->words : NULL, other ? other->bytes : 0), SF_OK);
    shot = draw();
    assert_int_equal(sf_verify_trace(shot.renderer, &options, &shot.frame, thorough, &fault), SF_OK);
    drop(&shot);
    assert_int_equal(sf_device_set_shader(device, "scene/sky.frag", NULL, 0), SF_OK);
    return fault;
}

static void test_trace(void **state)
{
    struct sf_verify_fault fault = trace_with(NULL, true);

    (void)state;
    assert_false(fault.found);
    for (int thorough = 0; thorough < 2; thorough++) {
        fault = trace_with("test/nan.frag", thorough);
        assert_true(fault.found && isnan(fault.value));
        assert_string_equal(fault.image, "depth");
        assert_string_equal(fault.pass, "scene.sky");
        assert_string_equal(fault.others, "");
        assert_int_equal(fault.x, 5);
        assert_int_equal(fault.y, 7);
    }
    /* The picture is written by more passes than this one: all of them are named. */
    fault = trace_with("test/inf.frag", false);
    assert_true(fault.found && isinf(fault.value));
    assert_string_equal(fault.image, "color");
    assert_non_null(strstr(fault.others, "scene.sky"));
    assert_string_not_equal(fault.pass, "scene.sky"); /* the smoke is laid over it later */
    assert_int_equal(fault.x, 5);
    assert_int_equal(fault.y, 7);
}

static int setup(void **state)
{
    (void)state;
    enum sf_status status =
        sf_device_create(&(struct sf_device_options){.validate = true, .no_cache = true}, &test_log, &device);
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
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_numbers), cmocka_unit_test(test_trace)};
    return cmocka_run_group_tests(tests, setup, teardown);
}
