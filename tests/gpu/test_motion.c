/* Forces, against closed forms, and collisions, against distances worked out here in double precision. */
#include "particles_kit.h"

static const double PI = 3.14159265358979323846;

/* ---- forces ---- */

static void gravity_is_exact(void **state)
{
    struct sf_listed list[] = {{.centre = {1, 2, 3}, .radius = 0.1f, .extinction = 1, .velocity = {1, 5, -2}}};
    struct sf_scene scene;
    struct snapshot shot;

    (void)state;
    scene_init(&scene, 16);
    add_list(&scene, list, 1);
    add_force(&scene, SF_FORCE_GRAVITY, 0)->acceleration[1] = -9.81f;
    shot = run_scene(&scene, 128); /* 2 s */
    assert_near(shot.list[0].x, 3, 1e-5, "x");
    assert_near(shot.list[0].y, 2 + 5 * 2 - 9.81 * 2, 2e-5, "y");
    assert_near(shot.list[0].z, -1, 1e-5, "z");
    assert_near(shot.list[0].vy, 5 - 9.81 * 2, 2e-5, "vy");
    assert_near(shot.list[0].age, 2, 1e-6, "age");
    free(shot.list);
}

/* dv/dt = g + k (w - v), for k h small and large. */
static void drag_is_exact(void **state)
{
    static const float drags[] = {1e-4f, 0.7f, 40, 1000};

    (void)state;
    for (size_t i = 0; i < SF_COUNT(drags); i++) {
        struct sf_listed list[] = {{.radius = 0.1f, .extinction = 1, .velocity = {3, 5, 0}}};
        double k = drags[i], t = 1.5, e = exp(-k * t), s = -expm1(-k * t) / k;
        double vx = 2, vy = -9.81 / k; /* where velocities end */
        struct sf_scene scene;
        struct snapshot shot;

        scene_init(&scene, 16);
        add_list(&scene, list, 1);
        add_force(&scene, SF_FORCE_GRAVITY, 0)->acceleration[1] = -9.81f;
        add_force(&scene, SF_FORCE_DRAG, drags[i]);
        add_force(&scene, SF_FORCE_WIND, 0)->velocity[0] = 2;
        shot = run_scene(&scene, 96);
        assert_near(shot.list[0].vx, vx + (3 - vx) * e, 3e-5, "vx"); /* 96 roundings */
        assert_near(shot.list[0].vy, vy + (5 - vy) * e, 1e-4, "vy");
        assert_near(shot.list[0].x, vx * t + (3 - vx) * s, 1e-4, "x");
        assert_near(shot.list[0].y, vy * t + (5 - vy) * s, 1e-4, "y");
        free(shot.list);
    }
}

/* Way of a particle at rest, after t, under the acceleration a exp(-c s) and the drag k, and its velocity. */
static void rising(double a, double c, double k, double t, double *velocity, double *way)
{
    double fast = c > 0 ? -expm1(-c * t) / c : t, slow = k > 0 ? -expm1(-k * t) / k : t;

    if (k == 0) {
        *velocity = a * fast;
        *way = c > 0 ? a * (t - fast) / c : a * t * t / 2;
    } else {
        *velocity = a * (exp(-c * t) - exp(-k * t)) / (k - c);
        *way = a * (fast - slow) / (k - c);
    }
}

/* Every particle of a stream, born anywhere within a step, is where its age says. */
static void buoyancy_and_cooling_are_exact(void **state)
{
    static const struct {
        float cooling, drag;
    } cases[] = {{0, 0}, {0.8f, 0}, {0.8f, 2}, {3, 0.5f}, {20, 25}};

    (void)state;
    for (size_t i = 0; i < SF_COUNT(cases); i++) {
        struct sf_scene scene;
        struct sf_emitter *emitter;
        struct snapshot shot;

        scene_init(&scene, 256);
        emitter = add_emitter(&scene, SF_EMITTER_SPHERE);
        emitter->radius = 0;
        emitter->rate = 97;
        emitter->temperature = 50;
        emitter->cooling = cases[i].cooling;
        add_force(&scene, SF_FORCE_BUOYANCY, 0.03f);
        add_force(&scene, SF_FORCE_DRAG, cases[i].drag);
        shot = run_scene(&scene, 100);
        assert_int_equal(shot.counts.live, floor(97 * 100 / 64.0));
        for (uint32_t j = 0; j < shot.counts.live; j++) {
            const struct sf_particle *p = &shot.list[j];
            double age = 100 / 64.0 - (p->id + 1) / 97.0, v, y;

            rising(0.03 * 50, cases[i].cooling, cases[i].drag, age, &v, &y);
            assert_near(p->age, age, 1e-6, "age");
            assert_near(p->temperature, 50 * exp(-cases[i].cooling * age), 1e-4, "temperature");
            assert_near(p->vy, v, 2e-5, "vy");
            assert_near(p->y, y, 2e-5, "y");
        }
        free(shot.list);
    }
}

