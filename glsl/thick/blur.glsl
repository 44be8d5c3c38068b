// One direction of the separable Gauss over a min/max image (L passes 4-7). A thread makes a run of 8 pixels of a row or column.
// R, G, B (near, far, life) are averaged over the pixels that hold smoke, so that emptiness has no depth; A is a plain blur, which keeps its mean.
// Raw images hold minus the far depth in G and SF_DEPTH_FAR where there is no smoke; the first direction turns G round.
#ifndef SF_THICK_BLUR_GLSL
#define SF_THICK_BLUR_GLSL

layout(constant_id = 0) const uint VERTICAL = 0u;
layout(constant_id = 1) const uint RADIUS = 4u;
layout(local_size_x = SF_THICK_TILE, local_size_y = SF_THICK_TILE / 8) in;
layout(set = 0, binding = 0) uniform sampler2D source;
layout(set = 0, binding = 1, rgba32f) writeonly uniform image2D target;
#ifdef TILED
layout(set = 0, binding = 2, std430) readonly buffer Tiles { uint tiles[]; };
layout(set = 0, binding = 3, std430) readonly buffer Mask { uint mask[]; };
#endif
layout(push_constant) uniform Push { sf_thick_blur_push push; };

const int RUN = 8; // pixels a thread makes
ivec2 axis, lowest, highest;

// The next tap: depths times 1 where there is smoke, else 0; optical depth; and that 1 or 0.
void fetch(inout ivec2 at, out vec4 value, out float here)
{
    ivec2 place = clamp(at, lowest, highest);
    value = texelFetch(source, place, 0);
    float inside = at == place ? 1.0 : 0.0;
    here = value.r < SF_DEPTH_FAR ? inside : 0.0;
    value *= vec4(here, here, here, inside);
    at += axis;
}

void store(ivec2 at, vec4 sum, float held)
{
    vec3 mean = held > 0.0 ? sum.rgb / held : vec3(SF_DEPTH_FAR, SF_DEPTH_FAR, 0.0);
    if (VERTICAL == 0u && held > 0.0) {
        mean.g = -mean.g;
        if (mean.g < mean.r) // only faint spheres here, whose surfaces crossed
            mean.rg = vec2(0.5 * (mean.r + mean.g));
    }
    if (at.x < int(push.width) && at.y < int(push.height))
        imageStore(target, at, vec4(mean, sum.a));
}

void main()
{
    uvec2 corner = gl_WorkGroupID.xy * SF_THICK_TILE;
    ivec2 low = ivec2(0), high = ivec2(push.width, push.height); // what may be read
#ifdef TILED
    {
        uint tile = tiles[gl_WorkGroupID.x];
        uvec2 at = uvec2(tile % push.tiles_x, tile / push.tiles_x);
        corner = at * SF_THICK_TILE;
        // Only listed tiles hold anything: read no others along the axis.
        uint step = VERTICAL != 0u ? push.tiles_x : 1u;
        uint place = VERTICAL != 0u ? at.y : at.x;
        uint last = (VERTICAL != 0u ? push.height - 1u : push.width - 1u) / SF_THICK_TILE;
        if (place == 0u || mask[tile - step] == 0u)
            low = ivec2(corner);
        if (place == last || mask[tile + step] == 0u)
            high = min(high, ivec2(corner) + SF_THICK_TILE);
    }
#else
    if (push.cell != 0u) {
        low.x = int(corner.x / push.cell * push.cell);
        high.x = low.x + int(push.cell);
    }
#endif

    // Not a ?: of vectors: Mesa 22.3 folds that wrongly for specialization constants, in the first component only.
    axis = ivec2(1 - int(VERTICAL), int(VERTICAL));
    lowest = low;
    highest = high - 1;
    ivec2 start = ivec2(corner) + int(gl_LocalInvocationID.x) * (1 - axis) + int(gl_LocalInvocationID.y) * RUN * axis;
    if (any(greaterThanEqual(start, ivec2(push.width, push.height))))
        return;

    // A window of eight pixels slides over the taps; all stays in registers (an indexed array would not).
    vec4 v0, v1, v2, v3, v4, v5, v6, v7, s0 = vec4(0.0), s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0, s6 = s0, s7 = s0;
    float h0, h1, h2, h3, h4, h5, h6, h7, n0 = 0.0, n1 = 0.0, n2 = 0.0, n3 = 0.0, n4 = 0.0, n5 = 0.0, n6 = 0.0, n7 = 0.0;
    const int radius = int(RADIUS);
    ivec2 next = start - radius * axis;
    fetch(next, v0, h0);
    fetch(next, v1, h1);
    fetch(next, v2, h2);
    fetch(next, v3, h3);
    fetch(next, v4, h4);
    fetch(next, v5, h5);
    fetch(next, v6, h6);
    for (int tap = -radius; tap <= radius; tap++) {
        fetch(next, v7, h7);
        float weight = push.weight[abs(tap)];
#define ADD(i) s##i += weight * v##i; n##i += weight * h##i
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
        h0 = h1;
        h1 = h2;
        h2 = h3;
        h3 = h4;
        h4 = h5;
        h5 = h6;
        h6 = h7;
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

#endif
