/* Paths of any number of scatterings: against what must come out, and against the integral of one scattering. Estimates
 * are held to four of their own standard errors; with fixed seeds they are the same on every run. */
#include "truth_kit.h"

#include "truth/scatter.h"

#define assert_estimate(estimate, channel, expected) assert_estimate_at(estimate, channel, expected, __LINE__)
static void assert_estimate_at(const struct sf_truth_estimate *estimate, int channel, double expected, int line)
{
    double error = sf_truth_estimate_error(estimate, channel);

    if (!(fabs(estimate->mean[channel] - expected) <= 4 * error + 1e-6 * expected))
        fail_msg("line %d: channel %d is %g +- %g, not %g", line, channel, estimate->mean[channel], error, expected);
}

static struct sf_truth_estimate estimate_of(const struct sf_truth *truth, const double origin[3],
                                            const double direction[3], double to, uint32_t paths, uint32_t orders)
{
    const struct sf_truth_paths wanted = {.pixel = 7, .count = paths, .orders = orders};
    struct sf_truth_estimate estimate = {0};
    struct sf_truth_scatter *scatter = NULL;

    assert_int_equal(sf_truth_scatter_create(truth, NULL, &scatter), SF_OK);
    assert_int_equal(sf_truth_scatter_ray(scatter, origin, direction, 0, to, &wanted, &estimate), SF_OK);
    assert_int_equal(estimate.paths, paths);
    sf_truth_scatter_destroy(&scatter);
    sf_truth_scatter_destroy(&scatter);
    return estimate;
}

/* Smoke that takes nothing, in light that is the same from everywhere, cannot be seen. */
static void test_white_furnace(void **state)
{
    static const double gs[] = {0, 0.6, -0.5};
    struct sf_scene *scene =
        parse("{\"environment\": {\"type\": \"color\", \"color\": [0.5, 1, 2]}, \"medium\": {\"albedo\": [1, 1, 1]}}");

    uint64_t meetings = 0;

    (void)state;
    for (uint32_t i = 0; i < SF_COUNT(gs); i++) {
        struct cloud cloud;

        scene->medium.g = (float)gs[i];
        cloud_random(&cloud, scene, 40, 60 + i, 0.4, 6);
        struct sf_truth *truth = truth_of(scene, &cloud.medium, 1e-4);
        for (uint32_t ray = 0; ray < 4; ray++) {
            double o[3], d[3];

            random_direction(61, ray, i, d);
            for (int k = 0; k < 3; k++)
                o[k] = ray == 3 ? 0 : -3 * d[k];
            struct sf_truth_estimate estimate = estimate_of(truth, o, d, INFINITY, 4000, 0);
            double through = trace(truth, o, d, 0, INFINITY).transmittance;
            for (int c = 0; c < 3; c++)
                assert_estimate(&estimate, c, (1 - through) * 0.5 * (1 << c));
            meetings += estimate.meetings;
        }
        sf_truth_destroy(&truth);
        cloud_free(&cloud);
    }
    assert_true(meetings > 40000);
    /* Nothing shines through this one: every single path brings the environment. */
    const struct sf_particle ball = ball_at(0, 0, 0, 1, 40);
    const double o[3] = {0, 0, -3}, d[3] = {0, 0, 1};
    struct cloud cloud;
    scene->medium.g = 0;
    cloud_make(&cloud, scene, &ball, 1);
    struct sf_truth *truth = truth_of(scene, &cloud.medium, 1e-4);
    struct sf_truth_estimate estimate = estimate_of(truth, o, d, INFINITY, 300, 0);
    assert_near(estimate.mean[1], 1, 1e-6);
    assert_near(estimate.spread[1], 0, 1e-9);
    assert_true(estimate.meetings > 10 * estimate.paths);
    sf_truth_destroy(&truth);
    cloud_free(&cloud);
    sf_scene_destroy(&scene);
}

