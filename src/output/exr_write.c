#include "output/exr.h"

#include <openexr.h>
#include <stdlib.h>
#include <string.h>
#include "base/file.h"
#include "output/exr_compress.h"
#include "output/half.h"
#include "output/image.h"

enum { BUFFER_BYTES = 1 << 18, MESSAGE_BYTES = 256 };

static const struct {
    const char *name;
    exr_compression_t core;
} compressions[] = {
    [SF_EXR_NONE] = {"none", EXR_COMPRESSION_NONE}, [SF_EXR_RLE] = {"rle", EXR_COMPRESSION_RLE},
    [SF_EXR_ZIPS] = {"zips", EXR_COMPRESSION_ZIPS}, [SF_EXR_ZIP] = {"zip", EXR_COMPRESSION_ZIP},
    [SF_EXR_PIZ] = {"piz", EXR_COMPRESSION_PIZ},    [SF_EXR_PXR24] = {"pxr24", EXR_COMPRESSION_PXR24},
    [SF_EXR_B44] = {"b44", EXR_COMPRESSION_B44},
};

enum sf_status sf_exr_compression_parse(const char *name, enum sf_exr_compression *compression,
                                        const struct sf_log *log)
{
    for (size_t i = 0; i < SF_COUNT(compressions); i++) {
        if (strcmp(name, compressions[i].name) == 0) {
            *compression = (enum sf_exr_compression)i;
            return SF_OK;
        }
    }
    if (strcmp(name, "dwaa") == 0 || strcmp(name, "dwab") == 0)
        return sf_fail(log, SF_ERROR_USAGE,
                       "EXR compression '%s' is not available: OpenEXRCore cannot write it; try pxr24 or b44", name);
    return sf_fail(log, SF_ERROR_USAGE, "unknown EXR compression '%.64s': none, rle, zips, zip, piz, pxr24 or b44",
                   name);
}

const char *sf_exr_compression_name(enum sf_exr_compression compression)
{
    return compressions[compression].name;
}

/* Where the bytes go: a file through a buffer, or memory. The library writes in order but for the table of chunks, at
 * the end. */
struct sink {
    const struct sf_file_writer *writer; /* NULL: memory */
    const struct sf_log *log;
    unsigned char *data; /* the buffer, or all of it */
    size_t size, capacity;
    uint64_t start; /* the buffer's place in the file */
    enum sf_status status;
    char message[MESSAGE_BYTES]; /* the library's first error */
};

struct encoder {
    struct sink sink;
    const struct sf_exr_frame *frame;
    const struct sf_exr_channel **order;                       /* the frame's channels as the file sorts them */
    struct sf_exr_compressor *compressor;                      /* for RLE, ZIPS and ZIP; NULL: */
    exr_result_t (*compress)(exr_encode_pipeline_t *pipeline); /* the library's way */
};

static void sink_flush(struct sink *sink)
{
    if (sink->size > 0 && sink->status == SF_OK)
        sink->status = sf_file_writer_write(sink->writer, sink->data, sink->size, sink->start, sink->log);
    sink->size = 0;
}

static void sink_write_file(struct sink *sink, const void *bytes, size_t size, uint64_t offset)
{
    if (offset != sink->start + sink->size || size > sink->capacity - sink->size) {
        sink_flush(sink);
        sink->start = offset;
    }
    if (size > sink->capacity) {
        if (sink->status == SF_OK)
            sink->status = sf_file_writer_write(sink->writer, bytes, size, offset, sink->log);
        sink->start = offset + size;
        return;
    }
    memcpy(sink->data + sink->size, bytes, size);
    sink->size += size;
}

