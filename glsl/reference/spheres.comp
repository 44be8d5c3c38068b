#version 460
#extension GL_GOOGLE_include_directive : require
// The particles as the eye has them: where they are from it, what they are made of, and which pixels they cover. One thread a particle.
#include "shared/frame.h"
#include "shared/particle.h"
#include "shared/reference.h"
#include "lib/sphere.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
layout(set = 0, binding = 1, std430) readonly buffer Particles { sf_particle particles[]; };
layout(set = 0, binding = 2, std430) readonly buffer Counts { sf_particle_counts counts; };
layout(set = 0, binding = 3, std430) readonly buffer Ramp { vec4 ramp[]; }; // rgb and share of life; unused ones repeat the last
layout(set = 0, binding = 4, std430) buffer Spheres { sf_reference_sphere spheres[]; };
layout(set = 0, binding = 5, std430) writeonly buffer Rects { vec4 rects[]; }; // px: left, top, right, bottom; none: left > right
layout(set = 0, binding = 6, std430) buffer Verdict { sf_reference_verdict verdict; };

// The ramp itself: linear between its keys, constant outside.
vec3 ramp_at(float life)
{
    vec3 color = ramp[0].rgb;
    for (uint i = 1u; i < SF_REFERENCE_RAMP; i++) {
        float span = ramp[i].w - ramp[i - 1u].w;
        if (life > ramp[i - 1u].w)
            color = mix(ramp[i - 1u].rgb, ramp[i].rgb, span > 0.0 ? min((life - ramp[i - 1u].w) / span, 1.0) : 1.0);
    }
    return color;
}

void main()
{
    uint index = gl_GlobalInvocationID.x;
    if (index == 0u)
        verdict = sf_reference_verdict(0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u);
    if (index >= counts.live)
        return;
    sf_particle p = particles[index];
    bool matters = p.extinction > 0.0 && p.radius > 0.0;
    vec3 centre = vec3(p.x, p.y, p.z) - frame.eye.xyz;
    spheres[index].ball = vec4(centre, matters ? p.radius : 0.0);
    spheres[index].matter = vec4(matters ? p.extinction : 0.0, frame.albedo.rgb * ramp_at(p.lifetime > 0.0 ? p.age / p.lifetime : 0.0));

    vec2 tangent = vec2(frame.right.w, frame.up.w);
    vec3 seen = vec3(dot(centre, frame.right.xyz) / tangent.x, dot(centre, frame.up.xyz) / tangent.y, dot(centre, frame.forward.xyz));
    // A little more than the sphere, for what rounding puts on the wrong side.
    float reach = p.radius * 1.0001 + 1e-5 * length(centre);
    vec2 x = circle_range(seen.x, seen.z, reach, 1e4) / tangent.x;
    vec2 y = circle_range(seen.y, seen.z, reach, 1e4) / tangent.y;
    vec2 low = (vec2(x.x, -y.y) + 1.0) * 0.5 * frame.size.xy, high = (vec2(x.y, -y.x) + 1.0) * 0.5 * frame.size.xy;
    bool seen_at_all = matters && seen.z + reach > frame.eye.w;
    rects[index] = seen_at_all ? vec4(low - 0.01, high + 0.01) : vec4(1.0, 1.0, -1.0, -1.0);
}
