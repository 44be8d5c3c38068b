/* Pictures in files: limits for all of them, and one reader for every format we know. */
#ifndef SF_OUTPUT_IMAGE_H
#define SF_OUTPUT_IMAGE_H

#include <stddef.h>
#include <stdint.h>
#include "base/log.h"

#define SF_IMAGE_SIDE_MAX  32768u            /* width and height, pixels */
#define SF_IMAGE_BYTES_MAX ((size_t)1 << 31) /* of all decoded floats of one picture */
#define SF_IMAGE_FILE_MAX  ((size_t)1 << 31) /* of the file */
#define SF_EXR_CHANNEL_MAX 64                /* channels of one EXR file */

/* RGBA floats, linear, Rec. 709, four to a pixel, row by row from the top. Alpha is 1 where the file has none; colour
 * is as the file has it: premultiplied in EXR, not in PNG. */
struct sf_image {
    uint32_t width, height;
    float *pixels;
};

/* Reads EXR (R, G, B or Y, and A), PNG or Radiance HDR; the file's first bytes tell which. SF_ERROR_IO when it is
 * missing, none of these, corrupt or over the limits; SF_ERROR_MEMORY. On failure *image is empty. */
enum sf_status sf_image_read(const char *path, struct sf_image *image, const struct sf_log *log);
void sf_image_finish(struct sf_image *image);

/* SF_OK when width x height pixels of `floats` floats each are within the limits. */
enum sf_status sf_image_check_size(const char *name, uint64_t width, uint64_t height, size_t floats,
                                   const struct sf_log *log);

#endif
