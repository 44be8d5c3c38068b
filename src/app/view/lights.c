#include "lights.h"

#include <stdio.h>
#include <string.h>

#include "rig.h"
#include "vector.h"

static const double PI = 3.14159265358979323846;
static const double SUN_FILL = 0.85;   /* of the picture's smaller half: the rim of the suns' sphere */
static const double SUN_LARGEST = 0.5; /* of the distance to the target: its radius */
static const double AIM_LEAST = 0.1;   /* of that distance: radius of the aims' sphere */
static const double HIGHEST = 89.9;    /* deg */

/* ---- the picture ---- */

struct eye {
    double place[3], target[3], right[3], above[3], forward[3];
    double tan_x, tan_y, width, height; /* of the half angles; px */
    double distance;                    /* to the target */
    double nearest;                     /* depth of what can be seen, m */
};

static bool make_eye(const struct sf_camera_view *view, float width, float height, struct eye *eye)
{
    double arm[3];

    if (!(width > 0 && height > 0))
        return false;
    for (int i = 0; i < 3; i++) {
        eye->place[i] = view->eye[i];
        eye->target[i] = view->target[i];
    }
    sf_view_axes(view, eye->right, eye->above, eye->forward);
    eye->width = width;
    eye->height = height;
    eye->tan_y = tan(view->fov * (PI / 360));
    eye->tan_x = eye->tan_y * width / height;
    sf_v3_subtract(eye->target, eye->place, arm);
    eye->distance = sf_v3_length(arm);
    eye->nearest = fmin(view->near_clip, 0.4 * eye->distance); /* suns are always further */
    return true;
}

static double depth_of(const struct eye *eye, const double point[3])
{
    double arm[3];

    sf_v3_subtract(point, eye->place, arm);
    return sf_v3_dot(arm, eye->forward);
}

/* False when the point is not in front of the eye. */
static bool project(const struct eye *eye, const double point[3], float *x, float *y)
{
    double arm[3], depth;

    *x = *y = 0;
    sf_v3_subtract(point, eye->place, arm);
    depth = sf_v3_dot(arm, eye->forward);
    if (!(depth >= eye->nearest))
        return false;
    *x = (float)((1 + sf_v3_dot(arm, eye->right) / (depth * eye->tan_x)) * eye->width / 2);
    *y = (float)((1 - sf_v3_dot(arm, eye->above) / (depth * eye->tan_y)) * eye->height / 2);
    return true;
}

/* The way of the ray through (x, y): 1 m of depth long. */
static void make_ray(const struct eye *eye, float x, float y, double ray[3])
{
    double right = (2 * x / eye->width - 1) * eye->tan_x, above = (1 - 2 * y / eye->height) * eye->tan_y;

    for (int i = 0; i < 3; i++)
        ray[i] = eye->forward[i] + right * eye->right[i] + above * eye->above[i];
}

/* ---- lamps as the controls have them ---- */

enum kind { KIND_SUN, KIND_POINT, KIND_SPOT };

struct lamp {
    enum kind kind;
    double position[3], direction[3]; /* direction: unit */
    const struct sf_control *position_control, *direction_control;
    float color[3];
};

static const struct sf_control *find_control(const struct sf_control *controls, uint32_t count, unsigned light,
                                             const char *key)
{
    char path[48];

    snprintf(path, sizeof path, "lights.%u.%s", light, key);
    for (uint32_t i = 0; i < count; i++)
        if (strcmp(controls[i].path, path) == 0)
            return &controls[i];
    return NULL;
}

static bool find_kind(const struct sf_control *type, enum kind *kind)
{
    static const char *const names[] = {[KIND_SUN] = "directional", [KIND_POINT] = "point", [KIND_SPOT] = "spot"};

    for (int i = 0; i < 3; i++) {
        if (strcmp(type->choices[(unsigned)type->value[0]], names[i]) == 0) {
            *kind = (enum kind)i;
            return true;
        }
    }
    return false;
}

static void find_color(const struct sf_control *color, float rgb[3])
{
    double most = 0;

    for (int i = 0; color && i < 3; i++)
        most = fmax(most, color->value[i]);
    for (int i = 0; i < 3; i++)
        rgb[i] = most > 0 ? (float)(fmax(color->value[i], 0) / most) : 1;
}

/* False when there is no such light, or one that is not known here. */
static bool find_lamp(const struct sf_control *controls, uint32_t count, unsigned light, struct lamp *lamp)
{
    const struct sf_control *type = find_control(controls, count, light, "type");

    memset(lamp, 0, sizeof *lamp);
    if (!type || !find_kind(type, &lamp->kind))
        return false;
    find_color(find_control(controls, count, light, "color"), lamp->color);
    if (lamp->kind != KIND_SUN) {
        if (!(lamp->position_control = find_control(controls, count, light, "position")))
            return false;
        memcpy(lamp->position, lamp->position_control->value, sizeof lamp->position);
    }
    if (lamp->kind != KIND_POINT) {
        if (!(lamp->direction_control = find_control(controls, count, light, "direction")))
            return false;
        memcpy(lamp->direction, lamp->direction_control->value, sizeof lamp->direction);
        return sf_v3_normalize(lamp->direction);
    }
    return true;
}

