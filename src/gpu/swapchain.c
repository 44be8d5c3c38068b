/* The images that a surface shows.
 *
 * One frame draws one image. Acquiring it signals the semaphore of the frame's slot, for which the submission waits in
 * the stage of SF_ACCESS_PRESENT: the graph's barriers around the image begin and end there, so that its change of
 * layout comes after. The submission signals the semaphore of the image, for which presenting waits. The slot's
 * semaphore is free again when the slot is (its submission is done), the image's when the image is acquired again.
 *
 * What makes a swapchain useless (surface changed or lost) is remembered, never an error: acquire gives no image until
 * sf_swapchain_renew. */
#include "gpu/vk.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NO_IMAGE = -1 };

static const uint64_t ACQUIRE_NS = 1000ull * 1000 * 1000;

struct sf_swapchain {
    struct sf_gpu *gpu;
    VkSwapchainKHR handle; /* none while the surface has no size */
    uint32_t width, height;
    uint32_t count;              /* images */
    struct sf_gpu_image *images; /* [count]; their VkImages are the swapchain's, their views ours */
    VkSemaphore *drawn;          /* [count] */
    VkSemaphore acquired[SF_FRAMES_IN_FLIGHT];
    int current;     /* the image of the open frame */
    bool useless;    /* until it is renewed */
    bool suboptimal; /* as the last present said */
};

static enum sf_status create_semaphore(struct sf_gpu *gpu, const char *name, VkSemaphore *semaphore)
{
    VkSemaphoreCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    enum sf_status status =
        sf_vk_check(gpu, gpu->vk.vkCreateSemaphore(gpu->device, &info, NULL, semaphore), "create the semaphore", name);

    if (!status)
        sf_vk_name(gpu, VK_OBJECT_TYPE_SEMAPHORE, SF_VK_HANDLE(*semaphore), name);
    return status;
}

/* Until the device is done with the images, and has handed the last of them over to be shown. */
static void settle(struct sf_gpu *gpu)
{
    sf_gpu_settle(gpu);
    if (!gpu->stuck)
        gpu->vk.vkQueueWaitIdle(gpu->queue); /* a lost device is idle, too */
}

/* Frees all but the handle, which the next swapchain may want to see. */
static void release_images(struct sf_swapchain *swapchain)
{
    struct sf_gpu *gpu = swapchain->gpu;

    for (uint32_t i = 0; swapchain->images && i < swapchain->count; i++) {
        swapchain->images[i].image.handle = VK_NULL_HANDLE;
        sf_vk_image_finish(gpu, &swapchain->images[i].image);
        free(swapchain->images[i].name);
    }
    for (uint32_t i = 0; swapchain->drawn && i < swapchain->count && !gpu->stuck; i++)
        gpu->vk.vkDestroySemaphore(gpu->device, swapchain->drawn[i], NULL);
    free(swapchain->images);
    free(swapchain->drawn);
    swapchain->images = NULL;
    swapchain->drawn = NULL;
    swapchain->count = swapchain->width = swapchain->height = 0;
    swapchain->current = NO_IMAGE;
}

static void release_handle(struct sf_swapchain *swapchain)
{
    if (swapchain->handle && !swapchain->gpu->stuck)
        swapchain->gpu->vk.vkDestroySwapchainKHR(swapchain->gpu->device, swapchain->handle, NULL);
    swapchain->handle = VK_NULL_HANDLE;
}

static enum sf_format format_of(const struct sf_gpu *gpu)
{
    return gpu->surface.format.format == VK_FORMAT_B8G8R8A8_UNORM ? SF_FORMAT_BGRA8_UNORM : SF_FORMAT_RGBA8_UNORM;
}

static enum sf_status wrap_images(struct sf_swapchain *swapchain, const VkImage *handles, uint32_t count)
{
    struct sf_gpu *gpu = swapchain->gpu;
    enum sf_status status = SF_OK;

