/* The render graph's declaration: resources, and passes that say what they touch and how. Pure data; no Vulkan, no GPU.
 *
 * A pass is one dispatch, one draw or one transfer. It names its shader, its uses, its push constants and the size of
 * its work; nothing else is needed to play it, so nobody above src/gpu ever holds a command buffer. Passes run in the
 * order in which they are declared (that order is the meaning: a use sees what earlier passes wrote); compiling
 * (plan.h) culls, places, and derives every barrier. */
#ifndef SF_GRAPH_GRAPH_H
#define SF_GRAPH_GRAPH_H

#include <stdbool.h>
#include <stdint.h>
#include "base/log.h"

enum {
    SF_PASS_USES_MAX = 24,
    SF_PASS_COLORS_MAX = 4,
    SF_PASS_CONSTANTS_MAX = 16,
    SF_PUSH_BYTES_MAX = 128,
};

/* An index into the graph's resources plus one; 0 is none. */
typedef uint32_t sf_resource;

enum sf_format {
    SF_FORMAT_NONE,
    SF_FORMAT_R8_UNORM,
    SF_FORMAT_RGBA8_UNORM,
    SF_FORMAT_RGBA8_SRGB,
    SF_FORMAT_BGRA8_UNORM,
    SF_FORMAT_R16F,
    SF_FORMAT_RG16F,
    SF_FORMAT_RGBA16F,
    SF_FORMAT_R32F,
    SF_FORMAT_RG32F,
    SF_FORMAT_RGBA32F,
    SF_FORMAT_R32_UINT,
    SF_FORMAT_D32F,
    SF_FORMAT_COUNT,
};
const char *sf_format_name(enum sf_format format);
uint32_t sf_format_bytes(enum sf_format format);

enum sf_lifetime {
    SF_TRANSIENT,  /* lives within one play of the graph; shares memory with others whose lives do not meet */
    SF_PERSISTENT, /* keeps its contents from play to play; owned by the graph; zero-filled at first */
    SF_HISTORY,    /* two copies that change places after each play: `previous` uses read the last play's */
    SF_IMPORTED,   /* made by somebody else and bound before playing; enters and leaves in `outside` access */
    SF_UPLOAD,     /* buffer only: written by the CPU before each play, read-only on the GPU; one slice a play */
    SF_READBACK,   /* buffer only: written by a transfer, read by the CPU after the play; one slice a frame in flight */
};
const char *sf_lifetime_name(enum sf_lifetime lifetime);

/* How a pass touches a resource. The stage follows from the pass's kind. */
enum sf_access {
    SF_ACCESS_NONE,
    SF_ACCESS_SAMPLED,        /* image: texture() or texelFetch() with `sampler` */
    SF_ACCESS_UNIFORM,        /* buffer: uniform block */
    SF_ACCESS_STORAGE_READ,   /* buffer or image, declared readonly in the shader */
    SF_ACCESS_STORAGE_WRITE,  /* buffer or image, declared writeonly: the pass writes every byte that is read later */
    SF_ACCESS_STORAGE_MODIFY, /* buffer or image: reads and writes, or writes only in part */
    SF_ACCESS_INDIRECT,       /* buffer: arguments of the draw or dispatch; implied by sf_pass_desc.indirect */
    SF_ACCESS_COLOR,          /* raster: colour attachment number `binding`; attachments have one layer, and one size */
    SF_ACCESS_DEPTH,          /* raster: depth attachment, tested and written */
    SF_ACCESS_DEPTH_READ,     /* raster: depth attachment, tested only */
    SF_ACCESS_TRANSFER_READ,
    SF_ACCESS_TRANSFER_WRITE,
    SF_ACCESS_HOST_READ, /* only as `outside`, or derived for readbacks */
    SF_ACCESS_PRESENT,   /* only as `outside` of an imported swapchain image */
    SF_ACCESS_COUNT,
};
const char *sf_access_name(enum sf_access access); /* "sampled"; never NULL */
bool sf_access_writes(enum sf_access access);
/* May it read? (Colour and depth attachments do when they blend, test or load.) */
bool sf_access_reads(enum sf_access access);

