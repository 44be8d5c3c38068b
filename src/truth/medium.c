#include "truth/medium.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "truth/bvh.h"
#include "truth/vec.h"

struct ball { /* 64 bytes */
    double centre[3], squared, extinction;
    double albedo[3];
};

struct sf_truth_particles {
    struct ball *balls; /* in the order of the hierarchy's leaves; none without extinction or radius */
    struct sf_bvh bvh;
    double g, emission[3];
    double min[3], max[3];
};

bool sf_truth_distances_add(struct sf_truth_distances *list, double value)
{
    if (!sf_array_reserve((void **)&list->values, list->count, &list->capacity, 1, sizeof *list->values))
        return false;
    list->values[list->count++] = value;
    return true;
}

void sf_truth_ramp(const struct sf_scene *scene, double life, double rgb[3])
{
    const struct sf_ramp_key *keys = scene->ramp;
    uint32_t count = scene->ramp_count, next = 0;

    while (next < count && keys[next].at < life)
        next++;
    const struct sf_ramp_key *a = &keys[next > 0 ? next - 1 : 0], *b = &keys[next < count ? next : count - 1];
    for (int i = 0; i < 3; i++) {
        double span = count > 0 ? (double)b->at - a->at : 0, share = span > 0 ? (life - a->at) / span : 0;

        rgb[i] = count > 0 ? a->color[i] + share * ((double)b->color[i] - a->color[i]) : 1;
    }
}

/* Where the line passes the ball, as distances from its origin; false on a miss. `direction` is a unit vector. From the
 * point that comes closest to the centre: b^2 - 4ac loses the chord of small spheres far away. */
static bool ball_span(const struct ball *ball, const double origin[3], const double direction[3], double span[2])
{
    double way[3], along, room;

    for (int i = 0; i < 3; i++)
        way[i] = ball->centre[i] - origin[i];
    along = vec_dot(way, direction);
    for (int i = 0; i < 3; i++)
        way[i] -= along * direction[i];
    room = ball->squared - vec_dot(way, way);
    if (!(room > 0))
        return false;
    span[0] = along - sqrt(room);
    span[1] = along + sqrt(room);
    return true;
}

