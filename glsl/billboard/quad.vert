#version 460
#extension GL_GOOGLE_include_directive : require
// A rectangle for each particle, back to front: a flat one through its centre that faces the camera, or the one that covers its whole sphere, from outside
// and from inside.
#include "shared/frame.h"
#include "shared/billboard.h"
#include "shared/thick.h"
#include "lib/sphere.glsl"

layout(constant_id = 0) const uint WHOLE = 0u; // 1: covers the sphere
layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
layout(set = 0, binding = 1, std430) readonly buffer Billboards { sf_billboard billboards[]; };
layout(push_constant) uniform Push { sf_billboard_push push; };

layout(location = 0) noperspective out vec4 ray;            // xy: view ray of unit depth; zw: from the centre, in the plane through it that faces the camera, radii
layout(location = 1) noperspective out vec2 texel;          // of the detail atlas
layout(location = 2) flat out vec4 sphere;    // centre (x, y, depth), radius
layout(location = 3) flat out vec4 light;     // rgb: radiance for each unit of opacity; w: extinction, 1/m
layout(location = 4) flat out vec4 settings;  // x: near plane; y: share that it leaves; z: detail; w: life
layout(location = 5) flat out vec4 own;       // the method's settings
layout(location = 6) flat out uint number;    // of the billboard, for those who need more of it
layout(location = 7) flat out vec4 turn;      // the rest of sf_billboard, for those who light each pixel
layout(location = 8) flat out vec4 albedo;
layout(location = 9) flat out vec4 lit[2];

void main()
{
    sf_billboard b = billboards[gl_InstanceIndex];
    vec3 c = b.sphere.xyz;
    float r = b.sphere.w;
    vec2 tangent = vec2(frame.right.w, frame.up.w);
    bool seen = b.light.w > 0.0;
    vec2 x, y;
    if (WHOLE != 0u) {
        x = circle_range(c.x, c.z, r, 1e4);
        y = circle_range(c.y, c.z, r, 1e4);
    } else {
        seen = seen && c.z > frame.eye.w && b.albedo.w > 0.0;
        x = (c.x + vec2(-r, r)) / max(c.z, 1e-6);
        y = (c.y + vec2(-r, r)) / max(c.z, 1e-6);
    }
    x = clamp(x, -1.02 * tangent.x, 1.02 * tangent.x);
    y = clamp(y, -1.02 * tangent.y, 1.02 * tangent.y);
    ray.xy = vec2((gl_VertexIndex & 1) != 0 ? x.y : x.x, (gl_VertexIndex & 2) != 0 ? y.y : y.x);
    ray.zw = (ray.xy * c.z - c.xy) / r;
    uint tile = uint(b.tile.z) & 3u;
    vec2 turned = vec2(b.tile.x * ray.z - b.tile.y * ray.w, b.tile.y * ray.z + b.tile.x * ray.w) * push.detail_scale;
    texel = (turned * 0.25 + 0.25 + 0.5 * vec2(tile & 1u, tile >> 1)) * float(SF_THICK_ATLAS);
    sphere = b.sphere;
    light = b.light;
    settings = vec4(frame.eye.w, b.albedo.w, push.detail, b.tile.w);
    own = push.own;
    number = gl_InstanceIndex;
    turn = b.tile;
    albedo = b.albedo;
    lit = b.lit;
    vec2 ndc = ray.xy / tangent;
    vec2 share = frame.size.xy / (float(push.scale) * vec2(push.width, push.height)); // of the image that the frame covers
    gl_Position = seen ? vec4((vec2(ndc.x, -ndc.y) + 1.0) * share - 1.0, 0.5, 1.0) : vec4(2.0, 2.0, 0.0, 1.0);
}
