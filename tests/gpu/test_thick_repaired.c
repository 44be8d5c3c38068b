/* What the thesis's way of thick smoke gets wrong and the method `thick` does not, each with a bound that `thick-larsson`
 * fails: particles that die, an eye that flies through, empty space between clouds; and that samples converge. */
#include "thick_kit.h"

enum { WIDTH = 56, HEIGHT = 42 };

#define FULL "thick.resolution=full"

/* ---- particles that die ---- */

/* The puff of dying.json has faded in by frame 5, since 0.08 of the longest life is 0.19 s, and the first particle of all
 * dies at 1 s or later. Its middle life are the steps between, though fading out, over the last half of a life, begins at
 * 0.5 s: that fading is meant to be seen, the going is not. */
enum { DYING_FRAMES = 60, DYING_FROM = 5 };

struct dying {
    double middle;  /* largest change of a pixel's radiance in a step before the first death */
    double deaths;  /* ... in a step with a death */
    double jump;    /* ... beyond the reference's own change, in a step with a death */
    double peak;    /* radiance of the brightest pixel of all */
    uint32_t steps; /* with a death */
};

/* Largest amount by which a pixel changes more between two pictures than it does between their references. */
static double jump_of(const struct picture *before, const struct picture *after,
                      const struct sf_reference_picture *true_before, const struct sf_reference_picture *true_after,
                      uint32_t stride)
{
    double jump = 0;

    for (size_t i = 0; i < (size_t)true_after->width * true_after->height; i++) {
        size_t at = pixel_of(true_after, i, stride, after);
        for (int k = 0; k < 3; k++) {
            double change = (double)after->smoke[at][k] - (double)before->smoke[at][k];
            double right = (double)true_after->pixels[i].radiance[k] - (double)true_before->pixels[i].radiance[k];
            jump = fmax(jump, fabs(change) - fabs(right));
        }
    }
    return jump;
}

static struct dying watch_dying(const char *const sets[KIT_SETS])
{
    struct stage stage = stage_of("dying", sets, WIDTH, HEIGHT);
    struct dying dying = {0};
    struct picture before = {0};
    struct sf_reference_picture *true_before = NULL;
    uint32_t live = 0;

    for (uint32_t number = DYING_FROM; number < DYING_FRAMES; number++) {
        struct picture after = stage_draw(&stage, number);
        struct sf_reference_picture *true_after = stage_reference(&stage, 3);
        if (before.smoke) {
            double change = picture_apart(&before, &after);
            if (stage.frame.live < live) {
                dying.steps++;
                dying.deaths = fmax(dying.deaths, change);
                dying.jump = fmax(dying.jump, jump_of(&before, &after, true_before, true_after, 3));
            } else if (dying.steps == 0)
                dying.middle = fmax(dying.middle, change);
        }
        dying.peak = fmax(dying.peak, picture_peak(&after));
        picture_free(&before);
        sf_reference_picture_destroy(&true_before);
        before = after;
        true_before = true_after;
        live = stage.frame.live;
    }
    picture_free(&before);
    sf_reference_picture_destroy(&true_before);
    assert_int_equal(live, 0);
    stage_end(&stage);
    return dying;
}

static bool dies_unseen(const struct dying *dying, const char *what)
{
    printf(
        "  dying, %s: largest change of a pixel, of the peak: %.4f in middle life, %.4f in the %u steps with a death, "
        "%.4f beyond the truth's\n",
        what, dying->middle / dying->peak, dying->deaths / dying->peak, dying->steps, dying->jump / dying->peak);
    assert_true(dying->steps > 10);
    return dying->deaths <= dying->middle && dying->jump <= 0.06 * dying->peak;
}

static void test_deaths(void **state)
{
    struct dying thick = watch_dying((const char *const[KIT_SETS]){FULL});
    struct dying larsson =
        watch_dying((const char *const[KIT_SETS]){FULL, "method=thick-larsson", "larsson.blur=0", "larsson.thin=0"});

    (void)state;
    assert_true(dies_unseen(&thick, "thick"));
    assert_false(dies_unseen(&larsson, "thick-larsson"));
}

/* ---- an eye that flies through ---- */

enum { FLIGHT_FRAMES = 97, FLIGHT_STRIDE = 5 };

struct flight {
    double jump;          /* change of a pixel beyond the reference's own, over the brightest radiance */
    double outside;       /* rms error of the frames before the smoke, the worst */
    double inside;        /* ... within it */
    double transmittance; /* worst of all */
};

static struct flight fly(const char *const sets[KIT_SETS])
{
    struct stage stage = stage_of("fly-through", sets, WIDTH, HEIGHT);
    struct flight flight = {0};
    struct picture before = {0};
    struct sf_reference_picture *true_before = NULL;
    double peak = 0;

