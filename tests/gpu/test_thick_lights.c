/* Thick smoke under many lights, from inside and out, against the reference; and lists of spheres that are too long. */
#include "thick_kit.h"

#include <stddef.h>
#include <time.h>
#include "gpu/shaders.h"
#include "shared/thick.h"

enum { WIDTH = 48, HEIGHT = 36, LIGHTS = 8, TEXT = 1 << 16 };

/* A scene with the lights and particles given as JSON. */
static void write_scene(char *text, const char *thick, const char *lights, const char *particles)
{
    int length = snprintf(text, TEXT,
                          "{\"thick\":{\"resolution\":\"full\",\"detail\":0,\"ambient\":0%s},"
                          "\"camera\":{\"eye\":[0,0,5],\"target\":[0,0,0],\"fov\":40,\"near\":0.01},"
                          "\"sim\":{\"capacity\":512},\"medium\":{\"albedo\":[0.9,0.8,0.7],\"g\":0.3},\"lights\":[%s],"
                          "\"emitters\":[{\"type\":\"list\",\"still\":true,\"particles\":[%s]}]}",
                          thick, lights, particles);
    assert_in_range(length, 1, TEXT - 1);
}

#define CLOUD                                                                                                          \
    "{\"centre\":[0,0,0],\"radius\":0.9,\"extinction\":0.9},{\"centre\":[0.7,0.4,-0.3],\"radius\":0.6,"                \
    "\"extinction\":1.5},{\"centre\":[-0.6,-0.3,0.5],\"radius\":0.5,\"extinction\":2},"                                \
    "{\"centre\":[-0.2,0.7,0.2],\"radius\":0.6,\"extinction\":1.2}"

/* Of every kind; some in the smoke. */
static const char *const lamps[LIGHTS] = {
    "{\"type\":\"directional\",\"direction\":[-0.6,-1,-0.5],\"color\":[1,0.9,0.7],\"intensity\":5}",
    "{\"type\":\"directional\",\"direction\":[1,0.1,-0.2],\"color\":[0.1,0.2,1],\"intensity\":4}",
    "{\"type\":\"point\",\"position\":[2,1.5,1],\"color\":[1,0.4,0.2],\"intensity\":20}",
    "{\"type\":\"point\",\"position\":[0.1,0.15,-0.1],\"color\":[1,0.7,0.4],\"intensity\":2}",
    "{\"type\":\"point\",\"position\":[0.7,0.4,-0.3],\"color\":[0.3,1,0.3],\"intensity\":2}",
    "{\"type\":\"spot\",\"position\":[-2.5,2,1],\"direction\":[2.5,-2,-1],\"color\":[1,0.2,0.9],\"intensity\":40,"
    "\"inner\":6,\"outer\":16}",
    "{\"type\":\"spot\",\"position\":[0,-0.2,0.1],\"direction\":[0.3,1,0.2],\"color\":[0.2,1,1],\"intensity\":4,"
    "\"inner\":15,\"outer\":40}",
    "{\"type\":\"point\",\"position\":[0,-1.2,0.3],\"color\":[1,1,0.3],\"intensity\":6}",
};
/* The largest error allowed of each alone, at 8 steps: rms, and worst over the brightest. */
static const struct {
    double rms, worst;
} allowed[LIGHTS] = {{0.02, 0.06}, {0.025, 0.06}, {0.025, 0.06}, {0.03, 0.06},
                     {0.03, 0.06}, {0.025, 0.06}, {0.07, 0.1},   {0.01, 0.02}};

static void write_lamps(char *lights, size_t bytes)
{
    lights[0] = 0;
    for (size_t i = 0; i < LIGHTS; i++)
        snprintf(lights + strlen(lights), bytes - strlen(lights), "%s%s", i ? "," : "", lamps[i]);
}

