/* What every texture has, made or read. */
#include "texture/texture.h"

#include <math.h>
#include <stdlib.h>

struct sf_texture *sf_texture_alloc(uint32_t width, uint32_t height, uint32_t tiles_x, uint32_t tiles_y)
{
    struct sf_texture *texture = calloc(1, sizeof *texture);
    size_t count = (size_t)width * height * 4;

    if (!texture)
        return NULL;
    texture->color = calloc(count, sizeof *texture->color);
    texture->shape = calloc(count, sizeof *texture->shape);
    texture->info = (struct sf_texture_info){.width = width,
                                             .height = height,
                                             .tiles_x = tiles_x,
                                             .tiles_y = tiles_y,
                                             .loop = 1,
                                             .color = texture->color,
                                             .shape = texture->shape};
    if (!texture->color || !texture->shape)
        sf_texture_destroy(&texture);
    return texture;
}

void sf_texture_destroy(struct sf_texture **place)
{
    struct sf_texture *texture = place ? *place : NULL;

    if (!texture)
        return;
    free(texture->color);
    free(texture->shape);
    free(texture->made);
    free(texture);
    *place = NULL;
}

void sf_texture_describe(const struct sf_texture *texture, struct sf_texture_info *info)
{
    *info = texture->info;
}

/* ---- normals ---- */

/* Of the texels before and behind, one may be beyond the tile's border: on the other side where it repeats, else there
 * is none. */
struct neighbours {
    uint32_t before, behind;
    float apart; /* texels */
};

static struct neighbours neighbours_of(uint32_t i, uint32_t count, bool around)
{
    struct neighbours two = {i > 0 ? i - 1 : 0, i + 1 < count ? i + 1 : i, 2};

    if (around) {
        two.before = i > 0 ? i - 1 : count - 1;
        two.behind = i + 1 < count ? i + 1 : 0;
    } else {
        two.apart = (float)(two.behind - two.before);
    }
    return two;
}

static void tile_normals(const struct sf_texture *texture, uint32_t left, uint32_t top)
{
    const struct sf_texture_info *info = &texture->info;
    uint32_t width = info->width / info->tiles_x, height = info->height / info->tiles_y;
    float *const tile = texture->shape + 4 * ((size_t)top * info->width + left);
    float half = 0.5f * (float)(width < height ? width : height); /* texels to a unit of height */

    for (uint32_t y = 0; y < height; y++) {
        struct neighbours rows = neighbours_of(y, height, info->tileable);
        const float *upper = tile + 4 * (size_t)rows.before * info->width,
                    *lower = tile + 4 * (size_t)rows.behind * info->width;
        float *row = tile + 4 * (size_t)y * info->width;

        for (uint32_t x = 0; x < width; x++) {
            struct neighbours columns = neighbours_of(x, width, info->tileable);
            float dx = (row[4 * columns.behind + 3] - row[4 * columns.before + 3]) * half / columns.apart;
            float dy = (upper[4 * x + 3] - lower[4 * x + 3]) * half / rows.apart;
            float shrink = 1 / sqrtf(1 + dx * dx + dy * dy);

            row[4 * x] = -dx * shrink;
            row[4 * x + 1] = -dy * shrink;
            row[4 * x + 2] = shrink;
        }
    }
}

void sf_texture_normals(struct sf_texture *texture)
{
    const struct sf_texture_info *info = &texture->info;

    for (uint32_t y = 0; y < info->tiles_y; y++)
        for (uint32_t x = 0; x < info->tiles_x; x++)
            tile_normals(texture, x * (info->width / info->tiles_x), y * (info->height / info->tiles_y));
}

/* ---- light in the colour ---- */

/* Weighted sums over texels: of the normal's parts and the luminance, and of their products. */
struct sums {
    double weight, mean[4], product[4][4];
};

static void add_texel(struct sums *sums, const float *color, const float *shape)
{
    double values[4] = {shape[0], shape[1], shape[2],
                        0.2126 * (double)color[0] + 0.7152 * (double)color[1] + 0.0722 * (double)color[2]};
    double weight = color[3];

    sums->weight += weight;
    for (int i = 0; i < 4; i++) {
        sums->mean[i] += weight * values[i];
        for (int j = 0; j < 4; j++)
            sums->product[i][j] += weight * values[i] * values[j];
    }
}

/* Solves the three normal equations by elimination. They are made a little stiffer, so that normals that are all alike
 * (or all in a plane) do no harm. */
static void solve(double m[3][4], double gradient[3])
{
    for (int i = 0; i < 3; i++)
        m[i][i] += 1e-9;
    for (int i = 0; i < 3; i++)
        for (int j = i + 1; j < 3; j++) {
            double times = m[j][i] / m[i][i];

            for (int k = i; k < 4; k++)
                m[j][k] -= times * m[i][k];
        }
    for (int i = 2; i >= 0; i--) {
        gradient[i] = m[i][3];
        for (int j = i + 1; j < 3; j++)
            gradient[i] -= m[i][j] * gradient[j];
        gradient[i] /= m[i][i];
    }
}

void sf_texture_lighting(const struct sf_texture *texture, double *slope, double *correlation)
{
    size_t count = (size_t)texture->info.width * texture->info.height * 4;
    struct sums sums = {0};
    double m[3][4], gradient[3], with[3], squares = 0, explained = 0;

    *slope = *correlation = 0;
    for (size_t i = 0; i < count; i += 4)
        add_texel(&sums, texture->color + i, texture->shape + i);
    if (!(sums.weight > 0))
        return;
    for (int i = 0; i < 4; i++)
        sums.mean[i] /= sums.weight;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 4; j++)
            m[i][j] = sums.product[i][j] / sums.weight - sums.mean[i] * sums.mean[j];
        with[i] = m[i][3];
    }
    solve(m, gradient);
    for (int i = 0; i < 3; i++) {
        squares += gradient[i] * gradient[i];
        explained += gradient[i] * with[i];
    }
    double variance = sums.product[3][3] / sums.weight - sums.mean[3] * sums.mean[3];

    if (sums.mean[3] > 0 && variance > 1e-12 * sums.mean[3] * sums.mean[3]) {
        *slope = sqrt(squares) / sums.mean[3];
        *correlation = sqrt(fmin(fmax(explained / variance, 0), 1));
    }
}
