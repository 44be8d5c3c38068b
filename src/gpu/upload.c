/* The ring from which UPLOAD buffers get their slices: mapped chunks of a frame in flight, filled from the front, all
 * free again when the frame's turn comes round. Chunks stay, so a steady scene allocates nothing. */
#include "gpu/vk.h"

#include <stdlib.h>

enum { CHUNK_BYTES = 1 << 20 };

static uint64_t slice_alignment(const struct sf_gpu *gpu)
{
    const uint64_t wants[] = {gpu->limits.minUniformBufferOffsetAlignment, gpu->limits.minStorageBufferOffsetAlignment,
                              gpu->limits.optimalBufferCopyOffsetAlignment};
    uint64_t alignment = 64; /* a cache line */

    for (size_t i = 0; i < SF_COUNT(wants); i++)
        if (wants[i] > alignment)
            alignment = wants[i]; /* powers of two, all of them */
    return alignment;
}

static enum sf_status add_chunk(struct sf_gpu *gpu, struct sf_upload_ring *ring, const char *name, uint64_t bytes)
{
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                     VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
    struct sf_vk_buffer chunk = {0};
    enum sf_status status;

    if (!sf_array_reserve((void **)&ring->chunks, ring->count, &ring->capacity, 1, sizeof chunk))
        return sf_fail(gpu->log, SF_ERROR_MEMORY, "no memory for the upload of '%s'", name);
    status = sf_vk_buffer_init(gpu, name, bytes > CHUNK_BYTES ? bytes : CHUNK_BYTES, usage, SF_MEMORY_UPLOAD, NULL, 0,
                               &chunk);
    if (status) {
        sf_vk_buffer_finish(gpu, &chunk);
        return status;
    }
    sf_vk_name(gpu, VK_OBJECT_TYPE_BUFFER, SF_VK_HANDLE(chunk.handle), "uploads");
    ring->chunks[ring->count++] = chunk;
    return SF_OK;
}

enum sf_status sf_upload_alloc(struct sf_gpu *gpu, struct sf_upload_ring *ring, const char *name, uint64_t bytes,
                               struct sf_upload *upload)
{
    uint64_t alignment = slice_alignment(gpu), offset = (ring->fill + alignment - 1) / alignment * alignment;

    while (ring->current < ring->count && offset + bytes > ring->chunks[ring->current].bytes) {
        ring->current++;
        offset = 0;
    }
    if (ring->current == ring->count) {
        enum sf_status status = add_chunk(gpu, ring, name, bytes);

        if (status)
            return status;
        offset = 0;
    }
    ring->fill = offset + bytes;
    upload->buffer = ring->chunks[ring->current].handle;
    upload->offset = offset;
    upload->data = ring->chunks[ring->current].place.mapped + offset;
    return SF_OK;
}

void sf_upload_reset(struct sf_upload_ring *ring)
{
    ring->current = 0;
    ring->fill = 0;
}

void sf_upload_finish(struct sf_gpu *gpu, struct sf_upload_ring *ring)
{
    for (size_t i = 0; i < ring->count; i++)
        sf_vk_buffer_finish(gpu, &ring->chunks[i]);
    free(ring->chunks);
    *ring = (struct sf_upload_ring){0};
}
