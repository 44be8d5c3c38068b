/* Particles that come back, and the reference for a frame of them, through the public interface; with validation. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "output/half.h"
#include "scene/scene.h"
#include "sfumato/sfumato.h"

enum { WIDTH = 41, HEIGHT = 31 };

static struct sf_device *device;
static char last_message[1024];

static void write_log(void *user, enum sf_log_level level, const char *message)
{
    (void)user;
    (void)level;
    snprintf(last_message, sizeof last_message, "%s", message);
}
static const struct sf_log test_log = {.write = write_log, .level = SF_LOG_WARNING};

#define SCENE(rest, particles)                                                                                         \
    "{\"camera\":{\"eye\":[0,0,4],\"target\":[0,0,0],\"fov\":40,\"near\":0.01},\"sim\":{\"capacity\":100},"            \
    "\"lights\":[{\"type\":\"directional\",\"direction\":[-1,-1,0]}],\"environment\":{\"type\":\"color\","             \
    "\"color\":[1,1,1]}," rest "\"emitters\":[{\"type\":\"list\",\"still\":true,\"particles\":[" particles "]}]}"
#define BALL  "{\"centre\":[0,0,0],\"radius\":1,\"extinction\":2}"
#define PLAIN "\"thick\":{\"detail\":0},"

struct shot {
    struct sf_scene *scene;
    struct sf_renderer *renderer;
    struct sf_frame frame;
};

static struct shot draw_with(const char *json, const struct sf_renderer_options *options, uint32_t number)
{
    struct shot shot = {NULL, NULL, {0}};
    uint64_t ticket = 0;

    if (sf_scene_parse("test", json, strlen(json), NULL, 0, &test_log, &shot.scene) != SF_OK ||
        sf_renderer_create(device, shot.scene, options, &test_log, &shot.renderer) != SF_OK ||
        sf_renderer_render(shot.renderer, number, &ticket) != SF_OK ||
        sf_renderer_wait(shot.renderer, ticket, &shot.frame) != SF_OK)
        fail_msg("%s: %s", json, last_message);
    return shot;
}

static struct shot draw(const char *json)
{
    return draw_with(json, &(struct sf_renderer_options){.width = WIDTH, .height = HEIGHT, .particles = true}, 0);
}

static void drop(struct shot *shot)
{
    sf_renderer_destroy(&shot->renderer);
    sf_scene_destroy(&shot->scene);
    assert_int_equal(sf_device_validation_messages(device), 0);
}

static struct sf_reference *reference_of(const struct shot *shot)
{
    struct sf_reference *reference = NULL;

    if (sf_reference_create(shot->scene, &shot->frame, &(struct sf_reference_options){0}, &test_log, &reference) !=
        SF_OK)
        fail_msg("%s", last_message);
    return reference;
}

/* The smoke as float is the smoke as half, in other words. */
static void test_float_aovs(void **state)
{
    struct sf_renderer_options options = {.width = WIDTH, .height = HEIGHT, .aovs = SF_AOV_SMOKE, .float_aovs = true};
    struct shot shot = draw_with(SCENE(PLAIN, BALL), &options, 0);
    float *floats = malloc(sizeof(float) * WIDTH * HEIGHT * 4);
    uint64_t ticket;
    uint32_t smoky = 0;

    (void)state;
    assert_null(shot.frame.smoke);
    assert_non_null(shot.frame.smoke_float);
    assert_non_null(floats);
    memcpy(floats, shot.frame.smoke_float, sizeof(float) * WIDTH * HEIGHT * 4);
    options.float_aovs = false;
    assert_int_equal(sf_renderer_set_options(shot.renderer, &options), SF_OK);
    assert_int_equal(sf_renderer_render(shot.renderer, 0, &ticket), SF_OK);
    assert_int_equal(sf_renderer_wait(shot.renderer, ticket, &shot.frame), SF_OK);
    assert_null(shot.frame.smoke_float);
    for (uint32_t i = 0; i < WIDTH * HEIGHT * 4; i++) {
        assert_int_equal(sf_half_from_float(floats[i]), shot.frame.smoke[i]);
        smoky += floats[i] > 0;
    }
    assert_true(smoky > 100);
    free(floats);
    drop(&shot);
}

