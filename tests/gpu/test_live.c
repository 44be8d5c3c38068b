/* The renderer as it changes while it runs: options, views, scenes that cannot be, memory, what is looked at, and the
 * printed graphs; with validation. test_live_controls.c goes through the parameters. */
#include "live_kit.h"

#include <jansson.h>
#include <math.h>
#include "output/half.h"
#include "shared/frame.h"
#include "shared/particle.h"

enum { SIDE = 64 };
static const struct sf_renderer_options plain = {.width = SIDE, .height = SIDE};

/* ---- options ---- */

/* Sizes, formats, what comes back: each time the picture of a fresh renderer, and no step made twice. */
static void test_options(void **state)
{
    static const struct sf_renderer_options all[] = {
        {.width = 1, .height = 1},
        {.width = 37, .height = 53, .aovs = SF_AOV_SMOKE | SF_AOV_DEPTHS},
        {.width = 130, .height = 90, .float_color = true, .timing = true, .frames_kept = 8},
        {.width = 37, .height = 53, .inspect = "light.raw"},
        {.width = 64, .height = 64, .shown = true, .returned = true, .aovs = SF_AOV_DEPTHS},
        {.width = 3, .height = 200, .timing = true, .frames_kept = 1},
    };
    struct sf_scene *scene = live_parse(live_sky, NULL);
    struct sf_renderer *renderer = live_create(scene, &plain);
    const struct sf_pass_timing *timings;
    uint64_t ticket;
    uint32_t count;

    (void)state;
    live_frame(renderer, 3);
    for (uint32_t i = 0; i < SF_COUNT(all); i++) {
        struct sf_frame frame;

        assert_int_equal(sf_renderer_set_options(renderer, &all[i]), SF_OK);
        assert_false(live_restarted(renderer, 4 + i));
        live_compare(renderer, scene, &all[i], 4 + i, "options");
        assert_int_equal(sf_renderer_render(renderer, 4 + i, &ticket), SF_OK);
        assert_int_equal(sf_renderer_wait(renderer, ticket, &frame), SF_OK);
        assert_true(!!frame.inspected == !!all[i].inspect);
        assert_true(!!frame.smoke == !!(all[i].aovs & SF_AOV_SMOKE));
        assert_int_equal(sf_renderer_timings(renderer, ticket, &timings, &count),
                         all[i].timing ? SF_OK : SF_ERROR_USAGE);
        assert_true(count > 10 || !all[i].timing);
    }
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
}

/* The simulation's passes are timed too, in a renderer that first was made without. */
static void test_timing_later(void **state)
{
    struct sf_scene *scene = live_parse(live_sky, NULL);
    struct sf_renderer *renderer = live_create(scene, &plain);
    const struct sf_renderer_options timed = {.width = SIDE, .height = SIDE, .timing = true, .frames_kept = 4};
    const struct sf_pass_timing *timings;
    struct sf_frame frame;
    uint64_t tickets[4];
    uint32_t count;

    (void)state;
    live_frame(renderer, 3);
    assert_int_equal(sf_renderer_set_options(renderer, &timed), SF_OK);
    for (uint32_t i = 0; i < 4; i++)
        assert_int_equal(sf_renderer_render(renderer, 4 + i, &tickets[i]), SF_OK);
    for (uint32_t i = 0; i < 4; i++) {
        assert_int_equal(sf_renderer_wait(renderer, tickets[i], &frame), SF_OK);
        assert_int_equal(sf_renderer_timings(renderer, tickets[i], &timings, &count), SF_OK);
        assert_string_equal(timings[0].name, "sim.count");
        assert_string_equal(timings[count - 1].name, "output.counts");
        assert_true(timings[0].end_ns > timings[0].begin_ns && timings[count - 1].end_ns >= timings[0].end_ns);
    }
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
}

/* Its pixels, which the inspected copy tells. */
static void check_shown(struct sf_renderer *renderer, const struct sf_scene *scene, bool float_color, uint32_t number)
{
    const struct sf_renderer_options back = {.width = SIDE, .height = SIDE, .float_color = float_color};
    struct sf_renderer *other = live_create(scene, &back);
    struct sf_frame shown = live_frame(renderer, number), want = live_frame(other, number);
    uint32_t width, height;
    bool is_float;

    assert_non_null(sf_renderer_shown(renderer, &width, &height, &is_float));
    assert_true(width == SIDE && height == SIDE && is_float == float_color);
    assert_true(!shown.color && !shown.color_float && !shown.depth && !shown.smoke);
    assert_true(shown.live == want.live && shown.live > 0 && shown.bounds_min[0] == want.bounds_min[0]);
    assert_non_null(shown.inspected);
    for (size_t i = 0; i < (size_t)SIDE * SIDE * 4; i++)
        assert_true(shown.inspected[i] == (float_color ? want.color_float[i] : sf_half_to_float(want.color[i])));
    sf_renderer_destroy(&other);
}

