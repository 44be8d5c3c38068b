/* Normals for meshes that come without. At each corner of a triangle: the mean of the normals of the triangles around
 * its point that are turned by less than 60 degrees against it, weighted by the angle that each has there (so that it
 * does not matter how a polygon was cut). Vertices are split where corners disagree, and shared where they do not.
 *
 * Points are told apart by the bits of their coordinates, so that it does not matter how the file shared its vertices.
 */
#include <stdlib.h>
#include <string.h>
#include "base/hash.h"
#include "scene/mesh.h"
#include "scene/vector.h"

enum {
    CROWD = 64,
    NONE = UINT32_MAX
}; /* around a point with more triangles all count, or the work would grow with the square */
static const double FOLD_COSINE = 0.5, SAME_COSINE = 0.99999;

struct shape {
    const struct sf_mesh *mesh;
    uint32_t triangles;
    uint32_t *point;  /* of each vertex: the first vertex at the same place */
    float *facing;    /* [triangles][3]: unit normals; 0 of those without an area */
    float *angles;    /* of each corner, rad */
    uint32_t *starts; /* [vertex_count + 1]: where a point's corners begin in `corners` */
    uint32_t *corners;
    uint32_t *first, *next; /* of each point, of each new vertex: the next new vertex of the same point */
    uint32_t *source;       /* of each new vertex: the old one */
    float *normals;         /* of each new vertex */
    uint32_t count;         /* new vertices */
    uint32_t *indices;      /* of the triangles, into the new vertices */
};

static const float *position_of(const struct shape *shape, uint32_t vertex)
{
    return shape->mesh->positions + (size_t)vertex * 3;
}

