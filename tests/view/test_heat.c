/* The heat map's colours and scale, and differences shown as one. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <math.h>
#include <cmocka.h>
#include "app/view/heat.h"
#include "app/view/looking.h"
#include "app/view/view.h"

static int light(const uint8_t rgb[3])
{
    return 2 * rgb[0] + 5 * rgb[1] + rgb[2];
}

static void zero_is_neutral_and_dark(void **state)
{
    uint8_t rgb[3], none[3];

    (void)state;
    sf_heat_color(0, 1, rgb);
    assert_in_range(rgb[0], 30, 50);
    assert_true(abs(rgb[0] - rgb[1]) <= 4 && abs(rgb[0] - rgb[2]) <= 4);
    sf_heat_color(NAN, 1, none);
    assert_memory_equal(rgb, none, 3);
}

static void more_is_red_less_is_blue_and_both_grow_brighter(void **state)
{
    int above = 0, below = 0;
    uint8_t rgb[3];

    (void)state;
    for (int i = 8; i <= 256; i += 8) {
        sf_heat_color((float)i / 128, 2, rgb);
        assert_true(rgb[0] > rgb[2]);
        assert_true(light(rgb) > above);
        above = light(rgb);
        sf_heat_color((float)-i / 128, 2, rgb);
        assert_true(rgb[2] > rgb[0]);
        assert_true(light(rgb) > below);
        below = light(rgb);
    }
    assert_true(abs(above - below) < above / 8); /* neither side is made to look the greater */
}

static void beyond_the_scale_nothing_changes(void **state)
{
    uint8_t end[3], rgb[3];

    (void)state;
    sf_heat_color(-0.25f, 0.25f, end);
    sf_heat_color(-1e30f, 0.25f, rgb);
    assert_memory_equal(end, rgb, 3);
    sf_heat_color(-INFINITY, 0.25f, rgb);
    assert_memory_equal(end, rgb, 3);
    sf_heat_color(0.125f, 0.25f, end); /* only the ratio to the scale counts */
    sf_heat_color(5, 10, rgb);
    assert_memory_equal(end, rgb, 3);
}

static void the_scale_is_the_greatest_number(void **state)
{
    (void)state;
    assert_true(sf_heat_scale((const float[]){0.5f, -2, NAN, 1, INFINITY}, 5) == 2);
    assert_true(sf_heat_scale((const float[]){0, 0}, 2) == 1e-6f);
    assert_true(sf_heat_scale(NULL, 0) == 1e-6f);
}

static void assert_color(const struct sf_looking *looking, const uint8_t *pixel, float value, float scale)
{
    uint8_t rgb[3], told[3];

    sf_heat_color(value, scale, rgb);
    assert_memory_equal(pixel, rgb, 3);
    sf_looking_color(looking, &value, told);
    assert_memory_equal(told, rgb, 3);
}

static void differences_are_shown_about_zero(void **state)
{
    const float values[] = {-0.1f, 0, 0.4f, NAN};
    struct sf_looking looking = {.heat = true, .automatic = true, .zoom = 1};
    uint32_t width, height;
    const uint8_t *pixels;
    uint8_t zero[3];

    (void)state;
    sf_looking_take(
        &looking,
        &(struct sf_frame){.inspected = values, .inspected_width = 4, .inspected_height = 1, .inspected_channels = 1});
    assert_true(looking.low == -0.4f && looking.high == 0.4f && !looking.logarithmic);
    pixels = sf_looking_pixels(&looking, 4, 1, &width, &height);
    assert_non_null(pixels);
    for (int i = 0; i < 3; i++)
        assert_color(&looking, pixels + 4 * i, values[i], 0.4f);
    sf_heat_color(0, 1, zero);
    assert_memory_not_equal(pixels + 12, zero, 3); /* checks, not 0 */
    looking.automatic = false;
    looking.high = 0.1f;
    looking.low = -0.1f;
    pixels = sf_looking_pixels(&looking, 4, 1, &width, &height);
    for (int i = 0; i < 3; i++)
        assert_color(&looking, pixels + 4 * i, values[i], 0.1f);
    sf_looking_finish(&looking);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(zero_is_neutral_and_dark),
        cmocka_unit_test(more_is_red_less_is_blue_and_both_grow_brighter),
        cmocka_unit_test(beyond_the_scale_nothing_changes),
        cmocka_unit_test(the_scale_is_the_greatest_number),
        cmocka_unit_test(differences_are_shown_about_zero),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
