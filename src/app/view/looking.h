/* The looked-at image: its place in the picture's, and its values as colours. Lengths are px of that place, from its upper
 * left corner; `width` and `height` are the place's. */
#ifndef SF_APP_VIEW_LOOKING_H
#define SF_APP_VIEW_LOOKING_H

#include <stdbool.h>
#include <stdint.h>

struct sf_looking;

/* px a texel. */
float sf_looking_scale(const struct sf_looking *looking, float width, float height);
/* The texel at (x, y); false: none is there. */
bool sf_looking_texel(const struct sf_looking *looking, float width, float height, float x, float y, uint32_t *column,
                      uint32_t *row);
/* Where the middle of a texel stands. */
void sf_looking_spot(const struct sf_looking *looking, float width, float height, uint32_t column, uint32_t row,
                     float *x, float *y);
/* Nearer by steps of a wheel (25 % each); what is at (x, y) stays there. From half the size that fits to 128 px a
 * texel. */
void sf_looking_zoom(struct sf_looking *looking, float width, float height, float x, float y, float steps);
/* Never quite out of the place. */
void sf_looking_pan(struct sf_looking *looking, float width, float height, float dx, float dy);
void sf_looking_fit(struct sf_looking *looking);
/* The colour that a texel's values are shown in, after sf_looking_pixels; NaN is dark. */
void sf_looking_color(const struct sf_looking *looking, const float *values, uint8_t rgb[3]);

#endif
