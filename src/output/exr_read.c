#include "output/exr.h"

#include <openexr.h>
#include <stdlib.h>
#include <string.h>
#include "base/file.h"
#include "output/half.h"
#include "output/image.h"

enum { MESSAGE_BYTES = 256, ATTRIBUTES_MAX = 1024 };

struct decoder {
    const unsigned char *data;
    size_t size;
    const char *name;
    const struct sf_log *log;
    struct sf_exr *exr;
    struct sf_exr_plane *by_channel[SF_EXR_CHANNEL_MAX]; /* the plane of each channel in the file; NULL: not wanted */
    int32_t left, top;                                   /* of the data window */
    uint32_t x, y;                                       /* of the chunk, within the data window */
    char message[MESSAGE_BYTES];                         /* the library's first error */
};

static int64_t read_bytes(exr_const_context_t context, void *user, void *bytes, uint64_t size, uint64_t offset,
                          exr_stream_error_func_ptr_t error)
{
    const struct decoder *decoder = user;

    (void)context;
    (void)error;
    if (offset > decoder->size)
        return -1;
    if (size > decoder->size - offset)
        size = decoder->size - offset;
    memcpy(bytes, decoder->data + offset, (size_t)size);
    return (int64_t)size;
}

static int64_t query_size(exr_const_context_t context, void *user)
{
    (void)context;
    return (int64_t)((const struct decoder *)user)->size;
}

/* Where the library's error handler, called on the failing thread, puts the first message (see exr_write.c). */
static _Thread_local char *message_place;

static void note_error(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context;
    (void)code;
    if (message_place && !message_place[0] && message)
        strncat(message_place, message, MESSAGE_BYTES - 1);
}

static enum sf_status fail(const struct decoder *decoder, const char *why)
{
    return sf_fail(decoder->log, SF_ERROR_IO, "cannot read '%s': %s", decoder->name, why);
}

static enum sf_status fail_memory(const struct decoder *decoder)
{
    return sf_fail(decoder->log, SF_ERROR_MEMORY, "cannot read '%s': out of memory", decoder->name);
}

/* A refusal of the library's. */
static enum sf_status fail_core(const struct decoder *decoder, exr_result_t result)
{
    if (result == EXR_ERR_OUT_OF_MEMORY)
        return fail_memory(decoder);
    return sf_fail(decoder->log, SF_ERROR_IO, "cannot read '%s': not a sound OpenEXR file: %s", decoder->name,
                   decoder->message[0] ? decoder->message : exr_get_default_error_message(result));
}

static bool is_wanted(const char *name, const char *const *wanted, size_t wanted_count)
{
    if (!wanted)
        return true;
    for (size_t i = 0; i < wanted_count; i++)
        if (strcmp(wanted[i], name) == 0)
            return true;
    return false;
}

/* Makes a plane for each wanted channel of the file. */
static enum sf_status make_planes(struct decoder *decoder, const exr_attr_chlist_t *channels, const char *const *wanted,
                                  size_t wanted_count)
{
    struct sf_exr *exr = decoder->exr;

    exr->planes = sf_arena_alloc(&exr->arena, (size_t)channels->num_channels * sizeof *exr->planes);
    if (!exr->planes)
        return fail_memory(decoder);
    for (int c = 0; c < channels->num_channels; c++) {
        const exr_attr_chlist_entry_t *entry = &channels->entries[c];
        struct sf_exr_plane *plane = &exr->planes[exr->plane_count];

        if (entry->x_sampling != 1 || entry->y_sampling != 1)
            return fail(decoder, "it has subsampled channels");
        if (!is_wanted(entry->name.str, wanted, wanted_count) || (!wanted && entry->pixel_type == EXR_PIXEL_UINT))
            continue;
        if (entry->pixel_type == EXR_PIXEL_UINT)
            return sf_fail(decoder->log, SF_ERROR_IO, "cannot read '%s': channel '%s' holds integers", decoder->name,
                           entry->name.str);
        plane->name = sf_arena_strdup(&exr->arena, entry->name.str);
        plane->stored = entry->pixel_type == EXR_PIXEL_HALF ? SF_EXR_HALF : SF_EXR_FLOAT;
        plane->pixels = calloc((size_t)exr->width * exr->height, sizeof *plane->pixels);
        exr->plane_count++;
        if (!plane->name || !plane->pixels)
            return fail_memory(decoder);
        decoder->by_channel[c] = plane;
    }
    for (size_t i = 0; i < wanted_count && wanted; i++)
        if (!sf_exr_pixels(exr, wanted[i]))
            return sf_fail(decoder->log, SF_ERROR_IO, "cannot read '%s': it has no channel '%s'", decoder->name,
                           wanted[i]);
    return SF_OK;
}

