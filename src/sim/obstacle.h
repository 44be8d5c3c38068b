/* Scene objects as the GPU's distance functions read them. */
#ifndef SF_SIM_OBSTACLE_H
#define SF_SIM_OBSTACLE_H

#include "scene/scene.h"
#include "shared/frame.h"

/* Place, shape, kind and bounce of an object; the colours stay 0. A plane's x and z axes are its checker's
 * (docs/scene.md). */
void sf_obstacle_fill(const struct sf_object *from, struct sf_gpu_object *to);
/* Whether particles collide with it. */
bool sf_obstacle_collides(const struct sf_object *object);

#endif
