#version 460
#extension GL_GOOGLE_include_directive : require
#include "sort/slice.glsl"
#include "sort/prefix.glsl"

layout(set = 0, binding = 0, std430) buffer Table { uint table[]; };

void main()
{
    uint row = gl_WorkGroupID.x * push.groups, sum = 0u;

    for (uint first = 0u; first < push.groups; first += LOCAL) {
        uint i = first + gl_LocalInvocationID.x, total;
        uint count = i < push.groups ? table[row + i] : 0u;
        uint before = prefix_sum(count, total);
        if (i < push.groups)
            table[row + i] = sum + before;
        sum += total;
    }
    if (gl_LocalInvocationID.x == 0u)
        table[SF_SORT_DIGITS * push.groups + gl_WorkGroupID.x] = sum;
}
