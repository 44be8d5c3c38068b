// A plane, where no other is nearer.
#ifndef SF_SCENE_PLANES_FRAGMENT_GLSL
#define SF_SCENE_PLANES_FRAGMENT_GLSL
#include "scene/shade.glsl"
#include "scene/planes.glsl"

NEAR_LIGHTS(in)
layout(location = 0) flat in uint plane;
layout(location = 1) flat in vec4 forward;
layout(location = 2) flat in vec4 right;
layout(location = 3) flat in vec4 up;
layout(location = 4) flat in vec4 slope;
layout(location = 5) flat in vec4 normal;
layout(location = 6) flat in vec4 albedo;
layout(location = 7) flat in vec4 albedo2;
layout(location = 8) flat in vec4 ambient;
layout(location = 9) noperspective in vec2 square_ray;
layout(location = 10) flat in vec4 square_eye;
layout(location = 11) flat in vec4 square_pixel;
#include "scene/targets.glsl"

// Is another plane nearer? All are judged by one formula, or their seams would have holes.
bool hidden(vec3 ray)
{
    float own = SF_DEPTH_FAR, nearest = SF_DEPTH_FAR;
    for (uint i = 0u; i < PLANES; i++) {
        float t = plane_depth(i, ray);
        nearest = min(nearest, t);
        own = i == plane ? t : own;
    }
    return nearest < own;
}

// The checker's share of the first albedo at squares `at`, averaged over the box (along the checker's own axes) that holds the pixel's footprint:
// the product of two square waves (1 on even squares, -1 on odd), each averaged over the box's width.
float checker(vec2 at, float inverse)
{
    vec2 turn = square_ray * inverse; // a pixel to the side changes the depth as well
    vec2 right_step = square_pixel.xy - turn * square_eye.z, up_step = square_pixel.zw - turn * square_eye.w;
    vec2 width = max(depth * (abs(right_step) + abs(up_step)), 1e-3);
    vec2 low = abs(fract(0.5 * at - 0.25 * width) - 0.5), high = abs(fract(0.5 * at + 0.25 * width) - 0.5);
    vec2 rise = low - high;
    return albedo.w > 0.0 ? 0.5 + 2.0 * rise.x * rise.y / (width.x * width.y) : 1.0;
}

void main()
{
    vec2 ndc = pixel_ndc(vec2(forward.w, right.w), gl_FragCoord.xy);
    vec3 ray = forward.xyz + ndc.x * right.xyz + ndc.y * up.xyz;
    float nearer = slope.z + ndc.x * slope.x + ndc.y * slope.y;
    float inverse = 1.0 / nearer;
    depth = slope.w * inverse;
    if (!(nearer > 0.0 && depth >= up.w && depth < SF_DEPTH_FAR) || PLANES > 1u && hidden(ray))
        discard;

    vec3 light = ambient.rgb;
    [[unroll]] for (uint i = 0u; i < NEAR; i++) {
        if (i >= LIGHTS)
            break;
        sf_gpu_light source;
        source.position = near_position[i];
        source.direction = near_direction[i];
        source.color = near_color[i];
        vec3 to_light;
        vec3 irradiance = light_irradiance_of(light_kind(i), source, depth * ray, to_light);
        float share = max(dot(normal.xyz, to_light), 0.0) * INVERSE_PI;
        share *= object_share(i, depth * map_ray[i] + map_eye[i], normal.w);
        share *= smoke_share(i, depth * smoke_ray[i] + smoke_eye[i].xyz, window[i]);
        light += irradiance * share;
    }
    if (LIGHTS > NEAR)
        light += far_lights(NEAR, frame.eye.xyz + depth * ray, normal.xyz);
    vec3 reflected = CHECKERED != 0u ? mix(albedo2.rgb, albedo.rgb, checker(square_eye.xy + depth * square_ray, inverse)) : albedo.rgb;
    color = vec4(reflected * light, 1.0);
}

#endif
