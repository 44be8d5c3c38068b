#include "settings.h"

#include <errno.h>
#include <fcntl.h>
#include <jansson.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../console.h"
#include "../files.h"
#include "vector.h"

enum { FILE_MOST = 256 * 1024, SIDE_LEAST = 64, SIDE_MOST = 16384 }; /* bytes; px */

void sf_settings_default(struct sf_settings *settings)
{
    *settings = (struct sf_settings){.width = 1280,
                                     .height = 800,
                                     .panel = true,
                                     .panel_width = 360,
                                     .present_mode = "fifo",
                                     .adapt = true,
                                     .goal_ms = 50}; /* what a CPU can hold; a GPU is always below it */
}

void sf_settings_finish(struct sf_settings *settings)
{
    for (int i = 0; i < SF_RECENT_MAX; i++) {
        free(settings->recent[i]);
        settings->recent[i] = NULL;
    }
}

/* malloc'ed; NULL when there is no home: then nothing is remembered. */
static char *settings_path(void)
{
    const char *base = getenv("XDG_CONFIG_HOME"), *rest = "/sfumato/view.json";
    size_t room;
    char *path;

    /* The XDG base directory specification: a relative one is to be ignored. */
    if (!base || base[0] != '/') {
        base = getenv("HOME");
        rest = "/.config/sfumato/view.json";
        if (!base || base[0] != '/')
            return NULL;
    }
    room = strlen(base) + strlen(rest) + 1;
    path = malloc(room);
    if (path)
        snprintf(path, room, "%s%s", base, rest);
    return path;
}

/* ---- what is in the file ---- */

enum kind { KIND_BOOL, KIND_WHOLE, KIND_NUMBER, KIND_MODE };

/* One value; the lists stand by themselves. */
struct row {
    const char *key;
    enum kind kind;
    size_t offset;
    double min, max;
};
static const struct row rows[] = {
    {"width", KIND_WHOLE, offsetof(struct sf_settings, width), SIDE_LEAST, SIDE_MOST},
    {"height", KIND_WHOLE, offsetof(struct sf_settings, height), SIDE_LEAST, SIDE_MOST},
    {"fullscreen", KIND_BOOL, offsetof(struct sf_settings, fullscreen), 0, 1},
    {"panel", KIND_BOOL, offsetof(struct sf_settings, panel), 0, 1},
    {"panel_width", KIND_NUMBER, offsetof(struct sf_settings, panel_width), 100, 2000},
    {"present_mode", KIND_MODE, offsetof(struct sf_settings, present_mode), 0, 0},
    {"adapt", KIND_BOOL, offsetof(struct sf_settings, adapt), 0, 1},
    {"goal_ms", KIND_NUMBER, offsetof(struct sf_settings, goal_ms), 1, 10000},
};
static const char *const modes[] = {"fifo", "fifo_relaxed", "mailbox", "immediate"};
enum { ROWS = sizeof rows / sizeof *rows, MODES = sizeof modes / sizeof *modes };

/* ---- reading ---- */

static const char *read_mode(const json_t *value, void *field)
{
    for (int i = 0; i < MODES; i++) {
        if (json_is_string(value) && strcmp(json_string_value(value), modes[i]) == 0) {
            snprintf(field, sizeof((struct sf_settings *)0)->present_mode, "%s", modes[i]);
            return NULL;
        }
    }
    return "is none of fifo, fifo_relaxed, mailbox, immediate";
}

/* NULL, or what is wrong. */
static const char *read_row(const struct row *row, const json_t *value, struct sf_settings *settings)
{
    void *field = (char *)settings + row->offset;
    double number = json_number_value(value);

    if (row->kind == KIND_MODE)
        return read_mode(value, field);
    if (row->kind == KIND_BOOL) {
        if (!json_is_boolean(value))
            return "is neither true nor false";
        *(bool *)field = json_is_true(value);
        return NULL;
    }
    if (row->kind == KIND_WHOLE ? !json_is_integer(value) : !json_is_number(value))
        return row->kind == KIND_WHOLE ? "is not a whole number" : "is not a number";
    if (!(number >= row->min && number <= row->max))
        return "is out of range";
    if (row->kind == KIND_WHOLE)
        *(uint32_t *)field = (uint32_t)number;
    else
        *(float *)field = (float)number;
    return NULL;
}

static const char *read_recent(const json_t *list, struct sf_settings *settings)
{
    const char *wrong = NULL;
    int count = 0;

    if (!json_is_array(list))
        return "is not a list";
    for (size_t i = 0; i < json_array_size(list); i++) {
        const char *path = json_string_value(json_array_get(list, i));

        if (!path || !*path)
            wrong = "has an entry that is not a file's name";
        else if (count == SF_RECENT_MAX)
            return "has more than 8 entries";
        else if (!(settings->recent[count++] = strdup(path)))
            return "does not fit into memory";
    }
    return wrong;
}

