/* The public writers: a rendered frame to an EXR or a PNG file. */
#include "sfumato/sfumato.h"

#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/log.h"
#include "output/exr.h"
#include "output/half.h"
#include "output/image.h"
#include "output/png.h"
#include "output/tone.h"

enum { CHANNELS_MAX = 13, ATTRIBUTES_MAX = 7, WIDE = 16 };

struct layers {
    const struct sf_frame *frame;
    struct sf_exr_channel channels[CHANNELS_MAX];
    size_t count;
};

/* Adds `count` channels of interleaved pixels. */
static void add_channels(struct layers *layers, const char *const *names, size_t count, const void *pixels,
                         enum sf_exr_type source, enum sf_exr_type stored)
{
    size_t size = source == SF_EXR_HALF ? sizeof(uint16_t) : sizeof(float);

    for (size_t c = 0; c < count; c++)
        layers->channels[layers->count++] = (struct sf_exr_channel){
            .name = names[c],
            .pixels = (const unsigned char *)pixels + c * size,
            .pixel_stride = count * size,
            .row_stride = count * size * layers->frame->width,
            .source = source,
            .stored = stored,
        };
}

/* No date and no host: the same frame has the same bytes wherever and whenever it is made. */
static size_t fill_attributes(const struct sf_frame *frame, const struct sf_exr_options *options,
                              struct sf_exr_attribute attributes[ATTRIBUTES_MAX])
{
    size_t count = 0;

    attributes[count++] = sf_exr_text("software", "sfumato " SF_VERSION);
    attributes[count++] = sf_exr_rec709();
    attributes[count++] = sf_exr_integer("sfumatoFrame", (int32_t)frame->frame);
    attributes[count++] = sf_exr_world_to_camera(frame->world_to_camera);
    attributes[count++] = sf_exr_world_to_ndc(frame->world_to_clip);
    if (options->fps > 0)
        attributes[count++] = sf_exr_frames_per_second(options->fps);
    if (options->scene_hash)
        attributes[count++] = sf_exr_text("sfumatoSceneHash", options->scene_hash);
    return count;
}

enum sf_status sf_frame_write_exr(const struct sf_frame *frame, const char *path, const struct sf_exr_options *options,
                                  const struct sf_log *log)
{
    static const char *const color[] = {"R", "G", "B", "A"}, *const depth[] = {"Z"};
    static const char *const smoke[] = {"smoke.R", "smoke.G", "smoke.B", "smoke.A"};
    static const char *const depths[] = {"smoke.near", "smoke.far", "smoke.depth", "smoke.T"};
    enum sf_exr_type stored = options->half ? SF_EXR_HALF : SF_EXR_FLOAT;
    struct layers layers = {.frame = frame};
    struct sf_exr_attribute attributes[ATTRIBUTES_MAX];
    struct sf_exr_frame exr = {.width = frame->width, .height = frame->height};
    enum sf_status status = sf_exr_compression_parse(options->compression, &exr.compression, log);

    if (status != SF_OK)
        return status;
    if (frame->color)
        add_channels(&layers, color, 4, frame->color, SF_EXR_HALF, stored);
    else if (frame->color_float)
        add_channels(&layers, color, 4, frame->color_float, SF_EXR_FLOAT, stored);
    if (frame->depth)
        add_channels(&layers, depth, 1, frame->depth, SF_EXR_FLOAT, SF_EXR_FLOAT);
    if (frame->smoke)
        add_channels(&layers, smoke, 4, frame->smoke, SF_EXR_HALF, stored);
    else if (frame->smoke_float)
        add_channels(&layers, smoke, 4, frame->smoke_float, SF_EXR_FLOAT, stored);
    if (frame->smoke_depths)
        add_channels(&layers, depths, 4, frame->smoke_depths, SF_EXR_FLOAT, SF_EXR_FLOAT);
    exr.attribute_count = fill_attributes(frame, options, attributes);
    exr.channels = layers.channels;
    exr.channel_count = layers.count;
    exr.attributes = attributes;
    return sf_exr_write(path, &exr, log);
}

enum sf_status sf_frame_write_inspected_exr(const struct sf_frame *frame, const char *path,
                                            const struct sf_exr_options *options, const struct sf_log *log)
{
    static const char *const names[] = {"R", "G", "B", "A"};
    const struct sf_frame shape = {.width = frame->inspected_width, .height = frame->inspected_height};
    struct layers layers = {.frame = &shape};
    struct sf_exr_attribute attributes[ATTRIBUTES_MAX];
    struct sf_exr_frame exr = {.width = shape.width, .height = shape.height, .channels = layers.channels};
    enum sf_status status = sf_exr_compression_parse(options->compression, &exr.compression, log);

    if (status != SF_OK)
        return status;
    if (!frame->inspected)
        return sf_fail(log, SF_ERROR_USAGE, "cannot write '%s': the frame has no inspected image", path);
    add_channels(&layers, names, frame->inspected_channels, frame->inspected, SF_EXR_FLOAT, SF_EXR_FLOAT);
    exr.channel_count = layers.count;
    exr.attribute_count = fill_attributes(frame, options, attributes);
    exr.attributes = attributes;
    return sf_exr_write(path, &exr, log);
}

