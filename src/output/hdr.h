/* Radiance pictures (.hdr): an RGB float picture with one exponent a pixel, for environment maps. */
#ifndef SF_OUTPUT_HDR_H
#define SF_OUTPUT_HDR_H

#include <stddef.h>
#include "output/image.h"

/* Reads a whole file from memory: 32-bit_rle_rgbe, with or without run lengths (old or new), stored from the top or the
 * bottom. EXPOSURE lines are divided out, so that the numbers are the scene's. `name` is for messages. SF_ERROR_IO: not
 * that format (XYZ included), turned pictures, corrupt, cut short, over the limits; SF_ERROR_MEMORY. On failure *image
 * is empty. */
enum sf_status sf_hdr_decode(const void *data, size_t size, const char *name, struct sf_image *image,
                             const struct sf_log *log);

#endif