/* The air's velocity at points: a drag so strong that a particle has it after one step. */
static void probe_air(struct sf_scene *scene, struct sf_listed *points, uint32_t count, uint32_t steps,
                      double (*velocity)[3])
{
    struct snapshot shot;

    for (uint32_t i = 0; i < count; i++)
        points[i].radius = 0.1f;
    scene->sim.capacity = (int32_t)count;
    add_list(scene, points, count)->start = 0;
    add_force(scene, SF_FORCE_DRAG, 1e7f);
    /* `steps` before the probe, to let time pass: the list is born in the step that is looked at. */
    if (steps)
        scene->emitters[0].start = (float)(steps / 64.0 + 1e-4);
    shot = run_scene(scene, steps + 1);
    assert_int_equal(shot.counts.live, count);
    for (uint32_t i = 0; i < count; i++) {
        velocity[i][0] = shot.list[i].vx;
        velocity[i][1] = shot.list[i].vy;
        velocity[i][2] = shot.list[i].vz;
    }
    free(shot.list);
}

static double unit_random(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) / 16777216.0;
}

/* Central differences over h: their sum vanishes with h^2, while each term stays about rms / scale. Octaves turned and
 * unturned. */
static void turbulence_is_free_of_divergence(void **state)
{
    enum { POINTS = 512 };
    const double h = 1.0 / 128;
    static struct sf_listed points[POINTS * 6];
    static double v[POINTS * 6][3];
    double worst = 0, terms = 0;
    uint32_t seed = 1;
    struct sf_scene scene;

    (void)state;
    scene_init(&scene, 1);
    add_force(&scene, SF_FORCE_TURBULENCE, 2)->octaves = 2;
    for (uint32_t i = 0; i < POINTS; i++)
        for (int axis = 0; axis < 3; axis++) {
            float x = (float)(floor(unit_random(&seed) * 4096) / 256 - 8);

            for (int j = 0; j < 6; j++)
                points[6 * i + (uint32_t)j].centre[axis] = x + (j / 2 == axis ? (float)(j % 2 ? h : -h) : 0);
        }
    probe_air(&scene, points, POINTS * 6, 0, v);
    for (uint32_t i = 0; i < POINTS; i++) {
        double divergence = 0;

        for (int axis = 0; axis < 3; axis++) {
            double term = (v[6 * i + 2 * (uint32_t)axis + 1][axis] - v[6 * i + 2 * (uint32_t)axis][axis]) / (2 * h);

            divergence += term;
            terms += term * term / POINTS;
        }
        worst = fmax(worst, fabs(divergence));
    }
    print_message("divergence at most %.4f 1/s, its terms %.3f 1/s rms\n", worst, sqrt(terms));
    assert_true(sqrt(terms) > 1);
    assert_true(worst < 0.02 * sqrt(terms));
}

static void turbulence_has_its_strength_and_changes(void **state)
{
    enum { POINTS = 4096 };
    static struct sf_listed points[POINTS];
    static double v[2][POINTS][3];
    double square = 0, mean[3] = {0}, change = 0;

    (void)state;
    for (int run = 0; run < 2; run++) {
        struct sf_scene scene;
        struct sf_force *force;
        uint32_t seed = 5;

        scene_init(&scene, 1);
        force = add_force(&scene, SF_FORCE_TURBULENCE, 3);
        force->octaves = 4;
        force->scale = 2;
        force->rate = 1;
        for (uint32_t i = 0; i < POINTS; i++)
            for (int axis = 0; axis < 3; axis++)
                points[i].centre[axis] = (float)(unit_random(&seed) * 200 - 100);
        probe_air(&scene, points, POINTS, run ? 64 : 0, v[run]);
    }
    for (uint32_t i = 0; i < POINTS; i++)
        for (int axis = 0; axis < 3; axis++) {
            square += v[0][i][axis] * v[0][i][axis] / POINTS;
            mean[axis] += v[0][i][axis] / POINTS;
            change += (v[1][i][axis] - v[0][i][axis]) * (v[1][i][axis] - v[0][i][axis]) / POINTS;
        }
    assert_near(sqrt(square), 3, 0.1, "the rms");
    for (int axis = 0; axis < 3; axis++)
        assert_near(mean[axis], 0, 0.15, "the mean");
    /* After 1/rate the field has little to do with what it was: the rms of the change is that of two independent
     * fields, sqrt(2) 3. */
    assert_in_range((uint64_t)(100 * sqrt(change)), 300, 520);
}

