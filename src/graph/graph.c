/* Declaring a graph: everything is copied, and nothing but memory, names and array lengths is judged here; validate.c
 * does the rest. */
#include "graph/internal.h"

#include <stdlib.h>
#include <string.h>

enum sf_status sf_graph_create(const char *name, const struct sf_log *log, struct sf_graph **graph)
{
    struct sf_graph *made = calloc(1, sizeof *made);

    *graph = NULL;
    if (made)
        made->name = sf_arena_strdup(&made->arena, name);
    if (!made || !made->name) {
        sf_graph_destroy(&made);
        return sf_fail(log, SF_ERROR_MEMORY, "graph '%s': out of memory", name);
    }
    *graph = made;
    return SF_OK;
}

void sf_graph_destroy(struct sf_graph **graph)
{
    if (!graph || !*graph)
        return;
    free((*graph)->resources);
    free((*graph)->passes);
    sf_arena_finish(&(*graph)->arena);
    free(*graph);
    *graph = NULL;
}

/* Keeps the first error; `what` and `name` say which declaration, `why` what is wrong and how to mend it. */
static void keep_error(struct sf_graph *graph, const char *what, const char *name, const char *why)
{
    if (graph->status)
        return;
    graph->status = SF_ERROR_INTERNAL;
    graph->error = sf_arena_printf(&graph->arena, "graph '%s': %s '%s': %s", graph->name, what, name ? name : "", why);
    if (!graph->error)
        graph->status = SF_ERROR_MEMORY;
}

static void out_of_memory(struct sf_graph *graph)
{
    if (!graph->status)
        graph->status = SF_ERROR_MEMORY;
}

static sf_resource add_resource(struct sf_graph *graph, const struct sf_graph_resource *resource)
{
    struct sf_graph_resource copy = *resource;

    if (graph->status)
        return 0;
    if (!copy.name || !*copy.name) {
        keep_error(graph, copy.is_image ? "image" : "buffer", "",
                   "has no name; give it a stable one, such as \"camera.minmax\"");
        return 0;
    }
    if (sf_graph_find(graph, copy.name)) {
        keep_error(graph, copy.is_image ? "image" : "buffer", copy.name,
                   "the name is taken by another resource; each needs its own");
        return 0;
    }
    copy.name = sf_arena_strdup(&graph->arena, copy.name);
    if (!copy.name || !sf_array_reserve((void **)&graph->resources, graph->resource_count, &graph->resource_capacity, 1,
                                        sizeof copy)) {
        out_of_memory(graph);
        return 0;
    }
    copy.image.name = copy.is_image ? copy.name : NULL;
    copy.buffer.name = copy.is_image ? NULL : copy.name;
    graph->resources[graph->resource_count++] = copy;
    return (sf_resource)graph->resource_count;
}

sf_resource sf_graph_image(struct sf_graph *graph, const struct sf_image_desc *desc)
{
    struct sf_graph_resource resource = {
        .name = desc->name,
        .lifetime = desc->lifetime,
        .outside = desc->outside,
        .is_image = true,
        .image = *desc,
    };

    if (!resource.image.layers)
        resource.image.layers = 1;
    if (!resource.image.size.num)
        resource.image.size.num = 1;
    if (!resource.image.size.den)
        resource.image.size.den = 1;
    return add_resource(graph, &resource);
}

sf_resource sf_graph_buffer(struct sf_graph *graph, const struct sf_buffer_desc *desc)
{
    struct sf_graph_resource resource = {
        .name = desc->name,
        .lifetime = desc->lifetime,
        .outside = desc->outside,
        .buffer = *desc,
    };

    return add_resource(graph, &resource);
}

