/* Floats as unsigned words in the same order, so that integer atomics find the least and the greatest of them whatever order they land in.
 * -0 comes just below +0; NaNs lie beyond the infinities. */
#ifndef SF_LIB_ORDER_GLSL
#define SF_LIB_ORDER_GLSL

uint order_from_float(float value)
{
    uint bits = floatBitsToUint(value);

    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

float float_from_order(uint order)
{
    return uintBitsToFloat((order & 0x80000000u) != 0u ? order & 0x7fffffffu : ~order);
}

#endif
