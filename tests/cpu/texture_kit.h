/* What the tests of src/texture share. */
#ifndef SF_TESTS_TEXTURE_KIT_H
#define SF_TESTS_TEXTURE_KIT_H

#include "scratch.h"

#include <math.h>
#include "sfumato/sfumato.h"

static const char *const kit_kinds[] = {"fbm", "turbulence", "cellular", "dispersed"};
enum { KIT_KINDS = 4 };

static struct caught caught;
static const struct sf_log log_caught = {.write = caught_write, .user = &caught, .level = SF_LOG_DEBUG};

/* One tile of `side`, else as usual. */
static inline struct sf_texture_options kit_options(const char *kind, uint32_t side)
{
    struct sf_texture_options options;

    sf_texture_options_init(&options);
    options.kind = kind;
    options.tiles_x = options.tiles_y = 1;
    options.width = options.height = side;
    return options;
}

static inline struct sf_texture *kit_make(const struct sf_texture_options *options)
{
    struct sf_texture *texture = NULL;

    if (sf_texture_create(options, NULL, NULL, &log_caught, &texture) != SF_OK)
        fail_msg("%s", caught.text);
    return texture;
}

static inline struct sf_texture_info kit_info(const struct sf_texture *texture)
{
    struct sf_texture_info info;

    sf_texture_describe(texture, &info);
    return info;
}

/* A texel of a tile, of the color or the shape plane. */
static inline const float *kit_texel(const struct sf_texture_info *info, const float *plane, uint32_t tile, uint32_t x,
                                     uint32_t y)
{
    uint32_t width = info->width / info->tiles_x, height = info->height / info->tiles_y;
    size_t row = (size_t)(tile / info->tiles_x) * height + y;

    return plane + 4 * (row * info->width + tile % info->tiles_x * width + x);
}

#endif