static void vortex_turns_and_pulls(void **state)
{
    static const double radii[] = {0, 0.25, 0.5, 1, 4};
    static struct sf_listed points[SF_COUNT(radii)];
    double v[SF_COUNT(radii)][3];
    struct sf_scene scene;
    struct sf_force *force;

    (void)state;
    scene_init(&scene, 1);
    force = add_force(&scene, SF_FORCE_VORTEX, 3);
    force->radius = 0.5f;
    force->pull = 1;
    force->position[0] = 10;
    force->axis[1] = 2; /* of any length */
    for (size_t i = 0; i < SF_COUNT(radii); i++) {
        points[i].centre[0] = (float)(10 + radii[i]);
        points[i].centre[1] = -3;
    }
    probe_air(&scene, points, SF_COUNT(radii), 0, v);
    for (size_t i = 0; i < SF_COUNT(radii); i++) {
        double x = radii[i] / 0.5, profile = 2 * x / (1 + x * x);

        assert_near(v[i][0], -profile, 1e-5, "the pull");
        assert_near(v[i][1], 0, 1e-5, "along the axis");
        assert_near(v[i][2], -3 * profile, 1e-5, "the turn"); /* y cross x = -z */
    }
}

/* Turbulence and drag give no more energy than the air has. */
static void energy_stays_sane(void **state)
{
    struct sf_scene scene;
    struct sf_emitter *emitter;
    struct snapshot shot;
    double square = 0;

    (void)state;
    scene_init(&scene, 2048);
    emitter = add_emitter(&scene, SF_EMITTER_SPHERE);
    emitter->burst = 2048;
    emitter->radius = 10;
    add_force(&scene, SF_FORCE_DRAG, 2);
    add_force(&scene, SF_FORCE_TURBULENCE, 1)->octaves = 3;
    shot = run_scene(&scene, 640);
    for (uint32_t i = 0; i < shot.counts.live; i++)
        square += ((double)shot.list[i].vx * shot.list[i].vx + (double)shot.list[i].vy * shot.list[i].vy +
                   (double)shot.list[i].vz * shot.list[i].vz) /
                  shot.counts.live;
    assert_true(sqrt(square) > 0.3 && sqrt(square) < 1.1);
    free(shot.list);
}

/* ---- collisions ---- */

/* Distance to an object, m, negative inside. */
static double distance_to(const struct sf_object *object, const struct sf_particle *particle)
{
    double x[3] = {particle->x - (double)object->position[0], particle->y - (double)object->position[1],
                   particle->z - (double)object->position[2]};
    double q[3], outside = 0, deepest = -1e30;

    if (object->kind == SF_OBJECT_PLANE)
        return x[0] * object->normal[0] + x[1] * object->normal[1] + x[2] * object->normal[2];
    for (int axis = 2; axis >= 0; axis--) { /* the inverse of Rz Ry Rx: z is undone first */
        double angle = -object->rotation[axis] * PI / 180, c = cos(angle), s = sin(angle);
        int a = (axis + 1) % 3, b = (axis + 2) % 3;
        double y = c * x[a] - s * x[b], z = s * x[a] + c * x[b];

        x[a] = y;
        x[b] = z;
    }
    if (object->kind == SF_OBJECT_SPHERE)
        return sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]) - object->radius;
    q[0] = object->kind == SF_OBJECT_BOX ? fabs(x[0]) - object->size[0] / 2.0
                                         : sqrt(x[0] * x[0] + x[2] * x[2]) - object->radius;
    q[1] = fabs(x[1]) - (object->kind == SF_OBJECT_BOX ? object->size[1] : object->height) / 2.0;
    q[2] = object->kind == SF_OBJECT_BOX ? fabs(x[2]) - object->size[2] / 2.0 : -1e30;
    for (int i = 0; i < 3; i++) {
        deepest = fmax(deepest, q[i]);
        outside += q[i] > 0 ? q[i] * q[i] : 0;
    }
    return deepest > 0 ? sqrt(outside) : deepest;
}

