/* verify's numbers, where they are known in closed form. */
#include "scratch.h"

#include <math.h>
#include "app/verify/metrics.h"

enum { SIDE_MOST = 32 };

/* A method's layers and a reference of equal pixels, to be changed one by one. */
struct pair {
    float smoke[SIDE_MOST * SIDE_MOST * 4], depths[SIDE_MOST * SIDE_MOST * 4];
    struct sf_reference_pixel pixels[SIDE_MOST * SIDE_MOST];
    struct sf_layers layers;
    struct sf_reference_picture reference;
};

/* L = (1, 2, 4) scaled, T = 0.5 in both. */
static void pair_fill(struct pair *pair, uint32_t width, uint32_t height, float scale)
{
    memset(pair, 0, sizeof *pair);
    pair->layers = (struct sf_layers){width, height, pair->smoke, pair->depths};
    pair->reference = (struct sf_reference_picture){.width = width, .height = height, .pixels = pair->pixels};
    for (size_t i = 0; i < (size_t)width * height; i++) {
        for (int c = 0; c < 3; c++) {
            pair->pixels[i].radiance[c] = (float)(1 << c);
            pair->smoke[4 * i + (size_t)c] = scale * (float)(1 << c);
        }
        pair->pixels[i].transmittance = pair->depths[4 * i + 3] = pair->smoke[4 * i + 3] = 0.5f;
    }
}

static struct sf_errors measure(const struct pair *pair, uint32_t stride)
{
    struct sf_errors errors;

    assert_int_equal(sf_errors_measure(&pair->layers, &pair->reference, stride, &errors), SF_OK);
    return errors;
}

static void assert_close(double a, double b)
{
    if (!(fabs(a - b) <= 1e-6 * fmax(1, fabs(b))))
        fail_msg("%.9g is not %.9g", a, b);
}

static struct pair pair;

/* A quarter too bright everywhere. */
static void test_factor(void **state)
{
    struct sf_errors errors;

    (void)state;
    pair_fill(&pair, 6, 5, 1.25f);
    errors = measure(&pair, 1);
    assert_close(errors.relative_mse, 0.0625);
    assert_close(errors.bias, 0.25);
    assert_close(errors.p99, 0.25);
    assert_close(errors.rms, sqrt(21));
    assert_close(errors.transmittance_mean, 0);
    assert_close(errors.alpha_max, 0);
    assert_int_equal(errors.pixels, 30);
    assert_int_equal(errors.smoky, 30);
    pair_fill(&pair, 6, 5, 1);
    errors = measure(&pair, 1);
    assert_true(errors.relative_mse == 0 && errors.bias == 0 && errors.p99 == 0);
}

/* Errors that cancel are no bias, but an error. */
static void test_signs(void **state)
{
    struct sf_errors errors;

    (void)state;
    pair_fill(&pair, 4, 4, 1);
    for (size_t i = 0; i < 16; i++)
        for (size_t c = 0; c < 3; c++)
            pair.smoke[4 * i + c] *= i % 2 ? 1.5f : 0.5f;
    errors = measure(&pair, 1);
    assert_close(errors.bias, 0);
    assert_close(errors.relative_mse, 0.25);
    pair_fill(&pair, 4, 4, 0.75f);
    assert_close(measure(&pair, 1).bias, -0.25);
}

/* One channel of one pixel: sums over all pixels and channels. */
static void test_one_channel(void **state)
{
    struct sf_errors errors;

    (void)state;
    pair_fill(&pair, 10, 10, 1);
    pair.smoke[4 * 42 + 1] += 3;
    errors = measure(&pair, 1);
    assert_close(errors.relative_mse, 9.0 / 2100);
    assert_close(errors.bias, 3.0 / 700);
    assert_close(errors.p99, 0); /* the worst one of a hundred is left out */
    pair.smoke[4 * 7 + 1] -= 2;
    assert_close(measure(&pair, 1).p99, 2 / sqrt(21));
}

static void test_transmittance(void **state)
{
    struct sf_errors errors;

    (void)state;
    pair_fill(&pair, 10, 4, 1);
    pair.depths[4 * 23 + 3] = 0.3f; /* (3, 2) */
    pair.depths[4 * 5 + 3] = 0.6f;
    pair.smoke[4 * 8 + 3] = 0.9f; /* 1 - alpha is 0.4 too small */
    errors = measure(&pair, 1);
    assert_close(errors.transmittance_max, 0.2);
    assert_close(errors.transmittance_mean, 0.3 / 40);
    assert_int_equal(errors.worst[0], 3);
    assert_int_equal(errors.worst[1], 2);
    assert_close(errors.alpha_max, 0.4);
    assert_close(errors.alpha_mean, 0.01);
}

/* Pixels without smoke count for transmittance, and not for the percentile. */
static void test_empty_pixels(void **state)
{
    struct sf_errors errors;

    (void)state;
    pair_fill(&pair, 10, 10, 1.5f);
    for (size_t i = 10; i < 100; i++) {
        memset(&pair.smoke[4 * i], 0, 4 * sizeof(float));
        memset(&pair.pixels[i], 0, sizeof pair.pixels[i]);
        pair.pixels[i].transmittance = pair.depths[4 * i + 3] = 1;
    }
    errors = measure(&pair, 1);
    assert_int_equal(errors.pixels, 100);
    assert_int_equal(errors.smoky, 10);
    assert_close(errors.rms, sqrt(21));
    assert_close(errors.p99, 0.5);
    assert_close(errors.relative_mse, 0.25);
    /* Smoke where the reference has none is smoke. */
    pair.smoke[4 * 50] = 0.1f;
    assert_int_equal(measure(&pair, 1).smoky, 11);
}

