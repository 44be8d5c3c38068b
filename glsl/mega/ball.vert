#version 460
#extension GL_GOOGLE_include_directive : require
// The rectangle that covers a ball.
#include "shared/frame.h"
#include "shared/thick.h"
#include "shared/mega.h"
#include "lib/sphere.glsl"

layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
layout(set = 0, binding = 1, std430) readonly buffer Balls { sf_mega_ball balls[]; };
layout(push_constant) uniform Push { sf_thick_push push; };
#include "thick/view.glsl"

layout(location = 0) out vec2 ray;         // view ray of unit depth
layout(location = 1) flat out vec4 sphere; // centre (x, y, depth), radius
layout(location = 2) flat out vec2 own;    // near plane, number of the ball

void main()
{
    sf_mega_ball ball = balls[gl_InstanceIndex];
    vec3 c = to_view(ball.sphere.xyz);
    float r = ball.sphere.w;
    vec2 tangent = vec2(frame.right.w, frame.up.w);
    // As far as the smoke's image, whose last row and column may reach beyond the frame.
    vec2 reach = tangent * (1.0 + 2.0 * float(push.scale) * frame.size.zw);
    vec2 x = clamp(circle_range(c.x, c.z, r, 1e4), -reach.x, reach.x);
    vec2 y = clamp(circle_range(c.y, c.z, r, 1e4), -reach.y, reach.y);
    ray = vec2((gl_VertexIndex & 1) != 0 ? x.y : x.x, (gl_VertexIndex & 2) != 0 ? y.y : y.x);
    sphere = vec4(c, r);
    own = vec2(frame.eye.w, gl_InstanceIndex);
    vec2 ndc = ray / tangent;
    vec2 share = frame.size.xy / (float(push.scale) * vec2(push.width, push.height)); // of the image that the frame covers
    gl_Position = r > 0.0 ? vec4((vec2(ndc.x, -ndc.y) + 1.0) * share - 1.0, 0.5, 1.0) : vec4(2.0, 2.0, 0.0, 1.0);
}
