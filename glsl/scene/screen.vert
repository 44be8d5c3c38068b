#version 460
// One triangle over the whole picture.
layout(location = 0) out vec2 ndc; // y up

void main()
{
    vec2 corner = vec2(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0);
    gl_Position = vec4(corner, 0.0, 1.0);
    ndc = vec2(corner.x, -corner.y);
}
