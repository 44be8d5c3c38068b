/* Whole pictures of the reference: the camera, depth, threads, stopping, numbers that are none, and many particles. */
#include "truth_kit.h"

#include "base/thread.h"

#define WORLD                                                                                                          \
    "{\"camera\": {\"eye\": [0.5, 0.8, 4], \"target\": [0, 0, 0], \"fov\": 50, \"near\": 0.2}, \"lights\": "           \
    "[{\"type\": \"directional\", \"direction\": [1, -1, -0.3]}, {\"type\": \"point\", \"position\": [1, 1, 1]}], "    \
    "\"objects\": [{\"type\": \"plane\", \"position\": [0, -0.5, 0]}, {\"type\": \"sphere\", \"position\": "           \
    "[-0.8, 0.9, 0.6], \"radius\": 0.3}]}"

static struct sf_truth_picture *render(const struct sf_truth *truth, const struct sf_scene *scene, uint32_t width,
                                       uint32_t height, unsigned threads)
{
    struct sf_truth_work work = {.threads = threads};
    struct sf_truth_picture *picture = NULL;
    struct sf_camera_pose pose;

    sf_scene_camera(scene, 0, &pose);
    assert_int_equal(sf_truth_render(truth, &pose, width, height, &work, &picture), SF_OK);
    return picture;
}

static bool same(const struct sf_truth_result *a, const struct sf_truth_result *b)
{
    return memcmp(a->radiance, b->radiance, sizeof a->radiance) == 0 && a->transmittance == b->transmittance &&
           a->optical_depth == b->optical_depth && a->near == b->near && a->far == b->far && a->error == b->error &&
           a->evaluations == b->evaluations && a->converged == b->converged;
}

static void test_threads(void **state)
{
    enum { WIDTH = 24, HEIGHT = 17 };
    struct sf_scene *scene = parse(WORLD);
    struct sf_truth_picture *one, *more;
    uint32_t filled = 0;
    struct cloud cloud;

    (void)state;
    cloud_random(&cloud, scene, 80, 5, 0.4, 2);
    struct sf_truth *truth = truth_of(scene, &cloud.medium, 1e-4);
    one = render(truth, scene, WIDTH, HEIGHT, 1);
    for (unsigned threads = 0; threads <= 7; threads += threads ? 5 : 2) { /* as many as there are, 2, 7 */
        more = render(truth, scene, WIDTH, HEIGHT, threads);
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            assert_true(same(&one->pixels[i], &more->pixels[i]));
            assert_true(one->depth[i] == more->depth[i]);
            filled += one->pixels[i].transmittance < 1;
        }
        sf_truth_picture_destroy(&more);
    }
    assert_int_equal(one->unconverged, 0);
    assert_in_range(filled, WIDTH * HEIGHT / 2, 3 * WIDTH * HEIGHT);
    sf_truth_picture_destroy(&one);
    sf_truth_picture_destroy(&one);
    sf_truth_destroy(&truth);
    sf_truth_destroy(&truth);
    cloud_free(&cloud);
    sf_scene_destroy(&scene);
}

