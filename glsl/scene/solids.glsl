// What the solids' vertices hand to their fragments. Everything is in the object's own space, where points are t ray + eye and the ray of pixel
// (x, y) is forward + x right + y up.
#ifndef SF_SCENE_SOLIDS_GLSL
#define SF_SCENE_SOLIDS_GLSL

const uint NEAR = 1u;
#define SOLID_VARYINGS(way)                                                                                   \
    layout(location = 0) flat way vec4 forward;                    /* w: 1/width */                           \
    layout(location = 1) flat way vec4 right;                      /* w: 1/height */                          \
    layout(location = 2) flat way vec4 up;                         /* w: near plane */                        \
    layout(location = 3) flat way vec4 eye;                        /* w: shadow exponent */                   \
    layout(location = 4) flat way vec4 reach;                      /* as solid_reach gives it */              \
    layout(location = 5) flat way vec4 albedo;                     /* w: number in the object list */         \
    layout(location = 6) flat way vec3 axes[3];                    /* the world's, in the object's space */   \
    layout(location = 9) flat way vec4 ground;                     /* of plane 0, as in planes.vert */        \
    layout(location = 10) flat way vec4 light_color;               /* of light 0 */                           \
    layout(location = 11) flat way vec4 light_position;            /* from the eye */                         \
    layout(location = 12) flat way vec4 light_direction;           /* w: cosine of the outer angle */         \
    layout(location = 13) flat way vec4 map[4];                    /* in its map: forward, right, up, eye */  \
    layout(location = 17) flat way vec4 smoke[4];                  /* as it sees the smoke; w: the window */  \
    layout(location = 21) flat way vec4 level[3];                  /* ambient light by powers of the normal's y; w of 0: solid_ball */

#endif
