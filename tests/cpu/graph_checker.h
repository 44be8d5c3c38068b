/* A second formulation of what barriers are for: it replays a plan over several plays, keeps for every byte of memory
 * the touches that nothing has followed yet and what each is known to come before, and says which access is a hazard.
 * It knows nothing of how the plan was made: no groups, no rings, no rules of reads and writes but these:
 *
 * - a barrier orders an earlier touch before its `after` touches if `before` has that touch or one that follows it;
 * - a change of layout writes the image: all earlier touches must come before it, and only `after` touches follow it;
 * - of two touches of the same bytes, one of them a write, the earlier must come before the later;
 * - what is read must have been written, into these bytes, by this resource, and not have been discarded since.
 *
 * Barriers count for their own resource's bytes only, so that a barrier on one resource cannot hide that another's is
 * missing. A transient's bytes are once its whole place, and once only what its contents fill: a plan must hold either
 * way. */
#ifndef SF_TESTS_GRAPH_CHECKER_H
#define SF_TESTS_GRAPH_CHECKER_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "graph/plan.h"

enum { CHECKER_PLAYS = 3, CHECKER_EVENTS = 48, CHECKER_NO_TOUCH = -1, CHECKER_NOBODY = -1 };
static const uint32_t CHECKER_DROP_NONE = UINT32_MAX;

struct checker_event {
    int touch; /* number of its bit, or CHECKER_NO_TOUCH for a change of layout and what came before the first play */
    bool writes;
    uint64_t precedes; /* touches known to come after it */
};

struct checker_cell {
    uint64_t begin, end; /* bytes of the heap; unused outside it */
    struct checker_event events[CHECKER_EVENTS];
    uint32_t event_count;
    int owner; /* the copy that wrote it last */
};

struct checker_copy {
    uint32_t *cells;
    uint32_t cell_count;
    enum sf_layout layout;
    bool valid;   /* holds something */
    bool touched; /* imported: by this play */
};

/* What to leave out: barrier number `barrier`, or of it only one touch of `before` or `after`. */
struct checker_drop {
    uint32_t barrier, before, after;
};

struct checker {
    const struct sf_plan *plan;
    struct checker_drop drop;
    bool contents; /* a transient ends with its contents, not with its place */
    struct checker_cell *cells;
    uint32_t cell_count;
    struct checker_copy *copies; /* two a resource, as they lie in memory: [play % 2] is the current one of a history */
    uint32_t *cell_lists;
    uint32_t moment; /* passes and ends of plays so far */
    char problem[256];
};

static inline int checker_bit(struct sf_touch touch)
{
    /* The host and the screen are one touch whatever the kind says. */
    if (touch.access == SF_ACCESS_HOST_READ || touch.access == SF_ACCESS_PRESENT)
        return touch.access * 3;
    return touch.access * 3 + touch.kind;
}

static inline uint64_t checker_mask(const struct sf_touch *touches, uint32_t count, uint32_t dropped)
{
    uint64_t mask = 0;

    for (uint32_t i = 0; i < count; i++)
        if (i != dropped)
            mask |= UINT64_C(1) << checker_bit(touches[i]);
    return mask;
}

static inline void checker_problem(struct checker *checker, sf_resource resource, const char *why)
{
    if (!checker->problem[0])
        snprintf(checker->problem, sizeof checker->problem, "play %u, pass %u, %s: %s",
                 checker->moment / (checker->plan->pass_count + 1), checker->moment % (checker->plan->pass_count + 1),
                 checker->plan->resources[resource - 1].name, why);
}

static inline void checker_push(struct checker *checker, struct checker_cell *cell, int touch, bool writes,
                                uint64_t precedes)
{
    if (writes)
        cell->event_count = 0;
    for (uint32_t e = 0; e < cell->event_count; e++)
        if (cell->events[e].touch == touch && cell->events[e].writes == writes && cell->events[e].precedes == precedes)
            return; /* the same again */
    if (cell->event_count == CHECKER_EVENTS) {
        checker_problem(checker, 1, "the checker has no room for more events");
        return;
    }
    cell->events[cell->event_count++] = (struct checker_event){touch, writes, precedes};
}

