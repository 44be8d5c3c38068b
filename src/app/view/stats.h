/* What the last pictures cost: passes with medians, CPU and GPU time of frames, the device's ceilings. */
#ifndef SF_APP_VIEW_STATS_H
#define SF_APP_VIEW_STATS_H

#include <stdbool.h>
#include <stdint.h>
#include "sfumato/sfumato.h"

enum { SF_STATS_PASSES = 96, SF_STATS_KEPT = 64, SF_STATS_FRAMES = 240, SF_STATS_NAME_BYTES = 48 };

struct sf_stats_pass {
    char name[SF_STATS_NAME_BYTES];
    float ms[SF_STATS_KEPT]; /* a ring; a pass that runs several times in a frame counts as their sum */
    unsigned count, next;
    float last, median;
    uint64_t bytes; /* read and written, of one frame */
    bool present;   /* in the last frame */
};
struct sf_stats {
    struct sf_stats_pass passes[SF_STATS_PASSES]; /* in the order in which they ran last */
    unsigned pass_count;
    float gpu_ms[SF_STATS_FRAMES], cpu_ms[SF_STATS_FRAMES], wall_ms[SF_STATS_FRAMES]; /* rings with one cursor */
    unsigned frame_count, next;
    float gpu_median, cpu_median, wall_median;
    float record_ms;
    struct sf_ceilings ceilings; /* zeros until measured */
};
/* A picture that is done. cpu: to record and submit; wall: since the picture before (0: unknown, not counted). */
void sf_stats_add(struct sf_stats *stats, const struct sf_pass_timing *timings, uint32_t count, float cpu_ms,
                  float wall_ms, float record_ms);
/* Forgets passes (the graph is another one). */
void sf_stats_clear(struct sf_stats *stats);
/* Share of the device's ceiling that the pass reaches: its bytes over its median time, against the plain image copy of the
 * same run. 0: not known. */
float sf_stats_share(const struct sf_stats *stats, const struct sf_stats_pass *pass);

/* Passes by what they are for. */
enum sf_stats_group { SF_STATS_SIMULATION, SF_STATS_SCENE, SF_STATS_SMOKE, SF_STATS_OUTPUT, SF_STATS_GROUPS };
enum sf_stats_group sf_stats_group_of(const struct sf_stats_pass *pass);
const char *sf_stats_group_name(enum sf_stats_group group);
/* Sum of the medians of the group's passes that ran in the last frame. */
float sf_stats_group_ms(const struct sf_stats *stats, enum sf_stats_group group);
/* The last frame's passes as a table for people, by groups. malloc'ed; NULL when memory is out. */
char *sf_stats_print(const struct sf_stats *stats);

#endif
