/* A frame's smoke beside the reference's, computed by threads of its own while the viewer goes on: the difference of every
 * stride-th pixel, numbers, and probes along rays. Called from one thread. */
#ifndef SF_APP_VIEW_COMPARISON_H
#define SF_APP_VIEW_COMPARISON_H

#include <stdbool.h>
#include <stdint.h>
#include "../verify/metrics.h"
#include "sfumato/sfumato.h"

enum { SF_PROBE_POINTS = 65, SF_COMPARISON_MESSAGE = 512 };

enum sf_comparison_stage {
    SF_COMPARISON_RUNS,
    SF_COMPARISON_DONE,
    SF_COMPARISON_STOPPED,
    SF_COMPARISON_FAILED, /* sf_comparison_message says why */
};
enum sf_difference {
    SF_DIFFERENCE_RADIANCE, /* of luminance, Rec. 709, W/(m2 sr) */
    SF_DIFFERENCE_TRANSMITTANCE,
};

/* What the method ended with in a pixel, and the reference along its ray. */
struct sf_probe {
    uint32_t x, y;      /* of the frame */
    float smoke[4];     /* of the method: premultiplied radiance and alpha of the smoke alone */
    float depths[4];    /* of the method: near, far, optical depth, transmittance */
    bool failed, empty; /* the reference: cannot be had (the log says why); meets no smoke */
    struct sf_probe_point points[SF_PROBE_POINTS];
};

struct sf_comparison;
/* Copies what it needs of a frame that was drawn from `scene` with `particles`, `float_aovs` and both aovs, and begins.
 * `stride` as in sf_reference_render; `threads` of the reference, 0: one a processor. What goes wrong is said through
 * `log` (any thread), and stays as the comparison's message. NULL: memory is out. */
struct sf_comparison *sf_comparison_begin(const struct sf_scene *scene, const struct sf_frame *frame, uint32_t stride,
                                          unsigned threads, const struct sf_log *log);
/* Does not wait: a thread that is at work stops after the reference's rows in hand, which may take long where very many
 * spheres overlap, and frees what it used. */
void sf_comparison_destroy(struct sf_comparison **comparison);
/* Asks it to stop, and returns at once. */
void sf_comparison_stop(struct sf_comparison *comparison);
/* A thread is still at work. */
bool sf_comparison_busy(struct sf_comparison *comparison);
enum sf_comparison_stage sf_comparison_stage(struct sf_comparison *comparison);
/* Rows of the reference that are done, 0..*total. */
uint64_t sf_comparison_progress(struct sf_comparison *comparison, uint64_t *total);
/* Counts whatever there is to show anew: rows, the end, a probe. */
uint64_t sf_comparison_version(struct sf_comparison *comparison);
void sf_comparison_message(struct sf_comparison *comparison, char text[SF_COMPARISON_MESSAGE]);
/* Where the scene's settings leave the reference's integral; NULL behind the last. */
const char *sf_comparison_note(const struct sf_comparison *comparison, uint32_t index);
/* Of the frame, and of the pixels that are compared. */
void sf_comparison_size(const struct sf_comparison *comparison, uint32_t size[2], uint32_t compared[2]);
uint32_t sf_comparison_stride(const struct sf_comparison *comparison);

/* ---- when it is done; else NULL and false ---- */
const struct sf_errors *sf_comparison_errors(struct sf_comparison *comparison, uint32_t *unconverged, double *seconds);
/* Method minus reference, [compared height][compared width] as sf_comparison_size says; NaN where the method has no
 * number. */
bool sf_comparison_difference(struct sf_comparison *comparison, enum sf_difference kind, float *values);

/* ---- probes, from the beginning on ---- */
/* Asks for one of a pixel of the frame; of several the last is made. */
void sf_comparison_probe(struct sf_comparison *comparison, uint32_t x, uint32_t y);
/* The newest that is there; false: none. */
bool sf_comparison_probed(struct sf_comparison *comparison, struct sf_probe *probe);

#endif
