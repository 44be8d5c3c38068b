/* The device: made lean, since every start pays for it; and its questions and answers. */
#include "gpu/vk.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/thread.h"
#include "gpu/fault.h"

static const char PORTABILITY_SUBSET[] = "VK_KHR_portability_subset";
static const uint64_t DEFAULT_TIMEOUT_NS = 60ull * 1000 * 1000 * 1000;

/* Called by the layer from whatever thread it likes. */
static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                 VkDebugUtilsMessageTypeFlagsEXT types,
                                                 const VkDebugUtilsMessengerCallbackDataEXT *data, void *user)
{
    struct sf_gpu *gpu = user;

    (void)severity;
    (void)types;
    pthread_mutex_lock(&gpu->message_lock);
    if (gpu->messages++ == 0)
        snprintf(gpu->first_message, sizeof gpu->first_message, "%s", data->pMessage);
    sf_log(gpu->log, SF_LOG_ERROR, "validation: %s", data->pMessage);
    pthread_mutex_unlock(&gpu->message_lock);
    return VK_FALSE;
}

static enum sf_status create_instance(struct sf_gpu *gpu)
{
    VkDebugUtilsMessengerCreateInfoEXT messenger = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
        .pfnUserCallback = on_message,
        .pUserData = gpu,
    };
    const struct sf_surface_source *surface = gpu->surface.source.create ? &gpu->surface.source : NULL;
    enum sf_status status = sf_instance_create(gpu->validate, gpu->validate ? &messenger : NULL, surface, gpu->log,
                                               &gpu->instance, &gpu->debug_utils);

    if (status || !gpu->validate)
        return status;
    if (!gpu->debug_utils)
        return sf_fail(gpu->log, SF_ERROR_DEVICE, "validation was asked for, but VK_EXT_debug_utils is missing");
    return sf_vk_check(gpu, vkCreateDebugUtilsMessengerEXT(gpu->instance, &messenger, NULL, &gpu->messenger), "create",
                       "debug messenger");
}

static enum sf_status create_device(struct sf_gpu *gpu)
{
    /* Needed: sf_physical_describe has seen that they are there. Those of 1.3 that every driver must have stand beside
     * them. */
    VkPhysicalDeviceVulkan13Features f13 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
        .dynamicRendering = VK_TRUE,
        .synchronization2 = VK_TRUE,
        .maintenance4 = VK_TRUE,
        .shaderTerminateInvocation = VK_TRUE,
        .shaderDemoteToHelperInvocation = VK_TRUE,
        .subgroupSizeControl = VK_TRUE,
        .computeFullSubgroups = VK_TRUE,
    };
    VkPhysicalDeviceVulkan12Features f12 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
        .pNext = &f13,
        .timelineSemaphore = VK_TRUE,
    };
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &f12};
    const float priority = 1;
    VkDeviceQueueCreateInfo queue = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
        .queueFamilyIndex = gpu->family,
        .queueCount = 1,
        .pQueuePriorities = &priority,
    };
    const char *extensions[2];
    VkDeviceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
        .pNext = &features,
        .queueCreateInfoCount = 1,
        .pQueueCreateInfos = &queue,
        .ppEnabledExtensionNames = extensions,
    };
    VkPhysicalDeviceFeatures has;
    enum sf_status status;

    if (sf_has_extension(gpu->physical, PORTABILITY_SUBSET)) /* must be asked for where it is */
        extensions[info.enabledExtensionCount++] = PORTABILITY_SUBSET;
    if (gpu->surface.handle)
        extensions[info.enabledExtensionCount++] = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    /* Wanted: a pass that needs one of these on a device without it is refused by name when its player is made. */
    vkGetPhysicalDeviceFeatures(gpu->physical, &has);
    features.features.independentBlend = has.independentBlend;
    features.features.shaderStorageImageExtendedFormats = has.shaderStorageImageExtendedFormats;
    features.features.fragmentStoresAndAtomics = has.fragmentStoresAndAtomics;
    features.features.vertexPipelineStoresAndAtomics = has.vertexPipelineStoresAndAtomics;
    features.features.shaderInt64 = has.shaderInt64;
    gpu->features = features.features;
    gpu->tuning.int64 = has.shaderInt64;
    status =
        sf_vk_check(gpu, vkCreateDevice(gpu->physical, &info, NULL, &gpu->device), "create the device", gpu->info.name);
    if (status)
        return status;
    volkLoadDeviceTable(&gpu->vk, gpu->device);
    sf_fault_wrap(&gpu->vk);
    gpu->vk.vkGetDeviceQueue(gpu->device, gpu->family, 0, &gpu->queue);
    sf_vk_name(gpu, VK_OBJECT_TYPE_QUEUE, SF_VK_HANDLE(gpu->queue), "sfumato");
    return SF_OK;
}

