/* Scenes that are wrong: each fault by its message and status; and noise, which must never do more than fail. */
#include "scene_kit.h"

#include <time.h>
#include "base/file.h"
#include "base/hash.h"

/* ---- JSON itself ---- */

static void test_not_json(void **state)
{
    (void)state;
    refuse("", "test.json: the file is empty");
    refuse("   \n", "test.json:");
    refuse("{\"sim\": {\"seed\": 1}", "test.json:1:19: '}' expected");
    refuse("{\n  \"sim\": {\n    \"seed\": 1,\n  }\n}", "test.json:4:3: string or '}' expected");
    refuse("[]", "test.json: a scene is a JSON object");
    refuse("3", "test.json:1:1:");
    refuse("{\"sim\":{\"seed\":1,\"seed\":2}}", "duplicate object key");
    refuse("{\"sim\":1}x", "end of file expected");
    refuse("{\"a\xff\":1}", "unable to decode byte 0xff");
    refuse("{\"a\\u0000\":1}", "test.json:1:");
    refuse("{\"camera\":{\"fov\":NaN}}", "test.json:1:");
    refuse("{\"camera\":{\"fov\":Infinity}}", "test.json:1:");
    refuse("{\"camera\":{\"fov\":1e999}}", "real number overflow");
    refuse("{\"sim\":{\"seed\":99999999999999999999}}", "too big integer");
}

static void test_deep_nesting(void **state)
{
    enum { DEPTH = 200000 };
    char *text = malloc(DEPTH + 16);

    (void)state;
    assert_non_null(text);
    strcpy(text, "{\"//\":");
    memset(text + 6, '[', DEPTH);
    text[6 + DEPTH] = '\0';
    refuse(text, "maximum parsing depth reached");
    free(text);
}

static void test_too_much_in_little(void **state)
{
    enum { PAIRS = 5000000 };
    char *text = malloc(3 * PAIRS + 32), *at = text;

    (void)state;
    assert_non_null(text);
    at += sprintf(at, "{\"//\":[");
    for (int i = 0; i < PAIRS; i++, at += 3)
        memcpy(at, "[],", 3);
    strcpy(at, "0]}");
    refuse(text, "test.json: more than 4000000 lists and objects");
    free(text);
}

/* ---- keys and values, one by one ---- */