    swapchain->images = calloc(count, sizeof *swapchain->images);
    swapchain->drawn = calloc(count, sizeof *swapchain->drawn);
    swapchain->count = count;
    if (!swapchain->images || !swapchain->drawn)
        return sf_fail(gpu->log, SF_ERROR_MEMORY, "no memory for the swapchain's images");
    for (uint32_t i = 0; i < count && !status; i++) {
        struct sf_gpu_image *image = &swapchain->images[i];
        char name[32];

        snprintf(name, sizeof name, "swapchain %u", i);
        *image = (struct sf_gpu_image){
            .gpu = gpu,
            .name = strdup(name),
            .image = {.handle = handles[i],
                      .width = swapchain->width,
                      .height = swapchain->height,
                      .layers = 1,
                      .format = format_of(gpu),
                      .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT},
            .outside = SF_ACCESS_PRESENT,
        };
        if (!image->name)
            return sf_fail(gpu->log, SF_ERROR_MEMORY, "no memory for the swapchain's images");
        sf_vk_name(gpu, VK_OBJECT_TYPE_IMAGE, SF_VK_HANDLE(handles[i]), name);
        status = sf_vk_image_view_init(gpu, name, &image->image);
        if (!status)
            status = create_semaphore(gpu, name, &swapchain->drawn[i]);
    }
    return status;
}

static enum sf_status take_images(struct sf_swapchain *swapchain)
{
    struct sf_gpu *gpu = swapchain->gpu;
    VkImage *handles = NULL;
    uint32_t count = 0;
    VkResult result = gpu->vk.vkGetSwapchainImagesKHR(gpu->device, swapchain->handle, &count, NULL);
    enum sf_status status;

    if (result == VK_SUCCESS) {
        handles = calloc(count + 1, sizeof(VkImage));
        result = handles ? gpu->vk.vkGetSwapchainImagesKHR(gpu->device, swapchain->handle, &count, handles)
                         : VK_ERROR_OUT_OF_HOST_MEMORY;
    }
    status = sf_vk_check(gpu, result, "get the images of", "swapchain");
    if (!status)
        status = wrap_images(swapchain, handles, count);
    free(handles);
    return status;
}

static uint32_t clamp(uint32_t value, uint32_t least, uint32_t most)
{
    return value < least ? least : value > most ? most : value;
}

/* Some surfaces have a size, others take that of their images. 0 x 0: nothing can be shown now. */
static VkExtent2D choose_extent(const VkSurfaceCapabilitiesKHR *has, uint32_t width, uint32_t height)
{
    if (width == 0 || height == 0)
        return (VkExtent2D){0, 0};
    if (has->currentExtent.width != UINT32_MAX)
        return has->currentExtent;
    return (VkExtent2D){clamp(width, has->minImageExtent.width, has->maxImageExtent.width),
                        clamp(height, has->minImageExtent.height, has->maxImageExtent.height)};
}

/* The lowest of the bits: opaque, where that can be had. */
static VkCompositeAlphaFlagBitsKHR choose_alpha(VkCompositeAlphaFlagsKHR has)
{
    return (VkCompositeAlphaFlagBitsKHR)(has & (~has + 1));
}