/* What the list says is what comes back, in its order. */
static void test_particles(void **state)
{
    struct shot shot = draw(SCENE(PLAIN, BALL ",{\"centre\":[0.5,-0.25,3],\"radius\":0.5,\"extinction\":7,"
                                              "\"velocity\":[1,2,3],\"age\":2,\"lifetime\":8,\"tile\":3,"
                                              "\"rotation\":1.5}"));
    const struct sf_frame_particle *p = shot.frame.particles;

    (void)state;
    assert_int_equal(shot.frame.live, 2);
    assert_non_null(p);
    assert_true(p[0].position[0] == 0 && p[0].radius == 1 && p[0].extinction == 2 && p[0].lifetime == 0);
    assert_true(p[1].position[0] == 0.5f && p[1].position[1] == -0.25f && p[1].position[2] == 3);
    assert_true(p[1].radius == 0.5f && p[1].extinction == 7 && p[1].age == 2 && p[1].lifetime == 8);
    assert_true(p[1].velocity[0] == 1 && p[1].velocity[1] == 2 && p[1].velocity[2] == 3 && p[1].rotation == 1.5f);
    assert_true(p[1].birth_radius == 0.5f && p[1].birth_extinction == 7);
    assert_int_equal(p[0].id, 0);
    assert_int_equal(p[1].id, 1);
    assert_int_equal(p[1].look & 0xff, 3);
    drop(&shot);
}

/* A moving list is that of the frame itself: the bounds that the device took agree with it. */
static void test_particles_of_the_frame(void **state)
{
    struct shot shot = draw_with("{\"emitters\":[{\"type\":\"cone\",\"rate\":100}],\"sim\":{\"capacity\":64}}",
                                 &(struct sf_renderer_options){.width = 8, .height = 8, .particles = true}, 9);
    float low = INFINITY;

    (void)state;
    assert_true(shot.frame.live > 10 && shot.frame.live <= 64);
    for (uint32_t i = 0; i < shot.frame.live; i++)
        low = fminf(low, shot.frame.particles[i].position[1] - shot.frame.particles[i].radius);
    assert_true(fabsf(low - shot.frame.bounds_min[1]) < 1e-5f);
    drop(&shot);
}

static void test_particles_usage(void **state)
{
    static const char json[] = SCENE(PLAIN, BALL);
    struct shot plain = draw_with(json, &(struct sf_renderer_options){.width = 8, .height = 8}, 0);
    struct sf_renderer_options options = {.width = 8, .height = 8, .particles = true, .no_readback = true};
    struct sf_renderer *renderer = NULL;
    struct sf_reference *reference = NULL;
    char *text = NULL;

    (void)state;
    assert_null(plain.frame.particles);
    /* Nothing is in the graph for it when it was not asked for. */
    assert_int_equal(sf_renderer_graph_print(plain.renderer, "text", &text), SF_OK);
    assert_null(strstr(text, "output.particles"));
    free(text);
    assert_int_equal(sf_renderer_create(device, plain.scene, &options, &test_log, &renderer), SF_ERROR_USAGE);
    assert_non_null(strstr(last_message, "particles"));
    assert_int_equal(
        sf_reference_create(plain.scene, &plain.frame, &(struct sf_reference_options){0}, &test_log, &reference),
        SF_ERROR_USAGE);
    assert_null(reference);
    assert_non_null(strstr(last_message, "sf_renderer_options.particles"));
    options.no_readback = false;
    options.shown = true; /* the list comes back, though the picture does not */
    assert_int_equal(sf_renderer_set_options(plain.renderer, &options), SF_OK);
    uint64_t ticket;
    assert_int_equal(sf_renderer_render(plain.renderer, 0, &ticket), SF_OK);
    assert_int_equal(sf_renderer_wait(plain.renderer, ticket, &plain.frame), SF_OK);
    assert_null(plain.frame.color);
    assert_non_null(plain.frame.particles);
    assert_true(plain.frame.particles[0].extinction == 2);
    drop(&plain);
}

/* Optical depth 2 times the chord of the unit ball at the origin, seen from z = 4 with 40 degrees. */
static double ball_transmittance(uint32_t width, uint32_t height, uint32_t x, uint32_t y)
{
    double tangent = tan(20 * 3.14159265358979323846 / 180);
    double dx = (2 * (x + 0.5) / width - 1) * tangent * width / height, dy = (1 - 2 * (y + 0.5) / height) * tangent;
    double away = 16 * (dx * dx + dy * dy) / (dx * dx + dy * dy + 1); /* squared, of the ray from the centre */

    return away < 1 ? exp(-2 * 2 * sqrt(1 - away)) : 1;
}

/* Bit for bit, but for what stands behind the last member. */
static void assert_same(const struct sf_reference_pixel *a, const struct sf_reference_pixel *b)
{
    assert_memory_equal(a, b, offsetof(struct sf_reference_pixel, converged));
    assert_int_equal(a->converged, b->converged);
}

