/* What pictures cost: sums, medians, order of passes, share of the ceiling. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <math.h>
#include <cmocka.h>
#include "app/view/stats.h"

static struct sf_stats stats;

static int setup(void **state)
{
    (void)state;
    memset(&stats, 0, sizeof stats);
    return 0;
}

static bool near(float a, double b)
{
    return fabs((double)a - b) <= 1e-5 * (1 + fabs(b));
}

/* A frame of passes named by single letters, each `ms` long and 1000 bytes. */
static void add_frame(const char *letters, double ms)
{
    static const char names[][2] = {"a", "b", "c", "d", "e", "f", "x", "y", "z"};
    struct sf_pass_timing timings[16] = {0};
    uint64_t now = 1000;
    uint32_t count = 0;

    for (; letters[count]; count++) {
        for (size_t n = 0; n < sizeof names / sizeof *names; n++)
            if (names[n][0] == letters[count])
                timings[count].name = names[n];
        timings[count].begin_ns = now;
        now += (uint64_t)(ms * 1e6);
        timings[count].end_ns = now;
        timings[count].bytes_read = 600;
        timings[count].bytes_written = 400;
    }
    sf_stats_add(&stats, timings, count, 1, 2, 0.5f);
}

static void assert_order(const char *letters)
{
    assert_int_equal(stats.pass_count, strlen(letters));
    for (unsigned i = 0; letters[i]; i++)
        if (stats.passes[i].name[0] != letters[i])
            fail_msg("pass %u is '%s', not '%c' of \"%s\"", i, stats.passes[i].name, letters[i], letters);
}

static void runs_of_a_pass_are_summed(void **state)
{
    (void)state;
    add_frame("aabab", 2);
    assert_order("ab");
    assert_true(near(stats.passes[0].last, 6) && near(stats.passes[1].last, 4));
    assert_int_equal(stats.passes[0].bytes, 3000);
    assert_int_equal(stats.passes[1].bytes, 2000);
    assert_int_equal(stats.passes[0].count, 1);
    add_frame("a", 1);
    assert_true(near(stats.passes[0].last, 1) && stats.passes[0].bytes == 1000);
    assert_true(stats.passes[0].present && !stats.passes[1].present);
    assert_true(near(stats.passes[1].last, 4) && near(stats.passes[1].median, 4));
}

static int by_size(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;

    return (x > y) - (x < y);
}

/* Of the last SF_STATS_KEPT and SF_STATS_FRAMES ones, against a sort of them. */
static void medians_are_those_of_a_sort(void **state)
{
    float all[600], sorted[SF_STATS_FRAMES];
    uint32_t random = 1;

    (void)state;
    for (unsigned i = 0; i < 600; i++) {
        random = random * 1664525u + 1013904223u;
        all[i] = (float)(1 + (random >> 16) % 50); /* many are alike */
        add_frame("a", (double)all[i]);
        unsigned kept = i + 1 < SF_STATS_KEPT ? i + 1 : SF_STATS_KEPT;
        memcpy(sorted, all + i + 1 - kept, kept * sizeof *sorted);
        qsort(sorted, kept, sizeof *sorted, by_size);
        double expected = ((double)sorted[kept / 2] + (double)sorted[(kept - 1) / 2]) / 2;
        if (!near(stats.passes[0].median, expected))
            fail_msg("after %u: %g, not %g", i, (double)stats.passes[0].median, expected);
        unsigned frames = i + 1 < SF_STATS_FRAMES ? i + 1 : SF_STATS_FRAMES;
        memcpy(sorted, all + i + 1 - frames, frames * sizeof *sorted);
        qsort(sorted, frames, sizeof *sorted, by_size);
        expected = ((double)sorted[frames / 2] + (double)sorted[(frames - 1) / 2]) / 2;
        assert_true(near(stats.gpu_median, expected));
    }
    assert_int_equal(stats.frame_count, SF_STATS_FRAMES);
    assert_int_equal(stats.next, 600 % SF_STATS_FRAMES);
}

