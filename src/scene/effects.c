/* Effects become what the rest of the program knows already: emitters and lights of the scene, with a timing; and flashes and shakes. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/file.h"
#include "scene/effect_file.h"
#include "scene/vector.h"

static const double RADIANS = 3.14159265358979323846 / 180;
/* So many things are counted for the message, and no more. */
enum { COUNTED_MAX = 100000 };

enum { WANT_EMITTERS, WANT_LIGHTS, WANT_FLASHES, WANT_SHAKES, WANTS };

struct loader {
    struct sf_scene *scene;
    struct sf_param_reader *reader; /* the scene's, at the effect in hand */
    struct sf_effect_file *files;
    uint32_t own[WANTS], wanted[WANTS], counted; /* the scene's own; with those of effects */
};

/* Where and when an effect is played. */
struct stage {
    double position[3], cosine, sine, scale;
    double rotation; /* deg about +y */
    struct sf_timing timing;
    uint32_t index; /* of the scene's effects */
    const struct sf_effect_file *chain[SF_EFFECT_DEPTH_MAX + 1];
    uint32_t depth;
};

/* ---- places ---- */

static void turn(const struct stage *stage, const float v[3], double scale, double out[3])
{
    out[0] = scale * (stage->cosine * v[0] + stage->sine * v[2]);
    out[1] = scale * v[1];
    out[2] = scale * (stage->cosine * v[2] - stage->sine * v[0]);
}

static void turn_direction(const struct stage *stage, float v[3])
{
    double out[3];

    turn(stage, v, 1, out);
    for (int i = 0; i < 3; i++)
        v[i] = (float)out[i];
}

static void place(const struct stage *stage, const float at[3], double out[3])
{
    turn(stage, at, stage->scale, out);
    for (int i = 0; i < 3; i++)
        out[i] += stage->position[i];
}

static void set_stage(struct stage *stage, const double position[3], double rotation, double scale)
{
    memcpy(stage->position, position, sizeof stage->position);
    stage->rotation = rotation;
    stage->cosine = cos(rotation * RADIANS);
    stage->sine = sin(rotation * RADIANS);
    stage->scale = scale;
}

static void push_clock(struct sf_timing *timing, struct sf_clock clock)
{
    timing->clocks[timing->clock_count++] = clock;
}

/* ---- what a step becomes ---- */

/* Counts one; false when there is no room for it, which is told when all have been counted. */
static bool want(struct loader *loader, int what, uint32_t room)
{
    loader->counted++;
    return loader->wanted[what]++ < room;
}

static enum sf_status out_of_memory(const struct loader *loader)
{
    return sf_fail(loader->reader->log, SF_ERROR_MEMORY, "%s: out of memory", loader->reader->name);
}

static enum sf_status add_timing(struct loader *loader, const struct stage *stage, const struct sf_step *step,
                                 const struct sf_timing **out)
{
    struct sf_timing *timing = sf_arena_alloc(&loader->scene->arena, sizeof *timing);

    *out = timing;
    if (!timing)
        return out_of_memory(loader);
    *timing = stage->timing;
    push_clock(timing, step->clock);
    timing->fade_in = step->fade_in;
    timing->fade_out = step->fade_out;
    timing->easing = step->easing;
    return SF_OK;
}

static void scale_emitter(const struct stage *stage, struct sf_emitter *emitter)
{
    float scale = (float)stage->scale;
    double at[3];

    place(stage, emitter->position, at);
    for (int i = 0; i < 3; i++) {
        emitter->position[i] = (float)at[i];
        emitter->size[i] *= scale;
    }
    turn_direction(stage, emitter->direction);
    for (int i = 0; i < 2; i++) {
        emitter->speed[i] *= scale;
        emitter->particle_radius[i] *= scale;
    }
    emitter->rotation = emitter->kind == SF_EMITTER_BOX || emitter->kind == SF_EMITTER_MESH
                            ? (float)(emitter->rotation + stage->rotation)
                            : 0;
    emitter->radius *= scale;
    emitter->scale *= scale;
    emitter->growth *= scale;
    emitter->extinction /= scale;
}

