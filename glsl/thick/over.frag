#version 460
#extension GL_GOOGLE_include_directive : require
// Lays the smoke over the shaded scene. Reduced smoke is taken up by the four nearest pixels, weighted by distance and by how well the depth that they
// were cut off at agrees with this pixel's (joint bilateral upsampling, Kopf et al. 2007).
#include "shared/frame.h"
#include "shared/thick.h"

layout(constant_id = 0) const uint MARGIN = 0u; // as in tile.vert
layout(constant_id = 1) const uint TO_FRAME = 1u;
layout(constant_id = 2) const uint SCALE = 1u;
layout(set = 0, binding = 2) uniform sampler2D smoke;
layout(set = 0, binding = 3) uniform sampler2D smoke_depth;
layout(set = 0, binding = 4) uniform sampler2D scene_depth;
layout(location = 0) flat in vec2 behind;
layout(location = 0) out vec4 result;
#include "thick/upsample.glsl"

void main()
{
    upsample_begin(gl_FragCoord.xy);
    result = SCALE == 1u ? texelFetch(smoke, ivec2(gl_FragCoord.xy), 0) : upsample(smoke);
}
