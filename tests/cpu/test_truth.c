/* The reference against closed forms. */
#include "truth_kit.h"

#include "truth/inner.h"

#define DARK "\"environment\": {\"type\": \"color\", \"color\": [0, 0, 0]}"

static void test_sphere_transmittance(void **state)
{
    struct sf_scene *scene = parse("{" DARK "}");
    const struct sf_particle ball = ball_at(0.5, -0.25, 2, 1.5, 0.75);
    struct cloud cloud;

    (void)state;
    cloud_make(&cloud, scene, &ball, 1);
    struct sf_truth *truth = truth_of(scene, &cloud.medium, 1e-6);
    for (uint32_t i = 0; i < 200; i++) {
        double o[3] = {4 * random_of(1, i, 0) - 2, 4 * random_of(1, i, 1) - 2, -3}, d[3];
        double m[3], a = 0, b = 0, c = -1.5 * 1.5, chord = 0;

        for (int k = 0; k < 3; k++) /* of any length, mostly towards the sphere */
            d[k] = 3 * (2 * random_of(1, i, 2 + (uint32_t)k) - 1 + (k == 2 ? 2.0 : 0));
        m[0] = o[0] - 0.5, m[1] = o[1] + 0.25, m[2] = o[2] - 2;
        for (int k = 0; k < 3; k++) {
            a += d[k] * d[k];
            b += 2 * m[k] * d[k];
            c += m[k] * m[k];
        }
        if (b * b > 4 * a * c)
            chord = sqrt(b * b - 4 * a * c) / sqrt(a);
        struct sf_truth_result result = trace(truth, o, d, 0, INFINITY);
        assert_near(result.transmittance, exp(-0.75 * chord), 1e-12);
        assert_near(result.optical_depth, 0.75 * chord, 1e-12);
        if (chord > 0) {
            assert_near(result.near, (-b - chord * sqrt(a)) / (2 * a), 1e-9);
            assert_near(result.far, (-b + chord * sqrt(a)) / (2 * a), 1e-9);
        } else {
            assert_true(result.near > result.far);
        }
        /* Half of it: up to the point nearest to the centre. */
        assert_near(trace(truth, o, d, 0, -b / (2 * a)).optical_depth, 0.375 * chord, 1e-12);
    }
    sf_truth_destroy(&truth);
    cloud_free(&cloud);
    sf_scene_destroy(&scene);
}

static void test_slab_transmittance(void **state)
{
    struct sf_scene *scene = parse("{" DARK "}");
    const struct slab slab = {.depth = 2, .extinction = 1.25, .albedo = {1, 1, 1}};
    const struct sf_truth_medium medium = slab_medium(&slab, 0);
    struct sf_truth *truth = truth_of(scene, &medium, 1e-6);

    (void)state;
    for (int i = 0; i < 8; i++) {
        double angle = i * 0.18, o[3] = {0, 0, -1}, d[3] = {sin(angle), 0, cos(angle)};

        assert_near(trace(truth, o, d, 0, INFINITY).transmittance, exp(-2.5 / cos(angle)), 1e-14);
    }
    sf_truth_destroy(&truth);
    sf_scene_destroy(&scene);
}

