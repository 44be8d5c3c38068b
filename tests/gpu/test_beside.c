/* Two methods side by side in one renderer: each side is, bit for bit, what a renderer of its own draws, whatever changes
 * meanwhile, and the simulation is stepped once. With validation. */
#include "live_kit.h"

#include "methods/method.h"

enum { SIDE = 32 };
static const struct sf_renderer_options plain = {
    .width = SIDE, .height = SIDE, .aovs = SF_AOV_SMOKE | SF_AOV_DEPTHS, .timing = true};
static const char *const few[] = {"reference.samples=32", "reference.batch=8"}; /* four plays of its graph */

static struct sf_scene *scene_with(const char *method, const char *set)
{
    char text[64];
    const char *sets[] = {few[0], few[1], text, set};
    struct sf_scene *scene;

    snprintf(text, sizeof text, "method=%s", method);
    scene = live_try(live_sky, sets, set ? 4 : 3);
    if (!scene)
        fail_msg("%s: %s", method, live_message);
    return scene;
}

static void beside(struct sf_renderer *renderer, const char *method)
{
    if (sf_renderer_set_beside(renderer, method) != SF_OK)
        fail_msg("%s", live_message);
}

static void assert_same(struct sf_renderer *renderer, uint64_t ticket, const struct picture *want, const char *what)
{
    struct sf_frame frame;
    struct picture got;
    bool same;

    if (sf_renderer_wait(renderer, ticket, &frame) != SF_OK)
        fail_msg("%s: %s", what, live_message);
    got = live_keep(&frame);
    same = live_same(&got, want);
    live_free(&got);
    if (!same)
        fail_msg("%s: frame %u is not that of a renderer of its own", what, want->frame.frame);
}

static void assert_picture(struct sf_renderer *renderer, uint64_t ticket, const struct sf_scene *scene,
                           const struct sf_renderer_options *options, uint32_t number, const char *what)
{
    struct picture want = live_fresh(scene, options, number);

    assert_same(renderer, ticket, &want, what);
    live_free(&want);
}

/* Both sides of a frame that is drawn now. */
static void assert_sides(struct sf_renderer *renderer, const char *left, const char *right, const char *set,
                         const struct sf_renderer_options *options, uint32_t number)
{
    struct sf_scene *scenes[] = {scene_with(left, set), scene_with(right, set)};
    uint64_t ticket;

    if (sf_renderer_render(renderer, number, &ticket) != SF_OK)
        fail_msg("%s beside %s: %s", right, left, live_message);
    assert_picture(renderer, ticket, scenes[0], options, number, left);
    assert_picture(renderer, ticket | SF_BESIDE, scenes[1], options, number, right);
    for (int i = 0; i < 2; i++)
        sf_scene_destroy(&scenes[i]);
}

static uint32_t passes_of(struct sf_renderer *renderer, uint64_t ticket, const char *begin)
{
    const struct sf_pass_timing *timings;
    uint32_t count, found = 0;

    assert_int_equal(sf_renderer_timings(renderer, ticket, &timings, &count), SF_OK);
    assert_true(count > 0);
    for (uint32_t i = 0; i < count; i++)
        found += strncmp(timings[i].name, begin, strlen(begin)) == 0;
    return found;
}

/* Every method of the table, the same one twice among them. */
static void test_each(void **state)
{
    struct sf_scene *scene = scene_with("thick", NULL);
    struct sf_renderer *renderer = live_create(scene, &plain), *alone = live_create(scene, &plain);
    uint64_t ticket, steps;

    (void)state;
    live_frame(renderer, 3);
    for (uint32_t i = 0; i < sf_method_count; i++) {
        struct sf_scene *other = scene_with(sf_methods[i].name, NULL);
        struct picture want = live_picture(alone, 4 + i);

        beside(renderer, sf_methods[i].name);
        beside(renderer, sf_methods[i].name);
        steps = sf_particles_steps(renderer->particles);
        assert_false(live_restarted(renderer, 4 + i));
        assert_int_equal(sf_renderer_render(renderer, 4 + i, &ticket), SF_OK);
        assert_int_equal(sf_particles_steps(renderer->particles), steps + 2); /* two substeps a frame */
        assert_same(renderer, ticket, &want, "the scene's method");
        assert_picture(renderer, ticket | SF_BESIDE, other, &plain, 4 + i, sf_methods[i].name);
        assert_true(passes_of(renderer, ticket, "sim.") > 0);
        assert_int_equal(passes_of(renderer, ticket | SF_BESIDE, "sim."), 0);
        assert_true(passes_of(renderer, ticket | SF_BESIDE, "scene.") > 0);
        live_free(&want);
        sf_scene_destroy(&other);
    }
    beside(renderer, NULL);
    live_compare(renderer, scene, &plain, 4 + sf_method_count, "the second method gone");
    sf_renderer_destroy(&renderer);
    sf_renderer_destroy(&alone);
    sf_scene_destroy(&scene);
}

