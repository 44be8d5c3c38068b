#version 460
#extension GL_GOOGLE_include_directive : require
// Each light's view of the smoke, for the map of its shadow on the scene: just around the particles. One thread a light.
#include "shared/frame.h"
#include "shared/particle.h"
#include "shared/reference.h"
#include "lib/order.glsl"

layout(local_size_x = SF_FRAME_LIGHTS) in;
layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
layout(set = 0, binding = 1, std430) readonly buffer Counts { sf_particle_counts counts; };
layout(set = 0, binding = 2, std430) buffer Views { sf_gpu_light_view views[]; };
layout(push_constant) uniform Push { sf_reference_push push; };

const float TAN_MAX = 3.73; // tan 75 deg: a lamp among the smoke looks at its middle

void main()
{
    uint light = gl_LocalInvocationID.x;
    if (light >= frame.light_count)
        return;
    vec3 low = vec3(float_from_order(counts.bounds_min.x), float_from_order(counts.bounds_min.y), float_from_order(counts.bounds_min.z));
    vec3 high = vec3(float_from_order(counts.bounds_max.x), float_from_order(counts.bounds_max.y), float_from_order(counts.bounds_max.z));
    bool smoke = counts.live > 0u;
    vec3 centre = smoke ? 0.5 * (low + high) : vec3(0.0), reach = smoke ? 0.5 * (high - low) + 1e-6 : vec3(1.0);

    sf_gpu_light source = frame.lights[light];
    bool lamp = uint(source.position.w) != SF_LIGHT_KIND_DIRECTIONAL;
    vec3 forward = lamp ? centre - source.position.xyz : source.direction.xyz;
    float away = length(forward), radius = length(reach);
    forward = away > 1e-5 ? forward / away : vec3(0.0, -1.0, 0.0);
    vec3 side = normalize(cross(forward, abs(forward.y) < 0.99 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0)));
    vec3 up = cross(side, forward), origin = lamp ? source.position.xyz : centre;
    float tangent = away > 1.04 * radius ? min(radius / sqrt(away * away - radius * radius), TAN_MAX) : TAN_MAX;
    vec2 extent = lamp ? vec2(tangent) : vec2(dot(abs(side), reach), dot(abs(up), reach));
    extent *= float(push.shadow_cell) / float(push.shadow_cell - 2u); // an empty texel around all
    views[light].view = mat4(vec4(side.x, up.x, forward.x, 0.0), vec4(side.y, up.y, forward.y, 0.0), vec4(side.z, up.z, forward.z, 0.0),
                             vec4(-dot(side, origin), -dot(up, origin), -dot(forward, origin), 1.0));
    views[light].window = vec4(0.5 / extent.x, -0.5 / extent.y, 0.5, 0.5);
    views[light].info = vec4(lamp ? 1.0 : 0.0, smoke ? 1.0 : 0.0, 0.0, 0.0);
}
