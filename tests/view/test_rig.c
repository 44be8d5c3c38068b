/* The viewer's eye. */
#include "../cpu/scratch.h"

#include <math.h>
#include "app/view/rig.h"
#include "chance.h"

static const double PI = 3.14159265358979323846;
static const double HEIGHT = 720; /* px */
enum { TRIALS = 2000 };

static const struct sf_camera_view front = {{0, 1, 6}, {0, 1, 0}, {0, 1, 0}, 40, 0.05f};

static struct sf_rig rig_at(const struct sf_camera_view *view)
{
    struct sf_rig rig = {0};

    sf_rig_follow(&rig, view);
    return rig;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void subtract(const double a[3], const double b[3], double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = a[i] - b[i];
}

static double distance(const double a[3], const double b[3])
{
    double way[3];

    subtract(a, b, way);
    return sqrt(dot(way, way));
}

static void scale_to(double v[3], double length)
{
    double now = sqrt(dot(v, v));

    for (int i = 0; i < 3; i++)
        v[i] *= length / now;
}

/* docs/scene.md, "Camera": ahead, right and above of a rig. */
static void axes_of(const struct sf_rig *rig, double right[3], double above[3], double ahead[3])
{
    subtract(rig->target, rig->eye, ahead);
    scale_to(ahead, 1);
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;

        right[i] = ahead[j] * rig->up[k] - ahead[k] * rig->up[j];
    }
    scale_to(right, 1);
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;

        above[i] = right[j] * ahead[k] - right[k] * ahead[j];
    }
}

/* Where the point is in the picture: -1..1 to the right and up, and its depth. */
static void project(const struct sf_rig *rig, const double point[3], double aspect, double seen[3])
{
    double right[3], above[3], ahead[3], way[3], half = tan(rig->fov * PI / 360);

    axes_of(rig, right, above, ahead);
    subtract(point, rig->eye, way);
    seen[2] = dot(way, ahead);
    seen[0] = dot(way, right) / (seen[2] * half * aspect);
    seen[1] = dot(way, above) / (seen[2] * half);
}

/* Anywhere, looking anywhere but along `up`, which may lean. */
static struct sf_rig random_rig(uint64_t *state)
{
    struct sf_rig rig = {.fov = chance(state, 10, 120), .near_clip = 0.05, .speed = 1};
    double way[3], up[3];

    do {
        for (int i = 0; i < 3; i++) {
            rig.target[i] = chance(state, -10, 10);
            way[i] = chance(state, -1, 1);
            up[i] = chance(state, -0.3, 0.3) + (i == 1);
        }
        scale_to(up, 1);
        scale_to(way, chance(state, 0.1, 20));
    } while (fabs(dot(way, up)) > 0.95 * sqrt(dot(way, way)));
    for (int i = 0; i < 3; i++) {
        rig.eye[i] = rig.target[i] + way[i];
        rig.up[i] = up[i];
    }
    return rig;
}

static void assert_near(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.12g is not %.12g to within %g", a, b, tolerance);
}

static void assert_same_place(const double a[3], const double b[3], double tolerance)
{
    for (int i = 0; i < 3; i++)
        assert_near(a[i], b[i], tolerance);
}

/* ---- whose camera ---- */

static void test_follow(void **state)
{
    struct sf_camera_view scene = {{1, 2, 3.3f}, {-0.1f, 0.2f, 0}, {0.6f, 0.8f, 0.01f}, 35.7f, 0.0123f}, got;
    char sets[SF_RIG_SETS][SF_RIG_SET_BYTES];
    struct sf_rig rig = rig_at(&scene);

    (void)state;
    sf_rig_view(&rig, &got);
    assert_memory_equal(&got, &scene, sizeof got); /* the bits: what is drawn is the scene's own picture */
    assert_int_equal(sf_rig_sets(&rig, sets), 0);
    assert_true(rig.speed > 0);
    sf_rig_orbit(&rig, 0, 0, HEIGHT);
    sf_rig_pan(&rig, 0, 0, HEIGHT);
    sf_rig_look(&rig, 0, 0, HEIGHT);
    sf_rig_dolly(&rig, 0);
    sf_rig_fly(&rig, 0, 0, 0, 1);
    sf_rig_fly(&rig, 1, 1, 1, 0);
    assert_false(rig.own);
    sf_rig_follow(&rig, &front);
    assert_near(rig.eye[2], 6, 0);
    sf_rig_orbit(&rig, 10, 0, HEIGHT);
    assert_true(rig.own);
    sf_rig_follow(&rig, &scene);
    assert_near(rig.target[1], 1, 0);
    sf_rig_release(&rig);
    sf_rig_follow(&rig, &scene);
    sf_rig_view(&rig, &got);
    assert_memory_equal(&got, &scene, sizeof got);
}