/* A pixel is the ray of docs/scene.md, from the near plane to the surface. */
static void test_camera(void **state)
{
    enum { WIDTH = 31, HEIGHT = 20 };
    struct sf_scene *scene = parse(WORLD);
    struct sf_truth_picture *picture;
    uint32_t ground = 0, cut = 0;
    struct cloud cloud;

    (void)state;
    cloud_random(&cloud, scene, 30, 6, 0.7, 1);
    struct sf_truth *truth = truth_of(scene, &cloud.medium, 1e-4);
    picture = render(truth, scene, WIDTH, HEIGHT, 2);
    for (uint32_t j = 0; j < HEIGHT; j++) {
        for (uint32_t i = 0; i < WIDTH; i++) {
            const double eye[3] = {0.5f, 0.8f, 4}, target[3] = {0, 0, 0};
            const struct sf_truth_result *pixel = &picture->pixels[j * WIDTH + i];
            double f[3], r[3], u[3], d[3], length = sqrt(0.25 + (double)0.8f * 0.8f + 16), depth;
            double x = (2 * (i + 0.5) / WIDTH - 1) * tan(25 * PI / 180) * WIDTH / HEIGHT;
            double y = (1 - 2 * (j + 0.5) / HEIGHT) * tan(25 * PI / 180);

            for (int k = 0; k < 3; k++)
                f[k] = (target[k] - eye[k]) / length;
            r[0] = -f[2] / hypot(f[0], f[2]), r[1] = 0, r[2] = f[0] / hypot(f[0], f[2]);
            u[0] = r[1] * f[2] - r[2] * f[1], u[1] = r[2] * f[0] - r[0] * f[2], u[2] = r[0] * f[1] - r[1] * f[0];
            for (int k = 0; k < 3; k++)
                d[k] = f[k] + x * r[k] + y * u[k];
            depth = d[1] < 0 ? (-0.5 - eye[1]) / d[1] : INFINITY;
            if (picture->depth[j * WIDTH + i] < depth - 1e-9) { /* the ball */
                double p[3] = {-0.8f, 0.9f, 0.6f}, away = 0;

                for (int k = 0; k < 3; k++)
                    away += pow(eye[k] + picture->depth[j * WIDTH + i] * d[k] - p[k], 2);
                assert_near(away, (double)0.3f * 0.3f, 1e-9);
                depth = picture->depth[j * WIDTH + i];
                cut++;
            } else if (isinf(depth)) {
                assert_true(isinf(picture->depth[j * WIDTH + i]));
            } else {
                assert_near(picture->depth[j * WIDTH + i], depth, 1e-6 * depth);
                ground++;
            }
            struct sf_truth_result ray = trace(truth, eye, d, 0.2f, depth);
            assert_near(pixel->transmittance, ray.transmittance, 1e-6);
            assert_near(pixel->radiance[1], ray.radiance[1], 1e-4);
            if (pixel->near <= pixel->far)
                assert_true(pixel->near >= 0.2f && pixel->far <= depth + 1e-6);
        }
    }
    assert_true(ground > 100 && cut > 3);
    sf_truth_picture_destroy(&picture);
    sf_truth_destroy(&truth);
    cloud_free(&cloud);
    sf_scene_destroy(&scene);
}

/* No particles, and particles that are nothing: no smoke. From within a sphere: what is in front of the near plane. */
static void test_few(void **state)
{
    struct sf_scene *scene = parse("{\"camera\": {\"eye\": [0, 0, 0.5], \"target\": [0, 0, 0], \"near\": 0.25}}");
    const struct sf_particle nothing[] = {{0}, {.extinction = 3}, {.radius = 1}};
    const struct sf_particle ball = ball_at(0, 0, 0, 1, 2);

    (void)state;
    for (uint32_t count = 0; count <= 3; count++) {
        struct cloud cloud;

        cloud_make(&cloud, scene, nothing, count);
        struct sf_truth *truth = truth_of(scene, &cloud.medium, 1e-4);
        struct sf_truth_picture *picture = render(truth, scene, 3, 3, 1);
        for (int i = 0; i < 9; i++) {
            assert_true(picture->pixels[i].transmittance == 1 && picture->pixels[i].radiance[0] == 0);
            assert_true(picture->pixels[i].near > picture->pixels[i].far && picture->pixels[i].converged);
        }
        sf_truth_picture_destroy(&picture);
        sf_truth_destroy(&truth);
        cloud_free(&cloud);
    }
    struct cloud cloud;
    cloud_make(&cloud, scene, &ball, 1);
    struct sf_truth *truth = truth_of(scene, &cloud.medium, 1e-4);
    struct sf_truth_picture *picture = render(truth, scene, 3, 3, 1);
    assert_near(picture->pixels[4].transmittance, exp(-2 * 1.25), 1e-12);
    assert_near(picture->pixels[4].near, 0.25, 1e-12);
    assert_near(picture->pixels[4].far, 1.5, 1e-12);
    assert_true(picture->pixels[4].radiance[0] > 0);
    sf_truth_picture_destroy(&picture);
    sf_truth_destroy(&truth);
    cloud_free(&cloud);
    sf_scene_destroy(&scene);
}

