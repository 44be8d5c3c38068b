/* Showing pictures in a window, with validation: every present mode, odd and tiny sizes, surfaces that change, go and
 * come back, and what happens when the driver says so. */
#include "gpu_kit.h"
#include "screen_kit.h"
#include "gpu/fault.h"

enum { WIDTH = 96, HEIGHT = 64 };

static struct kit_screen screen;

/* The window's surfaces, counted. */
struct host {
    uint32_t surfaces;
    enum sf_status refusal; /* what making another says; SF_OK: it is made */
};

static enum sf_status make_surface(void *user, void *instance, uint64_t *surface)
{
    struct host *host = user;

    if (host->refusal)
        return host->refusal;
    host->surfaces++;
    return kit_screen_surface(screen.window, instance, surface);
}

static void resize_window(uint32_t width, uint32_t height)
{
    if (!kit_screen_resize(&screen, (int)width, (int)height))
        fail_msg("the window keeps another size than %u x %u", width, height);
}

static enum sf_status create_gpu(struct host *host, const char *const *extensions, uint32_t count, struct sf_gpu **gpu)
{
    const struct sf_surface_source source = {extensions, count, make_surface, host};
    const struct sf_gpu_options options = {.validate = true, .no_cache = true, .surface = &source};

    kit_forget();
    return sf_gpu_create(&options, &kit_log, gpu);
}

/* What most tests need. */
struct stage {
    struct host host;
    struct sf_gpu *gpu;
    struct sf_swapchain *swapchain;
    /* A graph that draws the left half in one colour, over another: */
    struct sf_graph *graph;
    struct sf_plan *plan;
    struct sf_player *player;
    sf_resource screen;
    uint32_t width, height; /* for which the player was made */
    float push[10];
};

static void setup(struct stage *stage)
{
    memset(stage, 0, sizeof *stage);
    resize_window(WIDTH, HEIGHT);
    if (create_gpu(&stage->host, screen.source.extensions, screen.source.extension_count, &stage->gpu) != SF_OK)
        fail_msg("no device: %s", kit_record.last);
}

static void setup_shown(struct stage *stage)
{
    setup(stage);
    if (sf_swapchain_create(stage->gpu, WIDTH, HEIGHT, SF_PRESENT_FIFO, &stage->swapchain) != SF_OK)
        fail_msg("no swapchain: %s", kit_record.last);
}

static void drop_player(struct stage *stage)
{
    kit_drop(&stage->player, &stage->plan, &stage->graph);
    stage->width = stage->height = 0;
}

static void finish(struct stage *stage)
{
    drop_player(stage);
    sf_swapchain_destroy(&stage->swapchain);
    assert_null(stage->swapchain);
    kit_finish(&stage->gpu);
}

/* The player for images of the swapchain as it is now. */
static void make_player(struct stage *stage, enum sf_load load)
{
    const float push[10] = {-1, -1, 0, 1, 0.2f, 0.4f, 0.6f, 1, 0.5f, 0}; /* test/quad.vert: rectangle, colour, depth */
    uint32_t images;
    enum sf_format format;
    struct sf_use use = {.access = SF_ACCESS_COLOR, .load = load, .clear = {1, 0.8f, 0, 1}};

    drop_player(stage);
    sf_swapchain_extent(stage->swapchain, &stage->width, &stage->height, &images, &format);
    assert_true(images > 0 && stage->width > 0 && stage->height > 0);
    assert_true(format == SF_FORMAT_BGRA8_UNORM || format == SF_FORMAT_RGBA8_UNORM);
    memcpy(stage->push, push, sizeof push);
    stage->graph = kit_graph("show");
    stage->screen =
        sf_graph_image(stage->graph, &(struct sf_image_desc){.name = "screen",
                                                             .format = format,
                                                             .lifetime = SF_IMPORTED,
                                                             .size = {.width = stage->width, .height = stage->height},
                                                             .outside = SF_ACCESS_PRESENT});
    use.resource = stage->screen;
    sf_graph_pass(stage->graph, &(struct sf_pass_desc){.name = "draw",
                                                       .kind = SF_PASS_RASTER,
                                                       .uses = &use,
                                                       .use_count = 1,
                                                       .shader = "test/quad.vert",
                                                       .fragment = "test/flat.frag",
                                                       .push = stage->push,
                                                       .push_bytes = sizeof stage->push,
                                                       .vertices = 4,
                                                       .instances = 1,
                                                       .raster = {.triangle_strip = true}});
    stage->player = kit_player(stage->gpu, stage->graph, &stage->plan);
}

