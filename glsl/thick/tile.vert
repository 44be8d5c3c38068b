#version 460
#extension GL_GOOGLE_include_directive : require
// A rectangle for each tile of the list, widened by MARGIN (0 or 1) times the push constants' margin, over the smoke's image or the frame.
#include "shared/frame.h"
#include "shared/thick.h"

layout(constant_id = 0) const uint MARGIN = 0u;
layout(constant_id = 1) const uint TO_FRAME = 0u; // 1: the target has the frame's size
layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
layout(set = 0, binding = 1, std430) readonly buffer Tiles { uint tiles[]; };
layout(set = 0, binding = 7, std430) readonly buffer Args { sf_thick_args args; };
// View depth, m, beyond which there is no smoke, so that differences do not matter; and the difference in depth that does.
layout(location = 0) flat out vec2 behind;
layout(push_constant) uniform Push { sf_thick_push push; };

void main()
{
    uint tile = tiles[gl_InstanceIndex];
    vec2 corner = vec2(tile % push.tiles_x, tile / push.tiles_x) * float(SF_THICK_TILE);
    float margin = float(MARGIN * push.margin);
    vec2 pixel = corner - margin + vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * (float(SF_THICK_TILE) + 2.0 * margin);
    vec2 size = TO_FRAME != 0u ? frame.size.xy / float(push.scale) : vec2(push.width, push.height);
    behind = vec2(dot(args.centre.xyz - frame.eye.xyz, frame.forward.xyz) + args.centre.w, 0.1 * max(args.centre.w, 1e-4));
    gl_Position = vec4(pixel / size * 2.0 - 1.0, 0.5, 1.0);
}
