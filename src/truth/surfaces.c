#include "truth/surfaces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "truth/bvh.h"
#include "truth/vec.h"

struct surface {
    int32_t kind;
    double position[3];
    double axes[3][3]; /* the object's x, y, z in the world; a plane's normal is its y */
    double half[3];    /* box: half edges; cylinder: y is half its height */
    double radius, scale;
    const struct sf_mesh *mesh;
    struct sf_bvh bvh; /* mesh: of its triangles, in the world's axes */
};

struct sf_truth_surfaces {
    struct surface list[SF_OBJECTS_MAX];
    uint32_t count;
};

static const double RADIANS = 3.14159265358979323846 / 180;

/* Column i of R = Rz Ry Rx is where axis i of the object points. */
static void turn(const float rotation[3], double axes[3][3])
{
    for (int i = 0; i < 3; i++) {
        double v[3] = {i == 0, i == 1, i == 2};

        for (int about = 0; about < 3; about++) {
            double c = cos(rotation[about] * RADIANS), s = sin(rotation[about] * RADIANS);
            int j = (about + 1) % 3, k = (about + 2) % 3;
            double a = c * v[j] - s * v[k], b = s * v[j] + c * v[k];

            v[j] = a;
            v[k] = b;
        }
        memcpy(axes[i], v, sizeof v);
    }
}

static void vertex(const struct surface *surface, uint32_t index, double at[3])
{
    const float *from = &surface->mesh->positions[3 * (size_t)index];

    for (int i = 0; i < 3; i++) {
        at[i] = surface->position[i];
        for (int k = 0; k < 3; k++)
            at[i] += surface->scale * from[k] * surface->axes[k][i];
    }
}

static void triangle(const struct surface *surface, uint32_t number, double corners[3][3])
{
    for (int i = 0; i < 3; i++)
        vertex(surface, surface->mesh->indices[3 * (size_t)number + (size_t)i], corners[i]);
}

static enum sf_status mesh_build(struct surface *surface)
{
    uint32_t count = surface->mesh->index_count / 3;
    struct sf_bvh_box *boxes = calloc((size_t)count + 1, sizeof *boxes);
    enum sf_status status;

    if (!boxes)
        return SF_ERROR_MEMORY;
    for (uint32_t n = 0; n < count; n++) {
        double corners[3][3], min[3], max[3];

        triangle(surface, n, corners);
        for (int i = 0; i < 3; i++) {
            min[i] = fmin(corners[0][i], fmin(corners[1][i], corners[2][i]));
            max[i] = fmax(corners[0][i], fmax(corners[1][i], corners[2][i]));
        }
        boxes[n] = sf_bvh_box_of(min, max);
    }
    status = sf_bvh_build(boxes, count, &surface->bvh);
    free(boxes);
    return status;
}

static enum sf_status surface_fill(const struct sf_object *from, const struct sf_scene *scene, struct surface *surface)
{
    surface->kind = from->kind;
    for (int i = 0; i < 3; i++) {
        surface->position[i] = from->position[i];
        surface->half[i] = 0.5 * from->size[i];
    }
    surface->radius = from->radius;
    surface->scale = from->scale;
    if (from->kind == SF_OBJECT_PLANE) {
        for (int i = 0; i < 3; i++)
            surface->axes[1][i] = from->normal[i];
        return SF_OK;
    }
    turn(from->rotation, surface->axes);
    if (from->kind == SF_OBJECT_CYLINDER)
        surface->half[1] = 0.5 * from->height;
    if (from->kind != SF_OBJECT_MESH)
        return SF_OK;
    surface->mesh = &scene->meshes[from->mesh];
    return mesh_build(surface);
}

enum sf_status sf_truth_surfaces_create(const struct sf_scene *scene, const struct sf_log *log,
                                        struct sf_truth_surfaces **out)
{
    struct sf_truth_surfaces *surfaces = calloc(1, sizeof *surfaces);
    enum sf_status status = surfaces ? SF_OK : SF_ERROR_MEMORY;

    *out = NULL;
    for (uint32_t i = 0; i < scene->object_count && status == SF_OK; i++)
        status = surface_fill(&scene->objects[i], scene, &surfaces->list[surfaces->count++]);
    if (status != SF_OK) {
        sf_truth_surfaces_destroy(&surfaces);
        return sf_fail(log, status, "no memory for the reference's copy of the scene's objects");
    }
    *out = surfaces;
    return SF_OK;
}

void sf_truth_surfaces_destroy(struct sf_truth_surfaces **place)
{
    struct sf_truth_surfaces *surfaces = place ? *place : NULL;

    if (!surfaces)
        return;
    for (uint32_t i = 0; i < surfaces->count; i++)
        sf_bvh_finish(&surfaces->list[i].bvh);
    free(surfaces);
    *place = NULL;
}

/* Cuts from..to down to the slab -half <= y <= half. */
static void cut_slab(double y, double slope, double half, double span[2])
{
    double inverse = 1 / (fabs(slope) > 1e-300 ? slope : 1e-300), a = (-half - y) * inverse, b = (half - y) * inverse;

    span[0] = fmax(span[0], fmin(a, b));
    span[1] = fmin(span[1], fmax(a, b));
}