/* One frame; false when there was no image for it. */
static bool show(struct stage *stage)
{
    struct sf_gpu_image *image = NULL;
    uint64_t serial = 0;

    assert_int_equal(sf_frame_begin(stage->gpu), SF_OK);
    assert_int_equal(sf_swapchain_acquire(stage->swapchain, &image), SF_OK);
    if (image) {
        uint32_t width, height;

        sf_swapchain_extent(stage->swapchain, &width, &height, NULL, NULL);
        if (width != stage->width || height != stage->height || !stage->player)
            make_player(stage, SF_LOAD_CLEAR);
        sf_player_bind_image(stage->player, stage->screen, image);
        if (sf_player_play(stage->player) != SF_OK)
            fail_msg("%s", kit_record.last);
    }
    if (sf_frame_end(stage->gpu, &serial) != SF_OK)
        fail_msg("%s", kit_record.last);
    assert_int_equal(sf_frame_wait(stage->gpu, serial), SF_OK);
    return image != NULL;
}

static void renew(struct stage *stage, uint32_t width, uint32_t height, enum sf_present_mode mode)
{
    if (sf_swapchain_renew(stage->swapchain, width, height, mode) != SF_OK)
        fail_msg("%s", kit_record.last);
}

static void assert_extent(const struct stage *stage, uint32_t width, uint32_t height)
{
    uint32_t w, h, images;

    sf_swapchain_extent(stage->swapchain, &w, &h, &images, NULL);
    assert_int_equal(w, width);
    assert_int_equal(h, height);
    assert_int_equal(images > 0, width > 0);
}

static void assert_pixel(uint32_t x, uint32_t y, uint32_t rgb)
{
    if (!kit_screen_shows(&screen, (int)x, (int)y, (long)rgb))
        fail_msg("the window's pixel %u, %u is %06lx and should be %06x", x, y,
                 kit_screen_pixel(&screen, (int)x, (int)y), rgb);
}

static void assert_halves(const struct stage *stage, uint32_t left, uint32_t right)
{
    assert_pixel(0, 0, left);
    assert_pixel(stage->width / 2 - 1, stage->height - 1, left);
    assert_pixel(stage->width / 2, 0, right);
    assert_pixel(stage->width - 1, stage->height - 1, right);
}

enum { LEFT = 0x336699, RIGHT = 0xffcc00 };

static void test_shows(void **state)
{
    struct sf_gpu_info *infos = NULL;
    uint32_t count;
    struct stage stage;

    (void)state;
    setup_shown(&stage);
    assert_int_equal(stage.host.surfaces, 1);
    assert_extent(&stage, WIDTH, HEIGHT);
    assert_true(show(&stage));
    assert_halves(&stage, LEFT, RIGHT);
    /* Another instance, without surfaces, comes and goes meanwhile. */
    assert_int_equal(sf_gpu_list(&kit_log, &infos, &count), SF_OK);
    free(infos);
    for (int i = 0; i < 20; i++) {
        stage.push[4] = (float)i / 51.0f;
        assert_true(show(&stage));
    }
    assert_halves(&stage, 0x5f6699, RIGHT);
    renew(&stage, WIDTH, HEIGHT, SF_PRESENT_FIFO);
    assert_true(show(&stage));
    assert_halves(&stage, 0x5f6699, RIGHT);
    finish(&stage);
}

/* Frames in flight, none waited for. */
static void test_flight(void **state)
{
    struct stage stage;
    struct sf_gpu_image *image;

    (void)state;
    setup_shown(&stage);
    make_player(&stage, SF_LOAD_CLEAR);
    for (int i = 0; i < 60; i++) {
        assert_int_equal(sf_frame_begin(stage.gpu), SF_OK);
        assert_int_equal(sf_swapchain_acquire(stage.swapchain, &image), SF_OK);
        assert_non_null(image);
        sf_player_bind_image(stage.player, stage.screen, image);
        assert_int_equal(sf_player_play(stage.player), SF_OK);
        assert_int_equal(sf_frame_end(stage.gpu, NULL), SF_OK);
        if (i % 7 == 3) { /* frames that show nothing stand between */
            assert_int_equal(sf_frame_begin(stage.gpu), SF_OK);
            assert_int_equal(sf_frame_end(stage.gpu, NULL), SF_OK);
        }
        if (i % 20 == 10)
            renew(&stage, WIDTH, HEIGHT, SF_PRESENT_FIFO);
    }
    assert_halves(&stage, LEFT, RIGHT);
    finish(&stage);
}

