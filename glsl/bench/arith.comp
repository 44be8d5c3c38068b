#version 460
// The rate of multiply-adds: each thread runs 8 independent chains of vec4, `steps` long, so 64 * steps operations (a multiply-add counts
// as two). The result is stored, so that nothing is optimised away. Keep `steps` under 65,536: some drivers end loops there.
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) writeonly buffer Result { vec4 result[]; };
layout(push_constant) uniform Push
{
    float factor, offset;
    uint steps;
} push;

void main()
{
    vec4 factor = vec4(push.factor), offset = vec4(push.offset);
    vec4 a = vec4(gl_GlobalInvocationID.x), b = a + 1.0, c = a + 2.0, d = a + 3.0;
    vec4 e = a + 4.0, f = a + 5.0, g = a + 6.0, h = a + 7.0;

    for (uint i = 0; i < push.steps; i++) {
        a = a * factor + offset;
        b = b * factor + offset;
        c = c * factor + offset;
        d = d * factor + offset;
        e = e * factor + offset;
        f = f * factor + offset;
        g = g * factor + offset;
        h = h * factor + offset;
    }
    result[gl_GlobalInvocationID.x] = a + b + c + d + e + f + g + h;
}
