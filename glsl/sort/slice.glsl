// The way for a GPU: a least-significant-digit radix sort over the whole list, three passes a digit.
// - count.comp: each workgroup counts the digits of its slice of the list;
// - scan.comp: each workgroup turns one digit's counts over all slices into running sums;
// - scatter.comp: each workgroup sorts its slice by the digit, tile by tile in shared memory, and writes every digit's pairs where they belong.
//
// Workgroups never wait for each other and nothing depends on the subgroup's size: what one needs of another, an earlier pass wrote.
//
// `table[digit * groups + slice]`: counts, then sums within the digit. `table[256 * groups + digit]`: the digit's total.
#include "shared/sort.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint LOCAL = 256u;
layout(push_constant) uniform Push { sf_sort_push push; };

uint digit_of(uint key)
{
    return bitfieldExtract(key, int(push.shift), SF_SORT_BITS);
}

// The part of `count` pairs that slice number `slice` holds: begin and end.
uvec2 slice_bounds(uint count, uint slice)
{
    uint size = (count + push.groups - 1u) / push.groups;
    uint begin = min(count, slice * size);

    return uvec2(begin, min(count, begin + size));
}
