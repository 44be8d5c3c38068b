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
        .queryCount = SF_TIMER_PLAYS * (plan->pass_count + 1),
    };
    enum sf_status status;

    timer->passes = plan->pass_count;
    timer->ticks = calloc((size_t)SF_TIMER_PLAYS * (plan->pass_count + 1), sizeof *timer->ticks);
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

void sf_timer_start(struct sf_gpu *gpu, VkCommandBuffer commands, struct sf_timer *timer, uint64_t serial,
                    bool continued)
{
    uint32_t first;

    timer->plays = timer->serial == serial || continued ? timer->plays + 1 : 1;
    timer->serial = serial;
    if (timer->plays > SF_TIMER_PLAYS)
        return;
    first = (timer->plays - 1) * (timer->passes + 1);
    gpu->vk.vkCmdResetQueryPool(commands, timer->pool, first, timer->passes + 1);
    stamp(gpu, commands, timer, first);
}

void sf_timer_mark(struct sf_gpu *gpu, VkCommandBuffer commands, struct sf_timer *timer, uint32_t pass)
{
    if (timer->plays <= SF_TIMER_PLAYS)
        stamp(gpu, commands, timer, (timer->plays - 1) * (timer->passes + 1) + pass + 1);
}

enum sf_status sf_timer_read(struct sf_gpu *gpu, const char *name, struct sf_timer *timer)
{
    uint32_t plays = timer->plays < SF_TIMER_PLAYS ? timer->plays : SF_TIMER_PLAYS;
    uint32_t count = plays * (timer->passes + 1);
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
        struct sf_pass_time *time = &timer->times[i];

        /* Differences first: they are small, so that no bits are lost, and right when the counter wrapped. */
        time->begin_ns = time->end_ns = origin + (uint64_t)((double)((timer->ticks[i] - first) & mask) * period);
        for (uint32_t play = 0; play < plays; play++) {
            const uint64_t *ticks = timer->ticks + (size_t)play * (timer->passes + 1) + i;

            time->end_ns += (uint64_t)((double)((ticks[1] - ticks[0]) & mask) * period);
        }
    }
    return SF_OK;
}
