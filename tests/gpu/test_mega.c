/* Mega particles (METHODS B8): light and size of a ball in closed form, what the scene hides, particles that die, and
 * whether the noise stays on the smoke when the camera pans. */
#include "thick_kit.h"

#define PI 3.14159265358979323846

#define SCENE                                                                                                          \
    "{\"method\":\"mega\",\"camera\":{\"eye\":[0,0,5],\"target\":[0,0,0],\"fov\":40},"                                 \
    "\"lights\":[{\"type\":\"directional\",\"direction\":[-0.6,0,-0.8],\"color\":[1,0.5,0.25],\"intensity\":3}],"      \
    "\"environment\":{\"type\":\"color\",\"color\":[0.1,0.2,0.3],\"visible\":false},"                                  \
    "\"medium\":{\"albedo\":[0.9,0.8,0.7],\"emission\":[0.01,0.02,0.03]},\"sim\":{\"capacity\":64},"                   \
    "\"thick\":{\"resolution\":\"full\"},"
#define BARE  "\"mega\":{\"blur\":0,\"octaves\":0,\"specular\":0.2,\"shininess\":6,\"diffuse\":0.8,\"soft\":0.01},"
#define STILL "\"emitters\":[{\"type\":\"list\",\"still\":true,\"particles\":"
#define DENSE "[{\"centre\":[0,0,0],\"radius\":1,\"extinction\":1e4}]}]"

enum { SIDE = 81 };

static double middle(const struct picture *picture, int channel)
{
    return (double)picture->smoke[(SIDE / 2) * SIDE + SIDE / 2][channel];
}

/* Phong's light on a ball that looks at the eye, with the light 36.87 degrees to the side. */
static void phong(double light[3])
{
    static const double albedo[] = {0.9, 0.8, 0.7}, sun[] = {3, 1.5, 0.75}, around[] = {0.1, 0.2, 0.3};
    double lobe = 0.2 * (6 + 2) / (2 * PI) * pow(0.8, 6);

    for (int k = 0; k < 3; k++)
        light[k] = sun[k] * 0.8 * (0.8 * albedo[k] / PI + lobe) + albedo[k] * around[k] + 0.01 * (k + 1);
}

static void test_light_of_a_ball(void **state)
{
    struct picture picture = draw_text(SCENE BARE STILL DENSE "}", SIDE, SIDE);
    double right[3];

    (void)state;
    phong(right);
    for (int k = 0; k < 3; k++) {
        printf("  channel %d: %.5f, in closed form %.5f\n", k, middle(&picture, k), right[k]);
        assert_true(fabs(middle(&picture, k) / right[k] - 1) < 1e-3); /* half floats */
    }
    assert_true(middle(&picture, 3) >= 1);
    const float *depths = picture.depths[(SIDE / 2) * SIDE + SIDE / 2];
    assert_true(fabs((double)depths[0] - 4) < 1e-5 && fabs((double)depths[1] - 6) < 1e-5);
    picture_free(&picture);
}

/* A ball covers what its particle takes from light: of optical depth t through the middle, the share
 * 1 - 2 (1 - (1 + t) exp(-t)) / t^2 of the disc. */
static void test_size_of_a_ball(void **state)
{
    static const double depths[] = {0.02, 0.2, 0.3, 1, 3, 20};

    (void)state;
    for (size_t i = 0; i < sizeof depths / sizeof depths[0]; i++) {
        double t = depths[i], share = 1 - 2 * (1 - (1 + t) * exp(-t)) / (t * t), covered = 0;
        char json[2048];
        snprintf(json, sizeof json, "%s%s[{\"centre\":[0,0,0],\"radius\":1,\"extinction\":%.9g}]}]}", SCENE BARE, STILL,
                 t / 2);
        struct picture picture = draw_text(json, 6 * SIDE, 6 * SIDE);
        for (size_t k = 0; k < (size_t)36 * SIDE * SIDE; k++)
            covered += (double)picture.smoke[k][3];
        double pixel = 2 * tan(20 * PI / 180) / (6 * SIDE), area = covered * pixel * pixel;
        double right = PI * share / (25 - share);
        printf("  optical depth %5.2f: %.5f of the tangent plane, in closed form %.5f\n", t, area, right);
        assert_true(fabs(area / right - 1) < (i == 0 ? 0.02 : 0.005)); /* the first has 740 pixels */
        picture_free(&picture);
    }
}

