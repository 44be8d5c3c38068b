/* Sort keys from floats: unsigned words in the order of the floats, which a stable sort puts where `<` would.
 * -0 and +0 are equal; subnormals are told apart; every NaN, of either sign, comes last. Made from the bits alone, so the same everywhere.
 * The same function as sf_sort_key in src/sim/sort_host.c. */
#ifndef SF_SORT_KEY_GLSL
#define SF_SORT_KEY_GLSL

uint sort_key_from_bits(uint bits)
{
    uint size = bits & 0x7fffffffu;

    if (size > 0x7f800000u)
        return 0xffffffffu;
    return bits > 0x80000000u ? ~bits : size | 0x80000000u;
}

uint sort_key_from_float(float value)
{
    return sort_key_from_bits(floatBitsToUint(value));
}

#endif
