#version 460
#extension GL_GOOGLE_include_directive : require
// The renderer's picture: scene light to sRGB codes, its colour as it is over black.
#include "lib/tone.glsl"
#include "shared/window.h"

layout(constant_id = 0) const uint TONE = TONE_LINEAR;
layout(constant_id = 1) const uint EXACT = 0u; // a texel is a pixel: none is mixed with its neighbours
layout(set = 0, binding = 0) uniform sampler2D picture;
layout(push_constant) uniform Push { sf_window_picture_push push; };
layout(location = 0) out vec4 color;

void main()
{
    vec2 at = gl_FragCoord.xy - push.rect.xy;
    vec3 light;
    if (EXACT != 0u)
        light = texelFetch(picture, clamp(ivec2(floor(at)), ivec2(0), ivec2(push.size.xy) - 1), 0).rgb;
    else
        light = texture(picture, at / push.rect.zw).rgb;
    color = vec4(srgb_encode(tone_map(TONE, light * push.to_clip.z)), 1.0);
}
