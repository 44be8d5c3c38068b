/* The looked-at image: place, zoom and pan, ranges, colours. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <math.h>
#include <cmocka.h>
#include "app/view/looking.h"
#include "app/view/view.h"

static struct sf_looking looking;

static int setup(void **state)
{
    (void)state;
    looking = (struct sf_looking){.automatic = true, .high = 1, .zoom = 1};
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    sf_looking_finish(&looking);
    return 0;
}

static void take(const float *values, uint32_t width, uint32_t height, uint32_t channels)
{
    const struct sf_frame frame = {
        .inspected = values, .inspected_width = width, .inspected_height = height, .inspected_channels = channels};

    sf_looking_take(&looking, &frame);
}

static const uint8_t *pixels(uint32_t width, uint32_t height)
{
    uint32_t got_width, got_height;
    const uint8_t *result = sf_looking_pixels(&looking, width, height, &got_width, &got_height);

    assert_non_null(result);
    assert_true(got_width == width && got_height == height);
    return result;
}

static void assert_pixel(const uint8_t *pixel, int red, int green, int blue)
{
    if (abs(pixel[0] - red) > 1 || abs(pixel[1] - green) > 1 || abs(pixel[2] - blue) > 1 || pixel[3] != 255)
        fail_msg("the pixel is %d %d %d %d, not %d %d %d 255", pixel[0], pixel[1], pixel[2], pixel[3], red, green,
                 blue);
}

static void without_values_there_is_the_picture(void **state)
{
    const uint32_t words[] = {1, 2, 3};
    uint32_t width, height;

    (void)state;
    assert_null(sf_looking_pixels(&looking, 4, 4, &width, &height));
    take((const float[]){1, 2}, 2, 1, 1);
    assert_null(sf_looking_pixels(&looking, 0, 4, &width, &height));
    pixels(2, 1);
    sf_looking_take(&looking, &(struct sf_frame){.inspected_words = words, .inspected_word_count = 3});
    assert_null(looking.values);
    assert_null(sf_looking_pixels(&looking, 4, 4, &width, &height));
    assert_int_equal(looking.word_count, 3);
    assert_memory_equal(looking.words, words, sizeof words);
    sf_looking_take(&looking, &(struct sf_frame){0});
    assert_true(!looking.words && looking.word_count == 0 && looking.version == 3);
}

static void one_channel_is_grey_from_least_to_greatest(void **state)
{
    const float values[] = {2, 4, 3, SF_NO_DEPTH};
    const uint8_t *row;

    (void)state;
    take(values, 4, 1, 1);
    assert_true(looking.low == 2 && looking.high == 4); /* the panels say so in the same frame */
    row = pixels(4, 1);
    assert_pixel(row, 0, 0, 0);
    assert_pixel(row + 4, 255, 255, 255);
    assert_pixel(row + 8, 128, 128, 128);
    assert_pixel(row + 12, 24, 29, 40); /* nothing is there: neither near nor far */
    assert_true(looking.low == 2 && looking.high == 4 && !looking.logarithmic);
    looking.automatic = false;
    looking.low = 3;
    looking.high = 2e6f;
    row = pixels(4, 1);
    assert_pixel(row + 12, 127, 127, 127); /* now it is a value like any other */
    looking.low = 4;
    looking.high = 2; /* the other way round */
    row = pixels(4, 1);
    assert_pixel(row, 255, 255, 255);
    assert_pixel(row + 8, 128, 128, 128);
}

static void far_depths_go_by_their_size(void **state)
{
    const uint8_t *row;

    (void)state;
    take((const float[]){-2, -4, -3, -SF_NO_DEPTH}, 4, 1, 1);
    row = pixels(4, 1);
    assert_pixel(row, 0, 0, 0);
    assert_pixel(row + 4, 255, 255, 255);
    assert_pixel(row + 8, 128, 128, 128);
    assert_pixel(row + 12, 24, 29, 40);
    take((const float[]){-2, 2, 0, 1}, 4, 1, 1); /* both signs: by value */
    row = pixels(4, 1);
    assert_pixel(row, 0, 0, 0);
    assert_pixel(row + 8, 128, 128, 128);
}

