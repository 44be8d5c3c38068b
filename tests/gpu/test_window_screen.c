/* Windows on a real screen: pictures, sizes, minimised and back. */
#include "gpu_kit.h"
#include "screen_kit.h"
#include "gpu/fault.h"
#include "output/half.h"
#include "output/tone.h"

enum { WIDTH = 320, HEIGHT = 200 };

static struct kit_screen screen;

static struct sf_device *open_device(void)
{
    const struct sf_device_options options = {.validate = true, .no_cache = true, .surface = &screen.source};
    struct sf_device *device = NULL;

    kit_forget();
    if (!kit_screen_resize(&screen, WIDTH, HEIGHT))
        fail_msg("the window keeps another size");
    if (sf_device_create(&options, &kit_log, &device) != SF_OK)
        fail_msg("no device: %s", kit_record.last);
    return device;
}

static struct sf_window *open_window(struct sf_device *device, uint32_t width, uint32_t height)
{
    const struct sf_window_options options = {.width = width, .height = height};
    struct sf_window *window = NULL;

    if (sf_window_create(device, &options, &kit_log, &window) != SF_OK)
        fail_msg("no window: %s", kit_record.last);
    return window;
}

static void finish(struct sf_device **device, struct sf_window **window)
{
    sf_window_destroy(window);
    if (sf_device_validation_messages(*device))
        fail_msg("%u validation messages; the last error: %s", sf_device_validation_messages(*device), kit_record.last);
    sf_device_destroy(device);
    if (kit_record.errors)
        fail_msg("%d errors, the last: %s", kit_record.errors, kit_record.last);
}

static void show(struct sf_window *window, const struct sf_window_frame *frame)
{
    glfwPollEvents();
    if (sf_window_show(window, frame) != SF_OK)
        fail_msg("%s", kit_record.last);
}

static void resize(struct sf_window *window, uint32_t width, uint32_t height)
{
    const struct sf_window_options options = {.width = width, .height = height};

    assert_int_equal(sf_window_set_options(window, &options), SF_OK);
}

static struct sf_window_info describe(const struct sf_window *window)
{
    struct sf_window_info info;

    sf_window_describe(window, &info);
    return info;
}

static void assert_shows(int x, int y, long rgb)
{
    if (!kit_screen_shows(&screen, x, y, rgb))
        fail_msg("the screen shows %06lx at %d, %d and should show %06lx",
                 (unsigned long)kit_screen_pixel(&screen, x, y), x, y, (unsigned long)rgb);
}

/* One rectangle of one colour over the right lower half of a frame. */
struct cover {
    struct sf_overlay_vertex vertices[4];
    uint32_t indices[6];
    struct sf_overlay_batch batch;
    struct sf_overlay overlay;
};

static void set_cover(struct cover *cover, float left, float top, uint32_t color)
{
    const float side = 4000;

    *cover = (struct cover){
        .vertices = {{left, top, 0, 0, color},
                     {left + side, top, 0, 0, color},
                     {left + side, top + side, 0, 0, color},
                     {left, top + side, 0, 0, color}},
        .indices = {0, 1, 2, 0, 2, 3},
        .batch = {{0, 0, side, side}, 0, 6},
    };
    cover->overlay = (struct sf_overlay){cover->vertices, cover->indices, &cover->batch, 4, 6, 1};
}

/* Twenty sizes and more, odd and tiny ones among them, each seen on the screen in its corners. */
static void test_sizes(void **state)
{
    static const struct {
        int width, height;
    } sizes[] = {{320, 200}, {321, 201}, {37, 411}, {1, 1}, {640, 480}, {2, 3}, {333, 77}};
    struct sf_device *device = open_device();
    struct sf_window *window = open_window(device, WIDTH, HEIGHT);
    struct sf_window_frame frame = {.background = {1, 0.2f, 0}};
    struct cover cover;

    (void)state;
    frame.overlay = &cover.overlay;
    for (uint32_t i = 0; i < 21; i++) {
        int width = sizes[i % 7].width, height = sizes[i % 7].height;
        uint32_t color = 0xff000000u | 0x0a1b2cu * (i + 1);
        long rgb = (long)((color & 255) << 16 | (color & 0xff00) | (color >> 16 & 255));

        if (!kit_screen_resize(&screen, width, height))
            fail_msg("the window keeps another size than %dx%d", width, height);
        resize(window, (uint32_t)width, (uint32_t)height);
        set_cover(&cover, (float)(width / 2), (float)(height / 2), color);
        show(window, &frame);
        assert_int_equal(describe(window).width, width);
        assert_int_equal(describe(window).height, height);
        assert_int_equal(describe(window).shown, i + 1);
        if (width > 1)
            assert_shows(0, 0, 0xff3300);
        assert_shows(width - 1, height - 1, rgb);
    }
    finish(&device, &window);
}

