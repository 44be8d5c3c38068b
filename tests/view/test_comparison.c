/* A frame beside the reference: numbers, differences and probes against direct computation; stopping; what cannot be. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <math.h>
#include <time.h>
#include <cmocka.h>
#include "app/console.h"
#include "app/view/comparison.h"

enum { WIDTH = 22, HEIGHT = 17, PIXELS = WIDTH * HEIGHT, MANY = 100000 };

static char heard[1024];

static void hear(void *user, enum sf_log_level level, const char *message)
{
    (void)user;
    if (level == SF_LOG_ERROR)
        snprintf(heard, sizeof heard, "%s", message);
}
static const struct sf_log test_log = {.write = hear, .level = SF_LOG_WARNING};

static struct sf_frame_particle particles[MANY];
static float smoke[PIXELS * 4], depths[PIXELS * 4];
static struct sf_scene *scene;

static const char scene_text[] =
    "{\"method\": \"thick\", \"lights\": [{\"type\": \"directional\", \"direction\": [1, -1, -1], \"intensity\": 3}], "
    "\"thick\": {\"detail\": 0, \"octaves\": 1}}";

static int set_up(void **state)
{
    (void)state;
    heard[0] = '\0';
    for (int i = 0; i < PIXELS; i++) {
        for (int c = 0; c < 4; c++)
            smoke[4 * i + c] = 0.01f * (float)(i % 7) + 0.002f * (float)c;
        depths[4 * i] = 2;
        depths[4 * i + 1] = 4;
        depths[4 * i + 2] = 0.5f;
        depths[4 * i + 3] = 0.6f + 0.001f * (float)i;
    }
    for (int i = 0; i < MANY; i++)
        particles[i] = (struct sf_frame_particle){.position = {0.05f * (float)(i % 7), 0.04f * (float)(i % 5), 0},
                                                  .radius = 0.5f,
                                                  .extinction = 0.8f,
                                                  .lifetime = 5,
                                                  .birth_radius = 0.5f,
                                                  .birth_extinction = 0.8f,
                                                  .id = (uint32_t)i};
    return sf_scene_parse("test", scene_text, strlen(scene_text), NULL, 0, &test_log, &scene);
}

static int tear_down(void **state)
{
    (void)state;
    sf_scene_destroy(&scene);
    return 0;
}

static struct sf_frame frame_of(uint32_t live)
{
    return (struct sf_frame){.width = WIDTH,
                             .height = HEIGHT,
                             .view = {.eye = {0, 0, 3}, .up = {0, 1, 0}, .fov = 40, .near_clip = 0.05f},
                             .smoke_float = smoke,
                             .smoke_depths = depths,
                             .live = live,
                             .particles = particles};
}

static void rest(void)
{
    nanosleep(&(struct timespec){.tv_nsec = 5000000}, NULL);
}

static void wait_for_end(struct sf_comparison *comparison)
{
    uint64_t limit = sf_now_ns() + 60 * 1000000000ull;

    while (sf_comparison_busy(comparison)) {
        assert_true(sf_now_ns() < limit);
        rest();
    }
}

static struct sf_comparison *compared(const struct sf_frame *frame, uint32_t stride)
{
    struct sf_comparison *comparison = sf_comparison_begin(scene, frame, stride, 2, &test_log);

    assert_non_null(comparison);
    wait_for_end(comparison);
    return comparison;
}

/* The same asked of the library itself. */
static struct sf_reference *direct_reference(const struct sf_frame *frame)
{
    struct sf_reference *reference = NULL;

    assert_int_equal(sf_reference_create(scene, frame, &(struct sf_reference_options){0}, &test_log, &reference),
                     SF_OK);
    return reference;
}

static float luminance(const float rgb[3])
{
    return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
}

static void check_differences(struct sf_comparison *comparison, const struct sf_reference_picture *picture,
                              uint32_t stride)
{
    float radiance[PIXELS], transmittance[PIXELS];

    assert_true(sf_comparison_difference(comparison, SF_DIFFERENCE_RADIANCE, radiance));
    assert_true(sf_comparison_difference(comparison, SF_DIFFERENCE_TRANSMITTANCE, transmittance));
    for (uint32_t i = 0; i < picture->width * picture->height; i++) {
        uint32_t x = sf_errors_pixel(i % picture->width, stride, WIDTH);
        uint32_t y = sf_errors_pixel(i / picture->width, stride, HEIGHT), at = 4 * (y * WIDTH + x);

        assert_true(fabsf(radiance[i] - (luminance(&smoke[at]) - luminance(picture->pixels[i].radiance))) < 1e-6f);
        assert_true(fabsf(transmittance[i] - (depths[at + 3] - picture->pixels[i].transmittance)) < 1e-6f);
    }
}

