// Numbers as the sum of two floats, of which the second is what the first leaves out: some 48 bits (Dekker 1971), for the few places where
// 24 are too few. Adding and multiplying floats is rounded correctly on every Vulkan device; `precise` keeps the terms as they stand.
#ifndef SF_LIB_TWOFOLD_GLSL
#define SF_LIB_TWOFOLD_GLSL

vec2 twofold_sum(float a, float b)
{
    precise float sum = a + b;
    precise float of_b = sum - a;
    precise float left = (a - (sum - of_b)) + (b - of_b);
    return vec2(sum, left);
}

vec2 twofold_product(float a, float b)
{
    // Halves of 12 bits, whose products are exact.
    precise float a_wide = 4097.0 * a, b_wide = 4097.0 * b;
    precise float a_high = a_wide - (a_wide - a), b_high = b_wide - (b_wide - b);
    precise float a_low = a - a_high, b_low = b - b_high;
    precise float product = a * b;
    precise float left = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
    return vec2(product, left);
}

vec2 twofold_add(vec2 a, vec2 b)
{
    vec2 sum = twofold_sum(a.x, b.x);
    precise float left = sum.y + (a.y + b.y);
    return twofold_sum(sum.x, left);
}

vec2 twofold_times(vec2 a, vec2 b)
{
    vec2 product = twofold_product(a.x, b.x);
    precise float left = product.y + (a.x * b.y + a.y * b.x);
    return twofold_sum(product.x, left);
}

#endif
