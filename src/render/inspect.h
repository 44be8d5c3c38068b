/* Looking at an image or a buffer of the frame's graph: its last contents come back; images become floats. */
#ifndef SF_RENDER_INSPECT_H
#define SF_RENDER_INSPECT_H

#include "graph/graph.h"

enum { SF_INSPECTED_BYTES_MAX = 64 << 10 }; /* of a buffer */

struct sf_inspected {
    sf_resource readback; /* 0: nothing is inspected */
    enum sf_format format;
    uint32_t width, height, channels; /* image: layers stand below each other */
    uint32_t words;                   /* buffer: that come back; 0: it is an image */
};

/* Before the graph is declared: makes unwritten parts of the image tell themselves apart. `name` may be NULL. */
void sf_inspect_prepare(struct sf_graph *graph, const char *name);
/* When all else is declared: a copy of the image, or of the buffer's front, into a readback buffer. SF_ERROR_USAGE, with
 * the names there are, when nothing has this one. */
enum sf_status sf_inspect_declare(struct sf_graph *graph, const char *name, const struct sf_log *log,
                                  struct sf_inspected *inspected);
/* Of an image. */
uint64_t sf_inspect_values(const struct sf_inspected *inspected);
/* `to` takes sf_inspect_values() floats. 8-bit formats become 0..1 (sRGB ones stay encoded). */
void sf_inspect_convert(const struct sf_inspected *inspected, const void *from, float *to);

#endif
