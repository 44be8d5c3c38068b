/* OpenEXR: frames out, pictures (environment maps, golden frames) in. Scan lines of half and float channels, one part.
 */
#ifndef SF_OUTPUT_EXR_H
#define SF_OUTPUT_EXR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "base/array.h"
#include "base/log.h"

enum sf_exr_compression {
    SF_EXR_NONE,
    SF_EXR_RLE,
    SF_EXR_ZIPS, /* one line at a time */
    SF_EXR_ZIP,  /* 16 lines at a time */
    SF_EXR_PIZ,
    SF_EXR_PXR24, /* keeps 24 bits of a float, all of a half */
    SF_EXR_B44,   /* lossy for halves */
};

/* "none", "rle", "zips", "zip", "piz", "pxr24", "b44"; SF_ERROR_USAGE for others, "dwaa" and "dwab" among them. */
enum sf_status sf_exr_compression_parse(const char *name, enum sf_exr_compression *compression,
                                        const struct sf_log *log);
const char *sf_exr_compression_name(enum sf_exr_compression compression);

enum sf_exr_type { SF_EXR_HALF, SF_EXR_FLOAT };

/* One channel of the frame to write. The strides are bytes from pixel to pixel and from row to row (top row first), so
 * that planes and interleaved pixels both do. From float to half, what lies beyond +-65504 becomes +-65504 (half.h). */
struct sf_exr_channel {
    const char *name; /* "R", "smoke.near"; at most 31 bytes, each name once */
    const void *pixels;
    size_t pixel_stride, row_stride;
    enum sf_exr_type source; /* in memory, native byte order, aligned */
    enum sf_exr_type stored; /* in the file */
};

enum sf_exr_attribute_kind {
    SF_EXR_TEXT,          /* text */
    SF_EXR_NUMBER,        /* values[0] */
    SF_EXR_INTEGER,       /* integer */
    SF_EXR_RATIONAL,      /* integer / denominator */
    SF_EXR_MATRIX,        /* values: 4x4, row by row, for row vectors (point * matrix), as Imath has it */
    SF_EXR_CHROMATICITIES /* values: x and y of red, green, blue, white */
};

struct sf_exr_attribute {
    const char *name; /* at most 31 bytes */
    enum sf_exr_attribute_kind kind;
    const char *text;
    int32_t integer;
    uint32_t denominator;
    float values[16];
};

/* Attributes by value; names and text are borrowed. "capDate" takes "YYYY:MM:DD hh:mm:ss"; leave it out where the same
 * frame must have the same bits. */
struct sf_exr_attribute sf_exr_text(const char *name, const char *text);
struct sf_exr_attribute sf_exr_number(const char *name, float value);
struct sf_exr_attribute sf_exr_integer(const char *name, int32_t value);
/* framesPerSecond, 0 < fps <= 1e6. A rate within 0.005 of n*1000/1001 and not whole (23.976, 29.97) is taken for that
 * NTSC rate; others are the nearest fraction with a denominator of at most 1000. */
struct sf_exr_attribute sf_exr_frames_per_second(double fps);
/* chromaticities of Rec. 709 with white D65. */
struct sf_exr_attribute sf_exr_rec709(void);

/* worldToCamera (left-handed, x right, y up, z forward) of a row-major matrix for column vectors into a right-handed
 * camera space that looks along -z. */
struct sf_exr_attribute sf_exr_world_to_camera(const float matrix[16]);
/* worldToNDC (after division by w, (0,0) is the picture's top left and (1,1) its bottom right corner) of a row-major
 * matrix for column vectors into Vulkan's clip space. */
struct sf_exr_attribute sf_exr_world_to_ndc(const float matrix[16]);

struct sf_exr_frame {
    uint32_t width, height;
    const struct sf_exr_channel *channels;
    size_t channel_count;
    const struct sf_exr_attribute *attributes;
    size_t attribute_count;
    enum sf_exr_compression compression;
};

/* Writes `path` whole or not at all (base/file.h). The same frame gives the same bytes. Safe from several threads at
 * once; uses one. SF_ERROR_USAGE for a frame that cannot be (no pixels, a name twice), SF_ERROR_IO, SF_ERROR_MEMORY. */
enum sf_status sf_exr_write(const char *path, const struct sf_exr_frame *frame, const struct sf_log *log);
/* The same bytes into memory; *data is malloc'ed. */
enum sf_status sf_exr_encode(const struct sf_exr_frame *frame, const struct sf_log *log, unsigned char **data,
                             size_t *size);

/* What was read: planes of floats, row by row from the top, in the file's (alphabetical) order. */
struct sf_exr_plane {
    const char *name;
    enum sf_exr_type stored;
    float *pixels;
};
struct sf_exr {
    uint32_t width, height; /* of the data window */
    struct sf_exr_plane *planes;
    size_t plane_count;
    struct sf_exr_attribute *attributes; /* those of the kinds above */
    size_t attribute_count;
    struct sf_arena arena; /* names and texts */
};

/* Reads the half and float channels named in `wanted` (all of them when it is NULL) of a single-part file of scan lines
 * or tiles (their finest level). SF_ERROR_IO: missing, not EXR, corrupt, cut short, deep, several parts, subsampled,
 * DWA, a wanted channel absent, or over the limits of image.h. On failure *exr is empty. */
enum sf_status sf_exr_read(const char *path, const char *const *wanted, size_t wanted_count, struct sf_exr *exr,
                           const struct sf_log *log);
/* The same from memory; `name` is for messages. */
enum sf_status sf_exr_decode(const void *data, size_t size, const char *name, const char *const *wanted,
                             size_t wanted_count, struct sf_exr *exr, const struct sf_log *log);
/* A plane's pixels, an attribute; NULL when there is none of that name. */
const float *sf_exr_pixels(const struct sf_exr *exr, const char *name);
const struct sf_exr_attribute *sf_exr_attribute(const struct sf_exr *exr, const char *name);
void sf_exr_finish(struct sf_exr *exr);

#endif
