/* Single scattering along a ray. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "truth/inner.h"
#include "truth/vec.h"

enum {
    NODES = 7,       /* of Kronrod's rule; the odd ones are Gauss's */
    PARTS_LEAST = 16 /* no first panel is longer than this part of the way through the smoke, so that none skips a
                        shadow of smoke on smoke */
};
static const double DEEP = 42; /* optical depth behind which nothing is looked for */

/* Gauss and Kronrod's rule of 3 and 7 points (Kronrod 1965; Piessens et al., QUADPACK, 1983): exact for degree 11. */
static const double places[NODES] = {
    -0.960491268708020283423507092629080, -0.774596669241483377035853079956480, -0.434243749346802558002071502844628, 0,
    0.434243749346802558002071502844628,  0.774596669241483377035853079956480,  0.960491268708020283423507092629080,
};
static const double kronrod[NODES] = {
    0.104656226026467265193823857192073, 0.268488089868333440728569280666710, 0.401397414775962222905051818618432,
    0.450916538658474142345110087045571, 0.401397414775962222905051818618432, 0.268488089868333440728569280666710,
    0.104656226026467265193823857192073,
};
static const double gauss[NODES] = {0, 5.0 / 9, 0, 8.0 / 9, 0, 5.0 / 9, 0};

struct ray {
    const struct sf_truth *truth;
    double origin[3], w[3];
};

void sf_truth_space_finish(struct sf_truth_space *space)
{
    free(space->breaks.values);
    free(space->panels);
    memset(space, 0, sizeof *space);
}

bool sf_truth_clip(const struct sf_truth *truth, const double origin[3], const double direction[3], double span[2])
{
    const struct sf_truth_medium *medium = &truth->medium;

    for (int i = 0; i < 3; i++) {
        double inverse = 1 / (fabs(direction[i]) > 1e-300 ? direction[i] : 1e-300);
        double a = (medium->min[i] - origin[i]) * inverse, b = (medium->max[i] - origin[i]) * inverse;

        if (!(medium->min[i] <= medium->max[i]))
            return false;
        span[0] = fmax(span[0], fmin(a, b));
        span[1] = fmin(span[1], fmax(a, b));
    }
    return span[0] < span[1];
}

/* What arrives at the ray's beginning from each metre at t, in a panel. */
static void integrand(const struct ray *ray, const struct sf_truth_panel *panel, const double start[3], double t,
                      double rgb[3])
{
    const struct sf_truth *truth = ray->truth;
    const struct sf_truth_medium *medium = &truth->medium;
    double x[3], lit[3], ambient[3] = {0, 0, 0}, through;
    struct sf_truth_point point;

    vec_along(ray->origin, ray->w, t, x);
    medium->at(medium->self, x, &point);
    through = exp(-(panel->depth + medium->optical_depth(medium->self, start, x)));
    sf_truth_lit(truth, x, ray->w, lit);
    if (truth->has_ambient)
        sf_truth_ambient(truth, x, ambient);
    for (int c = 0; c < 3; c++)
        rgb[c] = through * (point.scattering[c] * (lit[c] + ambient[c]) + point.emission[c]);
}

/* The estimate is ten times the difference of the two rules. For a smooth integrand the better rule is better than that
 * by far; but where light grazes spheres the integrand has roots' corners, at which neither rule is good, all to the same side: there the
 * difference alone falls short of the error by up to four times. */
static void panel_evaluate(const struct ray *ray, struct sf_truth_panel *panel)
{
    double values[NODES][3], start[3], half = 0.5 * (panel->to - panel->from);

    vec_along(ray->origin, ray->w, panel->from, start);
    for (int i = 0; i < NODES; i++)
        integrand(ray, panel, start, panel->from + half * (1 + places[i]), values[i]);
    panel->worst = 0;
    for (int c = 0; c < 3; c++) {
        double better = 0, simpler = 0, error;

        for (int i = 0; i < NODES; i++) {
            better += kronrod[i] * values[i][c];
            simpler += gauss[i] * values[i][c];
        }
        error = 10 * fabs(better - simpler) * half;
        panel->value[c] = better * half;
        panel->error[c] = error;
        panel->worst = fmax(panel->worst, error);
    }
}