struct watch {
    uint32_t calls, last, stop_after;
};

static bool watch_progress(void *user, uint32_t done, uint32_t rows)
{
    struct watch *watch = user;

    assert_true(done >= watch->last && done <= rows);
    watch->last = done;
    return ++watch->calls != watch->stop_after;
}

static void test_progress(void **state)
{
    struct sf_scene *scene = parse(WORLD);
    struct sf_camera_pose pose;
    struct cloud cloud;

    (void)state;
    cloud_random(&cloud, scene, 20, 7, 0.4, 2);
    struct sf_truth *truth = truth_of(scene, &cloud.medium, 1e-4);
    sf_scene_camera(scene, 0, &pose);
    for (uint32_t stop = 0; stop <= 11; stop++) {
        struct watch watch = {.stop_after = stop};
        struct sf_truth_work work = {.threads = 2, .progress = watch_progress, .user = &watch};
        struct sf_truth_picture *picture = NULL;
        enum sf_status status = sf_truth_render(truth, &pose, 12, 10, &work, &picture);

        assert_int_equal(status, stop == 0 ? SF_OK : SF_ERROR_INTERRUPTED);
        assert_int_equal(watch.calls, stop == 0 ? 11 : stop);
        assert_true((picture != NULL) == (stop == 0));
        if (stop == 0)
            assert_int_equal(watch.last, 10);
        sf_truth_picture_destroy(&picture);
    }
    sf_truth_destroy(&truth);
    cloud_free(&cloud);
    sf_scene_destroy(&scene);
}

/* Right of the middle of the slab there is no number. */
static void broken_at(const void *self, const double x[3], struct sf_truth_point *point)
{
    slab_at(self, x, point);
    if (x[0] > 0 && x[1] < 0)
        point->scattering[1] = NAN;
}

static double broken_depth(const void *self, const double a[3], const double b[3])
{
    return fmax(a[0], b[0]) > 0 && fmin(a[1], b[1]) < 0 ? NAN : slab_depth(self, a, b);
}

static void test_not_a_number(void **state)
{
    struct sf_scene *scene = parse("{\"camera\": {\"eye\": [0, 0, 5], \"target\": [0, 0, 0], \"fov\": 60}}");
    const struct slab slab = {.depth = 1, .extinction = 1, .albedo = {1, 1, 1}};
    struct caught caught = {"", 0};
    struct sf_log log = {caught_write, &caught, SF_LOG_ERROR};
    struct sf_truth_work work = {.threads = 2, .log = &log};
    struct sf_truth_options options = sf_truth_options_usual();
    struct sf_camera_pose pose;

    (void)state;
    sf_scene_camera(scene, 0, &pose);
    for (int way = 0; way < 2; way++) {
        struct sf_truth_medium medium = slab_medium(&slab, 0);
        struct sf_truth_picture *picture = NULL;
        struct sf_truth *truth;

        if (way == 0)
            medium.at = broken_at;
        else
            medium.optical_depth = broken_depth;
        assert_int_equal(sf_truth_create(scene, &medium, &options, NULL, &truth), SF_OK);
        assert_int_equal(sf_truth_render(truth, &pose, 8, 6, &work, &picture), SF_ERROR_INTERNAL);
        assert_null(picture);
        assert_caught(&caught, "pixel (4, 3) is not a number");
        sf_truth_destroy(&truth);
    }
    sf_scene_destroy(&scene);
}

