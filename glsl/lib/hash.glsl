/* Integer hashes: the same functions, and the same bits, as src/base/hash.c, where their sources are named.
 * Kept to the words that C and GLSL share, so that a test compiles this very file as C and compares. */
#ifndef SF_LIB_HASH_GLSL
#define SF_LIB_HASH_GLSL

/* PCG-RXS-M-XS: a bijection of the 32-bit words. */
uint sf_hash_u32(uint x)
{
    uint state = x * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;

    return (word >> 22u) ^ word;
}

/* One random word for (seed, particle id, purpose). */
uint sf_random_u32(uint seed, uint id, uint purpose)
{
    return sf_hash_u32(seed + sf_hash_u32(purpose + sf_hash_u32(id)));
}

/* The same as a float in [0,1): 24 bits, every step exact. */
float sf_random_float(uint seed, uint id, uint purpose)
{
    float mantissa = sf_random_u32(seed, id, purpose) >> 8u;

    return mantissa * (1.0 / 16777216.0);
}

#endif
