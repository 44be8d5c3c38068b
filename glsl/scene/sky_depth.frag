#version 460
#extension GL_GOOGLE_include_directive : require
// Depth alone, before the colours.
#include "shared/frame.h"

layout(location = 0) out float depth;

void main()
{
    depth = SF_DEPTH_FAR;
}
