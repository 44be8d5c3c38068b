/* Saving scenes: what is written, that it is the same scene, and that nothing is left when it cannot be. */
#include "shipped_kit.h"

#include "base/file.h"
#include "base/hash.h"

static char *read_text(const char *path, size_t *bytes)
{
    char *text = NULL;

    if (sf_file_read(path, 64 << 20, NULL, &text, bytes) != SF_OK)
        fail_msg("%s cannot be read", path);
    return text;
}

static void write_text(const char *path, const char *text)
{
    assert_int_equal(sf_file_write(path, text, strlen(text), NULL), SF_OK);
}

/* Saves the file `from`, with sets, as `to`. */
static void save(const char *from, const char *const *sets, uint32_t set_count, const char *to)
{
    struct caught caught = {"", 0};
    struct sf_log log = {caught_write, &caught, SF_LOG_WARNING};
    size_t bytes;
    char *text = read_text(from, &bytes);

    if (sf_scene_save(from, text, bytes, sets, set_count, to, &log) != SF_OK)
        fail_msg("%s with %s as %s: %s", from, set_count ? sets[0] : "no set", to, caught.text);
    free(text);
}

/* ---- the same scene ---- */

/* The names of files as the other scene has them: only what they hold counts then. */
static void take_names(struct sf_scene *to, const struct sf_scene *from)
{
    for (uint32_t i = 0; i < to->object_count; i++)
        to->objects[i].file = from->objects[i].file;
    for (uint32_t i = 0; i < to->emitter_count; i++)
        to->emitters[i].file = from->emitters[i].file;
    to->atlas.file = from->atlas.file;
    for (uint32_t i = 0; i < to->effect_count; i++)
        to->effects[i].file = from->effects[i].file;
    to->environment.file = from->environment.file;
    memcpy(to->environment.files, from->environment.files, sizeof to->environment.files);
}

static void compare(const char *saved, const char *from, const char *const *sets, uint32_t set_count)
{
    struct sf_scene *before = load_with(from, sets, set_count), *after = load_with(saved, NULL, 0);
    struct controls a = controls_of(before), b = controls_of(after);

    assert_same_controls(&a, &b, false, from);
    take_names(after, before);
    if (sf_scene_difference(before, after) != 0)
        fail_msg("%s: saving makes another scene of it", from);
    free(a.list);
    free(b.list);
    sf_scene_destroy(&before);
    sf_scene_destroy(&after);
}

static const char *const set_lists[][4] = {
    {NULL},
    {"thick.steps=24", "sim.seed=9", "output.exposure=-0.1", "camera.near=0.0123456"},
    {"camera.type=fixed", "camera.eye=-0,1.1,7.3", "camera.target=0,1e-7,0", "method=none"},
    {"environment.type=color", "environment.color=0.1,0.2,0.3", "environment.visible=false", "thick.detail=0"},
    {"sim.substeps=2", "thick.octaves=1", "medium.g=0", "environment.intensity=1"}, /* defaults */
};

/* No object stands on a line that is too long for it. */
static void check_lines(const char *text)
{
    for (const char *end; (end = strchr(text, '\n')); text = end + 1) {
        const char *object = strstr(text, "{ ");

        if (end - text > 120 && object && object < end)
            fail_msg("a line of %d: %.*s", (int)(end - text), (int)(end - text), text);
    }
}

static void save_shipped(const char *path)
{
    for (size_t i = 0; i < sizeof set_lists / sizeof set_lists[0]; i++) {
        uint32_t count = set_lists[i][0] ? 4 : 0;
        size_t first, second;
        char *once, *twice;

        save(path, set_lists[i], count, "saved.json");
        compare("saved.json", path, set_lists[i], count);
        /* What is saved is saved as it is. */
        save("saved.json", NULL, 0, "again.json");
        once = read_text("saved.json", &first);
        twice = read_text("again.json", &second);
        assert_string_equal(once, twice);
        check_lines(once);
        free(once);
        free(twice);
        assert_int_equal(scratch_count("."), 2); /* no temporary stays */
        unlink("saved.json");
        unlink("again.json");
    }
}

