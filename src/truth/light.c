/* Light that reaches a point of the smoke. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "truth/inner.h"
#include "truth/vec.h"

static const double PI = 3.14159265358979323846;

struct sf_truth_options sf_truth_options_usual(void)
{
    return (struct sf_truth_options){.tolerance = 1e-4, .floor = 1e-7, .ambient = 1, .limit = 200000};
}

static void light_fill(const struct sf_light *from, struct sf_truth_light *light)
{
    light->kind = from->kind;
    for (int i = 0; i < 3; i++) {
        light->position[i] = from->position[i];
        light->direction[i] = from->direction[i];
        light->power[i] = (double)from->color[i] * from->intensity;
    }
    vec_normalize(light->direction); /* the loader's is rounded to float */
    light->cosine_inner = cos(from->inner * PI / 180);
    light->cosine_outer = cos(from->outer * PI / 180);
    light->shadows = from->shadows;
}

enum sf_status sf_truth_create(const struct sf_scene *scene, const struct sf_truth_medium *medium,
                               const struct sf_truth_options *options, const struct sf_log *log, struct sf_truth **out)
{
    struct sf_truth *truth;
    enum sf_status status;

    *out = NULL;
    if (!(options->tolerance >= 0) || !(options->floor >= 0) || !(options->ambient >= 0) || options->limit < 7)
        return sf_fail(log, SF_ERROR_USAGE,
                       "reference: tolerance, floor and ambient are 0 or more, the limit is 7 evaluations or more");
    truth = calloc(1, sizeof *truth);
    if (!truth)
        return sf_fail(log, SF_ERROR_MEMORY, "no memory for the reference");
    truth->scene = scene;
    truth->medium = *medium;
    truth->options = *options;
    for (uint32_t i = 0; i < scene->light_count; i++)
        light_fill(&scene->lights[i], &truth->lights[truth->light_count++]);
    if (medium->min[0] <= medium->max[0]) {
        double diagonal[3];

        for (int i = 0; i < 3; i++) {
            truth->middle[i] = 0.5 * (medium->min[i] + medium->max[i]);
            diagonal[i] = medium->max[i] - medium->min[i];
        }
        truth->reach = 1.001 * sqrt(vec_dot(diagonal, diagonal));
    }
    for (int i = 0; i < 9; i++) {
        for (int c = 0; c < 3; c++) {
            truth->sh[i][c] = scene->environment.sh[i][c] * options->ambient;
            truth->has_ambient = truth->has_ambient || truth->sh[i][c] != 0;
        }
    }
    status = sf_truth_surfaces_create(scene, log, &truth->surfaces);
    if (status != SF_OK)
        sf_truth_destroy(&truth);
    else
        truth->casts = sf_truth_casts(truth->surfaces);
    *out = truth;
    return status;
}

void sf_truth_destroy(struct sf_truth **place)
{
    struct sf_truth *truth = place ? *place : NULL;

    if (!truth)
        return;
    sf_truth_surfaces_destroy(&truth->surfaces);
    free(truth);
    *place = NULL;
}

double sf_truth_surface(const struct sf_truth *truth, const double origin[3], const double direction[3], double from)
{
    return sf_truth_first_surface(truth->surfaces, origin, direction, from);
}

double sf_truth_phase(double cosine, double g)
{
    double d = 1 + g * g - 2 * g * cosine;

    return (1 - g * g) / (4 * PI * d * sqrt(d));
}

/* The unit vector to the light and the way there (INFINITY: directional); gives the share of `power` that is the
 * irradiance with nothing in the way. */
static double light_at(const struct sf_truth_light *light, const double x[3], double to_light[3], double *way)
{
    double squared, share;

    *way = INFINITY;
    for (int i = 0; i < 3; i++)
        to_light[i] = light->kind == SF_LIGHT_DIRECTIONAL ? -light->direction[i] : light->position[i] - x[i];
    if (light->kind == SF_LIGHT_DIRECTIONAL)
        return 1;
    *way = vec_normalize(to_light);
    squared = fmax(*way * *way, 1e-12);
    if (light->kind != SF_LIGHT_SPOT)
        return 1 / squared;
    share = (-vec_dot(to_light, light->direction) - light->cosine_outer) /
            fmax(light->cosine_inner - light->cosine_outer, 1e-6);
    share = fmin(fmax(share, 0), 1);
    return share * share * (3 - 2 * share) / squared;
}

static bool shadowed(const struct sf_truth *truth, const struct sf_truth_light *light, const double x[3],
                     const double to_light[3], double way)
{
    return truth->casts && light->shadows && sf_truth_hidden(truth->surfaces, x, to_light, way);
}

