/* The rows: every key of a scene file. */
#ifndef SF_SCENE_TABLE_H
#define SF_SCENE_TABLE_H

#include "params/params.h"

/* The whole file: struct sf_scene. Its object rows (camera, medium, environment, sim, output, shadow, thick) are
 * reached by
 * --set GROUP.KEY=VALUE, its list rows by --set LIST.INDEX.KEY=VALUE. */
extern const struct sf_param_group sf_scene_group;

/* One explicit particle, struct sf_listed: also the columns' ranges of particle files. */
extern const struct sf_param_group sf_scene_particle_group;

#endif
