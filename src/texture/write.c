/* Textures to EXR and PNG files. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/array.h"
#include "output/exr.h"
#include "output/png.h"
#include "output/tone.h"
#include "texture/texture.h"

enum { CHANNELS_MAX = 8, ATTRIBUTES_MAX = 8 };

/* ---- EXR ---- */

struct layers {
    struct sf_exr_channel channels[CHANNELS_MAX];
    size_t count;
    uint32_t width;
    enum sf_exr_type stored;
};

/* Adds `count` channels of interleaved pixels of four floats. */
static void add_channels(struct layers *layers, const char *const *names, size_t count, const float *pixels)
{
    for (size_t c = 0; c < count; c++)
        layers->channels[layers->count++] = (struct sf_exr_channel){.name = names[c],
                                                                    .pixels = pixels + c,
                                                                    .pixel_stride = 4 * sizeof *pixels,
                                                                    .row_stride = 4 * sizeof *pixels * layers->width,
                                                                    .source = SF_EXR_FLOAT,
                                                                    .stored = layers->stored};
}

static size_t fill_attributes(const struct sf_texture *texture, const struct sf_exr_options *options, const char *tiles,
                              struct sf_exr_attribute attributes[ATTRIBUTES_MAX])
{
    size_t count = 0;

    attributes[count++] = sf_exr_text("software", "sfumato " SF_VERSION);
    attributes[count++] = sf_exr_rec709();
    attributes[count++] = sf_exr_text("sfumatoTiles", tiles);
    attributes[count++] = sf_exr_integer("sfumatoLoop", (int32_t)texture->info.loop);
    attributes[count++] = sf_exr_integer("sfumatoTileable", texture->info.tileable);
    attributes[count++] = sf_exr_text("sfumatoAlpha", "premultiplied");
    if (texture->made)
        attributes[count++] = sf_exr_text("sfumatoTexture", texture->made);
    if (options->fps > 0)
        attributes[count++] = sf_exr_frames_per_second(options->fps);
    return count;
}

static void premultiply(const float *color, size_t count, float *to)
{
    for (size_t i = 0; i < count; i++, color += 4, to += 4) {
        for (int c = 0; c < 3; c++)
            to[c] = color[c] * color[3];
        to[3] = color[3];
    }
}

enum sf_status sf_texture_write_exr(const struct sf_texture *texture, const char *path, uint32_t channels,
                                    const struct sf_exr_options *options, const struct sf_log *log)
{
    static const char *const color[] = {"R", "G", "B"}, *const alpha[] = {"A"};
    static const char *const normal[] = {"N.x", "N.y", "N.z"}, *const height[] = {"height"};
    size_t count = (size_t)texture->info.width * texture->info.height;
    struct layers layers = {.width = texture->info.width, .stored = options->half ? SF_EXR_HALF : SF_EXR_FLOAT};
    struct sf_exr_attribute attributes[ATTRIBUTES_MAX];
    struct sf_exr_frame exr = {.width = texture->info.width, .height = texture->info.height};
    enum sf_status status = sf_exr_compression_parse(options->compression, &exr.compression, log);
    char tiles[32];
    float *over;

    if (status != SF_OK)
        return status;
    if (!(channels & SF_TEXTURE_ALL))
        return sf_fail(log, SF_ERROR_USAGE, "cannot write '%s': no channels are asked for", path);
    over = malloc(count * 4 * sizeof *over);
    if (!over)
        return sf_fail(log, SF_ERROR_MEMORY, "cannot write '%s': out of memory", path);
    premultiply(texture->color, count, over);
    if (channels & SF_TEXTURE_COLOR)
        add_channels(&layers, color, 3, over);
    if (channels & SF_TEXTURE_ALPHA)
        add_channels(&layers, alpha, 1, over + 3);
    if (channels & SF_TEXTURE_NORMAL)
        add_channels(&layers, normal, 3, texture->shape);
    if (channels & SF_TEXTURE_HEIGHT)
        add_channels(&layers, height, 1, texture->shape + 3);
    snprintf(tiles, sizeof tiles, "%ux%u", (unsigned)texture->info.tiles_x, (unsigned)texture->info.tiles_y);
    exr.attribute_count = fill_attributes(texture, options, tiles, attributes);
    exr.attributes = attributes;
    exr.channels = layers.channels;
    exr.channel_count = layers.count;
    status = sf_exr_write(path, &exr, log);
    free(over);
    return status;
}

/* ---- PNG ---- */

/* Where a picture's channel comes from. */
struct source {
    const float *from; /* the first pixel's; four floats lie between pixels */
    enum { CURVE, PLAIN, SIGNED } how;
};

static double encode(const struct source *source, size_t pixel)
{
    double value = source->from[4 * pixel];

    if (source->how == SIGNED)
        value = 0.5 * value + 0.5;
    value = fmin(fmax(value, 0), 1);
    return source->how == CURVE ? sf_srgb_encode(value) : value;
}

/* The channels of a picture; 0 when there is none such. */
static unsigned find_sources(const struct sf_texture *texture, uint32_t channels, struct source sources[4])
{
    const float *color = texture->color, *shape = texture->shape;
    unsigned count = 3;

    for (int c = 0; c < 3; c++) {
        if (channels & SF_TEXTURE_COLOR)
            sources[c] = (struct source){color + c, CURVE};
        else if (channels & SF_TEXTURE_NORMAL)
            sources[c] = (struct source){shape + c, SIGNED};
        else
            sources[c] = (struct source){channels & SF_TEXTURE_ALPHA ? color + 3 : shape + 3, PLAIN};
    }
    if (channels == (SF_TEXTURE_COLOR | SF_TEXTURE_ALPHA))
        sources[count++] = (struct source){color + 3, PLAIN};
    else if (channels == (SF_TEXTURE_NORMAL | SF_TEXTURE_HEIGHT))
        sources[count++] = (struct source){shape + 3, PLAIN};
    else if (channels == 0 || channels > SF_TEXTURE_ALL || (channels & (channels - 1)) != 0)
        return 0;
    return count;
}

enum sf_status sf_texture_write_png(const struct sf_texture *texture, const char *path, uint32_t channels,
                                    unsigned bits, const struct sf_log *log)
{
    struct source sources[4];
    struct sf_png_frame png = {.width = texture->info.width,
                               .height = texture->info.height,
                               .channels = find_sources(texture, channels, sources),
                               .bits = bits,
                               .numbers = !(channels & SF_TEXTURE_COLOR)};
    size_t count = (size_t)png.width * png.height, values = count * png.channels;
    double greatest = bits == 16 ? 65535 : 255;
    enum sf_status status;
    void *pixels;

    if (png.channels == 0)
        return sf_fail(log, SF_ERROR_USAGE,
                       "cannot write '%s': a PNG holds colour and alpha, or normal and height, or one of them", path);
    pixels = malloc(values * (bits == 16 ? sizeof(uint16_t) : sizeof(uint8_t)));
    if (!pixels)
        return sf_fail(log, SF_ERROR_MEMORY, "cannot write '%s': out of memory", path);
    for (size_t i = 0; i < values; i++) {
        double value = greatest * encode(&sources[i % png.channels], i / png.channels) + 0.5;

        if (bits == 16)
            ((uint16_t *)pixels)[i] = (uint16_t)value;
        else
            ((uint8_t *)pixels)[i] = (uint8_t)value;
    }
    png.pixels = pixels;
    status = sf_png_write(path, &png, log);
    free(pixels);
    return status;
}
