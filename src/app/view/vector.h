/* Vectors of three doubles, for the viewer's eye and lights. */
#ifndef SF_APP_VIEW_VECTOR_H
#define SF_APP_VIEW_VECTOR_H

#include <math.h>
#include <stdbool.h>

static inline double sf_v3_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline double sf_v3_length(const double v[3])
{
    return sqrt(sf_v3_dot(v, v));
}

static inline void sf_v3_subtract(const double a[3], const double b[3], double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = a[i] - b[i];
}

/* to = a + b * scale */
static inline void sf_v3_add(const double a[3], const double b[3], double scale, double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = a[i] + b[i] * scale;
}

/* `to` may be a or b. */
static inline void sf_v3_cross(const double a[3], const double b[3], double to[3])
{
    double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];

    to[0] = x;
    to[1] = y;
    to[2] = z;
}

/* False, with v unchanged, when it is too short to have a direction. */
static inline bool sf_v3_normalize(double v[3])
{
    double length = sf_v3_length(v);

    if (!(length > 1e-12))
        return false;
    for (int i = 0; i < 3; i++)
        v[i] /= length;
    return true;
}

#endif
