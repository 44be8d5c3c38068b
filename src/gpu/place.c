/* Gives the resources of a plan their memory.
 *
 * Transients live in one heap, at the places that the plan chose with this device's own sizes (sf_gpu_memory_needs);
 * where a device wants another kind of memory for one of them, that one gets memory of its own, which is always right.
 * All others have memory of their own. */
#include "gpu/player.h"

#include <stdlib.h>

static VkBufferCreateInfo buffer_info(const struct sf_plan_resource *resource)
{
    return sf_vk_buffer_info(resource->bytes, sf_vk_buffer_usage(resource->usage));
}

static VkImageCreateInfo image_info(const struct sf_plan_resource *resource)
{
    VkImageUsageFlags usage = sf_vk_image_usage(resource->usage);

    if (resource->lifetime != SF_TRANSIENT)
        usage |= VK_IMAGE_USAGE_TRANSFER_DST_BIT; /* zeros at first */
    return sf_vk_image_info(resource->format, resource->width, resource->height,
                            resource->layers ? resource->layers : 1, usage);
}

static bool image_fits(const struct sf_gpu *gpu, const struct sf_plan_resource *resource)
{
    uint32_t side = gpu->limits.maxImageDimension2D;

    return resource->width > 0 && resource->height > 0 && resource->width <= side && resource->height <= side &&
           resource->layers <= gpu->limits.maxImageArrayLayers;
}

static VkMemoryRequirements device_needs(const struct sf_gpu *gpu, const struct sf_plan_resource *resource)
{
    VkMemoryRequirements2 needs = {.sType = VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2};

    if (resource->image) {
        VkImageCreateInfo info = image_info(resource);
        VkDeviceImageMemoryRequirements ask = {.sType = VK_STRUCTURE_TYPE_DEVICE_IMAGE_MEMORY_REQUIREMENTS,
                                               .pCreateInfo = &info};

        gpu->vk.vkGetDeviceImageMemoryRequirements(gpu->device, &ask, &needs);
    } else {
        VkBufferCreateInfo info = buffer_info(resource);
        VkDeviceBufferMemoryRequirements ask = {.sType = VK_STRUCTURE_TYPE_DEVICE_BUFFER_MEMORY_REQUIREMENTS,
                                                .pCreateInfo = &info};

        gpu->vk.vkGetDeviceBufferMemoryRequirements(gpu->device, &ask, &needs);
    }
    /* Neighbours of different kinds must keep this distance. */
    if (needs.memoryRequirements.alignment < gpu->limits.bufferImageGranularity)
        needs.memoryRequirements.alignment = gpu->limits.bufferImageGranularity;
    needs.memoryRequirements.size = (needs.memoryRequirements.size + needs.memoryRequirements.alignment - 1) /
                                    needs.memoryRequirements.alignment * needs.memoryRequirements.alignment;
    return needs.memoryRequirements;
}

void sf_gpu_memory_needs(void *user, const struct sf_plan_resource *resource, uint64_t *size, uint64_t *alignment)
{
    const struct sf_gpu *gpu = user;

    if (resource->image && (!image_fits(gpu, resource) || resource->usage == 0)) {
        *size = resource->bytes; /* refused by name when the player is made */
        *alignment = 1;
    } else {
        VkMemoryRequirements needs = device_needs(gpu, resource);

        *size = needs.size;
        *alignment = needs.alignment;
    }
}

/* The use for which the device cannot take the image, in words; NULL when it can. */
static const char *image_misfit(const struct sf_player *player, sf_resource number)
{
    const struct sf_plan *plan = player->plan;
    const struct sf_plan_resource *resource = &plan->resources[number - 1];
    bool blended = false, filtered = false;

    for (uint32_t i = 0; i < plan->pass_count; i++) {
        const struct sf_raster *raster = &sf_graph_pass_at(plan->graph, plan->passes[i].index)->raster;

        for (uint32_t j = 0; j < plan->passes[i].use_count; j++) {
            const struct sf_use *use = &plan->passes[i].uses[j].use;

            if (use->resource != number)
                continue;
            blended = blended || (use->access == SF_ACCESS_COLOR && raster->blend[use->binding] != SF_BLEND_NONE);
            filtered = filtered || (use->access == SF_ACCESS_SAMPLED && use->sampler == SF_SAMPLER_LINEAR_REPEAT);
        }
    }
    return sf_vk_image_misfit(player->gpu, resource->format, sf_vk_image_usage(resource->usage), blended, filtered);
}

