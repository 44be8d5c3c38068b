#version 460
#extension GL_GOOGLE_include_directive : require
// The rectangle in which the picture stands: a strip of two triangles.
#include "shared/window.h"

layout(push_constant) uniform Push { sf_window_picture_push push; };

void main()
{
    vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    gl_Position = vec4((push.rect.xy + corner * push.rect.zw) * push.to_clip.xy - 1.0, 0.0, 1.0);
}
