/* The picture of a scene's objects, computed by the CPU in double precision after docs/scene.md: a second opinion for
 * tests. */
#ifndef SF_TESTS_SCENE_TWIN_H
#define SF_TESTS_SCENE_TWIN_H

#include <math.h>
#include <stdbool.h>
#include <string.h>
#include "scene/environment.h"
#include "scene/scene.h"

struct twin_hit {
    int object; /* index into the scene's, -1: none */
    double t;   /* along the ray, in units of its direction */
    double normal[3];
};

static inline double twin_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void twin_cross(const double a[3], const double b[3], double to[3])
{
    to[0] = a[1] * b[2] - a[2] * b[1];
    to[1] = a[2] * b[0] - a[0] * b[2];
    to[2] = a[0] * b[1] - a[1] * b[0];
}

static inline void twin_normalize(double v[3])
{
    double length = sqrt(twin_dot(v, v));

    for (int i = 0; i < 3; i++)
        v[i] /= length;
}

/* R v or its inverse, R = Rz Ry Rx. */
static inline void twin_turn(const float degrees[3], bool back, double v[3])
{
    for (int step = 0; step < 3; step++) {
        int axis = back ? 2 - step : step, a = (axis + 1) % 3, b = (axis + 2) % 3;
        double angle = degrees[axis] * 3.14159265358979323846 / 180 * (back ? -1 : 1);
        double x = cos(angle) * v[a] - sin(angle) * v[b], y = sin(angle) * v[a] + cos(angle) * v[b];
        v[a] = x;
        v[b] = y;
    }
}

/* Keeps `t` when it is the first beyond `least` so far. */
static inline void twin_offer(struct twin_hit *hit, int object, double t, double least, const double normal[3])
{
    if (t < least || (hit->object >= 0 && t >= hit->t))
        return;
    hit->object = object;
    hit->t = t;
    memcpy(hit->normal, normal, sizeof hit->normal);
}

/* All crossings of the line with the object's surface, offered; in the object's space but for planes. */
static inline void twin_meet(const struct sf_object *object, int index, const double from[3], const double way[3],
                             double least, struct twin_hit *hit)
{
    double normal[3] = {0};

    if (object->kind == SF_OBJECT_PLANE) {
        double apart = 0, slope = 0;
        for (int i = 0; i < 3; i++) {
            normal[i] = object->normal[i];
            apart += normal[i] * (object->position[i] - from[i]);
            slope += normal[i] * way[i];
        }
        if (slope != 0)
            twin_offer(hit, index, apart / slope, least, normal);
    } else if (object->kind == SF_OBJECT_SPHERE) {
        double a = twin_dot(way, way), b = twin_dot(from, way),
               c = twin_dot(from, from) - (double)object->radius * object->radius;
        for (int end = -1; end <= 1 && b * b >= a * c; end += 2) {
            double t = (-b + end * sqrt(b * b - a * c)) / a;
            for (int i = 0; i < 3; i++)
                normal[i] = (from[i] + t * way[i]) / object->radius;
            twin_offer(hit, index, t, least, normal);
        }
    } else {
        bool box = object->kind == SF_OBJECT_BOX;
        double half[3] = {object->size[0] / 2.0, box ? object->size[1] / 2.0 : object->height / 2.0,
                          object->size[2] / 2.0};
        for (int axis = box ? 0 : 1; axis < (box ? 3 : 2); axis++) {
            for (int side = -1; side <= 1 && way[axis] != 0; side += 2) {
                double t = (side * half[axis] - from[axis]) / way[axis], at[3];
                for (int i = 0; i < 3; i++) {
                    at[i] = from[i] + t * way[i];
                    normal[i] = i == axis ? side : 0;
                }
                int b = (axis + 1) % 3, c = (axis + 2) % 3;
                bool inside = box ? fabs(at[b]) <= half[b] && fabs(at[c]) <= half[c]
                                  : at[b] * at[b] + at[c] * at[c] <= (double)object->radius * object->radius;
                if (inside)
                    twin_offer(hit, index, t, least, normal);
            }
        }
        double a = way[0] * way[0] + way[2] * way[2], b = from[0] * way[0] + from[2] * way[2];
        double c = from[0] * from[0] + from[2] * from[2] - (double)object->radius * object->radius;
        for (int end = -1; !box && end <= 1 && a > 0 && b * b >= a * c; end += 2) {
            double t = (-b + end * sqrt(b * b - a * c)) / a;
            normal[0] = (from[0] + t * way[0]) / object->radius;
            normal[1] = 0;
            normal[2] = (from[2] + t * way[2]) / object->radius;
            if (fabs(from[1] + t * way[1]) <= half[1])
                twin_offer(hit, index, t, least, normal);
        }
    }
}

