/* The methods of flat and spherical billboards against what one particle is in closed form, and what all of them must do
 * whatever a particle is: soften edges, blend in order of depth and not of birth, premultiplied, turn their tiles. */
#include "../cpu/scratch.h"

#include <math.h>
#include "sfumato/sfumato.h"

#define COUNT(array) ((int)(sizeof(array) / sizeof(array)[0]))
enum { SIDE = 64, PIXELS = SIDE * SIDE };
static const double TANGENT = 0.36397023426620234; /* of half of 40 degrees */
static const char *const methods[] = {"hard", "soft", "soft-contrast", "spherical"};
static struct sf_device *device;

static void write_log(void *user, enum sf_log_level level, const char *message)
{
    (void)user;
    if (level <= SF_LOG_WARNING)
        fprintf(stderr, "%s\n", message);
}
static const struct sf_log test_log = {.write = write_log, .level = SF_LOG_WARNING};

struct picture {
    float smoke[PIXELS][4];
    float depths[PIXELS][4];
    float color[PIXELS][4];
};

/* A camera in the origin that looks along -z at what `rest`, members of a scene, has; frame `number`. */
static void draw(const char *rest, const char *const *sets, size_t set_count, uint32_t number, struct picture *picture)
{
    static const char *const text = "{\"camera\":{\"eye\":[0,0,0],\"target\":[0,0,-1],\"fov\":40,\"near\":0.1},"
                                    "\"environment\":{\"type\":\"color\",\"color\":[0.3,0.3,0.3],\"visible\":false,"
                                    "\"background\":[0,0,0]},\"thick\":{\"resolution\":\"full\",\"detail\":0},%s}";
    const struct sf_renderer_options options = {
        .width = SIDE, .height = SIDE, .aovs = SF_AOV_DEPTHS | SF_AOV_SMOKE, .float_aovs = true, .float_color = true};
    struct sf_renderer *renderer = NULL;
    struct sf_scene *scene = NULL;
    struct sf_frame frame;
    static char json[8192];
    uint64_t ticket;

    snprintf(json, sizeof json, text, rest);
    assert_int_equal(sf_scene_parse("test.json", json, strlen(json), sets, set_count, &test_log, &scene), SF_OK);
    assert_int_equal(sf_renderer_create(device, scene, &options, &test_log, &renderer), SF_OK);
    assert_int_equal(sf_renderer_render(renderer, number, &ticket), SF_OK);
    assert_int_equal(sf_renderer_wait(renderer, ticket, &frame), SF_OK);
    memcpy(picture->smoke, frame.smoke_float, sizeof picture->smoke);
    memcpy(picture->depths, frame.smoke_depths, sizeof picture->depths);
    memcpy(picture->color, frame.color_float, sizeof picture->color);
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
    assert_int_equal(sf_device_validation_messages(device), 0);
}

static void draw_with(const char *method, const char *rest, struct picture *picture)
{
    char set[64];
    const char *sets[] = {set};

    snprintf(set, sizeof set, "method=%s", method);
    draw(rest, sets, 1, 0, picture);
}

static double clamp01(double x)
{
    return x < 0 ? 0 : x > 1 ? 1 : x;
}

/* What one particle's pixel hides, straight from the formulas of METHODS B1-B4. View depth z, radius r, extinction s;
 * d: from the axis in the plane through the centre; scene: view depth of what is behind. */
static double opacity(const char *method, double z, double r, double s, double d, double scene)
{
    double w = d < r ? sqrt(r * r - d * d) : 0, whole = 1 - exp(-2 * s * w), x = clamp01((scene - z) / r);

    if (strcmp(method, "hard") == 0)
        return z < scene ? whole : 0;
    if (strcmp(method, "soft") == 0)
        return whole * x;
    if (strcmp(method, "soft-contrast") == 0)
        return whole * (x < 0.5 ? 0.5 * pow(2 * x, 2) : 1 - 0.5 * pow(2 * (1 - x), 2));
    double front = fmax(0.1, z - w), back = fmin(scene, z + w), pi = 3.14159265358979324;
    return d < r && back > front ? 1 - exp(-s / (1 - 3 * pi / 16) * (1 - d / r) * (back - front)) : 0;
}

