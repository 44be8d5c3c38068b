/* Buffers: Vulkan's with their memory, and those that outlive a graph. */
#include "gpu/vk.h"

#include <stdlib.h>
#include <string.h>

VkBufferUsageFlags sf_vk_buffer_usage(uint32_t access_bits)
{
    static const VkBufferUsageFlags usages[SF_ACCESS_COUNT] = {
        [SF_ACCESS_UNIFORM] = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
        [SF_ACCESS_STORAGE_READ] = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
        [SF_ACCESS_STORAGE_WRITE] = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
        [SF_ACCESS_STORAGE_MODIFY] = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
        [SF_ACCESS_INDIRECT] = VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
        [SF_ACCESS_TRANSFER_READ] = VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
        [SF_ACCESS_TRANSFER_WRITE] = VK_BUFFER_USAGE_TRANSFER_DST_BIT,
    };
    VkBufferUsageFlags usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT; /* filled with zeros at first */

    for (uint32_t access = 0; access < SF_ACCESS_COUNT; access++)
        if (access_bits & 1u << access)
            usage |= usages[access];
    return usage;
}

VkBufferCreateInfo sf_vk_buffer_info(uint64_t bytes, VkBufferUsageFlags usage)
{
    return (VkBufferCreateInfo){
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
        .size = (bytes ? bytes + 15 : 16) / 16 * 16,
        .usage = usage,
        .sharingMode = VK_SHARING_MODE_EXCLUSIVE,
    };
}

enum sf_status sf_vk_buffer_init(struct sf_gpu *gpu, const char *name, uint64_t bytes, VkBufferUsageFlags usage,
                                 enum sf_memory_kind kind, const struct sf_place *home, uint64_t offset,
                                 struct sf_vk_buffer *buffer)
{
    VkBufferCreateInfo info = sf_vk_buffer_info(bytes, usage);
    VkMemoryRequirements needs;
    enum sf_status status = sf_gpu_refuse_lost(gpu);

    if (status)
        return status;
    buffer->bytes = bytes;
    status =
        sf_vk_check(gpu, gpu->vk.vkCreateBuffer(gpu->device, &info, NULL, &buffer->handle), "create the buffer", name);
    if (status)
        return status;
    sf_vk_name(gpu, VK_OBJECT_TYPE_BUFFER, SF_VK_HANDLE(buffer->handle), name);
    gpu->vk.vkGetBufferMemoryRequirements(gpu->device, buffer->handle, &needs);
    if (!home || !sf_memory_type_fits(home, needs.memoryTypeBits)) {
        status = sf_memory_alloc(gpu, name, &needs, kind, &buffer->place);
        if (status)
            return status;
        home = &buffer->place;
        offset = 0;
    }
    return sf_vk_check(gpu,
                       gpu->vk.vkBindBufferMemory(gpu->device, buffer->handle, home->memory, home->offset + offset),
                       "bind memory to the buffer", name);
}

void sf_vk_buffer_finish(struct sf_gpu *gpu, struct sf_vk_buffer *buffer)
{
    if (buffer->handle && !gpu->stuck)
        gpu->vk.vkDestroyBuffer(gpu->device, buffer->handle, NULL);
    sf_memory_free(gpu, &buffer->place);
    *buffer = (struct sf_vk_buffer){0};
}

enum sf_status sf_gpu_buffer_create(struct sf_gpu *gpu, const char *name, uint64_t bytes, bool history,
                                    enum sf_access outside, const void *data, struct sf_gpu_buffer **out)
{
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                     VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                     VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    struct sf_gpu_buffer *buffer;
    enum sf_status status = SF_OK;