/* ---- movements ---- */

static void test_orbit(void **state)
{
    uint64_t seed = 1;

    (void)state;
    for (int trial = 0; trial < TRIALS; trial++) {
        struct sf_rig rig = random_rig(&seed), before = rig;
        double arm[3], away = distance(rig.eye, rig.target);

        for (int i = 0; i < 5; i++)
            sf_rig_orbit(&rig, chance(&seed, -900, 900), chance(&seed, -900, 900), HEIGHT);
        assert_true(rig.own);
        assert_same_place(rig.target, before.target, 0);
        assert_same_place(rig.up, before.up, 0);
        assert_near(distance(rig.eye, rig.target), away, 1e-9);
        subtract(rig.eye, rig.target, arm);
        assert_true(fabs(dot(arm, rig.up)) <= away * sin(89.9001 * PI / 180));
    }
}

/* The side of the scene that is turned to the eye goes with the mouse: the eye goes the other way. */
static void test_orbit_follows_mouse(void **state)
{
    struct sf_rig rig = rig_at(&front);
    uint64_t seed = 2;

    (void)state;
    sf_rig_orbit(&rig, HEIGHT / 2, 0, HEIGHT); /* a quarter turn */
    assert_same_place(rig.eye, (const double[]){-6, 1, 0}, 1e-9);
    rig = rig_at(&front);
    sf_rig_orbit(&rig, 0, HEIGHT / 4, HEIGHT); /* down: the eye rises */
    assert_same_place(rig.eye, (const double[]){0, 1 + 6 * sqrt(0.5), 6 * sqrt(0.5)}, 1e-9);
    sf_rig_orbit(&rig, 0, 10 * HEIGHT, HEIGHT); /* stays short of the pole, above the front */
    assert_same_place(rig.eye, (const double[]){0, 7, 6 * PI / 1800}, 1e-4);
    for (int trial = 0; trial < TRIALS; trial++) {
        double point[3], before[3], after[3], dx = chance(&seed, -5, 5), dy = chance(&seed, -5, 5), moved[2];

        rig = random_rig(&seed);
        for (int i = 0; i < 3; i++)
            point[i] = rig.target[i] + 0.5 * (rig.eye[i] - rig.target[i]);
        project(&rig, point, 1, before);
        sf_rig_orbit(&rig, dx, dy, HEIGHT);
        project(&rig, point, 1, after);
        moved[0] = after[0] - before[0];
        moved[1] = before[1] - after[1];
        assert_true(moved[0] * dx + moved[1] * dy > 0);
    }
}

static void test_pan(void **state)
{
    uint64_t seed = 3;

    (void)state;
    for (int trial = 0; trial < TRIALS; trial++) {
        struct sf_rig rig = random_rig(&seed), before = rig;
        double right[3], above[3], ahead[3], point[3], was[3], is[3], eye_way[3], target_way[3];
        double dx = chance(&seed, -300, 300), dy = chance(&seed, -300, 300);
        double across = chance(&seed, -2, 2), high = chance(&seed, -2, 2);

        axes_of(&rig, right, above, ahead);
        for (int i = 0; i < 3; i++)
            point[i] = rig.target[i] + across * right[i] + high * above[i];
        project(&rig, point, 1, was);
        sf_rig_pan(&rig, dx, dy, HEIGHT);
        project(&rig, point, 1, is);
        assert_near((is[0] - was[0]) * HEIGHT / 2, dx, 1e-6);
        assert_near((was[1] - is[1]) * HEIGHT / 2, dy, 1e-6);
        subtract(rig.eye, before.eye, eye_way);
        subtract(rig.target, before.target, target_way);
        assert_same_place(eye_way, target_way, 1e-12);
    }
}

