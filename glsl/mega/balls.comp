#version 460
#extension GL_GOOGLE_include_directive : require
// Particles as opaque balls. One thread a particle.
#include "shared/frame.h"
#include "shared/particle.h"
#include "shared/thick.h"
#include "shared/mega.h"

layout(constant_id = 0) const uint RAMP = 0u;
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
layout(set = 0, binding = 1, std430) readonly buffer Particles { sf_particle particles[]; };
layout(set = 0, binding = 2, std430) readonly buffer Counts { sf_particle_counts counts; };
layout(set = 0, binding = 3, std430) writeonly buffer Balls { sf_mega_ball balls[]; };

// The radius of an opaque ball that takes from parallel light as much as a uniform sphere of radius 1 and optical depth `across` through its middle:
//   f^2 = integral over the disc of 1 - exp(-across w), w = sqrt(1 - d^2)  =  1 - 2 (1 - (1 + across) exp(-across)) / across^2
// It shrinks to nothing with the extinction, its area in proportion.
float share_of_radius(float across)
{
    float thick = 1.0 - 2.0 * (1.0 - (1.0 + across) * exp(-across)) / (across * across);
    float thin = across * (2.0 / 3.0 - across * (0.25 - across * (1.0 / 15.0 - across / 72.0)));
    return sqrt(clamp(across < 0.25 ? thin : thick, 0.0, 1.0));
}

void main()
{
    uint index = gl_GlobalInvocationID.x;
    if (index >= counts.live)
        return;
    sf_particle p = particles[index];
    vec3 centre = vec3(p.x, p.y, p.z);
    float radius = p.extinction > 0.0 ? p.radius * share_of_radius(2.0 * p.radius * p.extinction) : 0.0;
    // A ball that the eye comes to shrinks, so that it is seen under an angle of 45 degrees at most, and of none when its centre gets to the near plane.
    float before = dot(centre - frame.eye.xyz, frame.forward.xyz) - frame.eye.w;
    vec3 albedo = frame.albedo.rgb;
    float age = p.lifetime > 0.0 ? clamp(p.age / p.lifetime, 0.0, 1.0) : 0.0;
    if (RAMP != 0u)
        albedo *= frame.ramp[int(age * float(SF_FRAME_RAMP - 1) + 0.5)].rgb;
    balls[index].sphere = vec4(centre, min(radius, before > 0.0 && radius > 0.0 ? 0.5 * before * before / radius : 0.0));
    balls[index].albedo = vec4(albedo, 0.0);
}
