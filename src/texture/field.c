#include "texture/field.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>
#include "base/hash.h"
#include "shared/noise.h"

/* Of |noise| in units of its root mean square, and of the distance to the nearest point: means and deviations measured
 * at 4 10^7 points; three and four dimensions, points at rest and on their ways differ by less than 0.002. */
#define ABSOLUTE_MEAN  0.804f
#define ABSOLUTE_RMS   0.5945f
#define CELLS_MEAN     0.503f
#define CELLS_RMS      0.1587f
#define TWO_PI         6.2831853f
#define CHANGES_A_TURN 4 /* a cell's point that goes once around its middle has been in about so many places */

enum { CHANCE_TURN = 0x100, CHANCE_SHIFT = 0x200, CHANCE_SHEAR = 0x300, CHANCE_SEED = 0x400 };

/* Shoemake, "Uniform random rotations", Graphics Gems III. */
void sf_field_random_turn(uint32_t seed, uint32_t id, float turn[3][3])
{
    float u = sf_random_float(seed, id, CHANCE_TURN), a = TWO_PI * sf_random_float(seed, id, CHANCE_TURN + 1),
          b = TWO_PI * sf_random_float(seed, id, CHANCE_TURN + 2);
    float x = sqrtf(1 - u) * sinf(a), y = sqrtf(1 - u) * cosf(a), z = sqrtf(u) * sinf(b), w = sqrtf(u) * cosf(b);
    const float rows[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                              {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                              {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};

    memcpy(turn, rows, sizeof rows);
}

/* A lattice of whole cells in either direction, which cannot be turned; but it can lean, so that no line of its cells
 * runs to the viewer. */
static void repeating_turn(const struct sf_field_settings *settings, uint32_t number, struct sf_octave *octave)
{
    float angle = TWO_PI * sf_random_float(settings->seed, number, CHANCE_TURN);

    octave->period[0] = fmaxf(2, floorf(octave->frequency * settings->period_x + 0.5f));
    octave->period[1] = fmaxf(2, floorf(octave->frequency * settings->period_y + 0.5f));
    octave->turn[0][0] = octave->period[0] / settings->period_x;
    octave->turn[1][1] = octave->period[1] / settings->period_y;
    octave->turn[0][2] = 0.8f * octave->frequency * cosf(angle);
    octave->turn[1][2] = 0.8f * octave->frequency * sinf(angle);
    octave->turn[2][2] = octave->frequency;
}

/* Time runs through a fourth dimension that repeats. It also runs along the others, so that no moment is one where the
 * whole of space crosses a layer of the lattice, which would show as a beat. */
static void set_time(const struct sf_field_settings *settings, uint32_t number, float moment, struct sf_octave *octave)
{
    float faster = powf(settings->lacunarity, (float)number * (2.0f / 3)); /* Kolmogorov: smaller whirls turn faster */
    float cells = fmaxf(2, floorf((float)settings->changes * faster + 0.5f));
    float turns = fmaxf(1, floorf((float)settings->changes * faster / CHANGES_A_TURN + 0.5f));
    float angle = TWO_PI * (moment * turns - floorf(moment * turns)), along[3][3];

    octave->cosine = cosf(angle);
    octave->sine = sinf(angle);
    octave->period[3] = cells;
    octave->shift[3] += moment * cells;
    if (settings->period_x > 0) {
        octave->turn[3][0] = cells / settings->period_x;
        octave->turn[3][1] = cells / settings->period_y;
        return;
    }
    sf_field_random_turn(settings->seed ^ CHANCE_SHEAR, number, along);
    for (int i = 0; i < 3; i++)
        octave->turn[3][i] = 0.7f * octave->frequency * along[0][i];
}

void sf_field_init(const struct sf_field_settings *settings, float moment, struct sf_field *field)
{
    float amplitude = 1, frequency = settings->frequency, squares = 0;

    memset(field, 0, sizeof *field);
    field->kind = settings->kind;
    field->count = settings->octaves;
    moment -= floorf(moment);
    for (uint32_t number = 0; number < settings->octaves; number++) {
        struct sf_octave *octave = &field->octaves[number];

        octave->frequency = frequency;
        octave->amplitude = amplitude;
        octave->seed = sf_random_u32(settings->seed, number, CHANCE_SEED);
        octave->cosine = 1;
        for (uint32_t i = 0; i < 4; i++)
            octave->shift[i] = 64 * sf_random_float(settings->seed, number, CHANCE_SHIFT + i);
        if (settings->period_x > 0) {
            repeating_turn(settings, number, octave);
        } else {
            sf_field_random_turn(settings->seed, number, octave->turn);
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 3; j++)
                    octave->turn[i][j] *= frequency;
        }
        if (settings->changes > 0)
            set_time(settings, number, moment, octave);
        squares += amplitude * amplitude;
        amplitude *= settings->roughness;
        frequency *= settings->lacunarity;
    }
    field->scale = 1 / sqrtf(squares);
}

/* ---- many points at once ---- */

#if defined(__GNUC__)
#define INLINE static inline __attribute__((always_inline))
#else
#define INLINE static inline
#endif

/* Brings a lattice coordinate into 0..period, or leaves it where there is none. Twice, since rounding may leave it just
 * below 0. */
INLINE float reduce(float q, float period, float inverse)
{
    q -= period * (float)sf_noise_floor(q * inverse);
    return q - period * (float)sf_noise_floor(q * inverse);
}

struct place {
    float x[SF_FIELD_LANES], y[SF_FIELD_LANES], z[SF_FIELD_LANES], w[SF_FIELD_LANES];
};

INLINE void place_axis(const struct sf_octave *octave, int axis, const float *restrict x, const float *restrict y,
                       const float *restrict z, float *restrict q)
{
    float a = octave->turn[axis][0], b = octave->turn[axis][1], c = octave->turn[axis][2], shift = octave->shift[axis];
    float period = octave->period[axis], inverse = period > 0 ? 1 / period : 0;

    for (int i = 0; i < SF_FIELD_LANES; i++)
        q[i] = reduce(a * x[i] + b * y[i] + c * z[i] + shift, period, inverse);
}

INLINE void place_points(const struct sf_octave *octave, const float *restrict x, const float *restrict y,
                         const float *restrict z, struct place *restrict place)
{
    place_axis(octave, 0, x, y, z, place->x);
    place_axis(octave, 1, x, y, z, place->y);
    place_axis(octave, 2, x, y, z, place->z);
    place_axis(octave, 3, x, y, z, place->w);
}

INLINE void add_gradient(const struct sf_octave *octave, const struct place *restrict at, bool absolute,
                         float amplitude, float *restrict sum)
{
    int px = (int)octave->period[0], py = (int)octave->period[1], pw = (int)octave->period[3];

    if (pw == 0) {
        for (int i = 0; i < SF_FIELD_LANES; i++) {
            float value = sf_noise3(at->x[i], at->y[i], at->z[i], px, py, 0, octave->seed) * (1 / SF_NOISE3_RMS);

            sum[i] += amplitude * (absolute ? fabsf(value) : value);
        }
    } else {
        for (int i = 0; i < SF_FIELD_LANES; i++) {
            float value =
                sf_noise4(at->x[i], at->y[i], at->z[i], at->w[i], px, py, 0, pw, octave->seed) * (1 / SF_NOISE4_RMS);

            sum[i] += amplitude * (absolute ? fabsf(value) : value);
        }
    }
}

INLINE void add_cells(const struct sf_octave *octave, const struct place *restrict at, float amplitude,
                      float *restrict sum)
{
    int px = (int)octave->period[0], py = (int)octave->period[1];
    float cosine = octave->cosine, sine = octave->sine;
    uint32_t seed = octave->seed;

    for (int i = 0; i < SF_FIELD_LANES; i++)
        sum[i] -= amplitude * sqrtf(sf_noise_cells3(at->x[i], at->y[i], at->z[i], px, py, 0, cosine, sine, seed).first);
}

INLINE void sample(const struct sf_field *field, float finest, const float *restrict x, const float *restrict y,
                   const float *restrict z, float *restrict value)
{
    float sum[SF_FIELD_LANES] = {0}, mean = 0, scale = field->scale;

    for (uint32_t number = 0; number < field->count; number++) {
        const struct sf_octave *octave = &field->octaves[number];
        float weight = 2 - 2 * octave->frequency / finest, amplitude;
        struct place place;

        if (weight <= 0)
            break;
        amplitude = octave->amplitude * fminf(weight, 1);
        mean += amplitude;
        place_points(octave, x, y, z, &place);
        if (field->kind == SF_FIELD_CELLS)
            add_cells(octave, &place, amplitude, sum);
        else if (field->kind == SF_FIELD_ABSOLUTE)
            add_gradient(octave, &place, true, amplitude, sum);
        else
            add_gradient(octave, &place, false, amplitude, sum);
    }
    if (field->kind == SF_FIELD_CELLS) {
        mean *= -CELLS_MEAN;
        scale *= 1 / CELLS_RMS;
    } else if (field->kind == SF_FIELD_ABSOLUTE) {
        mean *= ABSOLUTE_MEAN;
        scale *= 1 / ABSOLUTE_RMS;
    } else {
        mean = 0;
    }
    for (int i = 0; i < SF_FIELD_LANES; i++)
        value[i] = (sum[i] - mean) * scale;
}

#if defined(__GNUC__) && defined(__x86_64__)
/* The same source for wider registers; without fused multiply-adds the bits are the same too. */
__attribute__((target("avx512f,avx512dq"))) static void
sample_avx512(const struct sf_field *field, float finest, const float *x, const float *y, const float *z, float *value)
{
    sample(field, finest, x, y, z, value);
}

__attribute__((target("avx2"))) static void sample_avx2(const struct sf_field *field, float finest, const float *x,
                                                        const float *y, const float *z, float *value)
{
    sample(field, finest, x, y, z, value);
}
#endif

void sf_field_sample_portable(const struct sf_field *field, float finest, const float *x, const float *y,
                              const float *z, float *value)
{
    sample(field, finest, x, y, z, value);
}

void sf_field_sample(const struct sf_field *field, float finest, const float *x, const float *y, const float *z,
                     float *value)
{
#if defined(__GNUC__) && defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) {
        sample_avx512(field, finest, x, y, z, value);
        return;
    }
    if (__builtin_cpu_supports("avx2")) {
        sample_avx2(field, finest, x, y, z, value);
        return;
    }
#endif
    sf_field_sample_portable(field, finest, x, y, z, value);
}
