/* What the tests of the simulation share: scenes made by hand, and a simulation run to a step and read back. */
#ifndef SF_TESTS_PARTICLES_KIT_H
#define SF_TESTS_PARTICLES_KIT_H

#include "gpu_kit.h"

#include <math.h>
#include "shared/sim.h"
#include "sim/particles.h"

static struct sf_gpu *kit_device; /* of all tests of a file */

static int open_device(void **state)
{
    (void)state;
    kit_device = kit_gpu(0);
    return 0;
}

static int close_device(void **state)
{
    (void)state;
    kit_finish(&kit_device);
    return 0;
}

/* 64 steps a second, so that times are exact in binary. */
static void scene_init(struct sf_scene *scene, int32_t capacity)
{
    memset(scene, 0, sizeof *scene);
    scene->path = "test";
    scene->sim = (struct sf_sim_settings){.seed = 7, .capacity = capacity, .fps = 32, .substeps = 2};
    scene->medium.extinction = 4;
}

static struct sf_emitter *add_emitter(struct sf_scene *scene, int32_t kind)
{
    struct sf_emitter *emitter = &scene->emitters[scene->emitter_count++];

    *emitter = (struct sf_emitter){
        .kind = kind,
        .direction = {0, 1, 0},
        .radius = 0.2f,
        .size = {1, 1, 1},
        .scale = 1,
        .lifetime = {100, 100},
        .particle_radius = {0.1f, 0.1f},
        .extinction = -1,
    };
    return emitter;
}

static inline struct sf_emitter *add_list(struct sf_scene *scene, struct sf_listed *list, uint32_t count)
{
    struct sf_emitter *emitter = add_emitter(scene, SF_EMITTER_LIST);

    emitter->list = list;
    emitter->list_count = count;
    return emitter;
}

static struct sf_force *add_force(struct sf_scene *scene, int32_t kind, float strength)
{
    struct sf_force *force = &scene->forces[scene->force_count++];

    *force =
        (struct sf_force){.kind = kind, .strength = strength, .scale = 1, .octaves = 1, .axis = {0, 1, 0}, .radius = 1};
    return force;
}

static struct sf_object *add_object(struct sf_scene *scene, int32_t kind, float x, float y, float z)
{
    struct sf_object *object = &scene->objects[scene->object_count++];

    *object = (struct sf_object){.kind = kind,
                                 .position = {x, y, z},
                                 .normal = {0, 1, 0},
                                 .size = {1, 1, 1},
                                 .radius = 0.5f,
                                 .height = 1,
                                 .collide = true};
    return object;
}

static struct sf_particles *start(const struct sf_scene *scene)
{
    struct sf_particles *particles = NULL;

    if (sf_particles_create(kit_device, scene, &kit_log, &particles) != SF_OK)
        fail_msg("%s", kit_record.last);
    return particles;
}

/* `steps` more, so many a frame; gives the last frame's serial. */
static uint64_t advance_steps(struct sf_particles *particles, uint32_t steps, uint32_t per_frame)
{
    uint64_t serial = 0;

    while (steps > 0) {
        if (sf_frame_begin(kit_device) != SF_OK)
            fail_msg("%s", kit_record.last);
        for (uint32_t i = 0; i < per_frame && steps > 0; i++, steps--)
            if (sf_particles_step(particles) != SF_OK)
                fail_msg("%s", kit_record.last);
        if (sf_frame_end(kit_device, &serial) != SF_OK || sf_frame_wait(kit_device, serial) != SF_OK)
            fail_msg("%s", kit_record.last);
    }
    return serial;
}

/* Everything that the device holds. */
struct snapshot {
    struct sf_particle_counts counts;
    struct sf_particle *list; /* counts.live of them */
};

static struct snapshot take(struct sf_particles *particles)
{
    struct snapshot shot = {0};

    assert_int_equal(sf_gpu_buffer_read(sf_particles_counts(particles), 0, &shot.counts, sizeof shot.counts), SF_OK);
    assert_true(shot.counts.live <= sf_particles_capacity(particles));
    shot.list = calloc(shot.counts.live + 1, sizeof *shot.list);
    assert_non_null(shot.list);
    if (shot.counts.live)
        assert_int_equal(
            sf_gpu_buffer_read(sf_particles_list(particles), 0, shot.list, shot.counts.live * sizeof *shot.list),
            SF_OK);
    return shot;
}

/* From the beginning to that step and back. */
static inline struct snapshot run_scene(const struct sf_scene *scene, uint32_t steps)
{
    struct sf_particles *particles = start(scene);
    struct snapshot shot;

    advance_steps(particles, steps, 16);
    shot = take(particles);
    sf_particles_destroy(&particles);
    return shot;
}

static float from_order(uint32_t order)
{
    uint32_t bits = order & 0x80000000u ? order & 0x7fffffffu : ~order;
    float value;

    memcpy(&value, &bits, sizeof value);
    return value;
}

/* What must hold after any step. */
static inline void check(const struct snapshot *shot)
{
    const struct sf_particle_counts *counts = &shot->counts;
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};

    assert_int_equal(counts->births, counts->live + counts->dropped + counts->deaths);
    assert_int_equal(counts->draw[0], 4);
    assert_int_equal(counts->draw[1], counts->live);
    assert_int_equal(counts->dispatch[0], (counts->live + 63) / 64);
    for (uint32_t i = 0; i < counts->live; i++) {
        const struct sf_particle *p = &shot->list[i];
        const float centre[3] = {p->x, p->y, p->z};

        assert_true(i == 0 || p->id > shot->list[i - 1].id); /* in order of birth */
        assert_true(p->extinction >= 0 && p->extinction <= p->extinction0);
        for (int axis = 0; axis < 3; axis++) {
            assert_true(isfinite(centre[axis]));
            low[axis] = fminf(low[axis], centre[axis] - p->radius);
            high[axis] = fmaxf(high[axis], centre[axis] + p->radius);
        }
    }
    for (int axis = 0; axis < 3; axis++) {
        assert_true(counts->live ? from_order(counts->bounds_min[axis]) == low[axis]
                                 : counts->bounds_min[axis] == 0xffffffffu);
        assert_true(counts->live ? from_order(counts->bounds_max[axis]) == high[axis] : counts->bounds_max[axis] == 0);
    }
}

static inline void assert_near(double value, double wanted, double tolerance, const char *what)
{
    if (!(fabs(value - wanted) <= tolerance))
        fail_msg("%s is %.9g, not %.9g within %.2g", what, value, wanted, tolerance);
}

#endif