/* The window changes and the host has not said so yet: no call fails, and what it says later is shown. */
static void test_late(void **state)
{
    struct sf_device *device = open_device();
    struct sf_window *window = open_window(device, WIDTH, HEIGHT);
    const struct sf_window_frame frame = {.background = {0, 1, 0}};

    (void)state;
    for (int i = 0; i < 20; i++) {
        assert_true(kit_screen_resize(&screen, 200 + 31 * (i % 5), 300 - 17 * (i % 7)));
        show(window, &frame);
        show(window, &frame);
    }
    assert_true(kit_screen_resize(&screen, 251, 149));
    resize(window, 251, 149);
    show(window, &frame);
    assert_shows(250, 148, 0x00ff00);
    assert_int_equal(describe(window).width, 251);
    finish(&device, &window);
}

/* Minimised, a window shows nothing and costs nothing; it may even be so from the start. A window whose size stays is
 * not made anew again and again, whatever the driver thinks of its images. */
static void test_minimised(void **state)
{
    struct sf_device *device = open_device();
    struct sf_window *window = open_window(device, 0, 0);
    struct sf_window_frame frame = {.background = {0, 0, 1}};
    uint64_t remade, used = 0, used_later, budget;

    (void)state;
    for (int i = 0; i < 5; i++)
        show(window, &frame);
    assert_int_equal(describe(window).shown, 0);
    resize(window, WIDTH, HEIGHT);
    for (int i = 0; i < 20; i++) {
        show(window, &frame);
        if (i == 2)
            sf_device_memory(device, &used, &budget);
    }
    sf_device_memory(device, &used_later, &budget);
    assert_int_equal(used, used_later);
    assert_int_equal(describe(window).shown, 20);
    assert_shows(WIDTH - 1, HEIGHT - 1, 0x0000ff);
    remade = describe(window).remade;
    assert_true(remade <= 2);
    resize(window, WIDTH, 0);
    frame.background[0] = 1;
    for (int i = 0; i < 5; i++)
        show(window, &frame);
    assert_int_equal(describe(window).shown, 20);
    assert_int_equal(describe(window).remade, remade);
    assert_shows(5, 5, 0x0000ff);
    resize(window, WIDTH, HEIGHT);
    show(window, &frame);
    assert_shows(5, 5, 0xff00ff);
    assert_int_equal(describe(window).shown, 21);
    finish(&device, &window);
}

/* Every mode that the window has can be had; one that it has not is refused by name, and nothing changes. */
static void test_modes(void **state)
{
    struct sf_device *device = open_device();
    struct sf_window *window = NULL;
    struct sf_window_options options = {.width = WIDTH, .height = HEIGHT, .present_mode = "sideways"};
    const struct sf_window_frame frame = {.background = {1, 1, 0}};
    struct sf_window_info info;
    uint32_t count = 0;

    (void)state;
    assert_int_equal(sf_window_create(device, &options, &kit_log, &window), SF_ERROR_USAGE);
    assert_null(window);
    assert_non_null(strstr(kit_record.last, "sideways"));
    assert_non_null(strstr(kit_record.last, "fifo"));
    window = open_window(device, WIDTH, HEIGHT);
    info = describe(window);
    assert_string_equal(info.present_mode, "fifo");
    for (; info.present_modes[count]; count++) {
        options.present_mode = info.present_modes[count];
        assert_int_equal(sf_window_set_options(window, &options), SF_OK);
        show(window, &frame);
        show(window, &frame);
        assert_string_equal(describe(window).present_mode, options.present_mode);
    }
    assert_int_equal(describe(window).shown, 2 * count);
    options = (struct sf_window_options){.width = 7, .height = 7, .present_mode = "sideways"};
    assert_int_equal(sf_window_set_options(window, &options), SF_ERROR_USAGE);
    show(window, &frame);
    assert_int_equal(describe(window).width, WIDTH);
    assert_int_equal(sf_window_create(device, &(struct sf_window_options){.width = 9, .height = 9}, &kit_log,
                                      &(struct sf_window *){NULL}),
                     SF_ERROR_USAGE); /* one window a device */
    kit_forget();
    finish(&device, &window);
}

