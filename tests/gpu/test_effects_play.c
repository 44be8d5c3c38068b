/* Effects as they play on a device: the explosion that ships step by step, flashes over every method, shakes that end, and the same bits however
 * one comes to a frame. */
#include "../cpu/scratch.h"

#include <math.h>
#include "base/file.h"
#include "scene/scene.h"
#include "sfumato/sfumato.h"
#include "sim/births.h"
#include "sim/feed.h"

enum { SIDE = 32, PIXELS = SIDE * SIDE };

static struct sf_device *device;
static char last_message[1024];

static void write_log(void *user, enum sf_log_level level, const char *message)
{
    (void)user;
    (void)level;
    snprintf(last_message, sizeof last_message, "%s", message);
}
static const struct sf_log test_log = {.write = write_log, .level = SF_LOG_WARNING};

struct shot {
    struct sf_scene *scene;
    struct sf_renderer *renderer;
    struct sf_frame frame;
};

static void go_to(struct shot *shot, uint32_t number)
{
    uint64_t ticket = 0;

    if (sf_renderer_render(shot->renderer, number, &ticket) != SF_OK ||
        sf_renderer_wait(shot->renderer, ticket, &shot->frame) != SF_OK)
        fail_msg("frame %u: %s", (unsigned)number, last_message);
}

static struct shot open_shot(const char *text, const char *method)
{
    const struct sf_renderer_options options = {.width = SIDE,
                                                .height = SIDE,
                                                .particles = true,
                                                .float_color = true,
                                                .aovs = SF_AOV_SMOKE,
                                                .float_aovs = true};
    struct shot shot = {NULL, NULL, {0}};
    char set[64];
    const char *const sets[] = {set};

    snprintf(set, sizeof set, "method=%s", method);
    if (sf_scene_parse("test.json", text, strlen(text), sets, 1, &test_log, &shot.scene) != SF_OK ||
        sf_renderer_create(device, shot.scene, &options, &test_log, &shot.renderer) != SF_OK)
        fail_msg("%s: %s", text, last_message);
    return shot;
}

static void drop(struct shot *shot)
{
    sf_renderer_destroy(&shot->renderer);
    sf_scene_destroy(&shot->scene);
    assert_int_equal(sf_device_validation_messages(device), 0);
}

static void write_text(const char *path, const char *text)
{
    assert_int_equal(sf_file_write(path, text, strlen(text), NULL), SF_OK);
}

/* The explosion that ships, at 0.5 s: frame 12. */
static const char *explosion(void)
{
    static char text[2048];
    const char *root = getenv("SF_SOURCE_ROOT");

    snprintf(
        text, sizeof text,
        "{\"camera\":{\"eye\":[0,3,14],\"target\":[0,3,0]},\"objects\":[{\"type\":\"plane\"}],"
        "\"environment\":{\"type\":\"color\",\"color\":[0.25,0.5,1]},\"forces\":[{\"type\":\"drag\",\"strength\":1}],"
        "\"thick\":{\"light_size\":32},\"sim\":{\"capacity\":4096},"
        "\"effects\":[{\"file\":\"%s/scenes/effects/ship-explosion.json\",\"position\":[0,1,0],\"start\":0.5}]}",
        root ? root : ".");
    return text;
}

/* Particles of the emitter that have been born. Nobody dies within the first 1.5 s. */
static uint32_t alive_of(const struct sf_frame *frame, uint32_t emitter)
{
    uint32_t count = 0;

    for (uint32_t i = 0; i < frame->live; i++)
        count += (frame->particles[i].look >> 8 & 0xff) == emitter;
    return count;
}

