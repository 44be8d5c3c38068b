/* What the graph room's files share. Nobody outside the room includes it. */
#ifndef SF_GRAPH_INTERNAL_H
#define SF_GRAPH_INTERNAL_H

#include "graph/plan.h"

/* ---- access.c ---- */

/* Does the access fit an image (else a buffer), and a kind of pass? */
bool sf_access_suits(enum sf_access access, bool image);
bool sf_access_in_kind(enum sf_access access, enum sf_pass_kind kind);
bool sf_access_by_pass(enum sf_access access);   /* by passes of some kind; not so the host's and the screen's */
bool sf_access_in_shader(enum sf_access access); /* bound in the shader's set 0 */
bool sf_access_attaches(enum sf_access access);
/* The touches that `outside` stands for; returns how many. */
uint32_t sf_access_outside(enum sf_access access, struct sf_touch touches[2]);
/* True when the use needs nothing of what was there before: its writes replace all that is read later. */
bool sf_use_overwrites(const struct sf_use *use);

/* ---- graph.c ---- */

struct sf_graph_resource {
    const char *name;
    enum sf_lifetime lifetime;
    enum sf_access outside;
    bool is_image, output;
    struct sf_image_desc image;
    struct sf_buffer_desc buffer;
};

struct sf_graph {
    const char *name;
    struct sf_graph_resource *resources;
    size_t resource_count, resource_capacity;
    struct sf_pass_desc *passes;
    size_t pass_count, pass_capacity;
    enum sf_status status; /* the first error of the declarations, and its words */
    const char *error;
    const char *watched; /* sf_graph_watch's, until the image's first use; NULL: none */
    struct sf_arena arena;
};

static inline const struct sf_graph_resource *sf_graph_get(const struct sf_graph *graph, sf_resource resource)
{
    return &graph->resources[resource - 1];
}

/* Two copies to a history, one to others: does the resource have a `previous`? */
static inline bool sf_resource_paired(const struct sf_graph_resource *resource)
{
    return resource->lifetime == SF_HISTORY || (!resource->is_image && resource->buffer.history);
}

/* Use number `index` of a pass, the one implied by `indirect` last; false when there are no more. */
bool sf_pass_use(const struct sf_pass_desc *pass, uint32_t index, struct sf_use *use);

/* Arguments of an indirect dispatch and draw, in bytes: three and four words. */
enum { SF_DISPATCH_ARGUMENT_BYTES = 12, SF_DRAW_ARGUMENT_BYTES = 16 };

/* ---- size.c: of valid graphs only ---- */

/* Width and height of an image, relative sizes resolved. */
void sf_image_extent(const struct sf_graph *graph, sf_resource resource, uint32_t *width, uint32_t *height);
/* Bytes of a resource's contents (one copy). */
uint64_t sf_resource_bytes(const struct sf_graph *graph, sf_resource resource);

/* ---- validate.c, validate_pass.c ---- */

enum sf_status sf_graph_validate(const struct sf_graph *graph, struct sf_arena *scratch, const struct sf_log *log);
enum sf_status sf_graph_validate_pass(const struct sf_graph *graph, const struct sf_pass_desc *pass,
                                      const struct sf_log *log);

/* ---- the steps of compiling; plan.c calls them in order ---- */

/* All that one pass does to one copy of a resource: what barriers stand between. Several reads (of one layout), or one
 * write. */
struct sf_node {
    uint32_t pass; /* of the plan */
    struct sf_touch touches[4];
    uint32_t touch_count;
    bool writes, overwrites;
    enum sf_layout layout;
    uint32_t next; /* the same copy's node in a later pass, or SF_NODE_END */
};
#define SF_NODE_END UINT32_MAX

struct sf_compiler {
    const struct sf_graph *graph;
    const struct sf_plan_memory *memory; /* never NULL */
    struct sf_plan *plan;
    struct sf_arena *scratch; /* dies with the compiler */
    bool *live;               /* [declared pass]: some output needs it */
    struct sf_node *nodes;
    uint32_t node_count;
    uint32_t *heads, *tails; /* [copy]: first and last node, or SF_NODE_END */
};

/* Copies are numbered: a resource's current one, then its previous one. */
static inline uint32_t sf_copy_index(sf_resource resource, bool previous)
{
    return (resource - 1) * 2 + previous;
}

/* Each returns false when memory is out. */
bool sf_compile_cull(struct sf_compiler *compiler);      /* cull.c: live, culled names, the plan's passes */
bool sf_compile_passes(struct sf_compiler *compiler);    /* pass.c: uses, size of the work, bytes moved */
bool sf_compile_nodes(struct sf_compiler *compiler);     /* node.c: nodes, and what resources are used for and when */
void sf_compile_stores(struct sf_compiler *compiler);    /* node.c: which attachments are stored */
void sf_compile_needs(struct sf_compiler *compiler);     /* memory.c: how much memory each resource takes */
bool sf_compile_placement(struct sf_compiler *compiler); /* memory.c: where transients lie */
bool sf_compile_barriers(struct sf_compiler *compiler);  /* barrier.c */

/* ---- print.c, and its formats ---- */

const char *sf_load_name(enum sf_load load);
const char *sf_store_name(enum sf_store store);
void sf_plan_print_dot(const struct sf_plan *plan, struct sf_text *text);  /* print_dot.c */
void sf_plan_print_json(const struct sf_plan *plan, struct sf_text *text); /* print_json.c */

#endif
