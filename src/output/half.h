/* 16-bit floats (IEEE 754 binary16) as image files hold them. */
#ifndef SF_OUTPUT_HALF_H
#define SF_OUTPUT_HALF_H

#include <stddef.h>
#include <stdint.h>

#define SF_HALF_MAX 65504.0f

/* Rounds to nearest, ties to even. What lies beyond +-65504, infinities too, becomes +-65504: one Inf in a frame
 * spreads over everything that filters it later. A NaN stays a (quiet) NaN, so that a defect shows. */
uint16_t sf_half_from_float(float value);
/* Exact. */
float sf_half_to_float(uint16_t half);

/* Converts `count` floats, `stride` bytes apart (a multiple of 4), to little-endian halves at `to`, which need not be
 * aligned. Uses the processor's F16C instructions where it has them; the bits are the same either way. */
void sf_half_row(const void *from, size_t stride, size_t count, unsigned char *to);
/* The same without F16C: for other processors, and for the test that compares the two. */
void sf_half_row_portable(const void *from, size_t stride, size_t count, unsigned char *to);

#endif
