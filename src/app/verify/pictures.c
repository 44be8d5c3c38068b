/* Pictures for the page: the smoke alone over an even grey, and the difference in brightness. */
#include "verify.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../console.h"

enum { NAME_ROOM = 192 };
static const float BACKDROP = 0.06f; /* linear: dark smoke shows on it as well as bright smoke */

/* A picture to be written. */
struct canvas {
    uint32_t width, height;
    float *rgba;
};

static enum sf_status canvas_init(struct canvas *canvas, uint32_t width, uint32_t height)
{
    *canvas = (struct canvas){width, height, malloc((size_t)width * height * 4 * sizeof(float))};
    return canvas->rgba ? SF_OK : sf_console_fail(SF_ERROR_MEMORY, "out of memory");
}

/* Writes it as the library writes frames, and lets go of it. */
static enum sf_status canvas_write(struct canvas *canvas, const struct sf_verify *verify, const char *name,
                                   const char *tone, float exposure)
{
    const struct sf_frame frame = {.width = canvas->width, .height = canvas->height, .color_float = canvas->rgba};
    char *path = sf_verify_folder_path(verify, name);
    enum sf_status status = path ? sf_frame_write_png(&frame, path, tone, exposure, sf_console_log())
                                 : sf_console_fail(SF_ERROR_MEMORY, "out of memory");

    free(path);
    free(canvas->rgba);
    return status;
}

static void lay_over(const float radiance[3], float transmittance, float *rgba)
{
    for (int c = 0; c < 3; c++)
        rgba[c] = radiance[c] + transmittance * BACKDROP;
    rgba[3] = 1;
}

static enum sf_status write_reference(const struct sf_verify *verify, const struct sf_verify_case *result,
                                      const struct sf_verify_drawn *drawn)
{
    const struct sf_reference_picture *picture = drawn->reference;
    char name[NAME_ROOM];
    struct canvas canvas;
    enum sf_status status = canvas_init(&canvas, picture->width, picture->height);

    for (size_t i = 0; i < (size_t)picture->width * picture->height && !status; i++)
        lay_over(picture->pixels[i].radiance, picture->pixels[i].transmittance, &canvas.rgba[4 * i]);
    sf_verify_picture_name(result, NULL, false, name, sizeof name);
    return status ? status : canvas_write(&canvas, verify, name, drawn->tone, drawn->exposure);
}

static enum sf_status write_smoke(const struct sf_verify *verify, const struct sf_verify_case *result,
                                  const struct sf_verify_drawn *drawn, size_t entry)
{
    const struct sf_layers *layers = &drawn->layers[entry];
    char name[NAME_ROOM];
    struct canvas canvas;
    enum sf_status status = canvas_init(&canvas, layers->width, layers->height);

    for (size_t i = 0; i < (size_t)layers->width * layers->height && !status; i++)
        lay_over(&layers->smoke[4 * i], 1 - layers->smoke[4 * i + 3], &canvas.rgba[4 * i]);
    sf_verify_picture_name(result, verify->entries[entry].method, false, name, sizeof name);
    return status ? status : canvas_write(&canvas, verify, name, drawn->tone, drawn->exposure);
}

/* ---- differences ---- */

void sf_verify_heat(double share, double rgb[3])
{
    static const double white[3] = {1, 1, 1};
    static const double red[2][3] = {{0.94, 0.48, 0.32}, {0.55, 0.02, 0.10}};
    static const double blue[2][3] = {{0.42, 0.66, 0.86}, {0.03, 0.18, 0.45}};
    double size = fmin(fabs(share), 1);
    const double(*end)[3] = share < 0 ? blue : red;
    const double *from = size < 0.5 ? white : end[0], *to = size < 0.5 ? end[0] : end[1];
    double way = size < 0.5 ? 2 * size : 2 * size - 1;

    for (int c = 0; c < 3; c++)
        rgb[c] = from[c] + way * (to[c] - from[c]);
}

/* Light that the writer of pictures makes that sRGB value of. */
static float decoded(double encoded)
{
    return (float)(encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4));
}

/* Green where the method has no number. */
static void heat_pixel(double off, double scale, float *rgba)
{
    double rgb[3] = {0, 0.8, 0};

    if (!isnan(off))
        sf_verify_heat(off / scale, rgb);
    for (int c = 0; c < 3; c++)
        rgba[c] = decoded(rgb[c]);
    rgba[3] = 1;
}

static enum sf_status write_difference(const struct sf_verify *verify, const struct sf_verify_case *result,
                                       const struct sf_verify_drawn *drawn, size_t entry)
{
    const struct sf_reference_picture *picture = drawn->reference;
    const struct sf_layers *layers = &drawn->layers[entry];
    char name[NAME_ROOM];
    struct canvas canvas;
    enum sf_status status = canvas_init(&canvas, picture->width, picture->height);

    for (size_t i = 0; i < (size_t)picture->width * picture->height && !status; i++) {
        uint32_t x = sf_errors_pixel((uint32_t)(i % picture->width), result->stride, layers->width);
        uint32_t y = sf_errors_pixel((uint32_t)(i / picture->width), result->stride, layers->height);
        const float *smoke = &layers->smoke[4 * ((size_t)y * layers->width + x)];

        heat_pixel(sf_errors_brightness(smoke, &picture->pixels[i]), result->scale, &canvas.rgba[4 * i]);
    }
    sf_verify_picture_name(result, verify->entries[entry].method, true, name, sizeof name);
    return status ? status : canvas_write(&canvas, verify, name, "linear", 0);
}

enum sf_status sf_verify_write_pictures(const struct sf_verify *verify, struct sf_verify_case *result,
                                        const struct sf_verify_drawn *drawn)
{
    enum sf_status status = SF_OK;

    result->scale = 1e-6;
    for (size_t i = 0; i < verify->entry_count && !status; i++)
        if (verify->entries[i].sweep == 0)
            status =
                sf_errors_scale(&drawn->layers[i], drawn->reference, result->stride, result->scale, &result->scale);
    if (!status)
        status = write_reference(verify, result, drawn);
    for (size_t i = 0; i < verify->entry_count && !status; i++) {
        if (verify->entries[i].sweep > 0)
            continue;
        status = write_smoke(verify, result, drawn, i);
        if (!status)
            status = write_difference(verify, result, drawn, i);
    }
    return status;
}
