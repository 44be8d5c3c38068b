#include "truth/scatter.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/hash.h"
#include "truth/inner.h"
#include "truth/vec.h"

enum {
    CELLS = 32,             /* of the grid, along each axis */
    MEETINGS_MOST = 1000000 /* of one path */
};

struct sf_truth_scatter {
    const struct sf_truth *truth;
    double size[3]; /* m: of a cell */
    double *bounds; /* [z][y][x], 1/m */
};

enum sf_status sf_truth_scatter_create(const struct sf_truth *truth, const struct sf_log *log,
                                       struct sf_truth_scatter **out)
{
    struct sf_truth_scatter *scatter = calloc(1, sizeof *scatter);
    const struct sf_truth_medium *medium = &truth->medium;
    bool empty = !(medium->min[0] <= medium->max[0]), fits = true;

    *out = NULL;
    if (scatter)
        scatter->bounds = calloc((size_t)CELLS * CELLS * CELLS, sizeof *scatter->bounds);
    if (!scatter || !scatter->bounds) {
        sf_truth_scatter_destroy(&scatter);
        return sf_fail(log, SF_ERROR_MEMORY, "no memory for the reference's bounds");
    }
    scatter->truth = truth;
    for (int i = 0; i < 3; i++)
        scatter->size[i] = empty ? 1 : (medium->max[i] - medium->min[i]) / CELLS;
    for (int n = 0; n < CELLS * CELLS * CELLS && !empty; n++) {
        const int cell[3] = {n % CELLS, n / CELLS % CELLS, n / CELLS / CELLS};
        double min[3], max[3];

        for (int i = 0; i < 3;
             i++) { /* a little wider than the cell, for points that rounding puts on the wrong side */
            min[i] = medium->min[i] + (cell[i] - 1e-6) * scatter->size[i];
            max[i] = medium->min[i] + (cell[i] + 1 + 1e-6) * scatter->size[i];
        }
        scatter->bounds[n] = medium->bound(medium->self, min, max);
        fits = fits && scatter->bounds[n] >= 0 && isfinite(scatter->bounds[n]);
    }
    if (!fits) {
        sf_truth_scatter_destroy(&scatter);
        return sf_fail(log, SF_ERROR_INTERNAL, "reference: the medium's bound is not a number");
    }
    *out = scatter;
    return SF_OK;
}

void sf_truth_scatter_destroy(struct sf_truth_scatter **place)
{
    struct sf_truth_scatter *scatter = place ? *place : NULL;

    if (!scatter)
        return;
    free(scatter->bounds);
    free(scatter);
    *place = NULL;
}

double sf_truth_estimate_error(const struct sf_truth_estimate *estimate, int channel)
{
    double paths = (double)estimate->paths;

    return paths > 1 ? sqrt(estimate->spread[channel] / (paths * (paths - 1))) : INFINITY;
}

struct chance {
    uint32_t pixel, path, event;
};

/* 0 <= u < 1 of 53 bits. */
static double draw(struct chance *chance)
{
    uint32_t high = sf_random_u32(chance->pixel, chance->path, chance->event++) >> 6;
    uint32_t low = sf_random_u32(chance->pixel, chance->path, chance->event++) >> 5;

    return (high * 134217728.0 + low) / 9007199254740992.0;
}

/* The way of one ray through the grid. */
struct walk {
    int cell[3], step[3];
    double next[3], apart[3]; /* distance of the next wall, and between walls, along each axis */
};

static void walk_begin(const struct sf_truth_scatter *scatter, const double origin[3], const double w[3], double from,
                       struct walk *walk)
{
    const struct sf_truth_medium *medium = &scatter->truth->medium;

    for (int i = 0; i < 3; i++) {
        double size = scatter->size[i], place = origin[i] + from * w[i] - medium->min[i];

        walk->cell[i] = (int)fmin(fmax(floor(place / size), 0), CELLS - 1);
        walk->step[i] = w[i] > 0 ? 1 : -1;
        walk->apart[i] = fabs(w[i]) > 1e-300 ? size / fabs(w[i]) : INFINITY;
        walk->next[i] = INFINITY;
        if (fabs(w[i]) > 1e-300)
            walk->next[i] = from + ((walk->cell[i] + (w[i] > 0)) * size - place) / w[i];
    }
}