/* Its files, path and messages are made to fit the scene. */
static enum sf_status add_emitter(struct loader *loader, const struct stage *stage, const struct sf_step *step,
                                  uint32_t index)
{
    const struct sf_effect_file *file = stage->chain[stage->depth - 1];
    struct sf_scene *scene = loader->scene;
    struct sf_emitter *emitter;
    char *beside = NULL;

    if (!want(loader, WANT_EMITTERS, SF_EMITTERS_MAX))
        return SF_OK;
    emitter = &scene->emitters[scene->emitter_count++];
    *emitter = step->emitter;
    scale_emitter(stage, emitter);
    emitter->origin = sf_arena_printf(&scene->arena, "/effects/%u (%s: /steps/%u/emitter)", (unsigned)stage->index,
                                      file->path, (unsigned)index);
    if (emitter->file) {
        beside = sf_path_beside(file->name, emitter->file);
        emitter->file = beside ? sf_arena_strdup(&scene->arena, beside) : NULL;
        free(beside);
    }
    if (emitter->path_count) {
        emitter->path = sf_arena_alloc(&scene->arena, emitter->path_count * sizeof *emitter->path);
        for (uint32_t i = 0; emitter->path && i < emitter->path_count; i++) {
            double at[3];

            turn(stage, step->emitter.path[i].position, stage->scale, at);
            emitter->path[i].time = step->emitter.path[i].time;
            for (int axis = 0; axis < 3; axis++)
                emitter->path[i].position[axis] = (float)at[axis];
        }
    }
    if (!emitter->origin || (step->emitter.file && !emitter->file) || (step->emitter.path && !emitter->path))
        return out_of_memory(loader);
    return add_timing(loader, stage, step, &emitter->timing);
}

static enum sf_status add_light(struct loader *loader, const struct stage *stage, const struct sf_step *step)
{
    struct sf_scene *scene = loader->scene;
    struct sf_light *light;
    double at[3];

    if (!want(loader, WANT_LIGHTS, SF_LIGHTS_MAX))
        return SF_OK;
    light = &scene->lights[scene->light_count++];
    *light = step->light;
    place(stage, light->position, at);
    for (int i = 0; i < 3 && light->kind != SF_LIGHT_DIRECTIONAL; i++)
        light->position[i] = (float)at[i];
    turn_direction(stage, light->direction);
    if (light->kind != SF_LIGHT_DIRECTIONAL)
        light->intensity *= (float)(stage->scale * stage->scale);
    light->flicker = step->flicker;
    light->frequency = step->frequency;
    return add_timing(loader, stage, step, &light->timing);
}

static enum sf_status add_flash(struct loader *loader, const struct stage *stage, const struct sf_step *step)
{
    struct sf_scene *scene = loader->scene;
    struct sf_flash *flash;

    if (!want(loader, WANT_FLASHES, SF_FLASHES_MAX))
        return SF_OK;
    flash = &scene->flashes[scene->flash_count++];
    *flash = step->flash;
    return add_timing(loader, stage, step, &flash->timing);
}

static enum sf_status add_shake(struct loader *loader, const struct stage *stage, const struct sf_step *step)
{
    struct sf_scene *scene = loader->scene;
    struct sf_shake *shake;

    if (!want(loader, WANT_SHAKES, SF_SHAKES_MAX))
        return SF_OK;
    shake = &scene->shakes[scene->shake_count++];
    *shake = step->shake;
    shake->frequency = step->frequency;
    return add_timing(loader, stage, step, &shake->timing);
}

/* ---- effects within effects ---- */

static enum sf_status play(struct loader *loader, const struct stage *stage);

/* Adds a file to the stage's chain. `named`: where its name stands. */
static enum sf_status enter(struct loader *loader, const struct sf_param_reader *named, const char *name,
                            struct stage *stage)
{
    const struct sf_effect_file *file;
    enum sf_status status;

    if (stage->depth == SF_EFFECT_DEPTH_MAX)
        return sf_param_reader_fail(named, "'%s' is an effect within %d others; %d deep is the most", name,
                                    SF_EFFECT_DEPTH_MAX, SF_EFFECT_DEPTH_MAX);
    status = sf_effect_file_get(loader->scene, named, name, &loader->files, &file);
    if (status != SF_OK)
        return status;
    for (uint32_t i = 0; i < stage->depth; i++)
        if (stage->chain[i]->device == file->device && stage->chain[i]->inode == file->inode)
            return sf_param_reader_fail(named, "'%s' is the effect that it is part of: it would never end; take it out",
                                        name);
    stage->chain[stage->depth++] = file;
    if (file->effect.duration > 0)
        push_clock(&stage->timing, (struct sf_clock){.duration = file->effect.duration,
                                                     .every = file->effect.loop ? file->effect.duration : 0});
    return SF_OK;
}

