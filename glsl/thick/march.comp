#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_EXT_control_flow_attributes : require
// The light that smoke sends to the eye, into the smoke's image. One group a tile, one thread a pixel.
#include "shared/frame.h"
#include "shared/particle.h"
#include "shared/thick.h"

layout(local_size_x = SF_THICK_TILE * SF_THICK_TILE) in;
layout(set = 0, binding = 9, rgba16f) writeonly uniform image2D target;
#include "thick/march.glsl"

void main()
{
    uint tile = tiles[gl_WorkGroupID.x];
    uvec2 place = uvec2(tile % push.tiles_x, tile / push.tiles_x) * SF_THICK_TILE + thick_corner(gl_SubgroupID * gl_SubgroupSize + gl_SubgroupInvocationID);
    ivec2 pixel = ivec2(place);
    looked at = look(pixel, ranges[gl_WorkGroupID.x]);
    uint steps = seen.whole > 0.0 ? STEPS : 0u;
    vec3 radiance = sent(at, pixel, steps, SF_DEPTH_FAR, opaque);
    if (place.x < push.width && place.y < push.height)
        imageStore(target, pixel, steps > 0u ? vec4(radiance, opaque) : vec4(0.0));
}
