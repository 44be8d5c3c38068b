#version 460
#extension GL_GOOGLE_include_directive : require
// Composite (L pass 10): the interval of each smoke pixel is marched. One group a tile, one thread a pixel.
#include "shared/frame.h"
#include "shared/thick.h"

layout(local_size_x = SF_THICK_TILE, local_size_y = SF_THICK_TILE) in;
layout(set = 0, binding = 1, std430) readonly buffer Tiles { uint tiles[]; };
layout(set = 0, binding = 9, rgba16f) writeonly uniform image2D target;
#include "larsson/march.glsl"

void main()
{
    uint tile = tiles[gl_WorkGroupID.x];
    uvec2 place = uvec2(tile % push.tiles_x, tile / push.tiles_x) * SF_THICK_TILE + gl_LocalInvocationID.xy;
    ivec2 pixel = ivec2(place);
    if (place.x >= push.width || place.y >= push.height)
        return;
    interval smoke = interval_of(pixel);
    vec3 radiance = sent(smoke, pixel, smoke.steps, 1.0);
    imageStore(target, pixel, smoke.steps > 0u ? vec4(radiance, smoke.opaque) : vec4(0.0));
}