static void test_faults(void **state)
{
    static const struct {
        const char *text, *part;
    } faults[] = {
        {"{\"emiters\":[]}", "test.json: /emiters: unknown key, did you mean emitters?"},
        {"{\"emitters\":[{\"type\":\"cone\",\"temprature\":3}]}",
         "test.json: /emitters/0/temprature: unknown key, did you mean temperature?"},
        {"{\"sim\":{\"$schema\":\"x\"}}", "/sim/$schema: unknown key"},
        {"{\"$schema\":3}", "/$schema: unknown key"},
        {"{\"a~b/c\":3}", "/a~0b~1c: unknown key"},
        {"{\"a\\u0007b\":3}", "/a?b: unknown key"},
        {"{\"camera\":[]}", "/camera: must be an object, not a list"},
        {"{\"lights\":{}}", "/lights: must be a list, not an object"},
        {"{\"lights\":[3]}", "/lights/0: must be an object, not a number"},
        {"{\"lights\":[{}]}", "/lights/0: type is missing (directional, point, spot)"},
        {"{\"lights\":[{\"type\":\"sptt\",\"position\":[0,0,0]}]}",
         "/lights/0/type: 'sptt' is not one of directional, point, spot, did you mean spot?"},
        {"{\"lights\":[{\"type\":1}]}", "/lights/0/type: must be one of directional, point, spot, not a number"},
        {"{\"lights\":[{\"type\":\"point\",\"position\":[0,0,0],\"inner\":3}]}",
         "/lights/0/inner: type point does not take this key, only spot"},
        {"{\"lights\":[{\"type\":\"directional\"}]}", "/lights/0: direction is missing (the way the light travels"},
        {"{\"lights\":[{\"type\":\"directional\",\"direction\":[0,0,0]}]}",
         "/lights/0/direction: 0,0,0 has no direction"},
        {"{\"lights\":[{\"type\":\"directional\",\"direction\":[0,0]}]}",
         "/lights/0/direction: must hold 3 numbers, and holds 2"},
        {"{\"lights\":[{\"type\":\"directional\",\"direction\":[0,\"1\",0]}]}",
         "/lights/0/direction/1: must be a number, not a string"},
        {"{\"lights\":[{\"type\":\"directional\",\"direction\":1}]}",
         "/lights/0/direction: must be a list of three numbers, not a number"},
        {"{\"lights\":[{\"type\":\"spot\",\"position\":[0,0,0],\"direction\":[0,1,0],\"inner\":30,\"outer\":20}]}",
         "/lights/0: inner (30 deg) must be less than outer (20 deg)"},
        {"{\"lights\":[{\"type\":\"point\",\"position\":[0,0,0],\"color\":[1,-0.1,0]}]}",
         "/lights/0/color/1: -0.1 is out of range: 0 to 1000"},
        {"{\"camera\":{\"fov\":171}}", "/camera/fov: 171 is out of range: 1 to 170 deg"},
        {"{\"camera\":{\"fov\":true}}", "/camera/fov: must be a number, not true or false"},
        {"{\"camera\":{\"fov\":null}}", "/camera/fov: must be a number, not null"},
        {"{\"camera\":{\"eye\":[1,2,3],\"target\":[1,2,3]}}", "/camera: at 0 s the camera is at its own target"},
        {"{\"camera\":{\"eye\":[0,5,0],\"target\":[0,0,0]}}", "/camera: at 0 s the camera looks along up"},
        {"{\"camera\":{\"up\":[0,0,0]}}", "/camera/up: has no length"},
        {"{\"camera\":{\"type\":\"orbit\",\"period\":0}}", "/camera/period: 0 is too short"},
        {"{\"camera\":{\"type\":\"orbit\",\"up\":[1,0,0],\"eye\":[0,0,4],\"target\":[0,0,0]}}",
         "the camera looks along up"},
        {"{\"camera\":{\"type\":\"keyframes\"}}", "/camera: keys is missing"},
        {"{\"camera\":{\"type\":\"keyframes\",\"keys\":[]}}", "/camera/keys: holds 0 elements; 1 to 64 are allowed"},
        {"{\"camera\":{\"type\":\"keyframes\",\"keys\":[{\"time\":0,\"eye\":[0,0,1],\"target\":[0,0,0]},{\"time\":0,"
         "\"eye\":[0,0,2],\"target\":[0,0,0]}]}}",
         "/camera/keys/1/time: 0 s is not later"},
        {"{\"camera\":{\"type\":\"keyframes\",\"keys\":[{\"time\":0,\"eye\":[0,0,1],\"target\":[0,0,0]},{\"time\":1,"
         "\"eye\":[0,0,-1],\"target\":[0,0,0]}]}}",
         "/camera/keys/1: at 0.5 s the camera is at its own target"},
        {"{\"objects\":[{\"type\":\"sphere\",\"radius\":-1}]}",
         "/objects/0/radius: -1 is out of range: 0.001 to 100000 m"},
        {"{\"objects\":[{\"type\":\"sphere\",\"height\":1}]}",
         "/objects/0/height: type sphere does not take this key, only cylinder"},
        {"{\"objects\":[{\"type\":\"plane\",\"normal\":[0,0,0]}]}", "/objects/0/normal: 0,0,0 has no direction"},
        {"{\"objects\":[{\"type\":\"box\",\"collide\":1}]}", "/objects/0/collide: must be true or false, not a number"},
        {"{\"objects\":[{\"type\":\"mesh\"}]}", "/objects/0: file is missing"},
        {"{\"objects\":[{\"type\":\"mesh\",\"file\":\"\"}]}", "/objects/0/file: is empty"},
        {"{\"objects\":[{\"type\":\"mesh\",\"file\":\"no.obj\"}]}", "test.json: /objects/0/file: no.obj: no such file"},
        {"{\"objects\":[{\"type\":\"mesh\",\"file\":\"no.stl\"}]}",
         "unsupported kind of file; meshes come from .obj, .gltf or .glb"},
        {"{\"medium\":{\"g\":1}}", "/medium/g: 1 is out of range: -0.99 to 0.99"},
        {"{\"ramp\":[{\"at\":0.5,\"color\":[1,1,1]},{\"at\":0.5,\"color\":[1,1,1]}]}",
         "/ramp/1/at: 0.5 is not above the key before"},
        {"{\"emitters\":[{\"type\":\"cone\",\"direction\":[0,0,0]}]}", "/emitters/0/direction: 0,0,0 has no direction"},
        {"{\"emitters\":[{\"type\":\"cone\",\"lifetime\":[2,1]}]}",
         "/emitters/0/lifetime: is no range: the lower number comes first"},
        {"{\"emitters\":[{\"type\":\"cone\",\"lifetime\":[0,1]}]}",
         "/emitters/0/lifetime/0: 0 is out of range: 0.001 to"},
        {"{\"emitters\":[{\"type\":\"cone\",\"lifetime\":\"1\"}]}",
         "/emitters/0/lifetime: must be a number or a list of two, not a string"},
        {"{\"emitters\":[{\"type\":\"cone\",\"burst\":1.5}]}", "/emitters/0/burst: 1.5 is not a whole number"},
        {"{\"emitters\":[{\"type\":\"mesh\"}]}", "/emitters/0: file is missing (OBJ or glTF)"},
        {"{\"emitters\":[{\"type\":\"list\"}]}", "/emitters/0: particles or file is missing"},
        {"{\"emitters\":[{\"type\":\"list\",\"file\":\"a.csv\",\"particles\":[]}]}",
         "/emitters/0: particles and file exclude each other"},
        {"{\"emitters\":[{\"type\":\"list\",\"file\":\"no.csv\"}]}", "test.json: /emitters/0/file: cannot"},
        {"{\"emitters\":[{\"type\":\"list\",\"file\":\"no.txt\"}]}",
         "/emitters/0/file: no.txt: unsupported kind of file; particles come from .csv or .ply"},
        {"{\"emitters\":[{\"type\":\"list\",\"particles\":[{\"radius\":1}]}]}",
         "/emitters/0/particles/0: centre is missing"},
        {"{\"emitters\":[{\"type\":\"list\",\"particles\":[{\"centre\":[0,0,0],\"radius\":0}]}]}",
         "/emitters/0/particles/0/radius: 0 is out of range: 0.0001 to 10000 m"},
        {"{\"emitters\":[{\"type\":\"list\",\"particles\":[{\"centre\":[0,0,0],\"radius\":1,\"tile\":1.5}]}]}",
         "/emitters/0/particles/0/tile: 1.5 is not a whole number"},
        {"{\"emitters\":[{\"type\":\"cone\",\"path\":[{\"time\":1,\"position\":[0,0,0]},{\"time\":0.5,\"position\":[0,"
         "0,0]}]}]}",
         "/emitters/0/path/1/time: 0.5 s is not later"},
        {"{\"emitters\":[{\"type\":\"cone\",\"path_loop\":true}]}", "/emitters/0/path_loop: needs a path"},
        {"{\"emitters\":[{\"type\":\"cone\",\"path_loop\":true,\"path\":[{\"time\":0,\"position\":[0,0,0]},{\"time\":1,"
         "\"position\":[1,0,0]},{\"time\":2,\"position\":[0,1,0]}]}]}",
         "the last key of the path must be where the first one is"},
        {"{\"forces\":[{\"type\":\"drag\",\"strength\":-1}]}",
         "/forces/0/strength: -1 is below 0, which drag cannot be"},
        {"{\"forces\":[{\"type\":\"drag\"}]}", "/forces/0: strength is missing"},
        {"{\"forces\":[{\"type\":\"vortex\",\"strength\":1,\"axis\":[0,0,0]}]}",
         "/forces/0/axis: 0,0,0 has no direction"},
        {"{\"environment\":{\"type\":\"latlong\"}}", "/environment: file is missing"},
        {"{\"environment\":{\"type\":\"latlong\",\"file\":\"no.exr\"}}", "test.json: /environment/file: "},
        {"{\"environment\":{\"type\":\"cube\",\"files\":[\"a\",\"b\"]}}",
         "/environment/files: must hold 6 file names, and holds 2"},
        {"{\"environment\":{\"type\":\"cube\",\"files\":[1,2,3,4,5,6]}}",
         "/environment/files/0: must be a string, not a number"},
        {"{\"atlas\":{\"type\":\"file\"}}", "/atlas: file is missing"},
        {"{\"atlas\":{\"type\":\"file\",\"file\":\"no.exr\"}}", "test.json: /atlas/file: "},
        {"{\"atlas\":{\"file\":\"a.exr\"}}", "/atlas/file"},
        {"{\"atlas\":{\"type\":\"made\",\"across\":0}}", "/atlas/across: 0 is out of range: 1 to 8"},
        {"{\"atlas\":{\"type\":\"made\",\"kind\":\"turbulance\"}}", "did you mean turbulence?"},
        {"{\"method\":\"thik\"}",
         "/method: 'thik' is not one of none, thick, thick-larsson, reference, hard, soft, soft-contrast, "
         "spherical, mega, average-density, density-extent, volumetric, lit, lit-scattering, did you mean thick?"},
        {"{\"sim\":{\"capacity\":1048577}}", "/sim/capacity: 1048577 is out of range: 1 to 1048576 particles"},
        {"{\"sim\":{\"capacity\":1},\"emitters\":[{\"type\":\"list\",\"particles\":[{\"centre\":[0,0,0],\"radius\":1},{"
         "\"centre\":[0,0,0],\"radius\":1}]}]}",
         "/sim/capacity: 1 is too small for the 2 particles that are listed"},
        {"{\"thick\":{\"steps\":9223372036854775807}}", "/thick/steps: 9223372036854775807 is out of range: 1 to 256"},
    };

    (void)state;
    for (size_t i = 0; i < SF_COUNT(faults); i++)
        refuse(faults[i].text, faults[i].part);
}

