/* Scenes that are right: what they become, how they move, their hash, and --set. */
#include "scene_kit.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

static void near3(const float v[3], double x, double y, double z, double tolerance)
{
    if (fabs(v[0] - x) > tolerance || fabs(v[1] - y) > tolerance || fabs(v[2] - z) > tolerance)
        fail_msg("(%g, %g, %g), not (%g, %g, %g)", v[0], v[1], v[2], x, y, z);
}

static void load_folder(const char *folder, unsigned least)
{
    char root[1024], path[2048];
    struct dirent *entry;
    unsigned count = 0;
    DIR *list;

    snprintf(root, sizeof root, "%s", source_path(folder));
    assert_non_null(list = opendir(root));
    while ((entry = readdir(list))) {
        struct caught caught = {"", 0};
        struct sf_log log = {caught_write, &caught, SF_LOG_ERROR};
        struct sf_scene *scene = NULL;
        size_t length = strlen(entry->d_name);

        if (length < 5 || strcmp(entry->d_name + length - 5, ".json") != 0)
            continue;
        snprintf(path, sizeof path, "%s/%s", root, entry->d_name);
        if (sf_scene_load(path, NULL, 0, &log, &scene) != SF_OK)
            fail_msg("%s: %s", path, caught.text);
        assert_int_not_equal(scene->hash, 0);
        sf_scene_destroy(&scene);
        assert_null(scene);
        count++;
    }
    closedir(list);
    assert_true(count >= least);
}

static void test_shipped_scenes_load(void **state)
{
    (void)state;
    load_folder("scenes", 6);
    load_folder("scenes/tiny", 8);
}

static void test_plume_is_what_the_benchmark_needs(void **state)
{
    struct sf_scene *scene = NULL;
    const struct sf_emitter *emitter;
    double life;

    (void)state;
    assert_int_equal(sf_scene_load(source_path("scenes/plume.json"), NULL, 0, NULL, &scene), SF_OK);
    assert_int_equal(scene->light_count, 1);
    assert_int_equal(scene->lights[0].kind, SF_LIGHT_DIRECTIONAL);
    assert_int_equal(scene->emitter_count, 1);
    assert_int_equal(scene->method, SF_METHOD_THICK);
    emitter = &scene->emitters[0];
    life = (emitter->lifetime[0] + emitter->lifetime[1]) / 2;
    assert_float_equal(emitter->rate * life, 512, 1);
    assert_true(scene->sim.preroll >= emitter->lifetime[1]); /* steady from frame 0 */
    assert_true(scene->sim.capacity >= 600);
    sf_scene_destroy(&scene);
}

static void test_least_scene_and_defaults(void **state)
{
    struct sf_scene *scene = parse("{}");

    (void)state;
    assert_int_equal(scene->camera.kind, SF_CAMERA_FIXED);
    assert_int_equal(scene->environment.kind, SF_ENVIRONMENT_SKY);
    assert_int_equal(scene->emitter_count, 0);
    assert_int_equal(scene->ramp_count, 0);
    assert_int_equal(scene->thick.octaves, 1);
    assert_string_equal(scene->path, "test.json");
    sf_scene_destroy(&scene);
    sf_scene_destroy(&scene);
    sf_scene_destroy(NULL);
}