static void frames_that_were_not_measured_do_not_count(void **state)
{
    const struct sf_pass_timing timing = {.name = "a", .begin_ns = 0, .end_ns = 3000000};

    (void)state;
    sf_stats_add(&stats, &timing, 1, 4, 0, 0.25f);
    assert_true(near(stats.wall_median, 0) && near(stats.gpu_median, 3) && near(stats.cpu_median, 4));
    sf_stats_add(&stats, NULL, 0, 6, 10, 0.75f);
    assert_true(near(stats.wall_median, 10) && near(stats.gpu_median, 3) && near(stats.cpu_median, 5));
    assert_true(near(stats.record_ms, 0.75));
    assert_int_equal(stats.frame_count, 2);
    assert_false(stats.passes[0].present);
}

/* A frame's span, not the sum: passes overlap, and there is idle time between them. */
static void the_frame_lasts_from_its_first_begin_to_its_last_end(void **state)
{
    const struct sf_pass_timing timings[] = {{.name = "a", .begin_ns = 5000000, .end_ns = 9000000},
                                             {.name = "b", .begin_ns = 4000000, .end_ns = 6000000},
                                             {.name = "c", .begin_ns = 11000000, .end_ns = 12000000}};

    (void)state;
    sf_stats_add(&stats, timings, 3, 1, 1, 1);
    assert_true(near(stats.gpu_ms[0], 8));
}

static void passes_stand_in_the_order_of_the_last_frame(void **state)
{
    (void)state;
    add_frame("xabc", 1);
    assert_order("xabc");
    add_frame("abc", 1); /* x stays before a */
    assert_order("xabc");
    add_frame("cab", 2);
    assert_order("xcab");
    assert_true(near(stats.passes[1].median, 1) && near(stats.passes[1].last, 2));
    add_frame("cydabz", 1); /* new ones come where they ran */
    assert_order("xcydabz");
    add_frame("x", 7);
    assert_order("xcydabz");
    assert_int_equal(stats.passes[0].count, 2);
    assert_true(near(stats.passes[0].median, 4));
    sf_stats_clear(&stats);
    assert_int_equal(stats.pass_count, 0);
    assert_int_equal(stats.frame_count, 5);
    add_frame("x", 3);
    assert_int_equal(stats.passes[0].count, 1);
    assert_true(near(stats.passes[0].median, 3));
    add_frame("abcx", 1);
    assert_order("abcx");
}

static void many_passes_and_long_names_are_kept_within_bounds(void **state)
{
    struct sf_pass_timing timings[200];
    char names[200][100];

    (void)state;
    for (unsigned i = 0; i < 200; i++) {
        snprintf(names[i], sizeof names[i], "room.%u.%070d", i, 0);
        timings[i] = (struct sf_pass_timing){.name = names[i], .begin_ns = 0, .end_ns = 1000000};
    }
    sf_stats_add(&stats, timings, 200, 1, 1, 1);
    assert_int_equal(stats.pass_count, SF_STATS_PASSES);
    sf_stats_add(&stats, timings + 150, 50, 1, 1, 1); /* take the places of those that did not run */
    assert_int_equal(stats.pass_count, SF_STATS_PASSES);
    unsigned present = 0;
    for (unsigned i = 0; i < stats.pass_count; i++)
        present += stats.passes[i].present;
    assert_int_equal(present, 50);
    sf_stats_add(&stats, timings + 150, 50, 1, 1, 1); /* known again, though their names were cut */
    for (unsigned i = 0; i < stats.pass_count; i++)
        if (stats.passes[i].present)
            assert_int_equal(stats.passes[i].count, 2);
}

