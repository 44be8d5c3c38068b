#include "render/uniforms.h"

#include <math.h>
#include <string.h>
#include "scene/vector.h"
#include "sim/obstacle.h"

_Static_assert(SF_FRAME_LIGHTS == SF_LIGHTS_MAX, "shared limits");
_Static_assert(SF_FRAME_OBJECTS == SF_OBJECTS_MAX, "shared limits");
_Static_assert((int)SF_DEPTH_FAR == (int)SF_NO_DEPTH, "shared limits");
_Static_assert((int)SF_LIGHT_KIND_POINT == (int)SF_LIGHT_POINT && (int)SF_LIGHT_KIND_SPOT == (int)SF_LIGHT_SPOT,
               "kinds");
_Static_assert((int)SF_OBJECT_KIND_PLANE == (int)SF_OBJECT_PLANE && (int)SF_OBJECT_KIND_MESH == (int)SF_OBJECT_MESH,
               "kinds");
_Static_assert((int)SF_OBJECT_KIND_BOX == (int)SF_OBJECT_BOX && (int)SF_OBJECT_KIND_SPHERE == (int)SF_OBJECT_SPHERE &&
                   (int)SF_OBJECT_KIND_CYLINDER == (int)SF_OBJECT_CYLINDER,
               "kinds");
_Static_assert(sizeof(struct sf_gpu_object) == 112, "std140");
_Static_assert(sizeof(struct sf_gpu_light) == 128, "std140");
_Static_assert(sizeof(struct sf_gpu_frame) == 64 * 3 + 16 * (14 + 9 + SF_FRAME_RAMP + 1) + 128 * SF_FRAME_LIGHTS,
               "std140");

static const double PI = 3.14159265358979323846;

static double radians(double degrees)
{
    return degrees * (PI / 180.0);
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double to[3])
{
    double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];

    to[0] = x;
    to[1] = y;
    to[2] = z;
}

static void normalize(double v[3])
{
    double length = sqrt(dot(v, v));

    for (int i = 0; i < 3; i++)
        v[i] /= length;
}

static void set4(float to[4], double x, double y, double z, double w)
{
    to[0] = (float)x;
    to[1] = (float)y;
    to[2] = (float)z;
    to[3] = (float)w;
}

/* Of three doubles, and what rounding leaves out; the fourth of `to` stays. */
static void set_axis(float to[4], float low[4], const double axis[3], double scale)
{
    for (int i = 0; i < 3; i++) {
        to[i] = (float)(axis[i] * scale);
        low[i] = (float)(axis[i] * scale - (double)to[i]);
    }
}

static void set_rgb(float to[4], const float rgb[3], double scale)
{
    set4(to, rgb[0] * scale, rgb[1] * scale, rgb[2] * scale, to[3]);
}

void sf_matrix_transpose(const float from[16], float to[16])
{
    for (int row = 0; row < 4; row++) {
        for (int column = 0; column < 4; column++)
            to[4 * row + column] = from[4 * column + row];
    }
}

/* Axes in double: a frame far from the origin must not wobble. */
static void fill_camera(const struct sf_camera_pose *pose, uint32_t width, uint32_t height, struct sf_gpu_frame *frame)
{
    double eye[3], forward[3], up[3], right[3];
    double tan_y = tan(radians(pose->fov) / 2), tan_x = tan_y * width / height;
    float *view = frame->world_to_view, *clip = frame->world_to_clip;

    for (int i = 0; i < 3; i++) {
        eye[i] = pose->eye[i];
        forward[i] = (double)pose->target[i] - pose->eye[i];
        up[i] = pose->up[i];
    }
    normalize(forward);
    cross(forward, up, right);
    if (dot(right, right) < 1e-12) { /* looking along `up`: any other axis serves */
        double other[3] = {fabs(forward[2]) < 0.5 ? 0 : 1, 0, fabs(forward[2]) < 0.5 ? 1 : 0};
        cross(forward, other, right);
    }
    normalize(right);
    cross(right, forward, up);

    const double *rows[3] = {right, up, forward};
    const double scale[3] = {1 / tan_x, -1 / tan_y, 0};
    memset(view, 0, sizeof frame->world_to_view);
    memset(clip, 0, sizeof frame->world_to_clip);
    memset(frame->view_to_clip, 0, sizeof frame->view_to_clip);
    for (int row = 0; row < 3; row++) {
        double sign = row == 2 ? -1 : 1, offset = -dot(rows[row], eye);
        for (int column = 0; column < 3; column++) {
            view[4 * column + row] = (float)(sign * rows[row][column]);
            clip[4 * column + row] = (float)(scale[row] * rows[row][column]);
        }
        view[12 + row] = (float)(sign * offset);
        clip[12 + row] = (float)(scale[row] * offset);
    }
    view[15] = 1;
    for (int column = 0; column < 3; column++)
        clip[4 * column + 3] = (float)forward[column];
    clip[15] = (float)-dot(forward, eye);
    clip[14] = pose->near_clip;
    frame->view_to_clip[0] = (float)(1 / tan_x);
    frame->view_to_clip[5] = (float)(-1 / tan_y);
    frame->view_to_clip[11] = -1;
    frame->view_to_clip[14] = pose->near_clip;

    set4(frame->eye, eye[0], eye[1], eye[2], pose->near_clip);
    frame->right[3] = (float)tan_x;
    frame->up[3] = (float)tan_y;
    set_axis(frame->right, frame->right_low, right, tan_x);
    set_axis(frame->up, frame->up_low, up, tan_y);
    set_axis(frame->forward, frame->forward_low, forward, 1);
    set4(frame->size, width, height, 1.0 / width, 1.0 / height);
}

