/* Frame lists and the file names of sequences. */
#include "scratch.h"

#include "base/array.h"
#include "sfumato/sfumato.h"

static struct caught caught;
static const struct sf_log log_caught = {.write = caught_write, .user = &caught, .level = SF_LOG_DEBUG};

static void assert_frames(const char *text, const uint32_t *expected, size_t expected_count)
{
    uint32_t *frames;
    size_t count;

    assert_int_equal(sf_frames_parse(text, &log_caught, &frames, &count), SF_OK);
    assert_int_equal(count, expected_count);
    assert_memory_equal(frames, expected, count * sizeof *expected);
    free(frames);
}

#define ASSERT_FRAMES(text, ...)                                                                                       \
    assert_frames(text, (const uint32_t[]){__VA_ARGS__}, sizeof((const uint32_t[]){__VA_ARGS__}) / sizeof(uint32_t))

static void test_lists(void **state)
{
    (void)state;
    ASSERT_FRAMES("0", 0);
    ASSERT_FRAMES("007", 7);
    ASSERT_FRAMES("1-4", 1, 2, 3, 4);
    ASSERT_FRAMES("1-10x4,150", 1, 5, 9, 150);
    ASSERT_FRAMES("5-5", 5);
    ASSERT_FRAMES("5-6x100", 5);
    ASSERT_FRAMES("9,1-3,2,9,0-1", 9, 1, 2, 3, 0);
    ASSERT_FRAMES(" 3 , 1 - 2 , 8-12x 2\t", 3, 1, 2, 8, 10, 12);
    ASSERT_FRAMES("9999998-9999999", 9999998, 9999999);
    ASSERT_FRAMES("0-9999999x9999999", 0, 9999999);
}

static void test_bad_lists(void **state)
{
    static const char *const bad[][2] = {
        {"", "character 1: expected a frame number"},
        {"1,", "character 3: expected a frame number"},
        {",1", "character 1: expected a frame number"},
        {"1,,2", "character 3: expected a frame number"},
        {"-3", "character 1: a frame number must not be negative"},
        {"1--3", "character 3: the range's last frame must not be negative"},
        {"1-", "character 3: expected the range's last frame"},
        {"5-4", "character 1: the range runs backwards"},
        {"1,5-4", "character 3: the range runs backwards"},
        {"1-9x0", "character 5: the range's step must be at least 1"},
        {"1-9x", "character 5: expected the range's step"},
        {"1-9x-2", "character 5: the range's step must not be negative"},
        {"1-9y2", "character 4: expected a comma or the end"},
        {"1x2", "character 2: expected a comma or the end"},
        {"one", "character 1: expected a frame number"},
        {"1.5", "character 2: expected a comma or the end"},
        {"1 2", "character 3: expected a comma or the end"},
        {"10000000", "character 1: a frame number is more than 9999999"},
        {"99999999999999999999", "character 1: a frame number is more than 9999999"},
        {"1-99999999999", "character 3: the range's last frame is more than"},
        {"0-9999999", "character 1: more than 1000000 frames"},
        {"0-999999,1000000", "character 10: more than 1000000 frames"},
    };

    (void)state;
    for (size_t i = 0; i < SF_COUNT(bad); i++) {
        uint32_t *frames = &(uint32_t){0};
        size_t count = 1;

        assert_int_equal(sf_frames_parse(bad[i][0], &log_caught, &frames, &count), SF_ERROR_USAGE);
        assert_caught(&caught, bad[i][1]);
        assert_null(frames);
        assert_int_equal(count, 0);
    }
}

static void test_names(void **state)
{
    static const struct {
        const char *pattern;
        uint32_t frame;
        const char *name;
    } names[] = {
        {"out/plume.####.exr", 7, "out/plume.0007.exr"},
        {"out/plume.####.exr", 123456, "out/plume.123456.exr"},
        {"#.png", 9999999, "9999999.png"},
        {"##########", 1, "0000000001"},
        {"a_%04d.exr", 12, "a_0012.exr"},
        {"a_%d.exr", 12, "a_12.exr"},
        {"a_%010d", 12, "a_0000000012"},
        {"100%%_%d%%.exr", 3, "100%_3%.exr"},
        {"still.exr", 3, "still.exr"},
        {"C#/50%/%s/####/a.###.exr", 3, "C#/50%/%s/####/a.003.exr"},
    };

    (void)state;
    for (size_t i = 0; i < SF_COUNT(names); i++) {
        char *name;

        assert_int_equal(sf_sequence_name(names[i].pattern, names[i].frame, false, &log_caught, &name), SF_OK);
        assert_string_equal(name, names[i].name);
        free(name);
    }
}

static void test_bad_names(void **state)
{
    static const char *const bad[][2] = {
        {"still.exr", "has no place (#### or %04d in its file name)"},
        {"out/####/still.exr", "has no place"},
        {"a.##.##.exr", "more than one place"},
        {"a.##.%d.exr", "more than one place"},
        {"a.%d%d", "more than one place"},
        {"a.%s.exr", "after % only"},
        {"a.%n", "after % only"},
        {"a.%4d", "after % only"},
        {"a.%0d", "after % only"},
        {"a.%00d", "after % only"},
        {"a.%011d", "after % only"},
        {"a.%0999999999999999999999d", "after % only"},
        {"a.%ld", "after % only"},
        {"a.%", "after % only"},
        {"a.%%%", "after % only"},
        {"###########", "at most 10"},
        {"out/", "no file name"},
        {"", "no file name"},
    };

    (void)state;
    for (size_t i = 0; i < SF_COUNT(bad); i++) {
        char *name = "";

        assert_int_equal(sf_sequence_name(bad[i][0], 1, true, &log_caught, &name), SF_ERROR_USAGE);
        assert_caught(&caught, bad[i][1]);
        assert_null(name);
        /* Without a place it may name a single frame; the rest is wrong for that as well. */
        assert_int_equal(sf_sequence_name(bad[i][0], 1, false, &log_caught, &name), i < 2 ? SF_OK : SF_ERROR_USAGE);
        assert_int_equal(caught.errors, i >= 2);
        caught.errors = 0;
        free(name);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lists),
        cmocka_unit_test(test_bad_lists),
        cmocka_unit_test(test_names),
        cmocka_unit_test(test_bad_names),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