/* All lamps together are the sum of each alone. */
static void test_sum(void **state)
{
    static char text[TEXT], lights[TEXT / 2];
    float(*sum)[3] = calloc((size_t)WIDTH * HEIGHT, sizeof *sum);
    double apart = 0, peak = 0;

    (void)state;
    assert_non_null(sum);
    for (size_t i = 0; i < LIGHTS; i++) {
        write_scene(text, "", lamps[i], CLOUD);
        struct picture alone = draw_text(text, WIDTH, HEIGHT);
        for (size_t at = 0; at < (size_t)WIDTH * HEIGHT; at++)
            for (int k = 0; k < 3; k++)
                sum[at][k] += alone.smoke[at][k];
        picture_free(&alone);
    }
    write_lamps(lights, sizeof lights);
    write_scene(text, "", lights, CLOUD);
    struct picture together = draw_text(text, WIDTH, HEIGHT);
    for (size_t at = 0; at < (size_t)WIDTH * HEIGHT; at++)
        for (int k = 0; k < 3; k++) {
            apart = fmax(apart, fabs((double)together.smoke[at][k] - (double)sum[at][k]));
            peak = fmax(peak, (double)sum[at][k]);
        }
    printf("  eight lights against the sum of each: %.1e of the peak\n", apart / peak);
    assert_true(peak > 0 && apart < 1e-3 * peak);
    picture_free(&together);
    free(sum);
}

/* Each lamp alone is as the reference has it; those of no intensity beside it are nothing. */
static void test_each_light(void **state)
{
    static char text[TEXT], dark[TEXT], off[TEXT / 2];

    (void)state;
    for (size_t i = 0; i < LIGHTS; i++) {
        /* Beside seven that are out. */
        off[0] = 0;
        for (size_t k = 0; k < LIGHTS; k++)
            snprintf(off + strlen(off), sizeof off - strlen(off), "%s%s", k ? "," : "",
                     k == i ? lamps[k] : "{\"type\":\"point\",\"position\":[0.3,0.2,0.1],\"intensity\":0}");
        write_scene(text, "", lamps[i], CLOUD);
        write_scene(dark, "", off, CLOUD);
        struct stage stage = stage_of_text(text, WIDTH, HEIGHT);
        struct picture alone = stage_draw(&stage, 0), beside = draw_text(dark, WIDTH, HEIGHT);
        struct sf_reference_picture *reference = stage_reference(&stage, 1);
        struct errors errors = errors_of(&alone, reference, 1, NULL);
        printf("  lamp %zu alone: rms error %.4f, bias %+.4f, worst %.4f of the peak, transmittance %.1e\n", i,
               errors.rms, errors.bias, errors.worst, errors.transmittance);
        assert_true(errors.rms < allowed[i].rms && errors.worst < allowed[i].worst && errors.transmittance < 1e-4);
        assert_true(picture_apart(&alone, &beside) <= 1e-3 * picture_peak(&alone));
        sf_reference_picture_destroy(&reference);
        picture_free(&alone);
        picture_free(&beside);
        stage_end(&stage);
    }
}

static void test_no_lights(void **state)
{
    static char text[TEXT];

    (void)state;
    write_scene(text, "", "", CLOUD);
    struct stage stage = stage_of_text(text, WIDTH, HEIGHT);
    struct picture picture = stage_draw(&stage, 0);
    struct sf_reference_picture *reference = stage_reference(&stage, 1);
    struct errors errors = errors_of(&picture, reference, 1, NULL);
    assert_true(picture_peak(&picture) == 0);
    assert_true(errors.transmittance < 1e-4);
    sf_reference_picture_destroy(&reference);
    picture_free(&picture);
    stage_end(&stage);
}