static enum sf_status check_resource(const struct sf_player *player, sf_resource number)
{
    const struct sf_gpu *gpu = player->gpu;
    const struct sf_plan_resource *resource = &player->plan->resources[number - 1];
    const uint32_t storage =
        1u << SF_ACCESS_STORAGE_READ | 1u << SF_ACCESS_STORAGE_WRITE | 1u << SF_ACCESS_STORAGE_MODIFY;
    const char *misfit;

    if (resource->image && !image_fits(gpu, resource))
        return sf_fail(
            gpu->log, SF_ERROR_USAGE,
            "the image '%s' of '%s' would be %u x %u pixels in %u layers: this device takes 1 to %u a side, %u "
            "layers",
            resource->name, player->plan->name, resource->width, resource->height, resource->layers,
            gpu->limits.maxImageDimension2D, gpu->limits.maxImageArrayLayers);
    if (resource->image) {
        misfit = image_misfit(player, number);
        return misfit ? sf_fail(gpu->log, SF_ERROR_DEVICE,
                                "the device does not support %s of %s, the format of the image '%s' of '%s'", misfit,
                                sf_format_name(resource->format), resource->name, player->plan->name)
                      : SF_OK;
    }
    if (resource->usage & storage && resource->bytes > gpu->limits.maxStorageBufferRange)
        return sf_fail(gpu->log, SF_ERROR_USAGE,
                       "the buffer '%s' of '%s' would have %llu bytes: this device lets a shader see at most %u",
                       resource->name, player->plan->name, (unsigned long long)resource->bytes,
                       gpu->limits.maxStorageBufferRange);
    if (resource->usage & 1u << SF_ACCESS_UNIFORM && resource->bytes > gpu->limits.maxUniformBufferRange)
        return sf_fail(gpu->log, SF_ERROR_USAGE,
                       "the uniform buffer '%s' of '%s' would have %llu bytes: this device takes at most %u",
                       resource->name, player->plan->name, (unsigned long long)resource->bytes,
                       gpu->limits.maxUniformBufferRange);
    return SF_OK;
}

/* Memory for all transients: of a kind that suits every one of them, or else the first. */
static enum sf_status make_heap(struct sf_player *player)
{
    const struct sf_plan *plan = player->plan;
    VkMemoryRequirements heap = {.size = plan->heap_bytes, .alignment = 1, .memoryTypeBits = UINT32_MAX};

    if (plan->heap_bytes == 0)
        return SF_OK;
    for (uint32_t i = 0; i < plan->resource_count; i++) {
        const struct sf_plan_resource *resource = &plan->resources[i];
        VkMemoryRequirements needs;

        if (!resource->used || resource->lifetime != SF_TRANSIENT)
            continue;
        needs = device_needs(player->gpu, resource);
        if (needs.size > resource->size || resource->offset % needs.alignment != 0 ||
            resource->offset + needs.size > plan->heap_bytes)
            return sf_fail(
                player->gpu->log, SF_ERROR_INTERNAL,
                "the plan '%s' was not compiled with this device's memory needs: '%s' does not fit its place",
                plan->name, resource->name);
        if (needs.alignment > heap.alignment)
            heap.alignment = needs.alignment;
        if (heap.memoryTypeBits & needs.memoryTypeBits)
            heap.memoryTypeBits &= needs.memoryTypeBits;
    }
    return sf_memory_alloc(player->gpu, plan->name, &heap, SF_MEMORY_DEVICE, &player->heap);
}

static enum sf_status make_object(struct sf_player *player, struct sf_object *object)
{
    struct sf_gpu *gpu = player->gpu;
    const struct sf_plan_resource *resource = object->resource;
    bool transient = resource->lifetime == SF_TRANSIENT;
    const struct sf_place *home = transient ? &player->heap : NULL;
    uint32_t copies = resource->lifetime == SF_HISTORY ? 2 : 1;
    enum sf_status status = SF_OK;

    for (uint32_t i = 0; i < copies && !status; i++) {
        if (resource->image) {
            VkImageCreateInfo info = image_info(resource);

            status = sf_vk_image_init(gpu, resource->name, &info, resource->format, home, resource->offset,
                                      &object->images[i]);
        } else {
            status = sf_vk_buffer_init(gpu, resource->name, resource->bytes, sf_vk_buffer_usage(resource->usage),
                                       SF_MEMORY_DEVICE, home, resource->offset, &object->buffers[i]);
        }
    }
    return status;
}

enum sf_status sf_player_place_readbacks(struct sf_player *player)
{
    enum sf_status status = SF_OK;