static void numbers_are_those_of_a_direct_computation(void **state)
{
    const struct sf_layers layers = {WIDTH, HEIGHT, smoke, depths};
    const struct sf_frame frame = frame_of(9);
    struct sf_reference *reference = direct_reference(&frame);

    (void)state;
    for (uint32_t stride = 1; stride <= 8; stride *= 2) {
        struct sf_comparison *comparison = compared(&frame, stride);
        struct sf_reference_picture *picture = NULL;
        struct sf_errors errors;
        const struct sf_errors *told;
        uint32_t unconverged, size[2], sides[2];
        uint64_t total;
        double seconds;

        assert_int_equal(sf_comparison_stage(comparison), SF_COMPARISON_DONE);
        assert_int_equal(sf_reference_render(reference, NULL, WIDTH, HEIGHT, stride, NULL, NULL, &picture), SF_OK);
        assert_int_equal(sf_errors_measure(&layers, picture, stride, &errors), SF_OK);
        told = sf_comparison_errors(comparison, &unconverged, &seconds);
        assert_non_null(told);
        assert_true(errors.pixels > 0 && errors.smoky > 0 && errors.relative_mse > 0);
        assert_memory_equal(told, &errors, sizeof errors);
        assert_int_equal(unconverged, picture->unconverged);
        sf_comparison_size(comparison, size, sides);
        assert_true(size[0] == WIDTH && size[1] == HEIGHT);
        assert_true(sides[0] == picture->width && sides[1] == picture->height);
        assert_int_equal(sf_comparison_progress(comparison, &total), picture->height);
        assert_int_equal(total, picture->height);
        check_differences(comparison, picture, stride);
        sf_reference_picture_destroy(&picture);
        sf_comparison_destroy(&comparison);
        assert_null(comparison);
    }
    sf_reference_destroy(&reference);
}

static void a_number_that_is_none_is_left_out_and_shown(void **state)
{
    const struct sf_frame frame = frame_of(9);
    struct sf_comparison *comparison;
    float values[PIXELS];
    uint32_t unconverged;
    double seconds;

    (void)state;
    smoke[4 * 5 + 1] = NAN;
    comparison = compared(&frame, 1);
    assert_int_equal(sf_comparison_errors(comparison, &unconverged, &seconds)->not_finite, 1);
    assert_true(sf_comparison_difference(comparison, SF_DIFFERENCE_RADIANCE, values));
    for (int i = 0; i < PIXELS; i++)
        assert_true(isnan(values[i]) == (i == 5));
    sf_comparison_destroy(&comparison);
}

static void a_probe_is_the_references_ray_and_the_methods_end(void **state)
{
    const struct sf_frame frame = frame_of(9);
    struct sf_comparison *comparison = compared(&frame, 8);
    struct sf_reference *reference = direct_reference(&frame);
    struct sf_probe_point points[SF_PROBE_POINTS];
    struct sf_probe probe;

    (void)state;
    assert_false(sf_comparison_probed(comparison, &probe));
    sf_comparison_probe(comparison, WIDTH, 0); /* no pixel of the frame */
    assert_false(sf_comparison_busy(comparison));
    sf_comparison_probe(comparison, 12, 8);
    wait_for_end(comparison);
    assert_true(sf_comparison_probed(comparison, &probe));
    assert_int_equal(sf_reference_probe(reference, NULL, WIDTH, HEIGHT, 12, 8, points, SF_PROBE_POINTS), SF_OK);
    assert_true(probe.x == 12 && probe.y == 8 && !probe.failed && !probe.empty);
    assert_memory_equal(probe.points, points, sizeof points);
    assert_memory_equal(probe.smoke, &smoke[4 * (8 * WIDTH + 12)], sizeof probe.smoke);
    assert_memory_equal(probe.depths, &depths[4 * (8 * WIDTH + 12)], sizeof probe.depths);
    assert_true(points[SF_PROBE_POINTS - 1].transmittance < 0.5f);
    sf_comparison_probe(comparison, 0, 0);
    wait_for_end(comparison);
    assert_true(sf_comparison_probed(comparison, &probe) && probe.x == 0 && probe.empty);
    sf_reference_destroy(&reference);
    sf_comparison_destroy(&comparison);
}