/* Whatever the number of depths in a light's map, and from 16 texels on; a coarse map may err more. */
static void test_light_maps(void **state)
{
    static const struct {
        const char *settings;
        double rms;
    } maps[] = {{"\"light_slices\":8", 0.03},  {"\"light_slices\":16", 0.03}, {"\"light_slices\":24", 0.03},
                {"\"light_slices\":40", 0.03}, {"\"light_slices\":64", 0.03}, {"\"light_size\":16", 0.2},
                {"\"light_size\":24", 0.11},   {"\"light_size\":40", 0.07},   {"\"light_size\":72", 0.04}};
    static const int chosen[] = {0, 2, 3};
    static char text[TEXT], thick[256];

    (void)state;
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++)
        for (size_t k = 0; k < sizeof chosen / sizeof *chosen; k++) {
            snprintf(thick, sizeof thick, ",\"steps\":32,%s", maps[i].settings);
            write_scene(text, thick, lamps[chosen[k]], CLOUD);
            struct stage stage = stage_of_text(text, WIDTH, HEIGHT);
            struct errors errors = stage_errors(&stage, 0, 2);
            stage_end(&stage);
            printf("  %s, lamp %d: rms error %.4f, bias %+.4f\n", maps[i].settings, chosen[k], errors.rms, errors.bias);
            assert_true(errors.rms < maps[i].rms);
        }
}

/* ---- lists ---- */

/* Optical depth of a pixel's ray, from the eye at (0, 0, 5) along -z, fov 40. */
static double optical_depth(const struct sf_frame *frame, uint32_t x, uint32_t y)
{
    double tangent = tan(20 * acos(-1.0) / 180), sum = 0;
    double ray[3] = {((x + 0.5) / frame->width * 2 - 1) * tangent * frame->width / frame->height,
                     (1 - (y + 0.5) / frame->height * 2) * tangent, -1};
    double length = sqrt(ray[0] * ray[0] + ray[1] * ray[1] + 1);

    for (uint32_t i = 0; i < frame->live; i++) {
        const struct sf_frame_particle *p = &frame->particles[i];
        double along = 0, square = (double)p->radius * (double)p->radius;
        for (int k = 0; k < 3; k++) {
            double to = (double)p->position[k] - (double)frame->view.eye[k];
            along += ray[k] / length * to;
            square -= to * to;
        }
        square += along * along;
        if (square > 0 && along > 0)
            sum += 2 * sqrt(square) * (double)p->extinction;
    }
    return sum;
}

static double worst_transmittance(const struct sf_frame *frame, uint32_t step)
{
    double worst = 0;

    for (uint32_t y = step / 2; y < frame->height; y += step)
        for (uint32_t x = step / 2; x < frame->width; x += step)
            worst = fmax(worst, fabs(exp(-optical_depth(frame, x, y)) -
                                     (double)frame->smoke_depths[4 * ((size_t)y * frame->width + x) + 3]));
    return worst;
}

/* The shader's words with one member of the push constants read in place of another: indices are constants, and those
 * from 16 on stand for nothing else. */
static void read_member(const char *shader_name, size_t member, size_t instead)
{
    const struct sf_shader *shader = sf_shader_find(shader_name);
    assert_non_null(shader);
    uint32_t *words = malloc(shader->bytes), found = 0;

    assert_non_null(words);
    memcpy(words, shader->words, shader->bytes);
    for (size_t at = 5; at < shader->bytes / 4 && words[at] >> 16 > 0; at += words[at] >> 16)
        if (words[at] == (4u << 16 | 43u) && words[at + 3] == member / 4) { /* OpConstant */
            words[at + 3] = (uint32_t)(instead / 4);
            found++;
        }
    assert_int_equal(found, 1);
    assert_int_equal(sf_device_set_shader(kit_device, shader_name, words, shader->bytes), SF_OK);
    free(words);
}

/* How many words of a buffer of the frame say that a list did not fit. */
static uint32_t too_long(struct stage *stage, const char *buffer)
{
    const struct sf_renderer_options options = {
        .width = WIDTH, .height = HEIGHT, .aovs = SF_AOV_SMOKE | SF_AOV_DEPTHS, .float_aovs = true, .inspect = buffer};
    uint32_t count = 0;

    assert_int_equal(sf_renderer_set_options(stage->renderer, &options), SF_OK);
    struct picture picture = stage_draw(stage, 0);
    picture_free(&picture);
    for (uint32_t i = 0; i < stage->frame.inspected_word_count; i++)
        count += stage->frame.inspected_words[i] == SF_THICK_ALL;
    return count;
}

