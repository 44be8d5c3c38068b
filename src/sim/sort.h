/* Sorting pairs of 32-bit words by key on the device: stable, ascending, a least-significant-digit radix sort. The
 * number of pairs stands in a buffer and never comes back to the CPU.
 *
 * How it works is told where it is done: glsl/sort/blocks.glsl for CPUs, glsl/sort/slice.glsl for GPUs; both give the
 * same bits. Float keys: glsl/sort/key.glsl. */
#ifndef SF_SIM_SORT_H
#define SF_SIM_SORT_H

#include "gpu/gpu.h"
#include "sfumato/sfumato.h"
#include "shared/sort.h"

struct sf_sort_pair {
    uint32_t key, payload;
};

/* How a device sorts best. Any values within the device's limits give the same result, but for those that make a lane
 * on llvmpipe take more turns than it may. */
struct sf_sort_tuning {
    bool blocks;           /* blocks and merges; else three passes a digit */
    bool int64;            /* blocks: the shader has 64-bit integers */
    uint32_t local;        /* invocations of a workgroup; blocks: as many as a subgroup has */
    uint32_t groups;       /* workgroups: one a block or slice */
    uint32_t ways;         /* blocks: how many sorted runs a merge makes into one, 2 or 4 */
    uint32_t merge_groups; /* blocks: workgroups of a merge; times `local` at least groups / ways */
    uint32_t items;        /* slices: pairs that an invocation holds, 1..8 */
};
void sf_sort_tune(const struct sf_gpu_tuning *device, uint32_t capacity, struct sf_sort_tuning *tuning);

/* Bytes that the buffer of the pairs must have: blocks need room for a second list. */
uint64_t sf_sort_bytes(const struct sf_sort_tuning *tuning, uint32_t capacity);

struct sf_sort_desc {
    const char *name;  /* of passes and buffers: "NAME.blocks"; at most 40 bytes */
    uint32_t capacity; /* pairs, at least 1; a greater count is cut to it */
    sf_resource pairs; /* sf_sort_bytes() long: struct sf_sort_pair[count] from byte 0 on, which earlier passes wrote */
    sf_resource count; /* number of pairs, 32 bits, at word `count_word` */
    uint32_t count_word;
    const struct sf_sort_tuning *tuning;
};
enum { SF_SORT_PUSHES = 17 };
/* Push constants of the declared passes: must stay where it is as long as a plan of the graph lives. */
struct sf_sort {
    struct sf_sort_push push[SF_SORT_PUSHES];
};
/* Adds the passes. Answers the buffer in which the sorted pairs stand from byte 0 on: `pairs` or one of its own. Begins
 * with reads of `count` and `pairs` as storage in compute, ends with a storage write in compute. */
sf_resource sf_sort_declare(struct sf_graph *graph, const struct sf_sort_desc *desc, struct sf_sort *sort);

/* The key of a float, as sort_key_from_float in glsl/sort/key.glsl. */
uint32_t sf_sort_key(float value);
/* What the device's sort is measured against: introsort, as std::sort is made, on one thread. Ascending. */
void sf_sort_words(uint64_t *words, size_t count);

/* Sorts `pairs` random pairs `repeats` times on the device and by sf_sort_words, and compares each result. Times are
 * the device's, from the first pass's begin to the last one's end. SF_ERROR_USAGE: more pairs than one binding of the
 * device holds. Plays frames of its own: not between sf_frame_begin and sf_frame_end. */
enum sf_status sf_sort_measure(struct sf_gpu *gpu, uint32_t pairs, uint32_t repeats, const struct sf_log *log,
                               struct sf_sort_timing *timing);

#endif
