#version 460
// A strip of 4 vertices: the rectangle push.rect (x0, y0, x1, y1 in clip space) at depth push.depth + instance * push.step, in push.color,
// which instance i multiplies by i + 1.
layout(push_constant) uniform Push
{
    vec4 rect;
    vec4 color;
    float depth, step;
} push;
layout(location = 0) flat out vec4 color;

void main()
{
    vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);

    gl_Position = vec4(mix(push.rect.xy, push.rect.zw, corner), push.depth + float(gl_InstanceIndex) * push.step, 1.0);
    color = push.color * float(gl_InstanceIndex + 1);
}
