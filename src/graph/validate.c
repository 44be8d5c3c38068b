/* Validation of resources, and of what passes say to each other: nothing is read before it is written, nothing written
 * for nobody. validate_pass.c judges each pass by itself. Every message names the graph, the pass or resource, and the
 * remedy. */
#include "graph/internal.h"

#include <stdio.h>

enum { IMAGE_SIDE_MAX = 1 << 16, IMAGE_LAYERS_MAX = 2048 };
static const uint64_t BUFFER_BYTES_MAX = (uint64_t)1 << 48;

static enum sf_status fail_resource(const struct sf_graph *graph, const struct sf_graph_resource *resource,
                                    const struct sf_log *log, const char *why)
{
    return sf_fail(log, SF_ERROR_INTERNAL, "graph '%s': %s '%s': %s", graph->name,
                   resource->is_image ? "image" : "buffer", resource->name, why);
}

static enum sf_status check_image_size(const struct sf_graph *graph, sf_resource self, const struct sf_log *log)
{
    const struct sf_graph_resource *resource = sf_graph_get(graph, self);
    const struct sf_size *size = &resource->image.size;
    uint32_t width, height;

    if (size->relative_to == self)
        return fail_resource(graph, resource, log,
                             "its size is relative to itself; name another image, or give width and height");
    if (size->relative_to > self)
        return fail_resource(graph, resource, log,
                             "its size is relative to an unknown resource; declare that image before this one");
    if (size->relative_to && !sf_graph_get(graph, size->relative_to)->is_image)
        return fail_resource(graph, resource, log,
                             "its size is relative to a buffer, which has no width; name an image");
    sf_image_extent(graph, self, &width, &height);
    if (width == 0 || height == 0)
        return fail_resource(graph, resource, log, "its size is zero; give width and height, or relative_to");
    if (width > IMAGE_SIDE_MAX || height > IMAGE_SIDE_MAX || resource->image.layers > IMAGE_LAYERS_MAX)
        return fail_resource(graph, resource, log, "is too large; sides end at 65536 pixels and layers at 2048");
    return SF_OK;
}

static enum sf_status check_resource(const struct sf_graph *graph, sf_resource self, const struct sf_log *log)
{
    const struct sf_graph_resource *resource = sf_graph_get(graph, self);
    bool imported = resource->lifetime == SF_IMPORTED;

    if ((unsigned)resource->lifetime > SF_READBACK)
        return fail_resource(graph, resource, log, "its lifetime is none of enum sf_lifetime");
    if (imported && (resource->outside == SF_ACCESS_NONE || !sf_access_suits(resource->outside, resource->is_image)))
        return fail_resource(
            graph, resource, log,
            "is imported, and `outside` is missing or does not fit it; say in which access it enters and leaves");
    if (!imported && resource->outside != SF_ACCESS_NONE)
        return fail_resource(graph, resource, log, "has an `outside` access but is not imported; leave it out");
    if (!resource->is_image) {
        if (resource->buffer.history && !imported)
            return fail_resource(graph, resource, log,
                                 "`history` is for imported buffers; use the lifetime SF_HISTORY instead");
        if (resource->buffer.bytes == 0 || resource->buffer.bytes > BUFFER_BYTES_MAX)
            return fail_resource(graph, resource, log, "its size must be from 1 to 2^48 bytes");
        return SF_OK;
    }
    if (resource->lifetime == SF_UPLOAD || resource->lifetime == SF_READBACK)
        return fail_resource(graph, resource, log,
                             "only buffers can be SF_UPLOAD or SF_READBACK; copy between it and a buffer");
    if (resource->image.format == SF_FORMAT_NONE || (unsigned)resource->image.format >= SF_FORMAT_COUNT)
        return fail_resource(graph, resource, log, "its format is missing or unknown; use one of enum sf_format");
    return check_image_size(graph, self, log);
}

/* What is known of a copy while the passes go by. Pass numbers are plus one; 0 is none. */
struct story {
    uint32_t first_reader;
    uint32_t writer; /* the last */
    bool read;       /* since that write */
};

