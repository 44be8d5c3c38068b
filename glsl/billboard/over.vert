#version 460
#extension GL_GOOGLE_include_directive : require
// The rectangle of the frame that smoke may touch: round the sphere round its bounds.
#include "shared/frame.h"
#include "shared/billboard.h"
#include "shared/thick.h"
#include "lib/sphere.glsl"

layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
layout(set = 0, binding = 1, std140) uniform Args { sf_thick_args args; };
layout(push_constant) uniform Push { sf_billboard_push push; };
#include "thick/view.glsl"
layout(location = 0) flat out vec4 behind; // as in thick/tile.vert

void main()
{
    vec3 c = to_view(args.centre.xyz);
    float r = args.centre.w;
    vec2 tangent = vec2(frame.right.w, frame.up.w);
    // A pixel of the smoke wider, for the upsampling.
    vec2 margin = 2.0 * float(push.scale) * frame.size.zw;
    vec2 x = clamp(circle_range(c.x, c.z, r, 1e4) / tangent.x + vec2(-margin.x, margin.x), -1.0, 1.0);
    vec2 y = clamp(circle_range(c.y, c.z, r, 1e4) / tangent.y + vec2(-margin.y, margin.y), -1.0, 1.0);
    vec2 ndc = vec2((gl_VertexIndex & 1) != 0 ? x.y : x.x, (gl_VertexIndex & 2) != 0 ? y.y : y.x);
    behind = vec4(c.z + r, 0.1 * max(r, 1e-4), 1.0 / (float(push.scale) * vec2(push.width, push.height)));
    gl_Position = r > 0.0 && c.z + r > frame.eye.w ? vec4(ndc.x, -ndc.y, 0.5, 1.0) : vec4(2.0, 2.0, 0.0, 1.0);
}
