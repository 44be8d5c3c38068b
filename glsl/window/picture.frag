#version 460
#extension GL_GOOGLE_include_directive : require
// The renderer's picture: scene light to sRGB codes, its colour as it is over black.
#include "lib/tone.glsl"

layout(constant_id = 0) const uint TONE = TONE_LINEAR;
layout(constant_id = 1) const uint EXACT = 0u; // a texel is a pixel: none is mixed with its neighbours
layout(set = 0, binding = 0) uniform sampler2D picture;
layout(location = 0) in vec2 at;         // in texels when EXACT, else 0 to 1
layout(location = 1) flat in float gain; // of the exposure
layout(location = 0) out vec4 color;

void main()
{
    vec3 light;
    if (EXACT != 0u)
        light = texelFetch(picture, ivec2(at), 0).rgb; // pixels' centres: never on an edge
    else
        light = texture(picture, at).rgb;
    color = vec4(srgb_encode(tone_map(TONE, light * gain)), 1.0);
}
