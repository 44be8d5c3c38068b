#include "params/params.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include "base/suggest.h"
#include "params/number.h"

enum { SHOWN_MAX = 80 };

const struct sf_param *sf_param_find(const struct sf_param_group *group, const char *key)
{
    for (size_t i = 0; i < group->count; i++)
        if (strcmp(group->rows[i].key, key) == 0)
            return &group->rows[i];
    return NULL;
}

const struct sf_param *sf_param_kind(const struct sf_param_group *group)
{
    const struct sf_param *row = sf_param_find(group, "type");

    return row && row->type == SF_PARAM_ENUM ? row : NULL;
}

/* Whether `word` is one of the space-separated words of `list`. */
static bool has_word(const char *list, const char *word)
{
    size_t length = strlen(word);

    for (const char *at = list; (at = strstr(at, word)); at += length)
        if ((at == list || at[-1] == ' ') && (at[length] == ' ' || at[length] == '\0'))
            return true;
    return false;
}

bool sf_param_applies(const struct sf_param_group *group, const struct sf_param *row, int32_t kind)
{
    const struct sf_param *types = sf_param_kind(group);

    return !row->only_for || !types || has_word(row->only_for, types->names[kind]);
}

void sf_param_defaults(const struct sf_param_group *group, void *object)
{
    const struct sf_param *kind = sf_param_kind(group);

    memset(object, 0, group->size);
    for (size_t i = 0; i < group->count; i++) {
        const struct sf_param *row = &group->rows[i];

        if (row->type == SF_PARAM_OBJECT)
            sf_param_defaults(row->group, (char *)object + row->offset);
        else if (sf_param_components(row) && sf_param_applies(group, row, kind ? (int32_t)kind->value[0] : 0))
            sf_param_store(row, row->value, object);
    }
}

unsigned sf_param_components(const struct sf_param *row)
{
    switch (row->type) {
    case SF_PARAM_BOOL:
    case SF_PARAM_INT:
    case SF_PARAM_FLOAT:
    case SF_PARAM_ENUM:
        return 1;
    case SF_PARAM_RANGE:
        return 2;
    case SF_PARAM_VEC3:
    case SF_PARAM_COLOR:
        return 3;
    case SF_PARAM_STRING:
    case SF_PARAM_FILES:
    case SF_PARAM_OBJECT:
    case SF_PARAM_LIST:
        break;
    }
    return 0;
}

bool sf_param_in_range(const struct sf_param *row, double value)
{
    if (row->type == SF_PARAM_INT)
        return value >= row->min && value <= row->max;
    return (float)value >= (float)row->min && (float)value <= (float)row->max;
}

void sf_param_store(const struct sf_param *row, const double *values, void *object)
{
    char *field = (char *)object + row->offset;
    unsigned n = sf_param_components(row);
    float numbers[3];
    int32_t whole;
    bool truth;

    switch (row->type) {
    case SF_PARAM_BOOL:
        truth = values[0] != 0;
        memcpy(field, &truth, sizeof truth);
        break;
    case SF_PARAM_INT:
    case SF_PARAM_ENUM:
        whole = (int32_t)values[0];
        memcpy(field, &whole, sizeof whole);
        break;
    default:
        for (unsigned i = 0; i < n; i++)
            numbers[i] = (float)values[i];
        memcpy(field, numbers, n * sizeof numbers[0]);
    }
}

unsigned sf_param_fetch(const struct sf_param *row, const void *object, double values[3])
{
    const char *field = (const char *)object + row->offset;
    unsigned n = sf_param_components(row);
    float numbers[3];
    int32_t whole;
    bool truth;

    switch (row->type) {
    case SF_PARAM_BOOL:
        memcpy(&truth, field, sizeof truth);
        values[0] = truth;
        break;
    case SF_PARAM_INT:
    case SF_PARAM_ENUM:
        memcpy(&whole, field, sizeof whole);
        values[0] = whole;
        break;
    default:
        memcpy(numbers, field, n * sizeof numbers[0]);
        for (unsigned i = 0; i < n; i++)
            values[i] = numbers[i];
    }
    return n;
}

void sf_param_range_text(const struct sf_param *row, char buffer[SF_PARAM_RANGE_BYTES])
{
    struct {
        char low[SF_NUMBER_BYTES], high[SF_NUMBER_BYTES];
    } limits;

    if (row->type == SF_PARAM_INT) {
        snprintf(limits.low, sizeof limits.low, "%.0f", row->min);
        snprintf(limits.high, sizeof limits.high, "%.0f", row->max);
    } else {
        sf_number_show(row->min, limits.low);
        sf_number_show(row->max, limits.high);
    }
    snprintf(buffer, SF_PARAM_RANGE_BYTES, "%.30s to %.30s%s%.24s", limits.low, limits.high,
             row->unit && *row->unit ? " " : "", row->unit ? row->unit : "");
}

void sf_param_names_text(const struct sf_param *row, struct sf_text *text)
{
    for (size_t i = 0; row->names[i]; i++) {
        sf_text_append(text, i ? ", " : "");
        sf_text_append(text, row->names[i]);
    }
}

