// The light that smoke sends to the eye along a pixel's ray. Include it in a compute shader of SF_THICK_TILE^2 threads.
//
// Along the ray the optical depth from the eye is a sum over the tile's spheres, each adding a straight rise between its entry and its exit. It is evaluated
// exactly at the ends of SF_THICK_GUIDE equal slices of near..far; between them it is taken as straight. Empty space stays empty: the depth
// does not rise in it, and no sample ever stands there. Samples stand at shares u_i of the light that reaches the eye, T(s_i) = 1 - u_i (1 - T), where
// Gauss and Legendre's rule has them, so that L = (1 - T) sum_i w_i S(s_i); a lamp's at shares of what it sheds (lamp.glsl); or in the middles of equal
// slices, weighted by the light that each sends. At each the lights' maps say what is before it (light_map.comp).
#ifndef SF_THICK_MARCH_GLSL
#define SF_THICK_MARCH_GLSL

layout(constant_id = 0) const uint STEPS = 8u;
layout(constant_id = 1) const uint LIGHTS = 1u;
layout(constant_id = 2) const uint SCENE_SHADOW = 0u;
layout(constant_id = 3) const uint OCTAVES = 1u;
layout(constant_id = 4) const uint POSITIONAL = 0u; // 1: some light stands somewhere, so that its way and strength change along the ray
layout(constant_id = 5) const uint DETAIL = 0u;
layout(constant_id = 6) const uint PLACEMENT = 0u; // SF_THICK_PLACEMENT_*
layout(constant_id = 7) const uint RAMP = 0u; // 1: particles differ in colour
layout(constant_id = 8) const uint SLICES = 16u; // of a texel of the lights' maps
layout(constant_id = 9) const uint TURN = 8u;
layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
layout(set = 0, binding = 1, std430) readonly buffer Tiles { uint tiles[]; };
// Uniform, though written by a shader: lavapipe reads a uniform once for all lanes, and storage for each.
layout(set = 0, binding = 2, std140) uniform Args { sf_thick_args args; };
layout(set = 0, binding = 3, std140) uniform Views { sf_gpu_light_view views[SF_FRAME_LIGHTS]; };
layout(set = 0, binding = 4) uniform sampler2D light_map;
layout(set = 0, binding = 5, std430) readonly buffer Slices { uint slices[]; };
layout(set = 0, binding = 6) uniform sampler2D atlas;
layout(set = 0, binding = 7) uniform sampler2D shadow_map;
layout(set = 0, binding = 8) uniform sampler2D scene_depth;
layout(set = 0, binding = 10, std430) readonly buffer Spheres { sf_thick_sphere spheres[]; };
layout(set = 0, binding = 11, std430) readonly buffer Ranges { uvec2 ranges[]; };
layout(set = 0, binding = 12, std430) readonly buffer List { uint list[]; };
layout(push_constant) uniform Push { sf_thick_push push; };
#include "thick/spheres.glsl"
#include "thick/view.glsl"
#include "thick/octaves.glsl"
#include "lib/smoke_shadow.glsl"
#include "lib/lighting.glsl"
#include "lib/environment.glsl"
#include "lib/shadow.glsl"

// Optical depth from the eye over near..far.
struct profile {
    float near, far, whole;
    vec4 e0, e1; // ends of SF_THICK_GUIDE = 8 slices, view depths
    vec4 g0, g1; // optical depths there
    vec4 h0, h1; // 1 / their rise in each slice: a division for each sample would cost more
};
profile seen;
float opaque; // 1 - T

// Optical depths at the slices' ends.
void fathom(thick_list touching, thick_ray ray)
{
    seen.g0 = seen.g1 = vec4(0.0);
    for (uint i = 0u; i < touching.count; i += TURN) {
        thick_turn turn = thick_read(touching, i, DETAIL != 0u, false);
        [[unroll]] for (uint k = 0u; k < TURN; k++) {
            float depth;
            thick_chord chord = thick_take(turn, k, ray, DETAIL != 0u, depth);
            float inverse = 1.0 / max(chord.to - chord.from, 1e-9), before = chord.from * inverse;
            seen.g0 += depth * clamp(seen.e0 * inverse - before, 0.0, 1.0);
            seen.g1 += depth * clamp(seen.e1 * inverse - before, 0.0, 1.0);
        }
    }
    seen.h0 = 1.0 / max(seen.g0 - vec4(0.0, seen.g0.xyz), 1e-7);
    seen.h1 = 1.0 / max(seen.g1 - vec4(seen.g0.w, seen.g1.xyz), 1e-7);
}