    for (uint32_t number = 0; number < FLIGHT_FRAMES; number++) {
        struct picture after = stage_draw(&stage, number);
        struct sf_reference_picture *true_after = stage_reference(&stage, FLIGHT_STRIDE);
        if (before.smoke)
            flight.jump = fmax(flight.jump, jump_of(&before, &after, true_before, true_after, FLIGHT_STRIDE));
        peak = fmax(peak, picture_peak(&after));
        double z = (double)stage.frame.view.eye[2];
        if (z > -1.7) { /* behind that the smoke is behind the eye */
            struct errors errors = errors_of(&after, true_after, FLIGHT_STRIDE, NULL);
            bool within = z < (double)stage.frame.bounds_max[2];
            flight.transmittance = fmax(flight.transmittance, errors.transmittance);
            *(within ? &flight.inside : &flight.outside) =
                fmax(within ? flight.inside : flight.outside, errors.mean > 0.02 ? errors.rms : 0);
        }
        picture_free(&before);
        sf_reference_picture_destroy(&true_before);
        before = after;
        true_before = true_after;
    }
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++)
        assert_true(before.smoke[i][3] == 0);
    picture_free(&before);
    sf_reference_picture_destroy(&true_before);
    stage_end(&stage);
    flight.jump /= peak;
    return flight;
}

static bool flies_well(const struct flight *flight, const char *what)
{
    printf("  flight, %s: jump %.4f of the peak beyond the truth's; rms error %.4f outside, %.4f inside; transmittance "
           "%.1e\n",
           what, flight->jump, flight->outside, flight->inside, flight->transmittance);
    return flight->jump < 0.045 && flight->inside < 0.02 && flight->inside < 1.15 * flight->outside &&
           flight->transmittance < 1e-4;
}

static void test_flight(void **state)
{
    struct flight thick = fly((const char *const[KIT_SETS]){FULL});
    struct flight larsson = fly((const char *const[KIT_SETS]){FULL, "method=thick-larsson"});

    (void)state;
    assert_true(flies_well(&thick, "thick"));
    assert_false(flies_well(&larsson, "thick-larsson"));
}

/* ---- empty space between clouds ---- */

/* Pixels within 3 of a sphere's outline. */
static void mark_outline(bool *mark, const struct sf_frame *frame, uint32_t index)
{
    const float *c = frame->particles[index].position;
    double radius = (double)frame->particles[index].radius, z = (double)frame->view.eye[2] - (double)c[2];
    double scale = frame->height / (2 * tan(20 * acos(-1.0) / 180)); /* px for each unit of slope; fov 40 */
    double x = frame->width / 2.0 + scale * ((double)c[0] - (double)frame->view.eye[0]) / z;
    double y = frame->height / 2.0 - scale * ((double)c[1] - (double)frame->view.eye[1]) / z;
    double outline = scale * radius / sqrt(z * z - radius * radius);

    for (uint32_t row = 0; row < frame->height; row++)
        for (uint32_t column = 0; column < frame->width; column++)
            if (fabs(hypot(column + 0.5 - x, row + 0.5 - y) - outline) < 3)
                mark[row * frame->width + column] = true;
}

/* Of the pixels around the outlines of spheres `first` to `last`. */
static struct errors outline_errors(const char *scene, const char *const sets[KIT_SETS], uint32_t first, uint32_t last)
{
    enum { W = 96, H = 72 };
    bool *mark = calloc(W * H, sizeof *mark);
    struct stage stage = stage_of(scene, sets, W, H);
    struct picture picture = stage_draw(&stage, 0);
    struct sf_reference_picture *reference = stage_reference(&stage, 1);
    struct errors errors;

    assert_non_null(mark);
    for (uint32_t i = first; i <= last; i++)
        mark_outline(mark, &stage.frame, i);
    errors = errors_of(&picture, reference, 1, mark);
    printf("  %s, %s, outlines of %u..%u: bias %+.4f, rms %.4f, worst %.4f of the peak, transmittance %.1e\n", scene,
           sets[1] ? "thick-larsson" : "thick", first, last, errors.bias, errors.rms, errors.worst,
           errors.transmittance);
    sf_reference_picture_destroy(&reference);
    picture_free(&picture);
    stage_end(&stage);
    free(mark);
    return errors;
}

static bool no_silhouette(const struct errors *errors)
{
    return fabs(errors->bias) < 0.03 && errors->rms < 0.035 && errors->worst < 0.11 && errors->transmittance < 1e-4;
}

static void test_holes(void **state)
{
    static const struct {
        const char *scene;
        uint32_t first, last;
    } cases[] = {{"hole-view", 0, 1}, {"hole-light", 1, 1}};

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct errors thick =
            outline_errors(cases[i].scene, (const char *const[KIT_SETS]){FULL}, cases[i].first, cases[i].last);
        struct errors larsson = outline_errors(
            cases[i].scene, (const char *const[KIT_SETS]){FULL, "method=thick-larsson"}, cases[i].first, cases[i].last);
        assert_true(no_silhouette(&thick));
        assert_false(no_silhouette(&larsson));
    }
}