/* One particle on the axis before a wall, the wall at several distances: every pixel. */
static void test_one_particle(void **state)
{
    static const double walls[] = {9, 4.45, 4.1, 3.8};
    static struct picture picture;

    (void)state;
    for (int m = 0; m < COUNT(methods); m++)
        for (int k = 0; k < COUNT(walls); k++) {
            char rest[512];
            double worst = 0, most = 0;

            snprintf(rest, sizeof rest,
                     "\"objects\":[{\"type\":\"plane\",\"position\":[0,0,%g],\"normal\":[0,0,1]}],\"emitters\":[{"
                     "\"type\":\"list\",\"still\":true,\"particles\":[{\"centre\":[0,0,-4],\"radius\":1,"
                     "\"extinction\":0.8}]}]",
                     -walls[k]);
            draw_with(methods[m], rest, &picture);
            for (int y = 0; y < SIDE; y++)
                for (int x = 0; x < SIDE; x++) {
                    double u = (x + 0.5 - SIDE / 2) * 2 / SIDE * TANGENT * 4,
                           v = (y + 0.5 - SIDE / 2) * 2 / SIDE * TANGENT * 4;
                    double right = opacity(methods[m], 4, 1, 0.8, sqrt(u * u + v * v), walls[k]);
                    double found = (double)picture.smoke[y * SIDE + x][3];

                    worst = fmax(worst, fabs(found - right));
                    worst = fmax(worst, fabs(1 - (double)picture.depths[y * SIDE + x][3] - right));
                    most = fmax(most, right);
                }
            if (worst > 2e-5)
                fail_msg("%s, wall at %g m: an opacity is wrong by %g", methods[m], walls[k], worst);
            assert_true(most > 0.2 || walls[k] < 4.5);
        }
}

/* A wall that leans through a particle: how far neighbouring pixels of a column differ. The wall is at 4 m in the
 * picture's middle, so that the line of intersection with a flat billboard crosses it there. */
static double largest_step(const char *method)
{
    static struct picture picture;
    double largest = 0;

    draw_with(method,
              "\"objects\":[{\"type\":\"plane\",\"position\":[0,0,-4],\"normal\":[0,1,1]}],\"emitters\":[{\"type\":"
              "\"list\",\"still\":true,\"particles\":[{\"centre\":[0,0,-4],\"radius\":1.2,\"extinction\":2}]}]",
              &picture);
    for (int y = SIDE / 2 - 8; y < SIDE / 2 + 8; y++)
        largest =
            fmax(largest,
                 fabs((double)(picture.smoke[y * SIDE + SIDE / 2][3] - picture.smoke[(y + 1) * SIDE + SIDE / 2][3])));
    return largest;
}

static void test_softness(void **state)
{
    (void)state;
    for (int m = 0; m < COUNT(methods); m++) {
        double step = largest_step(methods[m]);

        printf("  %s: a pixel's largest step across the line of intersection is %.3f\n", methods[m], step);
        if (strcmp(methods[m], "hard") == 0)
            assert_true(step > 0.9);
        else if (step > 0.12) /* the wall falls back 0.13 m from pixel to pixel there: a ninth of the radius */
            fail_msg("%s: a step of %g at the intersection", methods[m], step);
    }
}

/* A particle that comes nearer until it is behind the eye: what the middle of the picture shows has no jump, but for flat
 * billboards that do not fade. */
static double largest_jump(const char *method, const char *fade)
{
    static struct picture picture;
    char set[64], set_fade[64];
    const char *sets[] = {set, set_fade};
    double before = -1, largest = 0;

    snprintf(set, sizeof set, "method=%s", method);
    snprintf(set_fade, sizeof set_fade, "billboard.near_fade=%s", fade);
    for (int i = 0; i <= 24; i++) {
        char rest[512];

        snprintf(rest, sizeof rest,
                 "\"emitters\":[{\"type\":\"list\",\"still\":true,\"particles\":[{\"centre\":[0,0,%g],\"radius\":0.5,"
                 "\"extinction\":1.5}]}]",
                 -0.8 + 0.05 * i);
        draw(rest, sets, 2, 0, &picture);
        double now = (double)picture.smoke[PIXELS / 2 + SIDE / 2][3];

        largest = before < 0 ? 0 : fmax(largest, fabs(now - before));
        before = now;
    }
    return largest;
}

static void assert_in_bounds(const char *method, double jump)
{
    if (jump > 0.17)
        fail_msg("%s: a jump of %g where a particle passes the near plane", method, jump);
}

static void test_near_plane(void **state)
{
    (void)state;
    assert_true(largest_jump("hard", "0") > 0.7);
    assert_in_bounds("hard", largest_jump("hard", "1"));
    assert_in_bounds("spherical", largest_jump("spherical", "0"));
}

