#version 460
#extension GL_GOOGLE_include_directive : require
// The light of a flash, added to what is there. It covers nothing: alpha stays.
#include "shared/frame.h"

layout(push_constant) uniform Push { sf_flash_push flash; };
layout(location = 0) out vec4 color;

void main()
{
    color = vec4(flash.light.rgb, 0.0);
}
