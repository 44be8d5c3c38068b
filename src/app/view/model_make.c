#include "model_make.h"

#include <stdlib.h>
#include <string.h>

#include "log_line.h"

/* ---- a scene ---- */

struct listener {
    struct sf_made *made;
    const struct sf_log *log; /* gets what is no error; NULL: nobody */
};

static void listen_to(void *user, enum sf_log_level level, const char *message)
{
    struct listener *listener = user;

    if (level > SF_LOG_ERROR)
        sf_log_line(listener->log, level, "%s", message);
    else if (!listener->made->error[0])
        snprintf(listener->made->error, sizeof listener->made->error, "%s", message);
}

static void unmake(struct sf_made *made)
{
    free(made->controls);
    sf_scene_destroy(&made->scene);
    *made = (struct sf_made){0};
}

static enum sf_status make(const struct sf_next *next, const struct sf_sets *sets, const struct sf_log *log,
                           struct sf_made *made)
{
    struct listener listener = {.made = made, .log = log};
    const struct sf_log ear = {.write = listen_to, .user = &listener, .level = log ? log->level : SF_LOG_ERROR};

    *made = (struct sf_made){0};
    made->status =
        sf_scene_parse(next->path, next->text, next->bytes, sf_sets_view(sets), sets->count, &ear, &made->scene);
    if (!made->status)
        made->status = sf_scene_controls(made->scene, &ear, &made->controls, &made->count);
    if (made->status)
        sf_scene_destroy(&made->scene);
    if (made->status && !made->error[0])
        snprintf(made->error, sizeof made->error, "%s: %s", next->path, sf_status_name(made->status));
    return made->status;
}

void sf_next_finish(struct sf_next *next)
{
    if (!next->shared) {
        free(next->path);
        free(next->text);
        sf_sets_finish(&next->own);
    }
    sf_sets_finish(&next->sets);
    unmake(&next->made);
    *next = (struct sf_next){0};
}

enum sf_status sf_next_make(struct sf_next *next, const struct sf_log *log)
{
    unmake(&next->made);
    return make(next, &next->sets, log, &next->made);
}

/* ---- the file's own values ---- */

/* The control as a set; NULL when the scene has none of that path, and when memory is out. */
static char *print_control(const struct sf_made *made, const char *path, size_t bytes)
{
    for (uint32_t i = 0; i < made->count; i++)
        if (strncmp(made->controls[i].path, path, bytes) == 0 && !made->controls[i].path[bytes])
            return sf_control_print(&made->controls[i]);
    return NULL;
}

bool sf_next_read_own(struct sf_next *next)
{
    const struct sf_sets none = {0};
    struct sf_made bare;
    bool ok = true;

    if (make(next, &none, NULL, &bare) == SF_OK && bare.count) {
        next->own.items = calloc(bare.count, sizeof *next->own.items);
        ok = next->own.items != NULL;
        for (uint32_t i = 0; i < bare.count && ok; i++) {
            next->own.items[i] = sf_control_print(&bare.controls[i]);
            ok = next->own.items[i] != NULL;
            next->own.count += ok;
        }
    }
    unmake(&bare);
    return ok;
}

/* Does the set say what the file says? */
static bool says_own(const struct sf_next *next, const char *set)
{
    size_t bytes = sf_sets_path(set);
    uint32_t at = sf_sets_find(&next->own, set, bytes);
    char *with = at != UINT32_MAX ? print_control(&next->made, set, bytes) : NULL;
    bool same = with && strcmp(with, next->own.items[at]) == 0;

    free(with);
    return same;
}