static void test_values_arrive(void **state)
{
    struct sf_scene *scene =
        parse("{\"camera\":{\"type\":\"orbit\",\"eye\":[1,2,3],\"up\":[0,0.5,0],\"near\":0.2,\"period\":-8},"
              "\"lights\":[{\"type\":\"spot\",\"position\":[0,3,0],\"direction\":[0,-2,0],\"inner\":5,\"outer\":9,"
              "\"shadows\":false}],"
              "\"objects\":[{\"type\":\"plane\",\"normal\":[0,3,4],\"albedo\":[0.1,0.2,0.3]},"
              "{\"type\":\"plane\",\"albedo2\":[1,1,1],\"checker\":2},"
              "{\"type\":\"cylinder\",\"radius\":2,\"height\":3,\"rotation\":[10,20,30]}],"
              "\"medium\":{\"extinction\":7.5,\"g\":-0.5},"
              "\"ramp\":[{\"at\":0.25,\"color\":[1,0,0]},{\"at\":0.5,\"color\":[0,1,0]}],"
              "\"emitters\":[{\"type\":\"box\",\"direction\":[0,0,0],\"lifetime\":3,\"speed\":[1,2],\"burst\":5},"
              "{\"type\":\"list\",\"extinction\":2,\"still\":true,\"particles\":[{\"centre\":[1,2,3],\"radius\":0.5},"
              "{\"centre\":[4,5,6],\"radius\":0.25,\"extinction\":9,\"tile\":3}]}],"
              "\"forces\":[{\"type\":\"vortex\",\"strength\":2,\"axis\":[0,0,2]},{\"type\":\"drag\",\"strength\":1}],"
              "\"method\":\"none\",\"sim\":{\"fps\":25}}");

    (void)state;
    assert_int_equal(scene->camera.kind, SF_CAMERA_ORBIT);
    near3(scene->camera.eye, 1, 2, 3, 0);
    near3(scene->camera.up, 0, 1, 0, 0);
    assert_float_equal(scene->camera.period, -8, 0);
    near3(scene->lights[0].direction, 0, -1, 0, 0);
    assert_false(scene->lights[0].shadows);
    near3(scene->objects[0].normal, 0, 0.6, 0.8, 1e-7);
    near3(scene->objects[0].albedo2, 0.1, 0.2, 0.3, 1e-7); /* no checker: both are the first */
    near3(scene->objects[1].albedo2, 1, 1, 1, 0);
    assert_float_equal(scene->objects[2].height, 3, 0);
    near3(scene->objects[2].size, 0, 0, 0, 0); /* a cylinder has none */
    assert_float_equal(scene->ramp[1].at, 0.5, 0);
    assert_int_equal(scene->ramp_count, 2);
    near3(scene->emitters[0].direction, 0, 0, 0, 0);
    assert_float_equal(scene->emitters[0].lifetime[1], 3, 0);
    assert_float_equal(scene->emitters[0].extinction, 7.5, 0); /* the medium's */
    assert_int_equal(scene->emitters[0].burst, 5);
    assert_int_equal(scene->emitters[1].list_count, 2);
    assert_float_equal(scene->emitters[1].fade_in, 0, 0);
    assert_float_equal(scene->emitters[1].list[0].extinction, 2, 0); /* the emitter's */
    assert_float_equal(scene->emitters[1].list[1].extinction, 9, 0);
    near3(scene->emitters[1].list[1].centre, 4, 5, 6, 0);
    assert_true(scene->emitters[1].still);
    near3(scene->forces[0].axis, 0, 0, 1, 0);
    assert_int_equal(scene->method, SF_METHOD_NONE);
    sf_scene_destroy(&scene);
}

static void test_comments_and_schema(void **state)
{
    struct sf_scene *scene = parse("\xef\xbb\xbf{\"$schema\":\"x\",\"//\":[\"a\",1],\"sim\":{\"//\":\"b\",\"seed\":4},"
                                   "\"lights\":[{\"//\":{\"deep\":true},\"type\":\"point\",\"position\":[0,1,0]}]}");
    struct sf_scene *plain = parse("{\"lights\":[{\"position\":[0,1,0],\"type\":\"point\"}],\"sim\":{\"seed\":4}}");

    (void)state;
    assert_int_equal(scene->sim.seed, 4);
    assert_true(scene->hash == plain->hash); /* neither comments nor the order of keys count */
    sf_scene_destroy(&scene);
    sf_scene_destroy(&plain);
}

/* ---- motion ---- */

static void test_orbit(void **state)
{
    struct sf_scene *scene =
        parse("{\"camera\":{\"type\":\"orbit\",\"eye\":[1,3,4],\"target\":[1,2,0],\"period\":8,\"fov\":50}}");
    struct sf_camera_pose pose;

    (void)state;
    sf_scene_camera(scene, 0, &pose);
    near3(pose.eye, 1, 3, 4, 0);
    assert_float_equal(pose.fov, 50, 0);
    /* Counter-clockwise from above, +x to the right and +z towards the one who looks: from +z to +x. */
    sf_scene_camera(scene, 2, &pose);
    near3(pose.eye, 5, 3, 0, 1e-6);
    sf_scene_camera(scene, 4, &pose);
    near3(pose.eye, 1, 3, -4, 1e-6);
    sf_scene_camera(scene, 801, &pose);
    near3(pose.eye, 1 + 4 * sin(PI / 4), 3, 4 * cos(PI / 4), 1e-5);
    near3(pose.target, 1, 2, 0, 0);
    sf_scene_destroy(&scene);
}

