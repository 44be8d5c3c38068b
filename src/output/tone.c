#include "output/tone.h"

#include <math.h>
#include <pthread.h>
#include <string.h>
#include "base/array.h"

static const char *const names[] = {
    [SF_TONE_LINEAR] = "linear",
    [SF_TONE_REINHARD] = "reinhard",
    [SF_TONE_ACES] = "aces",
    [SF_TONE_NEUTRAL] = "neutral",
};

enum sf_status sf_tone_parse(const char *name, enum sf_tone_mode *mode, const struct sf_log *log)
{
    for (size_t i = 0; i < SF_COUNT(names); i++) {
        if (strcmp(name, names[i]) == 0) {
            *mode = (enum sf_tone_mode)i;
            return SF_OK;
        }
    }
    return sf_fail(log, SF_ERROR_USAGE, "unknown tone mapping '%.64s': linear, reinhard, aces or neutral", name);
}

const char *sf_tone_name(enum sf_tone_mode mode)
{
    return names[mode];
}

/* Also turns NaN into 0. */
static float saturate(float x)
{
    return x > 0.0f ? (x < 1.0f ? x : 1.0f) : 0.0f;
}

/* Reinhard et al., "Photographic Tone Reproduction for Digital Images", 2002, equation 4: luminance only, white where L
 * is 4. */
static void map_reinhard(float c[3])
{
    const float white = 4.0f;
    float luminance = 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
    float scale = (1.0f + luminance / (white * white)) / (1.0f + luminance);

    for (int i = 0; i < 3; i++)
        c[i] *= scale;
}

/* S. Hill's fit of ACES RRT and ODT (sRGB, 100 nits), from MJP's BakingLab (MIT). */
static void map_aces(float c[3])
{
    static const float in[3][3] = {
        {0.59719f, 0.35458f, 0.04823f}, {0.07600f, 0.90834f, 0.01566f}, {0.02840f, 0.13383f, 0.83777f}};
    static const float out[3][3] = {
        {1.60475f, -0.53108f, -0.07367f}, {-0.10208f, 1.10813f, -0.00605f}, {-0.00327f, -0.07276f, 1.07602f}};
    float v[3];

    for (int i = 0; i < 3; i++) {
        float x = in[i][0] * c[0] + in[i][1] * c[1] + in[i][2] * c[2];

        v[i] = (x * (x + 0.0245786f) - 0.000090537f) / (x * (0.983729f * x + 0.4329510f) + 0.238081f);
    }
    for (int i = 0; i < 3; i++)
        c[i] = out[i][0] * v[0] + out[i][1] * v[1] + out[i][2] * v[2];
}

/* Khronos PBR Neutral tone mapper (2024), https://github.com/KhronosGroup/ToneMapping. */
static void map_neutral(float c[3])
{
    const float start = 0.8f - 0.04f, desaturation = 0.15f, room = 1.0f - start;
    float least = fminf(c[0], fminf(c[1], c[2])), offset = least < 0.08f ? least - 6.25f * least * least : 0.04f;
    float peak = fmaxf(c[0], fmaxf(c[1], c[2])) - offset, new_peak, grey;

    for (int i = 0; i < 3; i++)
        c[i] -= offset;
    if (peak < start)
        return;
    new_peak = 1.0f - room * room / (peak + room - start);
    grey = 1.0f - 1.0f / (desaturation * (peak - new_peak) + 1.0f);
    for (int i = 0; i < 3; i++)
        c[i] = c[i] * new_peak / peak * (1.0f - grey) + new_peak * grey;
}

/* `scale` is 2^exposure. Light beyond any sense (infinity too) is cut where the curves' squares stay finite. */
static void map(enum sf_tone_mode mode, float scale, const float light[3], float display[3])
{
    float c[3];

    for (int i = 0; i < 3; i++) {
        float x = light[i] * scale;

        c[i] = x > 0.0f ? (x < 1e12f ? x : 1e12f) : 0.0f;
    }
    switch (mode) {
    case SF_TONE_LINEAR:
        break;
    case SF_TONE_REINHARD:
        map_reinhard(c);
        break;
    case SF_TONE_ACES:
        map_aces(c);
        break;
    case SF_TONE_NEUTRAL:
        map_neutral(c);
        break;
    }
    for (int i = 0; i < 3; i++)
        display[i] = saturate(c[i]);
}

void sf_tone_map(const struct sf_tone *tone, const float light[3], float display[3])
{
    map(tone->mode, exp2f(tone->exposure), light, display);
}

double sf_srgb_encode(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1.0 / 2.4) - 0.055;
}

double sf_srgb_decode(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4);
}

/* Rounded sRGB codes without pow(): threshold[k] is the least light that gives code k, and below[b] counts the
 * thresholds up to the start of bin b of 4096. The curve's steepest part is 12.92 * 255 = 3295 codes for all of [0,1],
 * so a bin holds one threshold at most. */
static float threshold[257];
static uint8_t below[4097];
static pthread_once_t table_once = PTHREAD_ONCE_INIT;

static void make_table(void)
{
    unsigned code = 0;

    for (unsigned k = 1; k <= 255; k++)
        threshold[k] = (float)sf_srgb_decode((k - 0.5) / 255.0);
    threshold[256] = HUGE_VALF;
    for (unsigned bin = 0; bin <= 4096; bin++) {
        while (threshold[code + 1] <= (float)bin / 4096.0f)
            code++;
        below[bin] = (uint8_t)code;
    }
}

static uint8_t encode8(float display)
{
    unsigned code = below[(unsigned)(display * 4096.0f)];

    return (uint8_t)(code + (display >= threshold[code + 1]));
}

/* What PNG is to hold of one pixel: display values and alpha. */
static float prepare(enum sf_tone_mode mode, float scale, const float rgba[4], unsigned channels, float display[3])
{
    float light[3] = {rgba[0], rgba[1], rgba[2]}, alpha = saturate(rgba[3]);

    for (int i = 0; i < 3 && channels == 4; i++)
        light[i] = alpha > 0.0f ? light[i] / alpha : 0.0f;
    map(mode, scale, light, display);
    return alpha;
}

void sf_tone_encode8(const struct sf_tone *tone, const float *rgba, size_t count, unsigned channels, uint8_t *out)
{
    float scale = exp2f(tone->exposure);

    pthread_once(&table_once, make_table);
    for (size_t i = 0; i < count; i++, rgba += 4, out += channels) {
        float display[3], alpha = prepare(tone->mode, scale, rgba, channels, display);

        for (int c = 0; c < 3; c++)
            out[c] = encode8(display[c]);
        if (channels == 4)
            out[3] = (uint8_t)(alpha * 255.0f + 0.5f);
    }
}

void sf_tone_encode16(const struct sf_tone *tone, const float *rgba, size_t count, unsigned channels, uint16_t *out)
{
    float scale = exp2f(tone->exposure);

    for (size_t i = 0; i < count; i++, rgba += 4, out += channels) {
        float display[3], alpha = prepare(tone->mode, scale, rgba, channels, display);

        for (int c = 0; c < 3; c++)
            out[c] = (uint16_t)(sf_srgb_encode(display[c]) * 65535.0 + 0.5);
        if (channels == 4)
            out[3] = (uint16_t)(alpha * 65535.0f + 0.5f);
    }
}
