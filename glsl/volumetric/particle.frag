#version 460
#extension GL_GOOGLE_include_directive : require
// Volumetric soft particles (METHODS B7; Larsson's [4]): a sphere is marched through noise in space, between the near plane and the scene. The noise is
// the particle's own: it stands still in the world when the camera moves, goes where the particle goes, and turns as it turns.
#include "billboard/particle.glsl"
#include "shared/billboard.h"
#include "shared/volumetric.h"
#include "lib/sphere.glsl"

layout(constant_id = 2) const uint STEPS = 8u;
layout(constant_id = 3) const uint NOISE = 0u;
layout(constant_id = 4) const uint LIGHTING = 0u;
layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
layout(set = 0, binding = 1, std430) readonly buffer Billboards { sf_billboard billboards[]; };
layout(set = 0, binding = 4) uniform sampler2DArray noise;
layout(push_constant) uniform Push { sf_billboard_push push; };
layout(location = 6) flat in uint number;

// Into the coordinates of the particle's noise, in which a cube's side is 1. `way`: x right, y up, z depth.
vec3 to_noise(vec3 way, vec4 tile)
{
    vec3 world = way * vec3(1.0, 1.0, -1.0) * mat3(frame.world_to_view);
    // Turned about one of three axes.
    uint axis = uint(tile.z) % 3u;
    world = axis == 0u ? world : axis == 1u ? world.yzx : world.zxy;
    return own.w * vec3(tile.x * world.x + tile.y * world.z, world.y, tile.x * world.z - tile.y * world.x);
}

void main()
{
    vec3 v = vec3(ray.xy, 1.0);
    vec2 chord = sphere_chord(v, sphere.xyz, sphere.w);
    float front = max(chord.x - chord.y, settings.x), back = min(chord.x + chord.y, depth_of_scene());
    float span = chord.y > 0.0 ? max(back - front, 0.0) : 0.0;
    float depth = light.w * span * length(v); // of the uniform sphere
    if (NOISE == 0u && LIGHTING == 0u) {
        result = radiance_at(1.0 - exp(-depth));
        return;
    }
    vec4 tile = billboards[number].tile, toward = billboards[number].toward;
    float share = 1.0 / float(STEPS);
    vec3 stride = v * (span * share / sphere.w);             // radii
    vec3 at = (v * front - sphere.xyz) / sphere.w + 0.5 * stride; // from the centre
    vec3 beat = to_noise(stride, tile) * vec3(1.0, 1.0, float(SF_VOLUMETRIC_SIDE));
    vec3 place = (to_noise(at, tile) + fract(toward.w * vec3(1.0, 61.0, 3701.0))) * vec3(1.0, 1.0, float(SF_VOLUMETRIC_SIDE));
    // One field becomes the other and its own negative, with the same variance all the time.
    float phase = push.more[0].x * (1.0 - settings.w);
    vec2 fields = vec2(cos(phase), sin(phase)) * (2.0 * SF_VOLUMETRIC_RANGE);
    float centre = -0.5 * (fields.x + fields.y);
    float gathered = 0.0, lit = 0.0, through = 1.0;
    for (uint i = 0u; i < STEPS; i++) {
        float part = share;
        if (NOISE != 0u) {
            float layer = floor(place.z), far = place.z - layer;
            vec4 texel = textureLod(noise, vec3(place.xy, float(int(layer) & (SF_VOLUMETRIC_SIDE - 1))), 0.0);
            float n = fields.x * mix(texel.r, texel.g, far) + fields.y * mix(texel.b, texel.a, far) + centre;
            part *= max(own.x + own.y * n - own.z * dot(at, at), 0.0);
            place += beat;
        }
        gathered += part;
        if (LIGHTING != 0u) {
            float left = exp(-depth * gathered);
            lit += (through - left) * max(1.0 + push.more[0].y * dot(at, toward.xyz), 0.0);
            through = left;
        }
        at += stride;
    }
    float opacity = 1.0 - exp(-depth * (NOISE != 0u ? gathered : 1.0));
    result = vec4(light.rgb * (LIGHTING != 0u ? lit : opacity), opacity);
}
