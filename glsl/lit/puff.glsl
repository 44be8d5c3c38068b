// What the two methods of lit smoke share (METHODS B9, B10; Reis 2008): a flat billboard with colour, alpha and normals of the scene's atlas, lit for each
// pixel by every light. docs/methods/lit.md has the equations.
#ifndef SF_LIT_PUFF_GLSL
#define SF_LIT_PUFF_GLSL
#include "billboard/particle.glsl"
#include "billboard/picture.glsl"
#include "soft/fade.glsl"
#include "lib/lighting.glsl"
#include "lib/phase.glsl"

layout(constant_id = 2) const uint LIGHTS = 1u;
layout(constant_id = 3) const uint KINDS = 0u;      // of the lights, two bits each
layout(constant_id = 4) const uint RAMP = 0u;       // 1: the scene's ramp runs over the light's intensity, and not over life
layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
layout(location = 7) flat in vec4 turn; // as sf_billboard has them
layout(location = 8) flat in vec4 albedo;
layout(location = 9) flat in vec4 lit[2];
layout(push_constant) uniform Push { sf_billboard_push push; };
#include "lib/environment.glsl"

const float INVERSE_PI = 0.318309886;

// A pixel of a puff.
struct lit_puff {
    vec3 at;      // in the tile: right and up, half a tile is 1; its layer
    vec4 color;   // of the tile, premultiplied; nothing beyond the sphere
    vec3 normal;  // unit, in the world
    float height; // above the billboard's plane, radii
    float opacity; // where the tile's alpha is 1: the medium's
    vec3 place;   // in the world, in the billboard's plane
    vec3 to_eye;  // unit
    vec3 right, up;
};

// From the billboard's plane to the tile's. The tile is turned about the view axis.
vec2 into_tile(vec2 v)
{
    return vec2(turn.x * v.x - turn.y * v.y, turn.y * v.x + turn.x * v.y);
}

lit_puff read_puff()
{
    lit_puff puff;
    sf_picture picture = picture_of(turn);
    vec4 shape = picture_shape(picture);
    puff.at = vec3(into_tile(ray.zw), picture.at.z);
    puff.color = dot(ray.zw, ray.zw) < 1.0 ? picture_color(picture) : vec4(0.0);
    puff.height = shape.w;
    puff.right = frame.right.xyz / frame.right.w;
    puff.up = frame.up.xyz / frame.up.w;
    // Tangent space is the view's (Tatarchuk 2006): the billboard faces the camera.
    vec3 ball = vec3(ray.zw, sqrt(clamp(1.0 - dot(ray.zw, ray.zw), 0.0, 1.0)));
    vec3 normal = normalize(mix(ball, shape.xyz, push.more[0].x));
    puff.normal = normal.x * puff.right + normal.y * puff.up - normal.z * frame.forward.xyz;
    // The matter of the medium's ball, 4/3 pi r^3, over the picture's 4 r^2 times its mean.
    puff.opacity = 1.0 - exp(-1.04719755 * sphere.w * light.w / max(picture.mean, 0.01));
    vec3 way = frame.forward.xyz + ray.x * puff.right + ray.y * puff.up;
    puff.place = frame.eye.xyz + sphere.z * way;
    puff.to_eye = -normalize(way);
    return puff;
}

// Irradiance of a small surface there that faces the light, and the unit vector to the light. A lamp inside the particle shines on its matter from all
// distances at once: 1 / (d^2 + r^2 / 3) is 1 / d^2 from afar, and its mean over the ball, 3 / r^2, at the middle.
vec3 irradiance_of(uint number, vec3 place, out vec3 to_light)
{
    uint kind = KINDS >> (2u * number) & 3u;
    vec3 irradiance = light_irradiance_of(kind, frame.lights[number], place, to_light);
    vec3 apart = frame.lights[number].position.xyz - place;
    float square = dot(apart, apart);
    return irradiance * (kind != SF_LIGHT_KIND_DIRECTIONAL ? square / (square + 0.333333333 * sphere.w * sphere.w) : 1.0);
}

// Wrap-around lighting (Reis's equations 5.2.3 and 5.2.4): (N . L) scale + bias with scale = 1 / (1 + w) and bias = w / (1 + w). Divided by
// pi (1 + w) its integral over all directions of the light is 1, as that of a phase function.
float wrapped(float cosine)
{
    float scale = 1.0 / (1.0 + own.z), bias = own.z * scale;
    return max(cosine * scale + bias, 0.0) * scale * INVERSE_PI;
}

// Light from behind (5.2.1): as much as the light stands behind the particle, E . L < 0; one that stands before it gives nothing. In an isotropic medium
// its integral over all directions of the light is `translucency`, before what dims it; else the medium's phase function over the isotropic one multiplies it.
float from_behind(vec3 to_eye, vec3 to_light)
{
    float behind = max(-dot(to_eye, to_light), 0.0);
    return own.w * 4.0 * behind * phase_henyey_greenstein(behind, frame.albedo.w);
}

// What light from all sides adds up to, in the ways that the scene's ramp can run.
struct lit_sum {
    vec3 scattered; // irradiance times share, 1/sr
    vec2 level;     // luminance of what is scattered, and of what would be if all lights shone on the face
};

void add_light(inout lit_sum sum, uint number, vec3 irradiance, float share)
{
    sum.scattered += share * lit[number >> 2][number & 3u] * irradiance;
    if (RAMP != 0u) {
        const vec3 luminance = vec3(0.2126, 0.7152, 0.0722);
        sum.level += dot(irradiance, luminance) * vec2(share * lit[number >> 2][number & 3u], wrapped(1.0));
    }
}

// Premultiplied. One pipeline serves all ways of blending: `blend` 0 covers what is behind, 1 adds to it.
vec4 lit_result(lit_puff puff, lit_sum sum)
{
    vec3 tint = albedo.rgb;
    if (RAMP != 0u) {
        float level = clamp(sum.level.x / max(sum.level.y, 1e-20), 0.0, 1.0) * float(SF_FRAME_RAMP - 1);
        int key = min(int(level), SF_FRAME_RAMP - 2);
        tint = frame.albedo.rgb * mix(frame.ramp[key].rgb, frame.ramp[key + 1].rgb, level - float(key));
    }
    vec3 ambient = environment_blurred(puff.normal) * push.ambient;
    vec3 radiance = puff.color.rgb * tint * (sum.scattered + ambient) + puff.color.a * frame.emission.rgb;
    return vec4(radiance, puff.color.a * (1.0 - own.y)) * (puff.opacity * distance_share() * settings.y);
}

#endif