/* Smoke that takes light and glows as much as it takes cannot be seen either. Its paths are faint from the second meeting on. */
static void test_grey_furnace(void **state)
{
    struct sf_scene *scene = parse("{\"environment\": {\"type\": \"color\", \"color\": [1, 1, 1]}, \"medium\": "
                                   "{\"albedo\": [0.3, 0.3, 0.3], \"emission\": [0.7, 0.7, 0.7], \"g\": 0.3}}");
    const struct sf_particle ball = ball_at(0, 0, 0, 1, 20);
    const double o[3] = {0, 0, -3}, d[3] = {0, 0, 1};
    struct cloud cloud;

    (void)state;
    cloud_make(&cloud, scene, &ball, 1);
    struct sf_truth *truth = truth_of(scene, &cloud.medium, 1e-4);
    struct sf_truth_estimate estimate = estimate_of(truth, o, d, INFINITY, 20000, 0);
    assert_estimate(&estimate, 0, 1);
    assert_true(sf_truth_estimate_error(&estimate, 0) < 0.002);
    sf_truth_destroy(&truth);
    cloud_free(&cloud);
    sf_scene_destroy(&scene);
}

/* One scattering, no environment: the integral of truth.h. */
static void test_single(void **state)
{
    struct sf_scene *scene = parse(
        "{\"lights\": [{\"type\": \"directional\", \"direction\": [1, -1, -0.3], \"intensity\": 2}, {\"type\": "
        "\"spot\", \"position\": [-2, 2, 1], \"direction\": [2, -2, -1], \"inner\": 15, \"outer\": 30, \"intensity\": "
        "9, \"color\": [1, 0.3, 0.1]}], \"objects\": [{\"type\": \"sphere\", \"position\": [-1.2, 1.4, 0.4], "
        "\"radius\": "
        "0.4}], \"medium\": {\"g\": 0.4, \"albedo\": [0.9, 0.6, 0.04], \"emission\": [0.1, 0.02, 0]}, "
        "\"environment\": {\"type\": \"color\", \"color\": [0, 0, 0]}}");
    struct cloud cloud;
    double worst = 0;

    (void)state;
    cloud_random(&cloud, scene, 60, 70, 0.4, 2);
    struct sf_truth *truth = truth_of(scene, &cloud.medium, 1e-5);
    for (uint32_t ray = 0; ray < 6; ray++) {
        double o[3], d[3];

        random_direction(71, ray, 0, d);
        for (int k = 0; k < 3; k++)
            o[k] = -2.5 * d[k] + 0.3 * random_of(72, ray, (uint32_t)k);
        struct sf_truth_result result = trace(truth, o, d, 0, 3);
        struct sf_truth_estimate estimate = estimate_of(truth, o, d, 3, 20000, 1);
        for (int c = 0; c < 3; c++) {
            assert_estimate(&estimate, c, result.radiance[c]);
            worst = fmax(worst, sf_truth_estimate_error(&estimate, c) / result.radiance[c]);
        }
    }
    print_message("largest standard error of 20,000 paths: %.2g of the radiance\n", worst);
    assert_true(worst < 0.02);
    sf_truth_destroy(&truth);
    cloud_free(&cloud);
    sf_scene_destroy(&scene);
}

/* One scattering under a sky with g = 0.7, against a plain sum over distance and direction. */
static void test_sky(void **state)
{
    enum { DISTANCES = 60, RISES = 60, TURNS = 120 };
    struct sf_scene *scene = parse("{\"environment\": {\"type\": \"sky\", \"zenith\": [3, 1, 0.5], \"horizon\": [0.1, "
                                   "0.5, 1], \"ground\": [0, 0, 0]}, \"medium\": {\"albedo\": [1, 1, 1], \"g\": 0.7}}");
    const struct sf_particle ball = ball_at(0, 0, 0, 1, 0.8);
    const double o[3] = {0.3, -3, 0.2}, d[3] = {0, 1, 0}, half = sqrt(1 - 0.13), g = 0.7f;
    double sum[3] = {0};
    struct cloud cloud;

    (void)state;
    cloud_make(&cloud, scene, &ball, 1);
    struct sf_truth *truth = truth_of(scene, &cloud.medium, 1e-5);
    for (int i = 0; i < DISTANCES; i++) {
        double t = 3 - half + 2 * half * (i + 0.5) / DISTANCES, x[3] = {0.3, -3 + t, 0.2};

        for (int j = 0; j < RISES * TURNS; j++) {
            double y = 2 * (j / TURNS + 0.5) / RISES - 1, turn = 2 * PI * (j % TURNS + 0.5) / TURNS;
            double l[3] = {sqrt(1 - y * y) * cos(turn), y, sqrt(1 - y * y) * sin(turn)}, end[3], part;
            float rgb[3];

            for (int k = 0; k < 3; k++)
                end[k] = x[k] + 3 * l[k];
            part = 4 * PI / (RISES * TURNS) * (1 - g * g) / (4 * PI * pow(1 + g * g - 2 * g * y, 1.5));
            part *= exp(-cloud.medium.optical_depth(cloud.medium.self, x, end) - 0.8f * (t - 3 + half)) * 0.8f * 2 *
                    half / DISTANCES;
            sf_environment_radiance(&scene->environment, (float[3]){(float)l[0], (float)l[1], (float)l[2]}, rgb);
            for (int c = 0; c < 3; c++)
                sum[c] += part * rgb[c];
        }
    }
    struct sf_truth_estimate estimate = estimate_of(truth, o, d, INFINITY, 40000, 1);
    for (int c = 0; c < 3; c++) {
        assert_estimate(&estimate, c, sum[c]);
        assert_true(sf_truth_estimate_error(&estimate, c) < 0.02 * sum[c]);
    }
    sf_truth_destroy(&truth);
    cloud_free(&cloud);
    sf_scene_destroy(&scene);
}

