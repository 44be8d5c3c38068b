#version 460
#extension GL_GOOGLE_include_directive : require
// A mesh as each light sees it: an instance a light, placed into its cell of the map.
#include "light/shadow.glsl"

layout(set = 0, binding = 2, std430) readonly buffer Vertices { float vertices[]; };
layout(set = 0, binding = 3, std430) readonly buffer Indices { uint indices[]; };
layout(push_constant) uniform Push { sf_mesh_push push; };
layout(location = 0) flat out uint cell;
layout(location = 1) out vec3 seen; // right, down (in cell units, times the depth for perspective), depth

void main()
{
    cell = gl_InstanceIndex;
    uint vertex = push.first_vertex + indices[push.first_index + gl_VertexIndex];
    vec3 at = vec3(vertices[6u * vertex], vertices[6u * vertex + 1u], vertices[6u * vertex + 2u]) * objects[push.object].shape.x;
    vec4 row0 = objects[push.object].row0, row1 = objects[push.object].row1, row2 = objects[push.object].row2;
    at -= vec3(row0.w, row1.w, row2.w);
    vec3 from = at.x * row0.xyz + at.y * row1.xyz + at.z * row2.xyz - cells[cell].origin.xyz;
    float square = cells[cell].right.w * cells[cell].right.w;
    seen = vec3(dot(from, cells[cell].right.xyz) / square, dot(from, cells[cell].down.xyz) / square, dot(from, cells[cell].forward.xyz));
    float w = cells[cell].origin.w > 0.0 ? seen.z : 1.0;
    float x = (seen.x + (2.0 * float(cell) + 1.0) * w) / float(push.cells) - w;
    gl_Position = vec4(x, seen.y, 0.5 * w, w);
}