static void test_dolly(void **state)
{
    uint64_t seed = 4;
    struct sf_rig rig = rig_at(&front);

    (void)state;
    sf_rig_dolly(&rig, 1);
    assert_same_place(rig.eye, (const double[]){0, 1, 5.4}, 1e-12);
    sf_rig_dolly(&rig, -1);
    assert_same_place(rig.eye, (const double[]){0, 1, 6}, 1e-12);
    for (int trial = 0; trial < TRIALS; trial++) {
        double before[3], after[3], was;
        struct sf_camera_view view;

        rig = random_rig(&seed);
        if (trial % 4 == 0) {
            rig.target[0] += 5000; /* where floats are coarse */
            rig.eye[0] += 5000;
        }
        subtract(rig.eye, rig.target, before);
        for (int i = 0; i < 20; i++) {
            was = distance(rig.eye, rig.target);
            sf_rig_dolly(&rig, chance(&seed, 0, trial % 3 ? 30 : 1e6));
            assert_true(distance(rig.eye, rig.target) <= was);
        }
        subtract(rig.eye, rig.target, after);
        scale_to(before, 1);
        assert_true(sqrt(dot(after, after)) >= 1e-4);
        assert_near(dot(before, after), sqrt(dot(after, after)), 1e-9); /* on the same side still */
        sf_rig_view(&rig, &view);
        assert_true(hypot(hypot(view.eye[0] - view.target[0], view.eye[1] - view.target[1]),
                          view.eye[2] - view.target[2]) > 0.5 * sqrt(dot(after, after)));
    }
}

static void test_look(void **state)
{
    struct sf_rig rig = rig_at(&front);
    uint64_t seed = 5;

    (void)state;
    sf_rig_look(&rig, HEIGHT, 0, HEIGHT); /* a quarter turn to the right */
    assert_same_place(rig.target, (const double[]){6, 1, 6}, 1e-9);
    rig = rig_at(&front);
    sf_rig_look(&rig, 0, -HEIGHT / 2, HEIGHT); /* up */
    assert_same_place(rig.target, (const double[]){0, 1 + 6 * sqrt(0.5), 6 - 6 * sqrt(0.5)}, 1e-9);
    for (int trial = 0; trial < TRIALS; trial++) {
        double eye[3], away;

        rig = random_rig(&seed);
        memcpy(eye, rig.eye, sizeof eye);
        away = distance(rig.eye, rig.target);
        sf_rig_look(&rig, chance(&seed, -2000, 2000), chance(&seed, -2000, 2000), HEIGHT);
        assert_same_place(rig.eye, eye, 0);
        assert_near(distance(rig.eye, rig.target), away, 1e-9);
    }
}

static void test_fly(void **state)
{
    struct sf_rig rig = rig_at(&front);

    (void)state;
    rig.speed = 2;
    sf_rig_fly(&rig, 1, 0, 0, 0.5);
    assert_same_place(rig.eye, (const double[]){1, 1, 6}, 1e-12);
    assert_same_place(rig.target, (const double[]){1, 1, 0}, 1e-12);
    sf_rig_fly(&rig, -1, 0.5, 1, 0.5);
    assert_same_place(rig.eye, (const double[]){0, 1.5, 5}, 1e-12);
    assert_same_place(rig.target, (const double[]){0, 1.5, -1}, 1e-12);
    rig.target[1] = -4; /* looking down, "up" is still up */
    sf_rig_fly(&rig, 0, 1, 0, 1);
    assert_same_place(rig.eye, (const double[]){0, 3.5, 5}, 1e-12);
}

/* What a scene's camera may not be is not gone to. */
static void test_bounds(void **state)
{
    struct sf_rig rig = rig_at(&front), before;

    (void)state;
    rig.speed = 1e6;
    before = rig;
    sf_rig_fly(&rig, 0, 0, -1, 1);
    sf_rig_dolly(&rig, -1000);
    sf_rig_pan(&rig, 1e9, 0, HEIGHT);
    sf_rig_orbit(&rig, 1, 1, 0); /* a picture without height */
    sf_rig_look(&rig, 1, 1, 0);
    sf_rig_pan(&rig, 1, 1, 0);
    assert_false(sf_rig_frame(&rig, (const float[]){-9e5f, 0, 0}, (const float[]){9e5f, 1, 1}, 1));
    assert_memory_equal(&rig, &before, sizeof rig);
}

/* ---- framing, sides, presets ---- */

