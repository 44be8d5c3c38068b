/* The public face of src/truth: the reference for a frame of a renderer. */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/log.h"
#include "methods/method.h"
#include "render/uniforms.h"
#include "sfumato/sfumato.h"
#include "truth/scatter.h"

enum { NOTES_MAX = 8, SIDE_MAX = 32768 };

struct sf_reference {
    struct sf_scene scene; /* what the reference reads of it, with copies of what that points to */
    struct sf_arena arena; /* holds the copies and the notes */
    struct sf_camera_pose pose;
    struct sf_truth_particles *particles;
    struct sf_truth *truth;
    unsigned threads;
    const char *notes[NOTES_MAX + 1]; /* NULL-terminated */
    uint32_t note_count;
    const struct sf_log *log;
};

/* ---- what can be compared ---- */

/* Every method says here what it draws, so that none is measured against something else: NULL is the particles of
 * docs/scene.md. A method that is missing is named by the compiler. */
static const char *foreign_medium(int32_t method)
{
    switch ((enum sf_method)method) {
    case SF_METHOD_NONE:
    case SF_METHOD_THICK:
    case SF_METHOD_LARSSON:
    case SF_METHOD_REFERENCE:
    case SF_METHOD_HARD:
    case SF_METHOD_SOFT:
    case SF_METHOD_CONTRAST:
    case SF_METHOD_SPHERICAL:
    case SF_METHOD_MEGA:
    case SF_METHOD_AVERAGE:
    case SF_METHOD_EXTENT:
    case SF_METHOD_VOLUMETRIC:
    case SF_METHOD_LIT:
    case SF_METHOD_SCATTERING:
        return NULL;
    }
    return "a medium of its own";
}

static enum sf_status check_medium(const struct sf_scene *scene, const struct sf_log *log)
{
    const char *medium = foreign_medium(scene->method);
    bool named = scene->method >= 0 && (uint32_t)scene->method < sf_method_count;

    if (!medium)
        return SF_OK;
    return sf_fail(log, SF_ERROR_SCENE,
                   "%s: /method: '%s' draws %s, for which there is no reference: it is known for particles only",
                   scene->path ? scene->path : "scene", named ? sf_methods[scene->method].name : "unknown", medium);
}

static void add_note(struct sf_reference *reference, const char *note)
{
    if (note && reference->note_count < NOTES_MAX)
        reference->notes[reference->note_count++] = note;
}

/* Settings by which method thick leaves the integral, and is meant to. */
static void note_thick(struct sf_reference *reference, const struct sf_thick_settings *thick)
{
    struct sf_arena *arena = &reference->arena;

    if (thick->detail > 0)
        add_note(reference,
                 sf_arena_printf(arena, "thick.detail is %g: it dents the spheres; the reference has round ones",
                                 (double)thick->detail));
    if (thick->octaves > 1)
        add_note(reference, sf_arena_printf(arena,
                                            "thick.octaves is %d: it adds light that is scattered more than once; the "
                                            "reference has one scattering",
                                            thick->octaves));
    if (!thick->scene_shadow)
        add_note(reference, "thick.scene_shadow is false: in the reference objects shadow the smoke");
}

/* The same of thick-larsson alone. */
static void note_larsson(struct sf_reference *reference, const struct sf_larsson_settings *larsson)
{
    struct sf_arena *arena = &reference->arena;

    if (larsson->soft > 0)
        add_note(reference, sf_arena_printf(arena,
                                            "larsson.soft is %g: it fades smoke towards surfaces; the reference cuts "
                                            "it off there",
                                            (double)larsson->soft));
    if (larsson->life_fade > 0)
        add_note(reference, sf_arena_printf(arena,
                                            "larsson.life_fade is %g: it thins smoke with age; the reference takes "
                                            "particles as the simulation leaves them",
                                            (double)larsson->life_fade));
}