static void sink_write_memory(struct sink *sink, const void *bytes, size_t size, uint64_t offset)
{
    size_t end = (size_t)offset + size;

    if (offset > SIZE_MAX / 2 || size > SIZE_MAX / 2 ||
        (end > sink->size &&
         !sf_array_reserve((void **)&sink->data, sink->size, &sink->capacity, end - sink->size, 1))) {
        sink->status = SF_ERROR_MEMORY;
        return;
    }
    if (offset > sink->size)
        memset(sink->data + sink->size, 0, (size_t)offset - sink->size);
    memcpy(sink->data + offset, bytes, size);
    if (end > sink->size)
        sink->size = end;
}

static int64_t write_bytes(exr_const_context_t context, void *user, const void *bytes, uint64_t size, uint64_t offset,
                           exr_stream_error_func_ptr_t error)
{
    struct sink *sink = &((struct encoder *)user)->sink;

    (void)context;
    (void)error;
    if (sink->writer)
        sink_write_file(sink, bytes, (size_t)size, offset);
    else
        sink_write_memory(sink, bytes, (size_t)size, offset);
    return sink->status == SF_OK ? (int64_t)size : -1;
}

/* Where the library's error handler, called on the failing thread, puts the first message. The handler cannot ask the
 * context for its user data: the library calls it with the context's lock held, and would wait for itself. */
static _Thread_local char *message_place;

static void note_error(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context;
    (void)code;
    if (message_place && !message_place[0] && message)
        strncat(message_place, message, MESSAGE_BYTES - 1);
}

/* Copies 16- or 32-bit words to little-endian order; one loop for each size, so that the compiler has a simple one. */
static void copy_words16(const unsigned char *from, size_t stride, size_t count, unsigned char *to)
{
    for (size_t i = 0; i < count; i++) {
        uint16_t word;

        memcpy(&word, from + i * stride, sizeof word);
        to[2 * i] = (unsigned char)word;
        to[2 * i + 1] = (unsigned char)(word >> 8);
    }
}

static void store_le32(unsigned char *to, uint32_t word)
{
    to[0] = (unsigned char)word;
    to[1] = (unsigned char)(word >> 8);
    to[2] = (unsigned char)(word >> 16);
    to[3] = (unsigned char)(word >> 24);
}

static void copy_words32(const unsigned char *from, size_t stride, size_t count, unsigned char *to)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t word;

        memcpy(&word, from + i * stride, sizeof word);
        store_le32(to + 4 * i, word);
    }
}

static void widen_halves(const unsigned char *from, size_t stride, size_t count, unsigned char *to)
{
    for (size_t i = 0; i < count; i++) {
        uint16_t half;
        uint32_t word;
        float value;

        memcpy(&half, from + i * stride, sizeof half);
        value = sf_half_to_float(half);
        memcpy(&word, &value, sizeof word);
        store_le32(to + 4 * i, word);
    }
}

/* One line of one channel as the file wants it, little-endian at an unaligned place. Returns its end. */
static unsigned char *pack_row(const struct sf_exr_channel *channel, uint32_t row, uint32_t width, unsigned char *to)
{
    const unsigned char *from = (const unsigned char *)channel->pixels + (size_t)row * channel->row_stride;
    size_t stride = channel->pixel_stride;

    if (channel->stored == SF_EXR_HALF) {
        if (channel->source == SF_EXR_FLOAT)
            sf_half_row(from, stride, width, to);
        else
            copy_words16(from, stride, width, to);
        return to + (size_t)width * 2;
    }
    if (channel->source == SF_EXR_FLOAT)
        copy_words32(from, stride, width, to);
    else
        widen_halves(from, stride, width, to);
    return to + (size_t)width * 4;
}

static exr_result_t pack_chunk(exr_encode_pipeline_t *pipeline)
{
    const struct encoder *encoder = pipeline->encoding_user_data;
    unsigned char *to = pipeline->packed_buffer;

    for (int32_t y = 0; y < pipeline->chunk.height; y++)
        for (int c = 0; c < pipeline->channel_count; c++)
            to = pack_row(encoder->order[c], (uint32_t)(pipeline->chunk.start_y + y), encoder->frame->width, to);
    pipeline->packed_bytes = (uint64_t)(to - (unsigned char *)pipeline->packed_buffer);
    return EXR_ERR_SUCCESS;
}