static enum sf_status play_nested(struct loader *loader, const struct stage *outer, const struct sf_step *step,
                                  uint32_t index)
{
    const struct sf_effect_file *file = outer->chain[outer->depth - 1];
    struct sf_param_reader named = {.name = file->path, .log = loader->reader->log};
    struct stage stage = *outer;
    char *name = sf_path_beside(file->name, step->file);
    double at[3];
    enum sf_status status;

    if (!name)
        return out_of_memory(loader);
    sf_param_reader_at(&named, "/steps/%u/file", (unsigned)index);
    push_clock(&stage.timing, step->clock);
    place(outer, step->position, at);
    set_stage(&stage, at, outer->rotation + step->rotation, outer->scale * step->scale);
    status = enter(loader, &named, name, &stage);
    free(name);
    return status == SF_OK ? play(loader, &stage) : status;
}

static enum sf_status play(struct loader *loader, const struct stage *stage)
{
    const struct sf_effect *effect = &stage->chain[stage->depth - 1]->effect;
    enum sf_status status = SF_OK;

    for (uint32_t i = 0; i < effect->step_count && status == SF_OK && loader->counted < COUNTED_MAX; i++) {
        const struct sf_step *step = &effect->steps[i];

        switch ((enum sf_step_kind)step->kind) {
        case SF_STEP_EMITTER:
            status = add_emitter(loader, stage, step, i);
            break;
        case SF_STEP_LIGHT:
            status = add_light(loader, stage, step);
            break;
        case SF_STEP_FLASH:
            status = add_flash(loader, stage, step);
            break;
        case SF_STEP_SHAKE:
            status = add_shake(loader, stage, step);
            break;
        case SF_STEP_EFFECT:
            status = play_nested(loader, stage, step, i);
            break;
        }
    }
    return status;
}

/* ---- the scene's list ---- */

static enum sf_status check_room(const struct loader *loader)
{
    static const struct {
        const char *name;
        uint32_t room;
    } things[WANTS] = {[WANT_EMITTERS] = {"emitters", SF_EMITTERS_MAX},
                       [WANT_LIGHTS] = {"lights", SF_LIGHTS_MAX},
                       [WANT_FLASHES] = {"flashes", SF_FLASHES_MAX},
                       [WANT_SHAKES] = {"shakes", SF_SHAKES_MAX}};

    sf_param_reader_at(loader->reader, "/effects");
    for (int i = 0; i < WANTS; i++)
        if (loader->wanted[i] > things[i].room)
            return sf_param_reader_fail(
                loader->reader, "%s%u %s of effects, with the scene's own %u, are more than %u; take effects out",
                loader->counted >= COUNTED_MAX ? "at least " : "", loader->wanted[i] - loader->own[i], things[i].name,
                loader->own[i], things[i].room);
    return SF_OK;
}

enum sf_status sf_scene_load_effects(struct sf_scene *scene, struct sf_param_reader *reader)
{
    struct loader loader = {.scene = scene, .reader = reader};
    enum sf_status status = SF_OK;

    loader.own[WANT_EMITTERS] = loader.wanted[WANT_EMITTERS] = scene->emitter_count;
    loader.own[WANT_LIGHTS] = loader.wanted[WANT_LIGHTS] = scene->light_count;
    for (uint32_t i = 0; i < scene->effect_count && status == SF_OK; i++) {
        const struct sf_placed_effect *placed = &scene->effects[i];
        struct stage stage = {.index = i};
        double at[3] = {placed->position[0], placed->position[1], placed->position[2]};
        char here[32];

        snprintf(here, sizeof here, "/effects/%u", (unsigned)i);
        status = sf_scene_check_clock(&placed->clock, reader, here);
        if (status != SF_OK)
            break;
        sf_param_reader_at(reader, "%s/file", here);
        push_clock(&stage.timing, placed->clock);
        set_stage(&stage, at, placed->rotation, placed->scale);
        status = enter(&loader, reader, placed->file, &stage);
        if (status == SF_OK)
            status = play(&loader, &stage);
    }
    return status == SF_OK ? check_room(&loader) : status;
}
