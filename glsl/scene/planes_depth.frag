#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Depth alone, before the colours.
#define SF_ONLY_DEPTH
#include "scene/planes_fragment.glsl"
