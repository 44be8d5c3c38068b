/* Billboards in an image smaller than the frame, against the same at the frame's size: a wall stands in the midst of the
 * smoke and hides the back of its right half, so that what is taken up wrongly shows along the wall's edge. And the passes
 * that draw the scene's depth before its colours change no bit of a frame. */
#include "thick_kit.h"

enum { SIDE = 96 };

#define EYE                                                                                                            \
    "{\"camera\":{\"eye\":[0,0,4],\"target\":[0,0,0],\"fov\":45},\"sim\":{\"capacity\":64},\"thick\":{\"detail\":0},"  \
    "\"lights\":[{\"type\":\"directional\",\"direction\":[-0.3,-1,-0.6],\"intensity\":6}],"                            \
    "\"environment\":{\"type\":\"color\",\"color\":[0.2,0.2,0.25]},\"medium\":{\"extinction\":0.7},"
/* From the middle of the picture to the right, its edges aslant. */
#define WALL                                                                                                           \
    "\"objects\":[{\"type\":\"box\",\"position\":[0.85,-0.1,0.4],\"size\":[1.6,1.6,0.1],\"rotation\":[0,0,17]}],"
#define SMOKE "\"emitters\":[{\"type\":\"list\",\"still\":true,\"particles\":["

/* Balls in front of the wall, in it, and behind it. */
static char *wall_scene(void)
{
    size_t room = 8192, used;
    char *text = malloc(room);

    assert_non_null(text);
    used = (size_t)snprintf(text, room, "%s", EYE WALL SMOKE);
    for (int i = 0; i < 27; i++)
        used += (size_t)snprintf(text + used, room - used, "%s{\"centre\":[%.2f,%.2f,%.2f],\"radius\":0.6}",
                                 i ? "," : "", 0.45 * (i % 3 - 1), 0.4 * (i / 3 % 3 - 1), 0.5 * (i / 9 - 1) + 0.3);
    snprintf(text + used, room - used, "]}]}");
    return text;
}

/* The smoke alone, and the scene's depth. */
struct view {
    float smoke[SIDE * SIDE][4];
    float depth[SIDE * SIDE];
};

static void draw(const char *method, const char *resolution, const char *upsample, struct view *view)
{
    char *text = wall_scene(), sets[3][64];
    const char *const given[] = {sets[0], sets[1], sets[2]};
    const struct sf_renderer_options options = {
        .width = SIDE, .height = SIDE, .aovs = SF_AOV_SMOKE, .float_aovs = true};
    struct sf_renderer *renderer = NULL;
    struct sf_scene *scene = NULL;
    struct sf_frame frame;
    uint64_t ticket;

    snprintf(sets[0], sizeof sets[0], "method=%s", method);
    snprintf(sets[1], sizeof sets[1], "thick.resolution=%s", resolution);
    snprintf(sets[2], sizeof sets[2], "billboard.upsample=%s", upsample);
    if (sf_scene_parse("wall", text, strlen(text), given, 3, &kit_log, &scene) != SF_OK ||
        sf_renderer_create(kit_device, scene, &options, &kit_log, &renderer) != SF_OK ||
        sf_renderer_render(renderer, 0, &ticket) != SF_OK || sf_renderer_wait(renderer, ticket, &frame) != SF_OK)
        fail_msg("%s", kit_message);
    memcpy(view->smoke, frame.smoke_float, sizeof view->smoke);
    memcpy(view->depth, frame.depth, sizeof view->depth);
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
    free(text);
    assert_int_equal(sf_device_validation_messages(kit_device), 0);
}

/* Is there, within two pixels, a step of the scene's depth? */
static bool at_edge(const struct view *view, int x, int y)
{
    float low = SF_NO_DEPTH, high = 0;

    for (int v = y - 2; v <= y + 2; v++)
        for (int u = x - 2; u <= x + 2; u++) {
            if (u < 0 || v < 0 || u >= SIDE || v >= SIDE)
                continue;
            low = fminf(low, view->depth[v * SIDE + u]);
            high = fmaxf(high, view->depth[v * SIDE + u]);
        }
    return high - low > 0.5f;
}

/* How far a picture is from the full one, in colour and opacity. */
struct apart {
    double rms;   /* over all pixels, over the full picture's own */
    double edge;  /* likewise over those at the wall's edges */
    double worst; /* of those, over the full picture's largest */
    int pixels;   /* at edges */
};

static struct apart compare(const struct view *full, const struct view *reduced)
{
    struct apart apart = {0};
    double square = 0, own = 0, edge_square = 0, edge_own = 0, peak = 0;

