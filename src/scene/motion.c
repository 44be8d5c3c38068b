/* Where cameras and emitters are at a moment. Paths are cubic Hermite curves whose tangents are those of Catmull and
 * Rom for keys at uneven times: m_i = (p_{i+1} - p_{i-1}) / (t_{i+1} - t_{i-1}); at an open end, the difference to the
 * one neighbour. */
#include <math.h>
#include <string.h>
#include "scene/moment.h"

static const double PI = 3.14159265358979323846;

/* Keys of any struct: the time is its first float, the values a vector of three at `offset`. */
struct track {
    const void *keys;
    size_t stride, offset;
    uint32_t count;
    bool loop; /* the last key is the first one again */
};

static double key_time(const struct track *track, uint32_t i)
{
    float time;

    memcpy(&time, (const char *)track->keys + i * track->stride, sizeof time);
    return time;
}

static double key_value(const struct track *track, uint32_t i, int axis)
{
    float value[3];

    memcpy(value, (const char *)track->keys + i * track->stride + track->offset, sizeof value);
    return value[axis];
}

static double tangent(const struct track *track, uint32_t i, int axis)
{
    uint32_t last = track->count - 1, before = i > 0 ? i - 1 : i, after = i < last ? i + 1 : i;

    if (track->loop && (i == 0 || i == last)) {
        double span = key_time(track, 1) - key_time(track, 0) + key_time(track, last) - key_time(track, last - 1);

        return (key_value(track, 1, axis) - key_value(track, last - 1, axis)) / span;
    }
    return (key_value(track, after, axis) - key_value(track, before, axis)) /
           (key_time(track, after) - key_time(track, before));
}

/* The segment that holds the time, and how far in it is. The time is within the track, which has two keys at least. */
static uint32_t find_segment(const struct track *track, double time, double *share)
{
    uint32_t i = 0;

    while (i + 2 < track->count && time >= key_time(track, i + 1))
        i++;
    *share = (time - key_time(track, i)) / (key_time(track, i + 1) - key_time(track, i));
    return i;
}

static void evaluate(const struct track *track, double time, float position[3], float velocity[3])
{
    double first = key_time(track, 0), last = key_time(track, track->count - 1), s, h;
    uint32_t i;

    if (track->loop && last > first) {
        time = fmod(time - first, last - first);
        time = first + (time < 0 ? time + (last - first) : time);
    }
    if (track->count < 2 || time < first || time > last) {
        uint32_t end = time > last ? track->count - 1 : 0;

        for (int axis = 0; axis < 3; axis++) {
            position[axis] = (float)key_value(track, end, axis);
            velocity[axis] = 0;
        }
        return;
    }
    i = find_segment(track, time, &s);
    h = key_time(track, i + 1) - key_time(track, i);
    for (int axis = 0; axis < 3; axis++) {
        double p = key_value(track, i, axis), q = key_value(track, i + 1, axis);
        double m = tangent(track, i, axis) * h, n = tangent(track, i + 1, axis) * h;
        double c = 3 * (q - p) - 2 * m - n, d = 2 * (p - q) + m + n; /* p + m s + c s^2 + d s^3 */

        position[axis] = (float)(p + s * (m + s * (c + s * d)));
        velocity[axis] = (float)((m + s * (2 * c + s * 3 * d)) / h);
    }
}

static void keyframes(const struct sf_camera *camera, double time, struct sf_camera_pose *pose)
{
    struct track track = {camera->keys, sizeof *camera->keys, offsetof(struct sf_camera_key, eye), camera->key_count,
                          false};
    double first = key_time(&track, 0), last = key_time(&track, track.count - 1), s;
    float unused[3];

    evaluate(&track, time, pose->eye, unused);
    track.offset = offsetof(struct sf_camera_key, target);
    evaluate(&track, time, pose->target, unused);
    if (track.count < 2 || time <= first || time >= last) {
        pose->fov = camera->keys[time > first ? track.count - 1 : 0].fov;
    } else {
        uint32_t i = find_segment(&track, time, &s);

        pose->fov = (float)(camera->keys[i].fov + s * ((double)camera->keys[i + 1].fov - camera->keys[i].fov));
    }
}

/* As the scene's camera says. */
static void unshaken(const struct sf_scene *scene, double time, struct sf_camera_pose *pose)
{
    const struct sf_camera *camera = &scene->camera;

    memcpy(pose->up, camera->up, sizeof pose->up);
    pose->near_clip = camera->near_clip;
    if (camera->kind == SF_CAMERA_KEYFRAMES) {
        keyframes(camera, time, pose);
        return;
    }
    memcpy(pose->eye, camera->eye, sizeof pose->eye);
    memcpy(pose->target, camera->target, sizeof pose->target);
    pose->fov = camera->fov;
    if (camera->kind == SF_CAMERA_ORBIT) {
        double angle = 2 * PI * fmod(time / camera->period, 1), c = cos(angle), s = sin(angle);
        double x = (double)camera->eye[0] - camera->target[0], z = (double)camera->eye[2] - camera->target[2];

        pose->eye[0] = (float)(camera->target[0] + c * x + s * z);
        pose->eye[2] = (float)(camera->target[2] - s * x + c * z);
    }
}

void sf_scene_camera(const struct sf_scene *scene, double time, struct sf_camera_pose *pose)
{
    unshaken(scene, time, pose);
    sf_pose_shake(scene, time, pose);
}

void sf_scene_view(const struct sf_scene *scene, double time, struct sf_camera_view *view)
{
    struct sf_camera_pose pose;

    sf_scene_camera(scene, time, &pose);
    memcpy(view->eye, pose.eye, sizeof view->eye);
    memcpy(view->target, pose.target, sizeof view->target);
    memcpy(view->up, pose.up, sizeof view->up);
    view->fov = pose.fov;
    view->near_clip = pose.near_clip;
}

void sf_scene_emitter_at(const struct sf_emitter *emitter, double time, float position[3], float velocity[3])
{
    struct track track = {emitter->path, sizeof *emitter->path, offsetof(struct sf_path_key, position),
                          emitter->path_count, emitter->path_loop};

    if (track.count == 0) {
        memcpy(position, emitter->position, sizeof emitter->position);
        memset(velocity, 0, sizeof emitter->position);
        return;
    }
    evaluate(&track, time, position, velocity);
    for (int axis = 0; axis < 3; axis++)
        position[axis] += emitter->position[axis];
}
