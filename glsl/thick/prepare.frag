#version 460
#extension GL_GOOGLE_include_directive : require
// Empties the smoke's targets where they will be used, and takes the scene's depth down to the smoke's resolution: farthest and nearest
// of each block in turn (a checkerboard), so that both sides of an edge are there when the picture is taken up again. Depths behind all smoke are
// made equal.
#include "shared/frame.h"
#include "shared/thick.h"

layout(set = 0, binding = 2) uniform sampler2D scene_depth;
layout(set = 0, binding = 8, std430) writeonly buffer Mask { uint mask[]; };
layout(push_constant) uniform Push { sf_thick_push push; };
layout(location = 0) flat in vec4 behind;
layout(location = 1) flat in uint number;
layout(location = 0) out vec4 raw;
layout(location = 1) out vec4 smoke;
layout(location = 2) out float depth;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 limit = textureSize(scene_depth, 0) - 1;
    ivec2 first = min(pixel * int(push.scale), limit);
    float z = texelFetch(scene_depth, first, 0).r;
    float nearest = z;
    if (push.scale > 1u) {
        ivec2 last = min(first + int(push.scale) - 1, limit);
        float a = texelFetch(scene_depth, ivec2(last.x, first.y), 0).r;
        float b = texelFetch(scene_depth, ivec2(first.x, last.y), 0).r;
        float c = texelFetch(scene_depth, last, 0).r;
        nearest = min(min(z, a), min(b, c));
        z = ((pixel.x ^ pixel.y) & 1) != 0 ? nearest : max(max(z, a), max(b, c));
    }
    if (nearest < behind.x)
        mask[number] = SF_THICK_TILE_CUT;
    raw = vec4(SF_DEPTH_FAR, SF_DEPTH_FAR, 1.0, 0.0);
    smoke = vec4(0.0);
    depth = min(z, behind.x);
}
