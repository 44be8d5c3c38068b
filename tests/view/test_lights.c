/* Lights' handles in the picture. */
#include "../cpu/scratch.h"

#include <math.h>
#include "app/view/lights.h"
#include "app/view/rig.h"
#include "chance.h"

static const double PI = 3.14159265358979323846;
enum { TRIALS = 400 };
enum { SUN, BULB, SPOT }; /* of the scene below */

static const struct sf_camera_view front = {{0, 0, 10}, {0, 0, 0}, {0, 1, 0}, 90, 0.05f};

static struct caught caught;
static const struct sf_log log_caught = {.write = caught_write, .user = &caught, .level = SF_LOG_ERROR};
static const char text[] =
    "{\"method\":\"none\",\"lights\":["
    "{\"type\":\"directional\",\"direction\":[0,-2,0],\"color\":[1,0.5,0.25]},"
    "{\"type\":\"point\",\"position\":[2,1,3],\"color\":[10,20,5]},"
    "{\"type\":\"spot\",\"position\":[-2,3,1],\"direction\":[2,-3,-1],\"color\":[0,0,0],\"inner\":10,\"outer\":20}]}";

/* The scene with sets, and its controls. */
struct world {
    struct sf_scene *scene;
    struct sf_control *controls;
    uint32_t count;
};

static struct world make_world(const char *const *sets, uint32_t set_count)
{
    struct world world = {0};

    if (sf_scene_parse("test", text, strlen(text), sets, set_count, &log_caught, &world.scene) != SF_OK)
        fail_msg("%s", caught.text);
    assert_int_equal(sf_scene_controls(world.scene, &log_caught, &world.controls, &world.count), SF_OK);
    return world;
}

static void end_world(struct world *world)
{
    free(world->controls);
    sf_scene_destroy(&world->scene);
}

/* The same world after what dragging or turning answered. */
static void change_world(struct world *world, char sets[SF_LIGHT_SETS][SF_LIGHT_SET_BYTES], unsigned count)
{
    const char *all[32] = {NULL};
    char *kept[32];
    uint32_t n = 0;

    /* All values of the lights as they are, then the new ones. */
    for (uint32_t i = 0; i < world->count; i++)
        if (strncmp(world->controls[i].path, "lights.", 7) == 0 &&
            (strstr(world->controls[i].path, "position") || strstr(world->controls[i].path, "direction")))
            all[n] = kept[n] = sf_control_print(&world->controls[i]), n++;
    uint32_t owned = n;
    for (unsigned i = 0; i < count; i++)
        all[n++] = sets[i];
    struct world next = make_world(all, n);
    end_world(world);
    *world = next;
    for (uint32_t i = 0; i < owned; i++)
        free(kept[i]);
}

static const struct sf_handle *find(const struct sf_handle *handles, unsigned count, unsigned light,
                                    enum sf_handle_kind kind)
{
    for (unsigned i = 0; i < count; i++)
        if (handles[i].light == light && handles[i].kind == kind)
            return &handles[i];
    fail_msg("light %u has no handle of kind %d", light, (int)kind);
    return NULL;
}

static struct sf_handle handle_of(const struct world *world, const struct sf_camera_view *view, float width,
                                  float height, unsigned light, enum sf_handle_kind kind)
{
    struct sf_handle handles[SF_HANDLES_MAX];
    unsigned count = sf_handles_find(world->controls, world->count, view, width, height, handles);

    return *find(handles, count, light, kind);
}

static void assert_near(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.12g is not %.12g to within %g", a, b, tolerance);
}

static void assert_point(const double point[3], double x, double y, double z, double tolerance)
{
    assert_near(point[0], x, tolerance);
    assert_near(point[1], y, tolerance);
    assert_near(point[2], z, tolerance);
}

/* Looking at the middle of the world, from anywhere but straight above. */
static struct sf_camera_view random_view(uint64_t *state)
{
    double turn = chance(state, 0, 2 * PI), rise = chance(state, -1.2, 1.2), away = chance(state, 2.5, 15);
    struct sf_camera_view view = front;

    for (int i = 0; i < 3; i++)
        view.target[i] = (float)chance(state, -1, 1);
    view.eye[0] = view.target[0] + (float)(away * cos(rise) * sin(turn));
    view.eye[1] = view.target[1] + (float)(away * sin(rise));
    view.eye[2] = view.target[2] + (float)(away * cos(rise) * cos(turn));
    view.fov = (float)chance(state, 20, 100);
    return view;
}

/* ---- finding ---- */

