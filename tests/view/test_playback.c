/* Which frame is shown when, on made-up clocks. */
#include "../cpu/scratch.h"

#include <math.h>
#include "app/view/playback.h"
#include "chance.h"

static const uint64_t MS = 1000000, START = 5000 * 1000000ull;
static const double FPS = 24;

/* Playing since START. */
static struct sf_playback started(void)
{
    struct sf_playback playback;

    sf_playback_init(&playback, FPS);
    assert_true(playback.playing);
    assert_false(sf_playback_tick(&playback, START)); /* whatever the clock says at first */
    assert_int_equal(playback.frame, 0);
    return playback;
}

static void assert_near(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.12g is not %.12g to within %g", a, b, tolerance);
}

/* Pictures that are quick, slow, and now and then very slow: what time says, on average and never off by more than what
 * was put off. */
static void test_real_time(void **state)
{
    struct sf_playback playback = started();
    uint64_t now = START, seed = 1;

    (void)state;
    for (int picture = 0; picture < 20000; picture++) {
        uint32_t before = playback.frame;
        bool changed;

        now += (uint64_t)((double)MS * (picture % 10 == 0 ? chance(&seed, 100, 300) : chance(&seed, 1, 60)));
        changed = sf_playback_tick(&playback, now);
        assert_true(changed == (playback.frame != before));
        assert_true(playback.frame - before <= 4 && playback.frame >= before);
        assert_near(playback.frame, (double)(now - START) * 1e-9 * FPS, 5);
    }
    assert_true(playback.frame > 15000);
}

/* At 60 pictures a second no frame is passed over, and each comes as soon as it is due. */
static void test_every_frame(void **state)
{
    struct sf_playback playback = started();
    uint32_t last = 0;

    (void)state;
    for (int picture = 1; picture <= 6000; picture++) {
        uint64_t now = START + (uint64_t)picture * 16666667;

        sf_playback_tick(&playback, now);
        assert_true(playback.frame - last <= 1);
        assert_int_equal(playback.frame, (uint32_t)((double)(now - START) * 1e-9 * FPS));
        last = playback.frame;
    }
}

static void test_due(void **state)
{
    struct sf_playback playback;

    (void)state;
    sf_playback_init(&playback, FPS);
    assert_near(sf_playback_due(&playback, START), 0, 0); /* the clock must begin */
    playback = started();
    assert_near(sf_playback_due(&playback, START), 1 / FPS, 1e-9);
    assert_near(sf_playback_due(&playback, START + 10 * MS), 1 / FPS - 0.01, 1e-9);
    assert_near(sf_playback_due(&playback, START + 100 * MS), 0, 0);
    sf_playback_tick(&playback, START + 10 * MS);
    assert_near(sf_playback_due(&playback, START + 10 * MS), 1 / FPS - 0.01, 1e-9);
    /* Sleeping until it is due makes it change. */
    assert_true(sf_playback_tick(&playback, START + (uint64_t)(1e9 / FPS) + 1));
    sf_playback_faster(&playback, -1);
    assert_near(sf_playback_due(&playback, playback.last_ns), 2 / FPS, 1e-6);
    sf_playback_toggle(&playback);
    assert_true(sf_playback_due(&playback, START) >= 1e6);
}

/* A scene's every picture slower than 4 frames: slow motion, not jumps. A machine that slept: the same. */
static void test_no_jump(void **state)
{
    struct sf_playback playback = started();
    uint64_t now = START;
    uint32_t before;

    (void)state;
    for (uint32_t picture = 1; picture <= 100; picture++) {
        assert_true(sf_playback_tick(&playback, now += 400 * MS));
        assert_int_equal(playback.frame, 4 * picture);
    }
    before = playback.frame;
    sf_playback_tick(&playback, now += 3600 * 1000 * MS);
    assert_int_equal(playback.frame, before + 4);
    for (int picture = 0; picture < 60; picture++)
        sf_playback_tick(&playback, now += 1000 * MS / 60);
    assert_true(playback.frame >= before + 4 + 24 && playback.frame <= before + 4 + 24 + 5);
    before = playback.frame;
    assert_false(sf_playback_tick(&playback, now - 1000 * MS)); /* a clock that goes back passes no time */
    assert_int_equal(playback.frame, before);
}

