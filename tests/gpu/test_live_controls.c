/* Every parameter of the table, changed in a renderer that is running: the pictures that follow are those of a renderer
 * made for the changed scene, bit for bit, and no more is made anew than the table says; with validation. */
#include "live_kit.h"

#include <math.h>

enum { SIDE = 64, BEFORE = 3, AFTER = 4 };
static const struct sf_renderer_options options = {.width = SIDE, .height = SIDE, .aovs = SF_AOV_SMOKE | SF_AOV_DEPTHS};

/* ---- another value ---- */

static double other_number(const struct sf_control *control, double value, double factor)
{
    bool whole = control->kind == SF_CONTROL_INT || strcmp(control->key, "tile") == 0;
    double step = fmax(fabs(value) * factor, factor);

    if (value == -1 && control->min == -1)
        return 6; /* below 0 stands for the medium's */
    step = whole ? ceil(step) : step;
    return fmax(value + step > control->max ? value - step : value + step, control->min);
}

/* Files of the same kind. */
static const char *other_file(const char *text)
{
    static const char *const pairs[][2] = {{"../assets/pyramid.gltf", "../assets/house.obj"},
                                           {"../assets/tiny.csv", "../assets/tiny.ply"}};

    for (size_t i = 0; text && i < SF_COUNT(pairs); i++)
        if (strcmp(text, pairs[i][0]) == 0)
            return pairs[i][1];
    return NULL;
}

/* The control's set with another value, malloc'ed; NULL when there is none. `round` makes it another still. */
static char *other_set(const struct sf_control *control, uint32_t round)
{
    struct sf_control changed = *control;

    switch (control->kind) {
    case SF_CONTROL_BOOL:
        changed.value[0] = control->value[0] == 0;
        break;
    case SF_CONTROL_CHOICE:
        changed.value[0] = fmod(control->value[0] + 1 + round, control->max + 1);
        if (changed.value[0] == control->value[0])
            return NULL;
        break;
    case SF_CONTROL_TEXT:
        changed.text = other_file(control->text);
        if (!changed.text)
            return NULL;
        break;
    default:
        for (uint32_t i = 0; i < control->numbers; i++)
            changed.value[i] = other_number(control, control->value[i], i == 0 ? 0.3 : 0.15);
        if (control->kind == SF_CONTROL_RANGE && changed.value[1] < changed.value[0])
            changed.value[1] = changed.value[0];
    }
    return sf_control_print(&changed);
}

/* ---- what is made anew ---- */

struct made {
    const void *graph, *list, *map, *method, *environment, *vertices;
};

static struct made made_by(const struct sf_renderer *renderer)
{
    return (struct made){renderer->sides[0].stage.assembly,     sf_particles_player(renderer->particles),
                         renderer->sides[0].assets.shadow_map,  renderer->sides[0].assets.method,
                         renderer->sides[0].assets.environment, renderer->sides[0].assets.meshes.vertices};
}

static bool begins(const char *text, const char *with)
{
    return strncmp(text, with, strlen(with)) == 0;
}

/* The table's word, and for shadow maps what they are drawn from. */
static void check_made(const struct sf_control *control, const char *set, const struct made *a, const struct made *b)
{
    bool values = control->renews[0] == '\0', files = strcmp(control->key, "file") == 0; /* meshes share buffers */
    bool drawn =
        begins(control->path, "lights.") || begins(control->path, "objects.") || begins(control->path, "shadow.");
    bool moves = drawn && (strcmp(control->key, "direction") == 0 || strcmp(control->key, "position") == 0 ||
                           strcmp(control->key, "softness") == 0 || strcmp(control->key, "exponent") == 0);
    bool colours = begins(control->key, "albedo") || strcmp(control->key, "color") == 0 ||
                   strcmp(control->key, "intensity") == 0 || strcmp(control->key, "friction") == 0;

    if (values && a->graph != b->graph)
        fail_msg("%s: the graph was made anew", set);
    if (strcmp(control->renews, "simulation") != 0 && a->list != b->list)
        fail_msg("%s: the simulation was made anew", set);
    if (values && (a->method != b->method || a->environment != b->environment || a->vertices != b->vertices))
        fail_msg("%s: files were made anew", set);
    if ((!drawn || colours) && !files && a->map != b->map)
        fail_msg("%s: the shadow map was drawn anew", set);
    if (moves && begins(control->path, "lights.0") && a->map == b->map)
        fail_msg("%s: the shadow map is the old one", set);
}