static void stopping_answers_at_once(void **state)
{
    const struct sf_frame frame = frame_of(MANY); /* all in each other: minutes */
    uint64_t begin, asked;
    struct sf_comparison *comparison;
    float values[PIXELS];
    uint32_t unconverged;
    double seconds;

    (void)state;
    comparison = sf_comparison_begin(scene, &frame, 1, 2, &test_log);
    assert_non_null(comparison);
    assert_int_equal(sf_comparison_stage(comparison), SF_COMPARISON_RUNS);
    assert_null(sf_comparison_errors(comparison, &unconverged, &seconds));
    assert_false(sf_comparison_difference(comparison, SF_DIFFERENCE_RADIANCE, values));
    sf_comparison_probe(comparison, 11, 8);
    for (int i = 0; i < 60; i++) /* in the midst of it */
        rest();
    assert_int_equal(sf_comparison_stage(comparison), SF_COMPARISON_RUNS);
    begin = sf_now_ns();
    sf_comparison_stop(comparison);
    asked = sf_now_ns() - begin;
    assert_true(asked < 500000000ull);
    assert_int_equal(sf_comparison_stage(comparison), SF_COMPARISON_STOPPED);
    sf_comparison_probe(comparison, 3, 3); /* comes too late, harms nothing */
    assert_true(sf_comparison_busy(comparison));
    sf_comparison_destroy(&comparison);
    assert_true(sf_now_ns() - begin < 1000000000ull);
}

static void what_was_stopped_comes_to_an_end(void **state)
{
    const struct sf_frame frame = frame_of(300);
    struct sf_comparison *comparison = sf_comparison_begin(scene, &frame, 1, 2, &test_log);
    float values[PIXELS];

    (void)state;
    assert_non_null(comparison);
    assert_true(sf_comparison_busy(comparison));
    sf_comparison_stop(comparison);
    wait_for_end(comparison);
    assert_int_equal(sf_comparison_stage(comparison), SF_COMPARISON_STOPPED);
    assert_false(sf_comparison_difference(comparison, SF_DIFFERENCE_RADIANCE, values));
    assert_string_equal(heard, ""); /* to stop is no error */
    sf_comparison_destroy(&comparison);
}

static void what_cannot_be_compared_says_why(void **state)
{
    struct sf_frame frame = frame_of(9);
    char text[SF_COMPARISON_MESSAGE];
    struct sf_comparison *comparison;

    (void)state;
    frame.smoke_float = NULL; /* as method none leaves it */
    comparison = compared(&frame, 1);
    assert_int_equal(sf_comparison_stage(comparison), SF_COMPARISON_FAILED);
    sf_comparison_message(comparison, text);
    assert_non_null(strstr(text, "no layers of the smoke"));
    assert_string_equal(text, heard);
    sf_comparison_probe(comparison, 3, 3);
    assert_false(sf_comparison_busy(comparison));
    sf_comparison_destroy(&comparison);

    frame = frame_of(9);
    frame.particles = NULL;
    comparison = compared(&frame, 1);
    assert_int_equal(sf_comparison_stage(comparison), SF_COMPARISON_FAILED);
    sf_comparison_message(comparison, text);
    assert_non_null(strstr(text, "no particles"));
    sf_comparison_destroy(&comparison);
    sf_comparison_destroy(&comparison); /* none */
}

static void without_smoke_only_the_method_is_left(void **state)
{
    const struct sf_frame frame = frame_of(0);
    struct sf_comparison *comparison = compared(&frame, 2);
    uint32_t unconverged;
    double seconds;

    (void)state;
    assert_int_equal(sf_comparison_stage(comparison), SF_COMPARISON_DONE);
    assert_true(isinf(sf_comparison_errors(comparison, &unconverged, &seconds)->relative_mse));
    sf_comparison_destroy(&comparison);
}

static void notes_are_the_references(void **state)
{
    const char *const sets[] = {"thick.octaves=3"};
    const struct sf_frame frame = frame_of(9);
    struct sf_comparison *comparison = compared(&frame, 8);

    (void)state;
    assert_null(sf_comparison_note(comparison, 0));
    sf_comparison_destroy(&comparison);
    sf_scene_destroy(&scene);
    assert_int_equal(sf_scene_parse("test", scene_text, strlen(scene_text), sets, 1, &test_log, &scene), SF_OK);
    comparison = compared(&frame, 8);
    assert_non_null(strstr(sf_comparison_note(comparison, 0), "thick.octaves is 3"));
    sf_comparison_destroy(&comparison);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(numbers_are_those_of_a_direct_computation, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_number_that_is_none_is_left_out_and_shown, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_probe_is_the_references_ray_and_the_methods_end, set_up, tear_down),
        cmocka_unit_test_setup_teardown(stopping_answers_at_once, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_was_stopped_comes_to_an_end, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_cannot_be_compared_says_why, set_up, tear_down),
        cmocka_unit_test_setup_teardown(without_smoke_only_the_method_is_left, set_up, tear_down),
        cmocka_unit_test_setup_teardown(notes_are_the_references, set_up, tear_down),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
