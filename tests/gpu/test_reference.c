/* The method reference against the CPU's reference (src/truth), and against itself: the same bits however one comes to
 * them, better with more samples, begun anew when anything changes. */
#include "live_kit.h"

#include <math.h>
#include "methods/reference.h"
#include "output/half.h"
#include "truth/truth.h"

static const char *const by_reference = "method=reference";

static struct sf_scene *load(const char *relative, const char *const *sets, uint32_t count)
{
    const char *root = getenv("SF_SOURCE_ROOT");
    struct sf_scene *scene = NULL;
    char path[1024];

    snprintf(path, sizeof path, "%s/scenes/%s.json", root ? root : ".", relative);
    if (sf_scene_load(path, sets, count, &live_log, &scene) != SF_OK)
        fail_msg("%s: %s", relative, live_message);
    return scene;
}

/* ---- against the CPU ---- */

/* The particles of a frame, as the device has them; up to 1,024. */
static struct sf_particle *particles_of(const struct sf_scene *scene, uint32_t number, uint32_t *count)
{
    const struct sf_renderer_options options = {.width = 8, .height = 8, .inspect = "particles"};
    struct sf_renderer *renderer = live_create(scene, &options);
    struct sf_frame frame = live_frame(renderer, number);
    struct sf_particle *list = malloc((frame.live + 1) * sizeof *list);

    assert_non_null(list);
    assert_in_range(frame.live * sizeof *list, 0, frame.inspected_word_count * sizeof(uint32_t));
    memcpy(list, frame.inspected_words, frame.live * sizeof *list);
    *count = frame.live;
    sf_renderer_destroy(&renderer);
    return list;
}

static struct sf_truth_picture *truth_of(const struct sf_scene *scene, uint32_t number, const struct sf_particle *list,
                                         uint32_t count, uint32_t size)
{
    struct sf_truth_options options = sf_truth_options_usual();
    const struct sf_truth_work work = {.log = &live_log};
    struct sf_truth_particles *particles = NULL;
    struct sf_truth_medium medium;
    struct sf_truth_picture *picture = NULL;
    struct sf_truth *truth = NULL;
    struct sf_camera_pose pose;

    options.tolerance = 2e-5;
    options.floor = 1e-9;
    options.limit = 2000000;
    options.ambient = scene->thick.ambient;
    assert_int_equal(sf_truth_particles_create(list, count, scene, &live_log, &particles), SF_OK);
    sf_truth_particles_medium(particles, &medium);
    assert_int_equal(sf_truth_create(scene, &medium, &options, &live_log, &truth), SF_OK);
    sf_scene_camera(scene, number / (double)scene->sim.fps, &pose);
    assert_int_equal(sf_truth_render(truth, &pose, size, size, &work, &picture), SF_OK);
    assert_int_equal(picture->unconverged, 0);
    sf_truth_destroy(&truth);
    sf_truth_particles_destroy(&particles);
    return picture;
}

/* Largest differences over all pixels, each relative to the pixel's own: transmittance, and radiance to its brightest
 * channel. */
struct difference {
    double transmittance, radiance, depths;
    double picture; /* of color, over a background of one colour, and of the smoke's plane */
};

/* The picture and the smoke's plane of halves, of which a value is known to 5e-4 of itself. */
static double compare_picture(const struct sf_frame *frame, const struct sf_scene *scene, size_t i,
                              const struct sf_truth_result *is, double brightest)
{
    const struct sf_environment *around = &scene->environment;
    bool plain = scene->object_count == 0 && around->kind == SF_ENVIRONMENT_COLOR;
    double worst = 0;

    for (size_t c = 0; c < 4 && brightest > 1e-3; c++) {
        double smoke = c < 3 ? is->radiance[c] : 1 - is->transmittance;
        double behind = c < 3 ? (double)around->color[c] * around->intensity : 1;
        double color = smoke + is->transmittance * behind;

        worst = fmax(worst, fabs(sf_half_to_float(frame->smoke[4 * i + c]) - smoke) / brightest);
        if (plain)
            worst = fmax(worst, fabs(frame->color_float[4 * i + c] - color) / fmax(color, brightest));
    }
    return worst;
}