/* The same of billboards that stand for volumes. */
static void note_volumes(struct sf_reference *reference, const struct sf_scene *scene)
{
    float opacity = scene->method == SF_METHOD_AVERAGE  ? scene->average.opacity
                    : scene->method == SF_METHOD_EXTENT ? scene->extent.opacity
                                                        : 1;
    const char *group = scene->method == SF_METHOD_AVERAGE ? "average_density" : "density_extent";

    if (opacity < 1)
        add_note(reference,
                 sf_arena_printf(&reference->arena, "%s.opacity is %g: smoke covers less than the reference's", group,
                                 (double)opacity));
    if (scene->method == SF_METHOD_EXTENT)
        add_note(reference, "density-extent draws the atlas's pictures; the reference has even spheres");
    if (scene->method == SF_METHOD_VOLUMETRIC && scene->volumetric.strength > 0)
        add_note(reference, sf_arena_printf(&reference->arena,
                                            "volumetric.strength is %g: there is noise in the density; the reference "
                                            "has even spheres",
                                            (double)scene->volumetric.strength));
}

/* ---- making one ---- */

static void *copy_bytes(struct sf_arena *arena, const void *from, size_t bytes)
{
    void *to = sf_arena_alloc(arena, bytes > 0 ? bytes : 1);

    if (to && bytes > 0)
        memcpy(to, from, bytes);
    return to;
}

/* Lamps as they are at the time, objects, medium, ramp and environment; nothing of emitters, forces, effects and cameras,
 * which the particles and the pose stand for. False when memory is out. */
static bool copy_scene(const struct sf_scene *from, double time, struct sf_reference *reference)
{
    struct sf_scene *scene = &reference->scene;
    struct sf_environment *environment = &scene->environment;

    *scene = *from;
    scene->path = sf_arena_strdup(&reference->arena, from->path ? from->path : "scene");
    scene->stated = NULL;
    scene->arena = (struct sf_arena){0};
    scene->camera = (struct sf_camera){0};
    memset(scene->emitters, 0, sizeof scene->emitters);
    scene->emitter_count = scene->force_count = 0;
    scene->effect_count = scene->flash_count = scene->shake_count = 0;
    sf_scene_lights(from, time, scene->lights);
    for (uint32_t i = 0; i < scene->mesh_count; i++) {
        struct sf_mesh *mesh = &scene->meshes[i];

        mesh->file = NULL;
        mesh->normals = NULL;
        mesh->positions =
            copy_bytes(&reference->arena, mesh->positions, (size_t)mesh->vertex_count * 3 * sizeof *mesh->positions);
        mesh->indices = copy_bytes(&reference->arena, mesh->indices, (size_t)mesh->index_count * sizeof *mesh->indices);
        if (!mesh->positions || !mesh->indices)
            return false;
    }
    if (environment->pixels) {
        environment->pixels = copy_bytes(&reference->arena, environment->pixels,
                                         (size_t)environment->width * environment->height * 3 * sizeof(float));
        return environment->pixels && scene->path;
    }
    return scene->path != NULL;
}

static enum sf_status create_truth(struct sf_reference *reference, const struct sf_frame *frame,
                                   const struct sf_reference_options *options)
{
    struct sf_truth_options wanted = sf_truth_options_usual();
    struct sf_truth_medium medium;
    /* The public particle has the bytes of the device's (renderer.c sees to it). */
    enum sf_status status =
        sf_truth_particles_create((const struct sf_particle *)(const void *)frame->particles, frame->live,
                                  &reference->scene, reference->log, &reference->particles);

    if (status)
        return status;
    wanted.ambient = reference->scene.thick.ambient;
    if (options->tolerance != 0)
        wanted.tolerance = options->tolerance;
    if (options->floor != 0)
        wanted.floor = options->floor;
    sf_truth_particles_medium(reference->particles, &medium);
    return sf_truth_create(&reference->scene, &medium, &wanted, reference->log, &reference->truth);
}

enum sf_status sf_reference_create(const struct sf_scene *scene, const struct sf_frame *frame,
                                   const struct sf_reference_options *options, const struct sf_log *log,
                                   struct sf_reference **out)
{
    struct sf_reference *reference;
    enum sf_status status = check_medium(scene, log);

