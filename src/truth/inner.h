/* What the files of this room share. */
#ifndef SF_TRUTH_INNER_H
#define SF_TRUTH_INNER_H

#include <stdatomic.h>
#include "truth/surfaces.h"
#include "truth/truth.h"

struct sf_truth_light {
    int32_t kind;
    double position[3], direction[3];
    double power[3]; /* irradiance, or radiant intensity */
    double cosine_inner, cosine_outer;
    bool shadows;
};

struct sf_truth {
    const struct sf_scene *scene;
    struct sf_truth_medium medium;
    struct sf_truth_options options;
    struct sf_truth_surfaces *surfaces;
    struct sf_truth_light lights[SF_LIGHTS_MAX];
    uint32_t light_count;
    double middle[3]; /* of the medium's box */
    double reach;     /* m: from any point of the box out of it */
    double sh[9][3];  /* the environment's, times `ambient` */
    bool has_ambient, casts;
};

/* Radiance that a point of unit scattering (1/m) sends against the unit vector `w` for each metre: from the lights, all
 * that is in the way counted. */
void sf_truth_lit(const struct sf_truth *truth, const double x[3], const double w[3], double rgb[3]);
/* L_ambient at a point. */
void sf_truth_ambient(const struct sf_truth *truth, const double x[3], double rgb[3]);
/* Distances in from..to along the unit vector `w` at which light or shadow changes abruptly. An object's shadow that covers
 * less than 1/256 of the way may be overlooked. False when memory is out. */
bool sf_truth_light_breaks(const struct sf_truth *truth, const double origin[3], const double w[3], double from,
                           double to, struct sf_truth_distances *list);
/* Henyey and Greenstein, normalised over the sphere. */
double sf_truth_phase(double cosine, double g);

struct sf_truth_panel {
    double from, to;
    double depth; /* optical, from the ray's beginning to `from` */
    double value[3], error[3], worst;
};
/* What a ray needs, kept from ray to ray; zeroed at first. */
struct sf_truth_space {
    struct sf_truth_distances breaks;
    struct sf_truth_panel *panels; /* a heap: the worst on top */
    size_t count, capacity;
};
void sf_truth_space_finish(struct sf_truth_space *space);
/* sf_truth_ray in a space of the caller's. */
enum sf_status sf_truth_ray_in(const struct sf_truth *truth, struct sf_truth_space *space, const double origin[3],
                               const double direction[3], double from, double to, struct sf_truth_result *result);

/* Calls fn(user, y, stopped) for every row, from `work->threads` threads; it should return soon once *stopped. The first failure,
 * or SF_ERROR_INTERRUPTED when `progress` said so. */
typedef enum sf_status (*sf_truth_row_fn)(void *user, uint32_t y, const atomic_bool *stopped);
enum sf_status sf_truth_rows(uint32_t height, const struct sf_truth_work *work, sf_truth_row_fn fn, void *user);

/* Cuts from..to down to the medium's box. False when nothing is left. */
bool sf_truth_clip(const struct sf_truth *truth, const double origin[3], const double direction[3], double span[2]);

#endif
