/* The 2 x 2 atlas of density detail (L 3.3.6, METHODS C9), made by fractal value noise. */
#include <stddef.h>

#include "base/hash.h"
#include "methods/thick_parts.h"
#include "texture/texels.h"

enum {
    OCTAVES = 4,
    TILE_MAX = SF_THICK_ATLAS / 2,
    LATTICE = 64, /* points that a tile may touch along a side: two for each unit of the highest frequency, and some */
};

/* An octave over a tile, made from random values on the integer lattice, smooth, 0..1. What many texels share (a value,
 * the place of a row or column) is computed once. */
struct noise {
    float amplitude;
    float value[LATTICE][LATTICE];
    int point[TILE_MAX];   /* of a texel along either axis: the lattice point before it, counted from the first */
    float share[TILE_MAX]; /* and the smooth way to the next */
};

static void noise_fill(uint32_t seed, float frequency, float amplitude, uint32_t tile, struct noise *noise)
{
    int first = 0, count = 0;

    noise->amplitude = amplitude;
    for (uint32_t i = 0; i < tile; i++) {
        float at = ((float)i + 0.5f) / (float)tile * 2 - 1;
        at = at * frequency + 64; /* positive */
        int point = (int)at;
        float u = at - (float)point;
        first = i == 0 ? point : first;
        count = point - first + 2;
        noise->point[i] = point - first;
        noise->share[i] = u * u * (3 - 2 * u);
    }
    for (int y = 0; y < count; y++)
        for (int x = 0; x < count; x++)
            noise->value[y][x] = sf_random_float(seed, (uint32_t)(first + x), (uint32_t)(first + y));
}

/* The octave's share of a row of texels. */
static void noise_add(const struct noise *noise, uint32_t row, uint32_t tile, float *sums)
{
    const float *upper = noise->value[noise->point[row]], *lower = noise->value[noise->point[row] + 1];
    float v = noise->share[row];

    for (uint32_t x = 0; x < tile; x++) {
        int i = noise->point[x];
        float u = noise->share[x];
        float top = upper[i] + u * (upper[i + 1] - upper[i]), bottom = lower[i] + u * (lower[i + 1] - lower[i]);

        sums[x] += noise->amplitude * (top + v * (bottom - top));
    }
}

static void fill_tile(uint32_t seed, uint32_t tile, uint32_t pitch, unsigned char *texels)
{
    struct noise octaves[OCTAVES];
    float amplitude = 0.5f, frequency = 3;

    for (uint32_t octave = 0; octave < OCTAVES; octave++) {
        noise_fill(seed + octave, frequency, amplitude, tile, &octaves[octave]);
        amplitude *= 0.55f;
        frequency *= 2.1f;
    }
    for (uint32_t y = 0; y < tile; y++, texels += pitch) {
        float sums[TILE_MAX] = {0};

        for (uint32_t octave = 0; octave < OCTAVES; octave++)
            noise_add(&octaves[octave], y, tile, sums);
        for (uint32_t x = 0; x < tile; x++) {
            /* 0.5 (1 - 0.55^4) / (1 - 0.55) is the largest sum; contrast is stretched about the middle. */
            float value = (sums[x] / 1.0094f - 0.5f) * 2.2f + 0.62f;

            texels[x] = (unsigned char)(255 * (value < 0 ? 0 : value > 1 ? 1 : value) + 0.5f);
        }
    }
}

void sf_thick_atlas(uint32_t seed, uint32_t size, unsigned char *texels)
{
    uint32_t tile = size / 2;

    for (uint32_t number = 0; number < 4; number++)
        fill_tile(seed + 977 * number, tile, size, texels + (size_t)(number / 2 * tile) * size + number % 2 * tile);
}

enum sf_status sf_thick_scene_atlas(const struct sf_scene *scene, uint32_t size, const struct sf_log *log,
                                    unsigned char *texels)
{
    const struct sf_atlas *atlas = &scene->atlas;
    uint32_t tile = size / 2, count = (uint32_t)(atlas->across * atlas->down);
    struct sf_texture *made = NULL;

    if (atlas->kind == SF_ATLAS_PLAIN) {
        sf_thick_atlas((uint32_t)scene->sim.seed, size, texels);
        return SF_OK;
    }
    if (atlas->kind == SF_ATLAS_MADE) {
        struct sf_texture_options options;
        enum sf_status status;

        sf_scene_atlas_options(atlas, &options);
        status = sf_texture_create(&options, NULL, NULL, log, &made);
        if (status != SF_OK)
            return status;
    }
    for (uint32_t number = 0; number < 4; number++)
        sf_texels_tile_alpha(made ? made : atlas->texture, number % count, tile, size,
                             texels + (size_t)(number / 2 * tile) * size + number % 2 * tile);
    sf_texture_destroy(&made);
    return SF_OK;
}
