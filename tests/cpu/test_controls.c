/* A scene's parameters as controls: what they say, and that a control's own words set it to the same bits. */
#include "shipped_kit.h"

#include <math.h>
#include "base/hash.h"
#include "params/params.h"

/* ---- what they say ---- */

static const char *small =
    "{\"camera\":{\"up\":[0,0.5,0]},"
    "\"lights\":[{\"type\":\"spot\",\"position\":[0,3,0],\"direction\":[0,-2,0],\"intensity\":0.1}],"
    "\"objects\":[{\"type\":\"plane\",\"albedo\":[0.1,0.2,0.3],\"albedo2\":[1,0,0]}],"
    "\"emitters\":[{\"type\":\"cone\",\"lifetime\":3,\"path\":[{\"time\":0,\"position\":[1,2,3]}]},"
    "{\"type\":\"list\",\"particles\":[{\"centre\":[0,0,0],\"radius\":0.5}]}],"
    "\"forces\":[{\"type\":\"vortex\",\"strength\":2,\"axis\":[0,0,3]}],\"medium\":{\"extinction\":7}}";

static void test_what_controls_say(void **state)
{
    struct sf_scene *scene = parse(small);
    struct controls controls = controls_of(scene);
    const struct sf_control *control;

    (void)state;
    control = find_control(&controls, "lights.0.intensity");
    assert_non_null(control);
    assert_string_equal(control->group, "lights.0");
    assert_string_equal(control->key, "intensity");
    assert_string_equal(control->unit, "W/m2, W/sr");
    assert_true(strlen(control->doc) > 10);
    assert_string_equal(control->renews, "");
    assert_int_equal(control->kind, SF_CONTROL_FLOAT);
    assert_int_equal(control->numbers, 1);
    assert_true(control->value[0] == (double)0.1f);
    assert_true(control->usual[0] == 3 && control->min == 0 && control->max == 1e6);
    assert_false(control->required);
    assert_null(control->text);
    assert_null(control->choices);

    control = find_control(&controls, "lights.0.direction");
    assert_int_equal(control->kind, SF_CONTROL_VECTOR);
    assert_int_equal(control->numbers, 3);
    assert_true(control->required);

    control = find_control(&controls, "method");
    assert_string_equal(control->group, "");
    assert_string_equal(control->renews, "graph");
    assert_int_equal(control->kind, SF_CONTROL_CHOICE);
    assert_string_equal(control->choices[(int)control->value[0]], "thick");
    assert_null(control->choices[(int)control->max + 1]);

    control = find_control(&controls, "emitters.0.lifetime");
    assert_int_equal(control->kind, SF_CONTROL_RANGE);
    assert_true(control->value[0] == 3 && control->value[1] == 3 && control->numbers == 2);
    assert_true(control->usual[0] == 4 && control->usual[1] == 5);
    assert_string_equal(control->renews, "simulation"); /* from the list that it stands in */
    assert_string_equal(find_control(&controls, "emitters.0.path.0.position")->group, "emitters.0.path.0");
    assert_string_equal(find_control(&controls, "emitters.0.path.0.position")->renews, "simulation");
    assert_int_equal(find_control(&controls, "thick.scene_shadow")->kind, SF_CONTROL_BOOL);
    assert_int_equal(find_control(&controls, "sim.seed")->kind, SF_CONTROL_INT);
    assert_int_equal(find_control(&controls, "medium.albedo")->kind, SF_CONTROL_COLOR);
    assert_int_equal(find_control(&controls, "emitters.1.file")->kind, SF_CONTROL_TEXT);
    assert_null(find_control(&controls, "emitters.1.file")->text);
    assert_int_equal(find_control(&controls, "emitters.1.file")->numbers, 0);

    /* Only what the type takes, and no lists by themselves. */
    assert_null(find_control(&controls, "camera.period"));
    assert_null(find_control(&controls, "lights.0.shape"));
    assert_null(find_control(&controls, "objects.0.radius"));
    assert_null(find_control(&controls, "emitters.0.path"));
    assert_null(find_control(&controls, "environment.files"));
    free(controls.list);
    sf_scene_destroy(&scene);
}

