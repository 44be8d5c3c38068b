#version 460
#extension GL_GOOGLE_include_directive : require
// The average density method (METHODS B5; Krazanowski): a particle stands for a slab of depth D, evenly filled, and covers as much of what it would cover
// whole as its share before the scene: a = V saturate((z_env - z_particle) / D), z_particle being the slab's front. The near plane takes from it as the scene does.
// V is what the medium's sphere covers, so the share that is seen of a thin particle is right in the mean.
#include "billboard/particle.glsl"

void main()
{
    float depth = own.x * sphere.w;
    float front = sphere.z - own.y * depth;
    float seen = clamp((depth_of_scene() - front) / depth, 0.0, 1.0);
    // Nothing is left of it when the near plane reaches the sphere's back, behind which a particle is not drawn.
    float back = min(front + depth, sphere.z + sphere.w);
    float passed = clamp((settings.x - front) / max(back - front, 1e-6), 0.0, 1.0);
    result = radiance_at(own.z * (1.0 - exp(-depth_across())) * max(seen - passed, 0.0));
}
