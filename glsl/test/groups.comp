#version 460
// Counts the workgroups that ran, and writes arguments for an indirect dispatch and an indirect draw.
layout(local_size_x = 1) in;
layout(set = 0, binding = 0, std430) buffer Count { uint count; };
layout(set = 0, binding = 1, std430) writeonly buffer Arguments { uint arguments[8]; };

void main()
{
    atomicAdd(count, 1u);
    if (gl_WorkGroupID.x == 0) {
        arguments[0] = 5;
        arguments[1] = 2;
        arguments[2] = 1;
        arguments[4] = 4; // vertices
        arguments[5] = 3; // instances
        arguments[6] = 0;
        arguments[7] = 0;
    }
}
