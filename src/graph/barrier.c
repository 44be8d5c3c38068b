/* Barriers. Each resource's life is cut into groups: one write, or reads in a row that share a layout. A barrier stands
 * before the first pass of each group; it waits for the group before, and serves all of its own. Waiting for the last
 * group is enough: a group's touches wait, through its own barrier, for all before it.
 *
 * What the first group of a play waits for:
 *
 * - persistent: the last group of the play before. Reads on both sides of the seam are one group, served by the barrier
 *   at its start.
 * - history: a copy is `current` in one play, `previous` in the next, then current again: a ring of both lives.
 * - readback: the last write, since several plays may write one slice.
 * - transient: whoever had the same bytes last, in this play or the one before, itself perhaps.
 * - imported: `outside`, to which it returns after the last pass. */
#include "graph/internal.h"

#include <string.h>

struct group {
    uint32_t pass; /* the first that touches */
    bool previous;
    bool before; /* some touches come from before this play (seen from the play of the group that follows) */
    bool writes, overwrites;
    enum sf_layout layout;
    struct sf_touch touches[SF_BARRIER_SOURCES_MAX];
    uint32_t touch_count;
};

/* Barriers as found, resource by resource; `pass` is pass_count for the final ones. */
struct found {
    uint32_t pass;
    struct sf_plan_barrier barrier;
};

struct barriers {
    struct sf_compiler *compiler;
    struct found *found;
    uint32_t count;
    struct group *groups; /* of the resource in hand */
    uint32_t group_count;
};

static bool has_touch(const struct sf_touch *touches, uint32_t count, struct sf_touch touch)
{
    for (uint32_t i = 0; i < count; i++)
        if (touches[i].access == touch.access && touches[i].kind == touch.kind)
            return true;
    return false;
}

static void add_touches(struct group *group, const struct sf_touch *touches, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        if (!has_touch(group->touches, group->touch_count, touches[i]) && group->touch_count < SF_BARRIER_SOURCES_MAX)
            group->touches[group->touch_count++] = touches[i];
}

static bool touches_within(const struct group *inner, const struct group *outer)
{
    for (uint32_t i = 0; i < inner->touch_count; i++)
        if (!has_touch(outer->touches, outer->touch_count, inner->touches[i]))
            return false;
    return true;
}

static bool joins(const struct group *group, bool writes, enum sf_layout layout)
{
    return !group->writes && !writes && group->layout == layout;
}

/* Appends the groups of one copy to those in hand; the first may join the last of the copy before it. */
static void append_groups(struct barriers *barriers, sf_resource resource, bool previous)
{
    const struct sf_compiler *compiler = barriers->compiler;

    for (uint32_t n = compiler->heads[sf_copy_index(resource, previous)]; n != SF_NODE_END;
         n = compiler->nodes[n].next) {
        const struct sf_node *node = &compiler->nodes[n];
        struct group *group = barriers->group_count ? &barriers->groups[barriers->group_count - 1] : NULL;

        if (!group || !joins(group, node->writes, node->layout)) {
            group = &barriers->groups[barriers->group_count++];
            *group = (struct group){
                .pass = node->pass,
                .previous = previous,
                .writes = node->writes,
                .overwrites = node->overwrites,
                .layout = node->layout,
            };
        }
        add_touches(group, node->touches, node->touch_count);
    }
}

static void emit(struct barriers *barriers, sf_resource resource, const struct group *before, const struct group *after,
                 bool from_before, bool discard)
{
    struct found *found = &barriers->found[barriers->count++];
    struct sf_plan_barrier *barrier = &found->barrier;

    found->pass = after->pass;
    *barrier = (struct sf_plan_barrier){
        .resource = resource,
        .previous = after->previous,
        .discard = discard || (after->overwrites && after->layout != before->layout),
        .from_before = from_before,
        .before_count = before->touch_count,
        .after_count = after->touch_count,
    };
    memcpy(barrier->before, before->touches, sizeof before->touches);
    memcpy(barrier->after, after->touches, sizeof after->touches);
}

/* Between the groups in hand, but not before the first. */
static void emit_between(struct barriers *barriers, sf_resource resource)
{
    for (uint32_t g = 1; g < barriers->group_count; g++) {
        const struct group *before = &barriers->groups[g - 1], *after = &barriers->groups[g];

        emit(barriers, resource, before, after, before->before || before->previous != after->previous, false);
    }
}

