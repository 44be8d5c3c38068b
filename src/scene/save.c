/* A scene as a file: the text with the sets in it, less what the table says anyway. */
#define _XOPEN_SOURCE 700 /* realpath */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/file.h"
#include "scene/load.h"
#include "scene/table.h"

/* ---- names of files ---- */

/* Both folders without links and dots, NULL where there is none. */
struct move {
    char *from, *to;
    bool failed; /* memory is out */
};

static char *real_folder(const char *path)
{
    char *folder = sf_path_beside(path, "."), *real = folder ? realpath(folder, NULL) : NULL;

    free(folder);
    return real;
}

/* Length of what the two have in common: nothing but the root, or whole steps such as "/home/a". */
static size_t common_length(const char *a, const char *b)
{
    size_t common = 0;

    for (size_t i = 0;; i++) {
        bool end_a = a[i] == '/' || a[i] == '\0', end_b = b[i] == '/' || b[i] == '\0';

        if (end_a && end_b)
            common = i;
        if (a[i] != b[i] || a[i] == '\0')
            return common;
    }
}

/* `name`, seen from `from`, as it is seen from `to`. A way that would lead through the root is given from there. Memory
 * is out when text->failed. */
static void seen_from(const char *name, const char *from, const char *to, struct sf_text *text)
{
    size_t length = strcmp(from, "/") == 0 ? 0 : strlen(from), common;
    const char *target = strcmp(to, "/") == 0 ? "" : to;
    struct sf_text whole = {0};

    /* Steps up are taken off the folder, which holds no links. */
    for (;; name += strspn(name, "/")) {
        if (strncmp(name, "../", 3) == 0) {
            while (length > 0 && from[--length] != '/')
                continue;
            name += 2;
        } else if (strncmp(name, "./", 2) == 0) {
            name += 1;
        } else {
            break;
        }
    }
    sf_text_printf(&whole, "%.*s/%s", (int)length, from, name);
    if (whole.failed) {
        text->failed = true;
        return;
    }
    common = common_length(whole.data, target);
    if (common == 0 && *target) {
        sf_text_append(text, whole.data);
    } else {
        for (const char *step = target + common; *step; step++)
            if (*step == '/')
                sf_text_append(text, "../");
        sf_text_append(text, whole.data + common + 1);
    }
    sf_text_finish(&whole);
}

/* A string of the tree that names a file, made to fit. */
static json_t *moved(struct move *move, const json_t *name)
{
    struct sf_text text = {0};
    json_t *string = NULL;

    seen_from(json_string_value(name), move->from, move->to, &text);
    if (!text.failed)
        string = json_string(text.data);
    sf_text_finish(&text);
    move->failed = move->failed || !string;
    return string;
}

static bool is_relative(const json_t *name)
{
    return json_is_string(name) && json_string_value(name)[0] != '/';
}

/* Every string of the table is the name of a file. */
static void move_files(struct move *move, const struct sf_param_group *group, json_t *json)
{
    for (size_t i = 0; i < group->count; i++) {
        const struct sf_param *row = &group->rows[i];
        json_t *value = json_object_get(json, row->key), *element;
        size_t k;

        if (row->type == SF_PARAM_OBJECT)
            move_files(move, row->group, value);
        else if (row->type == SF_PARAM_LIST)
            json_array_foreach(value, k, element) move_files(move, row->group, element);
        else if (row->type == SF_PARAM_STRING && is_relative(value))
            json_object_set_new(json, row->key, moved(move, value));
        else if (row->type == SF_PARAM_FILES)
            json_array_foreach(value, k, element) if (is_relative(element))
                json_array_set_new(value, k, moved(move, element));
    }
}

/* Names are seen from the folder of the file that they stand in. */
static enum sf_status fit_names(json_t *tree, const char *from, const char *to, const struct sf_log *log)
{
    struct move move = {real_folder(from), real_folder(to), false};
    const json_t *schema = json_object_get(tree, "$schema");
    bool linked = schema && (!is_relative(schema) || strstr(json_string_value(schema), "://"));

    if (!move.from || !move.to) {
        if (!linked)
            json_object_del(tree, "$schema"); /* nobody knows where it leads */
    } else if (strcmp(move.from, move.to) != 0) {
        move_files(&move, &sf_scene_group, tree);
        if (schema && !linked)
            json_object_set_new(tree, "$schema", moved(&move, schema));
    }
    free(move.from);
    free(move.to);
    return move.failed ? sf_fail(log, SF_ERROR_MEMORY, "%s: out of memory", to) : SF_OK;
}

/* ---- saving ---- */

/* The tree with its sets, as it shall stand in the file. */
static enum sf_status make_text(const char *name, json_t *tree, const char *const *sets, uint32_t set_count,
                                const char *path, const struct sf_log *log, struct sf_text *text)
{
    struct sf_arena arena = {0};
    struct sf_param_reader reader = {.name = name, .log = log, .arena = &arena};
    enum sf_status status = sf_scene_apply_sets(&reader, tree, sets, set_count);

    sf_arena_finish(&arena);
    if (status != SF_OK)
        return status;
    sf_param_prune(&sf_scene_group, tree);
    if ((status = fit_names(tree, name, path, log)) != SF_OK)
        return status;
    sf_param_write(tree, text);
    return text->failed ? sf_fail(log, SF_ERROR_MEMORY, "%s: out of memory", path) : SF_OK;
}

static enum sf_status check(const char *name, const char *text, size_t bytes, const char *const *sets,
                            uint32_t set_count, const struct sf_log *log)
{
    struct sf_scene *scene = NULL;
    enum sf_status status = sf_scene_parse(name, text, bytes, sets, set_count, log, &scene);

    sf_scene_destroy(&scene);
    return status;
}

enum sf_status sf_scene_save(const char *name, const char *text, size_t bytes, const char *const *sets,
                             uint32_t set_count, const char *path, const struct sf_log *log)
{
    /* Warnings came when the scene was loaded. */
    const struct sf_log errors = {log ? log->write : NULL, log ? log->user : NULL, SF_LOG_ERROR};
    const struct sf_log *quiet = log ? &errors : NULL;
    struct sf_file_writer writer = {.fd = -1};
    struct sf_text out = {0};
    json_t *tree = NULL;
    enum sf_status status = check(name, text, bytes, sets, set_count, quiet);

    if (status == SF_OK)
        status = sf_scene_parse_json(name, "a scene", text, bytes, quiet, &tree);
    if (status == SF_OK)
        status = sf_file_writer_open(&writer, path, quiet);
    if (status == SF_OK)
        status = make_text(name, tree, sets, set_count, path, quiet, &out);
    if (status == SF_OK)
        status = check(path, out.data, out.length, NULL, 0, quiet);
    if (status == SF_OK)
        status = sf_file_writer_write(&writer, out.data, out.length, 0, quiet);
    if (status == SF_OK)
        status = sf_file_writer_commit(&writer, quiet);
    sf_file_writer_abort(&writer);
    sf_text_finish(&out);
    json_decref(tree);
    return status;
}