static inline bool checker_paired(const struct checker *checker, sf_resource resource)
{
    const struct sf_buffer_desc *buffer = sf_graph_buffer_at(checker->plan->graph, resource);

    return checker->plan->resources[resource - 1].lifetime == SF_HISTORY || (buffer && buffer->history);
}

static inline uint32_t checker_copy_number(const struct checker *checker, sf_resource resource, bool previous)
{
    uint32_t play = checker->moment / (checker->plan->pass_count + 1);
    uint32_t which = checker_paired(checker, resource) ? (play + previous) % 2 : 0;

    return (resource - 1) * 2 + which;
}

static inline enum sf_access checker_outside(const struct checker *checker, sf_resource resource)
{
    const struct sf_image_desc *image = sf_graph_image_at(checker->plan->graph, resource);

    return image ? image->outside : sf_graph_buffer_at(checker->plan->graph, resource)->outside;
}

/* Every kind of pass that might make an access outside. */
static inline uint64_t checker_outside_mask(enum sf_access access)
{
    switch (access) {
    case SF_ACCESS_COLOR:
    case SF_ACCESS_DEPTH:
    case SF_ACCESS_DEPTH_READ:
        return UINT64_C(1) << checker_bit((struct sf_touch){access, SF_PASS_RASTER});
    case SF_ACCESS_TRANSFER_READ:
    case SF_ACCESS_TRANSFER_WRITE:
        return UINT64_C(1) << checker_bit((struct sf_touch){access, SF_PASS_TRANSFER});
    case SF_ACCESS_HOST_READ:
    case SF_ACCESS_PRESENT:
        return UINT64_C(1) << checker_bit((struct sf_touch){access, SF_PASS_TRANSFER});
    default:
        return UINT64_C(1) << checker_bit((struct sf_touch){access, SF_PASS_COMPUTE}) |
               UINT64_C(1) << checker_bit((struct sf_touch){access, SF_PASS_RASTER});
    }
}

static inline int checker_compare(const void *left, const void *right)
{
    uint64_t a = *(const uint64_t *)left, b = *(const uint64_t *)right;

    return a < b ? -1 : a > b;
}

static inline uint64_t checker_place_end(const struct checker *checker, const struct sf_plan_resource *resource)
{
    bool shorter = checker->contents && resource->bytes < resource->size;

    return resource->offset + (shorter ? resource->bytes : resource->size);
}

/* Cuts the heap at every transient's ends, and gives every other copy a cell of its own. */
static inline void checker_map(struct checker *checker)
{
    const struct sf_plan *plan = checker->plan;
    uint32_t count = plan->resource_count, cuts = 0, lists = 0;
    uint64_t *ends = calloc(count * 2 + 1, sizeof *ends);

    for (uint32_t r = 0; r < count; r++)
        if (plan->resources[r].used && plan->resources[r].lifetime == SF_TRANSIENT) {
            ends[cuts++] = plan->resources[r].offset;
            ends[cuts++] = checker_place_end(checker, &plan->resources[r]);
        }
    qsort(ends, cuts, sizeof *ends, checker_compare);
    checker->cells = calloc((size_t)cuts + count * 2 + 1, sizeof *checker->cells);
    checker->copies = calloc((size_t)count * 2 + 1, sizeof *checker->copies);
    checker->cell_lists = calloc(((size_t)cuts + 2) * (count + 1), sizeof *checker->cell_lists);
    for (uint32_t i = 0; i + 1 < cuts; i++)
        if (ends[i] < ends[i + 1])
            checker->cells[checker->cell_count++] = (struct checker_cell){.begin = ends[i], .end = ends[i + 1]};
    uint32_t heap_cells = checker->cell_count;
    for (uint32_t r = 0; r < count; r++) {
        const struct sf_plan_resource *resource = &plan->resources[r];

        for (uint32_t c = 0; c < 2; c++) {
            struct checker_copy *copy = &checker->copies[r * 2 + c];

            copy->cells = &checker->cell_lists[lists];
            if (!resource->used)
                continue;
            if (resource->lifetime != SF_TRANSIENT) {
                copy->cells[copy->cell_count++] = checker->cell_count++;
            } else if (c == 0) {
                for (uint32_t i = 0; i < heap_cells; i++)
                    if (checker->cells[i].begin >= resource->offset &&
                        checker->cells[i].end <= checker_place_end(checker, resource))
                        copy->cells[copy->cell_count++] = i;
            }
            lists += copy->cell_count;
        }
    }
    for (uint32_t i = 0; i < checker->cell_count; i++)
        checker->cells[i].owner = CHECKER_NOBODY;
    free(ends);
}

