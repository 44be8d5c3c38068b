/* Lit smoke (METHODS B9, B10) against closed forms, through the public interface, with validation. The eye stands in (0, 0, 4)
 * and looks along -z at a puff of radius 1 in the origin, whose atlas is made here: one colour, one alpha, one normal, one
 * height, so that every pixel of the disc is known. */
#include "../cpu/scratch.h"
#include "thick_kit.h"

#include "texture/texture.h"

enum { SIDE = 65, LIGHTS = 8, ATLAS = 16 };
static const double PI = 3.14159265358979323846;

struct lamp {
    double at[3]; /* directional: unit vector to the light; else where it stands */
    bool stands;
    double strength;
};

/* What is drawn. */
struct puff {
    const char *method;
    double alpha, normal[3], height; /* of the atlas */
    bool ridged;                     /* every fourth column of it has no height */
    double extinction, g;
    double wrap, translucency, halo, blend;
    double absorption, dampening;
    int steps;
    struct lamp lamps[LIGHTS];
    int lamp_count;
    double rotation;
    const char *more; /* JSON behind the rest, from a comma on; NULL: none */
};
static const struct puff usual = {.method = "lit",
                                  .alpha = 1,
                                  .normal = {0, 0, 1},
                                  .extinction = 2,
                                  .wrap = 0.6,
                                  .absorption = 1,
                                  .steps = 8,
                                  .lamps = {{{0, 0, 1}, false, 3}},
                                  .lamp_count = 1};

static void write_atlas(const struct puff *puff)
{
    const struct sf_exr_options exr = {.compression = "none"};
    struct sf_texture *texture = sf_texture_alloc(ATLAS, ATLAS, 1, 1);

    assert_non_null(texture);
    texture->info.channels = SF_TEXTURE_ALL;
    for (size_t i = 0; i < (size_t)ATLAS * ATLAS * 4; i++) {
        texture->color[i] = i % 4 < 3 ? 1 : (float)puff->alpha;
        texture->shape[i] = (float)(i % 4 < 3                                ? puff->normal[i % 4]
                                    : puff->ridged && i / 4 % ATLAS % 4 == 0 ? 0
                                                                             : puff->height);
    }
    remove("atlas.exr");
    assert_int_equal(sf_texture_write_exr(texture, "atlas.exr", SF_TEXTURE_ALL, &exr, &kit_log), SF_OK);
    sf_texture_destroy(&texture);
}

static int print_lamps(const struct puff *puff, char *text, int room)
{
    int used = 0;

    for (int i = 0; i < puff->lamp_count; i++) {
        const struct lamp *lamp = &puff->lamps[i];
        double sign = lamp->stands ? 1 : -1;

        used += snprintf(text + used, (size_t)(room - used),
                         "%s{\"type\":\"%s\",\"%s\":[%.9g,%.9g,%.9g],\"intensity\":%.9g,"
                         "\"shadows\":false}",
                         i ? "," : "", lamp->stands ? "point" : "directional", lamp->stands ? "position" : "direction",
                         sign * lamp->at[0], sign * lamp->at[1], sign * lamp->at[2], lamp->strength);
    }
    return used;
}

