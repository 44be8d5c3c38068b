/* The shim for fault tests: see fault.h. It stands between sfumato and the driver only when a test armed it before the
 * device was made. */
#include "gpu/fault.h"
#include "gpu/vk.h"

static struct VolkDeviceTable real;
static enum sf_fault armed;
static bool wrapping;
static uint32_t first_failing;
static atomic_uint calls;
static _Atomic int64_t alive;

void sf_gpu_fail_after(enum sf_fault fault, uint32_t n)
{
    armed = fault;
    first_failing = n;
    calls = 0;
    wrapping = fault != SF_FAULT_NONE; /* concerns the devices made from now on */
}

uint32_t sf_gpu_fault_calls(void)
{
    return calls;
}

int64_t sf_gpu_fault_alive(void)
{
    return alive;
}

static bool due(enum sf_fault fault)
{
    return armed == fault && atomic_fetch_add(&calls, 1) + 1 >= first_failing;
}

static VkResult made(VkResult result)
{
    alive += result == VK_SUCCESS;
    return result;
}

#define SHIM_CREATE(function, info, handle)                                                                            \
    static VKAPI_ATTR VkResult VKAPI_CALL shim_##function(VkDevice device, const info *create,                         \
                                                          const VkAllocationCallbacks *callbacks, handle *out)         \
    {                                                                                                                  \
        return due(SF_FAULT_OBJECT) ? VK_ERROR_OUT_OF_HOST_MEMORY                                                      \
                                    : made(real.function(device, create, callbacks, out));                             \
    }
#define SHIM_DESTROY(function, handle)                                                                                 \
    static VKAPI_ATTR void VKAPI_CALL shim_##function(VkDevice device, handle object,                                  \
                                                      const VkAllocationCallbacks *callbacks)                          \
    {                                                                                                                  \
        alive -= object != VK_NULL_HANDLE;                                                                             \
        real.function(device, object, callbacks);                                                                      \
    }
#define SHIM_PIPELINES(function, info)                                                                                 \
    static VKAPI_ATTR VkResult VKAPI_CALL shim_##function(VkDevice device, VkPipelineCache cache, uint32_t count,      \
                                                          const info *create, const VkAllocationCallbacks *callbacks,  \
                                                          VkPipeline *out)                                             \
    {                                                                                                                  \
        return due(SF_FAULT_OBJECT) ? VK_ERROR_OUT_OF_HOST_MEMORY                                                      \
                                    : made(real.function(device, cache, count, create, callbacks, out));               \
    }

SHIM_CREATE(vkCreateBuffer, VkBufferCreateInfo, VkBuffer)
SHIM_DESTROY(vkDestroyBuffer, VkBuffer)
SHIM_CREATE(vkCreateImage, VkImageCreateInfo, VkImage)
SHIM_DESTROY(vkDestroyImage, VkImage)
SHIM_CREATE(vkCreateImageView, VkImageViewCreateInfo, VkImageView)
SHIM_DESTROY(vkDestroyImageView, VkImageView)
SHIM_CREATE(vkCreateSampler, VkSamplerCreateInfo, VkSampler)
SHIM_DESTROY(vkDestroySampler, VkSampler)
SHIM_CREATE(vkCreateSemaphore, VkSemaphoreCreateInfo, VkSemaphore)
SHIM_DESTROY(vkDestroySemaphore, VkSemaphore)
SHIM_CREATE(vkCreateCommandPool, VkCommandPoolCreateInfo, VkCommandPool)
SHIM_DESTROY(vkDestroyCommandPool, VkCommandPool)
SHIM_CREATE(vkCreateDescriptorPool, VkDescriptorPoolCreateInfo, VkDescriptorPool)
SHIM_DESTROY(vkDestroyDescriptorPool, VkDescriptorPool)
SHIM_CREATE(vkCreateDescriptorSetLayout, VkDescriptorSetLayoutCreateInfo, VkDescriptorSetLayout)
SHIM_DESTROY(vkDestroyDescriptorSetLayout, VkDescriptorSetLayout)
SHIM_CREATE(vkCreatePipelineLayout, VkPipelineLayoutCreateInfo, VkPipelineLayout)
SHIM_DESTROY(vkDestroyPipelineLayout, VkPipelineLayout)
SHIM_CREATE(vkCreateShaderModule, VkShaderModuleCreateInfo, VkShaderModule)
SHIM_DESTROY(vkDestroyShaderModule, VkShaderModule)
SHIM_CREATE(vkCreatePipelineCache, VkPipelineCacheCreateInfo, VkPipelineCache)
SHIM_DESTROY(vkDestroyPipelineCache, VkPipelineCache)
SHIM_CREATE(vkCreateQueryPool, VkQueryPoolCreateInfo, VkQueryPool)
SHIM_DESTROY(vkDestroyQueryPool, VkQueryPool)
SHIM_PIPELINES(vkCreateComputePipelines, VkComputePipelineCreateInfo)
SHIM_PIPELINES(vkCreateGraphicsPipelines, VkGraphicsPipelineCreateInfo)
SHIM_DESTROY(vkDestroyPipeline, VkPipeline)
SHIM_DESTROY(vkFreeMemory, VkDeviceMemory)