/* ---- handles ---- */

struct sphere {
    double centre[3], radius;
};

/* Where the handle that gives the lamp's direction can be. */
static void find_sphere(const struct lamp *lamp, const struct eye *eye, struct sphere *sphere)
{
    double arm[3], rim = SUN_FILL * fmin(eye->tan_x, eye->tan_y);

    if (lamp->kind == KIND_SUN) {
        memcpy(sphere->centre, eye->target, sizeof sphere->centre);
        sphere->radius = eye->distance * fmin(rim / sqrt(1 + rim * rim), SUN_LARGEST);
    } else {
        memcpy(sphere->centre, lamp->position, sizeof sphere->centre);
        sf_v3_subtract(eye->target, lamp->position, arm);
        sphere->radius = fmax(sf_v3_length(arm), AIM_LEAST * eye->distance);
    }
}

static void place_handle(const struct eye *eye, unsigned light, enum sf_handle_kind kind, const double point[3],
                         const double from[3], const float color[3], struct sf_handle *handle)
{
    double depth = depth_of(eye, point), from_depth = depth_of(eye, from), way[3], seen[3], end[3];

    *handle = (struct sf_handle){.light = light, .kind = kind};
    memcpy(handle->point, point, sizeof handle->point);
    memcpy(handle->color, color, sizeof handle->color);
    sf_v3_subtract(point, from, way);
    sf_v3_subtract(point, eye->place, seen);
    handle->far = sf_v3_dot(way, seen) > 0;
    handle->visible = project(eye, point, &handle->x, &handle->y);
    if (!handle->visible)
        return;
    memcpy(end, from, sizeof end);
    if (from_depth < eye->nearest) /* the line is cut, a little in front so that rounding does not lose it */
        sf_v3_add(point, way, -(depth - eye->nearest * (1 + 1e-9)) / (depth - from_depth), end);
    if (!project(eye, end, &handle->from_x, &handle->from_y)) {
        handle->from_x = handle->x;
        handle->from_y = handle->y;
    }
}

unsigned sf_handles_find(const struct sf_control *controls, uint32_t control_count, const struct sf_camera_view *view,
                         float width, float height, struct sf_handle handles[SF_HANDLES_MAX])
{
    unsigned count = 0;
    struct eye eye;

    if (!make_eye(view, width, height, &eye))
        return 0;
    for (unsigned light = 0; find_control(controls, control_count, light, "type"); light++) {
        struct lamp lamp;
        struct sphere sphere;
        double point[3];

        if (!find_lamp(controls, control_count, light, &lamp))
            continue;
        if (lamp.kind != KIND_SUN && count < SF_HANDLES_MAX)
            place_handle(&eye, light, SF_HANDLE_POSITION, lamp.position, lamp.position, lamp.color, &handles[count++]);
        if (lamp.kind == KIND_POINT || count == SF_HANDLES_MAX)
            continue;
        find_sphere(&lamp, &eye, &sphere);
        sf_v3_add(sphere.centre, lamp.direction, lamp.kind == KIND_SUN ? -sphere.radius : sphere.radius, point);
        place_handle(&eye, light, lamp.kind == KIND_SUN ? SF_HANDLE_SUN : SF_HANDLE_AIM, point, sphere.centre,
                     lamp.color, &handles[count++]);
    }
    return count;
}

int sf_handles_pick(const struct sf_handle *handles, unsigned count, float x, float y, float reach)
{
    double least = reach;
    int nearest = -1;

    for (unsigned i = 0; i < count; i++) {
        double away = hypot((double)handles[i].x - x, (double)handles[i].y - y);

        if (handles[i].visible && away <= least && (nearest < 0 || away < least)) {
            least = away;
            nearest = (int)i;
        }
    }
    return nearest;
}

/* ---- dragging ---- */

/* "lights.0.position=1,2,3", within the control's range. */
static unsigned print_set(unsigned light, const struct sf_control *control, const double value[3],
                          char set[SF_LIGHT_SET_BYTES])
{
    float kept[3];

    for (int i = 0; i < 3; i++)
        kept[i] = (float)fmin(fmax(value[i], control->min), control->max);
    snprintf(set, SF_LIGHT_SET_BYTES, "lights.%u.%s=%.9g,%.9g,%.9g", light, control->key, kept[0], kept[1], kept[2]);
    return 1;
}

/* Where on the sphere the mouse is: the near or far end of the chord that the ray cuts out, or the point of the rim that is
 * nearest to it. From inside there is only the far end. */