static struct difference compare(const struct sf_frame *frame, const struct sf_scene *scene,
                                 const struct sf_truth_picture *truth)
{
    struct difference worst = {0};

    for (size_t i = 0; i < (size_t)truth->width * truth->height; i++) {
        const struct sf_truth_result *is = &truth->pixels[i];
        const float *depths = frame->smoke_depths + 4 * i, *sums = frame->inspected + 4 * i;
        double brightest = fmax(is->radiance[0], fmax(is->radiance[1], is->radiance[2]));
        bool meets = is->near <= is->far && is->optical_depth > 0;

        worst.transmittance = fmax(worst.transmittance, fabs(depths[3] / is->transmittance - 1));
        if (meets && is->optical_depth > 1e-6) {
            worst.depths = fmax(worst.depths, fabs(depths[0] - is->near) / is->near);
            worst.depths = fmax(worst.depths, fabs(depths[1] - is->far) / is->far);
        }
        worst.picture =
            fmax(worst.picture, compare_picture(frame, scene, i, is, fmax(brightest, 1 - is->transmittance)));
        for (int c = 0; c < 3 && brightest > 0; c++) {
            double radiance = sums[3] > 0 ? sums[c] / sums[3] * -expm1(-(double)depths[2]) : 0;

            worst.radiance = fmax(worst.radiance, fabs(radiance - is->radiance[c]) / brightest);
        }
    }
    return worst;
}

/* The picture with AOVs, and the sums in floats: the smoke's own plane is of halves. */
static struct difference differ(const struct sf_scene *scene, uint32_t number, uint32_t size,
                                const struct sf_truth_picture *truth)
{
    const struct sf_renderer_options options = {.width = size,
                                                .height = size,
                                                .float_color = true,
                                                .aovs = SF_AOV_SMOKE | SF_AOV_DEPTHS,
                                                .inspect = "reference.sums"};
    struct sf_renderer *renderer = live_create(scene, &options);
    struct sf_frame frame = live_frame(renderer, number);
    struct difference worst = compare(&frame, scene, truth);

    assert_true(frame.progress == 1);
    sf_renderer_destroy(&renderer);
    return worst;
}

static void test_truth_scenes(void **state)
{
    static const struct {
        const char *name;
        uint32_t frame, size;
    } scenes[] = {{"truth/one-puff", 0, 48},  {"truth/two-lights", 0, 48}, {"truth/cut", 0, 48},
                  {"truth/inside", 0, 20},    {"truth/backlit", 0, 48},    {"truth/overlap", 0, 48},
                  {"truth/hole-view", 0, 48}, {"truth/hole-light", 0, 48}, {"truth/ring", 0, 48},
                  {"truth/grazing", 0, 48},   {"truth/dying", 30, 32},     {"truth/plume-512", 0, 16},
                  {"tiny/all", 20, 32},       {"tiny/mesh", 20, 32},       {"still-life", 0, 24}};

    (void)state;
    for (size_t i = 0; i < SF_COUNT(scenes); i++) {
        const char *sets[] = {by_reference, "reference.batch=128"}; /* few steps are quicker */
        struct sf_scene *scene = load(scenes[i].name, sets, 2);
        uint32_t count, size = scenes[i].size;
        struct sf_particle *list = particles_of(scene, scenes[i].frame, &count);
        struct sf_truth_picture *truth = truth_of(scene, scenes[i].frame, list, count, size);
        struct difference worst = differ(scene, scenes[i].frame, size, truth);

        print_message("%-18s %3u particles: transmittance %.1e, radiance %.1e, depths %.1e, picture %.1e\n",
                      scenes[i].name, count, worst.transmittance, worst.radiance, worst.depths, worst.picture);
        if (!(worst.transmittance <= 1e-4) || !(worst.radiance <= 1e-3) || !(worst.depths <= 1e-4) ||
            !(worst.picture <= 1.5e-3))
            fail_msg("%s is not as the CPU has it", scenes[i].name);
        sf_truth_picture_destroy(&truth);
        free(list);
        sf_scene_destroy(&scene);
    }
}

