/* What a step of the simulation reads, with no GPU: how many are born, when, and as what. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <math.h>
#include <cmocka.h>
#include "sim/births.h"
#include "sim/feed.h"
#include "sim/obstacle.h"

static void scene_init(struct sf_scene *scene, struct sf_emitter emitter)
{
    memset(scene, 0, sizeof *scene);
    scene->sim = (struct sf_sim_settings){.seed = 1, .capacity = 1000, .fps = 24, .substeps = 2};
    scene->emitters[scene->emitter_count++] = emitter;
}

static struct sf_sim_births births_now;

static void feed(const struct sf_scene *scene, uint64_t step, struct sf_sim_now *now)
{
    struct sf_sim_layout layout;

    sf_sim_layout_fill(scene, &layout);
    assert_true(sf_sim_feed(scene, &layout, step, now, &births_now) <= sizeof *now);
}

/* floor(rate (t - start)), whole where it is whole, and not a function of the way there. */
static void a_stream_keeps_its_rate(void **state)
{
    static const float rates[] = {0.3f, 1, 30, 47.9f, 48, 100, 2400, 1e7f};

    (void)state;
    for (size_t i = 0; i < sizeof rates / sizeof rates[0]; i++) {
        struct sf_scene scene;
        uint64_t before = 0;

        scene_init(&scene, (struct sf_emitter){.rate = rates[i], .start = 0.5f});
        for (uint64_t step = 0; step < 1000; step++) {
            uint64_t births = sf_sim_births(&scene, &scene.emitters[0], step);
            double exact = rates[i] * ((double)step / 48 - 0.5);

            assert_true(births >= before);
            assert_true(exact <= 0 ? births == 0 : fabs(exact - 0.5 - (double)births) <= 0.500002);
            before = births;
        }
        assert_int_equal(sf_sim_births(&scene, &scene.emitters[0], 24 + 480), (uint64_t)floor(rates[i] * 10.0 + 1e-6));
        assert_int_equal(sf_sim_births(&scene, &scene.emitters[0], 48000000000),
                         (uint64_t)floor(rates[i] * (1e9 - 0.5) + 1e-6));
    }
}

static void records_add_up_and_stay_within_the_step(void **state)
{
    struct sf_scene scene;
    struct sf_sim_now now;
    uint32_t id = 0;

    (void)state;
    scene_init(&scene, (struct sf_emitter){.rate = 333, .start = 0.1f, .duration = 1, .burst = 20});
    scene.emitters[scene.emitter_count++] = (struct sf_emitter){.rate = 77.7f, .burst = 5};
    for (uint64_t step = 0; step < 100; step++) {
        uint32_t births = 0;

        feed(&scene, step, &now);
        assert_int_equal(now.first_id, id);
        for (uint32_t i = 0; i < now.record_count; i++) {
            const struct sf_sim_record *record = &births_now.records[i];
            double last = record->begin[3] + (double)(record->count - 1) * record->end[3];

            assert_int_equal(record->first, births);
            assert_true(record->count > 0 && record->begin[3] > -1e-5 && last < 1 + 1e-5);
            births += record->count;
        }
        assert_int_equal(now.births, births);
        assert_int_equal(now.refused, 0);
        id += births;
    }
    assert_int_equal(id, 333 + 20 + 5 + (uint32_t)floor(77.7 * 100 / 48));
    assert_int_equal(sf_sim_births(&scene, &scene.emitters[0], 4),
                     0); /* 0.1 s lies within the step from 4/48 to 5/48 */
    assert_int_equal(sf_sim_births(&scene, &scene.emitters[0], 5), 20 + 1);
}

static void births_beyond_the_capacity_are_refused_and_counted(void **state)
{
    struct sf_scene scene;
    struct sf_sim_now now;

    (void)state;
    scene_init(&scene, (struct sf_emitter){.rate = 1e7f, .burst = 900});
    feed(&scene, 0, &now);
    assert_int_equal(now.births, 1000);
    assert_int_equal((uint64_t)now.births + now.refused, 900 + (uint64_t)floor(1e7 / 48));
    feed(&scene, 1, &now); /* numbers go on as if all had been born */
    assert_int_equal(now.first_id, 900 + (uint64_t)floor(1e7 / 48));
}

