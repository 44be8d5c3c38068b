#version 460
#extension GL_GOOGLE_include_directive : require
// Lays the smoke over the shaded scene: the mean so far, times what the smoke hides. With AOVS, writes what was asked for beside the picture.
#include "shared/frame.h"

layout(constant_id = 0) const uint AOVS = 0u;
layout(set = 0, binding = 0) uniform sampler2D sums;
layout(set = 0, binding = 1) uniform sampler2D depths;
layout(location = 0) out vec4 result;
layout(location = 1) out vec4 measured;

void main()
{
    vec4 sum = texelFetch(sums, ivec2(gl_FragCoord.xy), 0);
    vec4 seen = texelFetch(depths, ivec2(gl_FragCoord.xy), 0);
    float opaque = seen.z < 1e-3 ? seen.z * (1.0 - 0.5 * seen.z) : 1.0 - seen.w;
    result = sum.a > 0.0 ? vec4(sum.rgb * (opaque / sum.a), opaque) : vec4(vec3(0.0), opaque);
    measured = seen;
}
