/* Signed differences as colours: blue below 0, red above, 0 dark. */
#ifndef SF_APP_VIEW_HEAT_H
#define SF_APP_VIEW_HEAT_H

#include <stddef.h>
#include <stdint.h>

/* The greatest size of the numbers among the values: 1e-6 at least, so that there is a scale. */
float sf_heat_scale(const float *values, size_t count);
/* sRGB; brighter with the value's size, as bright as can be from `scale` on, which is above 0. NaN: as 0. */
void sf_heat_color(float value, float scale, uint8_t rgb[3]);

#endif
