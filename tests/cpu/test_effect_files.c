/* Effect files that are wrong, or damaged; and what is listed of those that are right. */
#include "scene_kit.h"

#include "base/file.h"
#include "base/hash.h"

static void write_text(const char *path, const char *text)
{
    assert_int_equal(sf_file_write(path, text, strlen(text), NULL), SF_OK);
}

#define POINT   "{\"type\":\"light\",\"light\":{\"type\":\"point\",\"position\":[1,0,0]}}"
#define EMITTER "{\"type\":\"emitter\",\"emitter\":{\"type\":\"cone\",\"position\":[0,1,2],\"direction\":[0,0,1]}}"
#define SCENE   "{\"effects\":[{\"file\":\"a.json\"}]}"

static void refuse_effect(const char *text, const char *part)
{
    write_text("a.json", text);
    refuse(SCENE, part);
}

static void wrong_files_say_what_and_where(void **state)
{
    static const struct {
        const char *text, *part;
    } cases[] = {
        {"", "a.json: the file is empty; an effect is a JSON object"},
        {"[]", "a.json: an effect is a JSON object"},
        {"{\"steps\":[}", "a.json:1:11: "},
        {"{\"steps\":[],\"steps\":[]}", "duplicate"},
        {"{}", "a.json: steps is missing"},
        {"{\"steps\":[]}", "a.json: /steps: holds 0 elements; 1 to 64 are allowed"},
        {"{\"stepps\":[]}", "a.json: /stepps: unknown key, did you mean steps?"},
        {"{\"loop\":true,\"steps\":[" POINT "]}", "a.json: /loop: needs a duration"},
        {"{\"loop\":true,\"duration\":0.01,\"steps\":[" POINT "]}", "a.json: /duration: 0.01 s is too short"},
        {"{\"steps\":[{\"type\":\"light\"}]}", "a.json: /steps/0: light is missing"},
        {"{\"steps\":[{\"typ\":\"light\"}]}",
         "a.json: /steps/0: type is missing (emitter, light, flash, shake, effect)"},
        {"{\"steps\":[{\"type\":\"flach\"}]}", "did you mean flash?"},
        {"{\"steps\":[{\"type\":\"flash\",\"easng\":\"in\"}]}",
         "a.json: /steps/0/easng: unknown key, did you mean easing?"},
        {"{\"steps\":[{\"type\":\"flash\",\"angle\":1}]}",
         "/steps/0/angle: type flash does not take this key, only shake"},
        {"{\"steps\":[{\"type\":\"flash\",\"duration\":-1}]}", "/steps/0/duration: -1 is out of range: 0 to 100000 s"},
        {"{\"steps\":[{\"type\":\"flash\",\"duration\":\"1\"}]}", "/steps/0/duration: must be a number, not a string"},
        {"{\"steps\":[{\"type\":\"flash\",\"duration\":NaN}]}", "a.json:1:"},
        {"{\"steps\":[{\"type\":\"flash\",\"start\":1e999}]}", "a.json:1:"},
        {"{\"steps\":[{\"type\":\"flash\",\"fade_out\":1}]}",
         "/steps/0/fade_out: the step goes on for ever; give it a duration"},
        {"{\"steps\":[{\"type\":\"flash\",\"duration\":1,\"fade_in\":0.6,\"fade_out\":0.5}]}",
         "are longer than the step, 1 s"},
        {"{\"steps\":[{\"type\":\"flash\",\"duration\":2,\"every\":1}]}",
         "/steps/0/duration: 2 s is longer than every (1 s)"},
        {"{\"steps\":[{\"type\":\"flash\",\"every\":0.001}]}", "/steps/0/every: 0.001 s is too short"},
        {"{\"steps\":[{\"type\":\"flash\",\"times\":3}]}", "/steps/0/times: 3 times needs every"},
        {"{\"steps\":[{\"type\":\"emitter\",\"emitter\":{\"type\":\"cone\",\"temprature\":3}}]}",
         "a.json: /steps/0/emitter/temprature: unknown key, did you mean temperature?"},
        {"{\"steps\":[{\"type\":\"emitter\",\"emitter\":{\"type\":\"cone\",\"direction\":[0,0,0]}}]}",
         "a.json: /steps/0/emitter/direction: 0,0,0 has no direction"},
        {"{\"steps\":[{\"type\":\"emitter\",\"emitter\":{\"type\":\"list\",\"particles\":[]}}]}",
         "a.json: /steps/0/emitter/type: list cannot be a step of an effect"},
        {"{\"steps\":[{\"type\":\"emitter\",\"emitter\":{\"type\":\"mesh\",\"file\":\"no.obj\"}}]}",
         "test.json: /effects/0 (a.json: /steps/0/emitter)/file: "},
        {"{\"steps\":[{\"type\":\"light\",\"light\":{\"type\":\"spot\",\"position\":[0,0,0],\"direction\":[0,1,0],"
         "\"inner\":40}}]}",
         "a.json: /steps/0/light: inner (40 deg) must be less than outer"},
        {"{\"steps\":[{\"type\":\"effect\",\"file\":\"none.json\"}]}",
         "a.json: /steps/0/file: cannot open 'none.json'"},
        {"{\"steps\":[{\"type\":\"effect\",\"file\":\"a.json\"}]}",
         "a.json: /steps/0/file: 'a.json' is the effect that it is part of"},
        {"{\"steps\":[{\"type\":\"effect\",\"file\":\"./a.json\"}]}",
         "/steps/0/file: './a.json' is the effect that it is part of"},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        refuse_effect(cases[i].text, cases[i].part);
    refuse("{\"effects\":[{\"file\":\"none.json\"}]}", "test.json: /effects/0/file: cannot open 'none.json'");
    refuse("{\"effects\":[{\"position\":[0,0,0]}]}", "test.json: /effects/0: file is missing");
    refuse("{\"effects\":[{\"file\":\"a.json\",\"times\":2}]}", "test.json: /effects/0/times: 2 times needs every");
}

static void rings_and_depths_are_refused(void **state)
{
    char text[256];

    (void)state;
    write_text("b.json", "{\"steps\":[{\"type\":\"effect\",\"file\":\"a.json\"}]}");
    refuse_effect("{\"steps\":[" POINT ",{\"type\":\"effect\",\"file\":\"b.json\"}]}",
                  "b.json: /steps/0/file: 'a.json' is the effect that it is part of");
    for (int i = 0; i < 5; i++) {
        char path[16];

        snprintf(path, sizeof path, "deep%d.json", i);
        snprintf(text, sizeof text, "{\"steps\":[{\"type\":\"effect\",\"file\":\"deep%d.json\"}]}", i + 1);
        write_text(path, text);
    }
    write_text("deep4.json", "{\"steps\":[" POINT "]}");
    refuse("{\"effects\":[{\"file\":\"deep0.json\"}]}",
           "deep3.json: /steps/0/file: 'deep4.json' is an effect within 4 others");
    sf_scene_destroy(&(struct sf_scene *){parse("{\"effects\":[{\"file\":\"deep1.json\"}]}")});
}

static void too_many_are_counted(void **state)
{
    char text[4096] = "{\"lights\":[{\"type\":\"point\",\"position\":[0,0,0]}],\"effects\":[";

    (void)state;
    write_text("a.json", "{\"steps\":[" POINT "," POINT "]}");
    for (int i = 0; i < 4; i++)
        strcat(text, i ? ",{\"file\":\"a.json\"}" : "{\"file\":\"a.json\"}");
    strcat(text, "]}");
    refuse(text, "test.json: /effects: 8 lights of effects, with the scene's own 1, are more than 8; take effects out");
    /* 64 to the fourth of them: not all are counted. */
    for (int level = 0; level < 4; level++) {
        static char many[8192];
        char path[16], step[64];

        snprintf(path, sizeof path, "many%d.json", level);
        snprintf(step, sizeof step,
                 level == 3 ? "{\"type\":\"flash\"}" : "{\"type\":\"effect\",\"file\":\"many%d.json\"}", level + 1);
        strcpy(many, "{\"steps\":[");
        for (int i = 0; i < 64; i++) {
            strcat(many, i ? "," : "");
            strcat(many, step);
        }
        strcat(many, "]}");
        write_text(path, many);
    }
    refuse("{\"effects\":[{\"file\":\"many0.json\"}]}", "at least 100000 flashes of effects");
}

static void listings_are_in_order(void **state)
{
    struct caught caught = {"", 0};
    struct sf_log log = {caught_write, &caught, SF_LOG_ERROR};
    const char *light, *flash;
    char *text = NULL;

    (void)state;
    write_text("a.json", "{\"steps\":[{\"type\":\"flash\",\"start\":1,\"duration\":0.5,\"every\":2,\"times\":3}," POINT
                         "," EMITTER "]}");
    assert_int_equal(sf_effect_print("a.json", &log, &text), SF_OK);
    assert_non_null(strstr(text, "a.json: ok: 1 emitter, 1 light, 1 flash, 0 shakes\n"));
    assert_non_null(light = strstr(text, "0.000 s  for ever       light: point, intensity 3\n"));
    assert_non_null(flash = strstr(text, "1.000 s  for 0.5 s      flash: strength 1; every 2 s, 3 times\n"));
    assert_true(light < flash);
    free(text);
    assert_int_equal(sf_effect_print("none.json", &log, &text), SF_ERROR_IO);
    assert_caught(&caught, "cannot open 'none.json'");
    write_text("a.json", "{\"steps\":[{\"type\":\"flash\",\"strngth\":1}]}");
    assert_int_equal(sf_effect_print("a.json", &log, &text), SF_ERROR_SCENE);
    assert_caught(&caught, "a.json: /steps/0/strngth: unknown key, did you mean strength?");
}

/* Whatever a byte of a file becomes, it is read or refused. */
static void damaged_files_do_no_harm(void **state)
{
    static const char signs[] = "{}[],:\"\\0123456789.-+eE tfn\xff\x00/";
    const char *root = getenv("SF_SOURCE_ROOT");
    char path[1024], *text = NULL, *listed = NULL;
    size_t bytes = 0;
    unsigned right = 0;

    (void)state;
    snprintf(path, sizeof path, "%s/scenes/effects/ship-explosion.json", root ? root : ".");
    assert_int_equal(sf_file_read(path, 1 << 20, NULL, &text, &bytes), SF_OK);
    write_text("debris.json", "{\"steps\":[" POINT "]}");
    for (uint32_t i = 0; i < bytes; i += 3) {
        char kept = text[i];

        text[i] = signs[sf_random_u32(1, i, 0) % (sizeof signs - 1)];
        assert_int_equal(sf_file_write("a.json", text, bytes, NULL), SF_OK);
        right += sf_effect_print("a.json", NULL, &listed) == SF_OK;
        free(listed);
        text[i] = kept;
    }
    assert_true(right > 10 && right < bytes / 6);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wrong_files_say_what_and_where), cmocka_unit_test(rings_and_depths_are_refused),
        cmocka_unit_test(too_many_are_counted),           cmocka_unit_test(listings_are_in_order),
        cmocka_unit_test(damaged_files_do_no_harm),
    };
    return cmocka_run_group_tests(tests, scratch_enter, scratch_leave);
}