/* Smokeview's verification guide: soot of which one metre halves the light shows a white wall in these greys. */
static void test_greys(void **state)
{
    static const double metres[] = {0.5, 1, 2, 3, 4, 5};
    static const int greys[] = {181, 128, 64, 32, 16, 8};
    struct sf_scene *scene = parse("{\"lights\": [{\"type\": \"directional\", \"direction\": [0, -1, 0.5]}]}");
    const double o[3] = {0, 0, -1}, d[3] = {0, 0, 1};

    (void)state;
    for (int i = 0; i < 6; i++) {
        const struct slab slab = {.depth = metres[i], .extinction = log(2)};
        const struct sf_truth_medium medium = slab_medium(&slab, 0);
        const struct sf_particle ball = ball_at(0, 0, 5, metres[i] / 2, log(2));
        struct sf_truth *truth = truth_of(scene, &medium, 1e-6);
        struct sf_truth_result result = trace(truth, o, d, 0, INFINITY);
        struct cloud cloud;

        assert_int_equal((int)(256 * result.transmittance + 1e-9), greys[i]);
        assert_true(result.radiance[0] == 0 && result.radiance[1] == 0 && result.radiance[2] == 0);
        sf_truth_destroy(&truth);
        scene->medium.albedo[0] = scene->medium.albedo[1] = scene->medium.albedo[2] = 0;
        cloud_make(&cloud, scene, &ball, 1);
        truth = truth_of(scene, &cloud.medium, 1e-6);
        result = trace(truth, o, d, 0, INFINITY);
        assert_int_equal((int)(256 * result.transmittance + 1e-4), greys[i]); /* ln 2 as a float */
        assert_true(result.radiance[0] == 0);
        sf_truth_destroy(&truth);
        cloud_free(&cloud);
    }
    sf_scene_destroy(&scene);
}

/* Over the sphere the phase function has the integral 1 and the mean cosine g. */
static void test_phase(void **state)
{
    static const double gs[] = {-0.99, -0.5, 0, 0.3, 0.8, 0.95};

    (void)state;
    for (size_t i = 0; i < SF_COUNT(gs); i++) {
        enum { STEPS = 400000 };
        double sum = 0, mean = 0;

        for (int k = 0; k < STEPS; k++) {
            double angle = PI * (k + 0.5) / STEPS, part = 2 * PI * sin(angle) * PI / STEPS;

            sum += part * sf_truth_phase(cos(angle), gs[i]);
            mean += part * sf_truth_phase(cos(angle), gs[i]) * cos(angle);
        }
        assert_near(sum, 1, 1e-6);
        assert_near(mean, gs[i], 1e-6);
    }
    assert_near(sf_truth_phase(0.3, 0), 1 / (4 * PI), 1e-15);
    assert_true(sf_truth_phase(1, 0.8) > 100 * sf_truth_phase(-1, 0.8));
}

/* Single scattering in a slab: the eye looks along mu = cos(angle to z), light travels with cosine mu0 to z. */
static double slab_answer(double tau, double mu, double mu0)
{
    if (mu0 > 0)
        return (1 - exp(-tau * (1 / mu + 1 / mu0))) / mu / (1 / mu + 1 / mu0);
    return exp(tau / mu0) * (1 - exp(-tau * (1 / mu + 1 / mu0))) / mu / (1 / mu + 1 / mu0);
}

