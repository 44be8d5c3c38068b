/* What the tests of billboards that stand for volumes (METHODS B5-B7) share: one particle against a closed form, pixel by
 * pixel, with validation: with a wall behind it, in it and before it, and with the near plane in it. */
#ifndef SF_TESTS_VOLUME_KIT_H
#define SF_TESTS_VOLUME_KIT_H

#include "../cpu/scratch.h"

#include <math.h>
#include "sfumato/sfumato.h"

enum { SIDE = 48, PIXELS = SIDE * SIDE };
static struct sf_device *device;
static char message[1024];

static inline void write_log(void *user, enum sf_log_level level, const char *text)
{
    (void)user;
    if (level <= SF_LOG_WARNING)
        snprintf(message, sizeof message, "%s", text);
}
static const struct sf_log test_log = {.write = write_log, .level = SF_LOG_WARNING};

/* ---- one particle ---- */

static const double RADIUS = 0.7, EXTINCTION = 2, CENTRE[3] = {0.2, -0.1, 0}, NEAR_PLANE = 0.1;

/* Where the eye stands on z, looking along -z, and where the wall does; a wall beyond -50 is none. */
struct place {
    double eye, wall;
};
static const struct place places[] = {
    {3, -100},  {3, -2},   {3, -0.55}, {3, -0.2},  {3, 0},     {3, 0.3},    {3, 0.65},
    {3, 0.9},                                                                            /* the wall moves to the eye */
    {0.75, -2}, {0.4, -2}, {0.1, -2},  {-0.2, -2}, {-0.5, -2}, {-0.59, -2}, {0.2, -0.3}, /* the eye moves through */
};

static inline struct sf_scene *parse(const char *json)
{
    struct sf_scene *scene = NULL;

    if (sf_scene_parse("test.json", json, strlen(json), NULL, 0, &test_log, &scene) != SF_OK)
        fail_msg("%s: %s", json, message);
    return scene;
}

/* `settings`: more members of the scene, each behind a comma. */
static inline struct sf_scene *scene_at(const struct place *place, const char *settings)
{
    char json[2048];

    snprintf(json, sizeof json,
             "{\"camera\":{\"eye\":[0,0,%g],\"target\":[0,0,%g],\"fov\":60,\"near\":%g},\"sim\":{\"capacity\":8},"
             "\"lights\":[{\"type\":\"directional\",\"direction\":[1,-0.5,-1]}],\"medium\":{\"g\":0.3},"
             "\"objects\":[{\"type\":\"plane\",\"position\":[0,0,%g],\"normal\":[0,0,1],\"collide\":false}],"
             "\"thick\":{\"resolution\":\"full\",\"detail\":0},\"emitters\":[{\"type\":\"list\",\"still\":true,"
             "\"particles\":[{\"centre\":[%g,%g,%g],\"radius\":%g,\"extinction\":%g,\"tile\":1,\"rotation\":0.6}]}]%s}",
             place->eye, place->eye - 1, NEAR_PLANE, place->wall, CENTRE[0], CENTRE[1], CENTRE[2], RADIUS, EXTINCTION,
             settings);
    return parse(json);
}

/* The smoke alone: premultiplied radiance and opacity, and the frame. Either may be NULL. */
static inline void draw(struct sf_scene *scene, float smoke[PIXELS][4], float color[PIXELS][4])
{
    const struct sf_renderer_options options = {
        .width = SIDE, .height = SIDE, .aovs = SF_AOV_SMOKE, .float_aovs = true, .float_color = true};
    struct sf_renderer *renderer = NULL;
    struct sf_frame frame;
    uint64_t ticket;

    if (sf_renderer_create(device, scene, &options, &test_log, &renderer) != SF_OK ||
        sf_renderer_render(renderer, 0, &ticket) != SF_OK || sf_renderer_wait(renderer, ticket, &frame) != SF_OK)
        fail_msg("%s", message);
    if (smoke)
        memcpy(smoke, frame.smoke_float, PIXELS * sizeof *smoke);
    if (color)
        memcpy(color, frame.color_float, PIXELS * sizeof *color);
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
    assert_int_equal(sf_device_validation_messages(device), 0);
}

/* What a closed form is given: the ray of unit view depth, the particle's centre (x right, y up, view depth), and the
 * view depth of the wall. */
struct view {
    double ray[2], centre[3], wall;
};

static inline struct view view_of(const struct place *place, size_t pixel)
{
    double tangent = tan(30 * 3.14159265358979323846 / 180);

    return (struct view){
        .ray = {(2 * ((double)(pixel % SIDE) + 0.5) / SIDE - 1) * tangent,
                (1 - 2 * ((double)(pixel / SIDE) + 0.5) / SIDE) * tangent},
        .centre = {CENTRE[0], CENTRE[1], place->eye - CENTRE[2]},
        .wall = place->wall < -50 ? 1e30 : place->eye - place->wall,
    };
}