/* Persistent, history and readback: after the last group comes the first of the next play. */
static void ring_barriers(struct barriers *barriers, sf_resource resource)
{
    struct group *first = &barriers->groups[0], *last;

    last = &barriers->groups[barriers->group_count - 1];
    if (barriers->group_count > 1 && joins(last, first->writes, first->layout)) {
        /* One group over the seam: the barrier before `last` has served `first`, and who follows waits for both. */
        add_touches(last, first->touches, first->touch_count);
        *first = *last;
        first->before = true;
        emit_between(barriers, resource);
        return;
    }
    if (barriers->group_count == 1 && !first->writes)
        return;
    emit(barriers, resource, last, first, true, false);
    emit_between(barriers, resource);
}

static void imported_barriers(struct barriers *barriers, sf_resource resource, bool previous)
{
    const struct sf_plan *plan = barriers->compiler->plan;
    enum sf_access access = sf_graph_get(barriers->compiler->graph, resource)->outside;
    struct group outside = {
        .pass = plan->pass_count,
        .previous = previous,
        .writes = sf_access_writes(access),
        .layout = sf_access_layout(access, plan->resources[resource - 1].format),
    };
    struct group *first = &barriers->groups[0], *last = &barriers->groups[barriers->group_count - 1];
    bool leaves, enters;

    outside.touch_count = sf_access_outside(access, outside.touches);
    /* Reads that the outside makes as well are one group with it. */
    leaves = !joins(last, outside.writes, outside.layout) || !touches_within(last, &outside);
    if (!leaves)
        add_touches(last, outside.touches, outside.touch_count);
    enters = !joins(first, outside.writes, outside.layout) || !touches_within(first, &outside);
    if (!enters) {
        add_touches(first, outside.touches, outside.touch_count);
        first->before = true;
    } else {
        emit(barriers, resource, &outside, first, true, false);
    }
    emit_between(barriers, resource);
    if (leaves)
        emit(barriers, resource, last, &outside, last->before, false);
}

/* The touches of the last group of a transient's life. */
static void add_last_touches(const struct sf_compiler *compiler, sf_resource resource, struct group *target)
{
    struct group last = {0};

    for (uint32_t n = compiler->heads[sf_copy_index(resource, false)]; n != SF_NODE_END; n = compiler->nodes[n].next) {
        const struct sf_node *node = &compiler->nodes[n];

        if (last.touch_count && !joins(&last, node->writes, node->layout))
            last.touch_count = 0;
        last.writes = node->writes;
        last.layout = node->layout;
        add_touches(&last, node->touches, node->touch_count);
    }
    add_touches(target, last.touches, last.touch_count);
}

/* The place of a transient: its memory, or only as much of it as its contents fill. */
static uint64_t place_end(const struct sf_plan_resource *resource, bool contents)
{
    return resource->offset + (contents && resource->bytes < resource->size ? resource->bytes : resource->size);
}

/* Who had the byte at `at` last before `self` begins? `end` becomes the end of the stretch for which that is so. */
static sf_resource last_holder(const struct sf_plan *plan, sf_resource self, bool contents, uint64_t at, uint64_t *end)
{
    const struct sf_plan_resource *me = &plan->resources[self - 1];
    uint64_t newest = me->last; /* itself, in the play before */
    sf_resource holder = self;

    *end = place_end(me, false);
    for (uint32_t r = 0; r < plan->resource_count; r++) {
        const struct sf_plan_resource *other = &plan->resources[r];
        uint64_t age;

        if (r + 1 == self || !other->used || other->lifetime != SF_TRANSIENT)
            continue;
        if (other->offset > at && other->offset < *end)
            *end = other->offset;
        if (other->offset > at || place_end(other, contents) <= at)
            continue;
        if (place_end(other, contents) < *end)
            *end = place_end(other, contents);
        /* Passes counted from the start of the play before. */
        age = other->last + (other->last < me->first ? (uint64_t)plan->pass_count : 0);
        if (age > newest) {
            newest = age;
            holder = r + 1;
        }
    }
    return holder;
}

static void transient_barriers(struct barriers *barriers, sf_resource resource)
{
    const struct sf_compiler *compiler = barriers->compiler;
    const struct sf_plan_resource *planned = &compiler->plan->resources[resource - 1];
    struct group holders = {0};
    uint64_t end;

    /* Rounding makes places larger than what is in them. A holder's wait for the one before it counts for the holder's
     * own contents only (synchronization validation sees it so): behind their end, wait for the one before as well. */
    for (int contents = 0; contents < 2; contents++)
        for (uint64_t at = planned->offset; at < place_end(planned, contents); at = end)
            add_last_touches(compiler, last_holder(compiler->plan, resource, contents, at, &end), &holders);
    emit(barriers, resource, &holders, &barriers->groups[0], true, true);
    emit_between(barriers, resource);
}

