#include <stdlib.h>
#include <string.h>
#include "params/document.h"
#include "scene/effect.h"
#include "scene/table_inner.h"

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
        .effects = scene->effect_count,
        .flashes = scene->flash_count,
        .shakes = scene->shake_count,
        .meshes = scene->mesh_count,
        .exposure = scene->output.exposure,
        .tone = enum_name(sf_param_find(&sf_scene_group, "output")->group, "tone", scene->output.tone),
    };
    for (uint32_t i = 0; i < scene->emitter_count; i++)
        info->listed += scene->emitters[i].list_count;
}

static const struct sf_param_document scene_document = {
    .root = &sf_scene_group,
    .intro =
        (const char *const[]){
            "# Parameters",
            "",
            "Generated from the table of parameters by `sfumato params --format markdown`; a test compares.",
            "",
            "Every key of a scene file, by object. [scene.md](scene.md) says what they mean together. The same names",
            "serve `--set`, with dots: `--set thick.steps=24`, `--set lights.0.intensity=3`,",
            "`--set medium.albedo=0.9,0.9,0.8`. `types` are the values of the object's `type` that take the key. "
            "`renews`",
            "is the most that a change while running makes anew: the simulation from its beginning, the frame's graph, "
            "or",
            "what was read from files; nothing where empty.",
            NULL,
        },
    .title = "sfumato scene",
    .made_by = "sfumato params --format json-schema",
};

static const struct sf_param_document effect_document = {
    .root = &sf_effect_group,
    .intro =
        (const char *const[]){
            "# Keys of effect files",
            "",
            "Generated from the table of parameters by `sfumato params --effects --format markdown`; a test compares.",
            "[effects.md](effects.md) says what they mean together.",
            NULL,
        },
    .title = "sfumato effect",
    .made_by = "sfumato params --effects --format json-schema",
    .elsewhere =
        {
            {&sf_scene_emitter_group, "As [an element of a scene's `emitters`](params.md#emitters); `start`, "
                                      "`duration` and the times of its `path` "
                                      "count from the step's beginning."},
            {&sf_scene_light_group, "As [an element of a scene's `lights`](params.md#lights)."},
        },
};

enum sf_status sf_params_print(const char *format, const struct sf_log *log, char **text)
{
    static const struct {
        const char *name;
        void (*write)(const struct sf_param_document *document, struct sf_text *text);
        const struct sf_param_document *document;
    } formats[] = {
        {"text", sf_param_document_text, &scene_document},
        {"json-schema", sf_param_document_schema, &scene_document},
        {"markdown", sf_param_document_markdown, &scene_document},
        {"effect-text", sf_param_document_text, &effect_document},
        {"effect-json-schema", sf_param_document_schema, &effect_document},
        {"effect-markdown", sf_param_document_markdown, &effect_document},
    };
    struct sf_text out = {0}, names = {0};

    *text = NULL;
    for (size_t i = 0; i < SF_COUNT(formats); i++) {
        sf_text_printf(&names, "%s%s", i ? ", " : "", formats[i].name);
        if (strcmp(formats[i].name, format) != 0)
            continue;
        sf_text_finish(&names);
        formats[i].write(formats[i].document, &out);
        if (out.failed) {
            sf_text_finish(&out);
            return sf_fail(log, SF_ERROR_MEMORY, "parameters: out of memory");
        }
        *text = out.data;
        return SF_OK;
    }
    sf_fail(log, SF_ERROR_USAGE, "unknown format '%s' (%s)", format, names.failed ? "" : names.data);
    sf_text_finish(&names);
    return SF_ERROR_USAGE;
}
