#include "render/inspect.h"

#include <string.h>
#include "base/array.h"
#include "base/suggest.h"
#include "output/half.h"
#include "sfumato/sfumato.h"

enum { NAMES_MAX = 64 };

void sf_inspect_prepare(struct sf_graph *graph, const char *name)
{
    if (name)
        sf_graph_watch(graph, name);
}

static uint32_t channels_of(enum sf_format format)
{
    switch (format) {
    case SF_FORMAT_R8_UNORM:
    case SF_FORMAT_R16F:
    case SF_FORMAT_R32F:
    case SF_FORMAT_R32_UINT:
    case SF_FORMAT_D32F:
        return 1;
    case SF_FORMAT_RG16F:
    case SF_FORMAT_RG32F:
        return 2;
    case SF_FORMAT_RGBA8_UNORM:
    case SF_FORMAT_RGBA8_SRGB:
    case SF_FORMAT_RGBA16F:
    case SF_FORMAT_RGBA32F:
        return 4;
    default:
        return 0;
    }
}

/* Readbacks are the CPU's already. */
static const char *name_of(const struct sf_graph *graph, sf_resource resource)
{
    const struct sf_image_desc *image = sf_graph_image_at(graph, resource);
    const struct sf_buffer_desc *buffer = sf_graph_buffer_at(graph, resource);

    if (image)
        return image->name;
    return buffer && buffer->lifetime != SF_READBACK ? buffer->name : NULL;
}

static enum sf_status unknown(const struct sf_graph *graph, const char *name, const struct sf_log *log)
{
    const char *names[NAMES_MAX], *near;
    struct sf_text text = {0};
    size_t count = 0;
    enum sf_status status;

    for (sf_resource r = 1; r <= sf_graph_resource_count(graph) && count < NAMES_MAX; r++) {
        if (!name_of(graph, r))
            continue;
        names[count] = name_of(graph, r);
        sf_text_printf(&text, "%s%s", count > 0 ? ", " : "", names[count]);
        count++;
    }
    near = sf_suggest(name, names, count);
    status = sf_fail(log, SF_ERROR_USAGE, "the frame's graph has no image or buffer '%s'%s%s%s; there are %s", name,
                     near ? "; did you mean '" : "", near ? near : "", near ? "'?" : "",
                     text.data && !text.failed ? text.data : "others");
    sf_text_finish(&text);
    return status;
}

static uint32_t scaled(uint32_t side, const struct sf_size *size)
{
    uint32_t result = (uint32_t)(((uint64_t)side * size->num + size->den - 1) / size->den);

    return result > 0 ? result : 1;
}

static void extent(const struct sf_graph *graph, const struct sf_image_desc *image, uint32_t *width, uint32_t *height)
{
    const struct sf_image_desc *base =
        image->size.relative_to ? sf_graph_image_at(graph, image->size.relative_to) : NULL;

    *width = image->size.width;
    *height = image->size.height;
    if (!base)
        return;
    extent(graph, base, width, height);
    *width = scaled(*width, &image->size);
    *height = scaled(*height, &image->size);
}

/* Its bytes; how it will be looked at goes into `inspected`. */
static uint64_t describe(const struct sf_graph *graph, sf_resource resource, struct sf_inspected *inspected)
{
    const struct sf_image_desc *image = sf_graph_image_at(graph, resource);
    uint64_t bytes;

    if (!image) {
        bytes = sf_graph_buffer_at(graph, resource)->bytes;
        bytes = bytes < SF_INSPECTED_BYTES_MAX ? bytes : SF_INSPECTED_BYTES_MAX;
        inspected->words = (uint32_t)(bytes / sizeof(uint32_t));
        return bytes;
    }
    inspected->format = image->format;
    inspected->channels = channels_of(image->format);
    extent(graph, image, &inspected->width, &inspected->height);
    bytes = (uint64_t)inspected->width * inspected->height * image->layers * sf_format_bytes(image->format);
    inspected->height *= image->layers;
    return bytes;
}

enum sf_status sf_inspect_declare(struct sf_graph *graph, const char *name, const struct sf_log *log,
                                  struct sf_inspected *inspected)
{
    sf_resource from = sf_graph_find(graph, name);
    struct sf_buffer_desc readback = {.name = "read.inspected", .lifetime = SF_READBACK};

    *inspected = (struct sf_inspected){0};
    if (!from || !name_of(graph, from))
        return unknown(graph, name, log);
    readback.bytes = describe(graph, from, inspected);
    inspected->readback = sf_graph_buffer(graph, &readback);
    const struct sf_use uses[] = {{.resource = from, .access = SF_ACCESS_TRANSFER_READ},
                                  {.resource = inspected->readback, .access = SF_ACCESS_TRANSFER_WRITE}};
    sf_graph_pass(graph,
                  &(struct sf_pass_desc){.name = "output.inspected",
                                         .kind = SF_PASS_TRANSFER,
                                         .uses = uses,
                                         .use_count = 2,
                                         .transfer = inspected->words > 0 ? SF_TRANSFER_FRONT : SF_TRANSFER_COPY});
    return SF_OK;
}

bool sf_frame_unwritten(float value)
{
    uint32_t bits;

    memcpy(&bits, &value, sizeof bits);
    return bits == SF_GRAPH_UNWRITTEN;
}

uint64_t sf_inspect_values(const struct sf_inspected *inspected)
{
    return (uint64_t)inspected->width * inspected->height * inspected->channels;
}

void sf_inspect_convert(const struct sf_inspected *inspected, const void *from, float *to)
{
    uint64_t count = sf_inspect_values(inspected);
    const uint8_t *bytes = from;
    const uint16_t *halves = from;
    const uint32_t *words = from;

    switch (inspected->format) {
    case SF_FORMAT_R8_UNORM:
    case SF_FORMAT_RGBA8_UNORM:
    case SF_FORMAT_RGBA8_SRGB:
        for (uint64_t i = 0; i < count; i++)
            to[i] = (float)bytes[i] / 255.0f;
        break;
    case SF_FORMAT_R16F:
    case SF_FORMAT_RG16F:
    case SF_FORMAT_RGBA16F:
        for (uint64_t i = 0; i < count; i++)
            to[i] = sf_half_to_float(halves[i]);
        break;
    case SF_FORMAT_R32_UINT:
        for (uint64_t i = 0; i < count; i++)
            to[i] = (float)words[i];
        break;
    default:
        memcpy(to, from, count * sizeof *to);
        break;
    }
}