/* Each sphere's outline at 400 pixels: where a ray grazes, floats alone are off by more than 1e-4 here. */
static void test_outlines(void **state)
{
    const char *sets[] = {by_reference, "reference.samples=8", "lights.0.intensity=0", "environment.intensity=0"};
    struct sf_scene *scene = load("truth/overlap", sets, 4);
    uint32_t count;
    struct sf_particle *list = particles_of(scene, 0, &count);
    struct sf_truth_picture *truth = truth_of(scene, 0, list, count, 400);
    struct difference worst = differ(scene, 0, 400, truth);

    (void)state;
    print_message("outlines: transmittance %.1e\n", worst.transmittance);
    assert_true(worst.transmittance <= 1e-5);
    sf_truth_picture_destroy(&truth);
    free(list);
    sf_scene_destroy(&scene);
}

/* Four times as many samples, at least twice as near, until the CPU's own tolerance. */
static void test_more_samples_are_nearer(void **state)
{
    static const char *const names[] = {"truth/hole-view", "truth/cut"};
    static const char *const samples[] = {"reference.samples=32", "reference.samples=128", "reference.samples=512"};

    (void)state;
    for (size_t i = 0; i < SF_COUNT(names); i++) {
        struct sf_truth_picture *truth = NULL;
        double before = INFINITY;

        for (size_t k = 0; k < SF_COUNT(samples); k++) {
            const char *sets[] = {by_reference, samples[k], "reference.batch=32"};
            struct sf_scene *scene = load(names[i], sets, 3);
            uint32_t count;
            struct sf_particle *list = particles_of(scene, 0, &count);

            if (!truth)
                truth = truth_of(scene, 0, list, count, 40);
            struct difference worst = differ(scene, 0, 40, truth);
            print_message("%s, %s: radiance %.1e\n", names[i], samples[k], worst.radiance);
            assert_true(worst.radiance < 0.5 * before);
            before = worst.radiance;
            free(list);
            sf_scene_destroy(&scene);
        }
        sf_truth_picture_destroy(&truth);
    }
}

/* ---- the same picture by every way ---- */

static const char crowd[] =
    "{\"method\":\"reference\",\"reference\":{\"samples\":48,\"batch\":8,\"shadow_size\":64},"
    "\"camera\":{\"eye\":[0,1,5],\"target\":[0,1,0]},"
    "\"lights\":[{\"type\":\"directional\",\"direction\":[-1,-1.5,-0.4],\"intensity\":2},"
    "{\"type\":\"spot\",\"position\":[1.5,2.5,1],\"direction\":[-1.5,-2,-1],\"intensity\":20},"
    "{\"type\":\"point\",\"position\":[0,1,0.2],\"intensity\":1}],"
    "\"objects\":[{\"type\":\"plane\"},{\"type\":\"cylinder\",\"position\":[0.6,0.5,0.3],\"radius\":0.2,\"height\":1},"
    "{\"type\":\"mesh\",\"file\":\"../assets/pyramid.gltf\",\"position\":[-0.6,0.2,0.4],\"scale\":0.4}],"
    "\"medium\":{\"extinction\":4,\"g\":0.3,\"emission\":[0.02,0.01,0]},"
    "\"ramp\":[{\"at\":0.1,\"color\":[1,0.8,0.6]},{\"at\":0.7,\"color\":[0.4,0.9,1]}],"
    "\"emitters\":[{\"type\":\"sphere\",\"position\":[0,1,0],\"radius\":0.7,\"burst\":40,\"rate\":40,\"lifetime\":3,"
    "\"speed\":0.3,\"particle_radius\":[0.1,0.3]}],\"sim\":{\"capacity\":300}}";

static const struct sf_renderer_options all = {.width = 36, .height = 28, .aovs = SF_AOV_SMOKE | SF_AOV_DEPTHS};
static const struct sf_renderer_options stepwise = {
    .width = 36, .height = 28, .aovs = SF_AOV_SMOKE | SF_AOV_DEPTHS, .progressive = true};