    *out = NULL;
    if (bytes == 0)
        return sf_fail(gpu->log, SF_ERROR_USAGE, "the buffer '%s' has no bytes", name);
    buffer = calloc(1, sizeof *buffer);
    if (!buffer || !(buffer->name = strdup(name))) {
        free(buffer);
        return sf_fail(gpu->log, SF_ERROR_MEMORY, "no memory for the buffer '%s'", name);
    }
    buffer->gpu = gpu;
    buffer->outside = outside;
    buffer->copy_count = history ? 2 : 1;
    for (uint32_t i = 0; i < buffer->copy_count && !status; i++)
        status = sf_vk_buffer_init(gpu, name, bytes, usage, SF_MEMORY_DEVICE, NULL, 0, &buffer->copies[i]);
    if (!status && data)
        status = sf_gpu_buffer_write(buffer, 0, data, bytes);
    else if (!status) {
        VkCommandBuffer commands;

        status = sf_setup_begin(gpu, name, &commands);
        for (uint32_t i = 0; i < buffer->copy_count && !status; i++)
            gpu->vk.vkCmdFillBuffer(commands, buffer->copies[i].handle, 0, VK_WHOLE_SIZE, 0);
        if (!status)
            status = sf_setup_end(gpu, name);
    }
    if (status)
        sf_gpu_buffer_destroy(&buffer);
    *out = buffer;
    return status;
}

static enum sf_status check_range(const struct sf_gpu_buffer *buffer, uint64_t offset, uint64_t bytes)
{
    uint64_t size = buffer->copies[0].bytes;

    if (offset <= size && bytes <= size - offset)
        return SF_OK;
    return sf_fail(buffer->gpu->log, SF_ERROR_USAGE, "bytes %llu to %llu are asked of the buffer '%s', which has %llu",
                   (unsigned long long)offset, (unsigned long long)(offset + bytes), buffer->name,
                   (unsigned long long)size);
}

enum sf_status sf_gpu_buffer_write(struct sf_gpu_buffer *buffer, uint64_t offset, const void *data, uint64_t bytes)
{
    struct sf_gpu *gpu = buffer->gpu;
    struct sf_vk_buffer staging = {0};
    VkBufferCopy region = {.dstOffset = offset, .size = bytes};
    VkCommandBuffer commands;
    enum sf_status status = check_range(buffer, offset, bytes);

    if (status || bytes == 0)
        return status;
    status = sf_gpu_wait_idle(gpu);
    if (!status)
        status = sf_vk_buffer_init(gpu, buffer->name, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, SF_MEMORY_UPLOAD, NULL,
                                   0, &staging);
    if (!status) {
        memcpy(staging.place.mapped, data, bytes);
        status = sf_setup_begin(gpu, buffer->name, &commands);
    }
    if (!status) {
        for (uint32_t i = 0; i < buffer->copy_count; i++)
            gpu->vk.vkCmdCopyBuffer(commands, staging.handle, buffer->copies[i].handle, 1, &region);
        status = sf_setup_end(gpu, buffer->name);
    }
    sf_vk_buffer_finish(gpu, &staging);
    return status;
}

enum sf_status sf_gpu_buffer_read(struct sf_gpu_buffer *buffer, uint64_t offset, void *data, uint64_t bytes)
{
    struct sf_gpu *gpu = buffer->gpu;
    struct sf_vk_buffer staging = {0};
    VkBufferCopy region = {.srcOffset = offset, .size = bytes};
    VkCommandBuffer commands;
    enum sf_status status = check_range(buffer, offset, bytes);

    if (status || bytes == 0)
        return status;
    status = sf_gpu_wait_idle(gpu);
    if (!status)
        status = sf_vk_buffer_init(gpu, buffer->name, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, SF_MEMORY_READBACK, NULL,
                                   0, &staging);
    if (!status)
        status = sf_setup_begin(gpu, buffer->name, &commands);
    if (!status) {
        gpu->vk.vkCmdCopyBuffer(commands, buffer->copies[buffer->latest].handle, staging.handle, 1, &region);
        status = sf_setup_end(gpu, buffer->name);
    }
    if (!status)
        status = sf_memory_invalidate(gpu, &staging.place, buffer->name);
    if (!status)
        memcpy(data, staging.place.mapped, bytes);
    sf_vk_buffer_finish(gpu, &staging);
    return status;
}

void sf_gpu_buffer_destroy(struct sf_gpu_buffer **pointer)
{
    struct sf_gpu_buffer *buffer = pointer ? *pointer : NULL;

    if (!buffer)
        return;
    sf_gpu_settle(buffer->gpu);
    for (uint32_t i = 0; i < buffer->copy_count; i++)
        sf_vk_buffer_finish(buffer->gpu, &buffer->copies[i]);
    free(buffer->name);
    free(buffer);
    *pointer = NULL;
}