/* Copies an attribute if it is of a kind that we know. False when memory is out. */
static bool copy_attribute(struct sf_exr *exr, const exr_attribute_t *from)
{
    struct sf_exr_attribute to = {.denominator = 1};

    switch (from->type) {
    case EXR_ATTR_STRING:
        to.kind = SF_EXR_TEXT;
        to.text =
            sf_arena_printf(&exr->arena, "%.*s", from->string->length, from->string->str ? from->string->str : "");
        if (!to.text)
            return false;
        break;
    case EXR_ATTR_FLOAT:
        to.kind = SF_EXR_NUMBER;
        to.values[0] = from->f;
        break;
    case EXR_ATTR_INT:
        to.kind = SF_EXR_INTEGER;
        to.integer = from->i;
        break;
    case EXR_ATTR_RATIONAL:
        to.kind = SF_EXR_RATIONAL;
        to.integer = from->rational->num;
        to.denominator = from->rational->denom;
        break;
    case EXR_ATTR_M44F:
        to.kind = SF_EXR_MATRIX;
        memcpy(to.values, from->m44f->m, sizeof from->m44f->m);
        break;
    case EXR_ATTR_CHROMATICITIES:
        to.kind = SF_EXR_CHROMATICITIES;
        memcpy(to.values, from->chromaticities, sizeof *from->chromaticities);
        break;
    default:
        return true;
    }
    to.name = sf_arena_strdup(&exr->arena, from->name);
    if (!to.name)
        return false;
    exr->attributes[exr->attribute_count++] = to;
    return true;
}

static enum sf_status read_attributes(struct decoder *decoder, exr_context_t context)
{
    struct sf_exr *exr = decoder->exr;
    int32_t count = 0;
    exr_result_t result = exr_get_attribute_count(context, 0, &count);

    if (result != EXR_ERR_SUCCESS)
        return fail_core(decoder, result);
    if (count > ATTRIBUTES_MAX)
        return fail(decoder, "it has more than 1024 attributes");
    exr->attributes = sf_arena_alloc(&exr->arena, (size_t)count * sizeof *exr->attributes);
    if (!exr->attributes)
        return fail_memory(decoder);
    for (int32_t i = 0; i < count; i++) {
        const exr_attribute_t *attribute;

        result = exr_get_attribute_by_index(context, 0, EXR_ATTR_LIST_SORTED_ORDER, i, &attribute);
        if (result != EXR_ERR_SUCCESS)
            return fail_core(decoder, result);
        if (!copy_attribute(exr, attribute))
            return fail_memory(decoder);
    }
    return SF_OK;
}

/* Looks at the header, refuses what we do not read, makes the planes. */
static enum sf_status read_header(struct decoder *decoder, exr_context_t context, const char *const *wanted,
                                  size_t wanted_count, exr_storage_t *storage, exr_compression_t *compression)
{
    struct sf_exr *exr = decoder->exr;
    const exr_attr_chlist_t *channels = NULL;
    exr_attr_box2i_t window;
    int parts = 0;
    exr_result_t result = exr_get_count(context, &parts);
    enum sf_status status;
    int64_t width, height;

    if (result == EXR_ERR_SUCCESS && parts != 1)
        return fail(decoder, "it has several parts");
    if (result == EXR_ERR_SUCCESS)
        result = exr_get_storage(context, 0, storage);
    if (result == EXR_ERR_SUCCESS)
        result = exr_get_compression(context, 0, compression);
    if (result == EXR_ERR_SUCCESS)
        result = exr_get_data_window(context, 0, &window);
    if (result == EXR_ERR_SUCCESS)
        result = exr_get_channels(context, 0, &channels);
    if (result != EXR_ERR_SUCCESS)
        return fail_core(decoder, result);
    if (*storage != EXR_STORAGE_SCANLINE && *storage != EXR_STORAGE_TILED)
        return fail(decoder, "it holds deep data");
    if (*compression == EXR_COMPRESSION_DWAA || *compression == EXR_COMPRESSION_DWAB)
        return fail(decoder, "its compression (DWA) is not available");
    if (channels->num_channels < 1 || channels->num_channels > SF_EXR_CHANNEL_MAX)
        return sf_fail(decoder->log, SF_ERROR_IO, "cannot read '%s': %d channels (1 to %d can be)", decoder->name,
                       channels->num_channels, SF_EXR_CHANNEL_MAX);
    width = (int64_t)window.max.x - window.min.x + 1;
    height = (int64_t)window.max.y - window.min.y + 1;
    if (width < 1 || height < 1)
        return fail(decoder, "its data window is empty");
    status = sf_image_check_size(decoder->name, (uint64_t)width, (uint64_t)height, (size_t)channels->num_channels,
                                 decoder->log);
    if (status != SF_OK)
        return status;
    exr->width = (uint32_t)width;
    exr->height = (uint32_t)height;
    decoder->left = window.min.x;
    decoder->top = window.min.y;
    status = read_attributes(decoder, context);
    return status == SF_OK ? make_planes(decoder, channels, wanted, wanted_count) : status;
}

