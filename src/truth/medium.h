/* What the reference integrates: any medium that can say how thick it is along a segment and what it is at a point.
 * Particles are the first; grids and noise give the same six functions. Everything is in metres and in the world's
 * axes; all functions may be called from many threads at once. */
#ifndef SF_TRUTH_MEDIUM_H
#define SF_TRUTH_MEDIUM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "scene/scene.h"
#include "shared/particle.h"

struct sf_truth_point {
    double extinction;    /* 1/m */
    double scattering[3]; /* 1/m: extinction times albedo */
    double emission[3];   /* W/(m3 sr): extinction times emission */
};

/* A list of distances along a ray, in no order. Zeroed it is empty; the owner frees `values`. */
struct sf_truth_distances {
    double *values;
    size_t count, capacity;
};
/* False when memory is out. */
bool sf_truth_distances_add(struct sf_truth_distances *list, double value);

struct sf_truth_medium {
    const void *self;
    double g;              /* Henyey and Greenstein's */
    double min[3], max[3]; /* there is nothing outside; min > max when there is nothing at all */
    /* Integral of the extinction along the segment from a to b: exact, or to well below the integrator's tolerance. */
    double (*optical_depth)(const void *self, const double a[3], const double b[3]);
    void (*at)(const void *self, const double x[3], struct sf_truth_point *point);
    /* Adds the distances in from..to at which extinction, albedo or emission along origin + t direction (any length) is
     * not smooth. Not needed for a right answer, but for a quick one. False when memory is out. */
    bool (*breakpoints)(const void *self, const double origin[3], const double direction[3], double from, double to,
                        struct sf_truth_distances *list);
    /* Not less than the extinction anywhere in the box. */
    double (*bound)(const void *self, const double min[3], const double max[3]);
};

/* The particles of a scene at one moment, as the simulation leaves them, with the scene's medium and ramp: docs/scene.md,
 * "The medium". The ramp is evaluated exactly (the shaders look it up in a table). Optical depth is the sum of chords
 * times extinction. A bounding volume hierarchy finds the spheres, so that a segment through a cloud of n costs what the
 * spheres that it meets cost, and little more. */
struct sf_truth_particles;
/* Copies what it needs. SF_ERROR_SCENE names the first particle with a value that is not finite, or a radius or an extinction
 * below 0. */
enum sf_status sf_truth_particles_create(const struct sf_particle *particles, uint32_t count,
                                         const struct sf_scene *scene, const struct sf_log *log,
                                         struct sf_truth_particles **out);
void sf_truth_particles_destroy(struct sf_truth_particles **particles);
/* Good while the particles live. Its box is around all spheres, those without extinction included: their middle is where
 * ambient light is looked up from. */
void sf_truth_particles_medium(const struct sf_truth_particles *particles, struct sf_truth_medium *medium);

/* The colour of the scene's ramp at a share of life: linear between keys, constant outside, white without keys. */
void sf_truth_ramp(const struct sf_scene *scene, double life, double rgb[3]);

#endif
