#include "scene/load.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include "base/file.h"
#include "base/hash.h"
#include "scene/table.h"

/* A million particles take three million objects and lists, and fifteen million values. */
enum { NESTS_MAX = 4000000, VALUES_MAX = 20000000, REASON_BYTES = 256 };
#define SCENE_BYTES_MAX ((size_t)SF_SCENE_MIB_MAX << 20)

/* Every `[]` of three bytes is more than a hundred in memory: what would take gigabytes is refused before it is parsed.
 */
static bool is_bounded(const char *text, size_t bytes)
{
    size_t nests = 0, values = 0;
    bool inside = false; /* a string */

    for (size_t i = 0; i < bytes; i++) {
        if (inside && text[i] == '\\')
            i++;
        else if (text[i] == '"')
            inside = !inside;
        else if (!inside) {
            nests += text[i] == '[' || text[i] == '{';
            values += text[i] == ',';
        }
    }
    return nests <= NESTS_MAX && values <= VALUES_MAX;
}

enum sf_status sf_scene_parse_json(const char *name, const char *what, const char *text, size_t bytes,
                                   const struct sf_log *log, json_t **out)
{
    char reason[REASON_BYTES];
    json_error_t error;
    json_t *tree;

    *out = NULL;
    if (bytes > SCENE_BYTES_MAX)
        return sf_fail(log, SF_ERROR_SCENE,
                       "%s: %zu bytes; %s holds at most %d MiB. Long lists of particles go into CSV or PLY files", name,
                       bytes, what, SF_SCENE_MIB_MAX);
    if (bytes >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0) { /* the mark that some editors put before UTF-8 */
        text += 3;
        bytes -= 3;
    }
    if (bytes == 0)
        return sf_fail(log, SF_ERROR_SCENE, "%s: the file is empty; %s is a JSON object", name, what);
    if (!is_bounded(text, bytes))
        return sf_fail(log, SF_ERROR_SCENE,
                       "%s: more than %d lists and objects or %d values; long lists go into CSV or PLY files", name,
                       NESTS_MAX, VALUES_MAX);
    tree = json_loadb(text, bytes, JSON_REJECT_DUPLICATES, &error);
    if (!tree) {
        sf_param_clean(error.text, reason, sizeof reason);
        return sf_fail(log, SF_ERROR_SCENE, "%s:%d:%d: %s", name, error.line, error.column, reason);
    }
    if (!json_is_object(tree)) {
        json_decref(tree);
        return sf_fail(log, SF_ERROR_SCENE, "%s: %s is a JSON object: { ... }", name, what);
    }
    *out = tree;
    return SF_OK;
}

/* Takes comments and $schema out of the tree, so that they do not count in the hash. The parser has bounded the depth.
 */
static void strip(json_t *tree)
{
    const char *key;
    json_t *value;
    size_t i;

    json_object_del(tree, "//");
    json_object_foreach(tree, key, value) strip(value);
    json_array_foreach(tree, i, value) if (json_is_object(value) || json_is_array(value)) strip(value);
}

enum sf_status sf_scene_hash_tree(const char *name, json_t *tree, const struct sf_log *log, uint64_t *hash)
{
    char *text;

    json_object_del(tree, "$schema");
    strip(tree);
    if (!(text = json_dumps(tree, JSON_COMPACT | JSON_SORT_KEYS)))
        return sf_fail(log, SF_ERROR_MEMORY, "%s: out of memory", name);
    *hash = sf_hash_bytes(text, strlen(text), 0);
    free(text);
    return SF_OK;
}

enum sf_status sf_scene_apply_sets(struct sf_param_reader *reader, json_t *tree, const char *const *sets,
                                   uint32_t set_count)
{
    enum sf_status status = SF_OK;

    reader->set_count = 0;
    if (set_count && !(reader->sets = sf_arena_alloc(reader->arena, set_count * sizeof *reader->sets)))
        return sf_fail(reader->log, SF_ERROR_MEMORY, "%s: out of memory", reader->name);
    while (reader->set_count < set_count && status == SF_OK) {
        struct sf_param_set *set = &reader->sets[reader->set_count];

        set->text = sets[reader->set_count];
        status = sf_param_apply_set(reader, &sf_scene_group, tree, set);
        reader->set_count++;
    }
    return status;
}

/* Keeps the values as they are now, before anything is made of them. */
static enum sf_status keep_stated(struct sf_scene *scene, const struct sf_log *log)
{
    struct sf_scene *stated = sf_arena_alloc(&scene->arena, sizeof *stated);

