#version 460
#extension GL_GOOGLE_include_directive : require
// One direction of the separable Gauss over the listed tiles. Colour and coverage are blurred as they are; depth is a mean over what is covered, so that
// emptiness has none. A thread makes a run of 8 pixels of a row or column.
#include "shared/frame.h"
#include "shared/thick.h"

layout(constant_id = 0) const uint VERTICAL = 0u;
layout(constant_id = 1) const uint RADIUS = 4u;
layout(local_size_x = SF_THICK_TILE, local_size_y = SF_THICK_TILE / 8) in;
layout(set = 0, binding = 0) uniform sampler2D source; // across: rgb and depth; down: rgb, coverage
layout(set = 0, binding = 1) uniform sampler2D source_depth;
layout(set = 0, binding = 2, rgba16f) writeonly uniform image2D target;
layout(set = 0, binding = 3, r32f) writeonly uniform image2D target_depth;
layout(set = 0, binding = 4, std430) readonly buffer Tiles { uint tiles[]; };
layout(set = 0, binding = 5, std430) readonly buffer Mask { uint mask[]; };
layout(push_constant) uniform Push { sf_thick_blur_push push; };

const int RUN = 8; // pixels a thread makes
ivec2 axis, lowest, highest, border;

// The next tap: colour and coverage; and depth times coverage.
void fetch(inout ivec2 at, out vec4 value, out float depth)
{
    // Beyond the image's border smoke goes on as it is there.
    ivec2 wanted = clamp(at, ivec2(0), border), place = clamp(wanted, lowest, highest);
    value = texelFetch(source, place, 0);
    float inside = wanted == place ? 1.0 : 0.0;
    if (VERTICAL == 0u) {
        float here = value.a < SF_DEPTH_FAR ? inside : 0.0;
        depth = value.a * here;
        value = vec4(value.rgb, 1.0) * here;
    } else {
        depth = texelFetch(source_depth, place, 0).r * inside;
        value *= inside;
    }
    at += axis;
}

void store(ivec2 at, vec4 sum, float depth)
{
    if (VERTICAL != 0u)
        depth = sum.a > 0.0 ? depth / sum.a : 0.0;
    if (at.x < int(push.width) && at.y < int(push.height)) {
        imageStore(target, at, sum);
        imageStore(target_depth, at, vec4(depth));
    }
}

void main()
{
    uint tile = tiles[gl_WorkGroupID.x];
    ivec2 here = ivec2(tile % push.tiles_x, tile / push.tiles_x);
    ivec2 corner = here * SF_THICK_TILE;
    // Not a ?: of vectors: Mesa 22.3 folds that wrongly for specialization constants, in the first component only.
    axis = ivec2(1 - int(VERTICAL), int(VERTICAL));
    // Only listed tiles hold anything: those side by side with this one, two on each side.
    int place = VERTICAL != 0u ? here.y : here.x;
    int count = (int(VERTICAL != 0u ? push.height : push.width) + SF_THICK_TILE - 1) / SF_THICK_TILE;
    int step = VERTICAL != 0u ? int(push.tiles_x) : 1;
    int before = place > 0 && mask[tile - step] != 0u ? 1 : 0;
    before += before == 1 && place > 1 && mask[tile - 2 * step] != 0u ? 1 : 0;
    int after = place + 1 < count && mask[tile + step] != 0u ? 1 : 0;
    after += after == 1 && place + 2 < count && mask[tile + 2 * step] != 0u ? 1 : 0;
    lowest = corner - before * SF_THICK_TILE * axis;
    border = ivec2(push.width, push.height) - 1;
    highest = min(corner + SF_THICK_TILE + after * SF_THICK_TILE * axis - 1, border);
    ivec2 start = corner + int(gl_LocalInvocationID.x) * (1 - axis) + int(gl_LocalInvocationID.y) * RUN * axis;
    if (any(greaterThanEqual(start, ivec2(push.width, push.height))))
        return;

    // A window of eight pixels slides over the taps; all stays in registers (an indexed array would not).
    vec4 v0, v1, v2, v3, v4, v5, v6, v7, s0 = vec4(0.0), s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0, s6 = s0, s7 = s0;
    float z0, z1, z2, z3, z4, z5, z6, z7, n0 = 0.0, n1 = 0.0, n2 = 0.0, n3 = 0.0, n4 = 0.0, n5 = 0.0, n6 = 0.0, n7 = 0.0;
    const int radius = int(RADIUS);
    ivec2 next = start - radius * axis;
    fetch(next, v0, z0);
    fetch(next, v1, z1);
    fetch(next, v2, z2);
    fetch(next, v3, z3);
    fetch(next, v4, z4);
    fetch(next, v5, z5);
    fetch(next, v6, z6);
    for (int tap = -radius; tap <= radius; tap++) {
        fetch(next, v7, z7);
        float weight = push.weight[abs(tap)];
#define ADD(i) s##i += weight * v##i; n##i += weight * z##i
        ADD(0);
        ADD(1);
        ADD(2);
        ADD(3);
        ADD(4);
        ADD(5);
        ADD(6);
        ADD(7);
        v0 = v1;
        v1 = v2;
        v2 = v3;
        v3 = v4;
        v4 = v5;
        v5 = v6;
        v6 = v7;
        z0 = z1;
        z1 = z2;
        z2 = z3;
        z3 = z4;
        z4 = z5;
        z5 = z6;
        z6 = z7;
    }
    store(start, s0, n0);
    store(start + axis, s1, n1);
    store(start + 2 * axis, s2, n2);
    store(start + 3 * axis, s3, n3);
    store(start + 4 * axis, s4, n4);
    store(start + 5 * axis, s5, n5);
    store(start + 6 * axis, s6, n6);
    store(start + 7 * axis, s7, n7);
}