#define CROWD_LIGHT "\"lights\":[{\"type\":\"directional\",\"direction\":[1,-1,-0.5],\"intensity\":3}],"
static const char *const crowd[] = {
    "{\"centre\":[-0.3,0.2,-5],\"radius\":0.8,\"extinction\":2}",
    "{\"centre\":[0.4,0.1,-4.2],\"radius\":0.6,\"extinction\":1,\"rotation\":0.5}",
    "{\"centre\":[0,-0.4,-3.5],\"radius\":0.5,\"extinction\":3}",
    "{\"centre\":[0.1,0.5,-6],\"radius\":1,\"extinction\":0.7}",
    "{\"centre\":[-0.5,-0.2,-4.6],\"radius\":0.7,\"extinction\":1.4}",
};

/* The crowd, told from the `first` on and round, or backwards. */
static void draw_crowd(const char *method, int first, bool backwards, struct picture *picture)
{
    char rest[2048] = CROWD_LIGHT "\"emitters\":[{\"type\":\"list\",\"still\":true,\"particles\":[";
    int count = COUNT(crowd);

    for (int i = 0; i < count; i++) {
        int at = (first + (backwards ? count - i : i)) % count;

        strcat(strcat(rest, i > 0 ? "," : ""), crowd[at]);
    }
    strcat(rest, "]}]");
    draw_with(method, rest, picture);
}

static void test_any_order(void **state)
{
    static struct picture one, other;

    (void)state;
    for (int m = 0; m < COUNT(methods); m++) {
        double worst = 0, most = 0;

        draw_crowd(methods[m], 0, false, &one);
        for (int k = 0; k < 2; k++) {
            draw_crowd(methods[m], k ? 3 : 0, k == 0, &other);
            for (int i = 0; i < PIXELS; i++)
                for (int c = 0; c < 4; c++) {
                    worst = fmax(worst, fabs((double)(one.smoke[i][c] - other.smoke[i][c])));
                    most = fmax(most, (double)one.smoke[i][c]);
                }
        }
        assert_true(most > 0.3);
        if (worst > 2e-6) /* the light's way past the others is summed in another order */
            fail_msg("%s: another order of the list changes a pixel by %g", methods[m], worst);
    }
}

/* The nearer one lies over the farther one, whichever was born first. */
static void test_back_to_front(void **state)
{
    static const char *const lists[] = {"{\"centre\":[0,0,-3],\"radius\":0.5}", "{\"centre\":[0,0,-6],\"radius\":1}",
                                        "{\"centre\":[0,0,-3],\"radius\":0.5},{\"centre\":[0,0,-6],\"radius\":1}",
                                        "{\"centre\":[0,0,-6],\"radius\":1},{\"centre\":[0,0,-3],\"radius\":0.5}"};
    static struct picture pictures[4];

    (void)state;
    for (int m = 0; m < COUNT(methods); m++) {
        char set[64], rest[512];
        const char *sets[] = {set, "billboard.self_shadow=false"};

        snprintf(set, sizeof set, "method=%s", methods[m]);
        for (int k = 0; k < 4; k++) {
            snprintf(rest, sizeof rest,
                     "\"lights\":[{\"type\":\"point\",\"position\":[0,1,-3],\"intensity\":9}],\"medium\":{"
                     "\"extinction\":1.2},\"emitters\":[{\"type\":\"list\",\"still\":true,\"particles\":[%s]}]",
                     lists[k]);
            draw(rest, sets, 2, 0, &pictures[k]);
        }
        for (int k = 2; k < 4; k++) {
            const float *near = pictures[0].smoke[PIXELS / 2 + SIDE / 2],
                        *far = pictures[1].smoke[PIXELS / 2 + SIDE / 2];
            double right = (double)near[0] + (1 - (double)near[3]) * (double)far[0];
            double wrong = (double)far[0] + (1 - (double)far[3]) * (double)near[0];
            double found = (double)pictures[k].smoke[PIXELS / 2 + SIDE / 2][0];

            /* The environment's light depends a little on where the smoke's middle is. */
            assert_true(fabs(right - wrong) > 0.1);
            if (fabs(found - right) > 0.02)
                fail_msg("%s: two particles give %g, not %g", methods[m], found, right);
        }
    }
}

