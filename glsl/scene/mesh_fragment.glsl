// A mesh's surface, hidden where a plane is nearer.
#ifndef SF_SCENE_MESH_FRAGMENT_GLSL
#define SF_SCENE_MESH_FRAGMENT_GLSL
#include "scene/shade.glsl"

layout(location = 0) in vec3 world;
layout(location = 1) in vec3 normal;
layout(location = 2) flat in vec3 albedo;
#include "scene/targets.glsl"

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

#endif
