/* Pictures of the scene without smoke, pixel by pixel against the CPU's own (scene_twin.h), with validation. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>

#include "scene_twin.h"
#include "sfumato/sfumato.h"

static struct sf_device *device;

static void write_log(void *user, enum sf_log_level level, const char *message)
{
    (void)user;
    if (level <= SF_LOG_WARNING)
        fprintf(stderr, "%s\n", message);
}
static const struct sf_log test_log = {.write = write_log, .level = SF_LOG_WARNING};

struct picture {
    struct sf_scene *scene;
    struct sf_renderer *renderer;
    struct sf_frame frame;
};

static struct picture draw(const char *json, uint32_t width, uint32_t height)
{
    struct picture picture = {NULL, NULL, {0}};
    uint64_t ticket = 0;
    char name[1024];
    const char *root = getenv("SF_SOURCE_ROOT");
    const struct sf_renderer_options options = {.width = width, .height = height, .float_color = true};

    snprintf(name, sizeof name, "%s/scenes/tiny/test.json", root ? root : "."); /* where files are looked for */
    if (sf_scene_parse(name, json, strlen(json), NULL, 0, &test_log, &picture.scene) != SF_OK)
        fail_msg("%s", json);
    assert_int_equal(sf_renderer_create(device, picture.scene, &options, &test_log, &picture.renderer), SF_OK);
    assert_int_equal(sf_renderer_render(picture.renderer, 0, &ticket), SF_OK);
    assert_int_equal(sf_renderer_wait(picture.renderer, ticket, &picture.frame), SF_OK);
    return picture;
}

static void drop(struct picture *picture)
{
    sf_renderer_destroy(&picture->renderer);
    sf_scene_destroy(&picture->scene);
    assert_int_equal(sf_device_validation_messages(device), 0);
}

static bool close_to(double a, double b, double relative, double absolute)
{
    return fabs(a - b) <= absolute + relative * fabs(b); /* false for NaN */
}

/* An edge runs through the pixel's middle, as near as rounding: the object or the face is in doubt. */
static bool in_doubt(const struct sf_scene *scene, uint32_t width, uint32_t height, uint32_t x, uint32_t y,
                     const struct twin_hit *middle)
{
    double unused[3];

    for (int k = 0; k < 4; k++) {
        double dx = k & 1 ? 2e-3 : -2e-3, dy = k & 2 ? 2e-3 : -2e-3;
        struct twin_hit hit = twin_pixel(scene, width, height, x + 0.5 + dx, y + 0.5 + dy, false, unused);
        if (hit.object != middle->object || (hit.object >= 0 && twin_dot(hit.normal, middle->normal) < 0.99))
            return true;
    }
    return false;
}

/* Every pixel: depth to 1e-4 (towards the horizon rays are nearly level, and single precision gives less), radiance to
 * 1e-3. Few may be in doubt. */
static void compare(const char *what, const char *json, uint32_t width, uint32_t height)
{
    struct picture picture = draw(json, width, height);
    uint32_t doubtful = 0, surface = 0;
    char fault[512] = "";

    for (uint32_t y = 0; y < height && !fault[0]; y++) {
        for (uint32_t x = 0; x < width && !fault[0]; x++) {
            size_t pixel = (size_t)y * width + x;
            const float *got = picture.frame.color_float + 4 * pixel;
            double want[3];
            struct twin_hit hit = twin_pixel(picture.scene, width, height, x + 0.5, y + 0.5, false, want);
            bool good = close_to(picture.frame.depth[pixel], hit.t, 1e-4 + 3e-7 * hit.t, 0) && got[3] == 1.0f;
            for (int c = 0; c < 3; c++)
                good = good && close_to(got[c], want[c], 1e-3, 2e-4);
            surface += hit.object >= 0;
            if (good)
                continue;
            doubtful++;
            if (!in_doubt(picture.scene, width, height, x, y, &hit))
                snprintf(fault, sizeof fault, "pixel %u, %u: depth %g, not %g; color %g %g %g %g, not %g %g %g", x, y,
                         picture.frame.depth[pixel], hit.t, got[0], got[1], got[2], got[3], want[0], want[1], want[2]);
        }
    }
    drop(&picture);
    if (fault[0])
        fail_msg("%s: %s", what, fault);
    if (doubtful * 200 > width * height || surface == 0)
        fail_msg("%s: of %u pixels with surfaces %u are in doubt", what, surface, doubtful);
}