static enum sf_status refuse(const struct sf_log *log, const char *name, const char *text, const char *expected)
{
    return sf_fail(log, SF_ERROR_USAGE, "%s: '%.*s' is not %s", name, SHOWN_MAX, text, expected);
}

static enum sf_status parse_enum(const struct sf_param *row, const char *name, const char *text, double *value,
                                 const struct sf_log *log)
{
    struct sf_text names = {0};
    const char *near;
    size_t n = 0;

    for (; row->names[n]; n++) {
        if (strcmp(row->names[n], text) == 0) {
            *value = (double)n;
            return SF_OK;
        }
    }
    near = sf_suggest(text, row->names, n);
    sf_param_names_text(row, &names);
    sf_fail(log, SF_ERROR_USAGE, "%s: '%.*s' is not one of %s%s%s%s", name, SHOWN_MAX, text,
            names.failed ? "" : names.data, near ? ", did you mean " : "", near ? near : "", near ? "?" : "");
    sf_text_finish(&names);
    return SF_ERROR_USAGE;
}

static enum sf_status parse_numbers(const struct sf_param *row, const char *name, const char *text, double *values,
                                    const struct sf_log *log)
{
    static const char *const wanted[] = {"", "a number", "a number, or two with a comma between",
                                         "three numbers with commas between"};
    unsigned n = sf_param_components(row), got = 0;
    char range[SF_PARAM_RANGE_BYTES];

    for (const char *at = text; at; got++) {
        const char *comma = strchr(at, ',');
        size_t length = comma ? (size_t)(comma - at) : strlen(at);

        if (got == n || !sf_number_parse(at, length, &values[got]))
            return refuse(log, name, text, wanted[n]);
        at = comma ? comma + 1 : NULL;
    }
    if (row->type == SF_PARAM_RANGE && got == 1)
        values[got++] = values[0];
    if (got != n)
        return refuse(log, name, text, wanted[n]);
    sf_param_range_text(row, range);
    for (unsigned i = 0; i < n; i++) {
        if (row->type == SF_PARAM_INT && values[i] != floor(values[i]))
            return refuse(log, name, text, "a whole number");
        if (!sf_param_in_range(row, values[i]))
            return sf_fail(log, SF_ERROR_USAGE, "%s: %.*s is out of range: %s", name, SHOWN_MAX, text, range);
    }
    if (row->type == SF_PARAM_RANGE && values[0] > values[1])
        return refuse(log, name, text, "a range: the lower number comes first");
    return SF_OK;
}

enum sf_status sf_param_parse(const struct sf_param *row, const char *name, const char *text, void *object,
                              const struct sf_log *log)
{
    double values[3];
    enum sf_status status = SF_OK;

    switch (row->type) {
    case SF_PARAM_BOOL:
        values[0] = strcmp(text, "true") == 0;
        if (values[0] == 0 && strcmp(text, "false") != 0)
            status = refuse(log, name, text, "true or false");
        break;
    case SF_PARAM_ENUM:
        status = parse_enum(row, name, text, values, log);
        break;
    case SF_PARAM_STRING:
        if (!*text)
            return refuse(log, name, text, "a file name");
        memcpy((char *)object + row->offset, &text, sizeof text);
        return SF_OK;
    case SF_PARAM_FILES:
    case SF_PARAM_OBJECT:
    case SF_PARAM_LIST:
        return sf_fail(log, SF_ERROR_USAGE, "%s: cannot be given as one value; write it in the scene file", name);
    default:
        status = parse_numbers(row, name, text, values, log);
    }
    if (status == SF_OK)
        sf_param_store(row, values, object);
    return status;
}

void sf_param_print(const struct sf_param *row, const void *object, struct sf_text *text)
{
    const char *field = (const char *)object + row->offset, *string;
    char number[SF_NUMBER_BYTES];
    float values[3];
    int32_t whole;
    bool truth;

    switch (row->type) {
    case SF_PARAM_BOOL:
        memcpy(&truth, field, sizeof truth);
        sf_text_append(text, truth ? "true" : "false");
        break;
    case SF_PARAM_INT:
        memcpy(&whole, field, sizeof whole);
        sf_text_printf(text, "%d", (int)whole);
        break;
    case SF_PARAM_ENUM:
        memcpy(&whole, field, sizeof whole);
        sf_text_append(text, row->names[whole]);
        break;
    case SF_PARAM_STRING:
        memcpy(&string, field, sizeof string);
        if (string)
            sf_text_append(text, string);
        break;
    case SF_PARAM_FLOAT:
    case SF_PARAM_RANGE:
    case SF_PARAM_VEC3:
    case SF_PARAM_COLOR:
        memcpy(values, field, sf_param_components(row) * sizeof values[0]);
        for (unsigned i = 0; i < sf_param_components(row); i++) {
            sf_number_print(values[i], number);
            sf_text_append(text, i ? "," : "");
            sf_text_append(text, number);
        }
        break;
    case SF_PARAM_FILES:
    case SF_PARAM_OBJECT:
    case SF_PARAM_LIST:
        break;
    }
}
