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

void sf_param_document_text(const struct sf_param_document *document, struct sf_text *text)
{
    text_group("", document->root, text);
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

/* What stands in the place of the group's table, or NULL. */
static const char *elsewhere(const struct sf_param_document *document, const struct sf_param_group *group)
{
    for (size_t i = 0; i < SF_COUNT(document->elsewhere) && document->elsewhere[i].group; i++)
        if (document->elsewhere[i].group == group)
            return document->elsewhere[i].text;
    return NULL;
}

static void markdown_group(const struct sf_param_document *document, const char *path,
                           const struct sf_param_group *group, unsigned inherited, struct sf_text *text)
{
    bool typed = sf_param_kind(group) != NULL, outermost = group == document->root;
    const char *other = elsewhere(document, group);

    if (other) {
        sf_text_printf(text, "\n## %s\n\n%s\n", path, other);
        return;
    }
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
        sf_text_printf(&deeper, "%s%s%s%s", outermost ? "" : path, outermost ? "" : ".", row->key,
                       row->type == SF_PARAM_LIST ? "[]" : "");
        if (deeper.failed)
            text->failed = true;
        else
            markdown_group(document, deeper.data, row->group, inherited | row->rebuild, text);
        sf_text_finish(&deeper);
    }
}

void sf_param_document_markdown(const struct sf_param_document *document, struct sf_text *text)
{
    for (size_t i = 0; document->intro[i]; i++)
        sf_text_printf(text, "%s\n", document->intro[i]);
    markdown_group(document, document->root->name, document->root, 0, text);
}
