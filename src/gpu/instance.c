/* The loader, the instance and its layers, and the choice of a physical device. */
#define VOLK_IMPLEMENTATION
#include "gpu/vk.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char VALIDATION_LAYER[] = "VK_LAYER_KHRONOS_validation";

/* volk keeps the loader's functions in globals, which are the same for every instance: filled under a lock. */
static pthread_mutex_t loader_lock = PTHREAD_MUTEX_INITIALIZER;

static bool has_layer(const char *name)
{
    VkLayerProperties *layers;
    uint32_t count = 0;
    bool found = false;

    if (vkEnumerateInstanceLayerProperties(&count, NULL) != VK_SUCCESS || count == 0)
        return false;
    layers = calloc(count, sizeof *layers);
    if (layers && vkEnumerateInstanceLayerProperties(&count, layers) >= VK_SUCCESS)
        for (uint32_t i = 0; i < count; i++)
            found = found || strcmp(layers[i].layerName, name) == 0;
    free(layers);
    return found;
}

static VkResult list_extensions(VkPhysicalDevice physical, uint32_t *count, VkExtensionProperties *extensions)
{
    return physical ? vkEnumerateDeviceExtensionProperties(physical, NULL, count, extensions)
                    : vkEnumerateInstanceExtensionProperties(NULL, count, extensions);
}

bool sf_has_extension(VkPhysicalDevice physical, const char *name)
{
    VkExtensionProperties *extensions;
    uint32_t count = 0;
    bool found = false;

    if (list_extensions(physical, &count, NULL) != VK_SUCCESS || count == 0)
        return false;
    extensions = calloc(count, sizeof *extensions);
    if (extensions && list_extensions(physical, &count, extensions) >= VK_SUCCESS)
        for (uint32_t i = 0; i < count; i++)
            found = found || strcmp(extensions[i].extensionName, name) == 0;
    free(extensions);
    return found;
}

/* With the extensions that the surface needs, and as many of those that are good to have as can be had. Asking which
 * there are makes the loader open every driver, and close it again: rather ask for them, and for fewer when it says no.
 */
static VkResult create_with(VkInstanceCreateInfo *info, const struct sf_surface_source *surface, VkInstance *instance,
                            bool *debug_utils)
{
    static const char *const wanted[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME,
                                         VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME};
    uint32_t needed = surface ? surface->extension_count : 0;
    const char **names = calloc(needed + SF_COUNT(wanted), sizeof *names);
    VkResult result = VK_ERROR_EXTENSION_NOT_PRESENT;

    if (!names)
        return VK_ERROR_OUT_OF_HOST_MEMORY;
    for (uint32_t i = 0; i < needed; i++)
        names[i] = surface->extensions[i];
    for (uint32_t i = 0; i < SF_COUNT(wanted); i++)
        names[needed + i] = wanted[i];
    info->ppEnabledExtensionNames = names;
    for (uint32_t count = SF_COUNT(wanted) + 1; count-- > 0 && result == VK_ERROR_EXTENSION_NOT_PRESENT;) {
        info->enabledExtensionCount = needed + count;
        info->flags = count == SF_COUNT(wanted) ? VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR : 0;
        *debug_utils = count > 0;
        result = vkCreateInstance(info, NULL, instance);
    }
    free(names);
    return result;
}

