/* glsl/shared/noise.h: gradient and cellular noise. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <string.h>
#include "base/hash.h"
#include "shared/noise.h"

enum { POINTS = 2000000 };

static float chance(uint32_t i, uint32_t purpose, float size)
{
    return size * sf_random_float(5, i, purpose);
}

/* Mean, and root mean square against the closed form. */
static void test_moments(void **state)
{
    static const double wanted[3] = {SF_NOISE2_RMS, SF_NOISE3_RMS, SF_NOISE4_RMS};
    double sum[3] = {0}, squares[3] = {0};

    (void)state;
    for (uint32_t i = 0; i < POINTS; i++) {
        float x = chance(i, 1, 900) - 450, y = chance(i, 2, 900) - 450, z = chance(i, 3, 900) - 450,
              w = chance(i, 4, 900) - 450;
        double v[3] = {sf_noise2(x, y, 0, 0, 9), sf_noise3(x, y, z, 0, 0, 0, 9), sf_noise4(x, y, z, w, 0, 0, 0, 0, 9)};

        for (int n = 0; n < 3; n++) {
            sum[n] += v[n];
            squares[n] += v[n] * v[n];
        }
    }
    for (int n = 0; n < 3; n++) {
        double rms = sqrt(squares[n] / POINTS), mean = sum[n] / POINTS;

        if (fabs(rms / wanted[n] - 1) > 0.004 || fabs(mean) > 0.004 * wanted[n])
            fail_msg("%d dimensions: rms %.5f, wanted %.5f; mean %.5f", n + 2, rms, wanted[n], mean);
    }
}

static float along(int dimensions, int axis, float at, uint32_t i)
{
    float p[4] = {chance(i, 1, 40) - 20, chance(i, 2, 40) - 20, chance(i, 3, 40) - 20, chance(i, 4, 40) - 20};

    p[axis] = at;
    return dimensions == 2   ? sf_noise2(p[0], p[1], 0, 0, 3)
           : dimensions == 3 ? sf_noise3(p[0], p[1], p[2], 0, 0, 0, 3)
                             : sf_noise4(p[0], p[1], p[2], p[3], 0, 0, 0, 0, 3);
}

/* 0 on the lattice; value and slope continuous across every side of a cell. */
static void test_smooth(void **state)
{
    const float step = 1.0f / 1024;

    (void)state;
    for (int i = -5; i <= 5; i++)
        for (int j = -5; j <= 5; j++) {
            float x = (float)i, y = (float)j;

            assert_true(sf_noise2(x, y, 0, 0, 1) == 0 && sf_noise3(x, y, x, 0, 0, 0, 1) == 0);
            assert_true(sf_noise4(x, y, y, x, 0, 0, 0, 0, 1) == 0);
        }
    for (uint32_t i = 0; i < 3000; i++)
        for (int n = 2; n <= 4; n++)
            for (int axis = 0; axis < n; axis++) {
                float side = (float)((int)(i % 9) - 4), v[4];

                for (int k = 0; k < 4; k++)
                    v[k] = along(n, axis, side + step * ((float)k - 1.5f), i);
                float before = (v[1] - v[0]) / step, across = (v[2] - v[1]) / step, behind = (v[3] - v[2]) / step;

                if (fabsf(before - across) > 0.02f || fabsf(across - behind) > 0.02f)
                    fail_msg("%d dimensions, axis %d: slopes %g, %g, %g at a side", n, axis, (double)before,
                             (double)across, (double)behind);
            }
}

/* As much variance of change along every axis and diagonal: no direction is preferred by more than a lattice must. */
static void test_isotropy(void **state)
{
    static const float ways[4][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.57735f, 0.57735f, 0.57735f}};
    double squares[4] = {0};

    (void)state;
    for (uint32_t i = 0; i < 400000; i++) {
        float x = chance(i, 1, 500), y = chance(i, 2, 500), z = chance(i, 3, 500),
              from = sf_noise3(x, y, z, 0, 0, 0, 2);

        for (int k = 0; k < 4; k++) {
            double change =
                sf_noise3(x + 0.1f * ways[k][0], y + 0.1f * ways[k][1], z + 0.1f * ways[k][2], 0, 0, 0, 2) - from;

            squares[k] += change * change;
        }
    }
    for (int k = 1; k < 4; k++)
        assert_true(fabs(squares[k] / squares[0] - 1) < 0.02);
}