/* All is copied: the scene and the frame are gone when the picture is made. */
static void test_reference_picture(void **state)
{
    struct shot shot = draw(SCENE(PLAIN, BALL));
    struct sf_reference *reference = reference_of(&shot);
    struct sf_reference_picture *picture = NULL, *again = NULL;

    (void)state;
    drop(&shot);
    memset(&shot, 0x55, sizeof shot);
    assert_null(sf_reference_note(reference, 0));
    assert_int_equal(sf_reference_render(reference, NULL, WIDTH, HEIGHT, 0, NULL, NULL, &picture), SF_OK);
    assert_int_equal(picture->width, WIDTH);
    assert_int_equal(picture->height, HEIGHT);
    assert_int_equal(picture->unconverged, 0);
    for (uint32_t y = 0; y < HEIGHT; y++) {
        for (uint32_t x = 0; x < WIDTH; x++) {
            const struct sf_reference_pixel *pixel = &picture->pixels[y * WIDTH + x];

            assert_true(fabs((double)pixel->transmittance - ball_transmittance(WIDTH, HEIGHT, x, y)) < 1e-6);
            assert_true(pixel->transmittance == 1 ? pixel->near == SF_NO_DEPTH && pixel->radiance[0] == 0
                                                  : pixel->near < pixel->far && pixel->radiance[0] > 0);
        }
    }
    /* One pixel of each 4 x 4 is the same pixel; the last column's stands for a block that the picture cuts off. */
    const struct sf_camera_view close = {{0, 0, 2}, {0, 0, 0}, {0, 1, 0}, 40, 0.01f};
    sf_reference_picture_destroy(&picture);
    assert_int_equal(sf_reference_render(reference, &close, WIDTH, HEIGHT, 0, NULL, NULL, &picture), SF_OK);
    assert_int_equal(sf_reference_render(reference, &close, WIDTH, HEIGHT, 4, NULL, NULL, &again), SF_OK);
    assert_int_equal(again->width, 11);
    assert_int_equal(again->height, 8);
    assert_true(again->pixels[4 * 11 + 10].transmittance < 1);
    for (uint32_t y = 0; y < 8; y++)
        for (uint32_t x = 0; x < 11; x++) {
            uint32_t from = (4 * y + 2) * WIDTH + (x < 10 ? 4 * x + 2 : 40);
            assert_same(&again->pixels[y * 11 + x], &picture->pixels[from]);
        }
    sf_reference_picture_destroy(&again);
    sf_reference_picture_destroy(&picture);
    assert_null(picture);
    sf_reference_destroy(&reference);
}

/* The frame's own view, the scene's camera or not, is what NULL means. */
static void test_reference_view(void **state)
{
    const struct sf_camera_view beside = {{4, 0, 0}, {0, 0, 0}, {0, 2, 0}, 40, 0.01f}, nowhere = {.fov = 40};
    struct shot shot = draw(SCENE(PLAIN, "{\"centre\":[0,0,1.5],\"radius\":0.3,\"extinction\":2}"));
    struct sf_reference_picture *first = NULL, *second = NULL;
    struct sf_reference *reference;
    uint64_t ticket;

    (void)state;
    assert_true(shot.frame.view.eye[2] == 4 && shot.frame.view.fov == 40);
    sf_renderer_set_view(shot.renderer, &beside);
    assert_int_equal(sf_renderer_render(shot.renderer, 0, &ticket), SF_OK);
    assert_int_equal(sf_renderer_wait(shot.renderer, ticket, &shot.frame), SF_OK);
    assert_true(shot.frame.view.eye[0] == 4 && shot.frame.view.up[1] == 1);
    reference = reference_of(&shot);
    assert_int_equal(sf_reference_render(reference, NULL, WIDTH, HEIGHT, 1, NULL, NULL, &first), SF_OK);
    assert_int_equal(sf_reference_render(reference, &beside, WIDTH, HEIGHT, 1, NULL, NULL, &second), SF_OK);
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++)
        assert_same(&first->pixels[i], &second->pixels[i]);
    assert_true(first->pixels[HEIGHT / 2 * WIDTH + WIDTH / 2].transmittance == 1); /* the ball stands aside */
    sf_reference_picture_destroy(&second);
    assert_int_equal(sf_reference_render(reference, &nowhere, 4, 4, 1, NULL, NULL, &second), SF_ERROR_USAGE);
    assert_null(second);
    assert_int_equal(sf_reference_render(reference, NULL, 0, 4, 1, NULL, NULL, &second), SF_ERROR_USAGE);
    sf_reference_picture_destroy(&first);
    sf_reference_destroy(&reference);
    drop(&shot);
}

