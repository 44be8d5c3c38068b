#include "output/png.h"

#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include "base/file.h"
#include "output/tone.h"

/* zlib's level: pictures for looking at need not be small, but soon there. */
enum { LEVEL = 3, MESSAGE_BYTES = 160, DEFLATE_FACTOR_MAX = 1040 };

/* What libpng's callbacks share. It leaves a failing call by longjmp; nothing that must be freed lives in the frames
 * jumped over. */
struct session {
    jmp_buf escape;
    char message[MESSAGE_BYTES];
    enum sf_status status; /* of a failed write that was already logged */
    const struct sf_log *log;
    struct sf_file_writer *writer;
    uint64_t offset;
    const unsigned char *data;
    size_t left;
    unsigned char *rows; /* decoded pixels of 16 bits, big-endian, four channels */
};

static void on_error(png_structp png, png_const_charp message)
{
    struct session *session = png_get_error_ptr(png);

    strncat(session->message, message, sizeof session->message - 1);
    longjmp(session->escape, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static void on_write(png_structp png, png_bytep bytes, png_size_t size)
{
    struct session *session = png_get_io_ptr(png);

    session->status = sf_file_writer_write(session->writer, bytes, size, session->offset, session->log);
    if (session->status != SF_OK)
        png_error(png, "write failed");
    session->offset += size;
}

static void on_flush(png_structp png)
{
    (void)png;
}

static void on_read(png_structp png, png_bytep bytes, png_size_t size)
{
    struct session *session = png_get_io_ptr(png);

    if (size > session->left)
        png_error(png, "the file is cut short");
    memcpy(bytes, session->data, size);
    session->data += size;
    session->left -= size;
}

static bool little_endian(void)
{
    const uint16_t one = 1;

    return *(const unsigned char *)&one == 1;
}

/* Everything that may jump. True when the whole picture is written. */
static bool write_rows(png_structp png, png_infop info, const struct sf_png_frame *frame, struct session *session)
{
    size_t stride = (size_t)frame->width * frame->channels * (frame->bits / 8);

    if (setjmp(session->escape))
        return false;
    png_set_write_fn(png, session, on_write, on_flush);
    png_set_user_limits(png, SF_IMAGE_SIDE_MAX, SF_IMAGE_SIDE_MAX);
    png_set_compression_level(png, LEVEL);
    png_set_compression_buffer_size(png, 1 << 16);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_set_IHDR(png, info, frame->width, frame->height, (int)frame->bits,
                 frame->channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (!frame->numbers)
        png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png, info);
    if (frame->bits == 16 && little_endian())
        png_set_swap(png);
    for (uint32_t y = 0; y < frame->height; y++)
        png_write_row(png, (png_const_bytep)frame->pixels + y * stride);
    png_write_end(png, info);
    return true;
}

enum sf_status sf_png_write(const char *path, const struct sf_png_frame *frame, const struct sf_log *log)
{
    struct sf_file_writer writer;
    struct session session = {.log = log, .writer = &writer, .status = SF_OK};
    png_structp png;
    png_infop info;
    enum sf_status status;

    if (frame->width == 0 || frame->height == 0 || frame->width > SF_IMAGE_SIDE_MAX ||
        frame->height > SF_IMAGE_SIDE_MAX || (frame->channels != 3 && frame->channels != 4) ||
        (frame->bits != 8 && frame->bits != 16))
        return sf_fail(log, SF_ERROR_USAGE, "cannot write '%s': a picture of %ux%u pixels, %u channels of %u bits",
                       path, (unsigned)frame->width, (unsigned)frame->height, frame->channels, frame->bits);
    status = sf_file_writer_open(&writer, path, log);
    if (status != SF_OK)
        return status;
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &session, on_error, on_warning);
    info = png ? png_create_info_struct(png) : NULL;
    if (!info)
        status = sf_fail(log, SF_ERROR_MEMORY, "cannot write '%s': out of memory", path);
    else if (!write_rows(png, info, frame, &session))
        status = session.status != SF_OK ? session.status
                                         : sf_fail(log, SF_ERROR_IO, "cannot write '%s': %s", path, session.message);
    png_destroy_write_struct(&png, &info);
    if (status == SF_OK)
        status = sf_file_writer_commit(&writer, log);
    sf_file_writer_abort(&writer);
    return status;
}

/* How the file's samples become light: an exponent, or 0 for sRGB's curve. */
static double file_gamma(png_const_structp png, png_const_infop info)
{
    double gamma;

    if (png_get_valid(png, info, PNG_INFO_sRGB) || png_get_gAMA(png, info, &gamma) == 0)
        return 0.0;
    return gamma > 0.01 && gamma < 100.0 ? 1.0 / gamma : 0.0;
}

/* Everything that may jump: fills session->rows. The size is in `image`, its limits checked. */
static bool read_rows(png_structp png, png_infop info, struct sf_image *image, struct session *session, double *gamma,
                      enum sf_status *status, const char *name)
{
    uint64_t smallest;

    if (setjmp(session->escape))
        return false;
    png_set_read_fn(png, session, on_read);
    png_set_user_limits(png, SF_IMAGE_SIDE_MAX, SF_IMAGE_SIDE_MAX);
    png_set_chunk_malloc_max(png, 1 << 24);
    png_read_info(png, info);
    image->width = png_get_image_width(png, info);
    image->height = png_get_image_height(png, info);
    *status = sf_image_check_size(name, image->width, image->height, 4, session->log);
    if (*status != SF_OK)
        return true;
    /* No deflate stream grows by more: a tiny file with a vast header is refused before its memory is asked for. */
    smallest = (uint64_t)png_get_rowbytes(png, info) * image->height / DEFLATE_FACTOR_MAX;
    if (smallest > session->left)
        png_error(png, "the file is cut short");
    *gamma = file_gamma(png, info);
    png_set_expand_16(png); /* palettes, grey below 8 bits and transparent colours too */
    png_set_gray_to_rgb(png);
    png_set_add_alpha(png, 0xFFFF, PNG_FILLER_AFTER);
    int passes = png_set_interlace_handling(png);
    png_read_update_info(png, info);
    if (png_get_rowbytes(png, info) != (size_t)image->width * 8)
        png_error(png, "an unexpected layout of pixels");
    session->rows = malloc((size_t)image->width * image->height * 8);
    if (!session->rows) {
        *status = sf_fail(session->log, SF_ERROR_MEMORY, "cannot read '%s': out of memory", name);
        return true;
    }
    for (int pass = 0; pass < passes; pass++)
        for (uint32_t y = 0; y < image->height; y++)
            png_read_row(png, session->rows + (size_t)y * image->width * 8, NULL);
    png_read_end(png, NULL);
    return true;
}

static enum sf_status convert(const struct session *session, double gamma, const char *name, struct sf_image *image)
{
    size_t count = (size_t)image->width * image->height * 4;
    float *curve = malloc(65536 * sizeof *curve);

    image->pixels = malloc(count * sizeof *image->pixels);
    if (!image->pixels || !curve) {
        free(curve);
        return sf_fail(session->log, SF_ERROR_MEMORY, "cannot read '%s': out of memory", name);
    }
    for (unsigned i = 0; i < 65536; i++) {
        double value = i / 65535.0;

        curve[i] = (float)(gamma > 0.0 ? pow(value, gamma) : sf_srgb_decode(value));
    }
    for (size_t i = 0; i < count; i++) {
        unsigned value = (unsigned)session->rows[2 * i] << 8 | session->rows[2 * i + 1];

        image->pixels[i] = i % 4 == 3 ? (float)value / 65535.0f : curve[value];
    }
    free(curve);
    return SF_OK;
}

static enum sf_status decode(const void *data, size_t size, const char *name, bool numbers, struct sf_image *image,
                             const struct sf_log *log)
{
    struct session session = {.log = log, .data = data, .left = size};
    enum sf_status status = SF_OK;
    double gamma = 0.0;
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &session, on_error, on_warning);
    png_infop info = png ? png_create_info_struct(png) : NULL;

    *image = (struct sf_image){0};
    if (!info)
        status = sf_fail(log, SF_ERROR_MEMORY, "cannot read '%s': out of memory", name);
    else if (!read_rows(png, info, image, &session, &gamma, &status, name))
        status = sf_fail(log, SF_ERROR_IO, "cannot read '%s': not a sound PNG file: %s", name, session.message);
    png_destroy_read_struct(&png, &info, NULL);
    if (status == SF_OK)
        status = convert(&session, numbers ? 1.0 : gamma, name, image);
    free(session.rows);
    if (status != SF_OK)
        sf_image_finish(image);
    return status;
}

enum sf_status sf_png_decode(const void *data, size_t size, const char *name, struct sf_image *image,
                             const struct sf_log *log)
{
    return decode(data, size, name, false, image, log);
}

enum sf_status sf_png_decode_numbers(const void *data, size_t size, const char *name, struct sf_image *image,
                                     const struct sf_log *log)
{
    return decode(data, size, name, true, image, log);
}
