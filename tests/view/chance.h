/* Numbers for property tests, the same ones every time. */
#ifndef SF_TESTS_CHANCE_H
#define SF_TESTS_CHANCE_H

#include <stdint.h>

/* Even between low and high. */
static inline double chance(uint64_t *state, double low, double high)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * ((double)(*state >> 11) * 0x1p-53);
}

#endif