void sf_truth_lit(const struct sf_truth *truth, const double x[3], const double w[3], double rgb[3])
{
    memset(rgb, 0, 3 * sizeof *rgb);
    for (uint32_t n = 0; n < truth->light_count; n++) {
        const struct sf_truth_light *light = &truth->lights[n];
        double to_light[3], end[3], way, share = light_at(light, x, to_light, &way);

        if (share == 0 || shadowed(truth, light, x, to_light, way))
            continue;
        vec_along(x, to_light, fmin(way, truth->reach), end);
        share *= sf_truth_phase(vec_dot(w, to_light), truth->medium.g) *
                 exp(-truth->medium.optical_depth(truth->medium.self, x, end));
        for (int c = 0; c < 3; c++)
            rgb[c] += share * light->power[c];
    }
}

void sf_truth_ambient(const struct sf_truth *truth, const double at[3], double rgb[3])
{
    double d[3] = {at[0] - truth->middle[0], at[1] - truth->middle[1], at[2] - truth->middle[2]};
    double length = fmax(sqrt(vec_dot(d, d)), 1e-6); /* in the very middle: no direction, as in the shaders */
    double x = d[0] / length, y = d[1] / length, z = d[2] / length;
    const double basis[9] = {1, y, z, x, x * y, y * z, 3 * z * z - 1, x * z, x * x - y * y};

    for (int c = 0; c < 3; c++) {
        rgb[c] = 0;
        for (int i = 0; i < 9; i++)
            rgb[c] += basis[i] * truth->sh[i][c];
        rgb[c] = rgb[c] < 0 ? 0 : rgb[c];
    }
}

static bool add_inside(struct sf_truth_distances *list, double t, double from, double to)
{
    return !(t > from && t < to) || sf_truth_distances_add(list, t);
}

/* Where the line crosses the cone (and its mirror image, which does no harm) of that cosine about the light's axis:
 * (v . axis)^2 = cosine^2 v . v with v = m + t w. */
static bool cone_breaks(const struct sf_truth_light *light, double cosine, const double m[3], const double w[3],
                        const double span[2], struct sf_truth_distances *list)
{
    double squared = cosine * cosine, md = vec_dot(m, light->direction), wd = vec_dot(w, light->direction);
    double a = wd * wd - squared, b = md * wd - squared * vec_dot(m, w), c = md * md - squared * vec_dot(m, m);
    double room = b * b - a * c, q;

    if (!(room >= 0))
        return true;
    q = -(b + (b < 0 ? -sqrt(room) : sqrt(room)));
    return (a == 0 || add_inside(list, q / a, span[0], span[1])) &&
           (q == 0 || add_inside(list, c / q, span[0], span[1]));
}

/* Looks at 256 places whether objects hide the light, and finds where that changes by bisection. */
static bool shadow_breaks(const struct sf_truth *truth, const struct sf_truth_light *light, const double origin[3],
                          const double w[3], const double span[2], struct sf_truth_distances *list)
{
    enum { PLACES = 256 };
    double x[3], to_light[3], way, before = span[0];
    bool dark = false;

    for (int i = 0; i <= PLACES; i++) {
        double t = span[0] + (span[1] - span[0]) * i / PLACES;

        vec_along(origin, w, t, x);
        light_at(light, x, to_light, &way);
        bool now = shadowed(truth, light, x, to_light, way);
        if (i > 0 && now != dark) {
            double low = before, high = t;

            for (int k = 0; k < 48; k++) {
                double half = 0.5 * (low + high);

                vec_along(origin, w, half, x);
                light_at(light, x, to_light, &way);
                if (shadowed(truth, light, x, to_light, way) == dark)
                    low = half;
                else
                    high = half;
            }
            if (!add_inside(list, 0.5 * (low + high), span[0], span[1]))
                return false;
        }
        dark = now;
        before = t;
    }
    return true;
}

bool sf_truth_light_breaks(const struct sf_truth *truth, const double origin[3], const double w[3], double from,
                           double to, struct sf_truth_distances *list)
{
    const double span[2] = {from, to};

    for (uint32_t n = 0; n < truth->light_count; n++) {
        const struct sf_truth_light *light = &truth->lights[n];
        double m[3] = {origin[0] - light->position[0], origin[1] - light->position[1], origin[2] - light->position[2]};

        if (light->kind != SF_LIGHT_DIRECTIONAL && !add_inside(list, -vec_dot(m, w), from, to))
            return false;
        if (light->kind == SF_LIGHT_SPOT && (!cone_breaks(light, light->cosine_inner, m, w, span, list) ||
                                             !cone_breaks(light, light->cosine_outer, m, w, span, list)))
            return false;
        if (truth->casts && light->shadows && !shadow_breaks(truth, light, origin, w, span, list))
            return false;
    }
    return true;
}