#define HEAD   "{\"method\":\"none\","
#define CAMERA "\"camera\":{\"eye\":[2.1,1.6,3.2],\"target\":[0.1,0.4,-0.2],\"fov\":50},"
#define SUN                                                                                                            \
    "{\"type\":\"directional\",\"direction\":[-1,-2,-0.7],\"color\":[1,0.9,0.8],\"intensity\":3,\"shadows\":false}"
#define BULB "{\"type\":\"point\",\"position\":[-1.5,2.2,1],\"color\":[0.3,0.6,1],\"intensity\":9,\"shadows\":false}"
#define SPOT                                                                                                           \
    "{\"type\":\"spot\",\"position\":[1.5,3,1.5],\"direction\":[-0.5,-1,-0.5],\"inner\":12,\"outer\":25,"              \
    "\"intensity\":30,\"shadows\":false}"
#define DARK "\"environment\":{\"type\":\"color\",\"color\":[0,0,0]},"

static void test_plane(void **state)
{
    (void)state;
    compare("plane", HEAD CAMERA "\"lights\":[" SUN "],\"objects\":[{\"type\":\"plane\",\"albedo\":[0.5,0.4,0.3]}]}",
            160, 120);
    compare("checker",
            HEAD CAMERA
            "\"lights\":[" SUN
            "],\"objects\":[{\"type\":\"plane\",\"albedo\":[0.8,0.4,0.3],\"albedo2\":[0.1,0.2,0.5],\"checker\":0.37,"
            "\"position\":[0.1,-0.2,0.3],\"normal\":[0.1,1,0.05]}]}",
            160, 120);
    /* A corner of a room: three planes, each hiding parts of the others. */
    compare(
        "room",
        HEAD CAMERA
        "\"lights\":[" BULB "],\"objects\":[{\"type\":\"plane\",\"checker\":1},"
        "{\"type\":\"plane\",\"position\":[0,0,-2],\"normal\":[0.2,0.1,1],\"albedo\":[0.7,0.2,0.2],\"checker\":0.5},"
        "{\"type\":\"plane\",\"position\":[-2,0,0],\"normal\":[1,0,0],\"albedo\":[0.2,0.7,0.2]}]}",
        160, 120);
    /* From below: the side that faces the eye is lit. */
    compare("underside",
            HEAD "\"camera\":{\"eye\":[0,-1,3],\"target\":[0,0,0]},\"lights\":[{\"type\":\"point\",\"position\":[0,-0."
                 "8,0.5],\"intensity\":4,"
                 "\"shadows\":false}],\"objects\":[{\"type\":\"plane\"}]}",
            96, 96);
    /* The plane comes nearer than the near plane below, and the environment shows there. */
    compare("near",
            HEAD "\"camera\":{\"eye\":[0,0.3,3],\"target\":[0,0,0],\"near\":0.9,\"fov\":70},\"lights\":[" SUN
                 "],\"objects\":[{\"type\":\"plane\"}]}",
            96, 96);
}

