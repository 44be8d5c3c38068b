/* The reference: the integral of docs/scene.md ("The medium"), computed on the CPU in double precision to a stated
 * tolerance, so that every rendering method has a measurable error.
 *
 * Along a ray from `from` to `to`, with w its unit vector:
 *
 *     L = integral of [ sum over lights of s p(w . l) E V + s L_ambient + e ] T(from, t) dt
 *
 * s (extinction times albedo), e (extinction times emission) and T come from a medium (medium.h), whose optical depth is
 * exact; the one thing that is approximated is this integral over t. It is split where the medium says that it is not smooth, at
 * the edges of spots and of the objects' shadows, and where lights are nearest; each piece is integrated by Gauss and
 * Kronrod's rule of 3 and 7 points, and the panel with the largest error is halved until the sum of errors is below the
 * tolerance. What is looked for at so many places may be overlooked between them: a shadow of an object that covers
 * less than 1/256 of the way through the medium, a shadow of smoke on smoke that covers less than 1/74 of it.
 *
 * - l points to the light; p is Henyey and Greenstein's, normalised over the sphere; its cosine w . l is that between the
 *   ways that light travels before and after.
 * - E is as docs/scene.md defines it; nearer than 1e-6 m to a point or spot light it no longer grows, as in the shaders.
 * - V is exp(-optical depth) through all smoke between the point and the light, times 0 where a surface that is not a
 *   plane stands between and the light has shadows.
 * - L_ambient is A(d) of the environment times `ambient`: spherical harmonics of order 2, d from the middle of the
 *   medium's box to the point. It is not attenuated by smoke or objects, and g plays no part in it. In an environment
 *   of one colour it is that colour everywhere, which is what method `thick` adds there.
 *
 * The result is the smoke alone: over a surface of radiance L_s a ray shows L + T L_s. */
#ifndef SF_TRUTH_TRUTH_H
#define SF_TRUTH_TRUTH_H

#include <stdbool.h>
#include <stdint.h>
#include "truth/medium.h"

struct sf_truth_options {
    double tolerance; /* sum of error estimates, relative to the ray's brightest channel ... */
    double floor;     /* ... or absolute, W/(m2 sr): whichever allows more */
    double ambient;   /* times the environment's, as thick.ambient */
    uint32_t limit;   /* evaluations of a ray at most; one that needs more is not `converged` */
    uint32_t panels;  /* above 0: each piece in so many equal panels, and no more; to measure convergence */
};
/* 1e-4, 1e-7, 1, 200,000 and 0. */
struct sf_truth_options sf_truth_options_usual(void);

struct sf_truth;
/* The scene, and what the medium rests on, must outlive it. SF_ERROR_USAGE when an option is out of reason. */
enum sf_status sf_truth_create(const struct sf_scene *scene, const struct sf_truth_medium *medium,
                               const struct sf_truth_options *options, const struct sf_log *log, struct sf_truth **out);
void sf_truth_destroy(struct sf_truth **truth);

struct sf_truth_result {
    double radiance[3]; /* of the smoke, as it reaches the ray's beginning: premultiplied */
    double transmittance, optical_depth;
    double near, far; /* where the ray first enters smoke and last leaves it; near > far: it meets none */
    double error;     /* estimate, of the worst channel; what lies behind an optical depth of 42 is left out (6e-19) */
    uint32_t evaluations;
    bool converged; /* error is within the tolerance */
};
/* One ray; `direction` is of any length, and from, to, near and far are in units of it. `to` may be INFINITY. Surfaces do
 * not cut the ray off (sf_truth_surface does), but they cast shadows. From any thread. SF_ERROR_MEMORY. */
enum sf_status sf_truth_ray(const struct sf_truth *truth, const double origin[3], const double direction[3],
                            double from, double to, struct sf_truth_result *result);
/* Distance of the first surface with t >= from, in units of `direction`; INFINITY: none. */
double sf_truth_surface(const struct sf_truth *truth, const double origin[3], const double direction[3], double from);

struct sf_truth_picture {
    uint32_t width, height;
    struct sf_truth_result *pixels; /* rows from the top; near and far are depths along the view's axis, m */
    double *depth;                  /* m along the view's axis, of the first surface; INFINITY: none */
    uint32_t unconverged;           /* pixels that are not */
};
/* Rows done, in the caller's thread; false stops the work. May be NULL. */
typedef bool (*sf_truth_progress_fn)(void *user, uint32_t done, uint32_t rows);
struct sf_truth_work {
    unsigned threads; /* 0: as many as there are processors. The picture has the same bits with any number */
    uint32_t stride; /* above 1: of each stride x stride block only its pixel (stride / 2, stride / 2), or the picture's
                         last where that is outside; sf_truth_render alone */
    sf_truth_progress_fn progress;
    void *user;
    const struct sf_log *log;
};
/* The axes of a picture's rays (docs/scene.md, "Camera"): pixel (i, j) looks along forward + x right + y up with x = 2
 * (i + 1/2)/W - 1 and y = 1 - 2 (j + 1/2)/H, so that t is the depth. */
struct sf_truth_view {
    double eye[3], forward[3], right[3], up[3], near;
    uint32_t width, height;
};
void sf_truth_view(const struct sf_camera_pose *pose, uint32_t width, uint32_t height, struct sf_truth_view *view);
void sf_truth_view_ray(const struct sf_truth_view *view, uint32_t x, uint32_t y, double direction[3]);

/* The smoke from the near plane to the first surface, for every pixel's middle (of one a block: work->stride, and then the
 * picture has a pixel a block). SF_ERROR_INTERRUPTED when `progress` said so;
 * SF_ERROR_INTERNAL when a result is not a number: the message names the pixel; SF_ERROR_MEMORY; SF_ERROR_USAGE for a picture
 * of no pixels. */
enum sf_status sf_truth_render(const struct sf_truth *truth, const struct sf_camera_pose *pose, uint32_t width,
                               uint32_t height, const struct sf_truth_work *work, struct sf_truth_picture **out);
void sf_truth_picture_destroy(struct sf_truth_picture **picture);

#endif