static float load_value(const unsigned char *from, enum sf_exr_type type)
{
    uint32_t bits = (uint32_t)from[0] | (uint32_t)from[1] << 8;
    float value;

    if (type == SF_EXR_HALF)
        return sf_half_to_float((uint16_t)bits);
    bits |= (uint32_t)from[2] << 16 | (uint32_t)from[3] << 24;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Takes the place of the library's unpacking: copies a decoded chunk into the planes, with every size checked. */
static exr_result_t unpack_chunk(exr_decode_pipeline_t *pipeline)
{
    struct decoder *decoder = pipeline->decoding_user_data;
    const struct sf_exr *exr = decoder->exr;
    const unsigned char *from = pipeline->unpacked_buffer;
    uint64_t left = pipeline->chunk.unpacked_size;
    uint32_t width, height;

    if (!from || pipeline->chunk.width < 1 || pipeline->chunk.height < 1)
        return EXR_ERR_CORRUPT_CHUNK;
    width = (uint32_t)pipeline->chunk.width;
    height = (uint32_t)pipeline->chunk.height;
    if (decoder->x >= exr->width || decoder->y >= exr->height || width > exr->width - decoder->x ||
        height > exr->height - decoder->y)
        return EXR_ERR_CORRUPT_CHUNK;
    for (uint32_t y = 0; y < height; y++) {
        for (int c = 0; c < pipeline->channel_count; c++) {
            size_t bytes = (size_t)pipeline->channels[c].bytes_per_element;
            struct sf_exr_plane *plane = decoder->by_channel[c];

            if (left < width * bytes)
                return EXR_ERR_CORRUPT_CHUNK;
            if (plane) {
                float *to = plane->pixels + (size_t)(decoder->y + y) * exr->width + decoder->x;

                for (uint32_t x = 0; x < width; x++)
                    to[x] = load_value(from + x * bytes, plane->stored);
            }
            from += width * bytes;
            left -= width * bytes;
        }
    }
    return EXR_ERR_SUCCESS;
}

/* Decodes the chunk, setting the pipeline up when it is the first. */
static exr_result_t run_chunk(struct decoder *decoder, exr_context_t context, const exr_chunk_info_t *chunk,
                              exr_compression_t compression, exr_decode_pipeline_t *pipeline)
{
    exr_result_t result;

    /* The library would unpack memory that nobody filled. */
    if (compression == EXR_COMPRESSION_NONE && chunk->packed_size != chunk->unpacked_size)
        return EXR_ERR_CORRUPT_CHUNK;
    if (pipeline->context) {
        result = exr_decoding_update(context, 0, chunk, pipeline);
    } else {
        result = exr_decoding_initialize(context, 0, chunk, pipeline);
        if (result == EXR_ERR_SUCCESS && pipeline->channel_count > SF_EXR_CHANNEL_MAX)
            result = EXR_ERR_CORRUPT_CHUNK;
        if (result == EXR_ERR_SUCCESS)
            result = exr_decoding_choose_default_routines(context, 0, pipeline);
        pipeline->decoding_user_data = decoder;
        pipeline->unpack_and_convert_fn = unpack_chunk;
    }
    return result == EXR_ERR_SUCCESS ? exr_decoding_run(context, 0, pipeline) : result;
}

static exr_result_t read_lines(struct decoder *decoder, exr_context_t context, exr_compression_t compression,
                               exr_decode_pipeline_t *pipeline)
{
    int32_t lines = 0;
    exr_result_t result = exr_get_scanlines_per_chunk(context, 0, &lines);

    if (result == EXR_ERR_SUCCESS && lines < 1)
        result = EXR_ERR_CORRUPT_CHUNK;
    for (uint32_t y = 0; y < decoder->exr->height && result == EXR_ERR_SUCCESS; y += (uint32_t)lines) {
        exr_chunk_info_t chunk;

        decoder->y = y;
        result = exr_read_scanline_chunk_info(context, 0, decoder->top + (int32_t)y, &chunk);
        if (result == EXR_ERR_SUCCESS)
            result = run_chunk(decoder, context, &chunk, compression, pipeline);
    }
    return result;
}

static exr_result_t read_tiles(struct decoder *decoder, exr_context_t context, exr_compression_t compression,
                               exr_decode_pipeline_t *pipeline)
{
    uint32_t wide = 0, high = 0;
    exr_tile_level_mode_t levels;
    exr_tile_round_mode_t rounding;
    exr_result_t result = exr_get_tile_descriptor(context, 0, &wide, &high, &levels, &rounding);

    if (result == EXR_ERR_SUCCESS && (wide < 1 || high < 1 || wide > SF_IMAGE_SIDE_MAX || high > SF_IMAGE_SIDE_MAX))
        result = EXR_ERR_CORRUPT_CHUNK;
    for (uint32_t y = 0; y < decoder->exr->height && result == EXR_ERR_SUCCESS; y += high) {
        for (uint32_t x = 0; x < decoder->exr->width && result == EXR_ERR_SUCCESS; x += wide) {
            exr_chunk_info_t chunk;

            decoder->x = x;
            decoder->y = y;
            result = exr_read_tile_chunk_info(context, 0, (int)(x / wide), (int)(y / high), 0, 0, &chunk);
            if (result == EXR_ERR_SUCCESS)
                result = run_chunk(decoder, context, &chunk, compression, pipeline);
        }
    }
    return result;
}

enum sf_status sf_exr_decode(const void *data, size_t size, const char *name, const char *const *wanted,
                             size_t wanted_count, struct sf_exr *exr, const struct sf_log *log)
{
    static const unsigned char magic[4] = {0x76, 0x2f, 0x31, 0x01};
    struct decoder decoder = {.data = data, .size = size, .name = name, .log = log, .exr = exr};
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_decode_pipeline_t pipeline = {0};
    exr_context_t context = NULL;
    exr_storage_t storage = EXR_STORAGE_SCANLINE;
    exr_compression_t compression = EXR_COMPRESSION_NONE;
    enum sf_status status;
    exr_result_t result;

    *exr = (struct sf_exr){0};
    if (size < sizeof magic || memcmp(data, magic, sizeof magic) != 0)
        return fail(&decoder, "it is not an OpenEXR file");
    init.user_data = &decoder;
    init.read_fn = read_bytes;
    init.size_fn = query_size;
    init.error_handler_fn = note_error;
    init.max_image_width = init.max_image_height = (int)SF_IMAGE_SIDE_MAX;
    init.max_tile_width = init.max_tile_height = (int)SF_IMAGE_SIDE_MAX;
    /* A file without its table of chunks was not finished: an error, not a riddle. */
    init.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    message_place = decoder.message;
    result = exr_start_read(&context, name[0] ? name : "(unnamed)", &init);
    if (result != EXR_ERR_SUCCESS) {
        status = fail_core(&decoder, result);
    } else {
        status = read_header(&decoder, context, wanted, wanted_count, &storage, &compression);
        if (status == SF_OK) {
            result = storage == EXR_STORAGE_TILED ? read_tiles(&decoder, context, compression, &pipeline)
                                                  : read_lines(&decoder, context, compression, &pipeline);
            if (result != EXR_ERR_SUCCESS)
                status = fail_core(&decoder, result);
        }
        exr_decoding_destroy(context, &pipeline);
    }
    if (context)
        exr_finish(&context);
    message_place = NULL;
    if (status != SF_OK)
        sf_exr_finish(exr);
    return status;
}

enum sf_status sf_exr_read(const char *path, const char *const *wanted, size_t wanted_count, struct sf_exr *exr,
                           const struct sf_log *log)
{
    char *data;
    size_t size;
    enum sf_status status = sf_file_read(path, SF_IMAGE_FILE_MAX, log, &data, &size);

    *exr = (struct sf_exr){0};
    if (status == SF_OK)
        status = sf_exr_decode(data, size, path, wanted, wanted_count, exr, log);
    free(data);
    return status;
}

const float *sf_exr_pixels(const struct sf_exr *exr, const char *name)
{
    for (size_t i = 0; i < exr->plane_count; i++)
        if (strcmp(exr->planes[i].name, name) == 0)
            return exr->planes[i].pixels;
    return NULL;
}

const struct sf_exr_attribute *sf_exr_attribute(const struct sf_exr *exr, const char *name)
{
    for (size_t i = 0; i < exr->attribute_count; i++)
        if (strcmp(exr->attributes[i].name, name) == 0)
            return &exr->attributes[i];
    return NULL;
}

void sf_exr_finish(struct sf_exr *exr)
{
    if (!exr)
        return;
    for (size_t i = 0; i < exr->plane_count; i++)
        free(exr->planes[i].pixels);
    sf_arena_finish(&exr->arena);
    *exr = (struct sf_exr){0};
}