    *out = NULL;
    if (status)
        return status;
    if (!frame->particles)
        return sf_fail(log, SF_ERROR_USAGE,
                       "reference: the frame has no particles; its renderer needs sf_renderer_options.particles");
    reference = calloc(1, sizeof *reference);
    if (!reference || !copy_scene(scene, frame->time, reference)) {
        sf_reference_destroy(&reference);
        return sf_fail(log, SF_ERROR_MEMORY, "no memory for the reference");
    }
    reference->log = log;
    reference->threads = options->threads;
    if (!sf_pose_from_view(&frame->view, &reference->pose))
        status = sf_fail(log, SF_ERROR_USAGE, "reference: the frame's view is none");
    if (!status)
        status = create_truth(reference, frame, options);
    if (!status && (scene->method == SF_METHOD_THICK || scene->method == SF_METHOD_LARSSON))
        note_thick(reference, &scene->thick);
    if (!status && scene->method == SF_METHOD_LARSSON)
        note_larsson(reference, &scene->larsson);
    if (!status)
        note_volumes(reference, scene);
    if (status)
        sf_reference_destroy(&reference);
    *out = reference;
    return status;
}

void sf_reference_destroy(struct sf_reference **out)
{
    struct sf_reference *reference = out ? *out : NULL;

    if (!reference)
        return;
    sf_truth_destroy(&reference->truth);
    sf_truth_particles_destroy(&reference->particles);
    sf_arena_finish(&reference->arena);
    free(reference);
    *out = NULL;
}

const char *sf_reference_note(const struct sf_reference *reference, uint32_t index)
{
    return index < reference->note_count ? reference->notes[index] : NULL;
}

/* ---- pictures ---- */

struct progress {
    sf_progress_fn tell;
    void *user;
};

static bool tell(void *user, uint32_t done, uint32_t rows)
{
    const struct progress *progress = user;

    return progress->tell(progress->user, done, rows);
}

static struct sf_truth_work work_of(const struct sf_reference *reference, struct progress *progress)
{
    return (struct sf_truth_work){.threads = reference->threads,
                                  .progress = progress->tell ? tell : NULL,
                                  .user = progress,
                                  .log = reference->log};
}

/* The eye and the size of a picture; SF_ERROR_USAGE when there can be none. */
static enum sf_status check_view(const struct sf_reference *reference, const struct sf_camera_view *view,
                                 uint32_t width, uint32_t height, struct sf_camera_pose *pose)
{
    *pose = reference->pose;
    if (view && !sf_pose_from_view(view, pose))
        return sf_fail(reference->log, SF_ERROR_USAGE,
                       "reference: the view's eye is at its target, or a number is out of range");
    if (width == 0 || height == 0 || width > SIDE_MAX || height > SIDE_MAX)
        return sf_fail(reference->log, SF_ERROR_USAGE, "reference: a picture of %ux%u; each side is 1 to %d pixels",
                       width, height, SIDE_MAX);
    return SF_OK;
}

static struct sf_reference_pixel pixel_of(const struct sf_truth_result *result)
{
    bool any = result->near <= result->far;

    return (struct sf_reference_pixel){
        .radiance = {(float)result->radiance[0], (float)result->radiance[1], (float)result->radiance[2]},
        .transmittance = (float)result->transmittance,
        .optical_depth = (float)result->optical_depth,
        .near = any ? (float)result->near : SF_NO_DEPTH,
        .far = any ? (float)result->far : SF_NO_DEPTH,
        .error = (float)result->error,
        .evaluations = result->evaluations,
        .converged = result->converged,
    };
}

static enum sf_status publish(const struct sf_truth_picture *truth, const struct sf_log *log,
                              struct sf_reference_picture **out)
{
    size_t count = (size_t)truth->width * truth->height;
    struct sf_reference_picture *picture = calloc(1, sizeof *picture);

