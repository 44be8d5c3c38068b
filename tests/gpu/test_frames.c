/* The renderer as its users see it: frames that repeat, tickets, seeking, sizes, timings; with validation. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "output/half.h"
#include "sfumato/sfumato.h"

static struct sf_device *device;
static char last_message[1024];

static void write_log(void *user, enum sf_log_level level, const char *message)
{
    (void)user;
    (void)level;
    snprintf(last_message, sizeof last_message, "%s", message);
    if (getenv("SF_TEST_VERBOSE"))
        fprintf(stderr, "%s\n", message);
}
static const struct sf_log test_log = {.write = write_log, .level = SF_LOG_WARNING};

/* Smoke over ground, a lamp of each kind, an orbiting camera; every step counts. */
static const char smoky[] =
    "{\"camera\":{\"type\":\"orbit\",\"eye\":[2,1.5,3],\"target\":[0,0.8,0],\"period\":4},"
    "\"lights\":[{\"type\":\"directional\",\"direction\":[-1,-1,0]},{\"type\":\"point\",\"position\":[1,2,1],"
    "\"intensity\":4}],"
    "\"objects\":[{\"type\":\"plane\",\"checker\":0.5},{\"type\":\"sphere\",\"position\":[0.6,0.3,0],\"radius\":0.3}],"
    "\"emitters\":[{\"type\":\"cone\",\"position\":[0,0.1,0],\"rate\":120,\"lifetime\":[0.6,1],\"speed\":[1,1.5],"
    "\"particle_radius\":[0.1,0.2]}],"
    "\"forces\":[{\"type\":\"turbulence\",\"strength\":0.5},{\"type\":\"drag\",\"strength\":1}],"
    "\"sim\":{\"capacity\":200,\"fps\":24,\"substeps\":2,\"preroll\":0.5},\"shadow\":{\"map_size\":64},"
    "\"thick\":{\"steps\":4,\"light_size\":64}}";

static struct sf_scene *parse(const char *json)
{
    struct sf_scene *scene = NULL;

    if (sf_scene_parse("test.json", json, strlen(json), NULL, 0, &test_log, &scene) != SF_OK)
        fail_msg("%s", last_message);
    return scene;
}

static struct sf_renderer *create(const struct sf_scene *scene, const struct sf_renderer_options *options)
{
    struct sf_renderer *renderer = NULL;

    if (sf_renderer_create(device, scene, options, &test_log, &renderer) != SF_OK)
        fail_msg("%s", last_message);
    return renderer;
}

/* Renders and waits. */
static struct sf_frame frame_of(struct sf_renderer *renderer, uint32_t number)
{
    struct sf_frame frame;
    uint64_t ticket = 0;

    if (sf_renderer_render(renderer, number, &ticket) != SF_OK || sf_renderer_wait(renderer, ticket, &frame) != SF_OK)
        fail_msg("frame %u: %s", number, last_message);
    return frame;
}

/* The frame's pixels, copied: color halves, depth, and particles alive. */
struct copy {
    size_t bytes;
    unsigned char *data;
};

static struct copy copy_of(const struct sf_frame *frame)
{
    size_t pixels = (size_t)frame->width * frame->height;
    struct copy copy = {pixels * 12 + sizeof frame->live, malloc(pixels * 12 + sizeof frame->live)};

    assert_non_null(copy.data);
    memcpy(copy.data, frame->color, pixels * 8);
    memcpy(copy.data + pixels * 8, frame->depth, pixels * 4);
    memcpy(copy.data + pixels * 12, &frame->live, sizeof frame->live);
    return copy;
}

static void assert_same(struct copy *a, struct copy *b)
{
    assert_int_equal(a->bytes, b->bytes);
    assert_memory_equal(a->data, b->data, a->bytes);
}

/* Frame 7 alone, within a sequence, after frame 40, again, after seeking, and from a second renderer: the same bits. */
static void test_repeat(void **state)
{
    const struct sf_renderer_options options = {.width = 70, .height = 50};
    struct sf_scene *scene = parse(smoky);
    struct sf_renderer *renderer = create(scene, &options), *other = create(scene, &options);
    struct sf_frame frame = frame_of(renderer, 7);
    struct copy first = copy_of(&frame), next, sixth = {0, NULL};

    (void)state;
    assert_true(frame.live > 20);
    assert_int_equal(frame.frame, 7);
    assert_true(frame.time == 7.0 / 24);
    for (int round = 0; round < 4; round++) {
        uint32_t from = round == 0 ? 0 : round == 1 ? 40 : 7;
        if (round == 3)
            assert_int_equal(sf_renderer_seek(renderer, 3, NULL, NULL), SF_OK);
        for (uint32_t number = from; number < 7; number++) {
            frame = frame_of(renderer, number);
            if (number == 6)
                sixth = copy_of(&frame);
        }
        if (round == 1)
            frame_of(renderer, 40);
        frame = frame_of(renderer, 7);
        next = copy_of(&frame);
        assert_same(&first, &next);
        free(next.data);
    }
    frame = frame_of(other, 7);
    next = copy_of(&frame);
    assert_same(&first, &next);
    assert_true(sixth.data && memcmp(first.data, sixth.data, first.bytes) != 0);
    free(next.data);
    free(sixth.data);
    free(first.data);
    sf_renderer_destroy(&other);
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
}

