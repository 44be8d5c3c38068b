/* A method's samples along one pixel's ray: against the pixel itself, and against the reference along the same ray. */
#include "thick_kit.h"

enum { WIDTH = 56, HEIGHT = 42, STEPS = 16 };

#define FULL "thick.resolution=full"

static struct sf_renderer_options probing(void)
{
    return (struct sf_renderer_options){.width = WIDTH,
                                        .height = HEIGHT,
                                        .aovs = SF_AOV_SMOKE | SF_AOV_DEPTHS,
                                        .float_aovs = true,
                                        .particles = true,
                                        .probe = true};
}

static struct stage probed_stage(const char *name, const char *const sets[KIT_SETS])
{
    struct stage stage = stage_of(name, sets, WIDTH, HEIGHT);
    const struct sf_renderer_options options = probing();

    if (sf_renderer_set_options(stage.renderer, &options) != SF_OK)
        fail_msg("%s", kit_message);
    return stage;
}

/* How far a curve is from what it should be, at most. */
struct apart {
    double pixel;   /* last point to pixel, of the transmittance */
    double light;   /* the same of the radiance, over the brightest channel of all pixels */
    double through; /* any point to the reference at its depth, of the transmittance */
    double sent;    /* the same of the radiance, over the reference's brightest of the ray */
    uint32_t curves;
};

/* The reference on the way to a depth: linear between its points. */
static void reference_at(const struct sf_probe_point *points, uint32_t count, float depth, double value[4])
{
    double span = (double)points[count - 1].depth - (double)points[0].depth;
    double at = fmin(fmax(((double)depth - (double)points[0].depth) / fmax(span, 1e-9), 0), 1) * (count - 1);
    uint32_t i = (uint32_t)fmin(at, count - 2);
    double part = at - i;

    value[3] = (1 - part) * (double)points[i].transmittance + part * (double)points[i + 1].transmittance;
    for (int c = 0; c < 3; c++)
        value[c] = (1 - part) * (double)points[i].radiance[c] + part * (double)points[i + 1].radiance[c];
}

/* Holds the curve of the frame's probe to the reference's. */
static void hold_to_reference(const struct sf_frame *frame, const struct sf_reference *reference, struct apart *apart)
{
    enum { POINTS = 513 };
    static struct sf_probe_point points[POINTS];
    double right[4];

    assert_int_equal(sf_reference_probe(reference, NULL, frame->width, frame->height, frame->probe_at[0],
                                        frame->probe_at[1], points, POINTS),
                     SF_OK);
    double peak = 1e-12;
    for (int c = 0; c < 3; c++)
        peak = fmax(peak, (double)points[POINTS - 1].radiance[c]);
    for (uint32_t i = 0; i < frame->probe_count; i++) {
        reference_at(points, POINTS, frame->probe[i].depth, right);
        apart->through = fmax(apart->through, fabs((double)frame->probe[i].transmittance - right[3]));
        for (int c = 0; c < 3; c++)
            apart->sent = fmax(apart->sent, fabs((double)frame->probe[i].radiance[c] - right[c]) / peak);
    }
}

/* Depths rise, transmittance falls from 1, radiance rises from 0. */
static void assert_course(const struct sf_frame *frame)
{
    const struct sf_probe_point *points = frame->probe;

    assert_true(points[0].transmittance == 1 && points[0].radiance[0] == 0);
    for (uint32_t i = 1; i < frame->probe_count; i++) {
        assert_true(points[i].depth >= points[i - 1].depth);
        assert_true(points[i].transmittance <= points[i - 1].transmittance && points[i].transmittance >= 0);
        for (int c = 0; c < 3; c++)
            assert_true(points[i].radiance[c] >= points[i - 1].radiance[c]);
    }
}

/* Probes every seventh pixel of every fifth row of frame 0. Where `exact`, a pixel has points exactly where it has smoke. */
static struct apart probe_all(struct stage *stage, uint32_t points, bool exact)
{
    struct apart apart = {0};
    struct sf_reference *reference = NULL;
    double peak = 0;

    for (uint32_t y = 1; y < HEIGHT; y += 5)
        for (uint32_t x = 1; x < WIDTH; x += 7) {
            assert_int_equal(sf_renderer_set_probe(stage->renderer, x, y), SF_OK);
            struct picture picture = stage_draw(stage, 0);
            const struct sf_frame *frame = &stage->frame;
            const float *smoke = picture.smoke[y * WIDTH + x], *depths = picture.depths[y * WIDTH + x];
            if (!reference)
                assert_int_equal(
                    sf_reference_create(stage->scene, frame, &(struct sf_reference_options){0}, &kit_log, &reference),
                    SF_OK);
            peak = peak > 0 ? peak : picture_peak(&picture);
            assert_non_null(frame->probe);
            assert_true(frame->probe_at[0] == x && frame->probe_at[1] == y);
            assert_true(frame->probe_count == 0 || frame->probe_count == points);
            if (exact)
                assert_true((frame->probe_count > 0) == (depths[2] > 0));
            if (frame->probe_count > 0) {
                const struct sf_probe_point *last = &frame->probe[points - 1];
                assert_course(frame);
                apart.curves++;
                apart.pixel = fmax(apart.pixel, fabs((double)last->transmittance - (double)depths[3]));
                for (int c = 0; c < 3; c++)
                    apart.light = fmax(apart.light, fabs((double)last->radiance[c] - (double)smoke[c]) / peak);
                hold_to_reference(frame, reference, &apart);
            }
            picture_free(&picture);
        }
    sf_reference_destroy(&reference);
    return apart;
}

