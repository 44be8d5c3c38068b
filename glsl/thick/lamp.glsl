// Where samples along a ray stand for a lamp, whose light grows with the inverse square of the distance: at shares of what it sheds on the smoke that is
// seen, so that they crowd around the lamp. (Equiangular sampling, Kulla and Fajardo 2012, is the same for uniform smoke and without the last factor.)
// Include it where the ray's profile is declared: seen, opaque.
//
// Instead of 1 / (beside^2 + x^2), x from the point nearest to the lamp, samples go by 1 / (beside + |x|)^2, which is at least half as much: its integral and the
// inverse of that need no trigonometry. The samples' weights make up for it.
#ifndef SF_THICK_LAMP_GLSL
#define SF_THICK_LAMP_GLSL

// Lengths are view depths.
struct lamp_share {
    float nearest, beside; // where the ray comes closest to the lamp, and how far that is from it
    float start;           // lamp_way at seen.near
    vec4 way0, way1;       // how much lamp_way rises in each slice
    vec4 sent0, sent1;     // the light that each slice sends, of what reaches the eye
    vec4 from0, from1;     // what the lamp sheds on the slices before each, 0..1
    vec4 per0, per1;       // 1 / what it sheds on each
    vec4 long0, long1;     // 1 / the slices' lengths
    float mean;            // of 1 / (beside + |x|)^2 over the light that is sent
};

// The integral of beside / (beside + |x|)^2: -1..1.
vec4 lamp_way(vec4 x, float beside)
{
    return x / (beside + abs(x));
}

// The mean of 1 / (beside + |x|)^2 between a and b.
vec4 lamp_mean(vec4 a, vec4 b, float beside)
{
    return (1.0 + 2.0 * max(-a * b, 0.0) / (beside * max(b - a, 1e-9))) / ((beside + abs(a)) * (beside + abs(b)));
}

// The light that is sent from before a given optical depth.
vec4 lamp_sent(vec4 depth)
{
    return opaque > 1e-4 ? 1.0 - exp(-depth) : depth * (opaque / max(seen.whole, 1e-20));
}

lamp_share lamp_shares(vec3 to_lamp, vec3 ray)
{
    lamp_share lamp;
    float inverse = 1.0 / dot(ray, ray);
    lamp.nearest = dot(to_lamp, ray) * inverse;
    lamp.beside = max(length(to_lamp - lamp.nearest * ray) * sqrt(inverse), 1e-5);
    vec4 a0 = vec4(seen.near, seen.e0.xyz) - lamp.nearest, b0 = seen.e0 - lamp.nearest;
    vec4 a1 = vec4(seen.e0.w, seen.e1.xyz) - lamp.nearest, b1 = seen.e1 - lamp.nearest;
    vec4 start0 = lamp_way(a0, lamp.beside);
    lamp.start = start0.x;
    lamp.way0 = lamp_way(b0, lamp.beside) - start0;
    lamp.way1 = lamp_way(b1, lamp.beside) - lamp_way(a1, lamp.beside);
    vec4 sent0 = lamp_sent(seen.g0), sent1 = lamp_sent(seen.g1);
    lamp.sent0 = sent0 - vec4(0.0, sent0.xyz);
    lamp.sent1 = sent1 - vec4(sent0.w, sent1.xyz);
    vec4 shed0 = lamp.sent0 * lamp_mean(a0, b0, lamp.beside), shed1 = lamp.sent1 * lamp_mean(a1, b1, lamp.beside);
    lamp.mean = dot(shed0 + shed1, vec4(1.0));
    shed0 /= max(lamp.mean, 1e-30);
    shed1 /= max(lamp.mean, 1e-30);
    lamp.from0 = vec4(0.0, shed0.x, shed0.x + shed0.y, shed0.x + shed0.y + shed0.z);
    lamp.from1 = dot(shed0, vec4(1.0)) + vec4(0.0, shed1.x, shed1.x + shed1.y, shed1.x + shed1.y + shed1.z);
    lamp.per0 = 1.0 / max(shed0, 1e-7);
    lamp.per1 = 1.0 / max(shed1, 1e-7);
    lamp.long0 = 1.0 / max(b0 - a0, 1e-7);
    lamp.long1 = 1.0 / max(b1 - a1, 1e-7);
    return lamp;
}

// The view depth before which the lamp sheds the share `u` of its light, and the weight of a sample there, which is to be multiplied by its part of
// the range of `u` and by the lamp's irradiance.
vec2 lamp_place(lamp_share lamp, float u)
{
    float sent = dot(clamp((u - lamp.from0) * lamp.per0, 0.0, 1.0), lamp.sent0) + dot(clamp((u - lamp.from1) * lamp.per1, 0.0, 1.0), lamp.sent1);
    // Were the lamp's light even within each slice, it would stand at this optical depth.
    float depth = opaque > 1e-4 ? -log(max(1.0 - sent, 1e-7)) : sent * (seen.whole / max(opaque, 1e-20));
    vec4 before0 = vec4(0.0, seen.g0.xyz), before1 = vec4(seen.g0.w, seen.g1.xyz);
    float way = lamp.start + dot(clamp((depth - before0) * seen.h0, 0.0, 1.0), lamp.way0) + dot(clamp((depth - before1) * seen.h1, 0.0, 1.0), lamp.way1);
    float x = lamp.beside * way / max(1.0 - abs(way), 1e-7);
    float at = clamp(lamp.nearest + x, seen.near, seen.far);
    float reach = lamp.beside + abs(at - lamp.nearest);
    float there = dot(clamp((at - vec4(seen.near, seen.e0.xyz)) * lamp.long0, 0.0, 1.0), seen.g0 - before0) +
                  dot(clamp((at - vec4(seen.e0.w, seen.e1.xyz)) * lamp.long1, 0.0, 1.0), seen.g1 - before1); // the optical depth where it does stand
    return vec2(at, lamp.mean * reach * reach * exp(depth - there));
}

#endif
