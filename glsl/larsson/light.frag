#version 460
#extension GL_GOOGLE_include_directive : require
// Intersects the imaginary sphere along the light's ray (L 3.3.2, pass 2). Blended MIN on colour, ADD on alpha:
// R nearest distance, G minus the farthest (so that MIN keeps it), B unused, A optical depth.
#include "shared/frame.h"
#include "lib/sphere.glsl"

layout(location = 0) in vec2 window;
layout(location = 1) flat in vec4 sphere;
layout(location = 2) flat in vec4 properties;
layout(location = 0) out vec4 result;

void main()
{
    bool perspective = properties.y > 0.5;
    vec3 ray = perspective ? normalize(vec3(window, 1.0)) : vec3(0.0, 0.0, 1.0);
    vec3 centre = perspective ? sphere.xyz : vec3(sphere.xy - window, sphere.z);
    vec2 chord = sphere_chord(ray, centre, sphere.w);
    float near = chord.x - chord.y;
    float far = chord.x + chord.y;
    if (perspective)
        near = max(near, 0.0);
    float middle = 0.5 * (near + far);
    float reach = 0.5 * (far - near) * properties.z;
    bool hit = chord.y > 0.0 && far > near;
    result = hit ? vec4(middle - reach, -middle - reach, 1.0, properties.x * (far - near)) : vec4(SF_DEPTH_FAR, SF_DEPTH_FAR, 1.0, 0.0);
}
