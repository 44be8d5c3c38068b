/* Divergence-free noise: the analytic curl of a gradient-noise vector potential (Bridson, Hourihan and Nordenstam, "Curl-noise for procedural
 * fluid flow", SIGGRAPH 2007).
 *
 * Each corner c of the unit lattice carries a random vector w_c, and near it the potential A_c(x) = 1/2 w_c x (x - c): three gradient noises that
 * share one vector, whose curl is w_c itself. Blended with the quintic weights f_c (C2, so the velocity is C1):
 *   psi = sum f_c A_c,   u = curl psi = sum [ f_c w_c + grad f_c x A_c ]
 *     = sum [ w_c (f_c + 1/2 grad f_c . d_c) - 1/2 d_c (grad f_c . w_c) ],   d_c = x - c.
 * This costs one hash a corner. In time w_c turns on an ellipse through two independent vectors of equal variance, so that the statistics stay as
 * they are; each corner has one of four speeds, so that the whole does not repeat. */
#ifndef SF_LIB_NOISE_GLSL
#define SF_LIB_NOISE_GLSL
#include "lib/hash.glsl"

/* 1 / rms of |u| over the cell, for w_c with components of variance 1/3 (integrated numerically over 64^3 points). */
#define SF_CURL_NOISE_NORM 1.65338

/* What one corner adds. `far` says on which side of the cell it lies, in 0 and 1; the other arguments are of the cell. */
vec3 sf_curl_noise_corner(vec3 far, vec3 f, vec3 rise, vec3 slope, uint key, vec4 cosines, vec4 sines)
{
    vec3 weight = mix(1.0 - rise, rise, far);
    vec3 change = slope * (2.0 * far - 1.0);
    vec3 d = f - far;
    uint bits = sf_hash_u32(key);
    vec3 a = vec3(uvec3(bits, bits >> 10u, bits >> 20u) & 1023u) * (1.0 / 512.0) - (1023.0 / 1024.0);
    bool first = (bits & 0x40000000u) != 0u, second = (bits & 0x80000000u) != 0u;
    vec2 even = first ? vec2(cosines.y, sines.y) : vec2(cosines.x, sines.x);
    vec2 odd = first ? vec2(cosines.w, sines.w) : vec2(cosines.z, sines.z);
    vec2 phase = second ? odd : even;
    vec3 w = a * phase.x + a.yzx * phase.y;
    float xy = weight.x * weight.y, xz = weight.x * weight.z, yz = weight.y * weight.z;
    vec3 gradient = change * vec3(yz, xz, xy);

    return w * (xy * weight.z + 0.5 * dot(gradient, d)) - d * (0.5 * dot(gradient, w));
}

/* Velocity of unit rms at lattice coordinates q. The phases are the cosines and sines of the four speeds' angles. */
vec3 sf_curl_noise(vec3 q, uint seed, vec4 cosines, vec4 sines)
{
    vec3 cell = floor(q);
    vec3 f = q - cell;
    vec3 rise = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    vec3 slope = 30.0 * f * f * (f - 1.0) * (f - 1.0);
    uvec3 near = uvec3(ivec3(cell)) * uvec3(0x9E3779B1u, 0x85EBCA77u, 0xC2B2AE3Du) + uvec3(seed, 0u, 0u);
    uvec3 next = near + uvec3(0x9E3779B1u, 0x85EBCA77u, 0xC2B2AE3Du);

    /* Written out: with constants for `far` most of a corner's products are shared with its neighbours. */
    return SF_CURL_NOISE_NORM * (sf_curl_noise_corner(vec3(0.0, 0.0, 0.0), f, rise, slope, near.x + near.y + near.z, cosines, sines) +
                                 sf_curl_noise_corner(vec3(1.0, 0.0, 0.0), f, rise, slope, next.x + near.y + near.z, cosines, sines) +
                                 sf_curl_noise_corner(vec3(0.0, 1.0, 0.0), f, rise, slope, near.x + next.y + near.z, cosines, sines) +
                                 sf_curl_noise_corner(vec3(1.0, 1.0, 0.0), f, rise, slope, next.x + next.y + near.z, cosines, sines) +
                                 sf_curl_noise_corner(vec3(0.0, 0.0, 1.0), f, rise, slope, near.x + near.y + next.z, cosines, sines) +
                                 sf_curl_noise_corner(vec3(1.0, 0.0, 1.0), f, rise, slope, next.x + near.y + next.z, cosines, sines) +
                                 sf_curl_noise_corner(vec3(0.0, 1.0, 1.0), f, rise, slope, near.x + next.y + next.z, cosines, sines) +
                                 sf_curl_noise_corner(vec3(1.0, 1.0, 1.0), f, rise, slope, next.x + next.y + next.z, cosines, sines));
}

/* `octaves` (at least 1) of it: each halves the size, doubles the rate of change, and carries 2^(-1/3) of the velocity (Kolmogorov: u goes with the
 * cube root of the size). Not normalised: the rms is sqrt(sum over octaves of 4^(-i/3)). Odd octaves lie on a turned lattice. */
vec3 sf_curl_noise_octaves(vec3 q, uint seed, uint octaves, vec4 cosines, vec4 sines)
{
    const mat3 turn = mat3(0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6);
    vec3 sum = vec3(0.0);
    float amplitude = 1.0;
    uint octave = 0u;

    do {
        bool odd = (octave & 1u) != 0u;
        vec3 u = sf_curl_noise(odd ? turn * q : q, seed, cosines, sines);
        vec4 doubled = 2.0 * sines * cosines;

        sum += amplitude * (odd ? u * turn : u);
        cosines = 2.0 * cosines * cosines - 1.0;
        sines = doubled;
        amplitude *= 0.79370053;
        q *= 2.0;
        seed += 0x632BE5ABu;
        octave++;
    } while (octave < octaves);
    return sum;
}

#endif