static void test_refused(void **state)
{
    struct sf_scene *scene = parse("{}");
    struct caught caught = {"", 0};
    struct sf_log log = {caught_write, &caught, SF_LOG_ERROR};
    struct sf_truth_work work = {.threads = 1, .log = &log};
    const struct slab slab = {.depth = 1};
    const struct sf_truth_medium medium = slab_medium(&slab, 0);
    struct sf_truth_particles *particles = NULL;
    struct sf_truth_picture *picture = NULL;
    struct sf_truth_options options = sf_truth_options_usual();
    struct sf_truth *truth = NULL;
    struct sf_camera_pose pose;

    (void)state;
    for (int what = 0; what < 4; what++) {
        struct sf_particle list[3] = {ball_at(0, 0, 0, 1, 1), ball_at(1, 0, 0, 1, 1), ball_at(2, 0, 0, 1, 1)};

        if (what == 0)
            list[1].x = NAN;
        else if (what == 1)
            list[1].extinction = INFINITY;
        else if (what == 2)
            list[1].radius = -1;
        else
            list[1].extinction = -0.5f;
        assert_int_equal(sf_truth_particles_create(list, 3, scene, &log, &particles), SF_ERROR_SCENE);
        assert_null(particles);
        assert_caught(&caught, "particle 1 ");
    }
    options.tolerance = NAN;
    assert_int_equal(sf_truth_create(scene, &medium, &options, &log, &truth), SF_ERROR_USAGE);
    assert_caught(&caught, "tolerance");
    options = sf_truth_options_usual();
    assert_int_equal(sf_truth_create(scene, &medium, &options, &log, &truth), SF_OK);
    sf_scene_camera(scene, 0, &pose);
    assert_int_equal(sf_truth_render(truth, &pose, 0, 5, &work, &picture), SF_ERROR_USAGE);
    assert_caught(&caught, "0x5");
    sf_truth_destroy(&truth);
    sf_scene_destroy(&scene);
}

/* The limit holds, and a ray that hits it says so. */
static void test_limit(void **state)
{
    struct sf_scene *scene = parse(WORLD);
    const double o[3] = {0, 0, 4}, d[3] = {0, 0, -1};
    struct sf_truth_options options = sf_truth_options_usual();
    struct cloud cloud;

    (void)state;
    cloud_random(&cloud, scene, 60, 8, 0.5, 2);
    for (int i = 0; i < 2; i++) {
        struct sf_truth *truth;

        options.tolerance = 1e-8;
        options.limit = i == 0 ? 200000 : 700;
        assert_int_equal(sf_truth_create(scene, &cloud.medium, &options, NULL, &truth), SF_OK);
        struct sf_truth_result result = trace(truth, o, d, 0, INFINITY);
        assert_true(result.converged == (i == 0));
        assert_true(i == 0 ? result.evaluations > 700 : result.evaluations <= 700);
        sf_truth_destroy(&truth);
    }
    cloud_free(&cloud);
    sf_scene_destroy(&scene);
}

/* 100,000 particles: what a ray costs follows the spheres that it meets. */
static void test_many(void **state)
{
    enum { COUNT = 100000 };
    struct sf_scene *scene = parse(WORLD);
    uint64_t begin = sf_clock_ns(), made, done;
    struct sf_truth_picture *picture;
    struct cloud cloud;
    double depth = 0;

    (void)state;
    cloud_random(&cloud, scene, COUNT, 9, 0.03, 8);
    struct sf_truth *truth = truth_of(scene, &cloud.medium, 1e-3);
    made = sf_clock_ns();
    picture = render(truth, scene, 8, 8, 0);
    done = sf_clock_ns();
    for (int i = 0; i < 64; i++)
        depth = fmax(depth, picture->pixels[i].optical_depth);
    assert_int_equal(picture->unconverged, 0);
    assert_true(depth > 1);
    print_message("%d particles: made in %.2f s, 64 pixels in %.2f s, greatest optical depth %.1f\n", COUNT,
                  (double)(made - begin) * 1e-9, (double)(done - made) * 1e-9, depth);
    assert_true(done - begin < 60ull * 1000000000);
    sf_truth_picture_destroy(&picture);
    sf_truth_destroy(&truth);
    cloud_free(&cloud);
    sf_scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_threads),  cmocka_unit_test(test_camera),       cmocka_unit_test(test_few),
        cmocka_unit_test(test_progress), cmocka_unit_test(test_not_a_number), cmocka_unit_test(test_refused),
        cmocka_unit_test(test_limit),    cmocka_unit_test(test_many),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
