// Phase functions, normalised over the sphere.
#ifndef SF_LIB_PHASE_GLSL
#define SF_LIB_PHASE_GLSL

// Henyey and Greenstein 1941; `cosine` between the directions of travel before and after, g > 0 forward. L's equation 1 has 1/2 in place of 1/(4 pi): it is
// normalised over the cosine.
float phase_henyey_greenstein(float cosine, float g)
{
    float d = max(1.0 + g * g - 2.0 * g * cosine, 1e-6);
    return 0.0795774715 * (1.0 - g * g) * inversesqrt(d * d * d);
}

#endif
