/* Bounds of the spheres over a workgroup, joined to the list's by integer atomics: minima and maxima come out the same in any order. */
#ifndef SF_SIM_BOUNDS_GLSL
#define SF_SIM_BOUNDS_GLSL
#include "lib/order.glsl"

shared uint group_low[3], group_high[3];

/* A barrier must follow before join_bounds. */
void empty_bounds()
{
    if (gl_LocalInvocationIndex < 3u) {
        group_low[gl_LocalInvocationIndex] = 0xffffffffu;
        group_high[gl_LocalInvocationIndex] = 0u;
    }
}

/* Called by all lanes; those with low > high have no particle. */
#define JOIN_BOUNDS(low, high, counts)                                                                                                               \
    {                                                                                                                                                \
        if (low.x <= high.x) {                                                                                                                       \
            for (int axis = 0; axis < 3; axis++) {                                                                                                   \
                atomicMin(group_low[axis], order_from_float(low[axis]));                                                                             \
                atomicMax(group_high[axis], order_from_float(high[axis]));                                                                           \
            }                                                                                                                                        \
        }                                                                                                                                            \
        barrier();                                                                                                                                   \
        if (gl_LocalInvocationIndex == 0u && group_low[0] <= group_high[0]) {                                                                        \
            for (int axis = 0; axis < 3; axis++) {                                                                                                   \
                atomicMin(counts.bounds_min[axis], group_low[axis]);                                                                                 \
                atomicMax(counts.bounds_max[axis], group_high[axis]);                                                                                \
            }                                                                                                                                        \
        }                                                                                                                                            \
    }

#endif
