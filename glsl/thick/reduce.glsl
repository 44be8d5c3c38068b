// Takes the scene's depth down to the smoke's resolution: farthest and nearest of each block in turn (a checkerboard), so that both sides of an edge
// are there when the picture is taken up again. Include it where `sampler2D scene_depth` and `push` are declared.
#ifndef SF_THICK_REDUCE_GLSL
#define SF_THICK_REDUCE_GLSL

// x: the depth for smoke pixel `pixel`; y: the nearest of its block.
vec2 reduced_depth(ivec2 pixel)
{
    ivec2 limit = textureSize(scene_depth, 0) - 1;
    ivec2 first = min(pixel * int(push.scale), limit);
    float z = texelFetch(scene_depth, first, 0).r;
    float nearest = z;
    if (push.scale > 1u) {
        ivec2 last = min(first + int(push.scale) - 1, limit);
        float a = texelFetch(scene_depth, ivec2(last.x, first.y), 0).r;
        float b = texelFetch(scene_depth, ivec2(first.x, last.y), 0).r;
        float c = texelFetch(scene_depth, last, 0).r;
        nearest = min(min(z, a), min(b, c));
        z = ((pixel.x ^ pixel.y) & 1) != 0 ? nearest : max(max(z, a), max(b, c));
    }
    return vec2(z, nearest);
}

#endif
