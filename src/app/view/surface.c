/* The one file of the program that sees Vulkan: GLFW makes the window's surface for the instance that the library has. */
#include <vulkan/vulkan_core.h>

#include <GLFW/glfw3.h>

#include "surface.h"

enum sf_status sf_surface_create(void *user, void *instance, uint64_t *surface)
{
    VkSurfaceKHR handle = VK_NULL_HANDLE;
    VkResult result = glfwCreateWindowSurface((VkInstance)instance, user, NULL, &handle);

    *surface = (uint64_t)(uintptr_t)handle;
    if (result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY)
        return SF_ERROR_MEMORY;
    return result == VK_SUCCESS ? SF_OK : SF_ERROR_DEVICE;
}
