// Octaves of multiple scattering. Include it where OCTAVES is a constant and `frame` is declared.
#ifndef SF_THICK_OCTAVES_GLSL
#define SF_THICK_OCTAVES_GLSL
#include "lib/phase.glsl"

// After Wrenninge 2013: each octave reaches twice as deep, is 0.8 times as strong and half as directed as the one before.
// The first is single scattering. Values of the phase function, times the octave's strength.
vec4 octave_phases(float cosine)
{
    float g = frame.albedo.w;
    vec4 phases = vec4(phase_henyey_greenstein(cosine, g), 0.0, 0.0, 0.0);
    if (OCTAVES > 1u)
        phases.y = 0.8 * phase_henyey_greenstein(cosine, 0.5 * g);
    if (OCTAVES > 2u)
        phases.z = 0.64 * phase_henyey_greenstein(cosine, 0.25 * g);
    if (OCTAVES > 3u)
        phases.w = 0.512 * phase_henyey_greenstein(cosine, 0.125 * g);
    return phases;
}

// Of octaves without a phase function.
vec4 octave_strengths()
{
    return vec4(1.0, OCTAVES > 1u ? 0.8 : 0.0, OCTAVES > 2u ? 0.64 : 0.0, OCTAVES > 3u ? 0.512 : 0.0);
}

// exp(-depth), exp(-depth / 2), exp(-depth / 4), exp(-depth / 8), as far as there are octaves.
vec4 octave_transmittances(float depth)
{
    const uint last = OCTAVES - 1u;
    float deepest = exp(-depth / float(1u << last));
    vec4 t = vec4(deepest);
    if (OCTAVES > 3u)
        t.z = t.w * t.w;
    if (OCTAVES > 2u)
        t.y = t.z * t.z;
    if (OCTAVES > 1u)
        t.x = t.y * t.y;
    return t;
}

#endif
