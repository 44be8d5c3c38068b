#include "scene/effect_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include "base/file.h"
#include "base/hash.h"

enum { EFFECT_BYTES_MAX = 4 << 20, AT_BYTES = 32 };
static const float LEAST_EVERY = 0.02f; /* s */

/* ---- checking ---- */

enum sf_status sf_scene_check_clock(const struct sf_clock *clock, struct sf_param_reader *reader, const char *at)
{
    if (clock->every > 0 && clock->every < LEAST_EVERY) {
        sf_param_reader_at(reader, "%s/every", at);
        return sf_param_reader_fail(reader, "%g s is too short; %g s is the least, and 0 is once", clock->every,
                                    LEAST_EVERY);
    }
    if (clock->every > 0 && clock->duration > clock->every) {
        sf_param_reader_at(reader, "%s/duration", at);
        return sf_param_reader_fail(reader, "%g s is longer than every (%g s): it would begin again before it ends",
                                    clock->duration, clock->every);
    }
    if (clock->times > 0 && !(clock->every > 0)) {
        sf_param_reader_at(reader, "%s/times", at);
        return sf_param_reader_fail(reader, "%d times needs every, the time from one to the next", clock->times);
    }
    return SF_OK;
}

static enum sf_status check_fades(const struct sf_step *step, struct sf_param_reader *reader, const char *at)
{
    double run = sf_clock_run(&step->clock);

    if (step->fade_out > 0 && !isfinite(run)) {
        sf_param_reader_at(reader, "%s/fade_out", at);
        return sf_param_reader_fail(reader, "the step goes on for ever; give it a duration");
    }
    if ((double)step->fade_in + step->fade_out > run * (1 + 1e-6)) {
        sf_param_reader_at(reader, "%s", at);
        return sf_param_reader_fail(reader, "fade_in and fade_out (%g s and %g s) are longer than the step, %g s",
                                    step->fade_in, step->fade_out, run);
    }
    return SF_OK;
}

static enum sf_status check_step(const struct sf_scene *scene, struct sf_step *step, struct sf_param_reader *reader,
                                 uint32_t index)
{
    char at[AT_BYTES], deeper[2 * AT_BYTES];
    enum sf_status status;

    snprintf(at, sizeof at, "/steps/%u", (unsigned)index);
    status = sf_scene_check_clock(&step->clock, reader, at);
    if (status == SF_OK)
        status = check_fades(step, reader, at);
    if (status != SF_OK)
        return status;
    if (step->kind == SF_STEP_LIGHT) {
        snprintf(deeper, sizeof deeper, "%s/light", at);
        return sf_scene_check_light(&step->light, reader, deeper);
    }
    if (step->kind != SF_STEP_EMITTER)
        return SF_OK;
    if (step->emitter.kind == SF_EMITTER_LIST) {
        sf_param_reader_at(reader, "%s/emitter/type", at);
        return sf_param_reader_fail(reader, "list cannot be a step of an effect; cone, sphere, box and mesh can");
    }
    snprintf(deeper, sizeof deeper, "%s/emitter", at);
    return sf_scene_check_emitter(scene, &step->emitter, reader, deeper);
}

static enum sf_status check_effect(const struct sf_scene *scene, struct sf_effect *effect,
                                   struct sf_param_reader *reader)
{
    enum sf_status status = SF_OK;

    sf_param_reader_at(reader, "/loop");
    if (effect->loop && !(effect->duration > 0))
        return sf_param_reader_fail(reader, "needs a duration, after which it begins again");
    sf_param_reader_at(reader, "/duration");
    if (effect->loop && effect->duration < LEAST_EVERY)
        return sf_param_reader_fail(reader, "%g s is too short for loop; %g s is the least", effect->duration,
                                    LEAST_EVERY);
    for (uint32_t i = 0; i < effect->step_count && status == SF_OK; i++)
        status = check_step(scene, &effect->steps[i], reader, i);
    return status;
}

/* ---- reading ---- */

static enum sf_status parse(struct sf_scene *scene, const struct sf_log *log, const char *text, size_t bytes,
                            struct sf_effect_file *file)
{
    struct sf_param_reader reader = {.name = file->path, .log = log, .arena = &scene->arena};
    uint64_t hash;
    json_t *tree;
    enum sf_status status = sf_scene_parse_json(file->path, "an effect", text, bytes, log, &tree);

    if (status != SF_OK)
        return status;
    status = sf_param_read(&reader, &sf_effect_group, tree, &file->effect);
    if (status == SF_OK)
        status = check_effect(scene, &file->effect, &reader);
    if (status == SF_OK)
        status = sf_scene_hash_tree(file->path, tree, log, &hash);
    if (status == SF_OK)
        scene->hash = sf_hash_bytes(&hash, sizeof hash, scene->hash);
    json_decref(tree);
    return status;
}

static enum sf_status read_file(struct sf_scene *scene, const struct sf_param_reader *named,
                                struct sf_effect_file *file)
{
    struct sf_listener listener;
    struct stat about;
    char *text = NULL;
    size_t bytes = 0;
    enum sf_status status;

    sf_listener_init(&listener, named);
    status = sf_listener_retell(&listener, sf_file_read(file->path, EFFECT_BYTES_MAX, &listener.log, &text, &bytes));
    if (status == SF_OK && stat(file->path, &about) == 0) {
        file->device = about.st_dev;
        file->inode = about.st_ino;
    }
    if (status == SF_OK)
        status = parse(scene, named->log, text, bytes, file);
    free(text);
    return status;
}

enum sf_status sf_effect_file_get(struct sf_scene *scene, const struct sf_param_reader *named, const char *name,
                                  struct sf_effect_file **files, const struct sf_effect_file **out)
{
    struct sf_effect_file *file;
    char *path;
    enum sf_status status;

    for (file = *files; file; file = file->next) {
        *out = file;
        if (strcmp(file->name, name) == 0)
            return SF_OK;
    }
    file = sf_arena_alloc(&scene->arena, sizeof *file);
    path = sf_path_beside(scene->path, name);
    if (file) {
        file->name = sf_arena_strdup(&scene->arena, name);
        file->path = path ? sf_arena_strdup(&scene->arena, path) : NULL;
    }
    free(path);
    if (!file || !file->name || !file->path)
        return sf_fail(named->log, SF_ERROR_MEMORY, "%s: out of memory", named->name);
    status = read_file(scene, named, file);
    file->next = *files;
    *files = file;
    *out = file;
    return status;
}