// View depth at which the optical depth from the eye is `depth`.
float place_of(float depth)
{
    vec4 b0 = vec4(0.0, seen.g0.xyz), b1 = vec4(seen.g0.w, seen.g1.xyz);
    return seen.near + dot(clamp((depth - b0) * seen.h0, 0.0, 1.0), seen.e0 - vec4(seen.near, seen.e0.xyz)) +
           dot(clamp((depth - b1) * seen.h1, 0.0, 1.0), seen.e1 - vec4(seen.e0.w, seen.e1.xyz));
}

// The view depth before which the share `u` of the light is sent that reaches the eye.
float place_seen(float u)
{
    return place_of(opaque > 1e-4 ? -log(1.0 - u * opaque) : u * seen.whole);
}

// Optical depth from the eye to a view depth.
float depth_at(float at)
{
    vec4 f0 = vec4(seen.near, seen.e0.xyz), f1 = vec4(seen.e0.w, seen.e1.xyz);
    return dot(clamp((at - f0) / max(seen.e0 - f0, 1e-7), 0.0, 1.0), seen.g0 - vec4(0.0, seen.g0.xyz)) +
           dot(clamp((at - f1) / max(seen.e1 - f1, 1e-7), 0.0, 1.0), seen.g1 - vec4(seen.g0.w, seen.g1.xyz));
}

void survey(thick_list touching, thick_ray ray)
{
    seen.near = SF_DEPTH_FAR;
    seen.far = -SF_DEPTH_FAR;
    seen.whole = 0.0;
    for (uint i = 0u; i < touching.count; i += TURN) {
        thick_turn turn = thick_read(touching, i, DETAIL != 0u, false);
        [[unroll]] for (uint k = 0u; k < TURN; k++) {
            float depth;
            thick_chord chord = thick_take(turn, k, ray, DETAIL != 0u, depth);
            seen.near = min(seen.near, depth > 0.0 ? chord.from : SF_DEPTH_FAR);
            seen.far = max(seen.far, depth > 0.0 ? chord.to : -SF_DEPTH_FAR);
            seen.whole += depth;
        }
    }
    float step = max(seen.far - seen.near, 0.0) / float(SF_THICK_GUIDE);
    seen.e0 = seen.near + step * vec4(1.0, 2.0, 3.0, 4.0);
    seen.e1 = seen.near + step * vec4(5.0, 6.0, 7.0, 8.0);
    fathom(touching, ray);
    opaque = 1.0 - exp(-seen.whole);
    // Once more, where most of the light comes from.
    float first = place_seen(0.01), last = place_seen(0.985);
    seen.e0 = mix(vec4(first), vec4(last), vec4(0.0, 1.0, 2.0, 3.0) / 6.0);
    seen.e1 = vec4(mix(vec3(first), vec3(last), vec3(4.0, 5.0, 6.0) / 6.0), seen.far);
    fathom(touching, ray);
}

// The ramp's colour of what the eye sees: the spheres' colours weighted by the light that each sends, its transmittance taken as that of
// entry and exit in equal parts.
vec3 tint_seen(thick_list touching, thick_ray ray)
{
    vec4 sum = vec4(0.0, 0.0, 0.0, 1e-20);
    for (uint i = 0u; i < touching.count; i += TURN) {
        thick_turn turn = thick_read(touching, i, DETAIL != 0u, true);
        [[unroll]] for (uint k = 0u; k < TURN; k++) {
            float depth;
            thick_chord chord = thick_take(turn, k, ray, DETAIL != 0u, depth);
            float through = exp(-depth_at(chord.from)) + exp(-depth_at(chord.to));
            sum += depth * through * vec4(subgroupShuffle(turn.tint, k), 1.0);
        }
    }
    return sum.rgb / sum.a;
}

