/* After G. Ward, "Real Pixels", Graphics Gems II, 1991, and the format's description in the Radiance reference manual.
 */
#include "output/hdr.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct reader {
    const unsigned char *at, *end;
    const char *name;
    const struct sf_log *log;
};

enum { LINE_BYTES = 256, RLE_WIDTH_MIN = 8, RLE_WIDTH_MAX = 32767 };

static enum sf_status fail(const struct reader *reader, const char *why)
{
    return sf_fail(reader->log, SF_ERROR_IO, "cannot read '%s': %s", reader->name, why);
}

/* The next line without its end. False at the end of the file, or when a line is absurdly long. */
static bool read_line(struct reader *reader, char line[LINE_BYTES])
{
    size_t left = (size_t)(reader->end - reader->at), length;
    const unsigned char *newline = memchr(reader->at, '\n', left);

    if (!newline || newline - reader->at >= LINE_BYTES)
        return false;
    length = (size_t)(newline - reader->at);
    memcpy(line, reader->at, length);
    if (length > 0 && line[length - 1] == '\r')
        length--;
    line[length] = '\0';
    reader->at = newline + 1;
    return true;
}

static enum sf_status read_header(struct reader *reader, struct sf_image *image, bool *upward, float *exposure)
{
    char line[LINE_BYTES], y_sign, x_sign;
    bool format = false;
    unsigned width, height;

    *exposure = 1.0f;
    do {
        float factor;

        if (!read_line(reader, line))
            return fail(reader, "its Radiance header is cut short");
        if (strncmp(line, "FORMAT=", 7) == 0) {
            if (strcmp(line + 7, "32-bit_rle_rgbe") != 0)
                return fail(reader, "its Radiance format is not 32-bit_rle_rgbe");
            format = true;
        } else if (sscanf(line, "EXPOSURE=%f", &factor) == 1) {
            *exposure *= factor; /* several multiply */
        }
    } while (line[0] != '\0');
    if (!format)
        return fail(reader, "its Radiance header names no format");
    if (!(*exposure > 0.0f && *exposure < HUGE_VALF))
        return fail(reader, "its Radiance exposure is not a positive number");
    if (!read_line(reader, line) || sscanf(line, "%cY %9u %cX %9u", &y_sign, &height, &x_sign, &width) != 4 ||
        (y_sign != '-' && y_sign != '+') || x_sign != '+')
        return fail(reader, "its Radiance size is not of the form -Y height +X width");
    *upward = y_sign == '+';
    image->width = width;
    image->height = height;
    return sf_image_check_size(reader->name, width, height, 4, reader->log);
}

/* One component of a line: a count over 128 repeats the next byte count - 128 times, another copies count bytes. */
static bool read_component(struct reader *reader, uint32_t width, unsigned char *to)
{
    for (uint32_t x = 0; x < width;) {
        size_t left = (size_t)(reader->end - reader->at), count, bytes;

        if (left < 2)
            return false;
        count = *reader->at++;
        bytes = count > 128 ? 1 : count;
        count = count > 128 ? count - 128 : count;
        if (count == 0 || count > width - x || bytes > left - 1)
            return false;
        if (bytes == 1)
            memset(to + x, *reader->at, count);
        else
            memcpy(to + x, reader->at, count);
        reader->at += bytes;
        x += (uint32_t)count;
    }
    return true;
}

/* Old lines: pixels one by one; 1 1 1 n repeats the last one n times, and n is shifted by 8 for each such pixel on end.
 */
static bool read_old_line(struct reader *reader, uint32_t width, unsigned char *planes)
{
    unsigned shift = 0;

    for (uint32_t x = 0; x < width;) {
        const unsigned char *p = reader->at;

        if (reader->end - p < 4)
            return false;
        reader->at += 4;
        if (p[0] == 1 && p[1] == 1 && p[2] == 1) {
            uint64_t count = shift < 32 ? (uint64_t)p[3] << shift : UINT64_MAX;

            if (x == 0 || count > width - x)
                return false;
            for (; count > 0; count--, x++)
                for (size_t c = 0; c < 4; c++)
                    planes[c * width + x] = planes[c * width + x - 1];
            shift += 8;
        } else {
            for (size_t c = 0; c < 4; c++)
                planes[c * width + x] = p[c];
            x++;
            shift = 0;
        }
    }
    return true;
}

/* Four planes of one line: red, green, blue, exponent. */
static bool read_pixels(struct reader *reader, uint32_t width, unsigned char *planes)
{
    const unsigned char *p = reader->at;

    if (width < RLE_WIDTH_MIN || width > RLE_WIDTH_MAX || reader->end - p < 4 || p[0] != 2 || p[1] != 2 || p[2] > 127)
        return read_old_line(reader, width, planes);
    if (((uint32_t)p[2] << 8 | p[3]) != width)
        return false;
    reader->at += 4;
    for (size_t c = 0; c < 4; c++)
        if (!read_component(reader, width, planes + c * width))
            return false;
    return true;
}

static void convert_line(const unsigned char *planes, uint32_t width, float scale, float *to)
{
    for (uint32_t x = 0; x < width; x++, to += 4) {
        unsigned exponent = planes[3 * (size_t)width + x];
        /* Ward: the middle of the step, (mantissa + 1/2) / 256 * 2^(exponent - 128); exponent 0 is black. */
        float unit = exponent > 0 ? ldexpf(scale, (int)exponent - 136) : 0.0f;

        for (size_t c = 0; c < 3; c++)
            to[c] = ((float)planes[c * width + x] + 0.5f) * unit;
        to[3] = 1.0f;
    }
}

enum sf_status sf_hdr_decode(const void *data, size_t size, const char *name, struct sf_image *image,
                             const struct sf_log *log)
{
    struct reader reader = {.at = data, .end = (const unsigned char *)data + size, .name = name, .log = log};
    unsigned char *planes = NULL;
    bool upward = false;
    float exposure;
    enum sf_status status;

    *image = (struct sf_image){0};
    if (size < 2 || memcmp(data, "#?", 2) != 0)
        return fail(&reader, "it is not a Radiance picture");
    status = read_header(&reader, image, &upward, &exposure);
    /* A run of 127 pixels takes at least 8 bytes, and an old run may be longer, but not by much in a sane file. */
    if (status == SF_OK && (uint64_t)image->width * image->height / 1024 > size)
        status = fail(&reader, "it is cut short");
    if (status == SF_OK) {
        planes = malloc((size_t)image->width * 4);
        image->pixels = malloc((size_t)image->width * image->height * 4 * sizeof *image->pixels);
        if (!planes || !image->pixels)
            status = sf_fail(log, SF_ERROR_MEMORY, "cannot read '%s': out of memory", name);
    }
    for (uint32_t y = 0; status == SF_OK && y < image->height; y++) {
        uint32_t row = upward ? image->height - 1 - y : y;

        if (read_pixels(&reader, image->width, planes))
            convert_line(planes, image->width, 1.0f / exposure, image->pixels + (size_t)row * image->width * 4);
        else
            status = fail(&reader, "its Radiance pixels are corrupt or cut short");
    }
    free(planes);
    if (status != SF_OK)
        sf_image_finish(image);
    return status;
}