static void test_slab_scattering(void **state)
{
    static const double ways[][3] = {{0.3, -0.2, 1}, {1, 0, 0.2}, {0.4, 0.4, -1}, {0, 1, -0.3}};
    static const double gs[] = {0, 0.7, -0.6};
    struct sf_scene *scene =
        parse("{\"lights\": [{\"type\": \"directional\", \"direction\": [0, -1, 0], \"color\": [1, "
              "0.5, 0.25], \"intensity\": 3}], \"environment\": {\"type\": \"color\", \"color\": "
              "[0.2, 0.4, 0.6]}}");
    const struct slab slab = {.depth = 1.5, .extinction = 2, .albedo = {0.9, 0.6, 0.3}, .emission = {0.05, 0.02, 0.01}};
    const double o[3] = {0.1, 0.2, -2};
    double d[3] = {0.5, 0.1, 0.8}, length = sqrt(0.25 + 0.01 + 0.64);

    (void)state;
    for (size_t k = 0; k < SF_COUNT(gs); k++) {
        const struct sf_truth_medium medium = slab_medium(&slab, gs[k]);

        for (size_t i = 0; i < SF_COUNT(ways); i++) {
            double norm = sqrt(ways[i][0] * ways[i][0] + ways[i][1] * ways[i][1] + ways[i][2] * ways[i][2]);
            double mu = d[2] / length, mu0 = ways[i][2] / norm, cosine = 0;

            for (int c = 0; c < 3; c++) {
                scene->lights[0].direction[c] = (float)(ways[i][c] / norm);
                /* travels along `way` before and against d after */
                cosine -= ways[i][c] / norm * d[c] / length;
            }
            double phase = (1 - gs[k] * gs[k]) / (4 * PI * pow(1 + gs[k] * gs[k] - 2 * gs[k] * cosine, 1.5));
            struct sf_truth *truth = truth_of(scene, &medium, 1e-8);
            struct sf_truth_result result = trace(truth, o, d, 0, INFINITY);
            for (int c = 0; c < 3; c++) {
                double light = 3 * (c == 0 ? 1 : c == 1 ? 0.5 : 0.25), opaque = 1 - exp(-3 / mu);
                double expected =
                    slab.albedo[c] * (phase * light * slab_answer(3, mu, mu0) + opaque * (c == 0   ? 0.2f
                                                                                          : c == 1 ? 0.4f
                                                                                                   : 0.6f)) +
                    opaque * slab.emission[c];

                assert_near(result.radiance[c], expected, 1e-6 * expected);
            }
            assert_true(result.converged);
            sf_truth_destroy(&truth);
        }
    }
    sf_scene_destroy(&scene);
}

/* Looking straight into the light, smoke that scatters forward is bright. */
static void test_backlit(void **state)
{
    struct sf_scene *scene = parse("{\"lights\": [{\"type\": \"directional\", \"direction\": [0, 0, -1]}], " DARK
                                   ", \"medium\": {\"g\": 0.8}}");
    const struct sf_particle ball = ball_at(0, 0, 0, 1, 0.5);
    const double in_front[3] = {0, 0, -3}, behind[3] = {0, 0, 3}, into[3] = {0, 0, 1}, away[3] = {0, 0, -1};
    struct cloud cloud;

    (void)state;
    cloud_make(&cloud, scene, &ball, 1);
    struct sf_truth *truth = truth_of(scene, &cloud.medium, 1e-6);
    assert_true(trace(truth, in_front, into, 0, INFINITY).radiance[0] >
                100 * trace(truth, behind, away, 0, INFINITY).radiance[0]);
    sf_truth_destroy(&truth);
    cloud_free(&cloud);
    sf_scene_destroy(&scene);
}

/* A lamp in fog, against a plain sum of two million steps. The eye stands in the fog. */
static void test_airlight(void **state)
{
    struct sf_scene *scene =
        parse("{\"lights\": [{\"type\": \"point\", \"position\": [0.25, 0, 4], \"intensity\": 5}], " DARK
              ", \"medium\": {\"albedo\": [0.8, 0.8, 0.8], \"g\": 0.5}}");
    const struct sf_particle fog = ball_at(0, 0, 0, 50, 0.25);
    const double o[3] = {0, 0, 0}, d[3] = {0, 0, 2};
    enum { STEPS = 2000000 };
    double sum = 0, g = 0.5;
    struct cloud cloud;

    (void)state;
    for (int i = 0; i < STEPS; i++) {
        double t = 12 * (i + 0.5) / STEPS, away = sqrt(0.25 * 0.25 + (4 - t) * (4 - t)), cosine = (4 - t) / away;
        double phase = (1 - g * g) / (4 * PI * pow(1 + g * g - 2 * g * cosine, 1.5));

        sum += 0.25 * 0.8f * phase * 5 / (away * away) * exp(-0.25 * (t + away)) * 12 / STEPS;
    }
    cloud_make(&cloud, scene, &fog, 1);
    struct sf_truth *truth = truth_of(scene, &cloud.medium, 1e-9);
    struct sf_truth_result result = trace(truth, o, d, 0, 6);
    assert_near(result.radiance[0], sum, 1e-7 * sum);
    assert_near(result.transmittance, exp(-3), 1e-12);
    assert_near(result.near, 0, 0);
    assert_near(result.far, 6, 1e-12);
    sf_truth_destroy(&truth);
    cloud_free(&cloud);
    sf_scene_destroy(&scene);
}