static void test_shapes(void **state)
{
    (void)state;
    compare("sphere",
            HEAD CAMERA DARK "\"lights\":[" SUN
                             "],\"objects\":[{\"type\":\"sphere\",\"position\":[0,0.4,0],\"radius\":0.7}]}",
            128, 128);
    compare(
        "box",
        HEAD CAMERA
        "\"lights\":[" SUN
        "],\"objects\":[{\"type\":\"box\",\"position\":[0,0.4,0],\"size\":[0.5,0.9,1.3],\"rotation\":[20,35,-50]}]}",
        128, 128);
    compare("box of the axes",
            HEAD "\"camera\":{\"eye\":[0,0,3],\"target\":[0,0,0]},\"lights\":[" SUN
                 "],\"objects\":[{\"type\":\"box\"}]}",
            128, 128);
    compare("cylinder",
            HEAD CAMERA "\"lights\":[" SUN
                        "],\"objects\":[{\"type\":\"cylinder\",\"position\":[0,0.4,0],\"radius\":0.4,\"height\":1.5,"
                        "\"rotation\":[40,10,70]}]}",
            128, 128);
    compare("disc",
            HEAD CAMERA "\"lights\":[" SUN
                        "],\"objects\":[{\"type\":\"cylinder\",\"position\":[0,0.4,0],\"radius\":0.9,\"height\":0.1}]}",
            128, 128);
    /* All at once, cutting into each other and the ground, far from the origin's scale. */
    compare("together",
            HEAD CAMERA "\"lights\":[" SUN "," BULB "," SPOT
                        "],\"objects\":[{\"type\":\"sphere\",\"position\":[0,0.2,0],\"radius\":0.6},"
                        "{\"type\":\"plane\",\"checker\":0.5},{\"type\":\"box\",\"position\":[0.4,0.3,0.2],"
                        "\"rotation\":[0,30,10],\"albedo\":[0.9,0.1,0.1]},"
                        "{\"type\":\"cylinder\",\"position\":[-0.6,0.5,0.3],\"radius\":0.3,\"height\":1.4,\"rotation\":"
                        "[0,0,25],\"albedo\":[0.1,0.9,0.1]},"
                        "{\"type\":\"sphere\",\"position\":[0,0.9,-0.3],\"radius\":0.35,\"albedo\":[0.1,0.1,0.9]}]}",
            200, 150);
}

static void test_lights(void **state)
{
    static const char *const lights[] = {
        SUN, BULB, SPOT, SUN "," BULB, BULB "," SPOT, SPOT "," SUN "," BULB, SUN "," BULB "," SPOT "," SUN "," BULB};
    char json[4096];

    (void)state;
    for (size_t i = 0; i < sizeof lights / sizeof lights[0]; i++) {
        snprintf(json, sizeof json,
                 HEAD CAMERA DARK
                 "\"lights\":[%s],\"objects\":[{\"type\":\"plane\"},{\"type\":\"sphere\",\"position\":[0.3,0.4,0],"
                 "\"radius\":0.5},"
                 "{\"type\":\"box\",\"position\":[-1,0.3,0],\"size\":[0.6,0.6,0.6],\"rotation\":[0,20,0]}]}",
                 lights[i]);
        compare(lights[i], json, 96, 72);
    }
}

/* Closed forms at single pixels, without the twin: E cos / pi times albedo. */
static void test_irradiance(void **state)
{
    static const struct {
        const char *light;
        double radiance; /* of albedo 1, straight below at distance 2 */
    } cases[] = {
        {"{\"type\":\"directional\",\"direction\":[0,-1,0],\"intensity\":3,\"shadows\":false}", 3 / 3.14159265358979},
        {"{\"type\":\"directional\",\"direction\":[0,-1,1],\"intensity\":3,\"shadows\":false}",
         3 / 3.14159265358979 * 0.70710678},
        {"{\"type\":\"directional\",\"direction\":[0,1,0],\"intensity\":3,\"shadows\":false}", 0},
        {"{\"type\":\"point\",\"position\":[0,2,0],\"intensity\":8,\"shadows\":false}", 8 / 4.0 / 3.14159265358979},
        {"{\"type\":\"spot\",\"position\":[0,2,0],\"direction\":[0,-1,0],\"intensity\":8,\"shadows\":false}",
         8 / 4.0 / 3.14159265358979},
        {"{\"type\":\"spot\",\"position\":[0,2,0],\"direction\":[1,-1,0],\"intensity\":8,\"shadows\":false}", 0},
    };
    char json[1024];

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        snprintf(json, sizeof json,
                 HEAD DARK "\"camera\":{\"eye\":[0,2.5,2],\"target\":[0,0,0]},\"lights\":[%s],\"objects\":[{\"type\":"
                           "\"plane\",\"albedo\":[1,1,1]}]}",
                 cases[i].light);
        struct picture picture = draw(json, 41, 41);
        float got = picture.frame.color_float[4 * (20 * 41 + 20)];
        if (!close_to(got, cases[i].radiance, 1e-4, 1e-6))
            fail_msg("%s: %g, not %g", cases[i].light, got, cases[i].radiance);
        drop(&picture);
    }
}

