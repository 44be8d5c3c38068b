/* A step is three passes: count (who lives on), step (move them into the other copy of the list, without gaps), emit
 * (append the newborn; skipped when there are none). glsl/shared/sim.h says how the list is cut up between them. */
#include "sim/particles.h"

#include <stdlib.h>
#include <string.h>

#include "sim/feed.h"
#include "sim/obstacle.h"

enum { EMIT_LANES = 64 };

/* What is made for a scene, and anew for another one. */
struct setup {
    const struct sf_scene *scene;
    struct sf_sim_layout layout;
    struct sf_gpu_buffer *list, *counts, *triangles, *listed;
    struct sf_graph *graph;
    struct sf_plan *plan;
    struct sf_player *player;
    sf_resource now, births; /* uploads */
};

struct sf_particles {
    struct sf_gpu *gpu;
    const struct sf_log *log;
    struct setup setup;
    uint64_t steps;
    uint32_t emit_groups[3]; /* of this step; the plan reads it at each recording */
    struct sf_sim_now now;
    struct sf_sim_births births;
};

/* What of the scene shapes the passes: the lengths of the loops over it, as constants 1 to 4 of the shaders. */
struct extent {
    uint32_t turbulences, vortices, objects, emitters;
};

static struct extent measure(const struct sf_scene *scene)
{
    struct extent extent = {.emitters = scene->emitter_count};

    for (uint32_t i = 0; i < scene->force_count; i++) {
        extent.turbulences += scene->forces[i].kind == SF_FORCE_TURBULENCE;
        extent.vortices += scene->forces[i].kind == SF_FORCE_VORTEX;
    }
    for (uint32_t i = 0; i < scene->object_count; i++)
        extent.objects += sf_obstacle_collides(&scene->objects[i]);
    return extent;
}

/* Workgroups and lanes of the passes over the list. */
struct shape {
    uint32_t groups, lanes;
};

/* On a software device a workgroup is a task for one of few threads, and a subgroup is one vector: so one subgroup a
 * workgroup, and four tasks a thread to even out the load. But lavapipe leaves every loop once an invocation has gone
 * round 65,535 times in all its loops together: a lane must not have more particles than that allows at the worst.
 * Large lists take larger groups, since each adds up the chunks before it. */
static struct shape choose_shape(const struct sf_scene *scene, const struct sf_gpu_tuning *tuning)
{
    const uint32_t rounds = 65535 - 2048; /* less what the rest of a pass goes round */
    struct extent extent = measure(scene);
    struct shape shape = {tuning->workers, 128};
    /* Rounds for one particle: octaves, vortices, and looks at all objects. */
    uint32_t most =
        2 + 10 * extent.turbulences + extent.vortices + (extent.objects ? SF_SIM_TOUCHES * (1 + extent.objects) : 0);
    uint32_t capacity = (uint32_t)scene->sim.capacity, room;

    if (tuning->software) {
        shape = (struct shape){4 * tuning->workers, capacity > 1u << 15 ? 64 : tuning->subgroup_size};
        room = shape.lanes * (rounds / most);
        if (shape.groups < (capacity + room - 1) / room)
            shape.groups = (capacity + room - 1) / room;
    }
    if (shape.lanes > tuning->max_group_invocations)
        shape.lanes = tuning->max_group_invocations;
    return shape;
}

static uint64_t at_least_one(uint32_t count)
{
    return count ? count : 1; /* a binding cannot be empty */
}

static sf_resource import(struct sf_graph *graph, const char *name, uint64_t bytes, bool history)
{
    return sf_graph_buffer(graph, &(struct sf_buffer_desc){
                                      .name = name,
                                      .lifetime = SF_IMPORTED,
                                      .bytes = bytes,
                                      .outside = SF_ACCESS_STORAGE_READ,
                                      .history = history,
                                  });
}

static void declare_passes(const struct sf_scene *scene, struct shape shape, const uint32_t *emit_groups,
                           struct sf_graph *graph)
{
    struct extent extent = measure(scene);
    uint32_t constants[5] = {shape.lanes, extent.turbulences, extent.vortices, extent.objects, extent.emitters};
    struct sf_sim_layout layout;

