#include "params/json.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include "base/suggest.h"
#include "params/number.h"

enum { MESSAGE_BYTES = 1024, KEY_BYTES = 72, ROWS_MAX = 64, STRING_BYTES = 4096 };

void sf_param_clean(const char *text, char *buffer, size_t size)
{
    size_t n = 0;

    for (; text[n] && n + 1 < size; n++)
        buffer[n] = (unsigned char)text[n] < 32 || text[n] == 127 ? '?' : text[n];
    buffer[n] = '\0';
    if (text[n] && size > 4) {
        /* Not in the middle of a UTF-8 character. */
        n = size - 4;
        while (n > 0 && ((unsigned char)buffer[n] & 0xc0) == 0x80)
            n--;
        strcpy(buffer + n, "...");
    }
}

/* ---- where we are ---- */

void sf_param_reader_at(struct sf_param_reader *reader, const char *format, ...)
{
    va_list args;
    int length;

    va_start(args, format);
    length = vsnprintf(reader->pointer, sizeof reader->pointer, format, args);
    va_end(args);
    reader->pointer_length = length < 0 ? 0 : strlen(reader->pointer);
}

/* Appends a step and gives back the length to return to. */
static size_t push_key(struct sf_param_reader *reader, const char *key)
{
    size_t before = reader->pointer_length, room = sizeof reader->pointer - before;
    char clean[KEY_BYTES], escaped[2 * KEY_BYTES];
    size_t n = 0;

    sf_param_clean(key, clean, sizeof clean);
    for (const char *c = clean; *c; c++) {
        if (*c == '~' || *c == '/') { /* RFC 6901 */
            escaped[n++] = '~';
            escaped[n++] = *c == '~' ? '0' : '1';
        } else {
            escaped[n++] = *c;
        }
    }
    escaped[n] = '\0';
    snprintf(reader->pointer + before, room, "/%s", escaped);
    reader->pointer_length = before + strlen(reader->pointer + before);
    return before;
}

static size_t push_index(struct sf_param_reader *reader, size_t index)
{
    size_t before = reader->pointer_length;

    snprintf(reader->pointer + before, sizeof reader->pointer - before, "/%zu", index);
    reader->pointer_length = before + strlen(reader->pointer + before);
    return before;
}

