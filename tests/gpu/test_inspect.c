/* Images of the graph that come back: names, sizes, contents, and that looking changes nothing; with validation. */
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

enum { WIDTH = 70, HEIGHT = 50, FRAME = 9 };

static struct sf_device *device;
static struct sf_scene *scene;
static char last_message[1024];

static void write_log(void *user, enum sf_log_level level, const char *message)
{
    (void)user;
    (void)level;
    snprintf(last_message, sizeof last_message, "%s", message);
}
static const struct sf_log test_log = {.write = write_log, .level = SF_LOG_WARNING};

static const char smoky[] =
    "{\"method\":\"thick-larsson\",\"camera\":{\"eye\":[2,1.5,3],\"target\":[0,0.8,0]},"
    "\"lights\":[{\"type\":\"directional\",\"direction\":[-1,-1,0]}],"
    "\"objects\":[{\"type\":\"plane\"},{\"type\":\"sphere\",\"position\":[0.6,0.3,0],\"radius\":0.3}],"
    "\"emitters\":[{\"type\":\"cone\",\"position\":[0,0.1,0],\"rate\":120,\"lifetime\":[0.6,1],\"speed\":[1,1.5],"
    "\"particle_radius\":[0.1,0.2]}],"
    "\"sim\":{\"capacity\":200,\"fps\":24,\"preroll\":0.5},\"shadow\":{\"map_size\":64},"
    "\"thick\":{\"steps\":4,\"light_size\":64,\"resolution\":\"half\"}}";

static struct sf_renderer *create(const char *inspect, uint32_t kept)
{
    struct sf_renderer *renderer = NULL;
    const struct sf_renderer_options options = {
        .width = WIDTH, .height = HEIGHT, .frames_kept = kept, .inspect = inspect, .aovs = SF_AOV_DEPTHS};

    if (sf_renderer_create(device, scene, &options, &test_log, &renderer) != SF_OK)
        fail_msg("%s: %s", inspect ? inspect : "plain", last_message);
    return renderer;
}

static struct sf_frame frame_of(struct sf_renderer *renderer, uint32_t number)
{
    struct sf_frame frame;
    uint64_t ticket = 0;

    if (sf_renderer_render(renderer, number, &ticket) != SF_OK || sf_renderer_wait(renderer, ticket, &frame) != SF_OK)
        fail_msg("frame %u: %s", number, last_message);
    return frame;
}

static void assert_shape(const struct sf_frame *frame, uint32_t width, uint32_t height, uint32_t channels)
{
    assert_non_null(frame->inspected);
    assert_int_equal(frame->inspected_width, width);
    assert_int_equal(frame->inspected_height, height);
    assert_int_equal(frame->inspected_channels, channels);
}

static void test_usage(void **state)
{
    struct sf_renderer *renderer = NULL;
    struct sf_renderer_options options = {.width = WIDTH, .height = HEIGHT, .inspect = "camera.rau"};

    (void)state;
    assert_int_equal(sf_renderer_create(device, scene, &options, &test_log, &renderer), SF_ERROR_USAGE);
    assert_null(renderer);
    assert_non_null(strstr(last_message, "did you mean 'camera.raw'"));
    assert_non_null(strstr(last_message, "light.map, "));
    assert_non_null(strstr(last_message, "particles, ")); /* a buffer */
    options.inspect = "read.color";                       /* comes back anyway */
    assert_int_equal(sf_renderer_create(device, scene, &options, &test_log, &renderer), SF_ERROR_USAGE);
    options.inspect = "";
    assert_int_equal(sf_renderer_create(device, scene, &options, &test_log, &renderer), SF_ERROR_USAGE);
    options.inspect = "depth";
    options.no_readback = true;
    assert_int_equal(sf_renderer_create(device, scene, &options, &test_log, &renderer), SF_ERROR_USAGE);
}

/* Depth and colour are what the frame has as well; and the frame is the one that nobody inspects. */
static void test_same(void **state)
{
    static const char *const names[] = {"depth",      "color",     "z",          "light.raw",
                                        "light.half", "light.map", "camera.raw", "camera.half",
                                        "camera.map", "smoke",     "aov.depths", "shadow.map"};
    struct sf_renderer *plain = create(NULL, 0);
    struct sf_frame frame = frame_of(plain, FRAME);

    (void)state;
    assert_null(frame.inspected);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char name[32];
        snprintf(name, sizeof name, "%s", names[i]);
        struct sf_renderer *renderer = create(name, 0);
        memset(name, 0, sizeof name); /* it is copied */
        struct sf_frame looked = frame_of(renderer, FRAME);
        size_t pixels = (size_t)WIDTH * HEIGHT;

        assert_memory_equal(looked.color, frame.color, pixels * 8);
        assert_memory_equal(looked.depth, frame.depth, pixels * 4);
        assert_memory_equal(looked.smoke_depths, frame.smoke_depths, pixels * 16);
        assert_non_null(looked.inspected);
        if (strcmp(names[i], "depth") == 0) {
            assert_shape(&looked, WIDTH, HEIGHT, 1);
            assert_memory_equal(looked.inspected, frame.depth, pixels * 4);
        } else if (strcmp(names[i], "color") == 0) {
            assert_shape(&looked, WIDTH, HEIGHT, 4);
            for (size_t p = 0; p < pixels * 4; p++)
                assert_true(looked.inspected[p] == sf_half_to_float(frame.color[p]));
        } else if (strcmp(names[i], "aov.depths") == 0) {
            assert_memory_equal(looked.inspected, frame.smoke_depths, pixels * 16);
        } else if (strcmp(names[i], "shadow.map") == 0) {
            assert_shape(&looked, 64, 64, 1);
        } else if (strncmp(names[i], "light.", 6) == 0) {
            assert_shape(&looked, 64, 64, 4);
        }
        sf_renderer_destroy(&renderer);
    }
    sf_renderer_destroy(&plain);
}