/* The scene with a particle of the puff in the origin, and `others` in front of it in the list. */
static void print_scene(const struct puff *puff, const char *atlas, const char *others, char *text, size_t room)
{
    char lamps[2048] = "";

    print_lamps(puff, lamps, sizeof lamps);
    snprintf(text, room,
             "{\"method\":\"%s\",\"camera\":{\"eye\":[0,0,4],\"target\":[0,0,0],\"fov\":40,\"near\":0.01},"
             "\"atlas\":%s,\"lights\":[%s],"
             "\"medium\":{\"albedo\":[1,0.5,0.25],\"g\":%.9g},\"thick\":{\"resolution\":\"full\",\"detail\":0,"
             "\"ambient\":0},"
             "\"lit\":{\"relief\":1,\"wrap\":%.9g,\"translucency\":%.9g,\"halo\":%.9g,\"blend\":%.9g%s},"
             "\"scattering\":{\"steps\":%d,\"steps_min\":%d,\"absorption\":%.9g,\"dampening\":%.9g},"
             "\"environment\":{\"type\":\"color\",\"visible\":false},\"sim\":{\"capacity\":16},"
             "\"emitters\":[{\"type\":\"list\",\"still\":true,\"particles\":[%s{\"centre\":[0,0,0],\"radius\":1,"
             "\"extinction\":%.9g,\"rotation\":%.9g}]}]%s}",
             puff->method, atlas, lamps, puff->g, puff->wrap, puff->translucency, puff->halo, puff->blend,
             puff->more && strstr(puff->more, "ramp") ? ",\"ramp\":\"intensity\"" : "", puff->steps, puff->steps,
             puff->absorption, puff->dampening, others, puff->extinction, puff->rotation, puff->more ? puff->more : "");
}

#define FILE_ATLAS "{\"type\":\"file\",\"file\":\"atlas.exr\",\"across\":1,\"down\":1}"

static struct picture draw_puff(const struct puff *puff)
{
    char text[8192];

    write_atlas(puff);
    print_scene(puff, FILE_ATLAS, "", text, sizeof text);
    return draw_text(text, SIDE, SIDE);
}

/* ---- the closed form ---- */

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Where the ray of a pixel meets the puff's plane. */
static void place_of(uint32_t x, uint32_t y, double place[3])
{
    double tangent = tan(20 * PI / 180);

    place[0] = 4 * ((x + 0.5) / SIDE * 2 - 1) * tangent;
    place[1] = 4 * (1 - (y + 0.5) / SIDE * 2) * tangent;
    place[2] = 0;
}

static double phase(double cosine, double g)
{
    return (1 - g * g) / (4 * PI * pow(1 + g * g - 2 * g * cosine, 1.5));
}

/* Opacity where alpha is 1: the matter of a ball over the square. */
static double opacity_of(const struct puff *puff)
{
    return 1 - exp(-PI / 3 * puff->extinction / puff->alpha);
}

/* Through the level field, from its near face to the light: to the far one, or to the tile's border. */
static double matter_of(const struct puff *puff, const double place[3], const double to_light[3])
{
    double end = to_light[2] < 0 ? -2 * puff->height / to_light[2] : 0;

    for (int k = 0; k < 2; k++)
        if (to_light[k] != 0)
            end = fmin(end, (1 - copysign(1, to_light[k]) * place[k]) / fabs(to_light[k]));
    return end;
}

/* Radiance at a place in the puff's plane, of albedo 1. */
static double radiance_of(const struct puff *puff, const double place[3])
{
    double to_eye[3] = {-place[0], -place[1], 4}, away = sqrt(dot(to_eye, to_eye)), sum = 0;
    bool field = strcmp(puff->method, "lit-scattering") == 0;

    for (int k = 0; k < 3; k++)
        to_eye[k] /= away;
    for (int i = 0; i < puff->lamp_count; i++) {
        const struct lamp *lamp = &puff->lamps[i];
        double way[3], far = 1, irradiance = lamp->strength;

        for (int k = 0; k < 3; k++)
            way[k] = lamp->at[k] - (lamp->stands ? place[k] : 0);
        far = sqrt(dot(way, way));
        irradiance /= lamp->stands ? far * far + 1.0 / 3 : 1;
        for (int k = 0; k < 3; k++)
            way[k] /= far;
        double behind = fmax(-dot(to_eye, way), 0);
        double wrapped = fmax((dot(puff->normal, way) + puff->wrap) / (1 + puff->wrap), 0) / (PI * (1 + puff->wrap));
        double through = puff->translucency * 4 * behind * phase(behind, puff->g);
        if (field)
            irradiance *=
                exp(-puff->absorption * puff->extinction * matter_of(puff, place, way)) / (1 + puff->dampening);
        else
            through *= (1 - opacity_of(puff) * puff->alpha) * exp(-puff->halo * fmax(dot(puff->normal, to_eye), 0));
        sum += irradiance * (wrapped + through);
    }
    return sum * opacity_of(puff) * puff->alpha;
}

