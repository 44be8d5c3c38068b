#version 460
// target = texelFetch(source), by way of a combined image sampler; `between` samples half a texel to the right instead.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D source;
layout(set = 0, binding = 1, rgba32f) uniform writeonly image2D target;
layout(constant_id = 0) const uint between = 0;

void main()
{
    ivec2 p = ivec2(gl_GlobalInvocationID.xy), size = imageSize(target);

    if (all(lessThan(p, size)))
        imageStore(target, p, between == 0 ? texelFetch(source, p, 0) : textureLod(source, (vec2(p) + vec2(1.0, 0.5)) / vec2(size), 0.0));
}
