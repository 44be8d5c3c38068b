#include "scene/environment.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "output/image.h"

enum { FACE_SIDE = SF_ENVIRONMENT_WIDTH / 4, FACES = 6, SKY_ROWS = 4096 };

static const double PI = 3.14159265358979323846;
/* Above this a picture's radiance is cut, as the table's; NaN and what is below 0 is black. */
static const float BRIGHTEST = 1e6f;

static float sane(float value)
{
    return value > 0 ? (value < BRIGHTEST ? value : BRIGHTEST) : 0;
}

/* ---- pictures ---- */

/* Sums of the source columns (or rows) in [from, to), the ends by their share. */
struct span {
    uint32_t first, last; /* inclusive */
    double head, tail;    /* weight of first and last */
};

static struct span span_of(uint32_t i, uint32_t from, uint32_t to)
{
    double a = (double)i * from / to, b = (double)(i + 1) * from / to;
    struct span span = {(uint32_t)a, (uint32_t)ceil(b) - 1, 0, 0};

    if (span.last >= from)
        span.last = from - 1;
    span.head = (span.first == span.last ? b : span.first + 1.0) - a;
    span.tail = b - span.last;
    return span;
}

/* Area average into `out` [height][width][3]. */
static void shrink(const struct sf_image *image, uint32_t width, uint32_t height, float *out)
{
    double area = (double)image->width / width * image->height / height;

    for (uint32_t y = 0; y < height; y++) {
        struct span rows = span_of(y, image->height, height);

        for (uint32_t x = 0; x < width; x++) {
            struct span columns = span_of(x, image->width, width);
            double sum[3] = {0};

            for (uint32_t j = rows.first; j <= rows.last; j++) {
                double v = j == rows.first ? rows.head : j == rows.last ? rows.tail : 1;
                const float *pixel = image->pixels + ((size_t)j * image->width + columns.first) * 4;

                for (uint32_t i = columns.first; i <= columns.last; i++, pixel += 4) {
                    double w = v * (i == columns.first ? columns.head : i == columns.last ? columns.tail : 1);

                    for (int c = 0; c < 3; c++)
                        sum[c] += w * sane(pixel[c]);
                }
            }
            for (int c = 0; c < 3; c++)
                *out++ = (float)(sum[c] / area);
        }
    }
}

static enum sf_status load_latlong(struct sf_environment *environment, const char *path, struct sf_arena *arena,
                                   const struct sf_log *log)
{
    struct sf_image image = {0};
    enum sf_status status = sf_image_read(path, &image, log);
    uint32_t width, height;

    if (status != SF_OK)
        return status;
    if (image.width != 2 * image.height) {
        status = sf_fail(log, SF_ERROR_SCENE, "'%s' is %ux%u; a panorama is twice as wide as high", path,
                         (unsigned)image.width, (unsigned)image.height);
    } else {
        width = image.width > SF_ENVIRONMENT_WIDTH ? SF_ENVIRONMENT_WIDTH : image.width;
        height = width / 2;
        environment->pixels = sf_arena_alloc(arena, (size_t)width * height * 3 * sizeof(float));
        if (environment->pixels) {
            shrink(&image, width, height, environment->pixels);
            environment->width = width;
            environment->height = height;
        } else {
            status = sf_fail(log, SF_ERROR_MEMORY, "'%s': out of memory", path);
        }
    }
    sf_image_finish(&image);
    return status;
}

/* Six faces of side x side pixels, [face][row][column][3]. */
struct cube {
    float *pixels;
    uint32_t side;
};

/* Bilinear within a face, after the table of cube map faces in the Vulkan and OpenGL specifications. */
static void cube_radiance(const struct cube *cube, const double d[3], double rgb[3])
{
    double ax = fabs(d[0]), ay = fabs(d[1]), az = fabs(d[2]), major, s, t, x, y, u, v;
    uint32_t face, last = cube->side - 1;

    if (ax >= ay && ax >= az) {
        face = d[0] > 0 ? 0 : 1;
        major = ax;
        s = d[0] > 0 ? -d[2] : d[2];
        t = -d[1];
    } else if (ay >= az) {
        face = d[1] > 0 ? 2 : 3;
        major = ay;
        s = d[0];
        t = d[1] > 0 ? d[2] : -d[2];
    } else {
        face = d[2] > 0 ? 4 : 5;
        major = az;
        s = d[2] > 0 ? d[0] : -d[0];
        t = -d[1];
    }
    x = fmin(fmax((s / major + 1) / 2 * cube->side - 0.5, 0), last);
    y = fmin(fmax((t / major + 1) / 2 * cube->side - 0.5, 0), last);
    u = x - floor(x);
    v = y - floor(y);
    for (int c = 0; c < 3; c++) {
        const float *pixels = cube->pixels + (size_t)face * cube->side * cube->side * 3 + c;
        size_t x0 = (size_t)x, y0 = (size_t)y, x1 = x0 < last ? x0 + 1 : x0, y1 = y0 < last ? y0 + 1 : y0;
        double top = pixels[(y0 * cube->side + x0) * 3] * (1 - u) + pixels[(y0 * cube->side + x1) * 3] * u;
        double low = pixels[(y1 * cube->side + x0) * 3] * (1 - u) + pixels[(y1 * cube->side + x1) * 3] * u;

        rgb[c] = top * (1 - v) + low * v;
    }
}

