/* Light that is scattered any number of times, by chance: paths from the eye through the medium, free ways drawn by
 * delta tracking (Woodcock 1965) against bounds of the extinction in the cells of a grid. The mean of ever more paths comes ever
 * nearer to the truth, and the standard error says how near.
 *
 * A path begins as a ray of sf_truth_ray does. Where it meets smoke it gathers emission and the light of every lamp, dimmed
 * exactly (as in truth.h), and goes on in a direction drawn from the phase function, with its weight times the albedo. A path that
 * leaves the smoke after the first meeting gathers the radiance of the environment in its direction, times `ambient`: here the
 * light from all around is dimmed by smoke and hidden by objects, and g matters, all of which L_ambient of truth.h leaves
 * out. Surfaces, planes included, send no light into the smoke: a path ends there. A faint path is ended by chance, without
 * bias (Russian roulette).
 *
 * Like sf_truth_ray this is the smoke alone; what shines through it is T times it. */
#ifndef SF_TRUTH_SCATTER_H
#define SF_TRUTH_SCATTER_H

#include "truth/truth.h"

struct sf_truth_scatter;
/* `truth` must outlive it. SF_ERROR_MEMORY; SF_ERROR_INTERNAL when a bound is not a number. */
enum sf_status sf_truth_scatter_create(const struct sf_truth *truth, const struct sf_log *log,
                                       struct sf_truth_scatter **out);
void sf_truth_scatter_destroy(struct sf_truth_scatter **scatter);

/* Mean and spread of the paths so far; zeroed at first. */
struct sf_truth_estimate {
    double mean[3];
    double spread[3]; /* sum of squared differences to the mean */
    uint64_t paths;
    uint64_t meetings; /* with smoke, of all paths */
};
/* Standard error of the mean of a channel; INFINITY with fewer than two paths. */
double sf_truth_estimate_error(const struct sf_truth_estimate *estimate, int channel);

struct sf_truth_paths {
    uint32_t pixel; /* all chance is a hash of this, the path's number, and where in the path it is wanted: */
    uint32_t first; /* the paths `first` to `first + count - 1` are always the same ones */
    uint32_t count;
    uint32_t orders; /* scatterings at most: 1 is single scattering; 0: as many as there are */
};
/* Adds paths to the estimate; arguments as for sf_truth_ray. From any thread. SF_ERROR_INTERNAL when the medium is
 * denser than its own bound, or a path met smoke a million times. */
enum sf_status sf_truth_scatter_ray(const struct sf_truth_scatter *scatter, const double origin[3],
                                    const double direction[3], double from, double to,
                                    const struct sf_truth_paths *paths, struct sf_truth_estimate *estimate);

/* Adds `count` paths from number `first` on to every pixel's estimate (`estimates`: width x height, rows from the top), from the
 * near plane to the first surface. The same bits with any number of threads. Fails as sf_truth_render does; estimates are of no use
 * after that. */
enum sf_status sf_truth_scatter_render(const struct sf_truth_scatter *scatter, const struct sf_camera_pose *pose,
                                       uint32_t width, uint32_t height, uint32_t first, uint32_t count, uint32_t orders,
                                       const struct sf_truth_work *work, struct sf_truth_estimate *estimates);

#endif