#include "thick/lamp.glsl"

// Samples 0, 1, ... of STEPS: where in 0..1 of the light they stand, and what part of it each is.
struct course {
    float at, part;
    vec2 turn; // of the next sample: cosine and sine
};

// `even`: in the middles of equal parts, else shifted there by `shift`. Otherwise as Gauss and Legendre's rule has them, to what is its limit for many
// samples (within 4e-4 for 8): at (1 - cos a) / 2 with a in equal steps, close together at the ends, where light changes most.
course next_of(course before, uint i, bool even, float shift)
{
    const float step = 3.14159265 / (float(STEPS) + 0.5);
    vec2 turn = i == 0u ? vec2(cos(0.75 * step), sin(0.75 * step)) : before.turn;
    course here;
    here.at = even ? (float(i) + shift) / float(STEPS) : 0.5 - 0.5 * turn.x;
    // The parts sum to 1.
    here.part = even ? 1.0 / float(STEPS) : turn.y * sin(0.5 * step) / (sin(0.5 * step * float(STEPS)) * sin(step * (0.5 * float(STEPS) + 0.25)));
    here.turn = vec2(turn.x * cos(step) - turn.y * sin(step), turn.y * cos(step) + turn.x * sin(step));
    return here;
}

// Sample i: its view depth, and its share of the light.
vec2 sample_at(uint i, course samples)
{
    if (PLACEMENT == SF_THICK_PLACEMENT_UNIFORM) {
        float u = (float(i) + 0.5) / float(STEPS);
        float before = depth_at(mix(seen.near, seen.far, float(i) / float(STEPS))), after = depth_at(mix(seen.near, seen.far, float(i + 1u) / float(STEPS)));
        return vec2(mix(seen.near, seen.far, u), exp(-before) - exp(-after));
    }
    return vec2(place_seen(samples.at), opaque * samples.part);
}

// Optical depth between a light and a point, by the light's map. `moved`: part of a texel by which the look-up is shifted.
float depth_to_light(vec3 at, vec2 shift, uint left)
{
    float size = float(push.cell_size);
    vec2 moved = at.xy + shift / size;
    vec2 inside = clamp(moved, 0.0, 0.99999);
    uvec2 texel = uvec2(inside * size) + uvec2(left, 0u);
    vec2 ends = texelFetch(light_map, ivec2(texel), 0).rg * vec2(1.0, -1.0);
    float slice = clamp((at.z - ends.x) / max(ends.y - ends.x, 1e-6), 0.0, 1.0) * float(SLICES);
    float number = min(floor(slice), float(SLICES - 1u));
    vec2 pair = unpackHalf2x16(slices[(texel.y * push.cell_size * push.cells + texel.x) * SLICES + uint(number)]);
    return inside == moved && ends.y > ends.x ? mix(pair.x, pair.y, slice - number) : 0.0;
}