    for (uint32_t i = 0; i < player->object_count; i++) {
        struct sf_object *object = &player->objects[i];
        const struct sf_plan_resource *resource = object->resource;

        if (!resource->used || resource->lifetime != SF_READBACK)
            continue;
        if (!object->slices) { /* else a try that failed half way is taken up again */
            object->serials = sf_arena_alloc(&player->arena, player->depth * sizeof *object->serials);
            object->slices = sf_arena_alloc(&player->arena, player->depth * sizeof *object->slices);
            if (!object->slices || !object->serials)
                return sf_player_no_memory(player);
        }
        for (uint32_t slice = 0; slice < player->depth && !status; slice++)
            if (!object->slices[slice].handle)
                status =
                    sf_vk_buffer_init(player->gpu, resource->name, resource->bytes, sf_vk_buffer_usage(resource->usage),
                                      SF_MEMORY_READBACK, NULL, 0, &object->slices[slice]);
    }
    return status;
}

static void zero_image(struct sf_gpu *gpu, VkCommandBuffer commands, const struct sf_vk_image *image,
                       VkImageLayout then)
{
    VkImageSubresourceRange range = sf_vk_image_range(image->format);
    VkImageMemoryBarrier2 barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        .dstStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
        .dstAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
        .oldLayout = VK_IMAGE_LAYOUT_UNDEFINED,
        .newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image->handle,
        .subresourceRange = range,
    };
    VkDependencyInfo dependency = {
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
        .imageMemoryBarrierCount = 1,
        .pImageMemoryBarriers = &barrier,
    };

    gpu->vk.vkCmdPipelineBarrier2(commands, &dependency);
    if (image->format == SF_FORMAT_D32F)
        gpu->vk.vkCmdClearDepthStencilImage(commands, image->handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                            &(VkClearDepthStencilValue){0}, 1, &range);
    else
        gpu->vk.vkCmdClearColorImage(commands, image->handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                     &(VkClearColorValue){.float32 = {0}}, 1, &range);
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.newLayout = then;
    gpu->vk.vkCmdPipelineBarrier2(commands, &dependency);
}

/* Zeros into what keeps its contents, and each image into the layout in which the first play finds it. */
static enum sf_status fill_objects(struct sf_player *player)
{
    struct sf_gpu *gpu = player->gpu;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    enum sf_status status = SF_OK;

    for (uint32_t i = 0; i < player->object_count && !status; i++) {
        struct sf_object *object = &player->objects[i];
        const struct sf_plan_resource *resource = object->resource;
        uint32_t copies = resource->lifetime == SF_HISTORY ? 2 : 1;

        if (!resource->used || (resource->lifetime != SF_PERSISTENT && resource->lifetime != SF_HISTORY))
            continue;
        if (!commands)
            status = sf_setup_begin(gpu, player->plan->name, &commands);
        for (uint32_t copy = 0; copy < copies && !status; copy++) {
            VkImageLayout layout = sf_vk_layout(resource->enters[copy], resource->format);

            if (!resource->image)
                gpu->vk.vkCmdFillBuffer(commands, object->buffers[copy].handle, 0, VK_WHOLE_SIZE, 0);
            else /* a copy that no pass ever touches has no layout of its own */
                zero_image(gpu, commands, &object->images[copy],
                           layout == VK_IMAGE_LAYOUT_UNDEFINED ? VK_IMAGE_LAYOUT_GENERAL : layout);
        }
    }
    if (!status && commands)
        status = sf_setup_end(gpu, player->plan->name);
    return status;
}

enum sf_status sf_player_place(struct sf_player *player)
{
    const struct sf_plan *plan = player->plan;
    enum sf_status status = SF_OK;

    for (uint32_t i = 0; i < plan->resource_count && !status; i++)
        if (plan->resources[i].used)
            status = check_resource(player, i + 1);
    if (!status)
        status = make_heap(player);
    for (uint32_t i = 0; i < player->object_count && !status; i++) {
        enum sf_lifetime lifetime = plan->resources[i].lifetime;

        if (plan->resources[i].used &&
            (lifetime == SF_TRANSIENT || lifetime == SF_PERSISTENT || lifetime == SF_HISTORY))
            status = make_object(player, &player->objects[i]);
    }
    if (!status)
        status = fill_objects(player);
    return status;
}

void sf_player_unplace(struct sf_player *player)
{
    for (uint32_t i = 0; i < player->object_count; i++) {
        struct sf_object *object = &player->objects[i];

        for (int copy = 0; copy < 2; copy++) {
            sf_vk_buffer_finish(player->gpu, &object->buffers[copy]);
            sf_vk_image_finish(player->gpu, &object->images[copy]);
        }
        for (uint32_t slice = 0; object->slices && slice < player->depth; slice++)
            sf_vk_buffer_finish(player->gpu, &object->slices[slice]);
    }
    sf_memory_free(player->gpu, &player->heap);
}