    if (picture)
        picture->pixels = malloc(count * sizeof *picture->pixels);
    if (!picture || !picture->pixels) {
        free(picture);
        return sf_fail(log, SF_ERROR_MEMORY, "no memory for a reference of %ux%u pixels", truth->width, truth->height);
    }
    picture->width = truth->width;
    picture->height = truth->height;
    picture->unconverged = truth->unconverged;
    for (size_t i = 0; i < count; i++)
        picture->pixels[i] = pixel_of(&truth->pixels[i]);
    *out = picture;
    return SF_OK;
}

enum sf_status sf_reference_render(const struct sf_reference *reference, const struct sf_camera_view *view,
                                   uint32_t width, uint32_t height, uint32_t stride, sf_progress_fn progress_fn,
                                   void *user, struct sf_reference_picture **out)
{
    struct progress progress = {progress_fn, user};
    struct sf_truth_work work = work_of(reference, &progress);
    struct sf_truth_picture *picture = NULL;
    struct sf_camera_pose pose;
    enum sf_status status = check_view(reference, view, width, height, &pose);

    *out = NULL;
    work.stride = stride;
    if (!status)
        status = sf_truth_render(reference->truth, &pose, width, height, &work, &picture);
    if (!status)
        status = publish(picture, reference->log, out);
    sf_truth_picture_destroy(&picture);
    return status;
}

void sf_reference_picture_destroy(struct sf_reference_picture **out)
{
    struct sf_reference_picture *picture = out ? *out : NULL;

    if (!picture)
        return;
    free(picture->pixels);
    free(picture);
    *out = NULL;
}

/* ---- one ray ---- */

/* Each point adds the piece of the ray since the one before it. */
static enum sf_status walk(const struct sf_reference *reference, const struct sf_truth_view *view,
                           const double direction[3], const double span[2], struct sf_probe_point *points,
                           uint32_t count)
{
    double radiance[3] = {0}, through = 1, from = span[0];

    for (uint32_t i = 0; i < count; i++) {
        double to = count > 1 ? span[0] + (span[1] - span[0]) * i / (count - 1) : span[1];
        struct sf_truth_result piece;
        enum sf_status status = sf_truth_ray(reference->truth, view->eye, direction, from, to, &piece);

        if (status)
            return sf_fail(reference->log, status, "no memory for a ray of the reference");
        for (int c = 0; c < 3; c++) {
            radiance[c] += through * piece.radiance[c];
            points[i].radiance[c] = (float)radiance[c];
        }
        through *= piece.transmittance;
        points[i].transmittance = (float)through;
        points[i].depth = (float)to;
        from = to;
    }
    return SF_OK;
}

enum sf_status sf_reference_probe(const struct sf_reference *reference, const struct sf_camera_view *at, uint32_t width,
                                  uint32_t height, uint32_t x, uint32_t y, struct sf_probe_point *points,
                                  uint32_t count)
{
    struct sf_camera_pose pose;
    struct sf_truth_view view;
    struct sf_truth_result whole;
    double direction[3];
    enum sf_status status = check_view(reference, at, width, height, &pose);

    if (status)
        return status;
    if (x >= width || y >= height)
        return sf_fail(reference->log, SF_ERROR_USAGE, "reference: a picture of %ux%u has no pixel (%u, %u)", width,
                       height, x, y);
    sf_truth_view(&pose, width, height, &view);
    sf_truth_view_ray(&view, x, y, direction);
    double to = sf_truth_surface(reference->truth, view.eye, direction, view.near);
    status = sf_truth_ray(reference->truth, view.eye, direction, view.near, to, &whole);
    if (status)
        return sf_fail(reference->log, status, "no memory for a ray of the reference");
    if (whole.near <= whole.far)
        return walk(reference, &view, direction, (const double[2]){whole.near, whole.far}, points, count);
    for (uint32_t i = 0; i < count; i++)
        points[i] = (struct sf_probe_point){.depth = SF_NO_DEPTH, .transmittance = 1};
    return SF_OK;
}

/* ---- scattered more than once ---- */

struct estimate {
    struct sf_reference_estimate shown; /* first: what the caller has is this */
    const struct sf_reference *reference;
    struct sf_camera_pose pose;
    struct sf_truth_scatter *scatter;
    struct sf_truth_estimate *pixels;
};

