#include "model.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "log_line.h"
#include "model_make.h"

enum { SCENE_MIB_MAX = 64 }; /* as the library has it */
/* A file is missing or empty for that long before it is an error: editors truncate and write, or remove and rename. */
static const uint64_t MISSING_NS = 500000000;

static enum sf_status no_memory(const struct sf_model *model)
{
    return sf_log_fail(model->log, SF_ERROR_MEMORY, "out of memory");
}

static struct sf_sets sets_of(const struct sf_model *model)
{
    return (struct sf_sets){.items = model->sets, .count = model->set_count};
}

/* ---- what takes the model's place ---- */

/* The model's own file with sets that are still to be put. */
static struct sf_next next_of(const struct sf_model *model)
{
    return (struct sf_next){.path = model->path,
                            .text = model->text,
                            .bytes = model->bytes,
                            .shared = true,
                            .own = {.items = model->own, .count = model->own_count},
                            .log = model->log};
}

static void take_file(struct sf_model *model, const struct sf_next *next)
{
    struct sf_sets own = {.items = model->own, .count = model->own_count};

    sf_sets_finish(&own);
    free(model->path);
    free(model->text);
    model->path = next->path;
    model->text = next->text;
    model->bytes = next->bytes;
    model->own = next->own.items;
    model->own_count = next->own.count;
}

/* Offers it, and puts it in the model's place; it is empty afterwards. When it is refused, nothing changes. */
static enum sf_status commit(struct sf_model *model, struct sf_next *next)
{
    enum sf_status status = model->accept ? model->accept(model->user, next->made.scene) : SF_OK;
    struct sf_sets sets = sets_of(model);

    if (status)
        return status;
    free(model->controls);
    sf_scene_destroy(&model->scene);
    sf_sets_finish(&sets);
    if (!next->shared)
        take_file(model, next);
    model->sets = next->sets.items;
    model->set_count = next->sets.count;
    model->scene = next->made.scene;
    model->controls = next->made.controls;
    model->control_count = next->made.count;
    sf_scene_describe(model->scene, &model->info);
    *next = (struct sf_next){0};
    return SF_OK;
}

/* ---- files ---- */

static void stamp_of(const struct stat *info, int64_t stamp[2])
{
    /* The change of the inode, as renaming over a file may keep the time of its contents. */
    stamp[0] = (int64_t)info->st_ctim.tv_sec * 1000000000 + info->st_ctim.tv_nsec;
    stamp[1] = (int64_t)info->st_size;
}

/* The whole file; false: `reason` says why not. */
static bool read_file(const char *path, struct sf_next *next, int64_t stamp[2], char *reason, size_t room)
{
    FILE *file = NULL;
    struct stat info;
    bool ok = false;

    if (stat(path, &info) != 0) {
        snprintf(reason, room, "%s: cannot be read: %s", path, strerror(errno));
        return false;
    }
    stamp_of(&info, stamp);
    if (!S_ISREG(info.st_mode)) {
        snprintf(reason, room, "%s: is not a file", path);
    } else if (info.st_size > (off_t)SCENE_MIB_MAX << 20) {
        snprintf(reason, room, "%s: %lld bytes; a scene holds at most %d MiB", path, (long long)info.st_size,
                 SCENE_MIB_MAX);
    } else if (!(next->text = malloc((size_t)info.st_size + 1)) || !(next->path = strdup(path))) {
        snprintf(reason, room, "%s: out of memory", path);
    } else if (!(file = fopen(path, "rb"))) {
        snprintf(reason, room, "%s: cannot be read: %s", path, strerror(errno));
    } else {
        next->bytes = fread(next->text, 1, (size_t)info.st_size, file);
        next->text[next->bytes] = '\0';
        ok = !ferror(file);
        if (!ok)
            snprintf(reason, room, "%s: cannot be read: %s", path, strerror(errno));
    }
    if (file)
        fclose(file);
    return ok;
}

/* ---- opening ---- */

