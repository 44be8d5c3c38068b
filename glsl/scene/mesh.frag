#version 460
#extension GL_GOOGLE_include_directive : require
// A mesh's surface, hidden where a plane is nearer.
#include "scene/shade.glsl"

layout(location = 0) in vec3 world;
layout(location = 1) in vec3 normal;
layout(location = 2) flat in vec3 albedo;
layout(location = 0) out vec4 color;
layout(location = 1) out float depth;

void main()
{
    vec3 ray = world - frame.eye.xyz;
    depth = dot(ray, frame.forward.xyz);
    float least = SF_DEPTH_FAR;
    for (uint i = 0u; i < PLANES; i++)
        least = min(least, plane_depth(i, ray / depth));
    if (depth >= least)
        discard;
    vec3 facing = normalize(normal);
    facing = dot(facing, ray) > 0.0 ? -facing : facing;
    color = vec4(albedo * (far_lights(0u, world, facing) + environment_blurred(facing)), 1.0);
}
