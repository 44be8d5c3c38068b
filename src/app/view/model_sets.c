#include "model_sets.h"

#include <stdlib.h>
#include <string.h>

size_t sf_sets_path(const char *assignment)
{
    return strcspn(assignment, "=");
}

uint32_t sf_sets_find(const struct sf_sets *sets, const char *path, size_t bytes)
{
    for (uint32_t i = 0; i < sets->count; i++)
        if (sf_sets_path(sets->items[i]) == bytes && memcmp(sets->items[i], path, bytes) == 0)
            return i;
    return UINT32_MAX;
}

bool sf_sets_put(struct sf_sets *sets, const char *assignment)
{
    uint32_t at = sf_sets_find(sets, assignment, sf_sets_path(assignment));
    char *item = strdup(assignment), **items;

    if (!item)
        return false;
    if (at != UINT32_MAX) {
        free(sets->items[at]);
        sets->items[at] = item;
        return true;
    }
    if (!(items = realloc(sets->items, ((size_t)sets->count + 1) * sizeof *items))) {
        free(item);
        return false;
    }
    sets->items = items;
    items[sets->count++] = item;
    return true;
}

bool sf_sets_put_all(struct sf_sets *sets, const char *const *assignments, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        if (!sf_sets_put(sets, assignments[i]))
            return false;
    return true;
}

void sf_sets_drop(struct sf_sets *sets, uint32_t index)
{
    free(sets->items[index]);
    sets->count--;
    memmove(sets->items + index, sets->items + index + 1, (sets->count - index) * sizeof *sets->items);
}

bool sf_sets_copy(struct sf_sets *to, const struct sf_sets *from)
{
    return sf_sets_put_all(to, sf_sets_view(from), from->count);
}

bool sf_sets_equal(const struct sf_sets *a, const struct sf_sets *b)
{
    bool equal = a->count == b->count;

    for (uint32_t i = 0; i < a->count && equal; i++)
        equal = strcmp(a->items[i], b->items[i]) == 0;
    return equal;
}

const char *const *sf_sets_view(const struct sf_sets *sets)
{
    return (const char *const *)sets->items;
}

size_t sf_sets_kind(const char *path, size_t bytes)
{
    static const char tail[] = ".type";
    size_t length = sizeof tail - 1;

    return bytes > length && memcmp(path + bytes - length, tail, length) == 0 ? bytes - length + 1 : 0;
}

/* Whether an extra set replaces this one. */
static bool is_replaced(const char *item, const char *const *extra, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        size_t path = sf_sets_path(extra[i]), group = sf_sets_kind(extra[i], path);

        if (path == sf_sets_path(item) && memcmp(extra[i], item, path) == 0)
            return true;
        if (group && strncmp(extra[i], item, group) == 0)
            return true;
    }
    return false;
}

bool sf_sets_merge(struct sf_sets *to, const struct sf_sets *from, const char *const *extra, uint32_t count)
{
    for (uint32_t i = 0; i < from->count; i++)
        if (!is_replaced(from->items[i], extra, count) && !sf_sets_put(to, from->items[i]))
            return false;
    return sf_sets_put_all(to, extra, count);
}

void sf_sets_finish(struct sf_sets *sets)
{
    for (uint32_t i = 0; i < sets->count; i++)
        free(sets->items[i]);
    free(sets->items);
    *sets = (struct sf_sets){0};
}
