/* The plan for Graphviz: passes are boxes, resources are ellipses, arrows run with the data; dashed ones carry the last
 * play's copy. */
#include "graph/internal.h"

#include <inttypes.h>

static void escape(struct sf_text *text, const char *string)
{
    for (; *string; string++)
        sf_text_printf(text, *string == '"' || *string == '\\' ? "\\%c" : "%c", *string);
}

static void print_resource(struct sf_text *text, uint32_t number, const struct sf_plan_resource *resource)
{
    sf_text_printf(text, "  r%" PRIu32 " [label=\"", number);
    escape(text, resource->name);
    sf_text_printf(text, "\\n%s, %" PRIu64 " bytes", sf_lifetime_name(resource->lifetime), resource->bytes);
    if (resource->lifetime == SF_TRANSIENT)
        sf_text_printf(text, " at %" PRIu64, resource->offset);
    sf_text_append(text, "\"];\n");
}

static void print_use(struct sf_text *text, uint32_t pass, const struct sf_use *use)
{
    const char *access = sf_access_name(use->access), *style = use->previous ? ", style=dashed" : "";

    if (!sf_use_overwrites(use))
        sf_text_printf(text, "  r%" PRIu32 " -> p%" PRIu32 " [label=\"%s\"%s];\n", use->resource, pass, access, style);
    if (sf_access_writes(use->access))
        sf_text_printf(text, "  p%" PRIu32 " -> r%" PRIu32 " [label=\"%s\"];\n", pass, use->resource, access);
}

static void print_pass(struct sf_text *text, const struct sf_plan *plan, uint32_t number)
{
    const struct sf_plan_pass *pass = &plan->passes[number];

    sf_text_printf(text, "  p%" PRIu32 " [shape=box, label=\"", number);
    escape(text, pass->name);
    sf_text_printf(text, "\\n%s, %" PRIu32 " barriers\\nreads %" PRIu64 ", writes %" PRIu64 " bytes\"];\n",
                   sf_pass_kind_name(sf_graph_pass_at(plan->graph, pass->index)->kind), pass->barrier_count,
                   pass->bytes_read, pass->bytes_written);
    for (uint32_t i = 0; i < pass->use_count; i++)
        print_use(text, number, &pass->uses[i].use);
    /* Keeps the passes in their order. */
    if (number > 0)
        sf_text_printf(text, "  p%" PRIu32 " -> p%" PRIu32 " [style=invis];\n", number - 1, number);
}

void sf_plan_print_dot(const struct sf_plan *plan, struct sf_text *text)
{
    sf_text_append(text, "digraph \"");
    escape(text, plan->name);
    sf_text_append(text, "\" {\n  rankdir=LR;\n  node [fontname=\"sans-serif\"];\n");
    for (uint32_t r = 0; r < plan->resource_count; r++)
        if (plan->resources[r].used)
            print_resource(text, r + 1, &plan->resources[r]);
    for (uint32_t p = 0; p < plan->pass_count; p++)
        print_pass(text, plan, p);
    sf_text_append(text, "}\n");
}
