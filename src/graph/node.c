/* Nodes: each resource's life as a chain of the passes that touch it. From them come lifetimes, usage and store
 * operations. */
#include "graph/internal.h"

static struct sf_node *node_of(struct sf_compiler *compiler, uint32_t pass, uint32_t copy)
{
    uint32_t tail = compiler->tails[copy];
    struct sf_node *node;

    if (tail != SF_NODE_END && compiler->nodes[tail].pass == pass)
        return &compiler->nodes[tail];
    node = &compiler->nodes[compiler->node_count];
    *node = (struct sf_node){.pass = pass, .next = SF_NODE_END};
    if (tail != SF_NODE_END)
        compiler->nodes[tail].next = compiler->node_count;
    else
        compiler->heads[copy] = compiler->node_count;
    compiler->tails[copy] = compiler->node_count++;
    return node;
}

static void add_use(struct sf_compiler *compiler, uint32_t pass, const struct sf_use *use)
{
    struct sf_plan_resource *resource = &compiler->plan->resources[use->resource - 1];
    struct sf_node *node = node_of(compiler, pass, sf_copy_index(use->resource, use->previous));
    struct sf_touch touch = {use->access, compiler->graph->passes[compiler->plan->passes[pass].index].kind};

    if (!resource->used)
        resource->first = pass;
    resource->last = pass;
    resource->used = true;
    resource->usage |= 1u << use->access;
    node->writes = sf_access_writes(use->access);
    node->overwrites = sf_use_overwrites(use);
    node->layout = sf_access_layout(use->access, resource->format);
    for (uint32_t i = 0; i < node->touch_count; i++)
        if (node->touches[i].access == touch.access)
            return;
    /* At most uniform, storage_read and indirect of a buffer; sampled and depth_read of an image. */
    node->touches[node->touch_count++] = touch;
}

bool sf_compile_nodes(struct sf_compiler *compiler)
{
    struct sf_plan *plan = compiler->plan;
    uint32_t copies = plan->resource_count * 2, uses = 0;

    for (uint32_t p = 0; p < plan->pass_count; p++)
        uses += plan->passes[p].use_count;
    compiler->nodes = sf_arena_alloc(compiler->scratch, uses * sizeof *compiler->nodes);
    compiler->heads = sf_arena_alloc(compiler->scratch, copies * sizeof *compiler->heads);
    compiler->tails = sf_arena_alloc(compiler->scratch, copies * sizeof *compiler->tails);
    if (!compiler->nodes || !compiler->heads || !compiler->tails)
        return false;
    for (uint32_t c = 0; c < copies; c++)
        compiler->heads[c] = compiler->tails[c] = SF_NODE_END;
    for (uint32_t p = 0; p < plan->pass_count; p++)
        for (uint32_t i = 0; i < plan->passes[p].use_count; i++)
            add_use(compiler, p, &plan->passes[p].uses[i].use);
    /* An output is wanted after the play, so nothing else may take its memory before the end. */
    for (uint32_t r = 0; r < plan->resource_count; r++)
        if (compiler->graph->resources[r].output && plan->resources[r].used)
            plan->resources[r].last = plan->pass_count - 1;
    return true;
}

/* Does anything read what this node leaves behind? */
static bool wanted_after(const struct sf_compiler *compiler, sf_resource resource, const struct sf_node *node)
{
    const struct sf_graph_resource *declared = sf_graph_get(compiler->graph, resource);

    if (node->next != SF_NODE_END)
        return !compiler->nodes[node->next].overwrites;
    return declared->output || declared->lifetime != SF_TRANSIENT;
}

void sf_compile_stores(struct sf_compiler *compiler)
{
    struct sf_plan *plan = compiler->plan;

    for (uint32_t r = 1; r <= plan->resource_count; r++)
        for (uint32_t n = compiler->heads[sf_copy_index(r, false)]; n != SF_NODE_END; n = compiler->nodes[n].next) {
            const struct sf_node *node = &compiler->nodes[n];
            struct sf_plan_pass *pass = &plan->passes[node->pass];

            for (uint32_t i = 0; i < pass->use_count && node->writes; i++)
                if (pass->uses[i].use.resource == r && !pass->uses[i].use.previous && !wanted_after(compiler, r, node))
                    pass->uses[i].store = SF_STORE_DISCARD;
        }
}
