/* The plan for programs: one JSON object. Sizes are in bytes; keys that do not apply are left out. */
#include "graph/internal.h"

#include <inttypes.h>

static void print_string(struct sf_text *text, const char *string)
{
    sf_text_append(text, "\"");
    for (; *string; string++) {
        if (*string == '"' || *string == '\\')
            sf_text_printf(text, "\\%c", *string);
        else if ((unsigned char)*string < 0x20)
            sf_text_printf(text, "\\u%04x", (unsigned)*string);
        else
            sf_text_printf(text, "%c", *string);
    }
    sf_text_append(text, "\"");
}

/* `"key": "value"`; values that follow others in an object have a comma before them. */
static void print_name(struct sf_text *text, const char *key, const char *value)
{
    sf_text_printf(text, "\"%s\": ", key);
    print_string(text, value);
}

static void print_number(struct sf_text *text, const char *key, uint64_t value)
{
    sf_text_printf(text, ", \"%s\": %" PRIu64, key, value);
}

/* Elements of a list stand one to a line. */
static void next_element(struct sf_text *text, uint32_t index, const char *indent)
{
    sf_text_printf(text, "%s\n%s", index ? "," : "", indent);
}

static void print_resource(struct sf_text *text, const struct sf_plan *plan, const struct sf_plan_resource *resource)
{
    bool first = true;

    sf_text_append(text, "{");
    print_name(text, "name", resource->name);
    sf_text_printf(text, ", \"kind\": \"%s\", \"lifetime\": \"%s\", \"used\": %s", resource->image ? "image" : "buffer",
                   sf_lifetime_name(resource->lifetime), resource->used ? "true" : "false");
    if (resource->image) {
        sf_text_printf(text, ", \"format\": \"%s\"", sf_format_name(resource->format));
        print_number(text, "width", resource->width);
        print_number(text, "height", resource->height);
        print_number(text, "layers", resource->layers);
    }
    print_number(text, "bytes", resource->bytes);
    if (resource->used && resource->lifetime == SF_TRANSIENT) {
        print_number(text, "size", resource->size);
        print_number(text, "offset", resource->offset);
        print_number(text, "first", resource->first);
        print_number(text, "last", resource->last);
        if (resource->alias_of) {
            sf_text_append(text, ", ");
            print_name(text, "shares_with", plan->resources[resource->alias_of - 1].name);
        }
    }
    if (resource->enters[0] != SF_ACCESS_NONE)
        sf_text_printf(text, ", \"enters\": \"%s\"", sf_access_name(resource->enters[0]));
    if (resource->enters[1] != SF_ACCESS_NONE)
        sf_text_printf(text, ", \"previous_enters\": \"%s\"", sf_access_name(resource->enters[1]));
    sf_text_append(text, ", \"usage\": [");
    for (enum sf_access access = SF_ACCESS_NONE; access < SF_ACCESS_COUNT; access++)
        if (resource->usage >> access & 1) {
            sf_text_printf(text, "%s\"%s\"", first ? "" : ", ", sf_access_name(access));
            first = false;
        }
    sf_text_append(text, "]}");
}

static void print_touches(struct sf_text *text, const char *key, const struct sf_touch *touches, uint32_t count)
{
    sf_text_printf(text, ", \"%s\": [", key);
    for (uint32_t i = 0; i < count; i++) {
        sf_text_printf(text, "%s{\"access\": \"%s\"", i ? ", " : "", sf_access_name(touches[i].access));
        if (sf_access_by_pass(touches[i].access))
            sf_text_printf(text, ", \"pass\": \"%s\"", sf_pass_kind_name(touches[i].kind));
        sf_text_append(text, "}");
    }
    sf_text_append(text, "]");
}

static void print_barriers(struct sf_text *text, const struct sf_plan *plan, const struct sf_plan_barrier *barriers,
                           uint32_t count, const char *indent)
{
    sf_text_append(text, "[");
    for (uint32_t i = 0; i < count; i++) {
        const struct sf_plan_barrier *barrier = &barriers[i];

        next_element(text, i, indent);
        sf_text_append(text, "{");
        print_name(text, "resource", plan->resources[barrier->resource - 1].name);
        sf_text_printf(text, ", \"previous\": %s, \"discard\": %s, \"from_before\": %s",
                       barrier->previous ? "true" : "false", barrier->discard ? "true" : "false",
                       barrier->from_before ? "true" : "false");
        print_touches(text, "before", barrier->before, barrier->before_count);
        print_touches(text, "after", barrier->after, barrier->after_count);
        sf_text_append(text, "}");
    }
    sf_text_append(text, "]");
}

