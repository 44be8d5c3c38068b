#version 460
#extension GL_GOOGLE_include_directive : require
// Colour and depth.
#include "scene/mesh_fragment.glsl"
