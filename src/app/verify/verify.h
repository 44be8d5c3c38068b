/* What `sfumato verify` measured: verify.c fills it, table.c and json.c write it. */
#ifndef SF_APP_VERIFY_H
#define SF_APP_VERIFY_H

#include "../options.h"
#include "metrics.h"
#include "sfumato/sfumato.h"

/* A method, at a scene's own settings or with one of them changed: what is drawn, measured and timed. */
struct sf_verify_entry {
    char *method;
    char *set;         /* "thick.steps=4"; NULL: the scene's own settings */
    const char *label; /* "steps=4", the end of `set`; "" */
    uint32_t sweep;    /* number of the parameter that is changed; 0: none */
};

/* A number that is none, and where it is. */
struct sf_verify_fault {
    bool found;
    char image[64];   /* of the frame's graph, or "particles" */
    char pass[64];    /* that wrote the image last; none before it wrote one with such a number */
    char others[256]; /* passes that wrote it before, with commas; "" */
    uint32_t x, y;    /* pixel; of particles x is the index */
    float value;
};

struct sf_verify_row {
    struct sf_errors errors;
    struct sf_verify_fault fault;
    double ms, ms_least; /* the frame's passes on the device, simulation apart: median, minimum */
    uint32_t samples;    /* of the time; 0: not taken */
    char **notes;        /* where the method means to leave the reference's integral; NULL-terminated */
};

/* A scene at a frame. */
struct sf_verify_case {
    const char *path;
    char *name; /* the file's, without ending */
    char hash[17];
    uint32_t frame, live;
    uint32_t stride;            /* one pixel of each stride x stride was compared */
    uint32_t unconverged;       /* pixels of the reference over its tolerance */
    double seconds;             /* that the reference took */
    char base[96];              /* what its files in the folder of -o begin with */
    double scale;               /* W/(m2 sr): the ends of the colours of its difference pictures */
    struct sf_verify_row *rows; /* [entry_count] */
};

struct sf_verify {
    const struct sf_arguments *arguments;
    struct sf_device *device;
    struct sf_device_info info;
    char **paths; /* of scenes */
    size_t path_count;
    uint32_t *frames;
    size_t frame_count;
    struct sf_verify_entry *entries;
    size_t entry_count;
    struct sf_verify_case *cases;  /* every scene at every frame */
    size_t case_total, case_count; /* of these the first ones are done */
};

enum sf_status sf_verify_run(const struct sf_arguments *arguments);

/* What is drawn of a case: the layers of each entry, and the reference. */
struct sf_verify_drawn {
    const struct sf_layers *layers; /* [entry_count] */
    const struct sf_reference_picture *reference;
    const char *tone;
    float exposure;
};

/* ---- choice.c: what is to be measured ---- */

/* The scenes named, or those of scenes/truth here or beside the program. SF_ERROR_USAGE when there are none. */
enum sf_status sf_verify_find_scenes(struct sf_verify *verify);
/* The methods of --methods, or all that draw smoke, each followed by its settings when --settings is given. SF_ERROR_USAGE
 * names an unknown method, and the nearest known. */
enum sf_status sf_verify_find_entries(struct sf_verify *verify);
/* The scene as the entry draws it. */
enum sf_status sf_verify_load(const struct sf_verify *verify, const char *path, const struct sf_verify_entry *entry,
                              struct sf_scene **scene);
/* ---- cost.c ---- */

/* How many spheres a ray through the smoke meets, on average over all directions. */
double sf_verify_crossed(const struct sf_frame *frame);
/* How far apart the reference's pixels must be for it to take bounded time, going by a sparse sample of them: 1 for all
 * but large clouds. */
uint32_t sf_verify_stride(const struct sf_reference_picture *sample, uint32_t width, uint32_t height, double crossed,
                          uint32_t lights);

/* ---- trace.c ---- */

/* A particle with a number that is none: the simulation's doing. */
void sf_verify_check_particles(const struct sf_frame *frame, struct sf_verify_fault *fault);
/* Looks for NaN and infinities in what came out, and, if there are or `thorough`, for NaN in every image of the frame's
 * graph. `frame` is the renderer's last, rendered with `options`, which it has again afterwards; the frame is gone. */
enum sf_status sf_verify_trace(struct sf_renderer *renderer, const struct sf_renderer_options *options,
                               const struct sf_frame *frame, bool thorough, struct sf_verify_fault *fault);

/* ---- times.c ---- */

/* Times every entry's frame, in turns, into the rows of the case; `scenes` as the entries draw them. */
enum sf_status sf_verify_time(struct sf_verify *verify, struct sf_scene *const *scenes, struct sf_verify_case *result);

/* ---- summary.c ---- */

/* An entry over all scenes. */
struct sf_verify_summary {
    size_t rows;                                                                /* that were compared, and have smoke */
    double transmittance_mean, transmittance_max, alpha_max, relative_mse, p99; /* the worst of all */
    double bias;                                                                /* the one farthest from 0 */
    double typical_mse; /* geometric mean; relative_mse below 1e-12 counts as that */
    double ms;          /* geometric mean; 0: no times */
    size_t missed;      /* rows that miss a goal */
};
void sf_verify_summarise(const struct sf_verify *verify, size_t entry, struct sf_verify_summary *summary);
/* "T max, MSE" for bits of enum sf_goal; "" for none. */
void sf_verify_missed_text(unsigned missed, char *text, size_t room);
/* "thick", "thick steps=4". */
void sf_verify_entry_text(const struct sf_verify_entry *entry, char *text, size_t room);
/* The notes about a case and its rows that were not given for an earlier case, one after the other: the text for number
 * `index`, or false behind the last. */
bool sf_verify_note(const struct sf_verify *verify, size_t index, char *text, size_t room);

/* ---- table.c, json.c ---- */

void sf_verify_print(const struct sf_verify *verify);
/* malloc'ed; NULL when memory is out. */
char *sf_verify_json(const struct sf_verify *verify);

/* ---- folder.c: the folder of -o ---- */

/* Names the cases' files, makes the folder, and sees that nothing in it is replaced but what an earlier run made, and that
 * only with --overwrite. SF_ERROR_IO says what stands in the way. */
enum sf_status sf_verify_folder_open(struct sf_verify *verify);
/* "DIR/name", malloc'ed; NULL when memory is out. */
char *sf_verify_folder_path(const struct sf_verify *verify, const char *name);
/* The name of a picture of a case: "BASE-reference.png", "BASE-thick.png", "BASE-thick-difference.png"; `method` NULL: the
 * reference. */
void sf_verify_picture_name(const struct sf_verify_case *result, const char *method, bool difference, char *name,
                            size_t room);
/* By this a page of ours is known. */
#define SF_VERIFY_MARK "<meta name=\"generator\" content=\"sfumato verify\"/>"

/* ---- pictures.c ---- */

/* Writes the case's pictures into the folder and sets its scale. */
enum sf_status sf_verify_write_pictures(const struct sf_verify *verify, struct sf_verify_case *result,
                                        const struct sf_verify_drawn *drawn);
/* The colour of a difference as sRGB 0..1: `share` -1 blue, 0 white, 1 red. */
void sf_verify_heat(double share, double rgb[3]);

/* ---- page.c ---- */

/* index.html, plot.svg and verify.json, of what is done so far. */
enum sf_status sf_verify_write_page(const struct sf_verify *verify, bool finished);

#endif
