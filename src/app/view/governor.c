#include "governor.h"

#include <math.h>
#include <string.h>

static const uint64_t STILL_NS = 250 * 1000000ull, STAY_NS = 1000 * 1000000ull;
static const double WELL_BELOW = 0.8, WEIGHT = 0.3;

/* Of the recent pictures but the level's first; 0 while they are too few to tell. */
static double typical_ms(const struct sf_governor *governor)
{
    const double *ms = governor->recent_ms;

    if (governor->pictures < 3)
        return 0;
    if (governor->pictures == 3)
        return fmin(ms[0], ms[1]);
    return fmax(fmin(ms[0], ms[1]), fmin(fmax(ms[0], ms[1]), ms[2])); /* the middle one */
}

static void measure(struct sf_governor *governor, double picture_ms)
{
    double *cost = &governor->cost_ms[governor->level], typical, before = *cost;

    if (!(picture_ms > 0) || picture_ms == governor->newest_ms)
        return;
    governor->newest_ms = picture_ms;
    if (governor->pictures < SF_GOVERNOR_RECENT + 2)
        governor->pictures++;
    memmove(&governor->recent_ms[1], &governor->recent_ms[0], sizeof governor->recent_ms - sizeof *governor->recent_ms);
    governor->recent_ms[0] = picture_ms;
    if (!((typical = typical_ms(governor)) > 0))
        return;
    if (governor->pictures < SF_GOVERNOR_RECENT + 2 || !(before > 0)) {
        *cost = typical; /* measured anew: what is known of the others was measured too */
        return;
    }
    *cost += WEIGHT * (typical - *cost);
    for (unsigned level = 0; level < SF_GOVERNOR_LEVELS; level++)
        if (level != governor->level)
            governor->cost_ms[level] *= *cost / before;
}

static unsigned choose(const struct sf_governor *governor, uint64_t now_ns)
{
    bool stay = now_ns - governor->changed_ns < STAY_NS;
    unsigned level = 0;

    for (; level < governor->finest; level++) {
        double cost = governor->cost_ms[level];

        if (level < governor->level ? !stay && cost <= WELL_BELOW * governor->goal_ms : cost <= governor->goal_ms)
            break;
    }
    return level;
}

bool sf_governor_update(struct sf_governor *governor, uint64_t now_ns, bool moved, double picture_ms, unsigned finest)
{
    unsigned level = 0;

    finest = finest < SF_GOVERNOR_LEVELS ? finest : SF_GOVERNOR_LEVELS - 1;
    if (finest != governor->finest)
        memset(governor->cost_ms, 0, sizeof governor->cost_ms);
    if (finest != governor->finest || governor->level != governor->measured)
        governor->pictures = 0;
    governor->finest = finest;
    governor->measured = governor->level;
    measure(governor, picture_ms);
    if (moved)
        governor->moved_ns = now_ns;
    if (governor->on && governor->moved_ns > 0 && now_ns - governor->moved_ns < STILL_NS)
        level = choose(governor, now_ns);
    if (level == governor->level)
        return false;
    governor->level = level;
    governor->changed_ns = now_ns;
    return true;
}
