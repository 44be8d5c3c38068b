#version 460
#extension GL_GOOGLE_include_directive : require
// Hard particles (METHODS B1): C = a Cp + (1 - a) Cs where the billboard's plane lies before the scene, nothing behind it.
#include "billboard/particle.glsl"

void main()
{
    float opacity = 1.0 - exp(-depth_across());
    result = radiance_at(sphere.z < depth_of_scene() ? opacity * settings.y : 0.0);
}
