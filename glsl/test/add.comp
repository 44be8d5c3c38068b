#version 460
// result[i] = source[i] + addend
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Source { uint source[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Result { uint result[]; };
layout(push_constant) uniform Push { uint addend; } push;

void main()
{
    uint i = gl_GlobalInvocationID.x;

    if (i < result.length())
        result[i] = source[i] + push.addend;
}