static void test_shipped_scenes_stay_the_same(void **state)
{
    (void)state;
    assert_true(each_shipped(save_shipped) >= 16);
}

/* Every control at a random value. */
static void test_numbers_keep_their_bits(void **state)
{
    const char *path = source_path("scenes/tiny/all.json");
    struct sf_scene *scene = load_with(path, NULL, 0);
    struct controls controls = controls_of(scene);
    unsigned saved = 0;

    (void)state;
    for (uint32_t i = 0; i < 2 * controls.count; i++) {
        struct sf_control control = controls.list[i % controls.count];
        struct sf_scene *again = NULL;
        const char *set;

        if (control.kind != SF_CONTROL_FLOAT && control.kind != SF_CONTROL_VECTOR && control.kind != SF_CONTROL_COLOR)
            continue;
        for (uint32_t k = 0; k < control.numbers; k++)
            control.value[k] =
                (double)(float)(control.min + sf_random_float(3, i, k) / (1 + i % 999) * (control.max - control.min));
        set = sf_control_print(&control);
        if (sf_scene_load(path, &set, 1, NULL, &again) == SF_OK) {
            save(path, &set, 1, "saved.json");
            compare("saved.json", path, &set, 1);
            saved++;
        }
        sf_scene_destroy(&again);
        free((char *)set);
    }
    assert_true(saved > 150);
    unlink("saved.json");
    free(controls.list);
    sf_scene_destroy(&scene);
}

/* Digits changed at random: what can be read can be saved, and is the same. */
static void test_what_loads_can_be_saved(void **state)
{
    const char *path = source_path("scenes/tiny/all.json");
    unsigned saved = 0;
    size_t bytes;
    char *text = read_text(path, &bytes);

    (void)state;
    for (uint32_t i = 0; i < 400; i++) {
        char *copy = malloc(bytes + 1);
        struct sf_scene *before = NULL, *after = NULL;

        assert_non_null(copy);
        memcpy(copy, text, bytes + 1);
        for (uint32_t k = 0; k < 1 + i % 9; k++) {
            char *at = copy + sf_random_u32(4, i, k) % bytes;

            if (strchr("0123456789", *at))
                *at = "0123456789-.e"[sf_random_u32(5, i, k) % 13];
        }
        if (sf_scene_parse(path, copy, bytes, NULL, 0, NULL, &before) == SF_OK) {
            assert_int_equal(sf_scene_save(path, copy, bytes, NULL, 0, "saved.json", NULL), SF_OK);
            after = load_with("saved.json", NULL, 0);
            struct controls a = controls_of(before), b = controls_of(after);
            assert_same_controls(&a, &b, false, "noise");
            free(a.list);
            free(b.list);
            saved++;
        }
        sf_scene_destroy(&before);
        sf_scene_destroy(&after);
        free(copy);
    }
    assert_true(saved > 100);
    free(text);
}

/* ---- what is written ---- */

static void expect(const char *text, const char *const *sets, uint32_t set_count, const char *expected)
{
    struct caught caught = {"", 0};
    struct sf_log log = {caught_write, &caught, SF_LOG_WARNING};
    size_t bytes;
    char *written;

    if (sf_scene_save("test.json", text, strlen(text), sets, set_count, "saved.json", &log) != SF_OK)
        fail_msg("%s: %s", text, caught.text);
    written = read_text("saved.json", &bytes);
    assert_string_equal(written, expected);
    free(written);
    unlink("saved.json");
}