/* Goes on to the next cell; false when the grid ends. */
static bool walk_on(struct walk *walk)
{
    int axis = walk->next[0] <= walk->next[1] && walk->next[0] <= walk->next[2] ? 0
               : walk->next[1] <= walk->next[2]                                 ? 1
                                                                                : 2;

    walk->cell[axis] += walk->step[axis];
    walk->next[axis] += walk->apart[axis];
    return walk->cell[axis] >= 0 && walk->cell[axis] < CELLS;
}

/* Delta tracking: where the ray first meets smoke in from..to (INFINITY: it does not), and what is there. In each cell
 * meetings are drawn as if the extinction were the bound, and each is real with the chance that it has. */
static enum sf_status first_meeting(const struct sf_truth_scatter *scatter, struct chance *chance,
                                    const double origin[3], const double w[3], double from, double to, double *meeting,
                                    struct sf_truth_point *point)
{
    const struct sf_truth_medium *medium = &scatter->truth->medium;
    double span[2] = {from, to}, t, x[3];
    struct walk walk;

    *meeting = INFINITY;
    if (!sf_truth_clip(scatter->truth, origin, w, span))
        return SF_OK;
    walk_begin(scatter, origin, w, span[0], &walk);
    t = span[0];
    do {
        double bound = scatter->bounds[(walk.cell[2] * CELLS + walk.cell[1]) * CELLS + walk.cell[0]];
        double end = fmin(span[1], fmin(walk.next[0], fmin(walk.next[1], walk.next[2])));

        while (bound > 0) {
            t -= log(1 - draw(chance)) / bound;
            if (!(t < end))
                break;
            vec_along(origin, w, t, x);
            medium->at(medium->self, x, point);
            if (!(point->extinction <= bound * (1 + 1e-9)))
                return SF_ERROR_INTERNAL;
            if (draw(chance) * bound < point->extinction) {
                *meeting = t;
                return SF_OK;
            }
        }
        t = end;
    } while (t < span[1] && walk_on(&walk));
    return SF_OK;
}

/* Turns the unit vector w by the phase function (Henyey and Greenstein 1941, inverted). */
static void scatter_direction(struct chance *chance, double g, double w[3])
{
    double u = draw(chance), around = 2 * 3.14159265358979323846 * draw(chance), cosine = 1 - 2 * u, sine;
    double a[3] = {fabs(w[0]) < 0.5, fabs(w[0]) >= 0.5, 0}, b[3];

    if (fabs(g) > 1e-4) {
        double s = (1 - g * g) / (1 + g - 2 * g * u);

        cosine = fmin(fmax((1 + g * g - s * s) / (2 * g), -1), 1);
    }
    sine = sqrt(1 - cosine * cosine);
    vec_cross(w, a, b);
    vec_normalize(b);
    vec_cross(b, w, a);
    for (int i = 0; i < 3; i++)
        w[i] = cosine * w[i] + sine * (cos(around) * a[i] + sin(around) * b[i]);
    vec_normalize(w);
}

/* What comes from behind the smoke, after at least one scattering. */
static void gather_environment(const struct sf_truth *truth, const double x[3], const double w[3],
                               const double weight[3], double sum[3])
{
    const float direction[3] = {(float)w[0], (float)w[1], (float)w[2]};
    float radiance[3];

    if (!truth->has_ambient || sf_truth_first_surface(truth->surfaces, x, w, 0) < INFINITY)
        return;
    sf_environment_radiance(&truth->scene->environment, direction, radiance);
    for (int c = 0; c < 3; c++)
        sum[c] += weight[c] * truth->options.ambient * radiance[c];
}

/* One path; `sum` is what it gathers. */
static enum sf_status follow(const struct sf_truth_scatter *scatter, struct chance *chance, const double origin[3],
                             const double direction[3], double from, double to, uint32_t orders, double sum[3],
                             uint64_t *meetings)
{
    const struct sf_truth *truth = scatter->truth;
    double x[3] = {origin[0], origin[1], origin[2]}, w[3] = {direction[0], direction[1], direction[2]};
    double weight[3] = {1, 1, 1}, lit[3], t;
    struct sf_truth_point point;

    memset(sum, 0, 3 * sizeof *sum);
    for (uint32_t order = 0; order < MEETINGS_MOST; order++) {
        enum sf_status status;

        if (order > 0) {
            from = 0;
            to = sf_truth_first_surface(truth->surfaces, x, w, 0);
        }
        status = first_meeting(scatter, chance, x, w, from, to, &t, &point);
        if (status != SF_OK)
            return status;
        if (isinf(t)) {
            if (order > 0)
                gather_environment(truth, x, w, weight, sum);
            return SF_OK;
        }
        if (orders > 0 && order == orders)
            return SF_OK;
        (*meetings)++;
        vec_along(x, w, t, x);
        sf_truth_lit(truth, x, w, lit);
        for (int c = 0; c < 3; c++) {
            sum[c] += weight[c] * point.emission[c] / point.extinction;
            weight[c] *= point.scattering[c] / point.extinction;
            sum[c] += weight[c] * lit[c];
        }
        double strongest = fmax(weight[0], fmax(weight[1], weight[2]));
        if (strongest < 0.1) {
            if (!(draw(chance) * 0.1 < strongest))
                return SF_OK;
            for (int c = 0; c < 3; c++)
                weight[c] *= 0.1 / strongest;
        }
        scatter_direction(chance, truth->medium.g, w);
    }
    return SF_ERROR_INTERNAL;
}

