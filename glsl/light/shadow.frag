#version 460
#extension GL_GOOGLE_include_directive : require
// What each light sees first: the boxes, spheres and cylinders, exactly; behind them the planes that face the light.
#include "light/shadow.glsl"
#include "lib/solid.glsl"

layout(constant_id = 0) const uint PLANES = 0u;
layout(constant_id = 1) const uint SOLIDS = 0u;
layout(push_constant) uniform Push { sf_shadow_push push; };
layout(location = 0) out float value;

vec3 turned(uint i, vec3 world)
{
    return vec3(dot(objects[i].row0.xyz, world), dot(objects[i].row1.xyz, world), dot(objects[i].row2.xyz, world));
}

void main()
{
    uint cell = uint(gl_FragCoord.x) / push.cell;
    vec2 at = (gl_FragCoord.xy - vec2(cell * push.cell, 0.0)) / float(push.cell) * 2.0 - 1.0;
    vec3 aside = at.x * cells[cell].right.xyz + at.y * cells[cell].down.xyz;
    bool perspective = cells[cell].origin.w > 0.0;
    vec3 origin = cells[cell].origin.xyz + (perspective ? vec3(0.0) : aside);
    vec3 ray = cells[cell].forward.xyz + (perspective ? aside : vec3(0.0));
    float near = cells[cell].range.x;

    float first = SOLID_OPEN;
    for (uint i = PLANES; i < PLANES + SOLIDS; i++) {
        vec3 offset = vec3(objects[i].row0.w, objects[i].row1.w, objects[i].row2.w);
        uint kind = uint(objects[i].shape.w);
        vec2 span = solid_span(solid_reach(kind, objects[i].shape), solid_ball(kind), turned(i, origin) + offset, turned(i, ray));
        float t = span.x >= near ? span.x : span.y;
        first = span.x <= span.y && t >= near ? min(first, t) : first;
    }
    float behind = SOLID_OPEN;
    for (uint i = 0u; i < PLANES; i++) {
        vec4 row = objects[i].row1;
        float slope = dot(row.xyz, ray);
        float t = -(dot(row.xyz, origin) + row.w) / slope;
        behind = slope < 0.0 && t >= near ? min(behind, t) : behind;
    }
    value = shadow_value(cell, first < SOLID_OPEN ? first : behind);
}