static void test_inside(void **state)
{
    (void)state;
    /* Within a box, a cylinder and a sphere; within the box around a cylinder but not in it; cut open by the near
     * plane. */
    compare("in a box",
            HEAD "\"camera\":{\"eye\":[0.2,0.1,0.5],\"target\":[0,0,0],\"fov\":90},\"lights\":[" BULB
                 "],\"objects\":[{\"type\":\"box\",\"size\":[4,3,5],"
                 "\"rotation\":[0,20,0]},{\"type\":\"sphere\",\"position\":[0,0,-1],\"radius\":0.3}]}",
            96, 96);
    compare("in a cylinder",
            HEAD "\"camera\":{\"eye\":[0.2,0.1,0.5],\"target\":[0,0,0],\"fov\":90},\"lights\":[" BULB
                 "],\"objects\":[{\"type\":\"cylinder\","
                 "\"radius\":2,\"height\":3}]}",
            96, 96);
    compare("in a sphere",
            HEAD "\"camera\":{\"eye\":[0.2,0.1,0.5],\"target\":[0,0,0],\"fov\":90},\"lights\":[" BULB
                 "],\"objects\":[{\"type\":\"sphere\",\"radius\":3}]}",
            96, 96);
    compare("beside a cylinder",
            HEAD "\"camera\":{\"eye\":[0.95,0,0.95],\"target\":[0,0,0],\"fov\":70},\"lights\":[" SUN
                 "],\"objects\":[{\"type\":\"cylinder\",\"radius\":1,"
                 "\"height\":1}]}",
            96, 96);
    compare("cut open",
            HEAD "\"camera\":{\"eye\":[0,0.5,2],\"target\":[0,0,0],\"near\":1.6},\"lights\":[" SUN
                 "],\"objects\":[{\"type\":\"sphere\",\"radius\":0.7}]}",
            96, 96);
}

static void test_environment(void **state)
{
    (void)state;
#define BALL "\"objects\":[{\"type\":\"sphere\",\"radius\":0.8}]}"
    compare("sky", HEAD "\"camera\":{\"eye\":[0,0,3],\"target\":[0,0,0],\"fov\":120}," BALL, 96, 96);
    compare("color", HEAD "\"environment\":{\"type\":\"color\",\"color\":[0.2,0.5,0.1],\"intensity\":2}," BALL, 64, 64);
    compare("background",
            HEAD "\"environment\":{\"type\":\"sky\",\"visible\":false,\"background\":[0.1,0.2,0.3]}," BALL, 64, 64);
}

/* A panorama is kept as halves, and its texels are not followed to the last bit by a sampler. */
static void test_panorama(void **state)
{
    struct picture picture = draw(
        HEAD "\"camera\":{\"eye\":[0,0,3],\"target\":[0.5,0.4,0],\"fov\":120},\"environment\":{\"type\":\"latlong\","
             "\"file\":\"../assets/dusk.hdr\",\"rotation\":70,\"intensity\":1.5}," BALL,
        96, 96);
    double worst = 0;

    (void)state;
    for (uint32_t y = 0; y < 96; y++) {
        for (uint32_t x = 0; x < 96; x++) {
            double want[3];
            twin_pixel(picture.scene, 96, 96, x + 0.5, y + 0.5, false, want);
            for (int c = 0; c < 3; c++)
                worst = fmax(worst, fabs(picture.frame.color_float[4 * (y * 96 + x) + c] - want[c]) / (0.05 + want[c]));
        }
    }
    if (worst > 0.02)
        fail_msg("the panorama is off by %g", worst);
    drop(&picture);
}