static void share_is_of_the_copy(void **state)
{
    (void)state;
    add_frame("a", 2); /* 1000 bytes in 2 ms */
    assert_true(sf_stats_share(&stats, &stats.passes[0]) == 0);
    stats.ceilings = (struct sf_ceilings){.image_copy_ns = 1000000, .compute_copy_ns = 77, .bytes = 2000};
    assert_true(near(sf_stats_share(&stats, &stats.passes[0]), 0.25));
    stats.passes[0].median = 0;
    assert_true(sf_stats_share(&stats, &stats.passes[0]) == 0);
}

static void groups_and_their_sums(void **state)
{
    const struct sf_pass_timing timings[] = {
        {.name = "sim.step", .end_ns = 1000000},     {.name = "thick.camera", .end_ns = 2000000},
        {.name = "scene.sky", .end_ns = 3000000},    {.name = "shadow.keep", .end_ns = 4000000},
        {.name = "output.color", .end_ns = 5000000}, {.name = "simple", .end_ns = 6000000}};
    char *text;

    (void)state;
    sf_stats_add(&stats, timings, 6, 1, 1, 1);
    assert_true(near(sf_stats_group_ms(&stats, SF_STATS_SIMULATION), 1));
    assert_true(near(sf_stats_group_ms(&stats, SF_STATS_SCENE), 7));
    assert_true(near(sf_stats_group_ms(&stats, SF_STATS_SMOKE), 8));
    assert_true(near(sf_stats_group_ms(&stats, SF_STATS_OUTPUT), 5));
    sf_stats_add(&stats, timings + 1, 1, 1, 1, 1); /* what did not run costs nothing */
    assert_true(sf_stats_group_ms(&stats, SF_STATS_SIMULATION) == 0);
    assert_true(near(sf_stats_group_ms(&stats, SF_STATS_SMOKE), 2));
    text = sf_stats_print(&stats);
    assert_non_null(text);
    assert_non_null(strstr(text, "thick.camera"));
    assert_non_null(strstr(text, "frame on the device"));
    assert_null(strstr(text, "sim.step"));
    free(text);
}

/* The table's block holds its longest lines. */
static void the_longest_table_fits(void **state)
{
    char names[SF_STATS_PASSES][80], *text;
    struct sf_pass_timing timings[SF_STATS_PASSES];
    unsigned lines = 0;

    (void)state;
    for (unsigned i = 0; i < SF_STATS_PASSES; i++) {
        snprintf(names[i], sizeof names[i], "%s.%u.%060d",
                 i % 4 == 0   ? "sim"
                 : i % 4 == 1 ? "scene"
                 : i % 4 == 2 ? "output"
                              : "s",
                 i, 0);
        timings[i] = (struct sf_pass_timing){
            .name = names[i], .end_ns = UINT64_MAX, .bytes_read = UINT64_MAX / 2, .bytes_written = UINT64_MAX / 2};
    }
    stats.ceilings = (struct sf_ceilings){.image_copy_ns = UINT64_MAX, .bytes = 1};
    sf_stats_add(&stats, timings, SF_STATS_PASSES, 1e30f, 1e30f, 1e30f);
    text = sf_stats_print(&stats);
    assert_non_null(text);
    for (const char *at = text; *at; at++)
        lines += *at == '\n';
    assert_int_equal(lines, 1 + SF_STATS_PASSES + SF_STATS_GROUPS + 1);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(runs_of_a_pass_are_summed, setup),
        cmocka_unit_test_setup(medians_are_those_of_a_sort, setup),
        cmocka_unit_test_setup(frames_that_were_not_measured_do_not_count, setup),
        cmocka_unit_test_setup(the_frame_lasts_from_its_first_begin_to_its_last_end, setup),
        cmocka_unit_test_setup(passes_stand_in_the_order_of_the_last_frame, setup),
        cmocka_unit_test_setup(many_passes_and_long_names_are_kept_within_bounds, setup),
        cmocka_unit_test_setup(share_is_of_the_copy, setup),
        cmocka_unit_test_setup(groups_and_their_sums, setup),
        cmocka_unit_test_setup(the_longest_table_fits, setup),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