/* The first surface at or beyond `least`. */
static inline struct twin_hit twin_trace(const struct sf_scene *scene, const double from[3], const double way[3],
                                         double least, bool finite_only)
{
    struct twin_hit first = {.object = -1};

    for (uint32_t i = 0; i < scene->object_count; i++) {
        const struct sf_object *object = &scene->objects[i];
        struct twin_hit hit = {.object = -1};
        double local_from[3], local_way[3];
        if (finite_only && object->kind == SF_OBJECT_PLANE)
            continue;
        bool plane = object->kind == SF_OBJECT_PLANE;
        for (int k = 0; k < 3; k++) {
            local_from[k] = plane ? from[k] : from[k] - object->position[k];
            local_way[k] = way[k];
        }
        if (!plane) {
            twin_turn(object->rotation, true, local_from);
            twin_turn(object->rotation, true, local_way);
        }
        twin_meet(object, (int)i, local_from, local_way, least, &hit);
        if (hit.object < 0 || (first.object >= 0 && hit.t >= first.t))
            continue;
        if (!plane)
            twin_turn(object->rotation, false, hit.normal);
        first = hit;
    }
    return first;
}

/* The eye and the direction of unit depth through picture coordinates (column + 1/2 and row + 1/2 are a pixel's
 * middle). */
static inline void twin_ray(const struct sf_scene *scene, double time, uint32_t width, uint32_t height, double column,
                            double row, double eye[3], double way[3])
{
    struct sf_camera_pose pose;
    double forward[3], up[3], right[3], tangent;

    sf_scene_camera(scene, time, &pose);
    for (int i = 0; i < 3; i++) {
        eye[i] = pose.eye[i];
        forward[i] = (double)pose.target[i] - pose.eye[i];
        up[i] = pose.up[i];
    }
    twin_normalize(forward);
    twin_cross(forward, up, right);
    twin_normalize(right);
    twin_cross(right, forward, up);
    tangent = tan(pose.fov * 3.14159265358979323846 / 360);
    for (int i = 0; i < 3; i++)
        way[i] = forward[i] + (2 * column / width - 1) * tangent * width / height * right[i] +
                 (1 - 2 * row / height) * tangent * up[i];
}

/* Irradiance at `x` of a surface facing light `index`, and the way to it. */
static inline void twin_light(const struct sf_light *light, const double x[3], double irradiance[3], double to[3],
                              double *distance)
{
    double strength = light->intensity;

    *distance = INFINITY;
    for (int i = 0; i < 3; i++)
        to[i] = light->kind == SF_LIGHT_DIRECTIONAL ? -(double)light->direction[i] : light->position[i] - x[i];
    if (light->kind != SF_LIGHT_DIRECTIONAL) {
        *distance = sqrt(twin_dot(to, to));
        strength /= twin_dot(to, to);
    }
    twin_normalize(to);
    if (light->kind == SF_LIGHT_SPOT) {
        double aim[3] = {light->direction[0], light->direction[1], light->direction[2]};
        double outer = cos(light->outer * 3.14159265358979323846 / 180),
               inner = cos(light->inner * 3.14159265358979323846 / 180);
        double part = fmin(fmax((-twin_dot(to, aim) - outer) / (inner - outer), 0), 1);
        strength *= part * part * (3 - 2 * part);
    }
    for (int i = 0; i < 3; i++)
        irradiance[i] = strength * light->color[i];
}

/* Is the light's way to a surface point free of finite objects? */
static inline bool twin_lit(const struct sf_scene *scene, const struct sf_light *light, const double x[3],
                            const double normal[3])
{
    double irradiance[3], to[3], distance, start[3];

    twin_light(light, x, irradiance, to, &distance);
    for (int i = 0; i < 3; i++)
        start[i] = x[i] + 1e-5 * normal[i];
    struct twin_hit hit = twin_trace(scene, start, to, 0, true);
    return hit.object < 0 || hit.t > distance;
}

static inline double twin_square_wave(double at, double width)
{
    double wide = fmax(width, 1e-3), low = 0.5 * at - 0.25 * wide, high = 0.5 * at + 0.25 * wide;

    return 2 * (fabs(low - floor(low) - 0.5) - fabs(high - floor(high) - 0.5)) / wide;
}