/* As the device has the atlas: in 8 bits. */
static struct puff stored(const struct puff *puff)
{
    struct puff stored = *puff;
    double length = 0;

    for (int k = 0; k < 3; k++) {
        stored.normal[k] = round(127 * puff->normal[k]) / 127;
        length += stored.normal[k] * stored.normal[k];
    }
    for (int k = 0; k < 3; k++)
        stored.normal[k] /= sqrt(length);
    stored.height = round(255 * puff->height) / 255;
    stored.alpha = round(255 * puff->alpha) / 255;
    return stored;
}

/* All pixels that are well inside the disc. */
static void compare(const struct puff *stated, const struct picture *picture, double tolerance)
{
    const struct puff kept = stored(stated), *puff = &kept;
    static const double albedo[3] = {1, 0.5, 0.25};
    double opacity = opacity_of(puff) * puff->alpha * (1 - puff->blend), worst = 0, peak = 1e-12;
    unsigned pixels = 0;

    for (uint32_t y = 0; y < SIDE; y++)
        for (uint32_t x = 0; x < SIDE; x++) {
            const float *found = picture->smoke[(size_t)y * SIDE + x];
            double place[3];

            place_of(x, y, place);
            if (dot(place, place) > 1)
                assert_true(dot(place, place) < 1.01 || found[3] == 0);
            if (dot(place, place) > 0.98)
                continue;
            pixels++;
            peak = fmax(peak, radiance_of(puff, place));
            for (int k = 0; k < 3; k++)
                worst = fmax(worst, fabs((double)found[k] - albedo[k] * radiance_of(puff, place)));
            assert_float_equal((double)found[3], opacity, 1e-3);
        }
    if (pixels < 1000 || worst > tolerance * peak)
        fail_msg("%s: off by %.2e of %.3g in one of %u pixels", puff->method, worst / peak, peak, pixels);
}

static void check(const struct puff *puff, double tolerance)
{
    struct picture picture = draw_puff(puff);

    compare(puff, &picture, tolerance);
    picture_free(&picture);
}

/* ---- B9 ---- */

/* (N . L) scale + bias, exactly, for every w, normal and light, also where it is cut off at 0. */
static void test_wrap_around(void **state)
{
    static const double wraps[] = {0, 0.6, 1};
    static const struct {
        double normal[3], to_light[3];
    } rows[] = {{{0, 0, 1}, {0, 0, 1}}, {{0.6, 0, 0.8}, {-0.8, 0, 0.6}}, {{0, -0.8, 0.6}, {0, 0.96, 0.28}}};

    (void)state;
    for (size_t i = 0; i < 3; i++) {
        struct puff puff = usual;

        puff.wrap = wraps[i];
        memcpy(puff.normal, rows[i].normal, sizeof puff.normal);
        memcpy(puff.lamps[0].at, rows[i].to_light, sizeof puff.lamps[0].at);
        check(&puff, 1e-3);
    }
}

/* A light before the puff does not come through it, whatever the translucency; one behind it does, most where the normal
 * turns away from the eye. */
static void test_light_from_behind(void **state)
{
    struct puff puff = usual;
    struct picture without, with;

    (void)state;
    without = draw_puff(&puff);
    puff.translucency = 5;
    with = draw_puff(&puff);
    assert_memory_equal(without.smoke, with.smoke, sizeof *with.smoke * SIDE * SIDE);
    picture_free(&without);
    picture_free(&with);
    puff.alpha = 0.6;
    puff.halo = 3;
    puff.lamps[0] = (struct lamp){{0.36, 0.48, -0.8}, false, 2};
    check(&puff, 1e-3);
    puff.g = 0.6;
    memcpy(puff.normal, (const double[3]){0.6, 0, 0.8}, sizeof puff.normal);
    check(&puff, 1e-3);
}

