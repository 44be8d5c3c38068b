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
                assert_int_equal(sf_reference_create(stage->scene, frame, &(struct sf_reference_options){0}, &kit_log,
                                                     &reference),
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

static void thick_is_the_pixel_and_the_reference(void **state)
{
    static const char *const puff[KIT_SETS] = {FULL, "thick.steps=16", "thick.octaves=1"};
    static const char *const uniform[KIT_SETS] = {FULL, "thick.steps=16", "thick.octaves=1", "thick.placement=uniform"};
    struct apart apart = probe_scene("one-puff", puff, true);

    (void)state;
    assert_true(apart.curves >= 8);
    assert_true(apart.pixel < 1e-5 && apart.light < 1e-3);
    assert_true(apart.through < 1e-3 && apart.sent < 0.05);
    apart = probe_scene("overlap", puff, true);
    assert_true(apart.curves >= 8);
    assert_true(apart.pixel < 1e-5 && apart.light < 1e-3);
    assert_true(apart.through < 0.02 && apart.sent < 0.05);
    apart = probe_scene("overlap", uniform, true);
    assert_true(apart.pixel < 1e-5 && apart.light < 1e-3);
    assert_true(apart.through < 0.02 && apart.sent < 0.05);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(thick_is_the_pixel_and_the_reference),
    };

    return cmocka_run_group_tests(tests, kit_setup, kit_teardown);
}