static bool copy_pass(struct sf_graph *graph, struct sf_pass_desc *pass)
{
    struct sf_use *uses = sf_arena_alloc(&graph->arena, pass->use_count * sizeof *uses);

    if (!uses)
        return false;
    if (pass->use_count)
        memcpy(uses, pass->uses, pass->use_count * sizeof *uses);
    pass->uses = uses;
    if (!(pass->name = sf_arena_strdup(&graph->arena, pass->name)))
        return false;
    if (pass->shader && !(pass->shader = sf_arena_strdup(&graph->arena, pass->shader)))
        return false;
    if (pass->fragment && !(pass->fragment = sf_arena_strdup(&graph->arena, pass->fragment)))
        return false;
    return sf_array_reserve((void **)&graph->passes, graph->pass_count, &graph->pass_capacity, 1, sizeof *pass);
}

/* Fills the watched image, by way of a buffer, with the word that stands for no value. */
static void fill_watched(struct sf_graph *graph, sf_resource image)
{
    enum sf_format format = graph->resources[image - 1].image.format;
    bool halves = format == SF_FORMAT_R16F || format == SF_FORMAT_RG16F || format == SF_FORMAT_RGBA16F;
    bool floats = format == SF_FORMAT_R32F || format == SF_FORMAT_RG32F || format == SF_FORMAT_RGBA32F;
    uint64_t bytes = (sf_resource_bytes(graph, image) + 3) & ~(uint64_t)3;
    /* Not in the transients' memory: synchronization validation follows buffers and images apart, and misses the waits
     * of two images for each other when a buffer had their memory in between. */
    sf_resource fill = sf_graph_buffer(
        graph, &(struct sf_buffer_desc){.name = "watch.fill", .lifetime = SF_PERSISTENT, .bytes = bytes});
    const struct sf_use filled = {.resource = fill, .access = SF_ACCESS_TRANSFER_WRITE};
    const struct sf_use copied[] = {{.resource = fill, .access = SF_ACCESS_TRANSFER_READ},
                                    {.resource = image, .access = SF_ACCESS_TRANSFER_WRITE}};

    sf_graph_pass(graph, &(struct sf_pass_desc){.name = "watch.fill",
                                                .kind = SF_PASS_TRANSFER,
                                                .uses = &filled,
                                                .use_count = 1,
                                                .transfer = SF_TRANSFER_FILL,
                                                .fill = floats   ? SF_GRAPH_UNWRITTEN
                                                        : halves ? 0x7f1e7f1eu /* twice as a half */
                                                                 : 0});
    sf_graph_pass(graph, &(struct sf_pass_desc){.name = "watch.copy",
                                                .kind = SF_PASS_TRANSFER,
                                                .uses = copied,
                                                .use_count = 2,
                                                .transfer = SF_TRANSFER_COPY});
}

/* Is this the transient that is watched? Depth images are cleared before they are drawn to anyway. */
static bool is_watched(const struct sf_graph *graph, sf_resource resource)
{
    const struct sf_graph_resource *found;

    if (!graph->watched || resource == 0 || resource > graph->resource_count)
        return false;
    found = sf_graph_get(graph, resource);
    return found->is_image && found->lifetime == SF_TRANSIENT && found->image.format != SF_FORMAT_D32F &&
           found->image.size.relative_to < resource && !strcmp(graph->watched, found->name);
}

/* The first pass that writes the watched image need not write all of it: makes it find the fill there, and keep it. */
static void keep_watched(struct sf_graph *graph, const struct sf_pass_desc *pass, struct sf_use uses[SF_PASS_USES_MAX])
{
    for (uint32_t i = 0; i < pass->use_count; i++) {
        bool attached = uses[i].access == SF_ACCESS_COLOR && uses[i].load == SF_LOAD_DISCARD;

        if (!is_watched(graph, uses[i].resource))
            continue;
        graph->watched = NULL;
        if (!attached && uses[i].access != SF_ACCESS_STORAGE_WRITE)
            return;
        fill_watched(graph, uses[i].resource);
        if (attached)
            uses[i].load = SF_LOAD_KEEP;
        else
            uses[i].access = SF_ACCESS_STORAGE_MODIFY;
        return;
    }
}