/* What is wrong with a frame is refused before anything is drawn, and the next is shown. */
static void test_misuse(void **state)
{
    struct sf_device *device = open_device();
    struct sf_window *window = open_window(device, WIDTH, HEIGHT);
    struct sf_window_frame frame = {.background = {0, 1, 1}};
    const uint8_t coverage[4] = {255, 255, 255, 255};
    struct cover cover;

    (void)state;
    set_cover(&cover, 10, 10, 0xff112233u);
    cover.indices[5] = 4;
    frame.overlay = &cover.overlay;
    assert_int_equal(sf_window_show(window, &frame), SF_ERROR_USAGE);
    assert_int_equal(sf_window_set_font(window, NULL, 2, 2), SF_ERROR_USAGE);
    assert_int_equal(sf_window_set_font(window, coverage, 0, 2), SF_ERROR_USAGE);
    assert_int_equal(describe(window).shown, 0);
    kit_forget();
    cover.indices[5] = 3;
    show(window, &frame);
    assert_int_equal(sf_window_set_font(window, coverage, 2, 2), SF_OK);
    show(window, &frame);
    assert_int_equal(describe(window).shown, 2);
    assert_shows(9, 9, 0x00ffff);
    assert_shows(10, 10, 0x332211);
    finish(&device, &window);
}

/* ---- what goes wrong ---- */

enum { LATER = 1000000, MISSES = 100 };

/* An image that cannot be had is no error at once, and the window comes back as soon as the trouble ends; but not
 * for ever. */
static void check_trouble(enum sf_fault fault)
{
    struct sf_window_frame frame = {.background = {1, 0, 0}};
    struct sf_device *device;
    struct sf_window *window;

    sf_gpu_fail_after(fault, LATER);
    device = open_device();
    window = open_window(device, WIDTH, HEIGHT);
    show(window, &frame);
    for (int round = 0; round < 2; round++) {
        uint64_t remade = describe(window).remade;

        sf_gpu_fail_after(fault, 1);
        for (int i = 0; i < MISSES - 1; i++)
            show(window, &frame);
        assert_true(describe(window).remade <= remade + 4 * MISSES);
        assert_int_equal(describe(window).shown, 1 + round);
        if (round == 1) {
            assert_int_equal(sf_window_show(window, &frame), SF_ERROR_DEVICE);
            assert_non_null(strstr(kit_record.last, "100 times"));
            kit_forget();
        }
        sf_gpu_fail_after(SF_FAULT_NONE, 0);
        frame.background[2] = 1 - frame.background[2];
        show(window, &frame);
        assert_int_equal(describe(window).shown, 2 + round);
        assert_shows(WIDTH - 1, 0, round == 0 ? 0xff00ff : 0xff0000);
    }
    finish(&device, &window);
}

static void test_out_of_date(void **state)
{
    (void)state;
    check_trouble(SF_FAULT_OUT_OF_DATE);
}

static void test_surface_lost(void **state)
{
    (void)state;
    check_trouble(SF_FAULT_SURFACE_LOST);
}

static void test_busy(void **state)
{
    (void)state;
    check_trouble(SF_FAULT_BUSY);
}

