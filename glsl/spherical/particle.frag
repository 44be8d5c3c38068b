#version 460
#extension GL_GOOGLE_include_directive : require
// Spherical billboards (METHODS B4; Umenhoffer et al., Larsson's [2]): the way between the sphere's front and back, cut off by the near plane and by the
// scene, w = sqrt(r^2 - d^2), with a density that falls to nothing at the outline: a = 1 - exp(-tau (1 - d/r) (back - front)).
#include "billboard/particle.glsl"

// The same matter in the sphere as the medium's uniform one has: its 4/3 pi r^3 over the integral of 2 w (1 - d/r) over the disc, 1 / (1 - 3 pi / 16).
const float SAME_MATTER = 2.4333779;

void main()
{
    float d = length(ray.zw);
    float w = sphere.w * sqrt(clamp(1.0 - d * d, 0.0, 1.0));
    float front = max(settings.x, sphere.z - w), back = min(depth_of_scene(), sphere.z + w);
    float depth = SAME_MATTER * light.w * share_of_atlas() * max(1.0 - d, 0.0) * max(back - front, 0.0);
    result = radiance_at(1.0 - exp(-depth));
}
