#version 460
#extension GL_GOOGLE_include_directive : require
// Intersects the imaginary sphere along the camera's ray, cut off at the near plane and at the scene (L 3.3.2, pass 3). Blended MIN on
// colour, ADD on alpha: R near, G minus far (view depths, m), B life, A optical depth. Chords of uniform spheres add, so that A is exact.
#include "shared/frame.h"
#include "shared/thick.h"
#include "lib/sphere.glsl"

layout(constant_id = 0) const uint DETAIL = 0u;
layout(constant_id = 1) const uint CUT = 0u; // as in camera.vert
layout(set = 0, binding = 2) uniform sampler2D scene_depth;
layout(set = 0, binding = 3) uniform sampler2D atlas;

layout(location = 0) in vec4 ray;
layout(location = 1) flat in vec4 sphere;
layout(location = 2) flat in vec4 properties;
layout(location = 3) flat in float detail;
layout(location = 0) out vec4 result;

void main()
{
    vec3 v = vec3(ray.xy, 1.0);
    vec2 chord = sphere_chord(v, sphere.xyz, sphere.w); // in view depth, for v has unit depth
    if (DETAIL != 0u) {
        // The atlas dents the sphere: a thinner chord about the same middle.
        // Fetched, not filtered: the atlas is finer than the smoke's pixels, and a filtered look-up would double the pass's time on lavapipe.
        ivec2 at = ivec2(floor(ray.zw)) & (SF_THICK_ATLAS - 1);
        chord.y *= 1.0 - detail * (1.0 - texelFetch(atlas, at, 0).r);
    }
    float near = max(chord.x - chord.y, properties.z);
    float far = chord.x + chord.y;
    if (CUT != 0u)
        far = min(far, texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r);
    float middle = 0.5 * (near + far);
    float reach = 0.5 * (far - near) * properties.w;
    bool hit = chord.y > 0.0 && far > near;
    // A miss is blended as nothing: lavapipe is faster so than with a discard.
    result = hit ? vec4(middle - reach, -middle - reach, properties.y, properties.x * (far - near) * length(v)) : vec4(SF_DEPTH_FAR, SF_DEPTH_FAR, 1.0, 0.0);
}