static struct picture draw_overflowing(const char *text, uint32_t *camera, uint32_t *lights)
{
    struct stage stage = stage_of_text(text, WIDTH, HEIGHT);
    struct picture picture = stage_draw(&stage, 0);

    *camera = too_long(&stage, "thick.ranges");
    *lights = too_long(&stage, "light.lengths");
    stage_end(&stage);
    return picture;
}

/* Where lists do not fit their memory every particle is taken: the picture stays, to rounding. Maps of few tiles
 * too, whose rays lie far apart. */
static void test_overflow(void **state)
{
    static const uint32_t sizes[] = {16, 20, 40, 192};
    static const char *const names[] = {"thick/tiles.comp", "thick/light_lists.comp", "thick/light_map.comp"};
    static char text[TEXT], lights[TEXT / 2], size[64];
    uint32_t camera, lit;

    (void)state;
    write_lamps(lights, sizeof lights);
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        snprintf(size, sizeof size, ",\"light_size\":%u", sizes[i]);
        write_scene(text, size, lights, CLOUD);
        struct picture usual = draw_overflowing(text, &camera, &lit);
        assert_int_equal(camera, 0);
        assert_int_equal(lit, 0);
        /* Room for as many spheres as tiles stand beside each other, 3: no list fits. And for as many in a light's list as
         * a smoke pixel is wide in frame pixels, 1. */
        read_member(names[0], offsetof(struct sf_thick_push, list_words), offsetof(struct sf_thick_push, tiles_x));
        read_member(names[1], offsetof(struct sf_thick_push, light_list), offsetof(struct sf_thick_push, scale));
        read_member(names[2], offsetof(struct sf_thick_push, light_list), offsetof(struct sf_thick_push, scale));
        struct picture full = draw_overflowing(text, &camera, &lit);
        double apart = picture_apart(&usual, &full) / picture_peak(&usual);
        printf("  light_size %u: %u of the camera's lists and %u of the lights' too long: apart %.1e of the peak\n",
               sizes[i], camera, lit, apart);
        assert_true(camera > 4 && lit > 4);
        assert_true(apart <= 1e-3);
        picture_free(&full);
        picture_free(&usual);
        for (size_t k = 0; k < 3; k++)
            assert_int_equal(sf_device_set_shader(kit_device, names[k], NULL, 0), SF_OK);
    }
}

/* 300 in one place: more than a subgroup keeps. They are as one of their summed extinction, for the light as well. */
static void test_coincident(void **state)
{
    enum { COUNT = 300 };
    static char many[TEXT], one[TEXT], list[TEXT / 2];

    (void)state;
    list[0] = 0;
    for (int i = 0; i < COUNT; i++)
        snprintf(list + strlen(list), sizeof list - strlen(list),
                 "%s{\"centre\":[0.1,0.05,0],\"radius\":1,\"extinction\":0.01}", i ? "," : "");
    write_scene(many, "", lamps[0], list);
    write_scene(one, "", lamps[0], "{\"centre\":[0.1,0.05,0],\"radius\":1,\"extinction\":3}");
    struct stage stage = stage_of_text(many, WIDTH, HEIGHT);
    struct picture crowd = stage_draw(&stage, 0), single = draw_text(one, WIDTH, HEIGHT);
    double transmittance = worst_transmittance(&stage.frame, 1);
    assert_int_equal(stage.frame.live, COUNT);
    printf("  %d in one place: transmittance %.1e, against one as dense %.1e of the peak\n", COUNT, transmittance,
           picture_apart(&crowd, &single) / picture_peak(&single));
    assert_true(transmittance < 1e-4);
    assert_true(picture_apart(&crowd, &single) < 4e-3 * picture_peak(&single));
    picture_free(&crowd);
    picture_free(&single);
    stage_end(&stage);
}

#define MANY(emitter, settings)                                                                                        \
    "{\"thick\":{\"resolution\":\"full\",\"detail\":0,\"ambient\":0,\"light_size\":64" settings "},"                   \
    "\"camera\":{\"eye\":[0,0,5],\"target\":[0,0,0],\"fov\":40,\"near\":0.01},\"sim\":{\"capacity\":100000},"          \
    "\"lights\":[{\"type\":\"directional\",\"direction\":[-0.6,-1,-0.5],\"intensity\":5}],\"forces\":[],"              \
    "\"emitters\":[{" emitter "}]}"
