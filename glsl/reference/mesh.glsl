// Whether a triangle of the scene's meshes stands on a way: a walk through a hierarchy of boxes that needs no memory. Include it where `nodes`,
// `corners`, `push` and `verdict` are declared.
#ifndef SF_REFERENCE_MESH_GLSL
#define SF_REFERENCE_MESH_GLSL

uint mesh_turns = 0u; // of all walks of the invocation

bool box_met(sf_reference_node node, vec3 origin, vec3 inverse, float way)
{
    vec3 a = (vec3(node.min_x, node.min_y, node.min_z) - origin) * inverse;
    vec3 b = (vec3(node.max_x, node.max_y, node.max_z) - origin) * inverse;
    vec3 low = min(a, b), high = max(a, b);
    // A little more than the box, for what rounding puts on the wrong side.
    return max(max(low.x, low.y), max(low.z, 0.0)) <= min(min(high.x, high.y), min(high.z, way)) * 1.00001;
}

// Moeller and Trumbore 1997; both sides.
bool triangle_met(uint triangle, vec3 origin, vec3 direction, float way)
{
    vec3 from = corners[3u * triangle].xyz;
    vec3 a = corners[3u * triangle + 1u].xyz, b = corners[3u * triangle + 2u].xyz; // from it to the others
    vec3 p = cross(direction, b), s = origin - from, q = cross(s, a);
    float inverse = 1.0 / dot(a, p);
    float u = dot(s, p) * inverse, v = dot(direction, q) * inverse, t = dot(b, q) * inverse;
    return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= 0.0 && t < way; // false when the ray runs along it: then none is a number
}

// `direction` of unit length; in the world.
bool mesh_stands_between(vec3 origin, vec3 direction, float way)
{
    vec3 inverse = 1.0 / (direction + 1e-20); // no component is exactly 0 any more
    bool met = false;
    uint end = nodes[0].skip; // behind the last
    for (uint at = 0u; at < end && mesh_turns < push.budget; mesh_turns++) {
        sf_reference_node node = nodes[at];
        bool inside = box_met(node, origin, inverse, way);
        uint count = inside ? node.leaf & 7u : 0u;
        for (uint i = 0u; i < count; i++)
            met = met || triangle_met((node.leaf >> 3u) + i, origin, direction, way);
        mesh_turns += count;
        at = met ? end : inside ? at + 1u : node.skip;
    }
    return met;
}

#endif
