/* Frames in flight, waiting, and commands outside of frames.
 *
 * Frame number s (from 1) uses slot s mod SF_FRAMES_IN_FLIGHT and signals the timeline semaphore with s. Beginning it
 * waits for frame s - SF_FRAMES_IN_FLIGHT, so the slot's command pool, descriptors and uploads are free again. All
 * waits end: after timeout_ns the device counts as lost. */
#include "gpu/vk.h"

#include <string.h>

static enum sf_status create_timeline(struct sf_gpu *gpu, const char *name, VkSemaphore *semaphore)
{
    VkSemaphoreTypeCreateInfo type = {
        .sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
        .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE,
    };
    VkSemaphoreCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, .pNext = &type};
    enum sf_status status =
        sf_vk_check(gpu, gpu->vk.vkCreateSemaphore(gpu->device, &info, NULL, semaphore), "create the semaphore", name);

    if (!status)
        sf_vk_name(gpu, VK_OBJECT_TYPE_SEMAPHORE, SF_VK_HANDLE(*semaphore), name);
    return status;
}

static enum sf_status create_commands(struct sf_gpu *gpu, const char *name, VkCommandPool *pool,
                                      VkCommandBuffer *commands)
{
    VkCommandPoolCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
        .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
        .queueFamilyIndex = gpu->family,
    };
    VkCommandBufferAllocateInfo allocate = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
        .commandBufferCount = 1,
    };
    enum sf_status status =
        sf_vk_check(gpu, gpu->vk.vkCreateCommandPool(gpu->device, &info, NULL, pool), "create the command pool", name);

    if (status)
        return status;
    sf_vk_name(gpu, VK_OBJECT_TYPE_COMMAND_POOL, SF_VK_HANDLE(*pool), name);
    allocate.commandPool = *pool;
    status = sf_vk_check(gpu, gpu->vk.vkAllocateCommandBuffers(gpu->device, &allocate, commands),
                         "allocate the command buffer", name);
    if (!status)
        sf_vk_name(gpu, VK_OBJECT_TYPE_COMMAND_BUFFER, SF_VK_HANDLE(*commands), name);
    return status;
}

enum sf_status sf_frames_init(struct sf_gpu *gpu)
{
    enum sf_status status = create_timeline(gpu, "frames", &gpu->timeline);

    if (!status)
        status = create_timeline(gpu, "setup", &gpu->setup_timeline);
    if (!status)
        status = create_commands(gpu, "setup", &gpu->setup_pool, &gpu->setup_commands);
    for (int i = 0; i < SF_FRAMES_IN_FLIGHT && !status; i++)
        status =
            create_commands(gpu, i == 0 ? "even frames" : "odd frames", &gpu->slots[i].pool, &gpu->slots[i].commands);
    return status;
}

void sf_frames_finish(struct sf_gpu *gpu)
{
    for (int i = 0; i < SF_FRAMES_IN_FLIGHT; i++) {
        struct sf_frame_slot *slot = &gpu->slots[i];

        sf_descriptor_finish(gpu, &slot->descriptors);
        sf_upload_finish(gpu, &slot->uploads);
        if (!gpu->stuck)
            gpu->vk.vkDestroyCommandPool(gpu->device, slot->pool, NULL);
    }
    if (gpu->stuck)
        return;
    gpu->vk.vkDestroyCommandPool(gpu->device, gpu->setup_pool, NULL);
    gpu->vk.vkDestroySemaphore(gpu->device, gpu->setup_timeline, NULL);
    gpu->vk.vkDestroySemaphore(gpu->device, gpu->timeline, NULL);
}

static VkResult wait_timeline(struct sf_gpu *gpu, VkSemaphore semaphore, uint64_t value)
{
    VkSemaphoreWaitInfo info = {
        .sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
        .semaphoreCount = 1,
        .pSemaphores = &semaphore,
        .pValues = &value,
    };

    return gpu->vk.vkWaitSemaphores(gpu->device, &info, gpu->timeout_ns);
}

