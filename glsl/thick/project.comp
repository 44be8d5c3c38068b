#version 460
#extension GL_GOOGLE_include_directive : require
// Every particle as the camera sees it: its sphere, the rectangle of tiles that it may touch, and one more in the count of each of these.
// One thread a particle.
#include "shared/frame.h"
#include "shared/particle.h"
#include "shared/thick.h"
#include "lib/sphere.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
layout(set = 0, binding = 1, std430) readonly buffer Particles { sf_particle particles[]; };
layout(set = 0, binding = 2, std430) readonly buffer Counts { sf_particle_counts counts; };
layout(set = 0, binding = 3, std430) buffer Touching { uint touching[]; }; // a tile
layout(set = 0, binding = 4, std430) writeonly buffer Spheres { sf_thick_sphere spheres[]; };
layout(set = 0, binding = 5, std430) writeonly buffer Rectangles { uvec2 rectangles[]; }; // first and last tile: x + 65536 y
layout(push_constant) uniform Push { sf_thick_push push; };
#include "thick/view.glsl"

// Empty when it is not seen.
uvec4 tiles_of(vec3 c, float radius)
{
    vec2 x = circle_range(c.x, c.z, radius, 1e4) / frame.right.w;
    vec2 y = circle_range(c.y, c.z, radius, 1e4) / frame.up.w;
    // ndc to smoke pixels; rows go down
    vec2 pixels = 0.5 * frame.size.xy / float(push.scale);
    vec2 low = (vec2(x.x, -y.y) + 1.0) * pixels;
    vec2 high = (vec2(x.y, -y.x) + 1.0) * pixels;
    vec2 size = vec2(push.width, push.height);
    if (any(lessThan(high, vec2(0.0))) || any(greaterThanEqual(low, size)))
        return uvec4(1u, 1u, 0u, 0u);
    return uvec4(uvec2(clamp(low, vec2(0.0), size - 1.0)), uvec2(clamp(high, vec2(0.0), size - 1.0))) / SF_THICK_TILE;
}

void main()
{
    uint index = gl_GlobalInvocationID.x;
    if (index == 0u) // whole, since what memory held before may be NaN, and that times no chord is NaN
        spheres[push.capacity] = sf_thick_sphere(vec4(SF_THICK_NOWHERE, SF_THICK_NOWHERE, 0.0, 0.0), vec4(0.0), vec4(0.0));
    if (index >= counts.live)
        return;
    sf_particle p = particles[index];
    vec3 c = to_view(vec3(p.x, p.y, p.z));
    bool seen = c.z + p.radius > frame.eye.w && p.extinction > 0.0 && p.radius > 0.0;
    uvec4 tiles = seen ? tiles_of(c, p.radius) : uvec4(1u, 1u, 0u, 0u);
    float age = p.lifetime > 0.0 ? clamp(p.age / p.lifetime, 0.0, 1.0) : 0.0;
    float texels = push.detail_scale * float(SF_THICK_ATLAS / 4);
    uint tile = p.look & 3u;

    seen = seen && tiles.x <= tiles.z;
    rectangles[index] = uvec2(tiles.x | tiles.y << 16, tiles.z | tiles.w << 16);
    spheres[index].ball = seen ? vec4(c / p.radius, p.radius) : vec4(SF_THICK_NOWHERE, SF_THICK_NOWHERE, 0.0, 0.0);
    spheres[index].matter = vec4(seen ? p.extinction : 0.0, frame.ramp[int(age * float(SF_FRAME_RAMP - 1) + 0.5)].rgb);
    spheres[index].detail = vec4(texels * cos(p.rotation), texels * sin(p.rotation), (vec2(tile & 1u, tile >> 1) + 0.5) * float(SF_THICK_ATLAS / 2));
    if (seen)
        for (uint row = tiles.y; row <= tiles.w; row++)
            for (uint column = tiles.x; column <= tiles.z; column++)
                atomicAdd(touching[row * push.tiles_x + column], 1u);
}
