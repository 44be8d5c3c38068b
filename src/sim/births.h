/* How many particles are born in a step, when and where: from the step's number alone. */
#ifndef SF_SIM_BIRTHS_H
#define SF_SIM_BIRTHS_H

#include "sim/start.h"

/* Births of an emitter (lists that are there from the beginning included) before step number `step` begins, steps
 * counted from 0: the stream has given floor(rate (t - start)) by the time t; a burst, or a list, is born in the step
 * in which `start` lies. Each turn of a step of an effect counts by itself, and its stream gives floor(rate integral of
 * its strength). */
uint64_t sf_sim_births(const struct sf_scene *scene, const struct sf_emitter *emitter, uint64_t step);

/* The records of the step, and in `now` how many there are, of how many births; now->capacity has been set. */
void sf_sim_feed_births(const struct sf_scene *scene, const struct sf_sim_layout *layout, uint64_t step,
                        struct sf_sim_now *now, struct sf_sim_births *births);

#endif
