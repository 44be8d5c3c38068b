/* The GLSL files of a folder: which include which, and which have changed. */
#ifndef SF_APP_VIEW_INCLUDES_H
#define SF_APP_VIEW_INCLUDES_H

#include <stdbool.h>
#include <stdint.h>

struct sf_includes;
/* NULL: memory is out. */
struct sf_includes *sf_includes_create(const char *folder);
void sf_includes_destroy(struct sf_includes **includes);
/* A file that is compiled, "thick/march.comp"; *file is its number. It need not be there. False: memory is out. */
bool sf_includes_add(struct sf_includes *includes, const char *name, uint32_t *file);
/* Looks at all files that were added or are included, over any number of steps. A file that is missing or empty counts as
 * changed only when it still is at the next look: that is how editors write. */
void sf_includes_look(struct sf_includes *includes);
/* Did the file, or one that it includes, change between the last look and the one before? */
bool sf_includes_changed(const struct sf_includes *includes, uint32_t file);
bool sf_includes_exists(const struct sf_includes *includes, uint32_t file);

#endif
