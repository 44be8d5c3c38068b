/* Volumetric soft particles (METHODS B7): the exact chord without noise, and the march through it. */
#include "volume_kit.h"

#include "base/hash.h"
#include "methods/volumetric.h"
#include "shared/volumetric.h"

enum { CUBE = SF_VOLUMETRIC_SIDE };
static uint8_t noise[CUBE][CUBE][CUBE][4];

/* One of the fields, between its texels; the coordinates count texels from a middle. */
static double field_at(int field, const double at[3])
{
    double whole[3], share[3], sum = 0;

    for (int i = 0; i < 3; i++) {
        whole[i] = floor(at[i]);
        share[i] = at[i] - whole[i];
    }
    for (int k = 0; k < 8; k++) {
        double weight = 1;
        int corner[3];

        for (int i = 0; i < 3; i++) {
            weight *= k >> i & 1 ? share[i] : 1 - share[i];
            corner[i] = ((int)whole[i] + (k >> i & 1)) & (CUBE - 1);
        }
        sum += weight * noise[corner[2]][corner[1]][corner[0]][2 * field];
    }
    return (sum / 127.5 - 1) * (double)SF_VOLUMETRIC_RANGE;
}

/* Two bytes of a texel are one field, the second at the next layer; both fields have mean 0 and variance 1, and the density
 * that they leave has mean 1 in a sphere, to what the fields are not normally distributed. */
static void test_volumetric_noise(void **state)
{
    double sum[2] = {0}, squares[2] = {0}, mixed = 0;
    const size_t count = (size_t)CUBE * CUBE * CUBE;

    (void)state;
    for (size_t i = 0; i < count; i++) {
        const uint8_t *texel = noise[i / CUBE / CUBE][i / CUBE % CUBE][i % CUBE];
        const uint8_t *next = noise[(i / CUBE / CUBE + 1) % CUBE][i / CUBE % CUBE][i % CUBE];
        double values[2];

        for (int f = 0; f < 2; f++) {
            assert_int_equal(texel[2 * f + 1], next[2 * f]);
            values[f] = (texel[2 * f] / 127.5 - 1) * (double)SF_VOLUMETRIC_RANGE;
            sum[f] += values[f] / (double)count;
            squares[f] += values[f] * values[f] / (double)count;
        }
        mixed += values[0] * values[1] / (double)count;
    }
    for (int f = 0; f < 2; f++) {
        assert_float_equal(sum[f], 0, 0.02);
        assert_float_equal(squares[f], 1, 0.05);
    }
    assert_float_equal(mixed, 0, 0.05);
    for (int k = 0; k <= 4; k++) {
        enum { POINTS = 40000 };
        float density[3];
        double mean = 0;

        sf_volumetric_density(0.25f * (float)k, density);
        for (uint32_t i = 0; i < POINTS; i++) {
            double at[3], square = cbrt((double)sf_random_float(1, i, 3));

            for (uint32_t c = 0; c < 3; c++)
                at[c] = CUBE * (double)sf_random_float(1, i, c);
            square *= square;
            mean += fmax((double)density[0] + (double)density[1] * field_at(0, at) - (double)density[2] * square, 0) /
                    POINTS;
        }
        assert_float_equal(mean, 1, k ? 0.03 : 1e-6);
    }
}

/* The chord between near plane and wall: where it begins, and how long it is, in view depth. */
static bool chord_of(const struct view *view, double *front, double *span)
{
    double v[3] = {view->ray[0], view->ray[1], 1}, vv = 0, vc = 0, cc = 0, half;

    for (int i = 0; i < 3; i++) {
        vv += v[i] * v[i];
        vc += v[i] * view->centre[i];
        cc += view->centre[i] * view->centre[i];
    }
    half = vc * vc - vv * (cc - RADIUS * RADIUS);
    if (half <= 0)
        return false;
    half = sqrt(half) / vv;
    *front = fmax(vc / vv - half, NEAR_PLANE);
    *span = fmin(vc / vv + half, view->wall) - *front;
    return *span > 0;
}

static double chord_form(const struct view *view)
{
    double front, span, v = sqrt(view->ray[0] * view->ray[0] + view->ray[1] * view->ray[1] + 1);

    return chord_of(view, &front, &span) ? 1 - exp(-EXTINCTION * span * v) : 0;
}

enum { STEPS = 12 };

/* What the method does, in doubles. Strength 0.9, 2.5 features. The particle is the first, of tile 1, and the scene's seed 1;
 * it does not die, so the noise does not change. */