/* Over black the picture is the smoke, over white it is that and what the smoke lets through. */
static void test_premultiplied(void **state)
{
    static struct picture black, white;

    (void)state;
    for (int m = 0; m < COUNT(methods); m++) {
        char set[64], rest[2048];
        const char *sets[] = {set, "environment.background=1,1,1"};

        snprintf(set, sizeof set, "method=%s", methods[m]);
        snprintf(rest, sizeof rest,
                 CROWD_LIGHT "\"emitters\":[{\"type\":\"list\",\"still\":true,\"particles\":[%s,%s]}]", crowd[0],
                 crowd[2]);
        draw(rest, sets, 1, 0, &black);
        draw(rest, sets, 2, 0, &white);
        for (int i = 0; i < PIXELS; i++)
            for (int c = 0; c < 3; c++) {
                double smoke = (double)black.smoke[i][c], through = 1 - (double)black.smoke[i][3];

                assert_true(fabs((double)black.color[i][c] - smoke) < 1e-5);
                assert_true(fabs((double)white.color[i][c] - smoke - through) < 1e-5);
            }
    }
}

/* A tile turned by a right angle is the picture turned by a right angle. */
static void test_rotation(void **state)
{
    static struct picture upright, turned;
    static const char *const particle =
        "\"emitters\":[{\"type\":\"list\",\"still\":true,\"particles\":[{\"centre\":[0,0,-4],"
        "\"radius\":1.2,\"extinction\":2,\"tile\":1,\"rotation\":%s}]}]";

    (void)state;
    for (int m = 0; m < COUNT(methods); m++) {
        char set[64], rest[512];
        const char *sets[] = {set, "thick.detail=1"};
        double worst = 0, uneven = 0;

        snprintf(set, sizeof set, "method=%s", methods[m]);
        snprintf(rest, sizeof rest, particle, "0.3");
        draw(rest, sets, 2, 0, &upright);
        snprintf(rest, sizeof rest, particle, "1.8707963267948966"); /* and pi / 2 */
        draw(rest, sets, 2, 0, &turned);
        /* A few pixels look at the border of two texels: all but one in a hundred must agree. */
        int wrong = 0;
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                double a = (double)upright.smoke[y * SIDE + x][3];
                double b = (double)turned.smoke[(SIDE - 1 - x) * SIDE + y][3];
                double c = (double)turned.smoke[x * SIDE + SIDE - 1 - y][3];

                worst = fmax(worst, fmin(fabs(a - b), fabs(a - c)));
                uneven = fmax(uneven, fabs(a - (double)upright.smoke[x * SIDE + y][3]));
                wrong += fabs(a - c) > 1e-4 && fabs(a - b) > 1e-4;
            }
        assert_true(uneven > 0.1);
        if (wrong > PIXELS / 100)
            fail_msg("%s: turned by a right angle %d pixels differ, by %g at most", methods[m], wrong, worst);
    }
}

/* A million particles in one plane, of many colours: the same picture in every frame, since those of equal depth keep
 * their order. */
static void test_no_flicker(void **state)
{
    static struct picture one, other;
    const char *const sets[] = {"method=hard", "billboard.self_shadow=false", "thick.ground_shadow=false"};
    static const char *const rest =
        "\"sim\":{\"capacity\":1048576},\"lights\":[{\"type\":\"point\",\"position\":[0,0,-3.8],\"intensity\":1}],"
        "\"emitters\":[{\"type\":\"box\",\"position\":[0,0,-4],\"size\":[3,3,0],\"rate\":0,\"burst\":1048576,"
        "\"lifetime\":100000,\"speed\":0,\"growth\":0,\"particle_radius\":[0.01,0.1],\"fade_in\":0,"
        "\"fade_out\":0}]";
    double most = 0, least = 1e9;

    (void)state;
    draw(rest, sets, 3, 1, &one);
    draw(rest, sets, 3, 2, &other);
    for (int i = 0; i < PIXELS; i++) {
        most = fmax(most, (double)one.smoke[i][0]);
        least = fmin(least, (double)one.smoke[i][0]);
    }
    assert_true(most > 2 * least);
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < 4; c++)
            assert_true(one.smoke[i][c] == other.smoke[i][c]);
}

static int setup(void **state)
{
    const struct sf_device_options options = {.validate = true};
    enum sf_status status = sf_device_create(&options, &test_log, &device);

    if (status == SF_ERROR_DEVICE)
        exit(77);
    return status ? -1 : scratch_enter(state);
}

static int teardown(void **state)
{
    sf_device_destroy(&device);
    return scratch_leave(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one_particle), cmocka_unit_test(test_softness),      cmocka_unit_test(test_near_plane),
        cmocka_unit_test(test_any_order),    cmocka_unit_test(test_back_to_front), cmocka_unit_test(test_premultiplied),
        cmocka_unit_test(test_rotation),     cmocka_unit_test(test_no_flicker),
    };

    return cmocka_run_group_tests(tests, setup, teardown);
}