static void test_lists_that_are_too_long(void **state)
{
    static const struct {
        const char *key, *element;
        unsigned most;
    } lists[] = {
        {"lights", "{\"type\":\"point\",\"position\":[0,0,0]}", SF_LIGHTS_MAX},
        {"objects", "{\"type\":\"plane\"}", SF_OBJECTS_MAX},
        {"emitters", "{\"type\":\"cone\"}", SF_EMITTERS_MAX},
        {"forces", "{\"type\":\"gravity\"}", SF_FORCES_MAX},
    };

    (void)state;
    for (size_t i = 0; i < SF_COUNT(lists); i++) {
        struct sf_text text = {0};
        struct sf_scene *scene;
        char part[96];

        sf_text_printf(&text, "{\"%s\":[%s", lists[i].key, lists[i].element);
        for (unsigned k = 1; k < lists[i].most; k++)
            sf_text_printf(&text, ",%s", lists[i].element);
        sf_text_append(&text, "]}");
        scene = parse(text.data);
        sf_scene_destroy(&scene);
        text.length -= 2;
        sf_text_printf(&text, ",%s]}", lists[i].element);
        snprintf(part, sizeof part, "/%s: holds %u elements; 0 to %u are allowed", lists[i].key, lists[i].most + 1,
                 lists[i].most);
        refuse(text.data, part);
        sf_text_finish(&text);
    }
}

