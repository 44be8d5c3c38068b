/* Which frame is shown when: play, pause, single step, slow motion, and the way to a frame that is far. Plain arithmetic
 * on a clock that the caller reads. */
#ifndef SF_APP_VIEW_PLAYBACK_H
#define SF_APP_VIEW_PLAYBACK_H

#include <stdbool.h>
#include <stdint.h>

enum { SF_PLAYBACK_LAST = 9999999 }; /* the highest frame number, as in frame lists */
struct sf_playback {
    bool playing;
    double speed;     /* times real time: 1/16 .. 4 */
    double fps;       /* of the scene */
    uint32_t frame;   /* to be shown now */
    uint32_t longest; /* the furthest frame so far, for the time bar; at least 10 s */
    double rest;      /* frames that have passed and are not shown: below 1, but after a slow picture */
    uint64_t last_ns; /* when the clock was last read; 0: the next reading begins */
};
/* Plays, from frame 0. */
void sf_playback_init(struct sf_playback *playback, double fps);
/* Passes the time up to now_ns. A picture that takes long does not make the next one jump by more than 4 frames: what
 * cannot be shown in time is shown later, up to 4 frames of it, and the rest never. Returns whether `frame` changed. */
bool sf_playback_tick(struct sf_playback *playback, uint64_t now_ns);
void sf_playback_toggle(struct sf_playback *playback);
/* Pauses, and goes `frames` on or back (never below 0). */
void sf_playback_step(struct sf_playback *playback, int frames);
/* Plays on from there, or stays paused. */
void sf_playback_seek(struct sf_playback *playback, uint32_t frame);
/* Twice or half the speed, within its bounds. */
void sf_playback_faster(struct sf_playback *playback, int doublings);
/* Seconds until the next frame is due, not below 0; 1e9 while paused. */
double sf_playback_due(const struct sf_playback *playback, uint64_t now_ns);

#endif