/* Images that fit badly are made anew once for each size, and are shown meanwhile. */
static void test_suboptimal(void **state)
{
    const struct sf_window_frame frame = {.background = {1, 1, 1}};
    struct sf_device *device;
    struct sf_window *window;

    (void)state;
    sf_gpu_fail_after(SF_FAULT_SUBOPTIMAL, LATER);
    device = open_device();
    window = open_window(device, WIDTH, HEIGHT);
    sf_gpu_fail_after(SF_FAULT_SUBOPTIMAL, 1);
    for (int i = 0; i < 10; i++)
        show(window, &frame);
    assert_int_equal(describe(window).remade, 1);
    assert_true(kit_screen_resize(&screen, WIDTH + 10, HEIGHT));
    resize(window, WIDTH + 10, HEIGHT);
    for (int i = 0; i < 10; i++)
        show(window, &frame);
    assert_int_equal(describe(window).remade, 3);
    assert_int_equal(describe(window).shown, 20);
    assert_shows(WIDTH + 9, 0, 0xffffff);
    sf_gpu_fail_after(SF_FAULT_NONE, 0);
    finish(&device, &window);
}

static void test_device_lost(void **state)
{
    const struct sf_window_frame frame = {.background = {1, 1, 1}};
    struct sf_device *device;
    struct sf_window *window;

    (void)state;
    sf_gpu_fail_after(SF_FAULT_PRESENT, LATER);
    device = open_device();
    window = open_window(device, WIDTH, HEIGHT);
    show(window, &frame);
    sf_gpu_fail_after(SF_FAULT_PRESENT, 1);
    assert_int_equal(sf_window_show(window, &frame), SF_ERROR_DEVICE_LOST);
    sf_gpu_fail_after(SF_FAULT_NONE, 0);
    assert_int_equal(sf_window_show(window, &frame), SF_ERROR_DEVICE_LOST);
    assert_int_equal(describe(window).shown, 1);
    kit_forget();
    finish(&device, &window);
}

/* ---- a renderer's pictures ---- */

enum { LEFT = 31, TOP = 17 };

static struct sf_scene *load_scene(void)
{
    struct sf_scene *scene = NULL;
    char path[1024];

    snprintf(path, sizeof path, "%s/scenes/tiny/sphere.json", getenv("SF_SOURCE_ROOT"));
    if (sf_scene_load(path, NULL, 0, &kit_log, &scene) != SF_OK)
        fail_msg("%s", kit_record.last);
    return scene;
}

/* The number of pixels on the screen that are not within 1 of `codes`. */
static uint32_t count_wrong(const uint8_t *codes, uint32_t width, uint32_t height)
{
    uint32_t wrong = 0;

    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++, codes += 3) {
            long rgb = kit_screen_pixel(&screen, (int)x + LEFT, (int)y + TOP);
            bool right = rgb >= 0;

            for (int c = 0; c < 3; c++)
                right = right && labs((rgb >> (16 - 8 * c) & 255) - codes[c]) <= 1;
            wrong += !right;
        }
    return wrong;
}

/* Renders the frame, shows it, and looks on the screen for the codes that the PNG writer would make of the picture that
 * `other` gives back. */
static void check_picture(struct sf_window *window, struct sf_renderer *renderer, struct sf_renderer *other,
                          uint32_t number, bool floats)
{
    struct sf_window_frame shown = {
        .x = LEFT, .y = TOP, .background = {0.2f, 0.2f, 0.2f}, .renderer = renderer, .tone = "aces", .exposure = 0.5f};
    const struct sf_tone tone = {.mode = SF_TONE_ACES, .exposure = shown.exposure};
    struct sf_frame frame;
    uint64_t ticket;
    uint32_t wrong = 1;

    if (sf_renderer_render(renderer, number, &ticket) != SF_OK || sf_renderer_render(other, number, &ticket) != SF_OK ||
        sf_renderer_wait(other, ticket, &frame) != SF_OK)
        fail_msg("%s", kit_record.last);
    size_t pixels = (size_t)frame.width * frame.height;
    float *light = malloc(pixels * 4 * sizeof *light);
    uint8_t *codes = malloc(pixels * 3);

    assert_true(light && codes && (floats ? frame.color_float != NULL : frame.color != NULL));
    for (size_t i = 0; i < pixels * 4; i++)
        light[i] = floats ? frame.color_float[i] : sf_half_to_float(frame.color[i]);
    sf_tone_encode8(&tone, light, pixels, 3, codes);
    assert_memory_not_equal(codes, codes + pixels / 2 * 3, 3 * frame.width); /* there is something to be seen */
    shown.width = (float)frame.width;
    shown.height = (float)frame.height;
    show(window, &shown);
    for (int i = 0; i < 400 && wrong > 0; i++) {
        kit_screen_pause();
        wrong = count_wrong(codes, frame.width, frame.height);
    }
    if (wrong > 0)
        fail_msg("%u of %zu pixels on the screen are not the picture's", wrong, pixels);
    assert_shows(LEFT - 1, TOP, 0x333333);
    assert_shows(LEFT + (int)frame.width, TOP + (int)frame.height - 1, 0x333333);
    free(light);
    free(codes);
}

