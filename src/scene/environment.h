/* Environment pictures, and what ambient light is made of. */
#ifndef SF_SCENE_ENVIRONMENT_H
#define SF_SCENE_ENVIRONMENT_H

#include "scene/scene.h"

enum { SF_ENVIRONMENT_WIDTH = 1024 }; /* of the pixels kept; the height is half of it */

/* Reads the one panorama or the six squares (`paths` in the order of the files), and sets pixels, width, height. *bad
 * is the index of the path that a failure is about. The messages name the file. */
enum sf_status sf_environment_load(struct sf_environment *environment, char *const *paths, struct sf_arena *arena,
                                   const struct sf_log *log, uint32_t *bad);
/* Sets sh from the radiance; pixels are there. */
void sf_environment_project(struct sf_environment *environment);

#endif
