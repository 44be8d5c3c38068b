#version 460
#extension GL_GOOGLE_include_directive : require
// A triangle mesh, its vertices pulled from buffers.
#include "scene/shade.glsl"
#include "shared/shadow.h"

layout(set = 0, binding = 5, std430) readonly buffer Vertices { float vertices[]; };
layout(set = 0, binding = 6, std430) readonly buffer Indices { uint indices[]; };
layout(push_constant) uniform Push { sf_mesh_push push; };
layout(location = 0) out vec3 world;
layout(location = 1) out vec3 normal;
layout(location = 2) flat out vec3 albedo;
invariant gl_Position; // a pass that is to draw where the depth is equal finds it so

vec3 to_world(vec3 v)
{
    return v.x * objects[push.object].row0.xyz + v.y * objects[push.object].row1.xyz + v.z * objects[push.object].row2.xyz;
}

void main()
{
    uint at = 6u * (push.first_vertex + indices[push.first_index + gl_VertexIndex]);
    vec3 offset = vec3(objects[push.object].row0.w, objects[push.object].row1.w, objects[push.object].row2.w);
    world = to_world(vec3(vertices[at], vertices[at + 1u], vertices[at + 2u]) * objects[push.object].shape.x - offset);
    normal = to_world(vec3(vertices[at + 3u], vertices[at + 4u], vertices[at + 5u]));
    albedo = objects[push.object].albedo.rgb;
    gl_Position = frame.world_to_clip * vec4(world, 1.0);
}
