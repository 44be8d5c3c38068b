/* What every pass of a frame may read: camera, lights, medium, environment, objects. Filled by src/render. */
#ifndef SF_SHARED_FRAME_H
#define SF_SHARED_FRAME_H
#include "types.h"

#define SF_FRAME_LIGHTS  8
#define SF_FRAME_RAMP    16
#define SF_FRAME_OBJECTS 64

#define SF_LIGHT_KIND_DIRECTIONAL 0
#define SF_LIGHT_KIND_POINT       1
#define SF_LIGHT_KIND_SPOT        2

#define SF_OBJECT_KIND_PLANE    0
#define SF_OBJECT_KIND_BOX      1
#define SF_OBJECT_KIND_SPHERE   2
#define SF_OBJECT_KIND_CYLINDER 3
#define SF_OBJECT_KIND_MESH     4

/* Depth written where no surface is, m. Finite, so that arithmetic on it stays finite; blurs must not mix it in. */
#define SF_DEPTH_FAR 1.0e6

struct sf_gpu_light {
    SF_VEC4(position);  /* xyz m; w: kind */
    SF_VEC4(direction); /* xyz the way the light travels; w: cosine of the outer half angle */
    SF_VEC4(color);     /* rgb: irradiance (directional) or radiant intensity (point, spot); w: cosine of the inner half
                           angle */
    SF_VEC4(shadow);    /* x: 1 when its shadow map is to be read; y: exponent; z: its cell; w: 1 / number of cells */
    SF_MAT4(world_to_map); /* exponential shadow map: to (u w, v w, depth, w), u and v in 0..1 of this light's cell, v
                              down, depth 0..1 and not divided by w; see lib/shadow.glsl */
};

struct sf_gpu_frame {
    SF_MAT4(world_to_view); /* view space: right-handed, looks along -z */
    SF_MAT4(view_to_clip);  /* Vulkan clip space, y down, reversed z with an infinite far plane */
    SF_MAT4(world_to_clip);
    SF_VEC4(eye);   /* xyz; w: near plane, m of view depth */
    SF_VEC4(right); /* xyz: camera's x axis times tan(fov_x / 2); w: tan(fov_x / 2) */
    SF_VEC4(up);    /* xyz: camera's y axis times tan(fov_y / 2); w: tan(fov_y / 2) */
    SF_VEC4(
        forward); /* xyz: unit. The ray of ndc (x, y up) with unit view depth is forward + x right + y up; w: time, s */
    SF_VEC4(right_low); /* xyz of each: what the float leaves out, for those who need more than 24 bits */
    SF_VEC4(up_low);
    SF_VEC4(forward_low);
    SF_VEC4(size);       /* frame's width, height, 1/width, 1/height */
    SF_VEC4(albedo);     /* rgb: medium's single-scattering albedo; w: g */
    SF_VEC4(emission);   /* rgb, per unit of extinction; w: unused */
    SF_VEC4(background); /* rgb when the environment is not visible; w: environment kind (0 sky, 1 color, 2 picture, 3
                            background) */
    SF_VEC4(zenith);     /* the sky's, times its intensity; w: the intensity, for pictures */
    SF_VEC4(horizon);    /* w: cosine of the rotation of pictures */
    SF_VEC4(ground);     /* w: its sine */
    SF_VEC4(sh[9]);      /* rgb: blurred environment, order-2 spherical harmonics (lib/environment.glsl evaluates) */
    SF_VEC4(ramp[SF_FRAME_RAMP]); /* rgb over life, evenly spaced from birth to death; w: unused */
    SF_UINT(light_count);
    SF_UINT(object_count);
    SF_UINT(frame_number);
    SF_UINT(seed);
    SF_STRUCT(sf_gpu_light) lights[SF_FRAME_LIGHTS];
};

/* A scene object, analytic. rows of world_to_object: xyz rotation, w translation (object = R world + t); objects keep
 * metres. */
struct sf_gpu_object {
    SF_VEC4(row0);
    SF_VEC4(row1);
    SF_VEC4(row2);
    SF_VEC4(shape); /* box: half edges; sphere: radius; cylinder: radius, half height; plane: none (object space y = 0).
                       w: kind */
    SF_VEC4(albedo);  /* rgb; w: checker's square, m, 0 none */
    SF_VEC4(albedo2); /* rgb; w: 1 when particles collide */
    SF_VEC4(bounce);  /* x restitution, y friction, z, w unused */
};

/* What flashes add to the picture. */
struct sf_flash_push {
    SF_VEC4(light); /* rgb, W/(m2 sr); w: unused */
};

/* Where a light sees the smoke from: fitted on the GPU to the particles' bounds each frame (thick/fit.comp). A point p
 * of the world has q = (view * p).xyz (x right, y up, z away from the light), uv = (perspective ? q.xy / q.z : q.xy) *
 * window.xy + window.zw in 0..1 of its cell (v down), and depth d = perspective ? length(q) : q.z. A light that stands in
 * the smoke, or close to it, looks all around: window.x is 0, and uv is the octahedral map of q. */
struct sf_gpu_light_view {
    SF_MAT4(view);
    SF_VEC4(window);
    SF_VEC4(
        info); /* x: 1 perspective, 2 all around; y: 1 valid (there is smoke, the light is on); z: m per texel at the smoke's
                      centre; w: unused */
};
#endif
