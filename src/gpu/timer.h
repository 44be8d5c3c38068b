/* Timestamps around the passes of a player's plays in one frame. */
#ifndef SF_GPU_TIMER_H
#define SF_GPU_TIMER_H

#include "gpu/vk.h"

enum { SF_TIMER_PLAYS = 64 }; /* plays of a player in a frame that are timed; those beyond are not */

struct sf_timer {
    VkQueryPool pool;
    _Atomic uint64_t serial; /* of the frame that it timed last; 0: none. Other threads look for theirs */
    uint64_t *ticks;         /* one more than there are passes, for each play */
    struct sf_pass_time *times;
    uint32_t passes;
    uint32_t plays; /* in that frame, and those that it continues, so far */
};
enum sf_status sf_timer_init(struct sf_gpu *gpu, const struct sf_plan *plan, struct sf_timer *timer);
void sf_timer_finish(struct sf_gpu *gpu, struct sf_timer *timer);
/* Begins the next play of frame `serial`; `continued`: counted with those of the frame before. */
void sf_timer_start(struct sf_gpu *gpu, VkCommandBuffer commands, struct sf_timer *timer, uint64_t serial,
                    bool continued);
/* After pass number `pass`. */
void sf_timer_mark(struct sf_gpu *gpu, VkCommandBuffer commands, struct sf_timer *timer, uint32_t pass);
/* A pass begins where it did in the first play, and lasts as long as in all plays together. */
enum sf_status sf_timer_read(struct sf_gpu *gpu, const char *name, struct sf_timer *timer);

#endif