static void test_only_what_differs_is_written(void **state)
{
    static const char *const sets[] = {"thick.steps=8", "sim.seed=4", "lights.0.intensity=3", "camera.fov=40",
                                       "environment.type=sky"};

    (void)state;
    expect("{}", NULL, 0, "{}\n");
    expect("{\"sim\":{\"fps\":24.0,\"seed\":1},\"method\":\"thick\",\"lights\":[],\"medium\":{}}", NULL, 0, "{}\n");
    expect("{\"environment\":{\"type\":\"color\",\"color\":[0.5,0.5,0.5]},\"sim\":{\"//\":\"seconds\",\"preroll\":0},"
           "\"lights\":[{\"intensity\":2.5,\"type\":\"directional\",\"direction\":[0,-1,0],\"color\":[1,1,1]}]}",
           sets, 4,
           "{\n"
           "    \"environment\": { \"type\": \"color\" },\n"
           "    \"sim\": { \"//\": \"seconds\", \"seed\": 4 },\n"
           "    \"lights\": [{ \"type\": \"directional\", \"direction\": [0, -1, 0] }]\n"
           "}\n");
    expect("{\"environment\":{\"type\":\"color\",\"color\":[0.1,0.5,0.5],\"intensity\":1.5}}", sets + 4, 1,
           "{\n    \"environment\": { \"intensity\": 1.5 }\n}\n");
    /* An empty list of particles is not the same as none. */
    expect("{\"emitters\":[{\"type\":\"list\",\"particles\":[]}]}", NULL, 0,
           "{\n    \"emitters\": [{ \"type\": \"list\", \"particles\": [] }]\n}\n");
    /* A range is its default in either form, and lower first. */
    expect("{\"emitters\":[{\"type\":\"cone\",\"lifetime\":[4,5],\"speed\":[0.8,1.2],\"particle_radius\":0.15}]}", NULL,
           0, "{\n    \"emitters\": [{ \"type\": \"cone\", \"particle_radius\": 0.15 }]\n}\n");
}

static void test_layout(void **state)
{
    static const char *const long_word = "a word that is so long that the line which it stands in has to be broken";
    char text[1024], expected[1024];

    (void)state;
    snprintf(text, sizeof text,
             "{\"//\":[\"%s\",{\"two\":null,\"three\":[true,false,[],{}]},\"%s\"],\"medium\":{\"//"
             "\":\"\\\"\\\\\\u0001\\n\\u00e9\","
             "\"g\":-0.0,\"extinction\":1e-7,\"albedo\":[0.1,1,0.30000000000000004]}}",
             long_word, long_word);
    snprintf(expected, sizeof expected,
             "{\n"
             "    \"//\": [\n"
             "        \"%s\",\n"
             "        { \"two\": null, \"three\": [true, false, [], {}] },\n"
             "        \"%s\"\n"
             "    ],\n"
             "    \"medium\": { \"//\": \"\\\"\\\\\\u0001\\u000a\xc3\xa9\", \"g\": -0.0, "
             "\"extinction\": 1e-07, \"albedo\": [0.1, 1, 0.30000000000000004] }\n"
             "}\n",
             long_word, long_word);
    expect(text, NULL, 0, expected);
}

/* ---- names of files ---- */

static const char *particles = "x,y,z,radius,extinction\n0,0,0,1,1\n";

static void expect_file(const char *saved, const char *name, const char *schema)
{
    size_t bytes;
    char *text = read_text(saved, &bytes), part[256];

    snprintf(part, sizeof part, "\"file\": \"%s\"", name);
    if (!strstr(text, part))
        fail_msg("%s: no %s in %s", saved, part, text);
    snprintf(part, sizeof part, "\"$schema\": \"%s\"", schema ? schema : "");
    if (!strstr(text, schema ? part : "\"file\"") || (!schema && strstr(text, "$schema")))
        fail_msg("%s: %s is not as expected: %s", saved, part, text);
    free(text);
    compare(saved, "a/b/scene.json", NULL, 0);
}