static void swap(struct sf_truth_panel *a, struct sf_truth_panel *b)
{
    struct sf_truth_panel c = *a;

    *a = *b;
    *b = c;
}

static bool heap_push(struct sf_truth_space *space, const struct sf_truth_panel *panel)
{
    size_t at = space->count;

    if (!sf_array_reserve((void **)&space->panels, space->count, &space->capacity, 1, sizeof *space->panels))
        return false;
    space->panels[space->count++] = *panel;
    for (; at > 0 && space->panels[at].worst > space->panels[(at - 1) / 2].worst; at = (at - 1) / 2)
        swap(&space->panels[at], &space->panels[(at - 1) / 2]);
    return true;
}

/* After the top one has become better. */
static void heap_sink(struct sf_truth_space *space)
{
    size_t at = 0;

    for (;;) {
        size_t child = 2 * at + 1;

        if (child + 1 < space->count && space->panels[child + 1].worst > space->panels[child].worst)
            child++;
        if (child >= space->count || !(space->panels[child].worst > space->panels[at].worst))
            return;
        swap(&space->panels[at], &space->panels[child]);
        at = child;
    }
}

static int compare_distances(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

/* The pieces' ends in ascending order, both ends of the way included. */
static bool find_pieces(const struct ray *ray, struct sf_truth_space *space, const double span[2])
{
    const struct sf_truth_medium *medium = &ray->truth->medium;
    struct sf_truth_distances *breaks = &space->breaks;

    breaks->count = 0;
    if (!sf_truth_distances_add(breaks, span[0]) || !sf_truth_distances_add(breaks, span[1]) ||
        !medium->breakpoints(medium->self, ray->origin, ray->w, span[0], span[1], breaks) ||
        !sf_truth_light_breaks(ray->truth, ray->origin, ray->w, span[0], span[1], breaks))
        return false;
    qsort(breaks->values, breaks->count, sizeof *breaks->values, compare_distances);
    return true;
}

static double segment_depth(const struct ray *ray, double from, double to)
{
    double a[3], b[3];

    vec_along(ray->origin, ray->w, from, a);
    vec_along(ray->origin, ray->w, to, b);
    return ray->truth->medium.optical_depth(ray->truth->medium.self, a, b);
}

/* A piece that holds no smoke but what rounding has put there. */
static bool is_gap(const struct ray *ray, double half, double depth)
{
    struct sf_truth_point point;
    double x[3];

    if (!(depth < 1e-12))
        return false;
    vec_along(ray->origin, ray->w, half, x);
    ray->truth->medium.at(ray->truth->medium.self, x, &point);
    return point.extinction == 0;
}

/* Evaluates the first panels, and finds near, far and the optical depth. */
static bool first_panels(const struct ray *ray, struct sf_truth_space *space, struct sf_truth_result *result)
{
    const double *ends = space->breaks.values;
    double longest = (ends[space->breaks.count - 1] - ends[0]) / PARTS_LEAST;
    uint32_t fixed = ray->truth->options.panels;

    space->count = 0;
    for (size_t i = 0; i + 1 < space->breaks.count; i++) {
        double length = ends[i + 1] - ends[i], depth = length > 0 ? segment_depth(ray, ends[i], ends[i + 1]) : 0;
        uint32_t parts = fixed > 0 ? fixed : (uint32_t)fmax(1, ceil(length / longest - 1e-9));

        if (depth == 0 ||
            is_gap(ray, 0.5 * (ends[i] + ends[i + 1]), depth)) /* not a number goes on, to be found later */
            continue;
        result->near = fmin(result->near, ends[i]);
        result->far = ends[i + 1];
        struct sf_truth_panel panel = {.depth = result->optical_depth, .to = ends[i]};
        for (uint32_t k = 0; k < parts && !(result->optical_depth > DEEP); k++) {
            panel.from = panel.to;
            panel.to = k + 1 < parts ? ends[i] + length * (k + 1) / parts : ends[i + 1];
            panel_evaluate(ray, &panel);
            result->evaluations += NODES;
            if (!heap_push(space, &panel))
                return false;
            panel.depth += k + 1 < parts ? segment_depth(ray, panel.from, panel.to) : 0;
        }
        result->optical_depth += depth;
    }
    return true;
}

static double limit_of(const struct sf_truth *truth, const double sums[3])
{
    return fmax(truth->options.floor, truth->options.tolerance * fmax(sums[0], fmax(sums[1], sums[2])));
}

/* Halves the worst panel until all is well. */
static bool refine(const struct ray *ray, struct sf_truth_space *space, struct sf_truth_result *result)
{
    const struct sf_truth_options *options = &ray->truth->options;
    double sums[3] = {0}, errors[3] = {0};

    for (size_t i = 0; i < space->count; i++) {
        for (int c = 0; c < 3; c++) {
            sums[c] += space->panels[i].value[c];
            errors[c] += space->panels[i].error[c];
        }
    }
    while (options->panels == 0 && space->count > 0 && result->evaluations + 2 * NODES <= options->limit) {
        struct sf_truth_panel *top = &space->panels[0], left = *top, right = *top;
        double half = 0.5 * (top->from + top->to);

        if (!(fmax(errors[0], fmax(errors[1], errors[2])) > limit_of(ray->truth, sums)))
            break;
        if (top->to - top->from <= 64 * DBL_EPSILON * fmax(fabs(top->from), fabs(top->to)) || !(top->worst > 0))
            break; /* as small as it can be */
        left.to = right.from = half;
        right.depth += segment_depth(ray, left.from, half);
        panel_evaluate(ray, &left);
        panel_evaluate(ray, &right);
        result->evaluations += 2 * NODES;
        for (int c = 0; c < 3; c++) {
            sums[c] += left.value[c] + right.value[c] - top->value[c];
            errors[c] += left.error[c] + right.error[c] - top->error[c];
        }
        *top = left;
        heap_sink(space);
        if (!heap_push(space, &right))
            return false;
    }
    return true;
}

enum sf_status sf_truth_ray_in(const struct sf_truth *truth, struct sf_truth_space *space, const double origin[3],
                               const double direction[3], double from, double to, struct sf_truth_result *result)
{
    struct ray ray = {.truth = truth, .w = {direction[0], direction[1], direction[2]}};
    double length = vec_normalize(ray.w), span[2] = {from * length, to * length}, errors[3] = {0};

    memcpy(ray.origin, origin, sizeof ray.origin);
    *result = (struct sf_truth_result){.transmittance = 1, .near = INFINITY, .far = -INFINITY, .converged = true};
    if (!sf_truth_clip(truth, origin, ray.w, span) || segment_depth(&ray, span[0], span[1]) == 0)
        return SF_OK;
    if (!find_pieces(&ray, space, span) || !first_panels(&ray, space, result) || !refine(&ray, space, result))
        return SF_ERROR_MEMORY;
    for (size_t i = 0; i < space->count; i++) {
        for (int c = 0; c < 3; c++) {
            result->radiance[c] += space->panels[i].value[c];
            errors[c] += space->panels[i].error[c];
        }
    }
    result->near /= length;
    result->far /= length;
    result->transmittance = exp(-result->optical_depth);
    result->error = fmax(errors[0], fmax(errors[1], errors[2]));
    /* Sums kept up to date and sums made anew differ by their rounding. */
    result->converged = result->error <= limit_of(truth, result->radiance) * (1 + 1e-6);
    return SF_OK;
}

enum sf_status sf_truth_ray(const struct sf_truth *truth, const double origin[3], const double direction[3],
                            double from, double to, struct sf_truth_result *result)
{
    struct sf_truth_space space = {0};
    enum sf_status status = sf_truth_ray_in(truth, &space, origin, direction, from, to, result);

    sf_truth_space_finish(&space);
    return status;
}
