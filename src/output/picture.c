/* The public writers: a rendered frame to an EXR or a PNG file. */
#include "sfumato/sfumato.h"

#include <stdlib.h>
#include "base/array.h"
#include "base/log.h"
#include "output/exr.h"
#include "output/half.h"
#include "output/image.h"
#include "output/png.h"
#include "output/tone.h"

enum { CHANNELS_MAX = 13, ATTRIBUTES_MAX = 7 };

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
    if (frame->smoke_depths)
        add_channels(&layers, depths, 4, frame->smoke_depths, SF_EXR_FLOAT, SF_EXR_FLOAT);
    /* No date and no host: the same frame has the same bytes wherever and whenever it is made. */
    attributes[exr.attribute_count++] = sf_exr_text("software", "sfumato " SF_VERSION);
    attributes[exr.attribute_count++] = sf_exr_rec709();
    attributes[exr.attribute_count++] = sf_exr_integer("sfumatoFrame", (int32_t)frame->frame);
    attributes[exr.attribute_count++] = sf_exr_world_to_camera(frame->world_to_camera);
    attributes[exr.attribute_count++] = sf_exr_world_to_ndc(frame->world_to_clip);
    if (options->fps > 0)
        attributes[exr.attribute_count++] = sf_exr_frames_per_second(options->fps);
    if (options->scene_hash)
        attributes[exr.attribute_count++] = sf_exr_text("sfumatoSceneHash", options->scene_hash);
    exr.channels = layers.channels;
    exr.channel_count = layers.count;
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