/* Puts images of the surface's size in place of the old ones. A surface that is lost is remembered, and SF_OK. */
static enum sf_status make(struct sf_swapchain *swapchain, uint32_t width, uint32_t height, enum sf_present_mode mode)
{
    struct sf_gpu *gpu = swapchain->gpu;
    struct sf_surface *surface = &gpu->surface;
    VkSurfaceCapabilitiesKHR has;
    VkSwapchainCreateInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
        .surface = surface->handle,
        .imageFormat = surface->format.format,
        .imageColorSpace = surface->format.colorSpace,
        .imageArrayLayers = 1,
        .imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
        .imageSharingMode = VK_SHARING_MODE_EXCLUSIVE,
        .presentMode = sf_vk_present_mode(mode),
        .clipped = VK_TRUE,
        .oldSwapchain = swapchain->handle,
    };
    VkSwapchainKHR handle = VK_NULL_HANDLE;
    VkResult result = surface->capabilities(gpu->physical, surface->handle, &has);
    enum sf_status status;

    if (result == VK_SUCCESS) {
        info.imageExtent = choose_extent(&has, width, height);
        if (info.imageExtent.width == 0 || info.imageExtent.height == 0) {
            release_handle(swapchain);
            return SF_OK;
        }
        info.minImageCount = clamp(has.minImageCount + 1, 1, has.maxImageCount ? has.maxImageCount : UINT32_MAX);
        info.preTransform = has.currentTransform;
        info.compositeAlpha = choose_alpha(has.supportedCompositeAlpha);
        result = gpu->vk.vkCreateSwapchainKHR(gpu->device, &info, NULL, &handle);
    }
    release_handle(swapchain);
    if (result == VK_ERROR_SURFACE_LOST_KHR) {
        surface->lost = true;
        return SF_OK;
    }
    status = sf_vk_check(gpu, result, "create", "swapchain");
    if (status)
        return status;
    sf_vk_name(gpu, VK_OBJECT_TYPE_SWAPCHAIN_KHR, SF_VK_HANDLE(handle), "swapchain");
    swapchain->handle = handle;
    swapchain->width = info.imageExtent.width;
    swapchain->height = info.imageExtent.height;
    status = take_images(swapchain);
    if (status) {
        release_images(swapchain);
        release_handle(swapchain);
    }
    return status;
}

static enum sf_status check_mode(struct sf_gpu *gpu, enum sf_present_mode mode)
{
    struct sf_text names = {0};
    enum sf_status status;

    if ((unsigned)mode < SF_PRESENT_COUNT && gpu->surface.modes & 1u << mode)
        return SF_OK;
    for (int i = 0; i < SF_PRESENT_COUNT; i++)
        if (gpu->surface.modes & 1u << i)
            sf_text_printf(&names, "%s%s", names.length ? ", " : "", sf_present_mode_name((enum sf_present_mode)i));
    status = sf_fail(gpu->log, SF_ERROR_USAGE, "the window has no present mode '%s'; it has: %s",
                     sf_present_mode_name(mode) ? sf_present_mode_name(mode) : "(no such mode)",
                     names.data ? names.data : "");
    sf_text_finish(&names);
    return status;
}

static enum sf_status check_surface(struct sf_gpu *gpu)
{
    if (gpu->surface.source.create)
        return SF_OK;
    return sf_fail(gpu->log, SF_ERROR_USAGE, "the device '%s' was created without a surface to show pictures on",
                   gpu->info.name);
}

enum sf_status sf_swapchain_modes(struct sf_gpu *gpu, uint32_t *modes)
{
    *modes = gpu->surface.modes;
    return check_surface(gpu);
}

enum sf_status sf_swapchain_renew(struct sf_swapchain *swapchain, uint32_t width, uint32_t height,
                                  enum sf_present_mode mode)
{
    struct sf_gpu *gpu = swapchain->gpu;
    enum sf_status status = sf_gpu_refuse_lost(gpu);

    if (!status && swapchain->current != NO_IMAGE)
        status = sf_fail(gpu->log, SF_ERROR_USAGE, "the swapchain is renewed while a frame draws one of its images");
    if (!status)
        status = check_mode(gpu, mode);
    if (status)
        return status;
    settle(gpu);
    release_images(swapchain);
    if (gpu->stuck)
        return sf_fail(gpu->log, SF_ERROR_DEVICE_LOST, "the device '%s' does not let go of the swapchain",
                       gpu->info.name);
    swapchain->suboptimal = false;
    /* Once more on a new surface, if the old one turns out to be lost only now. */
    for (int i = 0; i < 2; i++) {
        if (gpu->surface.lost) {
            release_handle(swapchain);
            status = sf_surface_renew(gpu);
            if (!status)
                status = check_mode(gpu, mode);
        }
        if (!status)
            status = make(swapchain, width, height, mode);
        if (status || !gpu->surface.lost)
            break;
    }
    swapchain->useless = false; /* without images it gives none anyway */
    return status;
}

enum sf_status sf_swapchain_create(struct sf_gpu *gpu, uint32_t width, uint32_t height, enum sf_present_mode mode,
                                   struct sf_swapchain **out)
{
    static const char *const names[SF_FRAMES_IN_FLIGHT] = {"image acquired, even frames", "image acquired, odd frames"};
    struct sf_swapchain *swapchain;
    enum sf_status status = check_surface(gpu);