/* Controls show what was given, not what the loader made of it. */
static void test_values_are_as_given(void **state)
{
    struct sf_scene *scene = parse(small);
    struct controls controls = controls_of(scene);

    (void)state;
    assert_true(find_control(&controls, "camera.up")->value[1] == 0.5);
    assert_true(find_control(&controls, "lights.0.direction")->value[1] == -2);
    assert_true(find_control(&controls, "forces.0.axis")->value[2] == 3);
    assert_true(find_control(&controls, "objects.0.albedo2")->value[0] == 1); /* though there is no checker */
    assert_true(find_control(&controls, "emitters.0.extinction")->value[0] == -1);
    assert_true(find_control(&controls, "emitters.1.particles.0.extinction")->value[0] == -1);
    assert_true(scene->emitters[1].list[0].extinction == 7); /* while the scene has the medium's */
    free(controls.list);
    sf_scene_destroy(&scene);
}

static void test_long_lists_give_none(void **state)
{
    (void)state;
    for (int count = 64; count <= 65; count++) {
        char text[8192] = "{\"emitters\":[{\"type\":\"list\",\"particles\":[";
        struct controls controls;
        struct sf_scene *scene;

        for (int i = 0; i < count; i++)
            snprintf(text + strlen(text), sizeof text - strlen(text), "%s{\"centre\":[0,0,%d],\"radius\":1}",
                     i ? "," : "", i);
        strcat(text, "]}]}");
        scene = parse(text);
        controls = controls_of(scene);
        assert_true(!find_control(&controls, "emitters.0.particles.63.radius") == (count == 65));
        assert_true(!find_control(&controls, "emitters.0.particles.0.radius") == (count == 65));
        free(controls.list);
        sf_scene_destroy(&scene);
    }
    /* A list from a file is not the scene's. */
    FILE *file = fopen("a.csv", "w");
    assert_non_null(file);
    fprintf(file, "x,y,z,radius,extinction\n0,0,0,1,1\n");
    fclose(file);
    struct sf_scene *scene = parse("{\"emitters\":[{\"type\":\"list\",\"file\":\"a.csv\"}]}");
    struct controls controls = controls_of(scene);
    assert_int_equal(scene->emitters[0].list_count, 1);
    assert_null(find_control(&controls, "emitters.0.particles.0.radius"));
    assert_string_equal(find_control(&controls, "emitters.0.file")->text, "a.csv");
    free(controls.list);
    sf_scene_destroy(&scene);
}

/* ---- printing and setting ---- */

static void set_each_to_itself(const char *path)
{
    struct sf_scene *scene = load_with(path, NULL, 0), *again;
    struct controls controls = controls_of(scene), renewed;
    const char **sets = calloc(controls.count, sizeof *sets);

    assert_non_null(sets);
    for (uint32_t i = 0; i < controls.count; i++) {
        sets[i] = sf_control_print(&controls.list[i]);
        assert_non_null(sets[i]);
        again = load_with(path, &sets[i], 1);
        renewed = controls_of(again);
        assert_same_controls(&controls, &renewed, true, sets[i]);
        if (sf_scene_difference(scene, again) != 0)
            fail_msg("%s: %s makes another scene", path, sets[i]);
        free(renewed.list);
        sf_scene_destroy(&again);
    }
    again = load_with(path, sets, controls.count);
    renewed = controls_of(again);
    assert_same_controls(&controls, &renewed, true, "all of them");
    assert_int_equal(sf_scene_difference(scene, again), 0);
    free(renewed.list);
    sf_scene_destroy(&again);
    for (uint32_t i = 0; i < controls.count; i++)
        free((char *)sets[i]);
    free(sets);
    free(controls.list);
    sf_scene_destroy(&scene);
}

static void test_every_control_sets_itself(void **state)
{
    (void)state;
    assert_true(each_shipped(set_each_to_itself) >= 16);
}

/* Any value within the range, the smallest and -0 among them. */
static double random_value(const struct sf_control *control, uint32_t number)
{
    double share = sf_random_float(9, number, 5), value = control->min + share * (control->max - control->min);

    bool whole =
        control->kind == SF_CONTROL_INT || control->kind == SF_CONTROL_CHOICE || control->kind == SF_CONTROL_BOOL;

    if (number % 5 == 0 && control->min <= 0 && !whole)
        return control->min < 0 || number % 2 ? -0.0 : 0.0;
    if (number % 2)
        value *= pow(10, -9 * (double)sf_random_float(10, number, 5));
    value = (double)(float)value;
    value = whole ? floor(value) : value;
    return fmin(fmax(value, control->min), control->max);
}