static void test_frame(void **state)
{
    static const double aspects[] = {0.25, 0.5625, 1, 1.777, 4};
    uint64_t seed = 6;

    (void)state;
    for (int trial = 0; trial < TRIALS; trial++) {
        struct sf_rig rig = random_rig(&seed), before = rig;
        double aspect = aspects[trial % 5], most = 0, was[3], is[3];
        float min[3], max[3];

        rig.near_clip = 1e-4; /* so that it keeps no small box away */
        for (int i = 0; i < 3; i++) {
            min[i] = (float)chance(&seed, -20, 20);
            max[i] = min[i] + (float)chance(&seed, 0, trial % 7 ? 5 : 0.1);
        }
        assert_true(sf_rig_frame(&rig, min, max, aspect));
        for (int corner = 0; corner < 8; corner++) {
            double point[3], seen[3];

            for (int i = 0; i < 3; i++)
                point[i] = corner >> i & 1 ? max[i] : min[i];
            project(&rig, point, aspect, seen);
            assert_true(fabs(seen[0]) < 1 && fabs(seen[1]) < 1 && seen[2] > rig.near_clip);
            most = fmax(most, fmax(fabs(seen[0]), fabs(seen[1])));
        }
        assert_true(most >= 0.85);
        subtract(before.target, before.eye, was);
        subtract(rig.target, rig.eye, is);
        assert_near(dot(was, is), sqrt(dot(was, was) * dot(is, is)), 1e-9 * sqrt(dot(was, was) * dot(is, is)));
    }
}

static void test_frame_odd(void **state)
{
    struct sf_rig rig = rig_at(&front), before = rig;

    (void)state;
    assert_false(sf_rig_frame(&rig, (const float[]){1, 0, 0}, (const float[]){-1, 1, 1}, 1)); /* no smoke yet */
    assert_false(sf_rig_frame(&rig, (const float[]){NAN, 0, 0}, (const float[]){1, 1, 1}, 1));
    assert_false(sf_rig_frame(&rig, (const float[]){-1, 0, 0}, (const float[]){1, 1, 1}, 0));
    assert_false(sf_rig_frame(&rig, (const float[]){-1, 0, 0}, (const float[]){1, 1, INFINITY}, 1));
    assert_memory_equal(&rig, &before, sizeof rig);
    /* A point: as near as can be without being cut off. */
    assert_true(sf_rig_frame(&rig, (const float[]){1, 2, 3}, (const float[]){1, 2, 3}, 1));
    assert_same_place(rig.target, (const double[]){1, 2, 3}, 0);
    assert_true(rig.eye[2] - 3 > rig.near_clip && rig.eye[2] - 3 < 2 * rig.near_clip);
}

static void test_sides(void **state)
{
    static const double from[][3] = {
        [SF_RIG_FRONT] = {0, 0, 1}, [SF_RIG_BACK] = {0, 0, -1}, [SF_RIG_LEFT] = {-1, 0, 0},
        [SF_RIG_RIGHT] = {1, 0, 0}, [SF_RIG_TOP] = {0, 1, 0},   [SF_RIG_BOTTOM] = {0, -1, 0},
    };
    static const double to_right[][3] = {
        [SF_RIG_FRONT] = {1, 0, 0},  [SF_RIG_BACK] = {-1, 0, 0}, [SF_RIG_LEFT] = {0, 0, 1},
        [SF_RIG_RIGHT] = {0, 0, -1}, [SF_RIG_TOP] = {1, 0, 0},   [SF_RIG_BOTTOM] = {1, 0, 0},
    };
    uint64_t seed = 7;

    (void)state;
    for (int trial = 0; trial < 60; trial++) {
        enum sf_rig_side side = (enum sf_rig_side)(trial % 6);
        struct sf_rig rig = random_rig(&seed), before = rig;
        double away = distance(rig.eye, rig.target), arm[3], right[3], above[3], ahead[3];
        char sets[SF_RIG_SETS][SF_RIG_SET_BYTES];

        sf_rig_side(&rig, side);
        assert_true(rig.own);
        assert_same_place(rig.target, before.target, 0);
        subtract(rig.eye, rig.target, arm);
        assert_near(sqrt(dot(arm, arm)), away, 1e-9);
        scale_to(arm, 1);
        assert_same_place(arm, from[side], 2e-3);
        axes_of(&rig, right, above, ahead);
        assert_same_place(right, to_right[side], 1e-9);
        assert_int_equal(sf_rig_sets(&rig, sets), SF_RIG_SETS);
    }
}

static void test_presets(void **state)
{
    struct sf_rig rig = rig_at(&front);
    struct sf_camera_view stored, got;

    (void)state;
    assert_false(sf_rig_recall(&rig, 0));
    assert_false(sf_rig_recall(&rig, SF_RIG_PRESETS));
    sf_rig_store(&rig, SF_RIG_PRESETS); /* no such place */
    sf_rig_orbit(&rig, 123, 45, HEIGHT);
    sf_rig_view(&rig, &stored);
    sf_rig_store(&rig, 8);
    sf_rig_fly(&rig, 1, 2, 3, 4);
    sf_rig_release(&rig);
    assert_false(sf_rig_recall(&rig, 7));
    assert_true(sf_rig_recall(&rig, 8));
    assert_true(rig.own);
    sf_rig_view(&rig, &got);
    assert_memory_equal(&got, &stored, sizeof got);
}

