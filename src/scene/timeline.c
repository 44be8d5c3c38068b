#include "scene/timeline.h"

#include <math.h>
#include "base/hash.h"

/* A start of 0.1 s is a float just above it: the frame at 0.1 s is meant to be on. */
static const double ROUNDING = 1e-6; /* s */

double sf_ease(int32_t easing, double u)
{
    u = fmin(fmax(u, 0), 1);
    switch ((enum sf_easing)easing) {
    case SF_EASING_SMOOTH:
        return u * u * (3 - 2 * u);
    case SF_EASING_IN:
        return u * u;
    case SF_EASING_OUT:
        return u * (2 - u);
    case SF_EASING_LINEAR:
        break;
    }
    return u;
}

/* Integral of sf_ease over 0..u, for u in 0..1. */
static double ease_integral(int32_t easing, double u)
{
    switch ((enum sf_easing)easing) {
    case SF_EASING_SMOOTH:
        return u * u * u * (1 - u / 2);
    case SF_EASING_IN:
        return u * u * u / 3;
    case SF_EASING_OUT:
        return u * u * (1 - u / 3);
    case SF_EASING_LINEAR:
        break;
    }
    return u * u / 2;
}

double sf_clock_run(const struct sf_clock *clock)
{
    return clock->duration > 0 ? clock->duration : clock->every > 0 ? clock->every : INFINITY;
}

/* How often the clock has begun again by the time y since its start, and the time since it last did. */
static double turns(const struct sf_clock *clock, double y, double *rest)
{
    double n = clock->every > 0 ? floor(y / clock->every) : 0;

    *rest = clock->every > 0 ? fmin(fmax(y - n * clock->every, 0), clock->every) : y;
    return n;
}

static bool clock_at(const struct sf_clock *clock, double *time)
{
    double y = *time - clock->start, n;

    if (y < 0)
        return false;
    n = turns(clock, y, time);
    return (clock->every <= 0 || clock->times == 0 || n < clock->times) && *time < sf_clock_run(clock);
}

static const struct sf_clock *innermost(const struct sf_timing *timing)
{
    return &timing->clocks[timing->clock_count - 1];
}

static double strength_at(const struct sf_timing *timing, double local)
{
    double run = sf_clock_run(innermost(timing)), strength = 1;

    if (timing->fade_in > 0)
        strength *= sf_ease(timing->easing, local / timing->fade_in);
    if (timing->fade_out > 0)
        strength *= sf_ease(timing->easing, (run - local) / timing->fade_out);
    return strength;
}

bool sf_timing_at(const struct sf_timing *timing, double time, double *local, double *strength)
{
    *local = time;
    *strength = 1;
    if (!timing)
        return true;
    *local += ROUNDING;
    for (uint32_t i = 0; i < timing->clock_count; i++)
        if (!clock_at(&timing->clocks[i], local))
            return false;
    *strength = strength_at(timing, *local);
    return true;
}

double sf_timing_integral(const struct sf_timing *timing, double local)
{
    double run = sf_clock_run(innermost(timing)), in = timing->fade_in, out = isfinite(run) ? timing->fade_out : 0;
    double whole = fmin(local, run - out), rest = local - (run - out);
    double sum = in > 0 ? in * ease_integral(timing->easing, fmin(local / in, 1)) + fmax(whole - in, 0) : whole;

    if (out > 0 && rest > 0)
        sum += out * (ease_integral(timing->easing, 1) - ease_integral(timing->easing, fmax(1 - rest / out, 0)));
    return sum;
}

/* ---- sums and runs ---- */

struct sum {
    const struct sf_timing *timing;
    sf_timing_fn made;
    const void *user;
};

static double sum_of(const struct sum *sum, uint32_t level, double time);

/* What one turn of the clock makes by its time z. */
static double sum_within(const struct sum *sum, uint32_t level, double z)
{
    const struct sf_clock *clock = &sum->timing->clocks[level];

    if (clock->duration > 0)
        z = fmin(z, clock->duration);
    return level + 1 == sum->timing->clock_count ? sum->made(sum->user, z) : sum_of(sum, level + 1, z);
}

static double sum_of(const struct sum *sum, uint32_t level, double time)
{
    const struct sf_clock *clock = &sum->timing->clocks[level];
    double y = time - clock->start, rest, n;

    if (!(y > 0))
        return 0;
    n = turns(clock, y, &rest);
    if (n <= 0)
        return sum_within(sum, level, rest);
    if (clock->times > 0 && n >= clock->times)
        return clock->times * sum_within(sum, level, clock->every);
    return n * sum_within(sum, level, clock->every) + sum_within(sum, level, rest);
}

double sf_timing_sum(const struct sf_timing *timing, double time, sf_timing_fn made, const void *user)
{
    const struct sum sum = {timing, made, user};

    return sum_of(&sum, 0, time);
}

struct runs {
    const struct sf_timing *timing;
    sf_timing_run_fn run;
    void *user;
};

static void runs_of(const struct runs *runs, uint32_t level, double from, double to, double shift);

static void run_within(const struct runs *runs, uint32_t level, double from, double to, double shift)
{
    const struct sf_clock *clock = &runs->timing->clocks[level];

    if (clock->duration > 0) {
        from = fmin(from, clock->duration);
        to = fmin(to, clock->duration);
    }
    if (!(to > from))
        return;
    if (level + 1 == runs->timing->clock_count)
        runs->run(runs->user, from, to, shift);
    else
        runs_of(runs, level + 1, from, to, shift);
}

static void runs_of(const struct runs *runs, uint32_t level, double from, double to, double shift)
{
    const struct sf_clock *clock = &runs->timing->clocks[level];
    double before, after, first, last;

    if (!(to > clock->start))
        return;
    first = turns(clock, fmax(from - clock->start, 0), &before);
    last = turns(clock, to - clock->start, &after);
    for (double n = first; n <= last && (clock->times == 0 || clock->every <= 0 || n < clock->times); n++)
        run_within(runs, level, n == first ? before : 0, n == last ? after : clock->every,
                   shift + clock->start + n * clock->every);
}

void sf_timing_runs(const struct sf_timing *timing, double from, double to, sf_timing_run_fn run, void *user)
{
    const struct runs runs = {timing, run, user};

    runs_of(&runs, 0, from, to, 0);
}

/* ---- unsteady ---- */

static double lattice(uint32_t seed, uint32_t purpose, double x)
{
    return x > 0 ? 2 * (double)sf_random_float(seed, (uint32_t)fmod(x, 4294967296.0), purpose) - 1 : 0;
}

double sf_unsteady(uint32_t seed, uint32_t purpose, double x)
{
    double at = floor(x), before = lattice(seed, purpose, at), after = lattice(seed, purpose, at + 1);

    return before + (after - before) * sf_ease(SF_EASING_SMOOTH, x - at);
}
