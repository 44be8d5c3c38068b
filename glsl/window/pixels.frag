#version 460
#extension GL_GOOGLE_include_directive : require
// The host's own pixels, sRGB codes already, each a sharp rectangle however large it is drawn. Their alpha is not looked at.
#include "shared/window.h"

layout(set = 0, binding = 0, std430) readonly buffer Pixels { uint pixels[]; };
layout(push_constant) uniform Push { sf_window_picture_push push; };
layout(location = 0) out vec4 color;

void main()
{
    vec2 at = (gl_FragCoord.xy - push.rect.xy) * (vec2(push.size.xy) / push.rect.zw);
    ivec2 texel = clamp(ivec2(floor(at)), ivec2(0), ivec2(push.size.xy) - 1);
    color = vec4(unpackUnorm4x8(pixels[uint(texel.y) * push.size.x + uint(texel.x)]).rgb, 1.0);
}
