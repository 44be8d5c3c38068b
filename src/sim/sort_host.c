/* The CPU's side of sorting: keys from floats, and the comparison sort that the device's is measured against. */
#include "sim/sort.h"

#include <string.h>

uint32_t sf_sort_key(float value)
{
    uint32_t bits, size;

    memcpy(&bits, &value, sizeof bits);
    size = bits & 0x7fffffff;
    if (size > 0x7f800000)
        return 0xffffffff;
    return bits > 0x80000000 ? ~bits : size | 0x80000000;
}

/* Introsort (Musser 1997): quicksort by the median of three down to short ranges, heapsort where it goes too deep, and
 * one insertion sort over the whole in the end. */
enum { SHORT_RANGE = 16 };

static void swap_words(uint64_t *a, uint64_t *b)
{
    uint64_t held = *a;

    *a = *b;
    *b = held;
}

static void sift_down(uint64_t *words, size_t root, size_t count)
{
    uint64_t held = words[root];

    for (;;) {
        size_t child = 2 * root + 1;

        if (child >= count)
            break;
        if (child + 1 < count && words[child] < words[child + 1])
            child++;
        if (words[child] <= held)
            break;
        words[root] = words[child];
        root = child;
    }
    words[root] = held;
}

static void heap_sort(uint64_t *words, size_t count)
{
    for (size_t i = count / 2; i-- > 0;)
        sift_down(words, i, count);
    for (size_t end = count; end-- > 1;) {
        swap_words(&words[0], &words[end]);
        sift_down(words, 0, end);
    }
}

/* Moves the median of words[1], the middle and the last to words[0]. */
static void median_first(uint64_t *words, size_t count)
{
    uint64_t *a = words + 1, *b = words + count / 2, *c = words + count - 1;

    if (*a < *b)
        swap_words(words, *b < *c ? b : *a < *c ? c : a);
    else
        swap_words(words, *a < *c ? a : *b < *c ? c : b);
}

/* Splits words[1..count-1] about words[0], which bounds both searches: the first of the upper part. */
static size_t partition(uint64_t *words, size_t count)
{
    uint64_t pivot = words[0], *low = words + 1, *high = words + count;

    for (;;) {
        while (*low < pivot)
            low++;
        high--;
        while (pivot < *high)
            high--;
        if (low >= high)
            return (size_t)(low - words);
        swap_words(low, high);
        low++;
    }
}

static void sort_range(uint64_t *words, size_t count, int depth)
{
    while (count > SHORT_RANGE) {
        size_t split;

        if (depth-- == 0) {
            heap_sort(words, count);
            return;
        }
        median_first(words, count);
        split = partition(words, count);
        sort_range(words + split, count - split, depth);
        count = split;
    }
}

static void insertion_sort(uint64_t *words, size_t count)
{
    for (size_t i = 1; i < count; i++) {
        uint64_t held = words[i];
        size_t at = i;

        for (; at > 0 && held < words[at - 1]; at--)
            words[at] = words[at - 1];
        words[at] = held;
    }
}

void sf_sort_words(uint64_t *words, size_t count)
{
    int depth = 0;

    for (size_t i = count; i > 1; i /= 2)
        depth += 2;
    sort_range(words, count, depth);
    insertion_sort(words, count);
}