static enum sf_status load(struct sf_model *model, const char *path, const char *const *sets, uint32_t set_count)
{
    struct sf_next next = {.log = model->log};
    char reason[SF_MADE_ERROR_BYTES];
    int64_t stamp[2];
    enum sf_status status;

    if (!read_file(path, &next, stamp, reason, sizeof reason))
        status = sf_log_fail(model->log, SF_ERROR_IO, "%s", reason);
    else if (!sf_sets_put_all(&next.sets, sets, set_count))
        status = no_memory(model);
    else if ((status = sf_next_make(&next, model->log)) != SF_OK)
        sf_log_fail(model->log, status, "%s", next.made.error);
    else if (!sf_next_read_own(&next) || !sf_next_settle(&next))
        status = no_memory(model);
    else
        status = commit(model, &next);
    sf_next_finish(&next);
    if (status)
        return status;
    model->stamp[0] = stamp[0];
    model->stamp[1] = stamp[1];
    model->missing_ns = 0;
    model->error[0] = '\0';
    return SF_OK;
}

enum sf_status sf_model_open(struct sf_model *model, const char *path, const char *const *sets, uint32_t set_count)
{
    return load(model, path, sets, set_count);
}

enum sf_status sf_model_replace(struct sf_model *model, const char *path)
{
    return load(model, path, NULL, 0);
}

void sf_model_finish(struct sf_model *model)
{
    struct sf_sets sets = sets_of(model);

    take_file(model, &(struct sf_next){0});
    sf_sets_finish(&sets);
    free(model->controls);
    sf_scene_destroy(&model->scene);
    *model = (struct sf_model){.log = model->log, .accept = model->accept, .user = model->user};
}

/* ---- changes ---- */

/* Marks the sets that must stay: all but the others of a group whose type is one of the changed paths. */
static void mark_kept(const struct sf_sets *sets, const char *const *changed, uint32_t count, bool *kept)
{
    for (uint32_t i = 0; i < sets->count; i++) {
        bool in_group = false, is_changed = false;
        size_t bytes = sf_sets_path(sets->items[i]);

        for (uint32_t c = 0; c < count; c++) {
            size_t path = sf_sets_path(changed[c]), group = sf_sets_kind(changed[c], path);

            is_changed |= path == bytes && memcmp(changed[c], sets->items[i], bytes) == 0;
            in_group |= group && strncmp(changed[c], sets->items[i], group) == 0;
        }
        kept[i] = is_changed || !in_group;
    }
}

/* Makes next's sets the model's. `changed`: what they differ in. */
static enum sf_status apply(struct sf_model *model, struct sf_next *next, const char *const *changed, uint32_t count)
{
    enum sf_status status = sf_next_make(next, NULL);
    bool *kept = status ? calloc((size_t)next->sets.count + 1, sizeof *kept) : NULL, typed = false;

    for (uint32_t i = 0; i < count && kept; i++)
        typed |= sf_sets_kind(changed[i], sf_sets_path(changed[i])) > 0;
    if (typed) {
        mark_kept(&next->sets, changed, count, kept);
        if (sf_next_fit(next, kept))
            status = SF_OK;
    }
    free(kept);
    if (status)
        return sf_log_fail(model->log, status, "%s", next->made.error);
    if (!sf_next_settle(next))
        return no_memory(model);
    return commit(model, next);
}

enum sf_status sf_model_set_many(struct sf_model *model, const char *const *assignments, uint32_t count)
{
    struct sf_sets sets = sets_of(model);
    struct sf_next next = next_of(model);
    enum sf_status status;

    if (!sf_sets_put_all(&next.sets, sf_sets_view(&sets), sets.count) ||
        !sf_sets_put_all(&next.sets, assignments, count))
        status = no_memory(model);
    else if (sf_sets_equal(&next.sets, &sets))
        status = SF_OK;
    else
        status = apply(model, &next, assignments, count);
    sf_next_finish(&next);
    return status;
}

