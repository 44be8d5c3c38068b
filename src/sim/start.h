/* What the simulation holds before its first step, and what emitters read all along: explicit lists and the triangles
 * of mesh emitters. */
#ifndef SF_SIM_START_H
#define SF_SIM_START_H

#include "scene/scene.h"
#include "shared/sim.h"

/* Where each emitter's things lie. */
struct sf_sim_layout {
    uint32_t triangles[SF_EMITTERS_MAX], triangle_counts[SF_EMITTERS_MAX]; /* in the buffer of triangles */
    uint32_t listed[SF_EMITTERS_MAX]; /* lists that begin later: in the buffer of listed particles */
    uint32_t triangle_total, listed_total;
    uint32_t first_total; /* particles of the lists that are there from the beginning */
};
void sf_sim_layout_fill(const struct sf_scene *scene, struct sf_sim_layout *layout);

/* Fills `layout->first_total` particles with the lists that are there from the beginning (start 0), and the counts that
 * go with them. */
void sf_sim_first_particles(const struct sf_scene *scene, struct sf_particle *particles,
                            struct sf_particle_counts *counts);
/* Fills `layout->listed_total` particles with the lists that begin later; their ids are given at birth. */
void sf_sim_listed_particles(const struct sf_scene *scene, struct sf_particle *particles);
/* Fills `layout->triangle_total` triangles. SF_ERROR_SCENE when a mesh has no area. */
enum sf_status sf_sim_triangles(const struct sf_scene *scene, const struct sf_log *log,
                                struct sf_sim_triangle *triangles);

#endif