/* Draws until the picture is finished; the number of steps. */
static uint32_t finish(struct sf_renderer *renderer, uint32_t number, struct picture *picture)
{
    uint32_t steps = 0;

    do {
        struct sf_frame frame = live_frame(renderer, number);

        assert_true(frame.progress == sf_renderer_progress(renderer));
        if (steps > 0)
            live_free(picture);
        *picture = live_keep(&frame);
        steps++;
    } while (picture->frame.progress < 1);
    return steps;
}

static bool refine_some(void *user, uint64_t done, uint64_t total)
{
    assert_int_equal(total, 5);
    return done < *(uint64_t *)user;
}

static void test_the_same_bits(void **state)
{
    struct sf_scene *scene = live_parse(crowd, NULL);
    struct picture once = live_fresh(scene, &all, 12), again, steps, other;
    struct sf_renderer *renderer = live_create(scene, &all);
    uint64_t enough = 3;

    (void)state;
    again = live_picture(renderer, 12); /* alone and after others, and twice by one renderer */
    assert_true(live_same(&once, &again));
    live_free(&again);
    other = live_picture(renderer, 13);
    assert_false(live_same(&once, &other));
    live_free(&other);
    again = live_picture(renderer, 12);
    assert_true(live_same(&once, &again));
    live_free(&again);
    /* Prepared in part, broken off, and prepared to its end. */
    assert_int_equal(sf_renderer_refine(renderer, 12, refine_some, &enough), SF_ERROR_INTERRUPTED);
    again = live_picture(renderer, 12);
    assert_true(live_same(&once, &again));
    live_free(&again);
    assert_int_equal(sf_renderer_refine(renderer, 12, NULL, NULL), SF_OK);
    again = live_picture(renderer, 12);
    assert_true(live_same(&once, &again));
    sf_renderer_destroy(&renderer);

    renderer = live_create(scene, &stepwise);
    assert_int_equal(finish(renderer, 12, &steps), 6);
    assert_true(live_same(&once, &steps));
    live_free(&steps);
    assert_int_equal(finish(renderer, 12, &steps), 1); /* finished it stays */
    assert_true(live_same(&once, &steps));
    live_free(&steps);
    live_free(&again);
    live_free(&once);
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
}

/* Two steps, then the change, then to the end: as if there had been nothing before. */
static void check_restart(struct sf_renderer *renderer, const struct sf_scene *before, const struct sf_scene *scene,
                          uint32_t steps, const char *what)
{
    struct picture got, want;
    uint32_t took;

    assert_int_equal(sf_renderer_set_scene(renderer, before), SF_OK);
    live_frame(renderer, 12);
    live_frame(renderer, 12);
    assert_int_equal(sf_renderer_set_scene(renderer, scene), SF_OK);
    took = finish(renderer, 12, &got);
    want = live_fresh(scene, &all, 12);
    if (took != steps || !live_same(&got, &want))
        fail_msg("%s: %u steps to the end in place of %u, %s bits", what, took, steps,
                 live_same(&got, &want) ? "the same" : "other");
    live_free(&got);
    live_free(&want);
}

