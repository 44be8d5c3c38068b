/* What a pass of the plan holds: its uses, the size of its work, and the bytes that it moves at least. */
#include "graph/internal.h"

static uint64_t covered(uint64_t bytes, float coverage)
{
    return coverage > 0.0f && coverage < 1.0f ? (uint64_t)((double)bytes * (double)coverage) : bytes;
}

/* What the smaller side of a copy holds; else the whole resource. */
static uint64_t touched_bytes(const struct sf_graph *graph, const struct sf_pass_desc *pass, const struct sf_use *use)
{
    uint64_t bytes = sf_resource_bytes(graph, use->resource), other;

    if (use->access == SF_ACCESS_INDIRECT)
        return pass->kind == SF_PASS_COMPUTE ? SF_DISPATCH_ARGUMENT_BYTES : SF_DRAW_ARGUMENT_BYTES;
    if (pass->kind == SF_PASS_TRANSFER && pass->transfer != SF_TRANSFER_FILL) {
        other = sf_resource_bytes(graph, pass->uses[use == &pass->uses[0]].resource);
        return other < bytes ? other : bytes;
    }
    return bytes;
}

static void count_bytes(struct sf_plan_pass *planned, const struct sf_graph *graph, const struct sf_pass_desc *pass,
                        const struct sf_use *use)
{
    uint64_t whole = touched_bytes(graph, pass, use);
    bool part = use->access != SF_ACCESS_INDIRECT && use->access != SF_ACCESS_UNIFORM;
    uint64_t bytes = part ? covered(whole, pass->coverage) : whole;
    bool reads = sf_access_reads(use->access);

    if (use->access == SF_ACCESS_COLOR)
        reads = pass->raster.blend[use->binding] != SF_BLEND_NONE || use->load == SF_LOAD_KEEP;
    if (use->access == SF_ACCESS_DEPTH)
        reads = pass->raster.depth != SF_DEPTH_ALWAYS || use->load == SF_LOAD_KEEP;
    if (reads)
        planned->bytes_read += bytes;
    if (sf_access_writes(use->access))
        planned->bytes_written += use->load == SF_LOAD_CLEAR ? whole : bytes;
}

static void size_work(struct sf_plan_pass *planned, const struct sf_graph *graph, const struct sf_pass_desc *pass)
{
    uint32_t width, height;

    if (pass->kind == SF_PASS_RASTER) {
        for (uint32_t i = 0; i < pass->use_count; i++)
            if (sf_access_attaches(pass->uses[i].access))
                sf_image_extent(graph, pass->uses[i].resource, &planned->width, &planned->height);
    } else if (pass->domain) {
        sf_image_extent(graph, pass->domain, &width, &height);
        planned->groups[0] = width / pass->local[0] + (width % pass->local[0] != 0);
        planned->groups[1] = height / pass->local[1] + (height % pass->local[1] != 0);
        planned->groups[2] = sf_graph_get(graph, pass->domain)->image.layers;
    } else if (!pass->groups_live) {
        for (int i = 0; i < 3; i++)
            planned->groups[i] = pass->groups[i];
    }
}

bool sf_compile_passes(struct sf_compiler *compiler)
{
    const struct sf_graph *graph = compiler->graph;
    struct sf_plan *plan = compiler->plan;

    for (uint32_t p = 0; p < plan->pass_count; p++) {
        struct sf_plan_pass *planned = &plan->passes[p];
        const struct sf_pass_desc *pass = &graph->passes[planned->index];
        struct sf_use use;

        planned->uses = sf_arena_alloc(&plan->arena, (pass->use_count + 1) * sizeof *planned->uses);
        if (!planned->uses)
            return false;
        while (sf_pass_use(pass, planned->use_count, &use)) {
            struct sf_plan_use *target = &planned->uses[planned->use_count];

            target->use = use;
            target->load = use.load;
            count_bytes(planned, graph, pass,
                        planned->use_count < pass->use_count ? &pass->uses[planned->use_count] : &use);
            planned->use_count++;
        }
        size_work(planned, graph, pass);
    }
    return true;
}
