/* Where a VkResult becomes a status, and where objects get their names. */
#include "gpu/vk.h"

static const char *result_text(VkResult result)
{
    switch (result) {
    case VK_TIMEOUT:
        return "the device did not answer in time";
    case VK_NOT_READY:
        return "not ready";
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        return "out of host memory";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        return "out of device memory";
    case VK_ERROR_OUT_OF_POOL_MEMORY:
        return "out of pool memory";
    case VK_ERROR_FRAGMENTED_POOL:
        return "fragmented pool";
    case VK_ERROR_MEMORY_MAP_FAILED:
        return "cannot be mapped";
    case VK_ERROR_TOO_MANY_OBJECTS:
        return "too many objects";
    case VK_ERROR_DEVICE_LOST:
        return "device lost";
    case VK_ERROR_INITIALIZATION_FAILED:
        return "initialization failed";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
        return "no Vulkan driver";
    case VK_ERROR_LAYER_NOT_PRESENT:
        return "layer not present";
    case VK_ERROR_EXTENSION_NOT_PRESENT:
        return "extension not present";
    case VK_ERROR_FEATURE_NOT_PRESENT:
        return "feature not present";
    case VK_ERROR_FORMAT_NOT_SUPPORTED:
        return "format not supported";
    case VK_ERROR_SURFACE_LOST_KHR:
        return "surface lost";
    case VK_ERROR_OUT_OF_DATE_KHR:
        return "surface changed";
    case VK_ERROR_NATIVE_WINDOW_IN_USE_KHR:
        return "window in use";
    default:
        return "failed";
    }
}

static enum sf_status result_status(VkResult result)
{
    switch (result) {
    case VK_SUCCESS:
        return SF_OK;
    case VK_ERROR_OUT_OF_HOST_MEMORY:
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
    case VK_ERROR_OUT_OF_POOL_MEMORY:
    case VK_ERROR_FRAGMENTED_POOL:
    case VK_ERROR_MEMORY_MAP_FAILED:
    case VK_ERROR_TOO_MANY_OBJECTS:
        return SF_ERROR_MEMORY;
    case VK_TIMEOUT:
    case VK_ERROR_DEVICE_LOST:
        return SF_ERROR_DEVICE_LOST;
    case VK_ERROR_INITIALIZATION_FAILED:
    case VK_ERROR_INCOMPATIBLE_DRIVER:
    case VK_ERROR_LAYER_NOT_PRESENT:
    case VK_ERROR_EXTENSION_NOT_PRESENT:
    case VK_ERROR_FEATURE_NOT_PRESENT:
    case VK_ERROR_FORMAT_NOT_SUPPORTED:
    case VK_ERROR_SURFACE_LOST_KHR:
    case VK_ERROR_OUT_OF_DATE_KHR:
    case VK_ERROR_NATIVE_WINDOW_IN_USE_KHR:
        return SF_ERROR_DEVICE;
    default:
        return SF_ERROR_INTERNAL;
    }
}

enum sf_status sf_vk_fail(const struct sf_log *log, VkResult result, const char *doing, const char *what)
{
    return sf_fail(log, result_status(result), "cannot %s '%s': %s (VkResult %d)", doing, what, result_text(result),
                   (int)result);
}

enum sf_status sf_vk_check(struct sf_gpu *gpu, VkResult result, const char *doing, const char *what)
{
    if (result == VK_SUCCESS)
        return SF_OK;
    if (result_status(result) == SF_ERROR_DEVICE_LOST)
        atomic_store(&gpu->lost, SF_ERROR_DEVICE_LOST);
    return sf_vk_fail(gpu->log, result, doing, what);
}

void sf_vk_name(struct sf_gpu *gpu, VkObjectType type, uint64_t handle, const char *name)
{
    VkDebugUtilsObjectNameInfoEXT info = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
        .objectType = type,
        .objectHandle = handle,
        .pObjectName = name,
    };

    /* A name that cannot be kept is no reason to stop. */
    if (gpu->debug_utils)
        vkSetDebugUtilsObjectNameEXT(gpu->device, &info);
}
