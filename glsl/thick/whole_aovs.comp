#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_EXT_control_flow_attributes : require
// How much smoke each pixel of the frame sees, and from where to where: optical depth, near, far.
#include "shared/frame.h"
#include "shared/thick.h"

layout(set = 0, binding = 8, rgba32f) writeonly uniform image2D target;
const bool NEAR_FAR = true;
#include "thick/whole.glsl"
