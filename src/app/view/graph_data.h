/* The renderer's compiled graphs for the panels, from the JSON that sf_renderer_graph_print gives: which pass touches
 * which resource, and in which column the resource's life is drawn. */
#ifndef SF_APP_VIEW_GRAPH_DATA_H
#define SF_APP_VIEW_GRAPH_DATA_H

#include <stdbool.h>
#include <stdint.h>
#include "sfumato/sfumato.h"

enum { SF_DATA_NAME_BYTES = 64, SF_DATA_WORD_BYTES = 20 };
#define SF_DATA_NONE UINT32_MAX

struct sf_data_resource {
    char name[SF_DATA_NAME_BYTES];
    char format[SF_DATA_WORD_BYTES];   /* of an image: "rgba16f" */
    char lifetime[SF_DATA_WORD_BYTES]; /* "transient", "imported", "upload", "readback" ... */
    bool image;
    bool lookable; /* sf_renderer_options.inspect may name it: no readback, nothing of the looking itself */
    uint32_t width, height, layers; /* px; of a buffer 0 */
    uint64_t bytes;
    uint32_t first, last; /* passes that touch it; none: SF_DATA_NONE */
    uint32_t shares_with; /* resource whose memory it takes over, or SF_DATA_NONE */
    uint32_t barriers;    /* of the whole graph */
    uint32_t lane;        /* column: no other life in it at the same time; SF_DATA_NONE when no pass touches it */
};
struct sf_data_use {
    uint32_t resource;
    bool reads, writes;
};
struct sf_data_pass {
    char name[SF_DATA_NAME_BYTES];
    char kind[SF_DATA_WORD_BYTES]; /* "compute", "raster", "transfer" */
    uint64_t bytes_read, bytes_written;
    uint32_t first_use, use_count; /* of the graph's uses: one for each resource that it touches */
    uint32_t barriers;             /* before it */
};
struct sf_data_graph {
    char name[SF_DATA_NAME_BYTES]; /* "sim", "shadow", "frame" */
    struct sf_data_pass *passes;
    struct sf_data_resource *resources;
    struct sf_data_use *uses;
    uint32_t pass_count, resource_count, use_count, lane_count;
    uint32_t culled;                     /* passes that nothing needs */
    uint64_t transient, without_sharing; /* bytes of transient memory as it is, and if nothing shared it; 0: not told */
};
struct sf_graph_data {
    struct sf_data_graph *graphs;
    uint32_t graph_count;
    uint64_t version; /* of the graphs that it was read from */
};

/* Keys that are unknown are passed over, those that are missing leave zeros, "" and SF_DATA_NONE; SF_ERROR_INTERNAL when the
 * text is no JSON. */
enum sf_status sf_graph_data_parse(const char *text, const struct sf_log *log, struct sf_graph_data **data);
void sf_graph_data_destroy(struct sf_graph_data **data);
/* Reads the renderer's graphs again when `version` is not the one that *data was read at. Graphs that cannot be read are
 * none, until the next version. Answers *data; NULL only when memory is out. */
const struct sf_graph_data *sf_graph_data_refresh(struct sf_graph_data **data, const struct sf_renderer *renderer,
                                                  uint64_t version, const struct sf_log *log);

/* The graph that makes the picture, whose resources can be looked at; NULL when there is none. */
const struct sf_data_graph *sf_graph_data_frame(const struct sf_graph_data *data);
uint32_t sf_data_find(const struct sf_data_graph *graph, const char *resource); /* or SF_DATA_NONE */
/* How the pass uses the resource; NULL: not at all. */
const struct sf_data_use *sf_data_use_of(const struct sf_data_graph *graph, const struct sf_data_pass *pass,
                                         uint32_t resource);
/* "640 B", "2.4 MiB". */
enum { SF_BYTES_TEXT = 24 };
const char *sf_bytes_text(uint64_t bytes, char text[SF_BYTES_TEXT]);

#endif
