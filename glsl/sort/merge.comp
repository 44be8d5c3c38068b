#version 460
#extension GL_GOOGLE_include_directive : require
// Merges each four (or two) neighbouring sorted runs into one. Every lane makes an equal share of a merged run by itself: it finds where its share begins
// in each run, then takes the least of the next pairs again and again. Stable: equal keys come out in the order of their runs.
#include "shared/sort.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint WAYS = 4u; // runs that are made into one: 2 or 4
layout(set = 0, binding = 0, std430) readonly buffer Count { uint counts[]; };
layout(set = 0, binding = 1, std430) readonly buffer Source { uvec2 source[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Target { uvec2 target[]; };
layout(push_constant) uniform Push { sf_sort_push push; };

// First of the pairs low..high-1 whose key is not below `key`; high when there is none.
uint lower_bound(uint key, uint low, uint high)
{
    while (low < high) {
        uint middle = (low + high) >> 1u;
        if (source[middle].x < key)
            low = middle + 1u;
        else
            high = middle;
    }
    return low;
}

uvec4 lower_bounds(uint key, uvec4 low, uvec4 high)
{
    return uvec4(lower_bound(key, low.x, high.x), lower_bound(key, low.y, high.y), lower_bound(key, low.z, high.z),
                 lower_bound(key, low.w, high.w));
}

uint sum(uvec4 v)
{
    return v.x + v.y + v.z + v.w;
}

// How the first `rank` pairs of the merged run are spread over the runs that begin at `begin` and end at `end`: where each run goes on.
uvec4 split(uint rank, uvec4 begin, uvec4 end)
{
    // The greatest key that no more than `rank` pairs lie below, bit by bit; `low` are its lower bounds.
    uvec4 low = begin, high = end;
    uint key = 0u;
    for (int bit = 31; bit >= 0; bit--) {
        uint tried = key | 1u << bit;
        uvec4 bounds = lower_bounds(tried, low, high);
        if (sum(bounds - begin) <= rank) {
            key = tried;
            low = bounds;
        } else {
            high = bounds;
        }
    }
    // Pairs of that very key fill up to the rank, from the first run on. `high` are their ends, unless the key is the greatest of all.
    uvec4 equal = high - low;
    uint left = rank - sum(low - begin);
    for (int run = 0; run < 4; run++) {
        uint taken = min(left, equal[run]);
        low[run] += taken;
        left -= taken;
    }
    return low;
}

// One pair, from a tournament of two rounds. A run that is used up loses.
#define STEP                                                                                                  \
    {                                                                                                         \
        bool second = next.x >= end.x || next.y < end.y && pair1.x < pair0.x;                                 \
        bool fourth = next.z >= end.z || next.w < end.w && pair3.x < pair2.x;                                 \
        bool first_over = second ? next.y >= end.y : next.x >= end.x;                                         \
        bool third_over = fourth ? next.w >= end.w : next.z >= end.z;                                         \
        uvec2 left = second ? pair1 : pair0, right = fourth ? pair3 : pair2;                                  \
        bool upper = WAYS > 2u && (first_over || !third_over && right.x < left.x);                            \
        bvec4 taken = bvec4(!upper && !second, !upper && second, upper && !fourth, upper && fourth);          \
        target[at] = upper ? right : left;                                                                    \
        at++;                                                                                                 \
        next += uvec4(taken);                                                                                 \
        uvec2 fresh = source[min(upper ? (fourth ? next.w : next.z) : (second ? next.y : next.x), last)];     \
        pair0 = taken.x ? fresh : pair0;                                                                      \
        pair1 = taken.y ? fresh : pair1;                                                                      \
        pair2 = taken.z ? fresh : pair2;                                                                      \
        pair3 = taken.w ? fresh : pair3;                                                                      \
    }

void main()
{
    uint count = min(counts[push.count_word], push.capacity);
    uint run = (count + push.groups - 1u) / push.groups * push.span;
    uint results = (push.groups + push.span * WAYS - 1u) / (push.span * WAYS);
    uint lanes = gl_NumWorkGroups.x * gl_WorkGroupSize.x / results; // for each; the host sees to it that there is one
    uint result = gl_GlobalInvocationID.x / lanes;
    if (result >= results)
        return;
    uint start = min(count, result * WAYS * run);
    uvec4 begin = min(uvec4(count), start + min(uvec4(0u, 1u, 2u, 3u), WAYS) * run);
    uvec4 end = min(uvec4(count), start + min(uvec4(1u, 2u, 3u, 4u), WAYS) * run);
    uint total = end.w - start, share = (total + lanes - 1u) / lanes;
    uint rank = min(total, gl_GlobalInvocationID.x % lanes * share);
    uint at = start + rank, stop = start + min(total, rank + share), last = count - 1u;
    if (at == stop)
        return;

    uvec4 next = split(rank, begin, end);
    uvec2 pair0 = source[min(next.x, last)], pair1 = source[min(next.y, last)];
    uvec2 pair2 = source[min(next.z, last)], pair3 = source[min(next.w, last)];
    while (at + 4u <= stop) {
        STEP
        STEP
        STEP
        STEP
    }
    while (at < stop)
        STEP
}
