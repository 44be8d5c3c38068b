/* The life of particles: births, order, death, capacity, and the same bits again and again. */
#include "particles_kit.h"

#include <sys/wait.h>
#include <unistd.h>
#include "base/hash.h"

static bool same_bits(const struct snapshot *a, const struct snapshot *b)
{
    return memcmp(&a->counts, &b->counts, sizeof a->counts) == 0 &&
           memcmp(a->list, b->list, a->counts.live * sizeof *a->list) == 0;
}

/* Something of everything: all forces, obstacles, five emitters, deaths, and a capacity that is reached. */
static void rich_scene(struct sf_scene *scene)
{
    static struct sf_path_key path[] = {{0, {0, 0, 0}}, {1, {1, 0.5f, 0}}, {2, {0, 0, 1}}};
    static struct sf_listed list[] = {{{0, 1, 0}, 0.3f, 2, {0, 0, 0}, 0, 0, 1, 0},
                                      {{0.5f, 1, 0}, 0.2f, 3, {0, 1, 0}, 0, 1.5f, 2, 1}};
    struct sf_emitter *emitter;

    scene_init(scene, 450);
    emitter = add_emitter(scene, SF_EMITTER_CONE);
    emitter->rate = 333;
    emitter->angle = 20;
    memcpy(emitter->lifetime, (float[]){0.4f, 1.5f}, sizeof emitter->lifetime);
    memcpy(emitter->speed, (float[]){0.5f, 2}, sizeof emitter->speed);
    emitter->growth = 0.3f;
    emitter->dilution = 0.5f;
    emitter->fade_in = 0.1f;
    emitter->fade_out = 0.4f;
    emitter->temperature = 40;
    emitter->cooling = 0.7f;
    emitter->spin = 1;
    emitter->path = path;
    emitter->path_count = 3;
    emitter->inherit = 0.5f;
    emitter = add_emitter(scene, SF_EMITTER_SPHERE);
    emitter->burst = 300;
    emitter->start = 0.3f;
    memset(emitter->direction, 0, sizeof emitter->direction);
    memcpy(emitter->lifetime, (float[]){0.2f, 2}, sizeof emitter->lifetime);
    emitter->speed[1] = 3;
    emitter = add_emitter(scene, SF_EMITTER_BOX);
    emitter->rate = 200;
    emitter->duration = 0.7f;
    emitter->surface = true;
    add_list(scene, list, 2);
    add_list(scene, list, 2)->start = 0.51f;
    add_object(scene, SF_OBJECT_PLANE, 0, -0.2f, 0)->restitution = 0.3f;
    add_object(scene, SF_OBJECT_BOX, 0.5f, 1, 0)->rotation[1] = 30;
    add_object(scene, SF_OBJECT_CYLINDER, -0.7f, 0.8f, 0)->radius = 0.2f;
    add_force(scene, SF_FORCE_GRAVITY, 0)->acceleration[1] = -3;
    add_force(scene, SF_FORCE_BUOYANCY, 0.2f);
    add_force(scene, SF_FORCE_DRAG, 1);
    add_force(scene, SF_FORCE_WIND, 0)->velocity[0] = 0.3f;
    add_force(scene, SF_FORCE_TURBULENCE, 1)->octaves = 3;
    add_force(scene, SF_FORCE_VORTEX, 1);
}

static void counts_are_conserved(void **state)
{
    struct sf_scene scene;
    struct sf_particles *particles;
    uint32_t deaths = 0, dropped = 0;

    (void)state;
    rich_scene(&scene);
    particles = start(&scene);
    for (uint32_t step = 0; step <= 160; step += 2) {
        double t = step / 64.0;
        struct snapshot shot = take(particles);
        uint32_t births = (uint32_t)(floor(333 * t + 1e-6) + (t > 0.3 ? 300 : 0) + floor(200 * fmin(t, 0.7f) + 1e-6) +
                                     2 + (t > 0.51 ? 2 : 0));

        check(&shot);
        assert_int_equal(shot.counts.step, step);
        assert_int_equal(shot.counts.births, births);
        deaths = shot.counts.deaths;
        dropped = shot.counts.dropped;
        free(shot.list);
        advance_steps(particles, 2, 2);
    }
    assert_true(deaths > 0 && dropped > 0); /* or the scene tests nothing */
    assert_int_equal(sf_particles_steps(particles), 162);
    assert_true(sf_particles_dt(particles) == 1 / 64.0);
    sf_particles_destroy(&particles);
}

