/* Shaders that are edited while they run: what is compiled, what is said, and what the picture does. */
#include "../cpu/scratch.h"

#include <sys/wait.h>
#include <time.h>
#include "app/view/reload.h"

enum { SKIP = 77, SIZE = 48, TEXT_BYTES = 65536 };
static const uint64_t LOOK_NS = 250000000;

static struct sf_device *device;
static struct sf_scene *scene;
static struct sf_renderer *renderer;
static uint64_t clock_ns = 1000000000; /* the test's own: it says when files are looked at */

static struct {
    unsigned errors, taken;
    char names[4096]; /* of the shaders taken up, a blank behind each */
    char last[2048];
} heard;

static void hear(void *user, enum sf_log_level level, const char *message)
{
    const char *end = strstr(message, ": taken up");
    size_t used = strlen(heard.names);

    (void)user;
    heard.errors += level == SF_LOG_ERROR;
    if (level == SF_LOG_INFO && end) {
        heard.taken++;
        snprintf(heard.names + used, sizeof heard.names - used, "%.*s ", (int)(end - message), message);
    }
    snprintf(heard.last, sizeof heard.last, "%s", message);
}
static const struct sf_log test_log = {.write = hear, .level = SF_LOG_INFO};

static void forget(void)
{
    memset(&heard, 0, sizeof heard);
}

/* ---- files ---- */

static char *read_text(const char *path)
{
    static char texts[2][TEXT_BYTES];
    static unsigned turn;
    char *text = texts[turn++ % 2];
    FILE *file = fopen(path, "r");

    if (!file)
        fail_msg("%s: cannot be read", path);
    text[fread(text, 1, TEXT_BYTES - 1, file)] = '\0';
    fclose(file);
    return text;
}

static void write_text(const char *path, const char *text)
{
    FILE *file;

    /* A file's time is as fine as the kernel's tick. */
    nanosleep(&(struct timespec){.tv_nsec = 20000000}, NULL);
    assert_non_null(file = fopen(path, "w"));
    assert_int_equal(fwrite(text, 1, strlen(text), file), strlen(text));
    assert_int_equal(fclose(file), 0);
}

