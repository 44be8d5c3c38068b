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

/* The four texels round a place, as indices of their first channels, and what each weighs. */
struct corners {
    size_t at[4];
    double weight[4];
};

/* Middles of texels are at halves; beyond the outermost ones it is as there. `first`: the tile's first texel. */
static struct corners corners_at(const struct sf_texture_info *info, size_t first, double x, double y)
{
    double right = info->width / info->tiles_x - 1, bottom = info->height / info->tiles_y - 1, u, v;
    struct corners corners;
    size_t row, column;

    x = fmin(fmax(x - 0.5, 0), right);
    y = fmin(fmax(y - 0.5, 0), bottom);
    column = (size_t)fmin(x, fmax(right - 1, 0));
    row = (size_t)fmin(y, fmax(bottom - 1, 0));
    u = x - (double)column;
    v = y - (double)row;
    for (size_t i = 0; i < 4; i++) {
        double weight = (i % 2 ? u : 1 - u) * (i / 2 ? v : 1 - v);

        /* A texel without weight may lie outside. */
        corners.weight[i] = weight;
        corners.at[i] = 4 * (first + (weight > 0 ? (row + i / 2) * info->width + column + i % 2 : 0));
    }
    return corners;
}

/* How a tile is brought to another size. */
struct scaling {
    const struct sf_texture *texture;
    enum sf_texels_plane plane;
    size_t first;          /* texel of the tile */
    double width, height;  /* of the tile, px */
    uint32_t size;         /* wanted */
    uint32_t across, down; /* places in a wanted texel */
};

static struct scaling scaling_of(const struct sf_texture *texture, enum sf_texels_plane plane, uint32_t tile,
                                 uint32_t size)
{
    const struct sf_texture_info *info = &texture->info;
    uint32_t width = info->width / info->tiles_x, height = info->height / info->tiles_y;

    return (struct scaling){.texture = texture,
                            .plane = plane,
                            .first = (size_t)(tile / info->tiles_x) * height * info->width +
                                     (size_t)(tile % info->tiles_x) * width,
                            .width = width,
                            .height = height,
                            .size = size,
                            .across = (width + size - 1) / size,
                            .down = (height + size - 1) / size};
}

/* Channels from `begin` to 3 of one texel of the wanted size. */
static void scaled_texel(const struct scaling *scaling, uint32_t x, uint32_t y, size_t begin, double values[4])
{
    for (size_t channel = begin; channel < 4; channel++)
        values[channel] = 0;
    for (uint32_t j = 0; j < scaling->down; j++)
        for (uint32_t i = 0; i < scaling->across; i++) {
            struct corners corners = corners_at(&scaling->texture->info, scaling->first,
                                                (x + (i + 0.5) / scaling->across) * scaling->width / scaling->size,
                                                (y + (j + 0.5) / scaling->down) * scaling->height / scaling->size);

            for (size_t k = 0; k < 4; k++)
                for (size_t channel = begin; channel < 4; channel++)
                    values[channel] +=
                        corners.weight[k] * (double)texel(scaling->texture, scaling->plane, corners.at[k] + channel);
        }
    for (size_t channel = begin; channel < 4; channel++)
        values[channel] /= scaling->across * scaling->down;
}

/* All four channels, normals of unit length. */
static void whole_texel(const struct scaling *scaling, uint32_t x, uint32_t y, double values[4])
{
    double length;

    scaled_texel(scaling, x, y, 0, values);
    if (scaling->plane != SF_TEXELS_SHAPE)
        return;
    length = sqrt(values[0] * values[0] + values[1] * values[1] + values[2] * values[2]);
    for (int i = 0; i < 3; i++)
        values[i] = length > 1e-6 ? values[i] / length : i == 2;
}

static uint8_t byte_of(double value)
{
    return (uint8_t)(255 * fmin(fmax(value, 0), 1) + 0.5);
}

void sf_texels_rgba8(const struct sf_texture *texture, enum sf_texels_plane plane, uint32_t tile, uint32_t size,
                     uint8_t *texels)
{
    const struct scaling scaling = scaling_of(texture, plane, tile, size);

    for (uint32_t i = 0; i < size * size; i++, texels += 4) {
        double values[4];

        whole_texel(&scaling, i % size, i / size, values);
        for (int c = 0; c < 4; c++)
            texels[c] = byte_of(plane == SF_TEXELS_SHAPE && c < 3 ? (127 * values[c] + 128) / 255 : values[c]);
    }
}

void sf_texels_rgba16f(const struct sf_texture *texture, enum sf_texels_plane plane, uint32_t tile, uint32_t size,
                       uint16_t *texels)
{
    const struct scaling scaling = scaling_of(texture, plane, tile, size);

    for (uint32_t i = 0; i < size * size; i++, texels += 4) {
        double values[4];

        whole_texel(&scaling, i % size, i / size, values);
        for (int c = 0; c < 4; c++)
            texels[c] = sf_half_from_float((float)values[c]);
    }
}

void sf_texels_tile_alpha(const struct sf_texture *texture, uint32_t tile, uint32_t size, uint32_t pitch,
                          uint8_t *texels)
{
    const struct scaling scaling = scaling_of(texture, SF_TEXELS_COLOR, tile, size);

    for (uint32_t y = 0; y < size; y++, texels += pitch)
        for (uint32_t x = 0; x < size; x++) {
            double values[4];

            scaled_texel(&scaling, x, y, 3, values);
            texels[x] = byte_of(values[3]);
        }
}
