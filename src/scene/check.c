#include <math.h>
#include <stdio.h>
#include <string.h>
#include "scene/load.h"
#include "scene/vector.h"

enum { AT_BYTES = 32, LOOKS = 16 };

/* ---- camera ---- */

/* Poses looked at between two keys, and around an orbit. */
enum { POSES_BETWEEN = 16, POSES_AROUND = 64 };
static const double TOUCHING = 1e-6, PARALLEL = 1e-4; /* m; sine of the angle between view and up */

static enum sf_status check_pose(const struct sf_scene *scene, struct sf_param_reader *reader, double time)
{
    struct sf_camera_pose pose;
    float view[3], side[3];

    sf_scene_camera(scene, time, &pose);
    sf_subtract(pose.target, pose.eye, view);
    if (sf_length(view) < TOUCHING)
        return sf_param_reader_fail(reader, "at %g s the camera is at its own target; move eye or target", time);
    sf_normalize(view);
    sf_cross(view, pose.up, side);
    if (sf_length(side) < PARALLEL)
        return sf_param_reader_fail(reader, "at %g s the camera looks along up; turn up to another direction", time);
    return SF_OK;
}

static enum sf_status check_camera(struct sf_scene *scene, struct sf_param_reader *reader)
{
    struct sf_camera *camera = &scene->camera;
    enum sf_status status = SF_OK;

    if (!sf_normalize(camera->up)) {
        sf_param_reader_at(reader, "/camera/up");
        return sf_param_reader_fail(reader, "has no length; 0,1,0 is the usual");
    }
    if (camera->kind == SF_CAMERA_ORBIT && fabsf(camera->period) < 0.01f) {
        sf_param_reader_at(reader, "/camera/period");
        return sf_param_reader_fail(reader, "%g is too short; 0.01 s is the least, to either side", camera->period);
    }
    sf_param_reader_at(reader, "/camera");
    if (camera->kind == SF_CAMERA_FIXED)
        return check_pose(scene, reader, 0);
    if (camera->kind == SF_CAMERA_ORBIT) {
        for (int i = 0; i < POSES_AROUND && status == SF_OK; i++)
            status = check_pose(scene, reader, (double)camera->period * i / POSES_AROUND);
        return status;
    }
    for (uint32_t i = 0; i < camera->key_count; i++) {
        sf_param_reader_at(reader, "/camera/keys/%u/time", (unsigned)i);
        if (i && !(camera->keys[i].time > camera->keys[i - 1].time))
            return sf_param_reader_fail(reader, "%g s is not later than the key before", camera->keys[i].time);
        sf_param_reader_at(reader, "/camera/keys/%u", (unsigned)i);
        if (i == 0)
            status = check_pose(scene, reader, camera->keys[0].time);
        for (int k = 1; i && k <= POSES_BETWEEN && status == SF_OK; k++) {
            double before = camera->keys[i - 1].time, now = camera->keys[i].time;

            status = check_pose(scene, reader, before + (now - before) * k / POSES_BETWEEN);
        }
        if (status != SF_OK)
            return status;
    }
    return SF_OK;
}

/* ---- lists ---- */

static enum sf_status need_direction(struct sf_param_reader *reader, float v[3])
{
    return sf_normalize(v) ? SF_OK : sf_param_reader_fail(reader, "0,0,0 has no direction; 0,1,0 is straight up");
}

enum sf_status sf_scene_check_light(struct sf_light *light, struct sf_param_reader *reader, const char *at)
{
    enum sf_status status;

    if (light->kind == SF_LIGHT_POINT)
        return SF_OK;
    sf_param_reader_at(reader, "%s/direction", at);
    if ((status = need_direction(reader, light->direction)) != SF_OK)
        return status;
    sf_param_reader_at(reader, "%s", at);
    if (light->kind == SF_LIGHT_SPOT && !(light->inner < light->outer))
        return sf_param_reader_fail(reader, "inner (%g deg) must be less than outer (%g deg)", light->inner,
                                    light->outer);
    return SF_OK;
}

static enum sf_status check_lights(struct sf_scene *scene, struct sf_param_reader *reader)
{
    enum sf_status status = SF_OK;
    char at[AT_BYTES];

    for (uint32_t i = 0; i < scene->light_count && status == SF_OK; i++) {
        snprintf(at, sizeof at, "/lights/%u", (unsigned)i);
        status = sf_scene_check_light(&scene->lights[i], reader, at);
    }
    return status;
}

