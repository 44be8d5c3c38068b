#version 460
// Specialization constants, one of them the size of the workgroup.
layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint scale = 1;
layout(constant_id = 2) const float offset = 0.0;
layout(set = 0, binding = 3, std430) writeonly buffer Result { float result[]; };

void main()
{
    result[gl_GlobalInvocationID.x] = float(gl_GlobalInvocationID.x * scale) + offset + float(gl_WorkGroupSize.x) * 1000.0;
}