/* As the player makes it before the first play: zeros, in the layout that the plan names, visible to everything. */
static inline void checker_first(struct checker *checker)
{
    for (uint32_t r = 0; r < checker->plan->resource_count; r++) {
        const struct sf_plan_resource *resource = &checker->plan->resources[r];

        for (uint32_t c = 0; c < 2 && resource->used; c++) {
            struct checker_copy *copy = &checker->copies[r * 2 + c];

            if (resource->lifetime != SF_PERSISTENT && resource->lifetime != SF_HISTORY &&
                resource->lifetime != SF_UPLOAD)
                continue;
            copy->valid = true;
            copy->layout =
                sf_access_layout(resource->enters[resource->lifetime == SF_HISTORY ? c : 0], resource->format);
            checker->cells[copy->cells[0]].owner = (int)(r * 2 + c);
            checker_push(checker, &checker->cells[copy->cells[0]], CHECKER_NO_TOUCH, true, UINT64_MAX);
        }
    }
}

/* Somebody outside has written the imported ones since, and touched them as `outside` says. */
static inline void checker_enter(struct checker *checker)
{
    for (uint32_t r = 0; r < checker->plan->resource_count; r++) {
        const struct sf_plan_resource *resource = &checker->plan->resources[r];

        for (uint32_t c = 0; c < 2 && resource->used && resource->lifetime == SF_IMPORTED; c++) {
            enum sf_access outside = checker_outside(checker, r + 1);
            uint64_t mask = checker_outside_mask(outside);
            struct checker_copy *copy = &checker->copies[r * 2 + c];
            struct checker_cell *cell = &checker->cells[copy->cells[0]];

            copy->valid = true;
            copy->touched = false;
            copy->layout = sf_access_layout(outside, resource->format);
            cell->owner = (int)(r * 2 + c);
            cell->event_count = 0;
            checker_push(checker, cell, CHECKER_NO_TOUCH, true, mask);
            if (sf_access_writes(outside)) {
                cell->event_count = 0;
                for (int bit = 0; bit < 64; bit++)
                    if (mask >> bit & 1) {
                        checker_push(checker, cell, bit, false, 0);
                        cell->events[cell->event_count - 1].writes = true;
                    }
                continue;
            }
            for (int bit = 0; bit < 64; bit++)
                if (mask >> bit & 1)
                    checker_push(checker, cell, bit, false, 0);
        }
    }
}

static inline bool checker_comes_before(const struct checker_event *event, uint64_t mask)
{
    uint64_t self = event->touch == CHECKER_NO_TOUCH ? 0 : UINT64_C(1) << event->touch;

    return ((self | event->precedes) & mask) != 0;
}

static inline bool checker_one_layout(const struct sf_touch *touches, uint32_t count, enum sf_format format,
                                      enum sf_layout layout)
{
    for (uint32_t i = 0; i < count; i++)
        if (sf_access_layout(touches[i].access, format) != layout)
            return false;
    return true;
}