static void test_speed(void **state)
{
    static const struct {
        int doublings;
        double speed;
    } cases[] = {{0, 1}, {1, 2}, {2, 4}, {3, 4}, {50, 4}, {-1, 0.5}, {-4, 0.0625}, {-5, 0.0625}, {-2000, 0.0625}};

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct sf_playback playback = started();
        uint64_t now = START;

        sf_playback_faster(&playback, cases[i].doublings);
        assert_near(playback.speed, cases[i].speed, 0);
        for (int picture = 0; picture < 600; picture++)
            sf_playback_tick(&playback, now += 20 * MS);
        assert_near(playback.frame, 12 * FPS * cases[i].speed, 1);
    }
}

static void test_pause(void **state)
{
    struct sf_playback playback = started();
    uint64_t now = START;
    uint32_t frame;

    (void)state;
    for (int picture = 0; picture < 37; picture++)
        sf_playback_tick(&playback, now += 20 * MS);
    frame = playback.frame;
    sf_playback_toggle(&playback);
    assert_false(playback.playing);
    for (int picture = 0; picture < 50; picture++)
        assert_false(sf_playback_tick(&playback, now += 20 * MS));
    assert_int_equal(playback.frame, frame);
    /* The clock was not read for a while either: minimised. */
    sf_playback_toggle(&playback);
    assert_false(sf_playback_tick(&playback, now += 60 * 1000 * MS));
    assert_int_equal(playback.frame, frame);
    assert_true(sf_playback_tick(&playback, now += (uint64_t)(1e9 / FPS) + 1));
    assert_int_equal(playback.frame, frame + 1);
}

static void test_step(void **state)
{
    struct sf_playback playback = started();

    (void)state;
    sf_playback_step(&playback, 1);
    assert_false(playback.playing);
    assert_int_equal(playback.frame, 1);
    assert_false(sf_playback_tick(&playback, START + 1000 * MS));
    sf_playback_step(&playback, -1);
    assert_int_equal(playback.frame, 0);
    sf_playback_step(&playback, -1);
    assert_int_equal(playback.frame, 0);
    sf_playback_step(&playback, 10);
    sf_playback_step(&playback, -100);
    assert_int_equal(playback.frame, 0);
    sf_playback_seek(&playback, SF_PLAYBACK_LAST - 1);
    sf_playback_step(&playback, 5);
    assert_int_equal(playback.frame, SF_PLAYBACK_LAST);
}

static void test_seek(void **state)
{
    struct sf_playback playback = started();

    (void)state;
    sf_playback_tick(&playback, START + 40 * MS);
    sf_playback_seek(&playback, 100);
    assert_true(playback.playing);
    assert_int_equal(playback.frame, 100);
    /* The way there took ten seconds, which the picture then does not skip. */
    assert_false(sf_playback_tick(&playback, START + 10000 * MS));
    assert_true(sf_playback_tick(&playback, START + 10050 * MS));
    assert_int_equal(playback.frame, 101);
    sf_playback_toggle(&playback);
    sf_playback_seek(&playback, 3);
    assert_false(playback.playing);
    assert_int_equal(playback.frame, 3);
    sf_playback_seek(&playback, UINT32_MAX);
    assert_int_equal(playback.frame, SF_PLAYBACK_LAST);
    sf_playback_toggle(&playback);
    sf_playback_tick(&playback, START);
    assert_false(sf_playback_tick(&playback, START + 1000 * MS)); /* there is no further frame */
    assert_int_equal(playback.frame, SF_PLAYBACK_LAST);
}

static void test_longest(void **state)
{
    struct sf_playback playback = started();
    uint64_t now = START;

    (void)state;
    assert_int_equal(playback.longest, 240);
    sf_playback_seek(&playback, 239);
    assert_int_equal(playback.longest, 240);
    for (int picture = 0; picture < 100; picture++)
        sf_playback_tick(&playback, now += 40 * MS);
    assert_true(playback.frame > 240);
    assert_int_equal(playback.longest, playback.frame);
    sf_playback_seek(&playback, 500);
    sf_playback_step(&playback, 1);
    sf_playback_seek(&playback, 0);
    assert_int_equal(playback.longest, 501);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_real_time), cmocka_unit_test(test_every_frame), cmocka_unit_test(test_due),
        cmocka_unit_test(test_no_jump),   cmocka_unit_test(test_speed),       cmocka_unit_test(test_pause),
        cmocka_unit_test(test_step),      cmocka_unit_test(test_seek),        cmocka_unit_test(test_longest),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