static void test_names_fit_the_folder(void **state)
{
    char here[2048], long_name[4096], *text;
    size_t bytes;

    (void)state;
    assert_non_null(getcwd(here, sizeof here));
    assert_int_equal(sf_folder_create("a/b/parts", NULL), SF_OK);
    assert_int_equal(sf_folder_create("a/c", NULL), SF_OK);
    assert_int_equal(symlink("a/b", "link"), 0);
    write_text("a/b/parts/list.csv", particles);
    write_text("a/list.csv", particles);
    write_text("a/b/scene.json", "{\"$schema\":\"../../docs/s.json\","
                                 "\"emitters\":[{\"type\":\"list\",\"file\":\"./parts/list.csv\"}]}");
    save("a/b/scene.json", NULL, 0, "a/b/beside.json");
    expect_file("a/b/beside.json", "./parts/list.csv", "../../docs/s.json"); /* as it stands */
    save("a/b/scene.json", NULL, 0, "link/linked.json");
    expect_file("a/b/linked.json", "./parts/list.csv", "../../docs/s.json"); /* the same folder by another way */
    save("a/b/scene.json", NULL, 0, "a/c/x.json");
    expect_file("a/c/x.json", "../b/parts/list.csv", "../../docs/s.json");
    save("a/b/scene.json", NULL, 0, "x.json");
    expect_file("x.json", "a/b/parts/list.csv", "docs/s.json");
    save("a/b/scene.json", NULL, 0, "a/b/parts/x.json");
    expect_file("a/b/parts/x.json", "list.csv", "../../../docs/s.json");
    save("link/scene.json", NULL, 0, "x.json");
    expect_file("x.json", "a/b/parts/list.csv", "docs/s.json");
    save("x.json", NULL, 0, "a/b/scene2.json"); /* and back */
    expect_file("a/b/scene2.json", "parts/list.csv", "../../docs/s.json");

    write_text("a/b/scene.json", "{\"$schema\":\"https://x.org/s.json\","
                                 "\"emitters\":[{\"type\":\"list\",\"file\":\"../list.csv\"}]}");
    save("a/b/scene.json", NULL, 0, "a/c/x.json");
    expect_file("a/c/x.json", "../list.csv", "https://x.org/s.json");
    snprintf(long_name, sizeof long_name, "{\"emitters\":[{\"type\":\"list\",\"file\":\"%s/a/list.csv\"}]}", here);
    write_text("a/b/scene.json", long_name);
    save("a/b/scene.json", NULL, 0, "a/c/x.json");
    snprintf(long_name, sizeof long_name, "%s/a/list.csv", here);
    expect_file("a/c/x.json", long_name, NULL); /* absolute: as it is */

    /* A text that has no folder loses a schema that nobody can find, and keeps one that anybody can. */
    assert_int_equal(sf_scene_save("no/folder.json", "{\"$schema\":\"s.json\"}", 20, NULL, 0, "x.json", NULL), SF_OK);
    text = read_text("x.json", &bytes);
    assert_string_equal(text, "{}\n");
    free(text);
}

/* Folders that share only the root: no way through it. */
static void test_far_folders(void **state)
{
    const char *scene = source_path("scenes/tiny/list-csv.json");
    char here[2048], start[64], *text;
    size_t bytes;

    (void)state;
    assert_non_null(getcwd(here, sizeof here));
    if (strncmp(here, scene, strcspn(here + 1, "/") + 2) == 0)
        skip();
    save(scene, NULL, 0, "x.json");
    text = read_text("x.json", &bytes);
    snprintf(start, sizeof start, "\"file\": \"%.*s", (int)(strcspn(scene + 1, "/") + 2), scene);
    assert_non_null(strstr(text, start));
    free(text);
    compare("x.json", scene, NULL, 0);
}

static void test_six_pictures(void **state)
{
    const char *scene = source_path("scenes/tiny/cube.json");

    (void)state;
    save(scene, NULL, 0, "x.json");
    compare("x.json", scene, NULL, 0);
}

/* ---- when it cannot be ---- */

static void refuse_save(const char *text, const char *const *sets, uint32_t set_count, const char *path,
                        enum sf_status expected, const char *part)
{
    struct caught caught = {"", 0};
    struct sf_log log = {caught_write, &caught, SF_LOG_WARNING};
    unsigned before = scratch_count(".");

    assert_int_equal(sf_scene_save("test.json", text, strlen(text), sets, set_count, path, &log), expected);
    assert_caught(&caught, part);
    assert_int_equal(scratch_count("."), before);
}

