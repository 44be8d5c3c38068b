/* A picture for the tests of EXR files: smoke-like, with a large empty part. */
#ifndef SF_TESTS_EXR_PICTURE_H
#define SF_TESTS_EXR_PICTURE_H

#include "scratch.h"

#include <math.h>
#include "base/hash.h"
#include "output/exr.h"
#include "output/half.h"

/* A frame to write: RGBA interleaved, Z in a plane, N in halves; and what a reader must find of it. */
struct picture {
    uint32_t width, height;
    float *rgba, *z;
    uint16_t *n;
    struct sf_exr_channel channels[6];
    struct sf_exr_frame frame;
};

static inline void picture_make(struct picture *p, uint32_t width, uint32_t height, enum sf_exr_compression compression)
{
    static const char *const names[] = {"R", "G", "B", "A", "Z", "smoke.near"};
    size_t count = (size_t)width * height;

    *p = (struct picture){.width = width, .height = height};
    p->rgba = malloc(count * 4 * sizeof(float));
    p->z = malloc(count * sizeof(float));
    p->n = malloc(count * sizeof(uint16_t));
    for (size_t i = 0; i < count; i++) {
        float x = (float)(i % width) / (float)width, y = (float)(i / width) / (float)height;
        bool empty = (x - 0.5f) * (x - 0.5f) + (y - 0.5f) * (y - 0.5f) > 0.1f;

        for (size_t c = 0; c < 4; c++)
            p->rgba[4 * i + c] = empty ? 0.0f : x * y + 0.01f * sf_random_float(1, (uint32_t)i, (uint32_t)c);
        p->z[i] = empty ? HUGE_VALF : 4.0f + x;
        p->n[i] = (uint16_t)(sf_half_from_float(y) + i % 3);
    }
    for (size_t c = 0; c < 6; c++)
        p->channels[c] = (struct sf_exr_channel){
            .name = names[c],
            .pixels = c < 4    ? (const void *)(p->rgba + c)
                      : c == 4 ? (const void *)p->z
                               : (const void *)p->n,
            .pixel_stride = c < 4    ? 16
                            : c == 4 ? 4
                                     : 2,
            .row_stride = (c < 4    ? 16u
                           : c == 4 ? 4u
                                    : 2u) *
                          width,
            .source = c < 5 ? SF_EXR_FLOAT : SF_EXR_HALF,
            .stored = c == 4 ? SF_EXR_FLOAT : SF_EXR_HALF,
        };
    p->frame = (struct sf_exr_frame){.width = width, .height = height, .channels = p->channels, .channel_count = 6};
    p->frame.compression = compression;
}

static inline void picture_free(struct picture *p)
{
    free(p->rgba);
    free(p->z);
    free(p->n);
}

#endif
