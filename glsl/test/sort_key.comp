#version 460
#extension GL_GOOGLE_include_directive : require
// Pairs of (key of the i-th float, i).
#include "sort/key.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Floats { float floats[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Pairs { uvec2 pairs[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;

    if (i < floats.length())
        pairs[i] = uvec2(sort_key_from_float(floats[i]), i);
}
