#include "output/half.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <string.h>
#if defined(__GNUC__) && defined(__x86_64__)
#include <cpuid.h>
#include <immintrin.h>
#define HAVE_F16C_BUILD
#endif

static uint32_t float_bits(float value)
{
    uint32_t bits;

    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static float bits_float(uint32_t bits)
{
    float value;

    memcpy(&value, &bits, sizeof value);
    return value;
}

uint16_t sf_half_from_float(float value)
{
    uint32_t bits = float_bits(value), sign = bits >> 16 & 0x8000u, magnitude = bits & 0x7FFFFFFFu;
    uint32_t normal, small, half;

    /* Normal halves: rebias the exponent by 127 - 15, round half to even at bit 13. */
    normal = (magnitude - (112u << 23) + 0xFFFu + (magnitude >> 13 & 1u)) >> 13;
    /* Below 2^-14: adding 1/2 aligns the bits so that the float unit itself rounds at 2^-24, the step of subnormal
     * halves. */
    small = float_bits(bits_float(magnitude < 0x38800000u ? magnitude : 0u) + 0.5f) - 0x3F000000u;
    half = magnitude < 0x38800000u ? small : normal;
    half = magnitude >= 0x477FE000u ? 0x7BFFu : half;
    half = magnitude > 0x7F800000u ? 0x7E00u | (magnitude >> 13 & 0x1FFu) : half;
    return (uint16_t)(sign | half);
}

float sf_half_to_float(uint16_t half)
{
    uint32_t sign = (uint32_t)(half & 0x8000u) << 16, exponent = half >> 10 & 0x1Fu, mantissa = half & 0x3FFu;

    if (exponent == 0) {
        float value = (float)mantissa * (1.0f / 16777216.0f);

        return sign ? -value : value;
    }
    return bits_float(sign | (exponent == 31 ? 0x7F800000u : (exponent + 112u) << 23) | mantissa << 13);
}

void sf_half_row_portable(const void *from, size_t stride, size_t count, unsigned char *to)
{
    const unsigned char *source = from;

    for (size_t i = 0; i < count; i++) {
        float value;
        uint16_t half;

        memcpy(&value, source + i * stride, sizeof value);
        half = sf_half_from_float(value);
        to[2 * i] = (unsigned char)half;
        to[2 * i + 1] = (unsigned char)(half >> 8);
    }
}

#ifdef HAVE_F16C_BUILD
/* Asked once: a virtual machine traps every CPUID, which costs as much as converting a thousand pixels. */
static bool has_f16c(void)
{
    static atomic_int known; /* 0: not yet asked, 1: no, 2: yes */
    int answer = atomic_load_explicit(&known, memory_order_relaxed);

    if (answer == 0) {
        unsigned a, b, c = 0, d;

        /* AVX2 as the compiler's run-time asks for it includes the system's support for the wide registers. */
        answer = __builtin_cpu_supports("avx2") && __get_cpuid(1, &a, &b, &c, &d) && (c & bit_F16C) != 0 ? 2 : 1;
        atomic_store_explicit(&known, answer, memory_order_relaxed);
    }
    return answer == 2;
}

/* min and max give their second operand when either is NaN: so NaN passes both. */
__attribute__((target("avx2,f16c"))) static __m128i convert(__m256 v)
{
    v = _mm256_min_ps(_mm256_set1_ps(SF_HALF_MAX), v);
    v = _mm256_max_ps(_mm256_set1_ps(-SF_HALF_MAX), v);
    return _mm256_cvtps_ph(v, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}

static float load(const unsigned char *from)
{
    float value;

    memcpy(&value, from, sizeof value);
    return value;
}

__attribute__((target("avx2,f16c"))) static void row_f16c(const void *from, size_t stride, size_t count,
                                                          unsigned char *to)
{
    const unsigned char *source = from;
    size_t i = 0;

    if (stride == sizeof(float)) {
        for (; i + 8 <= count; i += 8)
            _mm_storeu_si128((__m128i *)(to + 2 * i), convert(_mm256_loadu_ps((const float *)(source + i * stride))));
    }
    for (; i + 8 <= count; i += 8) {
        const unsigned char *a = source + i * stride, *b = a + 4 * stride;
        __m256 v = _mm256_setr_ps(load(a), load(a + stride), load(a + 2 * stride), load(a + 3 * stride), load(b),
                                  load(b + stride), load(b + 2 * stride), load(b + 3 * stride));

        _mm_storeu_si128((__m128i *)(to + 2 * i), convert(v));
    }
    sf_half_row_portable(source + i * stride, stride, count - i, to + 2 * i);
}
#endif

void sf_half_row(const void *from, size_t stride, size_t count, unsigned char *to)
{
#ifdef HAVE_F16C_BUILD
    if (has_f16c()) {
        row_f16c(from, stride, count, to);
        return;
    }
#endif
    sf_half_row_portable(from, stride, count, to);
}
