#version 460
#extension GL_GOOGLE_include_directive : require
// What was asked for beside the picture, at the frame's size: smoke alone, and its depths: near, far (m of view depth; SF_DEPTH_FAR where there is
// none), optical depth, transmittance.
#include "shared/frame.h"

layout(constant_id = 2) const uint SCALE = 1u;
layout(constant_id = 3) const uint CHOICE = 0u; // as in thick/tile.vert
layout(set = 0, binding = 2) uniform sampler2D smoke;
layout(set = 0, binding = 3) uniform sampler2D smoke_depth;
layout(set = 0, binding = 4) uniform sampler2D scene_depth;
layout(set = 0, binding = 5) uniform sampler2D extent;
layout(location = 0) flat in vec4 behind;
layout(location = 0) out vec4 radiance;
layout(location = 1) out vec4 depths;
#include "thick/upsample.glsl"

void main()
{
    radiance = upsample(smoke, gl_FragCoord.xy);
    // Depths are not mixed across the border of the smoke: they come from the nearest pixel.
    ivec2 pixel = min(ivec2(gl_FragCoord.xy) / int(SCALE), textureSize(extent, 0) - 1);
    vec2 ends = texelFetch(extent, pixel, 0).rg * vec2(1.0, -1.0);
    float through = max(1.0 - radiance.a, 0.0);
    bool any_smoke = radiance.a > 0.0;
    bool found = any_smoke && ends.x < SF_DEPTH_FAR;
    depths = any_smoke ? vec4(found ? ends : vec2(SF_DEPTH_FAR), -log(max(through, 1e-30)), through) : vec4(SF_DEPTH_FAR, SF_DEPTH_FAR, 0.0, 1.0);
}
