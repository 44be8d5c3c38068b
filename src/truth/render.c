/* A whole picture of the smoke, row by row. */
#include <math.h>
#include <stdlib.h>
#include "truth/inner.h"
#include "truth/vec.h"

struct render {
    const struct sf_truth *truth;
    struct sf_truth_view view;
    uint32_t stride;
    struct sf_truth_picture *picture;
};

/* As src/render/uniforms.c makes them. */
void sf_truth_view(const struct sf_camera_pose *pose, uint32_t width, uint32_t height, struct sf_truth_view *view)
{
    double tan_y = tan(pose->fov * (3.14159265358979323846 / 180) / 2), up[3];

    for (int i = 0; i < 3; i++) {
        view->eye[i] = pose->eye[i];
        view->forward[i] = (double)pose->target[i] - pose->eye[i];
        up[i] = pose->up[i];
    }
    vec_normalize(view->forward);
    vec_cross(view->forward, up, view->right);
    if (vec_dot(view->right, view->right) < 1e-12) { /* looking along `up`: any other axis serves */
        bool level = fabs(view->forward[2]) < 0.5;
        double other[3] = {level ? 0 : 1, 0, level ? 1 : 0};

        vec_cross(view->forward, other, view->right);
    }
    vec_normalize(view->right);
    vec_cross(view->right, view->forward, view->up);
    for (int i = 0; i < 3; i++) {
        view->right[i] *= tan_y * width / height;
        view->up[i] *= tan_y;
    }
    view->near = pose->near_clip;
    view->width = width;
    view->height = height;
}

void sf_truth_view_ray(const struct sf_truth_view *view, uint32_t x, uint32_t y, double direction[3])
{
    double across = 2 * (x + 0.5) / view->width - 1, upward = 1 - 2 * (y + 0.5) / view->height;

    for (int i = 0; i < 3; i++)
        direction[i] = view->forward[i] + across * view->right[i] + upward * view->up[i];
}

/* The pixel that stands for a block. */
static uint32_t chosen(uint32_t block, uint32_t stride, uint32_t side)
{
    uint64_t pixel = (uint64_t)block * stride + stride / 2;

    return pixel < side ? (uint32_t)pixel : side - 1;
}

static enum sf_status render_row(void *user, uint32_t y, const atomic_bool *stopped)
{
    const struct render *render = user;
    const struct sf_truth_view *view = &render->view;
    uint32_t width = render->picture->width, stride = render->stride;
    struct sf_truth_space space = {0};
    enum sf_status status = SF_OK;

    for (uint32_t x = 0; x < width && status == SF_OK && !atomic_load(stopped); x++) {
        size_t at = (size_t)y * width + x;
        double direction[3];

        sf_truth_view_ray(view, chosen(x, stride, view->width), chosen(y, stride, view->height), direction);
        render->picture->depth[at] = sf_truth_surface(render->truth, view->eye, direction, view->near);
        status = sf_truth_ray_in(render->truth, &space, view->eye, direction, view->near, render->picture->depth[at],
                                 &render->picture->pixels[at]);
    }
    sf_truth_space_finish(&space);
    return status;
}

static bool result_is_finite(const struct sf_truth_result *result)
{
    return isfinite(result->radiance[0]) && isfinite(result->radiance[1]) && isfinite(result->radiance[2]) &&
           isfinite(result->transmittance) && isfinite(result->optical_depth) && isfinite(result->error);
}

static enum sf_status check(const struct render *render, const struct sf_log *log)
{
    struct sf_truth_picture *picture = render->picture;

    for (uint32_t y = 0; y < picture->height; y++) {
        for (uint32_t x = 0; x < picture->width; x++) {
            const struct sf_truth_result *result = &picture->pixels[(size_t)y * picture->width + x];

            if (!result_is_finite(result))
                return sf_fail(log, SF_ERROR_INTERNAL,
                               "reference: pixel (%u, %u) is not a number: radiance %g %g %g, transmittance %g",
                               chosen(x, render->stride, render->view.width),
                               chosen(y, render->stride, render->view.height), result->radiance[0], result->radiance[1],
                               result->radiance[2], result->transmittance);
            picture->unconverged += !result->converged;
        }
    }
    return SF_OK;
}

enum sf_status sf_truth_render(const struct sf_truth *truth, const struct sf_camera_pose *pose, uint32_t width,
                               uint32_t height, const struct sf_truth_work *work, struct sf_truth_picture **out)
{
    struct render render = {.truth = truth, .stride = work->stride > 1 ? work->stride : 1};
    struct sf_truth_picture *picture;
    enum sf_status status = SF_ERROR_MEMORY;

    *out = NULL;
    if (width == 0 || height == 0)
        return sf_fail(work->log, SF_ERROR_USAGE, "reference: a picture of %ux%u pixels", width, height);
    picture = calloc(1, sizeof *picture);
    if (picture) {
        picture->width = (width - 1) / render.stride + 1;
        picture->height = (height - 1) / render.stride + 1;
        picture->pixels = calloc((size_t)picture->width * picture->height, sizeof *picture->pixels);
        picture->depth = calloc((size_t)picture->width * picture->height, sizeof *picture->depth);
    }
    if (picture && picture->pixels && picture->depth) {
        render.picture = picture;
        sf_truth_view(pose, width, height, &render.view);
        status = sf_truth_rows(picture->height, work, render_row, &render);
    }
    if (status == SF_OK)
        status = check(&render, work->log);
    else if (status == SF_ERROR_MEMORY)
        sf_fail(work->log, status, "no memory for a reference of %ux%u pixels", width, height);
    if (status != SF_OK)
        sf_truth_picture_destroy(&picture);
    *out = picture;
    return status;
}

void sf_truth_picture_destroy(struct sf_truth_picture **place)
{
    struct sf_truth_picture *picture = place ? *place : NULL;

    if (!picture)
        return;
    free(picture->pixels);
    free(picture->depth);
    free(picture);
    *place = NULL;
}
