/* The radix sort's limits and push constants, for src/sim/sort.c and glsl/sort. */
#ifndef SF_SHARED_SORT_H
#define SF_SHARED_SORT_H
#include "types.h"

#define SF_SORT_BITS   8 /* of a digit */
#define SF_SORT_DIGITS 256
#define SF_SORT_PASSES 4 /* digits of a key: an even number, so that ping-pong ends where it began */
#define SF_SORT_UNROLL 8 /* pairs a lane handles in one turn of a loop; turns are limited, see src/sim/sort.c */

/* One pair is (key, payload), two 32-bit words; keys ascend. */
struct sf_sort_push {
    SF_UINT(capacity);   /* pairs; no more than these are sorted */
    SF_UINT(count_word); /* where in the count buffer the number of pairs stands */
    SF_UINT(shift);      /* of the digit that this pass sorts by */
    SF_UINT(groups);     /* count, scan, scatter: slices of the list. merge: blocks that the list was cut into */
    SF_UINT(span);       /* merge: blocks in each sorted run that is read */
};
#endif
