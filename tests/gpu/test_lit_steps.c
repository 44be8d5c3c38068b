/* How many steps a ray through a puff's height field needs, and which pixels need more of them: both readings of Reis's
 * equation 5.2.5 held against very many steps, at their cost. Prints the table of docs/methods/lit-scattering.md. */
#include "thick_kit.h"

enum { SIDE = 128, TILE = 128, MANY = 256 };
static const double PI = 3.14159265358979323846;
static const double angles[] = {30, 60, 90, 120, 150}; /* between the ways to the light and to the eye, degrees */
enum { ANGLES = sizeof angles / sizeof *angles };
static const int most[] = {8, 16, 32};
enum { ROWS = sizeof most / sizeof *most };

enum reading { EVEN, GRAZING, FACING, READINGS };
static const char *const names[READINGS] = {"everywhere the same", "more where grazing", "more where facing"};

/* What is measured of a reading with at most so many steps. */
struct measured {
    double steps;          /* mean of the pixels */
    double errors[ANGLES]; /* of the radiance, root mean square over the truth's */
    double error;          /* mean of them */
};

/* What is drawn with: one renderer for all, so that an atlas is made once. */
static struct stage stage;

/* Four puffs, one of each tile, seen from afar. */
static struct picture draw(const char *kind, double angle, enum reading reading, int steps, int steps_min)
{
    char text[4096];

    snprintf(
        text, sizeof text,
        "{\"method\":\"lit-scattering\",\"camera\":{\"eye\":[0,0,40],\"target\":[0,0,0],\"fov\":5.72,\"near\":0.1},"
        "\"atlas\":{\"type\":\"made\",\"kind\":\"%s\",\"size\":%d},\"medium\":{\"albedo\":[1,1,1]},"
        "\"lights\":[{\"type\":\"directional\",\"direction\":[%.9g,%.9g,%.9g],\"shadows\":false}],"
        "\"thick\":{\"resolution\":\"full\",\"detail\":0,\"ambient\":0},\"lit\":{\"relief\":1},"
        "\"scattering\":{\"steps\":%d,\"steps_min\":%d,\"more\":\"%s\"},\"billboard\":{\"self_shadow\":false},"
        "\"sim\":{\"capacity\":4},\"emitters\":[{\"type\":\"list\",\"still\":true,\"particles\":["
        "{\"centre\":[-1,1,0],\"radius\":1,\"extinction\":2,\"tile\":0},"
        "{\"centre\":[1,1,0],\"radius\":1,\"extinction\":2,\"tile\":1},"
        "{\"centre\":[-1,-1,0],\"radius\":1,\"extinction\":2,\"tile\":2},"
        "{\"centre\":[1,-1,0],\"radius\":1,\"extinction\":2,\"tile\":3}]}]}",
        kind, TILE, -0.8 * sin(angle * PI / 180), -0.6 * sin(angle * PI / 180), -cos(angle * PI / 180), steps,
        steps_min, reading == FACING ? "facing" : "grazing");
    struct sf_scene *scene = NULL, *before = stage.scene;

    if (!before) {
        stage = stage_of_text(text, SIDE, SIDE);
        return stage_draw(&stage, 0);
    }
    if (sf_scene_parse("test", text, strlen(text), NULL, 0, &kit_log, &scene) != SF_OK ||
        sf_renderer_set_scene(stage.renderer, scene) != SF_OK)
        fail_msg("%s", kit_message);
    stage.scene = scene;
    sf_scene_destroy(&before);
    return stage_draw(&stage, 0);
}

static double error_of(const struct picture *picture, const struct picture *truth)
{
    double square = 0, sum = 0;

    for (size_t i = 0; i < (size_t)SIDE * SIDE; i++) {
        square += pow((double)picture->smoke[i][0] - (double)truth->smoke[i][0], 2);
        sum += pow((double)truth->smoke[i][0], 2);
    }
    return sqrt(square / sum);
}

/* Steps that 5.2.5 gives the atlas's texels with smoke, all seen along -z. */
static double mean_steps(const char *kind, enum reading reading, int steps, int steps_min)
{
    struct sf_texture_options options;
    struct sf_texture *texture = NULL;
    struct sf_texture_info info;
    double sum = 0, count = 0;

    sf_texture_options_init(&options);
    options.kind = kind;
    options.width = options.height = TILE;
    assert_int_equal(sf_texture_create(&options, NULL, NULL, &kit_log, &texture), SF_OK);
    sf_texture_describe(texture, &info);
    for (size_t i = 0; i < (size_t)info.width * info.height; i++)
        if (info.color[4 * i + 3] > 0) {
            double facing = fmin(fmax((double)info.shape[4 * i + 2], 0), 1);

            sum += floor(steps_min + (steps - steps_min) * (reading == FACING ? facing : 1 - facing) + 0.5);
            count++;
        }
    sf_texture_destroy(&texture);
    return sum / count;
}

static struct measured measure(const char *kind, enum reading reading, int steps, const struct picture truths[ANGLES])
{
    int steps_min = reading == EVEN ? steps : steps / 2;
    struct measured measured = {.steps = mean_steps(kind, reading, steps, steps_min)};

    for (size_t i = 0; i < ANGLES; i++) {
        struct picture picture = draw(kind, angles[i], reading, steps, steps_min);

        measured.errors[i] = error_of(&picture, &truths[i]);
        assert_true(measured.errors[i] > 1e-3); /* at every angle rays meet matter */
        measured.error += measured.errors[i] / ANGLES;
        picture_free(&picture);
    }
    printf("  %-10s %-20s at most %2d: %5.1f steps, error %.4f (", kind, names[reading], steps, measured.steps,
           measured.error);
    for (size_t i = 0; i < ANGLES; i++)
        printf("%s%.4f", i ? " " : "", measured.errors[i]);
    printf(")\n");
    return measured;
}

/* The error at a mean of so many steps: between two rows by their logarithms. */
static double error_at(const struct measured *below, const struct measured *above, double steps)
{
    double part = log(steps / below->steps) / log(above->steps / below->steps);

    return exp(log(below->error) + part * log(above->error / below->error));
}

/* More steps are better, and at the same mean number of them the cited reading is better than the printed one. */
static void compare(const char *kind)
{
    struct measured rows[READINGS][ROWS];
    struct picture truths[ANGLES];
    double even[READINGS];

    for (size_t i = 0; i < ANGLES; i++)
        truths[i] = draw(kind, angles[i], EVEN, MANY, MANY);
    for (int r = 0; r < READINGS; r++) {
        for (size_t i = 0; i < ROWS; i++)
            rows[r][i] = measure(kind, (enum reading)r, most[i], truths);
        for (size_t i = 1; i < ROWS; i++)
            assert_true(rows[r][i].error < 0.6 * rows[r][i - 1].error);
        even[r] = error_at(&rows[r][0], &rows[r][1], 8);
        printf("  %-10s %-20s at a mean of 8: error %.4f\n", kind, names[r], even[r]);
    }
    assert_true(even[GRAZING] < even[FACING]);
    assert_true(rows[EVEN][ROWS - 1].error < 0.02);
    for (size_t i = 0; i < ANGLES; i++)
        picture_free(&truths[i]);
}

static void test_readings(void **state)
{
    (void)state;
    compare("fbm");
    compare("dispersed");
    stage_end(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_readings)};

    return cmocka_run_group_tests(tests, kit_setup, kit_teardown);
}