/* No environment, black behind: alpha says where nothing is. */
static void test_alpha(void **state)
{
    struct picture picture = draw(
        HEAD
        "\"camera\":{\"eye\":[0,0,3],\"target\":[0,0,0]},\"environment\":{\"type\":\"sky\",\"visible\":false}," BALL,
        33, 33);

    (void)state;
    assert_true(picture.frame.color_float[3] == 0.0f && picture.frame.color_float[0] == 0.0f);
    assert_true(picture.frame.color_float[4 * (16 * 33 + 16) + 3] == 1.0f);
    assert_true(picture.frame.depth[0] == SF_NO_DEPTH);
    drop(&picture);
}

/* The share of light 0 that arrives at each pixel with a lit surface, against sharp shadows: equal a few pixels away
 * from their edges. */
static void test_shadows(void **state)
{
    static const char *const lights[] = {
        "{\"type\":\"directional\",\"direction\":[-1,-1.4,-0.5],\"intensity\":3}",
        "{\"type\":\"point\",\"position\":[1.5,2.5,0.5],\"intensity\":20}",
        "{\"type\":\"spot\",\"position\":[2.5,2.5,0.5],\"direction\":[-2.5,-2.3,-0.5],\"inner\":30,\"outer\":35,"
        "\"intensity\":30}",
    };
    enum { SIDE = 240, MARGIN = 3 };
    static signed char lit[SIDE][SIDE]; /* -1: no surface that the light reaches */

    (void)state;
    for (size_t i = 0; i < sizeof lights / sizeof lights[0]; i++) {
        char json[2048];
        uint32_t dark = 0, bright = 0, wrong = 0;
        snprintf(
            json, sizeof json,
            HEAD DARK
            "\"camera\":{\"eye\":[3.2,2,4.2],\"target\":[0,0.6,0]},\"lights\":[%s],\"objects\":[{\"type\":\"plane\"},"
            "{\"type\":\"sphere\",\"position\":[-0.9,0.5,0.3]},{\"type\":\"box\",\"position\":[0.7,0.4,-0.4],\"size\":["
            "0.8,0.8,0.8],"
            "\"rotation\":[0,30,0]},{\"type\":\"cylinder\",\"position\":[0.4,0.8,0.9],\"radius\":0.25,\"height\":0.7}]"
            "}",
            lights[i]);
        struct picture picture = draw(json, SIDE, SIDE);
        for (uint32_t y = 0; y < SIDE; y++) {
            for (uint32_t x = 0; x < SIDE; x++) {
                double open[3], sharp[3];
                struct twin_hit hit = twin_pixel(picture.scene, SIDE, SIDE, x + 0.5, y + 0.5, false, open);
                twin_pixel(picture.scene, SIDE, SIDE, x + 0.5, y + 0.5, true, sharp);
                lit[y][x] = hit.object < 0 || open[0] < 0.02 ? -1 : sharp[0] > 0;
            }
        }
        for (int y = MARGIN; y < SIDE - MARGIN; y++) {
            for (int x = MARGIN; x < SIDE - MARGIN; x++) {
                double open[3];
                bool clear = lit[y][x] >= 0;
                for (int k = 0; k < (2 * MARGIN + 1) * (2 * MARGIN + 1); k++)
                    clear =
                        clear && lit[y + k / (2 * MARGIN + 1) - MARGIN][x + k % (2 * MARGIN + 1) - MARGIN] == lit[y][x];
                if (!clear)
                    continue;
                twin_pixel(picture.scene, SIDE, SIDE, x + 0.5, y + 0.5, false, open);
                double share = picture.frame.color_float[4 * (y * SIDE + x)] / open[0];
                dark += !lit[y][x];
                bright += lit[y][x];
                wrong += !close_to(share, lit[y][x], 0, 0.1);
            }
        }
        drop(&picture);
        if (dark < 300 || bright < 5000 || wrong * 1000 > bright)
            fail_msg("%s: of %u dark and %u bright pixels %u are wrong", lights[i], dark, bright, wrong);
    }
}