static void test_shown(void **state)
{
    struct sf_renderer_options options = {
        .width = SIDE, .height = SIDE, .shown = true, .inspect = "color", .aovs = SF_AOV_SMOKE};
    struct sf_scene *scene = live_parse(live_sky, NULL), *other = live_parse(live_sky, "thick.steps=3");
    struct sf_renderer *renderer = live_create(scene, &options);
    struct sf_gpu_image *image;
    uint32_t width, height;
    bool is_float;

    (void)state;
    assert_null(sf_renderer_shown(renderer, &width, &height, &is_float));
    check_shown(renderer, scene, false, 3);
    image = sf_renderer_shown(renderer, &width, &height, &is_float);
    /* Another graph that draws the same picture size goes on in the same image: what is seen does not blink. */
    assert_int_equal(sf_renderer_set_scene(renderer, other), SF_OK);
    assert_ptr_equal(sf_renderer_shown(renderer, &width, &height, &is_float), image);
    check_shown(renderer, other, false, 4);
    options.float_color = true;
    assert_int_equal(sf_renderer_set_options(renderer, &options), SF_OK);
    assert_null(sf_renderer_shown(renderer, &width, &height, &is_float));
    check_shown(renderer, other, true, 4);
    assert_int_equal(sf_renderer_set_options(renderer, &plain), SF_OK);
    live_frame(renderer, 5);
    assert_null(sf_renderer_shown(renderer, &width, &height, &is_float));
    options.float_color = false;
    assert_int_equal(sf_renderer_set_options(renderer, &options), SF_OK);
    check_shown(renderer, other, false, 5);
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&other);
    sf_scene_destroy(&scene);
}

/* ---- whole scenes ---- */

/* From each of some scenes to others that share nothing with them, and to the last again by another way. */
static void test_scenes(void **state)
{
    static const char *const names[] = {"all", "cube", "empty", "latlong", "list-ply", "mesh", "overlap"};
    enum { FILES = SF_COUNT(names), COUNT = FILES + 2 };
    const char *root = getenv("SF_SOURCE_ROOT");
    struct sf_scene *scenes[COUNT] = {live_parse(live_sky, NULL), live_parse(live_lists, NULL)};
    struct sf_renderer *renderer = live_create(scenes[0], &plain);

    (void)state;
    for (size_t i = 0; i < FILES; i++) {
        char path[1024];

        snprintf(path, sizeof path, "%s/scenes/tiny/%s.json", root ? root : ".", names[i]);
        assert_int_equal(sf_scene_load(path, NULL, 0, &live_log, &scenes[2 + i]), SF_OK);
    }
    for (uint32_t stride = 1; stride <= 4; stride++) {
        for (uint32_t i = 0; i < COUNT; i++) {
            const struct sf_scene *scene = scenes[i * stride % COUNT];
            char what[64];

            snprintf(what, sizeof what, "stride %u, scene %u", stride, i);
            live_frame(renderer, 3);
            if (sf_renderer_set_scene(renderer, scene) != SF_OK)
                fail_msg("%s: %s", what, live_message);
            live_compare(renderer, scene, &plain, 4, what);
        }
    }
    sf_renderer_destroy(&renderer);
    for (size_t i = 0; i < COUNT; i++)
        sf_scene_destroy(&scenes[i]);
}

/* ---- views ---- */