enum sf_status sf_model_set(struct sf_model *model, const char *assignment)
{
    return sf_model_set_many(model, &assignment, 1);
}

enum sf_status sf_model_reset(struct sf_model *model, const char *path)
{
    struct sf_sets sets = sets_of(model);
    uint32_t at = path ? sf_sets_find(&sets, path, strlen(path)) : 0;
    struct sf_next next = next_of(model);
    enum sf_status status;

    if (sets.count == 0 || at == UINT32_MAX)
        return SF_OK;
    if (path && !sf_sets_put_all(&next.sets, sf_sets_view(&sets), sets.count)) {
        status = no_memory(model);
    } else {
        if (path)
            sf_sets_drop(&next.sets, at);
        status = apply(model, &next, &path, path ? 1 : 0);
    }
    sf_next_finish(&next);
    return status;
}

bool sf_model_changed(const struct sf_model *model, const char *path)
{
    struct sf_sets sets = sets_of(model);

    return sf_sets_find(&sets, path, strlen(path)) != UINT32_MAX;
}

const struct sf_control *sf_model_control(const struct sf_model *model, const char *path)
{
    for (uint32_t i = 0; i < model->control_count; i++)
        if (strcmp(model->controls[i].path, path) == 0)
            return &model->controls[i];
    return NULL;
}

/* ---- the file on disk ---- */

/* The file cannot be used as it is: `error` says so, the log when that is news. */
static void complain(struct sf_model *model, const char *reason)
{
    if (strcmp(model->error, reason) == 0)
        return;
    snprintf(model->error, sizeof model->error, "%s", reason);
    sf_log_line(model->log, SF_LOG_ERROR, "%s", reason);
}

/* Is there something to read? False while the file is as it was, or is being written. */
static bool has_changed(struct sf_model *model)
{
    struct stat info;
    int64_t stamp[2];
    int error = stat(model->path, &info) != 0 ? errno : 0;

    if (error || info.st_size == 0) {
        char reason[SF_MADE_ERROR_BYTES];
        uint64_t now = sf_now_ns();

        model->stamp[0] = model->stamp[1] = -1; /* whatever comes is new */
        if (!model->missing_ns)
            model->missing_ns = now;
        if (now - model->missing_ns >= MISSING_NS) {
            snprintf(reason, sizeof reason, "%s: %s", model->path, error ? strerror(error) : "the file is empty");
            complain(model, reason);
        }
        return false;
    }
    model->missing_ns = 0;
    stamp_of(&info, stamp);
    return stamp[0] != model->stamp[0] || stamp[1] != model->stamp[1];
}

/* The sets over a text that has just been read. False: next->made says why; when it does not, memory is out. */
static bool renew(const struct sf_model *model, struct sf_next *next)
{
    struct sf_sets sets = sets_of(model);

    if (!sf_sets_copy(&next->sets, &sets) || !sf_next_read_own(next))
        return false;
    if (sf_next_make(next, model->log) != SF_OK) {
        bool *kept = next->sets.count ? calloc(next->sets.count, sizeof *kept) : NULL;
        bool fits = kept && sf_next_fit(next, kept);

        free(kept);
        if (!fits)
            return false;
    }
    return sf_next_settle(next);
}

void sf_model_watch(struct sf_model *model, bool *renewed)
{
    struct sf_next next = {.log = model->log};
    char reason[SF_MADE_ERROR_BYTES] = "";

    *renewed = false;
    if (!has_changed(model))
        return;
    if (!read_file(model->path, &next, model->stamp, reason, sizeof reason)) {
        complain(model, reason);
    } else if (!renew(model, &next)) {
        complain(model, next.made.error[0] ? next.made.error : "out of memory");
    } else if (commit(model, &next) != SF_OK) {
        snprintf(reason, sizeof reason, "%s: the scene cannot be drawn", model->path);
        complain(model, reason);
    } else {
        model->error[0] = '\0';
        *renewed = true;
    }
    sf_next_finish(&next);
}
