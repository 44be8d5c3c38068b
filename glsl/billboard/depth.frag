#version 460
#extension GL_GOOGLE_include_directive : require
// The scene's depth at the smoke's size.
#include "shared/billboard.h"

layout(set = 0, binding = 0) uniform sampler2D scene_depth;
layout(push_constant) uniform Push { sf_billboard_push push; };
layout(location = 0) out float depth;
#include "thick/reduce.glsl"

void main()
{
    depth = reduced_depth(ivec2(gl_FragCoord.xy)).x;
}