    sf_sim_layout_fill(scene, &layout);
    sf_resource now = sf_graph_buffer(
        graph, &(struct sf_buffer_desc){.name = "sim.now", .lifetime = SF_UPLOAD, .bytes = sizeof(struct sf_sim_now)});
    sf_resource births = sf_graph_buffer(
        graph,
        &(struct sf_buffer_desc){.name = "sim.births", .lifetime = SF_UPLOAD, .bytes = sizeof(struct sf_sim_births)});
    sf_resource scratch = sf_graph_buffer(
        graph,
        &(struct sf_buffer_desc){.name = "sim.scratch",
                                 .lifetime = SF_TRANSIENT,
                                 .bytes = 4 * (SF_SIM_SCRATCH_CHUNKS + (uint64_t)shape.groups * (1 + shape.lanes))});
    sf_resource list = import(graph, "particles", (uint64_t)scene->sim.capacity * sizeof(struct sf_particle), true);
    sf_resource counts = import(graph, "particles.counts", sizeof(struct sf_particle_counts), false);
    sf_resource triangles =
        import(graph, "sim.triangles", at_least_one(layout.triangle_total) * sizeof(struct sf_sim_triangle), false);
    sf_resource listed =
        import(graph, "sim.listed", at_least_one(layout.listed_total) * sizeof(struct sf_particle), false);
    const struct sf_use count_uses[] = {
        {.resource = now, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = list, .access = SF_ACCESS_STORAGE_READ, .binding = 1, .previous = true},
        {.resource = counts, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 2},
        {.resource = scratch, .access = SF_ACCESS_STORAGE_WRITE, .binding = 3},
    };
    const struct sf_use step_uses[] = {
        {.resource = now, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = list, .access = SF_ACCESS_STORAGE_READ, .binding = 1, .previous = true},
        {.resource = list, .access = SF_ACCESS_STORAGE_WRITE, .binding = 2},
        {.resource = counts, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 3},
        {.resource = scratch, .access = SF_ACCESS_STORAGE_READ, .binding = 4},
        {.resource = births, .access = SF_ACCESS_STORAGE_READ, .binding = 5},
    };
    const struct sf_use emit_uses[] = {
        {.resource = now, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = list, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 1},
        {.resource = counts, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 2},
        {.resource = triangles, .access = SF_ACCESS_STORAGE_READ, .binding = 3},
        {.resource = listed, .access = SF_ACCESS_STORAGE_READ, .binding = 4},
        {.resource = births, .access = SF_ACCESS_STORAGE_READ, .binding = 5},
    };
    struct sf_pass_desc pass = {.kind = SF_PASS_COMPUTE, .constant_count = 5, .groups = {shape.groups, 1, 1}};

    memcpy(pass.constants, constants, sizeof constants);
    pass.name = "sim.step";
    pass.shader = "sim/step.comp";
    pass.uses = step_uses;
    pass.use_count = SF_COUNT(step_uses);
    struct sf_pass_desc count = pass;
    count.name = "sim.count";
    count.shader = "sim/count.comp";
    count.uses = count_uses;
    count.use_count = SF_COUNT(count_uses);
    count.constant_count = 1;
    sf_graph_pass(graph, &count);
    sf_graph_pass(graph, &pass);
    pass.name = "sim.emit";
    pass.shader = "sim/emit.comp";
    pass.uses = emit_uses;
    pass.use_count = SF_COUNT(emit_uses);
    memset(pass.groups, 0, sizeof pass.groups);
    pass.groups_live = emit_groups;
    pass.constants[0] = EMIT_LANES;
    pass.constant_count = 4;
    if (scene->emitter_count > 0)
        sf_graph_pass(graph, &pass);
}

static enum sf_status declare(const struct sf_scene *scene, const struct sf_gpu_tuning *tuning,
                              const uint32_t *emit_groups, const struct sf_log *log, struct sf_graph **graph)
{
    enum sf_status status = sf_graph_create("sim", log, graph);

    if (!status)
        declare_passes(scene, choose_shape(scene, tuning), emit_groups, *graph);
    return status;
}

enum sf_status sf_particles_declare(const struct sf_scene *scene, const struct sf_gpu_tuning *tuning,
                                    const struct sf_log *log, struct sf_graph **graph)
{
    static const uint32_t no_groups[3];

    return declare(scene, tuning, no_groups, log, graph);
}

static enum sf_status check_capacity(const struct sf_particles *particles, const struct setup *setup, bool in_place)
{
    const struct sf_scene *scene = setup->scene;
    const char *path = scene->path ? scene->path : "scene";
    uint64_t capacity = (uint64_t)scene->sim.capacity, used, budget, most;

    if (scene->sim.capacity < 1 || capacity > SF_PARTICLES_MAX)
        return sf_fail(particles->log, SF_ERROR_SCENE, "%s: /sim/capacity: %d particles; it must be 1 to %d", path,
                       scene->sim.capacity, SF_PARTICLES_MAX);
    if (setup->layout.first_total > capacity)
        return sf_fail(particles->log, SF_ERROR_SCENE,
                       "%s: /sim/capacity: %llu particles, but the scene lists %u; raise it to that", path,
                       (unsigned long long)capacity, setup->layout.first_total);
    if (in_place)
        return SF_OK;
    sf_gpu_memory(particles->gpu, &used, &budget);
    most = sf_gpu_info(particles->gpu)->max_storage_bytes / sizeof(struct sf_particle);
    if (used < budget && (budget - used) / (2 * sizeof(struct sf_particle)) < most)
        most = (budget - used) / (2 * sizeof(struct sf_particle));
    if (capacity > most)
        return sf_fail(particles->log, SF_ERROR_SCENE,
                       "%s: /sim/capacity: %llu particles; this device holds %llu at most", path,
                       (unsigned long long)capacity, (unsigned long long)most);
    return SF_OK;
}