    *out = NULL;
    if (!status && gpu->swapchain)
        status = sf_fail(gpu->log, SF_ERROR_USAGE, "the device '%s' has a swapchain already", gpu->info.name);
    if (status)
        return status;
    swapchain = calloc(1, sizeof *swapchain);
    if (!swapchain)
        return sf_fail(gpu->log, SF_ERROR_MEMORY, "no memory for the swapchain");
    swapchain->gpu = gpu;
    swapchain->current = NO_IMAGE;
    gpu->swapchain = swapchain;
    for (int i = 0; i < SF_FRAMES_IN_FLIGHT && !status; i++)
        status = create_semaphore(gpu, names[i], &swapchain->acquired[i]);
    if (!status)
        status = sf_swapchain_renew(swapchain, width, height, mode);
    if (status)
        sf_swapchain_destroy(&swapchain);
    *out = swapchain;
    return status;
}

void sf_swapchain_destroy(struct sf_swapchain **pointer)
{
    struct sf_swapchain *swapchain = pointer ? *pointer : NULL;
    struct sf_gpu *gpu;

    if (!swapchain)
        return;
    gpu = swapchain->gpu;
    if (swapchain->current != NO_IMAGE) /* the open frame's commands may name what goes now: they never run */
        atomic_store(&gpu->lost, SF_ERROR_USAGE);
    settle(gpu);
    release_images(swapchain);
    release_handle(swapchain);
    for (int i = 0; i < SF_FRAMES_IN_FLIGHT && !gpu->stuck; i++)
        gpu->vk.vkDestroySemaphore(gpu->device, swapchain->acquired[i], NULL);
    gpu->swapchain = NULL;
    free(swapchain);
    *pointer = NULL;
}

void sf_swapchain_extent(const struct sf_swapchain *swapchain, uint32_t *width, uint32_t *height, uint32_t *images,
                         enum sf_format *format)
{
    if (width)
        *width = swapchain->width;
    if (height)
        *height = swapchain->height;
    if (images)
        *images = swapchain->count;
    if (format)
        *format = format_of(swapchain->gpu);
}

bool sf_swapchain_suboptimal(const struct sf_swapchain *swapchain)
{
    return swapchain->suboptimal;
}

/* Takes note of what acquiring and presenting say besides yes and no; true when it was that. */
static bool remember(struct sf_swapchain *swapchain, VkResult result)
{
    if (result == VK_ERROR_SURFACE_LOST_KHR)
        swapchain->gpu->surface.lost = true;
    if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_ERROR_SURFACE_LOST_KHR)
        swapchain->useless = true;
    return swapchain->useless;
}

enum sf_status sf_swapchain_acquire(struct sf_swapchain *swapchain, struct sf_gpu_image **image)
{
    struct sf_gpu *gpu = swapchain->gpu;
    uint64_t serial = atomic_load(&gpu->submitted) + 1;
    uint32_t index = 0;
    VkResult result;

    *image = NULL;
    if (!gpu->recording)
        return sf_fail(gpu->log, SF_ERROR_USAGE, "an image to show is acquired outside of a frame");
    if (swapchain->current != NO_IMAGE)
        return sf_fail(gpu->log, SF_ERROR_USAGE, "a second image to show is acquired in a frame");
    if (swapchain->count == 0 || swapchain->useless)
        return SF_OK;
    result = gpu->vk.vkAcquireNextImageKHR(gpu->device, swapchain->handle, ACQUIRE_NS,
                                           swapchain->acquired[serial % SF_FRAMES_IN_FLIGHT], VK_NULL_HANDLE, &index);
    if (result == VK_TIMEOUT || result == VK_NOT_READY || remember(swapchain, result))
        return SF_OK;
    if (result != VK_SUCCESS && result != VK_SUBOPTIMAL_KHR)
        return sf_vk_check(gpu, result, "acquire an image of", "swapchain");
    swapchain->current = (int)index;
    *image = &swapchain->images[index];
    (*image)->acquired = serial;
    (*image)->drawn = false;
    return SF_OK;
}

