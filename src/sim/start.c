#include "sim/start.h"

#include <math.h>
#include <string.h>

_Static_assert(sizeof(struct sf_particle) == 64, "glsl/sim/list.glsl reads four words of 16 bytes");
_Static_assert(sizeof(struct sf_particle_counts) == 96, "std430");
_Static_assert(offsetof(struct sf_particle_counts, draw) == SF_COUNTS_DRAW_OFFSET, "std430");
_Static_assert(offsetof(struct sf_particle_counts, dispatch) == SF_COUNTS_DISPATCH_OFFSET, "std430");
_Static_assert(sizeof(struct sf_sim_triangle) == 48, "std430");

static bool listed_at_first(const struct sf_emitter *emitter)
{
    return emitter->kind == SF_EMITTER_LIST && !(emitter->start > 0);
}

void sf_sim_layout_fill(const struct sf_scene *scene, struct sf_sim_layout *layout)
{
    memset(layout, 0, sizeof *layout);
    for (uint32_t i = 0; i < scene->emitter_count; i++) {
        const struct sf_emitter *emitter = &scene->emitters[i];

        layout->triangles[i] = layout->triangle_total;
        layout->listed[i] = layout->listed_total;
        if (emitter->kind == SF_EMITTER_MESH) {
            layout->triangle_counts[i] = scene->meshes[emitter->mesh].index_count / 3;
            layout->triangle_total += layout->triangle_counts[i];
        } else if (listed_at_first(emitter)) {
            layout->first_total += emitter->list_count;
        } else if (emitter->kind == SF_EMITTER_LIST) {
            layout->listed_total += emitter->list_count;
        }
    }
}

/* A listed particle is as stated, bit for bit: no growth, fades or warmth of the emitter's apply to it. */
static void fill_listed(const struct sf_scene *scene, uint32_t emitter_index, uint32_t i, uint32_t id,
                        struct sf_particle *particle)
{
    const struct sf_emitter *emitter = &scene->emitters[emitter_index];
    const struct sf_listed *from = &emitter->list[i];
    float extinction = from->extinction >= 0      ? from->extinction
                       : emitter->extinction >= 0 ? emitter->extinction
                                                  : scene->medium.extinction;

    *particle = (struct sf_particle){
        .x = from->centre[0],
        .y = from->centre[1],
        .z = from->centre[2],
        .radius = from->radius,
        .vx = from->velocity[0],
        .vy = from->velocity[1],
        .vz = from->velocity[2],
        .extinction = extinction,
        .age = from->age,
        .lifetime = from->lifetime,
        .rotation = from->rotation,
        .radius0 = from->radius,
        .extinction0 = extinction,
        .id = id,
        .look = (uint32_t)from->tile | emitter_index << SF_LOOK_EMITTER_SHIFT | (emitter->still ? SF_LOOK_STILL : 0),
    };
}

/* As glsl/lib/order.glsl. */
static uint32_t order_from_float(float value)
{
    uint32_t bits;

    memcpy(&bits, &value, sizeof bits);
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

static void enclose(const struct sf_particle *particle, struct sf_particle_counts *counts)
{
    const float centre[3] = {particle->x, particle->y, particle->z};

    for (int i = 0; i < 3; i++) {
        uint32_t low = order_from_float(centre[i] - particle->radius),
                 high = order_from_float(centre[i] + particle->radius);

        counts->bounds_min[i] = low < counts->bounds_min[i] ? low : counts->bounds_min[i];
        counts->bounds_max[i] = high > counts->bounds_max[i] ? high : counts->bounds_max[i];
    }
}

void sf_sim_first_particles(const struct sf_scene *scene, struct sf_particle *particles,
                            struct sf_particle_counts *counts)
{
    uint32_t live = 0;

    memset(counts, 0, sizeof *counts);
    memset(counts->bounds_min, 0xff, 3 * sizeof *counts->bounds_min);
    for (uint32_t e = 0; e < scene->emitter_count; e++) {
        if (!listed_at_first(&scene->emitters[e]))
            continue;
        for (uint32_t i = 0; i < scene->emitters[e].list_count; i++, live++) {
            fill_listed(scene, e, i, live, &particles[live]);
            enclose(&particles[live], counts);
        }
    }
    counts->live = counts->births = counts->survivors = live;
    counts->capacity = (uint32_t)scene->sim.capacity;
    counts->draw[0] = 4;
    counts->draw[1] = live;
    counts->dispatch[0] = (live + 63) / 64;
    counts->dispatch[1] = counts->dispatch[2] = 1;
}

void sf_sim_listed_particles(const struct sf_scene *scene, struct sf_particle *particles)
{
    uint32_t count = 0;

    for (uint32_t e = 0; e < scene->emitter_count; e++) {
        const struct sf_emitter *emitter = &scene->emitters[e];

        for (uint32_t i = 0; emitter->kind == SF_EMITTER_LIST && !listed_at_first(emitter) && i < emitter->list_count;
             i++)
            fill_listed(scene, e, i, 0, &particles[count++]);
    }
}

/* Edges from the first corner; returns the area. */
static double fill_triangle(const struct sf_mesh *mesh, const uint32_t *corners, struct sf_sim_triangle *triangle)
{
    const float *a = &mesh->positions[3 * (size_t)corners[0]];
    const float *b = &mesh->positions[3 * (size_t)corners[1]], *c = &mesh->positions[3 * (size_t)corners[2]];
    double u[3], v[3], area = 0;

    for (int i = 0; i < 3; i++) {
        u[i] = (double)b[i] - a[i];
        v[i] = (double)c[i] - a[i];
        triangle->edge1[i] = (float)u[i];
        triangle->edge2[i] = (float)v[i];
    }
    triangle->edge1[3] = triangle->edge2[3] = 0;
    triangle->x = a[0];
    triangle->y = a[1];
    triangle->z = a[2];
    for (int i = 0; i < 3; i++) {
        double component = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];

        area += component * component;
    }
    return 0.5 * sqrt(area);
}

enum sf_status sf_sim_triangles(const struct sf_scene *scene, const struct sf_log *log,
                                struct sf_sim_triangle *triangles)
{
    for (uint32_t e = 0; e < scene->emitter_count; e++) {
        const struct sf_emitter *emitter = &scene->emitters[e];
        const struct sf_mesh *mesh = emitter->kind == SF_EMITTER_MESH ? &scene->meshes[emitter->mesh] : NULL;
        uint32_t count = mesh ? mesh->index_count / 3 : 0;
        double total = 0, sum = 0;
        char place[SF_PLACE_BYTES];

        if (!mesh)
            continue;
        for (uint32_t i = 0; i < count; i++)
            total += fill_triangle(mesh, &mesh->indices[3 * (size_t)i], &triangles[i]);
        if (!(total > 0) || !isfinite(total))
            return sf_fail(log, SF_ERROR_SCENE,
                           "%s: %s: the mesh '%s' has no surface to emit from; give one with triangles that "
                           "have an area",
                           scene->path ? scene->path : "scene", sf_emitter_place(scene, e, place),
                           mesh->file ? mesh->file : "");
        for (uint32_t i = 0; i < count; i++) {
            sum += fill_triangle(mesh, &mesh->indices[3 * (size_t)i], &triangles[i]);
            /* Rounding may leave the end below the last word; the search ends at the last triangle anyway. */
            triangles[i].share = (uint32_t)fmin(sum / total * 4294967296.0, 4294967295.0);
        }
        triangles += count;
    }
    return SF_OK;
}
