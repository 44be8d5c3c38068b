#version 460
#extension GL_GOOGLE_include_directive : require
// Depth alone, before the colours.
#define SF_ONLY_DEPTH
#include "scene/solids_fragment.glsl"
