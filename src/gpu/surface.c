/* The surface that the host's windowing library makes for us: its life, and what the device can do with it. */
#include "gpu/vk.h"

#include <string.h>

_Static_assert(sizeof(VkSurfaceKHR) == sizeof(uint64_t), "a surface goes through the host as 64 bits");

static const VkPresentModeKHR MODES[SF_PRESENT_COUNT] = {
    [SF_PRESENT_FIFO] = VK_PRESENT_MODE_FIFO_KHR,
    [SF_PRESENT_FIFO_RELAXED] = VK_PRESENT_MODE_FIFO_RELAXED_KHR,
    [SF_PRESENT_MAILBOX] = VK_PRESENT_MODE_MAILBOX_KHR,
    [SF_PRESENT_IMMEDIATE] = VK_PRESENT_MODE_IMMEDIATE_KHR,
};

const char *sf_present_mode_name(enum sf_present_mode mode)
{
    static const char *const names[SF_PRESENT_COUNT] = {
        [SF_PRESENT_FIFO] = "fifo",
        [SF_PRESENT_FIFO_RELAXED] = "fifo_relaxed",
        [SF_PRESENT_MAILBOX] = "mailbox",
        [SF_PRESENT_IMMEDIATE] = "immediate",
    };

    return (unsigned)mode < SF_PRESENT_COUNT ? names[mode] : NULL;
}

VkPresentModeKHR sf_vk_present_mode(enum sf_present_mode mode)
{
    return MODES[mode];
}

static enum sf_status create(struct sf_gpu *gpu)
{
    struct sf_surface *surface = &gpu->surface;
    uint64_t made = 0;
    enum sf_status status = surface->source.create(surface->source.user, gpu->instance, &made);

    if (status)
        return sf_fail(gpu->log, status, "the window gives no surface to show pictures on");
    if (!made)
        return sf_fail(gpu->log, SF_ERROR_INTERNAL,
                       "the window's function says that it made a surface, but gives none");
    memcpy(&surface->handle, &made, sizeof made);
    surface->lost = false;
    return SF_OK;
}

enum sf_status sf_surface_init(struct sf_gpu *gpu)
{
    struct sf_surface *surface = &gpu->surface;

    if (!surface->source.create)
        return SF_OK;
#define LOAD(field, name)                                                                                              \
    ((surface->field = (PFN_##name)(void (*)(void))vkGetInstanceProcAddr(gpu->instance, #name)) != NULL)
    if (!LOAD(destroy, vkDestroySurfaceKHR) || !LOAD(support, vkGetPhysicalDeviceSurfaceSupportKHR) ||
        !LOAD(capabilities, vkGetPhysicalDeviceSurfaceCapabilitiesKHR) ||
        !LOAD(formats, vkGetPhysicalDeviceSurfaceFormatsKHR) ||
        !LOAD(present_modes, vkGetPhysicalDeviceSurfacePresentModesKHR))
        return sf_fail(gpu->log, SF_ERROR_DEVICE,
                       "the window does not name " VK_KHR_SURFACE_EXTENSION_NAME " among the extensions that it needs");
#undef LOAD
    return create(gpu);
}

bool sf_surface_takes(const struct sf_surface *surface, VkPhysicalDevice physical, uint32_t family)
{
    VkBool32 takes = VK_FALSE;

    return surface->support(physical, family, surface->handle, &takes) == VK_SUCCESS && takes;
}

static enum sf_status learn_modes(struct sf_gpu *gpu)
{
    enum { MOST = 16 };
    VkPresentModeKHR modes[MOST];
    uint32_t count = MOST;
    VkResult result = gpu->surface.present_modes(gpu->physical, gpu->surface.handle, &count, modes);

    if (result != VK_INCOMPLETE && result != VK_SUCCESS)
        return sf_vk_check(gpu, result, "list the present modes of", gpu->info.name);
    gpu->surface.modes = 0;
    for (uint32_t i = 0; i < count; i++)
        for (int mode = 0; mode < SF_PRESENT_COUNT; mode++)
            if (modes[i] == MODES[mode])
                gpu->surface.modes |= 1u << mode;
    return SF_OK;
}

/* 8 bits a channel, unsigned and as they are: sRGB's curve is ours to apply. */
static enum sf_status learn_format(struct sf_gpu *gpu)
{
    enum { MOST = 256 };
    VkSurfaceFormatKHR formats[MOST];
    uint32_t count = MOST;
    VkResult result = gpu->surface.formats(gpu->physical, gpu->surface.handle, &count, formats);

    if (result != VK_INCOMPLETE && result != VK_SUCCESS)
        return sf_vk_check(gpu, result, "list the formats of the surface on", gpu->info.name);
    for (uint32_t i = 0; i < count; i++)
        if ((formats[i].format == VK_FORMAT_B8G8R8A8_UNORM || formats[i].format == VK_FORMAT_R8G8B8A8_UNORM) &&
            formats[i].colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) {
            gpu->surface.format = formats[i];
            return SF_OK;
        }
    return sf_fail(gpu->log, SF_ERROR_DEVICE,
                   "the device '%s' shows neither bgra8_unorm nor rgba8_unorm pictures in this window", gpu->info.name);
}

enum sf_status sf_surface_learn(struct sf_gpu *gpu)
{
    enum sf_status status = gpu->surface.handle ? learn_modes(gpu) : SF_OK;

    return status || !gpu->surface.handle ? status : learn_format(gpu);
}

enum sf_status sf_surface_renew(struct sf_gpu *gpu)
{
    enum sf_status status;

    sf_log(gpu->log, SF_LOG_INFO, "the window's surface was lost: making another");
    sf_surface_finish(gpu);
    status = create(gpu);
    if (!status && !sf_surface_takes(&gpu->surface, gpu->physical, gpu->family))
        status = sf_fail(gpu->log, SF_ERROR_DEVICE, "the device '%s' cannot show pictures on the window's new surface",
                         gpu->info.name);
    if (!status)
        status = sf_surface_learn(gpu);
    gpu->surface.lost = status != SF_OK;
    return status;
}

void sf_surface_finish(struct sf_gpu *gpu)
{
    if (gpu->surface.handle)
        gpu->surface.destroy(gpu->instance, gpu->surface.handle, NULL);
    gpu->surface.handle = VK_NULL_HANDLE;
}
