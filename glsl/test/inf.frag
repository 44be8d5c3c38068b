#version 460
// In place of scene/sky.frag: black sky with one pixel of infinite brightness.

layout(location = 0) out vec4 color;
layout(location = 1) out float depth;

void main()
{
    bool here = ivec2(gl_FragCoord.xy) == ivec2(5, 7);
    color = vec4(0.0, here ? uintBitsToFloat(0x7f800000u) : 0.0, 0.0, 1.0);
    depth = 1.0e6;
}