static struct apart probe_scene(const char *name, const char *const sets[KIT_SETS], bool exact)
{
    struct stage stage = probed_stage(name, sets);
    struct apart apart = probe_all(&stage, STEPS + 1, exact);

    stage_end(&stage);
    print_message("%s: %u curves; pixel %.2e, light %.2e; reference: transmittance %.2e, radiance %.2e\n", name,
                  apart.curves, apart.pixel, apart.light, apart.through, apart.sent);
    return apart;
}

/* The pixel's radiance has the 16 bits of the smoke's image, which a device may round downwards: 2^-10. In one ball the depth rises evenly, and transmittance is the
 * reference's; where balls overlap it is taken as straight between the ends of SF_THICK_GUIDE slices. */
static void thick_is_the_pixel_and_the_reference(void **state)
{
    static const char *const equal[KIT_SETS] = {FULL, "thick.steps=16", "thick.octaves=1"};
    static const char *const uniform[KIT_SETS] = {FULL, "thick.steps=16", "thick.octaves=1", "thick.placement=uniform"};
    const struct {
        const char *name;
        const char *const *sets;
        double through, sent;
    } cases[] = {{"one-puff", equal, 1e-4, 0.03},
                 {"one-puff", uniform, 1e-4, 0.06},
                 {"overlap", equal, 0.04, 0.05},
                 {"overlap", uniform, 0.04, 0.06}};

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct apart apart = probe_scene(cases[i].name, cases[i].sets, true);
        assert_true(apart.curves >= 8);
        assert_true(apart.pixel < 1e-5 && apart.light < 1e-3);
        assert_true(apart.through < cases[i].through && apart.sent < cases[i].sent);
    }
}

/* Lamps, particles of several colours, detail and jitter: still the pixel's own sum. */
static void thick_is_the_pixel_with_all_that_it_has(void **state)
{
    static const char *const sets[KIT_SETS] = {FULL, "thick.steps=16", "thick.placement=jittered", "thick.detail=0.5"};

    (void)state;
    struct apart apart = probe_scene("two-lights", sets, true);
    assert_true(apart.curves >= 4);
    assert_true(apart.pixel < 1e-5 && apart.light < 1e-3);
}

/* Of the thesis's way the transmittance is that of one even interval: no more than the pixel is promised. */
static void larsson_is_the_pixel(void **state)
{
    static const char *const sets[KIT_SETS] = {FULL, "thick.steps=16", "method=thick-larsson"};

    (void)state;
    struct apart apart = probe_scene("overlap", sets, true);
    assert_true(apart.curves >= 8);
    assert_true(apart.pixel < 1e-5 && apart.light < 1e-3);
}

/* The smoke's pixel that covers the frame's: the middle of this ball is smooth enough to tell that it is that one. */
static void coarse_smoke_has_the_pixel_that_covers(void **state)
{
    static const char *const sets[KIT_SETS] = {"thick.resolution=half", "thick.steps=16"};

    (void)state;
    struct stage stage = probed_stage("one-puff", sets);
    double through = 0, light = 0;
    for (uint32_t x = WIDTH / 2 - 6; x < WIDTH / 2 + 6; x++) {
        assert_int_equal(sf_renderer_set_probe(stage.renderer, x, HEIGHT / 2), SF_OK);
        struct picture picture = stage_draw(&stage, 0);
        const float *smoke = picture.smoke[HEIGHT / 2 * WIDTH + x], *depths = picture.depths[HEIGHT / 2 * WIDTH + x];
        assert_int_equal(stage.frame.probe_count, STEPS + 1);
        const struct sf_probe_point *last = &stage.frame.probe[STEPS];
        through = fmax(through, fabs((double)last->transmittance - (double)depths[3]));
        light = fmax(light, fabs((double)last->radiance[1] / (double)smoke[1] - 1));
        picture_free(&picture);
    }
    stage_end(&stage);
    print_message("half: transmittance %.2e, radiance %.2e\n", through, light);
    assert_true(through < 0.01 && light < 0.1);
}