static exr_result_t compress_chunk(exr_encode_pipeline_t *pipeline)
{
    struct encoder *encoder = pipeline->encoding_user_data;
    exr_result_t result;

    if (encoder->compressor) {
        size_t size;
        const unsigned char *bytes =
            sf_exr_compress(encoder->compressor, pipeline->packed_buffer, (size_t)pipeline->packed_bytes, &size);

        /* Lent to the pipeline: an allocation size of 0 keeps it from freeing them. */
        pipeline->compressed_buffer = bytes ? (void *)(uintptr_t)bytes : pipeline->packed_buffer;
        pipeline->compressed_bytes = size;
        pipeline->compressed_alloc_size = 0;
        return EXR_ERR_SUCCESS;
    }
    /* A chunk as long after compression as before is taken for uncompressed by every reader (but for B44); the library
     * (3.1.5) does not guard against that. */
    result = encoder->compress(pipeline);
    if (result == EXR_ERR_SUCCESS && pipeline->compressed_bytes == pipeline->packed_bytes &&
        pipeline->compressed_buffer != pipeline->packed_buffer && encoder->frame->compression != SF_EXR_B44)
        memcpy(pipeline->compressed_buffer, pipeline->packed_buffer, (size_t)pipeline->packed_bytes);
    return result;
}

static exr_result_t set_attribute(exr_context_t context, const struct sf_exr_attribute *a)
{
    exr_attr_m44f_t matrix;
    exr_attr_chromaticities_t colours;
    exr_attr_rational_t rational = {.num = a->integer, .denom = a->denominator};

    switch (a->kind) {
    case SF_EXR_TEXT:
        return exr_attr_set_string(context, 0, a->name, a->text);
    case SF_EXR_NUMBER:
        return exr_attr_set_float(context, 0, a->name, a->values[0]);
    case SF_EXR_INTEGER:
        return exr_attr_set_int(context, 0, a->name, a->integer);
    case SF_EXR_RATIONAL:
        return exr_attr_set_rational(context, 0, a->name, &rational);
    case SF_EXR_MATRIX:
        memcpy(matrix.m, a->values, sizeof matrix.m);
        return exr_attr_set_m44f(context, 0, a->name, &matrix);
    case SF_EXR_CHROMATICITIES:
        memcpy(&colours, a->values, sizeof colours);
        return exr_attr_set_chromaticities(context, 0, a->name, &colours);
    }
    return EXR_ERR_INVALID_ARGUMENT;
}

