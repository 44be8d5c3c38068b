// A method's samples along the ray of the probed pixel (struct sf_probe_point of sfumato.h), for a shader that has PROBE_BINDING as their binding.
#ifndef SF_LIB_PROBE_GLSL
#define SF_LIB_PROBE_GLSL
#include "shared/probe.h"

layout(set = 0, binding = PROBE_BINDING, std430) writeonly buffer Probe {
    uint probe_count;
    float probe_values[]; // SF_PROBE_POINT_WORDS a point
};

// Point i: view depth, m, the transmittance to it, and what is sent from before it, as it reaches the eye.
void probe_store(uint i, float depth, float transmittance, vec3 radiance)
{
    uint first = i * SF_PROBE_POINT_WORDS;
    probe_values[first] = depth;
    probe_values[first + 1u] = transmittance;
    probe_values[first + 2u] = radiance.r;
    probe_values[first + 3u] = radiance.g;
    probe_values[first + 4u] = radiance.b;
}

#endif
