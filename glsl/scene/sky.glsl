// What the sky's vertices hand to the fragments, and its radiance. Include it after scene/shade.glsl.
#ifndef SF_SCENE_SKY_GLSL
#define SF_SCENE_SKY_GLSL

layout(set = 0, binding = 5) uniform sampler2D environment;
layout(location = 0) flat in vec4 forward;
layout(location = 1) flat in vec4 right;
layout(location = 2) flat in vec4 up;
layout(location = 3) flat in vec4 zenith;
layout(location = 4) flat in vec4 horizon;
layout(location = 5) flat in vec4 ground;

// With the background's alpha.
vec4 sky_color()
{
    vec2 ndc = pixel_ndc(vec2(forward.w, right.w), gl_FragCoord.xy);
    vec3 ray = forward.xyz + ndc.x * right.xyz + ndc.y * up.xyz;
    vec4 color = vec4(horizon.rgb, up.w);
    if (ENVIRONMENT == 0u)
        color.rgb = environment_gradient(ray, zenith.rgb, horizon.rgb, ground.rgb);
    if (ENVIRONMENT == 2u)
        color.rgb = zenith.w * textureLod(environment, environment_uv(ray, vec2(horizon.w, ground.w)), 0.0).rgb;
    return color;
}

#endif
