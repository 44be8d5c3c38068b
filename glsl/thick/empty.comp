#version 460
#extension GL_GOOGLE_include_directive : require
// Sets the words of all tiles to 0.
#include "shared/thick.h"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) writeonly buffer Words { uint words[]; };
layout(push_constant) uniform Push { sf_thick_push push; };

void main()
{
    if (gl_GlobalInvocationID.x < push.tiles_x * push.tiles_y)
        words[gl_GlobalInvocationID.x] = 0u;
}