/* ---- samples ---- */

static double error_with(const char *scene, const char *placement, uint32_t steps, uint32_t number)
{
    char place[64], count[64];

    snprintf(place, sizeof place, "thick.placement=%s", placement);
    snprintf(count, sizeof count, "thick.steps=%u", steps);
    const char *const sets[KIT_SETS] = {FULL, place, count, "thick.light_size=512", "thick.light_slices=64"};
    struct stage stage = stage_of(scene, sets, WIDTH, HEIGHT);
    struct errors errors = stage_errors(&stage, number, 2);
    stage_end(&stage);
    return errors.rms;
}

static void test_steps(void **state)
{
    static const char *const placements[] = {"equal", "uniform", "jittered"};
    static const uint32_t steps[] = {2, 8, 32, 128};
    double error[4];

    (void)state;
    for (size_t p = 0; p < 3; p++) {
        printf("  overlap, %s: rms error", placements[p]);
        for (size_t i = 0; i < 4; i++) {
            error[i] = error_with("overlap", placements[p], steps[i], 3);
            printf(" %.4f (%u)", error[i], steps[i]);
        }
        printf("\n");
        assert_true(error[1] < error[0] && error[2] < error[1] && error[3] < 1.05 * error[2]);
        assert_true(error[3] < 0.01);
    }
}

/* The mean over many frames of jittered samples is what many samples give; each frame is off by chance alone. */
static void test_jitter(void **state)
{
    enum { FRAMES = 48 };
    const char *const jittered[KIT_SETS] = {FULL, "thick.placement=jittered", "thick.steps=8"};
    const char *const fine[KIT_SETS] = {FULL, "thick.placement=equal", "thick.steps=256"};
    struct stage stage = stage_of("overlap", jittered, WIDTH, HEIGHT), still = stage_of("overlap", fine, WIDTH, HEIGHT);
    struct picture truth = stage_draw(&still, 0);
    size_t pixels = (size_t)WIDTH * HEIGHT;
    double *sum = calloc(pixels, sizeof *sum), *square = calloc(pixels, sizeof *square);
    double bias = 0, total = 0, variance = 0, off = 0;

    (void)state;
    assert_non_null(sum);
    assert_non_null(square);
    for (uint32_t number = 0; number < FRAMES; number++) {
        struct picture picture = stage_draw(&stage, number);
        for (size_t i = 0; i < pixels; i++) {
            sum[i] += (double)picture.smoke[i][1];
            square[i] += (double)picture.smoke[i][1] * (double)picture.smoke[i][1];
        }
        picture_free(&picture);
    }
    for (size_t i = 0; i < pixels; i++) {
        double mean = sum[i] / FRAMES, right = (double)truth.smoke[i][1];
        bias += mean - right;
        off += (mean - right) * (mean - right);
        total += right;
        variance += fmax(square[i] / FRAMES - mean * mean, 0) * FRAMES / (FRAMES - 1);
    }
    bias /= total;
    double rms = sqrt(off / (double)pixels) / (total / (double)pixels);
    double deviation = sqrt(variance / (double)pixels) / (total / (double)pixels);
    printf(
        "  jittered, 8 steps, %d frames: bias %+.5f, the mean's rms error %.4f, a frame's deviation %.4f of the mean "
        "radiance\n",
        FRAMES, bias, rms, deviation);
    assert_true(fabs(bias) < 2e-3);
    assert_true(rms < 0.03);
    assert_true(deviation > 1e-4 && deviation < 0.16);
    free(sum);
    free(square);
    picture_free(&truth);
    stage_end(&still);
    stage_end(&stage);
}

/* ---- resolution ---- */

static void test_resolution(void **state)
{
    static const char *const resolutions[] = {"full", "half", "quarter"};
    double rms[3];

    (void)state;
    for (size_t i = 0; i < 3; i++) {
        char set[64];
        snprintf(set, sizeof set, "thick.resolution=%s", resolutions[i]);
        /* Sizes that are no multiple of anything. */
        struct stage stage = stage_of("cut", (const char *const[KIT_SETS]){set}, 157, 119);
        struct errors errors = stage_errors(&stage, 0, 1);
        stage_end(&stage);
        printf("  cut, %s: transmittance %.1e; radiance rms %.4f, worst %.4f of the peak\n", resolutions[i],
               errors.transmittance, errors.rms, errors.worst);
        assert_true(errors.transmittance < 1e-3);
        rms[i] = errors.rms;
    }
    assert_true(rms[0] < 0.05 && rms[1] < 0.08 && rms[2] < 0.15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_holes),      cmocka_unit_test(test_steps),  cmocka_unit_test(test_jitter),
        cmocka_unit_test(test_resolution), cmocka_unit_test(test_flight), cmocka_unit_test(test_deaths),
    };
    return cmocka_run_group_tests(tests, kit_setup, kit_teardown);
}
