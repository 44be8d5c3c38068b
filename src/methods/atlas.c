/* The 2 x 2 atlas of density detail (L 3.3.6, METHODS C9), made by fractal value noise. */
#include <math.h>
#include <stddef.h>

#include "base/hash.h"
#include "methods/thick.h"

/* Value noise on the integer lattice, smooth, 0..1. */
static float noise(uint32_t seed, float x, float y)
{
    float fx = floorf(x), fy = floorf(y);
    float u = x - fx, v = y - fy;
    u = u * u * (3 - 2 * u);
    v = v * v * (3 - 2 * v);
    uint32_t ix = (uint32_t)(int32_t)fx, iy = (uint32_t)(int32_t)fy;
    float corner[4];
    for (uint32_t i = 0; i < 4; i++)
        corner[i] = sf_random_float(seed, ix + (i & 1), iy + (i >> 1));
    float top = corner[0] + u * (corner[1] - corner[0]), bottom = corner[2] + u * (corner[3] - corner[2]);
    return top + v * (bottom - top);
}

void sf_thick_atlas(uint32_t seed, uint32_t size, unsigned char *texels)
{
    uint32_t tile = size / 2;
    for (uint32_t y = 0; y < size; y++) {
        for (uint32_t x = 0; x < size; x++) {
            uint32_t number = (y / tile) * 2 + x / tile;
            float u = ((float)(x % tile) + 0.5f) / (float)tile * 2 - 1,
                  v = ((float)(y % tile) + 0.5f) / (float)tile * 2 - 1;
            float sum = 0, amplitude = 0.5f, frequency = 3;
            for (uint32_t octave = 0; octave < 4; octave++) {
                sum += amplitude * noise(seed + 977 * number + octave, u * frequency + 64, v * frequency + 64);
                amplitude *= 0.55f;
                frequency *= 2.1f;
            }
            /* 0.5 (1 - 0.55^4) / (1 - 0.55) is the largest sum; contrast is stretched about the middle. */
            float value = (sum / 1.0094f - 0.5f) * 2.2f + 0.62f;
            texels[(size_t)y * size + x] = (unsigned char)(255 * fminf(fmaxf(value, 0), 1) + 0.5f);
        }
    }
}
