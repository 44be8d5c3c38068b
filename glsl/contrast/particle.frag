#version 460
#extension GL_GOOGLE_include_directive : require
// Soft particles with contrast (METHODS B3; Larsson 2.7): the share x of the distance fades by 1/2 (2x)^p up to 1/2, and by the mirror image of that above.
#include "billboard/particle.glsl"
#include "soft/fade.glsl"

void main()
{
    float x = distance_share();
    float low = 0.5 * pow(2.0 * min(x, 1.0 - x), own.y);
    float opacity = 1.0 - exp(-depth_across());
    result = radiance_at(opacity * (x > 0.5 ? 1.0 - low : low) * settings.y);
}
