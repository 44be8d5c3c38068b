#include "params/document.h"

#include <string.h>
#include "params/number.h"

static const char *type_name(const struct sf_param *row)
{
    static const char *const names[] = {
        [SF_PARAM_BOOL] = "true/false",   [SF_PARAM_INT] = "whole number",
        [SF_PARAM_FLOAT] = "number",      [SF_PARAM_VEC3] = "three numbers",
        [SF_PARAM_COLOR] = "colour",      [SF_PARAM_ENUM] = "name",
        [SF_PARAM_STRING] = "string",     [SF_PARAM_RANGE] = "one or two numbers",
        [SF_PARAM_FILES] = "six strings", [SF_PARAM_OBJECT] = "object",
        [SF_PARAM_LIST] = "list",
    };
    return names[row->type];
}

/* The default as --set would take it; "required"; or nothing. */
static void default_text(const struct sf_param *row, struct sf_text *text)
{
    union {
        float numbers[3];
        int32_t whole;
        bool truth;
    } field;
    struct sf_param loose = *row;

    if (row->required) {
        sf_text_append(text, "required");
        return;
    }
    if (!sf_param_components(row))
        return;
    loose.offset = 0;
    sf_param_store(&loose, row->value, &field);
    if (row->type == SF_PARAM_RANGE && field.numbers[0] == field.numbers[1])
        loose.type = SF_PARAM_FLOAT;
    sf_param_print(&loose, &field, text);
}

/* "1 to 170 deg", the names of an enum, or nothing. */
static void allowed_text(const struct sf_param *row, struct sf_text *text)
{
    char range[SF_PARAM_RANGE_BYTES];

    if (row->type == SF_PARAM_ENUM) {
        sf_param_names_text(row, text);
    } else if (row->type == SF_PARAM_LIST) {
        sf_text_printf(text, "%u to %u elements", (unsigned)row->list_min, (unsigned)row->list_max);
    } else if (sf_param_components(row) && row->type != SF_PARAM_BOOL) {
        sf_param_range_text(row, range);
        sf_text_append(text, range);
    }
}

/* ---- text ---- */

static void text_line(const char *prefix, const struct sf_param *row, struct sf_text *text)
{
    struct sf_text name = {0}, value = {0}, allowed = {0};

    sf_text_printf(&name, "%s%s", prefix, row->key);
    default_text(row, &value);
    allowed_text(row, &allowed);
    if (name.failed || value.failed || allowed.failed)
        text->failed = true;
    else
        sf_text_printf(text, "  %-28s %-16s %s%s%s%s%s%s%s\n", name.data, value.data ? value.data : "", row->doc,
                       allowed.data ? " [" : "", allowed.data ? allowed.data : "", allowed.data ? "]" : "",
                       row->only_for ? " (type: " : "", row->only_for ? row->only_for : "", row->only_for ? ")" : "");
    sf_text_finish(&name);
    sf_text_finish(&value);
    sf_text_finish(&allowed);
}

static void text_group(const char *prefix, const struct sf_param_group *group, struct sf_text *text)
{
    sf_text_printf(text, "%s%s\n", text->length ? "\n" : "", group->doc);
    for (size_t i = 0; i < group->count; i++)
        if (!group->rows[i].group)
            text_line(prefix, &group->rows[i], text);
    for (size_t i = 0; i < group->count; i++) {
        const struct sf_param *row = &group->rows[i];
        struct sf_text deeper = {0};

        if (!row->group)
            continue;
        sf_text_printf(&deeper, "%s%s.%s", prefix, row->key, row->type == SF_PARAM_LIST ? "N." : "");
        if (deeper.failed)
            text->failed = true;
        else
            text_group(deeper.data, row->group, text);
        sf_text_finish(&deeper);
    }
}

void sf_param_document_text(const struct sf_param_group *root, struct sf_text *text)
{
    text_group("", root, text);
}

/* ---- markdown ---- */

/* `inherited`: the bits of the lists and objects that the row stands in. */
static void markdown_row(const struct sf_param *row, bool typed, unsigned inherited, struct sf_text *text)
{
    unsigned bits = row->rebuild | inherited;

    if (row->type == SF_PARAM_LIST) /* a list that grows or shrinks */
        bits |= sf_param_rebuild_all(row->group);
    sf_text_printf(text, "| `%s` | %s | ", row->key, type_name(row));
    default_text(row, text);
    sf_text_append(text, " | ");
    allowed_text(row, text);
    if (typed)
        sf_text_printf(text, " | %s", row->only_for ? row->only_for : "all");
    sf_text_printf(text, " | %s | %s |\n", sf_param_renews(bits), row->doc);
}

static void markdown_group(const char *path, const struct sf_param_group *group, unsigned inherited,
                           struct sf_text *text)
{
    bool typed = sf_param_kind(group) != NULL;

    sf_text_printf(text, "\n## %s\n\n%s\n\n", path, group->doc);
    sf_text_printf(text, "| key | value | default | allowed%s | renews | meaning |\n|---|---|---|---%s|---|---|\n",
                   typed ? " | types" : "", typed ? "|---" : "");
    for (size_t i = 0; i < group->count; i++)
        markdown_row(&group->rows[i], typed, inherited, text);
    for (size_t i = 0; i < group->count; i++) {
        const struct sf_param *row = &group->rows[i];
        struct sf_text deeper = {0};

        if (!row->group)
            continue;
        sf_text_printf(&deeper, "%s%s%s%s", strcmp(path, "scene") == 0 ? "" : path,
                       strcmp(path, "scene") == 0 ? "" : ".", row->key, row->type == SF_PARAM_LIST ? "[]" : "");
        if (deeper.failed)
            text->failed = true;
        else
            markdown_group(deeper.data, row->group, inherited | row->rebuild, text);
        sf_text_finish(&deeper);
    }
}

void sf_param_document_markdown(const struct sf_param_group *root, struct sf_text *text)
{
    static const char *const intro[] = {
        "# Parameters",
        "",
        "Generated from the table of parameters by `sfumato params --format markdown`; a test compares.",
        "",
        "Every key of a scene file, by object. [scene.md](scene.md) says what they mean together. The same names",
        "serve `--set`, with dots: `--set thick.steps=24`, `--set lights.0.intensity=3`,",
        "`--set medium.albedo=0.9,0.9,0.8`. `types` are the values of the object's `type` that take the key. `renews`",
        "is the most that a change while running makes anew: the simulation from its beginning, the frame's graph, or",
        "what was read from files; nothing where empty.",
    };

    for (size_t i = 0; i < SF_COUNT(intro); i++)
        sf_text_printf(text, "%s\n", intro[i]);
    markdown_group("scene", root, 0, text);
}