static void test_keyframes(void **state)
{
    struct sf_scene *scene = parse("{\"camera\":{\"type\":\"keyframes\",\"keys\":["
                                   "{\"time\":1,\"eye\":[0,1,5],\"target\":[0,0,0],\"fov\":30},"
                                   "{\"time\":2,\"eye\":[2,1,5],\"target\":[0,1,0],\"fov\":40},"
                                   "{\"time\":4,\"eye\":[6,1,5],\"target\":[0,3,0],\"fov\":60}]}}");
    struct sf_camera_pose pose;

    (void)state;
    sf_scene_camera(scene, -3, &pose);
    near3(pose.eye, 0, 1, 5, 0);
    assert_float_equal(pose.fov, 30, 0);
    sf_scene_camera(scene, 9, &pose);
    near3(pose.eye, 6, 1, 5, 0);
    assert_float_equal(pose.fov, 60, 0);
    sf_scene_camera(scene, 2, &pose);
    near3(pose.eye, 2, 1, 5, 1e-6);
    /* Keys at an even speed make an even motion, though their times are uneven. */
    for (double t = 1; t <= 4; t += 0.125) {
        sf_scene_camera(scene, t, &pose);
        near3(pose.eye, 2 * (t - 1), 1, 5, 1e-5);
        near3(pose.target, 0, t - 1, 0, 1e-5);
        assert_float_equal(pose.fov, 20 + 10 * t, 1e-4);
    }
    sf_scene_destroy(&scene);
}

static void test_emitter_path(void **state)
{
    struct sf_scene *scene =
        parse("{\"emitters\":[{\"type\":\"cone\",\"position\":[10,0,0],\"path_loop\":true,\"path\":["
              "{\"time\":0,\"position\":[1,0,0]},{\"time\":1,\"position\":[0,0,-1]},{\"time\":2,\"position\":[-1,0,0]},"
              "{\"time\":3,\"position\":[0,0,1]},{\"time\":4,\"position\":[1,0,0]}]},"
              "{\"type\":\"cone\",\"position\":[0,1,0]},"
              "{\"type\":\"cone\",\"path\":[{\"time\":1,\"position\":[0,0,0]},{\"time\":3,\"position\":[0,4,0]}]}]}");
    const struct sf_emitter *emitters = scene->emitters;
    float position[3], velocity[3], later[3], unused[3];

    (void)state;
    sf_scene_emitter_at(&emitters[0], 0, position, velocity);
    near3(position, 11, 0, 0, 0);
    near3(velocity, 0, 0, -1, 1e-6); /* (p1 - p3) / 2 */
    sf_scene_emitter_at(&emitters[0], 401, position, velocity);
    near3(position, 10, 0, -1, 1e-6);
    near3(velocity, -1, 0, 0, 1e-6);
    for (double t = 0; t < 4; t += 0.05) { /* velocity is the slope of the position, and the circle is nearly one */
        sf_scene_emitter_at(&emitters[0], t, position, velocity);
        sf_scene_emitter_at(&emitters[0], t + 1e-3, later, unused);
        for (int i = 0; i < 3; i++)
            assert_float_equal((later[i] - position[i]) / 1e-3, velocity[i], 5e-3);
        assert_true(fabs(hypot(position[0] - 10, position[2]) - 1) < 0.13);
    }
    sf_scene_emitter_at(&emitters[1], 7, position, velocity);
    near3(position, 0, 1, 0, 0);
    near3(velocity, 0, 0, 0, 0);
    sf_scene_emitter_at(&emitters[2], 2, position, velocity);
    near3(position, 0, 2, 0, 1e-6);
    near3(velocity, 0, 2, 0, 1e-6);
    sf_scene_emitter_at(&emitters[2], 5, position, velocity);
    near3(position, 0, 4, 0, 0);
    near3(velocity, 0, 0, 0, 0);
    sf_scene_destroy(&scene);
}

/* ---- hash and sets ---- */

static const char *small =
    "{\"sim\":{\"seed\":3},\"lights\":[{\"type\":\"point\",\"position\":[0,1,0],\"intensity\":2}]}";

static uint64_t hash_with(const char *set)
{
    struct sf_scene *scene = parse_with(small, &set, set ? 1 : 0);
    uint64_t hash = scene->hash;

    sf_scene_destroy(&scene);
    return hash;
}

static void test_hash(void **state)
{
    (void)state;
    assert_true(hash_with(NULL) == hash_with("sim.seed=3"));
    assert_true(hash_with(NULL) != hash_with("sim.seed=4"));
    assert_true(hash_with(NULL) == hash_with("lights.0.intensity=2.0"));
    assert_true(hash_with("lights.0.intensity=0.1") != hash_with("lights.0.intensity=0.2"));
    assert_true(hash_with("thick.steps=9") == hash_with("thick.steps=9"));
}

