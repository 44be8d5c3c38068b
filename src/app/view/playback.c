#include "playback.h"

#include <math.h>

static const double SLOWEST = 1.0 / 16, FASTEST = 4;
static const double SHOWN_S = 10; /* of the time bar, at least */
static const double NEVER_S = 1e9;
enum { JUMP = 4 }; /* frames */

void sf_playback_init(struct sf_playback *playback, double fps)
{
    *playback = (struct sf_playback){.playing = true, .speed = 1, .fps = fps};
    playback->longest = fps > 0 ? (uint32_t)fmin(ceil(SHOWN_S * fps), SF_PLAYBACK_LAST) : 0;
}

static void show(struct sf_playback *playback, uint32_t frame)
{
    playback->frame = frame;
    if (playback->longest < frame)
        playback->longest = frame;
}

static double frames_since(const struct sf_playback *playback, uint64_t now_ns)
{
    if (playback->last_ns == 0 || now_ns <= playback->last_ns)
        return 0;
    return (double)(now_ns - playback->last_ns) * 1e-9 * playback->speed * playback->fps;
}

bool sf_playback_tick(struct sf_playback *playback, uint64_t now_ns)
{
    double passed = frames_since(playback, now_ns), whole;

    playback->last_ns = now_ns;
    if (!playback->playing || playback->frame >= SF_PLAYBACK_LAST)
        return false;
    passed += playback->rest;
    whole = fmin(floor(passed), JUMP);
    playback->rest = fmin(passed - whole, JUMP);
    if (!(whole >= 1))
        return false;
    show(playback, (uint32_t)fmin(playback->frame + whole, SF_PLAYBACK_LAST));
    return true;
}

void sf_playback_toggle(struct sf_playback *playback)
{
    playback->playing = !playback->playing;
    playback->last_ns = 0; /* the clock may not have been read meanwhile */
}

void sf_playback_step(struct sf_playback *playback, int frames)
{
    double to = fmin(fmax((double)playback->frame + frames, 0), SF_PLAYBACK_LAST);

    playback->playing = false;
    playback->rest = 0;
    show(playback, (uint32_t)to);
}

void sf_playback_seek(struct sf_playback *playback, uint32_t frame)
{
    playback->rest = 0;
    playback->last_ns = 0; /* the way there may be long, and does not count */
    show(playback, frame < SF_PLAYBACK_LAST ? frame : SF_PLAYBACK_LAST);
}

void sf_playback_faster(struct sf_playback *playback, int doublings)
{
    playback->speed = fmin(fmax(ldexp(playback->speed, doublings), SLOWEST), FASTEST);
}

double sf_playback_due(const struct sf_playback *playback, uint64_t now_ns)
{
    double rate = playback->speed * playback->fps;

    if (!playback->playing || !(rate > 0) || playback->frame >= SF_PLAYBACK_LAST)
        return NEVER_S;
    if (playback->last_ns == 0)
        return 0; /* the clock is to be read first */
    return fmax((1 - playback->rest - frames_since(playback, now_ns)) / rate, 0);
}
