// What the planes' vertices hand to the fragments for each of the first lights. Points are t ray + eye in every space.
#ifndef SF_SCENE_PLANES_GLSL
#define SF_SCENE_PLANES_GLSL

const uint NEAR = 2u;
#define NEAR_LIGHTS(way)                                         \
    layout(location = 12) flat way vec4 near_color[NEAR];        \
    layout(location = 14) flat way vec4 near_position[NEAR];     \
    layout(location = 16) flat way vec4 near_direction[NEAR];    \
    layout(location = 18) noperspective way vec4 map_ray[NEAR];  \
    layout(location = 20) flat way vec4 map_eye[NEAR];           \
    layout(location = 22) noperspective way vec3 smoke_ray[NEAR]; \
    layout(location = 24) flat way vec4 smoke_eye[NEAR];         \
    layout(location = 26) flat way vec4 window[NEAR];

#endif