/* Signals the timeline; waits for and signals what `showing` names. */
static VkResult submit(struct sf_gpu *gpu, VkCommandBuffer commands, VkSemaphore timeline, uint64_t value,
                       struct sf_showing showing)
{
    VkCommandBufferSubmitInfo buffer = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
        .commandBuffer = commands,
    };
    VkSemaphoreSubmitInfo wait = {
        .sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
        .semaphore = showing.acquired,
        .stageMask = sf_scope_of((struct sf_touch){SF_ACCESS_PRESENT, SF_PASS_TRANSFER}).stages,
    };
    VkSemaphoreSubmitInfo signals[] = {{
                                           .sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                           .semaphore = timeline,
                                           .value = value,
                                           .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                       },
                                       {
                                           .sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                           .semaphore = showing.drawn,
                                           .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                       }};
    VkSubmitInfo2 info = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
        .waitSemaphoreInfoCount = showing.acquired ? 1 : 0,
        .pWaitSemaphoreInfos = &wait,
        .commandBufferInfoCount = 1,
        .pCommandBufferInfos = &buffer,
        .signalSemaphoreInfoCount = showing.drawn ? 2 : 1,
        .pSignalSemaphoreInfos = signals,
    };

    return gpu->vk.vkQueueSubmit2(gpu->queue, 1, &info, VK_NULL_HANDLE);
}

static enum sf_status begin_commands(struct sf_gpu *gpu, VkCommandPool pool, VkCommandBuffer commands, const char *name)
{
    VkCommandBufferBeginInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
    };
    enum sf_status status =
        sf_vk_check(gpu, gpu->vk.vkResetCommandPool(gpu->device, pool, 0), "reset the commands of", name);

    if (!status)
        status = sf_vk_check(gpu, gpu->vk.vkBeginCommandBuffer(commands, &info), "begin the commands of", name);
    return status;
}

enum sf_status sf_gpu_refuse_lost(struct sf_gpu *gpu)
{
    enum sf_status lost = (enum sf_status)atomic_load(&gpu->lost);

    if (lost)
        return sf_fail(gpu->log, lost, "the device '%s' failed before and takes no more work", gpu->info.name);
    return SF_OK;
}

struct sf_frame_slot *sf_frame_slot_now(struct sf_gpu *gpu)
{
    return &gpu->slots[(atomic_load(&gpu->submitted) + 1) % SF_FRAMES_IN_FLIGHT];
}

enum sf_status sf_frame_begin(struct sf_gpu *gpu)
{
    uint64_t submitted = atomic_load(&gpu->submitted);
    struct sf_frame_slot *slot = sf_frame_slot_now(gpu);
    enum sf_status status = sf_gpu_refuse_lost(gpu);

    if (status)
        return status;
    if (gpu->recording)
        return sf_fail(gpu->log, SF_ERROR_USAGE, "a frame is begun while another is open");
    if (submitted >= SF_FRAMES_IN_FLIGHT)
        status = sf_vk_check(gpu, wait_timeline(gpu, gpu->timeline, submitted + 1 - SF_FRAMES_IN_FLIGHT), "wait for",
                             "the frame before the last");
    if (!status)
        status = sf_descriptor_reset(gpu, &slot->descriptors);
    if (!status)
        status = begin_commands(gpu, slot->pool, slot->commands, "frame");
    if (status)
        return status;
    sf_upload_reset(&slot->uploads);
    gpu->recording = true;
    return SF_OK;
}

enum sf_status sf_frame_end(struct sf_gpu *gpu, uint64_t *serial)
{
    uint64_t next = atomic_load(&gpu->submitted) + 1;
    struct sf_frame_slot *slot = sf_frame_slot_now(gpu);
    struct sf_showing showing = {VK_NULL_HANDLE, VK_NULL_HANDLE};
    enum sf_status status = sf_gpu_refuse_lost(gpu);