static void test_failures_leave_nothing(void **state)
{
    static const char *const bad = "thick.steps=0", *const gone = "environment.file=gone.exr";
    static const char *const far[] = {"environment.type=latlong", "environment.file=gone.exr"};
    char *text;
    size_t bytes;

    (void)state;
    assert_int_equal(sf_folder_create("folder", NULL), SF_OK);
    write_text("kept.json", "{}");
    refuse_save("{}", NULL, 0, "nowhere/x.json", SF_ERROR_IO, "nowhere/x.json");
    refuse_save("{}", NULL, 0, "kept.json/x.json", SF_ERROR_IO, "kept.json/x.json");
    refuse_save("{}", NULL, 0, "folder", SF_ERROR_IO, "it is a folder");
    if (geteuid() != 0) { /* who may do anything is not kept out */
        assert_int_equal(chmod("folder", 0500), 0);
        refuse_save("{}", NULL, 0, "folder/x.json", SF_ERROR_IO, "folder/x.json");
    }
    assert_int_equal(scratch_count("folder"), 0);
    refuse_save("{", NULL, 0, "kept.json", SF_ERROR_SCENE, "test.json:1:");
    refuse_save("{\"sim\":{\"sed\":1}}", NULL, 0, "kept.json", SF_ERROR_SCENE, "did you mean seed?");
    refuse_save("{}", &bad, 1, "kept.json", SF_ERROR_USAGE, "--set thick.steps=0: 0 is out of range");
    refuse_save("{}", &gone, 1, "kept.json", SF_ERROR_USAGE, "type sky does not take this key");
    refuse_save("{}", far, 2, "kept.json", SF_ERROR_USAGE, "gone.exr");
    text = read_text("kept.json", &bytes);
    assert_string_equal(text, "{}");
    free(text);
}

/* What turns out only when the text is there: a name that has become too long. */
static void test_late_failures_leave_nothing(void **state)
{
    struct caught caught = {"", 0};
    struct sf_log log = {caught_write, &caught, SF_LOG_WARNING};
    char text[8192] = "{\"emitters\":[{\"type\":\"list\",\"file\":\"parts/";

    (void)state;
    assert_int_equal(sf_folder_create("a/b/parts", NULL), SF_OK);
    assert_int_equal(sf_folder_create("c/d/e/f/g/h", NULL), SF_OK);
    write_text("a/b/parts/list.csv", particles);
    for (int i = 0; i < 2030; i++)
        strcat(text, "./");
    strcat(text, "list.csv\"}]}");
    assert_int_equal(sf_scene_save("a/b/scene.json", text, strlen(text), NULL, 0, "a/b/x.json", &log), SF_OK);
    assert_int_equal(sf_scene_save("a/b/scene.json", text, strlen(text), NULL, 0, "c/d/e/f/g/h/x.json", &log),
                     SF_ERROR_SCENE);
    assert_caught(&caught, "c/d/e/f/g/h/x.json: /emitters/0/file: ");
    assert_int_equal(scratch_count("c/d/e/f/g/h"), 0);
}

static int empty(void **state)
{
    (void)state;
    scratch_empty(".");
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_shipped_scenes_stay_the_same, empty),
        cmocka_unit_test_teardown(test_numbers_keep_their_bits, empty),
        cmocka_unit_test_teardown(test_what_loads_can_be_saved, empty),
        cmocka_unit_test_teardown(test_only_what_differs_is_written, empty),
        cmocka_unit_test_teardown(test_layout, empty),
        cmocka_unit_test_teardown(test_names_fit_the_folder, empty),
        cmocka_unit_test_teardown(test_far_folders, empty),
        cmocka_unit_test_teardown(test_six_pictures, empty),
        cmocka_unit_test_teardown(test_failures_leave_nothing, empty),
        cmocka_unit_test_teardown(test_late_failures_leave_nothing, empty),
    };
    return cmocka_run_group_tests(tests, scratch_enter, scratch_leave);
}