static void readback_final(struct barriers *barriers, sf_resource resource)
{
    struct group host = {.pass = barriers->compiler->plan->pass_count};

    host.touch_count = sf_access_outside(SF_ACCESS_HOST_READ, host.touches);
    emit(barriers, resource, &barriers->groups[barriers->group_count - 1], &host, false, false);
}

static void set_enters(const struct sf_compiler *compiler, sf_resource resource)
{
    struct sf_plan_resource *planned = &compiler->plan->resources[resource - 1];
    const struct sf_graph_resource *declared = sf_graph_get(compiler->graph, resource);
    uint32_t current = compiler->tails[sf_copy_index(resource, false)],
             previous = compiler->tails[sf_copy_index(resource, true)];
    bool paired = sf_resource_paired(declared);

    if (declared->lifetime == SF_IMPORTED) {
        planned->enters[0] = declared->outside;
        planned->enters[1] = paired ? declared->outside : SF_ACCESS_NONE;
    } else if (declared->lifetime == SF_PERSISTENT || declared->lifetime == SF_HISTORY) {
        /* What was `previous` in the last play is current in this one, and the other way round. */
        uint32_t found_current = previous != SF_NODE_END ? previous : current;
        uint32_t found_previous = current != SF_NODE_END ? current : previous;

        planned->enters[0] = compiler->nodes[found_current].touches[0].access;
        planned->enters[1] = paired ? compiler->nodes[found_previous].touches[0].access : SF_ACCESS_NONE;
    }
}

static void resource_barriers(struct barriers *barriers, sf_resource resource)
{
    enum sf_lifetime lifetime = barriers->compiler->plan->resources[resource - 1].lifetime;

    set_enters(barriers->compiler, resource);
    if (lifetime == SF_IMPORTED) {
        for (int previous = 0; previous < 2; previous++) {
            barriers->group_count = 0;
            append_groups(barriers, resource, previous);
            if (barriers->group_count)
                imported_barriers(barriers, resource, previous);
        }
        return;
    }
    barriers->group_count = 0;
    append_groups(barriers, resource, false);
    append_groups(barriers, resource, true);
    if (lifetime == SF_TRANSIENT) {
        transient_barriers(barriers, resource);
    } else if (lifetime != SF_UPLOAD) { /* what the host writes before a submission is visible to it */
        ring_barriers(barriers, resource);
        if (lifetime == SF_READBACK)
            readback_final(barriers, resource);
    }
}

/* From the order of resources to the order of passes. */
static bool deal_out(struct barriers *barriers)
{
    struct sf_plan *plan = barriers->compiler->plan;
    struct sf_plan_barrier *all = sf_arena_alloc(&plan->arena, barriers->count * sizeof *all);

    if (!all)
        return false;
    for (uint32_t i = 0; i < barriers->count; i++) {
        uint32_t pass = barriers->found[i].pass;

        ++*(pass < plan->pass_count ? &plan->passes[pass].barrier_count : &plan->final_count);
    }
    for (uint32_t p = 0; p < plan->pass_count; p++) {
        plan->passes[p].barriers = all;
        all += plan->passes[p].barrier_count;
        plan->passes[p].barrier_count = 0;
    }
    plan->final_barriers = all;
    plan->final_count = 0;
    for (uint32_t i = 0; i < barriers->count; i++) {
        const struct found *found = &barriers->found[i];

        if (found->pass < plan->pass_count)
            plan->passes[found->pass].barriers[plan->passes[found->pass].barrier_count++] = found->barrier;
        else
            plan->final_barriers[plan->final_count++] = found->barrier;
    }
    return true;
}

bool sf_compile_barriers(struct sf_compiler *compiler)
{
    struct sf_plan *plan = compiler->plan;
    struct barriers barriers = {.compiler = compiler};
    /* At most one before each node, and one at each copy's end. */
    size_t most = compiler->node_count + (size_t)plan->resource_count * 2;

    barriers.found = sf_arena_alloc(compiler->scratch, most * sizeof *barriers.found);
    barriers.groups = sf_arena_alloc(compiler->scratch, compiler->node_count * sizeof *barriers.groups);
    if (!barriers.found || !barriers.groups)
        return false;
    for (sf_resource r = 1; r <= plan->resource_count; r++)
        if (plan->resources[r - 1].used)
            resource_barriers(&barriers, r);
    return deal_out(&barriers);
}