/* Chandrasekhar's H: what a half space of isotropic scatterers of that albedo sends back, all orders together. */
static double half_space(double albedo, double mu, double mu0)
{
    enum { POINTS = 400 };
    double h[POINTS], at[2] = {mu, mu0}, answer[2] = {0};

    for (int i = 0; i < POINTS; i++)
        h[i] = 1;
    for (int turn = 0; turn <= 100; turn++) {
        double next[POINTS];

        for (int i = 0; i < POINTS + 2; i++) {
            double m = i < POINTS ? (i + 0.5) / POINTS : at[i - POINTS], sum = 0;

            for (int k = 0; k < POINTS; k++)
                sum += (k + 0.5) / POINTS * h[k] / (m + (k + 0.5) / POINTS) / POINTS;
            sum = 1 / (sqrt(1 - albedo) + albedo / 2 * sum);
            if (i < POINTS)
                next[i] = sum;
            else
                answer[i - POINTS] = sum;
        }
        memcpy(h, next, sizeof h);
    }
    return albedo / (4 * PI) * mu0 / (mu + mu0) * answer[0] * answer[1];
}

static void test_half_space(void **state)
{
    struct sf_scene *scene =
        parse("{\"lights\": [{\"type\": \"directional\", \"direction\": [0.6, 0, 0.8], \"intensity\": "
              "1}], \"environment\": {\"type\": \"color\", \"color\": [0, 0, 0]}}");
    const struct slab slab = {.depth = 20, .extinction = 2, .albedo = {0.95, 0.8, 0.3}};
    const struct sf_truth_medium medium = slab_medium(&slab, 0);
    struct sf_truth *truth = truth_of(scene, &medium, 1e-4);
    const double o[3] = {0, 0, -1}, d[3] = {0, 0.5, sqrt(0.75)};
    struct sf_truth_estimate estimate;

    (void)state;
    estimate = estimate_of(truth, o, d, INFINITY, 20000, 0);
    for (int c = 0; c < 3; c++) {
        assert_estimate(&estimate, c, half_space(slab.albedo[c], d[2], 0.8f));
        assert_true(sf_truth_estimate_error(&estimate, c) < 0.02 * estimate.mean[c]);
    }
    sf_truth_destroy(&truth);
    sf_scene_destroy(&scene);
}

/* Surfaces send nothing: a box around white smoke leaves it in the dark. */
static void test_enclosed(void **state)
{
    struct sf_scene *scene =
        parse("{\"environment\": {\"type\": \"color\", \"color\": [1, 1, 1]}, \"objects\": [{\"type\": "
              "\"box\", \"size\": [4, 4, 4]}]}");
    const double o[3] = {0, 0, -1.5}, d[3] = {0, 0, 1};
    struct cloud cloud;

    (void)state;
    cloud_random(&cloud, scene, 20, 75, 0.4, 4);
    struct sf_truth *truth = truth_of(scene, &cloud.medium, 1e-4);
    struct sf_truth_estimate estimate = estimate_of(truth, o, d, 3.5, 500, 0);
    assert_true(estimate.mean[0] == 0 && estimate.meetings > 0);
    sf_truth_destroy(&truth);
    cloud_free(&cloud);
    sf_scene_destroy(&scene);
}

