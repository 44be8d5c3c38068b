#include "heat.h"

#include <math.h>

/* From 0 to the end of the scale, in even steps of it; the light of the steps rises alike on both sides. */
enum { STEPS = 4 };
static const float ABOVE[STEPS + 1][3] = {{40, 40, 40}, {112, 40, 34}, {193, 63, 39}, {242, 128, 66}, {255, 226, 176}};
static const float BELOW[STEPS + 1][3] = {{40, 40, 40}, {31, 56, 116}, {39, 97, 196}, {74, 162, 243}, {186, 234, 255}};
static const float LEAST = 1e-6f;

float sf_heat_scale(const float *values, size_t count)
{
    float most = LEAST;

    for (size_t i = 0; i < count; i++)
        if (isfinite(values[i]))
            most = fmaxf(most, fabsf(values[i]));
    return most;
}

void sf_heat_color(float value, float scale, uint8_t rgb[3])
{
    const float(*colors)[3] = value < 0 ? BELOW : ABOVE;
    float part = isnan(value) ? 0 : fminf(fabsf(value) / scale, 1) * STEPS;
    int step = part < STEPS ? (int)part : STEPS - 1;

    for (int c = 0; c < 3; c++)
        rgb[c] = (uint8_t)(colors[step][c] + (colors[step + 1][c] - colors[step][c]) * (part - (float)step) + 0.5f);
}
