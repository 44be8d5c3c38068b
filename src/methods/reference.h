/* The integral itself, by ever more samples: the rows of the method table (see method.h). docs/methods/reference.md tells
 * what it computes and how. */
#ifndef SF_METHODS_REFERENCE_H
#define SF_METHODS_REFERENCE_H

#include "methods/method.h"
#include "shared/reference.h"

struct sf_reference {
    struct sf_reference_push push;
    uint32_t fit_groups[3], shadow_groups[3], spheres_groups[3], tiles_groups[3], ways_groups[3], depths_groups[3],
        march_groups[3]; /* zeros: not now */
    sf_resource spheres, rects, ranges, lists, entries, depths, sums, ramp, nodes, corners, verdict;
};

enum sf_status sf_reference_light(struct sf_method_frame *frame, void *state, const struct sf_log *log);
enum sf_status sf_reference_view(struct sf_method_frame *frame, void *state, const struct sf_log *log);
void sf_reference_update(const struct sf_method_frame *frame, void *state);
uint32_t sf_reference_plays(const struct sf_scene *scene);
enum sf_status sf_reference_judge(const struct sf_method_frame *frame, const void *verdict, const struct sf_log *log);

/* Device objects: the ramp's keys, and the meshes' triangles with a hierarchy over them (reference_assets.c). */
enum sf_status sf_reference_assets_create(struct sf_gpu *gpu, const struct sf_scene *scene, const struct sf_log *log,
                                          void **assets);
void sf_reference_assets_destroy(void **assets);
bool sf_reference_assets_same(const struct sf_scene *a, const struct sf_scene *b);
void sf_reference_assets_bind(const struct sf_graph *graph, struct sf_player *player, void *assets);
/* Triangles of all the scene's meshes, as often as they stand there; and whether so many can be on any device. */
uint32_t sf_reference_triangles(const struct sf_scene *scene);
bool sf_reference_fits(uint32_t triangles);

#endif
