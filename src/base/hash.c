#include "base/hash.h"

/* XXH64 by Yann Collet, after its public specification: fast, 64 well-mixed bits, the same on every byte order. Not for
 * secrets. */
static const uint64_t PRIME_1 = 0x9E3779B185EBCA87u, PRIME_2 = 0xC2B2AE3D27D4EB4Fu, PRIME_3 = 0x165667B19E3779F9u,
                      PRIME_4 = 0x85EBCA77C2B2AE63u, PRIME_5 = 0x27D4EB2F165667C5u;

static uint64_t rotate(uint64_t x, unsigned bits)
{
    return x << bits | x >> (64 - bits);
}

static uint64_t load_le(const unsigned char *p, unsigned bytes)
{
    uint64_t x = 0;

    for (unsigned i = 0; i < bytes; i++)
        x |= (uint64_t)p[i] << 8 * i;
    return x;
}

static uint64_t round_lane(uint64_t lane, uint64_t word)
{
    return rotate(lane + word * PRIME_2, 31) * PRIME_1;
}

static uint64_t merge_lane(uint64_t hash, uint64_t lane)
{
    return (hash ^ round_lane(0, lane)) * PRIME_1 + PRIME_4;
}

uint64_t sf_hash_bytes(const void *data, size_t size, uint64_t seed)
{
    const unsigned char *p = data;
    size_t left = size;
    uint64_t hash = seed + PRIME_5;

    if (left >= 32) {
        uint64_t a = seed + PRIME_1 + PRIME_2, b = seed + PRIME_2, c = seed, d = seed - PRIME_1;

        for (; left >= 32; p += 32, left -= 32) {
            a = round_lane(a, load_le(p, 8));
            b = round_lane(b, load_le(p + 8, 8));
            c = round_lane(c, load_le(p + 16, 8));
            d = round_lane(d, load_le(p + 24, 8));
        }
        hash = rotate(a, 1) + rotate(b, 7) + rotate(c, 12) + rotate(d, 18);
        hash = merge_lane(merge_lane(merge_lane(merge_lane(hash, a), b), c), d);
    }
    hash += (uint64_t)size;
    for (; left >= 8; p += 8, left -= 8)
        hash = rotate(hash ^ round_lane(0, load_le(p, 8)), 27) * PRIME_1 + PRIME_4;
    for (; left >= 4; p += 4, left -= 4)
        hash = rotate(hash ^ load_le(p, 4) * PRIME_1, 23) * PRIME_2 + PRIME_3;
    for (; left > 0; p++, left--)
        hash = rotate(hash ^ *p * PRIME_5, 11) * PRIME_1;
    hash = (hash ^ hash >> 33) * PRIME_2;
    hash = (hash ^ hash >> 29) * PRIME_3;
    return hash ^ hash >> 32;
}

uint32_t sf_random_u32(uint32_t seed, uint32_t id, uint32_t purpose)
{
    /* The id innermost: else two purposes' (or seeds') sequences would be one sequence, shifted. */
    return sf_hash_u32(seed + sf_hash_u32(purpose + sf_hash_u32(id)));
}

float sf_random_float(uint32_t seed, uint32_t id, uint32_t purpose)
{
    /* 24 bits fill a float's mantissa: every step is exact, here and on a GPU. */
    return (float)(sf_random_u32(seed, id, purpose) >> 8u) * (1.0f / 16777216.0f);
}
