/* The sort's CPU side: keys of floats, the comparison sort, and the limits that tuning must keep to. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "base/hash.h"
#include "sim/sort.h"

/* The shaders' own function, compiled as C. */
typedef uint32_t uint;
static uint floatBitsToUint(float value)
{
    uint bits;

    memcpy(&bits, &value, sizeof bits);
    return bits;
}
uint sort_key_from_bits(uint bits);
uint sort_key_from_float(float value);
#include "sort/key.glsl"

static float float_from(uint32_t bits)
{
    float value;

    memcpy(&value, &bits, sizeof value);
    return value;
}

static void test_keys(void **state)
{
    static const uint32_t edges[] = {0x00000000, 0x00000001, 0x007fffff, 0x00800000, 0x3f800000, 0x7f7fffff, 0x7f800000,
                                     0x7f800001, 0x7fc00000, 0x7fffffff, 0x80000000, 0x80000001, 0x807fffff, 0x80800000,
                                     0xbf800000, 0xff7fffff, 0xff800000, 0xff800001, 0xffc00000, 0xffffffff};
    enum { EDGES = sizeof edges / sizeof *edges, RANDOMS = 500 };
    uint32_t bits[EDGES + RANDOMS];

    (void)state;
    memcpy(bits, edges, sizeof edges);
    for (uint32_t i = 0; i < RANDOMS; i++)
        bits[EDGES + i] = sf_random_u32(1, i, 0);
    for (int i = 0; i < EDGES + RANDOMS; i++) {
        float a = float_from(bits[i]);

        assert_int_equal(sf_sort_key(a), sort_key_from_float(a));
        for (int j = 0; j < EDGES + RANDOMS; j++) {
            float b = float_from(bits[j]);
            /* NaNs are alike, and above all else. */
            bool below = isnan(b) ? !isnan(a) : a < b;

            assert_int_equal(sf_sort_key(a) < sf_sort_key(b), below);
        }
    }
    assert_int_equal(sf_sort_key(-0.0f), sf_sort_key(0.0f));
    assert_int_equal(sf_sort_key(NAN), UINT32_MAX);
    assert_int_equal(sf_sort_key(-NAN), UINT32_MAX);
}

static int compare_words(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;

    return (x > y) - (x < y);
}

static void test_words(void **state)
{
    static const size_t sizes[] = {0, 1, 2, 3, 15, 16, 17, 18, 100, 5000};
    enum { KINDS = 7 };
    uint64_t words[5000], expected[5000];

    (void)state;
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
        for (int kind = 0; kind < KINDS; kind++) {
            size_t n = sizes[s];

            for (size_t i = 0; i < n; i++) {
                uint64_t random = (uint64_t)sf_random_u32(7, (uint32_t)i, 0) << 32 | sf_random_u32(7, (uint32_t)i, 1);
                const uint64_t kinds[KINDS] = {
                    random, i, n - i, 5, random % 3, i % 2 ? i : n - i, i < n / 2 ? i : n - i};

                words[i] = expected[i] = kinds[kind];
            }
            qsort(expected, n, sizeof *expected, compare_words);
            sf_sort_words(words, n);
            assert_memory_equal(words, expected, n * sizeof *words);
        }
}

/* Quicksort's worst case for a median of three (Musser 1997) must not take quadratic time, nor deep recursion. */
static void test_adversary(void **state)
{
    enum { HALF = 100000 };
    uint64_t *words = malloc(2 * HALF * sizeof *words);

    (void)state;
    assert_non_null(words);
    for (uint64_t i = 0; i < HALF; i++) {
        words[i] = i % 2 ? HALF + i : i + 1;
        words[HALF + i] = 2 * (i + 1);
    }
    sf_sort_words(words, 2 * HALF);
    for (size_t i = 1; i < 2 * HALF; i++)
        assert_true(words[i - 1] <= words[i]);
    free(words);
}

static uint32_t ceil_div(uint32_t a, uint32_t b)
{
    return a / b + (a % b != 0);
}

static void test_tuning(void **state)
{
    static const uint32_t capacities[] = {1, 2, 1000, 65536, 1 << 20, (1 << 20) + 1, 16 << 20, 200000000};
    static const uint32_t workers[] = {1, 2, 3, 4, 8, 12, 64, 1024};
    static const uint32_t subgroups[] = {1, 4, 8, 16, 32, 64};
    static const uint32_t shared[] = {16384, 32768, 49152};

    (void)state;
    for (size_t c = 0; c < sizeof capacities / sizeof *capacities; c++)
        for (size_t w = 0; w < sizeof workers / sizeof *workers; w++) {
            for (size_t s = 0; s < sizeof subgroups / sizeof *subgroups; s++) {
                const struct sf_gpu_tuning device = {
                    .software = true, .subgroup_size = subgroups[s], .workers = workers[w]};
                struct sf_sort_tuning tuning;
                uint32_t slice, share, results;

                sf_sort_tune(&device, capacities[c], &tuning);
                assert_true(tuning.blocks);
                assert_int_equal(tuning.local, subgroups[s]);
                assert_in_range(tuning.groups, workers[w], 65535);
                assert_in_range(tuning.merge_groups, 1, 65535);
                assert_true(tuning.ways == 2 || tuning.ways == 4);
                results = ceil_div(tuning.groups, tuning.ways);
                assert_in_range(tuning.merge_groups * tuning.local, results, UINT32_MAX);
                /* llvmpipe's limit of turns; a slice is rounded up to an odd number of cache lines, and its rest is
                 * done one by one */
                slice = ceil_div(ceil_div(capacities[c], tuning.groups), tuning.local) + 16;
                assert_in_range(SF_SORT_PASSES * (2 * (slice / SF_SORT_UNROLL + 7) + 321), 0, 65535);
                share = ceil_div(ceil_div(capacities[c], results), tuning.merge_groups * tuning.local / results);
                assert_in_range(share / 4 + 3 + 32 * 4 * 21, 0, 65535);
            }
            for (size_t s = 0; s < sizeof shared / sizeof *shared; s++) {
                const struct sf_gpu_tuning device = {.subgroup_size = 32,
                                                     .workers = workers[w],
                                                     .max_group_invocations = 1024,
                                                     .shared_bytes = shared[s]};
                struct sf_sort_tuning tuning;

                sf_sort_tune(&device, capacities[c], &tuning);
                assert_false(tuning.blocks);
                assert_in_range(tuning.groups, 1, workers[w]);
                assert_in_range(tuning.local, 64, 1024);
                assert_in_range(4 * (2 * tuning.local * tuning.items + 10 * tuning.local + 2 * SF_SORT_DIGITS), 0,
                                shared[s]);
            }
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_keys),
        cmocka_unit_test(test_words),
        cmocka_unit_test(test_adversary),
        cmocka_unit_test(test_tuning),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