static bool stop(void *user, uint64_t done, uint64_t total)
{
    (void)done;
    assert_int_equal(total, HEIGHT);
    return --*(int *)user > 0;
}

static void test_interrupted(void **state)
{
    struct shot shot = draw(SCENE(PLAIN, BALL));
    struct sf_reference *reference = reference_of(&shot);
    struct sf_reference_picture *picture = NULL;
    int left = 3;

    (void)state;
    assert_int_equal(sf_reference_render(reference, NULL, WIDTH, HEIGHT, 1, stop, &left, &picture),
                     SF_ERROR_INTERRUPTED);
    assert_null(picture);
    sf_reference_destroy(&reference);
    drop(&shot);
}

/* The curve begins with nothing, only grows, and ends at the pixel. */
static void test_probe(void **state)
{
    enum { COUNT = 33, X = WIDTH / 2, Y = HEIGHT / 2 };
    struct shot shot = draw(SCENE(PLAIN, BALL ",{\"centre\":[0,0,-3],\"radius\":0.5,\"extinction\":1}"));
    struct sf_reference *reference = reference_of(&shot);
    struct sf_reference_picture *picture = NULL;
    struct sf_probe_point points[COUNT];

    (void)state;
    assert_int_equal(sf_reference_render(reference, NULL, WIDTH, HEIGHT, 1, NULL, NULL, &picture), SF_OK);
    const struct sf_reference_pixel *pixel = &picture->pixels[Y * WIDTH + X];
    assert_int_equal(sf_reference_probe(reference, NULL, WIDTH, HEIGHT, X, Y, points, COUNT), SF_OK);
    assert_true(points[0].depth == pixel->near && points[0].transmittance == 1 && points[0].radiance[0] == 0);
    for (int i = 1; i < COUNT; i++) {
        assert_true(points[i].depth > points[i - 1].depth && points[i].transmittance <= points[i - 1].transmittance &&
                    points[i].radiance[1] >= points[i - 1].radiance[1]);
        /* Through the middle of the ball: 2 per metre, in depth from 3 to 5. */
        if (points[i].depth < 5)
            assert_true(fabs((double)points[i].transmittance - exp(-2 * ((double)points[i].depth - 3))) < 1e-5);
    }
    assert_true(points[COUNT - 1].depth == pixel->far);
    assert_true(fabsf(points[COUNT - 1].transmittance - pixel->transmittance) < 1e-6f);
    assert_true(fabsf(points[COUNT - 1].radiance[2] - pixel->radiance[2]) < 2e-4f * pixel->radiance[2]);
    assert_int_equal(sf_reference_probe(reference, NULL, WIDTH, HEIGHT, X, Y, points, 1), SF_OK);
    assert_true(points[0].depth == pixel->far && fabsf(points[0].transmittance - pixel->transmittance) < 1e-6f);
    assert_int_equal(sf_reference_probe(reference, NULL, WIDTH, HEIGHT, 0, 0, points, COUNT), SF_OK);
    assert_true(points[COUNT - 1].depth == SF_NO_DEPTH && points[COUNT - 1].transmittance == 1);
    assert_int_equal(sf_reference_probe(reference, NULL, WIDTH, HEIGHT, WIDTH, 0, points, COUNT), SF_ERROR_USAGE);
    sf_reference_picture_destroy(&picture);
    sf_reference_destroy(&reference);
    drop(&shot);
}