// What one light adds, before albedo: the sum of share p E T over the samples; of a probe over those up to a view depth.
vec3 scattered_from(uint index, vec3 ray, vec3 direction, float shift, uint steps, float until)
{
    sf_gpu_light light = frame.lights[index];
    sf_gpu_light_view view = views[index];
    bool directional = uint(light.position.w) == SF_LIGHT_KIND_DIRECTIONAL;
    vec3 to_light;
    vec3 irradiance = light_irradiance(light, frame.eye.xyz, to_light);
    vec4 phases = octave_phases(dot(direction, to_light)); // of the ways of travel, -to_light in and -direction out
    // Both maps are linear in homogeneous coordinates: transform the ray, not each sample.
    vec3 q_eye = (view.view * vec4(frame.eye.xyz, 1.0)).xyz, q_ray = mat3(view.view) * ray;
    vec4 s_eye = light.world_to_map * vec4(frame.eye.xyz, 1.0), s_ray = light.world_to_map * vec4(ray, 0.0);
    vec4 info = light.shadow;
    uint left = index * push.cell_size;
    vec3 sum = vec3(0.0);
    bool lamp_like = POSITIONAL != 0u && PLACEMENT != SF_THICK_PLACEMENT_UNIFORM && !directional;
    // A spot's light ends within the smoke: equal parts meet the edges better.
    bool even = PLACEMENT != SF_THICK_PLACEMENT_EQUAL || uint(light.position.w) == SF_LIGHT_KIND_SPOT;
    course samples;
    lamp_share lamp;
    if (lamp_like)
        lamp = lamp_shares(light.position.xyz - frame.eye.xyz, ray);
    // A pixel without smoke takes no step: lavapipe leaves a loop when no lane is in it, where it would run the body of an `if`.
    for (uint i = 0u; i < steps; i++) {
        samples = next_of(samples, i, even, shift);
        vec2 at = lamp_like ? lamp_place(lamp, samples.at) * vec2(1.0, samples.part) : sample_at(i, samples);
        if (POSITIONAL != 0u && !directional) {
            irradiance = light_irradiance(light, frame.eye.xyz + at.x * ray, to_light);
            phases = octave_phases(dot(direction, to_light));
        }
        vec3 place = light_map_of(POSITIONAL != 0u && !directional, q_eye + at.x * q_ray, view.window);
        // Each sample looks up the map at another place within the texel: together they filter it, and the texels' edges do not show as lines.
        float depth = view.info.y > 0.5 ? depth_to_light(place, fract(float(i) * vec2(0.7548777, 0.5698403)) - 0.5, left) : 0.0; // Roberts's R2 sequence
        float lit = at.y * dot(phases, octave_transmittances(depth));
        if (SCENE_SHADOW != 0u)
            lit *= info.x > 0.0 ? shadow_share(POSITIONAL != 0u && !directional, s_eye + at.x * s_ray, info.y, info.z, info.w) : 1.0;
#ifdef PROBE_BINDING
        lit = at.x <= until ? lit : 0.0;
#endif
        sum += lit * irradiance;
    }
    return sum;
}

// A pixel's ray, with unit view depth, and the spheres that it may meet.
struct looked {
    vec3 ray;
    thick_ray sight;
    thick_list touching;
};

// `range`: of the pixel's tile. Sets `seen` and `opaque`.
looked look(ivec2 pixel, uvec2 range)
{
    vec2 ndc = smoke_ndc(vec2(pixel));
    float cut = texelFetch(scene_depth, min(pixel, ivec2(push.width, push.height) - 1), 0).r;
    looked at;
    at.ray = world_ray(ndc);
    at.sight = thick_sight(view_ray(ndc).xy, frame.eye.w, cut);
    thick_live = args.dispatch_tiles.w;
    at.touching = thick_keep(range, at.sight.way, at.sight.way);
    survey(at.touching, at.sight);
    return at;
}

// What the ray's samples send to the eye (of a probe those up to the view depth `until`), which hide `part` of what is behind them.
vec3 sent(looked at, ivec2 pixel, uint steps, float until, float part)
{
    vec3 direction = normalize(at.ray);
    float shift = 0.5;
    if (PLACEMENT == SF_THICK_PLACEMENT_JITTERED) // interleaved gradient noise (Jimenez 2014), turned by the golden ratio from frame to frame
        shift = fract(52.9829189 * fract(dot(vec2(pixel), vec2(0.06711056, 0.00583715))) + 0.61803399 * float(frame.frame_number & 1023u));
    vec3 scattered = vec3(0.0);
    for (uint i = 0u; i < LIGHTS; i++)
        scattered += scattered_from(i, at.ray, direction, shift, steps, until);

    vec3 outward = frame.eye.xyz + place_seen(0.5) * at.ray - args.centre.xyz; // L 3.3.5
    vec3 ambient = environment_blurred(outward / max(length(outward), 1e-6)) * push.ambient;
    vec3 albedo = frame.albedo.rgb;
    if (RAMP != 0u)
        albedo *= tint_seen(at.touching, at.sight);
    return albedo * (scattered + part * ambient) + part * frame.emission.rgb;
}

#endif
