/* What the viewer remembers, and what becomes of a file that cannot be read. */
#include "../cpu/scratch.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include "app/console.h"
#include "app/view/settings.h"

static char home[4096];      /* of these tests */
static char file[4096 + 64]; /* where the settings are */

/* ---- the console's words, caught ---- */

static int real_stderr = -1;

static void words_begin(void)
{
    int fd = open("words", O_RDWR | O_CREAT | O_TRUNC, 0600);

    assert_true(fd >= 0);
    fflush(stderr);
    real_stderr = dup(STDERR_FILENO);
    dup2(fd, STDERR_FILENO);
    close(fd);
}

/* Ends catching. Passes when there were so many warnings, nothing else, and `part` is in them (NULL: whatever). */
static void assert_words(unsigned warnings, const char *part)
{
    static char words[64 * 1024];
    unsigned found = 0, lines = 0;
    ssize_t got;
    int fd;

    fflush(stderr);
    dup2(real_stderr, STDERR_FILENO);
    close(real_stderr);
    fd = open("words", O_RDONLY);
    got = read(fd, words, sizeof words - 1);
    close(fd);
    words[got > 0 ? got : 0] = '\0';
    for (const char *at = words; (at = strchr(at, '\n')); at++)
        lines++;
    for (const char *at = words; (at = strstr(at, "sfumato: warning: ")); at++)
        found++;
    if (found != warnings || lines != warnings || (part && !strstr(words, part)))
        fail_msg("expected %u warnings with \"%s\", got: %s", warnings, part ? part : "", words);
}

/* ---- files ---- */

static void write_file(const char *text, size_t bytes)
{
    int fd = open(file, O_WRONLY | O_CREAT | O_TRUNC, 0600);

    assert_true(fd >= 0);
    assert_int_equal(write(fd, text, bytes), (ssize_t)bytes);
    close(fd);
}

static void assert_defaults(const struct sf_settings *settings)
{
    static const bool none[SF_RIG_PRESETS];

    assert_int_equal(settings->width, 1280);
    assert_int_equal(settings->height, 800);
    assert_false(settings->fullscreen);
    assert_true(settings->panel);
    assert_true(settings->panel_width == 360);
    assert_string_equal(settings->present_mode, "fifo");
    assert_true(settings->adapt);
    assert_true(settings->goal_ms == 50);
    for (int i = 0; i < SF_RECENT_MAX; i++)
        assert_null(settings->recent[i]);
    assert_memory_equal(settings->preset_set, none, sizeof none);
}

/* Loads `text` as the file, expecting so many warnings. */
static struct sf_settings load_text(const char *text, unsigned warnings, const char *part)
{
    struct sf_settings settings;

    write_file(text, strlen(text));
    words_begin();
    sf_settings_load(&settings);
    assert_words(warnings, part);
    return settings;
}

static int set_up(void **state)
{
    (void)state;
    scratch_empty(home);
    snprintf(file, sizeof file, "%s/sfumato/view.json", home);
    if (setenv("XDG_CONFIG_HOME", home, 1) || setenv("HOME", "/nonexistent", 1))
        return -1;
    snprintf(file, sizeof file, "%s/sfumato", home);
    if (mkdir(file, 0700) != 0)
        return -1;
    snprintf(file, sizeof file, "%s/sfumato/view.json", home);
    return 0;
}

static int enter(void **state)
{
    sf_console_start(SF_LOG_WARNING);
    return scratch_enter(state) == 0 && getcwd(home, sizeof home) ? 0 : -1;
}

/* ---- to and fro ---- */

static struct sf_settings unusual(void)
{
    struct sf_settings settings;

