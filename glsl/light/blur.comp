#version 460
#extension GL_GOOGLE_include_directive : require
// One direction of the Gauss blur of the shadow map; cells do not mix. Runs once for a scene.
#include "shared/frame.h"
#include "shared/shadow.h"

layout(constant_id = 0) const uint VERTICAL = 0u;
layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0) uniform sampler2D source;
layout(set = 0, binding = 1, r32f) writeonly uniform image2D target;
layout(push_constant) uniform Push { sf_shadow_push push; };

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = textureSize(source, 0);
    if (any(greaterThanEqual(pixel, size)))
        return;
    // Not a ?: of vectors: Mesa 22.3 folds that wrongly for specialization constants, in the first component only.
    ivec2 axis = ivec2(1 - int(VERTICAL), int(VERTICAL));
    ivec2 low = ivec2(pixel.x / int(push.cell) * int(push.cell), 0);
    ivec2 high = low + int(push.cell) - 1;
    float scale = push.sigma > 0.0 ? -0.5 / (push.sigma * push.sigma) : 0.0;
    int radius = int(push.radius);
    float sum = 0.0, weights = 0.0;
    for (int i = -radius; i <= radius; i++) {
        float weight = exp(scale * float(i * i));
        sum += weight * texelFetch(source, clamp(pixel + i * axis, low, high), 0).r;
        weights += weight;
    }
    // The rim is lit, and what lies outside of the cell reads the rim.
    bool rim = VERTICAL != 0u && (any(equal(pixel, low)) || any(equal(pixel, high)));
    imageStore(target, pixel, vec4(rim ? 1e38 : sum / weights));
}