static enum sf_status check_objects(struct sf_scene *scene, struct sf_param_reader *reader)
{
    for (uint32_t i = 0; i < scene->object_count; i++) {
        struct sf_object *object = &scene->objects[i];
        enum sf_status status;

        sf_param_reader_at(reader, "/objects/%u/normal", (unsigned)i);
        if (object->kind == SF_OBJECT_PLANE && (status = need_direction(reader, object->normal)) != SF_OK)
            return status;
        if (object->checker == 0)
            memcpy(object->albedo2, object->albedo, sizeof object->albedo2);
    }
    return SF_OK;
}

static enum sf_status check_path(const struct sf_emitter *emitter, struct sf_param_reader *reader, const char *at)
{
    const struct sf_path_key *last = emitter->path + (emitter->path_count ? emitter->path_count - 1 : 0);

    for (uint32_t i = 1; i < emitter->path_count; i++) {
        sf_param_reader_at(reader, "%s/path/%u/time", at, (unsigned)i);
        if (!(emitter->path[i].time > emitter->path[i - 1].time))
            return sf_param_reader_fail(reader, "%g s is not later than the key before", emitter->path[i].time);
    }
    if (!emitter->path_loop)
        return SF_OK;
    sf_param_reader_at(reader, "%s/path_loop", at);
    if (emitter->path_count < 3)
        return sf_param_reader_fail(reader, "needs a path of three keys at least");
    if (memcmp(last->position, emitter->path[0].position, sizeof last->position) != 0)
        return sf_param_reader_fail(reader, "the last key of the path must be where the first one is");
    return SF_OK;
}

enum sf_status sf_scene_check_emitter(const struct sf_scene *scene, struct sf_emitter *emitter,
                                      struct sf_param_reader *reader, const char *at)
{
    enum sf_status status;

    sf_param_reader_at(reader, "%s/direction", at);
    if (!sf_normalize(emitter->direction) && emitter->kind == SF_EMITTER_CONE)
        return sf_param_reader_fail(reader, "0,0,0 has no direction; 0,1,0 is straight up");
    if ((status = check_path(emitter, reader, at)) != SF_OK)
        return status;
    if (emitter->extinction < 0)
        emitter->extinction = scene->medium.extinction;
    sf_param_reader_at(reader, "%s", at);
    if (emitter->kind == SF_EMITTER_MESH && !emitter->file)
        return sf_param_reader_fail(reader, "file is missing (OBJ or glTF)");
    if (emitter->kind == SF_EMITTER_LIST && !emitter->file == !emitter->list)
        return sf_param_reader_fail(reader, emitter->file ? "particles and file exclude each other"
                                                          : "particles or file is missing");
    return SF_OK;
}

static enum sf_status check_emitters(struct sf_scene *scene, struct sf_param_reader *reader)
{
    enum sf_status status = SF_OK;
    char at[AT_BYTES];

    for (uint32_t i = 0; i < scene->emitter_count && status == SF_OK; i++) {
        snprintf(at, sizeof at, "/emitters/%u", (unsigned)i);
        status = sf_scene_check_emitter(scene, &scene->emitters[i], reader, at);
    }
    return status;
}

static enum sf_status check_forces(struct sf_scene *scene, struct sf_param_reader *reader)
{
    bool air = false, drag = false;

    for (uint32_t i = 0; i < scene->force_count; i++) {
        struct sf_force *force = &scene->forces[i];
        enum sf_status status;

        sf_param_reader_at(reader, "/forces/%u/strength", (unsigned)i);
        if ((force->kind == SF_FORCE_DRAG || force->kind == SF_FORCE_TURBULENCE) && force->strength < 0)
            return sf_param_reader_fail(reader, "%g is below 0, which %s cannot be", force->strength,
                                        force->kind == SF_FORCE_DRAG ? "drag" : "turbulence");
        sf_param_reader_at(reader, "/forces/%u/axis", (unsigned)i);
        if (force->kind == SF_FORCE_VORTEX && (status = need_direction(reader, force->axis)) != SF_OK)
            return status;
        drag = drag || (force->kind == SF_FORCE_DRAG && force->strength > 0);
        air =
            air || force->kind == SF_FORCE_WIND || force->kind == SF_FORCE_TURBULENCE || force->kind == SF_FORCE_VORTEX;
    }
    sf_param_reader_at(reader, "/forces");
    if (air && !drag)
        sf_param_reader_warn(reader, "wind, turbulence and vortex do nothing without a force of type drag");
    return SF_OK;
}