/* By hand: 90 degrees and 10 m before the eye show 10 m up and down, so in 400 px of height 20 px a metre. */
static void test_projection(void **state)
{
    struct world world = make_world(NULL, 0);
    struct sf_handle handles[SF_HANDLES_MAX];
    unsigned count = sf_handles_find(world.controls, world.count, &front, 600, 400, handles);
    const struct sf_handle *bulb = find(handles, count, BULB, SF_HANDLE_POSITION);
    const struct sf_handle *lamp = find(handles, count, SPOT, SF_HANDLE_POSITION);
    const struct sf_handle *aim = find(handles, count, SPOT, SF_HANDLE_AIM);
    const struct sf_handle *sun = find(handles, count, SUN, SF_HANDLE_SUN);

    (void)state;
    assert_int_equal(count, 4);
    assert_point(bulb->point, 2, 1, 3, 0); /* 7 m away: 200 / 7 px a metre */
    assert_near(bulb->x, 300 + 2 * 200 / 7.0, 1e-4);
    assert_near(bulb->y, 200 - 200 / 7.0, 1e-4);
    assert_near(lamp->x, 300 - 2 * 200 / 9.0, 1e-4);
    assert_near(lamp->y, 200 - 3 * 200 / 9.0, 1e-4);
    /* As far from its lamp as the target, which it is aimed at. */
    assert_point(aim->point, 0, 0, 0, 1e-6);
    assert_near(aim->x, 300, 1e-4);
    assert_near(aim->y, 200, 1e-4);
    assert_near(aim->from_x, lamp->x, 1e-4);
    assert_near(aim->from_y, lamp->y, 1e-4);
    /* Straight above the target, and its line ends there. */
    assert_true(sun->visible && sun->point[1] > 0);
    assert_near(sun->x, 300, 1e-4);
    assert_near(sun->y, 200 - 20 * sun->point[1], 1e-4);
    assert_near(sun->from_x, 300, 1e-4);
    assert_near(sun->from_y, 200, 1e-4);
    end_world(&world);
}

static void test_colors(void **state)
{
    static const float expected[][3] = {{1, 0.5f, 0.25f}, {0.5f, 1, 0.25f}, {1, 1, 1}};
    struct world world = make_world(NULL, 0);
    struct sf_handle handles[SF_HANDLES_MAX];
    unsigned count = sf_handles_find(world.controls, world.count, &front, 600, 400, handles);

    (void)state;
    for (unsigned i = 0; i < count; i++)
        for (int c = 0; c < 3; c++)
            assert_near(handles[i].color[c], expected[handles[i].light][c], 1e-6);
    end_world(&world);
}

/* What is behind the eye is not there; a line that leads behind it is cut where it leaves the view. */
static void test_behind(void **state)
{
    const char *sets[] = {"lights.1.position=0,0,11", "lights.2.position=1,0,19", "lights.2.direction=0,0,-1"};
    struct world world = make_world(sets, 3);
    struct sf_handle handles[SF_HANDLES_MAX], *aim;
    unsigned count = sf_handles_find(world.controls, world.count, &front, 600, 400, handles);

    (void)state;
    assert_false(find(handles, count, BULB, SF_HANDLE_POSITION)->visible);
    assert_false(find(handles, count, SPOT, SF_HANDLE_POSITION)->visible);
    assert_int_equal(sf_handles_pick(handles, count, 0, 0, 0.5f), -1); /* where the hidden ones say they are */
    aim = (struct sf_handle *)find(handles, count, SPOT, SF_HANDLE_AIM);
    assert_true(aim->visible);
    assert_true(aim->from_x > 600 && isfinite(aim->from_x)); /* at 1 m to the right, 0.05 m before the eye */
    assert_near(aim->from_x, 300 + 200 / 0.05, 0.1);
    assert_near(aim->from_y, 200, 1e-3);
    assert_int_equal(sf_handles_find(world.controls, world.count, &front, 0, 400, handles), 0);
    assert_int_equal(sf_handles_find(world.controls, 0, &front, 600, 400, handles), 0);
    end_world(&world);
}

