#version 460
#extension GL_GOOGLE_include_directive : require
// Blur over a whole image; groups form a grid.
#include "shared/frame.h"
#include "shared/thick.h"
#include "thick/blur.glsl"
