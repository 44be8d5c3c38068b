#version 460
#extension GL_GOOGLE_include_directive : require
// The smoke as each light sees it, through the middle of every texel: near, far, -, optical depth (the sum of chords), for its shadow on the
// scene. One group for a square of texels: it looks at as many particles at once as it has threads, each thread finding out for one of them
// whether it touches the square.
#include "shared/frame.h"
#include "shared/particle.h"
#include "shared/reference.h"
#include "lib/sphere.glsl"

layout(local_size_x = SF_REFERENCE_TILE, local_size_y = SF_REFERENCE_TILE) in;
layout(set = 0, binding = 0, std430) readonly buffer Particles { sf_particle particles[]; };
layout(set = 0, binding = 1, std430) readonly buffer Counts { sf_particle_counts counts; };
layout(set = 0, binding = 2, std430) readonly buffer Views { sf_gpu_light_view views[]; };
layout(set = 0, binding = 3, std430) buffer Verdict { sf_reference_verdict verdict; };
layout(set = 0, binding = 4, rgba32f) uniform image2D map; // cells side by side
layout(push_constant) uniform Push { sf_reference_push push; };

const uint THREADS = SF_REFERENCE_TILE * SF_REFERENCE_TILE;
shared uint touching[THREADS / 32u]; // one bit a particle
shared vec4 balls[THREADS];          // as the light sees them; w: radius
shared float extinctions[THREADS];

// The plane at depth 1, or across the light's way, of a texel's corner.
vec2 across_of(sf_gpu_light_view view, vec2 texel)
{
    return (texel / float(push.shadow_cell) - view.window.zw) / view.window.xy;
}

bool touches(bool perspective, vec4 ball, vec2 low, vec2 high)
{
    vec2 x = perspective ? circle_range(ball.x, ball.z, ball.w, 1e4) : ball.x + vec2(-ball.w, ball.w);
    vec2 y = perspective ? circle_range(ball.y, ball.z, ball.w, 1e4) : ball.y + vec2(-ball.w, ball.w);
    bool seen = ball.w > 0.0 && (!perspective || ball.z + ball.w > 0.0);
    return seen && x.x <= high.x && x.y >= low.x && y.x <= high.y && y.y >= low.y;
}

void main()
{
    uint size = push.shadow_cell, light = gl_WorkGroupID.z, thread = gl_LocalInvocationIndex;
    uvec2 texel = gl_GlobalInvocationID.xy;
    sf_gpu_light_view view = views[light];
    vec2 corner = vec2(gl_WorkGroupID.xy * SF_REFERENCE_TILE);
    vec2 a = across_of(view, corner - 0.01), b = across_of(view, corner + float(SF_REFERENCE_TILE) + 0.01);
    vec2 across = across_of(view, vec2(texel) + 0.5);
    bool perspective = view.info.x > 0.5;
    vec3 ray = perspective ? normalize(vec3(across, 1.0)) : vec3(0.0, 0.0, 1.0);
    float near = SF_DEPTH_FAR, far = -SF_DEPTH_FAR, depth = 0.0;
    uint met_here = 0u;
    for (uint first = 0u; first < counts.live; first += THREADS) {
        if (thread < THREADS / 32u)
            touching[thread] = 0u;
        barrier();
        if (first + thread < counts.live) {
            sf_particle p = particles[first + thread];
            balls[thread] = vec4((view.view * vec4(p.x, p.y, p.z, 1.0)).xyz, p.radius);
            extinctions[thread] = p.extinction;
            if (p.extinction > 0.0 && touches(perspective, balls[thread], min(a, b), max(a, b)))
                atomicOr(touching[thread / 32u], 1u << (thread % 32u));
        }
        barrier();
        for (uint word = 0u; word < THREADS / 32u; word++) {
            met_here += bitCount(touching[word]);
            for (uint left = touching[word]; left != 0u; left &= left - 1u) {
                uint i = 32u * word + uint(findLSB(left));
                vec4 ball = balls[i];
                vec2 chord = sphere_chord(ray, perspective ? ball.xyz : vec3(ball.xy - across, ball.z), ball.w);
                float from = perspective ? max(chord.x - chord.y, 0.0) : chord.x - chord.y, to = chord.x + chord.y;
                bool met = chord.y > 0.0 && to > from;
                near = met ? min(near, from) : near;
                far = met ? max(far, to) : far;
                depth += met ? extinctions[i] * (to - from) : 0.0;
            }
        }
        barrier();
    }
    if (thread == 0u)
        atomicMax(verdict.longest_shadow, met_here);
    // Where there is no smoke the depths are in front of all, so that the filter, which mixes them in, leaves what lies behind the smoke dark.
    if (texel.x < size && texel.y < size)
        imageStore(map, ivec2(texel.x + light * size, texel.y), depth > 0.0 ? vec4(near, far, 0.0, depth) : vec4(-SF_DEPTH_FAR, -SF_DEPTH_FAR, 0.0, 0.0));
}
