// The light that one interval of smoke sends to the eye: the interval near..far of a smoke pixel is marched; at each sample the light-view interval
// gives the optical depth to the light (L pass 10).
//
// The optical depth of the pixel is spread evenly over the interval. Samples stand at equal shares of the light that reaches the eye:
// with T = exp(-tau s) over s in 0..1, s_i = -ln(1 - u_i (1 - exp(-tau))) / tau, so that L = (1 - exp(-tau)) mean_i S(s_i).
#ifndef SF_LARSSON_MARCH_GLSL
#define SF_LARSSON_MARCH_GLSL

layout(constant_id = 0) const uint STEPS = 8u;
layout(constant_id = 1) const uint LIGHTS = 1u;
layout(constant_id = 2) const uint SCENE_SHADOW = 0u;
layout(constant_id = 3) const uint OCTAVES = 1u;
layout(constant_id = 4) const uint POSITIONAL = 0u; // 1: some light stands somewhere, so that its way and strength change along the ray
layout(constant_id = 5) const uint SOFT = 0u; // 1: fade towards the scene beyond the exact cut
layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
// Uniform, though written by a shader: lavapipe reads a uniform once for all lanes, and storage for each.
layout(set = 0, binding = 2, std140) uniform Args { sf_thick_args args; };
layout(set = 0, binding = 3, std140) uniform Views { sf_gpu_light_view views[SF_FRAME_LIGHTS]; };
layout(set = 0, binding = 4) uniform sampler2D raw;
layout(set = 0, binding = 5) uniform sampler2D blurred;
layout(set = 0, binding = 6) uniform sampler2D light_map;
layout(set = 0, binding = 7) uniform sampler2D shadow_map;
layout(set = 0, binding = 8) uniform sampler2D scene_depth;
layout(push_constant) uniform Push { sf_thick_push push; };
#include "thick/view.glsl"
#include "lib/smoke_shadow.glsl"
#include "lib/lighting.glsl"
#include "lib/environment.glsl"
#include "thick/octaves.glsl"
#include "lib/shadow.glsl"

// What one light adds along near..far (world points), before albedo: the first `steps` samples of the mean of p E T.
vec3 scattered_from(uint index, vec3 near, vec3 far, vec3 direction, float tau, float opaque, uint steps)
{
    sf_gpu_light light = frame.lights[index];
    sf_gpu_light_view view = views[index];
    vec3 to_light;
    vec3 irradiance = light_irradiance(light, near, to_light);
    bool directional = uint(light.position.w) == SF_LIGHT_KIND_DIRECTIONAL;
    vec4 phases = octave_phases(dot(direction, to_light)); // of the ways of travel, -to_light in and -direction out
    vec3 q_near = (view.view * vec4(near, 1.0)).xyz, q_far = (view.view * vec4(far, 1.0)).xyz;
    // Both maps are linear in homogeneous coordinates: transform the ends, not each sample.
    vec4 s_near = light.world_to_map * vec4(near, 1.0), s_far = light.world_to_map * vec4(far, 1.0);
    vec4 info = light.shadow;
    bool perspective = view.info.x > 0.5;
    float size = float(push.cell_size);
    float left = float(index) * size;
    vec3 sum = vec3(0.0);
    // A pixel without smoke takes no step: lavapipe leaves a loop when no lane is in it, where it would run the body of an `if`.
    for (uint i = 0u; i < steps; i++) {
        float u = (float(i) + 0.5) / float(STEPS);
        float s = opaque > 1e-4 ? -log(1.0 - u * opaque) / tau : u;
        vec3 world = mix(near, far, s);
        if (POSITIONAL != 0u && !directional) {
            irradiance = light_irradiance(light, world, to_light);
            phases = octave_phases(dot(direction, to_light));
        }
        vec3 at = light_map_of(POSITIONAL != 0u && perspective, mix(q_near, q_far, s), view.window);
        // Each sample looks up the map at another place within the texel: together they filter it, and the texels' edges do not show as lines.
        vec2 moved = at.xy + (fract(float(i) * vec2(0.7548777, 0.5698403)) - 0.5) / size; // Roberts's R2 sequence
        vec2 inside = clamp(moved, 0.0, 0.99999);
        vec4 texel = texelFetch(light_map, ivec2(inside * size + vec2(left, 0.0)), 0);
        float depth = inside == moved ? light_map_depth(texel, at.z) : 0.0;
        float lit = dot(phases, octave_transmittances(depth));
        if (SCENE_SHADOW != 0u)
            lit *= info.x > 0.0 ? shadow_share(POSITIONAL != 0u && !directional, mix(s_near, s_far, s), info.y, info.z, info.w) : 1.0;
        sum += lit * irradiance;
    }
    return sum / float(STEPS);
}

// A smoke pixel's interval, m of view depth, and what it holds.
struct interval {
    float near, far, tau, opaque, life;
    uint steps; // samples in it: none where there is no smoke
};

interval interval_of(ivec2 pixel)
{
    vec4 sharp = texelFetch(raw, pixel, 0);
    vec4 soft = texelFetch(blurred, pixel, 0);
    interval smoke;
    smoke.tau = mix(sharp.a, soft.a, push.density_blur);
    smoke.near = max(soft.r, frame.eye.w);
    smoke.far = max(soft.g, smoke.near);
    if (SOFT != 0u)
        smoke.tau *= clamp((texelFetch(scene_depth, pixel, 0).r - smoke.near) / push.soft, 0.0, 1.0);
    smoke.opaque = 1.0 - exp(-smoke.tau);
    smoke.life = soft.b;
    smoke.steps = smoke.tau > 0.0 && smoke.near < SF_DEPTH_FAR ? STEPS : 0u;
    return smoke;
}

// What the first `steps` of its samples send to the eye, which are `part` of them all.
vec3 sent(interval smoke, ivec2 pixel, uint steps, float part)
{
    vec3 ray = world_ray(smoke_ndc(vec2(pixel)));
    vec3 direction = normalize(ray);
    vec3 scattered = vec3(0.0);
    for (uint i = 0u; i < LIGHTS; i++)
        scattered +=
            scattered_from(i, frame.eye.xyz + smoke.near * ray, frame.eye.xyz + smoke.far * ray, direction, smoke.tau, smoke.opaque, steps);

    vec3 tint = frame.ramp[clamp(int((1.0 - smoke.life) * float(SF_FRAME_RAMP - 1) + 0.5), 0, SF_FRAME_RAMP - 1)].rgb;
    vec3 outward = frame.eye.xyz + smoke.near * ray - args.centre.xyz; // L 3.3.5
    vec3 ambient = environment_blurred(outward / max(length(outward), 1e-6)) * push.ambient;
    return smoke.opaque * (frame.albedo.rgb * tint * (scattered + part * ambient) + part * frame.emission.rgb);
}

#endif
