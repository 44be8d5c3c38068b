/* Sizes of resources. */
#include "graph/internal.h"

static uint32_t scale(uint32_t side, const struct sf_size *size)
{
    uint64_t scaled = ((uint64_t)side * size->num + size->den - 1) / size->den;

    if (scaled == 0)
        return 1;
    /* Validation refuses whatever is above the limit, so the clamp only keeps the number in range until then. */
    return scaled > UINT32_MAX ? UINT32_MAX : (uint32_t)scaled;
}

void sf_image_extent(const struct sf_graph *graph, sf_resource resource, uint32_t *width, uint32_t *height)
{
    const struct sf_size *size = &sf_graph_get(graph, resource)->image.size;

    if (!size->relative_to) {
        *width = size->width;
        *height = size->height;
        return;
    }
    /* An image can only name one declared before it, so this ends. */
    sf_image_extent(graph, size->relative_to, width, height);
    *width = scale(*width, size);
    *height = scale(*height, size);
}

uint64_t sf_resource_bytes(const struct sf_graph *graph, sf_resource resource)
{
    const struct sf_graph_resource *declared = sf_graph_get(graph, resource);
    uint32_t width, height;

    if (!declared->is_image)
        return declared->buffer.bytes;
    sf_image_extent(graph, resource, &width, &height);
    return (uint64_t)width * height * declared->image.layers * sf_format_bytes(declared->image.format);
}
