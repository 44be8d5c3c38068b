#include "texture/texels.h"

#include <math.h>
#include "output/half.h"
#include "texture/texture.h"

static float texel(const struct sf_texture *texture, enum sf_texels_plane plane, size_t i)
{
    if (plane == SF_TEXELS_SHAPE)
        return texture->shape[i];
    return i % 4 == 3 ? texture->color[i] : texture->color[i] * texture->color[i | 3];
}

static size_t count(const struct sf_texture *texture)
{
    return (size_t)texture->info.width * texture->info.height * 4;
}

void sf_texels_rgba8(const struct sf_texture *texture, enum sf_texels_plane plane, uint8_t *texels)
{
    for (size_t i = 0; i < count(texture); i++) {
        float value = texel(texture, plane, i);

        if (plane == SF_TEXELS_SHAPE && i % 4 < 3)
            value = 0.5f * value + 0.5f;
        texels[i] = (uint8_t)(255 * (value < 0 ? 0 : value > 1 ? 1 : value) + 0.5f);
    }
}

void sf_texels_rgba16f(const struct sf_texture *texture, enum sf_texels_plane plane, uint16_t *texels)
{
    for (size_t i = 0; i < count(texture); i++)
        texels[i] = sf_half_from_float(texel(texture, plane, i));
}

/* Alpha of a tile, linear between its texels, whose middles are at halves; beyond the outermost ones as there. */
static double alpha_at(const struct sf_texture_info *info, const float *tile, double x, double y)
{
    double right = info->width / info->tiles_x - 1, bottom = info->height / info->tiles_y - 1, u, v, sum = 0;
    size_t row, column;

    x = fmin(fmax(x - 0.5, 0), right);
    y = fmin(fmax(y - 0.5, 0), bottom);
    column = (size_t)fmin(x, fmax(right - 1, 0));
    row = (size_t)fmin(y, fmax(bottom - 1, 0));
    u = x - (double)column;
    v = y - (double)row;
    for (size_t j = 0; j < 2; j++)
        for (size_t i = 0; i < 2; i++) {
            double weight = (i ? u : 1 - u) * (j ? v : 1 - v);

            if (weight > 0)
                sum += weight * (double)tile[4 * ((row + j) * info->width + column + i) + 3];
        }
    return sum;
}

void sf_texels_tile_alpha(const struct sf_texture *texture, uint32_t tile, uint32_t size, uint32_t pitch,
                          uint8_t *texels)
{
    const struct sf_texture_info *info = &texture->info;
    uint32_t width = info->width / info->tiles_x, height = info->height / info->tiles_y;
    const float *from = texture->color + 4 * ((size_t)(tile / info->tiles_x) * height * info->width +
                                              (size_t)(tile % info->tiles_x) * width);
    uint32_t across = (width + size - 1) / size, down = (height + size - 1) / size; /* points in a texel */

    for (uint32_t y = 0; y < size; y++, texels += pitch)
        for (uint32_t x = 0; x < size; x++) {
            double sum = 0;

            for (uint32_t j = 0; j < down; j++)
                for (uint32_t i = 0; i < across; i++)
                    sum += alpha_at(info, from, (x + (i + 0.5) / across) * width / size,
                                    (y + (j + 0.5) / down) * height / size);
            texels[x] = (uint8_t)(255 * sum / (across * down) + 0.5);
        }
}