/* Suns can be grabbed wherever they shine from, in pictures of any shape. */
static void test_suns_are_inside(void **state)
{
    static const float sizes[][2] = {{600, 400}, {200, 900}, {1600, 100}, {1, 1}};
    uint64_t seed = 1;

    (void)state;
    for (int trial = 0; trial < TRIALS; trial++) {
        const float *size = sizes[trial % 4];
        struct sf_camera_view view = random_view(&seed);
        char set[SF_LIGHT_SET_BYTES];
        const char *sets[] = {set};

        view.fov = trial % 9 ? view.fov : 170;
        snprintf(set, sizeof set, "lights.0.direction=%.9g,%.9g,%.9g", chance(&seed, -1, 1), chance(&seed, -1, 1),
                 chance(&seed, -1, 1));
        struct world world = make_world(sets, 1);
        struct sf_handle sun = handle_of(&world, &view, size[0], size[1], SUN, SF_HANDLE_SUN);
        assert_true(sun.visible);
        assert_true(sun.x > 0 && sun.x < size[0] && sun.y > 0 && sun.y < size[1]);
        end_world(&world);
    }
}

static void test_pick(void **state)
{
    const struct sf_handle handles[] = {
        {.visible = true, .x = 100, .y = 100},
        {.visible = false, .x = 111, .y = 100},
        {.visible = true, .x = 120, .y = 100},
        {.visible = true, .x = 120, .y = 100},
    };

    (void)state;
    assert_int_equal(sf_handles_pick(handles, 4, 109, 100, 20), 0);
    assert_int_equal(sf_handles_pick(handles, 4, 111, 100, 20), 2);
    assert_int_equal(sf_handles_pick(handles, 4, 100, 110, 10), 0);
    assert_int_equal(sf_handles_pick(handles, 4, 100, 110.5f, 10), -1);
    assert_int_equal(sf_handles_pick(handles, 0, 100, 100, 10), -1);
}

/* ---- dragging ---- */

/* Whatever is dragged, wherever: it is under the mouse afterwards. */
static void test_drag_positions(void **state)
{
    uint64_t seed = 2;

    (void)state;
    for (int trial = 0; trial < TRIALS; trial++) {
        unsigned light = trial % 2 ? BULB : SPOT;
        struct sf_camera_view view = random_view(&seed);
        struct world world = make_world(NULL, 0);
        struct sf_handle before = handle_of(&world, &view, 640, 360, light, SF_HANDLE_POSITION), after;
        float x = (float)chance(&seed, 0, 640), y = (float)chance(&seed, 0, 360);
        char sets[SF_LIGHT_SETS][SF_LIGHT_SET_BYTES];
        unsigned count = sf_handle_drag(&before, world.controls, world.count, &view, 640, 360, x, y, false, sets);

        assert_int_equal(count, 1);
        if (before.visible) {
            double moved = 0;

            change_world(&world, sets, count);
            after = handle_of(&world, &view, 640, 360, light, SF_HANDLE_POSITION);
            assert_near(after.x, x, 1e-3);
            assert_near(after.y, y, 1e-3);
            for (int i = 0; i < 3; i++) /* in the plane that faces the eye */
                moved += (after.point[i] - before.point[i]) * ((double)view.target[i] - view.eye[i]);
            assert_near(moved, 0, 1e-4);
        }
        end_world(&world);
    }
}

/* How far beside the sphere the ray through (x, y) of 640 x 360 px passes, m; below 0: it hits. docs/scene.md, "Camera". */
static double beside(const struct sf_camera_view *view, float x, float y, const double centre[3], double radius)
{
    double right[3], above[3], forward[3], ray[3], arm[3], rays = 0, arms = 0, both = 0;
    double half = tan(view->fov * PI / 360), a = (2 * x / 640 - 1) * half * 640 / 360, b = (1 - 2 * y / 360) * half;

    sf_view_axes(view, right, above, forward);
    for (int i = 0; i < 3; i++) {
        ray[i] = forward[i] + a * right[i] + b * above[i];
        arm[i] = centre[i] - view->eye[i];
        rays += ray[i] * ray[i];
        arms += arm[i] * arm[i];
        both += ray[i] * arm[i];
    }
    if (arms < radius * radius) /* from inside every ray hits */
        return -radius;
    return (both > 0 ? sqrt(fmax(arms - both * both / rays, 0)) : sqrt(arms)) - radius;
}

/* Suns go round the target and aims round their lamps: under the mouse, on the side that was asked for, wherever their
 * sphere is under it. */
