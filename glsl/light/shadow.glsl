// What the passes of the shadow map share.
#ifndef SF_LIGHT_SHADOW_GLSL
#define SF_LIGHT_SHADOW_GLSL
#include "shared/frame.h"
#include "shared/shadow.h"

layout(set = 0, binding = 0, std140) uniform Cells { sf_gpu_shadow_cell cells[SF_FRAME_LIGHTS]; };
layout(set = 0, binding = 1, std140) uniform Objects { sf_gpu_object objects[SF_FRAME_OBJECTS]; };

// The map's value for depth t of a cell's ray.
float shadow_value(uint cell, float t)
{
    vec4 range = cells[cell].range;
    return exp(range.z * (clamp((t - range.x) * range.y, 0.0, 1.0) - 0.5));
}

#endif
