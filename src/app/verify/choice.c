/* What is measured: scenes, methods, and how densely. */
#include "verify.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../console.h"
#include "../files.h"
#include "../session.h"

static const char truth_scenes[] = "scenes/truth";

static enum sf_status out_of_memory(void)
{
    return sf_console_fail(SF_ERROR_MEMORY, "out of memory");
}

/* ---- scenes ---- */

static int compare_names(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static bool ends_in_json(const char *name)
{
    size_t length = strlen(name);

    return length > 5 && strcmp(name + length - 5, ".json") == 0;
}

/* Takes over `path`. */
static enum sf_status add_path(struct sf_verify *verify, char *path)
{
    char **paths = path ? realloc(verify->paths, (verify->path_count + 1) * sizeof *paths) : NULL;

    if (!paths) {
        free(path);
        return out_of_memory();
    }
    verify->paths = paths;
    paths[verify->path_count++] = path;
    return SF_OK;
}

static char *joined(const char *folder, const char *name)
{
    size_t room = strlen(folder) + strlen(name) + 2;
    char *path = malloc(room);

    if (path)
        snprintf(path, room, "%s/%s", folder, name);
    return path;
}

/* The scenes of a folder by name; none when there is no such folder. */
static enum sf_status add_folder(struct sf_verify *verify, const char *folder)
{
    DIR *list = opendir(folder);
    const struct dirent *entry;
    enum sf_status status = SF_OK;

    while (list && !status && (entry = readdir(list)))
        if (ends_in_json(entry->d_name))
            status = add_path(verify, joined(folder, entry->d_name));
    if (list)
        closedir(list);
    if (verify->path_count > 0)
        qsort(verify->paths, verify->path_count, sizeof *verify->paths, compare_names);
    return status;
}

enum sf_status sf_verify_find_scenes(struct sf_verify *verify)
{
    const struct sf_argument_list *files = &verify->arguments->files;
    enum sf_status status = SF_OK;
    char *folder;

    for (size_t i = 0; i < files->count && !status; i++)
        status = add_path(verify, strdup(files->items[i]));
    if (files->count > 0)
        return status;
    folder = sf_file_beside_program(truth_scenes);
    if (folder)
        status = add_folder(verify, folder);
    free(folder);
    if (!status && verify->path_count == 0)
        return sf_console_fail(SF_ERROR_USAGE, "verify: needs SCENE: there is no folder %s here or beside the program",
                               truth_scenes);
    return status;
}

/* ---- methods ---- */

/* Takes over `method` and `set`, which may be NULL. */
static enum sf_status add_entry(struct sf_verify *verify, char *method, char *set, uint32_t sweep)
{
    struct sf_verify_entry *entries =
        method ? realloc(verify->entries, (verify->entry_count + 1) * sizeof *entries) : NULL;
    const char *dot = set ? strchr(set, '.') : NULL;

    if (!entries || (sweep > 0 && !set)) {
        free(method);
        free(set);
        if (entries)
            verify->entries = entries;
        return out_of_memory();
    }
    verify->entries = entries;
    entries[verify->entry_count++] =
        (struct sf_verify_entry){.method = method, .set = set, .label = dot ? dot + 1 : "", .sweep = sweep};
    return SF_OK;
}

static enum sf_status unknown_method(const char *method, const char *const *known, size_t count)
{
    const char *nearest = sf_nearest_word(method, known, count);
    char all[512] = "";
    size_t used = 0;

    for (size_t i = 0; i < count && used < sizeof all; i++)
        used += (size_t)snprintf(all + used, sizeof all - used, "%s%s", i ? ", " : "", known[i]);
    if (nearest)
        return sf_console_fail(SF_ERROR_USAGE, "--methods: unknown method %s; did you mean %s? (known: %s)", method,
                               nearest, all);
    return sf_console_fail(SF_ERROR_USAGE, "--methods: unknown method %s (known: %s)", method, all);
}

static enum sf_status add_method(struct sf_verify *verify, const char *name, size_t length, const char *const *known,
                                 size_t count)
{
    char *method = strndup(name, length);
    bool found = false;
    enum sf_status status;

    if (!method)
        return out_of_memory();
    if (length == 0) {
        free(method);
        return sf_console_fail(SF_ERROR_USAGE, "--methods %s: a name is empty", verify->arguments->methods);
    }
    for (size_t i = 0; i < count && !found; i++)
        found = strcmp(known[i], method) == 0;
    if (!found) {
        status = unknown_method(method, known, count);
        free(method);
        return status;
    }
    for (size_t i = 0; i < verify->entry_count; i++)
        if (strcmp(verify->entries[i].method, method) == 0) {
            status = sf_console_fail(SF_ERROR_USAGE, "--methods: %s is given twice", method);
            free(method);
            return status;
        }
    return add_entry(verify, method, NULL, 0);
}

static enum sf_status add_methods(struct sf_verify *verify, const char *const *known)
{
    const char *list = verify->arguments->methods;
    enum sf_status status = SF_OK;
    size_t count = 0;

    while (known[count])
        count++;
    for (size_t i = 0; i < count && !list && !status; i++)
        if (strcmp(known[i], "none") != 0)
            status = add_method(verify, known[i], strlen(known[i]), known, count);
    while (list && !status) {
        size_t length = strcspn(list, ",");

        status = add_method(verify, list, length, known, count);
        list = list[length] ? list + length + 1 : NULL;
    }
    return status;
}

/* ---- settings ---- */

/* What trades quality for time, under these names in any method's group. Of a choice every value is tried. */
static const struct {
    const char *key;
    double values[8]; /* of a number; those out of its range are left out. 0 ends them */
} qualities[] = {{"resolution", {0}}, {"steps", {2, 4, 8, 16, 32}}};

static const struct sf_control *find_control(const struct sf_control *controls, uint32_t count, const char *path)
{
    for (uint32_t i = 0; i < count; i++)
        if (strcmp(controls[i].path, path) == 0)
            return &controls[i];
    return NULL;
}

/* The method's own group, of its name, or of what is behind the dash in it ("larsson" for "thick-larsson"), or that of the
 * method that it is a kind of ("thick"). */
static const struct sf_control *find_quality(const struct sf_control *controls, uint32_t count, const char *method,
                                             const char *key)
{
    const char *dash = strchr(method, '-');
    const struct sf_control *control;
    char path[256];

    snprintf(path, sizeof path, "%s.%s", dash ? dash + 1 : method, key);
    control = find_control(controls, count, path);
    if (control || !dash)
        return control;
    snprintf(path, sizeof path, "%.*s.%s", (int)(dash - method), method, key);
    return find_control(controls, count, path);
}

/* The control at a value, as a set. */
static enum sf_status add_setting(struct sf_verify *verify, const char *method, const struct sf_control *control,
                                  double value, uint32_t sweep)
{
    struct sf_control changed = *control;

    changed.value[0] = value;
    return add_entry(verify, strdup(method), sf_control_print(&changed), sweep);
}

static enum sf_status add_settings(struct sf_verify *verify, const char *method, const struct sf_control *controls,
                                   uint32_t count)
{
    enum sf_status status = SF_OK;

    for (uint32_t q = 0; q < sizeof qualities / sizeof *qualities; q++) {
        const struct sf_control *control = find_quality(controls, count, method, qualities[q].key);
        const double *values = qualities[q].values;

        if (!control)
            continue;
        if (control->kind == SF_CONTROL_CHOICE)
            for (uint32_t i = 0; control->choices[i] && !status; i++)
                status = add_setting(verify, method, control, i, q + 1);
        for (uint32_t i = 0; control->kind != SF_CONTROL_CHOICE && values[i] > 0 && !status; i++)
            if (values[i] >= control->min && values[i] <= control->max)
                status = add_setting(verify, method, control, values[i], q + 1);
    }
    return status;
}

/* Each method's settings behind it. */
static enum sf_status sweep(struct sf_verify *verify, const struct sf_control *controls, uint32_t count)
{
    struct sf_verify_entry *methods = verify->entries;
    size_t method_count = verify->entry_count;
    enum sf_status status = SF_OK;

    verify->entries = NULL;
    verify->entry_count = 0;
    for (size_t i = 0; i < method_count; i++) {
        if (status) {
            free(methods[i].method);
            continue;
        }
        status = add_entry(verify, methods[i].method, NULL, 0);
        if (!status)
            status = add_settings(verify, verify->entries[verify->entry_count - 1].method, controls, count);
    }
    free(methods);
    return status;
}

/* The parameter table knows the methods; any scene shows it. */
enum sf_status sf_verify_find_entries(struct sf_verify *verify)
{
    struct sf_scene *scene = NULL;
    struct sf_control *controls = NULL;
    uint32_t count = 0;
    enum sf_status status = sf_scene_parse("methods", "{}", 2, NULL, 0, sf_console_log(), &scene);

    if (!status)
        status = sf_scene_controls(scene, sf_console_log(), &controls, &count);
    if (!status)
        status = add_methods(verify, find_control(controls, count, "method")->choices);
    if (!status && verify->arguments->settings)
        status = sweep(verify, controls, count);
    free(controls);
    sf_scene_destroy(&scene);
    return status;
}

enum sf_status sf_verify_load(const struct sf_verify *verify, const char *path, const struct sf_verify_entry *entry,
                              struct sf_scene **scene)
{
    struct sf_arguments arguments = *verify->arguments;
    const char **sets = malloc((arguments.sets.count + 1) * sizeof *sets);
    enum sf_status status;

    if (!sets)
        return out_of_memory();
    if (arguments.sets.count > 0)
        memcpy(sets, arguments.sets.items, arguments.sets.count * sizeof *sets);
    arguments.sets.items = sets;
    if (entry->set)
        sets[arguments.sets.count++] = entry->set;
    arguments.method = entry->method;
    status = sf_session_scene(&arguments, path, scene);
    free(sets);
    return status;
}
