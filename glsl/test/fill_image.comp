#version 460
// Each pixel tells its own place.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) uniform writeonly image2D target;

void main()
{
    ivec2 p = ivec2(gl_GlobalInvocationID.xy), size = imageSize(target);

    if (all(lessThan(p, size)))
        imageStore(target, p, vec4(p, p.y * size.x + p.x, 1.0));
}
