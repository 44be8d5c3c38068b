/* Volumetric soft particles (METHODS B7): what they keep on the device is noise in a cube that repeats, the same for every scene. */
#include <math.h>
#include <stdlib.h>
#include "methods/billboard.h"
#include "methods/sprites.h"
#include "methods/volumetric.h"
#include "shared/noise.h"
#include "shared/volumetric.h"

enum { SIDE = SF_VOLUMETRIC_SIDE, LAYER = SIDE * SIDE, TEXELS = SIDE * LAYER, OCTAVES = 3, FIELDS = 2 };

struct assets {
    void *detail; /* of sf_thick_assets_create */
    struct sf_gpu_image *noise;
};

/* ---- the noise ---- */

static void make_field(uint32_t field, float *values)
{
    for (size_t i = 0; i < TEXELS; i++)
        values[i] = 0;
    for (uint32_t octave = 0; octave < OCTAVES; octave++) {
        int cells = SF_VOLUMETRIC_CELLS << octave;
        float step = (float)cells / SIDE, amplitude = powf(SF_VOLUMETRIC_ROUGHNESS, (float)octave);
        /* Each octave begins elsewhere between lattice points, where gradient noise is 0. */
        float shift = 0.5f + 0.17f * (float)octave;

        for (size_t i = 0; i < TEXELS; i++) {
            float x = fmodf((float)(i % SIDE) * step + shift, (float)cells),
                  y = fmodf((float)(i / SIDE % SIDE) * step + shift, (float)cells),
                  z = fmodf((float)(i / LAYER) * step + shift, (float)cells);

            values[i] += amplitude * sf_noise3(x, y, z, cells, cells, cells, 16 * field + octave);
        }
    }
}

/* `other` NULL: 1 everywhere. */
static double mean_product(const float *values, const float *other)
{
    double sum = 0;

    for (size_t i = 0; i < TEXELS; i++)
        sum += (double)values[i] * (other ? (double)other[i] : 1);
    return sum / TEXELS;
}

/* Leaves a mean product of 0, where the other's mean square is 1. */
static void part_from(float *values, const float *other)
{
    float share = (float)mean_product(values, other);

    for (size_t i = 0; i < TEXELS; i++)
        values[i] -= share * (other ? other[i] : 1);
}

/* Both fields: mean 0, variance 1, mean product 0. The cube has few cells: by themselves they have it by chance only. */
static void make_fields(float *fields)
{
    for (uint32_t field = 0; field < FIELDS; field++) {
        float *values = fields + (size_t)field * TEXELS;

        make_field(field, values);
        part_from(values, NULL);
        if (field > 0)
            part_from(values, fields);
        float scale = (float)(1 / sqrt(mean_product(values, values)));
        for (size_t i = 0; i < TEXELS; i++)
            values[i] *= scale;
    }
}

static uint8_t packed(float value)
{
    return (uint8_t)lrintf(127.5f + 127.5f * fmaxf(fminf(value / SF_VOLUMETRIC_RANGE, 1), -1));
}

enum sf_status sf_volumetric_noise(uint8_t *texels)
{
    float *fields = malloc(sizeof *fields * FIELDS * TEXELS);

    if (!fields)
        return SF_ERROR_MEMORY;
    make_fields(fields);
    for (size_t field = 0; field < FIELDS; field++) {
        const float *values = fields + field * TEXELS;

        for (size_t i = 0; i < TEXELS; i++) {
            texels[4 * i + 2 * field] = packed(values[i]);
            texels[4 * i + 2 * field + 1] = packed(values[(i + LAYER) % TEXELS]);
        }
    }
    free(fields);
    return SF_OK;
}

/* ---- density ---- */

/* The mean of max(0, a + b n) over normally distributed n. */
static double mean_above(double a, double b)
{
    double x = a / b;

    return 0.5 * a * (1 + erf(x * sqrt(0.5))) + b * 0.3989422804014327 * exp(-0.5 * x * x);
}

void sf_volumetric_density(float strength, float density[3])
{
    enum { SHELLS = 64 };
    double inside = 1 + 0.4 * (double)strength, noise = 1.1 * (double)strength, fall = 2.2 * (double)strength, sum = 0;

    for (int i = 0; i < SHELLS && strength > 0; i++) {
        double radius = (i + 0.5) / SHELLS;

        sum += 3 * radius * radius / SHELLS * mean_above(inside - fall * radius * radius, noise);
    }
    density[0] = (float)(strength > 0 ? inside / sum : 1);
    density[1] = (float)(strength > 0 ? noise / sum : 0);
    density[2] = (float)(strength > 0 ? fall / sum : 0);
}

/* ---- the method ---- */

enum sf_status sf_volumetric_assets_create(struct sf_gpu *gpu, const struct sf_scene *scene, const struct sf_log *log,
                                           void **out)
{
    struct assets *assets = calloc(1, sizeof *assets);
    uint8_t *texels = malloc((size_t)4 * TEXELS);
    enum sf_status status = assets && texels ? sf_volumetric_noise(texels) : SF_ERROR_MEMORY;

    *out = assets;
    if (status)
        sf_fail(log, status, "volumetric.noise: out of memory");
    if (!status)
        status = sf_gpu_image_create(gpu, "volumetric.noise", SF_FORMAT_RGBA8_UNORM, SIDE, SIDE, SIDE,
                                     SF_ACCESS_SAMPLED, texels, &assets->noise);
    if (!status)
        status = sf_thick_assets_create(gpu, scene, log, &assets->detail);
    free(texels);
    if (status)
        sf_volumetric_assets_destroy(out);
    return status;
}

void sf_volumetric_assets_destroy(void **out)
{
    struct assets *assets = out ? *out : NULL;

    if (!assets)
        return;
    sf_thick_assets_destroy(&assets->detail);
    sf_gpu_image_destroy(&assets->noise);
    free(assets);
    *out = NULL;
}

bool sf_volumetric_assets_same(const struct sf_scene *a, const struct sf_scene *b)
{
    return sf_thick_assets_same(a, b);
}

void sf_volumetric_assets_bind(const struct sf_graph *graph, struct sf_player *player, void *data)
{
    const struct assets *assets = data;
    sf_resource noise = sf_graph_find(graph, "volumetric.noise");

    sf_thick_assets_bind(graph, player, assets->detail);
    if (noise)
        sf_player_bind_image(player, noise, assets->noise);
}

enum sf_status sf_volumetric_view(struct sf_method_frame *frame, void *state, const struct sf_log *log)
{
    const struct sf_volumetric_settings *settings = &frame->scene->volumetric;
    sf_resource noise = sf_graph_image(frame->graph, &(struct sf_image_desc){.name = "volumetric.noise",
                                                                             .format = SF_FORMAT_RGBA8_UNORM,
                                                                             .lifetime = SF_IMPORTED,
                                                                             .size = {.width = SIDE, .height = SIDE},
                                                                             .layers = SIDE,
                                                                             .outside = SF_ACCESS_SAMPLED});
    const struct sf_use uses[] = {
        {.resource = noise, .access = SF_ACCESS_SAMPLED, .binding = 4, .sampler = SF_SAMPLER_LINEAR_REPEAT},
    };
    const struct sf_billboard_look look = {
        .name = "volumetric.draw",
        .fragment = "volumetric/particle.frag",
        .whole = true,
        .uses = uses,
        .use_count = SF_COUNT(uses),
        .constants = {(uint32_t)settings->steps, settings->strength > 0, settings->lighting > 0},
        .constant_count = 3};

    return sf_billboard_view(frame, state, &look, log);
}