static VKAPI_ATTR VkResult VKAPI_CALL shim_vkAllocateMemory(VkDevice device, const VkMemoryAllocateInfo *info,
                                                            const VkAllocationCallbacks *callbacks, VkDeviceMemory *out)
{
    if (due(SF_FAULT_MEMORY))
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    return made(real.vkAllocateMemory(device, info, callbacks, out));
}

static VKAPI_ATTR VkResult VKAPI_CALL shim_vkMapMemory(VkDevice device, VkDeviceMemory memory, VkDeviceSize offset,
                                                       VkDeviceSize size, VkMemoryMapFlags flags, void **data)
{
    return due(SF_FAULT_OBJECT) ? VK_ERROR_MEMORY_MAP_FAILED
                                : real.vkMapMemory(device, memory, offset, size, flags, data);
}

static VKAPI_ATTR VkResult VKAPI_CALL shim_vkAllocateDescriptorSets(VkDevice device,
                                                                    const VkDescriptorSetAllocateInfo *info,
                                                                    VkDescriptorSet *sets)
{
    return due(SF_FAULT_OBJECT) ? VK_ERROR_OUT_OF_POOL_MEMORY : real.vkAllocateDescriptorSets(device, info, sets);
}

static VKAPI_ATTR VkResult VKAPI_CALL shim_vkAllocateCommandBuffers(VkDevice device,
                                                                    const VkCommandBufferAllocateInfo *info,
                                                                    VkCommandBuffer *commands)
{
    return due(SF_FAULT_OBJECT) ? VK_ERROR_OUT_OF_HOST_MEMORY : real.vkAllocateCommandBuffers(device, info, commands);
}

static VKAPI_ATTR VkResult VKAPI_CALL shim_vkQueueSubmit2(VkQueue queue, uint32_t count, const VkSubmitInfo2 *submits,
                                                          VkFence fence)
{
    return due(SF_FAULT_SUBMIT) ? VK_ERROR_DEVICE_LOST : real.vkQueueSubmit2(queue, count, submits, fence);
}

static VKAPI_ATTR VkResult VKAPI_CALL shim_vkWaitSemaphores(VkDevice device, const VkSemaphoreWaitInfo *info,
                                                            uint64_t timeout)
{
    return due(SF_FAULT_TIMEOUT) ? VK_TIMEOUT : real.vkWaitSemaphores(device, info, timeout);
}

static VKAPI_ATTR VkResult VKAPI_CALL shim_vkCreateSwapchainKHR(VkDevice device, const VkSwapchainCreateInfoKHR *info,
                                                                const VkAllocationCallbacks *callbacks,
                                                                VkSwapchainKHR *out)
{
    if (due(SF_FAULT_SURFACE_LOST))
        return VK_ERROR_SURFACE_LOST_KHR;
    return due(SF_FAULT_OBJECT) ? VK_ERROR_OUT_OF_HOST_MEMORY
                                : made(real.vkCreateSwapchainKHR(device, info, callbacks, out));
}