/* ---- the scene ---- */

#define WALL(z, soft)                                                                                                  \
    SCENE "\"mega\":{\"blur\":0,\"octaves\":0,\"soft\":" soft "},\"objects\":[{\"type\":\"box\",\"position\":[0,0," z  \
          "],\"size\":[9,9,0.2]}]," STILL DENSE "}"

static void test_scene_hides(void **state)
{
    static const struct {
        const char *json;
        double opacity;
    } cases[] = {
        {WALL("1.2", "0.01"), 0}, /* before the ball, whose front is at z = 1 */
        {WALL("0.4", "0.01"), 1}, /* in it */
        {WALL("-2", "0.01"), 1},
        {WALL("0.4", "2"), 0.25}, /* 0.5 m behind its front, of 2 m */
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct picture picture = draw_text(cases[i].json, SIDE, SIDE);
        printf("  wall %zu: opacity %.4f\n", i, middle(&picture, 3));
        assert_true(fabs(middle(&picture, 3) - cases[i].opacity) < 1e-3);
        picture_free(&picture);
    }
}

/* The smoke over the scene is what was asked for alone, over the scene without smoke. */
static void test_laid_over_the_scene(void **state)
{
    static const char json[] =
        SCENE "\"objects\":[{\"type\":\"plane\",\"position\":[0,-0.8,0],\"checker\":0.3}," /* */
              "{\"type\":\"sphere\",\"position\":[0.5,0.1,0.9],\"radius\":0.3}]," STILL DENSE "}";
    static const char *const sets[][2] = {{"thick.resolution=full", "method=mega"},
                                          {"thick.resolution=half", "method=mega"},
                                          {"thick.resolution=full", "method=none"}};
    const struct sf_renderer_options options = {
        .width = SIDE, .height = SIDE, .aovs = SF_AOV_SMOKE, .float_aovs = true, .float_color = true};
    float *color[3], *smoke[3] = {NULL};

    (void)state;
    for (size_t i = 0; i < 3; i++) {
        struct sf_scene *scene = NULL;
        const char *const over[] = {sets[i][0], sets[i][1], "thick.ground_shadow=false"};
        if (sf_scene_parse("test", json, strlen(json), over, 3, &kit_log, &scene) != SF_OK)
            fail_msg("%s", kit_message);
        struct stage stage = stage_with(scene, SIDE, SIDE);
        uint64_t ticket = 0;
        assert_int_equal(sf_renderer_set_options(stage.renderer, &options), SF_OK);
        assert_int_equal(sf_renderer_render(stage.renderer, 0, &ticket), SF_OK);
        assert_int_equal(sf_renderer_wait(stage.renderer, ticket, &stage.frame), SF_OK);
        color[i] = (float *)kit_copy(stage.frame.color_float, SIDE * SIDE);
        if (stage.frame.smoke_float)
            smoke[i] = (float *)kit_copy(stage.frame.smoke_float, SIDE * SIDE);
        stage_end(&stage);
    }
    for (size_t i = 0; i < 2; i++) {
        double worst = 0;
        for (size_t k = 0; k < (size_t)4 * SIDE * SIDE; k++) {
            double through = 1 - (double)smoke[i][k / 4 * 4 + 3];
            worst = fmax(worst, fabs((double)color[i][k] - (double)smoke[i][k] - through * (double)color[2][k]));
        }
        printf("  %s: %.1e from smoke over scene\n", sets[i][0], worst);
        assert_true(worst < (i == 0 ? 2e-3 : 0.1)); /* half: pictures take the plain way where nothing is cut */
    }
    for (size_t i = 0; i < 3; i++) {
        free(color[i]);
        free(smoke[i]);
    }
}

