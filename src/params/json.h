/* Reading structs from JSON, strictly, by their rows; and --set, which edits the JSON before it is read. */
#ifndef SF_PARAMS_JSON_H
#define SF_PARAMS_JSON_H

#include <jansson.h>
#include "params/params.h"

enum { SF_PARAM_POINTER_BYTES = 256 };

/* A "group.key=value" that was applied: the place that it wrote to, as a JSON pointer. */
struct sf_param_set {
    const char *text;
    char pointer[SF_PARAM_POINTER_BYTES];
};

/* One file being read. `pointer` is the place being looked at. Not for sharing between threads. */
struct sf_param_reader {
    const char *name; /* of the file, for messages */
    const struct sf_log *log;
    struct sf_arena *arena; /* strings and lists go here */
    struct sf_param_set *sets;
    uint32_t set_count;
    char pointer[SF_PARAM_POINTER_BYTES];
    size_t pointer_length;
};

/* "NAME: POINTER: message" as SF_ERROR_SCENE; or "--set TEXT: POINTER: message" as SF_ERROR_USAGE when a set wrote that
 * value. */
enum sf_status sf_param_reader_fail(const struct sf_param_reader *reader, const char *format, ...) SF_PRINTF(2, 3);
/* The same as a warning about the file. */
void sf_param_reader_warn(const struct sf_param_reader *reader, const char *format, ...) SF_PRINTF(2, 3);
/* Makes `pointer` the place that messages name: "/lights/0/direction". */
void sf_param_reader_at(struct sf_param_reader *reader, const char *format, ...) SF_PRINTF(2, 3);

/* Fills the struct at `object` from a JSON object. Unknown keys, wrong types and values out of range are errors; a
 * missing key gives the row's default, or is an error when the row is required. "//" is a comment in any object,
 * "$schema" a string in the outermost. */
enum sf_status sf_param_read(struct sf_param_reader *reader, const struct sf_param_group *group, const json_t *json,
                             void *object);

/* Applies set->text to the tree whose root is described by `root`, and notes the place in set->pointer. Types and
 * ranges are checked; whether the object at hand takes the key is found by the reading. A set of an object's "type" to
 * another one takes the keys out of the object that the new type does not take, but for those that the sets applied
 * before (reader->sets, set_count of them) have written to. An empty string takes a key away that is not required.
 * SF_ERROR_USAGE; SF_ERROR_SCENE when the tree itself is not of the shape that its rows say. */
enum sf_status sf_param_apply_set(struct sf_param_reader *reader, const struct sf_param_group *root, json_t *tree,
                                  struct sf_param_set *set);

/* Takes keys whose values are their rows' defaults out of a tree that can be read, and objects that are empty then.
 * What must be given stays, and elements of lists do. */
void sf_param_prune(const struct sf_param_group *group, json_t *json);

/* Appends the tree as people read it: below the outermost object, what fits on a line of 120 columns stands on one, and
 * lists of numbers always do. Numbers keep their bits. */
void sf_param_write(const json_t *json, struct sf_text *text);

/* Copies `text` with everything but printable characters replaced, for messages; cut with "..." when longer than `size`
 * - 1. */
void sf_param_clean(const char *text, char *buffer, size_t size);

#endif
