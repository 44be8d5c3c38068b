#version 460
#extension GL_GOOGLE_include_directive : require
// Which ball the ray meets first, by the depth test: shading comes later, once for each pixel and not for every layer.
#include "lib/sphere.glsl"

layout(location = 0) in vec2 ray;
layout(location = 1) flat in vec4 sphere;
layout(location = 2) flat in vec2 own;
layout(location = 0) out float number;

void main()
{
    vec2 chord = sphere_chord(vec3(ray, 1.0), sphere.xyz, sphere.w);
    bool hit = chord.y > 0.0;
    // A miss is as far as nothing.
    gl_FragDepth = hit ? clamp(own.x / (chord.x - chord.y), 0.0, 1.0) : 0.0;
    number = hit ? own.y : -1.0;
}
