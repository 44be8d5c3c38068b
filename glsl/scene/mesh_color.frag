#version 460
#extension GL_GOOGLE_include_directive : require
// Colour alone, where the depth is there already.
#define SF_ONLY_COLOR
#include "scene/mesh_fragment.glsl"
