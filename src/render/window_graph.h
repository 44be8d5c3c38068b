/* The graph that draws a window's image: pass `window.picture` clears it and draws the picture, pass `window.ui` lays
 * the overlay's triangles over it. Values are written as sRGB codes, so the image's format is a plain UNORM one. */
#ifndef SF_RENDER_WINDOW_GRAPH_H
#define SF_RENDER_WINDOW_GRAPH_H

#include "gpu/gpu.h"
#include "output/tone.h"
#include "shared/window.h"
#include "sfumato/sfumato.h"

/* What a frame is drawn from. */
struct sf_window_input {
    const struct sf_window_frame *frame;
    struct sf_gpu_image *picture; /* what frame->renderer shows; NULL: nothing. Rests in SF_ACCESS_SAMPLED */
    struct sf_gpu_image *beside;  /* a second one of the same size and format, right of the wipe; NULL: none */
    uint32_t picture_width, picture_height;
    bool float_color;          /* RGBA32F, else RGBA16F */
    struct sf_gpu_image *font; /* R8, rests in SF_ACCESS_SAMPLED */
    uint32_t font_width, font_height;
};

enum sf_window_source {
    SF_WINDOW_PIXELS, /* the host's, by an upload; with none nothing is drawn */
    SF_WINDOW_EXACT,  /* the renderer's picture, texel by texel */
    SF_WINDOW_SCALED, /* the same, filtered linearly */
};

/* All that a graph is compiled for: one of another shape cannot be played with it. Words only, so that shapes are
 * compared as memory. */
struct sf_window_shape {
    uint32_t width, height; /* of the window's image, px */
    enum sf_format format;
    enum sf_window_source source;
    uint32_t source_width, source_height; /* at least 1 x 1 */
    enum sf_format source_format;         /* SF_FORMAT_NONE for SF_WINDOW_PIXELS */
    uint32_t beside;                      /* 1: there are two pictures */
    enum sf_tone_mode tone;
    float background[3];
    uint32_t font_width, font_height;
    uint32_t vertices, corners, clips; /* room in the overlay's buffers */
};

/* What the passes read each time they are recorded. */
struct sf_window_live {
    struct sf_window_picture_push picture;
    struct sf_window_ui_push ui;
    uint32_t picture_draw[2], ui_draw[2]; /* vertices, instances */
};

struct sf_window_resources {
    sf_resource target, picture, pixels, font, vertices, corners, clips; /* picture or pixels is 0 */
    sf_resource beside;                                                  /* 0: one picture */
};

struct sf_window_graph {
    struct sf_window_shape shape;
    struct sf_window_resources resources;
    struct sf_window_live live;
    struct sf_graph *graph;
    struct sf_plan *plan;
    struct sf_player *player; /* NULL: there is no graph */
};

/* The shape that `input` wants, all but the target's size and format; room for the overlay is never less than `before`
 * has. SF_ERROR_USAGE when the frame is not as its contract says: an unknown tone, an index out of range. */
enum sf_status sf_window_shape_of(const struct sf_window_input *input, const struct sf_window_shape *before,
                                  const struct sf_log *log, struct sf_window_shape *shape);
/* Declares the passes into `graph`, drawing into `target`, an image of the shape's size. `live` must outlive it. */
void sf_window_graph_declare(struct sf_graph *graph, const struct sf_window_shape *shape,
                             const struct sf_window_live *live, sf_resource target,
                             struct sf_window_resources *resources);
/* Within a frame: uploads and bindings for the next play, all but the target. `input` is one that this shape was made
 * of. */
enum sf_status sf_window_graph_fill(struct sf_window_graph *graph, const struct sf_window_input *input,
                                    const struct sf_log *log);
/* Makes `graph` (zeroed, or made before) one that draws the shape into an imported image of SF_ACCESS_PRESENT. When it
 * fails there is no graph. */
enum sf_status sf_window_graph_fit(struct sf_window_graph *graph, struct sf_gpu *gpu,
                                   const struct sf_window_shape *shape, const struct sf_log *log);
void sf_window_graph_finish(struct sf_window_graph *graph);

#endif