enum sf_status sf_truth_scatter_ray(const struct sf_truth_scatter *scatter, const double origin[3],
                                    const double direction[3], double from, double to,
                                    const struct sf_truth_paths *paths, struct sf_truth_estimate *estimate)
{
    double w[3] = {direction[0], direction[1], direction[2]}, length = vec_normalize(w);

    for (uint32_t i = 0; i < paths->count; i++) {
        struct chance chance = {sf_hash_u32(paths->pixel), paths->first + i, 0};
        double sum[3];
        enum sf_status status =
            follow(scatter, &chance, origin, w, from * length, to * length, paths->orders, sum, &estimate->meetings);

        if (status != SF_OK)
            return status;
        estimate->paths++;
        for (int c = 0; c < 3; c++) { /* Welford 1962 */
            double off = sum[c] - estimate->mean[c];

            estimate->mean[c] += off / (double)estimate->paths;
            estimate->spread[c] += off * (sum[c] - estimate->mean[c]);
        }
    }
    return SF_OK;
}

struct scatter_render {
    const struct sf_truth_scatter *scatter;
    struct sf_truth_view view;
    struct sf_truth_paths paths;
    struct sf_truth_estimate *estimates;
};

static enum sf_status scatter_row(void *user, uint32_t y, const atomic_bool *stopped)
{
    const struct scatter_render *render = user;
    const struct sf_truth_view *view = &render->view;
    enum sf_status status = SF_OK;

    for (uint32_t x = 0; x < view->width && status == SF_OK && !atomic_load(stopped); x++) {
        struct sf_truth_paths paths = render->paths;
        double direction[3];

        paths.pixel = y * view->width + x;
        sf_truth_view_ray(view, x, y, direction);
        double to = sf_truth_surface(render->scatter->truth, view->eye, direction, view->near);
        status = sf_truth_scatter_ray(render->scatter, view->eye, direction, view->near, to, &paths,
                                      &render->estimates[paths.pixel]);
    }
    return status;
}

enum sf_status sf_truth_scatter_render(const struct sf_truth_scatter *scatter, const struct sf_camera_pose *pose,
                                       uint32_t width, uint32_t height, uint32_t first, uint32_t count, uint32_t orders,
                                       const struct sf_truth_work *work, struct sf_truth_estimate *estimates)
{
    struct scatter_render render = {
        .scatter = scatter, .paths = {.first = first, .count = count, .orders = orders}, .estimates = estimates};
    enum sf_status status;

    if (width == 0 || height == 0)
        return sf_fail(work->log, SF_ERROR_USAGE, "reference: a picture of %ux%u pixels", width, height);
    sf_truth_view(pose, width, height, &render.view);
    status = sf_truth_rows(height, work, scatter_row, &render);
    for (uint32_t i = 0; i < width * height && status == SF_OK; i++) {
        const struct sf_truth_estimate *estimate = &estimates[i];

        if (!isfinite(estimate->mean[0]) || !isfinite(estimate->mean[1]) || !isfinite(estimate->mean[2]))
            return sf_fail(work->log, SF_ERROR_INTERNAL, "reference: pixel (%u, %u) is not a number", i % width,
                           i / width);
    }
    if (status == SF_ERROR_INTERNAL)
        sf_fail(work->log, status,
                "reference: the medium is denser than its bound, or has no number, or light does not "
                "leave it");
    else if (status == SF_ERROR_MEMORY)
        sf_fail(work->log, status, "no memory for a reference of %ux%u pixels", width, height);
    return status;
}
