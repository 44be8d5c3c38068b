#version 460
#extension GL_GOOGLE_include_directive : require
// Lays the smoke over the shaded scene.
#include "shared/frame.h"
#include "shared/thick.h"

layout(constant_id = 2) const uint SCALE = 1u;
layout(constant_id = 3) const uint CHOICE = 0u; // as in tile.vert
layout(set = 0, binding = 2) uniform sampler2D smoke;
layout(set = 0, binding = 3) uniform sampler2D cut;
layout(set = 0, binding = 4) uniform sampler2D scene_depth;
layout(location = 0) flat in vec4 behind;
layout(location = 0) out vec4 result;
#include "mega/upsample.glsl"

void main()
{
    result = upsample(smoke, gl_FragCoord.xy);
}