static VkResult window_result(VkResult result)
{
    if (due(SF_FAULT_OUT_OF_DATE))
        return VK_ERROR_OUT_OF_DATE_KHR;
    if (due(SF_FAULT_SURFACE_LOST))
        return VK_ERROR_SURFACE_LOST_KHR;
    return result;
}

static VKAPI_ATTR VkResult VKAPI_CALL shim_vkAcquireNextImageKHR(VkDevice device, VkSwapchainKHR swapchain,
                                                                 uint64_t timeout, VkSemaphore semaphore, VkFence fence,
                                                                 uint32_t *index)
{
    VkResult result = due(SF_FAULT_BUSY) ? VK_TIMEOUT : window_result(VK_SUCCESS);

    if (result == VK_SUCCESS)
        result = real.vkAcquireNextImageKHR(device, swapchain, timeout, semaphore, fence, index);
    return due(SF_FAULT_SUBOPTIMAL) && result == VK_SUCCESS ? VK_SUBOPTIMAL_KHR : result;
}

static VKAPI_ATTR VkResult VKAPI_CALL shim_vkQueuePresentKHR(VkQueue queue, const VkPresentInfoKHR *info)
{
    VkResult result = window_result(real.vkQueuePresentKHR(queue, info));

    if (due(SF_FAULT_PRESENT))
        return VK_ERROR_DEVICE_LOST;
    return due(SF_FAULT_SUBOPTIMAL) && result == VK_SUCCESS ? VK_SUBOPTIMAL_KHR : result;
}

SHIM_DESTROY(vkDestroySwapchainKHR, VkSwapchainKHR)

void sf_fault_wrap(struct VolkDeviceTable *table)
{
    if (!wrapping)
        return;
    real = *table;
    alive = 0;
#define WRAP(function) table->function = shim_##function
    WRAP(vkCreateBuffer);
    WRAP(vkDestroyBuffer);
    WRAP(vkCreateImage);
    WRAP(vkDestroyImage);
    WRAP(vkCreateImageView);
    WRAP(vkDestroyImageView);
    WRAP(vkCreateSampler);
    WRAP(vkDestroySampler);
    WRAP(vkCreateSemaphore);
    WRAP(vkDestroySemaphore);
    WRAP(vkCreateCommandPool);
    WRAP(vkDestroyCommandPool);
    WRAP(vkCreateDescriptorPool);
    WRAP(vkDestroyDescriptorPool);
    WRAP(vkCreateDescriptorSetLayout);
    WRAP(vkDestroyDescriptorSetLayout);
    WRAP(vkCreatePipelineLayout);
    WRAP(vkDestroyPipelineLayout);
    WRAP(vkCreateShaderModule);
    WRAP(vkDestroyShaderModule);
    WRAP(vkCreatePipelineCache);
    WRAP(vkDestroyPipelineCache);
    WRAP(vkCreateQueryPool);
    WRAP(vkDestroyQueryPool);
    WRAP(vkCreateComputePipelines);
    WRAP(vkCreateGraphicsPipelines);
    WRAP(vkDestroyPipeline);
    WRAP(vkAllocateMemory);
    WRAP(vkFreeMemory);
    WRAP(vkMapMemory);
    WRAP(vkAllocateDescriptorSets);
    WRAP(vkAllocateCommandBuffers);
    WRAP(vkQueueSubmit2);
    WRAP(vkWaitSemaphores);
    WRAP(vkCreateSwapchainKHR);
    WRAP(vkDestroySwapchainKHR);
    WRAP(vkAcquireNextImageKHR);
    WRAP(vkQueuePresentKHR);
#undef WRAP
}

#undef SHIM_CREATE
#undef SHIM_DESTROY
#undef SHIM_PIPELINES