static exr_result_t write_header(exr_context_t context, const struct sf_exr_frame *frame)
{
    exr_result_t result = exr_add_part(context, NULL, EXR_STORAGE_SCANLINE, NULL);

    if (result == EXR_ERR_SUCCESS)
        result = exr_initialize_required_attr_simple(context, 0, (int32_t)frame->width, (int32_t)frame->height,
                                                     compressions[frame->compression].core);
    for (size_t i = 0; i < frame->channel_count && result == EXR_ERR_SUCCESS; i++)
        result = exr_add_channel(context, 0, frame->channels[i].name,
                                 frame->channels[i].stored == SF_EXR_HALF ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT,
                                 EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    for (size_t i = 0; i < frame->attribute_count && result == EXR_ERR_SUCCESS; i++)
        result = set_attribute(context, &frame->attributes[i]);
    return result == EXR_ERR_SUCCESS ? exr_write_header(context) : result;
}

/* Gives each of the pipeline's channels its source. The library looks at these, though the packing is ours. */
static exr_result_t connect_channels(struct encoder *encoder, exr_encode_pipeline_t *pipeline)
{
    const struct sf_exr_frame *frame = encoder->frame;

    for (int c = 0; c < pipeline->channel_count; c++) {
        exr_coding_channel_info_t *info = &pipeline->channels[c];

        encoder->order[c] = NULL;
        for (size_t i = 0; i < frame->channel_count && !encoder->order[c]; i++)
            if (strcmp(frame->channels[i].name, info->channel_name) == 0)
                encoder->order[c] = &frame->channels[i];
        if (!encoder->order[c])
            return EXR_ERR_INVALID_ARGUMENT;
        info->encode_from_ptr = encoder->order[c]->pixels;
        info->user_pixel_stride = info->bytes_per_element;
        info->user_line_stride = info->bytes_per_element * info->width;
    }
    return EXR_ERR_SUCCESS;
}

/* Sets the pipeline up for the first chunk. */
static exr_result_t start_pipeline(struct encoder *encoder, exr_context_t context, const exr_chunk_info_t *chunk,
                                   exr_encode_pipeline_t *pipeline)
{
    enum sf_exr_compression compression = encoder->frame->compression;
    exr_result_t result = exr_encoding_initialize(context, 0, chunk, pipeline);

    if (result == EXR_ERR_SUCCESS)
        result = connect_channels(encoder, pipeline);
    if (result == EXR_ERR_SUCCESS)
        result = exr_encoding_choose_default_routines(context, 0, pipeline);
    if (result != EXR_ERR_SUCCESS)
        return result;
    pipeline->encoding_user_data = encoder;
    pipeline->convert_and_pack_fn = pack_chunk;
    encoder->compress = pipeline->compress_fn;
    if (compression != SF_EXR_NONE)
        pipeline->compress_fn = compress_chunk;
    if (compression == SF_EXR_RLE || compression == SF_EXR_ZIPS || compression == SF_EXR_ZIP) {
        encoder->compressor = sf_exr_compressor_create(compression != SF_EXR_RLE, (size_t)chunk->unpacked_size);
        if (!encoder->compressor)
            return EXR_ERR_OUT_OF_MEMORY;
    }
    return EXR_ERR_SUCCESS;
}

static exr_result_t write_chunks(struct encoder *encoder, exr_context_t context)
{
    exr_encode_pipeline_t pipeline = {0};
    int32_t lines = 1, height = (int32_t)encoder->frame->height;
    exr_result_t result = exr_get_scanlines_per_chunk(context, 0, &lines);

    for (int32_t y = 0; y < height && result == EXR_ERR_SUCCESS; y += lines) {
        exr_chunk_info_t chunk;

        result = exr_write_scanline_chunk_info(context, 0, y, &chunk);
        if (result == EXR_ERR_SUCCESS)
            result = y == 0 ? start_pipeline(encoder, context, &chunk, &pipeline)
                            : exr_encoding_update(context, 0, &chunk, &pipeline);
        if (result == EXR_ERR_SUCCESS)
            result = exr_encoding_run(context, 0, &pipeline);
    }
    exr_encoding_destroy(context, &pipeline);
    sf_exr_compressor_destroy(&encoder->compressor);
    return result;
}

static enum sf_status check_frame(const struct sf_exr_frame *frame, const char *name, const struct sf_log *log)
{
    if (frame->width == 0 || frame->height == 0 || frame->width > SF_IMAGE_SIDE_MAX ||
        frame->height > SF_IMAGE_SIDE_MAX)
        return sf_fail(log, SF_ERROR_USAGE, "cannot write '%s': %ux%u pixels is no size for a frame", name,
                       (unsigned)frame->width, (unsigned)frame->height);
    if (frame->channel_count == 0 || frame->channel_count > SF_EXR_CHANNEL_MAX)
        return sf_fail(log, SF_ERROR_USAGE, "cannot write '%s': %zu channels", name, frame->channel_count);
    for (size_t i = 0; i < frame->channel_count; i++)
        for (size_t j = 0; j < i; j++)
            if (strcmp(frame->channels[i].name, frame->channels[j].name) == 0)
                return sf_fail(log, SF_ERROR_USAGE, "cannot write '%s': channel '%s' comes twice", name,
                               frame->channels[i].name);
    return SF_OK;
}

static enum sf_status status_of(exr_result_t result)
{
    switch (result) {
    case EXR_ERR_SUCCESS:
        return SF_OK;
    case EXR_ERR_OUT_OF_MEMORY:
        return SF_ERROR_MEMORY;
    case EXR_ERR_INVALID_ARGUMENT:
    case EXR_ERR_ARGUMENT_OUT_OF_RANGE:
    case EXR_ERR_NAME_TOO_LONG:
    case EXR_ERR_INVALID_ATTR:
    case EXR_ERR_ATTR_TYPE_MISMATCH:
        return SF_ERROR_USAGE;
    default:
        return SF_ERROR_IO;
    }
}

/* Encodes into the prepared sink. */
static enum sf_status encode(struct encoder *encoder, const char *name, const struct sf_log *log)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    struct sink *sink = &encoder->sink;
    const struct sf_exr_channel *order[SF_EXR_CHANNEL_MAX];
    exr_context_t context = NULL;
    exr_result_t result, finished;

    encoder->order = order;
    init.user_data = encoder;
    init.write_fn = write_bytes;
    init.error_handler_fn = note_error;
    message_place = sink->message;
    result = exr_start_write(&context, name, EXR_WRITE_FILE_DIRECTLY, &init);
    if (result == EXR_ERR_SUCCESS)
        result = write_header(context, encoder->frame);
    if (result == EXR_ERR_SUCCESS)
        result = write_chunks(encoder, context);
    if (context) {
        finished = exr_finish(&context); /* writes the table of chunks */
        if (result == EXR_ERR_SUCCESS)
            result = finished;
    }
    message_place = NULL;
    if (sink->writer)
        sink_flush(sink);
    if (sink->status == SF_ERROR_MEMORY)
        return sf_fail(log, SF_ERROR_MEMORY, "cannot write '%s': out of memory", name);
    if (sink->status != SF_OK)
        return sink->status; /* the file writer has said why */
    if (result != EXR_ERR_SUCCESS)
        return sf_fail(log, status_of(result), "cannot write '%s': %s", name,
                       sink->message[0] ? sink->message : exr_get_default_error_message(result));
    return SF_OK;
}

