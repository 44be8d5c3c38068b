/* Holds a frame time while the camera moves by drawing the smoke coarser, and refines when it rests. */
#ifndef SF_APP_VIEW_GOVERNOR_H
#define SF_APP_VIEW_GOVERNOR_H

#include <stdbool.h>
#include <stdint.h>

enum { SF_GOVERNOR_LEVELS = 3 }; /* 0: as the scene says; each further one coarser */
struct sf_governor {
    bool on;
    double goal_ms;
    unsigned level;      /* to draw with now */
    uint64_t moved_ns;   /* when the camera last moved; 0: never */
    double cost_ms[SF_GOVERNOR_LEVELS]; /* last known of each level; 0: unknown */
};
/* Once a picture. `finest`: how many levels there are below the scene's own resolution (full: 2, half: 1, quarter: 0).
 * While the camera moves: the finest level whose cost holds the goal (an unknown one is tried when the one before does
 * not); not back up before `cost` is well (a fifth) below the goal, so that it does not flicker. 250 ms after the last
 * movement: level 0. Returns whether `level` changed. */
bool sf_governor_update(struct sf_governor *governor, uint64_t now_ns, bool moved, double picture_ms, unsigned finest);

#endif