/* Tone-maps the picture row by row, colour as it is over black. */
static void encode_rows(const struct sf_frame *frame, const struct sf_tone *tone, float *row, uint8_t *bytes)
{
    size_t values = (size_t)frame->width * 4;

    for (uint32_t y = 0; y < frame->height; y++, bytes += (size_t)frame->width * 3) {
        const float *from = row;

        if (frame->color) {
            const uint16_t *halves = frame->color + y * values;

            for (size_t i = 0; i < values; i++)
                row[i] = sf_half_to_float(halves[i]);
        } else {
            from = frame->color_float + y * values;
        }
        sf_tone_encode8(tone, from, frame->width, 3, bytes);
    }
}

enum sf_status sf_frame_write_png(const struct sf_frame *frame, const char *path, const char *tone_name, float exposure,
                                  const struct sf_log *log)
{
    struct sf_tone tone = {.exposure = exposure};
    struct sf_png_frame png = {.width = frame->width, .height = frame->height, .channels = 3, .bits = 8};
    enum sf_status status = sf_tone_parse(tone_name, &tone.mode, log);
    float *row;
    uint8_t *bytes;

    if (status != SF_OK)
        return status;
    if ((!frame->color && !frame->color_float) || frame->width > SF_IMAGE_SIDE_MAX || frame->height > SF_IMAGE_SIDE_MAX)
        return sf_fail(log, SF_ERROR_USAGE, "cannot write '%s': the frame has no colour", path);
    row = malloc((size_t)frame->width * 4 * sizeof *row);
    bytes = malloc((size_t)frame->width * frame->height * 3);
    if (row && bytes) {
        encode_rows(frame, &tone, row, bytes);
        png.pixels = bytes;
        status = sf_png_write(path, &png, log);
    } else {
        status = sf_fail(log, SF_ERROR_MEMORY, "cannot write '%s': out of memory", path);
    }
    free(bytes);
    free(row);
    return status;
}

static bool shown(float value)
{
    return fabsf(value) < SF_NO_DEPTH; /* false for NaN */
}

/* One channel's values to 0..255; pixels whose first channel holds no value stay black. */
static void encode_channel(const float *pixels, uint32_t channels, uint32_t channel, size_t count, uint8_t *to)
{
    float least = SF_NO_DEPTH, greatest = -SF_NO_DEPTH;

    for (size_t i = 0; i < count; i++) {
        float value = pixels[i * channels + channel];
        if (shown(pixels[i * channels]) && shown(value)) {
            least = fminf(least, value);
            greatest = fmaxf(greatest, value);
        }
    }
    bool negative = greatest < 0;
    double low = negative ? -greatest : least, high = negative ? -least : greatest;
    bool wide = low > 0 && high > WIDE * low; /* a floor up to its horizon */
    double range = wide ? log(high / low) : high - low;
    for (size_t i = 0; i < count; i++) {
        double value = pixels[i * channels + channel], size = negative ? -value : value, part;

        if (!shown(pixels[i * channels]) || !shown((float)value))
            continue;
        part = range > 0 ? (wide ? log(size / low) : size - low) / range : size != 0;
        to[3 * i] = (uint8_t)(255.0 * fmin(fmax(part, 0.0), 1.0) + 0.5);
    }
}

enum sf_status sf_frame_write_inspected_png(const struct sf_frame *frame, const char *path, const struct sf_log *log)
{
    uint32_t channels = frame->inspected_channels;
    size_t pixels = (size_t)frame->inspected_width * frame->inspected_height;
    struct sf_png_frame png = {
        .width = frame->inspected_width, .height = frame->inspected_height, .channels = 3, .bits = 8};
    enum sf_status status;
    uint8_t *bytes;

    if (!frame->inspected || png.width > SF_IMAGE_SIDE_MAX || png.height > SF_IMAGE_SIDE_MAX)
        return sf_fail(log, SF_ERROR_USAGE, "cannot write '%s': the frame has no inspected image that fits", path);
    bytes = calloc(pixels, 3);
    if (!bytes)
        return sf_fail(log, SF_ERROR_MEMORY, "cannot write '%s': out of memory", path);
    for (uint32_t c = 0; c < 3; c++) {
        uint32_t from = channels == 1 ? 0 : c;
        if (from < channels)
            encode_channel(frame->inspected, channels, from, pixels, bytes + c);
    }
    png.pixels = bytes;
    status = sf_png_write(path, &png, log);
    free(bytes);
    return status;
}
