/* Volumetric soft particles (METHODS B7): their noise, what density it leaves, and their assets, see method.h. */
#ifndef SF_METHODS_VOLUMETRIC_H
#define SF_METHODS_VOLUMETRIC_H

#include "methods/method.h"

/* [SF_VOLUMETRIC_SIDE][..][..][4], as shared/volumetric.h has it. SF_ERROR_MEMORY without a message. The same bytes every time. */
enum sf_status sf_volumetric_noise(uint8_t *texels);
/* Density in a particle, of the medium's, is max(0, density[0] + density[1] n - density[2] (r / radius)^2), n being noise of
 * mean 0 and variance 1. With these three its mean over the sphere is 1 when n is normally distributed; with strength 0 it is
 * 1 everywhere. */
void sf_volumetric_density(float strength, float density[3]);

enum sf_status sf_volumetric_assets_create(struct sf_gpu *gpu, const struct sf_scene *scene, const struct sf_log *log,
                                           void **assets);
void sf_volumetric_assets_destroy(void **assets);
bool sf_volumetric_assets_same(const struct sf_scene *a, const struct sf_scene *b);
void sf_volumetric_assets_bind(const struct sf_graph *graph, struct sf_player *player, void *assets);

#endif
