/* Images: formats, Vulkan's images with their memory and view, and those that outlive a graph. */
#include "gpu/vk.h"

#include <stdlib.h>
#include <string.h>

VkFormat sf_vk_format(enum sf_format format)
{
    static const VkFormat formats[SF_FORMAT_COUNT] = {
        [SF_FORMAT_R8_UNORM] = VK_FORMAT_R8_UNORM,
        [SF_FORMAT_RGBA8_UNORM] = VK_FORMAT_R8G8B8A8_UNORM,
        [SF_FORMAT_RGBA8_SRGB] = VK_FORMAT_R8G8B8A8_SRGB,
        [SF_FORMAT_BGRA8_UNORM] = VK_FORMAT_B8G8R8A8_UNORM,
        [SF_FORMAT_R16F] = VK_FORMAT_R16_SFLOAT,
        [SF_FORMAT_RG16F] = VK_FORMAT_R16G16_SFLOAT,
        [SF_FORMAT_RGBA16F] = VK_FORMAT_R16G16B16A16_SFLOAT,
        [SF_FORMAT_R32F] = VK_FORMAT_R32_SFLOAT,
        [SF_FORMAT_RG32F] = VK_FORMAT_R32G32_SFLOAT,
        [SF_FORMAT_RGBA32F] = VK_FORMAT_R32G32B32A32_SFLOAT,
        [SF_FORMAT_R32_UINT] = VK_FORMAT_R32_UINT,
        [SF_FORMAT_D32F] = VK_FORMAT_D32_SFLOAT,
    };

    return formats[format];
}

VkImageUsageFlags sf_vk_image_usage(uint32_t access_bits)
{
    static const VkImageUsageFlags usages[SF_ACCESS_COUNT] = {
        [SF_ACCESS_SAMPLED] = VK_IMAGE_USAGE_SAMPLED_BIT,
        [SF_ACCESS_STORAGE_READ] = VK_IMAGE_USAGE_STORAGE_BIT,
        [SF_ACCESS_STORAGE_WRITE] = VK_IMAGE_USAGE_STORAGE_BIT,
        [SF_ACCESS_STORAGE_MODIFY] = VK_IMAGE_USAGE_STORAGE_BIT,
        [SF_ACCESS_COLOR] = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
        [SF_ACCESS_DEPTH] = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
        [SF_ACCESS_DEPTH_READ] = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
        [SF_ACCESS_TRANSFER_READ] = VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
        [SF_ACCESS_TRANSFER_WRITE] = VK_IMAGE_USAGE_TRANSFER_DST_BIT,
    };
    VkImageUsageFlags usage = 0;

    for (uint32_t access = 0; access < SF_ACCESS_COUNT; access++)
        if (access_bits & 1u << access)
            usage |= usages[access];
    return usage;
}

static VkImageAspectFlags aspect_of(enum sf_format format)
{
    return format == SF_FORMAT_D32F ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

VkImageSubresourceRange sf_vk_image_range(enum sf_format format)
{
    return (VkImageSubresourceRange){aspect_of(format), 0, 1, 0, VK_REMAINING_ARRAY_LAYERS};
}

VkImageSubresourceLayers sf_vk_image_layers(enum sf_format format, uint32_t layers)
{
    return (VkImageSubresourceLayers){aspect_of(format), 0, 0, layers};
}

VkImageCreateInfo sf_vk_image_info(enum sf_format format, uint32_t width, uint32_t height, uint32_t layers,
                                   VkImageUsageFlags usage)
{
    return (VkImageCreateInfo){
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .imageType = VK_IMAGE_TYPE_2D,
        .format = sf_vk_format(format),
        .extent = {width, height, 1},
        .mipLevels = 1,
        .arrayLayers = layers,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .tiling = VK_IMAGE_TILING_OPTIMAL,
        .usage = usage,
        .sharingMode = VK_SHARING_MODE_EXCLUSIVE,
        .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
    };
}

const char *sf_vk_image_misfit(const struct sf_gpu *gpu, enum sf_format format, VkImageUsageFlags usage, bool blended,
                               bool filtered)
{
    VkFormatFeatureFlags has = gpu->formats[format];

    if (usage & VK_IMAGE_USAGE_SAMPLED_BIT && !(has & VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT))
        return "sampling";
    if (filtered && !(has & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT))
        return "linear filtering";
    if (usage & VK_IMAGE_USAGE_STORAGE_BIT && !(has & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT))
        return "storage";
    if (usage & VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT && !(has & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT))
        return "drawing";
    if (blended && !(has & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT))
        return "blending";
    if (usage & VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT && !(has & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT))
        return "depth testing";
    return NULL;
}

enum sf_status sf_vk_image_view_init(struct sf_gpu *gpu, const char *name, struct sf_vk_image *image)
{
    VkImageViewCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = image->handle,
        .viewType = image->layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D,
        .format = sf_vk_format(image->format),
        .subresourceRange = sf_vk_image_range(image->format),
    };
    enum sf_status status = sf_vk_check(gpu, gpu->vk.vkCreateImageView(gpu->device, &info, NULL, &image->view),
                                        "create a view of the image", name);

    if (!status)
        sf_vk_name(gpu, VK_OBJECT_TYPE_IMAGE_VIEW, SF_VK_HANDLE(image->view), name);
    return status;
}