/* White smoke in white light from everywhere is white, however often light is scattered: its radiance is 1 - T. */
static void test_scatter(void **state)
{
    enum { SIDE = 9, HALF = 40 };
    struct shot shot = draw("{\"camera\":{\"eye\":[0,0,4],\"target\":[0,0,0],\"fov\":20},"
                            "\"medium\":{\"albedo\":[1,1,1]},\"thick\":{\"detail\":0},"
                            "\"environment\":{\"type\":\"color\",\"color\":[1,1,1]},"
                            "\"emitters\":[{\"type\":\"list\",\"still\":true,\"particles\":[" BALL "]}]}");
    struct sf_reference *reference = reference_of(&shot);
    struct sf_reference_estimate *estimate = NULL, *whole = NULL;

    (void)state;
    drop(&shot);
    for (uint32_t i = 1; i <= 2; i++) {
        assert_int_equal(sf_reference_scatter(reference, NULL, SIDE, SIDE, 0, HALF, NULL, NULL, &estimate), SF_OK);
        assert_int_equal(estimate->paths, i * HALF);
    }
    assert_int_equal(sf_reference_scatter(reference, NULL, SIDE, SIDE, 0, 2 * HALF, NULL, NULL, &whole), SF_OK);
    assert_memory_equal(estimate->radiance, whole->radiance, SIDE * SIDE * 3 * sizeof(float));
    assert_memory_equal(estimate->error, whole->error, SIDE * SIDE * 3 * sizeof(float));
    struct sf_reference_picture *picture = NULL;
    assert_int_equal(sf_reference_render(reference, NULL, SIDE, SIDE, 1, NULL, NULL, &picture), SF_OK);
    /* All pixels together: of a single one so few paths say little about their own spread. */
    double away = 0, variance = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        away += (double)estimate->radiance[3 * i] + (double)picture->pixels[i].transmittance - 1;
        variance += pow((double)estimate->error[3 * i], 2);
    }
    printf("  sum of %d pixels is off by %.3g, standard error %.3g\n", SIDE * SIDE, away, sqrt(variance));
    assert_true(fabs(away) < 4 * sqrt(variance) && sqrt(variance) < 0.02 * SIDE * SIDE);
    sf_reference_picture_destroy(&picture);
    /* Another size, or other orders: refused, and the estimate is gone. */
    assert_int_equal(sf_reference_scatter(reference, NULL, SIDE, SIDE, 1, HALF, NULL, NULL, &estimate), SF_ERROR_USAGE);
    assert_null(estimate);
    sf_reference_estimate_destroy(&whole);
    sf_reference_destroy(&reference);
}

static void test_notes(void **state)
{
    struct shot shot = draw(SCENE("\"thick\":{\"detail\":0.5,\"octaves\":3,\"scene_shadow\":false},", BALL));
    struct sf_reference *reference = reference_of(&shot);

    (void)state;
    assert_non_null(strstr(sf_reference_note(reference, 0), "thick.detail is 0.5"));
    assert_non_null(strstr(sf_reference_note(reference, 1), "thick.octaves is 3"));
    assert_non_null(strstr(sf_reference_note(reference, 2), "thick.scene_shadow"));
    assert_null(sf_reference_note(reference, 3));
    assert_null(sf_reference_note(reference, UINT32_MAX));
    sf_reference_destroy(&reference);
    shot.scene->method = 99; /* of a medium that is none of ours */
    assert_int_equal(
        sf_reference_create(shot.scene, &shot.frame, &(struct sf_reference_options){0}, &test_log, &reference),
        SF_ERROR_SCENE);
    assert_null(reference);
    assert_non_null(strstr(last_message, "no reference"));
    assert_int_equal(sf_reference_create(shot.scene, &shot.frame, &(struct sf_reference_options){.tolerance = -1},
                                         &test_log, &reference),
                     SF_ERROR_SCENE);
    drop(&shot);
}

/* Nothing to see: no particles at all. */
static void test_empty(void **state)
{
    struct shot shot = draw(SCENE(PLAIN, ""));
    struct sf_reference *reference = reference_of(&shot);
    struct sf_reference_picture *picture = NULL;

    (void)state;
    assert_int_equal(shot.frame.live, 0);
    assert_int_equal(sf_reference_render(reference, NULL, 4, 4, 1, NULL, NULL, &picture), SF_OK);
    assert_true(picture->pixels[5].transmittance == 1 && picture->pixels[5].far == SF_NO_DEPTH);
    sf_reference_picture_destroy(&picture);
    sf_reference_destroy(&reference);
    drop(&shot);
}

static int setup(void **state)
{
    (void)state;
    enum sf_status status = sf_device_create(&(struct sf_device_options){.validate = true}, &test_log, &device);
    if (status == SF_ERROR_DEVICE)
        exit(77);
    return status;
}

static int teardown(void **state)
{
    (void)state;
    sf_device_destroy(&device);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_float_aovs),
        cmocka_unit_test(test_particles),
        cmocka_unit_test(test_particles_of_the_frame),
        cmocka_unit_test(test_particles_usage),
        cmocka_unit_test(test_reference_picture),
        cmocka_unit_test(test_reference_view),
        cmocka_unit_test(test_interrupted),
        cmocka_unit_test(test_probe),
        cmocka_unit_test(test_scatter),
        cmocka_unit_test(test_notes),
        cmocka_unit_test(test_empty),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