/* Each particle of a stream was born when its number says, and dies when its time has come. */
static void births_fall_within_steps(void **state)
{
    struct sf_scene scene;
    struct sf_emitter *emitter;
    struct snapshot shot;
    uint32_t first;

    (void)state;
    scene_init(&scene, 4096);
    emitter = add_emitter(&scene, SF_EMITTER_SPHERE);
    emitter->rate = 1000;
    emitter->start = 0.25f;
    memcpy(emitter->lifetime, (float[]){0.5f, 0.5f}, sizeof emitter->lifetime);
    shot = run_scene(&scene, 64);
    check(&shot);
    /* Born after 0.5 s: the one born at 0.5 s itself is as old as it gets. */
    first = 250;
    assert_int_equal(shot.counts.live, 750 - first);
    for (uint32_t i = 0; i < shot.counts.live; i++) {
        assert_int_equal(shot.list[i].id, first + i);
        assert_near(shot.list[i].age, 0.75 - (shot.list[i].id + 1) / 1000.0, 1e-6, "age");
    }
    free(shot.list);
}

static void lists_arrive_bit_for_bit(void **state)
{
    enum { COUNT = 1000 };
    static struct sf_listed list[COUNT];
    struct sf_scene scene;
    struct sf_particles *particles;
    uint32_t steps[] = {0, 17};

    (void)state;
    for (uint32_t i = 0; i < COUNT; i++)
        for (size_t j = 0; j < 5; j++)
            (&list[i].centre[0])[j] = sf_random_float(3, i, (uint32_t)j) * 10 + 0.001f;
    scene_init(&scene, COUNT);
    add_list(&scene, list, COUNT)->still = true;
    list[5].extinction = -1;  /* the medium's */
    list[7].lifetime = 0.01f; /* still: it stays */
    list[9].velocity[0] = 3;
    add_object(&scene, SF_OBJECT_PLANE, 0, 5, 0); /* half of them are inside: they do not move */
    add_force(&scene, SF_FORCE_GRAVITY, 0)->acceleration[1] = -9.81f;
    particles = start(&scene);
    for (size_t s = 0; s < 2; s++) {
        struct snapshot shot;

        advance_steps(particles, steps[s], 5);
        shot = take(particles);
        check(&shot);
        assert_int_equal(shot.counts.live, COUNT);
        for (uint32_t i = 0; i < COUNT; i++) {
            const struct sf_particle *p = &shot.list[i];
            const float extinction = i == 5 ? 4 : list[i].extinction;

            assert_memory_equal(&p->x, list[i].centre, 12);
            assert_memory_equal(&p->radius, &list[i].radius, 4);
            assert_memory_equal(&p->vx, list[i].velocity, 12);
            assert_memory_equal(&p->extinction, &extinction, 4);
            assert_true(p->age == list[i].age && p->lifetime == list[i].lifetime && p->id == i &&
                        (p->look & SF_LOOK_STILL));
        }
        free(shot.list);
    }
    sf_particles_destroy(&particles);
}

/* Extinction follows age and radius; all of it in one run. */
static void fades_and_dilution(void **state)
{
    struct sf_scene scene;
    struct sf_emitter *emitter;
    struct snapshot shot;

    (void)state;
    scene_init(&scene, 4096);
    emitter = add_emitter(&scene, SF_EMITTER_SPHERE);
    emitter->rate = 640;
    memcpy(emitter->lifetime, (float[]){1, 2}, sizeof emitter->lifetime);
    memcpy(emitter->particle_radius, (float[]){0.1f, 0.3f}, sizeof emitter->particle_radius);
    emitter->growth = 0.2f;
    emitter->dilution = 0.5f;
    emitter->fade_in = 0.2f;
    emitter->fade_out = 0.5f;
    emitter->extinction = 3;
    shot = run_scene(&scene, 120);
    check(&shot);
    for (uint32_t i = 0; i < shot.counts.live; i++) {
        const struct sf_particle *p = &shot.list[i];
        double life = p->age / (double)p->lifetime, in = fmin(life / 0.2, 1), out = fmax((life - 0.5) / 0.5, 0);
        double fade = in * in * (3 - 2 * in) * (1 - out * out * (3 - 2 * out));

        assert_true(p->lifetime >= 1 && p->lifetime <= 2 && p->radius0 >= 0.1f && p->radius0 <= 0.3f);
        assert_near(p->radius, p->radius0 + 0.2 * p->age, 1e-5, "radius");
        assert_near(p->extinction, 3 * pow(p->radius0 / p->radius, 1.5) * fade, 1e-4, "extinction");
    }
    free(shot.list);
}