static bool same_place(const float a[3], const float b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* False when memory is out. */
static bool find_points(struct shape *shape)
{
    uint32_t slots = 16, count = shape->mesh->vertex_count;
    uint32_t *table;

    while (slots / 2 < count)
        slots *= 2;
    if (!(table = malloc(slots * sizeof *table)))
        return false;
    memset(table, 0xff, slots * sizeof *table);
    for (uint32_t v = 0; v < count; v++) {
        const float *position = position_of(shape, v);
        float key[3] = {position[0] + 0.0f, position[1] + 0.0f, position[2] + 0.0f}; /* -0 becomes 0 */
        uint32_t slot = (uint32_t)sf_hash_bytes(key, sizeof key, 0) & (slots - 1);

        while (table[slot] != NONE && !same_place(position_of(shape, table[slot]), position))
            slot = (slot + 1) & (slots - 1);
        if (table[slot] == NONE)
            table[slot] = v;
        shape->point[v] = table[slot];
    }
    free(table);
    return true;
}

/* The corners of each point, one point after the other, in the order of the triangles. */
static void gather_corners(struct shape *shape)
{
    const uint32_t *indices = shape->mesh->indices;
    uint32_t total = shape->mesh->index_count, count = shape->mesh->vertex_count;

    for (uint32_t c = 0; c < total; c++)
        shape->starts[shape->point[indices[c]] + 1]++;
    for (uint32_t v = 0; v < count; v++)
        shape->starts[v + 1] += shape->starts[v];
    for (uint32_t c = 0; c < total; c++)
        shape->corners[shape->starts[shape->point[indices[c]]]++] = c;
    /* Each start has moved to its end, which is the next one's start. */
    memmove(shape->starts + 1, shape->starts, count * sizeof *shape->starts);
    shape->starts[0] = 0;
}

static void measure_triangles(struct shape *shape)
{
    for (uint32_t t = 0; t < shape->triangles; t++) {
        const uint32_t *corner = shape->mesh->indices + (size_t)t * 3;
        float edges[3][3]; /* from each corner to the next */

        for (int k = 0; k < 3; k++)
            sf_subtract(position_of(shape, corner[(k + 1) % 3]), position_of(shape, corner[k]), edges[k]);
        sf_cross(edges[0], edges[1], shape->facing + (size_t)t * 3);
        if (!sf_normalize(shape->facing + (size_t)t * 3))
            memset(shape->facing + (size_t)t * 3, 0, 3 * sizeof *shape->facing);
        for (int k = 0; k < 3; k++) {
            const float *ahead = edges[k], *behind = edges[(k + 2) % 3];
            double lengths = sf_length(ahead) * sf_length(behind);

            shape->angles[(size_t)t * 3 + k] =
                lengths > 0 ? (float)acos(fmin(fmax(-sf_dot(ahead, behind) / lengths, -1), 1)) : 0;
        }
    }
}

static void corner_normal(const struct shape *shape, uint32_t corner, float normal[3])
{
    uint32_t point = shape->point[shape->mesh->indices[corner]];
    uint32_t begin = shape->starts[point], end = shape->starts[point + 1];
    const float *own = shape->facing + (size_t)(corner / 3) * 3;
    double sum[3] = {0};

    for (uint32_t i = begin; i < end; i++) {
        const float *other = shape->facing + (size_t)(shape->corners[i] / 3) * 3;

        if (end - begin <= CROWD && sf_dot(own, other) < FOLD_COSINE)
            continue;
        for (int axis = 0; axis < 3; axis++)
            sum[axis] += (double)shape->angles[shape->corners[i]] * other[axis];
    }
    for (int axis = 0; axis < 3; axis++)
        normal[axis] = (float)sum[axis];
    if (!sf_normalize(normal)) { /* triangles without an area */
        normal[0] = normal[2] = 0;
        normal[1] = 1;
    }
}

/* The new vertex of the corner: one of its point with that normal, or another. */
static uint32_t find_vertex(struct shape *shape, uint32_t corner)
{
    uint32_t vertex = shape->mesh->indices[corner], point = shape->point[vertex], found;
    float normal[3];

    corner_normal(shape, corner, normal);
    for (found = shape->first[point]; found != NONE; found = shape->next[found])
        if (sf_dot(shape->normals + (size_t)found * 3, normal) > SAME_COSINE)
            return found;
    found = shape->count++;
    shape->next[found] = shape->first[point];
    shape->first[point] = found;
    shape->source[found] = vertex;
    memcpy(shape->normals + (size_t)found * 3, normal, sizeof normal);
    return found;
}

static bool prepare(struct shape *shape)
{
    size_t vertices = shape->mesh->vertex_count, corners = shape->mesh->index_count;

    shape->point = malloc(vertices * sizeof *shape->point);
    shape->facing = malloc(corners * sizeof *shape->facing);
    shape->angles = malloc(corners * sizeof *shape->angles);
    shape->starts = calloc(vertices + 2, sizeof *shape->starts);
    shape->corners = malloc(corners * sizeof *shape->corners);
    shape->first = malloc(vertices * sizeof *shape->first);
    shape->next = malloc(corners * sizeof *shape->next);
    shape->source = malloc(corners * sizeof *shape->source);
    shape->normals = malloc(corners * 3 * sizeof *shape->normals);
    shape->indices = malloc(corners * sizeof *shape->indices);
    if (!shape->point || !shape->facing || !shape->angles || !shape->starts || !shape->corners || !shape->first ||
        !shape->next || !shape->source || !shape->normals || !shape->indices)
        return false;
    memset(shape->first, 0xff, vertices * sizeof *shape->first);
    return find_points(shape);
}

static void finish(struct shape *shape)
{
    free(shape->point);
    free(shape->facing);
    free(shape->angles);
    free(shape->starts);
    free(shape->corners);
    free(shape->first);
    free(shape->next);
    free(shape->source);
    free(shape->normals);
    free(shape->indices);
}

bool sf_mesh_make_normals(struct sf_mesh *mesh, struct sf_arena *arena)
{
    struct shape shape = {.mesh = mesh, .triangles = mesh->index_count / 3};
    float *positions, *normals;
    bool done = false;

    if (!prepare(&shape))
        goto end;
    gather_corners(&shape);
    measure_triangles(&shape);
    for (uint32_t corner = 0; corner < mesh->index_count; corner++)
        shape.indices[corner] = find_vertex(&shape, corner);
    positions = sf_arena_alloc(arena, (size_t)shape.count * 3 * sizeof *positions);
    normals = sf_arena_alloc(arena, (size_t)shape.count * 3 * sizeof *normals);
    if (!positions || !normals)
        goto end;
    for (uint32_t v = 0; v < shape.count; v++)
        memcpy(positions + (size_t)v * 3, position_of(&shape, shape.source[v]), 3 * sizeof *positions);
    memcpy(normals, shape.normals, (size_t)shape.count * 3 * sizeof *normals);
    memcpy(mesh->indices, shape.indices, (size_t)mesh->index_count * sizeof *mesh->indices);
    mesh->positions = positions;
    mesh->normals = normals;
    mesh->vertex_count = shape.count;
    done = true;
end:
    finish(&shape);
    return done;
}
