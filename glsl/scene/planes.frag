#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Colour and depth.
#include "scene/planes_fragment.glsl"