/* ---- one change, and back ---- */

struct tally {
    uint32_t changes, shows; /* and those that the picture shows */
};

/* At frame 3 the scene changes, frame 4 is the changed one's; then back, and again the first one's frame 4. */
static void change(const struct sf_control *control, const char *set, const struct sf_scene *base,
                   const struct sf_scene *other, const struct picture *base_after, struct sf_renderer *renderer,
                   struct tally *tally)
{
    struct picture before = live_picture(renderer, BEFORE), got, want;
    struct made made = made_by(renderer), then;
    bool restarts = strcmp(control->renews, "simulation") == 0;

    live_free(&before);
    if (sf_renderer_set_scene(renderer, other) != SF_OK)
        fail_msg("%s: %s", set, live_message);
    then = made_by(renderer);
    check_made(control, set, &made, &then);
    /* Another preroll is more steps, not other ones. */
    if (strcmp(control->key, "preroll") != 0 && live_restarted(renderer, AFTER) != restarts)
        fail_msg("%s: the simulation %s, but it renews '%s'", set, restarts ? "went on" : "began again",
                 control->renews);
    got = live_picture(renderer, AFTER);
    want = live_fresh(other, &options, AFTER);
    if (!live_same(&got, &want))
        fail_msg("%s (renews '%s'): not the picture of a fresh renderer", set, control->renews);
    tally->changes++;
    tally->shows += !live_same(&want, base_after);
    live_free(&got);
    live_free(&want);
    assert_int_equal(sf_renderer_set_scene(renderer, base), SF_OK);
    got = live_picture(renderer, AFTER);
    if (!live_same(&got, base_after))
        fail_msg("%s: not the old picture when it is taken back", set);
    live_free(&got);
}

/* Of another method than thick, with which the scenes here are drawn. */
static bool foreign(const struct sf_control *control)
{
    static const char *const groups[] = {"larsson.",         "reference.",      "billboard.",  "soft.", "mega.",
                                         "average_density.", "density_extent.", "volumetric.", "lit.",  "scattering."};

    for (size_t i = 0; i < sizeof groups / sizeof groups[0]; i++)
        if (begins(control->path, groups[i]))
            return true;
    return false;
}

static void change_all(const char *text, uint32_t least)
{
    struct sf_scene *base = live_parse(text, NULL);
    struct sf_renderer *renderer = live_create(base, &options);
    struct picture after = live_fresh(base, &options, AFTER);
    struct sf_control *controls;
    struct tally tally = {0, 0};
    uint32_t count;

    assert_int_equal(sf_scene_controls(base, &live_log, &controls, &count), SF_OK);
    for (uint32_t i = 0; i < count; i++) {
        /* All methods are drawn by test_beside. */
        uint32_t choices = controls[i].kind == SF_CONTROL_CHOICE ? (uint32_t)controls[i].max : 1;
        uint32_t rounds = strcmp(controls[i].key, "method") == 0 ? 3 : choices;

        for (uint32_t round = 0; round < rounds && !foreign(&controls[i]); round++) {
            char *set = other_set(&controls[i], round);
            const char *sets[] = {set};
            /* Some types need keys that are not there, and loops a path: no scene then. */
            struct sf_scene *other = set ? live_try(text, sets, 1) : NULL;

            if (other)
                change(&controls[i], set, base, other, &after, renderer, &tally);
            else if (set && controls[i].kind != SF_CONTROL_CHOICE && strcmp(controls[i].key, "path_loop") != 0)
                fail_msg("%s: %s", set, live_message);
            sf_scene_destroy(&other);
            free(set);
        }
    }
    printf("%u changes of %u controls, %u show\n", tally.changes, count, tally.shows);
    assert_true(tally.changes >= least && tally.shows * 3 >= tally.changes * 2);
    free(controls);
    live_free(&after);
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&base);
}

static void test_sky(void **state)
{
    (void)state;
    change_all(live_sky, 100);
}

static void test_lists(void **state)
{
    (void)state;
    change_all(live_lists, 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_sky), cmocka_unit_test(test_lists)};

    return live_probe() ? 77 : cmocka_run_group_tests(tests, live_open, live_close);
}
