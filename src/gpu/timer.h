/* Timestamps around the passes of one play. */
#ifndef SF_GPU_TIMER_H
#define SF_GPU_TIMER_H

#include "gpu/vk.h"

struct sf_timer {
    VkQueryPool pool;
    _Atomic uint64_t serial; /* of the frame that it timed last; 0: none. Other threads look for theirs */
    uint64_t *ticks;         /* one more than there are passes */
    struct sf_pass_time *times;
    uint32_t passes;
};
enum sf_status sf_timer_init(struct sf_gpu *gpu, const struct sf_plan *plan, struct sf_timer *timer);
void sf_timer_finish(struct sf_gpu *gpu, struct sf_timer *timer);
void sf_timer_start(struct sf_gpu *gpu, VkCommandBuffer commands, struct sf_timer *timer);
/* After pass number `pass`. */
void sf_timer_mark(struct sf_gpu *gpu, VkCommandBuffer commands, struct sf_timer *timer, uint32_t pass);
enum sf_status sf_timer_read(struct sf_gpu *gpu, const char *name, struct sf_timer *timer);

#endif
