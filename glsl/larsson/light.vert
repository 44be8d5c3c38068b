#version 460
#extension GL_GOOGLE_include_directive : require
// A billboard for each particle and light, in the light's cell of the map; it covers the whole projected sphere.
#include "shared/frame.h"
#include "shared/particle.h"
#include "shared/thick.h"
#include "lib/sphere.glsl"

layout(set = 0, binding = 1, std430) readonly buffer Particles { sf_particle particles[]; };
layout(set = 0, binding = 2, std430) readonly buffer Counts { sf_particle_counts counts; };
layout(set = 0, binding = 3, std430) readonly buffer Views { sf_gpu_light_view views[]; };
layout(push_constant) uniform Push { sf_thick_push push; };

layout(location = 0) out vec2 window;           // q.xy, or q.xy / q.z for perspective
layout(location = 1) flat out vec4 sphere;      // centre in the light's view, radius
layout(location = 2) flat out vec4 properties;  // extinction, 1 perspective, firmness, unused

void main()
{
    uint light = uint(gl_InstanceIndex) / max(counts.live, 1u);
    sf_particle p = particles[uint(gl_InstanceIndex) % max(counts.live, 1u)];
    sf_gpu_light_view view = views[light];
    vec3 q = (view.view * vec4(p.x, p.y, p.z, 1.0)).xyz;
    bool perspective = view.info.x > 0.5;
    // The cell's edges in window coordinates; a sphere may reach beyond (spot and near point lights), never into a neighbour.
    vec2 edge = 0.5 / abs(view.window.xy);
    vec2 x = perspective ? circle_range(q.x, q.z, p.radius, 1e4) : q.x + vec2(-p.radius, p.radius);
    vec2 y = perspective ? circle_range(q.y, q.z, p.radius, 1e4) : q.y + vec2(-p.radius, p.radius);
    x = clamp(x, -edge.x, edge.x);
    y = clamp(y, -edge.y, edge.y);
    window = vec2((gl_VertexIndex & 1) != 0 ? x.y : x.x, (gl_VertexIndex & 2) != 0 ? y.y : y.x);
    sphere = vec4(q, p.radius);
    properties = vec4(p.extinction, view.info.x, sphere_firmness(2.0 * p.radius * p.extinction, push.thin), 0.0);
    vec2 uv = window * view.window.xy + view.window.zw;
    bool empty = view.info.y < 0.5 || !(p.extinction > 0.0) || (perspective && q.z + p.radius <= 0.0);
    gl_Position = empty ? vec4(2.0, 2.0, 0.0, 1.0) : vec4((uv.x + float(light)) / float(push.cells) * 2.0 - 1.0, uv.y * 2.0 - 1.0, 0.5, 1.0);
}
