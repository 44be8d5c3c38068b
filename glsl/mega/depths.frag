#version 460
#extension GL_GOOGLE_include_directive : require
// Where the balls begin and end, for those who asked for it: blended MIN on colour. R near, G minus far (view depths, m).
#include "shared/frame.h"
#include "lib/sphere.glsl"

layout(location = 0) in vec2 ray;
layout(location = 1) flat in vec4 sphere;
layout(location = 2) flat in vec2 own;
layout(location = 0) out vec4 result;

void main()
{
    vec2 chord = sphere_chord(vec3(ray, 1.0), sphere.xyz, sphere.w);
    result = chord.y > 0.0 ? vec4(chord.x - chord.y, -chord.x - chord.y, 1.0, 0.0) : vec4(SF_DEPTH_FAR, SF_DEPTH_FAR, 1.0, 0.0);
}