/* An opaque ball above takes its width out of a beam: closed form. Also a ball that no node of the quadrature would meet. */
static void test_shadow(void **state)
{
    static const double radii[] = {0.5, 0.5, 0.03};
    double o[3] = {-5, 0, 1}, d[3] = {1, 0, 0};
    const struct slab slab = {.depth = 2, .extinction = 0.4, .albedo = {1, 1, 1}};

    (void)state;
    for (int i = 0; i < 3; i++) {
        double radius = (float)radii[i], middle = 5 + (double)0.244f;
        char text[512];

        snprintf(text, sizeof text,
                 "{\"lights\": [{\"type\": \"directional\", \"direction\": [0, 0, -1], \"intensity\": 2, \"shadows\": "
                 "%s}], \"objects\": [{\"type\": \"sphere\", \"position\": [0.244, 0, 6], \"radius\": %g}, {\"type\": "
                 "\"plane\", \"position\": [0, 0, 5], \"normal\": [0, 0, 1]}], " DARK "}",
                 i == 1 ? "false" : "true", radii[i]);
        struct sf_scene *scene = parse(text);
        const struct sf_truth_medium medium = slab_medium(&slab, 0);
        struct sf_truth *truth = truth_of(scene, &medium, 1e-9);
        double lit = 1 - exp(-0.4 * 10) - (i == 1 ? 0 : exp(-0.4 * (middle - radius)) - exp(-0.4 * (middle + radius)));

        assert_near(trace(truth, o, d, 0, 10).radiance[0], 2 / (4 * PI) * exp(-0.4) * lit, 1e-9);
        sf_truth_destroy(&truth);
        sf_scene_destroy(&scene);
    }
}

/* A spot's edge: E along a beam as docs/scene.md has it. The second beam is so narrow that no node of the quadrature would
 * meet it. */
static void test_spot(void **state)
{
    static const double angles[][2] = {{20, 40}, {0.25, 0.5}};
    const struct sf_particle fog = ball_at(0, 0, 0, 40, 0.1);
    const double o[3] = {-5.3, 0, 2}, d[3] = {1, 0, 0};
    enum { STEPS = 1000000 };

    (void)state;
    for (int beam = 0; beam < 2; beam++) {
        double inner = cos(angles[beam][0] * PI / 180), outer = cos(angles[beam][1] * PI / 180), sum = 0;
        struct cloud cloud;
        char text[512];

        snprintf(text, sizeof text,
                 "{\"lights\": [{\"type\": \"spot\", \"position\": [0, 0, 0], \"direction\": [0.5, 0, 1], "
                 "\"intensity\": 7, \"inner\": %g, \"outer\": %g}], " DARK "}",
                 angles[beam][0], angles[beam][1]);
        struct sf_scene *scene = parse(text);
        scene->medium.albedo[0] = 1;
        for (int i = 0; i < STEPS; i++) {
            double t = 12 * (i + 0.5) / STEPS, x = t - 5.3, away = sqrt(x * x + 4);
            double cosine = (0.5 * x + 2) / (away * sqrt(1.25));
            double s = fmin(fmax((cosine - outer) / (inner - outer), 0), 1);

            sum += 0.1f / (4 * PI) * 7 * s * s * (3 - 2 * s) / (away * away) * exp(-0.1f * (t + away)) * 12 / STEPS;
        }
        cloud_make(&cloud, scene, &fog, 1);
        struct sf_truth *truth = truth_of(scene, &cloud.medium, 1e-8);
        assert_near(trace(truth, o, d, 0, 12).radiance[0], sum, 1e-6 * sum);
        sf_truth_destroy(&truth);
        cloud_free(&cloud);
        sf_scene_destroy(&scene);
    }
}

