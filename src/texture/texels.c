#include "texture/texels.h"

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
