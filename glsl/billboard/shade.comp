#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_EXT_control_flow_attributes : require
// Particles in the order in which they are drawn, each lit at one point: from every light what smoke and scene let through, and what comes from all
// around. The point is on the way from the eye to the centre, where half of the light is sent that the eye gets of the particle: in its middle when it is thin,
// near its front when it is dense. The way to a light is exact: the sum of the chords that it cuts from all spheres, up to SF_BILLBOARD_OCCLUDERS of them; of more, every n-th stands
// for n.
#include "shared/frame.h"
#include "shared/particle.h"
#include "shared/billboard.h"
#include "shared/sim.h"
#include "shared/thick.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint LIGHTS = 1u;
layout(constant_id = 1) const uint SELF_SHADOW = 1u;
layout(constant_id = 2) const uint SCENE_SHADOW = 0u;
layout(constant_id = 3) const uint RAMP = 0u;
layout(constant_id = 4) const uint TURN = 8u; // particles that a subgroup reads together
layout(constant_id = 5) const uint OCTAVES = 1u;
layout(constant_id = 6) const uint OTHERS = 0u; // 1: a particle does not dim its own light, and all octaves arrive at it
layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
layout(set = 0, binding = 1, std430) readonly buffer Particles { sf_particle particles[]; };
layout(set = 0, binding = 2, std430) readonly buffer Counts { sf_particle_counts counts; };
layout(set = 0, binding = 3, std430) readonly buffer Pairs { uvec2 pairs[]; };
layout(set = 0, binding = 4) uniform sampler2D shadow_map;
layout(set = 0, binding = 5, std140) uniform Args { sf_thick_args args; };
layout(set = 0, binding = 6, std430) writeonly buffer Billboards { sf_billboard billboards[]; };
layout(push_constant) uniform Push { sf_billboard_push push; };
#include "lib/environment.glsl"
#include "lib/hash.glsl"
#include "lib/lighting.glsl"
#include "lib/shadow.glsl"
#include "thick/octaves.glsl"

const uint NONE = 0xffffffffu;

// Optical depth of all particles but number `own` from `from` along the unit vector `way` as far as `reach`. All lanes of a subgroup walk together.
float depth_along(vec3 from, vec3 way, float reach, uint own)
{
    uint live = counts.live;
    uint stride = max((live + SF_BILLBOARD_OCCLUDERS - 1u) / SF_BILLBOARD_OCCLUDERS, 1u);
    float sum = 0.0;
    for (uint i = 0u; i < live; i += TURN * stride) {
        uint number = i + (gl_SubgroupInvocationID & (TURN - 1u)) * stride;
        sf_particle other = particles[min(number, live - 1u)];
        vec4 ball = vec4(other.x, other.y, other.z, other.radius);
        float extinction = number < live ? other.extinction : 0.0;
        [[unroll]] for (uint k = 0u; k < TURN; k++) {
            vec4 sphere = subgroupShuffle(ball, k);
            vec3 apart = sphere.xyz - from;
            float along = dot(apart, way);
            vec3 miss = apart - along * way;
            float reached = sqrt(max(sphere.w * sphere.w - dot(miss, miss), 0.0));
            float matter = subgroupShuffle(extinction, k);
            if (OTHERS != 0u)
                matter = i + k * stride == own ? 0.0 : matter;
            sum += matter * max(min(along + reached, reach) - max(along - reached, 0.0), 0.0);
        }
    }
    return sum * float(stride) * push.density;
}

const vec3 LUMINANCE = vec3(0.2126, 0.7152, 0.0722); // Rec. 709

// How far before a sphere's centre half of its light is sent, m. `extinction` 1/m.
float before_centre(float radius, float extinction)
{
    float across = 2.0 * radius * extinction;
    return across > 1e-2 ? radius + log(0.5 + 0.5 * exp(-across)) / extinction : 0.0;
}

void main()
{
    uint slot = gl_GlobalInvocationID.x, live = counts.live;
    uint own = pairs[min(slot, live - 1u)].y;
    sf_particle p = particles[own];
    vec3 centre = vec3(p.x, p.y, p.z);
    vec3 view = (frame.world_to_view * vec4(centre, 1.0)).xyz * vec3(1.0, 1.0, -1.0);
    float away = length(centre - frame.eye.xyz);
    vec3 direction = away > 0.0 ? (centre - frame.eye.xyz) / away : frame.forward.xyz;
    // Other particles in the near half count as if they were spread over all of it.
    float dense = max(p.extinction * push.density, SELF_SHADOW != 0u ? depth_along(centre, -direction, p.radius, NONE) / p.radius : 0.0);
    vec3 at = centre - min(before_centre(p.radius, dense), away) * direction;
    float lit[SF_FRAME_LIGHTS] = float[](1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0);
    vec3 scattered = vec3(0.0), pull = vec3(0.0);
    for (uint i = 0u; i < LIGHTS; i++) {
        sf_gpu_light light = frame.lights[i];
        bool directional = uint(light.position.w) == SF_LIGHT_KIND_DIRECTIONAL;
        vec3 to_light;
        vec3 irradiance = light_irradiance(light, at, to_light);
        float depth = 0.0;
        if (SELF_SHADOW != 0u)
            depth = depth_along(at, to_light, directional ? SF_DEPTH_FAR : distance(light.position.xyz, at), own);
        float share = SCENE_SHADOW != 0u ? scene_visibility(i, at) : 1.0;
        lit[i] = share * (OTHERS != 0u ? dot(octave_strengths(), octave_transmittances(depth)) : exp(-depth));
        vec3 more = share * dot(octave_phases(dot(direction, to_light)), octave_transmittances(depth)) * irradiance;
        scattered += more;
        pull += dot(LUMINANCE * frame.albedo.rgb, more) * to_light;
    }
    vec3 outward = at - args.centre.xyz;
    vec3 ambient = environment_blurred(outward / max(length(outward), 1e-6)) * push.ambient;
    vec3 albedo = frame.albedo.rgb;
    float age = p.lifetime > 0.0 ? clamp(p.age / p.lifetime, 0.0, 1.0) : 0.0;
    if (RAMP != 0u)
        albedo *= frame.ramp[int(age * float(SF_FRAME_RAMP - 1) + 0.5)].rgb;
    float tint = dot(LUMINANCE, albedo) / max(dot(LUMINANCE, frame.albedo.rgb), 1e-6); // of the ramp

    sf_billboard drawn;
    drawn.sphere = vec4(view, p.radius);
    drawn.light = vec4(albedo * (scattered + ambient) + frame.emission.rgb, view.z + p.radius > frame.eye.w ? p.extinction * push.density : 0.0);
    drawn.tile = vec4(cos(p.rotation), sin(p.rotation), float(p.look & 255u), 1.0 - age);
    drawn.albedo = vec4(albedo, push.near_fade > 0.0 ? clamp((view.z - frame.eye.w) / (push.near_fade * p.radius), 0.0, 1.0) : 1.0);
    drawn.lit[0] = vec4(lit[0], lit[1], lit[2], lit[3]);
    drawn.lit[1] = vec4(lit[4], lit[5], lit[6], lit[7]);
    pull = (frame.world_to_view * vec4(pull, 0.0)).xyz * vec3(1.0, 1.0, -1.0);
    drawn.toward = vec4(pull * (tint / max(dot(LUMINANCE, drawn.light.rgb), 1e-20)), sf_random_float(frame.seed, p.id, SF_RANDOM_LOOK));
    if (slot < live)
        billboards[slot] = drawn;
}
