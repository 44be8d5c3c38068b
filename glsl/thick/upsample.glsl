// Takes reduced smoke up to a pixel of the frame.
#ifndef SF_THICK_UPSAMPLE_GLSL
#define SF_THICK_UPSAMPLE_GLSL

// By the sampler, bilinear: where no surface stands before the smoke's back.
vec4 upsample_plainly(sampler2D image, vec2 frame_pixel)
{
    return textureLod(image, frame_pixel * behind.zw, 0.0);
}

// The four nearest smoke pixels, weighted by distance and by how well the depth at which they were cut off agrees with this pixel's (joint
// bilateral upsampling, Kopf et al. 2007).
vec4 upsample_carefully(sampler2D image, vec2 frame_pixel)
{
    vec2 at = frame_pixel / float(SCALE) - 0.5;
    vec2 base = floor(at);
    vec2 part = at - base;
    ivec2 limit = textureSize(smoke_depth, 0) - 1;
    ivec2 low = clamp(ivec2(base), ivec2(0), limit), high = clamp(ivec2(base) + 1, ivec2(0), limit);
    ivec2 right = ivec2(high.x, low.y), down = ivec2(low.x, high.y);
    vec4 bilinear = vec4((1.0 - part.x) * (1.0 - part.y), part.x * (1.0 - part.y), (1.0 - part.x) * part.y, part.x * part.y);
    float here = min(texelFetch(scene_depth, ivec2(frame_pixel), 0).r, behind.x);
    vec4 there = min(vec4(texelFetch(smoke_depth, low, 0).r, texelFetch(smoke_depth, right, 0).r, texelFetch(smoke_depth, down, 0).r,
                          texelFetch(smoke_depth, high, 0).r), behind.x);
    // In shares of the smoke's extent: ground that slants away behind the smoke stays smooth, an object within it keeps its edge.
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
    return CHOICE == 1u || CHOICE == 3u ? upsample_plainly(image, frame_pixel) : upsample_carefully(image, frame_pixel);
}

#endif
