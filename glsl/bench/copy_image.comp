#version 460
// The ceiling that a frame is measured against: one imageLoad and one imageStore of RGBA32F, one pixel a thread.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) uniform readonly image2D source;
layout(set = 0, binding = 1, rgba32f) uniform writeonly image2D target;

void main()
{
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);

    if (all(lessThan(p, imageSize(target))))
        imageStore(target, p, imageLoad(source, p));
}
