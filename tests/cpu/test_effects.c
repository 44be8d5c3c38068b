/* Effects: their time lines against a model that unrolls every turn of every clock, and what they become in a scene. */
#include "scene_kit.h"

#include <math.h>
#include "base/file.h"
#include "base/hash.h"
#include "sim/births.h"
#include "sim/feed.h"

/* ---- the model ---- */

enum { RUNS_MAX = 4096 };
static const double HORIZON = 12; /* s */

/* Every run of the innermost clock, unrolled. */
struct unrolled {
    double begin[RUNS_MAX], length[RUNS_MAX];
    unsigned count;
};

static void unroll(const struct sf_timing *timing, uint32_t level, double from, double until, struct unrolled *list)
{
    const struct sf_clock *clock = &timing->clocks[level];
    double begin = from + clock->start;

    for (int turn = 0; begin < until; turn++) {
        double end = clock->duration > 0 ? begin + clock->duration : clock->every > 0 ? begin + clock->every : until;

        end = fmin(end, until);
        if (level + 1 < timing->clock_count) {
            unroll(timing, level + 1, begin, end, list);
        } else {
            assert_true(list->count < RUNS_MAX);
            list->begin[list->count] = begin;
            list->length[list->count++] = end - begin;
        }
        if (clock->every <= 0 || (clock->times > 0 && turn + 1 == clock->times))
            break;
        begin += clock->every;
    }
}

static double model_ease(int32_t easing, double x)
{
    x = x < 0 ? 0 : x > 1 ? 1 : x;
    return easing == SF_EASING_SMOOTH ? 3 * x * x - 2 * x * x * x
           : easing == SF_EASING_IN   ? x * x
           : easing == SF_EASING_OUT  ? 1 - (1 - x) * (1 - x)
                                      : x;
}

/* `u`: time of the innermost clock. */
static double model_strength(const struct sf_timing *timing, double u)
{
    const struct sf_clock *clock = &timing->clocks[timing->clock_count - 1];
    double run = clock->duration > 0 ? clock->duration : clock->every, strength = 1;

    if (timing->fade_in > 0)
        strength *= model_ease(timing->easing, u / timing->fade_in);
    if (timing->fade_out > 0)
        strength *= model_ease(timing->easing, (run - u) / timing->fade_out);
    return strength;
}

/* By the midpoint rule. */
static double model_integral(const struct sf_timing *timing, double u)
{
    const int pieces = 4000;
    double sum = 0;

    for (int i = 0; i < pieces; i++)
        sum += model_strength(timing, u * (i + 0.5) / pieces);
    return sum * u / pieces;
}

static uint32_t lot;
static float draw(float low, float high)
{
    return low + (high - low) * sf_random_float(77, lot++, 0);
}

/* Quarters and eighths of seconds now and then, so that clocks meet. */
static float draw_time(float high)
{
    float time = draw(0, high);

    return draw(0, 1) < 0.5f ? roundf(time * 8) / 8 : time;
}

static struct sf_timing draw_timing(void)
{
    struct sf_timing timing = {.clock_count = 1 + (uint32_t)draw(0, 3.99f)};
    double run;

    for (uint32_t i = 0; i < timing.clock_count; i++) {
        struct sf_clock *clock = &timing.clocks[i];

        clock->start = draw_time(1);
        clock->every = draw(0, 1) < 0.6f ? 0.125f + draw_time(4.0f / (float)(1u << i)) : 0;
        clock->times = clock->every > 0 && draw(0, 1) < 0.5f ? 1 + (int32_t)draw(0, 3.99f) : 0;
        clock->duration = draw(0, 1) < 0.7f ? 0.125f + draw_time(3) : 0;
        if (clock->every > 0)
            clock->duration = fminf(clock->duration, clock->every);
    }
    run = sf_clock_run(&timing.clocks[timing.clock_count - 1]);
    timing.easing = (int32_t)draw(0, 3.99f);
    timing.fade_in = draw(0, 1) < 0.5f ? draw(0, 0.5f) * (float)fmin(run, 2) : 0;
    timing.fade_out = isfinite(run) && draw(0, 1) < 0.5f ? draw(0, 0.5f) * (float)run : 0;
    return timing;
}

/* ---- time lines ---- */

