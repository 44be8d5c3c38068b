/* Signed distance to the analytic objects: exact, in metres, negative inside, with the outward unit normal.
 *
 * All four solids are boxes in some coordinates q (distances beyond each face): the box in |x|, |y|, |z|; the cylinder in its radius and |y|; the
 * sphere in its radius; the plane in y. So one formula serves them, which suits devices that run both sides of a branch. */
#ifndef SF_LIB_SDF_GLSL
#define SF_LIB_SDF_GLSL
#include "shared/frame.h"

float sf_object_distance(sf_gpu_object object, vec3 world, out vec3 normal)
{
    const float none = -1.0e30;
    uint kind = uint(object.shape.w);
    bool box = kind == SF_OBJECT_KIND_BOX;
    bool cylinder = kind == SF_OBJECT_KIND_CYLINDER;
    bool plane = kind == SF_OBJECT_KIND_PLANE;
    vec3 p = vec3(dot(object.row0.xyz, world) + object.row0.w, dot(object.row1.xyz, world) + object.row1.w,
                  dot(object.row2.xyz, world) + object.row2.w);
    /* The first coordinate's own direction: x of a box, away from the axis or the centre of the round ones. */
    vec3 across = vec3(p.x, box || cylinder ? 0.0 : p.y, box ? 0.0 : p.z);
    float reach = length(across);
    across = reach > 0.0 ? across * (1.0 / reach) : vec3(box ? 1.0 : 0.0, box ? 0.0 : (cylinder ? 0.0 : 1.0), cylinder ? 1.0 : 0.0);
    across = plane ? vec3(0.0, 1.0, 0.0) : across;

    vec3 q = vec3(plane ? p.y : reach - object.shape.x, box || cylinder ? abs(p.y) - object.shape.y : none,
                  box ? abs(p.z) - object.shape.z : none);
    vec3 beyond = max(q, 0.0);
    float outside = length(beyond);
    float deepest = max(q.x, max(q.y, q.z));
    /* Outside: towards the nearest point of the box in q. Inside: through the nearest face; the first of equals. */
    bool away = deepest > 1.0e-12; /* below, squares vanish */
    vec3 way = away ? beyond * (1.0 / outside)
                    : (q.x >= deepest ? vec3(1.0, 0.0, 0.0) : (q.y >= deepest ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0)));
    vec3 local = across * way.x + vec3(0.0, p.y < 0.0 ? -way.y : way.y, p.z < 0.0 ? -way.z : way.z);

    normal = object.row0.xyz * local.x + object.row1.xyz * local.y + object.row2.xyz * local.z;
    return away ? outside : deepest;
}

#endif