static void test_view(void **state)
{
    static const struct sf_camera_view views[] = {
        {.eye = {0.3f, 1.1f, 2.7f}, .target = {0.1f, 0.6f, 0}, .up = {0, 1, 0}, .fov = 52.5f, .near_clip = 0.05f},
        {.eye = {-1.7f, 0.4f, 0.9f}, .target = {0, 0.8f, 0.2f}, .up = {0.2f, 1, 0}, .fov = 33, .near_clip = 0.3f},
    };
    struct sf_scene *scene = live_parse(live_sky, NULL), *camera;
    struct sf_renderer *renderer = live_create(scene, &plain);
    struct sf_camera_view bad = views[0], found;

    (void)state;
    for (size_t i = 0; i < SF_COUNT(views); i++) {
        const struct sf_camera_view *v = &views[i];
        char eye[96], target[96], up[96], fov[48], near[48];
        const char *const sets[] = {"camera.type=fixed", eye, target, up, fov, near};

        snprintf(eye, sizeof eye, "camera.eye=%.9g,%.9g,%.9g", v->eye[0], v->eye[1], v->eye[2]);
        snprintf(target, sizeof target, "camera.target=%.9g,%.9g,%.9g", v->target[0], v->target[1], v->target[2]);
        snprintf(up, sizeof up, "camera.up=%.9g,%.9g,%.9g", v->up[0], v->up[1], v->up[2]);
        snprintf(fov, sizeof fov, "camera.fov=%.9g", v->fov);
        snprintf(near, sizeof near, "camera.near=%.9g", v->near_clip);
        camera = live_try(live_sky, sets, SF_COUNT(sets));
        assert_non_null(camera);
        sf_renderer_set_view(renderer, v);
        live_compare(renderer, camera, &plain, 3, "view");
        sf_scene_destroy(&camera);
    }
    /* The scene's own again; and it is what sf_scene_view says. */
    sf_renderer_set_view(renderer, NULL);
    live_compare(renderer, scene, &plain, 3, "no view");
    sf_scene_view(scene, 3.0 / 24, &found);
    sf_renderer_set_view(renderer, &found);
    live_compare(renderer, scene, &plain, 3, "the scene's view");
    /* What no camera can be is not taken. */
    memcpy(bad.target, bad.eye, sizeof bad.eye);
    sf_renderer_set_view(renderer, &bad);
    live_compare(renderer, scene, &plain, 3, "eye at its target");
    bad = views[0];
    bad.eye[1] = NAN;
    sf_renderer_set_view(renderer, &bad);
    live_compare(renderer, scene, &plain, 3, "no number");
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
}

/* ---- what cannot be ---- */

static void test_failures(void **state)
{
    static const struct {
        const char *set;
        enum sf_status status;
        const char *why;
    } scenes[] = {
        {"sim.capacity=1000000", SF_ERROR_MEMORY, "'light.list' needs"},
        {"shadow.map_size=8192", SF_ERROR_MEMORY, "'shadow.map' needs"},
        {"thick.light_size=1024", SF_ERROR_MEMORY, "budget"},
        {"method=none", SF_ERROR_USAGE, "no image or buffer 'light.raw'"},
    };
    static const struct sf_renderer_options bad[] = {{.width = 0, .height = 5},
                                                     {.width = 4000, .height = 4000},
                                                     {.width = 9, .height = 9, .inspect = "nothing"},
                                                     {.width = 9, .height = 9, .frames_kept = 9}};
    const struct sf_renderer_options options = {.width = SIDE, .height = SIDE, .inspect = "light.raw"};
    const struct sf_device_options limited = {.validate = true, .no_cache = true, .budget_bytes = 96 << 20};
    struct sf_device *usual = live_device;
    struct sf_scene *scene = live_parse(live_sky, "lights.1.type=spot");
    struct sf_renderer *renderer;

    (void)state;
    assert_int_equal(sf_device_create(&limited, &live_log, &live_device), SF_OK);
    renderer = live_create(scene, &options);
    live_frame(renderer, 3);
    for (uint32_t i = 0; i < SF_COUNT(scenes) + SF_COUNT(bad); i++) {
        if (i < SF_COUNT(scenes)) {
            const char *sets[] = {scenes[i].set, "sim.seed=9", "objects.1.position=0.1,0.2,0.3"};
            struct sf_scene *other = live_try(live_sky, sets, 3);

            assert_non_null(other);
            enum sf_status status = sf_renderer_set_scene(renderer, other);
            if (status != scenes[i].status || !strstr(live_message, scenes[i].why))
                fail_msg("%s: %s: %s", scenes[i].set, sf_status_name(status), live_message);
            sf_scene_destroy(&other);
        } else {
            assert_int_not_equal(sf_renderer_set_options(renderer, &bad[i - SF_COUNT(scenes)]), SF_OK);
        }
        assert_false(live_restarted(renderer, 4 + i));
        live_compare(renderer, scene, &options, 4 + i, "after a failure");
    }
    sf_renderer_destroy(&renderer);
    assert_int_equal(sf_device_validation_messages(live_device), 0);
    sf_device_destroy(&live_device);
    sf_scene_destroy(&scene);
    live_device = usual;
}