static void hit_sphere(const struct eye *eye, const struct sphere *sphere, const double ray[3], bool far,
                       double point[3])
{
    double arm[3], way[3], aside[3], along, beside, length, square = sphere->radius * sphere->radius;

    memcpy(way, ray, sizeof way);
    sf_v3_normalize(way);
    sf_v3_subtract(sphere->centre, eye->place, arm);
    length = sf_v3_length(arm);
    along = sf_v3_dot(arm, way);
    sf_v3_add(arm, way, -along, aside); /* from the ray's nearest point to the centre */
    beside = sf_v3_dot(aside, aside);
    if (length <= sphere->radius || (beside <= square && along > 0)) {
        double half = sqrt(fmax(square - beside, 0));

        sf_v3_add(eye->place, way, far || length <= sphere->radius ? along + half : along - half, point);
        return;
    }
    /* The tangent from the eye, in the plane of the ray and the centre. */
    double axis[3] = {arm[0] / length, arm[1] / length, arm[2] / length}, to_rim = sqrt(length * length - square);

    sf_v3_add(way, axis, -sf_v3_dot(way, axis), aside);
    sf_v3_normalize(aside);
    for (int i = 0; i < 3; i++)
        point[i] = eye->place[i] + to_rim * (axis[i] * to_rim + aside[i] * sphere->radius) / length;
}

unsigned sf_handle_drag(const struct sf_handle *handle, const struct sf_control *controls, uint32_t control_count,
                        const struct sf_camera_view *view, float width, float height, float x, float y, bool far,
                        char sets[SF_LIGHT_SETS][SF_LIGHT_SET_BYTES])
{
    double ray[3], point[3], direction[3];
    struct sphere sphere;
    struct lamp lamp;
    struct eye eye;

    if (!make_eye(view, width, height, &eye) || !find_lamp(controls, control_count, handle->light, &lamp))
        return 0;
    make_ray(&eye, x, y, ray);
    if (handle->kind == SF_HANDLE_POSITION) {
        if (!lamp.position_control)
            return 0;
        sf_v3_add(eye.place, ray, fmax(depth_of(&eye, handle->point), eye.nearest), point);
        return print_set(handle->light, lamp.position_control, point, sets[0]);
    }
    if (!lamp.direction_control)
        return 0;
    find_sphere(&lamp, &eye, &sphere);
    hit_sphere(&eye, &sphere, ray, far, point);
    if (lamp.kind == KIND_SUN)
        sf_v3_subtract(sphere.centre, point, direction);
    else
        sf_v3_subtract(point, sphere.centre, direction);
    sf_v3_normalize(direction);
    return print_set(handle->light, lamp.direction_control, direction, sets[0]);
}

/* ---- turning ---- */

/* Turns v about the vertical, then about `axis` (unit, level). rad */
static void turn_vector(double v[3], double turn, const double axis[3], double rise)
{
    double x = v[0] * cos(turn) + v[2] * sin(turn), z = v[2] * cos(turn) - v[0] * sin(turn), side[3], along;

    v[0] = x;
    v[2] = z;
    along = sf_v3_dot(axis, v);
    sf_v3_cross(axis, v, side);
    for (int i = 0; i < 3; i++)
        v[i] = v[i] * cos(rise) + side[i] * sin(rise) + axis[i] * along * (1 - cos(rise));
}

unsigned sf_light_orbit(unsigned light, double turn, double rise, const struct sf_control *controls,
                        uint32_t control_count, const struct sf_camera_view *view,
                        char sets[SF_LIGHT_SETS][SF_LIGHT_SET_BYTES])
{
    double target[3] = {view->target[0], view->target[1], view->target[2]}, arm[3], high, heading;
    unsigned count = 0;
    struct lamp lamp;

    if (!find_lamp(controls, control_count, light, &lamp))
        return 0;
    if (lamp.kind == KIND_SUN)
        sf_v3_subtract((const double[]){0, 0, 0}, lamp.direction, arm);
    else
        sf_v3_subtract(lamp.position, target, arm);
    high = atan2(arm[1], hypot(arm[0], arm[2])) * (180 / PI);
    rise = fmin(fmax(rise, fmin(-HIGHEST - high, 0)), fmax(HIGHEST - high, 0));
    turn *= PI / 180;
    heading = atan2(arm[0], arm[2]) + turn;

    const double axis[3] = {-cos(heading), 0, sin(heading)};
    turn_vector(arm, turn, axis, rise * (PI / 180));
    turn_vector(lamp.direction, turn, axis, rise * (PI / 180));
    if (lamp.position_control) {
        sf_v3_add(target, arm, 1, arm);
        count += print_set(light, lamp.position_control, arm, sets[count]);
    }
    if (lamp.direction_control)
        count += print_set(light, lamp.direction_control, lamp.direction, sets[count]);
    return count;
}
