#include "sim/obstacle.h"

#include <math.h>
#include <string.h>

static const double RADIANS = 3.14159265358979323846 / 180.0;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* R = Rz Ry Rx takes the object to the world; row i of its inverse is column i of R. */
static void solid_axes(const float rotation[3], double axes[3][3])
{
    double cx = cos(rotation[0] * RADIANS), sx = sin(rotation[0] * RADIANS);
    double cy = cos(rotation[1] * RADIANS), sy = sin(rotation[1] * RADIANS);
    double cz = cos(rotation[2] * RADIANS), sz = sin(rotation[2] * RADIANS);
    const double columns[3][3] = {{cz * cy, sz * cy, -sy},
                                  {cz * sy * sx - sz * cx, sz * sy * sx + cz * cx, cy * sx},
                                  {cz * sy * cx + sz * sx, sz * sy * cx - cz * sx, cy * cx}};

    memcpy(axes, columns, sizeof columns);
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static void normalize(double v[3])
{
    double length = sqrt(dot(v, v));

    for (int i = 0; i < 3; i++)
        v[i] /= length;
}

/* A plane's y is its normal; x and z are the checker's axes (docs/scene.md), the world's own for a level plane. */
static void plane_axes(const float normal[3], double axes[3][3])
{
    for (int i = 0; i < 3; i++)
        axes[1][i] = normal[i];
    normalize(axes[1]);
    const double along[3] = {fabs(axes[1][2]) > 0.9 ? 1 : 0, 0, fabs(axes[1][2]) > 0.9 ? 0 : 1};
    cross(axes[1], along, axes[0]);
    normalize(axes[0]);
    cross(axes[0], axes[1], axes[2]);
}

bool sf_obstacle_collides(const struct sf_object *object)
{
    return object->collide && object->kind != SF_OBJECT_MESH;
}

void sf_obstacle_fill(const struct sf_object *from, struct sf_gpu_object *to)
{
    const double position[3] = {from->position[0], from->position[1], from->position[2]};
    float *rows[3] = {to->row0, to->row1, to->row2};
    double axes[3][3];

    memset(to, 0, sizeof *to);
    if (from->kind == SF_OBJECT_PLANE)
        plane_axes(from->normal, axes);
    else
        solid_axes(from->rotation, axes);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            rows[i][j] = (float)axes[i][j];
        rows[i][3] = (float)-dot(axes[i], position);
    }
    for (int i = 0; i < 3; i++)
        to->shape[i] = from->kind == SF_OBJECT_BOX     ? 0.5f * from->size[i]
                       : from->kind == SF_OBJECT_PLANE ? 0
                       : from->kind == SF_OBJECT_MESH  ? from->scale
                                                       : from->radius;
    if (from->kind == SF_OBJECT_CYLINDER)
        to->shape[1] = 0.5f * from->height;
    to->shape[3] = (float)from->kind;
    to->albedo2[3] = sf_obstacle_collides(from) ? 1.0f : 0.0f;
    to->bounce[0] = from->restitution;
    to->bounce[1] = from->friction;
}