enum sf_status sf_exr_write(const char *path, const struct sf_exr_frame *frame, const struct sf_log *log)
{
    struct sf_file_writer writer;
    struct encoder encoder = {.frame = frame, .sink = {.writer = &writer, .log = log, .capacity = BUFFER_BYTES}};
    enum sf_status status = check_frame(frame, path, log);

    if (status != SF_OK)
        return status;
    encoder.sink.data = malloc(BUFFER_BYTES);
    if (!encoder.sink.data)
        return sf_fail(log, SF_ERROR_MEMORY, "cannot write '%s': out of memory", path);
    status = sf_file_writer_open(&writer, path, log);
    if (status == SF_OK)
        status = encode(&encoder, path, log);
    if (status == SF_OK)
        status = sf_file_writer_commit(&writer, log);
    sf_file_writer_abort(&writer);
    free(encoder.sink.data);
    return status;
}

enum sf_status sf_exr_encode(const struct sf_exr_frame *frame, const struct sf_log *log, unsigned char **data,
                             size_t *size)
{
    struct encoder encoder = {.frame = frame, .sink = {.log = log}};
    enum sf_status status = check_frame(frame, "(memory)", log);

    *data = NULL;
    *size = 0;
    if (status == SF_OK)
        status = encode(&encoder, "(memory)", log);
    if (status != SF_OK) {
        free(encoder.sink.data);
        return status;
    }
    *data = encoder.sink.data;
    *size = encoder.sink.size;
    return SF_OK;
}