void sf_graph_watch(struct sf_graph *graph, const char *name)
{
    graph->watched = sf_arena_strdup(&graph->arena, name);
    if (!graph->watched)
        out_of_memory(graph);
}

void sf_graph_pass(struct sf_graph *graph, const struct sf_pass_desc *desc)
{
    struct sf_pass_desc pass = *desc;
    struct sf_use kept[SF_PASS_USES_MAX];

    if (graph->status)
        return;
    if (!pass.name || !*pass.name) {
        keep_error(graph, "pass", "", "has no name; give it a stable one, such as \"thick.march\"");
        return;
    }
    for (size_t i = 0; i < graph->pass_count; i++)
        if (!strcmp(graph->passes[i].name, pass.name)) {
            keep_error(graph, "pass", pass.name, "the name is taken by an earlier pass; each needs its own");
            return;
        }
    /* The plan may add a use for `indirect`. */
    if (pass.use_count > (uint32_t)SF_PASS_USES_MAX - (pass.indirect != 0)) {
        keep_error(graph, "pass", pass.name, "has more uses than SF_PASS_USES_MAX, `indirect` counted; split the pass");
        return;
    }
    if (pass.constant_count > SF_PASS_CONSTANTS_MAX) {
        keep_error(graph, "pass", pass.name, "has more constants than SF_PASS_CONSTANTS_MAX; pass some in `push`");
        return;
    }
    if (graph->watched && pass.use_count > 0) {
        memcpy(kept, pass.uses, pass.use_count * sizeof *kept);
        pass.uses = kept;
        keep_watched(graph, &pass, kept);
    }
    if (!copy_pass(graph, &pass)) {
        out_of_memory(graph);
        return;
    }
    graph->passes[graph->pass_count++] = pass;
}

void sf_graph_output(struct sf_graph *graph, sf_resource resource)
{
    if (!graph->status && (resource == 0 || resource > graph->resource_count))
        keep_error(graph, "output", "?",
                   "is no resource of this graph; pass what sf_graph_image or sf_graph_buffer gave");
    if (!graph->status)
        graph->resources[resource - 1].output = true;
}

sf_resource sf_graph_find(const struct sf_graph *graph, const char *name)
{
    for (size_t i = 0; i < graph->resource_count; i++)
        if (!strcmp(graph->resources[i].name, name))
            return (sf_resource)(i + 1);
    return 0;
}

const char *sf_graph_name(const struct sf_graph *graph)
{
    return graph->name;
}

uint32_t sf_graph_pass_count(const struct sf_graph *graph)
{
    return (uint32_t)graph->pass_count;
}

const struct sf_pass_desc *sf_graph_pass_at(const struct sf_graph *graph, uint32_t index)
{
    return index < graph->pass_count ? &graph->passes[index] : NULL;
}

uint32_t sf_graph_resource_count(const struct sf_graph *graph)
{
    return (uint32_t)graph->resource_count;
}

const struct sf_image_desc *sf_graph_image_at(const struct sf_graph *graph, sf_resource resource)
{
    if (resource == 0 || resource > graph->resource_count || !graph->resources[resource - 1].is_image)
        return NULL;
    return &graph->resources[resource - 1].image;
}

const struct sf_buffer_desc *sf_graph_buffer_at(const struct sf_graph *graph, sf_resource resource)
{
    if (resource == 0 || resource > graph->resource_count || graph->resources[resource - 1].is_image)
        return NULL;
    return &graph->resources[resource - 1].buffer;
}

bool sf_pass_use(const struct sf_pass_desc *pass, uint32_t index, struct sf_use *use)
{
    if (index < pass->use_count) {
        *use = pass->uses[index];
        return true;
    }
    if (index > pass->use_count || !pass->indirect)
        return false;
    for (uint32_t i = 0; i < pass->use_count; i++)
        if (pass->uses[i].access == SF_ACCESS_INDIRECT && pass->uses[i].resource == pass->indirect)
            return false;
    *use = (struct sf_use){.resource = pass->indirect, .access = SF_ACCESS_INDIRECT};
    return true;
}
