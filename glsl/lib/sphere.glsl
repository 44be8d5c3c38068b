// A sphere seen by a ray, and the rectangle that it covers on the screen.
#ifndef SF_LIB_SPHERE_GLSL
#define SF_LIB_SPHERE_GLSL

// Where the ray t v (v not normalised) from the origin crosses the sphere (c, r): middle and half length of the chord in t; half < 0 is a miss.
// Through the nearest point of the ray, not b*b - 4ac: that loses the chord of small spheres far away.
vec2 sphere_chord(vec3 v, vec3 c, float r)
{
    float inverse = 1.0 / dot(v, v);
    float middle = dot(v, c) * inverse;
    vec3 miss = c - middle * v;
    float left = (r * r - dot(miss, miss)) * inverse;
    return vec2(middle, left > 0.0 ? sqrt(left) : -1.0);
}

// Range of x/z over a circle at (x, z), radius r, seen from the origin towards +z; the parts behind the origin are clamped to `limit`.
vec2 circle_range(float x, float z, float r, float limit)
{
    float square = x * x + z * z - r * r;
    if (square <= 0.0 || z + r <= 0.0)
        return vec2(-limit, limit);
    float tangent = sqrt(square);
    // Directions of both tangents: (x, z) turned by +-asin(r / distance), up to a positive factor.
    vec2 low = vec2(x * tangent - z * r, z * tangent + x * r);
    vec2 high = vec2(x * tangent + z * r, z * tangent - x * r);
    return vec2(low.y > 0.0 ? low.x / low.y : -limit, high.y > 0.0 ? high.x / high.y : limit);
}

// How firmly a sphere of this optical depth across stands in a min/max view, -1..1. The surfaces of a faint sphere are drawn moved inwards
// and at last through each other, so that it does not set the depths of the denser smoke around it; its optical depth stays.
float sphere_firmness(float depth_across, float thin)
{
    return thin > 0.0 ? 2.0 * smoothstep(0.0, 1.0, depth_across / thin) - 1.0 : 1.0;
}

#endif