/* ---- the end of a frame ---- */

static void move_image(struct sf_gpu *gpu, VkCommandBuffer commands, const struct sf_gpu_image *image,
                       enum sf_access from, enum sf_access to)
{
    struct sf_scope before = sf_scope_of((struct sf_touch){from, SF_PASS_RASTER}),
                    after = sf_scope_of((struct sf_touch){to, SF_PASS_RASTER});
    VkImageMemoryBarrier2 barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        .srcStageMask = before.stages,
        .srcAccessMask = before.writes,
        .dstStageMask = after.stages,
        .dstAccessMask = after.reads | after.writes,
        .oldLayout = from == SF_ACCESS_PRESENT ? VK_IMAGE_LAYOUT_UNDEFINED : sf_vk_layout(from, image->image.format),
        .newLayout = sf_vk_layout(to, image->image.format),
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image->image.handle,
        .subresourceRange = sf_vk_image_range(image->image.format),
    };
    VkDependencyInfo dependency = {
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
        .imageMemoryBarrierCount = 1,
        .pImageMemoryBarriers = &barrier,
    };

    gpu->vk.vkCmdPipelineBarrier2(commands, &dependency);
}

/* An image that was acquired can only be given back by showing it. */
static void make_black(struct sf_gpu *gpu, VkCommandBuffer commands, const struct sf_gpu_image *image)
{
    VkRenderingAttachmentInfo color = {
        .sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
        .imageView = image->image.view,
        .imageLayout = sf_vk_layout(SF_ACCESS_COLOR, image->image.format),
        .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
        .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
        .clearValue.color.float32 = {0, 0, 0, 1},
    };
    VkRenderingInfo rendering = {
        .sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
        .renderArea = {.extent = {image->image.width, image->image.height}},
        .layerCount = 1,
        .colorAttachmentCount = 1,
        .pColorAttachments = &color,
    };

    move_image(gpu, commands, image, SF_ACCESS_PRESENT, SF_ACCESS_COLOR);
    gpu->vk.vkCmdBeginRendering(commands, &rendering);
    gpu->vk.vkCmdEndRendering(commands);
    move_image(gpu, commands, image, SF_ACCESS_COLOR, SF_ACCESS_PRESENT);
}

struct sf_showing sf_swapchain_close_frame(struct sf_gpu *gpu, VkCommandBuffer commands)
{
    const struct sf_swapchain *swapchain = gpu->swapchain;

    if (!swapchain || swapchain->current == NO_IMAGE)
        return (struct sf_showing){VK_NULL_HANDLE, VK_NULL_HANDLE};
    if (!swapchain->images[swapchain->current].drawn)
        make_black(gpu, commands, &swapchain->images[swapchain->current]);
    return (struct sf_showing){
        .acquired = swapchain->acquired[(atomic_load(&gpu->submitted) + 1) % SF_FRAMES_IN_FLIGHT],
        .drawn = swapchain->drawn[swapchain->current],
    };
}

enum sf_status sf_swapchain_present(struct sf_gpu *gpu)
{
    struct sf_swapchain *swapchain = gpu->swapchain;
    uint32_t index;
    VkPresentInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
        .waitSemaphoreCount = 1,
        .swapchainCount = 1,
        .pImageIndices = &index,
    };
    VkResult result;

    if (!swapchain || swapchain->current == NO_IMAGE)
        return SF_OK;
    index = (uint32_t)swapchain->current;
    swapchain->current = NO_IMAGE;
    info.pWaitSemaphores = &swapchain->drawn[index];
    info.pSwapchains = &swapchain->handle;
    result = gpu->vk.vkQueuePresentKHR(gpu->queue, &info);
    swapchain->suboptimal = result == VK_SUBOPTIMAL_KHR;
    if (swapchain->suboptimal || remember(swapchain, result)) /* the semaphore was waited for all the same */
        return SF_OK;
    return sf_vk_check(gpu, result, "show an image of", "swapchain");
}