static void test_modes(void **state)
{
    struct stage stage;
    uint32_t modes = 0;

    (void)state;
    setup_shown(&stage);
    assert_int_equal(sf_swapchain_modes(stage.gpu, &modes), SF_OK);
    assert_true(modes & 1u << SF_PRESENT_FIFO); /* every surface has it */
    for (int mode = 0; mode <= SF_PRESENT_COUNT; mode++) {
        if (mode < SF_PRESENT_COUNT && modes & 1u << mode) {
            renew(&stage, WIDTH, HEIGHT, (enum sf_present_mode)mode);
            for (int i = 0; i < 10; i++)
                assert_true(show(&stage));
            assert_halves(&stage, LEFT, RIGHT);
            continue;
        }
        assert_int_equal(sf_swapchain_renew(stage.swapchain, WIDTH, HEIGHT, (enum sf_present_mode)mode),
                         SF_ERROR_USAGE);
        assert_non_null(strstr(kit_record.last, "fifo"));
        if (mode < SF_PRESENT_COUNT)
            assert_non_null(strstr(kit_record.last, sf_present_mode_name((enum sf_present_mode)mode)));
        kit_forget();
        assert_true(show(&stage)); /* it stayed as it was */
    }
    assert_string_equal(sf_present_mode_name(SF_PRESENT_FIFO), "fifo");
    assert_null(sf_present_mode_name(SF_PRESENT_COUNT));
    finish(&stage);
}

static void test_sizes(void **state)
{
    static const uint32_t sizes[][2] = {{1, 1}, {3, 7}, {257, 2}, {1, 131}, {640, 480}, {33, 65}};
    struct stage stage;

    (void)state;
    setup_shown(&stage);
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        resize_window(sizes[i][0], sizes[i][1]);
        /* The old images, as long as they last: never an error, never a wait for ever. */
        for (int k = 0; k < 3; k++)
            show(&stage);
        renew(&stage, sizes[i][0], sizes[i][1], SF_PRESENT_FIFO);
        assert_extent(&stage, sizes[i][0], sizes[i][1]);
        for (int k = 0; k < 3; k++)
            assert_true(show(&stage));
        if (sizes[i][0] % 2 == 0)
            assert_halves(&stage, LEFT, RIGHT);
    }
    /* What is asked for does not count where the surface has a size of its own. */
    renew(&stage, 5, 5, SF_PRESENT_FIFO);
    assert_extent(&stage, 33, 65);
    finish(&stage);
}

/* Minimised: no images, and frames go on without. */
static void test_no_size(void **state)
{
    struct stage stage;

    (void)state;
    setup(&stage);
    assert_int_equal(sf_swapchain_create(stage.gpu, 0, 0, SF_PRESENT_FIFO, &stage.swapchain), SF_OK);
    assert_extent(&stage, 0, 0);
    for (int i = 0; i < 3; i++)
        assert_false(show(&stage));
    renew(&stage, WIDTH, HEIGHT, SF_PRESENT_FIFO);
    assert_true(show(&stage));
    renew(&stage, WIDTH, 0, SF_PRESENT_FIFO);
    assert_extent(&stage, 0, 0);
    assert_false(show(&stage));
    renew(&stage, WIDTH, HEIGHT, SF_PRESENT_FIFO);
    assert_true(show(&stage));
    assert_halves(&stage, LEFT, RIGHT);
    finish(&stage);
}

static void expect_refused(enum sf_status status, enum sf_status want, const char *part)
{
    assert_int_equal(status, want);
    if (!strstr(kit_record.last, part))
        fail_msg("no '%s' in: %s", part, kit_record.last);
    kit_forget();
}

