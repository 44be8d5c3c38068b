#version 460
#extension GL_GOOGLE_include_directive : require
// As picture.frag, with a second picture of the same size to the right of a line.
#include "lib/tone.glsl"
#include "shared/window.h"

layout(constant_id = 0) const uint TONE = TONE_LINEAR;
layout(constant_id = 1) const uint EXACT = 0u; // a texel is a pixel: none is mixed with its neighbours
layout(set = 0, binding = 0) uniform sampler2D picture;
layout(set = 0, binding = 1) uniform sampler2D beside;
layout(push_constant) uniform Push { sf_window_picture_push push; };
layout(location = 0) in vec2 at;         // in texels when EXACT, else 0 to 1
layout(location = 1) flat in float gain; // of the exposure
layout(location = 0) out vec4 color;

void main()
{
    bool left = gl_FragCoord.x < push.to_clip.w;
    vec3 light;
    if (EXACT != 0u)
        light = (left ? texelFetch(picture, ivec2(at), 0) : texelFetch(beside, ivec2(at), 0)).rgb;
    else
        light = (left ? textureLod(picture, at, 0.0) : textureLod(beside, at, 0.0)).rgb;
    color = vec4(srgb_encode(tone_map(TONE, light * gain)), 1.0);
}
