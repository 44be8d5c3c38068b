#version 460
#extension GL_GOOGLE_include_directive : require
// What was asked for beside the picture, at the frame's size: smoke alone, and its depths: near, far (m of view depth; SF_DEPTH_FAR where there is
// none), optical depth, transmittance.
#include "shared/frame.h"
#include "shared/thick.h"

layout(constant_id = 2) const uint SCALE = 1u;
layout(constant_id = 3) const uint CHOICE = 0u; // as in tile.vert
layout(set = 0, binding = 2) uniform sampler2D smoke;
layout(set = 0, binding = 3) uniform sampler2D smoke_depth;
layout(set = 0, binding = 4) uniform sampler2D scene_depth;
layout(set = 0, binding = 5) uniform sampler2D whole;
layout(location = 0) flat in vec4 behind;
layout(location = 0) out vec4 radiance;
layout(location = 1) out vec4 depths;
#include "thick/upsample.glsl"
#include "thick/full.glsl"

void main()
{
    vec3 seen = texelFetch(whole, ivec2(gl_FragCoord.xy), 0).rgb;
    radiance = full_smoke();
    depths = seen.r > 0.0 ? vec4(seen.gb, seen.r, exp(-seen.r)) : vec4(SF_DEPTH_FAR, SF_DEPTH_FAR, 0.0, 1.0);
}