/* One to eight lights of both kinds, one of them inside the puff: as many terms are added. */
static void test_lights_add(void **state)
{
    static const struct lamp lamps[LIGHTS] = {
        {{0, 0, 1}, false, 1},       {{0.8, 0, 0.6}, false, 2},        {{2, 1, 1}, true, 5},
        {{0.2, -0.3, 0.1}, true, 1}, {{0.6, 0.64, -0.48}, false, 1.5}, {{-1, -2, -1.5}, true, 9},
        {{0, 0, -3}, true, 20},      {{-0.6, 0, -0.8}, false, 0.5}};
    struct puff puff = usual;

    (void)state;
    memcpy(puff.lamps, lamps, sizeof lamps);
    puff.translucency = 1;
    puff.halo = 1;
    for (puff.lamp_count = 1; puff.lamp_count <= LIGHTS; puff.lamp_count *= 2)
        check(&puff, 1e-3);
}

/* One pipeline for all: what is drawn over black and over white is what premultiplied blending makes of light and opacity. */
static void test_blending(void **state)
{
    static const double blends[] = {0, 0.4, 1};

    (void)state;
    for (size_t i = 0; i < 6; i++) {
        const struct sf_renderer_options options = {
            .width = SIDE, .height = SIDE, .aovs = SF_AOV_SMOKE, .float_aovs = true, .float_color = true};
        const double behind = i % 2 ? 1 : 0;
        struct stage stage = {0};
        struct puff puff = usual;
        char text[8192];
        uint64_t ticket;

        puff.blend = blends[i / 2];
        puff.alpha = 0.8;
        write_atlas(&puff);
        print_scene(&puff, FILE_ATLAS, "", text, sizeof text);
        const char *set = behind > 0 ? "environment.background=1,1,1" : "environment.background=0,0,0";
        assert_int_equal(sf_scene_parse("test", text, strlen(text), &set, 1, &kit_log, &stage.scene), SF_OK);
        assert_int_equal(sf_renderer_create(kit_device, stage.scene, &options, &kit_log, &stage.renderer), SF_OK);
        assert_int_equal(sf_renderer_render(stage.renderer, 0, &ticket), SF_OK);
        assert_int_equal(sf_renderer_wait(stage.renderer, ticket, &stage.frame), SF_OK);
        const float *found = stage.frame.color_float + 4 * (SIDE * SIDE / 2);
        double cover = opacity_of(&puff) * puff.alpha, place[3] = {0};
        /* The frame's colour has 16 bits. */
        assert_float_equal((double)found[0], radiance_of(&puff, place) + (1 - cover * (1 - puff.blend)) * behind, 2e-3);
        stage_end(&stage);
    }
}

/* A ramp over intensity: at half of the light's full strength the colour of the ramp's middle. */
static void test_ramp_over_intensity(void **state)
{
    struct puff puff = usual;
    struct picture picture;

    (void)state;
    puff.wrap = 0;
    puff.more = ",\"ramp\":[{\"at\":0,\"color\":[1,0,0]},{\"at\":1,\"color\":[0,1,0]}]";
    puff.lamps[0] = (struct lamp){{0.96, 0, 0.28}, false, 2};
    picture = draw_puff(&puff);
    const float *found = picture.smoke[SIDE * SIDE / 2];
    double radiance = radiance_of(&puff, (const double[3]){0});
    assert_float_equal((double)found[0], radiance * 0.72, 2e-3 * radiance);
    assert_float_equal((double)found[1], radiance * 0.5 * 0.28, 2e-3 * radiance);
    assert_float_equal((double)found[2], 0, 1e-6);
    picture_free(&picture);
}

