/* Timestamps: one before the first pass, one after each. So a pass's time is from the end of the one before to its own
 * end, which counts the barriers that it needs as its own; the times of all passes add up to the whole play, and a pass
 * costs one timestamp, not two. */
#include "gpu/timer.h"

#include <stdlib.h>

enum sf_status sf_timer_init(struct sf_gpu *gpu, const struct sf_plan *plan, struct sf_timer *timer)
{
    VkQueryPoolCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
        .queryType = VK_QUERY_TYPE_TIMESTAMP,
        .queryCount = plan->pass_count + 1,
    };
    enum sf_status status;

    timer->passes = plan->pass_count;
    timer->ticks = calloc(plan->pass_count + 1, sizeof *timer->ticks);
    timer->times = calloc(plan->pass_count + 1, sizeof *timer->times);
    if (!timer->ticks || !timer->times)
        return sf_fail(gpu->log, SF_ERROR_MEMORY, "no memory for the times of '%s'", plan->name);
    for (uint32_t i = 0; i < plan->pass_count; i++)
        timer->times[i].name = plan->passes[i].name;
    status = sf_vk_check(gpu, gpu->vk.vkCreateQueryPool(gpu->device, &info, NULL, &timer->pool),
                         "create timestamps for", plan->name);
    if (!status)
        sf_vk_name(gpu, VK_OBJECT_TYPE_QUERY_POOL, SF_VK_HANDLE(timer->pool), plan->name);
    return status;
}

void sf_timer_finish(struct sf_gpu *gpu, struct sf_timer *timer)
{
    if (timer->pool && !gpu->stuck)
        gpu->vk.vkDestroyQueryPool(gpu->device, timer->pool, NULL);
    free(timer->ticks);
    free(timer->times);
    *timer = (struct sf_timer){0};
}

static void stamp(struct sf_gpu *gpu, VkCommandBuffer commands, const struct sf_timer *timer, uint32_t query)
{
    gpu->vk.vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, timer->pool, query);
}

void sf_timer_start(struct sf_gpu *gpu, VkCommandBuffer commands, struct sf_timer *timer)
{
    gpu->vk.vkCmdResetQueryPool(commands, timer->pool, 0, timer->passes + 1);
    stamp(gpu, commands, timer, 0);
}

void sf_timer_mark(struct sf_gpu *gpu, VkCommandBuffer commands, struct sf_timer *timer, uint32_t pass)
{
    stamp(gpu, commands, timer, pass + 1);
}

enum sf_status sf_timer_read(struct sf_gpu *gpu, const char *name, struct sf_timer *timer)
{
    uint32_t count = timer->passes + 1;
    uint64_t mask = gpu->timestamp_bits >= 64 ? UINT64_MAX : (1ull << gpu->timestamp_bits) - 1;
    double period = (double)gpu->limits.timestampPeriod;
    enum sf_status status =
        sf_vk_check(gpu,
                    gpu->vk.vkGetQueryPoolResults(gpu->device, timer->pool, 0, count, count * sizeof *timer->ticks,
                                                  timer->ticks, sizeof *timer->ticks, VK_QUERY_RESULT_64_BIT),
                    "read the timestamps of", name);
    uint64_t first, origin;

    if (status)
        return status;
    first = timer->ticks[0] & mask;
    origin = (uint64_t)((double)first * period);
    for (uint32_t i = 0; i < timer->passes; i++) {
        /* Differences first: they are small, so that no bits are lost, and right when the counter wrapped. */
        timer->times[i].begin_ns = origin + (uint64_t)((double)((timer->ticks[i] - first) & mask) * period);
        timer->times[i].end_ns = origin + (uint64_t)((double)((timer->ticks[i + 1] - first) & mask) * period);
    }
    return SF_OK;
}
