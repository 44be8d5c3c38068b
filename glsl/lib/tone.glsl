// From scene light to sRGB codes, as src/output/tone.c does it; the numbers and their sources stand there.
#ifndef SF_LIB_TONE_GLSL
#define SF_LIB_TONE_GLSL

// enum sf_tone_mode
const uint TONE_LINEAR = 0u, TONE_REINHARD = 1u, TONE_ACES = 2u, TONE_NEUTRAL = 3u;

vec3 tone_reinhard(vec3 c)
{
    float luminance = dot(vec3(0.2126, 0.7152, 0.0722), c);
    return c * ((1.0 + luminance / 16.0) / (1.0 + luminance));
}

vec3 tone_aces(vec3 c)
{
    vec3 x = vec3(dot(vec3(0.59719, 0.35458, 0.04823), c), dot(vec3(0.07600, 0.90834, 0.01566), c), dot(vec3(0.02840, 0.13383, 0.83777), c));
    vec3 v = (x * (x + 0.0245786) - 0.000090537) / (x * (0.983729 * x + 0.4329510) + 0.238081);
    return vec3(dot(vec3(1.60475, -0.53108, -0.07367), v), dot(vec3(-0.10208, 1.10813, -0.00605), v), dot(vec3(-0.00327, -0.07276, 1.07602), v));
}

vec3 tone_neutral(vec3 c)
{
    const float start = 0.8 - 0.04, room = 1.0 - start;
    float least = min(c.r, min(c.g, c.b)), offset = least < 0.08 ? least - 6.25 * least * least : 0.04;
    float peak = max(c.r, max(c.g, c.b)) - offset;
    c -= offset;
    float new_peak = 1.0 - room * room / (max(peak, start) + room - start);
    float grey = 1.0 - 1.0 / (0.15 * (peak - new_peak) + 1.0);
    vec3 bright = c * (new_peak / max(peak, start) * (1.0 - grey)) + new_peak * grey;
    return peak < start ? c : bright;
}

// Linear display values in [0,1] of linear light. Negative parts and NaN count as 0; what is beyond any sense is cut where squares stay finite.
vec3 tone_map(uint mode, vec3 light)
{
    vec3 c = vec3(light.r > 0.0 ? min(light.r, 1e12) : 0.0, light.g > 0.0 ? min(light.g, 1e12) : 0.0, light.b > 0.0 ? min(light.b, 1e12) : 0.0);
    if (mode == TONE_REINHARD)
        c = tone_reinhard(c);
    if (mode == TONE_ACES)
        c = tone_aces(c);
    if (mode == TONE_NEUTRAL)
        c = tone_neutral(c);
    return clamp(c, 0.0, 1.0);
}

// IEC 61966-2-1.
vec3 srgb_encode(vec3 linear)
{
    vec3 low = 12.92 * linear, high = 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055;
    return mix(high, low, lessThanEqual(linear, vec3(0.0031308)));
}

#endif