/* A puff dims light by its own model alone: in its shadow map it is not there. Another one between it and the light dims it
 * by the chord that the light cuts from it, at the point where half of the puff's light is sent from. */
static void test_only_others_cast_shadows(void **state)
{
    struct puff puff = usual;
    struct picture picture;
    char text[8192];

    (void)state;
    puff.lamps[0] = (struct lamp){{1, 0, 0}, false, 3};
    check(&puff, 1e-3);
    print_scene(&puff, FILE_ATLAS, "{\"centre\":[8,0,0],\"radius\":1,\"extinction\":0.5},", text, sizeof text);
    picture = draw_text(text, SIDE, SIDE);
    double before = 1 + log(0.5 + 0.5 * exp(-4)) / 2;
    double share = exp(-0.5 * 2 * sqrt(1 - before * before));
    double truth = share * radiance_of(&puff, (const double[3]){0});
    assert_float_equal((double)picture.smoke[SIDE * SIDE / 2][0], truth, 2e-3 * truth);
    picture_free(&picture);
}

/* ---- turning, and order ---- */

#define MADE_ATLAS "{\"type\":\"made\",\"kind\":\"fbm\",\"size\":64,\"across\":1,\"down\":1}"

/* A quarter turn of the particle and of the light turns the picture, normals and heights included. */
static void test_quarter_turn(void **state)
{
    static const char *const methods[] = {"lit", "lit-scattering"};

    (void)state;
    for (size_t m = 0; m < 2; m++) {
        struct puff puff = usual;
        struct picture upright, turned;
        char text[8192];
        double peak;

        puff.method = methods[m];
        puff.translucency = 1;
        puff.lamps[0] = (struct lamp){{0.64, 0.48, -0.6}, false, 3};
        puff.lamps[1] = (struct lamp){{0.8, 0, 0.6}, false, 1};
        puff.lamp_count = 2;
        print_scene(&puff, MADE_ATLAS, "", text, sizeof text);
        upright = draw_text(text, SIDE, SIDE);
        puff.rotation = PI / 2;
        puff.lamps[0] = (struct lamp){{0.48, -0.64, -0.6}, false, 3};
        puff.lamps[1] = (struct lamp){{0, -0.8, 0.6}, false, 1};
        print_scene(&puff, MADE_ATLAS, "", text, sizeof text);
        turned = draw_text(text, SIDE, SIDE);
        peak = picture_peak(&upright);
        for (size_t y = 0; y < SIDE; y++)
            for (size_t x = 0; x < SIDE; x++)
                for (int k = 0; k < 4; k++) {
                    double a = (double)upright.smoke[y * SIDE + x][k],
                           b = (double)turned.smoke[x * SIDE + SIDE - 1 - y][k];
                    if (fabs(a - b) > 2e-3 * peak)
                        fail_msg("%s: (%zu, %zu) channel %d is %g, turned %g", methods[m], x, y, k, a, b);
                }
        assert_true(peak > 0.1);
        picture_free(&upright);
        picture_free(&turned);
    }
}

/* Particles are drawn by depth: the order in which they are listed changes no bit. */
static void test_order_of_the_list(void **state)
{
    static const char *const lists[] = {
        "{\"centre\":[0.3,0.2,0.5],\"radius\":0.6,\"tile\":1},{\"centre\":[-0.4,0,-0.7],\"radius\":0.8,\"tile\":2},",
        "{\"centre\":[-0.4,0,-0.7],\"radius\":0.8,\"tile\":2},{\"centre\":[0.3,0.2,0.5],\"radius\":0.6,\"tile\":1},"};
    struct picture pictures[2];

    (void)state;
    for (size_t i = 0; i < 2; i++) {
        struct puff puff = usual;
        char text[8192];

        puff.more = ",\"billboard\":{\"self_shadow\":false}";
        print_scene(&puff, "{}", lists[i], text, sizeof text);
        pictures[i] = draw_text(text, SIDE, SIDE);
    }
    assert_true(picture_peak(&pictures[0]) > 0.1);
    assert_memory_equal(pictures[0].smoke, pictures[1].smoke, sizeof *pictures[0].smoke * SIDE * SIDE);
    picture_free(&pictures[0]);
    picture_free(&pictures[1]);
}

