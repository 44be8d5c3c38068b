#version 460
#extension GL_GOOGLE_include_directive : require
// Where the smoke begins and ends, for those who asked for it: blended MIN on colour. R near, G minus far (view depths, m).
#include "billboard/particle.glsl"
#include "lib/sphere.glsl"

void main()
{
    vec2 chord = sphere_chord(vec3(ray.xy, 1.0), sphere.xyz, sphere.w);
    float near = max(chord.x - chord.y, settings.x), far = min(chord.x + chord.y, depth_of_scene());
    result = chord.y > 0.0 && far > near ? vec4(near, -far, 1.0, 0.0) : vec4(SF_DEPTH_FAR, SF_DEPTH_FAR, 1.0, 0.0);
}