#define BURST(rest)                                                                                                    \
    "\"type\":\"sphere\",\"position\":[0,0,0],\"rate\":0,\"lifetime\":100,\"speed\":0,\"growth\":0,\"fade_in\":"       \
    "0," rest

static struct picture draw_many(const char *what, const char *text, uint32_t count)
{
    struct timespec begin, end;
    struct stage stage = stage_of_text(text, WIDTH, HEIGHT);

    clock_gettime(CLOCK_MONOTONIC, &begin);
    struct picture picture = stage_draw(&stage, 1);
    clock_gettime(CLOCK_MONOTONIC, &end);
    double seconds = (double)(end.tv_sec - begin.tv_sec) + 1e-9 * (double)(end.tv_nsec - begin.tv_nsec);
    double worst = worst_transmittance(&stage.frame, 5);
    printf("  %u particles %s, %ux%u: %.2f s with pipelines and simulation; transmittance %.1e\n", count, what, WIDTH,
           HEIGHT, seconds, worst);
    assert_int_equal(stage.frame.live, count);
    assert_true(worst < 1e-3);
    assert_true(seconds < 120);
    stage_end(&stage);
    return picture;
}

/* A hundred thousand, all over the picture; and as one knot, which is as one sphere of their summed extinction. (A software
 * device ends an invocation's loops after 65,535 turns: that is what the knots come close to.) */
static void test_many(void **state)
{
    static const struct {
        const char *text;
        uint32_t count;
    } knots[] = {
        {MANY(BURST("\"radius\":0.0001,\"particle_radius\":0.5,\"burst\":100000,\"extinction\":0.00002"), ""), 100000},
        {MANY(BURST("\"radius\":0.0001,\"particle_radius\":0.5,\"burst\":40000,\"extinction\":0.00005"),
              ",\"light_slices\":64"),
         40000},
    };
    struct picture picture = draw_many(
        "spread out",
        MANY(BURST("\"radius\":1,\"particle_radius\":[0.02,0.05],\"burst\":100000,\"extinction\":0.5"), ""), 100000);
    struct picture one = draw_text(MANY("\"type\":\"list\",\"still\":true,\"particles\":[{\"centre\":[0,0,0],"
                                        "\"radius\":0.5,\"extinction\":2}]",
                                        ""),
                                   WIDTH, HEIGHT);

    (void)state;
    picture_free(&picture);
    for (size_t i = 0; i < sizeof knots / sizeof *knots; i++) {
        picture = draw_many("in a knot", knots[i].text, knots[i].count);
        double apart = picture_apart(&picture, &one) / picture_peak(&one);
        printf("    apart from one as dense: %.1e of the peak\n", apart);
        assert_true(apart < 0.02);
        picture_free(&picture);
    }
    picture_free(&one);
}

/* The same bits each time. */
static void test_same_bits(void **state)
{
    static char text[TEXT], lights[TEXT / 2];

    (void)state;
    write_lamps(lights, sizeof lights);
    write_scene(text, "", lights, CLOUD);
    struct picture a = draw_text(text, WIDTH, HEIGHT), b = draw_text(text, WIDTH, HEIGHT);
    assert_memory_equal(a.smoke, b.smoke, sizeof(float[4]) * WIDTH * HEIGHT);
    assert_memory_equal(a.depths, b.depths, sizeof(float[4]) * WIDTH * HEIGHT);
    picture_free(&a);
    picture_free(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_light), cmocka_unit_test(test_sum),       cmocka_unit_test(test_no_lights),
        cmocka_unit_test(test_light_maps), cmocka_unit_test(test_overflow),  cmocka_unit_test(test_coincident),
        cmocka_unit_test(test_many),       cmocka_unit_test(test_same_bits),
    };
    return cmocka_run_group_tests(tests, kit_setup, kit_teardown);
}
