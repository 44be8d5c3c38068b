/* A texture's planes as a device takes them: for methods that draw with an atlas. */
#ifndef SF_TEXTURE_TEXELS_H
#define SF_TEXTURE_TEXELS_H

#include <stdint.h>

struct sf_texture;

enum sf_texels_plane {
    SF_TEXELS_COLOR, /* linear R, G, B premultiplied by A, so that filtering needs no care at borders; A */
    SF_TEXELS_SHAPE, /* normal x, y, z; height */
};

/* Tile number `tile`, brought to `size` by `size` texels: the mean over a texel where there are fewer of them, linear
 * between where there are more; [size][size][4], row 0 on top. In 8 bits (RGBA8_UNORM) normals are (127 n + 128) / 255, and values
 * above 1 are 1; in 16-bit floats (RGBA16F) all is as it is. Normals are unit. */
void sf_texels_rgba8(const struct sf_texture *texture, enum sf_texels_plane plane, uint32_t tile, uint32_t size,
                     uint8_t *texels);
void sf_texels_rgba16f(const struct sf_texture *texture, enum sf_texels_plane plane, uint32_t tile, uint32_t size,
                       uint16_t *texels);
/* Alpha alone (R8_UNORM) of a tile, likewise; rows are `pitch` apart. */
void sf_texels_tile_alpha(const struct sf_texture *texture, uint32_t tile, uint32_t size, uint32_t pitch,
                          uint8_t *texels);

#endif
