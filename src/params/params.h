/* The one table of parameters. A row says all there is to know of a field: its key, place, type, default, range, unit
 * and meaning. Scene loading, strict validation, --set, the JSON Schema, docs/params.md and later the viewer's sliders
 * are read off the rows. This room is the machinery; the rows themselves stand in scene/table.c, with the structs that
 * they describe. */
#ifndef SF_PARAMS_PARAMS_H
#define SF_PARAMS_PARAMS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "base/array.h"
#include "base/log.h"

enum sf_param_type {
    SF_PARAM_BOOL,   /* bool */
    SF_PARAM_INT,    /* int32_t */
    SF_PARAM_FLOAT,  /* float */
    SF_PARAM_VEC3,   /* float[3] */
    SF_PARAM_COLOR,  /* float[3], linear Rec. 709, >= 0 */
    SF_PARAM_ENUM,   /* int32_t, an index into `names` */
    SF_PARAM_STRING, /* const char * (memory of the scene's arena); default NULL */
    SF_PARAM_RANGE,  /* float[2], lower first; in text one number (both) or two */
    SF_PARAM_FILES,  /* const char *[6]: six file names; only in scene files */
    SF_PARAM_OBJECT, /* a struct described by `group` */
    SF_PARAM_LIST,   /* many structs described by `group`: an array field, or a pointer to arena memory */
};
typedef float sf_param_vec3[3];
typedef float sf_param_vec2[2];
typedef const char *sf_param_string;
typedef const char *sf_param_files[6];

/* What must be made anew when the value changes. */
enum sf_rebuild {
    SF_REBUILD_NONE = 0,   /* read every frame */
    SF_REBUILD_GRAPH = 1,  /* the frame graph's shape */
    SF_REBUILD_SIM = 2,    /* the simulation restarts from frame 0 */
    SF_REBUILD_ASSETS = 4, /* meshes, environment, textures are loaded again */
    SF_REBUILD_READ = 8,   /* in answers to "what differs" only, never in a row: something differs at all */
};

struct sf_param_group;

struct sf_param {
    const char *key; /* within its group: "steps" */
    enum sf_param_type type;
    size_t offset;            /* of the field in the group's struct */
    double value[3];          /* default: number(s), 0/1, or index */
    double min, max;          /* inclusive; each component of a vector */
    const char *unit;         /* "m", "1/m", "deg", "" */
    const char *const *names; /* enum: NULL-terminated */
    /* enum sf_rebuild bits. Those of a list or an object hold for all that is in it as well. */
    unsigned rebuild;
    bool required;        /* the key must be given (by the types that take it) */
    const char *doc;      /* one line */
    const char *only_for; /* for objects with a "type": the types that take this key, space separated; NULL: all */
    const struct sf_param_group *group; /* object, list: of what */
    size_t count_offset;                /* list: of the uint32_t that holds the number of elements */
    uint32_t list_min, list_max;        /* list: elements, inclusive */
    bool list_pointer; /* list: the field is a pointer to the elements; else it is an array of list_max */
};

/* Evaluates to the offset of field `f` of struct S, and fails to compile unless the field has type T. */
#define SF_OFFSET(S, f, T) (offsetof(S, f) + _Generic(&((S *)0)->f, T * : 0u))

/* The rows of one struct. A group whose rows hold an enum named "type" describes objects of several kinds: a row's
 * only_for says which of them take its key, and the field is zero in the others. */
struct sf_param_group {
    const char *name; /* "thick"; of a list's elements: "light" */
    const char *doc;
    const struct sf_param *rows;
    size_t count, size; /* rows; bytes of the struct */
};

/* NULL when there is no such key. */
const struct sf_param *sf_param_find(const struct sf_param_group *group, const char *key);
/* The group's row "type", or NULL. */
const struct sf_param *sf_param_kind(const struct sf_param_group *group);
/* Whether objects of this type (an index into the type row's names) take the row's key. */
bool sf_param_applies(const struct sf_param_group *group, const struct sf_param *row, int32_t kind);

/* Fills the struct: defaults of the group's default type, zero where the type does not take a key; nested objects too;
 * lists empty. */
void sf_param_defaults(const struct sf_param_group *group, void *object);
/* Parses text ("24", "true", "0.1,0.2,0.3", an enum's name) into the field, checking type and range. The message of a
 * failure begins with `name` and holds value, range, unit and the nearest word. SF_ERROR_USAGE. A string field points
 * at `text` afterwards. Lists, objects and file sets are refused. */
enum sf_status sf_param_parse(const struct sf_param *row, const char *name, const char *text, void *object,
                              const struct sf_log *log);
/* Appends the value so that parsing gives the same bits; nothing for a NULL string, a list, an object or a file set. */
void sf_param_print(const struct sf_param *row, const void *object, struct sf_text *text);

/* Numbers that come with a row: 1 to 3; 0 when it is none of the numeric types. */
unsigned sf_param_components(const struct sf_param *row);
/* NaN is never in range. Floats are compared as floats, so that what was printed may be read again. */
bool sf_param_in_range(const struct sf_param *row, double value);
/* Stores numbers that have been checked; `values` has sf_param_components() of them (bool 0/1, enum index). */
void sf_param_store(const struct sf_param *row, const double *values, void *object);
/* The numbers that the field holds, as sf_param_store takes them; returns how many. */
unsigned sf_param_fetch(const struct sf_param *row, const void *object, double values[3]);
/* What differs between two structs of the group: the bits of all rows whose values do, each with `inherited` and those
 * of the lists and objects that it stands in; strings by contents; of lists that are not equally long, the bits of all
 * rows of their elements. SF_REBUILD_READ is among them; 0 when all values have the same bits. */
unsigned sf_param_difference(const struct sf_param_group *group, const void *before, const void *after,
                             unsigned inherited);
/* The bits of all rows of the group, and of the groups in it. */
unsigned sf_param_rebuild_all(const struct sf_param_group *group);
/* The most that the bits make anew, as people read it: "simulation", "graph", "files" or "". */
const char *sf_param_renews(unsigned rebuild);
/* "1 to 170 deg" into `buffer`. */
enum { SF_PARAM_RANGE_BYTES = 96 };
void sf_param_range_text(const struct sf_param *row, char buffer[SF_PARAM_RANGE_BYTES]);
/* "directional, point, spot" appended. */
void sf_param_names_text(const struct sf_param *row, struct sf_text *text);

#endif