/* In one go or in parts, on one thread or on many: the same paths, and the same bits. */
static void test_same_bits(void **state)
{
    enum { WIDTH = 9, HEIGHT = 7, PIXELS = WIDTH * HEIGHT };
    struct sf_scene *scene =
        parse("{\"camera\": {\"eye\": [0, 0.5, 3], \"target\": [0, 0, 0]}, \"lights\": [{\"type\": "
              "\"directional\", \"direction\": [1, -1, 0]}]}");
    static struct sf_truth_estimate whole[PIXELS], parts[PIXELS];
    struct sf_truth_scatter *scatter = NULL;
    struct sf_truth_work work = {.threads = 1};
    struct sf_camera_pose pose;
    struct cloud cloud;
    int differ = 0;

    (void)state;
    cloud_random(&cloud, scene, 30, 76, 0.4, 3);
    struct sf_truth *truth = truth_of(scene, &cloud.medium, 1e-4);
    assert_int_equal(sf_truth_scatter_create(truth, NULL, &scatter), SF_OK);
    sf_scene_camera(scene, 0, &pose);
    assert_int_equal(sf_truth_scatter_render(scatter, &pose, WIDTH, HEIGHT, 0, 40, 0, &work, whole), SF_OK);
    work.threads = 3;
    for (uint32_t first = 0; first < 40; first += 10)
        assert_int_equal(sf_truth_scatter_render(scatter, &pose, WIDTH, HEIGHT, first, 10, 0, &work, parts), SF_OK);
    assert_memory_equal(whole, parts, sizeof whole);
    for (int i = 1; i < PIXELS; i++)
        differ += whole[i].mean[0] != whole[i - 1].mean[0];
    assert_true(differ > PIXELS / 2);
    assert_true(isinf(sf_truth_estimate_error(&(struct sf_truth_estimate){.paths = 1}, 0)));
    sf_truth_scatter_destroy(&scatter);
    sf_truth_destroy(&truth);
    cloud_free(&cloud);
    sf_scene_destroy(&scene);
}

static double low_bound(const void *self, const double min[3], const double max[3])
{
    return 0.5 * slab_bound(self, min, max);
}

static double no_bound(const void *self, const double min[3], const double max[3])
{
    (void)self, (void)min, (void)max;
    return NAN;
}

static void test_bad_bounds(void **state)
{
    struct sf_scene *scene = parse("{\"camera\": {\"eye\": [0, 0, 5], \"target\": [0, 0, 0]}}");
    const struct slab slab = {.depth = 1, .extinction = 3, .albedo = {1, 1, 1}};
    struct sf_truth_medium medium = slab_medium(&slab, 0);
    struct caught caught = {"", 0};
    struct sf_log log = {caught_write, &caught, SF_LOG_ERROR};
    struct sf_truth_work work = {.threads = 2, .log = &log};
    struct sf_truth_estimate estimates[16] = {0};
    struct sf_truth_scatter *scatter = NULL;
    struct sf_camera_pose pose;

    (void)state;
    sf_scene_camera(scene, 0, &pose);
    medium.bound = low_bound;
    struct sf_truth *truth = truth_of(scene, &medium, 1e-4);
    assert_int_equal(sf_truth_scatter_create(truth, &log, &scatter), SF_OK);
    assert_int_equal(sf_truth_scatter_render(scatter, &pose, 4, 4, 0, 10, 0, &work, estimates), SF_ERROR_INTERNAL);
    assert_caught(&caught, "denser than its bound");
    sf_truth_scatter_destroy(&scatter);
    sf_truth_destroy(&truth);
    medium.bound = no_bound;
    truth = truth_of(scene, &medium, 1e-4);
    assert_int_equal(sf_truth_scatter_create(truth, &log, &scatter), SF_ERROR_INTERNAL);
    assert_null(scatter);
    assert_caught(&caught, "bound is not a number");
    sf_truth_destroy(&truth);
    sf_scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_white_furnace), cmocka_unit_test(test_grey_furnace), cmocka_unit_test(test_single),
        cmocka_unit_test(test_sky),           cmocka_unit_test(test_half_space),   cmocka_unit_test(test_enclosed),
        cmocka_unit_test(test_same_bits),     cmocka_unit_test(test_bad_bounds),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