/* Keys are sorted by the loader; before the first and after the last the colour stays. */
static void ramp_at(const struct sf_scene *scene, double at, float rgb[4])
{
    const struct sf_ramp_key *keys = scene->ramp;
    uint32_t count = scene->ramp_count, next = 0;

    set4(rgb, 1, 1, 1, 0);
    if (count == 0)
        return;
    while (next < count && keys[next].at < at)
        next++;
    const struct sf_ramp_key *a = &keys[next > 0 ? next - 1 : 0], *b = &keys[next < count ? next : count - 1];
    double span = (double)b->at - a->at, part = span > 0 ? (at - a->at) / span : 0;
    for (int i = 0; i < 3; i++)
        rgb[i] = (float)(a->color[i] + part * ((double)b->color[i] - a->color[i]));
}

static void fill_light(const struct sf_light *from, struct sf_gpu_light *light)
{
    memset(light, 0, sizeof *light);
    set4(light->position, from->position[0], from->position[1], from->position[2], from->kind);
    set4(light->direction, from->direction[0], from->direction[1], from->direction[2], cos(radians(from->outer)));
    set_rgb(light->color, from->color, from->intensity);
    light->color[3] = (float)cos(radians(from->inner));
}

static void fill_environment(const struct sf_environment *from, struct sf_gpu_frame *frame)
{
    bool picture = from->kind == SF_ENVIRONMENT_LATLONG || from->kind == SF_ENVIRONMENT_CUBE;
    bool sky = from->kind == SF_ENVIRONMENT_SKY;
    double turn = radians(from->rotation);

    if (from->visible && !sky && !picture)
        set_rgb(frame->background, from->color, from->intensity);
    else
        set_rgb(frame->background, from->background, 1);
    frame->background[3] = !from->visible ? 3.0f : picture ? 2.0f : sky ? 0.0f : 1.0f;
    set_rgb(frame->zenith, from->zenith, from->intensity);
    set_rgb(frame->horizon, from->horizon, from->intensity);
    set_rgb(frame->ground, from->ground, from->intensity);
    frame->zenith[3] = from->intensity;
    frame->horizon[3] = (float)cos(turn);
    frame->ground[3] = (float)sin(turn);
    for (int i = 0; i < 9; i++)
        set4(frame->sh[i], from->sh[i][0], from->sh[i][1], from->sh[i][2], 0);
}

void sf_uniforms_fill(const struct sf_scene *scene, uint32_t width, uint32_t height, uint32_t frame_number, double time,
                      struct sf_gpu_frame *frame)
{
    struct sf_light lights[SF_LIGHTS_MAX];
    struct sf_camera_pose pose;

    memset(frame, 0, sizeof *frame);
    sf_scene_camera(scene, time, &pose);
    frame->forward[3] = (float)time;
    fill_camera(&pose, width, height, frame);
    set_rgb(frame->albedo, scene->medium.albedo, 1);
    frame->albedo[3] = scene->medium.g;
    set_rgb(frame->emission, scene->medium.emission, 1);
    fill_environment(&scene->environment, frame);
    for (int i = 0; i < SF_FRAME_RAMP; i++)
        ramp_at(scene, (double)i / (SF_FRAME_RAMP - 1), frame->ramp[i]);
    frame->light_count = scene->light_count;
    frame->object_count = scene->object_count;
    frame->frame_number = frame_number;
    frame->seed = (uint32_t)scene->sim.seed;
    sf_scene_lights(scene, time, lights);
    for (uint32_t i = 0; i < scene->light_count; i++)
        fill_light(&lights[i], &frame->lights[i]);
}

void sf_uniforms_view(const struct sf_camera_pose *pose, uint32_t width, uint32_t height, struct sf_gpu_frame *frame)
{
    fill_camera(pose, width, height, frame);
}

void sf_object_list_fill(const struct sf_scene *scene, struct sf_object_list *list)
{
    uint32_t count = 0;

    memset(list, 0, sizeof *list);
    for (int kind = SF_OBJECT_PLANE; kind <= SF_OBJECT_MESH; kind++) {
        uint32_t *counter = kind == SF_OBJECT_PLANE  ? &list->planes
                            : kind == SF_OBJECT_MESH ? &list->meshes
                                                     : &list->solids;
        for (uint32_t i = 0; i < scene->object_count; i++) {
            if (scene->objects[i].kind == kind) {
                list->from[count++] = i;
                (*counter)++;
            }
        }
    }
}

void sf_object_fill(const struct sf_object *from, struct sf_gpu_object *object)
{
    sf_obstacle_fill(from, object);
    set_rgb(object->albedo, from->albedo, 1);
    object->albedo[3] = from->kind == SF_OBJECT_PLANE ? from->checker : 0;
    set_rgb(object->albedo2, from->albedo2, 1);
    object->albedo2[3] = sf_obstacle_collides(from) ? 1.0f : 0.0f;
}

bool sf_pose_from_view(const struct sf_camera_view *view, struct sf_camera_pose *pose)
{
    bool apart = false, finite = isfinite(view->fov) && isfinite(view->near_clip);

    for (int i = 0; i < 3; i++) {
        apart = apart || view->eye[i] != view->target[i];
        finite = finite && isfinite(view->eye[i]) && isfinite(view->target[i]) && isfinite(view->up[i]);
    }
    *pose = (struct sf_camera_pose){.fov = view->fov, .near_clip = view->near_clip};
    memcpy(pose->eye, view->eye, sizeof view->eye);
    memcpy(pose->target, view->target, sizeof view->target);
    memcpy(pose->up, view->up, sizeof view->up);
    return apart && finite && view->fov > 0 && view->fov < 180 && view->near_clip > 0 && sf_normalize(pose->up);
}