static void easings_and_their_integrals(void **state)
{
    (void)state;
    for (int32_t easing = 0; easing < 4; easing++) {
        struct sf_timing timing = {
            .clocks = {{.duration = 3}}, .clock_count = 1, .easing = easing, .fade_in = 1, .fade_out = 1.5f};

        assert_true(sf_ease(easing, 0) == 0 && sf_ease(easing, 1) == 1 && sf_ease(easing, -1) == 0 &&
                    sf_ease(easing, 2) == 1);
        for (double x = 0; x <= 1; x += 0.03125)
            assert_true(fabs(sf_ease(easing, x) - model_ease(easing, x)) < 1e-12);
        for (double u = 0; u <= 3; u += 0.0625)
            assert_true(fabs(sf_timing_integral(&timing, u) - model_integral(&timing, u)) < 1e-6);
    }
}

/* Before, within, between and after, in clocks within clocks. */
static void clocks_agree_with_the_unrolled_model(void **state)
{
    static struct unrolled list;
    unsigned on = 0, asked = 0;

    (void)state;
    for (int trial = 0; trial < 400; trial++) {
        struct sf_timing timing = draw_timing();

        list.count = 0;
        unroll(&timing, 0, 0, HORIZON, &list);
        for (double time = -0.5; time < HORIZON; time += 0.0371) {
            double local = 0, strength = 0, u = -1, edge = 1;
            bool is_on;

            for (unsigned i = 0; i < list.count; i++) {
                double since = time - list.begin[i];

                edge = fmin(edge, fmin(fabs(since), fabs(since - list.length[i])));
                if (since >= 0 && since < list.length[i])
                    u = since;
            }
            if (edge < 1e-4)
                continue;
            is_on = sf_timing_at(&timing, time, &local, &strength);
            if (is_on != (u >= 0))
                fail_msg("trial %d: %s at %g s, and should be %s", trial, is_on ? "on" : "off", time,
                         u >= 0 ? "on" : "off");
            asked++;
            on += is_on;
            if (is_on && (fabs(local - u) > 1e-5 || fabs(strength - model_strength(&timing, local)) > 1e-9))
                fail_msg("trial %d: at %g s its clock shows %g (%g), strength %g (%g)", trial, time, local, u, strength,
                         model_strength(&timing, u));
        }
    }
    assert_true(on > asked / 20 && on < asked - asked / 20);
}

/* ---- births ---- */

static void births_agree_with_the_unrolled_model(void **state)
{
    static struct unrolled list;
    static struct sf_scene scene;
    static struct sf_sim_now now;
    static struct sf_sim_births births;
    unsigned born = 0, most_records = 0;

    (void)state;
    for (int trial = 0; trial < 150; trial++) {
        struct sf_timing timing = draw_timing();
        struct sf_emitter *emitter = &scene.emitters[0];
        struct sf_sim_layout layout = {0};
        double rate;
        uint32_t id = 0;

        memset(&scene, 0, sizeof scene);
        scene.sim = (struct sf_sim_settings){.capacity = 100000, .fps = draw(3, 30), .substeps = 1 + trial % 3};
        *emitter =
            (struct sf_emitter){.timing = &timing, .rate = draw(1, 200), .burst = trial % 4, .start = draw_time(0.2f)};
        if (trial % 3 == 0)
            emitter->duration = 0.1f + draw_time(1);
        scene.emitter_count = 1;
        rate = sf_sim_step_rate(&scene);
        list.count = 0;
        unroll(&timing, 0, 0, HORIZON, &list);
        for (uint64_t step = 0; (double)step / rate < HORIZON - 1; step++) {
            double time = (double)step / rate, exact = 0;
            uint32_t count = 0, slack = 1;
            uint64_t now_born = sf_sim_births(&scene, emitter, step);

            for (unsigned i = 0; i < list.count && list.begin[i] < time; i++) {
                double u = fmin(time - list.begin[i], list.length[i]);
                double end = emitter->duration > 0 ? fmin(u, (double)emitter->start + emitter->duration) : u;

                if (step % 8 == 0 && end > emitter->start)
                    exact +=
                        floor(emitter->rate * (model_integral(&timing, end) - model_integral(&timing, emitter->start)) +
                              1e-5);
                slack++;
                exact += emitter->start < u ? emitter->burst : 0;
            }
            /* Where rate and integral come to a whole number, rounding decides, once in each run. */
            if (step % 8 == 0 && fabs(exact - (double)now_born) > (slack < 3 ? slack : 3))
                fail_msg("trial %d, step %u: %u births, and %g in the model", trial, (unsigned)step, (unsigned)now_born,
                         exact);
            assert_int_equal(now_born, id);
            sf_sim_feed(&scene, &layout, step, &now, &births);
            assert_int_equal(now.first_id, id);
            most_records = now.record_count > most_records ? now.record_count : most_records;
            for (uint32_t i = 0; i < now.record_count; i++) {
                const struct sf_sim_record *record = &births.records[i];

                assert_int_equal(record->first, count);
                assert_true(record->count > 0 && record->begin[3] > -1e-4 && record->begin[3] < 1 + 1e-4);
                count += record->count;
            }
            assert_int_equal(now.births, count);
            id += count;
        }
        born += id;
    }
    assert_true(born > 10000 && most_records == 3);
}

