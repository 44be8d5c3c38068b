#version 460
#extension GL_GOOGLE_include_directive : require
// A pair to sort for each particle: by view depth of the centre, the farthest first. The sort is stable, so those of equal depth stay in order of birth.
#include "shared/frame.h"
#include "shared/particle.h"
#include "sort/key.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
layout(set = 0, binding = 1, std430) readonly buffer Particles { sf_particle particles[]; };
layout(set = 0, binding = 2, std430) readonly buffer Counts { sf_particle_counts counts; };
layout(set = 0, binding = 3, std430) writeonly buffer Pairs { uvec2 pairs[]; };

void main()
{
    uint index = gl_GlobalInvocationID.x;
    if (index >= counts.live)
        return;
    sf_particle p = particles[index];
    float depth = dot(vec3(p.x, p.y, p.z) - frame.eye.xyz, frame.forward.xyz);
    pairs[index] = uvec2(sort_key_from_float(-depth), index);
}
