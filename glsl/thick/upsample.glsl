// The four smoke pixels around a frame pixel and their weights.
#ifndef SF_THICK_UPSAMPLE_GLSL
#define SF_THICK_UPSAMPLE_GLSL

ivec2 upsample_low, upsample_high;
vec4 upsample_weight;

void upsample_begin(vec2 frame_pixel)
{
    vec2 at = frame_pixel / float(SCALE) - 0.5;
    vec2 base = floor(at);
    vec2 part = at - base;
    ivec2 limit = textureSize(smoke_depth, 0) - 1;
    upsample_low = clamp(ivec2(base), ivec2(0), limit);
    upsample_high = clamp(ivec2(base) + 1, ivec2(0), limit);
    vec4 bilinear = vec4((1.0 - part.x) * (1.0 - part.y), part.x * (1.0 - part.y), (1.0 - part.x) * part.y, part.x * part.y);
    float here = texelFetch(scene_depth, ivec2(frame_pixel), 0).r;
    vec4 there = vec4(texelFetch(smoke_depth, upsample_low, 0).r, texelFetch(smoke_depth, ivec2(upsample_high.x, upsample_low.y), 0).r,
                      texelFetch(smoke_depth, ivec2(upsample_low.x, upsample_high.y), 0).r, texelFetch(smoke_depth, upsample_high, 0).r);
    // In shares of the smoke's extent: ground that slants away behind the smoke stays smooth, an object within it keeps its edge.
    vec4 apart = (min(there, vec4(behind.x)) - min(here, behind.x)) / behind.y;
    vec4 weight = (bilinear + 1e-3) / (0.02 + apart * apart);
    upsample_weight = weight / dot(weight, vec4(1.0));
}

vec4 upsample(sampler2D image)
{
    return upsample_weight.x * texelFetch(image, upsample_low, 0) +
           upsample_weight.y * texelFetch(image, ivec2(upsample_high.x, upsample_low.y), 0) +
           upsample_weight.z * texelFetch(image, ivec2(upsample_low.x, upsample_high.y), 0) +
           upsample_weight.w * texelFetch(image, upsample_high, 0);
}

#endif
