/* The few vector operations that scenes need. */
#ifndef SF_SCENE_VECTOR_H
#define SF_SCENE_VECTOR_H

#include <math.h>
#include <stdbool.h>

static inline double sf_dot(const float a[3], const float b[3])
{
    return (double)a[0] * b[0] + (double)a[1] * b[1] + (double)a[2] * b[2];
}

static inline double sf_length(const float v[3])
{
    return sqrt(sf_dot(v, v));
}

static inline void sf_subtract(const float a[3], const float b[3], float out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[i] - b[i];
}

/* False, with v unchanged, when it is too short to have a direction. */
static inline bool sf_normalize(float v[3])
{
    double length = sf_length(v);

    if (!(length > 1e-12))
        return false;
    for (int i = 0; i < 3; i++)
        v[i] = (float)(v[i] / length);
    return true;
}

static inline void sf_cross(const float a[3], const float b[3], float out[3])
{
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;

        out[i] = (float)((double)a[j] * b[k] - (double)a[k] * b[j]);
    }
}

#endif
