/* --set: one value of the JSON tree is replaced before the tree is read, so that everything is checked in one place. */
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/suggest.h"
#include "params/json.h"
#include "params/number.h"

enum { STEP_BYTES = 64, ROWS_MAX = 64 };

/* The value as a person would write it in a file: what a set gives and what a file gives hash alike. */
static json_t *number_json(double value)
{
    bool whole = value == floor(value) && fabs(value) < 1e15;

    return whole && !(value == 0 && signbit(value)) ? json_integer((json_int_t)value) : json_real(value);
}

static json_t *numbers_json(const char *text, bool one)
{
    json_t *list = one ? NULL : json_array();

    for (const char *at = text; at;) {
        const char *comma = strchr(at, ',');
        double value = 0;

        sf_number_parse(at, comma ? (size_t)(comma - at) : strlen(at), &value);
        if (one)
            return number_json(value);
        json_array_append_new(list, number_json(value));
        at = comma ? comma + 1 : NULL;
    }
    return list;
}

/* `text` has been accepted by sf_param_parse. */
static json_t *value_json(const struct sf_param *row, const char *text)
{
    switch (row->type) {
    case SF_PARAM_BOOL:
        return json_boolean(strcmp(text, "true") == 0);
    case SF_PARAM_ENUM:
    case SF_PARAM_STRING:
        return json_string(text); /* NULL unless it is UTF-8 */
    case SF_PARAM_RANGE:
        return numbers_json(text, strchr(text, ',') == NULL);
    default:
        return numbers_json(text, sf_param_components(row) == 1);
    }
}

static enum sf_status fail(const struct sf_param_reader *reader, const struct sf_param_set *set, const char *message,
                           const char *word, const char *near)
{
    return sf_fail(reader->log, SF_ERROR_USAGE, "--set %.200s: %s%s%s%s%s", set->text, message, word,
                   near ? ", did you mean " : "", near ? near : "", near ? "?" : "");
}

static enum sf_status unknown_key(const struct sf_param_reader *reader, const struct sf_param_group *group,
                                  const struct sf_param_set *set, const char *step)
{
    const char *candidates[ROWS_MAX];
    size_t n = 0;

    for (; n < group->count && n < ROWS_MAX; n++)
        candidates[n] = group->rows[n].key;
    return fail(reader, set, "unknown key ", step, sf_suggest(step, candidates, n));
}

/* The next step of "lights.0.intensity=3" into `step`; false when it is empty or too long. `*at` moves to the '.' or
 * '='. */
static bool next_step(const char **at, char step[STEP_BYTES])
{
    size_t length = strcspn(*at, ".=");

    if (length == 0 || length >= STEP_BYTES)
        return false;
    memcpy(step, *at, length);
    step[length] = '\0';
    *at += length;
    return true;
}

/* Steps into the element of a list that the text names. */
static enum sf_status enter_list(const struct sf_param_reader *reader, const struct sf_param *row,
                                 struct sf_param_set *set, const char **at, json_t **tree)
{
    size_t count = json_array_size(*tree), used = strlen(set->pointer);
    char step[STEP_BYTES], message[STEP_BYTES * 3], *end;
    unsigned long index;

    if (*tree && !json_is_array(*tree))
        return sf_fail(reader->log, SF_ERROR_SCENE, "%s: %s: must be a list", reader->name, set->pointer);
    if (**at != '.' || (++*at, !next_step(at, step)) || **at != '.' || step[strspn(step, "0123456789")]) {
        snprintf(message, sizeof message, "%s is a list: write %s.0.KEY=VALUE", row->key, row->key);
        return fail(reader, set, message, "", NULL);
    }
    index = strtoul(step, &end, 10);
    if (index >= count) {
        snprintf(message, sizeof message, "%s has %zu element%s, counted from 0", row->key, count,
                 count == 1 ? "" : "s");
        return fail(reader, set, message, "", NULL);
    }
    snprintf(set->pointer + used, sizeof set->pointer - used, "/%lu", index);
    *tree = json_array_get(*tree, index);
    return SF_OK;
}

/* Whether an earlier set wrote to the key of the object at `place` (the first `length` bytes), or to something in it. */
static bool was_set(const struct sf_param_reader *reader, const char *place, size_t length, const char *key)
{
    size_t more = strlen(key);

    for (uint32_t i = 0; i < reader->set_count; i++) {
        const char *pointer = reader->sets[i].pointer;

        if (strncmp(pointer, place, length) == 0 && pointer[length] == '/' &&
            strncmp(pointer + length + 1, key, more) == 0 &&
            (pointer[length + 1 + more] == '\0' || pointer[length + 1 + more] == '/'))
            return true;
    }
    return false;
}