/* ---- sets ---- */

static const char *const scenes[] = {
    "{\"method\":\"none\"}",
    "{\"method\":\"none\",\"camera\":{\"type\":\"orbit\",\"period\":3,\"fov\":60}}",
    "{\"method\":\"none\",\"camera\":{\"type\":\"keyframes\",\"up\":[1,2,0],\"keys\":["
    "{\"time\":0,\"eye\":[0,1,5],\"target\":[0,0,0]},{\"time\":1,\"eye\":[1,1,5],\"target\":[0,0,0]}]}}",
};

/* A scene with these sets has the rig's eye, bit for bit, whatever camera its file has. */
static void test_sets(void **state)
{
    struct caught caught = {0};
    const struct sf_log log = {.write = caught_write, .user = &caught, .level = SF_LOG_ERROR};
    uint64_t seed = 8;

    (void)state;
    for (int trial = 0; trial < TRIALS; trial++) {
        const char *text = scenes[trial % 3], *pointers[SF_RIG_SETS];
        char sets[SF_RIG_SETS][SF_RIG_SET_BYTES];
        struct sf_rig rig = random_rig(&seed);
        struct sf_camera_view drawn, read;
        struct sf_scene *scene;
        unsigned count;

        if (trial % 5 == 0)
            sf_rig_side(&rig, (enum sf_rig_side)(trial / 5 % 6));
        if (trial % 11 == 0)
            rig.eye[0] = -rig.target[0] * 1e-30;
        rig.near_clip = trial % 13 ? chance(&seed, 1e-4, 1) : 1e-4;
        sf_rig_orbit(&rig, chance(&seed, -500, 500), chance(&seed, -500, 500), HEIGHT);
        sf_rig_view(&rig, &drawn);
        count = sf_rig_sets(&rig, sets);
        assert_int_equal(count, SF_RIG_SETS);
        for (unsigned i = 0; i < count; i++) {
            assert_true(strlen(sets[i]) < SF_RIG_SET_BYTES - 32);
            pointers[i] = sets[i];
        }
        if (sf_scene_parse("test", text, strlen(text), pointers, count, &log, &scene) != SF_OK)
            fail_msg("%s", caught.text);
        sf_scene_view(scene, 0.7, &read);
        sf_scene_destroy(&scene);
        assert_memory_equal(&read, &drawn, sizeof read);
    }
}

/* The renderer's axes, by hand: looking along -z, +x is to the right; a leaning `up` leans the picture. */
static void test_axes(void **state)
{
    struct sf_camera_view leaning = {{2, 3, 4}, {2, 3, -1}, {1, 1, 0}, 40, 0.05f},
                          along = {{0, 5, 0}, {0, 0, 0}, {0, 1, 0}, 40, 0.05f};
    double right[3], above[3], forward[3], root = sqrt(0.5);

    (void)state;
    sf_view_axes(&front, right, above, forward);
    assert_same_place(right, (const double[]){1, 0, 0}, 1e-15);
    assert_same_place(above, (const double[]){0, 1, 0}, 1e-15);
    assert_same_place(forward, (const double[]){0, 0, -1}, 1e-15);
    sf_view_axes(&leaning, right, above, forward);
    assert_same_place(right, (const double[]){root, -root, 0}, 1e-15);
    assert_same_place(above, (const double[]){root, root, 0}, 1e-15);
    sf_view_axes(&along, right, above, forward); /* no picture of a scene, but it has axes */
    assert_near(dot(right, right) + dot(above, above), 2, 1e-12);
    assert_near(dot(right, forward), 0, 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_follow),    cmocka_unit_test(test_orbit),  cmocka_unit_test(test_orbit_follows_mouse),
        cmocka_unit_test(test_pan),       cmocka_unit_test(test_dolly),  cmocka_unit_test(test_look),
        cmocka_unit_test(test_fly),       cmocka_unit_test(test_bounds), cmocka_unit_test(test_frame),
        cmocka_unit_test(test_frame_odd), cmocka_unit_test(test_sides),  cmocka_unit_test(test_presets),
        cmocka_unit_test(test_sets),      cmocka_unit_test(test_axes),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