/* Frames queued ahead, and looked at while later ones are drawn. */
static void test_tickets(void **state)
{
    const struct sf_renderer_options options = {.width = 40, .height = 30, .frames_kept = 3};
    struct sf_scene *scene = parse(smoky);
    struct sf_renderer *renderer = create(scene, &options), *alone = create(scene, &options);
    struct sf_frame frame, again;
    uint64_t tickets[5];

    (void)state;
    for (uint32_t i = 0; i < 3; i++)
        assert_int_equal(sf_renderer_render(renderer, 20 * i, &tickets[i]), SF_OK); /* with batches of steps between */
    for (uint32_t i = 0; i < 3; i++) {
        assert_int_equal(sf_renderer_wait(renderer, tickets[i], &frame), SF_OK);
        assert_int_equal(frame.frame, 20 * i);
        again = frame_of(alone, 20 * i);
        struct copy a = copy_of(&frame), b = copy_of(&again);
        assert_same(&a, &b);
        free(a.data);
        free(b.data);
    }
    assert_int_equal(sf_renderer_render(renderer, 61, &tickets[3]), SF_OK);
    assert_int_equal(sf_renderer_wait(renderer, tickets[0], &frame), SF_ERROR_USAGE); /* its memory is another's now */
    assert_null(frame.color);
    assert_int_equal(sf_renderer_wait(renderer, tickets[1], &frame), SF_OK);
    assert_int_equal(sf_renderer_wait(renderer, tickets[3] + 1, &frame), SF_ERROR_USAGE);
    assert_int_equal(sf_renderer_wait(renderer, 0, &frame), SF_ERROR_USAGE);
    assert_int_equal(sf_renderer_wait(renderer, tickets[3], &frame), SF_OK);
    sf_renderer_destroy(&alone);
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
}

struct progress {
    uint32_t calls;
    uint64_t done, total, stop_at;
};

static bool on_progress(void *user, uint64_t done, uint64_t total)
{
    struct progress *progress = user;

    progress->calls++;
    assert_true(done >= progress->done && done <= total);
    progress->done = done;
    progress->total = total;
    return done < progress->stop_at;
}

static void test_seek(void **state)
{
    const struct sf_renderer_options options = {.width = 16, .height = 16};
    struct sf_scene *scene = parse(smoky);
    struct sf_renderer *renderer = create(scene, &options);
    struct progress progress = {.stop_at = 50};

    (void)state;
    assert_int_equal(sf_renderer_seek(renderer, 100, on_progress, &progress), SF_ERROR_INTERRUPTED);
    /* Preroll of 24 steps and 100 frames of 2, less those that go with the frame. */
    assert_int_equal(progress.total, 24 + 200 - 2);
    assert_true(progress.done >= 50 && progress.done < 100);
    uint64_t made = progress.done;
    progress = (struct progress){.stop_at = UINT64_MAX};
    assert_int_equal(sf_renderer_seek(renderer, 100, on_progress, &progress), SF_OK);
    assert_int_equal(progress.total, 222 - made);
    assert_int_equal(progress.done, progress.total);
    progress = (struct progress){.stop_at = UINT64_MAX};
    assert_int_equal(sf_renderer_seek(renderer, 100, on_progress, &progress), SF_OK);
    assert_int_equal(progress.calls, 0);
    struct sf_frame frame = frame_of(renderer, 100);
    assert_true(frame.live > 0);
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
}