static enum sf_status create_locked(bool validate, const VkDebugUtilsMessengerCreateInfoEXT *messenger,
                                    const struct sf_surface_source *surface, const struct sf_log *log,
                                    VkInstance *instance, bool *debug_utils)
{
    static const VkValidationFeatureEnableEXT enables[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    const char *layers[] = {VALIDATION_LAYER};
    VkApplicationInfo application = {
        .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
        .pApplicationName = "sfumato",
        .pEngineName = "sfumato",
        .apiVersion = VK_API_VERSION_1_3,
    };
    VkValidationFeaturesEXT features = {
        .sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
        .pNext = messenger,
        .enabledValidationFeatureCount = SF_COUNT(enables),
        .pEnabledValidationFeatures = enables,
    };
    VkInstanceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pApplicationInfo = &application,
        .ppEnabledLayerNames = layers,
    };
    VkResult result;

    if (volkInitialize() != VK_SUCCESS)
        return sf_fail(log, SF_ERROR_DEVICE, "no Vulkan loader (libvulkan.so.1): install the package libvulkan1");
    if (volkGetInstanceVersion() < VK_API_VERSION_1_3)
        return sf_fail(log, SF_ERROR_DEVICE, "the Vulkan loader is older than 1.3: bring libvulkan1 up to date");
    if (validate) {
        if (!has_layer(VALIDATION_LAYER))
            return sf_fail(log, SF_ERROR_DEVICE,
                           "validation was asked for, but the layer %s is missing: install the package "
                           "vulkan-validationlayers",
                           VALIDATION_LAYER);
        info.enabledLayerCount = 1;
        info.pNext = &features;
    }
    result = create_with(&info, surface, instance, debug_utils);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
        return sf_fail(log, SF_ERROR_DEVICE,
                       "no Vulkan driver: install one for your GPU, or the package mesa-vulkan-drivers for the CPU");
    for (uint32_t i = 0; result == VK_ERROR_EXTENSION_NOT_PRESENT && surface && i < surface->extension_count; i++)
        if (!sf_has_extension(VK_NULL_HANDLE, surface->extensions[i]))
            return sf_fail(log, SF_ERROR_DEVICE,
                           "the window needs the Vulkan extension %s, which no driver here has: bring libvulkan1 and "
                           "the driver up to date",
                           surface->extensions[i]);
    if (result != VK_SUCCESS)
        return sf_vk_fail(log, result, "create", "Vulkan instance");
    volkLoadInstanceOnly(*instance);
    return SF_OK;
}

enum sf_status sf_instance_create(bool validate, const VkDebugUtilsMessengerCreateInfoEXT *messenger,
                                  const struct sf_surface_source *surface, const struct sf_log *log,
                                  VkInstance *instance, bool *debug_utils)
{
    enum sf_status status;

    pthread_mutex_lock(&loader_lock);
    status = create_locked(validate, messenger, surface, log, instance, debug_utils);
    pthread_mutex_unlock(&loader_lock);
    return status;
}

static const char *kind_name(VkPhysicalDeviceType type)
{
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return "discrete";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return "integrated";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return "virtual";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return "cpu";
    default:
        return "other";
    }
}

/* The first family that draws, computes and copies, and shows when there is a surface; its queues do all our work. */
static uint32_t find_family(VkPhysicalDevice physical, const struct sf_surface *surface)
{
    enum { FAMILIES_MAX = 32 };
    VkQueueFamilyProperties families[FAMILIES_MAX];
    uint32_t count = FAMILIES_MAX;

    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families);
    for (uint32_t i = 0; i < count; i++) {
        VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;

        if ((families[i].queueFlags & wanted) == wanted && (!surface || sf_surface_takes(surface, physical, i)))
            return i;
    }
    return UINT32_MAX;
}

static const char *missing_feature(VkPhysicalDevice physical)
{
    VkPhysicalDeviceVulkan13Features f13 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features f12 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
                                            .pNext = &f13};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &f12};

    vkGetPhysicalDeviceFeatures2(physical, &features);
    if (!f13.dynamicRendering)
        return "the feature dynamicRendering is missing";
    if (!f13.synchronization2)
        return "the feature synchronization2 is missing";
    if (!f13.maintenance4)
        return "the feature maintenance4 is missing";
    if (!f12.timelineSemaphore)
        return "the feature timelineSemaphore is missing";
    return NULL;
}

static void format_uuid(const uint8_t uuid[VK_UUID_SIZE], char text[37])
{
    char *p = text;

    for (unsigned i = 0; i < VK_UUID_SIZE; i++) {
        if (i == 4 || i == 6 || i == 8 || i == 10)
            *p++ = '-';
        p += snprintf(p, 3, "%02x", uuid[i]);
    }
}