static void wide_ranges_are_logarithmic_at_first(void **state)
{
    const uint8_t *row;

    (void)state;
    take((const float[]){1, 10, 100, 1000}, 4, 1, 1);
    assert_true(looking.logarithmic);
    row = pixels(4, 1);
    assert_pixel(row, 0, 0, 0);
    assert_pixel(row + 4, 85, 85, 85);
    assert_pixel(row + 8, 170, 170, 170);
    assert_pixel(row + 12, 255, 255, 255);
    looking.logarithmic = false; /* the person's choice stays */
    take((const float[]){1, 10, 100, 1000}, 4, 1, 1);
    assert_false(looking.logarithmic);
    assert_pixel(pixels(4, 1) + 8, 25, 25, 25);
    looking.logarithmic = true;
    take((const float[]){-5, 0, 0.1f, 10}, 4, 1, 1); /* from the nearest above 0 */
    row = pixels(4, 1);
    assert_pixel(row, 0, 0, 0);
    assert_pixel(row + 4, 0, 0, 0);
    assert_pixel(row + 12, 255, 255, 255);
    assert_true(looking.low == 0.1f);
    looking.automatic = false;
    looking.low = 0;
    looking.high = 100; /* from 0: six tens */
    take((const float[]){0, 0.1f, 1, 100}, 4, 1, 1);
    row = pixels(4, 1);
    assert_pixel(row, 0, 0, 0);
    assert_pixel(row + 4, 128, 128, 128);
    assert_pixel(row + 8, 170, 170, 170);
}

static void constant_images_are_black_or_white(void **state)
{
    static const float values[] = {0, 3, -3, SF_NO_DEPTH, INFINITY};
    static const uint8_t grey[][3] = {{0, 0, 0}, {255, 255, 255}, {255, 255, 255}, {24, 29, 40}, {24, 29, 40}};

    (void)state;
    for (int i = 0; i < 10; i++) {
        looking.logarithmic = i >= 5;
        take((const float[]){values[i % 5], values[i % 5]}, 2, 1, 1);
        assert_pixel(pixels(2, 1), grey[i % 5][0], grey[i % 5][1], grey[i % 5][2]);
    }
    looking.automatic = false;
    looking.low = looking.high = 2; /* a threshold */
    take((const float[]){1, 2, 3}, 3, 1, 1);
    assert_pixel(pixels(3, 1), 0, 0, 0);
    assert_pixel(pixels(3, 1) + 4, 0, 0, 0);
    assert_pixel(pixels(3, 1) + 8, 255, 255, 255);
}

static void channels_share_a_range_when_they_are_alike(void **state)
{
    const float picture[] = {0, 0.5f, 1, 9, 2, 0.5f, 0, 7}, kinds[] = {5, -20, 0.5f, 0, 10, -40, 1, 0};
    const uint8_t *row;

    (void)state;
    take(picture, 2, 1, 4);
    row = pixels(2, 1);
    assert_pixel(row, 0, 64, 128);
    assert_pixel(row + 4, 255, 64, 0);
    assert_true(looking.low == 0 && looking.high == 2);
    take(kinds, 2, 1, 4);
    row = pixels(2, 1);
    assert_pixel(row, 0, 0, 0);
    assert_pixel(row + 4, 255, 255, 255);
    take((const float[]){0, 0, 0, 0, 1, 9, 3, 0}, 2, 1, 4); /* one is much larger */
    assert_pixel(pixels(2, 1) + 4, 255, 255, 255);
    take((const float[]){0, 0, 0, 0, 1, 8, 4, 0}, 2, 1, 4);
    assert_pixel(pixels(2, 1) + 4, 32, 255, 128);
    take((const float[]){0, 5, 1, 6}, 2, 1, 2); /* two channels: red and green, each for itself */
    row = pixels(2, 1);
    assert_pixel(row, 0, 0, 0);
    assert_pixel(row + 4, 255, 255, 0);
    take(kinds, 2, 1, 4);
    looking.channel = 2;
    row = pixels(2, 1);
    assert_pixel(row, 0, 0, 0);
    assert_pixel(row + 4, 255, 255, 255);
    assert_true(looking.low == -20 && looking.high == -40);
    looking.channel = 4;
    take(picture, 2, 1, 4);
    row = pixels(2, 1);
    assert_pixel(row, 255, 255, 255);
    assert_pixel(row + 4, 0, 0, 0);
    take((const float[]){0, 1}, 2, 1, 1); /* there is no fourth */
    assert_pixel(pixels(2, 1) + 4, 255, 255, 255);
}

