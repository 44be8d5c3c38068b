/* For tests of the reference: media and particles to look through. */
#ifndef SF_TESTS_TRUTH_KIT_H
#define SF_TESTS_TRUTH_KIT_H

#include "scene_kit.h"
#include <math.h>
#include "base/hash.h"
#include "truth/truth.h"

static const double PI = 3.14159265358979323846;

#define assert_near(a, b, tolerance) assert_near_at(a, b, tolerance, #a, __LINE__)
static inline void assert_near_at(double a, double b, double tolerance, const char *what, int line)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("line %d: %s is %.17g, not %.17g: off by %g", line, what, a, b, a - b);
}

/* 0..1, the same every time. */
static inline double random_of(uint32_t seed, uint32_t id, uint32_t purpose)
{
    return sf_random_float(seed, id, purpose);
}

/* Uniform smoke between z = 0 and z = depth, endless to the sides. */
struct slab {
    double depth, extinction, albedo[3], emission[3];
};

static inline double slab_depth(const void *self, const double a[3], const double b[3])
{
    const struct slab *slab = self;
    double length = sqrt(pow(b[0] - a[0], 2) + pow(b[1] - a[1], 2) + pow(b[2] - a[2], 2));
    double low = fmin(a[2], b[2]), high = fmax(a[2], b[2]);

    if (low == high)
        return low >= 0 && low <= slab->depth ? slab->extinction * length : 0;
    return slab->extinction * length * fmax(0, fmin(high, slab->depth) - fmax(low, 0)) / (high - low);
}

static inline void slab_at(const void *self, const double x[3], struct sf_truth_point *point)
{
    const struct slab *slab = self;

    point->extinction = x[2] >= 0 && x[2] <= slab->depth ? slab->extinction : 0;
    for (int c = 0; c < 3; c++) {
        point->scattering[c] = point->extinction * slab->albedo[c];
        point->emission[c] = point->extinction * slab->emission[c];
    }
}

static inline bool slab_breakpoints(const void *self, const double origin[3], const double direction[3], double from,
                                    double to, struct sf_truth_distances *list)
{
    const struct slab *slab = self;

    for (int i = 0; i < 2; i++) {
        double t = (i * slab->depth - origin[2]) / direction[2];

        if (t > from && t < to && !sf_truth_distances_add(list, t))
            return false;
    }
    return true;
}

static inline double slab_bound(const void *self, const double min[3], const double max[3])
{
    const struct slab *slab = self;

    return max[2] >= 0 && min[2] <= slab->depth ? slab->extinction : 0;
}

static inline struct sf_truth_medium slab_medium(const struct slab *slab, double g)
{
    return (struct sf_truth_medium){.self = slab,
                                    .g = g,
                                    .min = {-1e3, -1e3, 0},
                                    .max = {1e3, 1e3, slab->depth},
                                    .optical_depth = slab_depth,
                                    .at = slab_at,
                                    .breakpoints = slab_breakpoints,
                                    .bound = slab_bound};
}

static inline struct sf_truth *truth_of(const struct sf_scene *scene, const struct sf_truth_medium *medium,
                                        double tolerance)
{
    struct sf_truth_options options = sf_truth_options_usual();
    struct sf_truth *truth = NULL;

    options.tolerance = tolerance;
    options.floor = 0;
    assert_int_equal(sf_truth_create(scene, medium, &options, NULL, &truth), SF_OK);
    return truth;
}

/* Particles of a scene in their medium. */
struct cloud {
    struct sf_particle *list;
    uint32_t count;
    struct sf_truth_particles *particles;
    struct sf_truth_medium medium;
};

static inline void cloud_make(struct cloud *cloud, const struct sf_scene *scene, const struct sf_particle *list,
                              uint32_t count)
{
    cloud->list = malloc((count + 1) * sizeof *list);
    assert_non_null(cloud->list);
    if (count > 0)
        memcpy(cloud->list, list, count * sizeof *list);
    cloud->count = count;
    assert_int_equal(sf_truth_particles_create(list, count, scene, NULL, &cloud->particles), SF_OK);
    sf_truth_particles_medium(cloud->particles, &cloud->medium);
}

static inline void cloud_free(struct cloud *cloud)
{
    sf_truth_particles_destroy(&cloud->particles);
    free(cloud->list);
}

static inline struct sf_particle ball_at(double x, double y, double z, double radius, double extinction)
{
    return (struct sf_particle){
        .x = (float)x, .y = (float)y, .z = (float)z, .radius = (float)radius, .extinction = (float)extinction};
}

/* Spheres of many sizes in a box about the origin, each about half as wide as `size` says. */
static inline void cloud_random(struct cloud *cloud, const struct sf_scene *scene, uint32_t count, uint32_t seed,
                                double size, double extinction)
{
    struct sf_particle *list = malloc(count * sizeof *list);

    assert_non_null(list);
    for (uint32_t i = 0; i < count; i++) {
        list[i] = ball_at(2 * random_of(seed, i, 0) - 1, 2 * random_of(seed, i, 1) - 1, 2 * random_of(seed, i, 2) - 1,
                          size * (0.2 + random_of(seed, i, 3)), extinction * random_of(seed, i, 4));
        list[i].age = (float)random_of(seed, i, 5);
        list[i].lifetime = i % 5 ? 1 : 0;
    }
    cloud_make(cloud, scene, list, count);
    free(list);
}

static inline void random_direction(uint32_t seed, uint32_t id, uint32_t purpose, double d[3])
{
    double z = 2 * random_of(seed, id, purpose) - 1, a = 2 * PI * random_of(seed, id, purpose + 1);

    d[0] = sqrt(1 - z * z) * cos(a);
    d[1] = sqrt(1 - z * z) * sin(a);
    d[2] = z;
}

static inline struct sf_truth_result trace(const struct sf_truth *truth, const double origin[3],
                                           const double direction[3], double from, double to)
{
    struct sf_truth_result result;

    assert_int_equal(sf_truth_ray(truth, origin, direction, from, to, &result), SF_OK);
    return result;
}

#endif
