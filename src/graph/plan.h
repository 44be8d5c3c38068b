/* The compiled plan: which passes run, where resources live, and the barriers between, as plain data that tests and the
 * player read. */
#ifndef SF_GRAPH_PLAN_H
#define SF_GRAPH_PLAN_H

#include "base/array.h"
#include "graph/graph.h"

/* A use, seen as hazards see it: the access, and the kind of pass that makes it (the stage follows from both). Touches
 * by somebody outside the graph stand once for each kind of pass that could make them; the kind of SF_ACCESS_HOST_READ
 * and _PRESENT means nothing. */
struct sf_touch {
    enum sf_access access;
    enum sf_pass_kind kind;
};
enum { SF_BARRIER_SOURCES_MAX = 18 }; /* every access by every kind of pass that may make it: 17, and the host */

/* Make `resource` (copy: previous or current of a history) ready for `after`, once all of `before` are done.
 * Reads among `before` need their stages only (their writes were made available earlier); writes need their accesses as
 * well. An image goes from the layout of before[0] (undefined when `discard`) to that of after[0], by sf_access_layout
 * with its format. With `discard`, `before` may be touches of other resources in the same memory: a write among them
 * needs a barrier on all memory, as one on this resource alone covers only accesses made through it. */
struct sf_plan_barrier {
    sf_resource resource;
    bool previous;
    bool discard;     /* old contents are not kept (first use, aliased memory, or a full overwrite in another layout) */
    bool from_before; /* some of the `before` touches were made before this play, or by an aliased neighbour */
    struct sf_touch before[SF_BARRIER_SOURCES_MAX];
    uint32_t before_count;
    struct sf_touch after[SF_BARRIER_SOURCES_MAX]; /* all reads that this one barrier serves, or the one write */
    uint32_t after_count;
};

enum sf_store { SF_STORE_KEEP, SF_STORE_DISCARD };

/* The declared uses in their order, then the one that `indirect` implies when it was not declared. */
struct sf_plan_use {
    struct sf_use use;
    enum sf_load load;   /* color and depth */
    enum sf_store store; /* color and depth; a depth_read is neither stored nor discarded (store op NONE) */
};

struct sf_plan_pass {
    uint32_t index; /* into the declared passes */
    const char *name;
    struct sf_plan_barrier *barriers; /* played before the pass */
    uint32_t barrier_count;
    struct sf_plan_use *uses;
    uint32_t use_count;
    uint32_t width, height; /* raster: size of the attachments */
    uint32_t groups[3];     /* compute, when known */
    /* Each used resource's bytes times coverage. Blending, depth testing and loading count as reads; a clear writes all
     * of it; an indirect use reads its arguments; a copy moves what its smaller side holds. */
    uint64_t bytes_read, bytes_written;
};

struct sf_plan_resource {
    const char *name;
    bool image, used;
    enum sf_lifetime lifetime;
    enum sf_format format;
    uint32_t width, height, layers;
    uint64_t bytes;           /* contents */
    uint64_t size, alignment; /* memory needs, as the memory function says */
    uint64_t offset;          /* transient: place in the shared heap */
    uint32_t first, last;     /* transient: first and last plan pass that touches it */
    uint32_t usage;           /* bit set of 1u << enum sf_access over all uses */
    /* Persistent and history, [1] the `previous` copy of a history: each play finds it as this access left it, and
     * leaves it so for the next. Before the first play the player fills it with zeros, puts it into this access's
     * layout and makes that visible to everything. (Imported: `outside`. Others: SF_ACCESS_NONE.) */
    enum sf_access enters[2];
    sf_resource alias_of; /* the earliest transient whose memory it shares, or 0 */
};

struct sf_plan {
    const char *name;
    const struct sf_graph *graph; /* outlives the plan */
    struct sf_plan_pass *passes;
    uint32_t pass_count;
    const char **culled; /* names of the passes that no output needs */
    uint32_t culled_count;
    struct sf_plan_resource *resources; /* [resource - 1] */
    uint32_t resource_count;
    struct sf_plan_barrier *final_barriers; /* after the last pass: imported back to `outside`, readbacks to the host */
    uint32_t final_count;
    uint64_t heap_bytes; /* transient memory with aliasing */
    uint64_t unaliased_bytes;
    struct sf_arena arena;
};

/* Memory needs of a transient or persistent resource. The default (NULL fn) is bytes rounded up to 256 for buffers and
 * 4096 for images. */
struct sf_plan_memory {
    void (*needs)(void *user, const struct sf_plan_resource *resource, uint64_t *size, uint64_t *alignment);
    void *user;
    bool no_alias; /* give each transient its own memory (to find aliasing bugs) */
};

/* Compiles. Errors (SF_ERROR_INTERNAL, the log names graph, pass and resource): read before write, two writers (a full
 * overwrite of contents that nobody read), unknown resource, wrong usage (access that does not fit the resource, the
 * pass's kind or the format; two uses of one resource in a pass that conflict; a size that is relative to itself),
 * duplicate names, limits. SF_ERROR_MEMORY. *plan is then NULL. Reads the graph only, so any thread may compile while
 * no thread declares. */
enum sf_status sf_plan_create(const struct sf_graph *graph, const struct sf_plan_memory *memory,
                              const struct sf_log *log, struct sf_plan **plan);
void sf_plan_destroy(struct sf_plan **plan);

enum sf_plan_format { SF_PLAN_TEXT, SF_PLAN_DOT, SF_PLAN_JSON };
/* Stable: no pointers, no times; the same graph gives the same text. Appends to `text`. */
void sf_plan_print(const struct sf_plan *plan, enum sf_plan_format format, struct sf_text *text);

#endif