static void read_limits(struct sf_gpu *gpu)
{
    enum { FAMILIES_MAX = 32 };
    VkPhysicalDeviceMaintenance3Properties allocation = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES};
    VkPhysicalDeviceProperties2 properties = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                              .pNext = &allocation};
    VkQueueFamilyProperties families[FAMILIES_MAX];
    uint32_t count = FAMILIES_MAX;
    bool software, discrete;

    vkGetPhysicalDeviceProperties2(gpu->physical, &properties);
    vkGetPhysicalDeviceMemoryProperties(gpu->physical, &gpu->memory_types);
    vkGetPhysicalDeviceQueueFamilyProperties(gpu->physical, &count, families);
    gpu->limits = properties.properties.limits;
    gpu->max_allocation = allocation.maxMemoryAllocationSize;
    gpu->timestamp_bits = families[gpu->family].timestampValidBits;
    for (int format = SF_FORMAT_NONE + 1; format < SF_FORMAT_COUNT; format++) {
        VkFormatProperties has;

        vkGetPhysicalDeviceFormatProperties(gpu->physical, sf_vk_format(format), &has);
        gpu->formats[format] = has.optimalTilingFeatures;
    }
    software = properties.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    discrete = properties.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
    gpu->tuning = (struct sf_gpu_tuning){
        .software = software,
        .subgroup_size = gpu->info.subgroup_size ? gpu->info.subgroup_size : 1,
        /* Vulkan does not tell how many compute units there are: enough to fill any, not too many for the small. */
        .workers = software   ? sf_cpu_count()
                   : discrete ? 1024
                              : 128,
        .max_group_invocations = gpu->limits.maxComputeWorkGroupInvocations,
        .shared_bytes = gpu->limits.maxComputeSharedMemorySize,
    };
}

static enum sf_status create_samplers(struct sf_gpu *gpu)
{
    static const struct {
        const char *name;
        VkFilter filter;
        VkSamplerAddressMode mode;
    } kinds[SF_SAMPLER_COUNT] = {
        [SF_SAMPLER_NEAREST] = {"nearest", VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE},
        [SF_SAMPLER_LINEAR] = {"linear", VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE},
        [SF_SAMPLER_LINEAR_REPEAT] = {"linear, repeated", VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT},
    };
    enum sf_status status = SF_OK;

    for (int i = 0; i < SF_SAMPLER_COUNT && !status; i++) {
        VkSamplerCreateInfo info = {
            .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
            .magFilter = kinds[i].filter,
            .minFilter = kinds[i].filter,
            .addressModeU = kinds[i].mode,
            .addressModeV = kinds[i].mode,
            .addressModeW = kinds[i].mode,
        };

        status = sf_vk_check(gpu, gpu->vk.vkCreateSampler(gpu->device, &info, NULL, &gpu->samplers[i]),
                             "create the sampler", kinds[i].name);
        if (!status)
            sf_vk_name(gpu, VK_OBJECT_TYPE_SAMPLER, SF_VK_HANDLE(gpu->samplers[i]), kinds[i].name);
    }
    return status;
}

enum sf_status sf_gpu_create(const struct sf_gpu_options *options, const struct sf_log *log, struct sf_gpu **out)
{
    struct sf_gpu *gpu = calloc(1, sizeof *gpu);
    enum sf_status status;