/* False unless it is a number that a scene's camera may have there. */
static bool read_number(const json_t *value, double min, double max, float *number)
{
    double read = json_number_value(value);

    if (!json_is_number(value) || fabs(read) > 1e6)
        return false;
    *number = (float)read; /* compared as such, so that what was written may be read again */
    return *number >= (float)min && *number <= (float)max;
}

static bool read_vector(const json_t *list, double most, float v[3])
{
    bool good = json_array_size(list) == 3;

    for (size_t i = 0; i < 3 && good; i++)
        good = read_number(json_array_get(list, i), -most, most, &v[i]);
    return good;
}

/* A camera that cannot be drawn with is refused here: later it would be an error of the scene. */
static bool read_preset(const json_t *value, struct sf_camera_view *view)
{
    double way[3], up[3], side[3];

    if (json_object_size(value) != 5 || !read_vector(json_object_get(value, "eye"), 1e5, view->eye) ||
        !read_vector(json_object_get(value, "target"), 1e5, view->target) ||
        !read_vector(json_object_get(value, "up"), 1, view->up) ||
        !read_number(json_object_get(value, "fov"), 1, 170, &view->fov) ||
        !read_number(json_object_get(value, "near"), 1e-4, 1e3, &view->near_clip))
        return false;
    for (int i = 0; i < 3; i++) {
        way[i] = (double)view->target[i] - view->eye[i];
        up[i] = view->up[i];
    }
    if (sf_v3_length(way) < 1e-6 || !sf_v3_normalize(way) || !sf_v3_normalize(up))
        return false;
    sf_v3_cross(way, up, side);
    return sf_v3_length(side) > 1e-4;
}

static const char *read_presets(const json_t *list, struct sf_settings *settings)
{
    const char *wrong = NULL;

    if (!json_is_array(list) || json_array_size(list) > SF_RIG_PRESETS)
        return "is not a list of at most 9";
    for (size_t i = 0; i < json_array_size(list); i++) {
        const json_t *entry = json_array_get(list, i);
        struct sf_camera_view view;

        if (json_is_null(entry))
            continue;
        settings->preset_set[i] = read_preset(entry, &view);
        if (settings->preset_set[i])
            settings->presets[i] = view;
        else
            wrong = "has an entry that is not a camera";
    }
    return wrong;
}

static const char *read_key(const char *key, const json_t *value, struct sf_settings *settings)
{
    if (strcmp(key, "recent") == 0)
        return read_recent(value, settings);
    if (strcmp(key, "presets") == 0)
        return read_presets(value, settings);
    for (int i = 0; i < ROWS; i++)
        if (strcmp(key, rows[i].key) == 0)
            return read_row(&rows[i], value, settings);
    return "is not known";
}

/* The file's bytes, malloc'ed; NULL with a warning, but none when there is no file. */
static char *read_file(const char *path, size_t *bytes)
{
    /* Not blocking: something else than a file may stand there. */
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    const char *wrong = NULL;
    struct stat about;
    char *text = NULL;
    ssize_t got = 1;

    *bytes = 0;
    if (fd < 0) {
        if (errno != ENOENT && errno != ENOTDIR)
            sf_console_say(SF_LOG_WARNING, "%s: cannot be read: %s; going on with defaults", path, strerror(errno));
        return NULL;
    }
    if (fstat(fd, &about) != 0 || !S_ISREG(about.st_mode))
        wrong = "is not a file";
    else if (!(text = malloc(FILE_MOST + 1)))
        wrong = "out of memory";
    while (!wrong && got > 0 && *bytes <= FILE_MOST) {
        got = read(fd, text + *bytes, FILE_MOST + 1 - *bytes);
        if (got > 0)
            *bytes += (size_t)got;
        else if (got < 0)
            wrong = strerror(errno);
    }
    if (!wrong && *bytes > FILE_MOST)
        wrong = "is too large";
    close(fd);
    if (!wrong)
        return text;
    sf_console_say(SF_LOG_WARNING, "%s: %s; going on with defaults", path, wrong);
    free(text);
    return NULL;
}

void sf_settings_load(struct sf_settings *settings)
{
    char *path = settings_path(), *text;
    json_error_t error;
    json_t *root, *value;
    const char *key, *wrong;
    size_t bytes;

    sf_settings_default(settings);
    text = path ? read_file(path, &bytes) : NULL;
    if (!text) {
        free(path);
        return;
    }
    root = json_loadb(text, bytes, JSON_REJECT_DUPLICATES, &error);
    free(text);
    if (!root)
        sf_console_say(SF_LOG_WARNING, "%s: line %d: %s; going on with defaults", path, error.line, error.text);
    else if (!json_is_object(root))
        sf_console_say(SF_LOG_WARNING, "%s: is not a JSON object; going on with defaults", path);
    json_object_foreach(root, key, value)
    {
        if ((wrong = read_key(key, value, settings)))
            sf_console_say(SF_LOG_WARNING, "%s: %.64s %s; passed over", path, key, wrong);
    }
    json_decref(root);
    free(path);
}