/* The panorama that shows what the cube shows. */
static enum sf_status unfold(struct sf_environment *environment, const struct cube *cube, struct sf_arena *arena)
{
    uint32_t width = 4 * cube->side, height = 2 * cube->side;
    float *out = sf_arena_alloc(arena, (size_t)width * height * 3 * sizeof(float));

    if (!out)
        return SF_ERROR_MEMORY;
    environment->pixels = out;
    environment->width = width;
    environment->height = height;
    for (uint32_t j = 0; j < height; j++) {
        for (uint32_t i = 0; i < width; i++, out += 3) {
            double sum[3] = {0}, rgb[3];

            for (int k = 0; k < 4; k++) {
                double phi = ((i + (k % 2 ? 0.75 : 0.25)) / width - 0.5) * 2 * PI;
                double theta = (j + (k / 2 ? 0.75 : 0.25)) / height * PI;
                double d[3] = {sin(theta) * sin(phi), cos(theta), -sin(theta) * cos(phi)};

                cube_radiance(cube, d, rgb);
                for (int c = 0; c < 3; c++)
                    sum[c] += rgb[c] / 4;
            }
            for (int c = 0; c < 3; c++)
                out[c] = (float)sum[c];
        }
    }
    return SF_OK;
}

static enum sf_status load_cube(struct sf_environment *environment, char *const *paths, struct sf_arena *arena,
                                const struct sf_log *log, uint32_t *bad)
{
    struct cube cube = {NULL, 0};
    struct sf_image image = {0};
    enum sf_status status = SF_OK;
    uint32_t whole = 0; /* side in the files */

    for (uint32_t face = 0; face < FACES && status == SF_OK; face++) {
        *bad = face;
        if ((status = sf_image_read(paths[face], &image, log)) != SF_OK)
            break;
        if (face == 0) {
            whole = image.width;
            cube.side = whole > FACE_SIDE ? FACE_SIDE : whole;
            cube.pixels = calloc((size_t)FACES * cube.side * cube.side * 3, sizeof(float));
        }
        if (image.width != whole || image.height != whole)
            status = sf_fail(log, SF_ERROR_SCENE, "'%s' is %ux%u; the six pictures of a cube are squares of one size",
                             paths[face], (unsigned)image.width, (unsigned)image.height);
        else if (!cube.pixels)
            status = sf_fail(log, SF_ERROR_MEMORY, "'%s': out of memory", paths[face]);
        else
            shrink(&image, cube.side, cube.side, cube.pixels + (size_t)face * cube.side * cube.side * 3);
        sf_image_finish(&image);
    }
    if (status == SF_OK && unfold(environment, &cube, arena) != SF_OK)
        status = sf_fail(log, SF_ERROR_MEMORY, "'%s': out of memory", paths[0]);
    free(cube.pixels);
    return status;
}

enum sf_status sf_environment_load(struct sf_environment *environment, char *const *paths, struct sf_arena *arena,
                                   const struct sf_log *log, uint32_t *bad)
{
    *bad = 0;
    if (environment->kind == SF_ENVIRONMENT_LATLONG)
        return load_latlong(environment, paths[0], arena, log);
    return load_cube(environment, paths, arena, log, bad);
}

/* ---- radiance ---- */

static double smooth(double edge, double x)
{
    double t = fmin(fmax(x / edge, 0), 1);

    return t * t * (3 - 2 * t);
}

static void sky(const struct sf_environment *environment, double y, double rgb[3])
{
    const float *far = y >= 0 ? environment->zenith : environment->ground;
    double w = y >= 0 ? smooth(1, y) : smooth(0.25, -y);

    for (int c = 0; c < 3; c++)
        rgb[c] = environment->horizon[c] + w * ((double)far[c] - environment->horizon[c]);
}

/* Bilinear; around the seam, and held at the poles. `d` is in the picture's frame. */
static void picture(const struct sf_environment *environment, const double d[3], double rgb[3])
{
    uint32_t width = environment->width, height = environment->height;
    double x = (0.5 + atan2(d[0], -d[2]) / (2 * PI)) * width - 0.5;
    double y = fmin(fmax(acos(fmin(fmax(d[1], -1), 1)) / PI * height - 0.5, 0), height - 1.0);
    double u = x - floor(x), v = y - floor(y);
    size_t x0 = (size_t)(floor(x) + width) % width, x1 = (x0 + 1) % width;
    size_t y0 = (size_t)y, y1 = y0 + 1 < height ? y0 + 1 : y0;

    for (int c = 0; c < 3; c++) {
        const float *p = environment->pixels + c;
        double top = p[(y0 * width + x0) * 3] * (1 - u) + p[(y0 * width + x1) * 3] * u;
        double low = p[(y1 * width + x0) * 3] * (1 - u) + p[(y1 * width + x1) * 3] * u;

        rgb[c] = top * (1 - v) + low * v;
    }
}

