#version 460
#extension GL_GOOGLE_include_directive : require
// Colour alone, where the depth is there already.
#include "scene/shade.glsl"
#include "scene/sky.glsl"

layout(location = 0) out vec4 color;

void main()
{
    color = sky_color();
}