    sf_settings_default(&settings);
    settings.width = 1921;
    settings.height = 77;
    settings.fullscreen = true;
    settings.panel = false;
    settings.panel_width = 412.34567f;
    snprintf(settings.present_mode, sizeof settings.present_mode, "fifo_relaxed");
    settings.adapt = false;
    settings.goal_ms = 16.6666f;
    sf_settings_recent(&settings, "/tmp/b \"quoted\" \xc3\xa9.json");
    sf_settings_recent(&settings, "/tmp/a.json");
    settings.presets[0] = (struct sf_camera_view){{0.1f, -2e-7f, 3}, {1e5f, 0, 0}, {0.6f, 0.8f, 0}, 170, 1e-4f};
    settings.presets[8] = (struct sf_camera_view){{1, 2, 3}, {4, 5, 6}, {0, 1, 0}, 1, 1e3f};
    settings.preset_set[0] = settings.preset_set[8] = true;
    return settings;
}

static void test_round_trip(void **state)
{
    struct sf_settings settings = unusual(), read;
    struct stat about;

    (void)state;
    words_begin();
    sf_settings_save(&settings);
    sf_settings_load(&read);
    assert_words(0, NULL);
    assert_int_equal(scratch_count("sfumato"), 1); /* no temporary */
    for (int i = 0; i < SF_RECENT_MAX; i++) {
        if (settings.recent[i])
            assert_string_equal(read.recent[i], settings.recent[i]);
        else
            assert_null(read.recent[i]);
    }
    assert_string_equal(read.recent[0], "/tmp/a.json");
    assert_int_equal(read.width, 1921);
    assert_int_equal(read.height, 77);
    assert_true(read.fullscreen && !read.panel && !read.adapt);
    assert_true(read.panel_width == settings.panel_width && read.goal_ms == settings.goal_ms);
    assert_string_equal(read.present_mode, "fifo_relaxed");
    assert_memory_equal(read.preset_set, settings.preset_set, sizeof read.preset_set);
    assert_memory_equal(&read.presets[0], &settings.presets[0], sizeof read.presets[0]);
    assert_memory_equal(&read.presets[8], &settings.presets[8], sizeof read.presets[8]);
    sf_settings_finish(&settings);
    sf_settings_finish(&read);
    sf_settings_finish(&read); /* twice does no harm */
    assert_int_equal(stat(file, &about), 0);
}

/* What nobody would read again is not written. */
static void test_extreme_values(void **state)
{
    struct sf_settings settings, read;

    (void)state;
    sf_settings_default(&settings);
    settings.width = 3;
    settings.height = 4000000000u;
    settings.panel_width = -1;
    settings.goal_ms = 1e30f;
    sf_settings_recent(&settings, "/tmp/good.json");
    sf_settings_recent(&settings, "/tmp/not-utf-8-\xff.json");
    words_begin();
    sf_settings_save(&settings);
    sf_settings_load(&read);
    assert_words(0, NULL);
    assert_int_equal(read.width, 64);
    assert_int_equal(read.height, 16384);
    assert_string_equal(read.recent[0], "/tmp/good.json");
    assert_null(read.recent[1]);
    sf_settings_finish(&settings);
    sf_settings_finish(&read);
}

static void test_recent(void **state)
{
    struct sf_settings settings;
    char path[4096 + 32];

    (void)state;
    sf_settings_default(&settings);
    for (int i = 0; i < SF_RECENT_MAX + 3; i++) {
        snprintf(path, sizeof path, "/scenes/%d.json", i);
        sf_settings_recent(&settings, path);
    }
    for (int i = 0; i < SF_RECENT_MAX; i++) {
        snprintf(path, sizeof path, "/scenes/%d.json", SF_RECENT_MAX + 2 - i);
        assert_string_equal(settings.recent[i], path);
    }
    sf_settings_recent(&settings, settings.recent[3]); /* one of its own */
    assert_string_equal(settings.recent[0], "/scenes/7.json");
    assert_string_equal(settings.recent[1], "/scenes/10.json");
    assert_string_equal(settings.recent[3], "/scenes/8.json");
    assert_string_equal(settings.recent[4], "/scenes/6.json");
    /* Seen from here, but remembered for everywhere; once. */
    sf_settings_recent(&settings, "a.json");
    sf_settings_recent(&settings, "./a.json");
    snprintf(path, sizeof path, "%s/a.json", home);
    assert_string_equal(settings.recent[0], path);
    assert_string_equal(settings.recent[1], "/scenes/7.json");
    sf_settings_finish(&settings);
}

