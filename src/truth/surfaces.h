/* The scene's surfaces for rays: planes, boxes, spheres and cylinders exactly, meshes by their triangles. */
#ifndef SF_TRUTH_SURFACES_H
#define SF_TRUTH_SURFACES_H

#include <stdbool.h>
#include "scene/scene.h"

struct sf_truth_surfaces;
/* The scene must outlive it (meshes are not copied). */
enum sf_status sf_truth_surfaces_create(const struct sf_scene *scene, const struct sf_log *log,
                                        struct sf_truth_surfaces **out);
void sf_truth_surfaces_destroy(struct sf_truth_surfaces **surfaces);

/* The first surface along origin + t direction with t >= from, in units of `direction`; INFINITY when there is none.
 * Both sides of everything are seen: the far side of a solid in which the ray begins. */
double sf_truth_first_surface(const struct sf_truth_surfaces *surfaces, const double origin[3],
                              const double direction[3], double from);
/* Whether a surface that casts shadows (all but planes) is crossed with t between 0 and `to`. */
bool sf_truth_hidden(const struct sf_truth_surfaces *surfaces, const double origin[3], const double direction[3],
                     double to);
/* Whether anything casts shadows at all. */
bool sf_truth_casts(const struct sf_truth_surfaces *surfaces);

#endif