static inline double clamp(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

/* The opacity; not a number where the test has no opinion. */
typedef double (*form)(const struct view *view);

/* How many pixels smoke covers in all places. */
static inline size_t compare(const char *settings, form wanted, double tolerance)
{
    static float smoke[PIXELS][4];
    size_t covered = 0;

    for (size_t p = 0; p < sizeof places / sizeof *places; p++) {
        draw(scene_at(&places[p], settings), smoke, NULL);
        for (size_t i = 0; i < PIXELS; i++) {
            struct view view = view_of(&places[p], i);
            double opacity = view.wall > NEAR_PLANE ? wanted(&view) : 0;

            if (isnan(opacity))
                continue;
            covered += opacity > 0.01;
            if (fabs((double)smoke[i][3] - opacity) > tolerance)
                fail_msg("%s: eye at %g, wall at %g: pixel (%zu, %zu) covers %.7f, not %.7f", settings, places[p].eye,
                         places[p].wall, i % SIDE, i / SIDE, (double)smoke[i][3], opacity);
        }
    }
    return covered;
}

/* ---- what all of these methods hold to ---- */

/* Over a black wall and over a white one: the smoke over it, premultiplied. */
static inline void check_over(const char *settings)
{
    static const char *const walls[] = {"0,0,0", "1,1,1"};
    static float smoke[PIXELS][4], bare[PIXELS][4], color[PIXELS][4];
    double most = 0;

    for (size_t w = 0; w < 2; w++) {
        char json[1024], none[1024];
        static const char *const text =
            "{\"camera\":{\"eye\":[0,0,3],\"target\":[0,0,0]},\"sim\":{\"capacity\":8},\"lights\":[{\"type\":"
            "\"directional\",\"direction\":"
            "[1,-0.5,-1]}],\"objects\":[{\"type\":\"plane\",\"position\":[0,0,-0.3],\"normal\":[0,0,1],\"albedo\":[%s]}"
            "]"
            ",\"thick\":{\"resolution\":\"full\",\"ground_shadow\":false},\"emitters\":[{\"type\":\"list\",\"still\":"
            "true,"
            "\"particles\":[{\"centre\":[0,0,0],\"radius\":0.7},{\"centre\":[0.3,0.2,0.4],\"radius\":0.4}]}]%s}";

        snprintf(json, sizeof json, text, walls[w], settings);
        snprintf(none, sizeof none, text, walls[w], ",\"method\":\"none\"");
        draw(parse(none), NULL, bare);
        draw(parse(json), smoke, color);
        for (size_t i = 0; i < PIXELS; i++)
            for (size_t c = 0; c < 3; c++) {
                double over = (double)smoke[i][c] + (1 - (double)smoke[i][3]) * (double)bare[i][c];

                /* The frame has 16 bits. */
                assert_true(fabs((double)color[i][c] - over) <= 1e-3 * fmax(over, 0.1));
                most = fmax(most, (double)smoke[i][3]);
            }
    }
    assert_true(most > 0.5);
}

/* Whatever order the particles come in, the picture is one. */
static inline void check_order(const char *settings)
{
    enum { COUNT = 12 };
    static float first[PIXELS][4], other[PIXELS][4];

    for (size_t turn = 0; turn < 3; turn++) {
        char json[4096];
        int at = snprintf(json, sizeof json,
                          "{\"camera\":{\"eye\":[0,0,4],\"target\":[0,0,0]},\"sim\":{\"capacity\":16},\"lights\":"
                          "[{\"type\":\"directional\",\"direction\":[1,-0.5,-1]}],\"thick\":{\"resolution\":\"full\"},"
                          "\"emitters\":[{\"type\":"
                          "\"list\",\"still\":true,\"particles\":[");

        for (int k = 0; k < COUNT; k++) {
            int i = turn == 0 ? k : turn == 1 ? COUNT - 1 - k : k * 5 % COUNT;

            at += snprintf(json + at, sizeof json - (size_t)at,
                           "%s{\"centre\":[%g,%g,%g],\"radius\":%g,\"tile\":%d,\"rotation\":%d}", k ? "," : "",
                           0.7 * sin(i * 2.1), 0.7 * cos(i * 3.7), 0.9 * sin(i * 5.3 + 1), 0.3 + 0.02 * i, i % 4, i);
        }
        snprintf(json + at, sizeof json - (size_t)at, "]}]%s}", settings);
        draw(parse(json), turn ? other : first, NULL);
        for (size_t i = 0; turn && i < PIXELS; i++)
            for (size_t c = 0; c < 4; c++)
                assert_float_equal(first[i][c], other[i][c], 2e-6);
    }
}

static inline int setup(void **state)
{
    const struct sf_device_options options = {.validate = true};
    enum sf_status status = sf_device_create(&options, &test_log, &device);

    if (status == SF_ERROR_DEVICE)
        exit(77);
    return status ? -1 : scratch_enter(state);
}

static inline int teardown(void **state)
{
    sf_device_destroy(&device);
    return scratch_leave(state);
}

#endif