static void test_changes_begin_anew(void **state)
{
    static const struct {
        const char *set;
        uint32_t steps;
    } changes[] = {{"output.exposure=2", 4}, /* is for who shows it */
                   {"lights.1.intensity=7", 6},
                   {"medium.g=-0.2", 6},
                   {"ramp.1.color=1,0.2,0.1", 6},
                   {"thick.ambient=0.3", 6},
                   {"objects.1.position=0.1,0.5,0.8", 6},
                   {"objects.2.rotation=0,40,0", 6},
                   {"camera.eye=0.3,1,5", 6},
                   {"emitters.0.radius=0.5", 6},
                   {"environment.horizon=1,0,0", 6},
                   {"reference.samples=72", 9},
                   {"reference.batch=24", 2},
                   {"emitters.0.rate=90", 6}};
    struct sf_scene *before = live_parse(crowd, NULL);
    struct sf_renderer *renderer = live_create(before, &stepwise);
    const struct sf_camera_view view = {
        .eye = {1, 1.5f, 4}, .target = {0, 1, 0}, .up = {0, 1, 0}, .fov = 40, .near_clip = 0.05f};
    struct picture here, there;

    (void)state;
    for (size_t i = 0; i < SF_COUNT(changes); i++) {
        struct sf_scene *scene = live_parse(crowd, changes[i].set);

        check_restart(renderer, before, scene, changes[i].steps, changes[i].set);
        assert_int_equal(sf_renderer_set_scene(renderer, before), SF_OK);
        sf_scene_destroy(&scene);
    }
    /* The eye, the frame, a shader. */
    assert_int_equal(finish(renderer, 12, &here), 6);
    sf_renderer_set_view(renderer, &view);
    assert_int_equal(finish(renderer, 12, &there), 6);
    assert_false(live_same(&here, &there));
    live_free(&there);
    sf_renderer_set_view(renderer, NULL);
    assert_int_equal(finish(renderer, 12, &there), 6);
    assert_true(live_same(&here, &there));
    live_free(&there);
    live_frame(renderer, 13);
    assert_int_equal(finish(renderer, 12, &there), 6);
    assert_true(live_same(&here, &there));
    live_free(&there);
    assert_int_equal(sf_device_set_shader(live_device, "reference/march.comp", NULL, 0), SF_OK);
    assert_int_equal(finish(renderer, 12, &there), 6);
    assert_true(live_same(&here, &there));
    live_free(&there);
    live_free(&here);
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&before);
}

/* Lists for which there is no room: all particles are gone through, and the bits stay. */
static void test_lists_without_room(void **state)
{
    struct sf_scene *scene = live_parse(crowd, NULL);
    struct sf_renderer *renderer = live_create(scene, &all);
    struct sf_reference *reference = renderer->sides[0].stage.assembly->state;
    struct picture roomy = live_picture(renderer, 12), crowded;

    (void)state;
    assert_in_range(reference->push.entries, 10000, 1u << 24);
    for (uint32_t room = 3000; room > 0; room /= 10) {
        reference->push.entries = room;
        crowded = live_picture(renderer, 12);
        assert_true(live_same(&roomy, &crowded));
        live_free(&crowded);
    }
    live_free(&roomy);
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
}

/* ---- few and many ---- */

static void test_no_particles(void **state)
{
    static const char *const scenes[] = {
        "{\"objects\":[{\"type\":\"plane\"},{\"type\":\"box\",\"size\":[1,1,1]}],\"lights\":[{\"type\":\"point\","
        "\"position\":[1,2,1]}]}",
        "{\"emitters\":[{\"type\":\"sphere\",\"rate\":10,\"start\":9,\"radius\":1}]}", "{}"};

    (void)state;
    for (size_t i = 0; i < SF_COUNT(scenes); i++) {
        struct sf_scene *none = live_parse(scenes[i], "method=none"), *scene = live_parse(scenes[i], by_reference);
        const struct sf_renderer_options plain = {.width = 40, .height = 40};
        struct picture empty = live_fresh(none, &plain, 0), same = live_fresh(scene, &plain, 0);
        struct sf_renderer *renderer = live_create(scene, &all);
        struct sf_frame frame = live_frame(renderer, 0);

        assert_true(live_same(&empty, &same));
        for (size_t k = 0; k < (size_t)all.width * all.height; k++) {
            const float *depths = frame.smoke_depths + 4 * k;

            assert_true(depths[0] == SF_NO_DEPTH && depths[1] == SF_NO_DEPTH && depths[2] == 0 && depths[3] == 1);
            assert_true(frame.smoke[4 * k] == 0 && frame.smoke[4 * k + 3] == 0);
        }
        sf_renderer_destroy(&renderer);
        live_free(&empty);
        live_free(&same);
        sf_scene_destroy(&none);
        sf_scene_destroy(&scene);
    }
}

enum { MANY = 20000 };