uint32_t sf_physical_describe(VkPhysicalDevice physical, const struct sf_surface *surface, struct sf_gpu_info *info)
{
    VkPhysicalDeviceDriverProperties driver = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceIDProperties id = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES, .pNext = &driver};
    VkPhysicalDeviceSubgroupProperties subgroup = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES,
                                                   .pNext = &id};
    VkPhysicalDeviceProperties2 properties = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    VkPhysicalDeviceMemoryProperties memory;
    const VkPhysicalDeviceProperties *p = &properties.properties;
    bool shows = surface && surface->handle;
    uint32_t family = find_family(physical, shows ? surface : NULL);
    const char *because = NULL;

    *info = (struct sf_gpu_info){0};
    vkGetPhysicalDeviceProperties2(physical, &properties);
    if (p->apiVersion >= VK_API_VERSION_1_2) { /* older ones do not know the structures */
        properties.pNext = &subgroup;
        vkGetPhysicalDeviceProperties2(physical, &properties);
    }
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);
    snprintf(info->name, sizeof info->name, "%s", p->deviceName);
    snprintf(info->driver, sizeof info->driver, "%.120s %.120s", driver.driverName, driver.driverInfo);
    format_uuid(id.deviceUUID, info->uuid);
    snprintf(info->kind, sizeof info->kind, "%s", kind_name(p->deviceType));
    info->api_major = VK_API_VERSION_MAJOR(p->apiVersion);
    info->api_minor = VK_API_VERSION_MINOR(p->apiVersion);
    info->api_patch = VK_API_VERSION_PATCH(p->apiVersion);
    for (uint32_t i = 0; i < memory.memoryHeapCount; i++)
        if (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT &&
            memory.memoryHeaps[i].size > info->memory_bytes)
            info->memory_bytes = memory.memoryHeaps[i].size;
    info->subgroup_size = subgroup.subgroupSize;
    info->max_image_side = p->limits.maxImageDimension2D;
    info->max_storage_bytes = p->limits.maxStorageBufferRange;
    if (p->apiVersion < VK_API_VERSION_1_3)
        because = "its driver is older than Vulkan 1.3";
    else if (family == UINT32_MAX && shows && find_family(physical, NULL) != UINT32_MAX)
        because = "no queue that draws can show pictures in the window";
    else if (family == UINT32_MAX)
        because = "no queue both draws and computes";
    else if (shows && !sf_has_extension(physical, VK_KHR_SWAPCHAIN_EXTENSION_NAME))
        because = "the extension " VK_KHR_SWAPCHAIN_EXTENSION_NAME " is missing";
    else
        because = missing_feature(physical);
    info->suitable = !because;
    if (because)
        snprintf(info->unsuitable_because, sizeof info->unsuitable_because, "%s", because);
    return family;
}

enum sf_status sf_physical_list(VkInstance instance, const struct sf_log *log, VkPhysicalDevice **physicals,
                                uint32_t *count)
{
    VkResult result;

    *physicals = NULL;
    *count = 0;
    result = vkEnumeratePhysicalDevices(instance, count, NULL);
    if (result == VK_SUCCESS && *count > 0) {
        *physicals = calloc(*count, sizeof **physicals);
        if (!*physicals)
            return sf_fail(log, SF_ERROR_MEMORY, "no memory for the list of devices");
        result = vkEnumeratePhysicalDevices(instance, count, *physicals);
    }
    if (result >= VK_SUCCESS && *count > 0)
        return SF_OK;
    free(*physicals);
    *physicals = NULL;
    if (result < VK_SUCCESS && result != VK_ERROR_INITIALIZATION_FAILED)
        return sf_vk_fail(log, result, "list", "Vulkan devices");
    return sf_fail(log, SF_ERROR_DEVICE,
                   "no Vulkan device: install a driver for your GPU, or the package mesa-vulkan-drivers for the CPU");
}

enum sf_status sf_gpu_list(const struct sf_log *log, struct sf_gpu_info **infos, uint32_t *count)
{
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice *physicals = NULL;
    bool debug_utils;
    enum sf_status status;

    *infos = NULL;
    *count = 0;
    status = sf_instance_create(false, NULL, NULL, log, &instance, &debug_utils);
    if (!status)
        status = sf_physical_list(instance, log, &physicals, count);
    if (!status) {
        *infos = calloc(*count, sizeof **infos);
        if (!*infos)
            status = sf_fail(log, SF_ERROR_MEMORY, "no memory for the list of devices");
    }
    for (uint32_t i = 0; !status && i < *count; i++)
        sf_physical_describe(physicals[i], NULL, &(*infos)[i]);
    if (status)
        *count = 0;
    free(physicals);
    if (instance)
        vkDestroyInstance(instance, NULL);
    return status;
}