/* ---- where the file is ---- */

static void test_places(void **state)
{
    struct sf_settings settings = unusual(), read;
    char place[4096 + 64];
    struct stat about;

    (void)state;
    setenv("HOME", home, 1);
    setenv("XDG_CONFIG_HOME", "relative", 1); /* to be ignored */
    words_begin();
    sf_settings_load(&read);
    assert_words(0, NULL);
    assert_defaults(&read);
    words_begin();
    sf_settings_save(&settings);
    assert_words(0, NULL);
    snprintf(place, sizeof place, "%s/.config", home);
    assert_int_equal(stat(place, &about), 0);
    assert_int_equal(about.st_mode & 0777, 0700);
    snprintf(place, sizeof place, "%s/.config/sfumato", home);
    assert_int_equal(stat(place, &about), 0);
    assert_int_equal(about.st_mode & 0777, 0700);
    unsetenv("XDG_CONFIG_HOME");
    sf_settings_load(&read);
    assert_int_equal(read.width, settings.width);
    sf_settings_finish(&read);
    /* A folder that XDG_CONFIG_HOME names is made too. */
    snprintf(place, sizeof place, "%s/elsewhere", home);
    setenv("XDG_CONFIG_HOME", place, 1);
    words_begin();
    sf_settings_save(&settings);
    sf_settings_load(&read);
    assert_words(0, NULL);
    assert_int_equal(read.width, settings.width);
    sf_settings_finish(&read);
    /* Neither: nothing is read, nothing written, nothing said. */
    unsetenv("XDG_CONFIG_HOME");
    unsetenv("HOME");
    words_begin();
    sf_settings_save(&settings);
    sf_settings_load(&read);
    assert_words(0, NULL);
    assert_defaults(&read);
    /* A home that does not exist is not made. */
    snprintf(place, sizeof place, "%s/nobody", home);
    setenv("HOME", place, 1);
    words_begin();
    sf_settings_save(&settings);
    assert_words(1, "nobody/.config/sfumato/view.json: cannot be written: No such file");
    assert_int_equal(access(place, F_OK), -1);
    sf_settings_finish(&settings);
}

/* ---- files that cannot be used ---- */

static void test_corrupt(void **state)
{
    static const char *const texts[][2] = {
        {"", "line"},
        {"{\"width\":", "line 1"},
        {"{\"width\": 900,\n\"height\" 700}", "line 2"},
        {"[1, 2]", "is not a JSON object"},
        {"{\"width\": 900, \"width\": 901}", "duplicate"},
        {"{\"panel_width\": 1e999}", "line 1"},
        {"{\"present_mode\": \"\xff\xfe\"}", "line 1"},
        {"\x7f"
         "ELF",
         "line 1"},
    };
    struct sf_settings settings;
    char nested[5000];

    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        settings = load_text(texts[i][0], 1, texts[i][1]);
        assert_defaults(&settings);
    }
    memset(nested, '[', sizeof nested - 1);
    nested[sizeof nested - 1] = '\0';
    settings = load_text(nested, 1, "view.json: line");
    assert_defaults(&settings);
}

/* A good file cut anywhere never does harm, and only the whole of it counts. */
static void test_truncated(void **state)
{
    struct sf_settings settings = unusual(), read;
    static char text[8192];
    ssize_t bytes;
    int fd;

    (void)state;
    sf_settings_save(&settings);
    fd = open(file, O_RDONLY);
    bytes = pread(fd, text, sizeof text, 0);
    close(fd);
    assert_true(bytes > 500 && bytes < (ssize_t)sizeof text);
    for (ssize_t cut = 0; cut < bytes - 1; cut += 7) {
        write_file(text, (size_t)cut);
        words_begin();
        sf_settings_load(&read);
        assert_words(1, "going on with defaults");
        assert_defaults(&read);
    }
    sf_settings_finish(&settings);
}

