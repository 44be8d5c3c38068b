#version 460
#extension GL_GOOGLE_include_directive : require
// The part of the picture that a plane may take, an instance a plane; and all that its fragments need of the frame.
#include "scene/shade.glsl"
#include "scene/half_plane.glsl"
#include "scene/planes.glsl"

NEAR_LIGHTS(out)
layout(location = 0) flat out uint plane;
layout(location = 1) flat out vec4 forward; // w: 1/width
layout(location = 2) flat out vec4 right;   // w: 1/height
layout(location = 3) flat out vec4 up;      // w: near plane
layout(location = 4) flat out vec4 slope;   // xyz: how fast a pixel's ray comes nearer to the plane, times ndc and 1; w: distance
layout(location = 5) flat out vec4 normal;  // towards the eye; w: shadow exponent
layout(location = 6) flat out vec4 albedo;  // w: checker squares a metre
layout(location = 7) flat out vec4 albedo2;
layout(location = 8) flat out vec4 ambient;
layout(location = 9) noperspective out vec2 square_ray; // checker coordinates: t square_ray + square_eye.xy
layout(location = 10) flat out vec4 square_eye;         // zw: a pixel right and up, in units of slope
layout(location = 11) flat out vec4 square_pixel;       // a pixel right, and up, at t = 1, in squares

void main()
{
    plane = gl_InstanceIndex;
    slope.xyz = plane_horizon(plane, slope.w);
    vec2 ndc = half_plane_corner(slope.xyz + vec3(0.0, 0.0, pixel_slope(slope.xyz)), gl_VertexIndex);
    gl_Position = vec4(ndc.x, -ndc.y, 0.0, 1.0);

    vec3 ray = frame.forward.xyz + ndc.x * frame.right.xyz + ndc.y * frame.up.xyz;
    vec4 row0 = objects[plane].row0, row1 = objects[plane].row1, row2 = objects[plane].row2;
    bool front = dot(row1.xyz, frame.eye.xyz) + row1.w > 0.0;
    forward = vec4(frame.forward.xyz, frame.size.z);
    right = vec4(frame.right.xyz, frame.size.w);
    up = vec4(frame.up.xyz, frame.eye.w);
    normal = vec4(front ? row1.xyz : -row1.xyz, 0.0);
    albedo = objects[plane].albedo;
    albedo.w = albedo.w > 0.0 ? 1.0 / albedo.w : 0.0;
    albedo2 = objects[plane].albedo2;
    ambient = vec4(environment_blurred(normal.xyz), 0.0);
    vec3 right_pixel = frame.right.xyz * (2.0 * frame.size.z), up_pixel = frame.up.xyz * (2.0 * frame.size.w);
    square_ray = vec2(dot(row0.xyz, ray), dot(row2.xyz, ray)) * albedo.w;
    square_eye.xy = vec2(dot(row0.xyz, frame.eye.xyz) + row0.w, dot(row2.xyz, frame.eye.xyz) + row2.w) * albedo.w;
    square_eye.zw = slope.xy * 2.0 * frame.size.zw;
    square_pixel = vec4(dot(row0.xyz, right_pixel), dot(row2.xyz, right_pixel), dot(row0.xyz, up_pixel), dot(row2.xyz, up_pixel)) * albedo.w;

    for (uint i = 0u; i < NEAR; i++) {
        near_color[i] = near_position[i] = near_direction[i] = map_ray[i] = map_eye[i] = smoke_eye[i] = window[i] = vec4(0.0);
        smoke_ray[i] = vec3(0.0);
        if (i >= LIGHTS)
            continue;
        near_color[i] = frame.lights[i].color;
        near_position[i] = vec4(frame.lights[i].position.xyz - frame.eye.xyz, 0.0);
        near_direction[i] = frame.lights[i].direction;
        if ((SHADOWED >> i & 1u) != 0u) {
            map_ray[i] = frame.lights[i].world_to_map * vec4(ray, 0.0);
            map_eye[i] = frame.lights[i].world_to_map * vec4(frame.eye.xyz, 1.0);
            normal.w = frame.lights[i].shadow.y;
        }
        if ((SMOKE >> i & 1u) != 0u) {
            smoke_ray[i] = (views[i].view * vec4(ray, 0.0)).xyz;
            smoke_eye[i] = views[i].view * vec4(frame.eye.xyz, 1.0);
            window[i] = smoke_window(i);
        }
    }
}