/* Smoke that fills the frame does so up to its border, blurred and displaced. */
static void test_border(void **state)
{
    static const char *const resolutions[] = {"full", "half", "quarter"};

    (void)state;
    for (size_t i = 0; i < 3; i++) {
        static const char json[] = SCENE STILL "[{\"centre\":[0,0,-8],\"radius\":9,\"extinction\":1e4}]}]}";
        struct sf_scene *scene = NULL;
        char set[64];
        const char *const sets[] = {set};
        snprintf(set, sizeof set, "thick.resolution=%s", resolutions[i]);
        if (sf_scene_parse("test", json, strlen(json), sets, 1, &kit_log, &scene) != SF_OK)
            fail_msg("%s", kit_message);
        struct stage stage = stage_with(scene, SIDE, SIDE);
        struct picture picture = stage_draw(&stage, 0);
        stage_end(&stage);
        double least = 1;
        for (size_t k = 0; k < (size_t)SIDE * SIDE; k++)
            least = fmin(least, (double)picture.smoke[k][3]);
        printf("  %s: opacity %.4f at least\n", resolutions[i], least);
        assert_true(least > 0.998); /* half floats */
        picture_free(&picture);
    }
}

/* ---- particles that die ---- */

static void test_deaths(void **state)
{
    struct stage stage = stage_of("dying", (const char *const[KIT_SETS]){"method=mega", "mega.speed=0"}, 120, 90);
    struct picture before = {0};
    double middle_life = 0, deaths = 0, last = 0;
    uint32_t live = 0, steps = 0;

    (void)state;
    for (uint32_t number = 5; number < 60; number++) {
        struct picture after = stage_draw(&stage, number);
        double change = 0;
        for (size_t i = 0; before.smoke && i < (size_t)120 * 90; i++)
            change = fmax(change, fabs((double)after.smoke[i][3] - (double)before.smoke[i][3]));
        if (stage.frame.live < live) {
            deaths = fmax(deaths, change);
            last = change;
            steps++;
        } else
            middle_life = fmax(middle_life, change);
        live = stage.frame.live;
        picture_free(&before);
        before = after;
    }
    picture_free(&before);
    stage_end(&stage);
    printf(
        "  largest change of a pixel's opacity: %.4f in %u steps with a death, %.4f in the last, %.4f in the others\n",
        deaths, steps, last, middle_life);
    assert_int_equal(live, 0);
    assert_true(steps > 5 && last < 0.02);
    assert_true(deaths < 1.2 * middle_life);
}

/* The eye flies through a ball: what it covers of the picture changes little from step to step. */
static void test_flight(void **state)
{
    struct stage stage = stage_of_text(SCENE BARE STILL DENSE "}", SIDE, SIDE);
    double before = 0, jump = 0, most = 0;

    (void)state;
    for (int step = 0; step <= 64; step++) {
        float z = 2.6f - 0.05f * (float)step;
        const struct sf_camera_view view = {
            .eye = {0, 0, z}, .target = {0, 0, z - 1}, .up = {0, 1, 0}, .fov = 40, .near_clip = 0.05f};
        sf_renderer_set_view(stage.renderer, &view);
        struct picture picture = stage_draw(&stage, 0);
        double covered = 0;
        for (size_t i = 0; i < (size_t)SIDE * SIDE; i++)
            covered += (double)picture.smoke[i][3] / (SIDE * SIDE);
        picture_free(&picture);
        jump = step > 0 ? fmax(jump, fabs(covered - before)) : 0;
        most = fmax(most, covered);
        before = covered;
    }
    stage_end(&stage);
    printf("  covered: %.3f at most, %.3f at the end; largest change in a step of a twentieth of the radius: %.3f\n",
           most, before, jump);
    assert_true(most > 0.99 && before <= 0 && jump < 0.2);
}

/* ---- the shower door ---- */

/* A heap of still smoke, seen through a long lens that has turned by `turn`, rad. */
static struct picture pan(const char *noise, double turn)
{
    char json[8192];
    int used =
        snprintf(json, sizeof json,
                 SCENE "\"mega\":{%s},\"camera\":{\"eye\":[0,0,12],\"target\":[%.9g,0,%.9g],\"fov\":14}," STILL "[",
                 noise, 12 * sin(turn), 12 - 12 * cos(turn));
    char *first = strstr(json, "\"camera\""), *second = strstr(first + 1, "\"camera\"");

    /* The second camera takes the first one's place: keys may not stand twice. */
    assert_non_null(second);
    memset(first, ' ', (size_t)(strstr(first, "\"lights\"") - first));
    for (uint32_t i = 0; i < 48; i++) {
        double angle = 2.399963 * i, from = 0.75 * sqrt(i / 48.0);
        used += snprintf(json + used, sizeof json - (size_t)used,
                         "%s{\"centre\":[%.4f,%.4f,%.4f],\"radius\":%.3f,\"extinction\":6}", i ? "," : "",
                         from * cos(angle), from * sin(angle), 0.25 * sin(7.0 * i), 0.16 + 0.08 * cos(5.0 * i));
    }
    snprintf(json + used, sizeof json - (size_t)used, "]}]}");
    return draw_text(json, 192, 192);
}