/* Where the device puts each of them is on the path, at the moment of its own turn. */
static void a_path_begins_again_with_its_step(void **state)
{
    static struct sf_scene scene;
    static struct sf_sim_now now;
    static struct sf_sim_births births;
    struct sf_path_key path[2] = {{0, {0, 0, 0}}, {0.5f, {2, 0, 0}}};
    struct sf_timing timing = {.clocks = {{.start = 0.3f}, {.duration = 0.5f, .every = 0.7f, .times = 4}},
                               .clock_count = 2};
    struct sf_sim_layout layout = {0};
    unsigned born = 0;

    (void)state;
    scene.sim = (struct sf_sim_settings){.capacity = 1000, .fps = 11, .substeps = 1};
    scene.emitters[0] =
        (struct sf_emitter){.timing = &timing, .rate = 100, .inherit = 1, .path = path, .path_count = 2};
    scene.emitter_count = 1;
    for (uint64_t step = 0; step < 60; step++) {
        sf_sim_feed(&scene, &layout, step, &now, &births);
        for (uint32_t i = 0; i < now.record_count; i++) {
            const struct sf_sim_record *record = &births.records[i];

            for (uint32_t k = 0; k < record->count; k++, born++) {
                double moment = record->begin[3] + k * (double)record->end[3];
                double time = ((double)step + moment) / 11, u = fmod(time - 0.3, 0.7);
                double x = record->begin[0] + (record->end[0] - record->begin[0]) * moment;

                assert_true(time > 0.3 && time < 0.3 + 3 * 0.7 + 0.5 + 1e-6);
                assert_true(fabs(x - 4 * u) < 1e-4 && fabs(record->drift[0] - 4) < 1e-3);
            }
        }
    }
    assert_int_equal(born, 4 * 50);
}

/* ---- in a scene ---- */

static void write_text(const char *path, const char *text)
{
    assert_int_equal(sf_file_write(path, text, strlen(text), NULL), SF_OK);
}

#define POINT   "{\"type\":\"light\",\"light\":{\"type\":\"point\",\"position\":[1,0,0]}}"
#define EMITTER "{\"type\":\"emitter\",\"emitter\":{\"type\":\"cone\",\"position\":[0,1,2],\"direction\":[0,0,1]}}"
#define SCENE   "{\"effects\":[{\"file\":\"a.json\"}]}"

static void near3(const float v[3], double x, double y, double z)
{
    if (fabs(v[0] - x) > 1e-5 || fabs(v[1] - y) > 1e-5 || fabs(v[2] - z) > 1e-5)
        fail_msg("%g %g %g, not %g %g %g", v[0], v[1], v[2], x, y, z);
}

