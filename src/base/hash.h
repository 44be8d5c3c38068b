/* Integer hashes. The same functions stand in glsl/lib/hash.glsl: same input, same bits on both sides. */
#ifndef SF_BASE_HASH_H
#define SF_BASE_HASH_H

#include <stddef.h>
#include <stdint.h>

uint64_t sf_hash_bytes(const void *data, size_t size, uint64_t seed);
/* 32-bit finaliser: state -> well-mixed word. One step of PCG's generator and its output function RXS-M-XS 32 (O'Neill
 * 2014), as a hash: Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020. A bijection of the 32-bit
 * words. */
static inline uint32_t sf_hash_u32(uint32_t x)
{
    uint32_t state = x * 747796405u + 2891336453u;
    uint32_t word = (state >> ((state >> 28u) + 4u) ^ state) * 277803737u;

    return word >> 22u ^ word;
}
/* Combines (seed, id, purpose) to one random word, and to a float in [0,1). */
uint32_t sf_random_u32(uint32_t seed, uint32_t id, uint32_t purpose);
float sf_random_float(uint32_t seed, uint32_t id, uint32_t purpose);

#endif
