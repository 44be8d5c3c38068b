/* A list of sets, "thick.steps=24": at most one a path, in the order in which paths came first. */
#ifndef SF_APP_VIEW_MODEL_SETS_H
#define SF_APP_VIEW_MODEL_SETS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct sf_sets {
    char **items; /* malloc'ed, and each of them */
    uint32_t count;
};

/* Bytes of the path: up to the '=', or the whole. */
size_t sf_sets_path(const char *assignment);
/* Index of the set of that path; UINT32_MAX: none. */
uint32_t sf_sets_find(const struct sf_sets *sets, const char *path, size_t bytes);
/* Over the one of its path, or behind the others. False: memory is out, nothing changed. */
bool sf_sets_put(struct sf_sets *sets, const char *assignment);
bool sf_sets_put_all(struct sf_sets *sets, const char *const *assignments, uint32_t count);
void sf_sets_drop(struct sf_sets *sets, uint32_t index);
/* `to` is empty before. */
bool sf_sets_copy(struct sf_sets *to, const struct sf_sets *from);
bool sf_sets_equal(const struct sf_sets *a, const struct sf_sets *b);
/* As the library takes them. */
const char *const *sf_sets_view(const struct sf_sets *sets);
/* `from` with `extra` behind. An extra goes over the set of its path; one of a group's type ("camera.type=fixed") over all
 * sets of the group, as the extras then say the group anew. */
bool sf_sets_merge(struct sf_sets *to, const struct sf_sets *from, const char *const *extra, uint32_t count);
void sf_sets_finish(struct sf_sets *sets);

/* Bytes of the group in front of a path that ends in ".type", dot included; 0 for other paths. */
size_t sf_sets_kind(const char *path, size_t bytes);

#endif