/* A plane's coordinates in squares of its checker. */
static inline void twin_squares(const struct sf_object *plane, const double x[3], double squares[2])
{
    double normal[3] = {plane->normal[0], plane->normal[1], plane->normal[2]}, from[3], u[3], v[3];
    const double e[3] = {fabs(normal[2]) > 0.9, 0, !(fabs(normal[2]) > 0.9)};

    for (int i = 0; i < 3; i++)
        from[i] = x[i] - plane->position[i];
    twin_cross(normal, e, u);
    twin_normalize(u);
    twin_cross(u, normal, v);
    squares[0] = twin_dot(u, from) / plane->checker;
    squares[1] = twin_dot(v, from) / plane->checker;
}

/* Albedo at a hit, the checker averaged over the box of the pixel's footprint. */
static inline void twin_albedo(const struct sf_scene *scene, uint32_t width, uint32_t height, double column, double row,
                               const struct twin_hit *hit, double albedo[3])
{
    const struct sf_object *object = &scene->objects[hit->object];
    double eye[3], way[3], x[3], at[2] = {0}, reach[2] = {0};

    for (int i = 0; i < 3; i++)
        albedo[i] = object->albedo[i];
    if (object->kind != SF_OBJECT_PLANE || object->checker <= 0)
        return;
    for (int step = 0; step < 3; step++) {
        /* The middle, and then a thousandth of a pixel right and down. */
        double h = 1e-3, squares[2];
        twin_ray(scene, 0, width, height, column + (step == 1 ? h : 0), row + (step == 2 ? h : 0), eye, way);
        struct twin_hit here = {.object = -1};
        twin_meet(object, 0, eye, way, 0, &here);
        for (int i = 0; i < 3; i++)
            x[i] = eye[i] + here.t * way[i];
        twin_squares(object, x, squares);
        for (int k = 0; k < 2; k++) {
            if (step == 0)
                at[k] = squares[k];
            else
                reach[k] += fabs(squares[k] - at[k]) / h;
        }
    }
    double share = 0.5 + 0.5 * twin_square_wave(at[0], reach[0]) * twin_square_wave(at[1], reach[1]);
    for (int i = 0; i < 3; i++)
        albedo[i] = object->albedo2[i] + share * ((double)object->albedo[i] - object->albedo2[i]);
}

/* Radiance of a hit. `shadows`: lights that ask for it are blocked by objects, sharply. */
static inline void twin_shade(const struct sf_scene *scene, const double eye[3], const double way[3],
                              const struct twin_hit *hit, const double albedo[3], bool shadows, double radiance[3])
{
    double x[3], normal[3], sum[3] = {0};
    float upright[3], ambient[3];
    double side = twin_dot(hit->normal, way) > 0 ? -1 : 1;

    for (int i = 0; i < 3; i++) {
        x[i] = eye[i] + hit->t * way[i];
        normal[i] = side * hit->normal[i];
        upright[i] = (float)normal[i];
    }
    for (uint32_t k = 0; k < scene->light_count; k++) {
        double irradiance[3], to[3], distance;
        twin_light(&scene->lights[k], x, irradiance, to, &distance);
        if (shadows && scene->lights[k].shadows && !twin_lit(scene, &scene->lights[k], x, normal))
            continue;
        for (int i = 0; i < 3; i++)
            sum[i] += irradiance[i] * fmax(twin_dot(normal, to), 0) / 3.14159265358979323846;
    }
    sf_environment_ambient(&scene->environment, upright, ambient);
    for (int i = 0; i < 3; i++)
        radiance[i] = albedo[i] * (sum[i] + fmax(ambient[i], 0));
}

/* What the pixel shows, and its depth; no surface: the environment and SF_NO_DEPTH. */
static inline struct twin_hit twin_pixel(const struct sf_scene *scene, uint32_t width, uint32_t height, double column,
                                         double row, bool shadows, double radiance[3])
{
    double eye[3], way[3], albedo[3];

    twin_ray(scene, 0, width, height, column, row, eye, way);
    struct twin_hit hit = twin_trace(scene, eye, way, scene->camera.near_clip, false);
    if (hit.object < 0 || hit.t >= SF_NO_DEPTH) {
        float direction[3], seen[3];
        twin_normalize(way);
        for (int i = 0; i < 3; i++)
            direction[i] = (float)way[i];
        sf_environment_radiance(&scene->environment, direction, seen);
        for (int i = 0; i < 3; i++)
            radiance[i] = scene->environment.visible ? seen[i] : scene->environment.background[i];
        hit.object = -1;
        hit.t = SF_NO_DEPTH;
        return hit;
    }
    twin_albedo(scene, width, height, column, row, &hit, albedo);
    twin_shade(scene, eye, way, &hit, albedo, shadows, radiance);
    return hit;
}

#endif