static void test_hash_counts_files(void **state)
{
    const char *text = "{\"emitters\":[{\"type\":\"list\",\"file\":\"a.csv\"}]}";
    uint64_t hashes[2];

    (void)state;
    for (int i = 0; i < 2; i++) {
        struct sf_scene *scene;
        FILE *file = fopen("a.csv", "w");

        assert_non_null(file);
        fprintf(file, "x,y,z,radius,extinction\n0,0,%d,1,1\n", i);
        fclose(file);
        scene = parse(text);
        hashes[i] = scene->hash;
        sf_scene_destroy(&scene);
    }
    assert_true(hashes[0] != hashes[1]);
}

static void test_sets(void **state)
{
    static const char *const sets[] = {"thick.steps=24",
                                       "lights.0.intensity=3.5",
                                       "method=none",
                                       "medium.albedo=0.1,0.2,0.3",
                                       "thick.detail=0",
                                       "thick.scene_shadow=false",
                                       "camera.type=orbit",
                                       "camera.period=5",
                                       "lights.0.type=spot",
                                       "lights.0.direction=0,-1,0",
                                       "environment.zenith=1e-1,0,0",
                                       "thick.steps=25"};
    struct sf_scene *scene = parse_with(small, sets, SF_COUNT(sets));

    (void)state;
    assert_int_equal(scene->thick.steps, 25); /* the last word counts */
    assert_float_equal(scene->lights[0].intensity, 3.5, 0);
    assert_int_equal(scene->lights[0].kind, SF_LIGHT_SPOT);
    assert_int_equal(scene->method, SF_METHOD_NONE);
    near3(scene->medium.albedo, 0.1, 0.2, 0.3, 1e-7);
    assert_false(scene->thick.scene_shadow);
    assert_float_equal(scene->camera.period, 5, 0);
    assert_float_equal(scene->environment.zenith[0], 0.1, 1e-7);
    sf_scene_destroy(&scene);
}

static void refuse_set(const char *set, const char *part)
{
    char named[300];

    refuse_with(small, &set, 1, SF_ERROR_USAGE, part);
    snprintf(named, sizeof named, "--set %s", set);
    refuse_with(small, &set, 1, SF_ERROR_USAGE, named);
}

static void test_bad_sets(void **state)
{
    static const char *const wrong_file = "camera.fov=30";

    (void)state;
    refuse_set("thick.stpes=24", "unknown key stpes, did you mean steps?");
    refuse_set("thik.steps=24", "unknown key thik, did you mean thick?");
    refuse_set("thick.steps", "expected KEY=VALUE");
    refuse_set("=3", "expected KEY=VALUE");
    refuse_set("thick..steps=3", "expected KEY=VALUE");
    refuse_set("thick.steps=many", "'many' is not a number");
    refuse_set("thick.steps=2.5", "whole number");
    refuse_set("thick.steps=0", "0 is out of range: 1 to 256");
    refuse_set("thick.steps=", "is not a number");
    refuse_set("medium.g=nan", "'nan' is not a number");
    refuse_set("thick=3", "is a group");
    refuse_set("thick.steps.x=3", "nothing can follow steps");
    refuse_set("lights=3", "lights is a list: write lights.0.KEY=VALUE");
    refuse_set("lights.0=3", "lights is a list");
    refuse_set("lights.first.intensity=3", "lights is a list");
    refuse_set("lights.1.intensity=3", "lights has 1 element, counted from 0");
    refuse_set("lights.18446744073709551617.intensity=3", "lights has 1 element");
    refuse_set("emitters.0.rate=3", "emitters has 0 elements");
    refuse_set("method=thikc", "did you mean thick?");
    refuse_set("lights.0.inner=3", "/lights/0/inner: type point does not take this key, only spot");
    refuse_set("camera.target=0,1.5,6", "/camera: at 0 s the camera is at its own target");
    refuse_set("lights.0.type=directional", "/lights/0: direction is missing");
    refuse_set("lights.0.type=spot", "/lights/0: direction is missing");
    refuse_set("environment.file=\xff", "UTF-8");
    refuse_set("environment.file=", "'' is not a file name"); /* it cannot go: it must be there */
    refuse_set("sim.capacity=1048577", "out of range: 1 to 1048576 particles");
    /* A file that is wrong by itself stays the file's fault. */
    refuse_with("{\"thick\":3}", &wrong_file, 1, SF_ERROR_SCENE, "test.json: /thick: must be an object");
    refuse_with("{\"camera\":3}", &wrong_file, 1, SF_ERROR_SCENE, "test.json: /camera: must be an object");
}

