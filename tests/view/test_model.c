/* The viewer's model: a scene file, what is changed over it, and the file changing below. */
#include "../cpu/scratch.h"

#include <time.h>
#include "app/view/model.h"

static struct {
    unsigned errors, warnings;
    char error[2048], warning[2048];
} heard;

static void hear(void *user, enum sf_log_level level, const char *message)
{
    (void)user;
    if (level == SF_LOG_ERROR) {
        heard.errors++;
        snprintf(heard.error, sizeof heard.error, "%s", message);
    } else if (level == SF_LOG_WARNING) {
        heard.warnings++;
        snprintf(heard.warning, sizeof heard.warning, "%s", message);
    }
}
static const struct sf_log test_log = {.write = hear, .level = SF_LOG_WARNING};

/* Passes when exactly one error was logged since the last look, with this in it. */
static void assert_error(const char *part)
{
    if (heard.errors != 1 || !strstr(heard.error, part))
        fail_msg("expected one error with \"%s\", got %u: %s", part, heard.errors, heard.error);
    heard.errors = 0;
}

/* Passes when nothing was logged since the last look. */
static void assert_silence(void)
{
    if (heard.errors || heard.warnings)
        fail_msg("%u errors: %s; %u warnings: %s", heard.errors, heard.error, heard.warnings, heard.warning);
}

static const char plain[] = "{\n"
                            "  \"camera\": { \"eye\": [2, 1, 6], \"fov\": 38 },\n"
                            "  \"lights\": [\n"
                            "    { \"type\": \"spot\", \"position\": [0, 3, 0], \"direction\": [0, -1, 0.5] },\n"
                            "    { \"type\": \"directional\", \"direction\": [1, -1, 0], \"intensity\": 4.2 }\n"
                            "  ],\n"
                            "  \"emitters\": [{ \"type\": \"cone\", \"rate\": 80 }],\n"
                            "  \"thick\": { \"steps\": 12 }, \"larsson\": { \"blur\": 5 }\n"
                            "}\n";

/* Times of files are as fine as the kernel's tick, so that two writes within one may look like one. */
static void let_time_pass(void)
{
    nanosleep(&(struct timespec){.tv_nsec = 20000000}, NULL);
}

static void write_text(const char *path, const char *text)
{
    FILE *file;

    let_time_pass();
    assert_non_null(file = fopen(path, "w"));
    assert_int_equal(fwrite(text, 1, strlen(text), file), strlen(text));
    assert_int_equal(fclose(file), 0);
}

/* As editors do that write beside the file and rename. */
static void rename_text(const char *path, const char *text)
{
    write_text("beside.tmp", text);
    assert_int_equal(rename("beside.tmp", path), 0);
}

