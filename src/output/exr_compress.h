/* EXR's RLE and ZIP encodings of one chunk. OpenEXRCore has both; these write the same formats in less time (one third
 * for RLE, three quarters for ZIP), because the byte shuffle before them is vectorised and zlib's state is kept from
 * chunk to chunk. */
#ifndef SF_OUTPUT_EXR_COMPRESS_H
#define SF_OUTPUT_EXR_COMPRESS_H

#include <stdbool.h>
#include <stddef.h>

struct sf_exr_compressor;

/* For chunks of at most `chunk_bytes`; `zip` or run lengths. NULL when memory is out. One thread at a time. */
struct sf_exr_compressor *sf_exr_compressor_create(bool zip, size_t chunk_bytes);
void sf_exr_compressor_destroy(struct sf_exr_compressor **compressor);

/* The encoded bytes, the compressor's until the next call; NULL when they would not be fewer than `size` (then the
 * chunk stands in the file as it is: readers tell by the size). */
const unsigned char *sf_exr_compress(struct sf_exr_compressor *compressor, const unsigned char *chunk, size_t size,
                                     size_t *encoded);

#endif
