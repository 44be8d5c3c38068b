#version 460
// Shows the depth that the pass tests against.
layout(set = 0, binding = 0) uniform sampler2D depth;
layout(location = 0) flat in vec4 color;
layout(location = 0) out vec4 target;

void main()
{
    target = vec4(texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r, 0.0, 0.0, color.a * 0.0);
}
