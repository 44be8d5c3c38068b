/* What the tests of thick smoke share: a device with validation, scenes drawn frame by frame, and their reference. */
#ifndef SF_TESTS_THICK_KIT_H
#define SF_TESTS_THICK_KIT_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "sfumato/sfumato.h"

enum { KIT_SETS = 8 };

static struct sf_device *kit_device;
static char kit_message[1024];

static void kit_write(void *user, enum sf_log_level level, const char *message)
{
    (void)user;
    (void)level;
    snprintf(kit_message, sizeof kit_message, "%s", message);
}
static const struct sf_log kit_log = {.write = kit_write, .level = SF_LOG_WARNING};

/* A scene that is being drawn. */
struct stage {
    struct sf_scene *scene;
    struct sf_renderer *renderer;
    struct sf_frame frame; /* the last one */
};

/* The smoke alone, as floats. */
struct picture {
    uint32_t width, height;
    float (*smoke)[4];  /* premultiplied radiance, opacity */
    float (*depths)[4]; /* near, far, optical depth, transmittance */
};

static inline struct stage stage_with(struct sf_scene *scene, uint32_t width, uint32_t height)
{
    struct stage stage = {.scene = scene};
    const struct sf_renderer_options options = {
        .width = width, .height = height, .aovs = SF_AOV_SMOKE | SF_AOV_DEPTHS, .float_aovs = true, .particles = true};

    if (sf_renderer_create(kit_device, scene, &options, &kit_log, &stage.renderer) != SF_OK)
        fail_msg("%s", kit_message);
    return stage;
}

/* A scene of scenes/truth, with up to KIT_SETS sets over it (a NULL behind the last). */
static inline struct stage stage_of(const char *name, const char *const sets[KIT_SETS], uint32_t width, uint32_t height)
{
    const char *root = getenv("SF_SOURCE_ROOT");
    struct sf_scene *scene = NULL;
    char path[1024];
    uint32_t count = 0;

    while (sets && count < KIT_SETS && sets[count])
        count++;
    snprintf(path, sizeof path, "%s/scenes/truth/%s.json", root ? root : ".", name);
    if (sf_scene_load(path, sets, count, &kit_log, &scene) != SF_OK)
        fail_msg("%s", kit_message);
    return stage_with(scene, width, height);
}

static inline struct stage stage_of_text(const char *json, uint32_t width, uint32_t height)
{
    struct sf_scene *scene = NULL;

    if (sf_scene_parse("test", json, strlen(json), NULL, 0, &kit_log, &scene) != SF_OK)
        fail_msg("%s: %s", json, kit_message);
    return stage_with(scene, width, height);
}

static inline void stage_end(struct stage *stage)
{
    sf_renderer_destroy(&stage->renderer);
    sf_scene_destroy(&stage->scene);
    assert_int_equal(sf_device_validation_messages(kit_device), 0);
}

static inline float (*kit_copy(const float *values, size_t pixels))[4]
{
    float(*copy)[4] = malloc(pixels * sizeof *copy);

    assert_non_null(copy);
    memcpy(copy, values, pixels * sizeof *copy);
    return copy;
}

/* Every value is a number, and in its range. */
static inline struct picture stage_draw(struct stage *stage, uint32_t number)
{
    uint64_t ticket = 0;

    if (sf_renderer_render(stage->renderer, number, &ticket) != SF_OK ||
        sf_renderer_wait(stage->renderer, ticket, &stage->frame) != SF_OK)
        fail_msg("frame %u: %s", number, kit_message);
    size_t pixels = (size_t)stage->frame.width * stage->frame.height;
    struct picture picture = {.width = stage->frame.width,
                              .height = stage->frame.height,
                              .smoke = kit_copy(stage->frame.smoke_float, pixels),
                              .depths = kit_copy(stage->frame.smoke_depths, pixels)};
    for (size_t i = 0; i < pixels; i++) {
        for (int k = 0; k < 4; k++)
            assert_true(isfinite(picture.smoke[i][k]) && picture.smoke[i][k] >= 0);
        assert_true(picture.smoke[i][3] <= 1 && picture.depths[i][3] >= 0 && picture.depths[i][3] <= 1);
    }
    return picture;
}

static inline void picture_free(struct picture *picture)
{
    free(picture->smoke);
    free(picture->depths);
    *picture = (struct picture){0};
}

static inline struct picture draw_text(const char *json, uint32_t width, uint32_t height)
{
    struct stage stage = stage_of_text(json, width, height);
    struct picture picture = stage_draw(&stage, 0);

    stage_end(&stage);
    return picture;
}