static enum sf_status begin_estimate(const struct sf_reference *reference, const struct sf_camera_pose *pose,
                                     uint32_t width, uint32_t height, uint32_t orders, struct estimate **out)
{
    struct estimate *estimate = calloc(1, sizeof *estimate);
    size_t count = (size_t)width * height;

    *out = estimate;
    if (!estimate)
        return sf_fail(reference->log, SF_ERROR_MEMORY, "no memory for the reference");
    estimate->shown = (struct sf_reference_estimate){.width = width, .height = height, .orders = orders};
    estimate->reference = reference;
    estimate->pose = *pose;
    estimate->pixels = calloc(count, sizeof *estimate->pixels);
    estimate->shown.radiance = calloc(count * 3, sizeof(float));
    estimate->shown.error = calloc(count * 3, sizeof(float));
    if (!estimate->pixels || !estimate->shown.radiance || !estimate->shown.error)
        return sf_fail(reference->log, SF_ERROR_MEMORY, "no memory for a reference of %ux%u pixels", width, height);
    return sf_truth_scatter_create(reference->truth, reference->log, &estimate->scatter);
}

static bool goes_on(const struct estimate *estimate, const struct sf_reference *reference,
                    const struct sf_camera_pose *pose, uint32_t width, uint32_t height, uint32_t orders)
{
    return estimate->reference == reference && memcmp(&estimate->pose, pose, sizeof *pose) == 0 &&
           estimate->shown.width == width && estimate->shown.height == height && estimate->shown.orders == orders;
}

static void show_estimate(struct estimate *estimate)
{
    size_t count = (size_t)estimate->shown.width * estimate->shown.height;

    for (size_t i = 0; i < count; i++) {
        for (int c = 0; c < 3; c++) {
            estimate->shown.radiance[3 * i + (size_t)c] = (float)estimate->pixels[i].mean[c];
            estimate->shown.error[3 * i + (size_t)c] = (float)sf_truth_estimate_error(&estimate->pixels[i], c);
        }
    }
}

enum sf_status sf_reference_scatter(const struct sf_reference *reference, const struct sf_camera_view *view,
                                    uint32_t width, uint32_t height, uint32_t orders, uint32_t paths,
                                    sf_progress_fn progress_fn, void *user, struct sf_reference_estimate **out)
{
    struct progress progress = {progress_fn, user};
    const struct sf_truth_work work = work_of(reference, &progress);
    struct estimate *estimate = (struct estimate *)*out;
    struct sf_camera_pose pose;
    enum sf_status status = check_view(reference, view, width, height, &pose);

    if (!status && estimate && !goes_on(estimate, reference, &pose, width, height, orders))
        status = sf_fail(reference->log, SF_ERROR_USAGE,
                         "reference: an estimate goes on with the reference, view, size and orders that it began with");
    if (!status && estimate && paths > UINT32_MAX - estimate->shown.paths)
        status =
            sf_fail(reference->log, SF_ERROR_USAGE, "reference: an estimate has at most %u paths a pixel", UINT32_MAX);
    if (!status && !estimate)
        status = begin_estimate(reference, &pose, width, height, orders, &estimate);
    if (!status)
        status = sf_truth_scatter_render(estimate->scatter, &pose, width, height, estimate->shown.paths, paths, orders,
                                         &work, estimate->pixels);
    *out = (struct sf_reference_estimate *)estimate;
    if (status) {
        sf_reference_estimate_destroy(out);
        return status;
    }
    estimate->shown.paths += paths;
    show_estimate(estimate);
    return SF_OK;
}

void sf_reference_estimate_destroy(struct sf_reference_estimate **out)
{
    struct estimate *estimate = out ? (struct estimate *)*out : NULL;

    if (!estimate)
        return;
    sf_truth_scatter_destroy(&estimate->scatter);
    free(estimate->pixels);
    free(estimate->shown.radiance);
    free(estimate->shown.error);
    free(estimate);
    *out = NULL;
}
