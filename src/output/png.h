/* PNG: finished pictures out, 8- and 16-bit pictures in. */
#ifndef SF_OUTPUT_PNG_H
#define SF_OUTPUT_PNG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "output/image.h"

/* Pixels that are already encoded for sRGB (tone.h does so), or numbers that are no colours: 3 or 4 channels (alpha not
 * premultiplied) of 8 or 16 bits, without gaps. */
struct sf_png_frame {
    uint32_t width, height;
    bool numbers;       /* not colours */
    unsigned channels;  /* 3, 4 */
    unsigned bits;      /* 8: pixels are uint8_t; 16: uint16_t, native byte order */
    const void *pixels; /* row by row from the top */
};

/* Writes `path` whole or not at all (base/file.h), colours with an sRGB chunk. The same frame gives the same bytes. Safe from
 * several threads at once. SF_ERROR_USAGE for a frame that cannot be, SF_ERROR_IO, SF_ERROR_MEMORY. */
enum sf_status sf_png_write(const char *path, const struct sf_png_frame *frame, const struct sf_log *log);

/* Reads a whole file from memory: any PNG, to linear floats by its gAMA chunk, or as sRGB when it has an sRGB chunk or
 * neither. Alpha is not premultiplied. `name` is for messages. SF_ERROR_IO: not PNG, corrupt, cut short, over the
 * limits; SF_ERROR_MEMORY. On failure *image is empty. */
enum sf_status sf_png_decode(const void *data, size_t size, const char *name, struct sf_image *image,
                             const struct sf_log *log);
/* The same for numbers that are no colours: 0..1 of the greatest sample, whatever the file says of gamma. */
enum sf_status sf_png_decode_numbers(const void *data, size_t size, const char *name, struct sf_image *image,
                                     const struct sf_log *log);

#endif
