// Exact intersection of a line with a box, sphere or cylinder about the origin of its own space, all by the same steps (a software device takes
// both sides of a branch): the space between three pairs of planes, cut with a ball or a round column about y. A shape has those that
// it needs; the others are too far away to matter.
#ifndef SF_LIB_SOLID_GLSL
#define SF_LIB_SOLID_GLSL

const float SOLID_OPEN = 1e15;

// xyz: distance of the planes from the origin; w: radius.
vec4 solid_reach(uint kind, vec4 shape)
{
    if (kind == SF_OBJECT_KIND_BOX)
        return vec4(shape.xyz, SOLID_OPEN);
    if (kind == SF_OBJECT_KIND_SPHERE)
        return vec4(vec3(SOLID_OPEN), shape.x);
    return vec4(SOLID_OPEN, shape.y, SOLID_OPEN, shape.x);
}

// What y counts for in the roundness: 1 for a ball, 0 for a column.
float solid_ball(uint kind)
{
    return kind == SF_OBJECT_KIND_SPHERE ? 1.0 : 0.0;
}

// Half edges of the box around it.
vec3 solid_bounds(vec4 reach, float ball)
{
    return vec3(min(reach.x, reach.w), ball > 0.0 ? reach.w : reach.y, min(reach.z, reach.w));
}

// Entry and exit along the line eye + t ray; entry > exit on a miss.
vec2 solid_span(vec4 reach, float ball, vec3 eye, vec3 ray)
{
    vec3 inverse = 1.0 / (ray + 1e-20); // no component is exactly 0 any more
    vec3 middle = -eye * inverse, half_width = reach.xyz * abs(inverse);
    vec3 low = middle - half_width, high = middle + half_width;
    // From the point of the line that comes closest, so that no large squares are subtracted.
    vec3 weight = vec3(1.0, ball, 1.0);
    vec3 round_eye = eye * weight, round_ray = ray * weight;
    float squared = max(dot(round_ray, round_ray), 1e-30);
    float along = -dot(round_eye, round_ray) / squared;
    vec3 closest = round_eye + along * round_ray;
    float room = reach.w * reach.w - dot(closest, closest);
    float half_chord = sqrt(max(room, 0.0) / squared);
    float entry = max(max(low.x, low.y), max(low.z, along - half_chord));
    float leave = min(min(high.x, high.y), min(high.z, along + half_chord));
    return vec2(entry, room < 0.0 ? -SOLID_OPEN : leave);
}

// Outward, at a point of the surface.
vec3 solid_normal(vec4 reach, float ball, vec3 at)
{
    vec3 outward = at * vec3(1.0, ball, 1.0);
    vec3 beyond = abs(at) - reach.xyz;
    float round_beyond = 0.5 * (dot(outward, outward) / reach.w - reach.w); // to first order
    float most = max(beyond.x, max(beyond.y, beyond.z));
    vec3 side = vec3(beyond.x == most, beyond.y == most, beyond.z == most) * sign(at); // on an edge: between its faces, as long as it may be
    return round_beyond > most ? outward / reach.w : side;
}

#endif