/* The half picture is the float one, rounded; and what is not asked for is not there. */
static void test_formats(void **state)
{
    struct sf_renderer_options options = {.width = 61, .height = 37};
    struct sf_scene *scene = parse(smoky);
    struct sf_renderer *half = create(scene, &options), *full, *bare;
    struct sf_frame a = frame_of(half, 5), b, c;

    (void)state;
    options.float_color = true;
    options.aovs = SF_AOV_SMOKE | SF_AOV_DEPTHS;
    full = create(scene, &options);
    b = frame_of(full, 5);
    assert_true(a.color && !a.color_float && !a.smoke && !a.smoke_depths);
    assert_true(!b.color && b.color_float && b.smoke && b.smoke_depths);
    assert_memory_equal(a.depth, b.depth, sizeof *a.depth * 61 * 37);
    for (size_t i = 0; i < 61 * 37 * 4; i++) {
        double x = sf_half_to_float(a.color[i]), y = b.color_float[i];
        if (fabs(x - y) > 2e-3 * fabs(y) + 1e-4)
            fail_msg("component %zu is %g as half, %g as float", i, x, y);
    }
    options = (struct sf_renderer_options){.width = 61, .height = 37, .no_readback = true, .timing = true};
    bare = create(scene, &options);
    c = frame_of(bare, 5);
    assert_true(!c.color && !c.color_float && !c.depth);
    /* Row-major: the third row of the camera's matrix is minus the depth; the eye is its own origin. */
    double angle = 2 * 3.14159265358979 * c.time / 4,
           eye[3] = {cos(angle) * 2 + sin(angle) * 3, 1.5, cos(angle) * 3 - sin(angle) * 2};
    for (int row = 0; row < 3; row++) {
        const float *m = c.world_to_camera + 4 * row;
        assert_true(fabs(m[0] * eye[0] + m[1] * eye[1] + m[2] * eye[2] + m[3]) < 1e-5);
        assert_true(fabs(m[0] * m[0] + m[1] * m[1] + m[2] * m[2] - 1) < 1e-5f);
    }
    double ahead = -(c.world_to_camera[9] * 0.8 + c.world_to_camera[11]),
           w = c.world_to_clip[13] * 0.8 + c.world_to_clip[15];
    assert_true(ahead > 3 && fabs(ahead - w) < 1e-5);
    sf_renderer_destroy(&bare);
    sf_renderer_destroy(&full);
    sf_renderer_destroy(&half);
    sf_scene_destroy(&scene);
}

static void test_sizes(void **state)
{
    static const uint32_t sizes[][2] = {{1, 1}, {7, 3}, {1, 64}, {801, 599}};
    struct sf_scene *scene = parse(smoky);

    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        const struct sf_renderer_options options = {
            .width = sizes[i][0], .height = sizes[i][1], .aovs = SF_AOV_SMOKE | SF_AOV_DEPTHS};
        struct sf_renderer *renderer = create(scene, &options);
        struct sf_frame frame = frame_of(renderer, 2);
        size_t pixels = (size_t)frame.width * frame.height;
        for (size_t k = 0; k < pixels; k++) {
            assert_true(frame.depth[k] > 0 && frame.depth[k] <= SF_NO_DEPTH);
            assert_true((frame.color[4 * k] & 0x7c00) != 0x7c00); /* neither infinite nor NaN */
        }
        sf_renderer_destroy(&renderer);
    }
    static const uint32_t bad[][2] = {{0, 0}, {0, 5}, {5, 0}, {100000, 100000}, {5, 4000000000u}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        const struct sf_renderer_options options = {.width = bad[i][0], .height = bad[i][1]};
        struct sf_renderer *renderer = NULL;
        char size[64];
        snprintf(size, sizeof size, "%ux%u", bad[i][0], bad[i][1]);
        assert_int_equal(sf_renderer_create(device, scene, &options, &test_log, &renderer), SF_ERROR_USAGE);
        assert_null(renderer);
        assert_non_null(strstr(last_message, size));
    }
    sf_scene_destroy(&scene);
}

/* A frame that the budget does not hold is refused with its status, and leaves nothing behind. */
static void test_budget(void **state)
{
    struct sf_device *small = NULL;
    struct sf_scene *scene = parse(smoky);
    struct sf_renderer *renderer = NULL;
    const struct sf_renderer_options options = {.width = 4000, .height = 4000};
    uint64_t used, budget;

    (void)state;
    assert_int_equal(
        sf_device_create(&(struct sf_device_options){.validate = true, .no_cache = true, .budget_bytes = 64 << 20},
                         &test_log, &small),
        SF_OK);
    assert_int_equal(sf_renderer_create(small, scene, &options, &test_log, &renderer), SF_ERROR_MEMORY);
    assert_null(renderer);
    sf_device_memory(small, &used, &budget);
    assert_true(used <= budget && budget == 64 << 20);
    assert_int_equal(sf_device_validation_messages(small), 0);
    sf_device_destroy(&small);
    sf_scene_destroy(&scene);
}

