/* How far a method's smoke is from the reference's: numbers only. */
#ifndef SF_APP_VERIFY_METRICS_H
#define SF_APP_VERIFY_METRICS_H

#include <stddef.h>
#include <stdint.h>
#include "sfumato/sfumato.h"

/* What a method drew, [height][width][4] each, as struct sf_frame has it. */
struct sf_layers {
    uint32_t width, height;
    const float *smoke;  /* premultiplied radiance and alpha of the smoke alone */
    const float *depths; /* near, far, optical depth, transmittance */
};

/* With L the method's radiance and R the reference's, sums over the compared pixels and the three channels, |.| the length
 * of a vector of three. Where the reference is black a ratio to it is 0 when the method is black too, else INFINITY. */
struct sf_errors {
    double transmittance_mean, transmittance_max; /* of |T - reference|, of the layer "smoke.T" */
    uint32_t worst[2];                            /* pixel of that maximum */
    double alpha_mean, alpha_max;                 /* the same of 1 - alpha, which is what the picture is laid over by */
    double relative_mse;                          /* sum (L - R)^2 / sum R^2 */
    double bias;                                  /* sum (L - R) / sum R */
    double p99;           /* of |L - R| over the pixels that smoke touches in either, relative to `rms`: nearest rank */
    double rms;           /* of |R| over the same pixels, W/(m2 sr) */
    size_t pixels, smoky; /* compared; of these touched by smoke */
    size_t not_finite;    /* of these with a NaN or an infinity in the method's layers: left out of all that is above */
};

/* `reference` is of the layers' size over `stride` (sf_reference_render). SF_ERROR_MEMORY. */
enum sf_status sf_errors_measure(const struct sf_layers *layers, const struct sf_reference_picture *reference,
                                 uint32_t stride, struct sf_errors *errors);
/* The pixel of a side of `side` that a block stands for, as sf_reference_render chooses it. */
uint32_t sf_errors_pixel(uint32_t block, uint32_t stride, uint32_t side);

/* 1, 2 or 5 times a power of ten: not below the differences in brightness of 99.5 % of the pixels that smoke touches, nor
 * below `least`. Brightness is the luminance of linear Rec. 709. SF_ERROR_MEMORY. */
enum sf_status sf_errors_scale(const struct sf_layers *layers, const struct sf_reference_picture *reference,
                               uint32_t stride, double least, double *scale);
/* Brightness of L - R, in W/(m2 sr); NaN where the method has no number. */
double sf_errors_brightness(const float *smoke, const struct sf_reference_pixel *truth);

/* What is asked of a method at its own settings. */
struct sf_goals {
    double transmittance_mean, transmittance_max, relative_mse;
};
extern const struct sf_goals sf_goals;
enum sf_goal { SF_GOAL_MEAN = 1, SF_GOAL_MAX = 2, SF_GOAL_MSE = 4 };
/* Which are missed: bits of enum sf_goal. Alpha counts as transmittance does. */
unsigned sf_goals_missed(const struct sf_errors *errors);

#endif
