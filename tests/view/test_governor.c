/* Coarser smoke while the camera moves: pictures of known cost, with noise. */
#include "../cpu/scratch.h"

#include <math.h>
#include "app/view/governor.h"
#include "chance.h"

static const uint64_t MS = 1000000;

/* A viewer that draws one picture after the other. */
struct viewer {
    struct sf_governor governor;
    const double *costs; /* ms of each level */
    double noise;        /* share, to either side */
    uint64_t now, seed;
    unsigned finest;
    double last; /* ms of the last picture; 0: none yet */
    unsigned changes;
    double late; /* ms of the picture before, when they come back one later */
    bool pipelined;
};

static struct viewer viewer(const double *costs, double noise)
{
    return (struct viewer){.governor = {.on = true, .goal_ms = 50},
                           .costs = costs,
                           .noise = noise,
                           .now = 1000 * MS,
                           .seed = 1,
                           .finest = 2};
}

/* One picture; answers its cost. */
static double draw(struct viewer *viewer, bool moved)
{
    double known = viewer->pipelined ? viewer->late : viewer->last, cost;

    viewer->late = viewer->last;
    viewer->changes += sf_governor_update(&viewer->governor, viewer->now, moved, known, viewer->finest);
    cost = viewer->costs[viewer->governor.level] * chance(&viewer->seed, 1 - viewer->noise, 1 + viewer->noise);
    viewer->last = cost;
    viewer->now += (uint64_t)(cost * (double)MS);
    return cost;
}

static void draw_many(struct viewer *viewer, unsigned pictures, bool moved)
{
    for (unsigned i = 0; i < pictures; i++)
        draw(viewer, moved);
}

/* ---- the goal ---- */

static void test_holds_goal(void **state)
{
    static const struct {
        double costs[SF_GOVERNOR_LEVELS];
        unsigned finest, level;
    } cases[] = {
        {{10, 5, 2}, 2, 0},      {{45, 20, 9}, 2, 0},    {{120, 40, 15}, 2, 1},  {{400, 120, 30}, 2, 2},
        {{900, 300, 120}, 2, 2}, {{400, 120, 30}, 1, 1}, {{400, 120, 30}, 0, 0}, {{400, 120, 30}, 9, 2},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        for (int late = 0; late <= 1; late++) {
            struct viewer v = viewer(cases[i].costs, 0.05);

            v.finest = cases[i].finest;
            v.pipelined = late;
            draw_many(&v, 12, true);
            assert_int_equal(v.governor.level, cases[i].level);
            v.changes = 0;
            draw_many(&v, 200, true);
            assert_int_equal(v.governor.level, cases[i].level);
            assert_int_equal(v.changes, 0);
        }
    }
}

/* What is known from before is gone to at once. */
static void test_remembers(void **state)
{
    static const double costs[] = {400, 120, 30};
    struct viewer v = viewer(costs, 0.05);

    (void)state;
    draw_many(&v, 5, false);
    draw_many(&v, 10, true);
    assert_int_equal(v.governor.level, 2);
    draw_many(&v, 12, false);
    assert_int_equal(v.governor.level, 0);
    draw(&v, true);
    assert_int_equal(v.governor.level, 2);
}

/* ---- rest ---- */

static void test_refines(void **state)
{
    struct sf_governor governor = {.on = true, .goal_ms = 50, .cost_ms = {200, 30, 10}, .finest = 2};
    uint64_t now = 1000 * MS;

    (void)state;
    assert_false(sf_governor_update(&governor, now, false, 0, 2)); /* it has never moved */
    assert_true(sf_governor_update(&governor, now, true, 0, 2));
    assert_int_equal(governor.level, 1);
    assert_false(sf_governor_update(&governor, now + 100 * MS, true, 0, 2));
    assert_false(sf_governor_update(&governor, now + 349 * MS, false, 0, 2)); /* 249 ms after the last movement */
    assert_int_equal(governor.level, 1);
    assert_true(sf_governor_update(&governor, now + 350 * MS, false, 0, 2));
    assert_int_equal(governor.level, 0);
    assert_false(sf_governor_update(&governor, now + 5000 * MS, false, 0, 2));
}

/* ---- no flicker ---- */

/* Costs right at the goal, with much noise: the level changes a few times a minute at most. */
static void test_no_flicker(void **state)
{
    static const double costs[][SF_GOVERNOR_LEVELS] = {{50, 25, 10}, {52, 48, 44},  {47, 40, 20},
                                                       {60, 50, 40}, {300, 51, 49}, {55, 8, 4}};

    (void)state;
    for (size_t i = 0; i < sizeof costs / sizeof *costs; i++) {
        for (uint64_t seed = 1; seed <= 20; seed++) {
            struct viewer v = viewer(costs[i], 0.15);
            uint64_t begin = v.now;

            v.seed = seed;
            draw_many(&v, 12, true);
            v.changes = 0;
            while (v.now < begin + 60000 * MS)
                draw(&v, true);
            if (v.changes > 6)
                fail_msg("costs %zu, seed %u: %u changes in a minute", i, (unsigned)seed, v.changes);
        }
    }
}

