/* Back to JSON as people read it. jansson either indents every number of a vector or nothing at all. */
#include <math.h>
#include <string.h>
#include "params/json.h"
#include "params/number.h"

enum { INDENT = 4, COLUMNS = 120 };

/* ---- what need not be said ---- */

static bool is_default(const struct sf_param *row, const json_t *json)
{
    unsigned n = sf_param_components(row);
    struct {
        float field[3];
    } given = {{0}}, usual = {{0}};
    struct sf_param loose = *row;
    double values[3] = {0};

    if (n == 0 || row->required)
        return false;
    if (row->type == SF_PARAM_BOOL)
        values[0] = json_is_true(json);
    else if (row->type == SF_PARAM_ENUM)
        while (row->names[(int)values[0]] && strcmp(row->names[(int)values[0]], json_string_value(json)) != 0)
            values[0]++;
    else
        for (unsigned i = 0; i < n; i++)
            values[i] = json_number_value(json_is_array(json) ? json_array_get(json, i) : json);
    loose.offset = 0;
    sf_param_store(&loose, values, &given);
    sf_param_store(&loose, row->value, &usual);
    return memcmp(&given, &usual, sizeof given) == 0;
}

void sf_param_prune(const struct sf_param_group *group, json_t *json)
{
    for (size_t i = 0; i < group->count; i++) {
        const struct sf_param *row = &group->rows[i];
        json_t *value = json_object_get(json, row->key), *element;
        bool empty = false;
        size_t k;

        if (!value)
            continue;
        if (row->type == SF_PARAM_OBJECT) {
            sf_param_prune(row->group, value);
            empty = json_object_size(value) == 0;
        } else if (row->type == SF_PARAM_LIST) {
            json_array_foreach(value, k, element) sf_param_prune(row->group, element);
            /* A pointer tells an empty list from none at all. */
            empty = json_array_size(value) == 0 && !row->list_pointer && !row->required;
        }
        if (empty || is_default(row, value))
            json_object_del(json, row->key);
    }
}

/* ---- writing ---- */

static void write_string(const char *string, struct sf_text *text)
{
    static const char special[] = "\"\\\x01\x02\x03\x04\x05\x06\x07\x08\x09\x0a\x0b\x0c\x0d\x0e\x0f\x10"
                                  "\x11\x12\x13\x14\x15\x16\x17\x18\x19\x1a\x1b\x1c\x1d\x1e\x1f\x7f";

    sf_text_append(text, "\"");
    while (*string) {
        size_t plain = strcspn(string, special);

        sf_text_printf(text, "%.*s", (int)plain, string);
        string += plain;
        if (*string == '"' || *string == '\\')
            sf_text_printf(text, "\\%c", *string++);
        else if (*string)
            sf_text_printf(text, "\\u%04x", (unsigned)(unsigned char)*string++);
    }
    sf_text_append(text, "\"");
}

static void write_scalar(const json_t *json, struct sf_text *text)
{
    char number[SF_NUMBER_BYTES];
    double value;

    switch (json_typeof(json)) {
    case JSON_STRING:
        write_string(json_string_value(json), text);
        break;
    case JSON_INTEGER:
        sf_text_printf(text, "%" JSON_INTEGER_FORMAT, json_integer_value(json));
        break;
    case JSON_REAL:
        value = json_real_value(json);
        sf_number_print_double(value, number);
        sf_text_append(text, number);
        sf_text_append(text, value == 0 && signbit(value) ? ".0" : ""); /* -0 would be read as a whole number, 0 */
        break;
    case JSON_TRUE:
    case JSON_FALSE:
        sf_text_append(text, json_is_true(json) ? "true" : "false");
        break;
    default:
        sf_text_append(text, "null");
    }
}

/* On one line; false, half done, when the text becomes longer than `limit`. */
static bool write_flat(const json_t *json, size_t limit, struct sf_text *text)
{
    const char *key, *between = "";
    json_t *value;
    size_t i;

    if (json_is_array(json)) {
        sf_text_append(text, "[");
        json_array_foreach(json, i, value)
        {
            sf_text_append(text, between);
            if (!write_flat(value, limit, text))
                return false;
            between = ", ";
        }
        sf_text_append(text, "]");
    } else if (json_is_object(json)) {
        sf_text_append(text, "{");
        json_object_foreach((json_t *)json, key, value)
        {
            sf_text_append(text, *between ? between : " ");
            write_string(key, text);
            sf_text_append(text, ": ");
            if (!write_flat(value, limit, text))
                return false;
            between = ", ";
        }
        sf_text_append(text, *between ? " }" : "}");
    } else {
        write_scalar(json, text);
    }
    return text->length <= limit;
}

static bool is_plain(const json_t *json)
{
    json_t *value;
    size_t i;

    if (!json_is_array(json))
        return !json_is_object(json);
    json_array_foreach(json, i, value) if (!json_is_number(value)) return false;
    return true;
}

static void break_line(unsigned depth, const char *between, struct sf_text *text)
{
    sf_text_printf(text, "%s\n%*s", between, (int)(depth * INDENT), "");
}

/* `line`: where in the text the line begins that the value continues. */
static void write_value(const json_t *json, unsigned depth, size_t line, struct sf_text *text)
{
    size_t start = text->length, i;
    const char *key, *between = "";
    json_t *value;

    /* A comma may follow. The outermost object is never on one line. */
    if (is_plain(json) || depth > 0 || json_object_size(json) == 0) {
        if (write_flat(json, is_plain(json) ? SIZE_MAX : line + COLUMNS - 1, text) || text->failed)
            return;
        text->length = start;
    }
    sf_text_append(text, json_is_array(json) ? "[" : "{");
    if (json_is_array(json)) {
        json_array_foreach(json, i, value)
        {
            break_line(depth + 1, between, text);
            write_value(value, depth + 1, text->length - (depth + 1) * INDENT, text);
            between = ",";
        }
    } else {
        json_object_foreach((json_t *)json, key, value)
        {
            size_t begun;

            break_line(depth + 1, between, text);
            begun = text->length - (depth + 1) * INDENT;
            write_string(key, text);
            sf_text_append(text, ": ");
            write_value(value, depth + 1, begun, text);
            between = ",";
        }
    }
    break_line(depth, "", text);
    sf_text_append(text, json_is_array(json) ? "]" : "}");
}

void sf_param_write(const json_t *json, struct sf_text *text)
{
    write_value(json, 0, text->length, text);
    sf_text_append(text, "\n");
}
