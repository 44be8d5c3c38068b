// Sorts blocks of the list, each by one subgroup on its own, with a least-significant-digit radix sort: the way for a CPU.
//
// Theory. On llvmpipe a subgroup is a vector of 8 lanes and a workgroup runs on one core. Four things decide the speed there:
// - Lines of memory that two cores write in turn. Passes over the whole list scatter every core's pairs among the other's; a block of its own keeps
//   each core to its own lines through all digits, and one merge (merge.comp) of the blocks costs less than the traffic did.
// - barrier() makes the shader a coroutine whose every variable lives in memory (half as fast here). A block is therefore the work of
//   one subgroup, which needs subgroupBarrier() only. Nothing is assumed of the subgroup's size, nor that workgroups run at the same time.
// - Access to buffers and to shared memory costs a branch and a bounds check a lane; a private array with a computed index does not. So each lane
//   counts the digits of its own slice of the block in private counters, which then become the places of its pairs.
// - A turn of a loop has a fixed price, and the driver ends every loop for good after 65,535 turns of all loops together (src/sim/sort.c keeps to
//   that). Hence SF_SORT_UNROLL pairs a turn.
//
// Stable: slices are in the order of the lanes, and a lane places its pairs in their order.
//
// Invariant: before pass p the block's pairs stand in half p & 1 of the buffer, sorted by the p least digits.
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "shared/sort.h"

layout(local_size_x_id = 0) in;
layout(set = 0, binding = 0, std430) readonly buffer Count { uint counts[]; };
#ifdef SORT_INT64
#define PAIR         uint64_t // moved in one access; the key comes first in memory
#define KEY_OF(pair) uint(pair)
#else
#define PAIR         uvec2
#define KEY_OF(pair) (pair).x
#endif
// Two halves of `capacity` pairs: the list, and room for it.
layout(set = 0, binding = 1, std430) buffer Pairs { PAIR pairs[]; };
layout(push_constant) uniform Push { sf_sort_push push; };

#define DIGIT(key)            bitfieldExtract(key, shift, SF_SORT_BITS)
#define EACH(what)            what(0) what(1) what(2) what(3) what(4) what(5) what(6) what(7)
#define LOAD_KEY(i)           uint key##i = KEY_OF(pairs[at + i]);
#define COUNT_KEY(i)          places[DIGIT(key##i)]++;
#define LOAD_PAIR(i)          PAIR pair##i = pairs[at + i];
#define PLACE_PAIR(i)         PLACE(pair##i)
#define PLACE(pair)                               \
    {                                             \
        uint digit = DIGIT(KEY_OF(pair));         \
        uint place = places[digit];               \
        places[digit] = place + 1u;               \
        pairs[place] = pair;                      \
    }

void main()
{
    if (gl_SubgroupID != 0u)
        return;
    uint lanes = subgroupAdd(1u), lane = subgroupExclusiveAdd(1u);
    uint count = min(counts[push.count_word], push.capacity);
    uint block = (count + gl_NumWorkGroups.x - 1u) / gl_NumWorkGroups.x;
    uint block_begin = min(count, gl_WorkGroupID.x * block), block_end = min(count, block_begin + block);
    // An odd number of cache lines, lest all lanes' slices begin in the same cache set.
    uint slice = (((block_end - block_begin + lanes - 1u) / lanes + 7u) / 8u | 1u) * 8u;
    uint slice_begin = min(block_end, block_begin + lane * slice), slice_end = min(block_end, slice_begin + slice);
    uint from = 0u, to = push.capacity;
    uint places[SF_SORT_DIGITS];

    for (int shift = 0; shift < SF_SORT_BITS * SF_SORT_PASSES; shift += SF_SORT_BITS) {
        uint end = from + slice_end, at;

        for (uint digit = 0u; digit < SF_SORT_DIGITS; digit += 4u) {
            places[digit] = 0u;
            places[digit + 1u] = 0u;
            places[digit + 2u] = 0u;
            places[digit + 3u] = 0u;
        }
        for (at = from + slice_begin; at + SF_SORT_UNROLL <= end; at += SF_SORT_UNROLL) {
            EACH(LOAD_KEY)
            EACH(COUNT_KEY)
        }
        for (; at < end; at++)
            places[DIGIT(KEY_OF(pairs[at]))]++;

        // Counts become places: digits in order, within a digit lanes in order.
        uint base = to + block_begin;
        for (uint digit = 0u; digit < SF_SORT_DIGITS; digit++) {
            uint mine = places[digit], through = subgroupInclusiveAdd(mine);
            places[digit] = base + through - mine;
            base += subgroupMax(through);
        }

        for (at = from + slice_begin; at + SF_SORT_UNROLL <= end; at += SF_SORT_UNROLL) {
            EACH(LOAD_PAIR)
            EACH(PLACE_PAIR)
        }
        for (; at < end; at++) {
            PAIR pair = pairs[at];
            PLACE(pair)
        }
        subgroupBarrier();
        from = push.capacity - from;
        to = push.capacity - to;
    }
}
