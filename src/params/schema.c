/* The JSON Schema of scene and effect files. jansson builds it, so that it is JSON whatever the rows say; every failure of an
 * allocation surfaces as a NULL that the setters refuse, and shows in the end as text->failed. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "params/document.h"
#include <jansson.h>

static json_t *number(double value)
{
    return value == floor(value) && fabs(value) < 1e15 ? json_integer((json_int_t)value) : json_real(value);
}

struct builder {
    bool failed;
};

/* Takes `value`. */
static void put(struct builder *builder, json_t *object, const char *key, json_t *value)
{
    if (json_object_set_new(object, key, value) != 0)
        builder->failed = true;
}

static void append(struct builder *builder, json_t *array, json_t *value)
{
    if (json_array_append_new(array, value) != 0)
        builder->failed = true;
}

static json_t *group_schema(struct builder *builder, const struct sf_param_group *group, bool outermost);

static json_t *bounded(struct builder *builder, const struct sf_param *row)
{
    json_t *schema = json_object();

    put(builder, schema, "type", json_string(row->type == SF_PARAM_INT ? "integer" : "number"));
    put(builder, schema, "minimum", number(row->min));
    put(builder, schema, "maximum", number(row->max));
    return schema;
}

static json_t *list_of(struct builder *builder, json_t *items, unsigned min, unsigned max)
{
    json_t *schema = json_object();

    put(builder, schema, "type", json_string("array"));
    put(builder, schema, "items", items);
    put(builder, schema, "minItems", json_integer(min));
    put(builder, schema, "maxItems", json_integer(max));
    return schema;
}

static json_t *text_schema(struct builder *builder)
{
    json_t *schema = json_object();

    put(builder, schema, "type", json_string("string"));
    put(builder, schema, "minLength", json_integer(1));
    return schema;
}

static json_t *value_schema(struct builder *builder, const struct sf_param *row)
{
    json_t *schema, *choices;

    switch (row->type) {
    case SF_PARAM_BOOL:
        schema = json_object();
        put(builder, schema, "type", json_string("boolean"));
        return schema;
    case SF_PARAM_INT:
    case SF_PARAM_FLOAT:
        return bounded(builder, row);
    case SF_PARAM_VEC3:
    case SF_PARAM_COLOR:
        return list_of(builder, bounded(builder, row), 3, 3);
    case SF_PARAM_RANGE:
        schema = json_object();
        choices = json_array();
        append(builder, choices, bounded(builder, row));
        append(builder, choices, list_of(builder, bounded(builder, row), 2, 2));
        put(builder, schema, "anyOf", choices);
        return schema;
    case SF_PARAM_ENUM:
        schema = json_object();
        choices = json_array();
        for (size_t i = 0; row->names[i]; i++)
            append(builder, choices, json_string(row->names[i]));
        put(builder, schema, "enum", choices);
        return schema;
    case SF_PARAM_FILES:
        return list_of(builder, text_schema(builder), 6, 6);
    case SF_PARAM_OBJECT:
        return group_schema(builder, row->group, false);
    case SF_PARAM_LIST:
        return list_of(builder, group_schema(builder, row->group, false), row->list_min, row->list_max);
    case SF_PARAM_STRING:
        break;
    }
    return text_schema(builder);
}

static json_t *default_json(struct builder *builder, const struct sf_param *row)
{
    unsigned n = sf_param_components(row);
    json_t *list;

    if (row->type == SF_PARAM_BOOL)
        return json_boolean(row->value[0] != 0);
    if (row->type == SF_PARAM_ENUM)
        return json_string(row->names[(int)row->value[0]]);
    if (n == 1)
        return number(row->value[0]);
    list = json_array();
    for (unsigned i = 0; i < n; i++)
        append(builder, list, number(row->value[i]));
    return list;
}

static json_t *row_schema(struct builder *builder, const struct sf_param *row)
{
    json_t *schema = value_schema(builder, row);
    struct sf_text doc = {0};

    sf_text_printf(&doc, "%s%s%s%s", row->doc, row->unit && *row->unit ? " (" : "", row->unit ? row->unit : "",
                   row->unit && *row->unit ? ")" : "");
    if (doc.failed)
        builder->failed = true;
    else
        put(builder, schema, "description", json_string(doc.data));
    sf_text_finish(&doc);
    if (!row->required && sf_param_components(row))
        put(builder, schema, "default", default_json(builder, row));
    return schema;
}

/* An object of one type (`types` NULL: of a group without types). */
static json_t *variant_schema(struct builder *builder, const struct sf_param_group *group, const struct sf_param *types,
                              int32_t kind, bool outermost)
{
    json_t *schema = json_object(), *properties = json_object(), *required = json_array();

    put(builder, schema, "type", json_string("object"));
    if (!types)
        put(builder, schema, "description", json_string(group->doc));
    put(builder, properties, "//", json_object());
    if (outermost)
        put(builder, properties, "$schema", text_schema(builder));
    for (size_t i = 0; i < group->count; i++) {
        const struct sf_param *row = &group->rows[i];

        if (!sf_param_applies(group, row, kind))
            continue;
        if (row == types) {
            json_t *constant = json_object();

            put(builder, constant, "const", json_string(types->names[kind]));
            put(builder, constant, "description", json_string(row->doc));
            put(builder, properties, row->key, constant);
        } else {
            put(builder, properties, row->key, row_schema(builder, row));
        }
        /* The one type that may go unnamed is the default. */
        if (row->required || (row == types && kind != (int32_t)types->value[0]))
            append(builder, required, json_string(row->key));
    }
    put(builder, schema, "properties", properties);
    if (json_array_size(required))
        put(builder, schema, "required", required);
    else
        json_decref(required);
    put(builder, schema, "additionalProperties", json_false());
    return schema;
}

static json_t *group_schema(struct builder *builder, const struct sf_param_group *group, bool outermost)
{
    const struct sf_param *types = sf_param_kind(group);
    json_t *schema, *variants;

    if (!types)
        return variant_schema(builder, group, NULL, 0, outermost);
    schema = json_object();
    variants = json_array();
    put(builder, schema, "description", json_string(group->doc));
    for (int32_t kind = 0; types->names[kind]; kind++)
        append(builder, variants, variant_schema(builder, group, types, kind, outermost));
    put(builder, schema, "oneOf", variants);
    return schema;
}

void sf_param_document_schema(const struct sf_param_document *document, struct sf_text *text)
{
    struct builder builder = {false};
    json_t *schema = json_object(), *body = group_schema(&builder, document->root, true);
    char *dump = NULL;

    put(&builder, schema, "$schema", json_string("https://json-schema.org/draft/2020-12/schema"));
    put(&builder, schema, "title", json_string(document->title));
    put(&builder, schema, "$comment",
        json_sprintf("Generated by %s; a test compares. The program checks more than a schema can.",
                     document->made_by));
    if (json_object_update(schema, body) != 0)
        builder.failed = true;
    json_decref(body);
    if (!builder.failed)
        dump = json_dumps(schema, JSON_INDENT(1) | JSON_REAL_PRECISION(9));
    json_decref(schema);
    if (!dump) {
        text->failed = true;
        return;
    }
    sf_text_append(text, dump);
    sf_text_append(text, "\n");
    free(dump);
}
