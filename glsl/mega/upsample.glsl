// Takes the reduced smoke up to a pixel of the frame, as thick/upsample.glsl does; but smoke is here a surface, before which alone the scene takes something away.
// `cut` says so: the scene's depth where it does, and elsewhere minus the depth from which on it would not.
#ifndef SF_MEGA_UPSAMPLE_GLSL
#define SF_MEGA_UPSAMPLE_GLSL

vec4 upsample_at_edges(sampler2D image, vec2 frame_pixel)
{
    vec2 at = frame_pixel / float(SCALE) - 0.5;
    vec2 base = floor(at);
    vec2 part = at - base;
    ivec2 limit = textureSize(cut, 0) - 1;
    ivec2 low = clamp(ivec2(base), ivec2(0), limit), high = clamp(ivec2(base) + 1, ivec2(0), limit);
    ivec2 right = ivec2(high.x, low.y), down = ivec2(low.x, high.y);
    vec4 bilinear = vec4((1.0 - part.x) * (1.0 - part.y), part.x * (1.0 - part.y), (1.0 - part.x) * part.y, part.x * part.y);
    vec4 there = vec4(texelFetch(cut, low, 0).r, texelFetch(cut, right, 0).r, texelFetch(cut, down, 0).r, texelFetch(cut, high, 0).r);
    // Scenes behind the smoke are all the same.
    float deepest = max(max(-there.x, -there.y), max(-there.z, -there.w));
    deepest = deepest > 0.0 ? min(deepest, behind.x) : behind.x;
    float here = min(texelFetch(scene_depth, ivec2(frame_pixel), 0).r, deepest);
    there = min(mix(there, vec4(deepest), lessThan(there, vec4(0.0))), deepest);
    vec4 apart = (there - here) / behind.y;
    vec4 weight = (bilinear + 1e-3) / (0.02 + apart * apart);
    weight /= dot(weight, vec4(1.0));
    return weight.x * texelFetch(image, low, 0) + weight.y * texelFetch(image, right, 0) + weight.z * texelFetch(image, down, 0) +
           weight.w * texelFetch(image, high, 0);
}

vec4 upsample(sampler2D image, vec2 frame_pixel)
{
    if (SCALE == 1u)
        return texelFetch(image, ivec2(frame_pixel), 0);
    return CHOICE == 1u ? textureLod(image, frame_pixel * behind.zw, 0.0) : upsample_at_edges(image, frame_pixel);
}

#endif
