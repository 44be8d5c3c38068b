/* What a step costs with few particles and with a million, and what is refused. */
#include "particles_kit.h"

static double fastest_step(struct sf_particles *particles, int frames, double pass_ms[3])
{
    double best = 1e9;

    for (int i = 0; i < frames; i++) {
        const struct sf_pass_time *times;
        uint32_t count;
        uint64_t serial = advance_steps(particles, 1, 1);
        double total;

        assert_int_equal(sf_player_times(sf_particles_player(particles), serial, &times, &count), SF_OK);
        assert_int_equal(count, 3);
        total = (double)(times[2].end_ns - times[0].begin_ns) / 1e6;
        if (total < best) {
            best = total;
            for (int j = 0; j < 3; j++)
                pass_ms[j] = (double)(times[j].end_ns - times[j].begin_ns) / 1e6;
        }
    }
    return best;
}

static void plume(struct sf_scene *scene, uint32_t live)
{
    struct sf_emitter *emitter;

    scene_init(scene, (int32_t)live);
    emitter = add_emitter(scene, SF_EMITTER_CONE);
    emitter->rate = (float)live / 4;
    emitter->angle = 15;
    emitter->lifetime[0] = emitter->lifetime[1] = 4;
    emitter->speed[0] = emitter->speed[1] = 1;
    emitter->growth = 0.1f;
    emitter->dilution = 0.3f;
    emitter->fade_out = 0.5f;
    emitter->temperature = 30;
    emitter->cooling = 0.4f;
    add_force(scene, SF_FORCE_BUOYANCY, 0.05f);
    add_force(scene, SF_FORCE_DRAG, 1);
    add_force(scene, SF_FORCE_TURBULENCE, 1)->octaves = 3;
    add_object(scene, SF_OBJECT_PLANE, 0, 0, 0);
    add_object(scene, SF_OBJECT_BOX, 1.5f, 0.5f, 0);
    add_object(scene, SF_OBJECT_SPHERE, -1.5f, 0.5f, 0);
}

static void few_particles_cost_little(void **state)
{
    struct sf_scene scene;
    struct sf_particles *particles;
    struct snapshot shot;
    double pass_ms[3] = {0}, best;

    (void)state;
    plume(&scene, 512);
    particles = start(&scene);
    sf_player_set_timing(sf_particles_player(particles), true);
    advance_steps(particles, 400, 100);
    best = fastest_step(particles, 200, pass_ms);
    shot = take(particles);
    check(&shot);
    print_message(
        "%u particles: %.3f ms a step at best (count %.3f, step %.3f, emit %.3f); recording it takes the CPU %.3f ms\n",
        shot.counts.live, best, pass_ms[0], pass_ms[1], pass_ms[2],
        (double)sf_player_record_ns(sf_particles_player(particles)) / 1e6);
    assert_true(shot.counts.live > 500);
    free(shot.list);
    sf_particles_destroy(&particles);
}

static void a_million_live(void **state)
{
    const uint32_t million = 1u << 20;
    struct sf_scene scene;
    struct sf_particles *particles;
    struct snapshot shot;
    double pass_ms[3] = {0}, best;

    (void)state;
    plume(&scene, million);
    scene.emitters[0].burst = (int32_t)million;
    scene.emitters[0].lifetime[0] = scene.emitters[0].lifetime[1] = 100;
    particles = start(&scene);
    sf_player_set_timing(sf_particles_player(particles), true);
    advance_steps(particles, 1, 1);
    shot = take(particles);
    check(&shot);
    assert_int_equal(shot.counts.live, million);
    assert_int_equal(shot.counts.dropped, million / 256);
    free(shot.list);
    best = fastest_step(particles, 5, pass_ms);
    shot = take(particles);
    check(&shot);
    assert_int_equal(shot.counts.live, million);
    /* Floors: 128 bytes moved and some 2,600 operations (three octaves of 8 corners) a particle, at the device's
     * ceilings of 26 GB/s and 49 Gop/s. */
    print_message("a million particles: %.1f ms a step at best, %.1f M/s (count %.1f, step %.1f, emit %.1f); floors: "
                  "memory %.1f ms, arithmetic %.1f ms\n",
                  best, million / best / 1e3, pass_ms[0], pass_ms[1], pass_ms[2], million * 128 / 26e6,
                  million * 2600.0 / 49e6);
    free(shot.list);
    sf_particles_destroy(&particles);
}

/* ---- misuse ---- */

static void refuse(const struct sf_scene *scene, const char *why)
{
    struct sf_particles *particles = NULL;

    kit_forget();
    assert_int_equal(sf_particles_create(kit_device, scene, &kit_log, &particles), SF_ERROR_SCENE);
    assert_null(particles);
    assert_int_equal(kit_record.errors, 1);
    if (!strstr(kit_record.last, why))
        fail_msg("'%s' does not say '%s'", kit_record.last, why);
    kit_forget();
}

static void what_cannot_be_is_refused(void **state)
{
    struct sf_listed list[3] = {{.radius = 1}, {.radius = 1}, {.radius = 1}};
    float corners[9] = {0};
    uint32_t indices[3] = {0, 1, 2};
    struct sf_particles *particles = NULL;
    struct sf_scene scene;

    (void)state;
    scene_init(&scene, 2);
    add_list(&scene, list, 3);
    refuse(&scene, "lists 3");
    scene_init(&scene, (1 << 20) + 1);
    refuse(&scene, "/sim/capacity");
    scene_init(&scene, 2);
    scene.meshes[0] = (struct sf_mesh){
        .file = "flat.obj", .positions = corners, .indices = indices, .vertex_count = 3, .index_count = 3};
    add_emitter(&scene, SF_EMITTER_MESH);
    refuse(&scene, "flat.obj");

    scene_init(&scene, 2);
    particles = start(&scene);
    assert_int_equal(sf_particles_step(particles), SF_ERROR_INTERNAL);
    assert_int_equal(sf_particles_steps(particles), 0);
    kit_forget();
    sf_particles_destroy(&particles);
    sf_particles_destroy(&particles);
}

/* A device with little memory says how many it can hold. */
static void capacity_beyond_the_memory_is_refused(void **state)
{
    struct sf_gpu *usual = kit_device;
    struct sf_scene scene;

    (void)state;
    kit_device = kit_gpu(64 << 20);
    scene_init(&scene, 1 << 20);
    refuse(&scene, "this device holds");
    kit_finish(&kit_device);
    kit_device = usual;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(few_particles_cost_little),
        cmocka_unit_test(a_million_live),
        cmocka_unit_test(what_cannot_be_is_refused),
        cmocka_unit_test(capacity_beyond_the_memory_is_refused),
    };
    int skip = kit_probe();

    return skip ? skip : cmocka_run_group_tests(tests, open_device, close_device);
}