static void what_was_not_written_differs_from_black(void **state)
{
    const float values[] = {0, 1, NAN, NAN};
    const uint8_t *all;
    unsigned kinds[2] = {0};

    (void)state;
    take(values, 2, 2, 1);
    all = pixels(24, 24); /* two texels beside each other, 12 px each, below them two of NaN */
    for (unsigned y = 13; y < 24; y++)
        for (unsigned x = 1; x < 24; x++) {
            const uint8_t *pixel = all + (y * 24 + x) * 4;
            if (x == 12)
                continue; /* the grid's */
            assert_true(pixel[0] > pixel[1] + 40 && pixel[2] > pixel[1] + 40);
            kinds[pixel[0] > 66]++;
        }
    assert_true(kinds[0] > 100 && kinds[1] > 100); /* a checker, also downwards */
    assert_true(abs(all[(14 * 24 + 2) * 4] - all[(20 * 24 + 2) * 4]) > 10);
    looking.automatic = false;
    pixels(24, 24);
    assert_true(looking.pixels[(20 * 24 + 20) * 4] > looking.pixels[(20 * 24 + 20) * 4 + 1] + 40);
}

/* Every pixel against what sf_looking_texel says of its middle. */
static void pixels_stand_where_texels_do(void **state)
{
    enum { COLUMNS = 7, ROWS = 5 };
    static const struct {
        uint32_t width, height;
        float zoom, pan_x, pan_y;
    } places[] = {{70, 50, 1, 0, 0},       {100, 31, 1, 0, 0},      {13, 200, 1, 0, 0},
                  {64, 64, 3.7f, 20, -11}, {64, 64, 0.5f, -10, 3},  {3, 2, 1, 0, 0},
                  {1, 1, 1, 0, 0},         {160, 120, 6, 300, 200}, {90, 40, 0, 0, 0} /* zoom not set yet: 1 */};
    float values[COLUMNS * ROWS];

    (void)state;
    for (int i = 0; i < COLUMNS * ROWS; i++)
        values[i] = (float)(i + 1);
    take(values, COLUMNS, ROWS, 1);
    looking.automatic = looking.logarithmic = false;
    looking.low = 0;
    looking.high = 255;
    for (size_t p = 0; p < sizeof places / sizeof *places; p++) {
        uint32_t width = places[p].width, height = places[p].height, outside = 0, column, row;
        looking.zoom = places[p].zoom;
        looking.pan_x = places[p].pan_x;
        looking.pan_y = places[p].pan_y;
        bool grid = sf_looking_scale(&looking, (float)width, (float)height) >= 8;
        const uint8_t *all = pixels(width, height);

        for (uint32_t y = 0; y < height; y++)
            for (uint32_t x = 0; x < width; x++) {
                const uint8_t *pixel = all + ((size_t)y * width + x) * 4;
                bool inside = sf_looking_texel(&looking, (float)width, (float)height, (float)x + 0.5f, (float)y + 0.5f,
                                               &column, &row);
                int value = inside ? (int)values[row * COLUMNS + column] : 0;

                if (!inside) {
                    outside++;
                    assert_pixel(pixel, 20, 21, 23);
                } else if (!grid || pixel[0] != value - value / 4 + 14) {
                    assert_pixel(pixel, value, value, value);
                }
            }
        if (p == 0)
            assert_int_equal(outside, 0);
        if (p == 1 || p == 4)
            assert_true(outside > width * height / 10);
    }
}

static void the_grid_stands_between_texels(void **state)
{
    const uint8_t *all;

    (void)state;
    take((const float[]){100, 100, 100, 100}, 2, 2, 1);
    looking.automatic = looking.logarithmic = false;
    looking.low = 0;
    looking.high = 255;
    all = pixels(16, 16);
    for (unsigned y = 0; y < 16; y++)
        for (unsigned x = 0; x < 16; x++)
            assert_int_equal(all[(y * 16 + x) * 4], x % 8 == 0 || y % 8 == 0 ? 89 : 100);
    all = pixels(14, 14); /* 7 px a texel: none */
    for (unsigned i = 0; i < 14 * 14; i++)
        assert_int_equal(all[i * 4], 100);
}

