#version 460
#extension GL_GOOGLE_include_directive : require
// What of a ray needs no sampling: where smoke begins and ends, its optical depth (the sum of chords), its transmittance. One thread a pixel.
//
// Twofold arithmetic where a ray grazes a sphere: there the chord is the root of a small difference of large squares, and floats alone
// would give depths of a thousandth where there is nothing.
#include "shared/frame.h"
#include "shared/particle.h"
#include "shared/reference.h"
#include "lib/twofold.glsl"

layout(local_size_x = SF_REFERENCE_TILE, local_size_y = SF_REFERENCE_TILE) in;
layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
layout(set = 0, binding = 1, std430) readonly buffer Particles { sf_particle particles[]; };
layout(set = 0, binding = 2, std430) readonly buffer Lists { uvec2 lists[]; };
layout(set = 0, binding = 3, std430) readonly buffer Entries { uint entries[]; };
layout(set = 0, binding = 4) uniform sampler2D scene_depth;
layout(set = 0, binding = 5, rgba32f) uniform image2D depths; // near, far (m of view depth), optical depth, transmittance
layout(push_constant) uniform Push { sf_reference_push push; };

// (2 i + 1 - n) / n
vec2 across(uint i, float n)
{
    float above = float(2u * i + 1u) - n, share = above / n;
    vec2 back = twofold_product(share, n);
    return vec2(share, (above - back.x - back.y) / n);
}

// A component of the ray of unit view depth; xy and zw: the place in the frame, y up.
vec2 ray_part(vec4 at, float forward, float forward_low, float right, float right_low, float up, float up_low)
{
    vec2 aside = twofold_add(twofold_times(at.xy, vec2(right, right_low)), twofold_times(at.zw, vec2(up, up_low)));
    return twofold_add(vec2(forward, forward_low), aside);
}

// r^2 less the square of the way from the centre to the ray, which passes it at depth `middle`: the exact value for all that a float can tell.
float room_of(vec3 centre, float radius, float middle, vec2 x, vec2 y, vec2 z)
{
    vec2 middle_of = vec2(-middle, 0.0), room = twofold_product(radius, radius);
    vec2 miss = twofold_add(twofold_sum(centre.x, -frame.eye.x), twofold_times(middle_of, x));
    room = twofold_add(room, -twofold_times(miss, miss));
    miss = twofold_add(twofold_sum(centre.y, -frame.eye.y), twofold_times(middle_of, y));
    room = twofold_add(room, -twofold_times(miss, miss));
    miss = twofold_add(twofold_sum(centre.z, -frame.eye.z), twofold_times(middle_of, z));
    return twofold_add(room, -twofold_times(miss, miss)).x;
}

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= uint(frame.size.x) || pixel.y >= uint(frame.size.y))
        return;
    uvec2 list = lists[(gl_WorkGroupID.y * push.tiles_x + gl_WorkGroupID.x) * push.lists];
    vec4 at = vec4(across(pixel.x, frame.size.x), -across(pixel.y, frame.size.y));
    vec2 x = ray_part(at, frame.forward.x, frame.forward_low.x, frame.right.x, frame.right_low.x, frame.up.x, frame.up_low.x);
    vec2 y = ray_part(at, frame.forward.y, frame.forward_low.y, frame.right.y, frame.right_low.y, frame.up.y, frame.up_low.y);
    vec2 z = ray_part(at, frame.forward.z, frame.forward_low.z, frame.right.z, frame.right_low.z, frame.up.z, frame.up_low.z);
    vec3 ray = vec3(x.x, y.x, z.x);
    float squared = dot(ray, ray), begin = frame.eye.w, end = texelFetch(scene_depth, ivec2(pixel), 0).r;
    float near = SF_DEPTH_FAR, far = 0.0;
    vec2 depth = vec2(0.0); // twofold: of many summands
    for (uint i = 0u; i < list.y; i++) {
        uint index = list.x == SF_REFERENCE_ALL ? i : entries[list.x + i];
        sf_particle p = particles[index];
        vec3 centre = vec3(p.x, p.y, p.z);
        float middle = dot(centre - frame.eye.xyz, ray) / squared; // its rounding moves the point along the ray, which is of second order
        float half_chord = sqrt(max(room_of(centre, p.radius, middle, x, y, z), 0.0) / squared);
        float from = max(middle - half_chord, begin), to = min(middle + half_chord, end);
        float within = min(half_chord, middle - begin) + min(half_chord, end - middle); // to - from would lose a short chord
        bool met = half_chord > 0.0 && within > 0.0 && p.extinction > 0.0;
        near = met ? min(near, from) : near;
        far = met ? max(far, to) : far;
        depth = twofold_add(depth, vec2(met ? p.extinction * sqrt(squared) * within : 0.0, 0.0));
    }
    imageStore(depths, ivec2(pixel), depth.x > 0.0 ? vec4(near, far, depth.x, exp(-depth.x)) : vec4(SF_DEPTH_FAR, SF_DEPTH_FAR, 0.0, 1.0));
}