static enum sf_status check_use_order(const struct sf_graph *graph, uint32_t index, const struct sf_use *use,
                                      struct story *story, const struct sf_log *log)
{
    const struct sf_graph_resource *resource = sf_graph_get(graph, use->resource);
    const char *pass = graph->passes[index].name;
    bool overwrites = sf_use_overwrites(use), found;

    /* What a play finds in it, before any of its passes has written. */
    found = resource->lifetime == SF_PERSISTENT || resource->lifetime == SF_IMPORTED ||
            resource->lifetime == SF_UPLOAD || use->previous;
    if (!overwrites && !story->writer && !found)
        return sf_fail(log, SF_ERROR_INTERNAL,
                       "graph '%s': pass '%s' reads '%s' before any pass writes it (%s counts as reading); declare the "
                       "pass that writes it "
                       "earlier, clear or fill it first, or %s",
                       graph->name, pass, resource->name, sf_access_name(use->access),
                       resource->lifetime == SF_HISTORY ? "read its previous copy" : "make it SF_PERSISTENT");
    if (overwrites && story->writer && !story->read)
        return sf_fail(log, SF_ERROR_INTERNAL,
                       "graph '%s': '%s' has two writers: pass '%s' replaces all that pass '%s' wrote, which nobody "
                       "read; drop one, "
                       "read between, or use an access that keeps what is there (storage_modify, or load SF_LOAD_KEEP)",
                       graph->name, resource->name, pass, graph->passes[story->writer - 1].name);
    if (!overwrites) {
        story->read = true;
        if (!story->first_reader)
            story->first_reader = index + 1;
    }
    if (sf_access_writes(use->access)) {
        story->writer = index + 1;
        story->read = false;
    }
    return SF_OK;
}

static enum sf_status check_ends(const struct sf_graph *graph, const struct story *stories, const struct sf_log *log)
{
    for (sf_resource r = 1; r <= graph->resource_count; r++) {
        const struct sf_graph_resource *resource = sf_graph_get(graph, r);
        const struct story *current = &stories[sf_copy_index(r, false)], *previous = &stories[sf_copy_index(r, true)];
        uint32_t reader = current->first_reader ? current->first_reader : previous->first_reader;

        if (current->writer || resource->lifetime == SF_IMPORTED || resource->lifetime == SF_UPLOAD)
            continue;
        if (reader)
            return sf_fail(log, SF_ERROR_INTERNAL,
                           "graph '%s': pass '%s' reads '%s', which no pass ever writes; declare the pass that writes "
                           "it, or import it",
                           graph->name, graph->passes[reader - 1].name, resource->name);
        if (resource->output)
            return fail_resource(graph, resource, log,
                                 "is an output that no pass writes; declare the pass that writes it");
    }
    return SF_OK;
}

static enum sf_status check_order(const struct sf_graph *graph, struct story *stories, const struct sf_log *log)
{
    struct sf_use use;
    enum sf_status status;

    for (uint32_t p = 0; p < graph->pass_count; p++) {
        /* Uses of one copy within a pass are all reads, or one write: the order among them does not matter. */
        for (uint32_t i = 0; sf_pass_use(&graph->passes[p], i, &use); i++) {
            status = check_use_order(graph, p, &use, &stories[sf_copy_index(use.resource, use.previous)], log);
            if (status)
                return status;
        }
    }
    return check_ends(graph, stories, log);
}

enum sf_status sf_graph_validate(const struct sf_graph *graph, struct sf_arena *scratch, const struct sf_log *log)
{
    struct story *stories;
    enum sf_status status = graph->status;

    if (status)
        return sf_fail(log, status, "%s", graph->error ? graph->error : "declaring a graph: out of memory");
    for (sf_resource r = 1; r <= graph->resource_count && !status; r++)
        status = check_resource(graph, r, log);
    for (uint32_t p = 0; p < graph->pass_count && !status; p++)
        status = sf_graph_validate_pass(graph, &graph->passes[p], log);
    if (status)
        return status;
    stories = sf_arena_alloc(scratch, graph->resource_count * 2 * sizeof *stories);
    if (!stories)
        return sf_fail(log, SF_ERROR_MEMORY, "graph '%s': out of memory", graph->name);
    return check_order(graph, stories, log);
}