/* `count` spheres around (0, 1, 0), each of `radius` or a little more, as a scene and as a list. */
static struct sf_scene *many(uint32_t count, double radius, const char *batch, struct sf_particle *list)
{
    static const char head[] =
        "{\"method\":\"reference\",\"camera\":{\"eye\":[0,1,5],\"target\":[0,1,0]},\"lights\":[{\"type\":"
        "\"directional\",\"direction\":[-1,-1.5,-0.4],\"intensity\":2}],\"environment\":{\"type\":\"color\",\"color\":"
        "[0.1,0.1,0.1]},\"sim\":{\"capacity\":20000},\"emitters\":[{\"type\":\"list\",\"still\":true,\"particles\":[";
    size_t room = sizeof head + 160 * (size_t)count + 64, used;
    char *text = malloc(room);
    struct sf_scene *scene;

    assert_non_null(text);
    used = (size_t)snprintf(text, room, "%s", head);
    for (uint32_t i = 0; i < count; i++) {
        float at[5];

        for (uint32_t k = 0; k < 5; k++)
            at[k] = (float)(2.0 * (uint32_t)(2654435761u * (5 * i + k + 1)) / 4294967296.0 - 1);
        list[i] = (struct sf_particle){.x = at[0],
                                       .y = 1 + at[1],
                                       .z = at[2],
                                       .radius = (float)(radius * (1.5 + 0.5 * (double)at[3])),
                                       .extinction = (float)(0.2 + 0.1 * (double)at[4])};
        used += (size_t)snprintf(text + used, room - used,
                                 "%s{\"centre\":[%.9g,%.9g,%.9g],\"radius\":%.9g,\"extinction\":%.9g}", i ? "," : "",
                                 (double)list[i].x, (double)list[i].y, (double)list[i].z, (double)list[i].radius,
                                 (double)list[i].extinction);
    }
    snprintf(text + used, room - used, "]}]}");
    scene = live_parse(text, batch);
    free(text);
    return scene;
}

static void test_many_particles(void **state)
{
    struct sf_particle *list = malloc(MANY * sizeof *list);
    struct sf_scene *scene;
    struct sf_truth_picture *truth;
    struct difference worst;

    (void)state;
    assert_non_null(list);
    scene = many(MANY, 0.03, "reference.samples=512", list);
    truth = truth_of(scene, 0, list, MANY, 12);
    worst = differ(scene, 0, 12, truth);
    print_message("%d particles: transmittance %.1e, radiance %.1e\n", MANY, worst.transmittance, worst.radiance);
    assert_true(worst.transmittance <= 1e-4 && worst.radiance <= 1e-3);
    sf_truth_picture_destroy(&truth);
    sf_scene_destroy(&scene);
    free(list);
}

/* More in one place than a software device's loops may take turns: no picture, and a word why. */
static void test_too_many_are_refused(void **state)
{
    const struct sf_renderer_options small = {.width = 4, .height = 4};
    struct sf_particle *list = malloc(MANY * sizeof *list);
    struct sf_renderer *renderer;
    struct sf_scene *scene;
    struct sf_frame frame;
    uint64_t ticket = 0;

    (void)state;
    assert_non_null(list);
    if (!sf_gpu_tuning(live_device->gpu)->software) {
        free(list);
        skip();
    }
    scene = many(MANY, 1, "reference.batch=64", list);
    renderer = live_create(scene, &small);
    assert_int_equal(sf_renderer_render(renderer, 0, &ticket), SF_OK);
    assert_int_equal(sf_renderer_wait(renderer, ticket, &frame), SF_ERROR_DEVICE);
    assert_non_null(strstr(live_message, "20000 particles lie behind one tile"));
    assert_non_null(strstr(live_message, "reference.batch (64 now)"));
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
    free(list);
}

/* ---- its shadow on the ground ---- */

static double chord_from(const double at[3], const double way[3], const double centre[3], double radius)
{
    double along = 0, away = 0, room, half;

    for (int i = 0; i < 3; i++)
        along += way[i] * (centre[i] - at[i]);
    for (int i = 0; i < 3; i++)
        away += pow(centre[i] - at[i] - along * way[i], 2);
    room = radius * radius - away;
    half = room > 0 ? sqrt(room) : 0;
    return fmax(along + half, 0) - fmax(along - half, 0);
}

