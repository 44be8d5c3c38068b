/* Holds a frame time while the camera moves by drawing the smoke coarser, and refines when it rests. */
#ifndef SF_APP_VIEW_GOVERNOR_H
#define SF_APP_VIEW_GOVERNOR_H

#include <stdbool.h>
#include <stdint.h>

enum { SF_GOVERNOR_LEVELS = 3, SF_GOVERNOR_RECENT = 3 }; /* level 0: as the scene says; each further one coarser */
struct sf_governor {
    bool on;
    double goal_ms;
    unsigned level;                     /* to draw with now; the caller may put it back to 0 */
    uint64_t moved_ns;                  /* when the camera last moved; 0: never */
    uint64_t changed_ns;                /* when the level last changed */
    double cost_ms[SF_GOVERNOR_LEVELS]; /* last known of each level; 0: unknown */
    /* What the cost of the present level is taken from. */
    unsigned finest, measured;            /* that the costs are for; level that the pictures below are of */
    unsigned pictures;                    /* of that level, since it began; stops at SF_GOVERNOR_RECENT + 2 */
    double recent_ms[SF_GOVERNOR_RECENT]; /* newest first */
    double newest_ms;                     /* as last passed */
};
/* Once a picture, or more often. `picture_ms`: what the newest picture that is known of has cost; the same number again is
 * the same picture; 0: none is known. `finest`: how many levels there are below the scene's own resolution (full: 2, half:
 * 1, quarter: 0); when it changes, the costs are forgotten.
 * A cost is the typical one of some pictures: the first of a level does not count (the change itself is in it, or it was
 * queued before), and one slow picture alone is not believed. When the present level's cost changes, those known of the
 * others change in proportion.
 * While the camera moves: the finest level whose cost holds the goal (an unknown one is tried when the one before does
 * not); a finer one than now only when its cost is a fifth below the goal, and a second after the last change, so that it
 * does not flicker. 250 ms after the last movement, or when not on: level 0. Returns whether `level` changed. */
bool sf_governor_update(struct sf_governor *governor, uint64_t now_ns, bool moved, double picture_ms, unsigned finest);

#endif