/* The layout class in which an image must be for an access. Accesses of equal layout need no change between them. */
enum sf_layout {
    SF_LAYOUT_NONE, /* buffers, SF_ACCESS_NONE and SF_ACCESS_HOST_READ */
    SF_LAYOUT_GENERAL,
    SF_LAYOUT_SAMPLED, /* read-only by shaders; but a depth image, when sampled, is in SF_LAYOUT_DEPTH_READ, always */
    SF_LAYOUT_COLOR,
    SF_LAYOUT_DEPTH,
    SF_LAYOUT_DEPTH_READ, /* read-only depth attachment, sampled depth, or both at once */
    SF_LAYOUT_TRANSFER_READ,
    SF_LAYOUT_TRANSFER_WRITE,
    SF_LAYOUT_PRESENT,
};
enum sf_layout sf_access_layout(enum sf_access access, enum sf_format format);

/* What an attachment holds when its pass begins. */
enum sf_load {
    SF_LOAD_KEEP,    /* what earlier passes wrote: this pass modifies it (an error where nobody wrote) */
    SF_LOAD_CLEAR,   /* `clear` */
    SF_LOAD_DISCARD, /* anything: the pass writes every pixel that is read later */
};

/* The first two clamp to the edge. LINEAR falls back to nearest where the device cannot filter the format. */
enum sf_sampler { SF_SAMPLER_NEAREST, SF_SAMPLER_LINEAR, SF_SAMPLER_LINEAR_REPEAT, SF_SAMPLER_COUNT };

/* A size: absolute, or that of another image, declared before, times num/den, rounded up, at least 1. */
struct sf_size {
    uint32_t width, height; /* pixels; used when relative_to is 0 */
    sf_resource relative_to;
    uint32_t num, den; /* 0 means 1 */
};

struct sf_image_desc {
    const char *name; /* copied; unique within the graph; stable, such as "camera.minmax" */
    enum sf_format format;
    enum sf_lifetime lifetime;
    struct sf_size size;
    uint32_t layers;        /* array layers; 0 means 1. Sampled as sampler2DArray when above 1 */
    enum sf_access outside; /* imported: the access in which it enters and must leave. Needed for SF_IMPORTED only */
};

struct sf_buffer_desc {
    const char *name;
    enum sf_lifetime lifetime;
    uint64_t bytes;
    enum sf_access outside;
    bool history; /* an imported buffer that is a ping-pong pair */
};

struct sf_use {
    sf_resource resource;
    enum sf_access access;
    uint32_t binding; /* shader: binding in set 0; SF_ACCESS_COLOR: attachment number; else unused */
    bool previous;    /* history: the copy written by the play before; read only, and not as indirect arguments */
    enum sf_load load;
    float clear[4]; /* depth: clear[0] */
    enum sf_sampler sampler;
};

enum sf_pass_kind { SF_PASS_COMPUTE, SF_PASS_RASTER, SF_PASS_TRANSFER };
const char *sf_pass_kind_name(enum sf_pass_kind kind);

enum sf_blend {
    SF_BLEND_NONE,
    SF_BLEND_MIN_ADD,       /* MIN on colour, ADD on alpha: near/far/life and optical depth in one target */
    SF_BLEND_PREMULTIPLIED, /* src + (1 - src.a) dst, alpha likewise */
    SF_BLEND_ADD,
    SF_BLEND_MULTIPLY,
};
enum sf_cull { SF_CULL_NONE, SF_CULL_BACK, SF_CULL_FRONT };
/* Reversed z: 1 near, 0 far. OFF exactly when the pass has no depth attachment. */
enum sf_depth_test { SF_DEPTH_OFF, SF_DEPTH_GREATER_EQUAL, SF_DEPTH_ALWAYS, SF_DEPTH_EQUAL };

struct sf_raster {
    enum sf_blend blend[SF_PASS_COLORS_MAX];
    enum sf_cull cull; /* front faces are counter-clockwise in a y-up view */
    enum sf_depth_test depth;
    bool triangle_strip; /* else a triangle list */
};

enum sf_transfer {
    SF_TRANSFER_COPY,  /* uses[0] read -> uses[1] write: buffer to buffer, image to image of equal size, image to buffer
                         (tightly packed rows, layers in order) or buffer to image */
    SF_TRANSFER_FILL,  /* uses[0] write, a buffer, filled with the 32-bit word `fill` */
    SF_TRANSFER_FRONT, /* uses[0] read -> uses[1] write, both buffers: as much as the smaller one holds */
};