static double noise_form(const struct view *view)
{
    float chance = sf_random_float(1, 0, 12), density[3];
    double offset[3] = {(double)chance, (double)(chance * 61.0f), (double)(chance * 3701.0f)};
    double v[3] = {view->ray[0], view->ray[1], 1}, front, span, gathered = 0;

    if (!chord_of(view, &front, &span))
        return 0;
    sf_volumetric_density(0.9f, density);
    for (int i = 0; i < STEPS; i++) {
        double p[3], world[3], at[3], t = front + span * (i + 0.5) / STEPS, square = 0;

        for (int k = 0; k < 3; k++) {
            p[k] = (v[k] * t - view->centre[k]) / RADIUS;
            square += p[k] * p[k];
        }
        /* The world's y, z and x, turned about the second of these. */
        world[0] = p[1];
        world[1] = -p[2];
        world[2] = p[0];
        at[0] = cos(0.6) * world[0] + sin(0.6) * world[2];
        at[1] = world[1];
        at[2] = cos(0.6) * world[2] - sin(0.6) * world[0];
        for (int k = 0; k < 3; k++)
            at[k] = CUBE * (at[k] * 2.5 / (2 * SF_VOLUMETRIC_CELLS) + offset[k]) - (k < 2 ? 0.5 : 0);
        gathered +=
            fmax((double)density[0] + (double)density[1] * field_at(0, at) - (double)density[2] * square, 0) / STEPS;
    }
    return 1 - exp(-EXTINCTION * span * sqrt(v[0] * v[0] + v[1] * v[1] + 1) * gathered);
}

#define VOLUMETRIC ",\"method\":\"volumetric\",\"volumetric\":"

static void test_volumetric(void **state)
{
    (void)state;
    /* Exact: at the outline the chord is the root of a small difference. */
    assert_true(compare(VOLUMETRIC "{\"strength\":0,\"lighting\":0}", chord_form, 2e-5) > 3000);
    assert_true(compare(VOLUMETRIC "{\"strength\":0,\"lighting\":1,\"steps\":3}", chord_form, 2e-5) > 3000);
    /* The noise has 8 bits, and so has its filter. */
    assert_true(compare(VOLUMETRIC "{\"strength\":0.9,\"scale\":2.5,\"steps\":12}", noise_form, 0.03) > 3000);
    check_over(VOLUMETRIC "{}");
    /* A particle's own noise goes by the number of its birth. */
    check_order(VOLUMETRIC "{\"strength\":0}");
}

/* Light from the right: what each step adds is brighter to the right by as many radii. */
static void test_volumetric_lighting(void **state)
{
    static float plain[PIXELS][4], lit[PIXELS][4];
    static const char *const dark =
        ",\"environment\":{\"type\":\"color\",\"color\":[0,0,0]},\"method\":\"volumetric\",\"volumetric\":"
        "{\"strength\":0,\"steps\":12,\"lighting\":%g}";
    char settings[512];
    double most = 0;

    (void)state;
    for (int k = 0; k < 2; k++) {
        snprintf(settings, sizeof settings, dark, k ? 0.7 : 0);
        draw(scene_at(&places[0], settings), k ? lit : plain, NULL);
    }
    for (size_t i = 0; i < PIXELS; i++) {
        struct view view = view_of(&places[0], i);
        /* As scene_at has the light: it travels along (1, -0.5, -1). */
        double v[3] = {view.ray[0], view.ray[1], 1}, to_light[3] = {-1 / 1.5, 0.5 / 1.5, -1 / 1.5}, front, span,
               sum = 0;

        if (!chord_of(&view, &front, &span))
            continue;
        double depth = EXTINCTION * span * sqrt(v[0] * v[0] + v[1] * v[1] + 1);

        for (int n = 0; n < STEPS; n++) {
            double along = 0;

            for (int c = 0; c < 3; c++)
                along += to_light[c] * (v[c] * (front + span * (n + 0.5) / STEPS) - view.centre[c]) / RADIUS;
            sum += (exp(-depth * n / STEPS) - exp(-depth * (n + 1) / STEPS)) * (1 + 0.7 * along);
        }
        assert_float_equal(lit[i][1], (double)plain[i][1] * sum / (1 - exp(-depth)), 1e-4);
        most = fmax(most, (double)(lit[i][1] - plain[i][1]));
    }
    assert_true(most > 0.01);
}

static int setup_noise(void **state)
{
    int failed = setup(state);

    return failed ? failed : (int)sf_volumetric_noise(&noise[0][0][0][0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_volumetric_noise), cmocka_unit_test(test_volumetric),
                                       cmocka_unit_test(test_volumetric_lighting)};

    return cmocka_run_group_tests(tests, setup_noise, teardown);
}