static void test_empty(void **state)
{
    static const char *const scenes[] = {"{}", "{\"method\":\"none\"}", "{\"objects\":[{\"type\":\"plane\"}]}",
                                         "{\"lights\":[{\"type\":\"directional\",\"direction\":[0,-1,0]}],"
                                         "\"environment\":{\"type\":\"color\",\"visible\":false}}",
                                         "{\"objects\":[{\"type\":\"sphere\"}]}"};

    (void)state;
    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i++) {
        const struct sf_renderer_options options = {.width = 33, .height = 17, .aovs = SF_AOV_SMOKE};
        struct sf_scene *scene = parse(scenes[i]);
        struct sf_renderer *renderer = create(scene, &options);
        for (uint32_t number = 0; number < 3; number++) {
            struct sf_frame frame = frame_of(renderer, number);
            assert_int_equal(frame.live, 0);
            assert_true((frame.color[0] & 0x7c00) != 0x7c00);
        }
        sf_renderer_destroy(&renderer);
        sf_scene_destroy(&scene);
    }
}

static void test_timings(void **state)
{
    const struct sf_renderer_options options = {.width = 64, .height = 64, .timing = true};
    struct sf_scene *scene = parse(smoky);
    struct sf_renderer *renderer = create(scene, &options);
    const struct sf_pass_timing *timings = NULL;
    uint32_t count = 0, passes = 0;
    uint64_t ticket = 0;
    struct sf_frame frame;
    bool planes = false, stepped = false;

    (void)state;
    for (uint32_t number = 0; number < 3; number++) {
        assert_int_equal(sf_renderer_render(renderer, number, &ticket), SF_OK);
        assert_int_equal(sf_renderer_wait(renderer, ticket, &frame), SF_OK);
        assert_int_equal(sf_renderer_timings(renderer, ticket, &timings, &count), SF_OK);
        for (uint32_t i = 0; i < count; i++) {
            assert_true(timings[i].end_ns >= timings[i].begin_ns);
            assert_true(i == 0 || timings[i].begin_ns >= timings[i - 1].begin_ns);
            planes = planes || (strcmp(timings[i].name, "scene.planes") == 0 && timings[i].bytes_written > 0);
            stepped = stepped || (strcmp(timings[i].name, "sim.step") == 0 && i < 3);
        }
    }
    assert_true(planes && stepped && count > 10);
    assert_true(sf_renderer_record_ns(renderer, &passes) > 0);
    assert_true(passes >= count);
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
}

/* With no device: names, sizes, and the same text twice. */
static void test_print(void **state)
{
    static const char *const formats[] = {"text", "dot", "json"};
    struct sf_scene *scene = parse(smoky);
    char *text = NULL, *again = NULL;

    (void)state;
    for (size_t i = 0; i < 3; i++) {
        assert_int_equal(sf_graph_print(scene, 800, 600, SF_AOV_SMOKE, formats[i], &test_log, &text), SF_OK);
        assert_int_equal(sf_graph_print(scene, 800, 600, SF_AOV_SMOKE, formats[i], &test_log, &again), SF_OK);
        assert_string_equal(text, again);
        assert_non_null(strstr(text, "sim.step"));
        assert_non_null(strstr(text, "shadow.solids"));
        assert_non_null(strstr(text, "scene.planes"));
        assert_non_null(strstr(text, "thick.march"));
        free(text);
        free(again);
    }
    assert_int_equal(sf_graph_print(scene, 800, 600, 0, "jsn", &test_log, &text), SF_ERROR_USAGE);
    assert_non_null(strstr(last_message, "did you mean 'json'"));
    assert_int_equal(sf_graph_print(scene, 0, 600, 0, "text", &test_log, &text), SF_ERROR_USAGE);
    sf_scene_destroy(&scene);
}

static int open_device(void **state)
{
    (void)state;
    return sf_device_create(&(struct sf_device_options){.validate = true, .no_cache = true}, &test_log, &device) ==
                   SF_OK
               ? 0
               : -1;
}

static int close_device(void **state)
{
    int messages = (int)sf_device_validation_messages(device);

    (void)state;
    if (messages)
        fprintf(stderr, "%d validation messages\n", messages);
    sf_device_destroy(&device);
    return messages;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_repeat),  cmocka_unit_test(test_tickets), cmocka_unit_test(test_seek),
        cmocka_unit_test(test_formats), cmocka_unit_test(test_sizes),   cmocka_unit_test(test_budget),
        cmocka_unit_test(test_empty),   cmocka_unit_test(test_timings), cmocka_unit_test(test_print),
    };

    enum sf_status status =
        sf_device_create(&(struct sf_device_options){.validate = true, .no_cache = true}, NULL, &device);
    sf_device_destroy(&device);
    if (status == SF_ERROR_DEVICE)
        return 77;
    return cmocka_run_group_tests(tests, open_device, close_device);
}
