// Light that reaches a point when nothing is in the way.
#ifndef SF_LIB_LIGHTING_GLSL
#define SF_LIB_LIGHTING_GLSL

// Irradiance (W/m2) of a small surface at `world` that faces the light, and the unit vector towards the light.
// Directional lights state it; point and spot lights have radiant intensity I (W/sr) and give I / distance^2. A spot's edge is a smoothstep of the
// cosine between its outer and inner angles.
vec3 light_irradiance_of(uint kind, sf_gpu_light light, vec3 world, out vec3 to_light)
{
    if (kind == SF_LIGHT_KIND_DIRECTIONAL) {
        to_light = -light.direction.xyz;
        return light.color.rgb;
    }
    vec3 way = light.position.xyz - world;
    float inverse = inversesqrt(max(dot(way, way), 1e-12));
    to_light = way * inverse;
    float strength = inverse * inverse;
    if (kind == SF_LIGHT_KIND_SPOT) {
        float cosine = -dot(to_light, light.direction.xyz);
        float outer = light.direction.w;
        float part = clamp((cosine - outer) / max(light.color.w - outer, 1e-6), 0.0, 1.0);
        strength *= part * part * (3.0 - 2.0 * part);
    }
    return light.color.rgb * strength;
}

vec3 light_irradiance(sf_gpu_light light, vec3 world, out vec3 to_light)
{
    return light_irradiance_of(uint(light.position.w), light, world, to_light);
}

#endif