static void assert_outside(const struct sf_scene *scene, const struct snapshot *shot)
{
    for (uint32_t i = 0; i < shot->counts.live; i++)
        for (uint32_t j = 0; j < scene->object_count; j++)
            if (distance_to(&scene->objects[j], &shot->list[i]) < 0)
                fail_msg("particle %u is %.4g m inside object %u after step %u", shot->list[i].id,
                         -distance_to(&scene->objects[j], &shot->list[i]), j, shot->counts.step);
}

/* All kinds, turned; a rain through them, with a stream that begins inside one. */
static void nothing_is_ever_inside_an_obstacle(void **state)
{
    struct sf_scene scene;
    struct sf_emitter *emitter;
    struct sf_object *object;
    struct sf_particles *particles;

    (void)state;
    scene_init(&scene, 4096);
    add_object(&scene, SF_OBJECT_PLANE, 0, 0, 0);
    object = add_object(&scene, SF_OBJECT_PLANE, 3, 0, 0); /* a slope; both wedges are narrow */
    object->normal[0] = -0.6f;
    object->normal[1] = 0.8f;
    object = add_object(&scene, SF_OBJECT_BOX, -1, 0.6f, 0.3f);
    memcpy(object->rotation, (float[]){25, 40, -70}, sizeof object->rotation);
    memcpy(object->size, (float[]){1.5f, 0.3f, 0.7f}, sizeof object->size);
    object->restitution = 0.7f;
    object = add_object(&scene, SF_OBJECT_CYLINDER, 0.8f, 0.7f, 0);
    memcpy(object->rotation, (float[]){60, 0, 30}, sizeof object->rotation);
    object->radius = 0.3f;
    object->friction = 0.5f;
    add_object(&scene, SF_OBJECT_SPHERE, 0, 0.2f, -0.5f); /* sunk in the floor, and in its neighbour */
    add_object(&scene, SF_OBJECT_SPHERE, 0.6f, 0.3f, -0.5f);
    emitter = add_emitter(&scene, SF_EMITTER_BOX);
    emitter->position[1] = 3;
    memcpy(emitter->size, (float[]){4, 1, 3}, sizeof emitter->size);
    emitter->rate = 1500;
    emitter->speed[1] = 8;
    emitter->angle = 180;
    emitter = add_emitter(&scene, SF_EMITTER_SPHERE);
    emitter->position[1] = 0.2f;
    emitter->position[2] = -0.5f;
    emitter->rate = 300;
    emitter->speed[1] = 3;
    emitter->angle = 180;
    add_force(&scene, SF_FORCE_GRAVITY, 0)->acceleration[1] = -9.81f;
    add_force(&scene, SF_FORCE_DRAG, 0.5f);
    add_force(&scene, SF_FORCE_TURBULENCE, 3)->octaves = 2;
    particles = start(&scene);
    for (int i = 0; i < 128; i++) {
        struct snapshot shot;

        advance_steps(particles, 1, 1);
        shot = take(particles);
        assert_outside(&scene, &shot);
        free(shot.list);
    }
    sf_particles_destroy(&particles);
}

static void particles_come_to_rest_on_a_floor(void **state)
{
    struct sf_scene scene;
    struct sf_emitter *emitter;
    struct sf_object *floor_object;
    struct snapshot shot;

    (void)state;
    scene_init(&scene, 512);
    floor_object = add_object(&scene, SF_OBJECT_PLANE, 0, 1, 0);
    floor_object->restitution = 0.5f;
    floor_object->friction = 0.2f;
    emitter = add_emitter(&scene, SF_EMITTER_BOX);
    emitter->position[1] = 2;
    emitter->burst = 512;
    emitter->speed[1] = 2;
    emitter->angle = 180;
    add_force(&scene, SF_FORCE_GRAVITY, 0)->acceleration[1] = -9.81f;
    shot = run_scene(&scene, 640);
    assert_outside(&scene, &shot);
    for (uint32_t i = 0; i < shot.counts.live; i++) {
        const struct sf_particle *p = &shot.list[i];

        assert_near(p->y, 1, 0.003, "the height");
        assert_near(sqrt((double)p->vx * p->vx + (double)p->vy * p->vy + (double)p->vz * p->vz), 0, 0.01, "the speed");
    }
    free(shot.list);
}