/* Lists that are there from the beginning are no births; later ones are, in the step of their start. */
static void lists_begin_when_they_say(void **state)
{
    struct sf_listed list[4] = {{.tile = 3, .extinction = -1}, {.extinction = 2}};
    struct sf_particle particles[8];
    struct sf_particle_counts counts;
    struct sf_sim_layout layout;
    struct sf_scene scene;
    struct sf_sim_now now;

    (void)state;
    scene_init(&scene, (struct sf_emitter){
                           .kind = SF_EMITTER_LIST, .list = list, .list_count = 4, .extinction = -1, .still = true});
    scene.emitters[scene.emitter_count++] =
        (struct sf_emitter){.kind = SF_EMITTER_LIST, .list = list, .list_count = 3, .extinction = 7, .start = 1};
    scene.medium.extinction = 5;
    sf_sim_layout_fill(&scene, &layout);
    assert_true(layout.first_total == 4 && layout.listed_total == 3 && layout.listed[1] == 0);
    sf_sim_first_particles(&scene, particles, &counts);
    assert_true(counts.live == 4 && counts.draw[1] == 4 && counts.capacity == 1000 && counts.dispatch[0] == 1);
    assert_true(particles[0].extinction == 5 && particles[1].extinction == 2 && particles[3].id == 3);
    assert_int_equal(particles[0].look, 3 | SF_LOOK_STILL);
    sf_sim_listed_particles(&scene, particles);
    assert_true(particles[0].extinction == 7 && particles[0].look == (3 | 1u << SF_LOOK_EMITTER_SHIFT));
    for (uint64_t step = 0; step < 100; step++) {
        feed(&scene, step, &now);
        assert_int_equal(now.births, step == 48 ? 3 : 0);
        assert_int_equal(now.first_id, step > 48 ? 7 : 4);
    }
}

/* The whole step's coefficients, where the plain formulas are exact enough to compare. */
static void coefficients_of_motion(void **state)
{
    static const double cases[][2] = {{0, 0},     {1, 0},   {0, 1},   {2, 2},      {2, 2.0000001},
                                      {2, 2.001}, {500, 3}, {3, 500}, {1e-9, 1e-9}};
    const double h = 1 / 48.0;

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        double k = (float)cases[i][0], c = (float)cases[i][1], c1 = 0, c2 = 0;
        struct sf_scene scene;
        struct sf_sim_now now;

        scene_init(&scene, (struct sf_emitter){.cooling = (float)c});
        scene.forces[scene.force_count++] = (struct sf_force){.kind = SF_FORCE_DRAG, .strength = (float)k};
        feed(&scene, 0, &now);
        for (int j = 0; j < 20000; j++) { /* the integrals, by the middles of 20,000 parts */
            double t = (j + 0.5) * h / 20000, rest = h - t;

            c1 += exp(-k * rest - c * t) * h / 20000;
            c2 += (k > 1e-6 ? -expm1(-k * rest) / k : rest) * exp(-c * t) * h / 20000;
        }
        assert_true(fabs(now.motion[0] - exp(-k * h)) < 1e-7);
        assert_true(fabs(births_now.emitters[0].turn[1] - exp(-c * h)) < 1e-7);
        assert_true(fabs(births_now.emitters[0].turn[2] / c1 - 1) < 1e-6);
        assert_true(fabs(births_now.emitters[0].turn[3] / c2 - 1) < 1e-6);
    }
}

static double row(const float r[4], const double x[3])
{
    return r[0] * x[0] + r[1] * x[1] + r[2] * x[2] + r[3];
}

static void obstacles_stand_where_they_should(void **state)
{
    struct sf_object box = {
        .kind = SF_OBJECT_BOX, .position = {1, 2, 3}, .rotation = {0, 0, 90}, .size = {2, 4, 6}, .collide = true};
    struct sf_object plane = {.kind = SF_OBJECT_PLANE, .position = {0, 2, 0}, .normal = {0.6f, 0.8f, 0}};
    struct sf_object mesh = {.kind = SF_OBJECT_MESH, .collide = true};
    struct sf_gpu_object gpu;

    (void)state;
    sf_obstacle_fill(&box, &gpu);
    /* A quarter turn about z takes the box's x to the world's y. */
    assert_true(fabs(row(gpu.row0, (double[]){1, 3, 3}) - 1) < 1e-6 &&
                fabs(row(gpu.row1, (double[]){0, 2, 3}) - 1) < 1e-6);
    assert_true(gpu.shape[0] == 1 && gpu.shape[1] == 2 && gpu.shape[2] == 3 && gpu.shape[3] == SF_OBJECT_KIND_BOX);
    sf_obstacle_fill(&plane, &gpu);
    assert_true(fabs(row(gpu.row1, (double[]){0.6, 2.8, 5}) - 1) < 1e-6 &&
                fabs(row(gpu.row1, (double[]){0, 2, -7})) < 1e-6);
    assert_true(sf_obstacle_collides(&box) && !sf_obstacle_collides(&plane) && !sf_obstacle_collides(&mesh));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_stream_keeps_its_rate),
        cmocka_unit_test(records_add_up_and_stay_within_the_step),
        cmocka_unit_test(births_beyond_the_capacity_are_refused_and_counted),
        cmocka_unit_test(lists_begin_when_they_say),
        cmocka_unit_test(coefficients_of_motion),
        cmocka_unit_test(obstacles_stand_where_they_should),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
