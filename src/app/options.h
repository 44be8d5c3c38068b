/* The command line: one row an option. Parsing, ranges, "did you mean" and --help are read off the rows. */
#ifndef SF_APP_OPTIONS_H
#define SF_APP_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "sfumato/status.h"

struct sf_argument_list {
    const char **items; /* malloc'ed; the strings are argv's */
    size_t count;
};
struct sf_argument_size {
    uint32_t width, height; /* px */
};
struct sf_argument_real {
    bool given;
    double value;
};

/* Everything that any subcommand can be told. Strings are argv's or the rows' own. */
struct sf_arguments {
    struct sf_argument_list files; /* what is not an option */
    bool help;
    uint32_t verbose; /* how often -v was given */
    bool quiet;
    /* scene */
    struct sf_argument_list sets;
    const char *method; /* NULL: the scene's */
    /* device */
    const char *device; /* NULL: the best */
    bool validate, no_cache;
    uint32_t memory; /* MiB; 0: the library's own budget */
    /* picture */
    struct sf_argument_size size;
    const char *frames;
    bool aovs;
    /* capture */
    struct sf_argument_list outputs;
    const char *type, *compression;
    const char *tone;                 /* NULL: the scene's */
    struct sf_argument_real exposure; /* stops; not given: the scene's */
    const char *inspect;              /* an image of the graph in place of the picture, or NULL */
    bool overwrite, skip_existing;
    uint32_t threads; /* 0: by the number of cores */
    /* bench */
    uint32_t warmup, repeats;
    const char *json_file, *csv_file, *trace_file, *compare_file;
    bool sort, quick;
    const char *sizes, *suite;
    /* verify */
    const char *methods; /* NULL: all that draw smoke */
    struct sf_argument_size time_size;
    uint32_t stride;                   /* 0: by the number of particles */
    struct sf_argument_real tolerance; /* of the reference */
    bool goals, require_goals, settings;
    /* view */
    const char *present_mode; /* NULL: as last time */
    bool fullscreen, bare, paused, no_adapt;
    struct sf_argument_real goal; /* ms */
    uint32_t first_frame, exit_after;
    const char *folder, *shaders; /* for pictures; of GLSL sources */
    /* view and capture: two methods side by side */
    const char *beside;           /* NULL: one method */
    struct sf_argument_real wipe; /* 0..1; not given: the middle */
    /* texture */
    const char *kind, *channels, *bits;
    struct sf_argument_size tiles; /* how many, across and down */
    uint32_t seed, octaves, clones, loop, changes;
    struct sf_argument_real lacunarity, roughness, scale, ragged, softness, density, mottle;
    bool tileable;
    /* devices, graph, params */
    bool json, effects;
    const char *format;
};

enum sf_option_kind {
    SF_OPTION_FLAG,   /* bool */
    SF_OPTION_COUNT,  /* uint32_t: how often it stands there */
    SF_OPTION_TEXT,   /* const char * */
    SF_OPTION_LIST,   /* struct sf_argument_list: may be repeated */
    SF_OPTION_WORD,   /* const char *, one of `words` */
    SF_OPTION_NUMBER, /* uint32_t in min..max */
    SF_OPTION_REAL,   /* struct sf_argument_real in min..max */
    SF_OPTION_SIZE,   /* struct sf_argument_size, each side in min..max pixels */
    SF_OPTION_GRID,   /* the same, but no pixels */
};

struct sf_option {
    const char *name; /* without the dashes; NULL ends a table */
    char letter;      /* 0: none */
    enum sf_option_kind kind;
    size_t offset;       /* in struct sf_arguments */
    const char *value;   /* what --help calls the value */
    const char *initial; /* parsed before the command line, and printed by --help; NULL: the field stays zero */
    const char *doc;
    const char *const *words; /* NULL-terminated */
    double min, max;
};

struct sf_command {
    const char *name;
    const char *operands; /* as in the usage line: "SCENE" */
    const char *summary;
    const char *const *notes;              /* lines at the end of --help; NULL-terminated */
    const struct sf_option *const *tables; /* NULL-terminated */
    size_t files_min, files_max;
    enum sf_status (*run)(const struct sf_arguments *arguments);
};

/* Reads argv[0..argc-1] (what follows the subcommand) into *arguments, which starts as the rows' initial values.
 * SF_ERROR_USAGE with the reason on the console. --help skips the count of operands. Finish in either case. */
enum sf_status sf_arguments_parse(const struct sf_command *command, int argc, char **argv,
                                  struct sf_arguments *arguments);
void sf_arguments_finish(struct sf_arguments *arguments);
/* Prints the subcommand's --help to standard output. */
void sf_command_help(const struct sf_command *command);

/* The candidate most like `word`: one that it begins, or within a third of its length in edits. NULL when none is. */
const char *sf_nearest_word(const char *word, const char *const *candidates, size_t count);
/* "16384,65536": malloc'ed numbers in min..max. SF_ERROR_USAGE names `option`. */
enum sf_status sf_numbers_parse(const char *option, const char *text, uint32_t min, uint32_t max, uint32_t **numbers,
                                size_t *count);

#endif