static void test_misuse(void **state)
{
    struct stage stage, over;
    struct sf_gpu_image *image = NULL, *second = NULL;
    struct sf_swapchain *other = NULL;
    struct sf_gpu *blind;
    uint32_t modes;

    (void)state;
    setup_shown(&stage);
    make_player(&stage, SF_LOAD_CLEAR);
    over = stage; /* the same device and swapchain, another player */
    over.graph = NULL, over.plan = NULL, over.player = NULL;
    make_player(&over, SF_LOAD_KEEP);
    expect_refused(sf_swapchain_create(stage.gpu, 1, 1, SF_PRESENT_FIFO, &other), SF_ERROR_USAGE, "already");
    expect_refused(sf_swapchain_acquire(stage.swapchain, &image), SF_ERROR_USAGE, "outside of a frame");
    assert_null(other);
    assert_null(image);

    assert_int_equal(sf_frame_begin(stage.gpu), SF_OK);
    assert_int_equal(sf_swapchain_acquire(stage.swapchain, &image), SF_OK);
    assert_non_null(image);
    expect_refused(sf_swapchain_acquire(stage.swapchain, &second), SF_ERROR_USAGE, "second");
    expect_refused(sf_swapchain_renew(stage.swapchain, WIDTH, HEIGHT, SF_PRESENT_FIFO), SF_ERROR_USAGE,
                   "while a frame");
    sf_player_bind_image(over.player, over.screen, image);
    expect_refused(sf_player_play(over.player), SF_ERROR_USAGE, "clear it first");
    /* Drawn once, it may be drawn over in the same frame. */
    sf_player_bind_image(stage.player, stage.screen, image);
    over.push[0] = 0, over.push[2] = 1;
    assert_int_equal(sf_player_play(stage.player), SF_OK);
    assert_int_equal(sf_player_play(over.player), SF_OK);
    assert_int_equal(sf_frame_end(stage.gpu, NULL), SF_OK);
    assert_halves(&stage, LEFT, LEFT);

    assert_int_equal(sf_frame_begin(stage.gpu), SF_OK);
    expect_refused(sf_player_play(stage.player), SF_ERROR_USAGE, "not acquired");
    assert_int_equal(sf_frame_end(stage.gpu, NULL), SF_OK);
    /* Acquired and not drawn: black. */
    for (int i = 0; i < 9; i++) {
        assert_int_equal(sf_frame_begin(stage.gpu), SF_OK);
        assert_int_equal(sf_swapchain_acquire(stage.swapchain, &image), SF_OK);
        assert_non_null(image);
        assert_int_equal(sf_frame_end(stage.gpu, NULL), SF_OK);
    }
    assert_halves(&stage, 0, 0);
    drop_player(&over);
    finish(&stage);

    blind = kit_gpu(0);
    expect_refused(sf_swapchain_create(blind, 1, 1, SF_PRESENT_FIFO, &other), SF_ERROR_USAGE, "without a surface");
    expect_refused(sf_swapchain_modes(blind, &modes), SF_ERROR_USAGE, "without a surface");
    kit_finish(&blind);
}

/* Instances and devices that cannot be. */
static void test_no_surface(void **state)
{
    static const char *const unknown[] = {"VK_KHR_surface", "VK_SF_no_such_surface"};
    static const char *const other[] = {"VK_KHR_get_physical_device_properties2"};
    struct host host = {0};
    struct sf_gpu *gpu = NULL;

    (void)state;
    expect_refused(create_gpu(&host, unknown, 2, &gpu), SF_ERROR_DEVICE, "VK_SF_no_such_surface");
    expect_refused(create_gpu(&host, other, 1, &gpu), SF_ERROR_DEVICE, "VK_KHR_surface");
    assert_int_equal(host.surfaces, 0);
    host.refusal = SF_ERROR_IO;
    expect_refused(create_gpu(&host, screen.source.extensions, screen.source.extension_count, &gpu), SF_ERROR_IO,
                   "surface");
    assert_null(gpu);
}

/* Two frames, of which call number `n` of acquire, present, acquire, present fails, and all later ones until the fault is
 * taken away: how many showed something? */
static int show_two(struct stage *stage, enum sf_fault fault, uint32_t n)
{
    int shown = 0;

    sf_gpu_fail_after(fault, n);
    for (int i = 0; i < 2; i++)
        shown += show(stage);
    sf_gpu_fail_after(SF_FAULT_NONE, 0);
    return shown;
}

