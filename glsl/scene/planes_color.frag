#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Colour alone, where the depth is there already.
#define SF_ONLY_COLOR
#include "scene/planes_fragment.glsl"