/* The set makes another kind of the object `tree`: what the file says of it that the new kind does not take goes. What
 * sets have put there stays, so that the reading refuses it. */
static void drop_misfits(const struct sf_param_reader *reader, const struct sf_param_group *group,
                         const struct sf_param *types, const char *name, const struct sf_param_set *set, json_t *tree)
{
    size_t place = strlen(set->pointer) - strlen(types->key) - 1;
    const char *before = json_string_value(json_object_get(tree, types->key)), *key;
    json_t *value;
    int32_t kind = 0;
    void *next;

    if (!before && !types->required)
        before = types->names[(int)types->value[0]];
    if (before && strcmp(before, name) == 0)
        return;
    while (strcmp(types->names[kind], name) != 0)
        kind++;
    json_object_foreach_safe(tree, next, key, value)
    {
        const struct sf_param *row = sf_param_find(group, key);

        if (row && !sf_param_applies(group, row, kind) && !was_set(reader, set->pointer, place, key))
            json_object_del(tree, key);
    }
}

/* Parses the value, and puts it under the key of `tree`, an object of the group. */
static enum sf_status put_value(const struct sf_param_reader *reader, const struct sf_param_group *group,
                                const struct sf_param *row, const char *text, const struct sf_param_set *set,
                                json_t *tree)
{
    union {
        float numbers[3];
        int32_t whole;
        bool truth;
        const char *string;
    } scratch;
    char name[SF_PARAM_POINTER_BYTES];
    struct sf_param loose = *row;
    enum sf_status status;
    json_t *value;

    if (row->type == SF_PARAM_STRING && !*text && !row->required) {
        json_object_del(tree, row->key); /* no name: what a missing key is */
        return SF_OK;
    }
    loose.offset = 0;
    snprintf(name, sizeof name, "--set %.200s", set->text);
    if ((status = sf_param_parse(&loose, name, text, &scratch, reader->log)) != SF_OK)
        return status;
    if (!(value = value_json(row, text)))
        return fail(reader, set, "the value is not UTF-8", "", NULL);
    if (row == sf_param_kind(group))
        drop_misfits(reader, group, row, text, set, tree);
    if (json_object_set_new(tree, row->key, value) != 0)
        return sf_fail(reader->log, SF_ERROR_MEMORY, "%s: out of memory", reader->name);
    return SF_OK;
}

enum sf_status sf_param_apply_set(struct sf_param_reader *reader, const struct sf_param_group *root, json_t *tree,
                                  struct sf_param_set *set)
{
    const struct sf_param_group *group = root;
    const char *at = set->text;
    char step[STEP_BYTES];
    enum sf_status status;

    set->pointer[0] = '\0';
    if (!strchr(at, '='))
        return fail(reader, set, "expected KEY=VALUE", "", NULL);
    for (;;) {
        const struct sf_param *row;
        size_t used = strlen(set->pointer);

        if (!json_is_object(tree))
            return sf_fail(reader->log, SF_ERROR_SCENE, "%s: %s%smust be an object", reader->name, set->pointer,
                           used ? ": " : "");
        if (!next_step(&at, step))
            return fail(reader, set, "expected KEY=VALUE with keys such as thick.steps or lights.0.intensity", "",
                        NULL);
        if (!(row = sf_param_find(group, step)))
            return unknown_key(reader, group, set, step);
        snprintf(set->pointer + used, sizeof set->pointer - used, "/%s", row->key);
        if (row->type == SF_PARAM_LIST) {
            tree = json_object_get(tree, row->key);
            if ((status = enter_list(reader, row, set, &at, &tree)) != SF_OK)
                return status;
        } else if (row->type == SF_PARAM_OBJECT) {
            json_t *inner = json_object_get(tree, row->key);

            if (*at != '.')
                return fail(reader, set, "is a group; name one of its keys after ", row->key, NULL);
            if (!inner && json_object_set_new(tree, row->key, inner = json_object()) != 0)
                return sf_fail(reader->log, SF_ERROR_MEMORY, "%s: out of memory", reader->name);
            tree = inner;
        } else {
            if (*at != '=')
                return fail(reader, set, "nothing can follow ", row->key, NULL);
            return put_value(reader, group, row, at + 1, set, tree);
        }
        group = row->group;
        at++; /* the '.' */
    }
}
