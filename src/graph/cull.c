/* Culling: a walk back from the outputs. A pass lives if it writes something that is needed after it; what it reads is
 * then needed before it, and what it replaces entirely is not. */
#include "graph/internal.h"

static bool needed_at_end(const struct sf_graph_resource *resource)
{
    return resource->output || resource->lifetime == SF_PERSISTENT || resource->lifetime == SF_HISTORY ||
           resource->lifetime == SF_IMPORTED || resource->lifetime == SF_READBACK;
}

static void walk_back(struct sf_compiler *compiler, bool *needed)
{
    const struct sf_graph *graph = compiler->graph;
    struct sf_use use;

    for (size_t p = graph->pass_count; p-- > 0;) {
        const struct sf_pass_desc *pass = &graph->passes[p];
        bool live = pass->keep;

        for (uint32_t i = 0; sf_pass_use(pass, i, &use) && !live; i++)
            live = sf_access_writes(use.access) && needed[sf_copy_index(use.resource, use.previous)];
        compiler->live[p] = live;
        if (!live)
            continue;
        /* Uses of one copy are all reads or one write, so their order does not matter. */
        for (uint32_t i = 0; sf_pass_use(pass, i, &use); i++)
            needed[sf_copy_index(use.resource, use.previous)] = !sf_use_overwrites(&use);
    }
}

bool sf_compile_cull(struct sf_compiler *compiler)
{
    const struct sf_graph *graph = compiler->graph;
    struct sf_plan *plan = compiler->plan;
    bool *needed = sf_arena_alloc(compiler->scratch, graph->resource_count * 2 * sizeof *needed);

    compiler->live = sf_arena_alloc(compiler->scratch, graph->pass_count * sizeof *compiler->live);
    plan->passes = sf_arena_alloc(&plan->arena, graph->pass_count * sizeof *plan->passes);
    plan->culled = sf_arena_alloc(&plan->arena, graph->pass_count * sizeof *plan->culled);
    if (!needed || !compiler->live || !plan->passes || !plan->culled)
        return false;
    for (sf_resource r = 1; r <= graph->resource_count; r++)
        needed[sf_copy_index(r, false)] = needed_at_end(sf_graph_get(graph, r));
    walk_back(compiler, needed);
    for (uint32_t p = 0; p < graph->pass_count; p++) {
        if (compiler->live[p])
            plan->passes[plan->pass_count++] = (struct sf_plan_pass){.index = p, .name = graph->passes[p].name};
        else
            plan->culled[plan->culled_count++] = graph->passes[p].name;
    }
    return true;
}
