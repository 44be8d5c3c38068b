/* What effects do to a scene at a moment: lights that come and go, flashes, a camera that shakes. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "scene/scene.h"
#include "scene/vector.h"
#include "scene/moment.h"

static const double RADIANS = 3.14159265358979323846 / 180;

/* Purposes of random numbers, above those of particles and forces. A shake takes six. */
enum { PURPOSE_FLICKER = 0x20000, PURPOSE_SHAKE = 0x20100 };

const char *sf_emitter_place(const struct sf_scene *scene, uint32_t emitter, char buffer[SF_PLACE_BYTES])
{
    if (scene->emitters[emitter].origin)
        return scene->emitters[emitter].origin;
    snprintf(buffer, SF_PLACE_BYTES, "/emitters/%u", (unsigned)emitter);
    return buffer;
}

double sf_emitter_stream(const struct sf_emitter *emitter, double local)
{
    double end = emitter->duration > 0 ? fmin(local, (double)emitter->start + emitter->duration) : local;

    if (!(end > emitter->start))
        return 0;
    return emitter->rate *
           (sf_timing_integral(emitter->timing, end) - sf_timing_integral(emitter->timing, emitter->start));
}

void sf_scene_lights(const struct sf_scene *scene, double time, struct sf_light lights[SF_LIGHTS_MAX])
{
    uint32_t seed = (uint32_t)scene->sim.seed;

    for (uint32_t i = 0; i < scene->light_count; i++) {
        const struct sf_light *light = &scene->lights[i];
        double local, strength;

        lights[i] = *light;
        if (!light->timing)
            continue;
        if (!sf_timing_at(light->timing, time + scene->sim.preroll, &local, &strength))
            strength = 0;
        if (strength > 0 && light->flicker > 0)
            strength *=
                1 - light->flicker * (0.5 + 0.5 * sf_unsteady(seed, PURPOSE_FLICKER + i, local * light->frequency));
        lights[i].intensity = (float)(light->intensity * strength);
        lights[i].timing = NULL;
    }
}

void sf_scene_flash(const struct sf_scene *scene, double time, float rgb[3])
{
    double sum[3] = {0};

    for (uint32_t i = 0; i < scene->flash_count; i++) {
        const struct sf_flash *flash = &scene->flashes[i];
        double local, strength;

        if (!sf_timing_at(flash->timing, time + scene->sim.preroll, &local, &strength))
            continue;
        for (int c = 0; c < 3; c++)
            sum[c] += strength * flash->strength * flash->color[c];
    }
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)sum[c];
}

/* How far all that shakes at the moment moves the eye (m) and turns it (rad): to the right, up, forward. False: not at all. */
static bool shaken(const struct sf_scene *scene, double time, double move[3], double turn[3])
{
    uint32_t seed = (uint32_t)scene->sim.seed;
    bool any = false;

    for (uint32_t i = 0; i < scene->shake_count; i++) {
        const struct sf_shake *shake = &scene->shakes[i];
        double local, strength;

        if (!sf_timing_at(shake->timing, time + scene->sim.preroll, &local, &strength))
            continue;
        any = any || strength > 0;
        for (uint32_t axis = 0; axis < 3; axis++) {
            uint32_t purpose = PURPOSE_SHAKE + 6 * i + axis;

            move[axis] += strength * shake->amplitude * sf_unsteady(seed, purpose, local * shake->frequency);
            turn[axis] += strength * shake->angle * RADIANS * sf_unsteady(seed, purpose + 3, local * shake->frequency);
        }
    }
    return any;
}

void sf_pose_shake(const struct sf_scene *scene, double time, struct sf_camera_pose *pose)
{
    double move[3] = {0}, turn[3] = {0}, far;
    float view[3], right[3], up[3];

    if (scene->shake_count == 0 || !shaken(scene, time, move, turn))
        return;
    sf_subtract(pose->target, pose->eye, view);
    far = sf_length(view);
    sf_normalize(view);
    sf_cross(view, pose->up, right);
    if (!sf_normalize(right))
        return; /* it looks along up */
    sf_cross(right, view, up);
    for (int i = 0; i < 3; i++) {
        double step = move[0] * right[i] + move[1] * up[i] + move[2] * view[i];

        pose->eye[i] = (float)(pose->eye[i] + step);
        pose->target[i] = (float)(pose->target[i] + step + far * (tan(turn[0]) * right[i] + tan(turn[1]) * up[i]));
        pose->up[i] = (float)(cos(turn[2]) * up[i] + sin(turn[2]) * right[i]);
    }
}