struct sf_pass_desc {
    const char *name; /* copied; unique; "room.what" */
    enum sf_pass_kind kind;
    const struct sf_use *uses; /* copied */
    uint32_t use_count;

    const char *shader;   /* copied; compute shader, or vertex shader: "thick/march.comp" as under glsl/ */
    const char *fragment; /* raster; may be NULL for depth only */
    uint32_t constants[SF_PASS_CONSTANTS_MAX]; /* specialization constants with ids 0..constant_count-1, 32-bit words */
    uint32_t constant_count;
    /* Read each time the pass is recorded; must outlive the compiled graph. NULL when push_bytes is 0. */
    const void *push;
    uint32_t push_bytes;

    /* Size of the work, one of: (1) compute: `groups`; (2) compute: `domain`, an image covered by groups of local[0] x
     * local[1] pixels (and its layers in z); (3) `indirect`, arguments in a buffer; (4) raster: vertices x instances.
     * `groups_live` (3 words) and `draw_live` (vertices, instances) when not NULL are read at each recording instead; a
     * zero skips the pass's work. */
    uint32_t groups[3];
    const uint32_t *groups_live;
    sf_resource domain;
    uint32_t local[2];
    sf_resource indirect; /* VkDispatchIndirectCommand or VkDrawIndirectCommand at indirect_offset */
    uint64_t indirect_offset;
    uint32_t vertices, instances;
    const uint32_t *draw_live;
    struct sf_raster raster;

    enum sf_transfer transfer;
    uint32_t fill;

    bool keep; /* never culled, though no output needs it */
    /* For the report of bytes moved: how many bytes of the use's resource the pass touches is by default all of it. A
     * pass that covers only part (tiles, live particles) may say so: fraction in 0..1, default 0 = all. */
    float coverage;
};

struct sf_graph;
enum sf_status sf_graph_create(const char *name, const struct sf_log *log, struct sf_graph **graph);
void sf_graph_destroy(struct sf_graph **graph);

/* Declarations never fail by themselves: the first error is kept and given by sf_plan_create, with the names in it.
 * They return 0 then. */
sf_resource sf_graph_image(struct sf_graph *graph, const struct sf_image_desc *desc);
sf_resource sf_graph_buffer(struct sf_graph *graph, const struct sf_buffer_desc *desc);
void sf_graph_pass(struct sf_graph *graph, const struct sf_pass_desc *desc);
/* Marks a resource as wanted after the play (a frame, a readback, next frame's state): it and what it needs is not
 * culled. Persistent, history-written, imported-written and readback resources are outputs by themselves. */
void sf_graph_output(struct sf_graph *graph, sf_resource resource);
/* Before the passes are declared: where no pass writes the transient image of that name, it shall hold the NaN
 * of SF_GRAPH_UNWRITTEN (0 in formats of whole numbers) instead of anything, so that who looks at it sees what was made and
 * what was not. Costs a buffer of
 * the image's size and a copy, where the first pass does not clear it anyway. `name` is copied; without such an image
 * it does nothing. */
void sf_graph_watch(struct sf_graph *graph, const char *name);
/* The bits of that NaN, in a float or in a half that was made a float: none that an operation gives by itself. */
#define SF_GRAPH_UNWRITTEN 0x7fe3c000u
/* The resource of that name, or 0. */
sf_resource sf_graph_find(const struct sf_graph *graph, const char *name);

/* What was declared, for the compiler and the player: passes by index from 0, resources from 1. Everything pointed to
 * belongs to the graph (all but `push`, `groups_live` and `draw_live`, which are the declarer's) and lives as long as
 * it. */
const char *sf_graph_name(const struct sf_graph *graph);
uint32_t sf_graph_pass_count(const struct sf_graph *graph);
const struct sf_pass_desc *sf_graph_pass_at(const struct sf_graph *graph, uint32_t index);
uint32_t sf_graph_resource_count(const struct sf_graph *graph);
/* NULL when the resource is a buffer, and the other way round. */
const struct sf_image_desc *sf_graph_image_at(const struct sf_graph *graph, sf_resource resource);
const struct sf_buffer_desc *sf_graph_buffer_at(const struct sf_graph *graph, sf_resource resource);

#endif