    if (!stated)
        return sf_fail(log, SF_ERROR_MEMORY, "%s: out of memory", scene->path);
    *stated = *scene;
    stated->arena = (struct sf_arena){0};
    /* Camera keys and paths stay as they are; particles take over what their emitter says. */
    for (uint32_t i = 0; i < stated->emitter_count; i++) {
        struct sf_emitter *emitter = &stated->emitters[i];
        size_t bytes = emitter->list_count * sizeof *emitter->list;
        struct sf_listed *list;

        if (emitter->list_count == 0 || emitter->list_count > SF_CONTROLS_LIST_MAX)
            continue;
        if (!(list = sf_arena_alloc(&scene->arena, bytes)))
            return sf_fail(log, SF_ERROR_MEMORY, "%s: out of memory", scene->path);
        emitter->list = memcpy(list, emitter->list, bytes);
    }
    scene->stated = stated;
    return SF_OK;
}

/* From the parsed tree to the scene. */
static enum sf_status read_tree(struct sf_scene *scene, json_t *tree, const char *const *sets, uint32_t set_count,
                                const struct sf_log *log)
{
    struct sf_param_reader reader = {.name = scene->path, .log = log, .arena = &scene->arena};
    struct sf_arena arena;
    enum sf_status status = sf_scene_apply_sets(&reader, tree, sets, set_count);
    const char *path = scene->path;

    if (status != SF_OK)
        return status;
    /* Reading begins with the defaults of everything, so what is not of the table is put back. */
    arena = scene->arena;
    reader.arena = &arena;
    status = sf_param_read(&reader, &sf_scene_group, tree, scene);
    reader.arena = &scene->arena;
    scene->arena = arena;
    scene->path = path;
    if (status == SF_OK)
        status = keep_stated(scene, log);
    if (status == SF_OK)
        status = sf_scene_hash_tree(path, tree, log, &scene->hash);
    if (status == SF_OK)
        status = sf_scene_check(scene, &reader);
    if (status == SF_OK)
        status = sf_scene_load_effects(scene, &reader);
    if (status == SF_OK)
        status = sf_scene_load_assets(scene, &reader);
    if (status == SF_OK)
        status = sf_scene_check_particles(scene, &reader);
    return status;
}

enum sf_status sf_scene_parse(const char *name, const char *text, size_t bytes, const char *const *sets,
                              uint32_t set_count, const struct sf_log *log, struct sf_scene **out)
{
    struct sf_scene *scene;
    enum sf_status status;
    json_t *tree;

    *out = NULL;
    if ((status = sf_scene_parse_json(name, "a scene", text, bytes, log, &tree)) != SF_OK)
        return status;
    scene = calloc(1, sizeof *scene);
    if (scene)
        scene->path = sf_arena_strdup(&scene->arena, name);
    if (scene && scene->path)
        status = read_tree(scene, tree, sets, set_count, log);
    else
        status = sf_fail(log, SF_ERROR_MEMORY, "%s: out of memory", name);
    json_decref(tree);
    if (status == SF_OK)
        *out = scene;
    else
        sf_scene_destroy(&scene);
    return status;
}

enum sf_status sf_scene_load(const char *path, const char *const *sets, uint32_t set_count, const struct sf_log *log,
                             struct sf_scene **scene)
{
    enum sf_status status;
    struct stat info;
    char *text = NULL;
    size_t bytes = 0;

    *scene = NULL;
    if (stat(path, &info) == 0 && S_ISREG(info.st_mode) && info.st_size > (off_t)SCENE_BYTES_MAX)
        return sf_fail(log, SF_ERROR_SCENE,
                       "%s: %lld bytes; a scene holds at most %d MiB. Long lists of particles go into CSV or PLY files",
                       path, (long long)info.st_size, SF_SCENE_MIB_MAX);
    if ((status = sf_file_read(path, SCENE_BYTES_MAX, log, &text, &bytes)) != SF_OK)
        return status;
    status = sf_scene_parse(path, text, bytes, sets, set_count, log, scene);
    free(text);
    return status;
}

void sf_scene_destroy(struct sf_scene **scene)
{
    if (!scene || !*scene)
        return;
    sf_texture_destroy(&(*scene)->atlas.texture);
    sf_arena_finish(&(*scene)->arena);
    free(*scene);
    *scene = NULL;
}
