#version 460
#extension GL_GOOGLE_include_directive : require
// Empties the smoke's image where it will be used, and takes the scene's depth down.
#include "shared/frame.h"
#include "shared/thick.h"

layout(set = 0, binding = 2) uniform sampler2D scene_depth;
layout(set = 0, binding = 8, std430) writeonly buffer Mask { uint mask[]; };
layout(push_constant) uniform Push { sf_thick_push push; };
layout(location = 0) flat in vec4 behind;
layout(location = 1) flat in uint number;
layout(location = 0) out vec4 smoke;
layout(location = 1) out float depth;
#include "thick/reduce.glsl"

void main()
{
    vec2 reduced = reduced_depth(ivec2(gl_FragCoord.xy));
    if (reduced.y < behind.x)
        mask[number] = SF_THICK_TILE_CUT;
    smoke = vec4(0.0);
    depth = reduced.x;
}