bool sf_next_settle(struct sf_next *next)
{
    struct sf_sets fewer = {0};
    struct sf_made made = {0};

    for (uint32_t i = 0; i < next->sets.count; i++)
        if (!says_own(next, next->sets.items[i]) && !sf_sets_put(&fewer, next->sets.items[i])) {
            sf_sets_finish(&fewer);
            return false;
        }
    /* The scene is the same without them but for its hash, which is to be that of the sets that are shown. */
    if (fewer.count == next->sets.count || make(next, &fewer, NULL, &made) != SF_OK) {
        sf_sets_finish(&fewer);
        return true;
    }
    sf_sets_finish(&next->sets);
    unmake(&next->made);
    next->sets = fewer;
    next->made = made;
    return true;
}

/* ---- sets that no longer fit ---- */

struct fit {
    const struct sf_next *next;
    struct sf_sets sets; /* those that are kept */
    struct sf_made made; /* of them */
    bool *kept;          /* for each of next's */
    bool ok;             /* there is memory */
};

/* Adds a set, or all that are left of its group, when the scene can be made with them. `reason` gets why not. */
static bool add_sets(struct fit *fit, uint32_t index, bool group, char reason[SF_MADE_ERROR_BYTES])
{
    const struct sf_sets *all = &fit->next->sets;
    const char *set = all->items[index];
    size_t path = sf_sets_path(set), prefix = path;
    uint32_t before = fit->sets.count;
    struct sf_made made = {0};
    bool fits;

    while (prefix > 0 && set[prefix - 1] != '.')
        prefix--;
    for (uint32_t i = index; i < all->count && fit->ok; i++)
        if (i == index || (group && prefix && !fit->kept[i] && strncmp(all->items[i], set, prefix) == 0))
            fit->ok = sf_sets_put(&fit->sets, all->items[i]);
    fits = fit->ok && make(fit->next, &fit->sets, NULL, &made) == SF_OK;
    if (fits) {
        unmake(&fit->made);
        fit->made = made;
        for (uint32_t i = index; i < all->count; i++)
            fit->kept[i] = sf_sets_find(&fit->sets, all->items[i], sf_sets_path(all->items[i])) != UINT32_MAX;
        return true;
    }
    snprintf(reason, SF_MADE_ERROR_BYTES, "%s", made.error);
    while (fit->sets.count > before)
        sf_sets_drop(&fit->sets, fit->sets.count - 1);
    return false;
}

static bool add_all(struct fit *fit)
{
    const struct sf_sets *all = &fit->next->sets;
    char reason[SF_MADE_ERROR_BYTES];
    bool more = true;

    /* Whole groups first: a type may need its keys. Then in rounds: a set may need one that stands behind it. */
    for (uint32_t i = 0; i < all->count && fit->ok; i++)
        if (!fit->kept[i])
            add_sets(fit, i, true, reason);
    while (more && fit->ok) {
        more = false;
        for (uint32_t i = 0; i < all->count && fit->ok; i++)
            if (!fit->kept[i])
                more |= add_sets(fit, i, false, reason);
    }
    for (uint32_t i = 0; i < all->count && fit->ok; i++)
        if (!fit->kept[i] && !add_sets(fit, i, false, reason))
            sf_log_line(fit->next->log, SF_LOG_WARNING, "%s does not fit any more and is dropped (%s)", all->items[i],
                        reason);
    return fit->ok;
}

bool sf_next_fit(struct sf_next *next, bool *kept)
{
    struct fit fit = {.next = next, .kept = kept, .ok = true};

    for (uint32_t i = 0; i < next->sets.count && fit.ok; i++)
        fit.ok = !kept[i] || sf_sets_put(&fit.sets, next->sets.items[i]);
    if (!fit.ok || make(next, &fit.sets, NULL, &fit.made) != SF_OK || !add_all(&fit)) {
        sf_sets_finish(&fit.sets);
        unmake(&fit.made);
        return false;
    }
    sf_sets_finish(&fit.sets);
    unmake(&next->made);
    next->made = fit.made;
    /* The order of sets means nothing to the scene, but people know it. */
    for (uint32_t i = next->sets.count; i-- > 0;)
        if (!kept[i])
            sf_sets_drop(&next->sets, i);
    return true;
}