static inline void checker_barrier(struct checker *checker, const struct sf_plan_barrier *barrier, uint32_t number)
{
    const struct sf_plan_resource *resource = &checker->plan->resources[barrier->resource - 1];
    struct checker_copy *copy = &checker->copies[checker_copy_number(checker, barrier->resource, barrier->previous)];
    bool mutated = number == checker->drop.barrier, changes = false;
    uint64_t before =
        checker_mask(barrier->before, barrier->before_count, mutated ? checker->drop.before : CHECKER_DROP_NONE);
    uint64_t after =
        checker_mask(barrier->after, barrier->after_count, mutated ? checker->drop.after : CHECKER_DROP_NONE);

    if (mutated && checker->drop.before == CHECKER_DROP_NONE && checker->drop.after == CHECKER_DROP_NONE)
        return;
    if (resource->image) {
        enum sf_layout from = sf_access_layout(barrier->before[0].access, resource->format);
        enum sf_layout to = sf_access_layout(barrier->after[0].access, resource->format);

        if (!barrier->discard && (copy->layout != from ||
                                  !checker_one_layout(barrier->before, barrier->before_count, resource->format, from)))
            checker_problem(checker, barrier->resource, "a barrier starts from another layout than the image is in");
        if (!checker_one_layout(barrier->after, barrier->after_count, resource->format, to))
            checker_problem(checker, barrier->resource, "a barrier leads to two layouts");
        changes = barrier->discard || from != to;
        copy->layout = to;
    }
    if (barrier->discard)
        copy->valid = false;
    for (uint32_t i = 0; i < copy->cell_count; i++) {
        struct checker_cell *cell = &checker->cells[copy->cells[i]];

        for (uint32_t e = 0; e < cell->event_count; e++) {
            if (checker_comes_before(&cell->events[e], before))
                cell->events[e].precedes |= after;
            else if (changes)
                checker_problem(checker, barrier->resource, "a change of layout does not wait for an earlier touch");
        }
        if (changes)
            checker_push(checker, cell, CHECKER_NO_TOUCH, true, after);
    }
}

/* Looks, but leaves no trace: the uses of a pass do not see each other. */
static inline void checker_look(struct checker *checker, const struct sf_plan_use *planned, struct sf_touch touch)
{
    const struct sf_use *use = &planned->use;
    const struct sf_plan_resource *resource = &checker->plan->resources[use->resource - 1];
    uint32_t number = checker_copy_number(checker, use->resource, use->previous);
    const struct checker_copy *copy = &checker->copies[number];
    bool writes = sf_access_writes(use->access),
         attached = use->access == SF_ACCESS_COLOR || use->access == SF_ACCESS_DEPTH;
    bool fills = use->access == SF_ACCESS_STORAGE_WRITE || use->access == SF_ACCESS_TRANSFER_WRITE;
    bool needs = attached ? planned->load == SF_LOAD_KEEP : !fills;

    if (resource->image && copy->layout != sf_access_layout(use->access, resource->format))
        checker_problem(checker, use->resource, "is used in the wrong layout");
    if (needs && !copy->valid)
        checker_problem(checker, use->resource, "is read but holds nothing");
    for (uint32_t i = 0; i < copy->cell_count; i++) {
        const struct checker_cell *cell = &checker->cells[copy->cells[i]];

        if (needs && cell->owner != (int)number)
            checker_problem(checker, use->resource, "is read but its memory was written by another");
        for (uint32_t e = 0; e < cell->event_count; e++)
            if ((writes || cell->events[e].writes) && !(cell->events[e].precedes >> checker_bit(touch) & 1))
                checker_problem(checker, use->resource,
                                writes ? "is written without waiting" : "is read without waiting");
    }
}

static inline void checker_record(struct checker *checker, const struct sf_plan_use *planned, struct sf_touch touch)
{
    const struct sf_use *use = &planned->use;
    uint32_t number = checker_copy_number(checker, use->resource, use->previous);
    struct checker_copy *copy = &checker->copies[number];
    bool writes = sf_access_writes(use->access),
         attached = use->access == SF_ACCESS_COLOR || use->access == SF_ACCESS_DEPTH;

    copy->touched = true;
    if (writes)
        copy->valid = !attached || planned->store == SF_STORE_KEEP;
    for (uint32_t i = 0; i < copy->cell_count; i++) {
        struct checker_cell *cell = &checker->cells[copy->cells[i]];

        checker_push(checker, cell, checker_bit(touch), writes, 0);
        if (writes)
            cell->owner = (int)number;
    }
}

/* All of a copy's touches must come before whoever takes it at the end of the play. */
static inline void checker_leave(struct checker *checker, sf_resource resource, const struct checker_copy *copy,
                                 uint64_t mask)
{
    const struct checker_cell *cell = &checker->cells[copy->cells[0]];

    for (uint32_t e = 0; e < cell->event_count; e++) {
        const struct checker_event *event = &cell->events[e];
        bool same = event->touch != CHECKER_NO_TOUCH && !event->writes && (mask >> event->touch & 1);

        if (!same && (event->precedes & mask) != mask)
            checker_problem(checker, resource, "is not ready for who takes it after the play");
    }
}

