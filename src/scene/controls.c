/* A scene's parameters one by one, and a control as the set that gives it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "params/number.h"
#include "scene/scene.h"
#include "scene/table.h"

enum { PATH_BYTES = 128 };

/* The table is gone through twice: once to count (no controls yet), once to write. */
struct lister {
    struct sf_control *controls;
    char *text; /* free bytes behind the controls */
    size_t count, bytes;
};

static const char *keep(struct lister *lister, const char *string)
{
    size_t bytes = strlen(string) + 1;

    lister->bytes += bytes;
    if (!lister->controls)
        return NULL;
    lister->text += bytes;
    return memcpy(lister->text - bytes, string, bytes);
}

static enum sf_control_kind kind_of(const struct sf_param *row)
{
    switch (row->type) {
    case SF_PARAM_BOOL:
        return SF_CONTROL_BOOL;
    case SF_PARAM_INT:
        return SF_CONTROL_INT;
    case SF_PARAM_VEC3:
        return SF_CONTROL_VECTOR;
    case SF_PARAM_COLOR:
        return SF_CONTROL_COLOR;
    case SF_PARAM_RANGE:
        return SF_CONTROL_RANGE;
    case SF_PARAM_ENUM:
        return SF_CONTROL_CHOICE;
    case SF_PARAM_STRING:
        return SF_CONTROL_TEXT;
    default:
        return SF_CONTROL_FLOAT;
    }
}

/* The numbers as the row's field would hold them. */
static void hold(const struct sf_param *row, const double given[3], double held[3])
{
    struct {
        float field[3];
    } place = {{0}};
    struct sf_param loose = *row;

    loose.offset = 0;
    sf_param_store(&loose, given, &place);
    sf_param_fetch(&loose, &place, held);
}

static void fill(const struct sf_param *row, const void *object, struct sf_control *control)
{
    const double low[3] = {row->min, row->min, row->min}, high[3] = {row->max, row->max, row->max};
    double limit[3];

    control->numbers = sf_param_components(row);
    if (row->type == SF_PARAM_STRING) {
        memcpy(&control->text, (const char *)object + row->offset, sizeof control->text);
        return;
    }
    sf_param_fetch(row, object, control->value);
    hold(row, row->value, control->usual);
    hold(row, low, limit);
    control->min = limit[0];
    hold(row, high, limit);
    control->max = limit[0];
    for (uint32_t i = 0; row->type == SF_PARAM_ENUM && row->names[i]; i++)
        control->max = i;
}

static void add_control(struct lister *lister, const struct sf_param *row, const void *object, const char *group,
                        const char *kept_group, unsigned bits)
{
    char path[PATH_BYTES];
    const char *kept;

    snprintf(path, sizeof path, "%s%s%s", group, *group ? "." : "", row->key);
    kept = keep(lister, path);
    if (lister->controls) {
        struct sf_control *control = &lister->controls[lister->count];

        *control = (struct sf_control){
            .path = kept,
            .group = kept_group,
            .key = row->key,
            .unit = row->unit,
            .doc = row->doc,
            .renews = sf_param_renews(bits),
            .kind = kind_of(row),
            .required = row->required,
            .choices = row->type == SF_PARAM_ENUM ? row->names : NULL,
        };
        fill(row, object, control);
    }
    lister->count++;
}

static void list_group(struct lister *lister, const struct sf_param_group *group, const void *object, const char *path,
                       unsigned inherited);

static void list_elements(struct lister *lister, const struct sf_param *row, const void *object, const char *path,
                          unsigned bits)
{
    const char *elements = (const char *)object + row->offset;
    char element[PATH_BYTES];
    uint32_t count;

    memcpy(&count, (const char *)object + row->count_offset, sizeof count);
    if (count > SF_CONTROLS_LIST_MAX)
        return;
    if (row->list_pointer)
        memcpy(&elements, (const char *)object + row->offset, sizeof elements);
    for (uint32_t i = 0; i < count; i++) {
        snprintf(element, sizeof element, "%.96s.%u", path, (unsigned)i);
        list_group(lister, row->group, elements + i * row->group->size, element, bits);
    }
}

/* `inherited`: the bits of the lists and objects that the group stands in. */
static void list_group(struct lister *lister, const struct sf_param_group *group, const void *object, const char *path,
                       unsigned inherited)
{
    const struct sf_param *types = sf_param_kind(group);
    const char *kept = keep(lister, path);
    double kind[3] = {0};

    if (types)
        sf_param_fetch(types, object, kind);
    for (size_t i = 0; i < group->count; i++) {
        const struct sf_param *row = &group->rows[i];
        unsigned bits = row->rebuild | inherited;
        char deeper[PATH_BYTES];

        if (!sf_param_applies(group, row, (int32_t)kind[0]) || row->type == SF_PARAM_FILES)
            continue;
        snprintf(deeper, sizeof deeper, "%.96s%s%.30s", path, *path ? "." : "", row->key);
        if (row->type == SF_PARAM_LIST)
            list_elements(lister, row, object, deeper, bits);
        else if (row->type == SF_PARAM_OBJECT)
            list_group(lister, row->group, (const char *)object + row->offset, deeper, bits);
        else
            add_control(lister, row, object, path, kept, bits);
    }
}

enum sf_status sf_scene_controls(const struct sf_scene *scene, const struct sf_log *log, struct sf_control **controls,
                                 uint32_t *count)
{
    const struct sf_scene *stated = scene->stated ? scene->stated : scene;
    struct lister measure = {0}, writer = {0};

    *count = 0;
    list_group(&measure, &sf_scene_group, stated, "", 0);
    *controls = writer.controls = malloc(measure.count * sizeof **controls + measure.bytes);
    if (!writer.controls)
        return sf_fail(log, SF_ERROR_MEMORY, "%s: out of memory for its parameters", scene->path);
    writer.text = (char *)(writer.controls + measure.count);
    list_group(&writer, &sf_scene_group, stated, "", 0);
    *count = (uint32_t)writer.count;
    return SF_OK;
}

static const char *choice_name(const struct sf_control *control)
{
    for (uint32_t i = 0; control->choices && control->choices[i]; i++)
        if (control->value[0] == i)
            return control->choices[i];
    return "";
}

char *sf_control_print(const struct sf_control *control)
{
    char number[SF_NUMBER_BYTES];
    struct sf_text text = {0};

    sf_text_printf(&text, "%s=", control->path);
    switch (control->kind) {
    case SF_CONTROL_BOOL:
        sf_text_append(&text, control->value[0] != 0 ? "true" : "false");
        break;
    case SF_CONTROL_INT:
        sf_text_printf(&text, "%.0f", control->value[0] + 0.0); /* -0 becomes 0 */
        break;
    case SF_CONTROL_CHOICE:
        sf_text_append(&text, choice_name(control));
        break;
    case SF_CONTROL_TEXT:
        sf_text_append(&text, control->text ? control->text : "");
        break;
    default:
        for (uint32_t i = 0; i < control->numbers; i++) {
            sf_number_print((float)control->value[i], number);
            sf_text_append(&text, i ? "," : "");
            sf_text_append(&text, number);
        }
    }
    if (text.failed)
        sf_text_finish(&text);
    return text.data;
}