static void test_drag_directions(void **state)
{
    unsigned hits[2][2] = {{0}}, inside = 0;
    uint64_t seed = 3;

    (void)state;
    for (int trial = 0; trial < 2 * TRIALS; trial++) {
        bool sun = trial % 2 == 0, far = trial / 2 % 2 == 1;
        enum sf_handle_kind kind = sun ? SF_HANDLE_SUN : SF_HANDLE_AIM;
        unsigned light = sun ? SUN : SPOT;
        struct sf_camera_view view = random_view(&seed);
        struct world world = make_world(NULL, 0);
        struct sf_handle handle = handle_of(&world, &view, 640, 360, light, kind);
        struct sf_handle lamp = handle_of(&world, &view, 640, 360, SPOT, SF_HANDLE_POSITION);
        float x = (float)chance(&seed, 0, 640), y = (float)chance(&seed, 0, 360);
        char sets[SF_LIGHT_SETS][SF_LIGHT_SET_BYTES];
        double centre[3], radius = 0, away;

        for (int i = 0; i < 3; i++) {
            centre[i] = sun ? view.target[i] : lamp.point[i];
            radius += (handle.point[i] - centre[i]) * (handle.point[i] - centre[i]);
        }
        radius = sqrt(radius);
        away = beside(&view, x, y, centre, radius);
        assert_int_equal(sf_handle_drag(&handle, world.controls, world.count, &view, 640, 360, x, y, far, sets), 1);
        change_world(&world, sets, 1);
        handle = handle_of(&world, &view, 640, 360, light, kind);
        inside += away == -radius;
        if (away < -0.01 * radius) { /* near the rim floats are too coarse for 1/1000 px */
            assert_true(handle.visible);
            assert_near(handle.x, x, 1e-3);
            assert_near(handle.y, y, 1e-3);
            assert_true(handle.far == (far || away == -radius));
            hits[sun][far]++;
        } else if (sun && away > 0) { /* the rim is a circle round the picture's middle */
            double way = hypot(x - 320, y - 180);

            assert_true(hypot(handle.x - 320, handle.y - 180) < way);
            assert_near((handle.x - 320) * (y - 180) / way, (handle.y - 180) * (x - 320) / way, 0.05);
        } else if (handle.visible && away > 0) { /* an aim beside its sphere stays where it is when dragged on */
            struct sf_handle again;

            assert_int_equal(sf_handle_drag(&handle, world.controls, world.count, &view, 640, 360, x, y, far, sets), 1);
            change_world(&world, sets, 1);
            again = handle_of(&world, &view, 640, 360, light, kind);
            assert_near(handle.x, again.x, 0.1);
            assert_near(handle.y, again.y, 0.1);
        }
        end_world(&world);
    }
    assert_true(inside > 10);
    for (int i = 0; i < 4; i++)
        assert_true(hits[i / 2][i % 2] > 30);
}

/* Where the sphere is under the mouse is known by hand for suns. */
static void test_sun_disc(void **state)
{
    struct world world = make_world(NULL, 0);
    double radius = handle_of(&world, &front, 400, 400, SUN, SF_HANDLE_SUN).point[1]; /* it is straight above */
    double rim = 200 * radius / sqrt(100 - radius * radius);
    char sets[SF_LIGHT_SETS][SF_LIGHT_SET_BYTES];

    (void)state;
    assert_true(radius > 2 && radius <= 5 && rim < 200);
    for (int far = 0; far <= 1; far++) {
        for (int step = -19; step <= 19; step++) {
            float x = (float)(200 + step * 10), y = 203;
            bool inside = hypot(x - 200, y - 200) < rim;
            struct sf_handle sun = handle_of(&world, &front, 400, 400, SUN, SF_HANDLE_SUN);

            change_world(&world, sets,
                         sf_handle_drag(&sun, world.controls, world.count, &front, 400, 400, x, y, far, sets));
            sun = handle_of(&world, &front, 400, 400, SUN, SF_HANDLE_SUN);
            assert_near(hypot(hypot(sun.point[0], sun.point[1]), sun.point[2]), radius, 1e-5);
            if (inside) {
                assert_near(sun.x, x, 1e-3);
                assert_near(sun.y, y, 1e-3);
                assert_true(sun.far == far);
            } else {
                assert_near(hypot(sun.x - 200, sun.y - 200), rim, 1e-3);
                assert_true((sun.x - 200) * (x - 200) > 0);
            }
        }
    }
    end_world(&world);
}

/* ---- turning ---- */

static const double *value_of(const struct world *world, const char *path)
{
    for (uint32_t i = 0; i < world->count; i++)
        if (strcmp(world->controls[i].path, path) == 0)
            return world->controls[i].value;
    fail_msg("no control %s", path);
    return NULL;
}

static unsigned orbit(struct world *world, unsigned light, double turn, double rise, const struct sf_camera_view *view)
{
    char sets[SF_LIGHT_SETS][SF_LIGHT_SET_BYTES];
    unsigned count = sf_light_orbit(light, turn, rise, world->controls, world->count, view, sets);

    change_world(world, sets, count);
    return count;
}

