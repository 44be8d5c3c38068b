#version 460
#extension GL_GOOGLE_include_directive : require
// Blur over the listed tiles; one group a tile.
#define TILED
#include "shared/frame.h"
#include "shared/thick.h"
#include "thick/blur.glsl"