enum sf_status sf_vk_image_init(struct sf_gpu *gpu, const char *name, const VkImageCreateInfo *info,
                                enum sf_format format, const struct sf_place *home, uint64_t offset,
                                struct sf_vk_image *image)
{
    const VkImageUsageFlags viewed = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                                     VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    VkMemoryRequirements needs;
    enum sf_status status = sf_gpu_refuse_lost(gpu);

    if (status)
        return status;
    image->width = info->extent.width;
    image->height = info->extent.height;
    image->layers = info->arrayLayers;
    image->format = format;
    image->usage = info->usage;
    status = sf_vk_check(gpu, gpu->vk.vkCreateImage(gpu->device, info, NULL, &image->handle), "create the image", name);
    if (status)
        return status;
    sf_vk_name(gpu, VK_OBJECT_TYPE_IMAGE, SF_VK_HANDLE(image->handle), name);
    gpu->vk.vkGetImageMemoryRequirements(gpu->device, image->handle, &needs);
    if (!home || !sf_memory_type_fits(home, needs.memoryTypeBits)) {
        status = sf_memory_alloc(gpu, name, &needs, SF_MEMORY_DEVICE, &image->place);
        if (status)
            return status;
        home = &image->place;
        offset = 0;
    }
    status =
        sf_vk_check(gpu, gpu->vk.vkBindImageMemory(gpu->device, image->handle, home->memory, home->offset + offset),
                    "bind memory to the image", name);
    if (status || !(info->usage & viewed))
        return status;
    return sf_vk_image_view_init(gpu, name, image);
}

void sf_vk_image_finish(struct sf_gpu *gpu, struct sf_vk_image *image)
{
    if (image->view && !gpu->stuck)
        gpu->vk.vkDestroyImageView(gpu->device, image->view, NULL);
    if (image->handle && !gpu->stuck)
        gpu->vk.vkDestroyImage(gpu->device, image->handle, NULL);
    sf_memory_free(gpu, &image->place);
    *image = (struct sf_vk_image){0};
}

static void layout_barrier(struct sf_gpu *gpu, VkCommandBuffer commands, const struct sf_vk_image *image,
                           VkImageLayout from, VkImageLayout to)
{
    VkImageMemoryBarrier2 barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        .srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
        .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
        .dstStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
        .dstAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
        .oldLayout = from,
        .newLayout = to,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image->handle,
        .subresourceRange = sf_vk_image_range(image->format),
    };
    VkDependencyInfo dependency = {
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
        .imageMemoryBarrierCount = 1,
        .pImageMemoryBarriers = &barrier,
    };

    gpu->vk.vkCmdPipelineBarrier2(commands, &dependency);
}

/* Fills the image by way of a mapped buffer, or with zeros, and leaves it in the layout of `outside`. */
static enum sf_status image_fill(struct sf_gpu_image *image, const void *data)
{
    struct sf_gpu *gpu = image->gpu;
    const struct sf_vk_image *vk = &image->image;
    uint64_t bytes = (uint64_t)vk->width * vk->height * vk->layers * sf_format_bytes(vk->format);
    struct sf_vk_buffer staging = {0};
    VkBufferImageCopy region = {
        .imageSubresource = sf_vk_image_layers(vk->format, vk->layers),
        .imageExtent = {vk->width, vk->height, 1},
    };
    VkImageSubresourceRange range = sf_vk_image_range(vk->format);
    VkCommandBuffer commands;
    enum sf_status status = SF_OK;

