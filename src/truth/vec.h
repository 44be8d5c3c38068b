/* Vectors of three doubles. */
#ifndef SF_TRUTH_VEC_H
#define SF_TRUTH_VEC_H

#include <math.h>

static inline double vec_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void vec_cross(const double a[3], const double b[3], double out[3])
{
    double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];

    out[0] = x;
    out[1] = y;
    out[2] = z;
}

/* The point at t of a ray. */
static inline void vec_along(const double origin[3], const double direction[3], double t, double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = origin[i] + t * direction[i];
}

/* Makes it a unit vector and gives its length; 0 leaves it alone. */
static inline double vec_normalize(double v[3])
{
    double length = sqrt(vec_dot(v, v));

    for (int i = 0; i < 3 && length > 0; i++)
        v[i] /= length;
    return length;
}

#endif