/* Emitters in the file's order: fireball, column (from 0.1 s), spray (at 0.08 s), three pieces of debris, the fire (from 0.8 s). */
static void the_explosion_plays_as_its_file_says(void **state)
{
    struct shot shot = open_shot(explosion(), "none");
    struct sf_camera_view before, view;
    static const double starts[] = {0, 0.1, 0.08, 0.05, 0.1, 0.02, 0.8};
    bool shook = false;

    (void)state;
    assert_int_equal(shot.scene->emitter_count, 7);
    go_to(&shot, 0);
    before = shot.frame.view;
    for (uint32_t number = 0; number <= 48; number += number < 12 ? 3 : 1) {
        const float *corner;
        double since = number / 24.0 - 0.5, fade = 1 - since / 0.25;
        double flash = since >= -1e-9 && fade > 0 ? 0.9 * fade * fade : 0;

        go_to(&shot, number);
        for (uint32_t e = 0; e < 7; e++) {
            uint32_t count = alive_of(&shot.frame, e);

            if (since <= starts[e] ? count != 0 : e == 0 ? count != 330 : e == 2 ? count != 150 : false)
                fail_msg("%g s after the beginning, emitter %u has %u particles", since, e, count);
            if (count != sf_sim_births(shot.scene, &shot.scene->emitters[e], 2 * (uint64_t)number))
                fail_msg("%g s: emitter %u: %u particles", since, e, count);
            if (since > starts[e] + 0.3 && count == 0)
                fail_msg("%g s: emitter %u has not begun", since, e);
        }
        corner = shot.frame.color_float; /* the sky, at the top left */
        if (fabs(corner[0] - 0.25 - flash) > 1e-4 || fabs(corner[1] - 0.5 - 0.86 * flash) > 1e-4 ||
            fabs(corner[2] - 1 - 0.66 * flash) > 1e-4 || corner[3] != 1)
            fail_msg("%g s: the sky is %g %g %g, and the flash %g", since, corner[0], corner[1], corner[2], flash);
        view = shot.frame.view;
        if (since < 0.12 || since > 0.12 + 1.6)
            assert_memory_equal(&view, &before, sizeof view);
        else
            shook = shook || memcmp(&view, &before, sizeof view) != 0;
    }
    assert_true(shook);
    go_to(&shot, 60);
    assert_memory_equal(&shot.frame.view, &before, sizeof before);
    drop(&shot);
}

/* The lamp of the explosion shines on the floor for 1.8 s, then only the flickering fire does. */
static void its_lamps_come_and_go(void **state)
{
    struct shot shot = open_shot(explosion(), "none");
    struct sf_light lights[SF_LIGHTS_MAX];
    const size_t floor_pixel = 4 * (size_t)(SIDE * (SIDE - 3) + SIDE / 2);
    float dark, bright, late;

    (void)state;
    go_to(&shot, 3);
    dark = shot.frame.color_float[floor_pixel];
    go_to(&shot, 22);
    bright = shot.frame.color_float[floor_pixel];
    go_to(&shot, 70);
    late = shot.frame.color_float[floor_pixel];
    assert_true(bright > 1.2f * dark && late < bright && late > dark);
    sf_scene_lights(shot.scene, 2.4, lights);
    assert_true(lights[0].intensity == 0 && lights[1].intensity > 26 * 0.29f && lights[1].intensity <= 26);
    drop(&shot);
}

static void a_frame_has_the_same_bits_from_anywhere(void **state)
{
    const char *root = getenv("SF_SOURCE_ROOT");
    char text[2048];
    static float color[4 * PIXELS];
    struct sf_frame_particle *list;
    struct shot a, b;
    uint32_t live;

    (void)state;
    snprintf(text, sizeof text,
             "{\"camera\":{\"eye\":[0,1.2,4],\"target\":[0,0.6,0]},\"objects\":[{\"type\":\"plane\"}],\"sim\":{"
             "\"capacity\":512},"
             "\"thick\":{\"light_size\":32},\"effects\":[{\"file\":\"%s/scenes/assets/"
             "effect-outer.json\",\"position\":[0,0.3,0]},"
             "{\"file\":\"%s/scenes/assets/effect-inner.json\",\"start\":0.2,\"duration\":0.6,\"every\":0.8}]}",
             root ? root : ".", root ? root : ".");
    a = open_shot(text, "thick");
    for (uint32_t number = 0; number <= 16; number += 4)
        go_to(&a, number);
    go_to(&a, 17);
    live = a.frame.live;
    assert_true(live > 20);
    list = malloc(live * sizeof *list);
    assert_non_null(list);
    memcpy(list, a.frame.particles, live * sizeof *list);
    memcpy(color, a.frame.color_float, sizeof color);
    b = open_shot(text, "thick");
    go_to(&b, 17);
    assert_int_equal(b.frame.live, live);
    assert_memory_equal(b.frame.particles, list, live * sizeof *list);
    assert_memory_equal(b.frame.color_float, color, sizeof color);
    go_to(&b, 30);
    go_to(&b, 17); /* and back again */
    assert_memory_equal(b.frame.particles, list, live * sizeof *list);
    assert_memory_equal(b.frame.color_float, color, sizeof color);
    free(list);
    drop(&a);
    drop(&b);
}

#define BALL                                                                                                           \
    "{\"camera\":{\"eye\":[0,0,4],\"target\":[0,0,0],\"fov\":40},\"sim\":{\"capacity\":8},\"reference\":{\"samples\":" \
    "64},"                                                                                                             \
    "\"environment\":{\"type\":\"color\",\"color\":[0.2,0.2,0.2],\"visible\":false},\"thick\":{\"detail\":0,"          \
    "\"steps\":32},"                                                                                                   \
    "\"emitters\":[{\"type\":\"list\",\"still\":true,\"particles\":[{\"centre\":[0,0,0],\"radius\":1,\"extinction\":"  \
    "2}]}],"