/* A ball that loses nothing comes back to its height, and one that keeps a quarter of its energy to a quarter of it. */
static void bounces_keep_their_energy(void **state)
{
    static const float restitutions[] = {1, 0.5f};

    (void)state;
    for (size_t i = 0; i < SF_COUNT(restitutions); i++) {
        struct sf_listed list[] = {{.centre = {0, 2, 0}, .radius = 0.1f, .extinction = 1}};
        struct sf_scene scene;
        struct sf_particles *particles;
        double top = 0, fall = sqrt(2 * 2 / 9.81);

        scene_init(&scene, 1);
        add_list(&scene, list, 1);
        add_object(&scene, SF_OBJECT_PLANE, 0, 0, 0)->restitution = restitutions[i];
        add_force(&scene, SF_FORCE_GRAVITY, 0)->acceleration[1] = -9.81f;
        particles = start(&scene);
        advance_steps(particles, (uint32_t)(fall * 64) + 2, 64);
        for (int step = 0; step < 60; step++) {
            struct snapshot shot;

            advance_steps(particles, 1, 1);
            shot = take(particles);
            top = fmax(top, shot.list[0].y);
            free(shot.list);
        }
        assert_near(top, 2 * restitutions[i] * restitutions[i], 0.05, "the height of the bounce");
        sf_particles_destroy(&particles);
    }
}

/* 2 m a step against a wall of 2 cm, straight and askew. */
static void fast_particles_do_not_pass_thin_walls(void **state)
{
    struct sf_listed list[64];
    struct sf_scene scene;
    struct sf_object *wall;
    struct snapshot shot;

    (void)state;
    memset(list, 0, sizeof list);
    for (int i = 0; i < 64; i++)
        list[i] = (struct sf_listed){.centre = {-1 - 0.01f * (float)i, 0.1f * (float)i - 3.2f, 0},
                                     .radius = 0.1f,
                                     .velocity = {128, (float)i - 32, 0}};
    scene_init(&scene, 64);
    add_list(&scene, list, 64);
    wall = add_object(&scene, SF_OBJECT_BOX, 0, 0, 0);
    memcpy(wall->size, (float[]){0.02f, 20, 20}, sizeof wall->size);
    shot = run_scene(&scene, 3);
    for (int i = 0; i < 64; i++)
        assert_true(shot.list[i].x < 0);
    free(shot.list);
}

/* Where spheres overlap so that a push from one leads into the next. */
static void births_in_a_knot_rise_out_of_it(void **state)
{
    struct sf_scene scene;
    struct sf_emitter *emitter;
    struct snapshot shot;

    (void)state;
    scene_init(&scene, 1024);
    for (int i = 0; i < 9; i++)
        add_object(&scene, SF_OBJECT_SPHERE, 0.3f * (float)(i % 3 - 1), 0.1f * (float)i, 0.3f * (float)(i / 3 - 1));
    emitter = add_emitter(&scene, SF_EMITTER_BOX);
    emitter->burst = 1024;
    shot = run_scene(&scene, 4);
    assert_outside(&scene, &shot);
    free(shot.list);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gravity_is_exact),
        cmocka_unit_test(drag_is_exact),
        cmocka_unit_test(buoyancy_and_cooling_are_exact),
        cmocka_unit_test(turbulence_is_free_of_divergence),
        cmocka_unit_test(turbulence_has_its_strength_and_changes),
        cmocka_unit_test(vortex_turns_and_pulls),
        cmocka_unit_test(energy_stays_sane),
        cmocka_unit_test(nothing_is_ever_inside_an_obstacle),
        cmocka_unit_test(particles_come_to_rest_on_a_floor),
        cmocka_unit_test(bounces_keep_their_energy),
        cmocka_unit_test(fast_particles_do_not_pass_thin_walls),
        cmocka_unit_test(births_in_a_knot_rise_out_of_it),
    };
    int skip = kit_probe();

    return skip ? skip : cmocka_run_group_tests(tests, open_device, close_device);
}