/* ---- B10 ---- */

/* The matter of a level field has a closed form: one step is exact where the ray leaves through the far face, many where it
 * leaves through a side. */
static void test_level_field(void **state)
{
    struct puff puff = usual;

    (void)state;
    puff.method = "lit-scattering";
    puff.translucency = 1;
    puff.height = 0.25;
    puff.extinction = 1.5;
    puff.absorption = 0.8;
    puff.lamps[0] = (struct lamp){{0, 0, -1}, false, 3};
    puff.lamps[1] = (struct lamp){{0.6, 0, 0.8}, false, 0.5};
    puff.lamp_count = 2;
    puff.steps = 1;
    check(&puff, 1e-3);
    puff.dampening = 0.3;
    puff.lamps[0] = (struct lamp){{0.48, 0.64, -0.6}, false, 3};
    puff.steps = 256;
    check(&puff, 1e-2);
}

/* 5.2.5: where the normal is the way to the eye, `facing` takes the most steps and `grazing` the fewest; where it stands
 * across it, the other way round. The field has ridges, so that the number of steps shows. */
static void test_readings_of_the_equation(void **state)
{
    static const double normals[2][3] = {{0, 0, 1}, {1, 0, 0}};
    static const char *const sets[4] = {"scattering.more=facing", "scattering.more=grazing", "scattering.steps=3",
                                        "scattering.steps_min=40"};

    (void)state;
    for (size_t n = 0; n < 2; n++) {
        const float *found[4];
        struct picture pictures[4];
        struct puff puff = usual;
        char text[8192];

        puff.method = "lit-scattering";
        puff.height = 0.25;
        puff.ridged = true;
        puff.steps = 3; /* of steps_min; at most 40 unless a set says otherwise */
        puff.lamps[0] = (struct lamp){{0.96, 0, -0.28}, false, 3};
        memcpy(puff.normal, normals[n], sizeof puff.normal);
        write_atlas(&puff);
        print_scene(&puff, FILE_ATLAS, "", text, sizeof text);
        for (size_t i = 0; i < 4; i++) {
            const char *const set[2] = {"scattering.steps=40", sets[i]};
            struct stage stage = {0};
            struct sf_scene *scene = NULL;

            assert_int_equal(sf_scene_parse("test", text, strlen(text), set, 2, &kit_log, &scene), SF_OK);
            stage = stage_with(scene, SIDE, SIDE);
            pictures[i] = stage_draw(&stage, 0);
            stage_end(&stage);
            found[i] = pictures[i].smoke[SIDE * SIDE / 2];
        }
        assert_float_not_equal((double)found[2][0], (double)found[3][0], 1e-3);
        assert_float_equal((double)found[n == 0 ? 0 : 1][0], (double)found[3][0], 1e-6); /* the most */
        assert_float_equal((double)found[n == 0 ? 1 : 0][0], (double)found[2][0], 1e-6); /* the fewest */
        for (size_t i = 0; i < 4; i++)
            picture_free(&pictures[i]);
    }
}

static int setup(void **state)
{
    return kit_setup(state) ? -1 : scratch_enter(state);
}

static int teardown(void **state)
{
    kit_teardown(state);
    return scratch_leave(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_wrap_around),         cmocka_unit_test(test_light_from_behind),
        cmocka_unit_test(test_lights_add),          cmocka_unit_test(test_blending),
        cmocka_unit_test(test_ramp_over_intensity), cmocka_unit_test(test_only_others_cast_shadows),
        cmocka_unit_test(test_quarter_turn),        cmocka_unit_test(test_order_of_the_list),
        cmocka_unit_test(test_level_field),         cmocka_unit_test(test_readings_of_the_equation),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
