/* Compiling a graph: the table of contents. Each step is in the file named in internal.h. */
#include "graph/internal.h"

#include <stdlib.h>

static bool list_resources(struct sf_compiler *compiler)
{
    const struct sf_graph *graph = compiler->graph;
    struct sf_plan *plan = compiler->plan;

    plan->resources = sf_arena_alloc(&plan->arena, graph->resource_count * sizeof *plan->resources);
    if (!plan->resources)
        return false;
    plan->resource_count = (uint32_t)graph->resource_count;
    for (sf_resource r = 1; r <= plan->resource_count; r++) {
        const struct sf_graph_resource *declared = sf_graph_get(graph, r);
        struct sf_plan_resource *resource = &plan->resources[r - 1];

        resource->name = declared->name;
        resource->image = declared->is_image;
        resource->lifetime = declared->lifetime;
        resource->bytes = sf_resource_bytes(graph, r);
        if (declared->is_image) {
            resource->format = declared->image.format;
            resource->layers = declared->image.layers;
            sf_image_extent(graph, r, &resource->width, &resource->height);
        }
    }
    return true;
}

static bool compile(struct sf_compiler *compiler)
{
    if (!list_resources(compiler))
        return false;
    if (!sf_compile_cull(compiler))
        return false;
    if (!sf_compile_passes(compiler))
        return false;
    if (!sf_compile_nodes(compiler))
        return false;
    sf_compile_stores(compiler);
    sf_compile_needs(compiler);
    if (!sf_compile_placement(compiler))
        return false;
    return sf_compile_barriers(compiler);
}

enum sf_status sf_plan_create(const struct sf_graph *graph, const struct sf_plan_memory *memory,
                              const struct sf_log *log, struct sf_plan **plan)
{
    static const struct sf_plan_memory plain = {0};
    struct sf_arena scratch = {0};
    struct sf_compiler compiler = {.graph = graph, .memory = memory ? memory : &plain, .scratch = &scratch};
    enum sf_status status;

    *plan = NULL;
    status = sf_graph_validate(graph, &scratch, log);
    if (status)
        goto done;
    compiler.plan = calloc(1, sizeof *compiler.plan);
    if (compiler.plan) {
        compiler.plan->name = graph->name;
        compiler.plan->graph = graph;
    }
    if (!compiler.plan || !compile(&compiler)) {
        status = sf_fail(log, SF_ERROR_MEMORY, "graph '%s': out of memory while compiling", graph->name);
        sf_plan_destroy(&compiler.plan);
    }
    *plan = compiler.plan;
done:
    sf_arena_finish(&scratch);
    return status;
}

void sf_plan_destroy(struct sf_plan **plan)
{
    if (!plan || !*plan)
        return;
    sf_arena_finish(&(*plan)->arena);
    free(*plan);
    *plan = NULL;
}
