#version 460
#extension GL_GOOGLE_include_directive : require
// Lays the smoke over the shaded scene.
#include "shared/frame.h"

layout(constant_id = 0) const uint SCALE = 1u;
layout(constant_id = 1) const uint CHOICE = 0u; // 1: bilinear, without a look at depths
layout(set = 0, binding = 2) uniform sampler2D smoke;
layout(set = 0, binding = 3) uniform sampler2D smoke_depth;
layout(set = 0, binding = 4) uniform sampler2D scene_depth;
layout(location = 0) flat in vec4 behind;
layout(location = 0) out vec4 result;
#include "thick/upsample.glsl"

void main()
{
    result = upsample(smoke, gl_FragCoord.xy);
}