/* The buffers that emitters read all along, from a copy made here. */
static enum sf_status create_sources(const struct sf_particles *particles, struct setup *setup)
{
    const struct sf_sim_layout *layout = &setup->layout;
    uint64_t triangle_bytes = at_least_one(layout->triangle_total) * sizeof(struct sf_sim_triangle);
    uint64_t listed_bytes = at_least_one(layout->listed_total) * sizeof(struct sf_particle);
    struct sf_sim_triangle *triangles = calloc(1, triangle_bytes);
    struct sf_particle *listed = calloc(1, listed_bytes);
    enum sf_status status = SF_OK;

    if (!triangles || !listed)
        status = sf_fail(particles->log, SF_ERROR_MEMORY, "no memory for the emitters' meshes and lists");
    if (!status)
        status = sf_sim_triangles(setup->scene, particles->log, triangles);
    if (!status)
        status = sf_gpu_buffer_create(particles->gpu, "sim.triangles", triangle_bytes, false, SF_ACCESS_STORAGE_READ,
                                      triangles, &setup->triangles);
    if (!status) {
        sf_sim_listed_particles(setup->scene, listed);
        status = sf_gpu_buffer_create(particles->gpu, "sim.listed", listed_bytes, false, SF_ACCESS_STORAGE_READ, listed,
                                      &setup->listed);
    }
    free(triangles);
    free(listed);
    return status;
}

static enum sf_status create_list(const struct sf_particles *particles, struct setup *setup)
{
    uint64_t bytes = (uint64_t)setup->scene->sim.capacity * sizeof(struct sf_particle);
    enum sf_status status =
        sf_gpu_buffer_create(particles->gpu, "particles", bytes, true, SF_ACCESS_STORAGE_READ, NULL, &setup->list);

    if (!status)
        status = sf_gpu_buffer_create(particles->gpu, "particles.counts", sizeof(struct sf_particle_counts), false,
                                      SF_ACCESS_STORAGE_READ, NULL, &setup->counts);
    return status;
}

static enum sf_status create_player(const struct sf_particles *particles, struct setup *setup)
{
    const struct sf_gpu_tuning *tuning = sf_gpu_tuning(particles->gpu);
    struct sf_plan_memory memory = {.needs = sf_gpu_memory_needs, .user = particles->gpu};
    enum sf_status status;

    status = declare(setup->scene, tuning, particles->emit_groups, particles->log, &setup->graph);
    if (!status)
        status = sf_plan_create(setup->graph, &memory, particles->log, &setup->plan);
    if (!status)
        status = sf_player_create(particles->gpu, setup->plan, &setup->player);
    if (status)
        return status;
    setup->now = sf_graph_find(setup->graph, "sim.now");
    setup->births = sf_graph_find(setup->graph, "sim.births");
    sf_player_bind_buffer(setup->player, sf_graph_find(setup->graph, "particles"), setup->list);
    sf_player_bind_buffer(setup->player, sf_graph_find(setup->graph, "particles.counts"), setup->counts);
    sf_player_bind_buffer(setup->player, sf_graph_find(setup->graph, "sim.triangles"), setup->triangles);
    sf_player_bind_buffer(setup->player, sf_graph_find(setup->graph, "sim.listed"), setup->listed);
    return SF_OK;
}

/* The list itself serves any scene of the same capacity. */
static bool list_serves(const struct setup *setup, const struct sf_scene *scene)
{
    return setup->list && setup->scene->sim.capacity == scene->sim.capacity;
}

/* All for `scene`; the list in common with the setup in use when it serves. Leaves what it has after a failure. */
static enum sf_status make_setup(const struct sf_particles *particles, const struct sf_scene *scene,
                                 struct setup *setup)
{
    bool in_place = list_serves(&particles->setup, scene);
    enum sf_status status;

    *setup = (struct setup){.scene = scene};
    sf_sim_layout_fill(scene, &setup->layout);
    status = check_capacity(particles, setup, in_place);
    if (!status && in_place) {
        setup->list = particles->setup.list;
        setup->counts = particles->setup.counts;
    } else if (!status) {
        status = create_list(particles, setup);
    }
    if (!status)
        status = create_sources(particles, setup);
    if (!status)
        status = create_player(particles, setup);
    return status;
}