    *out = NULL;
    if (!gpu)
        return sf_fail(log, SF_ERROR_MEMORY, "no memory for the device");
    if (pthread_mutex_init(&gpu->message_lock, NULL) != 0) {
        free(gpu);
        return sf_fail(log, SF_ERROR_MEMORY, "no memory for the device's lock");
    }
    gpu->log = log;
    gpu->validate = options->validate;
    gpu->no_cache = options->no_cache;
    gpu->timeout_ns = options->timeout_ns ? options->timeout_ns : DEFAULT_TIMEOUT_NS;
    if (options->surface)
        gpu->surface.source = *options->surface;
    status = create_instance(gpu);
    if (!status)
        status = sf_surface_init(gpu);
    if (!status)
        status = sf_physical_choose(gpu->instance, options->device, &gpu->surface, log, &gpu->physical, &gpu->info);
    if (!status) {
        struct sf_gpu_info unused;

        gpu->family = sf_physical_describe(gpu->physical, &gpu->surface, &unused);
        gpu->memory.budget = options->budget_bytes ? options->budget_bytes : gpu->info.memory_bytes / 10 * 8;
        read_limits(gpu);
        status = sf_surface_learn(gpu);
    }
    if (!status)
        status = create_device(gpu);
    if (!status)
        status = create_samplers(gpu);
    if (!status)
        status = sf_cache_open(gpu);
    if (!status)
        status = sf_frames_init(gpu);
    if (status) {
        sf_gpu_destroy(&gpu);
        return status;
    }
    sf_log(log, SF_LOG_INFO, "device: %s (%s), Vulkan %u.%u.%u", gpu->info.name, gpu->info.driver, gpu->info.api_major,
           gpu->info.api_minor, gpu->info.api_patch);
    *out = gpu;
    return SF_OK;
}

void sf_gpu_destroy(struct sf_gpu **pointer)
{
    struct sf_gpu *gpu = pointer ? *pointer : NULL;

    if (!gpu)
        return;
    if (gpu->device) {
        sf_gpu_settle(gpu);
        sf_cache_close(gpu);
        sf_pipelines_finish(gpu);
        sf_shaders_finish(gpu);
        sf_frames_finish(gpu);
        sf_memory_finish(gpu);
        for (int i = 0; i < SF_SAMPLER_COUNT && !gpu->stuck; i++)
            gpu->vk.vkDestroySampler(gpu->device, gpu->samplers[i], NULL);
        if (!gpu->stuck)
            gpu->vk.vkDestroyDevice(gpu->device, NULL);
    }
    if (gpu->stuck) { /* the driver may still call back: leave it its instance and our lock */
        *pointer = NULL;
        return;
    }
    sf_surface_finish(gpu);
    if (gpu->messenger)
        vkDestroyDebugUtilsMessengerEXT(gpu->instance, gpu->messenger, NULL);
    if (gpu->instance)
        vkDestroyInstance(gpu->instance, NULL);
    pthread_mutex_destroy(&gpu->message_lock);
    free(gpu);
    *pointer = NULL;
}

const struct sf_gpu_info *sf_gpu_info(const struct sf_gpu *gpu)
{
    return &gpu->info;
}

const struct sf_gpu_tuning *sf_gpu_tuning(const struct sf_gpu *gpu)
{
    return &gpu->tuning;
}

uint32_t sf_gpu_validation_messages(const struct sf_gpu *gpu, const char **first)
{
    struct sf_gpu *locked = (struct sf_gpu *)gpu; /* the lock changes, the device does not */
    uint32_t count;

    pthread_mutex_lock(&locked->message_lock);
    count = gpu->messages;
    pthread_mutex_unlock(&locked->message_lock);
    if (first)
        *first = count ? gpu->first_message : NULL;
    return count;
}

void sf_gpu_memory(const struct sf_gpu *gpu, uint64_t *used, uint64_t *budget)
{
    if (used)
        *used = gpu->memory.used;
    if (budget)
        *budget = gpu->memory.budget;
}