    if (data)
        status = sf_vk_buffer_init(gpu, image->name, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, SF_MEMORY_UPLOAD, NULL, 0,
                                   &staging);
    if (!status && data)
        memcpy(staging.place.mapped, data, bytes);
    if (!status)
        status = sf_setup_begin(gpu, image->name, &commands);
    if (!status) {
        layout_barrier(gpu, commands, vk, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        if (data)
            gpu->vk.vkCmdCopyBufferToImage(commands, staging.handle, vk->handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                           1, &region);
        else
            gpu->vk.vkCmdClearColorImage(commands, vk->handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                         &(VkClearColorValue){.float32 = {0}}, 1, &range);
        layout_barrier(gpu, commands, vk, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                       sf_vk_layout(image->outside, vk->format));
        status = sf_setup_end(gpu, image->name);
    }
    sf_vk_buffer_finish(gpu, &staging);
    return status;
}

/* `data` NULL: zeros. */
static enum sf_status create_image(struct sf_gpu *gpu, const char *name, const VkImageCreateInfo *info,
                                   enum sf_format format, enum sf_access outside, const void *data,
                                   struct sf_gpu_image **out)
{
    uint32_t side = gpu->limits.maxImageDimension2D, most = gpu->limits.maxImageArrayLayers;
    uint32_t width = info->extent.width, height = info->extent.height, layers = info->arrayLayers;
    struct sf_gpu_image *image;
    const char *misfit;
    enum sf_status status;

    *out = NULL;
    if (width == 0 || height == 0 || width > side || height > side || layers > most)
        return sf_fail(
            gpu->log, SF_ERROR_USAGE,
            "the image '%s' cannot be %u x %u pixels in %u layers: this device takes 1 to %u a side, %u layers", name,
            width, height, layers, side, most);
    misfit = sf_vk_image_misfit(gpu, format, info->usage, info->usage & VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, false);
    if (misfit)
        return sf_fail(gpu->log, SF_ERROR_DEVICE, "the device does not support %s of %s, the format of the image '%s'",
                       misfit, sf_format_name(format), name);
    image = calloc(1, sizeof *image);
    if (!image || !(image->name = strdup(name))) {
        free(image);
        return sf_fail(gpu->log, SF_ERROR_MEMORY, "no memory for the image '%s'", name);
    }
    image->gpu = gpu;
    image->outside = outside;
    status = sf_vk_image_init(gpu, name, info, format, NULL, 0, &image->image);
    if (!status)
        status = image_fill(image, data);
    if (status)
        sf_gpu_image_destroy(&image);
    *out = image;
    return status;
}

enum sf_status sf_gpu_image_create(struct sf_gpu *gpu, const char *name, enum sf_format format, uint32_t width,
                                   uint32_t height, uint32_t layers, enum sf_access outside, const void *data,
                                   struct sf_gpu_image **image)
{
    VkImageUsageFlags usage = sf_vk_image_usage(1u << SF_ACCESS_SAMPLED | 1u << SF_ACCESS_TRANSFER_READ |
                                                1u << SF_ACCESS_TRANSFER_WRITE | 1u << outside);
    VkImageCreateInfo info = sf_vk_image_info(format, width, height, layers > 0 ? layers : 1, usage);

    return create_image(gpu, name, &info, format, outside, data, image);
}

enum sf_status sf_gpu_image_create_target(struct sf_gpu *gpu, const char *name, enum sf_format format, uint32_t width,
                                          uint32_t height, uint32_t accesses, enum sf_access outside,
                                          struct sf_gpu_image **image)
{
    VkImageUsageFlags usage = sf_vk_image_usage(accesses | 1u << SF_ACCESS_TRANSFER_WRITE | 1u << outside);
    VkImageCreateInfo info = sf_vk_image_info(format, width, height, 1, usage);

    return create_image(gpu, name, &info, format, outside, NULL, image);
}

void sf_gpu_image_destroy(struct sf_gpu_image **pointer)
{
    struct sf_gpu_image *image = pointer ? *pointer : NULL;

    if (!image)
        return;
    sf_gpu_settle(image->gpu);
    sf_vk_image_finish(image->gpu, &image->image);
    free(image->name);
    free(image);
    *pointer = NULL;
}