static void emitters_have_their_shapes(void **state)
{
    enum { COUNT = 2000 };
    /* Two triangles, one of three times the other's area, at z = 0 and z = 1. */
    float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 3, 0, 1, 0, 1, 1};
    uint32_t indices[] = {0, 1, 2, 3, 4, 5};

    (void)state;
    for (int kind = SF_EMITTER_CONE; kind <= SF_EMITTER_MESH; kind++) {
        struct sf_scene scene;
        struct sf_emitter *emitter;
        struct snapshot shot;
        double low[3] = {9, 9, 9}, high[3] = {-9, -9, -9};
        uint32_t far_triangle = 0;

        scene_init(&scene, COUNT);
        scene.meshes[scene.mesh_count++] = (struct sf_mesh){
            .file = "test", .positions = corners, .indices = indices, .vertex_count = 6, .index_count = 6};
        emitter = add_emitter(&scene, kind);
        emitter->burst = COUNT;
        emitter->start = 1.999999f / 64; /* the last moment of the second step */
        emitter->surface = true;
        emitter->speed[0] = emitter->speed[1] = 2;
        emitter->angle = 10;
        if (kind != SF_EMITTER_CONE) {
            memset(emitter->direction, 0, sizeof emitter->direction); /* outward */
            emitter->angle = 0;
        }
        shot = run_scene(&scene, 2);
        assert_int_equal(shot.counts.live, COUNT);
        for (uint32_t i = 0; i < COUNT; i++) {
            const struct sf_particle *p = &shot.list[i];
            double x = p->x, y = p->y, z = p->z, along = sqrt(x * x + y * y + z * z);
            const double place[3] = {x, y, z};

            assert_near(sqrt((double)p->vx * p->vx + (double)p->vy * p->vy + (double)p->vz * p->vz), 2, 1e-5,
                        "the speed");
            for (int axis = 0; axis < 3; axis++) {
                low[axis] = fmin(low[axis], place[axis]);
                high[axis] = fmax(high[axis], place[axis]);
            }
            if (kind == SF_EMITTER_CONE) {
                assert_true(along <= 0.2 + 1e-6 && fabs(y) < 1e-6);
                assert_true(p->vy >= 2 * cos(10.0 / 180 * 3.14159265358979) - 1e-5);
            } else if (kind == SF_EMITTER_SPHERE) {
                assert_near(along, 0.2, 1e-6, "the radius");
                assert_near((p->vx * x + p->vy * y + p->vz * z) / 0.4, 1, 1e-4, "outward");
            } else if (kind == SF_EMITTER_BOX) {
                assert_near(fmax(fabs(x), fmax(fabs(y), fabs(z))), 0.5, 1e-5, "the face");
            } else {
                assert_true(z < 1e-5 || z > 1 - 1e-5);
                assert_true(x >= -1e-6 && y >= -1e-6 && (z > 0.5 ? x / 3 : x) + y <= 1 + 1e-5);
                assert_near(p->vz, 2, 1e-5, "the normal");
                far_triangle += z > 0.5;
            }
        }
        for (int axis = 0; axis < 3; axis++) { /* spread all over */
            double wanted_low = kind == SF_EMITTER_MESH ? 0 : kind == SF_EMITTER_BOX ? -0.5 : -0.2;
            double wanted_high = kind == SF_EMITTER_MESH ? (axis == 0 ? 3 : 1) : kind == SF_EMITTER_BOX ? 0.5 : 0.2;

            if (kind == SF_EMITTER_CONE && axis == 1)
                continue;
            assert_near(low[axis], wanted_low, 0.1, "the lower end");
            assert_near(high[axis], wanted_high, 0.15, "the upper end");
        }
        if (kind == SF_EMITTER_MESH)
            assert_near(far_triangle, 0.75 * COUNT, 80, "the larger triangle's share");
        free(shot.list);
    }
}

/* Particles at rest lie along the path where the emitter was at their birth, and have the share of its velocity that
 * they inherit. */