static void test_black(void **state)
{
    struct sf_errors errors;

    (void)state;
    pair_fill(&pair, 3, 3, 0);
    for (size_t i = 0; i < 9; i++)
        memset(pair.pixels[i].radiance, 0, sizeof pair.pixels[i].radiance);
    errors = measure(&pair, 1);
    assert_true(errors.relative_mse == 0 && errors.bias == 0 && errors.p99 == 0 && errors.rms == 0);
    assert_int_equal(errors.smoky, 9);
    pair.smoke[0] = 1;
    errors = measure(&pair, 1);
    assert_true(isinf(errors.relative_mse) && errors.relative_mse > 0 && isinf(errors.bias) && isinf(errors.p99));
    assert_int_equal(sf_goals_missed(&errors), SF_GOAL_MSE);
}

/* Left out of the sums, and counted: never passed over in silence. */
static void test_not_finite(void **state)
{
    struct sf_errors errors;

    (void)state;
    pair_fill(&pair, 5, 5, 1.25f);
    pair.smoke[4 * 3] = NAN;
    pair.smoke[4 * 9 + 3] = INFINITY;
    pair.depths[4 * 10 + 2] = -INFINITY;
    errors = measure(&pair, 1);
    assert_int_equal(errors.not_finite, 3);
    assert_int_equal(errors.pixels, 22);
    assert_close(errors.relative_mse, 0.0625);
    assert_int_equal(sf_goals_missed(&errors), SF_GOAL_MEAN | SF_GOAL_MAX | SF_GOAL_MSE);
    for (size_t i = 0; i < 25; i++)
        pair.depths[4 * i] = NAN;
    errors = measure(&pair, 1);
    assert_int_equal(errors.pixels, 0);
    assert_int_equal(sf_goals_missed(&errors), SF_GOAL_MEAN | SF_GOAL_MAX | SF_GOAL_MSE);
}

/* The method's pixel that a sparse reference's stands for. */
static void test_stride(void **state)
{
    struct sf_errors errors;

    (void)state;
    for (uint32_t side = 1; side < 12; side++)
        for (uint32_t stride = 1; stride < 5; stride++)
            assert_true(sf_errors_pixel((side - 1) / stride, stride, side) < side);
    assert_int_equal(sf_errors_pixel(2, 3, 100), 7);
    assert_int_equal(sf_errors_pixel(2, 4, 9), 8);
    pair_fill(&pair, 8, 7, 3);
    pair.reference.width = 3;  /* 8 / 3 rounded up: 1, 4, 7 */
    pair.reference.height = 3; /* 1, 4, 6 */
    for (size_t y = 0; y < 3; y++)
        for (size_t x = 0; x < 3; x++) {
            size_t at = 4 * ((y == 2 ? 6 : 3 * y + 1) * 8 + 3 * x + 1);

            for (size_t c = 0; c < 3; c++)
                pair.smoke[at + c] = (float)(1 << c);
        }
    errors = measure(&pair, 3);
    assert_int_equal(errors.pixels, 9);
    assert_true(errors.relative_mse == 0);
}

static void test_goals(void **state)
{
    struct sf_errors errors = {
        .transmittance_mean = 0.002, .transmittance_max = 0.02, .relative_mse = 0.01, .pixels = 1};

    (void)state;
    assert_int_equal(sf_goals_missed(&errors), 0);
    errors.alpha_mean = 0.0021;
    assert_int_equal(sf_goals_missed(&errors), SF_GOAL_MEAN);
    errors.alpha_max = 0.021;
    assert_int_equal(sf_goals_missed(&errors), SF_GOAL_MEAN | SF_GOAL_MAX);
    errors.relative_mse = NAN;
    assert_int_equal(sf_goals_missed(&errors), SF_GOAL_MEAN | SF_GOAL_MAX | SF_GOAL_MSE);
}

static void test_scale(void **state)
{
    static const struct {
        float factor; /* of L: what is off is (factor - 1) times the luminance 0.2126 + 2 x 0.7152 + 4 x 0.0722 */
        double scale;
    } cases[] = {{1, 1e-6}, {1.1f, 0.2}, {1.2f, 0.5}, {0.5f, 1}, {2, 2}, {3.5f, 5}, {4, 10}};
    double scale;

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        pair_fill(&pair, 4, 4, cases[i].factor);
        assert_int_equal(sf_errors_scale(&pair.layers, &pair.reference, 1, 1e-6, &scale), SF_OK);
        assert_close(scale / cases[i].scale, 1);
    }
    assert_close(sf_errors_brightness(pair.smoke, pair.pixels), 3 * (0.2126 + 2 * 0.7152 + 4 * 0.0722));
    pair.smoke[0] = NAN;
    assert_true(isnan(sf_errors_brightness(pair.smoke, pair.pixels)));
    assert_int_equal(sf_errors_scale(&pair.layers, &pair.reference, 1, 50, &scale), SF_OK);
    assert_close(scale, 50);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_factor),        cmocka_unit_test(test_signs),        cmocka_unit_test(test_one_channel),
        cmocka_unit_test(test_transmittance), cmocka_unit_test(test_empty_pixels), cmocka_unit_test(test_black),
        cmocka_unit_test(test_not_finite),    cmocka_unit_test(test_stride),       cmocka_unit_test(test_goals),
        cmocka_unit_test(test_scale),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
