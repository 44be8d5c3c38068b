#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Lit smoke with scattering through its height field (METHODS B10; Reis 2008, "More realistic scattering"): from the pixel's place on the field a ray goes to
// each light, and what matter it meets dims that light. A tile's matter fills |z| < height: the far half of a puff is taken to be as the near one.
#include "lit/puff.glsl"
#include "shared/particle.h"

layout(constant_id = 5) const uint FACING = 0u; // 1: more steps where the puff faces the eye, as equation 5.2.5 is printed
layout(set = 0, binding = 7, std430) readonly buffer Counts { sf_particle_counts counts; };

// Steps of each ray: push.more[1].x at least, push.more[1].y at most (5.2.5).
uint steps_at(lit_puff puff)
{
    float facing = clamp(dot(puff.normal, puff.to_eye), 0.0, 1.0);
    uint steps = uint(mix(push.more[1].x, push.more[1].y, FACING != 0u ? facing : 1.0 - facing) + 0.5);
    return puff.color.a > 0.0 ? steps : 0u;
}

// Length of matter, in radii, on the way from the puff's place to the tile's border.
float matter_along(lit_puff puff, vec3 way, uint steps)
{
    vec3 from = vec3(clamp(puff.at.xy, -1.0, 1.0), puff.height);
    vec3 reach = (1.0 - from * sign(way)) / max(abs(way), 1e-6); // to the sides of the box round the field
    float step_length = min(min(reach.x, reach.y), reach.z) / float(max(steps, 1u));
    float rise = max(abs(way.z) * step_length, 1e-3), matter = 0.0;
    int side = textureSize(atlas_shape, 0).x;
    for (uint i = 0u; i < steps; i++) {
        vec3 at = from + (float(i) + 0.5) * step_length * way;
        ivec2 texel = clamp(ivec2((0.5 + 0.5 * at.xy * vec2(1.0, -1.0)) * float(side)), 0, side - 1);
        float height = texelFetch(atlas_shape, ivec3(texel, int(puff.at.z)), 0).w;
        // The part of the step that lies within: exact where the field is level.
        float inside = min(height, abs(at.z) + 0.5 * rise) - max(-height, abs(at.z) - 0.5 * rise);
        matter += clamp(inside / rise, 0.0, 1.0);
    }
    return matter * step_length;
}

void main()
{
    lit_puff puff = read_puff();
    lit_sum sum = lit_sum(vec3(0.0), vec2(0.0));
    uint steps = steps_at(puff);
    float absorption = push.more[0].y * sphere.w * light.w;
    float damping = 1.0 / (1.0 + push.more[0].z * float(counts.live));
    [[unroll]] for (uint i = 0u; i < LIGHTS; i++) {
        vec3 to_light;
        vec3 irradiance = irradiance_of(i, puff.place, to_light);
        vec3 way = vec3(into_tile(vec2(dot(to_light, puff.right), dot(to_light, puff.up))), -dot(to_light, frame.forward.xyz));
        float through = exp(-absorption * matter_along(puff, way, steps));
        add_light(sum, i, irradiance, damping * through * (wrapped(dot(puff.normal, to_light)) + from_behind(puff.to_eye, to_light)));
    }
    result = lit_result(puff, sum);
}
