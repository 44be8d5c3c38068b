#version 460
#extension GL_GOOGLE_include_directive : require
// A rectangle for each tile of the list, widened by MARGIN pixels of the smoke, over the smoke's image or the frame.
#include "shared/frame.h"
#include "shared/thick.h"

layout(constant_id = 0) const uint MARGIN = 0u;
layout(constant_id = 1) const uint TO_FRAME = 0u; // 1: the target has the frame's size
layout(constant_id = 3) const uint CHOICE = 0u; // 0: all tiles; 1: those before whose smoke no surface stands; 2: the others; 3: all, taken up as those of 1 are
layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
layout(set = 0, binding = 1, std430) readonly buffer Tiles { uint tiles[]; };
layout(set = 0, binding = 8, std430) readonly buffer Mask { uint mask[]; };
layout(set = 0, binding = 7, std430) readonly buffer Args { sf_thick_args args; };
// View depth, m, beyond which there is no smoke, so that differences do not matter; and the difference in depth that does.
layout(location = 0) flat out vec4 behind; // zw: from a pixel of the frame to 0..1 of the smoke's image
layout(location = 1) flat out uint number;
layout(push_constant) uniform Push { sf_thick_push push; };

void main()
{
    uint tile = tiles[gl_InstanceIndex];
    vec2 corner = vec2(tile % push.tiles_x, tile / push.tiles_x) * float(SF_THICK_TILE);
    float margin = float(MARGIN);
    vec2 pixel = corner - margin + vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * (float(SF_THICK_TILE) + 2.0 * margin);
    vec2 size = TO_FRAME != 0u ? frame.size.xy / float(push.scale) : vec2(push.width, push.height);
    behind = vec4(dot(args.centre.xyz - frame.eye.xyz, frame.forward.xyz) + args.centre.w, 0.1 * max(args.centre.w, 1e-4),
                  1.0 / (float(push.scale) * vec2(push.width, push.height)));
    number = tile;
    bool out_of_turn = (CHOICE == 1u || CHOICE == 2u) && (mask[tile] == SF_THICK_TILE_CUT) != (CHOICE == 2u);
    gl_Position = out_of_turn ? vec4(2.0, 2.0, 0.0, 1.0) : vec4(pixel / size * 2.0 - 1.0, 0.5, 1.0);
}
