/* Memory: what each resource needs, and where transients lie in the heap that they share. Two may share bytes when no
 * pass lies in both lives. Interval colouring, greedily: the largest first, each into the smallest gap that fits. */
#include "graph/internal.h"

#include <stdlib.h>

enum { BUFFER_ALIGNMENT = 256, IMAGE_ALIGNMENT = 4096 };

static uint64_t round_up(uint64_t value, uint64_t alignment)
{
    return (value + alignment - 1) / alignment * alignment;
}

static void default_needs(void *user, const struct sf_plan_resource *resource, uint64_t *size, uint64_t *alignment)
{
    (void)user;
    *alignment = resource->image ? IMAGE_ALIGNMENT : BUFFER_ALIGNMENT;
    *size = round_up(resource->bytes, *alignment);
}

void sf_compile_needs(struct sf_compiler *compiler)
{
    const struct sf_plan_memory *memory = compiler->memory;

    for (uint32_t r = 0; r < compiler->plan->resource_count; r++) {
        struct sf_plan_resource *resource = &compiler->plan->resources[r];
        bool shown = resource->lifetime == SF_TRANSIENT || resource->lifetime == SF_PERSISTENT ||
                     resource->lifetime == SF_HISTORY;

        if (!resource->used || resource->lifetime == SF_IMPORTED)
            continue;
        if (memory->needs && shown)
            memory->needs(memory->user, resource, &resource->size, &resource->alignment);
        else
            default_needs(NULL, resource, &resource->size, &resource->alignment);
        if (resource->alignment == 0)
            resource->alignment = 1;
    }
}

static bool lives_meet(const struct sf_plan_resource *a, const struct sf_plan_resource *b)
{
    return a->first <= b->last && b->first <= a->last;
}

static bool bytes_meet(const struct sf_plan_resource *a, const struct sf_plan_resource *b)
{
    return a->offset < b->offset + b->size && b->offset < a->offset + a->size;
}

static int larger_first(const void *left, const void *right)
{
    const struct sf_plan_resource *a = *(struct sf_plan_resource *const *)left,
                                  *b = *(struct sf_plan_resource *const *)right;

    if (a->size != b->size)
        return a->size > b->size ? -1 : 1;
    if (a->first != b->first)
        return a->first < b->first ? -1 : 1;
    return a < b ? -1 : a > b; /* both lie in the plan's array of resources */
}

/* `placed` is in the order of offsets. Finds the smallest gap among those alive at the same time, or the end behind
 * them. */
static uint64_t best_offset(struct sf_plan_resource *const *placed, uint32_t count,
                            const struct sf_plan_resource *resource, bool no_alias)
{
    uint64_t end = 0, best = 0, best_gap = UINT64_MAX;

    for (uint32_t i = 0; i < count; i++) {
        uint64_t start = round_up(end, resource->alignment);

        if (!no_alias && !lives_meet(placed[i], resource))
            continue;
        if (placed[i]->offset >= start && placed[i]->offset - start >= resource->size &&
            placed[i]->offset - end < best_gap) {
            best = start;
            best_gap = placed[i]->offset - end;
        }
        if (placed[i]->offset + placed[i]->size > end)
            end = placed[i]->offset + placed[i]->size;
    }
    return best_gap == UINT64_MAX ? round_up(end, resource->alignment) : best;
}

static void place(struct sf_plan_resource **placed, uint32_t count, struct sf_plan_resource *resource, bool no_alias)
{
    uint32_t i = count;

    resource->offset = best_offset(placed, count, resource, no_alias);
    for (; i > 0 && placed[i - 1]->offset > resource->offset; i--)
        placed[i] = placed[i - 1];
    placed[i] = resource;
}

/* The earliest of those, begun before it, with which a transient shares bytes. */
static sf_resource alias_of(const struct sf_plan *plan, const struct sf_plan_resource *resource)
{
    const struct sf_plan_resource *earliest = resource;

    for (uint32_t r = 0; r < plan->resource_count; r++) {
        const struct sf_plan_resource *other = &plan->resources[r];

        if (other->used && other->lifetime == SF_TRANSIENT && other->first < earliest->first &&
            bytes_meet(other, resource))
            earliest = other;
    }
    return earliest == resource ? 0 : (sf_resource)(earliest - plan->resources) + 1;
}

bool sf_compile_placement(struct sf_compiler *compiler)
{
    struct sf_plan *plan = compiler->plan;
    struct sf_plan_resource **sorted =
        sf_arena_alloc(compiler->scratch, plan->resource_count * sizeof(struct sf_plan_resource *));
    struct sf_plan_resource **placed =
        sf_arena_alloc(compiler->scratch, plan->resource_count * sizeof(struct sf_plan_resource *));
    uint32_t count = 0;

    if (!sorted || !placed)
        return false;
    for (uint32_t r = 0; r < plan->resource_count; r++)
        if (plan->resources[r].used && plan->resources[r].lifetime == SF_TRANSIENT)
            sorted[count++] = &plan->resources[r];
    qsort(sorted, count, sizeof *sorted, larger_first);
    for (uint32_t i = 0; i < count; i++) {
        struct sf_plan_resource *resource = sorted[i];

        place(placed, i, resource, compiler->memory->no_alias);
        plan->unaliased_bytes = round_up(plan->unaliased_bytes, resource->alignment) + resource->size;
        if (resource->offset + resource->size > plan->heap_bytes)
            plan->heap_bytes = resource->offset + resource->size;
    }
    for (uint32_t i = 0; i < count; i++)
        sorted[i]->alias_of = alias_of(plan, sorted[i]);
    return true;
}
