// The light from all around (docs/scene.md). Include it where `frame` is declared.
#ifndef SF_LIB_ENVIRONMENT_GLSL
#define SF_LIB_ENVIRONMENT_GLSL

// Radiance of a Lambertian surface of albedo 1 facing `normal` (unit) under the whole environment: spherical harmonics of order 2, already
// convolved with the cosine and multiplied by the basis' constants.
vec3 environment_blurred(vec3 normal)
{
    float x = normal.x, y = normal.y, z = normal.z;
    vec3 sum = frame.sh[0].rgb + y * frame.sh[1].rgb + z * frame.sh[2].rgb + x * frame.sh[3].rgb;
    sum += x * y * frame.sh[4].rgb + y * z * frame.sh[5].rgb + (3.0 * z * z - 1.0) * frame.sh[6].rgb;
    sum += x * z * frame.sh[7].rgb + (x * x - y * y) * frame.sh[8].rgb;
    return max(sum, 0.0);
}

// 1 / sqrt(x) to 5e-6 of itself: two steps of Newton from a first guess off the exponent. Software devices divide and take roots slowly, and the
// sky is large.
float environment_inverse_root(float x)
{
    float r = uintBitsToFloat(0x5f375a86u - (floatBitsToUint(x) >> 1u));
    r *= 1.5 - 0.5 * x * r * r;
    return r * (1.5 - 0.5 * x * r * r);
}

// The gradient sky in direction `ray` (any length): from the horizon up to the zenith, and within 0.25 down to the ground.
vec3 environment_gradient(vec3 ray, vec3 zenith, vec3 horizon, vec3 ground)
{
    float y = ray.y * environment_inverse_root(dot(ray, ray));
    float part = clamp(y >= 0.0 ? y : -4.0 * y, 0.0, 1.0);
    return mix(horizon, y >= 0.0 ? zenith : ground, part * part * (3.0 - 2.0 * part));
}

// Where a picture shows direction `ray`: its middle looks along -z; `turn`: cosine and sine of the environment's rotation.
vec2 environment_uv(vec3 ray, vec2 turn)
{
    vec3 d = normalize(ray);
    d.xz = vec2(turn.x * d.x - turn.y * d.z, turn.y * d.x + turn.x * d.z);
    return vec2(0.5 + atan(d.x, -d.z) * 0.159154943, acos(clamp(d.y, -1.0, 1.0)) * 0.318309886);
}

#endif