static void setup_faulty(struct stage *stage)
{
    sf_gpu_fail_after(SF_FAULT_OUT_OF_DATE, UINT32_MAX); /* puts the shim in */
    setup_shown(stage);
    make_player(stage, SF_LOAD_CLEAR);
    sf_gpu_fail_after(SF_FAULT_NONE, 0);
}

static void test_out_of_date(void **state)
{
    static const struct {
        uint32_t n;
        int shown;
    } cases[] = {{1, 0}, {2, 1}, {3, 1}, {4, 2}};
    struct stage stage;

    (void)state;
    setup_faulty(&stage);
    for (int lost = 0; lost < 2; lost++)
        for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
            uint32_t surfaces = stage.host.surfaces;

            assert_int_equal(show_two(&stage, lost ? SF_FAULT_SURFACE_LOST : SF_FAULT_OUT_OF_DATE, cases[i].n),
                             cases[i].shown);
            assert_false(show(&stage)); /* until it is renewed */
            renew(&stage, WIDTH, HEIGHT, SF_PRESENT_FIFO);
            assert_int_equal(stage.host.surfaces, surfaces + lost);
            assert_extent(&stage, WIDTH, HEIGHT);
            assert_true(show(&stage));
            assert_false(sf_swapchain_suboptimal(stage.swapchain));
            assert_halves(&stage, LEFT, RIGHT);
        }
    finish(&stage);
    assert_int_equal(sf_gpu_fault_alive(), 0);
}

static void test_suboptimal(void **state)
{
    struct stage stage;

    (void)state;
    setup_faulty(&stage);
    assert_false(sf_swapchain_suboptimal(stage.swapchain));
    for (uint32_t n = 1; n <= 4; n++) {
        assert_int_equal(show_two(&stage, SF_FAULT_SUBOPTIMAL, n), 2);
        assert_true(sf_swapchain_suboptimal(stage.swapchain));
        assert_true(show(&stage)); /* it goes on, and says so no more */
        assert_false(sf_swapchain_suboptimal(stage.swapchain));
    }
    show_two(&stage, SF_FAULT_SUBOPTIMAL, 1);
    renew(&stage, WIDTH, HEIGHT, SF_PRESENT_FIFO);
    assert_false(sf_swapchain_suboptimal(stage.swapchain));
    assert_true(show(&stage));
    /* No image in time: this frame goes without, the next need not. */
    assert_int_equal(show_two(&stage, SF_FAULT_BUSY, 1), 0);
    assert_true(show(&stage));
    finish(&stage);
    assert_int_equal(sf_gpu_fault_alive(), 0);
}

/* A surface that is lost again each time: every call comes back, with one new surface a turn or two, and when it is well
 * again pictures are shown. */
static void test_lost_for_long(void **state)
{
    struct stage stage;

    (void)state;
    setup_faulty(&stage);
    sf_gpu_fail_after(SF_FAULT_SURFACE_LOST, 1);
    for (uint32_t i = 0; i < 5; i++) {
        uint32_t surfaces = stage.host.surfaces;

        assert_false(show(&stage));
        renew(&stage, WIDTH, HEIGHT, SF_PRESENT_FIFO);
        assert_true(stage.host.surfaces > surfaces && stage.host.surfaces <= surfaces + 2);
        assert_extent(&stage, 0, 0);
    }
    stage.host.refusal = SF_ERROR_INTERRUPTED;
    expect_refused(sf_swapchain_renew(stage.swapchain, WIDTH, HEIGHT, SF_PRESENT_FIFO), SF_ERROR_INTERRUPTED,
                   "no surface");
    assert_false(show(&stage));
    stage.host.refusal = SF_OK;
    sf_gpu_fail_after(SF_FAULT_NONE, 0);
    renew(&stage, WIDTH, HEIGHT, SF_PRESENT_FIFO);
    assert_true(show(&stage));
    assert_halves(&stage, LEFT, RIGHT);
    finish(&stage);
    assert_int_equal(sf_gpu_fault_alive(), 0);
}

