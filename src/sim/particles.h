/* The particle simulation: emission, forces, collision, death and compaction, all on the device in fixed steps. Nothing
 * here depends on the order in which atomics land; the same scene gives the same bits. */
#ifndef SF_SIM_PARTICLES_H
#define SF_SIM_PARTICLES_H

#include "gpu/gpu.h"
#include "scene/scene.h"

struct sf_particles;
/* Buffers, graph and player for the scene; uploads explicit lists. The scene must outlive it. SF_ERROR_SCENE when the
 * capacity is more than the device can hold (the message says how much it can). */
enum sf_status sf_particles_create(struct sf_gpu *gpu, const struct sf_scene *scene, const struct sf_log *log,
                                   struct sf_particles **particles);
void sf_particles_destroy(struct sf_particles **particles);
/* Takes another scene and starts from time 0: all that is made for it is made anew, but for the list where the capacity
 * stays. When it fails, the old scene goes on, from time 0 at worst. */
enum sf_status sf_particles_restart(struct sf_particles *particles, const struct sf_scene *scene);
/* Takes a scene whose simulation is the same; it goes on. */
void sf_particles_set_scene(struct sf_particles *particles, const struct sf_scene *scene);
/* Back to time 0: the explicit lists, and nothing else. Waits for idle. */
enum sf_status sf_particles_reset(struct sf_particles *particles);
/* Records one fixed step; between sf_frame_begin and sf_frame_end. */
enum sf_status sf_particles_step(struct sf_particles *particles);
/* Steps made since the start (SF_STEPS_UNKNOWN after a reset that failed: reset it), and the length of one in s. */
#define SF_STEPS_UNKNOWN UINT64_MAX
uint64_t sf_particles_steps(const struct sf_particles *particles);
double sf_particles_dt(const struct sf_particles *particles);

/* The list (a history pair of struct sf_particle) and its struct sf_particle_counts; both rest in
 * SF_ACCESS_STORAGE_READ outside. */
struct sf_gpu_buffer *sf_particles_list(struct sf_particles *particles);
struct sf_gpu_buffer *sf_particles_counts(struct sf_particles *particles);
uint32_t sf_particles_capacity(const struct sf_particles *particles);
/* For timing: the step's player. */
struct sf_player *sf_particles_player(struct sf_particles *particles);
const struct sf_plan *sf_particles_plan(const struct sf_particles *particles);
/* The same plan with no device, for `sfumato graph`; the caller destroys plan, then graph. */
enum sf_status sf_particles_declare(const struct sf_scene *scene, const struct sf_gpu_tuning *tuning,
                                    const struct sf_log *log, struct sf_graph **graph);

#endif
