#include <stdlib.h>
#include <string.h>
#include "params/document.h"
#include "scene/scene.h"
#include "scene/table.h"

static const char *enum_name(const struct sf_param_group *group, const char *key, int32_t value)
{
    return sf_param_find(group, key)->names[value];
}

void sf_scene_describe(const struct sf_scene *scene, struct sf_scene_info *info)
{
    *info = (struct sf_scene_info){
        .path = scene->path,
        .method = enum_name(&sf_scene_group, "method", scene->method),
        .hash = scene->hash,
        .fps = scene->sim.fps,
        .capacity = (uint32_t)scene->sim.capacity,
        .lights = scene->light_count,
        .objects = scene->object_count,
        .emitters = scene->emitter_count,
        .forces = scene->force_count,
        .meshes = scene->mesh_count,
        .exposure = scene->output.exposure,
        .tone = enum_name(sf_param_find(&sf_scene_group, "output")->group, "tone", scene->output.tone),
    };
    for (uint32_t i = 0; i < scene->emitter_count; i++)
        info->listed += scene->emitters[i].list_count;
}

enum sf_status sf_params_print(const char *format, const struct sf_log *log, char **text)
{
    static const struct {
        const char *name;
        void (*write)(const struct sf_param_group *root, struct sf_text *text);
    } formats[] = {
        {"text", sf_param_document_text},
        {"json-schema", sf_param_document_schema},
        {"markdown", sf_param_document_markdown},
    };
    struct sf_text out = {0};

    *text = NULL;
    for (size_t i = 0; i < SF_COUNT(formats); i++) {
        if (strcmp(formats[i].name, format) != 0)
            continue;
        formats[i].write(&sf_scene_group, &out);
        if (out.failed) {
            sf_text_finish(&out);
            return sf_fail(log, SF_ERROR_MEMORY, "parameters: out of memory");
        }
        *text = out.data;
        return SF_OK;
    }
    return sf_fail(log, SF_ERROR_USAGE, "unknown format '%s' (text, json-schema, markdown)", format);
}