    if (serial)
        *serial = 0;
    if (!gpu->recording)
        return sf_fail(gpu->log, SF_ERROR_USAGE, "a frame is ended that was not begun");
    gpu->recording = false;
    if (!status) {
        showing = sf_swapchain_close_frame(gpu, slot->commands);
        status = sf_vk_check(gpu, gpu->vk.vkEndCommandBuffer(slot->commands), "end the commands of", "frame");
    }
    if (!status)
        status = sf_vk_check(gpu, submit(gpu, slot->commands, gpu->timeline, next, showing), "submit", "frame");
    if (!status) {
        atomic_store(&gpu->submitted, next);
        status = sf_swapchain_present(gpu);
    }
    if (status) {
        /* What was recorded never runs, but the players have taken it for done (histories flipped): there is no way on.
         */
        atomic_store(&gpu->lost, status);
        return status;
    }
    if (serial)
        *serial = next;
    return SF_OK;
}

enum sf_status sf_frame_wait(struct sf_gpu *gpu, uint64_t serial)
{
    VkResult result;

    if (serial > atomic_load(&gpu->submitted))
        return sf_fail(gpu->log, SF_ERROR_USAGE, "waiting for frame %llu, which was not submitted",
                       (unsigned long long)serial);
    result = wait_timeline(gpu, gpu->timeline, serial);
    if (result == VK_TIMEOUT) {
        atomic_store(&gpu->lost, SF_ERROR_DEVICE_LOST);
        return sf_fail(gpu->log, SF_ERROR_DEVICE_LOST, "the device '%s' did not finish frame %llu in %.1f s",
                       gpu->info.name, (unsigned long long)serial, (double)gpu->timeout_ns * 1e-9);
    }
    return sf_vk_check(gpu, result, "wait for", "frame");
}

enum sf_status sf_gpu_wait_idle(struct sf_gpu *gpu)
{
    enum sf_status status = sf_gpu_refuse_lost(gpu);

    return status ? status : sf_frame_wait(gpu, atomic_load(&gpu->submitted));
}

void sf_gpu_settle(struct sf_gpu *gpu)
{
    bool late = false;

    if (gpu->timeline)
        late = wait_timeline(gpu, gpu->timeline, atomic_load(&gpu->submitted)) == VK_TIMEOUT;
    if (gpu->setup_timeline && !late)
        late = wait_timeline(gpu, gpu->setup_timeline, gpu->setup_count) == VK_TIMEOUT;
    if (late && !atomic_load(&gpu->stuck))
        sf_log(gpu->log, SF_LOG_WARNING, "the device '%s' does not answer: what it may still use is not freed",
               gpu->info.name);
    atomic_store(&gpu->stuck, late);
}

enum sf_status sf_setup_begin(struct sf_gpu *gpu, const char *name, VkCommandBuffer *commands)
{
    enum sf_status status = sf_gpu_refuse_lost(gpu);

    if (!status)
        status = begin_commands(gpu, gpu->setup_pool, gpu->setup_commands, name);
    *commands = gpu->setup_commands;
    return status;
}

enum sf_status sf_setup_end(struct sf_gpu *gpu, const char *name)
{
    VkMemoryBarrier2 barrier = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
        .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
        .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT,
        .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
    };
    VkDependencyInfo dependency = {
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
        .memoryBarrierCount = 1,
        .pMemoryBarriers = &barrier,
    };
    const struct sf_showing nothing = {VK_NULL_HANDLE, VK_NULL_HANDLE};
    enum sf_status status;
    VkResult result;

    gpu->vk.vkCmdPipelineBarrier2(gpu->setup_commands, &dependency);
    status = sf_vk_check(gpu, gpu->vk.vkEndCommandBuffer(gpu->setup_commands), "end the commands of", name);
    if (!status)
        status = sf_vk_check(gpu, submit(gpu, gpu->setup_commands, gpu->setup_timeline, gpu->setup_count + 1, nothing),
                             "submit", name);
    if (status)
        return status;
    gpu->setup_count++;
    result = wait_timeline(gpu, gpu->setup_timeline, gpu->setup_count);
    if (result == VK_TIMEOUT)
        atomic_store(&gpu->stuck, true); /* the caller's staging memory is still being used */
    return sf_vk_check(gpu, result, "wait for", name);
}