static void test_wrong_values(void **state)
{
    static const char *const texts[][2] = {
        {"{\"width\": \"wide\"}", "width is not a whole number"},
        {"{\"width\": 900.5}", "width is not a whole number"},
        {"{\"width\": 0}", "width is out of range"},
        {"{\"height\": -5}", "height is out of range"},
        {"{\"height\": 99999999999999}", "height is out of range"},
        {"{\"fullscreen\": 1}", "fullscreen is neither true nor false"},
        {"{\"adapt\": null}", "adapt is neither true nor false"},
        {"{\"panel_width\": 5}", "panel_width is out of range"},
        {"{\"panel_width\": []}", "panel_width is not a number"},
        {"{\"goal_ms\": 1e300}", "goal_ms is out of range"},
        {"{\"present_mode\": \"vsync\"}", "present_mode is none of fifo"},
        {"{\"present_mode\": 3}", "present_mode is none of fifo"},
        {"{\"zoom\": 3}", "zoom is not known"},
        {"{\"recent\": \"a.json\"}", "recent is not a list"},
        {"{\"recent\": [3, \"\"]}", "recent has an entry that is not"},
        {"{\"presets\": {}}", "presets is not a list of at most 9"},
        {"{\"presets\": [null,null,null,null,null,null,null,null,null,null]}", "presets is not a list of at most 9"},
    };

    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct sf_settings settings = load_text(texts[i][0], 1, texts[i][1]);

        assert_defaults(&settings);
    }
    /* What is good beside it counts. */
    struct sf_settings settings = load_text("{\"width\": 900, \"height\": \"no\", \"zoom\": 1, \"goal_ms\": 20,"
                                            "\"recent\": [\"/a\", 7, \"/b\"]}",
                                            3, "height");
    assert_int_equal(settings.width, 900);
    assert_int_equal(settings.height, 800);
    assert_true(settings.goal_ms == 20);
    assert_string_equal(settings.recent[0], "/a");
    assert_string_equal(settings.recent[1], "/b");
    sf_settings_finish(&settings);
    settings = load_text("{\"recent\": [\"1\",\"2\",\"3\",\"4\",\"5\",\"6\",\"7\",\"8\",\"9\"]}", 1, "more than 8");
    assert_string_equal(settings.recent[7], "8");
    sf_settings_finish(&settings);
}

/* A preset that no scene could have would be an error when it is called up. */
static void test_wrong_presets(void **state)
{
    static const char *const bad[] = {
        "3",
        "{}",
        "{\"eye\":[0,1,5],\"target\":[0,1,0],\"up\":[0,1,0],\"fov\":40}",
        "{\"eye\":[0,1],\"target\":[0,1,0],\"up\":[0,1,0],\"fov\":40,\"near\":0.1}",
        "{\"eye\":[0,1,\"5\"],\"target\":[0,1,0],\"up\":[0,1,0],\"fov\":40,\"near\":0.1}",
        "{\"eye\":[0,1,2e5],\"target\":[0,1,0],\"up\":[0,1,0],\"fov\":40,\"near\":0.1}",
        "{\"eye\":[0,1,0],\"target\":[0,1,0],\"up\":[0,1,0],\"fov\":40,\"near\":0.1}",
        "{\"eye\":[0,5,0],\"target\":[0,1,0],\"up\":[0,1,0],\"fov\":40,\"near\":0.1}",
        "{\"eye\":[0,1,5],\"target\":[0,1,0],\"up\":[0,0,0],\"fov\":40,\"near\":0.1}",
        "{\"eye\":[0,1,5],\"target\":[0,1,0],\"up\":[0,1,0],\"fov\":0,\"near\":0.1}",
        "{\"eye\":[0,1,5],\"target\":[0,1,0],\"up\":[0,1,0],\"fov\":40,\"near\":0}",
        "{\"eye\":[0,1,5],\"target\":[0,1,0],\"up\":[0,1,0],\"fov\":40,\"near\":0.1,\"roll\":1}",
    };

    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char text[512];

        snprintf(text, sizeof text,
                 "{\"presets\":[%s,null,{\"eye\":[0,1,5],\"target\":[0,1,0],\"up\":[0,1,0],\"fov\":40,\"near\":0.1}]}",
                 bad[i]);
        struct sf_settings settings = load_text(text, 1, "presets has an entry that is not a camera");
        assert_false(settings.preset_set[0] || settings.preset_set[1]);
        assert_true(settings.preset_set[2]);
        assert_true(settings.presets[2].eye[2] == 5 && settings.presets[2].fov == 40);
    }
}

