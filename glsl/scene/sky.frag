#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene/shade.glsl"
#include "scene/sky.glsl"

layout(location = 0) out vec4 color;
layout(location = 1) out float depth;

void main()
{
    depth = SF_DEPTH_FAR;
    color = sky_color();
}
