#include "output/exr.h"

#include <math.h>

struct sf_exr_attribute sf_exr_text(const char *name, const char *text)
{
    return (struct sf_exr_attribute){.name = name, .kind = SF_EXR_TEXT, .text = text};
}

struct sf_exr_attribute sf_exr_number(const char *name, float value)
{
    return (struct sf_exr_attribute){.name = name, .kind = SF_EXR_NUMBER, .values = {value}};
}

struct sf_exr_attribute sf_exr_integer(const char *name, int32_t value)
{
    return (struct sf_exr_attribute){.name = name, .kind = SF_EXR_INTEGER, .integer = value};
}

struct sf_exr_attribute sf_exr_frames_per_second(double fps)
{
    struct sf_exr_attribute rate = {.name = "framesPerSecond", .kind = SF_EXR_RATIONAL, .integer = 1, .denominator = 1};
    double ntsc = round(fps * 1.001), best = HUGE_VAL;

    if (fabs(fps - round(fps)) > 1e-9 && fabs(ntsc * 1000 / 1001 - fps) < 0.005) {
        rate.integer = (int32_t)(ntsc * 1000);
        rate.denominator = 1001;
        return rate;
    }
    /* The smallest denominator that is exact to a part in 10^9, else the nearest. */
    for (uint32_t d = 1; d <= 1000 && best > fps * 1e-9; d++) {
        double n = round(fps * d), error = fabs(n / d - fps);

        if (n >= 1 && error < best) {
            best = error;
            rate.integer = (int32_t)n;
            rate.denominator = d;
        }
    }
    return rate;
}

struct sf_exr_attribute sf_exr_rec709(void)
{
    /* ITU-R BT.709-6, table 1.3 and 1.4. */
    return (struct sf_exr_attribute){.name = "chromaticities",
                                     .kind = SF_EXR_CHROMATICITIES,
                                     .values = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f}};
}

/* Row vectors: element (row, column) of the attribute is (column, row) of the matrix that we are given. */
struct sf_exr_attribute sf_exr_world_to_camera(const float matrix[16])
{
    struct sf_exr_attribute to = {.name = "worldToCamera", .kind = SF_EXR_MATRIX};

    for (int row = 0; row < 4; row++)
        for (int column = 0; column < 4; column++)
            to.values[row * 4 + column] = matrix[column * 4 + row] * (column == 2 ? -1.0f : 1.0f);
    return to;
}

struct sf_exr_attribute sf_exr_world_to_ndc(const float matrix[16])
{
    struct sf_exr_attribute to = {.name = "worldToNDC", .kind = SF_EXR_MATRIX};

    /* x and y from [-w, w] to [0, w]. */
    for (int row = 0; row < 4; row++)
        for (int column = 0; column < 4; column++)
            to.values[row * 4 + column] =
                column < 2 ? 0.5f * (matrix[column * 4 + row] + matrix[12 + row]) : matrix[column * 4 + row];
    return to;
}