/* Destroys what is not `other`'s. */
static void drop_setup(struct setup *setup, const struct setup *other)
{
    sf_player_destroy(&setup->player);
    sf_plan_destroy(&setup->plan);
    sf_graph_destroy(&setup->graph);
    if (setup->list != other->list)
        sf_gpu_buffer_destroy(&setup->list);
    if (setup->counts != other->counts)
        sf_gpu_buffer_destroy(&setup->counts);
    sf_gpu_buffer_destroy(&setup->triangles);
    sf_gpu_buffer_destroy(&setup->listed);
}

enum sf_status sf_particles_create(struct sf_gpu *gpu, const struct sf_scene *scene, const struct sf_log *log,
                                   struct sf_particles **out)
{
    struct sf_particles *particles = calloc(1, sizeof *particles);
    enum sf_status status;

    *out = NULL;
    if (!particles)
        return sf_fail(log, SF_ERROR_MEMORY, "no memory for the simulation");
    particles->gpu = gpu;
    particles->log = log;
    status = sf_particles_restart(particles, scene);
    if (status)
        sf_particles_destroy(&particles);
    *out = particles;
    return status;
}

void sf_particles_destroy(struct sf_particles **particles)
{
    const struct setup none = {0};

    if (!*particles)
        return;
    drop_setup(&(*particles)->setup, &none);
    free(*particles);
    *particles = NULL;
}

enum sf_status sf_particles_restart(struct sf_particles *particles, const struct sf_scene *scene)
{
    struct setup old = particles->setup, fresh;
    enum sf_status status = make_setup(particles, scene, &fresh);

    if (!status) {
        particles->setup = fresh;
        status = sf_particles_reset(particles);
    }
    if (status) {
        particles->setup = old;
        drop_setup(&fresh, &old);
    } else {
        drop_setup(&old, &fresh);
    }
    return status;
}

void sf_particles_set_scene(struct sf_particles *particles, const struct sf_scene *scene)
{
    particles->setup.scene = scene;
}

enum sf_status sf_particles_reset(struct sf_particles *particles)
{
    const struct setup *setup = &particles->setup;
    uint32_t first = setup->layout.first_total;
    struct sf_particle *list = calloc(at_least_one(first), sizeof *list);
    struct sf_particle_counts counts;
    enum sf_status status = SF_OK;

    if (!list)
        return sf_fail(particles->log, SF_ERROR_MEMORY, "no memory for %u listed particles", first);
    sf_sim_first_particles(setup->scene, list, &counts);
    particles->steps = SF_STEPS_UNKNOWN;
    if (first)
        status = sf_gpu_buffer_write(setup->list, 0, list, first * sizeof *list);
    if (!status)
        status = sf_gpu_buffer_write(setup->counts, 0, &counts, sizeof counts);
    if (!status)
        particles->steps = 0;
    free(list);
    return status;
}

enum sf_status sf_particles_step(struct sf_particles *particles)
{
    const struct setup *setup = &particles->setup;
    void *now = sf_player_upload(setup->player, setup->now), *births = sf_player_upload(setup->player, setup->births);
    size_t bytes;
    enum sf_status status;

    if (!now || !births)
        return sf_fail(
            particles->log, SF_ERROR_INTERNAL,
            "the simulation has nowhere to put step %llu; a step is recorded between sf_frame_begin and sf_frame_end",
            (unsigned long long)particles->steps);
    /* Composed in ordinary memory, since mapped memory may be slow to read. */
    bytes = sf_sim_feed(setup->scene, &setup->layout, particles->steps, &particles->now, &particles->births);
    memcpy(now, &particles->now, bytes);
    memcpy(births, &particles->births,
           offsetof(struct sf_sim_births, records) + particles->now.record_count * sizeof particles->births.records[0]);
    particles->emit_groups[0] = (particles->now.births + EMIT_LANES - 1) / EMIT_LANES;
    particles->emit_groups[1] = particles->emit_groups[2] = 1;
    status = sf_player_play(setup->player);
    if (!status)
        particles->steps++;
    return status;
}

uint64_t sf_particles_steps(const struct sf_particles *particles)
{
    return particles->steps;
}

double sf_particles_dt(const struct sf_particles *particles)
{
    return 1 / sf_sim_step_rate(particles->setup.scene);
}

struct sf_gpu_buffer *sf_particles_list(struct sf_particles *particles)
{
    return particles->setup.list;
}

struct sf_gpu_buffer *sf_particles_counts(struct sf_particles *particles)
{
    return particles->setup.counts;
}

uint32_t sf_particles_capacity(const struct sf_particles *particles)
{
    return (uint32_t)particles->setup.scene->sim.capacity;
}

struct sf_player *sf_particles_player(struct sf_particles *particles)
{
    return particles->setup.player;
}

const struct sf_plan *sf_particles_plan(const struct sf_particles *particles)
{
    return particles->setup.plan;
}
