/* The plan in words, for people and for goldens: what runs, what waits for what, where memory lies. */
#include "graph/internal.h"

#include <inttypes.h>
#include <string.h>

const char *sf_load_name(enum sf_load load)
{
    switch (load) {
    case SF_LOAD_KEEP:
        return "keep";
    case SF_LOAD_CLEAR:
        return "clear";
    case SF_LOAD_DISCARD:
        return "discard";
    }
    return "none";
}

const char *sf_store_name(enum sf_store store)
{
    return store == SF_STORE_KEEP ? "keep" : "discard";
}

static void print_touches(struct sf_text *text, const struct sf_touch *touches, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        sf_text_printf(text, "%s%s", i ? " + " : "", sf_access_name(touches[i].access));
        if (sf_access_by_pass(touches[i].access))
            sf_text_printf(text, "/%s", sf_pass_kind_name(touches[i].kind));
    }
}

static void print_barriers(struct sf_text *text, const struct sf_plan *plan, const struct sf_plan_barrier *barriers,
                           uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        const struct sf_plan_barrier *barrier = &barriers[i];

        sf_text_printf(text, "      barrier %s%s: ", plan->resources[barrier->resource - 1].name,
                       barrier->previous ? " (previous)" : "");
        print_touches(text, barrier->before, barrier->before_count);
        sf_text_append(text, " -> ");
        print_touches(text, barrier->after, barrier->after_count);
        sf_text_printf(text, "%s%s\n", barrier->from_before ? ", from before" : "",
                       barrier->discard ? ", discard" : "");
    }
}

static void print_use(struct sf_text *text, const struct sf_plan *plan, const struct sf_plan_use *planned)
{
    const struct sf_use *use = &planned->use;

    sf_text_printf(text, "      %s", sf_access_name(use->access));
    if (sf_access_in_shader(use->access) || use->access == SF_ACCESS_COLOR)
        sf_text_printf(text, " %" PRIu32, use->binding);
    sf_text_printf(text, ": %s%s", plan->resources[use->resource - 1].name, use->previous ? " (previous)" : "");
    if (use->access == SF_ACCESS_COLOR || use->access == SF_ACCESS_DEPTH)
        sf_text_printf(text, ", load %s, store %s", sf_load_name(planned->load), sf_store_name(planned->store));
    sf_text_append(text, "\n");
}

static void print_pass(struct sf_text *text, const struct sf_plan *plan, uint32_t index)
{
    const struct sf_plan_pass *pass = &plan->passes[index];
    const struct sf_pass_desc *declared = sf_graph_pass_at(plan->graph, pass->index);

    sf_text_printf(text, "  %2" PRIu32 " %s: %s", index, pass->name, sf_pass_kind_name(declared->kind));
    if (declared->kind == SF_PASS_RASTER)
        sf_text_printf(text, " %" PRIu32 "x%" PRIu32, pass->width, pass->height);
    if (pass->groups[0])
        sf_text_printf(text, " %" PRIu32 "x%" PRIu32 "x%" PRIu32 " groups", pass->groups[0], pass->groups[1],
                       pass->groups[2]);
    sf_text_printf(text, ", reads %" PRIu64 " bytes, writes %" PRIu64 "\n", pass->bytes_read, pass->bytes_written);
    print_barriers(text, plan, pass->barriers, pass->barrier_count);
    for (uint32_t i = 0; i < pass->use_count; i++)
        print_use(text, plan, &pass->uses[i]);
}

static void print_resource(struct sf_text *text, const struct sf_plan *plan, const struct sf_plan_resource *resource,
                           int width)
{
    sf_text_printf(text, "  %-*s  %s", width, resource->name, sf_lifetime_name(resource->lifetime));
    if (resource->image) {
        sf_text_printf(text, " %s %" PRIu32 "x%" PRIu32, sf_format_name(resource->format), resource->width,
                       resource->height);
        if (resource->layers > 1)
            sf_text_printf(text, "x%" PRIu32, resource->layers);
    }
    sf_text_printf(text, ", %" PRIu64 " bytes", resource->bytes);
    if (!resource->used) {
        sf_text_append(text, ", unused\n");
        return;
    }
    if (resource->lifetime == SF_TRANSIENT) {
        sf_text_printf(text, ", at %" PRIu64 " +%" PRIu64 ", passes %" PRIu32 "-%" PRIu32, resource->offset,
                       resource->size, resource->first, resource->last);
        if (resource->alias_of)
            sf_text_printf(text, ", shares with %s", plan->resources[resource->alias_of - 1].name);
    }
    for (int i = 0; i < 2; i++)
        if (resource->enters[i] != SF_ACCESS_NONE)
            sf_text_printf(text, ", %senters as %s", i ? "previous " : "", sf_access_name(resource->enters[i]));
    sf_text_append(text, ", used as");
    for (enum sf_access access = SF_ACCESS_NONE; access < SF_ACCESS_COUNT; access++)
        if (resource->usage >> access & 1)
            sf_text_printf(text, " %s", sf_access_name(access));
    sf_text_append(text, "\n");
}

static void print_text(const struct sf_plan *plan, struct sf_text *text)
{
    uint64_t saved = plan->unaliased_bytes > plan->heap_bytes ? plan->unaliased_bytes - plan->heap_bytes : 0;
    int width = 0;

    sf_text_printf(text, "graph %s: %" PRIu32 " passes, %" PRIu32 " culled\n", plan->name, plan->pass_count,
                   plan->culled_count);
    sf_text_printf(text, "transient memory: %" PRIu64 " bytes; sharing saves %" PRIu64 " of %" PRIu64 " (%u%%)\n",
                   plan->heap_bytes, saved, plan->unaliased_bytes,
                   plan->unaliased_bytes ? (unsigned)((double)saved * 100.0 / (double)plan->unaliased_bytes) : 0);
    sf_text_append(text, "resources:\n");
    for (uint32_t r = 0; r < plan->resource_count; r++)
        if ((int)strlen(plan->resources[r].name) > width)
            width = (int)strlen(plan->resources[r].name);
    for (uint32_t r = 0; r < plan->resource_count; r++)
        print_resource(text, plan, &plan->resources[r], width);
    sf_text_append(text, "passes:\n");
    for (uint32_t p = 0; p < plan->pass_count; p++)
        print_pass(text, plan, p);
    if (plan->final_count)
        sf_text_append(text, "at the end:\n");
    print_barriers(text, plan, plan->final_barriers, plan->final_count);
    if (plan->culled_count)
        sf_text_append(text, "culled:\n");
    for (uint32_t i = 0; i < plan->culled_count; i++)
        sf_text_printf(text, "  %s\n", plan->culled[i]);
}

void sf_plan_print(const struct sf_plan *plan, enum sf_plan_format format, struct sf_text *text)
{
    switch (format) {
    case SF_PLAN_TEXT:
        print_text(plan, text);
        break;
    case SF_PLAN_DOT:
        sf_plan_print_dot(plan, text);
        break;
    case SF_PLAN_JSON:
        sf_plan_print_json(plan, text);
        break;
    }
}