static inline void checker_end(struct checker *checker, const bool *outputs)
{
    for (uint32_t r = 0; r < checker->plan->resource_count; r++) {
        const struct sf_plan_resource *resource = &checker->plan->resources[r];
        uint32_t current = checker_copy_number(checker, r + 1, false);

        if (!resource->used)
            continue;
        if (!checker->copies[current].valid && (outputs[r] || resource->lifetime != SF_TRANSIENT))
            checker_problem(checker, r + 1, "is wanted after the play but holds nothing");
        if (outputs[r] && checker->cells[checker->copies[current].cells[0]].owner != (int)current)
            checker_problem(checker, r + 1, "is wanted after the play but its memory was written by another");
        if (resource->lifetime == SF_READBACK)
            checker_leave(checker, r + 1, &checker->copies[current], checker_outside_mask(SF_ACCESS_HOST_READ));
        if (resource->lifetime != SF_IMPORTED)
            continue;
        for (uint32_t c = 0; c < 2; c++) {
            enum sf_access outside = checker_outside(checker, r + 1);

            if (checker->copies[r * 2 + c].touched)
                checker_leave(checker, r + 1, &checker->copies[r * 2 + c], checker_outside_mask(outside));
            if (checker->copies[r * 2 + c].layout != sf_access_layout(outside, resource->format))
                checker_problem(checker, r + 1, "leaves the play in another layout than that of `outside`");
        }
    }
}

static inline void checker_play(struct checker *checker, const bool *outputs)
{
    const struct sf_plan *plan = checker->plan;
    uint32_t number = 0;

    checker_enter(checker);
    for (uint32_t p = 0; p < plan->pass_count; p++) {
        const struct sf_plan_pass *pass = &plan->passes[p];
        enum sf_pass_kind kind = sf_graph_pass_at(plan->graph, pass->index)->kind;

        for (uint32_t b = 0; b < pass->barrier_count; b++)
            checker_barrier(checker, &pass->barriers[b], number++);
        for (uint32_t u = 0; u < pass->use_count; u++)
            checker_look(checker, &pass->uses[u], (struct sf_touch){pass->uses[u].use.access, kind});
        for (uint32_t u = 0; u < pass->use_count; u++)
            checker_record(checker, &pass->uses[u], (struct sf_touch){pass->uses[u].use.access, kind});
        checker->moment++;
    }
    for (uint32_t b = 0; b < plan->final_count; b++)
        checker_barrier(checker, &plan->final_barriers[b], number++);
    checker_end(checker, outputs);
    checker->moment++;
}

static inline bool checker_run_once(const struct sf_plan *plan, const bool *outputs, struct checker_drop drop,
                                    bool contents, char *problem)
{
    struct checker checker = {.plan = plan, .drop = drop, .contents = contents};

    checker_map(&checker);
    checker_first(&checker);
    for (int play = 0; play < CHECKER_PLAYS; play++)
        checker_play(&checker, outputs);
    free(checker.cells);
    free(checker.copies);
    free(checker.cell_lists);
    memcpy(problem, checker.problem, sizeof checker.problem);
    return !checker.problem[0];
}

/* Replays the plan with something left out. True when all is well; else `problem` (256 bytes) says what is not.
 * `outputs` is by resource. */
static inline bool checker_run(const struct sf_plan *plan, const bool *outputs, struct checker_drop drop, char *problem)
{
    return checker_run_once(plan, outputs, drop, false, problem) &&
           checker_run_once(plan, outputs, drop, true, problem);
}

static inline uint32_t checker_barrier_count(const struct sf_plan *plan)
{
    uint32_t count = plan->final_count;

    for (uint32_t p = 0; p < plan->pass_count; p++)
        count += plan->passes[p].barrier_count;
    return count;
}

static inline const struct sf_plan_barrier *checker_barrier_at(const struct sf_plan *plan, uint32_t number)
{
    for (uint32_t p = 0; p < plan->pass_count; p++) {
        if (number < plan->passes[p].barrier_count)
            return &plan->passes[p].barriers[number];
        number -= plan->passes[p].barrier_count;
    }
    return &plan->final_barriers[number];
}

#endif