static void pop(struct sf_param_reader *reader, size_t before)
{
    reader->pointer_length = before;
    reader->pointer[before] = '\0';
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* The set that wrote the value at, above or (for what concerns several keys) just below the place being looked at. */
static const struct sf_param_set *find_set(const struct sf_param_reader *reader)
{
    size_t here = reader->pointer_length;

    if (here == 0)
        return NULL;
    for (uint32_t i = reader->set_count; i-- > 0;) {
        const struct sf_param_set *set = &reader->sets[i];
        size_t there = strlen(set->pointer), shorter = here < there ? here : there;
        const char *longer = here < there ? set->pointer : reader->pointer;

        if (!there || strncmp(set->pointer, reader->pointer, shorter) != 0)
            continue;
        if (longer[shorter] == '\0' || (longer[shorter] == '/' && (here > there || !is_digit(longer[shorter + 1]))))
            return set; /* a list's own faults are never a set's: it only changes elements */
    }
    return NULL;
}

enum sf_status sf_param_reader_fail(const struct sf_param_reader *reader, const char *format, ...)
{
    const struct sf_param_set *set = find_set(reader);
    const char *colon = reader->pointer_length ? ": " : "";
    char message[MESSAGE_BYTES];
    va_list args;

    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
    if (set)
        return sf_fail(reader->log, SF_ERROR_USAGE, "--set %.200s: %s%s%s", set->text, reader->pointer, colon, message);
    return sf_fail(reader->log, SF_ERROR_SCENE, "%s: %s%s%s", reader->name, reader->pointer, colon, message);
}

void sf_param_reader_warn(const struct sf_param_reader *reader, const char *format, ...)
{
    char message[MESSAGE_BYTES];
    va_list args;

    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
    sf_log(reader->log, SF_LOG_WARNING, "%s: %s%s%s", reader->name, reader->pointer, reader->pointer_length ? ": " : "",
           message);
}

/* ---- values ---- */

static const char *kind_name(const json_t *json)
{
    switch (json_typeof(json)) {
    case JSON_OBJECT:
        return "an object";
    case JSON_ARRAY:
        return "a list";
    case JSON_STRING:
        return "a string";
    case JSON_INTEGER:
    case JSON_REAL:
        return "a number";
    case JSON_TRUE:
    case JSON_FALSE:
        return "true or false";
    case JSON_NULL:
        break;
    }
    return "null";
}

static enum sf_status wrong_type(const struct sf_param_reader *reader, const char *wanted, const json_t *json)
{
    return sf_param_reader_fail(reader, "must be %s, not %s", wanted, kind_name(json));
}

static enum sf_status read_number(struct sf_param_reader *reader, const struct sf_param *row, const json_t *json,
                                  double *value)
{
    char shown[SF_NUMBER_BYTES], range[SF_PARAM_RANGE_BYTES];
    bool whole;

    if (!json_is_number(json))
        return wrong_type(reader, row->type == SF_PARAM_INT ? "a whole number" : "a number", json);
    *value = json_number_value(json);
    whole = row->type != SF_PARAM_INT || *value == floor(*value);
    if (whole && sf_param_in_range(row, *value))
        return SF_OK;
    sf_number_show(*value, shown);
    if (json_is_integer(json))
        snprintf(shown, sizeof shown, "%" JSON_INTEGER_FORMAT, json_integer_value(json));
    if (!whole)
        return sf_param_reader_fail(reader, "%s is not a whole number", shown);
    sf_param_range_text(row, range);
    return sf_param_reader_fail(reader, "%s is out of range: %s", shown, range);
}

static enum sf_status read_numbers(struct sf_param_reader *reader, const struct sf_param *row, const json_t *json,
                                   void *object)
{
    unsigned n = sf_param_components(row);
    double values[3] = {0};

    if (row->type == SF_PARAM_RANGE && json_is_number(json)) {
        enum sf_status status = read_number(reader, row, json, &values[0]);

        values[1] = values[0];
        if (status == SF_OK)
            sf_param_store(row, values, object);
        return status;
    }
    if (!json_is_array(json))
        return wrong_type(reader, n == 2 ? "a number or a list of two" : "a list of three numbers", json);
    if (json_array_size(json) != n)
        return sf_param_reader_fail(reader, "must hold %u numbers, and holds %zu", n, json_array_size(json));
    for (unsigned i = 0; i < n; i++) {
        size_t before = push_index(reader, i);
        enum sf_status status = read_number(reader, row, json_array_get(json, i), &values[i]);

        if (status != SF_OK)
            return status;
        pop(reader, before);
    }
    if (row->type == SF_PARAM_RANGE && values[0] > values[1])
        return sf_param_reader_fail(reader, "is no range: the lower number comes first");
    sf_param_store(row, values, object);
    return SF_OK;
}

static enum sf_status read_enum(struct sf_param_reader *reader, const struct sf_param *row, const json_t *json,
                                double *value)
{
    char shown[KEY_BYTES];
    const char *word, *near;
    struct sf_text names = {0};
    enum sf_status status;
    size_t n = 0;

    sf_param_names_text(row, &names);
    if (names.failed) {
        status = SF_ERROR_MEMORY;
    } else if (!json_is_string(json)) {
        status = sf_param_reader_fail(reader, "must be one of %s, not %s", names.data, kind_name(json));
    } else {
        word = json_string_value(json);
        while (row->names[n] && strcmp(row->names[n], word) != 0)
            n++;
        *value = (double)n;
        status = SF_OK;
        if (!row->names[n]) {
            near = sf_suggest(word, row->names, n);
            sf_param_clean(word, shown, sizeof shown);
            status = sf_param_reader_fail(reader, "'%s' is not one of %s%s%s%s", shown, names.data,
                                          near ? ", did you mean " : "", near ? near : "", near ? "?" : "");
        }
    }
    sf_text_finish(&names);
    return status;
}

static enum sf_status read_string(struct sf_param_reader *reader, const json_t *json, const char **string)
{
    if (!json_is_string(json))
        return wrong_type(reader, "a string", json);
    if (json_string_length(json) == 0)
        return sf_param_reader_fail(reader, "is empty");
    if (json_string_length(json) > STRING_BYTES)
        return sf_param_reader_fail(reader, "is longer than %d bytes", STRING_BYTES);
    *string = sf_arena_strdup(reader->arena, json_string_value(json));
    return *string ? SF_OK : sf_fail(reader->log, SF_ERROR_MEMORY, "%s: out of memory", reader->name);
}

static enum sf_status read_files(struct sf_param_reader *reader, const json_t *json, void *field)
{
    sf_param_files files;

    if (!json_is_array(json))
        return wrong_type(reader, "a list of six file names", json);
    if (json_array_size(json) != SF_COUNT(files))
        return sf_param_reader_fail(reader, "must hold 6 file names, and holds %zu", json_array_size(json));
    for (size_t i = 0; i < SF_COUNT(files); i++) {
        size_t before = push_index(reader, i);
        enum sf_status status = read_string(reader, json_array_get(json, i), &files[i]);

        if (status != SF_OK)
            return status;
        pop(reader, before);
    }
    memcpy(field, files, sizeof files);
    return SF_OK;
}

static enum sf_status read_list(struct sf_param_reader *reader, const struct sf_param *row, const json_t *json,
                                void *object)
{
    uint32_t count = (uint32_t)json_array_size(json);
    char *elements = (char *)object + row->offset;

    if (!json_is_array(json))
        return wrong_type(reader, "a list", json);
    if (json_array_size(json) > row->list_max || json_array_size(json) < row->list_min)
        return sf_param_reader_fail(reader, "holds %zu elements; %u to %u are allowed", json_array_size(json),
                                    (unsigned)row->list_min, (unsigned)row->list_max);
    if (row->list_pointer) {
        void *memory = sf_arena_alloc(reader->arena, count * row->group->size);

        if (!memory)
            return sf_fail(reader->log, SF_ERROR_MEMORY, "%s: out of memory for %u elements of %s", reader->name,
                           (unsigned)count, reader->pointer);
        memcpy(elements, &memory, sizeof memory);
        elements = memory;
    }
    for (uint32_t i = 0; i < count; i++) {
        size_t before = push_index(reader, i);
        enum sf_status status =
            sf_param_read(reader, row->group, json_array_get(json, i), elements + i * row->group->size);

        if (status != SF_OK)
            return status;
        pop(reader, before);
    }
    memcpy((char *)object + row->count_offset, &count, sizeof count);
    return SF_OK;
}

static enum sf_status read_row(struct sf_param_reader *reader, const struct sf_param *row, const json_t *json,
                               void *object)
{
    enum sf_status status;
    const char *string;
    double value;

    switch (row->type) {
    case SF_PARAM_BOOL:
        if (!json_is_boolean(json))
            return wrong_type(reader, "true or false", json);
        value = json_is_true(json);
        status = SF_OK;
        break;
    case SF_PARAM_INT:
    case SF_PARAM_FLOAT:
        status = read_number(reader, row, json, &value);
        break;
    case SF_PARAM_ENUM:
        status = read_enum(reader, row, json, &value);
        break;
    case SF_PARAM_STRING:
        status = read_string(reader, json, &string);
        if (status == SF_OK)
            memcpy((char *)object + row->offset, &string, sizeof string);
        return status;
    case SF_PARAM_FILES:
        return read_files(reader, json, (char *)object + row->offset);
    case SF_PARAM_OBJECT:
        return sf_param_read(reader, row->group, json, (char *)object + row->offset);
    case SF_PARAM_LIST:
        return read_list(reader, row, json, object);
    default:
        return read_numbers(reader, row, json, object);
    }
    if (status == SF_OK)
        sf_param_store(row, &value, object);
    return status;
}

/* ---- objects ---- */

/* Keys that no row knows, and keys that objects of this type do not take. */
static enum sf_status check_keys(struct sf_param_reader *reader, const struct sf_param_group *group, const json_t *json,
                                 int32_t kind)
{
    const struct sf_param *types = sf_param_kind(group);
    const char *candidates[ROWS_MAX], *key, *near;
    json_t *value;
    size_t n = 0, before;

    json_object_foreach((json_t *)json, key, value)
    {
        const struct sf_param *row = sf_param_find(group, key);

        if ((row && sf_param_applies(group, row, kind)) || strcmp(key, "//") == 0)
            continue;
        if (reader->pointer_length == 0 && strcmp(key, "$schema") == 0 && json_is_string(value))
            continue;
        before = push_key(reader, key);
        if (row && !find_set(reader)) {
            /* The file may be right, and a set have changed the type. */
            pop(reader, before);
            push_key(reader, types->key);
            if (find_set(reader))
                return sf_param_reader_fail(reader, "%s does not take %s, which is given", types->names[kind], key);
            pop(reader, before);
            push_key(reader, key);
        }
        if (row)
            return sf_param_reader_fail(reader, "type %s does not take this key, only %s", types->names[kind],
                                        row->only_for);
        for (size_t i = 0; i < group->count && n < ROWS_MAX; i++)
            if (sf_param_applies(group, &group->rows[i], kind))
                candidates[n++] = group->rows[i].key;
        near = sf_suggest(key, candidates, n);
        return sf_param_reader_fail(reader, "unknown key%s%s%s", near ? ", did you mean " : "", near ? near : "",
                                    near ? "?" : "");
    }
    return SF_OK;
}

static enum sf_status missing(struct sf_param_reader *reader, const struct sf_param *row)
{
    struct sf_text names = {0};
    enum sf_status status;

    if (row->type == SF_PARAM_ENUM)
        sf_param_names_text(row, &names);
    status = sf_param_reader_fail(reader, "%s is missing (%s)", row->key, names.data ? names.data : row->doc);
    sf_text_finish(&names);
    return status;
}

enum sf_status sf_param_read(struct sf_param_reader *reader, const struct sf_param_group *group, const json_t *json,
                             void *object)
{
    const struct sf_param *types = sf_param_kind(group);
    const json_t *given;
    enum sf_status status;
    double kind = types ? types->value[0] : 0;

    if (!json_is_object(json))
        return wrong_type(reader, "an object", json);
    sf_param_defaults(group, object);
    if (types) {
        if ((given = json_object_get(json, types->key))) {
            size_t before = push_key(reader, types->key);

            if ((status = read_enum(reader, types, given, &kind)) != SF_OK)
                return status;
            pop(reader, before);
        } else if (types->required) {
            return missing(reader, types);
        }
    }
    if ((status = check_keys(reader, group, json, (int32_t)kind)) != SF_OK)
        return status;
    for (size_t i = 0; i < group->count; i++) {
        const struct sf_param *row = &group->rows[i];
        static const double zeros[3] = {0};
        size_t before;

        if (!sf_param_applies(group, row, (int32_t)kind)) {
            if (sf_param_components(row))
                sf_param_store(row, zeros, object);
            continue;
        }
        if (!(given = json_object_get(json, row->key))) {
            if (row->required)
                return missing(reader, row);
            if (sf_param_components(row))
                sf_param_store(row, row->value, object);
            continue;
        }
        before = push_key(reader, row->key);
        if ((status = read_row(reader, row, given, object)) != SF_OK)
            return status;
        pop(reader, before);
    }
    return SF_OK;
}