/* Another type takes along what of the file it does not take. */
static void test_sets_of_types(void **state)
{
    static const char *const orbit = "{\"camera\":{\"type\":\"orbit\",\"eye\":[1,2,3],\"period\":5,\"fov\":50}}";
    static const char *const keyed = "{\"camera\":{\"type\":\"keyframes\",\"//\":\"a comment\",\"near\":0.5,"
                                     "\"keys\":[{\"time\":0,\"eye\":[0,1,5],\"target\":[0,0,0]}]}}";
    static const char *const fixed[] = {"camera.type=fixed", "camera.eye=0,1,5"};
    static const char *const early[] = {"camera.eye=0,1,5", "camera.type=fixed"};
    static const char *const spot[] = {"lights.0.direction=0,-1,0", "lights.0.type=directional"};
    static const char *const own[] = {"camera.period=3", "camera.type=fixed"};
    static const char *const within[] = {"camera.keys.0.fov=30", "camera.type=fixed"};
    static const char *const late[] = {"camera.type=fixed", "camera.period=3"};
    static const char *const same = "camera.type=orbit", *const other = "camera.type=keyframes";
    struct sf_scene *scene = parse_with(orbit, fixed, 2);

    (void)state;
    assert_int_equal(scene->camera.kind, SF_CAMERA_FIXED);
    near3(scene->camera.eye, 0, 1, 5, 0);
    assert_float_equal(scene->camera.period, 0, 0);
    assert_float_equal(scene->camera.fov, 50, 0); /* what it takes stays */
    sf_scene_destroy(&scene);
    scene = parse_with(keyed, fixed, 2);
    assert_int_equal(scene->camera.key_count, 0);
    near3(scene->camera.eye, 0, 1, 5, 0);
    assert_float_equal(scene->camera.near_clip, 0.5, 0);
    sf_scene_destroy(&scene);
    scene = parse_with(keyed, early, 2); /* the new type's keys may come first */
    near3(scene->camera.eye, 0, 1, 5, 0);
    sf_scene_destroy(&scene);
    scene = parse_with(small, spot, 2);
    assert_int_equal(scene->lights[0].kind, SF_LIGHT_DIRECTIONAL);
    near3(scene->lights[0].position, 0, 0, 0, 0);
    assert_float_equal(scene->lights[0].intensity, 2, 0);
    sf_scene_destroy(&scene);
    scene = parse_with(orbit, &same, 1);
    assert_float_equal(scene->camera.period, 5, 0);
    sf_scene_destroy(&scene);
    /* What sets have put there is never dropped without a word. */
    refuse_with(orbit, own, 2, SF_ERROR_USAGE,
                "--set camera.period=3: /camera/period: type fixed does not take this key");
    refuse_with(orbit, late, 2, SF_ERROR_USAGE, "--set camera.period=3: /camera/period: type fixed does not take");
    refuse_with(keyed, within, 2, SF_ERROR_USAGE, "fixed does not take keys, which is given");
    refuse_with(orbit, &other, 1, SF_ERROR_USAGE, "/camera: keys is missing");
    /* A file that is wrong by itself stays wrong when the type does not change. */
    refuse_with("{\"camera\":{\"period\":5}}", &fixed[0], 1, SF_ERROR_USAGE, "fixed does not take period");
}

static void count_warnings(void *user, enum sf_log_level level, const char *message)
{
    unsigned *count = user;

    if (level == SF_LOG_WARNING && strstr(message, "test.json: /"))
        ++*count;
}

static void test_warnings(void **state)
{
    const char *text = "{\"forces\":[{\"type\":\"wind\",\"velocity\":[1,0,0]}],"
                       "\"emitters\":[{\"type\":\"cone\",\"rate\":5000}]}";
    unsigned count = 0;
    struct sf_log log = {count_warnings, &count, SF_LOG_WARNING};
    struct sf_scene *scene;

    (void)state;
    /* Odd, but allowed: wind that nothing feels, more particles than there is room for. */
    assert_int_equal(sf_scene_parse("test.json", text, strlen(text), NULL, 0, &log, &scene), SF_OK);
    assert_int_equal(count, 2);
    sf_scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shipped_scenes_load),
        cmocka_unit_test(test_plume_is_what_the_benchmark_needs),
        cmocka_unit_test(test_least_scene_and_defaults),
        cmocka_unit_test(test_values_arrive),
        cmocka_unit_test(test_comments_and_schema),
        cmocka_unit_test(test_orbit),
        cmocka_unit_test(test_keyframes),
        cmocka_unit_test(test_emitter_path),
        cmocka_unit_test(test_hash),
        cmocka_unit_test(test_hash_counts_files),
        cmocka_unit_test(test_sets),
        cmocka_unit_test(test_bad_sets),
        cmocka_unit_test(test_sets_of_types),
        cmocka_unit_test(test_warnings),
    };
    return cmocka_run_group_tests(tests, scratch_enter, scratch_leave);
}
