#include "sim/sort.h"

#include <stdio.h>
#include <string.h>

enum {
    /* llvmpipe ends every loop of a shader for good once all of its loops together have made 65,535 turns. This leaves
     * room for what does not grow with the list: in a block 4 x 320 for the counters and 4 x 18 for the rests of
     * slices, in a merge at most 32 x 4 x 21 for finding the splits. */
    TURNS_MAX = 60000,
    /* Pairs that one lane may have: a block's lane makes two loops over its slice for each digit (counted as if nothing
     * were unrolled, which is the driver's choice), a merge's one, by fours. */
    BLOCK_LANE_MAX = TURNS_MAX / (2 * SF_SORT_PASSES),
    MERGE_LANE_MAX = TURNS_MAX * 4,
    SLICE_LOCAL = 256,
    SLICE_ITEMS = 8,
    GROUPS_MAX = 65535,
};

_Static_assert(sizeof(struct sf_sort_push) == 20, "as GLSL has it");
_Static_assert(SF_SORT_BITS *SF_SORT_PASSES == 32 && SF_SORT_DIGITS == 1 << SF_SORT_BITS, "digits make up a key");

static uint32_t ceil_div(uint32_t a, uint32_t b)
{
    return a / b + (a % b != 0);
}

static uint32_t max_u32(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

static uint32_t min_u32(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

/* Shared memory of scatter.comp, bytes. */
static uint32_t scatter_bytes(uint32_t local, uint32_t items)
{
    uint32_t tile = 2 * local * items, counters = 8 * local, prefix = 2 * local, digits = 2 * SF_SORT_DIGITS;

    return 4 * (tile + counters + prefix + digits);
}

static void tune_blocks(const struct sf_gpu_tuning *device, uint32_t capacity, struct sf_sort_tuning *tuning)
{
    uint32_t lanes = device->subgroup_size;
    uint32_t needed = max_u32(device->workers, ceil_div(capacity, lanes * BLOCK_LANE_MAX));
    uint32_t results;

    /* As many blocks as merges of `ways` make into one with no run left over. */
    tuning->ways = needed == 2 ? 2 : 4;
    tuning->groups = 1;
    while (tuning->groups < needed && tuning->groups < GROUPS_MAX / tuning->ways)
        tuning->groups *= tuning->ways;
    tuning->blocks = true;
    tuning->int64 = device->int64;
    tuning->local = lanes;
    /* As many lanes for every result of the first merge. */
    results = ceil_div(tuning->groups, tuning->ways);
    tuning->merge_groups = max_u32(device->workers, ceil_div(capacity, lanes * MERGE_LANE_MAX));
    tuning->merge_groups = min_u32(GROUPS_MAX, ceil_div(tuning->merge_groups, results) * results);
}

static void tune_slices(const struct sf_gpu_tuning *device, uint32_t capacity, struct sf_sort_tuning *tuning)
{
    tuning->local = SLICE_LOCAL;
    tuning->items = SLICE_ITEMS;
    while (tuning->local > 1 && (tuning->local > device->max_group_invocations ||
                                 scatter_bytes(tuning->local, tuning->items) > device->shared_bytes))
        tuning->local /= 2;
    tuning->groups = min_u32(max_u32(device->workers, 1), ceil_div(capacity, tuning->local * tuning->items));
    tuning->groups = min_u32(tuning->groups, GROUPS_MAX);
}

void sf_sort_tune(const struct sf_gpu_tuning *device, uint32_t capacity, struct sf_sort_tuning *tuning)
{
    *tuning = (struct sf_sort_tuning){0};
    if (device->software)
        tune_blocks(device, capacity, tuning);
    else
        tune_slices(device, capacity, tuning);
}

static uint64_t list_bytes(uint32_t capacity)
{
    return (uint64_t)capacity * sizeof(struct sf_sort_pair);
}

static uint64_t table_bytes(const struct sf_sort_tuning *tuning)
{
    return ((uint64_t)tuning->groups + 1) * SF_SORT_DIGITS * sizeof(uint32_t);
}

uint64_t sf_sort_bytes(const struct sf_sort_tuning *tuning, uint32_t capacity)
{
    return list_bytes(capacity) * (tuning->blocks ? 2 : 1);
}

/* What declaring needs besides the description. */
struct declaration {
    struct sf_graph *graph;
    const struct sf_sort_desc *desc;
    struct sf_sort *sort;
    char name[64];
};

static const char *name_of(struct declaration *at, const char *what)
{
    snprintf(at->name, sizeof at->name, "%s.%s", at->desc->name, what);
    return at->name;
}

static sf_resource add_buffer(struct declaration *at, const char *what, uint64_t bytes)
{
    return sf_graph_buffer(at->graph, &(struct sf_buffer_desc){
                                          .name = name_of(at, what),
                                          .lifetime = SF_TRANSIENT,
                                          .bytes = bytes,
                                      });
}

static void add_pass(struct declaration *at, const char *what, const char *shader, const struct sf_use *uses,
                     uint32_t use_count, uint32_t groups, uint32_t push)
{
    const struct sf_sort_tuning *tuning = at->desc->tuning;

    sf_graph_pass(at->graph, &(struct sf_pass_desc){
                                 .name = name_of(at, what),
                                 .kind = SF_PASS_COMPUTE,
                                 .uses = uses,
                                 .use_count = use_count,
                                 .shader = shader,
                                 .constants = {tuning->local, tuning->blocks ? tuning->ways : tuning->items},
                                 .constant_count = 2,
                                 .push = &at->sort->push[push],
                                 .push_bytes = sizeof at->sort->push[push],
                                 .groups = {groups, 1, 1},
                             });
}

static sf_resource declare_blocks(struct declaration *at)
{
    const struct sf_sort_desc *desc = at->desc;
    const struct sf_sort_tuning *tuning = desc->tuning;
    const struct sf_use uses[] = {
        {.resource = desc->count, .access = SF_ACCESS_STORAGE_READ, .binding = 0},
        {.resource = desc->pairs, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 1},
    };
    sf_resource from = desc->pairs, to = 0;
    uint32_t push = 0;

    add_pass(at, "blocks", tuning->int64 ? "sort/blocks64.comp" : "sort/blocks.comp", uses, 2, tuning->groups, push++);
    if (tuning->groups > 1)
        to = add_buffer(at, "merged", list_bytes(desc->capacity));
    for (uint32_t span = 1; span < tuning->groups; span *= tuning->ways, push++) {
        const struct sf_use merge[] = {
            {.resource = desc->count, .access = SF_ACCESS_STORAGE_READ, .binding = 0},
            {.resource = from, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
            {.resource = to, .access = SF_ACCESS_STORAGE_WRITE, .binding = 2},
        };
        sf_resource swap = from;
        char what[16];

        snprintf(what, sizeof what, "merge%u", push);
        at->sort->push[push].span = span;
        add_pass(at, what, "sort/merge.comp", merge, 3, tuning->merge_groups, push);
        from = to;
        to = swap;
    }
    return from;
}

static sf_resource declare_slices(struct declaration *at)
{
    const struct sf_sort_desc *desc = at->desc;
    const struct sf_sort_tuning *tuning = desc->tuning;
    sf_resource from = desc->pairs, to = add_buffer(at, "other", list_bytes(desc->capacity));
    sf_resource table = add_buffer(at, "table", table_bytes(tuning));

    for (uint32_t pass = 0; pass < SF_SORT_PASSES; pass++) {
        const struct sf_use count[] = {
            {.resource = desc->count, .access = SF_ACCESS_STORAGE_READ, .binding = 0},
            {.resource = from, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
            {.resource = table, .access = SF_ACCESS_STORAGE_WRITE, .binding = 2},
        };
        const struct sf_use scan[] = {{.resource = table, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 0}};
        const struct sf_use scatter[] = {
            {.resource = desc->count, .access = SF_ACCESS_STORAGE_READ, .binding = 0},
            {.resource = from, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
            {.resource = to, .access = SF_ACCESS_STORAGE_WRITE, .binding = 2},
            {.resource = table, .access = SF_ACCESS_STORAGE_READ, .binding = 3},
        };
        sf_resource swap = from;
        char what[16];

        at->sort->push[pass].shift = pass * SF_SORT_BITS;
        snprintf(what, sizeof what, "count%u", pass);
        add_pass(at, what, "sort/count.comp", count, 3, tuning->groups, pass);
        snprintf(what, sizeof what, "scan%u", pass);
        add_pass(at, what, "sort/scan.comp", scan, 1, SF_SORT_DIGITS, pass);
        snprintf(what, sizeof what, "scatter%u", pass);
        add_pass(at, what, "sort/scatter.comp", scatter, 4, tuning->groups, pass);
        from = to;
        to = swap;
    }
    return from;
}

sf_resource sf_sort_declare(struct sf_graph *graph, const struct sf_sort_desc *desc, struct sf_sort *sort)
{
    struct declaration at = {.graph = graph, .desc = desc, .sort = sort};

    for (int i = 0; i < SF_SORT_PUSHES; i++)
        sort->push[i] = (struct sf_sort_push){
            .capacity = desc->capacity,
            .count_word = desc->count_word,
            .groups = desc->tuning->groups,
        };
    return desc->tuning->blocks ? declare_blocks(&at) : declare_slices(&at);
}