/* An effect in an effect, each with a place and a time of its own. */
static void nested_effects_are_placed_and_timed(void **state)
{
    struct sf_scene *scene;
    const struct sf_emitter *emitter;
    const struct sf_timing *timing;

    (void)state;
    mkdir("sub", 0700);
    write_text(
        "sub/inner.json",
        "{\"duration\":2,\"loop\":true,\"steps\":[{\"type\":\"emitter\",\"start\":0.25,\"emitter\":{\"type\":\"mesh\","
        "\"file\":\"x.obj\",\"position\":[0,1,2],\"direction\":[0,0,1],\"extinction\":6,\"speed\":2}}," POINT "]}");
    write_text("sub/x.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write_text("a.json", "{\"steps\":[{\"type\":\"effect\",\"file\":\"sub/"
                         "inner.json\",\"start\":1,\"every\":5,\"times\":2,\"position\":[1,0,0],"
                         "\"rotation\":90,\"scale\":2}]}");
    scene =
        parse("{\"lights\":[{\"type\":\"point\",\"position\":[0,0,0]}],\"emitters\":[{\"type\":\"cone\"}],"
              "\"effects\":[{\"file\":\"a.json\",\"position\":[0,0,10],\"rotation\":90,\"scale\":1.5,\"start\":0.5}]}");
    assert_true(scene->emitter_count == 2 && scene->light_count == 2 && scene->effect_count == 1);
    assert_null(scene->emitters[0].timing);
    emitter = &scene->emitters[1];
    /* Ry(90) takes +z to +x, and +x to -z. Inner: 2 Ry(90) (0,1,2) + (1,0,0) = (5,2,0); outer: 1.5 Ry(90) of it + (0,0,10). */
    near3(emitter->position, 0, 3, 10 - 7.5);
    near3(emitter->direction, 0, 0, -1);
    near3(scene->lights[1].position, -3, 0, 10 - 1.5);
    assert_float_equal(emitter->extinction, 2, 1e-6);
    assert_float_equal(emitter->speed[0], 6, 1e-6);
    assert_float_equal(emitter->rotation, 180, 1e-4);
    assert_float_equal(scene->lights[1].intensity, 3 * 9, 1e-4);
    assert_string_equal(emitter->file, "sub/x.obj");
    assert_int_equal(scene->mesh_count, 1);
    assert_non_null(strstr(emitter->origin, "/effects/0 (sub/inner.json: /steps/0/emitter)"));
    timing = emitter->timing;
    assert_int_equal(timing->clock_count, 4);
    assert_true(timing->clocks[0].start == 0.5f && timing->clocks[1].start == 1 && timing->clocks[1].every == 5 &&
                timing->clocks[1].times == 2 && timing->clocks[2].every == 2 && timing->clocks[3].start == 0.25f);
    sf_scene_destroy(&scene);
}

static void lights_flashes_and_shakes_come_and_go(void **state)
{
    struct sf_light lights[SF_LIGHTS_MAX];
    struct sf_camera_pose before, during, again, after;
    struct sf_scene *scene, *other;
    const char *const seed[] = {"sim.seed=2"};
    const char *text = "{\"sim\":{\"preroll\":1},\"effects\":[{\"file\":\"a.json\",\"start\":2}]}";
    float rgb[3];

    (void)state;
    write_text(
        "a.json",
        "{\"steps\":[{\"type\":\"light\",\"start\":0.5,\"duration\":1,\"fade_out\":0.5,\"light\":{\"type\":\"point\","
        "\"position\":[1,0,0],\"intensity\":8}},"
        "{\"type\":\"flash\",\"start\":0.5,\"duration\":0.5,\"fade_out\":0.5,\"easing\":\"in\",\"color\":[1,0.5,0],"
        "\"strength\":4},"
        "{\"type\":\"flash\",\"start\":0.75,\"duration\":0.5,\"color\":[0,0,1],\"strength\":1},"
        "{\"type\":\"shake\",\"start\":0.5,\"duration\":1,\"fade_out\":0.5,\"amplitude\":0.1,\"angle\":2,\"frequency\":"
        "9}]}");
    scene = parse(text);
    other = parse_with(text, seed, 1);
    /* All of it begins at 2.5 s of the simulation's clock, which is 1.5 s of the frames'. */
    for (int i = 0; i < 5; i++) {
        static const double times[] = {1.4, 1.5, 2, 2.25, 2.51}, wanted[] = {0, 8, 8, 4, 0};

        sf_scene_lights(scene, times[i], lights);
        if (fabs(lights[0].intensity - wanted[i]) > 1e-4)
            fail_msg("at %g s the light is %g, not %g", times[i], (double)lights[0].intensity, wanted[i]);
    }
    sf_scene_flash(scene, 1.49, rgb);
    near3(rgb, 0, 0, 0);
    sf_scene_flash(scene, 1.75, rgb); /* half of it has gone: 1/4 is left; the other has just begun */
    assert_true(fabs(rgb[0] - 1) < 1e-4 && fabs(rgb[1] - 0.5) < 1e-4 && rgb[2] == 1);
    sf_scene_flash(scene, 2.26, rgb);
    near3(rgb, 0, 0, 0);
    sf_scene_camera(scene, 1.2, &before);
    sf_scene_camera(scene, 1.83, &during);
    sf_scene_camera(scene, 1.83, &again);
    sf_scene_camera(scene, 2.6, &after);
    assert_memory_equal(&before, &after, sizeof before);
    assert_memory_equal(&during, &again, sizeof during);
    assert_memory_not_equal(&before, &during, sizeof before);
    for (int i = 0; i < 3; i++)
        assert_true(fabsf(during.eye[i] - before.eye[i]) <= 0.2f);
    sf_scene_camera(other, 1.83, &again);
    assert_memory_not_equal(&during, &again, sizeof during);
    sf_scene_destroy(&scene);
    sf_scene_destroy(&other);
}

static void shakes_are_what_the_document_says(void **state)
{
    struct sf_camera_pose still, pose;
    struct sf_scene *scene;

    (void)state;
    for (double x = 0; x < 6; x += 0.125) {
        double a = floor(x) > 0 ? 2 * (double)sf_random_float(5, (uint32_t)floor(x), 9) - 1 : 0;
        double b = 2 * (double)sf_random_float(5, (uint32_t)floor(x) + 1, 9) - 1;

        assert_true(fabs(sf_unsteady(5, 9, x) - (a + (b - a) * model_ease(SF_EASING_SMOOTH, x - floor(x)))) < 1e-12);
    }
    /* Only turned: the eye stays, and what it looks at is as far along the view as before. */
    write_text("a.json",
               "{\"steps\":[{\"type\":\"shake\",\"duration\":4,\"amplitude\":0,\"angle\":5,\"frequency\":3}]}");
    scene = parse(SCENE);
    sf_scene_camera(scene, 5, &still);
    for (double time = 0.1; time < 4; time += 0.1) {
        double along = 0, aside = 0, far = 0;

        sf_scene_camera(scene, time, &pose);
        assert_memory_equal(pose.eye, still.eye, sizeof still.eye);
        for (int i = 0; i < 3; i++) {
            double axis = (double)still.target[i] - still.eye[i];

            far += axis * axis;
            along += axis * ((double)pose.target[i] - pose.eye[i]);
            aside += pow((double)pose.target[i] - still.target[i], 2);
        }
        assert_true(fabs(along / far - 1) < 1e-5 && sqrt(aside / far) < sqrt(2) * tan(5 * 3.14159265 / 180) + 1e-6);
    }
    sf_scene_destroy(&scene);
}

static void sets_and_hashes_know_effects(void **state)
{
    const char *const sets[] = {"effects.0.start=2", "effects.0.position=1,2,3"}, *const bad[] = {"effects.0.stort=2"};
    struct sf_scene *a, *b;

    (void)state;
    write_text("a.json", "{\"steps\":[" EMITTER "]}");
    a = parse(SCENE);
    b = parse_with(SCENE, sets, 2);
    assert_true(b->emitters[0].timing->clocks[0].start == 2);
    near3(b->emitters[0].position, 1, 3, 5);
    assert_true(a->hash != b->hash);
    assert_int_equal(a->stated->emitter_count, 0);
    sf_scene_destroy(&b);
    refuse_with(SCENE, bad, 1, SF_ERROR_USAGE, "did you mean start?");
    write_text("a.json", "{\"//\":\"the same\", \"steps\":[" EMITTER "]}");
    b = parse(SCENE);
    assert_true(a->hash == b->hash && sf_scene_difference(a, b) == 0);
    sf_scene_destroy(&b);
    write_text("a.json", "{\"steps\":[" EMITTER "," EMITTER "]}");
    b = parse(SCENE);
    assert_true(a->hash != b->hash && sf_scene_difference(a, b) != 0);
    sf_scene_destroy(&a);
    sf_scene_destroy(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(easings_and_their_integrals),          cmocka_unit_test(clocks_agree_with_the_unrolled_model),
        cmocka_unit_test(births_agree_with_the_unrolled_model), cmocka_unit_test(a_path_begins_again_with_its_step),
        cmocka_unit_test(nested_effects_are_placed_and_timed),  cmocka_unit_test(lights_flashes_and_shakes_come_and_go),
        cmocka_unit_test(shakes_are_what_the_document_says),    cmocka_unit_test(sets_and_hashes_know_effects),
    };
    return cmocka_run_group_tests(tests, scratch_enter, scratch_leave);
}
