#version 460
#extension GL_GOOGLE_include_directive : require
// All triangles of the overlay in one draw. Each index comes with the number of its batch, whose clip rectangle the fragments get flat.
#include "shared/window.h"

layout(set = 0, binding = 0, std430) readonly buffer Vertices { uint vertices[]; }; // struct sf_overlay_vertex: x, y, u, v, colour
layout(set = 0, binding = 1, std430) readonly buffer Corners { uvec2 corners[]; };  // vertex, batch
layout(set = 0, binding = 2, std430) readonly buffer Clips { vec4 clips[]; };       // px: left, top, right, bottom
layout(push_constant) uniform Push { sf_window_ui_push push; };
layout(location = 0) flat out vec4 clip;
layout(location = 1) out vec2 uv;
layout(location = 2) out vec4 color;

void main()
{
    uvec2 corner = corners[gl_VertexIndex];
    uint at = 5u * corner.x;
    vec2 position = vec2(uintBitsToFloat(vertices[at]), uintBitsToFloat(vertices[at + 1u]));
    uv = vec2(uintBitsToFloat(vertices[at + 2u]), uintBitsToFloat(vertices[at + 3u]));
    color = unpackUnorm4x8(vertices[at + 4u]);
    clip = clips[corner.y];
    gl_Position = vec4(position * push.to_clip.xy - 1.0, 0.0, 1.0);
}