/* ---- tickets, and stopping ---- */

static bool stop_at_twenty(void *user, uint64_t done, uint64_t total)
{
    (void)total;
    *(uint64_t *)user = done;
    return done < 20;
}

static void test_tickets(void **state)
{
    struct sf_scene *scene = live_parse(live_sky, NULL), *value = live_parse(live_sky, "medium.g=0.5"),
                    *graph = live_parse(live_sky, "thick.steps=3");
    struct sf_renderer *renderer = live_create(scene, &plain);
    struct sf_frame frame;
    uint64_t tickets[2], done = 0;

    (void)state;
    assert_int_equal(sf_renderer_render(renderer, 3, &tickets[0]), SF_OK);
    assert_int_equal(sf_renderer_set_scene(renderer, value), SF_OK);
    sf_scene_destroy(&scene); /* it may go now */
    assert_int_equal(sf_renderer_wait(renderer, tickets[0], &frame), SF_OK);
    assert_non_null(frame.color);
    assert_int_equal(sf_renderer_set_scene(renderer, graph), SF_OK);
    assert_int_equal(sf_renderer_wait(renderer, tickets[0], &frame), SF_ERROR_USAGE);
    assert_non_null(strstr(live_message, "made anew"));
    assert_int_equal(sf_renderer_render(renderer, 4, &tickets[1]), SF_OK);
    assert_int_equal(sf_renderer_wait(renderer, tickets[0], &frame), SF_ERROR_USAGE);
    assert_int_equal(sf_renderer_wait(renderer, tickets[1], &frame), SF_OK);
    assert_int_equal(sf_renderer_set_options(renderer, &plain), SF_OK);
    assert_int_equal(sf_renderer_wait(renderer, tickets[1], &frame), SF_ERROR_USAGE);

    /* Whoever stops it knows that it was stopped; and nothing is lost. */
    live_errors = 0;
    assert_int_equal(sf_renderer_seek(renderer, 40, stop_at_twenty, &done), SF_ERROR_INTERRUPTED);
    assert_int_equal(live_errors, 0);
    assert_non_null(strstr(live_said, "was stopped at step"));
    assert_true(sf_particles_steps(renderer->particles) > 14 + 16);
    done = 0;
    assert_int_equal(sf_renderer_seek(renderer, 20, stop_at_twenty, &done), SF_OK);
    assert_true(done <= 16);
    live_compare(renderer, graph, &plain, 20, "after stopping");
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&graph);
    sf_scene_destroy(&value);
}

/* ---- memory ---- */

static uint64_t memory_used(void)
{
    uint64_t used, budget;

    sf_device_memory(live_device, &used, &budget);
    return used;
}

/* Other options, or another scene; then sometimes a frame. */
static void change_somehow(struct sf_renderer *renderer, struct sf_scene *const *scenes, uint32_t count,
                           uint32_t random)
{
    static const char *const looked[] = {NULL, "color", "counts", "objects", "particles"};
    const struct sf_renderer_options options = {.width = 1 + (random >> 8) % 150,
                                                .height = 1 + (random >> 16) % 120,
                                                .shown = random >> 24 & 1,
                                                .returned = random >> 25 & 1,
                                                .timing = random >> 26 & 1,
                                                .float_color = random >> 27 & 1,
                                                .aovs = random >> 28 & 3,
                                                .inspect = looked[(random >> 12) % SF_COUNT(looked)]};
    enum sf_status status = random >> 31 ? sf_renderer_set_options(renderer, &options)
                                         : sf_renderer_set_scene(renderer, scenes[(random >> 10) % count]);

    if (status != SF_OK)
        fail_msg("%s", live_message);
    if (random >> 20 & 1)
        live_frame(renderer, (random >> 21) % 7);
}

/* A device of little memory takes it in small blocks, so that what is left behind shows. Blocks that are there for a
 * hole's sake may stay as long as the renderer lives, and no longer. */
