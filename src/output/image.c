#include "output/image.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include "base/file.h"
#include "output/exr.h"
#include "output/hdr.h"
#include "output/png.h"

enum sf_status sf_image_check_size(const char *name, uint64_t width, uint64_t height, size_t floats,
                                   const struct sf_log *log)
{
    if (width == 0 || height == 0)
        return sf_fail(log, SF_ERROR_IO, "cannot read '%s': it has no pixels", name);
    if (width > SF_IMAGE_SIDE_MAX || height > SF_IMAGE_SIDE_MAX ||
        width * height > SF_IMAGE_BYTES_MAX / sizeof(float) / (floats ? floats : 1))
        return sf_fail(log, SF_ERROR_IO, "cannot read '%s': %ju x %ju pixels are over the limit", name,
                       (uintmax_t)width, (uintmax_t)height);
    return SF_OK;
}

/* R, G, B (or Y for all three) and A, of any file that has them. */
static enum sf_status decode_exr(const char *data, size_t size, const char *path, struct sf_image *image,
                                 const struct sf_log *log)
{
    struct sf_exr exr;
    enum sf_status status = sf_exr_decode(data, size, path, NULL, 0, &exr, log);
    const float *channels[4];
    size_t count;

    if (status != SF_OK)
        return status;
    for (int c = 0; c < 4; c++)
        channels[c] = sf_exr_pixels(&exr, (const char *const[]){"R", "G", "B", "A"}[c]);
    if (!channels[0] && !channels[1] && !channels[2])
        channels[0] = channels[1] = channels[2] = sf_exr_pixels(&exr, "Y");
    if (!channels[0] || !channels[1] || !channels[2]) {
        sf_exr_finish(&exr);
        return sf_fail(log, SF_ERROR_IO, "cannot read '%s': it has neither channels R, G, B nor Y", path);
    }
    count = (size_t)exr.width * exr.height;
    status = sf_image_check_size(path, exr.width, exr.height, 4, log);
    image->pixels = status == SF_OK ? malloc(count * 4 * sizeof *image->pixels) : NULL;
    if (image->pixels) {
        image->width = exr.width;
        image->height = exr.height;
        for (size_t i = 0; i < count; i++)
            for (int c = 0; c < 4; c++)
                image->pixels[4 * i + (size_t)c] = channels[c] ? channels[c][i] : 1.0f;
    } else if (status == SF_OK) {
        status = sf_fail(log, SF_ERROR_MEMORY, "cannot read '%s': out of memory", path);
    }
    sf_exr_finish(&exr);
    return status;
}

static bool begins(const char *data, size_t size, const char *with, size_t length)
{
    return size >= length && memcmp(data, with, length) == 0;
}

enum sf_status sf_image_read(const char *path, struct sf_image *image, const struct sf_log *log)
{
    char *data;
    size_t size;
    enum sf_status status = sf_file_read(path, SF_IMAGE_FILE_MAX, log, &data, &size);

    *image = (struct sf_image){0};
    if (status != SF_OK)
        return status;
    if (begins(data, size, "\x76\x2f\x31\x01", 4))
        status = decode_exr(data, size, path, image, log);
    else if (begins(data, size, "\x89PNG\r\n\x1a\n", 8))
        status = sf_png_decode(data, size, path, image, log);
    else if (begins(data, size, "#?", 2))
        status = sf_hdr_decode(data, size, path, image, log);
    else
        status = sf_fail(log, SF_ERROR_IO, "cannot read '%s': it is neither EXR nor PNG nor Radiance HDR", path);
    free(data);
    return status;
}

void sf_image_finish(struct sf_image *image)
{
    if (!image)
        return;
    free(image->pixels);
    *image = (struct sf_image){0};
}