static struct sf_renderer *make_renderer(struct sf_device *device, const struct sf_scene *scene,
                                         struct sf_renderer_options options, bool shown)
{
    struct sf_renderer *renderer = NULL;

    options.shown = shown;
    if (sf_renderer_create(device, scene, &options, &kit_log, &renderer) != SF_OK)
        fail_msg("%s", kit_record.last);
    return renderer;
}

/* A window shows what the renderer drew last, goes along when its size and format change, and outlives it. */
static void test_picture(void **state)
{
    struct sf_renderer_options options = {.width = 160, .height = 120};
    struct sf_scene *scene = load_scene();
    struct sf_device *device = open_device();
    struct sf_window *window = open_window(device, WIDTH, HEIGHT);
    struct sf_renderer *renderer = make_renderer(device, scene, options, true);
    struct sf_renderer *other = make_renderer(device, scene, options, false);
    struct sf_window_frame before = {.width = 100, .height = 100, .background = {1, 0, 1}, .renderer = renderer};

    (void)state;
    show(window, &before); /* before there is a picture */
    assert_shows(50, 50, 0xff00ff);
    for (uint32_t i = 0; i < 3; i++)
        check_picture(window, renderer, other, i, false);
    options = (struct sf_renderer_options){.width = 93, .height = 71, .float_color = true, .shown = true};
    assert_int_equal(sf_renderer_set_options(renderer, &options), SF_OK);
    sf_renderer_destroy(&other);
    other = make_renderer(device, scene, options, false);
    check_picture(window, renderer, other, 4, true);
    sf_renderer_destroy(&renderer);
    sf_renderer_destroy(&other);
    before.renderer = NULL;
    show(window, &before);
    assert_shows(50, 50, 0xff00ff);
    finish(&device, &window);
    sf_scene_destroy(&scene);
}

static void test_no_surface(void **state)
{
    const struct sf_device_options options = {.no_cache = true};
    struct sf_device *device = NULL;
    struct sf_window *window = NULL;

    (void)state;
    kit_forget();
    assert_int_equal(sf_device_create(&options, &kit_log, &device), SF_OK);
    assert_int_equal(sf_window_create(device, &(struct sf_window_options){.width = 9, .height = 9}, &kit_log, &window),
                     SF_ERROR_USAGE);
    assert_null(window);
    assert_non_null(strstr(kit_record.last, "surface"));
    sf_device_destroy(&device);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sizes),        cmocka_unit_test(test_late),    cmocka_unit_test(test_minimised),
        cmocka_unit_test(test_modes),        cmocka_unit_test(test_misuse),  cmocka_unit_test(test_out_of_date),
        cmocka_unit_test(test_surface_lost), cmocka_unit_test(test_busy),    cmocka_unit_test(test_suboptimal),
        cmocka_unit_test(test_device_lost),  cmocka_unit_test(test_picture), cmocka_unit_test(test_no_surface),
    };
    int result = kit_probe();

    if (result)
        return result;
    if (!kit_screen_open(&screen, WIDTH, HEIGHT))
        return KIT_SKIP;
    result = cmocka_run_group_tests(tests, NULL, NULL);
    kit_screen_close(&screen);
    return result;
}
