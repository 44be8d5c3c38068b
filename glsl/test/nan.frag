#version 460
// In place of scene/sky.frag: black sky, and in one pixel a depth that is no number.

layout(location = 0) out vec4 color;
layout(location = 1) out float depth;

void main()
{
    bool here = ivec2(gl_FragCoord.xy) == ivec2(5, 7);
    color = vec4(0.0, 0.0, 0.0, 1.0);
    depth = here ? uintBitsToFloat(0xffc00000u) : 1.0e6;
}