static void test_too_many_meshes(void **state)
{
    struct sf_text text = {0};
    char name[32];

    (void)state;
    sf_text_append(&text, "{\"objects\":[");
    for (int i = 0; i <= SF_MESHES_MAX; i++) {
        static const char triangle[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

        snprintf(name, sizeof name, "m%d.obj", i);
        assert_int_equal(sf_file_write(name, triangle, sizeof triangle - 1, NULL), SF_OK);
        sf_text_printf(&text, "%s{\"type\":\"mesh\",\"file\":\"%s\"}", i ? "," : "", name);
    }
    sf_text_append(&text, "]}");
    refuse(text.data, "/objects/16/file: more than 16 different mesh files");
    sf_text_finish(&text);
}

/* ---- a long list with one bad row ---- */

static void test_bad_row_of_an_inline_list(void **state)
{
    enum { ROWS = 100000, BAD = 76543 };
    struct sf_text text = {0};

    (void)state;
    sf_text_append(&text, "{\"sim\":{\"capacity\":1000000},\"emitters\":[{\"type\":\"list\",\"particles\":[");
    for (int i = 0; i < ROWS; i++)
        sf_text_printf(&text, "%s{\"centre\":[0,1,2],\"radius\":%s}", i ? "," : "", i == BAD ? "-1" : "1");
    sf_text_append(&text, "]}]}");
    assert_false(text.failed);
    refuse(text.data, "/emitters/0/particles/76543/radius: -1 is out of range");
    sf_text_finish(&text);
}

/* ---- files ---- */

static void refuse_file(const char *path, enum sf_status expected, const char *part)
{
    struct caught caught = {"", 0};
    struct sf_log log = {caught_write, &caught, SF_LOG_ERROR};
    struct sf_scene *scene = NULL;

    assert_int_equal(sf_scene_load(path, NULL, 0, &log, &scene), expected);
    assert_null(scene);
    assert_caught(&caught, part);
}

static void test_scene_files(void **state)
{
    struct timespec before, after;
    FILE *file;

    (void)state;
    refuse_file("missing.json", SF_ERROR_IO, "missing.json");
    refuse_file(".", SF_ERROR_IO, ".");
    refuse_file("/dev/zero", SF_ERROR_IO, "/dev/zero");
    assert_int_equal(sf_file_write("empty.json", "", 0, NULL), SF_OK);
    refuse_file("empty.json", SF_ERROR_SCENE, "empty.json: the file is empty");
    assert_non_null(file = fopen("huge.json", "w"));
    assert_int_equal(ftruncate(fileno(file), 100 << 20), 0);
    fclose(file);
    clock_gettime(CLOCK_MONOTONIC, &before);
    refuse_file("huge.json", SF_ERROR_SCENE, "huge.json: 104857600 bytes; a scene holds at most 64 MiB");
    clock_gettime(CLOCK_MONOTONIC, &after);
    assert_true(after.tv_sec - before.tv_sec <= 1);
}

/* Files that are named by a scene are seen from its folder. */
static void test_names_are_seen_from_the_scene(void **state)
{
    static const char text[] = "{\"emitters\":[{\"type\":\"list\",\"file\":\"rows.csv\"}]}";
    static const char rows[] = "x,y,z,radius,extinction\n1,2,3,4,5\n";
    struct sf_scene *scene = NULL;

    (void)state;
    assert_int_equal(sf_folder_create("inner", NULL), SF_OK);
    assert_int_equal(sf_file_write("inner/scene.json", text, sizeof text - 1, NULL), SF_OK);
    assert_int_equal(sf_file_write("inner/rows.csv", rows, sizeof rows - 1, NULL), SF_OK);
    assert_int_equal(sf_scene_load("inner/scene.json", NULL, 0, NULL, &scene), SF_OK);
    assert_int_equal(scene->emitters[0].list_count, 1);
    sf_scene_destroy(&scene);
}

/* ---- noise ---- */

/* Anything may come of it but a crash, a leak or a silent failure. */
static void try_noise(const char *name, const char *text, size_t bytes)
{
    struct caught caught = {"", 0};
    struct sf_log log = {caught_write, &caught, SF_LOG_ERROR};
    struct sf_scene *scene = NULL;
    enum sf_status status = sf_scene_parse(name, text, bytes, NULL, 0, &log, &scene);

    if (status == SF_OK ? !scene : (status != SF_ERROR_SCENE || scene || caught.errors != 1))
        fail_msg("status %d with %u messages: %.*s", (int)status, caught.errors, (int)bytes, text);
    sf_scene_destroy(&scene);
}

static void test_noise(void **state)
{
    char *whole = NULL, *copy, *text;
    size_t size = 0;

    (void)state;
    assert_int_equal(sf_file_read(source_path("scenes/tiny/all.json"), 1 << 20, NULL, &whole, &size), SF_OK);
    assert_non_null(copy = malloc(size));
    for (size_t length = 0; length < size; length++) { /* exact allocations, so that a sanitizer sees a step too far */
        assert_non_null(text = malloc(length ? length : 1));
        memcpy(text, whole, length);
        try_noise("noise.json", text, length);
        free(text);
    }
    for (uint32_t round = 0; round < 4000; round++) {
        memcpy(copy, whole, size);
        for (uint32_t k = 0; k <= round % 3; k++) {
            uint32_t word = sf_random_u32(5, round, k);

            if (round % 2) /* bits, or characters that JSON likes */
                copy[word % size] ^= (char)(1 << (word >> 24) % 8);
            else
                copy[word % size] = "0123456789-.,:{}[]\"e"[(word >> 24) % 20];
        }
        /* Now and then where the files are that it names; they take long. */
        try_noise(round % 50 == 0 ? source_path("scenes/tiny/all.json") : "noise.json", copy, size);
    }
    free(copy);
    free(whole);
}

static void test_noise_in_sets(void **state)
{
    static const char *const wholes[] = {"thick.steps=24", "emitters.0.particles.0.centre=1,2,3",
                                         "camera.eye=0,1e0,-5.5", "method=none", "lights.0.shadows=false"};
    static const char scene_text[] =
        "{\"lights\":[{\"type\":\"point\",\"position\":[0,0,0]}],\"emitters\":[{\"type\":\"list\","
        "\"particles\":[{\"centre\":[0,0,0],\"radius\":1}]}]}";

    (void)state;
    for (uint32_t round = 0; round < 5000; round++) {
        struct caught caught = {"", 0};
        struct sf_log log = {caught_write, &caught, SF_LOG_ERROR};
        struct sf_scene *scene = NULL;
        uint32_t word = sf_random_u32(6, round, 0);
        char text[64];
        const char *set = text;
        enum sf_status status;
        size_t length;

        snprintf(text, sizeof text, "%s", wholes[round % SF_COUNT(wholes)]);
        length = strlen(text);
        if (round % 2)
            text[word % length] = "0123456789.=,-eE\377\001xyz"[(word >> 16) % 21];
        else
            text[word % (length + 1)] = '\0';
        status = sf_scene_parse("noise.json", scene_text, sizeof scene_text - 1, &set, 1, &log, &scene);
        if (status == SF_OK ? !scene : (status != SF_ERROR_USAGE || scene || caught.errors != 1))
            fail_msg("%s: status %d with %u messages: %s", text, (int)status, caught.errors, caught.text);
        sf_scene_destroy(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_not_json),
        cmocka_unit_test(test_deep_nesting),
        cmocka_unit_test(test_too_much_in_little),
        cmocka_unit_test(test_faults),
        cmocka_unit_test(test_lists_that_are_too_long),
        cmocka_unit_test(test_too_many_meshes),
        cmocka_unit_test(test_bad_row_of_an_inline_list),
        cmocka_unit_test(test_scene_files),
        cmocka_unit_test(test_names_are_seen_from_the_scene),
        cmocka_unit_test(test_noise),
        cmocka_unit_test(test_noise_in_sets),
    };
    return cmocka_run_group_tests(tests, scratch_enter, scratch_leave);
}