static void test_orbit(void **state)
{
    const char *sets[] = {"lights.0.direction=0,0,-3", "lights.1.position=0,0,4", "lights.2.position=0,0,2",
                          "lights.2.direction=0,0,-1"};
    struct world world = make_world(sets, 4);
    struct sf_camera_view view = front;
    double root = sqrt(0.5);

    (void)state;
    /* A quarter turn takes +z to +x; then up. */
    assert_int_equal(orbit(&world, SUN, 90, 0, &view), 1);
    assert_point(value_of(&world, "lights.0.direction"), -1, 0, 0, 1e-6);
    orbit(&world, SUN, 0, 45, &view);
    assert_point(value_of(&world, "lights.0.direction"), -root, -root, 0, 1e-6);
    view.target[1] = 1; /* the bulb's arm is 0,-1,4 */
    assert_int_equal(orbit(&world, BULB, -90, 0, &view), 1);
    assert_point(value_of(&world, "lights.1.position"), -4, 0, 0, 1e-6);
    orbit(&world, BULB, 0, 2 * atan(0.25) * 180 / PI, &view);
    assert_point(value_of(&world, "lights.1.position"), -4, 2, 0, 1e-6);
    view.target[1] = 0;
    assert_int_equal(orbit(&world, SPOT, 90, 45, &view), 2); /* goes on shining at the target */
    assert_point(value_of(&world, "lights.2.position"), 2 * root, 2 * root, 0, 1e-6);
    assert_point(value_of(&world, "lights.2.direction"), -root, -root, 0, 1e-6);
    assert_int_equal(orbit(&world, 3, 90, 45, &view), 0); /* no such light */
    end_world(&world);
}

/* Up to a tenth of a degree of upright, from where the heading is still known; what stands upright already may stay. */
static void test_orbit_poles(void **state)
{
    struct world world = make_world(NULL, 0);
    uint64_t seed = 4;

    (void)state;
    orbit(&world, SUN, 30, 0, &front);
    assert_point(value_of(&world, "lights.0.direction"), 0, -1, 0, 1e-6);
    orbit(&world, SUN, 0, 500, &front);
    assert_point(value_of(&world, "lights.0.direction"), 0, -1, 0, 1e-6);
    orbit(&world, SUN, 0, -1000, &front);
    assert_point(value_of(&world, "lights.0.direction"), 0, 1, 0, 2e-3);
    for (int trial = 0; trial < TRIALS; trial++) {
        double before, after, turn = chance(&seed, -180, 180);
        const double *place = value_of(&world, "lights.1.position");

        before = hypot(hypot(place[0], place[1]), place[2]);
        orbit(&world, BULB, turn, chance(&seed, -200, 200), &front);
        place = value_of(&world, "lights.1.position");
        after = hypot(hypot(place[0], place[1]), place[2]);
        assert_near(after, before, 1e-5);
        assert_true(hypot(place[0], place[2]) > 1e-3);
    }
    end_world(&world);
}

/* Sets are within the room that they have and within what the parameter takes. */
static void test_sets_are_legal(void **state)
{
    const char *sets[] = {"lights.1.position=-99999.1,-99999.2,-99999.3"};
    struct world world = make_world(sets, 1);
    struct sf_camera_view view = {{-1e5f, -1e5f, -9e4f}, {-1e5f, -1e5f, -1e5f}, {0, 1, 0}, 40, 0.05f};
    struct sf_handle bulb = handle_of(&world, &view, 300, 300, BULB, SF_HANDLE_POSITION);
    char out[SF_LIGHT_SETS][SF_LIGHT_SET_BYTES];

    (void)state;
    assert_int_equal(sf_handle_drag(&bulb, world.controls, world.count, &view, 300, 300, 0, 300, false, out), 1);
    change_world(&world, out, 1);
    assert_near(value_of(&world, "lights.1.position")[0], -1e5, 0);
    end_world(&world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_projection),
        cmocka_unit_test(test_colors),
        cmocka_unit_test(test_behind),
        cmocka_unit_test(test_suns_are_inside),
        cmocka_unit_test(test_pick),
        cmocka_unit_test(test_drag_positions),
        cmocka_unit_test(test_drag_directions),
        cmocka_unit_test(test_sun_disc),
        cmocka_unit_test(test_orbit),
        cmocka_unit_test(test_orbit_poles),
        cmocka_unit_test(test_sets_are_legal),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