/* The reference for the stage's last frame; one pixel of each stride x stride block. */
static inline struct sf_reference_picture *stage_reference(const struct stage *stage, uint32_t stride)
{
    struct sf_reference *reference = NULL;
    struct sf_reference_picture *picture = NULL;
    const struct sf_reference_options options = {.tolerance = 1e-3, .floor = 1e-5};

    if (sf_reference_create(stage->scene, &stage->frame, &options, &kit_log, &reference) != SF_OK ||
        sf_reference_render(reference, NULL, stage->frame.width, stage->frame.height, stride, NULL, NULL, &picture) !=
            SF_OK)
        fail_msg("%s", kit_message);
    sf_reference_destroy(&reference);
    assert_int_equal(picture->unconverged, 0);
    return picture;
}

/* The pixel of the picture that the reference's pixel i stands for. */
static inline size_t pixel_of(const struct sf_reference_picture *reference, size_t i, uint32_t stride,
                              const struct picture *picture)
{
    uint32_t x = (uint32_t)(i % reference->width) * stride + stride / 2;
    uint32_t y = (uint32_t)(i / reference->width) * stride + stride / 2;

    x = x < picture->width ? x : picture->width - 1;
    y = y < picture->height ? y : picture->height - 1;
    return (size_t)y * picture->width + x;
}

/* How far a picture is from the truth. */
struct errors {
    double rms;           /* of the radiance over all smoky pixels and channels, over the truth's own rms there */
    double bias;          /* mean of the radiance's error over the truth's mean */
    double worst;         /* of the radiance, over the truth's brightest */
    double transmittance; /* worst */
    double mean;          /* radiance of the truth */
    size_t pixels;        /* smoky */
};

/* Over the pixels that `wanted` is true for (NULL: all) and that are smoky in the truth. */
static inline struct errors errors_of(const struct picture *picture, const struct sf_reference_picture *reference,
                                      uint32_t stride, const bool *wanted)
{
    struct errors errors = {0};
    double square = 0, truth_square = 0, sum = 0, truth_sum = 0, peak = 1e-12;

    for (size_t i = 0; i < (size_t)reference->width * reference->height; i++) {
        const struct sf_reference_pixel *truth = &reference->pixels[i];
        size_t at = pixel_of(reference, i, stride, picture);
        if (wanted && !wanted[i])
            continue;
        errors.transmittance =
            fmax(errors.transmittance, fabs((double)picture->depths[at][3] - (double)truth->transmittance));
        if (truth->optical_depth <= 0)
            continue;
        errors.pixels++;
        for (int k = 0; k < 3; k++) {
            double right = (double)truth->radiance[k], off = (double)picture->smoke[at][k] - right;
            square += off * off;
            truth_square += right * right;
            sum += off;
            truth_sum += right;
            peak = fmax(peak, right);
            errors.worst = fmax(errors.worst, fabs(off));
        }
    }
    errors.rms = sqrt(square / fmax(truth_square, 1e-30));
    errors.bias = sum / fmax(truth_sum, 1e-30);
    errors.worst /= peak;
    errors.mean = truth_sum / (3 * fmax((double)errors.pixels, 1));
    return errors;
}

/* Draws frame `number` and holds it to the reference. */
static inline struct errors stage_errors(struct stage *stage, uint32_t number, uint32_t stride)
{
    struct picture picture = stage_draw(stage, number);
    struct sf_reference_picture *reference = stage_reference(stage, stride);
    struct errors errors = errors_of(&picture, reference, stride, NULL);

    sf_reference_picture_destroy(&reference);
    picture_free(&picture);
    return errors;
}

static inline double picture_peak(const struct picture *picture)
{
    double peak = 0;

    for (size_t i = 0; i < (size_t)picture->width * picture->height; i++)
        for (int k = 0; k < 3; k++)
            peak = fmax(peak, (double)picture->smoke[i][k]);
    return peak;
}

/* The largest difference of a radiance. */
static inline double picture_apart(const struct picture *a, const struct picture *b)
{
    double apart = 0;

    for (size_t i = 0; i < (size_t)a->width * a->height; i++)
        for (int k = 0; k < 3; k++)
            apart = fmax(apart, fabs((double)a->smoke[i][k] - (double)b->smoke[i][k]));
    return apart;
}

static inline int kit_setup(void **state)
{
    const struct sf_device_options options = {.validate = true};
    enum sf_status status = sf_device_create(&options, &kit_log, &kit_device);

    (void)state;
    if (status == SF_ERROR_DEVICE)
        exit(77);
    return status;
}

static inline int kit_teardown(void **state)
{
    (void)state;
    sf_device_destroy(&kit_device);
    return 0;
}

#endif