static void test_memory(void **state)
{
    static const char *const sets[] = {
        NULL,          "thick.light_size=100",  "sim.capacity=3000",         "shadow.map_size=200",
        "method=none", "thick.resolution=full", "lights.0.direction=1,-1,1", "environment.visible=false",
        "sim.seed=3",  "medium.g=0.1"};
    enum { HOLES = 2 };
    const struct sf_device_options limited = {.validate = true, .no_cache = true, .budget_bytes = 24 << 20};
    const uint64_t block = limited.budget_bytes / 8;
    struct sf_device *usual = live_device;
    struct sf_scene *scenes[2 * SF_COUNT(sets)];
    struct sf_renderer *renderer;
    uint32_t random = 1;

    (void)state;
    for (size_t i = 0; i < SF_COUNT(sets); i++) {
        scenes[2 * i] = live_parse(live_sky, sets[i]);
        scenes[2 * i + 1] = live_parse(live_lists, i == 6 ? NULL : sets[i]);
    }
    assert_int_equal(sf_device_create(&limited, &live_log, &live_device), SF_OK);
    renderer = live_create(scenes[0], &plain);
    live_frame(renderer, 3);
    live_frame(renderer, 4);
    uint64_t used = memory_used();
    sf_renderer_destroy(&renderer);
    uint64_t idle = memory_used(); /* the device's own, for frames in flight */
    renderer = live_create(scenes[0], &plain);
    for (int i = 0; i < 200; i++) {
        random = random * 1664525u + 1013904223u;
        change_somehow(renderer, scenes, SF_COUNT(scenes), random);
    }
    assert_int_equal(sf_renderer_set_options(renderer, &plain), SF_OK);
    assert_int_equal(sf_renderer_set_scene(renderer, scenes[0]), SF_OK);
    live_compare(renderer, scenes[0], &plain, 3, "after 200 changes");
    if (memory_used() > used + HOLES * block)
        fail_msg("%llu bytes are used after 200 changes, %llu before", (unsigned long long)memory_used(),
                 (unsigned long long)used);
    sf_renderer_destroy(&renderer);
    if (memory_used() != idle)
        fail_msg("%llu bytes are left of 200 changes, %llu of none", (unsigned long long)memory_used(),
                 (unsigned long long)idle);
    assert_int_equal(sf_device_validation_messages(live_device), 0);
    live_errors = 0;
    sf_device_destroy(&live_device);
    assert_int_equal(live_errors, 0); /* the layers see what is left behind */
    for (size_t i = 0; i < SF_COUNT(scenes); i++)
        sf_scene_destroy(&scenes[i]);
    live_device = usual;
}

/* ---- looking at buffers ---- */

static struct sf_renderer *look(const struct sf_scene *scene, const char *name)
{
    const struct sf_renderer_options options = {.width = SIDE, .height = SIDE, .inspect = name};

    return live_create(scene, &options);
}

static void test_words(void **state)
{
    struct sf_scene *scene = live_parse(live_sky, "sim.capacity=2000");
    struct sf_renderer *renderer = look(scene, "counts");
    struct sf_renderer_options options = {.width = SIDE, .height = SIDE};
    struct sf_frame frame = live_frame(renderer, 5);
    struct sf_particle_counts counts;
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};

    (void)state;
    assert_null(frame.inspected);
    assert_int_equal(frame.inspected_word_count, sizeof counts / 4);
    memcpy(&counts, frame.inspected_words, sizeof counts);
    assert_true(counts.live == frame.live && counts.live > 20 && counts.capacity == 2000);
    assert_int_equal(counts.step, sf_particles_steps(renderer->particles));

    /* The list, of which the front comes back: its spheres' bounds are the frame's. */
    options.inspect = "particles";
    assert_int_equal(sf_renderer_set_options(renderer, &options), SF_OK);
    frame = live_frame(renderer, 5);
    assert_int_equal(frame.inspected_word_count, 16384);
    for (uint32_t i = 0; i < frame.live; i++) {
        struct sf_particle particle;

        memcpy(&particle, frame.inspected_words + 16 * i, sizeof particle);
        const float centre[3] = {particle.x, particle.y, particle.z};
        for (int k = 0; k < 3; k++) {
            low[k] = fminf(low[k], centre[k] - particle.radius);
            high[k] = fmaxf(high[k], centre[k] + particle.radius);
        }
    }
    assert_memory_equal(frame.bounds_min, low, sizeof low);
    assert_memory_equal(frame.bounds_max, high, sizeof high);

    /* What the CPU wrote. */
    options.inspect = "frame";
    assert_int_equal(sf_renderer_set_options(renderer, &options), SF_OK);
    frame = live_frame(renderer, 5);
    assert_int_equal(frame.inspected_word_count, sizeof(struct sf_gpu_frame) / 4);
    assert_int_equal(frame.inspected_words[offsetof(struct sf_gpu_frame, frame_number) / 4], 5);
    options.inspect = "light.rau";
    assert_int_equal(sf_renderer_set_options(renderer, &options), SF_ERROR_USAGE);
    assert_non_null(strstr(live_message, "did you mean 'light.raw'"));
    assert_non_null(strstr(live_message, "counts, "));
    assert_null(strstr(live_message, "read."));
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);

    /* No smoke, no bounds. */
    scene = live_parse("{}", NULL);
    renderer = live_create(scene, &plain);
    frame = live_frame(renderer, 0);
    assert_true(frame.live == 0 && frame.bounds_min[1] > frame.bounds_max[1]);
    assert_null(frame.inspected_words);
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
}

