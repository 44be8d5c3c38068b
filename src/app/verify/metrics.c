#include "metrics.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "../console.h"

const struct sf_goals sf_goals = {.transmittance_mean = 0.002, .transmittance_max = 0.02, .relative_mse = 0.01};

uint32_t sf_errors_pixel(uint32_t block, uint32_t stride, uint32_t side)
{
    uint64_t pixel = (uint64_t)block * stride + stride / 2;

    return pixel < side ? (uint32_t)pixel : side - 1;
}

/* Sums over pixels. */
struct sums {
    double difference, squares; /* of L - R */
    double light, power;        /* of R, R^2 */
    double smoky_power;
    double *lengths; /* of L - R, a smoky pixel each */
};

static bool all_finite(const float *smoke, const float *depths)
{
    bool finite = true;

    for (int i = 0; i < 4; i++)
        finite = finite && isfinite(smoke[i]) && isfinite(depths[i]);
    return finite;
}

static void add_transmittance(const float *smoke, const float *depths, double truth, uint32_t x, uint32_t y,
                              struct sf_errors *errors)
{
    double off = fabs((double)depths[3] - truth), alpha_off = fabs(1 - (double)smoke[3] - truth);

    errors->transmittance_mean += off;
    errors->alpha_mean += alpha_off;
    errors->alpha_max = fmax(errors->alpha_max, alpha_off);
    if (off > errors->transmittance_max || errors->pixels == 0) {
        errors->transmittance_max = off;
        errors->worst[0] = x;
        errors->worst[1] = y;
    }
}

static void add_radiance(const float *smoke, const struct sf_reference_pixel *truth, struct sums *sums,
                         struct sf_errors *errors)
{
    double squares = 0, power = 0;
    bool smoky = truth->transmittance < 1 || smoke[3] > 0;

    for (int c = 0; c < 3; c++) {
        double r = truth->radiance[c], off = (double)smoke[c] - r;

        squares += off * off;
        power += r * r;
        sums->difference += off;
        sums->light += r;
        smoky = smoky || smoke[c] != 0;
    }
    sums->squares += squares;
    sums->power += power;
    if (!smoky)
        return;
    sums->smoky_power += power;
    sums->lengths[errors->smoky++] = sqrt(squares);
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

static double ratio(double part, double whole)
{
    return part == 0 ? 0 : whole > 0 ? part / whole : part > 0 ? INFINITY : -INFINITY;
}

static void conclude(struct sums *sums, struct sf_errors *errors)
{
    size_t smoky = errors->smoky;

    if (errors->pixels > 0) {
        errors->transmittance_mean /= (double)errors->pixels;
        errors->alpha_mean /= (double)errors->pixels;
    }
    errors->relative_mse = ratio(sums->squares, sums->power);
    errors->bias = ratio(sums->difference, sums->light);
    if (smoky == 0)
        return;
    errors->rms = sqrt(sums->smoky_power / (double)smoky);
    qsort(sums->lengths, smoky, sizeof *sums->lengths, compare_doubles);
    errors->p99 = ratio(sums->lengths[(smoky * 99 + 99) / 100 - 1], errors->rms);
}

enum sf_status sf_errors_measure(const struct sf_layers *layers, const struct sf_reference_picture *reference,
                                 uint32_t stride, struct sf_errors *errors)
{
    struct sums sums = {.lengths = malloc(((size_t)reference->width * reference->height + 1) * sizeof(double))};

    *errors = (struct sf_errors){0};
    if (!sums.lengths)
        return sf_console_fail(SF_ERROR_MEMORY, "out of memory");
    for (uint32_t row = 0; row < reference->height; row++) {
        for (uint32_t column = 0; column < reference->width; column++) {
            const struct sf_reference_pixel *truth = &reference->pixels[(size_t)row * reference->width + column];
            uint32_t x = sf_errors_pixel(column, stride, layers->width);
            uint32_t y = sf_errors_pixel(row, stride, layers->height);
            size_t at = 4 * ((size_t)y * layers->width + x);

            if (!all_finite(&layers->smoke[at], &layers->depths[at])) {
                errors->not_finite++;
                continue;
            }
            add_transmittance(&layers->smoke[at], &layers->depths[at], truth->transmittance, x, y, errors);
            add_radiance(&layers->smoke[at], truth, &sums, errors);
            errors->pixels++;
        }
    }
    conclude(&sums, errors);
    free(sums.lengths);
    return SF_OK;
}

double sf_errors_brightness(const float *smoke, const struct sf_reference_pixel *truth)
{
    static const double weights[3] = {0.2126, 0.7152, 0.0722};
    double sum = 0;

    for (int c = 0; c < 3; c++)
        sum += weights[c] * ((double)smoke[c] - truth->radiance[c]);
    return isfinite(sum) ? sum : NAN;
}

static double round_up(double value)
{
    double power = pow(10, floor(log10(value))), share = value / power;

    return power * (share <= 1 ? 1 : share <= 2 ? 2 : share <= 5 ? 5 : 10);
}

enum sf_status sf_errors_scale(const struct sf_layers *layers, const struct sf_reference_picture *reference,
                               uint32_t stride, double least, double *scale)
{
    size_t count = (size_t)reference->width * reference->height, smoky = 0;
    double *values = malloc((count + 1) * sizeof *values);

    *scale = least;
    if (!values)
        return sf_console_fail(SF_ERROR_MEMORY, "out of memory");
    for (size_t i = 0; i < count; i++) {
        uint32_t x = sf_errors_pixel((uint32_t)(i % reference->width), stride, layers->width);
        uint32_t y = sf_errors_pixel((uint32_t)(i / reference->width), stride, layers->height);
        const float *smoke = &layers->smoke[4 * ((size_t)y * layers->width + x)];
        double off = fabs(sf_errors_brightness(smoke, &reference->pixels[i]));

        if (isfinite(off) && (reference->pixels[i].transmittance < 1 || smoke[3] > 0))
            values[smoky++] = off;
    }
    if (smoky > 0) {
        qsort(values, smoky, sizeof *values, compare_doubles);
        double most = values[(smoky * 995 + 999) / 1000 - 1];
        if (most > least)
            *scale = round_up(most);
    }
    free(values);
    return SF_OK;
}

unsigned sf_goals_missed(const struct sf_errors *errors)
{
    bool mean = fmax(errors->transmittance_mean, errors->alpha_mean) <= sf_goals.transmittance_mean;
    bool most = fmax(errors->transmittance_max, errors->alpha_max) <= sf_goals.transmittance_max;
    bool mse = errors->relative_mse <= sf_goals.relative_mse;
    bool whole = errors->not_finite == 0 && errors->pixels > 0;

    return (mean && whole ? 0u : SF_GOAL_MEAN) | (most && whole ? 0u : SF_GOAL_MAX) | (mse && whole ? 0u : SF_GOAL_MSE);
}