/* Cuts down to the part within `radius` of the origin, in the coordinates that `weight` leaves. */
static void cut_round(const double origin[3], const double direction[3], const double weight[3], double radius,
                      double span[2])
{
    double o[3], d[3], squared, along, room;

    for (int i = 0; i < 3; i++) {
        o[i] = origin[i] * weight[i];
        d[i] = direction[i] * weight[i];
    }
    squared = fmax(vec_dot(d, d), 1e-300);
    along = -vec_dot(o, d) / squared;
    for (int i = 0; i < 3; i++)
        o[i] += along * d[i];
    room = radius * radius - vec_dot(o, o);
    if (room < 0) {
        span[1] = -INFINITY;
        return;
    }
    span[0] = fmax(span[0], along - sqrt(room / squared));
    span[1] = fmin(span[1], along + sqrt(room / squared));
}

/* Where the line enters and leaves a solid; the entry is the greater on a miss. */
static void solid_span(const struct surface *solid, const double origin[3], const double direction[3], double span[2])
{
    static const double ball[3] = {1, 1, 1}, column[3] = {1, 0, 1};
    double way[3] = {origin[0] - solid->position[0], origin[1] - solid->position[1], origin[2] - solid->position[2]};
    double o[3], d[3];

    for (int i = 0; i < 3; i++) {
        o[i] = vec_dot(solid->axes[i], way);
        d[i] = vec_dot(solid->axes[i], direction);
    }
    span[0] = -INFINITY;
    span[1] = INFINITY;
    if (solid->kind != SF_OBJECT_BOX)
        cut_round(o, d, solid->kind == SF_OBJECT_SPHERE ? ball : column, solid->radius, span);
    for (int i = 0; i < 3; i++) {
        if (solid->kind == SF_OBJECT_BOX || (solid->kind == SF_OBJECT_CYLINDER && i == 1))
            cut_slab(o[i], d[i], solid->half[i], span);
    }
}

/* Moeller and Trumbore 1997; both sides. INFINITY on a miss. */
static double triangle_distance(double corners[3][3], const double origin[3], const double direction[3])
{
    double a[3], b[3], s[3], p[3], q[3], volume, u, v;

    for (int i = 0; i < 3; i++) {
        a[i] = corners[1][i] - corners[0][i];
        b[i] = corners[2][i] - corners[0][i];
        s[i] = origin[i] - corners[0][i];
    }
    vec_cross(direction, b, p);
    volume = vec_dot(a, p);
    if (volume == 0)
        return INFINITY;
    u = vec_dot(s, p) / volume;
    vec_cross(s, a, q);
    v = vec_dot(direction, q) / volume;
    return u >= 0 && v >= 0 && u + v <= 1 ? vec_dot(b, q) / volume : INFINITY;
}

static double mesh_distance(const struct surface *mesh, const double origin[3], const double direction[3], double from,
                            double to)
{
    const struct sf_bvh_node *leaf;
    struct sf_bvh_walk walk;
    double first = INFINITY;

    sf_bvh_begin(&walk, &mesh->bvh, origin, direction, from, to);
    while ((leaf = sf_bvh_next(&walk, &mesh->bvh))) {
        for (uint32_t i = leaf->first; i < leaf->first + leaf->count; i++) {
            double corners[3][3], t;

            triangle(mesh, mesh->bvh.order[i], corners);
            t = triangle_distance(corners, origin, direction);
            if (t >= from && t < first)
                walk.to = fmin(walk.to, first = t);
        }
    }
    return first;
}

/* The first crossing with t >= from. Meshes are looked for up to `to` alone. */
static double surface_distance(const struct surface *surface, const double origin[3], const double direction[3],
                               double from, double to)
{
    double span[2];

    if (surface->kind == SF_OBJECT_MESH)
        return mesh_distance(surface, origin, direction, from, to);
    if (surface->kind == SF_OBJECT_PLANE) {
        double way[3] = {surface->position[0] - origin[0], surface->position[1] - origin[1],
                         surface->position[2] - origin[2]};
        double t = vec_dot(surface->axes[1], way) / vec_dot(surface->axes[1], direction);

        return t >= from ? t : INFINITY; /* not a number when the ray runs along it: none either */
    }
    solid_span(surface, origin, direction, span);
    if (span[0] > span[1])
        return INFINITY;
    return span[0] >= from ? span[0] : span[1] >= from ? span[1] : INFINITY;
}

double sf_truth_first_surface(const struct sf_truth_surfaces *surfaces, const double origin[3],
                              const double direction[3], double from)
{
    double first = INFINITY;

    for (uint32_t i = 0; i < surfaces->count; i++)
        first = fmin(first, surface_distance(&surfaces->list[i], origin, direction, from, first));
    return first;
}

bool sf_truth_hidden(const struct sf_truth_surfaces *surfaces, const double origin[3], const double direction[3],
                     double to)
{
    for (uint32_t i = 0; i < surfaces->count; i++) {
        const struct surface *surface = &surfaces->list[i];

        if (surface->kind != SF_OBJECT_PLANE && surface_distance(surface, origin, direction, 0, to) < to)
            return true;
    }
    return false;
}

bool sf_truth_casts(const struct sf_truth_surfaces *surfaces)
{
    bool casts = false;

    for (uint32_t i = 0; i < surfaces->count; i++)
        casts = casts || surfaces->list[i].kind != SF_OBJECT_PLANE;
    return casts;
}