/* ---- the printed graphs ---- */

static bool listed(const json_t *resources, const char *name)
{
    const json_t *resource;
    size_t i;

    json_array_foreach(resources, i, resource)
    {
        if (strcmp(json_string_value(json_object_get(resource, "name")), name) == 0)
            return true;
    }
    return false;
}

/* Every pass with what it reads and writes, all of it there. */
static size_t check_graph(const json_t *graph)
{
    const json_t *resources = json_object_get(graph, "resources"), *passes = json_object_get(graph, "passes"), *pass,
                 *name;
    static const char *const lists[] = {"reads", "writes"};
    size_t i, j;

    json_array_foreach(passes, i, pass)
    {
        size_t names = 0;

        assert_true(json_is_string(json_object_get(pass, "name")) && json_is_string(json_object_get(pass, "kind")));
        assert_true(json_is_integer(json_object_get(pass, "bytes_read")) &&
                    json_is_integer(json_object_get(pass, "bytes_written")));
        for (size_t l = 0; l < 2; l++) {
            json_array_foreach(json_object_get(pass, lists[l]), j, name)
            {
                assert_true(listed(resources, json_string_value(name)));
                names++;
            }
        }
        assert_true(names >= 1 && json_array_size(json_object_get(pass, "writes")) >= 1);
    }
    return json_array_size(passes);
}

static void test_graph_print(void **state)
{
    struct sf_scene *scene = live_parse(live_sky, NULL), *none = live_parse(live_sky, "method=none");
    const struct sf_renderer_options options = {.width = 50, .height = 30, .shown = true};
    struct sf_renderer *renderer = live_create(scene, &options);
    static const char *const names[] = {"sim", "shadow", "frame"};
    char *text = NULL;
    json_t *root, *graphs;

    (void)state;
    assert_int_equal(sf_renderer_graph_print(renderer, "json", &text), SF_OK);
    root = json_loads(text, 0, NULL);
    graphs = json_object_get(root, "graphs");
    assert_int_equal(json_array_size(graphs), 3);
    for (size_t i = 0; i < 3; i++) {
        const json_t *graph = json_array_get(graphs, i);

        assert_string_equal(json_string_value(json_object_get(graph, "graph")), names[i]);
        assert_true(check_graph(graph) >= 3);
    }
    json_decref(root);
    assert_non_null(strstr(text, "thick.march"));
    assert_null(strstr(text, "read.color"));
    free(text);
    assert_int_equal(sf_renderer_set_scene(renderer, none), SF_OK);
    assert_int_equal(sf_renderer_graph_print(renderer, "text", &text), SF_OK);
    assert_null(strstr(text, "thick.march"));
    assert_non_null(strstr(text, "color     "));
    assert_non_null(strstr(text, "rgba16f 50x30"));
    free(text);
    assert_int_equal(sf_renderer_graph_print(renderer, "dot", &text), SF_OK);
    free(text);
    assert_int_equal(sf_renderer_graph_print(renderer, "txt", &text), SF_ERROR_USAGE);
    assert_null(text);
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&none);
    sf_scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_options),     cmocka_unit_test(test_timing_later), cmocka_unit_test(test_shown),
        cmocka_unit_test(test_scenes),      cmocka_unit_test(test_view),         cmocka_unit_test(test_failures),
        cmocka_unit_test(test_tickets),     cmocka_unit_test(test_memory),       cmocka_unit_test(test_words),
        cmocka_unit_test(test_graph_print),
    };

    return live_probe() ? 77 : cmocka_run_group_tests(tests, live_open, live_close);
}
