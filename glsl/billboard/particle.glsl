// What a billboard's fragment knows, and what it may want of the medium. Opacity is the medium's: exp(-optical depth) is what a particle lets through, and
// the optical depth of a sphere is extinction times the way through it (docs/methods/billboards.md).
#ifndef SF_BILLBOARD_PARTICLE_GLSL
#define SF_BILLBOARD_PARTICLE_GLSL
#include "shared/frame.h"
#include "shared/thick.h"

layout(set = 0, binding = 2) uniform sampler2D scene_depth; // of the smoke's size
layout(set = 0, binding = 3) uniform sampler2D atlas;
layout(location = 0) noperspective in vec4 ray; // as quad.vert has them
layout(location = 1) noperspective in vec2 texel;
layout(location = 2) flat in vec4 sphere;
layout(location = 3) flat in vec4 light;
layout(location = 4) flat in vec4 settings;
layout(location = 5) flat in vec4 own;
layout(location = 0) out vec4 result;

layout(constant_id = 1) const uint DETAIL = 0u; // 1: the atlas takes some of the density away

float depth_of_scene()
{
    return texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r;
}

// What the atlas leaves of the density, 0..1.
float share_of_atlas()
{
    if (DETAIL == 0u)
        return 1.0;
    // Fetched, not filtered: the atlas is finer than the smoke's pixels, and a filtered look-up costs lavapipe twice the time.
    ivec2 at = ivec2(floor(texel)) & (SF_THICK_ATLAS - 1);
    return 1.0 - settings.z * (1.0 - texelFetch(atlas, at, 0).r);
}

// Optical depth of the sphere where the flat billboard shows it: along the view axis, whole.
float depth_across()
{
    float across = sqrt(clamp(1.0 - dot(ray.zw, ray.zw), 0.0, 1.0));
    return 2.0 * sphere.w * across * light.w * share_of_atlas();
}

// Premultiplied. A miss is blended as nothing: lavapipe is faster so than with a discard.
vec4 radiance_at(float opacity)
{
    return vec4(light.rgb, 1.0) * opacity;
}

#endif