/* Panels of a rule of degree 11: the error falls with the 12th power of their size. */
static void test_order(void **state)
{
    struct sf_scene *scene =
        parse("{\"lights\": [{\"type\": \"directional\", \"direction\": [0, 0, 1], \"intensity\": 1}], " DARK "}");
    const struct slab slab = {.depth = 1, .extinction = 18, .albedo = {1, 1, 1}};
    const struct sf_truth_medium medium = slab_medium(&slab, 0);
    const double o[3] = {0, 0, -1}, d[3] = {0, 0, 1}, exact = (1 - exp(-36)) / 2 / (4 * PI);
    double errors[5];

    (void)state;
    for (int i = 0; i < 5; i++) {
        struct sf_truth_options options = sf_truth_options_usual();
        struct sf_truth *truth;

        options.panels = 1u << i;
        assert_int_equal(sf_truth_create(scene, &medium, &options, NULL, &truth), SF_OK);
        struct sf_truth_result result = trace(truth, o, d, 0, INFINITY);
        assert_int_equal(result.evaluations, 7u << i);
        errors[i] = fabs(result.radiance[0] - exact) / exact;
        assert_true(result.error >= errors[i] * exact);
        sf_truth_destroy(&truth);
    }
    double order = log2(errors[3] / errors[4]);
    print_message("relative error of 1, 2, 4, 8, 16 panels: %.2g %.2g %.2g %.2g %.2g, last order %.2f\n", errors[0],
                  errors[1], errors[2], errors[3], errors[4], order);
    assert_true(order > 11 && order < 13);
    assert_true(errors[4] < 1e-11);
    sf_scene_destroy(&scene);
}

/* Within the stated tolerance, and at a cost that grows as it falls. The 1e-5 is for slivers of shadow that fall between
 * the first panels' nodes (truth.h). */
static void test_tolerance(void **state)
{
    struct sf_scene *scene =
        parse("{\"lights\": [{\"type\": \"directional\", \"direction\": [1, -2, 0.5], \"intensity\": "
              "4}, {\"type\": \"point\", \"position\": [0.3, 0.9, 0.2]}]}");
    const double o[3] = {0.2, 0.1, 4};
    struct cloud cloud;

    (void)state;
    cloud_random(&cloud, scene, 60, 3, 0.4, 3);
    for (uint32_t ray = 0; ray < 16; ray++) {
        double d[3] = {0.3 * (random_of(4, ray, 0) - 0.5), 0.3 * (random_of(4, ray, 1) - 0.5), -1}, best[3] = {0};
        uint32_t before = UINT32_MAX;

        for (int digits = 10; digits >= 2; digits -= digits > 5 ? 5 : 1) {
            struct sf_truth *truth = truth_of(scene, &cloud.medium, pow(10, -digits));
            struct sf_truth_result result = trace(truth, o, d, 0, INFINITY);

            assert_true(result.converged && result.evaluations <= before);
            for (int c = 0; c < 3; c++) {
                best[c] = digits == 10 ? result.radiance[c] : best[c];
                assert_near(result.radiance[c], best[c], (pow(10, -digits) + 1e-5) * best[c]);
            }
            before = result.evaluations;
            sf_truth_destroy(&truth);
        }
    }
    cloud_free(&cloud);
    sf_scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sphere_transmittance),
        cmocka_unit_test(test_slab_transmittance),
        cmocka_unit_test(test_greys),
        cmocka_unit_test(test_phase),
        cmocka_unit_test(test_slab_scattering),
        cmocka_unit_test(test_backlit),
        cmocka_unit_test(test_airlight),
        cmocka_unit_test(test_shadow),
        cmocka_unit_test(test_spot),
        cmocka_unit_test(test_order),
        cmocka_unit_test(test_tolerance),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