static void test_not_a_file(void **state)
{
    struct sf_settings settings, saved = unusual();
    static char large[300 * 1024];

    (void)state;
    memset(large, ' ', sizeof large);
    memcpy(large, "{}", 2);
    write_file(large, sizeof large);
    words_begin();
    sf_settings_load(&settings);
    assert_words(1, "is too large");
    assert_defaults(&settings);
    unlink(file);
    assert_int_equal(mkfifo(file, 0600), 0); /* nobody writes into it: must not wait */
    words_begin();
    sf_settings_load(&settings);
    assert_words(1, "is not a file");
    assert_defaults(&settings);
    unlink(file);
    assert_int_equal(mkdir(file, 0700), 0);
    words_begin();
    sf_settings_load(&settings);
    assert_words(1, "is not a file");
    assert_defaults(&settings);
    words_begin();
    sf_settings_save(&saved);
    assert_words(1, "view.json: cannot be written: Is a directory");
    assert_int_equal(scratch_count("sfumato"), 1); /* no temporary */
    sf_settings_finish(&saved);
}

/* ---- writing that fails ---- */

static void test_unwritable(void **state)
{
    struct sf_settings settings = unusual(), read;
    struct rlimit limit, none;
    char place[4096 + 64];

    (void)state;
    /* A disk that is full: what was there stays. */
    write_file("{\"width\": 900}", 14);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &none), 0);
    limit = none;
    signal(SIGXFSZ, SIG_IGN);
    words_begin();
    limit.rlim_cur = 300;
    setrlimit(RLIMIT_FSIZE, &limit);
    sf_settings_save(&settings);
    setrlimit(RLIMIT_FSIZE, &none);
    assert_words(1, "view.json: cannot be written: ");
    assert_int_equal(scratch_count("sfumato"), 1);
    sf_settings_load(&read);
    assert_int_equal(read.width, 900);
    sf_settings_finish(&read);
    /* A folder that is not ours (root may write everywhere). */
    snprintf(place, sizeof place, "%s/sfumato", home);
    if (geteuid() != 0) {
        chmod(place, 0500);
        words_begin();
        sf_settings_save(&settings);
        assert_words(1, "cannot be written: Permission denied");
        chmod(place, 0700);
    }
    /* A file in a folder's place. */
    unlink(file);
    rmdir(place);
    snprintf(file, sizeof file, "%s/sfumato", home);
    write_file("x", 1);
    words_begin();
    sf_settings_load(&read);
    sf_settings_save(&settings);
    assert_words(1, "cannot be written: Not a directory");
    assert_defaults(&read);
    sf_settings_finish(&settings);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_round_trip, set_up),   cmocka_unit_test_setup(test_extreme_values, set_up),
        cmocka_unit_test_setup(test_recent, set_up),       cmocka_unit_test_setup(test_places, set_up),
        cmocka_unit_test_setup(test_corrupt, set_up),      cmocka_unit_test_setup(test_truncated, set_up),
        cmocka_unit_test_setup(test_wrong_values, set_up), cmocka_unit_test_setup(test_wrong_presets, set_up),
        cmocka_unit_test_setup(test_not_a_file, set_up),   cmocka_unit_test_setup(test_unwritable, set_up),
    };

    return cmocka_run_group_tests(tests, enter, scratch_leave);
}