/* Reversed z and the linear depth agree where an object was drawn: near / z. */
static void test_depth_image(void **state)
{
    struct sf_renderer *renderer = create("z", 0);
    struct sf_frame frame = frame_of(renderer, FRAME);
    float near = frame.world_to_clip[11]; /* row-major: the offset of clip z is the near plane's distance */
    size_t drawn = 0;

    (void)state;
    assert_shape(&frame, WIDTH, HEIGHT, 1);
    for (size_t p = 0; p < (size_t)WIDTH * HEIGHT; p++) {
        if (frame.inspected[p] <= 0)
            continue;
        drawn++;
        assert_true(fabsf(near / frame.inspected[p] - frame.depth[p]) < 1e-3f * frame.depth[p]);
    }
    assert_true(drawn > 20);
    sf_renderer_destroy(&renderer);
}

/* Half the size; intervals where smoke is, NaN where no tile was. */
static void test_camera(void **state)
{
    struct sf_renderer *renderer = create("camera.raw", 0);
    struct sf_frame frame = frame_of(renderer, FRAME);
    size_t smoke = 0, untouched = 0;

    (void)state;
    assert_shape(&frame, WIDTH / 2, HEIGHT / 2, 4);
    for (size_t p = 0; p < (size_t)(WIDTH / 2) * (HEIGHT / 2); p++) {
        const float *texel = &frame.inspected[4 * p];

        untouched += isnan(texel[0]) && isnan(texel[1]) && isnan(texel[2]) && isnan(texel[3]);
        assert_int_equal(sf_frame_unwritten(texel[0]), isnan(texel[0]) != 0); /* no pass makes NaN */
        if (!(texel[0] < SF_NO_DEPTH) || !(texel[3] > 0))
            continue;
        smoke++;
        assert_true(texel[0] > 1 && texel[0] < 10 && -texel[1] > 1 && -texel[1] < 10); /* faint spheres may cross */
    }
    assert_true(smoke > 20);
    assert_true(untouched > 20);
    sf_renderer_destroy(&renderer);
    renderer = create("smoke", 0); /* halves */
    frame = frame_of(renderer, FRAME);
    for (size_t p = untouched = 0; p < (size_t)(WIDTH / 2) * (HEIGHT / 2) * 4; p++) {
        untouched += sf_frame_unwritten(frame.inspected[p]);
        assert_int_equal(sf_frame_unwritten(frame.inspected[p]), isnan(frame.inspected[p]) != 0);
    }
    assert_true(untouched > 20);
    assert_false(sf_frame_unwritten(NAN) || sf_frame_unwritten(-NAN) || sf_frame_unwritten(INFINITY));
    sf_renderer_destroy(&renderer);
}

/* As many frames as are kept can be looked at at once. */
static void test_kept(void **state)
{
    struct sf_renderer *renderer = create("camera.raw", 3);
    struct sf_frame frames[3];
    uint64_t tickets[3];
    size_t bytes = (size_t)(WIDTH / 2) * (HEIGHT / 2) * 16;

    (void)state;
    for (uint32_t i = 0; i < 3; i++)
        assert_int_equal(sf_renderer_render(renderer, FRAME + i, &tickets[i]), SF_OK);
    for (uint32_t i = 0; i < 3; i++)
        assert_int_equal(sf_renderer_wait(renderer, tickets[i], &frames[i]), SF_OK);
    for (uint32_t i = 0; i < 3; i++) {
        struct sf_renderer *other = create("camera.raw", 0);
        struct sf_frame alone = frame_of(other, FRAME + i), again;

        assert_memory_equal(frames[i].inspected, alone.inspected, bytes);
        assert_int_equal(sf_renderer_wait(renderer, tickets[i], &again), SF_OK);
        assert_ptr_equal(again.inspected, frames[i].inspected);
        sf_renderer_destroy(&other);
    }
    assert_memory_not_equal(frames[0].inspected, frames[1].inspected, bytes);
    sf_renderer_destroy(&renderer);
}

static int open_device(void **state)
{
    (void)state;
    if (sf_device_create(&(struct sf_device_options){.validate = true, .no_cache = true}, &test_log, &device) != SF_OK)
        return 1;
    return sf_scene_parse("test.json", smoky, strlen(smoky), NULL, 0, &test_log, &scene) != SF_OK;
}

static int close_device(void **state)
{
    int messages = (int)sf_device_validation_messages(device);

    (void)state;
    if (messages)
        fprintf(stderr, "%d validation messages: %s\n", messages, last_message);
    sf_scene_destroy(&scene);
    sf_device_destroy(&device);
    return messages;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_usage),  cmocka_unit_test(test_same), cmocka_unit_test(test_depth_image),
        cmocka_unit_test(test_camera), cmocka_unit_test(test_kept),
    };

    enum sf_status status =
        sf_device_create(&(struct sf_device_options){.validate = true, .no_cache = true}, NULL, &device);
    sf_device_destroy(&device);
    if (status == SF_ERROR_DEVICE)
        return 77;
    return cmocka_run_group_tests(tests, open_device, close_device);
}
