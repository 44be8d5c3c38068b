#version 460
#extension GL_GOOGLE_include_directive : require
// Marks the tiles of the smoke's image that a particle's sphere may touch. One thread a particle.
#include "shared/frame.h"
#include "shared/particle.h"
#include "shared/thick.h"
#include "lib/sphere.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
layout(set = 0, binding = 1, std430) readonly buffer Particles { sf_particle particles[]; };
layout(set = 0, binding = 2, std430) readonly buffer Counts { sf_particle_counts counts; };
layout(set = 0, binding = 3, std430) buffer Mask { uint mask[]; };
layout(push_constant) uniform Push { sf_thick_push push; };
#include "thick/view.glsl"

void main()
{
    uint index = gl_GlobalInvocationID.x;
    if (index >= counts.live)
        return;
    sf_particle p = particles[index];
    vec3 c = to_view(vec3(p.x, p.y, p.z));
    if (c.z + p.radius <= frame.eye.w || !(p.extinction > 0.0))
        return;
    vec2 x = circle_range(c.x, c.z, p.radius, 1e4) / frame.right.w;
    vec2 y = circle_range(c.y, c.z, p.radius, 1e4) / frame.up.w;
    // ndc to smoke pixels; rows go down
    vec2 pixels = 0.5 * frame.size.xy / float(push.scale);
    vec2 low = (vec2(x.x, -y.y) + 1.0) * pixels;
    vec2 high = (vec2(x.y, -y.x) + 1.0) * pixels;
    low -= float(push.reach);
    high += float(push.reach);
    vec2 size = vec2(push.width, push.height);
    if (any(lessThan(high, vec2(0.0))) || any(greaterThanEqual(low, size)))
        return;
    uvec2 first = uvec2(clamp(low, vec2(0.0), size - 1.0)) / SF_THICK_TILE;
    uvec2 last = uvec2(clamp(high, vec2(0.0), size - 1.0)) / SF_THICK_TILE;
    for (uint row = first.y; row <= last.y; row++)
        for (uint column = first.x; column <= last.x; column++)
            atomicOr(mask[row * push.tiles_x + column], 1u);
}