/* The picture's opacity where the ray of pixel (x, y) of a camera turned by `turn` meets it; linear between pixels. */
static double seen_at(const struct picture *picture, double turn, double x, double y, int channel)
{
    double tangent = tan(7 * PI / 180), u = ((x + 0.5) / 96 - 1) * tangent, v = ((y + 0.5) / 96 - 1) * tangent;
    double ahead = cos(turn) - u * sin(turn), across = u * cos(turn) + sin(turn);
    double px = (across / ahead / tangent + 1) * 96 - 0.5, py = (v / ahead / tangent + 1) * 96 - 0.5;
    int ix = (int)floor(px), iy = (int)floor(py);
    double fx = px - ix, fy = py - iy, sum = 0;

    for (int k = 0; k < 4; k++) {
        int ax = ix + (k & 1), ay = iy + (k >> 1);
        double weight = ((k & 1) ? fx : 1 - fx) * ((k >> 1) ? fy : 1 - fy);
        if (ax >= 0 && ay >= 0 && ax < 192 && ay < 192)
            sum += weight * (double)picture->smoke[ay * 192 + ax][channel];
    }
    return sum;
}

/* How much of what the noise does to the picture does not go with the smoke when the camera pans by `pixels`: rms of the
 * difference between the panned picture and the shifted first one, over the rms of what the noise changes. */
static double shower_door(const char *noise, double pixels)
{
    double turn = atan(pixels / 96 * tan(7 * PI / 180)), apart = 0, done = 0;
    struct picture plain = pan("\"octaves\":0", 0), first = pan(noise, 0), second = pan(noise, turn);

    for (int y = 0; y < 192; y++)
        for (int x = 0; x < 192; x++)
            for (int k = 0; k < 4; k++) {
                double shifted = seen_at(&first, turn, x, y, k);
                double off = (double)second.smoke[y * 192 + x][k] - shifted;
                double change = shifted - seen_at(&plain, turn, x, y, k);
                apart += off * off;
                done += change * change;
            }
    picture_free(&plain);
    picture_free(&first);
    picture_free(&second);
    return sqrt(apart / done);
}

static void test_shower_door(void **state)
{
    static const double pans[] = {4, 16, 40};

    (void)state;
    for (size_t i = 0; i < sizeof pans / sizeof pans[0]; i++) {
        double screen = shower_door("\"noise\":\"screen\"", pans[i]),
               world = shower_door("\"noise\":\"world\"", pans[i]);
        printf("  a pan of %2.0f px leaves behind: %.3f of the noise on the screen, %.3f of that in the world\n",
               pans[i], screen, world);
        assert_true(world < 0.12);
        assert_true(screen > (i == 0 ? 0.3 : 0.9));
    }
}

/* ---- the same bits ---- */

static void test_same_bits(void **state)
{
    struct picture pictures[2];

    (void)state;
    for (size_t i = 0; i < 2; i++) {
        struct stage stage = stage_of("dying", (const char *const[KIT_SETS]){"method=mega"}, 90, 70);
        pictures[i] = stage_draw(&stage, 12);
        stage_end(&stage);
    }
    assert_memory_equal(pictures[0].smoke, pictures[1].smoke, sizeof(float[4]) * 90 * 70);
    assert_memory_equal(pictures[0].depths, pictures[1].depths, sizeof(float[4]) * 90 * 70);
    picture_free(&pictures[0]);
    picture_free(&pictures[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_light_of_a_ball), cmocka_unit_test(test_size_of_a_ball),
        cmocka_unit_test(test_scene_hides),     cmocka_unit_test(test_laid_over_the_scene),
        cmocka_unit_test(test_deaths),          cmocka_unit_test(test_shower_door),
        cmocka_unit_test(test_same_bits),       cmocka_unit_test(test_flight),
        cmocka_unit_test(test_border),
    };
    return cmocka_run_group_tests(tests, kit_setup, kit_teardown);
}