/* The same bits with and without, for both methods; nothing of it in the graph without. */
static void the_picture_is_the_same(void **state)
{
    static const char *const methods[] = {"method=thick", "method=thick-larsson"};

    (void)state;
    for (int i = 0; i < 2; i++) {
        const char *const sets[KIT_SETS] = {methods[i]};
        struct stage stage = stage_of("overlap", sets, WIDTH, HEIGHT);
        const struct sf_renderer_options options = probing();
        char *text = NULL;
        struct picture plain = stage_draw(&stage, 0);
        assert_null(stage.frame.probe);
        assert_int_equal(sf_renderer_graph_print(stage.renderer, "text", &text), SF_OK);
        assert_null(strstr(text, "probe"));
        free(text);
        assert_int_equal(sf_renderer_set_options(stage.renderer, &options), SF_OK);
        struct picture probed = stage_draw(&stage, 0);
        assert_non_null(stage.frame.probe);
        assert_memory_equal(plain.smoke, probed.smoke, sizeof *plain.smoke * WIDTH * HEIGHT);
        assert_memory_equal(plain.depths, probed.depths, sizeof *plain.depths * WIDTH * HEIGHT);
        picture_free(&plain);
        picture_free(&probed);
        stage_end(&stage);
    }
}

static void set_method(struct stage *stage, const char *method)
{
    char set[64];
    const char *const sets[KIT_SETS] = {set};

    snprintf(set, sizeof set, "method=%s", method);
    *stage = probed_stage("one-puff", sets);
}

/* Methods that keep nothing of the way give no curve, and draw all the same. */
static void others_have_none(void **state)
{
    static const char *const methods[] = {"none", "reference"};
    uint64_t ticket;

    (void)state;
    for (int i = 0; i < 2; i++) {
        struct stage stage;
        set_method(&stage, methods[i]);
        assert_int_equal(sf_renderer_set_probe(stage.renderer, 3, 4), SF_OK);
        assert_int_equal(sf_renderer_render(stage.renderer, 0, &ticket), SF_OK);
        assert_int_equal(sf_renderer_wait(stage.renderer, ticket, &stage.frame), SF_OK);
        assert_true(!stage.frame.probe && stage.frame.probe_count == 0);
        stage_end(&stage);
    }
}

/* Which pixel: the middle at first and after a change of size; a frame keeps the one that it was drawn with. */
static void pixels_are_checked_and_kept(void **state)
{
    struct stage stage;
    struct sf_frame first, second;
    uint64_t tickets[2];

    (void)state;
    set_method(&stage, "thick");
    picture_free(&(struct picture[]){stage_draw(&stage, 0)}[0]);
    assert_true(stage.frame.probe_at[0] == WIDTH / 2 && stage.frame.probe_at[1] == HEIGHT / 2);
    assert_true(stage.frame.probe_count > 0);
    assert_int_equal(sf_renderer_set_probe(stage.renderer, WIDTH, 0), SF_ERROR_USAGE);
    assert_string_equal(kit_message, "a frame of 56x42 has no pixel (56, 0) to probe");
    assert_int_equal(sf_renderer_set_probe(stage.renderer, 0, HEIGHT), SF_ERROR_USAGE);
    assert_string_equal(kit_message, "a frame of 56x42 has no pixel (0, 42) to probe");
    assert_int_equal(sf_renderer_render(stage.renderer, 0, &tickets[0]), SF_OK);
    assert_int_equal(sf_renderer_set_probe(stage.renderer, 0, 1), SF_OK);
    assert_int_equal(sf_renderer_render(stage.renderer, 0, &tickets[1]), SF_OK);
    assert_int_equal(sf_renderer_wait(stage.renderer, tickets[0], &first), SF_OK);
    assert_int_equal(sf_renderer_wait(stage.renderer, tickets[1], &second), SF_OK);
    assert_true(first.probe_at[0] == WIDTH / 2 && first.probe_count > 0);
    assert_true(second.probe && second.probe_at[0] == 0 && second.probe_at[1] == 1 && second.probe_count == 0);

    struct sf_renderer_options options = probing();
    options.width = 20;
    assert_int_equal(sf_renderer_set_options(stage.renderer, &options), SF_OK);
    picture_free(&(struct picture[]){stage_draw(&stage, 0)}[0]);
    assert_true(stage.frame.probe_at[0] == 10 && stage.frame.probe_at[1] == HEIGHT / 2);
    options.no_readback = true;
    options.particles = false;
    assert_int_equal(sf_renderer_set_options(stage.renderer, &options), SF_ERROR_USAGE);
    assert_string_equal(kit_message, "a probe needs what no_readback leaves out");
    options.probe = options.no_readback = false;
    assert_int_equal(sf_renderer_set_options(stage.renderer, &options), SF_OK);
    assert_int_equal(sf_renderer_set_probe(stage.renderer, 1, 1), SF_ERROR_USAGE);
    assert_string_equal(kit_message, "the renderer was made without probe");
    stage_end(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(thick_is_the_pixel_and_the_reference),
        cmocka_unit_test(thick_is_the_pixel_with_all_that_it_has),
        cmocka_unit_test(larsson_is_the_pixel),
        cmocka_unit_test(coarse_smoke_has_the_pixel_that_covers),
        cmocka_unit_test(the_picture_is_the_same),
        cmocka_unit_test(others_have_none),
        cmocka_unit_test(pixels_are_checked_and_kept),
    };

    return cmocka_run_group_tests(tests, kit_setup, kit_teardown);
}