/* Replaces the first `from` of the file; returns the line that it stands in, counted from 1. */
static int edit(const char *path, const char *from, const char *to)
{
    static char buffer[TEXT_BYTES];
    const char *text = read_text(path), *at = strstr(text, from);
    int line = 1;

    if (!at)
        fail_msg("%s: holds no \"%s\"", path, from);
    for (const char *c = text; c < at; c++)
        line += *c == '\n';
    snprintf(buffer, sizeof buffer, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
    write_text(path, buffer);
    return line;
}

static void touch(const char *path)
{
    write_text(path, read_text(path));
}

/* ---- watching ---- */

static struct sf_reload *created(void)
{
    struct sf_reload *reload = NULL;

    assert_int_equal(sf_reload_create("glsl", device, &test_log, &reload), SF_OK);
    if (!reload)
        fail_msg("%s", heard.last);
    forget();
    return reload;
}

/* Three looks, each with all the compiling that comes of it. Returns whether a pipeline changed. */
static bool watched(struct sf_reload *reload)
{
    bool any = false, renewed;

    for (int i = 0; i < 3; i++) {
        clock_ns += LOOK_NS;
        do {
            sf_reload_poll(reload, clock_ns, &renewed);
            any |= renewed;
            nanosleep(&(struct timespec){.tv_nsec = 2000000}, NULL);
        } while (sf_reload_busy(reload));
    }
    return any;
}

static void assert_errors(const struct sf_reload *reload, const char *start)
{
    if (strncmp(sf_reload_errors(reload), start, strlen(start)) != 0)
        fail_msg("expected \"%s...\", got \"%s\"", start, sf_reload_errors(reload));
}

/* The picture as the renderer draws it now. */
static void draw(uint16_t pixels[SIZE * SIZE * 4])
{
    struct sf_frame frame;
    uint64_t ticket = 0;

    assert_int_equal(sf_renderer_render(renderer, 2, &ticket), SF_OK);
    assert_int_equal(sf_renderer_wait(renderer, ticket, &frame), SF_OK);
    memcpy(pixels, frame.color, SIZE * SIZE * 4 * sizeof *pixels);
}

static uint16_t first[SIZE * SIZE * 4], now[SIZE * SIZE * 4];

static bool is_as_first(void)
{
    draw(now);
    return memcmp(first, now, sizeof now) == 0;
}

/* ---- tests ---- */

static void test_absent(void **state)
{
    struct sf_reload *reload = NULL;
    char *path = strdup(getenv("PATH"));

    (void)state;
    assert_int_equal(sf_reload_create("nowhere", device, &test_log, &reload), SF_OK);
    assert_null(reload);
    assert_string_equal(heard.last, "shaders are not watched: there is no folder nowhere here");
    setenv("PATH", "/nonexistent:", 1);
    assert_int_equal(sf_reload_create("glsl", device, &test_log, &reload), SF_OK);
    setenv("PATH", path, 1);
    free(path);
    assert_null(reload);
    assert_string_equal(heard.last, "shaders are not watched: glslangValidator is not installed");
    assert_int_equal(heard.errors, 0);
    sf_reload_destroy(&reload);
}

static void test_nothing(void **state)
{
    struct sf_reload *reload = created();

    (void)state;
    assert_false(watched(reload));
    write_text("glsl/lib/unused.glsl", "not GLSL at all\n");
    assert_false(watched(reload));
    touch("glsl/lib/unused.glsl");
    assert_false(watched(reload));
    assert_int_equal(sf_reload_count(reload), 0);
    assert_string_equal(sf_reload_errors(reload), "");
    sf_reload_destroy(&reload);
    assert_null(reload);
}

static void test_change(void **state)
{
    static const char tail[] = "color = sky_color()", dark[] = "color = vec4(0.0)";
    struct sf_reload *reload = created();
    bool renewed = true;

    (void)state;
    assert_true(is_as_first());
    edit("glsl/scene/sky.frag", tail, dark);
    /* Files are looked at four times a second. */
    clock_ns += LOOK_NS;
    sf_reload_poll(reload, clock_ns, &renewed);
    assert_true(sf_reload_busy(reload));
    assert_true(watched(reload));
    assert_int_equal(sf_reload_count(reload), 1);
    assert_false(is_as_first());
    edit("glsl/scene/sky.frag", dark, tail);
    sf_reload_poll(reload, clock_ns + LOOK_NS / 2, &renewed);
    assert_false(sf_reload_busy(reload));
    assert_true(watched(reload));
    assert_int_equal(sf_reload_count(reload), 2);
    assert_string_equal(heard.names, "glsl/scene/sky.frag glsl/scene/sky.frag ");
    assert_true(is_as_first());
    sf_reload_destroy(&reload);
}

static void test_broken(void **state)
{
    static const char good[] = "result = full_smoke(", bad[] = "result = full_smkoe(";
    char expected[256];
    struct sf_reload *reload = created();
    int line;

    (void)state;
    line = edit("glsl/thick/over.frag", good, bad);
    assert_false(watched(reload));
    snprintf(expected, sizeof expected,
             "glsl/thick/over.frag:%d: 'full_smkoe': no matching overloaded function found\n", line);
    assert_errors(reload, expected);
    assert_true(is_as_first());
    edit("glsl/thick/over.frag", bad, good);
    assert_true(watched(reload));
    assert_string_equal(sf_reload_errors(reload), "");
    assert_true(is_as_first());
    /* A shader without a beginning has no line to name. */
    edit("glsl/thick/over.frag", "void main()", "void mian()");
    assert_false(watched(reload));
    assert_string_equal(sf_reload_errors(reload),
                        "glsl/thick/over.frag: Linking fragment stage: Missing entry point: Each stage requires one "
                        "entry point\n");
    edit("glsl/thick/over.frag", "void mian()", "void main()");
    assert_true(watched(reload));
    assert_string_equal(sf_reload_errors(reload), "");
    assert_int_equal(heard.errors, 0);
    sf_reload_destroy(&reload);
}

/* The device refuses what compiles: a binding that the pass does not have. */
static void test_refused(void **state)
{
    struct sf_reload *reload = created();

    (void)state;
    edit("glsl/thick/over.frag", "binding = 2", "binding = 9");
    assert_false(watched(reload));
    assert_errors(reload, "glsl/thick/over.frag: compiles, but the device does not take it: ");
    assert_int_equal(sf_reload_count(reload), 0);
    assert_int_equal(heard.errors, 1); /* the device's own words */
    assert_true(is_as_first());
    edit("glsl/thick/over.frag", "binding = 9", "binding = 2");
    assert_true(watched(reload));
    assert_string_equal(sf_reload_errors(reload), "");
    assert_true(is_as_first());
    sf_reload_destroy(&reload);
}

/* A header two steps away, found beside the file that includes it. */
static void test_headers(void **state)
{
    struct sf_reload *reload = created();

    (void)state;
    write_text("glsl/lib/inner.glsl", "float inner() { return 1.0; }\n");
    write_text("glsl/lib/outer.glsl", "  #  include \"inner.glsl\"\n");
    edit("glsl/thick/over.frag", "#include \"thick/up", "#include \"lib/outer.glsl\"\n#include \"thick/up");
    edit("glsl/scene/sky.frag", "#include \"scene/shade.glsl\"\n",
         "#include \"scene/shade.glsl\"\n#include \"lib/outer.glsl\"\n");
    assert_true(watched(reload));
    assert_int_equal(heard.taken, 2);
    forget();
    touch("glsl/lib/inner.glsl");
    assert_true(watched(reload));
    assert_int_equal(heard.taken, 2);
    assert_non_null(strstr(heard.names, "glsl/scene/sky.frag "));
    assert_non_null(strstr(heard.names, "glsl/thick/over.frag "));
    assert_int_equal(sf_reload_count(reload), 4);
    /* Its error is said once, in its own name. */
    write_text("glsl/lib/inner.glsl", "\nfloat inner() { return 1.0 }\n");
    assert_false(watched(reload));
    assert_errors(reload, "glsl/lib/inner.glsl:2: syntax error, ");
    assert_ptr_equal(strchr(sf_reload_errors(reload), '\n') + 1, strchr(sf_reload_errors(reload), '\0'));
    assert_true(is_as_first());
    /* Gone for good is an error too, at the place that wants it. */
    assert_int_equal(remove("glsl/lib/inner.glsl"), 0);
    assert_false(watched(reload));
    assert_errors(reload, "glsl/lib/outer.glsl:1: '#include': Could not process include directive");
    write_text("glsl/lib/inner.glsl", "float inner() { return 1.0; }\n");
    assert_true(watched(reload));
    assert_string_equal(sf_reload_errors(reload), "");
    /* One that turns up in the other place where the compiler looks. */
    forget();
    write_text("glsl/inner.glsl", "\n");
    assert_true(watched(reload));
    assert_int_equal(heard.taken, 2);
    sf_reload_destroy(&reload);
}

/* A header of the library's: all shaders that reach it, and no other. */
static void test_library_header(void **state)
{
    struct sf_reload *reload = created();

    (void)state;
    touch("glsl/lib/hash.glsl");
    assert_true(watched(reload));
    assert_int_equal(sf_reload_count(reload), heard.taken);
    assert_non_null(strstr(heard.names, "glsl/sim/emit.comp "));
    assert_non_null(strstr(heard.names, "glsl/sim/step.comp "));
    assert_null(strstr(heard.names, "glsl/thick/"));
    assert_null(strstr(heard.names, "glsl/scene/"));
    assert_true(is_as_first());
    sf_reload_destroy(&reload);
}

/* Editors truncate and then write, or move the old file away and then rename the new one. */
static void test_editors(void **state)
{
    const char *path = "glsl/thick/over.frag";
    struct sf_reload *reload = created();
    bool renewed;

    (void)state;
    char *text = strdup(read_text(path));
    for (int way = 0; way < 2; way++) {
        if (way == 0)
            write_text(path, "");
        else
            assert_int_equal(rename(path, "glsl/thick/over.frag~"), 0);
        clock_ns += LOOK_NS;
        sf_reload_poll(reload, clock_ns, &renewed);
        assert_false(sf_reload_busy(reload));
        assert_string_equal(sf_reload_errors(reload), "");
        if (way == 0) {
            write_text(path, text);
        } else {
            write_text("glsl/new.tmp", text);
            assert_int_equal(rename("glsl/new.tmp", path), 0);
        }
        assert_true(watched(reload));
        assert_string_equal(sf_reload_errors(reload), "");
        assert_int_equal(sf_reload_count(reload), way + 1);
    }
    /* Taken away for good: nothing to compile, and nothing wrong. */
    write_text(path, "broken\n");
    assert_false(watched(reload));
    assert_errors(reload, "glsl/thick/over.frag:1: ");
    assert_int_equal(remove(path), 0);
    assert_false(watched(reload));
    assert_string_equal(sf_reload_errors(reload), "");
    assert_true(is_as_first());
    /* Empty for good. */
    write_text(path, "");
    assert_false(watched(reload));
    assert_errors(reload, "glsl/thick/over.frag: ");
    write_text(path, text);
    assert_true(watched(reload));
    assert_string_equal(sf_reload_errors(reload), "");
    free(text);
    sf_reload_destroy(&reload);
}

/* Changes during a compilation, and an end in the middle of one. */
static void test_busy(void **state)
{
    struct sf_reload *reload = created();
    bool renewed;

    (void)state;
    edit("glsl/thick/over.frag", "void main()", "broken\nvoid main()");
    clock_ns += LOOK_NS;
    sf_reload_poll(reload, clock_ns, &renewed);
    assert_true(sf_reload_busy(reload));
    edit("glsl/thick/over.frag", "broken\n", "");
    clock_ns += LOOK_NS;
    sf_reload_poll(reload, clock_ns, &renewed);
    assert_true(watched(reload));
    assert_string_equal(sf_reload_errors(reload), "");
    assert_int_equal(sf_reload_count(reload), 1);
    touch("glsl/shared/frame.h"); /* many */
    clock_ns += LOOK_NS;
    sf_reload_poll(reload, clock_ns, &renewed);
    assert_true(sf_reload_busy(reload));
    assert_int_equal(scratch_count("tmp"), 1);
    sf_reload_destroy(&reload);
    assert_int_equal(scratch_count("tmp"), 0);
    assert_int_equal(waitpid(-1, NULL, WNOHANG), -1); /* no child is left */
}

/* ---- the group ---- */

static const char smoky[] =
    "{\"camera\":{\"eye\":[2,1.5,3],\"target\":[0,0.8,0]},"
    "\"lights\":[{\"type\":\"directional\",\"direction\":[-1,-1,0]}],"
    "\"objects\":[{\"type\":\"plane\"}],"
    "\"emitters\":[{\"type\":\"cone\",\"position\":[0,0.1,0],\"rate\":120,\"lifetime\":[0.6,1],\"speed\":[1,1.5],"
    "\"particle_radius\":[0.1,0.2]}],"
    "\"sim\":{\"capacity\":200,\"preroll\":0.5},\"shadow\":{\"map_size\":64},"
    "\"thick\":{\"steps\":4,\"light_size\":64,\"resolution\":\"full\"}}";

static int enter(void **state)
{
    const struct sf_renderer_options options = {.width = SIZE, .height = SIZE};
    const char *root = getenv("SF_SOURCE_ROOT");
    char command[1024];

    if (!root)
        fprintf(stderr, "SF_SOURCE_ROOT says where glsl/ is\n");
    if (!root || scratch_enter(state) != 0)
        return -1;
    snprintf(command, sizeof command, "cp -r '%s/glsl' . && mkdir tmp", root);
    if (system(command) != 0)
        return -1;
    setenv("TMPDIR", "tmp", 1);
    if (sf_scene_parse("test.json", smoky, strlen(smoky), NULL, 0, &test_log, &scene) != SF_OK ||
        sf_renderer_create(device, scene, &options, &test_log, &renderer) != SF_OK) {
        fprintf(stderr, "%s\n", heard.last);
        return -1;
    }
    draw(first);
    return 0;
}

static int leave(void **state)
{
    uint32_t messages;

    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
    messages = sf_device_validation_messages(device);
    sf_device_destroy(&device);
    if (*state)
        scratch_leave(state);
    if (messages)
        fprintf(stderr, "%u validation messages\n", messages);
    return messages ? -1 : 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_absent),         cmocka_unit_test(test_nothing), cmocka_unit_test(test_change),
        cmocka_unit_test(test_broken),         cmocka_unit_test(test_refused), cmocka_unit_test(test_headers),
        cmocka_unit_test(test_library_header), cmocka_unit_test(test_editors), cmocka_unit_test(test_busy),
    };
    const struct sf_device_options options = {.validate = true, .no_cache = true};
    enum sf_status status = sf_device_create(&options, &test_log, &device);

    if (status == SF_ERROR_DEVICE) {
        fprintf(stderr, "skipped: %s\n", heard.last);
        return SKIP;
    }
    if (status != SF_OK)
        return 1;
    return cmocka_run_group_tests(tests, enter, leave);
}