static void emitters_move(void **state)
{
    struct sf_path_key path[] = {{0, {0, 0, 0}}, {4, {8, 0, 0}}};
    struct sf_scene scene;
    struct sf_emitter *emitter;
    struct snapshot shot;

    (void)state;
    for (int inherit = 0; inherit < 2; inherit++) {
        scene_init(&scene, 1024);
        emitter = add_emitter(&scene, SF_EMITTER_SPHERE);
        emitter->radius = 0;
        emitter->rate = 500;
        emitter->path = path;
        emitter->path_count = 2;
        emitter->inherit = (float)inherit;
        emitter->position[1] = 1;
        shot = run_scene(&scene, 64);
        for (uint32_t i = 0; i < shot.counts.live; i++) {
            double born = (shot.list[i].id + 1) / 500.0;

            assert_near(shot.list[i].vx, inherit ? 2 : 0, 1e-4, "the velocity");
            assert_near(shot.list[i].x, inherit ? 2 : 2 * born, 1e-4, "the place");
            assert_near(shot.list[i].y, 1, 1e-6, "the height");
        }
        free(shot.list);
    }
}

/* ---- the same bits ---- */

enum { RICH_STEPS = 120 };

static void same_seed_same_bits(void **state)
{
    struct sf_scene scene;
    struct sf_particles *particles;
    struct snapshot once, other;
    float unseeded;

    (void)state;
    rich_scene(&scene);
    once = run_scene(&scene, RICH_STEPS);
    check(&once);

    other = run_scene(&scene, RICH_STEPS);
    assert_true(same_bits(&once, &other));
    free(other.list);

    /* With pauses, after a reset, and many steps a frame. */
    particles = start(&scene);
    advance_steps(particles, 31, 1);
    assert_int_equal(sf_particles_reset(particles), SF_OK);
    advance_steps(particles, 13, 3);
    advance_steps(particles, RICH_STEPS - 13, RICH_STEPS);
    other = take(particles);
    assert_true(same_bits(&once, &other));
    free(other.list);
    sf_particles_destroy(&particles);

    unseeded = once.list[once.counts.live - 1].x;
    free(once.list);
    scene.sim.seed++;
    other = run_scene(&scene, RICH_STEPS);
    assert_true(other.list[other.counts.live - 1].x != unseeded);
    free(other.list);
}

static uint64_t digest(void)
{
    struct sf_scene scene;
    struct snapshot shot;
    uint64_t hash;

    rich_scene(&scene);
    shot = run_scene(&scene, RICH_STEPS);
    hash = sf_hash_bytes(shot.list, shot.counts.live * sizeof *shot.list,
                         sf_hash_bytes(&shot.counts, sizeof shot.counts, 0));
    free(shot.list);
    return hash;
}

static const char *self;

/* The digest that another process comes to, with a variable set for the software driver. */
static uint64_t digest_of_child(const char *name, const char *value)
{
    unsigned long long hash = 0;
    int ends[2], status = 0;
    pid_t child;
    FILE *output;

    assert_int_equal(pipe(ends), 0);
    child = fork();
    if (child == 0) {
        setenv(name, value, 1);
        dup2(ends[1], 1);
        close(ends[0]);
        close(ends[1]);
        execl("/proc/self/exe", self, "--digest", (char *)NULL);
        _exit(127);
    }
    close(ends[1]);
    output = fdopen(ends[0], "r");
    assert_non_null(output);
    assert_int_equal(fscanf(output, "%llx", &hash), 1);
    fclose(output);
    assert_true(waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0);
    return hash;
}

static void same_bits_with_any_number_of_threads_and_lanes(void **state)
{
    static const char *const runs[][2] = {{"LP_NUM_THREADS", "1"},
                                          {"LP_NUM_THREADS", "2"},
                                          {"LP_NATIVE_VECTOR_WIDTH", "128"},
                                          {"LP_NATIVE_VECTOR_WIDTH", "512"}};
    uint64_t here = digest();

    (void)state;
    for (size_t i = 0; i < SF_COUNT(runs); i++)
        if (digest_of_child(runs[i][0], runs[i][1]) != here)
            fail_msg("%s=%s gives other bits", runs[i][0], runs[i][1]);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts_are_conserved),       cmocka_unit_test(births_fall_within_steps),
        cmocka_unit_test(lists_arrive_bit_for_bit),   cmocka_unit_test(fades_and_dilution),
        cmocka_unit_test(emitters_have_their_shapes), cmocka_unit_test(emitters_move),
        cmocka_unit_test(same_seed_same_bits),        cmocka_unit_test(same_bits_with_any_number_of_threads_and_lanes),
    };
    int skip = kit_probe();

    self = argv[0];
    if (!skip && argc > 1 && strcmp(argv[1], "--digest") == 0) {
        open_device(NULL);
        printf("%llx\n", (unsigned long long)digest());
        fflush(stdout);
        return close_device(NULL);
    }
    return skip ? skip : cmocka_run_group_tests(tests, open_device, close_device);
}
