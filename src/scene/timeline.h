/* When things of an effect happen: clocks within clocks, and how strong a thing is at a moment. Plain functions of time, so that any moment
 * can be asked for in any order. No GPU.
 *
 * A clock turns the time of the one around it into its own: with t counted from its start, and `every` above 0, it begins again at each
 * multiple of that, `times` times (0: for ever), and shows t less the last of them. It runs for `duration` each time (0: until it begins
 * again, or for ever), and is at rest before, between and after. */
#ifndef SF_SCENE_TIMELINE_H
#define SF_SCENE_TIMELINE_H

#include <stdbool.h>
#include <stdint.h>

enum { SF_CLOCKS_MAX = 10 };

enum sf_easing { SF_EASING_LINEAR, SF_EASING_SMOOTH, SF_EASING_IN, SF_EASING_OUT };

struct sf_clock {
    float start;    /* s, on the clock around it */
    float duration; /* s; not above `every`, when that is not 0 */
    float every;    /* s; 0: once */
    int32_t times;
};

/* The clocks of one step, the outermost first, and its strength over the innermost: 1, but that it rises from 0 in the first `fade_in`
 * seconds and falls to 0 in the last `fade_out`. Zeroed where it is not used, so that its bytes can be compared. */
struct sf_timing {
    struct sf_clock clocks[SF_CLOCKS_MAX];
    uint32_t clock_count;
    float fade_in,
        fade_out;   /* s; together not above the innermost clock's run. One that runs for ever does not fade out */
    int32_t easing; /* enum sf_easing: of both */
};

/* 0..1 for 0..1, u limited to that. linear: u; smooth: u^2 (3 - 2u); in: u^2; out: u (2 - u). */
double sf_ease(int32_t easing, double u);
/* How long a clock runs each time, s; INFINITY: for ever. */
double sf_clock_run(const struct sf_clock *clock);
/* Whether the step is on at the time (s on the outermost clock, a millionth more to be safe of rounding); then its innermost clock's time,
 * and its strength. `timing` NULL: always on, at that time, with strength 1. */
bool sf_timing_at(const struct sf_timing *timing, double time, double *local, double *strength);
/* Integral of the strength over the innermost clock from 0 to `local`, s. */
double sf_timing_integral(const struct sf_timing *timing, double local);

/* Something that the step makes while its innermost clock runs from 0 to `local`; 0 for 0, and never less for more. */
typedef double (*sf_timing_fn)(const void *user, double local);
/* All of it up to a time of the outermost clock. */
double sf_timing_sum(const struct sf_timing *timing, double time, sf_timing_fn made, const void *user);
/* Takes the time between two apart into runs of the innermost clock: each from `begin` to `end` of it, which is `shift` seconds behind the
 * outermost one. What the runs make adds up to the difference of the two sums, bit for bit while it is whole numbers. */
typedef void (*sf_timing_run_fn)(void *user, double begin, double end, double shift);
void sf_timing_runs(const struct sf_timing *timing, double from, double to, sf_timing_run_fn run, void *user);

/* Noise over time, between -1 and 1, for lamps and hands that are not steady: 0 at 0, a random number at each other whole x, and smooth
 * between. `purpose` tells one from another. */
double sf_unsteady(uint32_t seed, uint32_t purpose, double x);

#endif