static bool equal_fold(const char *a, const char *b)
{
    while (*a && tolower((unsigned char)*a) == tolower((unsigned char)*b))
        a++, b++;
    return tolower((unsigned char)*a) == tolower((unsigned char)*b);
}

static bool contains_fold(const char *text, const char *part)
{
    size_t length = strlen(part);

    for (; *text; text++) {
        size_t i = 0;

        while (i < length && text[i] && tolower((unsigned char)text[i]) == tolower((unsigned char)part[i]))
            i++;
        if (i == length)
            return true;
    }
    return false;
}

static int preference(const struct sf_gpu_info *info)
{
    static const char *const order[] = {"discrete", "integrated", "virtual", "cpu"};
    int i = 0;

    while (i < (int)SF_COUNT(order) && strcmp(info->kind, order[i]) != 0)
        i++;
    return i;
}

/* The best suitable one; `*found` stays UINT32_MAX when there is none. */
static void choose_best(const struct sf_gpu_info *infos, uint32_t count, uint32_t *found)
{
    for (uint32_t i = 0; i < count; i++)
        if (infos[i].suitable && (*found == UINT32_MAX || preference(&infos[i]) < preference(&infos[*found])))
            *found = i;
}

static enum sf_status choose_wanted(const struct sf_gpu_info *infos, uint32_t count, const char *wanted,
                                    const struct sf_log *log, uint32_t *found)
{
    struct sf_text names = {0};
    uint32_t matches = 0;
    enum sf_status status = SF_OK;

    if (*wanted && strlen(wanted) < 6 && strspn(wanted, "0123456789") == strlen(wanted)) {
        unsigned long index = strtoul(wanted, NULL, 10);

        if (index >= count)
            return sf_fail(log, SF_ERROR_DEVICE, "no device number %lu: there %s %u, counted from 0", index,
                           count == 1 ? "is" : "are", count);
        *found = (uint32_t)index;
        return SF_OK;
    }
    for (uint32_t i = 0; i < count; i++) {
        if (equal_fold(infos[i].uuid, wanted)) {
            *found = i;
            return SF_OK;
        }
        if (*wanted && contains_fold(infos[i].name, wanted)) {
            *found = i;
            matches++;
        }
    }
    for (uint32_t i = 0; i < count; i++)
        sf_text_printf(&names, "%s%u: %s", i ? ", " : "", i, infos[i].name);
    if (matches != 1)
        status = sf_fail(log, SF_ERROR_DEVICE, "%s device called '%s'; there are: %s", matches ? "more than one" : "no",
                         wanted, names.data ? names.data : "");
    sf_text_finish(&names);
    return status;
}

enum sf_status sf_physical_choose(VkInstance instance, const char *wanted, const struct sf_surface *surface,
                                  const struct sf_log *log, VkPhysicalDevice *physical, struct sf_gpu_info *info)
{
    VkPhysicalDevice *physicals = NULL;
    struct sf_gpu_info *infos = NULL;
    uint32_t count, found = UINT32_MAX;
    enum sf_status status = sf_physical_list(instance, log, &physicals, &count);

    if (status)
        goto done;
    infos = calloc(count, sizeof *infos);
    if (!infos) {
        status = sf_fail(log, SF_ERROR_MEMORY, "no memory for the list of devices");
        goto done;
    }
    for (uint32_t i = 0; i < count; i++)
        sf_physical_describe(physicals[i], surface, &infos[i]);
    if (wanted)
        status = choose_wanted(infos, count, wanted, log, &found);
    else
        choose_best(infos, count, &found);
    if (status)
        goto done;
    if (found == UINT32_MAX || !infos[found].suitable) {
        uint32_t shown = found == UINT32_MAX ? 0 : found;

        status = sf_fail(log, SF_ERROR_DEVICE, "the device '%s' cannot be used: %s", infos[shown].name,
                         infos[shown].unsuitable_because);
        goto done;
    }
    *physical = physicals[found];
    *info = infos[found];
done:
    free(infos);
    free(physicals);
    return status;
}