/* Optical depth of the sphere about (0, 2, 0) with radius 0.8 and extinction 1.5 on the way from the light to x. */
static double smoke_depth(const struct sf_light *light, const double x[3])
{
    double irradiance[3], to[3], distance, from[3] = {x[0], x[1] - 2, x[2]};

    twin_light(light, x, irradiance, to, &distance);
    double along = -twin_dot(from, to), apart = twin_dot(from, from) - along * along;
    return apart < 0.64 ? 1.5 * 2 * sqrt(0.64 - apart) : 0;
}

/* Smoke's shadow on the ground is exp(-optical depth), for each kind of light; none for a light or method told so. */
static void test_smoke_shadow(void **state)
{
    static const struct {
        const char *light, *thick;
        bool shadow;
    } cases[] = {
        {"{\"type\":\"directional\",\"direction\":[1,-1,0.2],\"intensity\":3}", "", true},
        {"{\"type\":\"point\",\"position\":[-1.5,4,0],\"intensity\":60}", "", true},
        {"{\"type\":\"spot\",\"position\":[-1.5,4,0],\"direction\":[1.5,-2,0],\"inner\":40,\"outer\":50,\"intensity\":"
         "60}",
         "", true},
        {"{\"type\":\"directional\",\"direction\":[1,-1,0.2],\"intensity\":3,\"shadows\":false}", "", false},
        {"{\"type\":\"directional\",\"direction\":[1,-1,0.2],\"intensity\":3}", ",\"ground_shadow\":false", false},
    };
    enum { SIDE = 128 };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char json[2048];
        uint32_t shadowed = 0;
        double worst = 0, sum = 0;
        snprintf(json, sizeof json,
                 "{\"method\":\"thick\",\"thick\":{\"resolution\":\"full\",\"detail\":0,\"light_blur\":0,\"light_"
                 "size\":1024%s}," DARK "\"camera\":{\"eye\":[2.2,1.8,1.8],\"target\":[2.1,0,0.2],\"fov\":50},"
                 "\"lights\":[%s],\"objects\":[{\"type\":\"plane\"}],"
                 "\"emitters\":[{\"type\":\"list\",\"still\":true,\"particles\":[{\"centre\":[0,2,0],\"radius\":0.8,"
                 "\"extinction\":1.5}]}]}",
                 cases[i].thick, cases[i].light);
        struct picture picture = draw(json, SIDE, SIDE);
        for (uint32_t y = 0; y < SIDE; y++) {
            for (uint32_t x = 0; x < SIDE; x++) {
                double open[3], eye[3], way[3], at[3];
                struct twin_hit hit = twin_pixel(picture.scene, SIDE, SIDE, x + 0.5, y + 0.5, false, open);
                if (hit.object < 0 || open[0] < 0.02)
                    continue;
                twin_ray(picture.scene, 0, SIDE, SIDE, x + 0.5, y + 0.5, eye, way);
                for (int k = 0; k < 3; k++)
                    at[k] = eye[k] + hit.t * way[k];
                double depth = smoke_depth(&picture.scene->lights[0], at);
                double share = picture.frame.color_float[4 * (y * SIDE + x)] / open[0];
                shadowed += depth > 0.5;
                double error = fabs(share - (cases[i].shadow ? exp(-depth) : 1));
                worst = fmax(worst, error);
                sum += error;
            }
        }
        drop(&picture);
        /* At the rim of the sphere, where its depth is steepest, a texel is sqrt(2 r texel) of chord, times 2 and the extinction:
         * 0.2 off at most. The mean is next to nothing. */
        if (shadowed < 500 || worst > (cases[i].shadow ? 0.2 : 1e-3) || sum > 5e-4 * shadowed)
            fail_msg("%s%s: %u pixels in shadow, off by up to %g, %g in the mean", cases[i].light, cases[i].thick,
                     shadowed, worst, sum / shadowed);
    }
}