/* One picture that took long, whatever else the machine did, is no reason. */
static void test_hiccup(void **state)
{
    static const double costs[] = {30, 10, 5};
    struct viewer v = viewer(costs, 0.05);

    (void)state;
    draw_many(&v, 20, true);
    for (int i = 0; i < 20; i++) {
        v.last = 500;
        draw_many(&v, 10, true);
    }
    assert_int_equal(v.changes, 0);
}

/* A level begins slowly: its pipelines are made, and one picture more is unlucky. */
static void test_slow_beginning(void **state)
{
    struct sf_governor governor = {.on = true, .goal_ms = 50, .cost_ms = {200}, .finest = 2};
    static const double pictures[] = {400, 20, 90, 21, 22, 23};

    (void)state;
    assert_true(sf_governor_update(&governor, 1000 * MS, true, 0, 2));
    for (int i = 0; i < 6; i++)
        assert_false(sf_governor_update(&governor, 1000 * MS, true, pictures[i], 2));
    assert_int_equal(governor.level, 1);
    assert_true(governor.cost_ms[1] > 19 && governor.cost_ms[1] < 24);
}

/* However cheap it becomes: not finer again within a second. */
static void test_stays(void **state)
{
    struct sf_governor governor = {.on = true, .goal_ms = 50, .cost_ms = {60, 20, 5}, .finest = 2};
    uint64_t begin = 1000 * MS, now = begin;

    (void)state;
    assert_true(sf_governor_update(&governor, now, true, 0, 2));
    for (int i = 0; governor.level == 1 && i < 100; i++)
        sf_governor_update(&governor, now += 20 * MS, true, i < 5 ? 20 + 0.1 * i : 5 + 0.01 * i, 2);
    assert_int_equal(governor.level, 0);
    assert_true(now >= begin + 1000 * MS && now <= begin + 1100 * MS);
}

/* ---- changing scenes ---- */

/* The camera goes into the smoke and comes out again, in one movement. */
static void test_follows_cost(void **state)
{
    double costs[] = {30, 12, 6};
    struct viewer v = viewer(costs, 0.05);

    (void)state;
    draw_many(&v, 20, true);
    assert_int_equal(v.governor.level, 0);
    for (int i = 0; i < 3; i++)
        costs[i] *= 3;
    draw_many(&v, 20, true);
    assert_int_equal(v.governor.level, 1);
    for (int i = 0; i < 3; i++)
        costs[i] /= 3;
    draw_many(&v, 200, true);
    assert_int_equal(v.governor.level, 0);
    assert_true(v.changes <= 3);
}

/* Another scene, whose finest resolution is another: costs are of no use any more. */
static void test_forgets(void **state)
{
    static const double slow[] = {400, 120, 30}, fast[] = {5, 5, 5};
    struct viewer v = viewer(slow, 0.05);

    (void)state;
    draw_many(&v, 20, true);
    assert_int_equal(v.governor.level, 2);
    v.finest = 1;
    v.costs = fast;
    v.governor.level = 0; /* as the caller does with a new scene */
    draw_many(&v, 300, true);
    assert_int_equal(v.governor.level, 0);
}

/* The caller may ask often while no picture comes back, and draw the finest one for its own reasons. */
static void test_same_picture(void **state)
{
    struct sf_governor governor = {.on = true, .goal_ms = 50};
    static const double pictures[] = {90.1, 90.2, 90.3, 90.4};

    (void)state;
    for (int i = 0; i < 4; i++)
        for (int again = 0; again < 20; again++)
            sf_governor_update(&governor, 1000 * MS, true, pictures[i], 2);
    assert_int_equal(governor.level, 1); /* not 2: nothing is known of it */
    assert_true(governor.cost_ms[1] == 0);
    governor.level = 0;
    sf_governor_update(&governor, 1000 * MS, false, 90.5, 2);
    assert_true(governor.cost_ms[0] > 80 && governor.cost_ms[1] == 0);
}

static void test_off(void **state)
{
    static const double costs[] = {400, 120, 30};
    struct viewer v = viewer(costs, 0.05);

    (void)state;
    v.governor.on = false;
    draw_many(&v, 50, true);
    assert_int_equal(v.changes, 0);
    v.governor.on = true;
    draw_many(&v, 20, true);
    assert_int_equal(v.governor.level, 2);
    v.governor.on = false;
    v.changes = 0;
    draw(&v, true);
    assert_int_equal(v.governor.level, 0);
    assert_int_equal(v.changes, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_holds_goal),     cmocka_unit_test(test_remembers),    cmocka_unit_test(test_refines),
        cmocka_unit_test(test_no_flicker),     cmocka_unit_test(test_hiccup),       cmocka_unit_test(test_follows_cost),
        cmocka_unit_test(test_forgets),        cmocka_unit_test(test_same_picture), cmocka_unit_test(test_off),
        cmocka_unit_test(test_slow_beginning), cmocka_unit_test(test_stays),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
