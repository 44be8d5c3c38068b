#version 460
#extension GL_GOOGLE_include_directive : require
// The density extent method (METHODS B6; Krazanowski): the alpha of a particle's picture says how far its matter, evenly dense, reaches along the ray to either
// side of a plane, at most D: a = V (1/2 + 1/2 clamp((z_env - z_particle) / D / a_tex, -1, 1)). Both of his extensions: heights move the plane, pixel by
// pixel, and normals light the particle. The near plane takes from it as the scene does.
// V is the medium's: evenly dense matter along that extent, as much in the whole particle as in the medium's sphere.
#include "billboard/particle.glsl"
#include "billboard/picture.glsl"

layout(constant_id = 2) const uint DEVIATION = 0u;
layout(constant_id = 3) const uint LIGHTING = 0u;

// Of the square round a sphere's disc, the mean of its chord over its diameter.
const float SPHERE_MEAN = 0.52359878;

void main()
{
    sf_picture picture = picture_of(billboards[number].tile);
    vec4 color = picture_color(picture);
    vec4 shape = DEVIATION != 0u || LIGHTING != 0u ? picture_shape(picture) : vec4(0.0, 0.0, 1.0, 0.0);
    float plane = sphere.z - (DEVIATION != 0u ? own.z * shape.w * sphere.w : 0.0);
    float extent = own.x * sphere.w * max(color.a, 1e-3);
    float behind = clamp((depth_of_scene() - plane) / extent, -1.0, 1.0) * 0.5 + 0.5;
    float before = clamp((settings.x - plane) / extent, -1.0, 1.0) * 0.5 + 0.5;
    float depth = light.w * 2.0 * sphere.w * SPHERE_MEAN / max(picture.mean, 1e-3) * color.a;
    result = radiance_at(own.y * (1.0 - exp(-depth)) * max(behind - before, 0.0));
    result.rgb *= color.rgb / max(color.a, 1e-3);
    if (LIGHTING != 0u)
        result.rgb *= max(1.0 + own.w * dot(vec3(shape.xy, -shape.z), billboards[number].toward.xyz), 0.0);
}