    for (int i = 0; i < SIDE * SIDE; i++) {
        bool edge = full->smoke[i][3] > 0 && at_edge(full, i % SIDE, i / SIDE);

        apart.pixels += edge;
        for (int k = 0; k < 4; k++) {
            double value = (double)full->smoke[i][k], off = fabs((double)reduced->smoke[i][k] - value);

            assert_true(isfinite(off));
            square += off * off;
            own += value * value;
            peak = fmax(peak, value);
            edge_square += edge ? off * off : 0;
            edge_own += edge ? value * value : 0;
            apart.worst = edge ? fmax(apart.worst, off) : apart.worst;
        }
    }
    apart.rms = sqrt(square / own);
    apart.edge = sqrt(edge_square / edge_own);
    apart.worst /= peak;
    return apart;
}

static void test_reduced(void **state)
{
    /* Where a surface makes a billboard fade, the wall's edge is a step in the smoke, and the look at depths must pay. */
    static const struct {
        const char *name;
        bool fades;
    } methods[] = {{"hard", false}, {"soft", true}, {"soft-contrast", true}, {"spherical", false}};
    static const struct {
        const char *resolution;
        double rms, edge, worst;
    } bounds[] = {{"half", 0.03, 0.03, 0.18}, {"quarter", 0.065, 0.09, 0.42}};
    static struct view full, careful, plain;

    (void)state;
    for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
        draw(methods[m].name, "full", "depth", &full);
        for (size_t r = 0; r < sizeof bounds / sizeof *bounds; r++) {
            draw(methods[m].name, bounds[r].resolution, "depth", &careful);
            draw(methods[m].name, bounds[r].resolution, "plain", &plain);
            struct apart with = compare(&full, &careful), without = compare(&full, &plain);

            print_message("%-14s %-8s rms %.4f, of %d pixels at edges %.4f, worst %.3f; plain %.4f, %.4f, %.3f\n",
                          methods[m].name, bounds[r].resolution, with.rms, with.pixels, with.edge, with.worst,
                          without.rms, without.edge, without.worst);
            assert_true(with.pixels > 400);
            assert_true(with.rms < bounds[r].rms);
            assert_true(with.edge < bounds[r].edge);
            assert_true(with.worst < bounds[r].worst);
            if (methods[m].fades)
                assert_true(without.edge > 1.9 * with.edge);
        }
    }
}

/* ---- the scene's depth before its colours ---- */

struct shot {
    uint16_t *color, *smoke;
    float *depth;
    size_t pixels;
};

static struct shot shoot(const char *name, const char *prepass)
{
    const char *root = getenv("SF_SOURCE_ROOT");
    char path[1024], set[64];
    const char *const sets[] = {"method=soft", set};
    const struct sf_renderer_options options = {.width = 120, .height = 80, .aovs = SF_AOV_SMOKE};
    struct sf_renderer *renderer = NULL;
    struct sf_scene *scene = NULL;
    struct sf_frame frame;
    uint64_t ticket;

    snprintf(path, sizeof path, "%s/scenes/%s.json", root ? root : ".", name);
    snprintf(set, sizeof set, "surfaces.prepass=%s", prepass);
    if (sf_scene_load(path, sets, 2, &kit_log, &scene) != SF_OK ||
        sf_renderer_create(kit_device, scene, &options, &kit_log, &renderer) != SF_OK ||
        sf_renderer_render(renderer, 6, &ticket) != SF_OK || sf_renderer_wait(renderer, ticket, &frame) != SF_OK)
        fail_msg("%s", kit_message);
    struct shot shot = {.pixels = (size_t)frame.width * frame.height};
    shot.color = malloc(shot.pixels * 8);
    shot.smoke = malloc(shot.pixels * 8);
    shot.depth = malloc(shot.pixels * 4);
    assert_true(shot.color && shot.smoke && shot.depth);
    memcpy(shot.color, frame.color, shot.pixels * 8);
    memcpy(shot.smoke, frame.smoke, shot.pixels * 8);
    memcpy(shot.depth, frame.depth, shot.pixels * 4);
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
    assert_int_equal(sf_device_validation_messages(kit_device), 0);
    return shot;
}

static void free_shot(struct shot *shot)
{
    free(shot->color);
    free(shot->smoke);
    free(shot->depth);
}

static void test_prepass(void **state)
{
    /* Planes, solids, meshes and a picture of the sky; nothing but meshes before a plane; nothing at all. */
    static const char *const scenes[] = {"tiny/all", "tiny/mesh", "tiny/latlong", "truth/one-puff"};
    static const char *const ways[] = {"again", "equal"};

    (void)state;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        struct shot beside = shoot(scenes[i], "none");

        for (size_t k = 0; k < 2; k++) {
            struct shot before = shoot(scenes[i], ways[k]);

            print_message("%s, %s\n", scenes[i], ways[k]);
            assert_memory_equal(beside.color, before.color, beside.pixels * 8);
            assert_memory_equal(beside.smoke, before.smoke, beside.pixels * 8);
            assert_memory_equal(beside.depth, before.depth, beside.pixels * 4);
            free_shot(&before);
        }
        free_shot(&beside);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reduced),
        cmocka_unit_test(test_prepass),
    };

    return cmocka_run_group_tests(tests, kit_setup, kit_teardown);
}
