#version 460
// A triangle over the whole target, counter-clockwise as seen with y up; clip space has y down, so y is turned here as a projection does.
layout(location = 0) flat out vec4 color;

void main()
{
    const vec2 corners[3] = vec2[](vec2(-1.0, -1.0), vec2(3.0, -1.0), vec2(-1.0, 3.0));

    gl_Position = vec4(corners[gl_VertexIndex] * vec2(1.0, -1.0), 0.5, 1.0);
    color = vec4(1.0, 2.0, 3.0, 4.0);
}