/* A ball above a plane that is lit by one light: what the smoke leaves of it, by closed form. */
static void check_ground(const char *light, const double sun[3], const double lamp[3])
{
    static const double centre[3] = {0, 1, 0};
    const struct sf_renderer_options options = {.width = 64, .height = 64, .float_color = true};
    struct picture with, without;
    double worst = 0, deepest = 0;
    char text[700];

    snprintf(
        text, sizeof text,
        "{\"method\":\"reference\",\"reference\":{\"samples\":8,\"shadow_size\":1024},\"camera\":{\"eye\":[0,6,0.01],"
        "\"target\":[0,0,0],\"near\":5.5},\"lights\":[%s],\"objects\":[{\"type\":\"plane\"}],\"environment\":{"
        "\"type\":\"color\",\"color\":[0,0,0]},\"emitters\":[{\"type\":\"list\",\"still\":true,\"particles\":[{"
        "\"centre\":[0,1,0],\"radius\":0.4,\"extinction\":2}]}]}",
        light);
    struct sf_scene *scene = live_parse(text, NULL), *bare = live_parse(text, "reference.ground_shadow=false");
    with = live_fresh(scene, &options, 0);
    without = live_fresh(bare, &options, 0);
    const float *a = (const float *)(const void *)with.data, *b = (const float *)(const void *)without.data;
    const float *depth = a + 4 * 64 * 64;
    for (uint32_t i = 0; i < 64 * 64; i++) {
        double x = 2 * (i % 64 + 0.5) / 64 - 1, y = 1 - 2 * (i / 64 + 0.5) / 64;
        double ray[3], at[3], way[3], length = 0;
        struct sf_camera_pose pose;

        sf_scene_camera(scene, 0, &pose);
        double tangent = tan(pose.fov * 3.14159265358979 / 360), c = 6 / sqrt(36 + 1e-4), s = 0.01 / sqrt(36 + 1e-4);
        ray[0] = x * tangent;
        ray[1] = -c + y * tangent * s;
        ray[2] = -s - y * tangent * c;
        at[0] = depth[i] * ray[0];
        at[1] = 0;
        at[2] = 0.01 + depth[i] * ray[2];
        for (int k = 0; k < 3; k++) {
            way[k] = lamp ? lamp[k] - at[k] : -sun[k];
            length += way[k] * way[k];
        }
        for (int k = 0; k < 3; k++)
            way[k] /= sqrt(length);
        double left = exp(-2 * chord_from(at, way, centre, 0.4));
        worst = fmax(worst, fabs(a[4 * i] / b[4 * i] - left));
        deepest = fmax(deepest, 1 - left);
    }
    print_message("ground: %.1e of at most %.2f\n", worst, deepest);
    assert_true(worst < 0.03 && deepest > 0.6);
    live_free(&with);
    live_free(&without);
    sf_scene_destroy(&scene);
    sf_scene_destroy(&bare);
}

static void test_ground_shadow(void **state)
{
    static const double sun[3] = {0.3, -1, 0.2}, lamp[3] = {0.2, 3, 0.3};

    (void)state;
    check_ground("{\"type\":\"directional\",\"direction\":[0.3,-1,0.2]}", sun, NULL);
    check_ground("{\"type\":\"point\",\"position\":[0.2,3,0.3],\"intensity\":9}", NULL, lamp);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_truth_scenes),
        cmocka_unit_test(test_outlines),
        cmocka_unit_test(test_more_samples_are_nearer),
        cmocka_unit_test(test_the_same_bits),
        cmocka_unit_test(test_changes_begin_anew),
        cmocka_unit_test(test_lists_without_room),
        cmocka_unit_test(test_no_particles),
        cmocka_unit_test(test_many_particles),
        cmocka_unit_test(test_too_many_are_refused),
        cmocka_unit_test(test_ground_shadow),
    };

    return live_probe() ? 77 : cmocka_run_group_tests(tests, live_open, live_close);
}