void sf_environment_radiance(const struct sf_environment *environment, const float direction[3], float rgb[3])
{
    double turn = environment->rotation * PI / 180, value[3] = {0};
    double d[3] = {cos(turn) * direction[0] - sin(turn) * direction[2], direction[1],
                   sin(turn) * direction[0] + cos(turn) * direction[2]};

    if (environment->pixels)
        picture(environment, d, value);
    else if (environment->kind == SF_ENVIRONMENT_SKY)
        sky(environment, direction[1], value);
    else
        for (int c = 0; c < 3; c++)
            value[c] = environment->color[c];
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)(value[c] * environment->intensity);
}

/* ---- spherical harmonics (Ramamoorthi and Hanrahan 2001, "An efficient representation for irradiance environment
 * maps") ---- */

static void basis(const double d[3], double out[9])
{
    double x = d[0], y = d[1], z = d[2];

    out[0] = 1;
    out[1] = y;
    out[2] = z;
    out[3] = x;
    out[4] = x * y;
    out[5] = y * z;
    out[6] = 3 * z * z - 1;
    out[7] = x * z;
    out[8] = x * x - y * y;
}

static void gather(double sums[9][3], const double d[3], double weight, const double rgb[3])
{
    double y[9];

    basis(d, y);
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            sums[i][c] += weight * y[i] * rgb[c];
}

static void gather_sky(const struct sf_environment *environment, double sums[9][3])
{
    /* The sky depends on y alone, and polynomials of the second degree have their mean over a ring at four points a
     * quarter turn apart. */
    for (int j = 0; j < SKY_ROWS; j++) {
        double y = (j + 0.5) / SKY_ROWS * 2 - 1, s = sqrt(1 - y * y), rgb[3];

        sky(environment, y, rgb);
        for (int k = 0; k < 4; k++) {
            double d[3] = {k == 0 ? s : k == 2 ? -s : 0, y, k == 1 ? s : k == 3 ? -s : 0};

            gather(sums, d, PI / SKY_ROWS, rgb);
        }
    }
}

static void gather_picture(const struct sf_environment *environment, double sums[9][3])
{
    double turn = environment->rotation * PI / 180;
    uint32_t fine = environment->width < SF_ENVIRONMENT_WIDTH ? SF_ENVIRONMENT_WIDTH / environment->width : 1;
    uint32_t width = environment->width * fine, height = environment->height * fine;

    for (uint32_t j = 0; j < height; j++) {
        double top = cos(PI * j / height), low = cos(PI * (j + 1) / height), y = (top + low) / 2, s = sqrt(1 - y * y);
        const float *row = environment->pixels + (size_t)(j / fine) * environment->width * 3;

        for (uint32_t i = 0; i < width; i++) {
            /* Ry(rotation) of the picture's direction: longitudes grow clockwise from above. */
            double phi = ((i + 0.5) / width - 0.5) * 2 * PI - turn;
            double d[3] = {s * sin(phi), y, -s * cos(phi)};
            const float *pixel = row + (size_t)(i / fine) * 3;
            double rgb[3] = {pixel[0], pixel[1], pixel[2]};

            gather(sums, d, (top - low) * 2 * PI / width, rgb);
        }
    }
}

void sf_environment_project(struct sf_environment *environment)
{
    /* The squares of the basis' constants, for what comes in and what goes out, times the cosine's share in each band:
     * 1, 2/3, 1/4. */
    static const double band[3] = {1, 2.0 / 3, 1.0 / 4};
    const double square[9] = {1 / (4 * PI),  3 / (4 * PI),  3 / (4 * PI),  3 / (4 * PI),  15 / (4 * PI),
                              15 / (4 * PI), 5 / (16 * PI), 15 / (4 * PI), 15 / (16 * PI)};
    double sums[9][3] = {{0}};

    if (environment->pixels)
        gather_picture(environment, sums);
    else if (environment->kind == SF_ENVIRONMENT_SKY)
        gather_sky(environment, sums);
    else
        for (int c = 0; c < 3; c++)
            sums[0][c] = environment->color[c] * 4 * PI;
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            environment->sh[i][c] = (float)(sums[i][c] * square[i] *
                                            band[i == 0  ? 0
                                                 : i < 4 ? 1
                                                         : 2] *
                                            environment->intensity);
}

void sf_environment_ambient(const struct sf_environment *environment, const float normal[3], float rgb[3])
{
    double d[3] = {normal[0], normal[1], normal[2]}, y[9], sum[3] = {0};

    basis(d, y);
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            sum[c] += y[i] * environment->sh[i][c];
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)sum[c];
}
