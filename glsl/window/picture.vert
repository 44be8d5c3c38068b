#version 460
#extension GL_GOOGLE_include_directive : require
// The rectangle in which the picture stands: a strip of two triangles.
#include "shared/window.h"

layout(constant_id = 1) const uint EXACT = 0u;
layout(push_constant) uniform Push { sf_window_picture_push push; };

// Handed over rather than read by each fragment, which costs lavapipe as much as ten multiplications.
layout(location = 0) out vec2 at;
layout(location = 1) flat out float gain;

void main()
{
    vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    at = EXACT != 0u ? corner * push.size.xy : corner;
    gain = push.to_clip.z;
    gl_Position = vec4((push.rect.xy + corner * push.rect.zw) * push.to_clip.xy - 1.0, 0.0, 1.0);
}