/* Frame 6 in steps; side `slow` is the one that takes four. */
static void play(struct sf_renderer *renderer, int slow)
{
    struct sf_frame frame;
    uint64_t ticket;

    for (int step = 1; step <= 6; step++) {
        float want = step < 4 ? (float)step / 4 : 1;

        assert_int_equal(sf_renderer_render(renderer, 6, &ticket), SF_OK);
        assert_true(sf_renderer_progress(renderer) == want);
        for (int side = 0; side < 2; side++) {
            assert_int_equal(sf_renderer_wait(renderer, side ? ticket | SF_BESIDE : ticket, &frame), SF_OK);
            assert_true(frame.progress == (side == slow ? want : 1));
            assert_true(frame.frame == 6 && frame.live > 0 && frame.color);
        }
    }
}

/* A method of four plays on either side: the other one waits, and what it has drawn is still there. */
static void test_plays(void **state)
{
    struct sf_scene *scenes[] = {scene_with("reference", NULL), scene_with("thick", NULL)};
    struct picture want[] = {live_fresh(scenes[0], &plain, 6), live_fresh(scenes[1], &plain, 6)};
    struct sf_renderer_options stepwise = plain;

    (void)state;
    stepwise.progressive = true;
    for (int left = 0; left < 2; left++) {
        struct sf_renderer *renderer = live_create(scenes[left], &plain);
        uint64_t ticket;
        int calls = 0;

        beside(renderer, left ? "reference" : "thick");
        assert_int_equal(sf_renderer_refine(renderer, 6, live_count, &calls), SF_OK);
        assert_int_equal(calls, 4);
        assert_int_equal(sf_renderer_render(renderer, 6, &ticket), SF_OK);
        assert_same(renderer, ticket, &want[left], "the scene's method, refined");
        assert_same(renderer, ticket | SF_BESIDE, &want[!left], "the second, refined");
        assert_int_equal(sf_renderer_set_options(renderer, &stepwise), SF_OK);
        play(renderer, left);
        assert_same(renderer, renderer->tickets, &want[left], "the scene's method, by steps");
        assert_same(renderer, renderer->tickets | SF_BESIDE, &want[!left], "the second, by steps");
        sf_renderer_destroy(&renderer);
    }
    for (int i = 0; i < 2; i++) {
        live_free(&want[i]);
        sf_scene_destroy(&scenes[i]);
    }
}

/* What comes beside a picture that is being bettered leaves it alone. */
static void test_goes_on(void **state)
{
    static const float progress[] = {0.25f, 0.5f, 0.75f, 1};
    struct sf_renderer_options stepwise = plain;
    struct sf_scene *scene = scene_with("reference", NULL);
    struct sf_renderer *renderer;
    struct sf_frame frame;
    uint64_t ticket = 0, before;

    (void)state;
    stepwise.progressive = true;
    stepwise.frames_kept = 4;
    renderer = live_create(scene, &stepwise);
    for (int i = 0; i < 4; i++) {
        before = ticket;
        if (i > 0)
            beside(renderer, i == 1 ? "thick" : i == 2 ? "none" : NULL);
        assert_int_equal(sf_renderer_render(renderer, 2, &ticket), SF_OK);
        assert_int_equal(sf_renderer_wait(renderer, ticket, &frame), SF_OK);
        assert_true(frame.progress == progress[i]);
        if (before) {
            assert_int_equal(sf_renderer_wait(renderer, before, &frame), SF_OK);
            assert_int_equal(sf_renderer_wait(renderer, before | SF_BESIDE, &frame), SF_ERROR_USAGE);
        }
    }
    stepwise.progressive = false;
    assert_picture(renderer, ticket, scene, &stepwise, 2, "reference");
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
}

