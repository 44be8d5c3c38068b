#version 460
// The overlay's triangles: straight alpha times the font's coverage, premultiplied for blending. Pixels whose centre lies outside of the clip
// rectangle are not drawn.
layout(set = 0, binding = 3) uniform sampler2D font;
layout(location = 0) flat in vec4 clip;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 color;
layout(location = 0) out vec4 result;

void main()
{
    if (!(all(greaterThanEqual(gl_FragCoord.xy, clip.xy)) && all(lessThan(gl_FragCoord.xy, clip.zw))))
        discard;
    float alpha = color.a * texture(font, uv).r;
    result = vec4(color.rgb * alpha, alpha);
}
