/* Integer hashes. The same functions stand in glsl/lib/hash.glsl: same input, same bits on both sides. */
#ifndef SF_BASE_HASH_H
#define SF_BASE_HASH_H

#include <stddef.h>
#include <stdint.h>

uint64_t sf_hash_bytes(const void *data, size_t size, uint64_t seed);
/* 32-bit finaliser (PCG-RXS-M-XS): state -> well-mixed word. */
uint32_t sf_hash_u32(uint32_t x);
/* Combines (seed, id, purpose) to one random word, and to a float in [0,1). */
uint32_t sf_random_u32(uint32_t seed, uint32_t id, uint32_t purpose);
float sf_random_float(uint32_t seed, uint32_t id, uint32_t purpose);

#endif