/* ---- writing ---- */

static json_t *vector_json(const float v[3])
{
    return json_pack("[f,f,f]", (double)v[0], (double)v[1], (double)v[2]);
}

/* Kept to what is read again: a window can be larger or smaller than is worth remembering. */
static json_t *row_json(const struct row *row, const struct sf_settings *settings)
{
    const void *field = (const char *)settings + row->offset;

    switch (row->kind) {
    case KIND_BOOL:
        return json_boolean(*(const bool *)field);
    case KIND_WHOLE:
        return json_integer((json_int_t)fmin(fmax(*(const uint32_t *)field, row->min), row->max));
    case KIND_NUMBER:
        return json_real(fmin(fmax(*(const float *)field, row->min), row->max));
    case KIND_MODE:
        break;
    }
    return json_string(field);
}

static json_t *preset_json(const struct sf_settings *settings, int preset)
{
    const struct sf_camera_view *view = &settings->presets[preset];

    if (!settings->preset_set[preset])
        return json_null();
    return json_pack("{s:o,s:o,s:o,s:f,s:f}", "eye", vector_json(view->eye), "target", vector_json(view->target), "up",
                     vector_json(view->up), "fov", (double)view->fov, "near", (double)view->near_clip);
}

/* NULL when memory is out. */
static json_t *settings_json(const struct sf_settings *settings)
{
    json_t *root = json_object(), *recent = json_array(), *presets = json_array();
    bool failed = !root;

    for (int i = 0; i < ROWS; i++)
        failed = json_object_set_new(root, rows[i].key, row_json(&rows[i], settings)) != 0 || failed;
    for (int i = 0; i < SF_RECENT_MAX; i++)
        if (settings->recent[i])
            json_array_append_new(recent, json_string(settings->recent[i])); /* a name that is not UTF-8 is left out */
    for (int i = 0; i < SF_RIG_PRESETS; i++)
        failed = json_array_append_new(presets, preset_json(settings, i)) != 0 || failed;
    failed = json_object_set_new(root, "recent", recent) != 0 || failed;
    failed = json_object_set_new(root, "presets", presets) != 0 || failed;
    if (!failed)
        return root;
    json_decref(root);
    return NULL;
}

/* Makes the file's folder and the one that holds it; the person's own, so nobody else may look in. Nothing above: a home
 * that is not there is not ours to make. errno tells of a failure. */
static bool make_folders(char *path)
{
    char *file = strrchr(path, '/'), *folder;
    bool made;

    *file = '\0';
    folder = strrchr(path, '/');
    *folder = '\0';
    made = mkdir(path, 0700) == 0 || errno == EEXIST;
    *folder = '/';
    made = made && (mkdir(path, 0700) == 0 || errno == EEXIST);
    *file = '/';
    return made;
}

void sf_settings_save(const struct sf_settings *settings)
{
    const size_t flags = JSON_INDENT(2) | JSON_REAL_PRECISION(9); /* nine digits give each float back */
    char *path = settings_path(), *text = NULL;
    json_t *root;

    if (!path)
        return;
    if (!(root = settings_json(settings)) || !(text = json_dumps(root, flags)))
        sf_console_say(SF_LOG_WARNING, "%s: cannot be written: out of memory", path);
    else if (!make_folders(path) || !sf_file_replace(path, text, strlen(text)))
        sf_console_say(SF_LOG_WARNING, "%s: cannot be written: %s", path, strerror(errno));
    json_decref(root);
    free(text);
    free(path);
}

/* malloc'ed; the next time may be in another folder. */
static char *whole_path(const char *path)
{
    char folder[4096];
    size_t room;
    char *whole;

    while (path[0] == '.' && path[1] == '/')
        path += 2;
    if (path[0] == '/' || !getcwd(folder, sizeof folder))
        return strdup(path);
    room = strlen(folder) + strlen(path) + 2;
    whole = malloc(room);
    if (whole)
        snprintf(whole, room, "%s/%s", folder, path);
    return whole;
}

void sf_settings_recent(struct sf_settings *settings, const char *path)
{
    char *newest = whole_path(path); /* a copy, as `path` may be one of the list */
    int at = 0;

    if (!newest)
        return;
    while (at < SF_RECENT_MAX - 1 && settings->recent[at] && strcmp(settings->recent[at], newest) != 0)
        at++;
    free(settings->recent[at]);
    memmove(&settings->recent[1], &settings->recent[0], (size_t)at * sizeof *settings->recent);
    settings->recent[0] = newest;
}