/* `text` with its first `from` replaced. */
static const char *edited(const char *text, const char *from, const char *to)
{
    static char buffer[4096];
    const char *at = strstr(text, from);

    assert_non_null(at);
    snprintf(buffer, sizeof buffer, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
    return buffer;
}

static struct sf_model opened(const char *const *sets, uint32_t count)
{
    struct sf_model model = {.log = &test_log};

    memset(&heard, 0, sizeof heard);
    write_text("plain.json", plain);
    if (sf_model_open(&model, "plain.json", sets, count) != SF_OK)
        fail_msg("%s", heard.error);
    return model;
}

static double value_of(const struct sf_model *model, const char *path)
{
    const struct sf_control *control = sf_model_control(model, path);

    if (!control)
        fail_msg("no control %s", path);
    return control->value[0];
}

/* The sets, each followed by a blank. */
static void assert_sets(const struct sf_model *model, const char *expected)
{
    char text[1024] = "";
    size_t used = 0;

    for (uint32_t i = 0; i < model->set_count; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, "%s ", model->sets[i]);
    assert_string_equal(text, expected);
}

static void test_open(void **state)
{
    const char *const sets[] = {"thick.steps=24", "lights.1.intensity=4.20", "thick.steps=30", "thick.detail=0.5"};
    struct sf_model model = opened(sets, 4);

    (void)state;
    /* The intensity is the file's, the detail the table's default: neither is a change. */
    assert_sets(&model, "thick.steps=30 ");
    assert_true(value_of(&model, "thick.steps") == 30);
    assert_true(value_of(&model, "larsson.blur") == 5);
    assert_string_equal(model.path, "plain.json");
    assert_string_equal(model.info.path, "plain.json");
    assert_int_equal(model.info.lights, 2);
    assert_int_equal(model.bytes, strlen(plain));
    assert_string_equal(model.text, plain);
    assert_string_equal(model.error, "");
    assert_null(sf_model_control(&model, "thick.step"));
    assert_true(sf_model_changed(&model, "thick.steps"));
    assert_false(sf_model_changed(&model, "thick.step"));
    assert_false(sf_model_changed(&model, "lights.1.intensity"));
    assert_silence();
    sf_model_finish(&model);
    sf_model_finish(&model);
}

static void test_open_fails(void **state)
{
    const char *const sets[] = {"thick.stepz=3"};
    struct sf_model model = {.log = &test_log};

    (void)state;
    memset(&heard, 0, sizeof heard);
    assert_int_equal(sf_model_open(&model, "nothing.json", NULL, 0), SF_ERROR_IO);
    assert_error("nothing.json: cannot be read: No such file");
    sf_model_finish(&model);
    write_text("bad.json", "{\n  \"thick\": { \"steps\": 12, }\n}\n");
    assert_int_equal(sf_model_open(&model, "bad.json", NULL, 0), SF_ERROR_SCENE);
    assert_error("bad.json:2:");
    sf_model_finish(&model);
    assert_int_equal(sf_model_open(&model, ".", NULL, 0), SF_ERROR_IO);
    assert_error("is not a file");
    sf_model_finish(&model);
    write_text("plain.json", plain);
    assert_int_equal(sf_model_open(&model, "plain.json", sets, 1), SF_ERROR_USAGE);
    assert_error("did you mean steps");
    sf_model_finish(&model);
}

static void test_set(void **state)
{
    struct sf_model model = opened(NULL, 0);
    const struct sf_scene *before;

    (void)state;
    assert_int_equal(sf_model_set(&model, "thick.steps=24"), SF_OK);
    assert_int_equal(sf_model_set(&model, "lights.1.color=1,0.5,0.25"), SF_OK);
    assert_int_equal(sf_model_set(&model, "thick.steps=25"), SF_OK);
    assert_sets(&model, "thick.steps=25 lights.1.color=1,0.5,0.25 ");
    assert_true(value_of(&model, "thick.steps") == 25);
    before = model.scene;
    assert_int_equal(sf_model_set(&model, "thick.steps=25"), SF_OK);
    assert_ptr_equal(model.scene, before);
    /* What the file says, in another spelling; and a default that the file does not name. */
    assert_int_equal(sf_model_set(&model, "thick.steps=012"), SF_OK);
    assert_int_equal(sf_model_set(&model, "lights.1.color=1,1.0,1"), SF_OK);
    assert_sets(&model, "");
    assert_true(value_of(&model, "thick.steps") == 12);
    assert_silence();

    assert_int_equal(sf_model_set(&model, "larsson.blur=6"), SF_OK);
    before = model.scene;
    assert_int_equal(sf_model_set(&model, "thick.steps=1000"), SF_ERROR_USAGE);
    assert_error("thick.steps=1000");
    assert_int_equal(sf_model_set(&model, "thick.steps"), SF_ERROR_USAGE);
    assert_error("KEY=VALUE");
    assert_sets(&model, "larsson.blur=6 ");
    assert_ptr_equal(model.scene, before);
    sf_model_finish(&model);
}

static void test_hash(void **state)
{
    struct sf_model model = opened(NULL, 0);
    uint64_t hash = model.info.hash;

    (void)state;
    assert_int_equal(sf_model_set(&model, "thick.detail=0.75"), SF_OK);
    assert_true(model.info.hash != hash);
    assert_int_equal(sf_model_set(&model, "thick.detail=0.5"), SF_OK);
    assert_true(model.info.hash == hash);
    sf_model_finish(&model);
}

static void test_reset(void **state)
{
    struct sf_model model = opened((const char *const[]){"thick.steps=24"}, 1);

    (void)state;
    assert_int_equal(sf_model_set(&model, "larsson.blur=6"), SF_OK);
    assert_int_equal(sf_model_set(&model, "camera.fov=50"), SF_OK);
    assert_int_equal(sf_model_reset(&model, "larsson.soft"), SF_OK);
    assert_int_equal(sf_model_reset(&model, "thick.steps"), SF_OK);
    assert_sets(&model, "larsson.blur=6 camera.fov=50 ");
    assert_true(value_of(&model, "thick.steps") == 12);
    assert_int_equal(sf_model_reset(&model, NULL), SF_OK);
    assert_sets(&model, "");
    assert_true(value_of(&model, "larsson.blur") == 5);
    assert_int_equal(sf_model_reset(&model, NULL), SF_OK);
    assert_silence();
    sf_model_finish(&model);
}

static void test_many(void **state)
{
    struct sf_model model = opened(NULL, 0);
    const char *const good[] = {"thick.steps=3", "camera.fov=60", "thick.steps=4"};
    const char *const bad[] = {"larsson.blur=7", "camera.fov=600"};

    (void)state;
    assert_int_equal(sf_model_set_many(&model, good, 3), SF_OK);
    assert_sets(&model, "thick.steps=4 camera.fov=60 ");
    assert_int_equal(sf_model_set_many(&model, bad, 2), SF_ERROR_USAGE);
    assert_error("camera.fov=600");
    assert_sets(&model, "thick.steps=4 camera.fov=60 ");
    assert_true(value_of(&model, "larsson.blur") == 5);
    sf_model_finish(&model);
}

/* Sets of keys that another type does not take go with the type. */
static void test_type(void **state)
{
    struct sf_model model = opened(NULL, 0);

    (void)state;
    assert_int_equal(sf_model_set(&model, "lights.0.inner=10"), SF_OK);
    assert_int_equal(sf_model_set(&model, "lights.0.intensity=9"), SF_OK);
    assert_int_equal(sf_model_set(&model, "thick.steps=5"), SF_OK);
    assert_int_equal(sf_model_set(&model, "lights.0.type=directional"), SF_OK);
    assert_sets(&model, "lights.0.intensity=9 thick.steps=5 lights.0.type=directional ");
    assert_int_equal(heard.warnings, 1);
    assert_non_null(strstr(heard.warning, "lights.0.inner=10 does not fit any more"));
    heard.warnings = 0;
    assert_int_equal(sf_model_set(&model, "lights.0.type=spot"), SF_OK);
    assert_sets(&model, "lights.0.intensity=9 thick.steps=5 ");
    /* The same when a type is reset. */
    assert_int_equal(sf_model_set(&model, "lights.1.type=point"), SF_ERROR_USAGE);
    assert_error("position");
    assert_int_equal(
        sf_model_set_many(&model, (const char *const[]){"lights.1.position=1,2,3", "lights.1.type=point"}, 2), SF_OK);
    assert_silence();
    assert_int_equal(sf_model_reset(&model, "lights.1.type"), SF_OK);
    assert_sets(&model, "lights.0.intensity=9 thick.steps=5 ");
    assert_int_equal(heard.warnings, 1);
    /* What does not fit by itself is refused all the same. */
    assert_int_equal(sf_model_set(&model, "lights.1.inner=10"), SF_ERROR_USAGE);
    assert_int_equal(sf_model_set(&model, "lights.1.type=bulb"), SF_ERROR_USAGE);
    assert_sets(&model, "lights.0.intensity=9 thick.steps=5 ");
    sf_model_finish(&model);
}

struct renderer {
    unsigned offers;
    bool refuses;
    const struct sf_scene *last;
};

static enum sf_status consider(void *user, const struct sf_scene *scene)
{
    struct renderer *renderer = user;

    renderer->offers++;
    if (renderer->refuses)
        return SF_ERROR_MEMORY;
    renderer->last = scene;
    return SF_OK;
}

static void test_accept(void **state)
{
    struct sf_model model = opened(NULL, 0);
    struct renderer renderer = {0};
    const struct sf_scene *before = model.scene;
    bool renewed = true;

    (void)state;
    model.accept = consider;
    model.user = &renderer;
    assert_int_equal(sf_model_set(&model, "thick.steps=3"), SF_OK);
    assert_int_equal(renderer.offers, 1);
    assert_ptr_equal(renderer.last, model.scene);
    assert_ptr_not_equal(renderer.last, before);
    renderer.refuses = true;
    before = model.scene;
    assert_int_equal(sf_model_set(&model, "thick.steps=4"), SF_ERROR_MEMORY);
    assert_int_equal(sf_model_reset(&model, NULL), SF_ERROR_MEMORY);
    assert_int_equal(sf_model_replace(&model, "plain.json"), SF_ERROR_MEMORY);
    assert_int_equal(renderer.offers, 4);
    assert_ptr_equal(model.scene, before);
    assert_sets(&model, "thick.steps=3 ");
    assert_true(value_of(&model, "thick.steps") == 3);
    write_text("plain.json", edited(plain, "38", "39"));
    sf_model_watch(&model, &renewed);
    assert_false(renewed);
    assert_string_equal(model.text, plain);
    assert_non_null(strstr(model.error, "plain.json: the scene cannot be drawn"));
    assert_ptr_equal(model.scene, before);
    sf_model_finish(&model);
}

static void test_replace(void **state)
{
    struct sf_model model = opened((const char *const[]){"thick.steps=24"}, 1);

    (void)state;
    write_text("broken.json", "{ \"thick\": 3 }");
    assert_int_equal(sf_model_replace(&model, "broken.json"), SF_ERROR_SCENE);
    assert_error("broken.json: /thick");
    assert_int_equal(sf_model_replace(&model, "missing.json"), SF_ERROR_IO);
    assert_error("missing.json");
    assert_string_equal(model.path, "plain.json");
    assert_sets(&model, "thick.steps=24 ");
    write_text("other.json", "{ \"thick\": { \"steps\": 24 } }");
    assert_int_equal(sf_model_replace(&model, "other.json"), SF_OK);
    assert_string_equal(model.path, "other.json");
    assert_sets(&model, "");
    assert_int_equal(model.info.lights, 0);
    /* Compared with the new file from now on. */
    assert_int_equal(sf_model_set(&model, "thick.steps=12"), SF_OK);
    assert_int_equal(sf_model_set(&model, "larsson.blur=5"), SF_OK);
    assert_int_equal(sf_model_set(&model, "thick.steps=24"), SF_OK);
    assert_sets(&model, "larsson.blur=5 ");
    assert_silence();
    sf_model_finish(&model);
}

static bool watched(struct sf_model *model)
{
    bool renewed = true;

    sf_model_watch(model, &renewed);
    return renewed;
}

static void test_watch(void **state)
{
    struct sf_model model = opened((const char *const[]){"thick.steps=24"}, 1);

    (void)state;
    assert_false(watched(&model));
    write_text("plain.json", edited(plain, "\"fov\": 38", "\"fov\": 45"));
    assert_true(watched(&model));
    assert_false(watched(&model));
    assert_true(value_of(&model, "camera.fov") == 45);
    assert_true(value_of(&model, "thick.steps") == 24);
    rename_text("plain.json", edited(plain, "\"fov\": 38", "\"fov\": 46"));
    assert_true(watched(&model));
    assert_true(value_of(&model, "camera.fov") == 46);
    assert_sets(&model, "thick.steps=24 ");
    /* The file has come to say what the set says. */
    rename_text("plain.json", edited(plain, "12", "24"));
    assert_true(watched(&model));
    assert_sets(&model, "");
    assert_true(value_of(&model, "thick.steps") == 24);
    assert_silence();
    sf_model_finish(&model);
}

static void test_watch_broken(void **state)
{
    struct sf_model model = opened(NULL, 0);
    const struct sf_scene *before = model.scene;

    (void)state;
    write_text("plain.json", edited(plain, "\"fov\": 38 },", "\"fov\": 38 "));
    assert_false(watched(&model));
    assert_non_null(strstr(model.error, "plain.json:3:"));
    assert_error("plain.json:3:");
    assert_ptr_equal(model.scene, before);
    assert_string_equal(model.text, plain);
    /* Changes go on over the text that was good. */
    assert_int_equal(sf_model_set(&model, "thick.steps=3"), SF_OK);
    assert_false(watched(&model));
    assert_non_null(strstr(model.error, "plain.json:3:"));
    write_text("plain.json", edited(plain, "\"fov\": 38", "\"fov\": 380"));
    assert_false(watched(&model));
    assert_error("plain.json: /camera/fov");
    assert_non_null(strstr(model.error, "/camera/fov"));
    /* Undone: the same text as before. */
    write_text("plain.json", plain);
    assert_true(watched(&model));
    assert_string_equal(model.error, "");
    assert_true(value_of(&model, "thick.steps") == 3);
    assert_silence();
    sf_model_finish(&model);
}

static void test_watch_missing(void **state)
{
    struct sf_model model = opened(NULL, 0);

    (void)state;
    assert_int_equal(remove("plain.json"), 0);
    assert_false(watched(&model));
    assert_string_equal(model.error, "");
    write_text("plain.json", "");
    assert_false(watched(&model));
    assert_string_equal(model.error, "");
    write_text("plain.json", edited(plain, "38", "39"));
    assert_true(watched(&model));
    assert_silence();
    /* For good; and it comes back as it was, with its folder. */
    assert_int_equal(mkdir("folder", 0777), 0);
    write_text("folder/plain.json", plain);
    assert_int_equal(sf_model_replace(&model, "folder/plain.json"), SF_OK);
    assert_int_equal(rename("folder", "away"), 0);
    assert_false(watched(&model));
    nanosleep(&(struct timespec){.tv_nsec = 600000000}, NULL);
    assert_false(watched(&model));
    assert_false(watched(&model));
    assert_error("folder/plain.json: No such file");
    assert_non_null(strstr(model.error, "No such file"));
    assert_int_equal(rename("away", "folder"), 0);
    assert_true(watched(&model));
    assert_string_equal(model.error, "");
    assert_silence();
    sf_model_finish(&model);
}

/* Sets that the new file has no place for go, all others stay, those that need each other too. */
static void test_watch_drops(void **state)
{
    const char *const sets[] = {"lights.1.intensity=9", "camera.fov=60", "lights.0.inner=10", "thick.steps=24",
                                "lights.1.color=1,0,0"};
    const char *const kind[] = {"lights.0.type=point"};
    struct sf_model model = opened(sets, 5);

    (void)state;
    write_text("plain.json",
               "{ \"lights\": [{ \"type\": \"spot\", \"position\": [0, 3, 0], \"direction\": [0, -1, 0] }] }");
    assert_true(watched(&model));
    assert_sets(&model, "camera.fov=60 lights.0.inner=10 thick.steps=24 ");
    assert_int_equal(heard.warnings, 2);
    assert_non_null(strstr(heard.warning, "lights.1.color=1,0,0 does not fit any more"));
    assert_non_null(strstr(heard.warning, "lights has 1 element"));
    assert_int_equal(heard.errors, 0);
    assert_int_equal(model.info.lights, 1);

    heard.warnings = 0;
    write_text("plain.json", "{ \"lights\": [{ \"type\": \"directional\", \"direction\": [0, -1, 0] }] }");
    assert_true(watched(&model));
    assert_sets(&model, "camera.fov=60 thick.steps=24 ");
    assert_int_equal(heard.warnings, 1);
    heard.warnings = 0;
    assert_int_equal(sf_model_set_many(&model, kind, 1), SF_ERROR_USAGE);
    assert_error("position");
    assert_int_equal(
        sf_model_set_many(&model, (const char *const[]){"lights.0.type=point", "lights.0.position=1,2,3"}, 2), SF_OK);
    /* The emitter goes; the two sets of the light need each other, whichever comes first. */
    write_text("plain.json", "{ \"lights\": [{ \"type\": \"directional\", \"direction\": [0, -1, 0] }],\n"
                             "\"emitters\": [{ \"type\": \"cone\" }] }");
    assert_int_equal(sf_model_set(&model, "camera.fov=61"), SF_OK);
    assert_true(watched(&model));
    assert_int_equal(sf_model_set(&model, "emitters.0.rate=10"), SF_OK);
    write_text("plain.json", "{ \"lights\": [{ \"type\": \"directional\", \"direction\": [0, -1, 0] }] }");
    assert_true(watched(&model));
    assert_sets(&model, "camera.fov=61 thick.steps=24 lights.0.type=point lights.0.position=1,2,3 ");
    assert_int_equal(heard.warnings, 1);
    assert_non_null(strstr(heard.warning, "emitters.0.rate=10 does not fit any more"));
    sf_model_finish(&model);
}

static void test_save(void **state)
{
    const char *const extra[] = {"camera.type=fixed", "camera.eye=1,2,3",  "camera.target=0,1,0",
                                 "camera.up=0,1,0",   "camera.fov=33.125", "camera.near=0.25"};
    struct sf_model model = opened(NULL, 0), again = {.log = &test_log};

    (void)state;
    assert_int_equal(sf_model_replace(&model, "plain.json"), SF_OK);
    write_text("plain.json", edited(plain, "\"eye\": [2, 1, 6]", "\"type\": \"orbit\", \"period\": 7"));
    assert_true(watched(&model));
    assert_int_equal(sf_model_set(&model, "camera.period=9"), SF_OK);
    assert_int_equal(sf_model_set(&model, "thick.steps=30"), SF_OK);
    assert_int_equal(sf_model_save(&model, "as-it-is.json", NULL, 0), SF_OK);
    assert_int_equal(sf_model_save(&model, "fixed.json", extra, 6), SF_OK);
    assert_sets(&model, "camera.period=9 thick.steps=30 ");

    assert_int_equal(sf_model_open(&again, "as-it-is.json", NULL, 0), SF_OK);
    assert_int_equal(again.control_count, model.control_count);
    for (uint32_t i = 0; i < again.control_count; i++)
        for (uint32_t n = 0; n < again.controls[i].numbers; n++)
            assert_true(again.controls[i].value[n] == model.controls[i].value[n]);
    sf_model_finish(&again);
    assert_int_equal(sf_model_open(&again, "fixed.json", NULL, 0), SF_OK);
    assert_null(sf_model_control(&again, "camera.period"));
    assert_true(value_of(&again, "camera.fov") == 33.125);
    assert_true(value_of(&again, "thick.steps") == 30);
    assert_true(value_of(&again, "camera.near") == 0.25);
    assert_silence();
    assert_int_equal(sf_model_save(&model, "no/such/folder.json", NULL, 0), SF_ERROR_IO);
    sf_model_finish(&again);
    sf_model_finish(&model);
}

/* The words that a shell makes of the command, in a file of a line each. */
static void assert_words(const char *command, const char *const *words, size_t count)
{
    char line[2048];
    FILE *file;

    assert_non_null(file = fopen("words.sh", "w"));
    fprintf(file, "printf '%%s\\n' %s >words.txt\n", command);
    assert_int_equal(fclose(file), 0);
    assert_int_equal(system("sh words.sh"), 0);
    assert_non_null(file = fopen("words.txt", "r"));
    for (size_t i = 0; i < count; i++) {
        if (!fgets(line, sizeof line, file))
            fail_msg("%s: no word %zu", command, i);
        line[strcspn(line, "\n")] = '\0';
        assert_string_equal(line, words[i]);
    }
    assert_null(fgets(line, sizeof line, file));
    fclose(file);
}

static void test_command(void **state)
{
    struct sf_model model = opened(NULL, 0);
    const char *const extra[] = {"camera.type=fixed", "camera.eye=1,2,3"};
    const char *const words[] = {"sfumato",
                                 "capture",
                                 "plain.json",
                                 "--frames",
                                 "48",
                                 "-s",
                                 "640x360",
                                 "--set",
                                 "thick.steps=30",
                                 "--set",
                                 "camera.type=fixed",
                                 "--set",
                                 "camera.eye=1,2,3",
                                 "-o",
                                 "plain.####.png"};
    char *text;

    (void)state;
    assert_int_equal(sf_model_set(&model, "camera.fov=60"), SF_OK);
    assert_int_equal(sf_model_set(&model, "thick.steps=30"), SF_OK);
    text = sf_model_command(&model, 48, 640, 360, extra, 2);
    assert_string_equal(text, "sfumato capture plain.json --frames 48 -s 640x360 --set thick.steps=30"
                              " --set camera.type=fixed --set camera.eye=1,2,3 -o plain.####.png");
    assert_words(text, words, sizeof words / sizeof *words);
    free(text);
    sf_model_finish(&model);
}

static void test_command_quotes(void **state)
{
    static const char name[] = "-it's $HOME `id` \"#1\" 100%; *.a.json";
    const char *const words[] = {"sfumato",
                                 "capture",
                                 "./-it's $HOME `id` \"#1\" 100%; *.a.json",
                                 "--frames",
                                 "0",
                                 "-s",
                                 "1x1",
                                 "--set",
                                 "emitters.0.file=a 'b'\\\"!\".csv",
                                 "-o",
                                 "./-it's $HOME `id` \"_1\" 100_; *.a.####.png"};
    struct sf_model model = {.log = &test_log};
    const char *const extra[] = {"emitters.0.file=a 'b'\\\"!\".csv"};
    char *text, *path = NULL;

    (void)state;
    write_text(name, plain);
    assert_int_equal(sf_model_open(&model, name, NULL, 0), SF_OK);
    text = sf_model_command(&model, 0, 1, 1, extra, 1);
    assert_non_null(text);
    assert_words(text, words, sizeof words / sizeof *words);
    assert_int_equal(sf_sequence_name(words[10], 7, true, &test_log, &path), SF_OK);
    assert_string_equal(path, "./-it's $HOME `id` \"_1\" 100_; *.a.0007.png");
    free(path);
    free(text);
    sf_model_finish(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_open),         cmocka_unit_test(test_open_fails),
        cmocka_unit_test(test_set),          cmocka_unit_test(test_hash),
        cmocka_unit_test(test_reset),        cmocka_unit_test(test_many),
        cmocka_unit_test(test_type),         cmocka_unit_test(test_accept),
        cmocka_unit_test(test_replace),      cmocka_unit_test(test_watch),
        cmocka_unit_test(test_watch_broken), cmocka_unit_test(test_watch_missing),
        cmocka_unit_test(test_watch_drops),  cmocka_unit_test(test_save),
        cmocka_unit_test(test_command),      cmocka_unit_test(test_command_quotes),
    };
    return cmocka_run_group_tests(tests, scratch_enter, scratch_leave);
}