/* Depth of a mesh among other objects, against its triangles one by one. */
static void test_mesh(void **state)
{
    struct picture picture =
        draw(HEAD CAMERA "\"lights\":[" SUN
                         "],\"objects\":[{\"type\":\"plane\"},{\"type\":\"mesh\",\"file\":\"../assets/pyramid.gltf\","
                         "\"position\":[0,0.2,0],\"rotation\":[10,40,0],\"scale\":0.9},"
                         "{\"type\":\"sphere\",\"position\":[0.5,0.3,0.5],\"radius\":0.3}]}",
             128, 128);
    const struct sf_object *object = &picture.scene->objects[1];
    const struct sf_mesh *mesh = &picture.scene->meshes[0];
    uint32_t seen = 0, wrong = 0;

    (void)state;
    for (uint32_t y = 0; y < 128; y++) {
        for (uint32_t x = 0; x < 128; x++) {
            double eye[3], way[3], unused[3], least = INFINITY;
            twin_ray(picture.scene, 0, 128, 128, x + 0.5, y + 0.5, eye, way);
            for (uint32_t t = 0; t < mesh->index_count; t += 3) {
                double corner[3][3], edge1[3], edge2[3], p[3], q[3], from[3];
                for (int k = 0; k < 3; k++) {
                    for (int i = 0; i < 3; i++)
                        corner[k][i] =
                            (double)mesh->positions[3 * mesh->indices[t + (uint32_t)k] + (uint32_t)i] * object->scale;
                    twin_turn(object->rotation, false, corner[k]);
                }
                for (int i = 0; i < 3; i++) {
                    edge1[i] = corner[1][i] - corner[0][i];
                    edge2[i] = corner[2][i] - corner[0][i];
                    from[i] = eye[i] - object->position[i] - corner[0][i];
                }
                twin_cross(way, edge2, p);
                twin_cross(from, edge1, q);
                double d = twin_dot(p, edge1), u = twin_dot(p, from) / d, v = twin_dot(q, way) / d,
                       at = twin_dot(q, edge2) / d;
                if (fabs(d) > 1e-12 && u >= 0 && v >= 0 && u + v <= 1 && at > 0.05)
                    least = fmin(least, at);
            }
            struct twin_hit hit = {.object = -1};
            double plane_and_sphere = INFINITY;
            for (int k = 0; k < 3; k += 2) {
                double local[3];
                for (int i = 0; i < 3; i++)
                    local[i] = eye[i] - (k == 2 ? picture.scene->objects[k].position[i] : 0.0f);
                hit.object = -1;
                twin_meet(&picture.scene->objects[k], k, local, way, 0.05, &hit);
                plane_and_sphere = hit.object >= 0 ? fmin(plane_and_sphere, hit.t) : plane_and_sphere;
            }
            (void)unused;
            double want = fmin(fmin(least, plane_and_sphere), SF_NO_DEPTH);
            seen += least < plane_and_sphere;
            wrong += !close_to(picture.frame.depth[y * 128 + x], want, 1e-4, 0);
        }
    }
    assert_true(seen > 500);
    if (wrong > 60) /* silhouettes, where the rasterizer decides */
        fail_msg("the mesh's depth is wrong at %u pixels", wrong);
    drop(&picture);
}

static int open_device(void **state)
{
    (void)state;
    return sf_device_create(&(struct sf_device_options){.validate = true, .no_cache = true}, &test_log, &device) ==
                   SF_OK
               ? 0
               : -1;
}

static int close_device(void **state)
{
    (void)state;
    int messages = (int)sf_device_validation_messages(device);
    sf_device_destroy(&device);
    return messages;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_plane),        cmocka_unit_test(test_shapes), cmocka_unit_test(test_lights),
        cmocka_unit_test(test_irradiance),   cmocka_unit_test(test_inside), cmocka_unit_test(test_environment),
        cmocka_unit_test(test_panorama),     cmocka_unit_test(test_alpha),  cmocka_unit_test(test_shadows),
        cmocka_unit_test(test_smoke_shadow), cmocka_unit_test(test_mesh),
    };

    enum sf_status status =
        sf_device_create(&(struct sf_device_options){.validate = true, .no_cache = true}, NULL, &device);
    sf_device_destroy(&device);
    if (status == SF_ERROR_DEVICE)
        return 77;
    return cmocka_run_group_tests(tests, open_device, close_device);
}
