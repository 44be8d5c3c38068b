/* Fractal noise in a volume: octaves of gradient or cellular noise, each turned and shifted by chance, still or going
 * through a cycle in time, endless or repeating in x and y. Made for many points at once. */
#ifndef SF_TEXTURE_FIELD_H
#define SF_TEXTURE_FIELD_H

#include <stdint.h>

enum {
    SF_FIELD_LANES = 16, /* points evaluated at a time */
    SF_FIELD_OCTAVES_MAX = 10,
};

enum sf_field_kind {
    SF_FIELD_SUM,      /* sum of noise / f (fractal Brownian motion) */
    SF_FIELD_ABSOLUTE, /* sum of |noise| / f (turbulence): bulges with creases between */
    SF_FIELD_CELLS,    /* sum of -F1 / f, F1 the distance to the nearest of scattered points: bubbles */
};

struct sf_field_settings {
    enum sf_field_kind kind;
    uint32_t octaves; /* 1..SF_FIELD_OCTAVES_MAX */
    float lacunarity; /* frequency of an octave to that of the one before, above 1 */
    float roughness;  /* amplitude likewise, 0..1 */
    float frequency;  /* of the first octave: cells of the lattice in a unit of length */
    float period_x;   /* units of length after which it repeats in x; 0: never, and then neither in y */
    float period_y;   /* in y */
    uint32_t changes; /* how often the first octave becomes another one in a cycle of time; 0: it stands still */
    uint32_t seed;
};

struct sf_octave {
    float turn[4][3]; /* from a point to lattice coordinates; the last is time's */
    float shift[4];
    float period[4]; /* lattice cells, whole; 0: none */
    float frequency; /* cells in a unit of length */
    float amplitude;
    float cosine, sine; /* of the angle of cellular noise's points */
    uint32_t seed;
};

struct sf_field {
    enum sf_field_kind kind;
    uint32_t count;
    float scale; /* brings the sum's variance to 1 */
    struct sf_octave octaves[SF_FIELD_OCTAVES_MAX];
};

/* The field at a moment of its cycle, 0..1; 1 is 0. */
void sf_field_init(const struct sf_field_settings *settings, float moment, struct sf_field *field);

/* The field, of mean 0 and variance 1, at SF_FIELD_LANES points. Octaves whose cells are smaller than 1/`finest` units
 * are left out, and those near it are weakened: what pixels cannot show would only be noise in them. The same points
 * give the same bits on every processor. */
void sf_field_sample(const struct sf_field *field, float finest, const float *x, const float *y, const float *z,
                     float *value);
/* The same without wide registers: for other processors, and for the test that compares the two. */
void sf_field_sample_portable(const struct sf_field *field, float finest, const float *x, const float *y,
                              const float *z, float *value);

/* A rotation, every one as likely as any other. */
void sf_field_random_turn(uint32_t seed, uint32_t id, float turn[3][3]);

#endif