static void test_any_value_keeps_its_bits(void **state)
{
    const char *path = source_path("scenes/tiny/all.json");
    struct sf_scene *scene = load_with(path, NULL, 0);
    struct controls controls = controls_of(scene);
    unsigned taken = 0, refused = 0;

    (void)state;
    for (uint32_t i = 0; i < 12 * controls.count; i++) {
        struct sf_control control = controls.list[i % controls.count];
        struct sf_scene *again = NULL;
        char *set;

        if (control.kind == SF_CONTROL_TEXT || strcmp(control.key, "type") == 0)
            continue;
        for (uint32_t k = 0; k < control.numbers; k++)
            control.value[k] = random_value(&control, 3 * i + k);
        if (control.kind == SF_CONTROL_RANGE && control.value[0] > control.value[1])
            control.value[1] = control.value[0];
        set = sf_control_print(&control);
        if (sf_scene_load(path, (const char *const *)&set, 1, NULL, &again) == SF_OK) {
            struct controls renewed = controls_of(again);
            const struct sf_control *found = find_control(&renewed, control.path);

            if (memcmp(found->value, control.value, sizeof found->value) != 0)
                fail_msg("%s has become %.9g %.9g %.9g", set, found->value[0], found->value[1], found->value[2]);
            free(renewed.list);
            taken++;
        } else {
            refused++; /* keys that must ascend, directions without a length */
        }
        sf_scene_destroy(&again);
        free(set);
    }
    assert_true(taken > 1000 && refused < taken / 4);
    free(controls.list);
    sf_scene_destroy(&scene);
}

static void test_print(void **state)
{
    static const char *const choices[] = {"a", "b", NULL};
    struct sf_control control = {.path = "x.y", .kind = SF_CONTROL_CHOICE, .numbers = 1, .choices = choices};
    char *text;

    (void)state;
    control.value[0] = 1;
    assert_string_equal(text = sf_control_print(&control), "x.y=b");
    free(text);
    control.value[0] = 2; /* none: an assignment that is refused */
    assert_string_equal(text = sf_control_print(&control), "x.y=");
    free(text);
    control.kind = SF_CONTROL_TEXT;
    control.text = "a b=c.csv";
    assert_string_equal(text = sf_control_print(&control), "x.y=a b=c.csv");
    free(text);
    control.kind = SF_CONTROL_INT;
    control.value[0] = 1048576;
    assert_string_equal(text = sf_control_print(&control), "x.y=1048576");
    free(text);
    control.value[0] = -0.0; /* which whole numbers do not have */
    assert_string_equal(text = sf_control_print(&control), "x.y=0");
    free(text);
    control.value[0] = 1048576;
    control.kind = SF_CONTROL_RANGE;
    control.numbers = 2;
    control.value[1] = (double)0.1f;
    assert_string_equal(text = sf_control_print(&control), "x.y=1048576,0.1");
    free(text);
}

/* A string that need not be there can be taken away again, as its empty control says. */
static void test_an_empty_string_takes_the_key_away(void **state)
{
    static const char *const set = "emitters.0.file=";
    struct sf_scene *scene = parse_with(
        "{\"emitters\":[{\"type\":\"list\",\"file\":\"gone.csv\",\"particles\":[{\"centre\":[0,0,0],\"radius\":1}]}]}",
        &set, 1);

    (void)state;
    assert_null(scene->emitters[0].file);
    assert_int_equal(scene->emitters[0].list_count, 1);
    sf_scene_destroy(&scene);
}

/* ---- the camera ---- */

static void test_view(void **state)
{
    struct sf_scene *scene = load_with(source_path("scenes/tiny/all.json"), NULL, 0);

    (void)state;
    for (double time = -0.5; time < 2; time += 0.25) {
        struct sf_camera_pose pose;
        struct sf_camera_view view;

        memset(&view, 0x5a, sizeof view);
        sf_scene_camera(scene, time, &pose);
        sf_scene_view(scene, time, &view);
        assert_memory_equal(view.eye, pose.eye, sizeof pose.eye);
        assert_memory_equal(view.target, pose.target, sizeof pose.target);
        assert_memory_equal(view.up, pose.up, sizeof pose.up);
        assert_true(view.fov == pose.fov && view.near_clip == pose.near_clip);
    }
    sf_scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_controls_say),
        cmocka_unit_test(test_values_are_as_given),
        cmocka_unit_test(test_long_lists_give_none),
        cmocka_unit_test(test_every_control_sets_itself),
        cmocka_unit_test(test_any_value_keeps_its_bits),
        cmocka_unit_test(test_print),
        cmocka_unit_test(test_an_empty_string_takes_the_key_away),
        cmocka_unit_test(test_view),
    };
    return cmocka_run_group_tests(tests, scratch_enter, scratch_leave);
}