/* Both ends of a period have the same bits; within it the lattice is that of the noise without one. */
static void test_periods(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 20000; i++) {
        float x = chance(i, 1, 5), y = chance(i, 2, 7), z = chance(i, 3, 11), w = chance(i, 4, 2);
        struct sf_noise_cells a = sf_noise_cells3(0, y, z, 5, 7, 11, 0.6f, 0.8f, 4),
                              b = sf_noise_cells3(5, y, z, 5, 7, 11, 0.6f, 0.8f, 4);

        assert_true(sf_noise2(0, y, 5, 7, 4) == sf_noise2(5, y, 5, 7, 4));
        assert_true(sf_noise3(x, 0, z, 5, 7, 11, 4) == sf_noise3(x, 7, z, 5, 7, 11, 4));
        assert_true(sf_noise3(x, y, 0, 5, 7, 11, 4) == sf_noise3(x, y, 11, 5, 7, 11, 4));
        assert_true(sf_noise4(x, y, z, 0, 5, 7, 11, 2, 4) == sf_noise4(x, y, z, 2, 5, 7, 11, 2, 4));
        assert_true(sf_noise4(x, 0, z, w, 5, 7, 11, 2, 4) == sf_noise4(x, 7, z, w, 5, 7, 11, 2, 4));
        assert_true(a.first == b.first && a.second == b.second);
        if (x < 4 && y < 6 && z < 10)
            assert_true(sf_noise3(x, y, z, 5, 7, 11, 4) == sf_noise3(x, y, z, 0, 0, 0, 4));
        /* Just below the period the noise is just beside its beginning. */
        assert_true(fabsf(sf_noise3(nextafterf(5, 0), y, z, 5, 0, 0, 4) - sf_noise3(0, y, z, 5, 0, 0, 4)) < 1e-5f);
    }
}

/* Squared distances to the two nearest points, found among all of 9^3 cells. */
static void nearest(const float *p, float cosine, float sine, uint32_t seed, double two[2])
{
    int cell[3];

    for (int axis = 0; axis < 3; axis++)
        cell[axis] = (int)floorf(p[axis]);
    two[0] = two[1] = HUGE_VAL;
    for (int n = 0; n < 729; n++) {
        int x = cell[0] + n % 9 - 4, y = cell[1] + n / 9 % 9 - 4, z = cell[2] + n / 81 - 4;
        uint32_t bits =
            sf_hash_u32((uint32_t)x * SF_NOISE_X + (uint32_t)y * SF_NOISE_Y + (uint32_t)z * SF_NOISE_Z + seed);
        double v[3], at[3] = {x, y, z}, square = 0;

        for (unsigned axis = 0; axis < 3; axis++)
            v[axis] = ((bits >> (axis < 2 ? 10 * axis : 22) & 1023u) * 2.0 - 1023) / 1024;
        for (int axis = 0; axis < 3; axis++) {
            double away = at[axis] + 0.5 + 0.35355338 * (v[axis] * cosine + v[(axis + 1) % 3] * sine) - p[axis];

            square += away * away;
        }
        if (square < two[0]) {
            two[1] = two[0];
            two[0] = square;
        } else if (square < two[1]) {
            two[1] = square;
        }
    }
}

static void test_cells(void **state)
{
    unsigned second_missed = 0;

    (void)state;
    for (uint32_t i = 0; i < 60000; i++) {
        float p[3] = {chance(i, 1, 100) - 50, chance(i, 2, 100) - 50, chance(i, 3, 100) - 50};
        float angle = i % 2 ? chance(i, 4, 6.2831853f) : 0, cosine = cosf(angle), sine = sinf(angle);
        struct sf_noise_cells cells = sf_noise_cells3(p[0], p[1], p[2], 0, 0, 0, cosine, sine, 6);
        double two[2];

        nearest(p, cosine, sine, 6, two);
        if (fabs(cells.first - two[0]) > 2e-5)
            fail_msg("the nearest is %.9g away, not %.9g", sqrt(two[0]), sqrt((double)cells.first));
        second_missed += fabs(cells.second - two[1]) > 2e-5;
    }
    assert_true(second_missed <= 3);
}

/* Neighbouring lattice points, axes and seeds have nothing in common. */
static void test_seeds(void **state)
{
    double product[3] = {0}, square = 0;

    (void)state;
    for (uint32_t i = 0; i < 200000; i++) {
        float x = chance(i, 1, 300), y = chance(i, 2, 300), z = chance(i, 3, 300);
        double a = sf_noise3(x, y, z, 0, 0, 0, 1);

        square += a * a;
        product[0] += a * sf_noise3(x, y, z, 0, 0, 0, 2);
        product[1] += a * sf_noise3(x + 3, y, z, 0, 0, 0, 1);
        product[2] += a * sf_noise3(y, x, z, 0, 0, 0, 1);
    }
    for (int k = 0; k < 3; k++)
        assert_true(fabs(product[k] / square) < 0.015);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_moments), cmocka_unit_test(test_smooth), cmocka_unit_test(test_isotropy),
        cmocka_unit_test(test_periods), cmocka_unit_test(test_cells),  cmocka_unit_test(test_seeds),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