/* Settings of either method, lights, the simulation, the first method itself, the size. */
static void test_changes(void **state)
{
    static const struct {
        const char *left, *set;
    } changes[] = {{"thick", "thick.steps=7"},
                   {"thick", "larsson.blur=1"},
                   {"thick", "sim.seed=9"},
                   {"thick-larsson", "sim.seed=9"},
                   {"thick", "thick.resolution=half"}};
    struct sf_renderer_options options = plain;
    struct sf_scene *scene = scene_with("thick", NULL);
    struct sf_renderer *renderer = live_create(scene, &plain);

    (void)state;
    beside(renderer, "thick-larsson");
    assert_sides(renderer, "thick", "thick-larsson", NULL, &plain, 2);
    for (uint32_t i = 0; i < SF_COUNT(changes); i++) {
        struct sf_scene *next = scene_with(changes[i].left, changes[i].set);

        assert_int_equal(sf_renderer_set_scene(renderer, next), SF_OK);
        sf_scene_destroy(&scene);
        scene = next;
        assert_sides(renderer, changes[i].left, "thick-larsson", changes[i].set, &plain, 3 + i);
    }
    options.width = 31;
    options.float_color = true;
    assert_int_equal(sf_renderer_set_options(renderer, &options), SF_OK);
    assert_sides(renderer, "thick", "thick-larsson", changes[SF_COUNT(changes) - 1].set, &options, 9);
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
}

static void test_wrong(void **state)
{
    struct sf_scene *scene = scene_with("thick", NULL);
    struct sf_renderer *renderer = live_create(scene, &plain);
    struct sf_frame frame;
    uint64_t ticket;

    (void)state;
    assert_int_equal(sf_renderer_render(renderer, 1, &ticket), SF_OK);
    assert_int_equal(sf_renderer_wait(renderer, ticket | SF_BESIDE, &frame), SF_ERROR_USAGE);
    assert_non_null(strstr(live_message, "no second method"));
    assert_int_equal(sf_renderer_set_beside(renderer, "thick-larson"), SF_ERROR_USAGE);
    assert_non_null(strstr(live_message, "did you mean 'thick-larsson'"));
    assert_int_equal(sf_renderer_set_beside(renderer, ""), SF_ERROR_USAGE);
    beside(renderer, "thick-larsson");
    assert_int_equal(sf_renderer_set_beside(renderer, "fog"), SF_ERROR_USAGE);
    assert_sides(renderer, "thick", "thick-larsson", NULL, &plain, 2);
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
}

/* No memory for a second one: the first goes on; nor for both in another size: both go on. */
static void test_memory(void **state)
{
    const struct sf_device_options tight = {.validate = true, .no_cache = true, .budget_bytes = 20 << 20};
    struct sf_renderer_options large = {.width = 64, .height = 64}, small = {.width = SIDE, .height = SIDE};
    struct sf_scene *scene = scene_with("thick", NULL);
    struct sf_device *roomy = live_device;
    struct sf_renderer *renderer = NULL;
    uint64_t used, budget, before;
    enum sf_status status = SF_OK;

    (void)state;
    assert_int_equal(sf_device_create(&tight, &live_log, &live_device), SF_OK);
    while (!status) {
        sf_renderer_destroy(&renderer);
        large.width = large.height = large.width + 96;
        renderer = live_create(scene, &large);
        live_frame(renderer, 0);
        live_frame(renderer, 1); /* memory for what comes back is taken when it is wanted */
        sf_device_memory(live_device, &before, &budget);
        status = sf_renderer_set_beside(renderer, "thick-larsson");
    }
    assert_int_equal(status, SF_ERROR_MEMORY);
    sf_device_memory(live_device, &used, &budget);
    assert_int_equal(used, before);
    assert_true(live_frame(renderer, 2).live > 0);
    assert_int_equal(sf_renderer_set_options(renderer, &small), SF_OK);
    beside(renderer, "thick-larsson");
    large.width *= 2; /* what comes back takes no memory yet */
    assert_int_equal(sf_renderer_set_options(renderer, &large), SF_ERROR_MEMORY);
    assert_sides(renderer, "thick", "thick-larsson", NULL, &small, 3);
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
    assert_int_equal(sf_device_validation_messages(live_device), 0);
    sf_device_destroy(&live_device);
    live_device = roomy;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each),    cmocka_unit_test(test_plays), cmocka_unit_test(test_goes_on),
        cmocka_unit_test(test_changes), cmocka_unit_test(test_wrong), cmocka_unit_test(test_memory),
    };

    if (live_probe())
        return 77;
    return cmocka_run_group_tests(tests, live_open, live_close);
}