static double particles_depth(const void *self, const double a[3], const double b[3])
{
    const struct sf_truth_particles *particles = self;
    double direction[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, length = vec_normalize(direction), sum = 0;
    const struct sf_bvh_node *leaf;
    struct sf_bvh_walk walk;

    if (!(length > 0))
        return 0;
    sf_bvh_begin(&walk, &particles->bvh, a, direction, 0, length);
    while ((leaf = sf_bvh_next(&walk, &particles->bvh))) {
        for (uint32_t i = leaf->first; i < leaf->first + leaf->count; i++) {
            double span[2];

            if (!ball_span(&particles->balls[i], a, direction, span))
                continue;
            double from = fmax(span[0], 0), to = fmin(span[1], length);
            if (to > from)
                sum += particles->balls[i].extinction * (to - from);
        }
    }
    return sum;
}

static void particles_at(const void *self, const double x[3], struct sf_truth_point *point)
{
    static const double nowhere[3] = {0, 0, 0};
    const struct sf_truth_particles *particles = self;
    const struct sf_bvh_node *leaf;
    struct sf_bvh_walk walk;

    memset(point, 0, sizeof *point);
    /* A ray of no length: the boxes that hold its origin. */
    sf_bvh_begin(&walk, &particles->bvh, x, nowhere, 0, 0);
    while ((leaf = sf_bvh_next(&walk, &particles->bvh))) {
        for (uint32_t i = leaf->first; i < leaf->first + leaf->count; i++) {
            const struct ball *ball = &particles->balls[i];
            double way[3] = {x[0] - ball->centre[0], x[1] - ball->centre[1], x[2] - ball->centre[2]};

            if (vec_dot(way, way) >= ball->squared)
                continue;
            point->extinction += ball->extinction;
            for (int c = 0; c < 3; c++)
                point->scattering[c] += ball->extinction * ball->albedo[c];
        }
    }
    for (int c = 0; c < 3; c++)
        point->emission[c] = point->extinction * particles->emission[c];
}

static bool particles_breakpoints(const void *self, const double origin[3], const double direction[3], double from,
                                  double to, struct sf_truth_distances *list)
{
    const struct sf_truth_particles *particles = self;
    double unit[3] = {direction[0], direction[1], direction[2]}, length = vec_normalize(unit);
    const struct sf_bvh_node *leaf;
    struct sf_bvh_walk walk;

    sf_bvh_begin(&walk, &particles->bvh, origin, direction, from, to);
    while ((leaf = sf_bvh_next(&walk, &particles->bvh))) {
        for (uint32_t i = leaf->first; i < leaf->first + leaf->count; i++) {
            double span[2];

            if (!ball_span(&particles->balls[i], origin, unit, span))
                continue;
            for (int k = 0; k < 2; k++) {
                double t = span[k] / length;

                if (t > from && t < to && !sf_truth_distances_add(list, t))
                    return false;
            }
        }
    }
    return true;
}

/* As if all spheres that touch the box did so in one point. */
static double particles_bound(const void *self, const double min[3], const double max[3])
{
    const struct sf_truth_particles *particles = self;
    uint32_t stack[SF_BVH_DEPTH], waiting = 0;
    double sum = 0;

    if (particles->bvh.node_count > 0)
        stack[waiting++] = 0;
    while (waiting > 0) {
        uint32_t number = stack[--waiting];
        const struct sf_bvh_node *node = &particles->bvh.nodes[number];
        bool apart = false;

        for (int i = 0; i < 3; i++)
            apart = apart || node->box.min[i] > max[i] || node->box.max[i] < min[i];
        if (apart)
            continue;
        if (node->count == 0) {
            stack[waiting++] = node->first;
            stack[waiting++] = number + 1;
        }
        for (uint32_t i = node->first; i < node->first + node->count; i++) {
            const struct ball *ball = &particles->balls[i];
            double away = 0;

            for (int k = 0; k < 3; k++) {
                double gap = fmax(fmax(min[k] - ball->centre[k], ball->centre[k] - max[k]), 0);

                away += gap * gap;
            }
            /* A little more than the sphere, for what rounding puts on the wrong side. */
            if (away <= ball->squared * (1 + 1e-12))
                sum += ball->extinction;
        }
    }
    return sum;
}

static bool particle_fits(const struct sf_particle *particle)
{
    const float values[] = {particle->x,          particle->y,   particle->z,       particle->radius,
                            particle->extinction, particle->age, particle->lifetime};
    bool fits = particle->radius >= 0 && particle->extinction >= 0;

    for (size_t i = 0; i < SF_COUNT(values); i++)
        fits = fits && isfinite(values[i]);
    return fits;
}

static void ball_fill(const struct sf_particle *from, const struct sf_scene *scene, struct ball *ball)
{
    double life = from->lifetime > 0 ? (double)from->age / from->lifetime : 0, tint[3];

    ball->centre[0] = from->x;
    ball->centre[1] = from->y;
    ball->centre[2] = from->z;
    ball->squared = (double)from->radius * from->radius;
    ball->extinction = from->extinction;
    sf_truth_ramp(scene, life, tint);
    for (int c = 0; c < 3; c++)
        ball->albedo[c] = scene->medium.albedo[c] * tint[c];
}

/* `boxes` and `from` have room for all: the boxes of those that matter, and which they are. */
static uint32_t gather(struct sf_truth_particles *particles, const struct sf_particle *list, uint32_t count,
                       struct sf_bvh_box *boxes, uint32_t *from)
{
    uint32_t kept = 0;

    for (uint32_t k = 0; k < count; k++) {
        const double centre[3] = {list[k].x, list[k].y, list[k].z}, radius = list[k].radius;
        double min[3], max[3];

        for (int i = 0; i < 3; i++) {
            min[i] = centre[i] - radius;
            max[i] = centre[i] + radius;
            particles->min[i] = fmin(particles->min[i], min[i]);
            particles->max[i] = fmax(particles->max[i], max[i]);
        }
        if (list[k].radius > 0 && list[k].extinction > 0) {
            boxes[kept] = sf_bvh_box_of(min, max);
            from[kept++] = k;
        }
    }
    return kept;
}

enum sf_status sf_truth_particles_create(const struct sf_particle *list, uint32_t count, const struct sf_scene *scene,
                                         const struct sf_log *log, struct sf_truth_particles **out)
{
    struct sf_truth_particles *particles = calloc(1, sizeof *particles);
    struct sf_bvh_box *boxes = calloc((size_t)count + 1, sizeof *boxes);
    uint32_t *from = malloc(((size_t)count + 1) * sizeof *from), kept;
    enum sf_status status = SF_ERROR_MEMORY;

    *out = NULL;
    if (!particles || !boxes || !from)
        goto end;
    for (uint32_t i = 0; i < count; i++) {
        if (!particle_fits(&list[i])) {
            status = sf_fail(log, SF_ERROR_SCENE,
                             "particle %u has a value that is not finite, or a radius or an extinction below 0", i);
            goto end;
        }
    }
    particles->g = scene->medium.g;
    for (int i = 0; i < 3; i++) {
        particles->emission[i] = scene->medium.emission[i];
        particles->min[i] = INFINITY;
        particles->max[i] = -INFINITY;
    }
    kept = gather(particles, list, count, boxes, from);
    particles->balls = malloc(((size_t)kept + 1) * sizeof *particles->balls);
    if (!particles->balls)
        goto end;
    status = sf_bvh_build(boxes, kept, &particles->bvh);
    for (uint32_t i = 0; i < kept && status == SF_OK; i++)
        ball_fill(&list[from[particles->bvh.order[i]]], scene, &particles->balls[i]);

end:
    free(boxes);
    free(from);
    if (status == SF_ERROR_MEMORY)
        sf_fail(log, status, "no memory for the reference's copy of %u particles", count);
    if (status != SF_OK)
        sf_truth_particles_destroy(&particles);
    *out = particles;
    return status;
}

void sf_truth_particles_destroy(struct sf_truth_particles **place)
{
    struct sf_truth_particles *particles = place ? *place : NULL;

    if (!particles)
        return;
    sf_bvh_finish(&particles->bvh);
    free(particles->balls);
    free(particles);
    *place = NULL;
}

void sf_truth_particles_medium(const struct sf_truth_particles *particles, struct sf_truth_medium *medium)
{
    memset(medium, 0, sizeof *medium);
    medium->self = particles;
    medium->g = particles->g;
    memcpy(medium->min, particles->min, sizeof medium->min);
    memcpy(medium->max, particles->max, sizeof medium->max);
    medium->optical_depth = particles_depth;
    medium->at = particles_at;
    medium->breakpoints = particles_breakpoints;
    medium->bound = particles_bound;
}
