/* What a step of the simulation reads, from the scene and the step's number alone: nothing accumulates from step to
 * step, so stepping can resume anywhere and gives the same bits. No GPU. */
#ifndef SF_SIM_FEED_H
#define SF_SIM_FEED_H

#include "sim/start.h"

/* Fixed steps in a second: fps x substeps. */
double sf_sim_step_rate(const struct sf_scene *scene);

/* Everything for the step from step/rate to (step+1)/rate. The scene is read anew each time, so that forces and
 * emitters can be changed while it runs. Only the objects that are there are written, at the end of `now`, and only the
 * emitters and records that are there in `births`. Returns the bytes of `now` to upload. */
size_t sf_sim_feed(const struct sf_scene *scene, const struct sf_sim_layout *layout, uint64_t step,
                   struct sf_sim_now *now, struct sf_sim_births *births);

#endif
