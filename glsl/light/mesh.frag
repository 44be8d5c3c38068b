#version 460
#extension GL_GOOGLE_include_directive : require
// Blended by MIN, so that the first surface stays.
#include "light/shadow.glsl"

layout(location = 0) flat in uint cell;
layout(location = 1) in vec3 seen;
layout(location = 0) out float value;

void main()
{
    float w = cells[cell].origin.w > 0.0 ? seen.z : 1.0;
    if (abs(seen.x) > w || abs(seen.y) > w || seen.z < cells[cell].range.x)
        discard;
    value = shadow_value(cell, seen.z);
}
