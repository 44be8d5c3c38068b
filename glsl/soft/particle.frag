#version 460
#extension GL_GOOGLE_include_directive : require
// Soft particles (METHODS B2; Larsson 2.7): opacity fades in proportion to the distance from the billboard's plane to the scene behind it.
#include "billboard/particle.glsl"
#include "soft/fade.glsl"

void main()
{
    float opacity = 1.0 - exp(-depth_across());
    result = radiance_at(opacity * distance_share() * settings.y);
}
