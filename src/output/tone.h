/* From scene light to display values on the CPU, for PNG. No dither: the same frame gives the same bits. */
#ifndef SF_OUTPUT_TONE_H
#define SF_OUTPUT_TONE_H

#include <stddef.h>
#include <stdint.h>
#include "base/log.h"

enum sf_tone_mode {
    SF_TONE_LINEAR,   /* cut off at 1 */
    SF_TONE_REINHARD, /* luminance, white at 4 */
    SF_TONE_ACES,     /* Hill's fit of the ACES reference transforms */
    SF_TONE_NEUTRAL,  /* Khronos PBR Neutral: colours below 0.8 as they are */
};

struct sf_tone {
    enum sf_tone_mode mode;
    float exposure; /* stops: light is first multiplied by 2^exposure */
};

/* "linear", "reinhard", "aces", "neutral"; SF_ERROR_USAGE for others. */
enum sf_status sf_tone_parse(const char *name, enum sf_tone_mode *mode, const struct sf_log *log);
const char *sf_tone_name(enum sf_tone_mode mode);

/* Linear Rec. 709 light to linear display values in [0,1]. Negative parts and NaN count as 0. */
void sf_tone_map(const struct sf_tone *tone, const float light[3], float display[3]);

/* IEC 61966-2-1, for values in [0,1]. */
double sf_srgb_encode(double linear);
double sf_srgb_decode(double encoded);

/* Tone-maps `count` premultiplied RGBA pixels and encodes them for sRGB, rounded to nearest. With 3 channels colour is
 * as over black; with 4 it is divided by alpha first (PNG's alpha is not premultiplied; where alpha is 0 colour is
 * lost). */
void sf_tone_encode8(const struct sf_tone *tone, const float *rgba, size_t count, unsigned channels, uint8_t *out);
void sf_tone_encode16(const struct sf_tone *tone, const float *rgba, size_t count, unsigned channels, uint16_t *out);

#endif