/* The window itself goes, and another one comes. */
static void test_window_gone(void **state)
{
    struct stage stage;
    int shown = 0;

    (void)state;
    setup_shown(&stage);
    assert_true(show(&stage));
    glfwDestroyWindow(screen.window);
    screen.window = NULL;
    for (int i = 0; i < 4; i++)
        shown += show(&stage);
    assert_true(shown < 4);
    screen.window = glfwCreateWindow(WIDTH, HEIGHT, "another", NULL, NULL);
    assert_non_null(screen.window);
    glfwSetWindowPos(screen.window, 0, 0);
    resize_window(WIDTH + 1, HEIGHT + 1);
    renew(&stage, WIDTH + 1, HEIGHT + 1, SF_PRESENT_FIFO);
    assert_int_equal(stage.host.surfaces, 2);
    assert_extent(&stage, WIDTH + 1, HEIGHT + 1);
    assert_true(show(&stage));
    assert_pixel(0, 0, LEFT);
    finish(&stage);
}

static void test_lost_device(void **state)
{
    struct stage stage;
    struct sf_gpu_image *image;

    (void)state;
    setup_faulty(&stage);
    assert_int_equal(sf_frame_begin(stage.gpu), SF_OK);
    assert_int_equal(sf_swapchain_acquire(stage.swapchain, &image), SF_OK);
    sf_player_bind_image(stage.player, stage.screen, image);
    assert_int_equal(sf_player_play(stage.player), SF_OK);
    sf_gpu_fail_after(SF_FAULT_PRESENT, 1);
    assert_int_equal(sf_frame_end(stage.gpu, NULL), SF_ERROR_DEVICE_LOST);
    assert_int_equal(sf_frame_begin(stage.gpu), SF_ERROR_DEVICE_LOST);
    assert_int_equal(sf_swapchain_renew(stage.swapchain, WIDTH, HEIGHT, SF_PRESENT_FIFO), SF_ERROR_DEVICE_LOST);
    sf_gpu_fail_after(SF_FAULT_NONE, 0);
    kit_forget();
    finish(&stage);
    assert_int_equal(sf_gpu_fault_alive(), 0);
}

/* Each creation fails in turn, when the swapchain is made and when it is renewed. */
static void test_object_faults(void **state)
{
    struct stage stage;
    uint32_t calls;

    (void)state;
    sf_gpu_fail_after(SF_FAULT_OBJECT, UINT32_MAX);
    setup(&stage);
    sf_gpu_fail_after(SF_FAULT_OBJECT, UINT32_MAX);
    assert_int_equal(sf_swapchain_create(stage.gpu, WIDTH, HEIGHT, SF_PRESENT_FIFO, &stage.swapchain), SF_OK);
    calls = sf_gpu_fault_calls();
    assert_true(calls >= 7); /* 2 semaphores, the swapchain, a view and a semaphore an image */
    sf_swapchain_destroy(&stage.swapchain);
    for (uint32_t n = 1; n <= calls; n++) {
        sf_gpu_fail_after(SF_FAULT_OBJECT, n);
        assert_int_equal(sf_swapchain_create(stage.gpu, WIDTH, HEIGHT, SF_PRESENT_FIFO, &stage.swapchain),
                         SF_ERROR_MEMORY);
        assert_null(stage.swapchain);
    }
    sf_gpu_fail_after(SF_FAULT_NONE, 0);
    assert_int_equal(sf_swapchain_create(stage.gpu, WIDTH, HEIGHT, SF_PRESENT_FIFO, &stage.swapchain), SF_OK);
    for (uint32_t n = 1; n <= calls - 2; n++) {
        sf_gpu_fail_after(SF_FAULT_OBJECT, n);
        assert_int_equal(sf_swapchain_renew(stage.swapchain, WIDTH, HEIGHT, SF_PRESENT_FIFO), SF_ERROR_MEMORY);
        sf_gpu_fail_after(SF_FAULT_NONE, 0);
        assert_false(show(&stage));
    }
    kit_forget();
    renew(&stage, WIDTH, HEIGHT, SF_PRESENT_FIFO);
    assert_true(show(&stage));
    assert_halves(&stage, LEFT, RIGHT);
    finish(&stage);
    assert_int_equal(sf_gpu_fault_alive(), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shows),         cmocka_unit_test(test_flight),      cmocka_unit_test(test_modes),
        cmocka_unit_test(test_sizes),         cmocka_unit_test(test_no_size),     cmocka_unit_test(test_misuse),
        cmocka_unit_test(test_no_surface),    cmocka_unit_test(test_out_of_date), cmocka_unit_test(test_suboptimal),
        cmocka_unit_test(test_lost_for_long), cmocka_unit_test(test_window_gone), cmocka_unit_test(test_lost_device),
        cmocka_unit_test(test_object_faults),
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