#define LAMP                                                                                                           \
    "{\"type\":\"light\",\"duration\":1,\"fade_out\":1,\"light\":{\"type\":\"point\",\"position\":[1.5,2,2],"          \
    "\"intensity\":40}}"

/* Every method has the flash in its picture, and none in its smoke; nothing else of the picture changes. */
static void flashes_lie_over_every_method(void **state)
{
    static const char *const names[] = {"none", "thick", "thick-larsson", "reference"};

    (void)state;
    write_text("dark.json", "{\"steps\":[" LAMP "]}");
    write_text("flash.json",
               "{\"steps\":[" LAMP
               ",{\"type\":\"flash\",\"duration\":2,\"fade_out\":2,\"strength\":3,\"color\":[1,0.5,0]}]}");
    for (int i = 0; i < 4; i++) {
        struct shot dark = open_shot(BALL "\"effects\":[{\"file\":\"dark.json\"}]}", names[i]);
        struct shot flash = open_shot(BALL "\"effects\":[{\"file\":\"flash.json\"}]}", names[i]);

        for (uint32_t number = 12; number <= 48; number += 36) { /* 0.5 s: 2.25 of 3 are left; 2 s: nothing */
            double light = number == 12 ? 2.25 : 0;

            go_to(&dark, number);
            go_to(&flash, number);
            for (uint32_t p = 0; p < PIXELS; p++) {
                const float *x = dark.frame.color_float + 4 * (size_t)p, *y = flash.frame.color_float + 4 * (size_t)p;

                if (fabs(y[0] - x[0] - light) > 1e-4 || fabs(y[1] - x[1] - light / 2) > 1e-4 || y[2] != x[2] ||
                    y[3] != x[3])
                    fail_msg("%s, frame %u: pixel %u is %g %g %g %g, and %g %g %g %g without the flash", names[i],
                             number, p, y[0], y[1], y[2], y[3], x[0], x[1], x[2], x[3]);
            }
            if (i > 0)
                assert_memory_equal(dark.frame.smoke_float, flash.frame.smoke_float, sizeof(float) * 4 * PIXELS);
        }
        drop(&dark);
        drop(&flash);
    }
}

static double mean_radiance(const struct sf_reference_picture *picture)
{
    double sum = 0;

    for (uint32_t i = 0; i < PIXELS; i++)
        sum += picture->pixels[i].radiance[0];
    return sum / PIXELS;
}

/* The reference sees the lamp as strong as it is at the frame's time. */
static void the_reference_sees_the_same_lamps(void **state)
{
    double means[3];

    (void)state;
    write_text("flash.json", "{\"steps\":[" LAMP ",{\"type\":\"flash\",\"duration\":2,\"strength\":3}]}");
    for (uint32_t i = 0; i < 3; i++) { /* 0, 1/2 and 1 s: whole, half, out */
        struct shot shot = open_shot(BALL "\"effects\":[{\"file\":\"flash.json\"}]}", "thick");
        struct sf_reference *reference = NULL;
        struct sf_reference_picture *picture = NULL;
        double drawn = 0;

        go_to(&shot, 12 * i);
        assert_int_equal(
            sf_reference_create(shot.scene, &shot.frame, &(struct sf_reference_options){0}, &test_log, &reference),
            SF_OK);
        assert_int_equal(sf_reference_render(reference, NULL, SIDE, SIDE, 1, NULL, NULL, &picture), SF_OK);
        means[i] = mean_radiance(picture);
        for (uint32_t p = 0; p < PIXELS; p++)
            drawn += shot.frame.smoke_float[4 * p] / PIXELS;
        if (fabs(drawn / means[i] - 1) > 0.03)
            fail_msg("frame %u: %g in the picture, %g in the reference", 12 * i, drawn, means[i]);
        sf_reference_picture_destroy(&picture);
        sf_reference_destroy(&reference);
        drop(&shot);
    }
    if (fabs((means[0] - means[2]) / (means[1] - means[2]) - 2) > 0.01 || means[0] < 1.8 * means[2])
        fail_msg("radiance %g, %g, %g", means[0], means[1], means[2]);
}

static int setup(void **state)
{
    enum sf_status status = sf_device_create(&(struct sf_device_options){.validate = true}, &test_log, &device);
    if (status == SF_ERROR_DEVICE)
        exit(77);
    return status ? -1 : scratch_enter(state);
}

static int teardown(void **state)
{
    sf_device_destroy(&device);
    return scratch_leave(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_explosion_plays_as_its_file_says),    cmocka_unit_test(its_lamps_come_and_go),
        cmocka_unit_test(a_frame_has_the_same_bits_from_anywhere), cmocka_unit_test(flashes_lie_over_every_method),
        cmocka_unit_test(the_reference_sees_the_same_lamps),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