static void print_uses(struct sf_text *text, const struct sf_plan *plan, const struct sf_plan_pass *pass)
{
    sf_text_append(text, "[");
    for (uint32_t i = 0; i < pass->use_count; i++) {
        const struct sf_use *use = &pass->uses[i].use;

        next_element(text, i, "       ");
        sf_text_append(text, "{");
        print_name(text, "resource", plan->resources[use->resource - 1].name);
        sf_text_printf(text, ", \"access\": \"%s\"", sf_access_name(use->access));
        if (sf_access_in_shader(use->access) || use->access == SF_ACCESS_COLOR)
            print_number(text, "binding", use->binding);
        if (use->previous)
            sf_text_append(text, ", \"previous\": true");
        if (use->access == SF_ACCESS_COLOR || use->access == SF_ACCESS_DEPTH)
            sf_text_printf(text, ", \"load\": \"%s\", \"store\": \"%s\"", sf_load_name(pass->uses[i].load),
                           sf_store_name(pass->uses[i].store));
        sf_text_append(text, "}");
    }
    sf_text_append(text, "]");
}

/* What an attachment is cleared of, or discards, is not read. */
static bool reads(const struct sf_use *use)
{
    return sf_access_reads(use->access) && !sf_use_overwrites(use);
}

static bool writes(const struct sf_use *use)
{
    return sf_access_writes(use->access);
}

/* Names of the resources of those uses, each once (a pass may read both copies of a history, or a buffer and the
 * arguments in it). */
static void print_names(struct sf_text *text, const char *key, const struct sf_plan *plan,
                        const struct sf_plan_pass *pass, bool (*wanted)(const struct sf_use *use))
{
    uint32_t printed = 0;

    sf_text_printf(text, ",\n     \"%s\": [", key);
    for (uint32_t i = 0; i < pass->use_count; i++) {
        const struct sf_use *use = &pass->uses[i].use;
        uint32_t before = 0;

        while (before < i && (pass->uses[before].use.resource != use->resource || !wanted(&pass->uses[before].use)))
            before++;
        if (before < i || !wanted(use))
            continue;
        sf_text_append(text, printed++ ? ", " : "");
        print_string(text, plan->resources[use->resource - 1].name);
    }
    sf_text_append(text, "]");
}

static void print_pass(struct sf_text *text, const struct sf_plan *plan, const struct sf_plan_pass *pass)
{
    const struct sf_pass_desc *declared = sf_graph_pass_at(plan->graph, pass->index);

    sf_text_append(text, "{");
    print_name(text, "name", pass->name);
    sf_text_printf(text, ", \"kind\": \"%s\"", sf_pass_kind_name(declared->kind));
    if (declared->kind == SF_PASS_RASTER) {
        print_number(text, "width", pass->width);
        print_number(text, "height", pass->height);
    }
    if (pass->groups[0])
        sf_text_printf(text, ", \"groups\": [%" PRIu32 ", %" PRIu32 ", %" PRIu32 "]", pass->groups[0], pass->groups[1],
                       pass->groups[2]);
    print_number(text, "bytes_read", pass->bytes_read);
    print_number(text, "bytes_written", pass->bytes_written);
    print_names(text, "reads", plan, pass, reads);
    print_names(text, "writes", plan, pass, writes);
    sf_text_append(text, ",\n     \"barriers\": ");
    print_barriers(text, plan, pass->barriers, pass->barrier_count, "       ");
    sf_text_append(text, ",\n     \"uses\": ");
    print_uses(text, plan, pass);
    sf_text_append(text, "}");
}

void sf_plan_print_json(const struct sf_plan *plan, struct sf_text *text)
{
    sf_text_append(text, "{\n  ");
    print_name(text, "graph", plan->name);
    sf_text_printf(text, ",\n  \"memory\": {\"transient\": %" PRIu64 ", \"without_sharing\": %" PRIu64 "}",
                   plan->heap_bytes, plan->unaliased_bytes);
    sf_text_append(text, ",\n  \"resources\": [");
    for (uint32_t r = 0; r < plan->resource_count; r++) {
        next_element(text, r, "    ");
        print_resource(text, plan, &plan->resources[r]);
    }
    sf_text_append(text, "],\n  \"passes\": [");
    for (uint32_t p = 0; p < plan->pass_count; p++) {
        next_element(text, p, "    ");
        print_pass(text, plan, &plan->passes[p]);
    }
    sf_text_append(text, "],\n  \"final_barriers\": ");
    print_barriers(text, plan, plan->final_barriers, plan->final_count, "    ");
    sf_text_append(text, ",\n  \"culled\": [");
    for (uint32_t i = 0; i < plan->culled_count; i++) {
        next_element(text, i, "    ");
        print_string(text, plan->culled[i]);
    }
    sf_text_append(text, "]\n}\n");
}
