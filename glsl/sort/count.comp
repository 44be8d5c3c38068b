#version 460
#extension GL_GOOGLE_include_directive : require
#include "sort/slice.glsl"

layout(set = 0, binding = 0, std430) readonly buffer Count { uint counts[]; };
layout(set = 0, binding = 1, std430) readonly buffer Source { uvec2 source[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Table { uint table[]; };

shared uint bins[SF_SORT_DIGITS];

void main()
{
    uvec2 bounds = slice_bounds(min(counts[push.count_word], push.capacity), gl_WorkGroupID.x);

    for (uint digit = gl_LocalInvocationID.x; digit < SF_SORT_DIGITS; digit += LOCAL)
        bins[digit] = 0u;
    barrier();
    for (uint i = bounds.x + gl_LocalInvocationID.x; i < bounds.y; i += LOCAL)
        atomicAdd(bins[digit_of(source[i].x)], 1u);
    barrier();
    for (uint digit = gl_LocalInvocationID.x; digit < SF_SORT_DIGITS; digit += LOCAL)
        table[digit * push.groups + gl_WorkGroupID.x] = bins[digit];
}
