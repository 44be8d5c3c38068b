#version 460
#extension GL_GOOGLE_include_directive : require
// Fits each light's view of the smoke to the bounds of the particles, and makes the light pass's draw arguments. One thread a light.
#include "shared/frame.h"
#include "shared/particle.h"
#include "shared/thick.h"
#include "lib/order.glsl"

layout(local_size_x = SF_FRAME_LIGHTS) in;
layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
layout(set = 0, binding = 1, std430) readonly buffer Counts { sf_particle_counts counts; };
layout(set = 0, binding = 2, std430) writeonly buffer Views { sf_gpu_light_view views[]; };
layout(set = 0, binding = 3, std430) writeonly buffer Args { sf_thick_args args; };
layout(push_constant) uniform Push { sf_thick_push push; };

layout(constant_id = 0) const uint AROUND = 0u; // 1: a light close to the smoke, or in it, looks all around; 0: it looks at its middle
const float TAN_MAX = AROUND != 0u ? 1.73 : 3.73; // 60 deg, 75 deg

// Rounded up to one of 8 sizes an octave, so that the map's texels keep their size while smoke grows a little.
float snapped(float extent)
{
    return exp2(ceil(log2(max(extent, 1e-4)) * 8.0) / 8.0);
}

void main()
{
    uint light = gl_LocalInvocationID.x;
    bool smoke = counts.live > 0u;
    vec3 low = smoke ? vec3(float_from_order(counts.bounds_min.x), float_from_order(counts.bounds_min.y), float_from_order(counts.bounds_min.z)) : vec3(0.0);
    vec3 high = smoke ? vec3(float_from_order(counts.bounds_max.x), float_from_order(counts.bounds_max.y), float_from_order(counts.bounds_max.z)) : vec3(0.0);
    vec3 centre = 0.5 * (low + high);
    vec3 reach = 0.5 * (high - low);
    if (light == 0u) {
        args.draw_light = uvec4(4u, counts.live * push.cells, 0u, 0u);
        args.centre = vec4(centre, length(reach));
    }
    if (light >= push.cells)
        return;

    sf_gpu_light source = frame.lights[light];
    bool perspective = uint(source.position.w) != SF_LIGHT_KIND_DIRECTIONAL;
    vec3 forward = perspective ? centre - source.position.xyz : source.direction.xyz;
    float distance = length(forward);
    forward = distance > 1e-5 ? forward / distance : vec3(0.0, -1.0, 0.0);
    vec3 side = normalize(cross(forward, abs(forward.y) < 0.99 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0)));
    vec3 up = cross(side, forward);
    vec3 origin = perspective ? source.position.xyz : centre;
    float texels = float(push.cell_size);
    float usable = (texels - 2.0 * push.light_margin) / texels;
    vec2 window;
    float kind = 0.0, texel;
    if (perspective) {
        float radius = length(reach);
        float tangent = distance > radius * 1.04 ? radius / sqrt(distance * distance - radius * radius) : TAN_MAX;
        tangent = snapped(tangent / usable);
        bool around = AROUND != 0u && tangent > TAN_MAX;
        tangent = min(tangent, TAN_MAX);
        window = vec2(around ? 0.0 : 0.5 / tangent);
        kind = around ? 2.0 : 1.0;
        texel = (around ? 3.54 : 2.0 * tangent) * distance / texels; // sqrt(4 pi)
    } else {
        vec2 extent = vec2(dot(abs(side), reach), dot(abs(up), reach));
        extent = vec2(snapped(extent.x / usable), snapped(extent.y / usable));
        // The origin moves in whole texels of the world, or shadows would shimmer as the smoke grows.
        vec2 grid = 2.0 * extent / texels;
        vec2 at = vec2(dot(side, centre), dot(up, centre));
        vec2 moved = round(at / grid) * grid - at;
        origin += side * moved.x + up * moved.y;
        window = 0.5 / extent;
        texel = max(grid.x, grid.y);
    }
    views[light].view = mat4(vec4(side.x, up.x, forward.x, 0.0), vec4(side.y, up.y, forward.y, 0.0), vec4(side.z, up.z, forward.z, 0.0),
                             vec4(-dot(side, origin), -dot(up, origin), -dot(forward, origin), 1.0));
    views[light].window = kind > 1.5 ? vec4(0.0) : vec4(window.x, -window.y, 0.5, 0.5);
    views[light].info = vec4(kind, smoke && any(greaterThan(source.color.rgb, vec3(0.0))) ? 1.0 : 0.0, texel, 0.0);
}