static enum sf_status check_ramp(const struct sf_scene *scene, struct sf_param_reader *reader)
{
    for (uint32_t i = 1; i < scene->ramp_count; i++) {
        sf_param_reader_at(reader, "/ramp/%u/at", (unsigned)i);
        if (!(scene->ramp[i].at > scene->ramp[i - 1].at))
            return sf_param_reader_fail(reader, "%g is not above the key before", scene->ramp[i].at);
    }
    return SF_OK;
}

enum sf_status sf_scene_check(struct sf_scene *scene, struct sf_param_reader *reader)
{
    enum sf_status status = check_camera(scene, reader);

    if (status == SF_OK)
        status = check_lights(scene, reader);
    if (status == SF_OK)
        status = check_objects(scene, reader);
    if (status == SF_OK)
        status = check_ramp(scene, reader);
    if (status == SF_OK)
        status = check_emitters(scene, reader);
    if (status == SF_OK)
        status = check_forces(scene, reader);
    return status;
}

/* ---- how many particles ---- */

static double mean_life(const struct sf_emitter *emitter)
{
    return ((double)emitter->lifetime[0] + emitter->lifetime[1]) / 2;
}

static double made(const void *user, double local)
{
    const struct sf_emitter *emitter = user;

    return sf_emitter_stream(emitter, local) + (emitter->start < local ? emitter->burst : 0);
}

/* Particles of effects that live at the time. */
static double timed_alive(const struct sf_scene *scene, double time)
{
    double sum = 0;

    for (uint32_t i = 0; i < scene->emitter_count; i++) {
        const struct sf_emitter *emitter = &scene->emitters[i];

        if (emitter->timing)
            sum += sf_timing_sum(emitter->timing, time, made, emitter) -
                   sf_timing_sum(emitter->timing, time - mean_life(emitter), made, emitter);
    }
    return sum;
}

/* The most of them at once, looked for at the moments just before one dies out, and after one has begun. */
static double most_timed(const struct sf_scene *scene)
{
    double most = 0;

    for (uint32_t i = 0; i < scene->emitter_count; i++) {
        const struct sf_emitter *emitter = &scene->emitters[i];
        double begin = 0, life = mean_life(emitter);

        for (uint32_t k = 0; emitter->timing && k < emitter->timing->clock_count; k++)
            begin += emitter->timing->clocks[k].start;
        for (int k = 0; emitter->timing && k < LOOKS; k++)
            most = fmax(most, timed_alive(scene, begin + emitter->start + life * (k + 0.999) / (LOOKS / 2)));
    }
    return most;
}

enum sf_status sf_scene_check_particles(struct sf_scene *scene, struct sf_param_reader *reader)
{
    uint64_t listed = 0;
    double expected = 0;

    for (uint32_t i = 0; i < scene->emitter_count; i++) {
        struct sf_emitter *emitter = &scene->emitters[i];
        double life = mean_life(emitter);

        for (uint32_t k = 0; k < emitter->list_count; k++) {
            struct sf_listed *particle = &emitter->list[k];

            if (particle->extinction < 0)
                particle->extinction = emitter->extinction;
            if (particle->tile != floorf(particle->tile)) {
                sf_param_reader_at(reader, "/emitters/%u/particles/%u/tile", (unsigned)i, (unsigned)k);
                return sf_param_reader_fail(reader, "%g is not a whole number", particle->tile);
            }
        }
        listed += emitter->list_count;
        if (emitter->duration > 0 && emitter->duration < life)
            life = emitter->duration;
        expected += emitter->timing ? 0 : emitter->rate * life + emitter->burst;
    }
    expected += most_timed(scene);
    sf_param_reader_at(reader, "/sim/capacity");
    if (listed > (uint64_t)scene->sim.capacity)
        return sf_param_reader_fail(reader, "%d is too small for the %llu particles that are listed",
                                    (int)scene->sim.capacity, (unsigned long long)listed);
    if (expected + (double)listed > scene->sim.capacity)
        sf_param_reader_warn(reader, "%d particles; the emitters may want %.0f at once, and the rest is lost",
                             (int)scene->sim.capacity, expected + (double)listed);
    return SF_OK;
}
