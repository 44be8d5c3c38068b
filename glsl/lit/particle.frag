#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Per-pixel lit smoke (METHODS B9; Reis 2008): wrap-around light on the atlas's normals, and light that comes through from behind, brightest at the rim.
#include "lit/puff.glsl"

void main()
{
    lit_puff puff = read_puff();
    lit_sum sum = lit_sum(vec3(0.0), vec2(0.0));
    // What comes through is dimmed by what the puff covers (the translucency map), and by the way through a ball, which is as long as N . E.
    float through = (1.0 - puff.opacity * puff.color.a) * exp(-push.more[0].y * max(dot(puff.normal, puff.to_eye), 0.0));
    [[unroll]] for (uint i = 0u; i < LIGHTS; i++) {
        vec3 to_light;
        vec3 irradiance = irradiance_of(i, puff.place, to_light);
        add_light(sum, i, irradiance, wrapped(dot(puff.normal, to_light)) + through * from_behind(puff.to_eye, to_light));
    }
    result = lit_result(puff, sum);
}