static void zoom_keeps_what_is_under_the_mouse(void **state)
{
    static float values[300 * 200];
    float x, y;
    uint32_t column, row, other_column, other_row;

    (void)state;
    take(values, 300, 200, 1);
    for (int turn = 0; turn < 40; turn++) {
        x = 500 + (float)(turn % 7) * 20;
        y = 300 + (float)(turn % 5) * 20;
        assert_true(sf_looking_texel(&looking, 900, 700, x, y, &column, &row));
        sf_looking_zoom(&looking, 900, 700, x, y, turn < 22 ? 1 : -1);
        assert_true(sf_looking_texel(&looking, 900, 700, x, y, &other_column, &other_row));
        assert_true(abs((int)column - (int)other_column) <= 1 && abs((int)row - (int)other_row) <= 1);
        float spot_x, spot_y, scale = sf_looking_scale(&looking, 900, 700);
        sf_looking_spot(&looking, 900, 700, other_column, other_row, &spot_x, &spot_y);
        assert_true(fabsf(spot_x - x) <= scale / 2 + 0.01f && fabsf(spot_y - y) <= scale / 2 + 0.01f);
        assert_true(scale <= 128.01f);
    }
    for (int turn = 0; turn < 100; turn++)
        sf_looking_zoom(&looking, 900, 700, 10, 10, -1);
    assert_true(looking.zoom == 0.5f);
    sf_looking_fit(&looking);
    assert_true(looking.zoom == 1 && looking.pan_x == 0 && looking.pan_y == 0);
    for (int turn = 0; turn < 5; turn++)
        sf_looking_zoom(&looking, 900, 700, 450, 350, 1);
    for (int turn = 0; turn < 5; turn++)
        sf_looking_zoom(&looking, 900, 700, 450, 350, -1);
    assert_true(looking.zoom == 1);
    sf_looking_pan(&looking, 900, 700, 1e6f, -1e6f); /* a margin stays in the place */
    assert_true(sf_looking_texel(&looking, 900, 700, 899, 5, &column, &row));
    assert_false(sf_looking_texel(&looking, 900, 700, 800, 5, &column, &row));
}

static void pixels_are_mapped_anew_when_something_changed_and_only_then(void **state)
{
    const float values[] = {0, 1, 2, 3};

    (void)state;
    take(values, 4, 1, 1);
    pixels(40, 10);
    looking.pixels[3] = 7; /* a mark that a new mapping takes away */
    pixels(40, 10);
    assert_int_equal(looking.pixels[3], 7);
#define ASSERT_ANEW(change)                                                                                            \
    do {                                                                                                               \
        change;                                                                                                        \
        pixels(40, 10);                                                                                                \
        assert_int_equal(looking.pixels[3], 255);                                                                      \
        looking.pixels[3] = 7;                                                                                         \
    } while (0)
    ASSERT_ANEW(take(values, 4, 1, 1));
    ASSERT_ANEW(looking.zoom = 2);
    ASSERT_ANEW(looking.pan_x = 3);
    ASSERT_ANEW(looking.pan_y = 3);
    ASSERT_ANEW(looking.channel = 1);
    ASSERT_ANEW(looking.logarithmic = true);
    ASSERT_ANEW(looking.automatic = false);
    ASSERT_ANEW(looking.low = 0.5f);
    ASSERT_ANEW(looking.high = 2.5f);
#undef ASSERT_ANEW
    pixels(40, 11);
    assert_int_equal(looking.pixels[3], 255);
}

static void a_texel_has_the_colour_that_it_is_drawn_in(void **state)
{
    const float values[] = {0, 0.5f, 1, 9, 2, 0.5f, 0, 7};
    uint8_t rgb[3];

    (void)state;
    take(values, 2, 1, 4);
    pixels(2, 1);
    sf_looking_color(&looking, values + 4, rgb);
    assert_memory_equal(rgb, looking.pixels + 4, 3);
    sf_looking_color(&looking, (const float[]){NAN, NAN, NAN, NAN}, rgb);
    assert_true(rgb[0] < 80 && rgb[1] < 80 && rgb[2] < 80);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(without_values_there_is_the_picture, setup, teardown),
        cmocka_unit_test_setup_teardown(one_channel_is_grey_from_least_to_greatest, setup, teardown),
        cmocka_unit_test_setup_teardown(far_depths_go_by_their_size, setup, teardown),
        cmocka_unit_test_setup_teardown(wide_ranges_are_logarithmic_at_first, setup, teardown),
        cmocka_unit_test_setup_teardown(constant_images_are_black_or_white, setup, teardown),
        cmocka_unit_test_setup_teardown(channels_share_a_range_when_they_are_alike, setup, teardown),
        cmocka_unit_test_setup_teardown(what_was_not_written_differs_from_black, setup, teardown),
        cmocka_unit_test_setup_teardown(pixels_stand_where_texels_do, setup, teardown),
        cmocka_unit_test_setup_teardown(the_grid_stands_between_texels, setup, teardown),
        cmocka_unit_test_setup_teardown(zoom_keeps_what_is_under_the_mouse, setup, teardown),
        cmocka_unit_test_setup_teardown(pixels_are_mapped_anew_when_something_changed_and_only_then, setup, teardown),
        cmocka_unit_test_setup_teardown(a_texel_has_the_colour_that_it_is_drawn_in, setup, teardown),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
