#version 460
#extension GL_GOOGLE_include_directive : require
// A billboard for each particle that covers the whole projected sphere, from outside and from inside.
#include "shared/frame.h"
#include "shared/particle.h"
#include "shared/thick.h"
#include "lib/sphere.glsl"

layout(constant_id = 0) const uint DETAIL = 0u;
layout(constant_id = 1) const uint CUT = 0u; // 1: spheres that a surface of the scene may cut off; 0: the others
layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
layout(set = 0, binding = 1, std430) readonly buffer Particles { sf_particle particles[]; };
layout(set = 0, binding = 4, std430) readonly buffer Mask { uint mask[]; };
layout(push_constant) uniform Push { sf_thick_push push; };
#include "thick/view.glsl"

layout(location = 0) out vec4 ray;             // xy: view ray of unit depth; zw: texel of the detail atlas
layout(location = 1) flat out vec4 sphere;     // centre (x, y, depth), radius
layout(location = 2) flat out vec4 properties; // extinction, life, near plane, firmness
layout(location = 3) flat out float detail;    // handed over, since a fragment pays more for a push constant

// Whether a tile of the rectangle (in the smoke's clip space) has a surface before the smoke's back. Large rectangles are not searched.
bool may_be_cut(vec2 low, vec2 high)
{
    vec2 size = vec2(push.width, push.height);
    uvec2 first = uvec2(clamp((low * 0.5 + 0.5) * size, vec2(0.0), size - 1.0)) / SF_THICK_TILE;
    uvec2 last = uvec2(clamp((high * 0.5 + 0.5) * size, vec2(0.0), size - 1.0)) / SF_THICK_TILE;
    uvec2 count = last - first + 1u;
    uint tiles = count.x * count.y;
    bool found = tiles > 64u;
    for (uint i = 0u; i < (found ? 0u : tiles); i++)
        found = found || mask[(first.y + i / count.x) * push.tiles_x + first.x + i % count.x] == SF_THICK_TILE_CUT;
    return found;
}

void main()
{
    sf_particle p = particles[gl_InstanceIndex];
    vec3 c = to_view(vec3(p.x, p.y, p.z));
    float life = p.lifetime > 0.0 ? clamp(1.0 - p.age / p.lifetime, 0.0, 1.0) : 1.0;
    vec2 tangent = vec2(frame.right.w, frame.up.w);
    vec2 x = clamp(circle_range(c.x, c.z, p.radius, 1e4), -1.02 * tangent.x, 1.02 * tangent.x);
    vec2 y = clamp(circle_range(c.y, c.z, p.radius, 1e4), -1.02 * tangent.y, 1.02 * tangent.y);
    vec2 at = vec2((gl_VertexIndex & 1) != 0 ? x.y : x.x, (gl_VertexIndex & 2) != 0 ? y.y : y.x);
    detail = push.detail;
    ray.xy = at;
    ray.zw = vec2(0.0);
    if (DETAIL != 0u) {
        // Turned tile over the sphere's middle plane (L 3.3.6), in texels of the 2 x 2 atlas.
        vec2 middle = (at * c.z - c.xy) / p.radius * push.detail_scale;
        float s = sin(p.rotation), k = cos(p.rotation);
        uint tile = p.look & 3u;
        ray.zw = (vec2(k * middle.x - s * middle.y, s * middle.x + k * middle.y) * 0.25 + 0.25 + 0.5 * vec2(tile & 1u, tile >> 1)) * float(SF_THICK_ATLAS);
    }
    sphere = vec4(c, p.radius);
    properties = vec4(p.extinction, life, frame.eye.w, 1.0);
    if (push.life_fade > 0.0)
        properties.x *= pow(life, push.life_fade);
    properties.w = sphere_firmness(2.0 * p.radius * properties.x, push.thin);

    vec2 ndc = at / tangent;
    vec2 share = frame.size.xy / (float(push.scale) * vec2(push.width, push.height)); // of the image that the frame covers
    vec2 position = (vec2(ndc.x, -ndc.y) + 1.0) * share - 1.0;
    vec2 low = (vec2(x.x, -y.y) / tangent + 1.0) * share - 1.0;
    vec2 high = (vec2(x.y, -y.x) / tangent + 1.0) * share - 1.0;
    bool empty = c.z + p.radius <= frame.eye.w || !(properties.x > 0.0) || may_be_cut(low, high) != (CUT != 0u);
    gl_Position = empty ? vec4(2.0, 2.0, 0.0, 1.0) : vec4(position, 0.5, 1.0);
}
