// Exact intersections of a line with the finite shapes, each about the origin of its own space: entry and exit along the line, entry > exit on a
// miss; and the normal at a point of the surface.
#ifndef SF_LIB_SOLID_GLSL
#define SF_LIB_SOLID_GLSL

const float NEVER = 3.0e38;

vec2 box_span(vec3 eye, vec3 ray, vec3 half_edges)
{
    // A ray along a face divides by zero: infinities of the right sign come out, and 0/0 is kept away by the tiny number.
    vec3 inverse = 1.0 / mix(ray, vec3(1e-30), lessThan(abs(ray), vec3(1e-30)));
    vec3 middle = -eye * inverse, reach = half_edges * abs(inverse);
    vec3 low = middle - reach, high = middle + reach;
    return vec2(max(max(low.x, low.y), low.z), min(min(high.x, high.y), high.z));
}

vec3 box_normal(vec3 at, vec3 half_edges)
{
    vec3 beyond = abs(at) - half_edges;
    float most = max(max(beyond.x, beyond.y), beyond.z);
    vec3 axis = most == beyond.x ? vec3(1.0, 0.0, 0.0) : most == beyond.y ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0);
    return axis * sign(at);
}

// The closest approach is taken first, so that no large squares are subtracted.
vec2 round_span(float along, float squared, float apart, float radius)
{
    float room = radius * radius - apart;
    float reach = sqrt(max(room, 0.0) / squared);
    return room >= 0.0 ? vec2(along - reach, along + reach) : vec2(NEVER, -NEVER);
}

vec2 sphere_span(vec3 eye, vec3 ray, float radius)
{
    float squared = dot(ray, ray);
    float along = -dot(eye, ray) / squared;
    vec3 closest = eye + along * ray;
    return round_span(along, squared, dot(closest, closest), radius);
}

// Axis y, with caps.
vec2 cylinder_span(vec3 eye, vec3 ray, float radius, float half_height)
{
    float squared = max(dot(ray.xz, ray.xz), 1e-30);
    float along = -dot(eye.xz, ray.xz) / squared;
    vec2 closest = eye.xz + along * ray.xz;
    vec2 side = round_span(along, squared, dot(closest, closest), radius);
    float inverse = 1.0 / (abs(ray.y) < 1e-30 ? 1e-30 : ray.y);
    float middle = -eye.y * inverse, reach = half_height * abs(inverse);
    return vec2(max(side.x, middle - reach), min(side.y, middle + reach));
}

vec3 cylinder_normal(vec3 at, float radius, float half_height)
{
    bool cap = abs(at.y) - half_height > length(at.xz) - radius;
    return cap ? vec3(0.0, sign(at.y), 0.0) : normalize(vec3(at.x, 0.0, at.z));
}

vec2 solid_span(uint kind, vec4 shape, vec3 eye, vec3 ray)
{
    if (kind == SF_OBJECT_KIND_BOX)
        return box_span(eye, ray, shape.xyz);
    if (kind == SF_OBJECT_KIND_SPHERE)
        return sphere_span(eye, ray, shape.x);
    return cylinder_span(eye, ray, shape.x, shape.y);
}

vec3 solid_normal(uint kind, vec4 shape, vec3 at)
{
    if (kind == SF_OBJECT_KIND_BOX)
        return box_normal(at, shape.xyz);
    if (kind == SF_OBJECT_KIND_SPHERE)
        return normalize(at);
    return cylinder_normal(at, shape.x, shape.y);
}

#endif
