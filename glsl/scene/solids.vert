#version 460
#extension GL_GOOGLE_include_directive : require
// A box around each box, sphere and cylinder, an instance an object; its back faces are drawn, so that the camera may be inside.
#include "scene/shade.glsl"
#include "scene/half_plane.glsl"
#include "scene/solids.glsl"
#include "lib/solid.glsl"

SOLID_VARYINGS(out)

// Corners (bits: x, y, z) of two triangles a face, counter-clockwise seen from outside.
const uint CORNERS[36] = uint[](0u, 4u, 6u, 0u, 6u, 2u, 1u, 3u, 7u, 1u, 7u, 5u, 0u, 1u, 5u, 0u, 5u, 4u,
                                2u, 6u, 7u, 2u, 7u, 3u, 0u, 2u, 3u, 0u, 3u, 1u, 4u, 5u, 7u, 4u, 7u, 6u);

vec3 turned(uint object, vec3 world)
{
    return vec3(dot(objects[object].row0.xyz, world), dot(objects[object].row1.xyz, world), dot(objects[object].row2.xyz, world));
}

void hand_over_light()
{
    light_color = light_position = light_direction = vec4(0.0);
    for (uint k = 0u; k < 4u; k++)
        map[k] = smoke[k] = vec4(0.0);
    if (LIGHTS == 0u)
        return;
    uint object = uint(albedo.w);
    vec4 parts[4] = vec4[](vec4(frame.forward.xyz, 0.0), vec4(frame.right.xyz, 0.0), vec4(frame.up.xyz, 0.0), vec4(frame.eye.xyz, 1.0));
    light_color = frame.lights[0].color;
    light_position.xyz = turned(object, frame.lights[0].position.xyz - frame.eye.xyz);
    light_direction = vec4(turned(object, frame.lights[0].direction.xyz), frame.lights[0].direction.w);
    eye.w = frame.lights[0].shadow.y;
    for (uint k = 0u; k < 4u; k++) {
        if ((SHADOWED & 1u) != 0u)
            map[k] = frame.lights[0].world_to_map * parts[k];
        if ((SMOKE & 1u) != 0u)
            smoke[k] = vec4((views[0].view * parts[k]).xyz, smoke_window(0u)[k]);
    }
}

void main()
{
    uint object = PLANES + gl_InstanceIndex;
    vec3 offset = vec3(objects[object].row0.w, objects[object].row1.w, objects[object].row2.w);
    forward = vec4(turned(object, frame.forward.xyz), frame.size.z);
    right = vec4(turned(object, frame.right.xyz), frame.size.w);
    up = vec4(turned(object, frame.up.xyz), frame.eye.w);
    eye = vec4(turned(object, frame.eye.xyz) + offset, 0.0);
    vec4 shape = objects[object].shape;
    uint kind = uint(shape.w);
    reach = solid_reach(kind, shape);
    level[0] = vec4(frame.sh[0].rgb + 2.0 * frame.sh[6].rgb, solid_ball(kind));
    level[1] = frame.sh[1];
    level[2] = -6.0 * frame.sh[6];
    albedo = vec4(objects[object].albedo.rgb, float(object));
    axes[0] = vec3(objects[object].row0.x, objects[object].row1.x, objects[object].row2.x);
    axes[1] = vec3(objects[object].row0.y, objects[object].row1.y, objects[object].row2.y);
    axes[2] = vec3(objects[object].row0.z, objects[object].row1.z, objects[object].row2.z);
    ground = vec4(0.0);
    if (PLANES > 0u)
        ground.xyz = plane_horizon(0u, ground.w);
    hand_over_light();

    // A little larger, or rounding would lose pixels at the edges.
    uint corner = CORNERS[gl_VertexIndex];
    vec3 at = solid_bounds(reach, level[0].w) * 1.001 * (vec3(corner & 1u, corner >> 1u & 1u, corner >> 2u) * 2.0 - 1.0) - offset;
    gl_Position = frame.world_to_clip * vec4(dot(at, axes[0]), dot(at, axes[1]), dot(at, axes[2]), 1.0);
}
