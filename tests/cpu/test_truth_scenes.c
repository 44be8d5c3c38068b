/* The reference against a second, naive formulation: no acceleration, no pieces, equal steps, and surfaces that are met by
 * walking until inside. */
#include "truth_kit.h"

#include "scene/scene.h"
#include "truth/surfaces.h"

/* Chords by the quadratic formula, of all spheres. */
static double naive_depth(const struct cloud *cloud, const double a[3], const double b[3])
{
    double sum = 0;

    for (uint32_t i = 0; i < cloud->count; i++) {
        const struct sf_particle *p = &cloud->list[i];
        const double m[3] = {a[0] - p->x, a[1] - p->y, a[2] - p->z}, d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
        double aa = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], bb = m[0] * d[0] + m[1] * d[1] + m[2] * d[2];
        double cc = m[0] * m[0] + m[1] * m[1] + m[2] * m[2] - (double)p->radius * p->radius, room = bb * bb - aa * cc;

        if (room <= 0 || aa == 0)
            continue;
        double from = fmax(0, (-bb - sqrt(room)) / aa), to = fmin(1, (-bb + sqrt(room)) / aa);
        sum += p->extinction * fmax(0, to - from) * sqrt(aa);
    }
    return sum;
}

/* Whether x is in the solid: turned back about z, then y, then x. */
static bool inside(const struct sf_object *object, const double x[3])
{
    double p[3] = {x[0] - object->position[0], x[1] - object->position[1], x[2] - object->position[2]};

    for (int about = 2; about >= 0; about--) {
        double a = -object->rotation[about] * PI / 180, u = p[(about + 1) % 3], v = p[(about + 2) % 3];

        p[(about + 1) % 3] = cos(a) * u - sin(a) * v;
        p[(about + 2) % 3] = sin(a) * u + cos(a) * v;
    }
    if (object->kind == SF_OBJECT_BOX)
        return fabs(p[0]) < object->size[0] / 2 && fabs(p[1]) < object->size[1] / 2 && fabs(p[2]) < object->size[2] / 2;
    if (object->kind == SF_OBJECT_CYLINDER)
        return hypot(p[0], p[2]) < object->radius && fabs(p[1]) < object->height / 2;
    return object->kind == SF_OBJECT_SPHERE &&
           p[0] * p[0] + p[1] * p[1] + p[2] * p[2] < object->radius * object->radius;
}

/* Where the first change from outside to inside or back is, to 1e-9; INFINITY: none within `to`. */
static double naive_change(const struct sf_object *object, const double o[3], const double d[3], double to, int steps)
{
    double x[3] = {o[0], o[1], o[2]};
    bool first = inside(object, x);

    for (int i = 1; i <= steps; i++) {
        double t = to * i / steps, low = to * (i - 1) / steps;

        for (int k = 0; k < 3; k++)
            x[k] = o[k] + t * d[k];
        if (inside(object, x) == first)
            continue;
        while (t - low > 1e-9) {
            double half = (low + t) / 2;

            for (int k = 0; k < 3; k++)
                x[k] = o[k] + half * d[k];
            if (inside(object, x) == first)
                low = half;
            else
                t = half;
        }
        return t;
    }
    return INFINITY;
}

static bool naive_hidden(const struct sf_scene *scene, const double x[3], const double l[3], double way)
{
    double to = fmin(way, 6);

    for (uint32_t i = 0; i < scene->object_count; i++) {
        if (scene->objects[i].kind != SF_OBJECT_PLANE && naive_change(&scene->objects[i], x, l, to, 600) < to)
            return true;
    }
    return false;
}

static double naive_share(const struct sf_light *light, const double x[3], double l[3], double *way)
{
    double away = 0, s;

    *way = INFINITY;
    for (int k = 0; k < 3; k++)
        l[k] = light->kind == SF_LIGHT_DIRECTIONAL ? -light->direction[k] : light->position[k] - x[k];
    away = sqrt(l[0] * l[0] + l[1] * l[1] + l[2] * l[2]);
    for (int k = 0; k < 3; k++)
        l[k] /= away;
    if (light->kind == SF_LIGHT_DIRECTIONAL)
        return 1;
    *way = away;
    if (light->kind == SF_LIGHT_POINT)
        return 1 / (away * away);
    s = -(l[0] * light->direction[0] + l[1] * light->direction[1] + l[2] * light->direction[2]);
    s = (s - cos(light->outer * PI / 180)) / (cos(light->inner * PI / 180) - cos(light->outer * PI / 180));
    s = fmin(fmax(s, 0), 1);
    return s * s * (3 - 2 * s) / (away * away);
}

/* Linear from white at birth to the second key's colour at death, as the scene below has it. */
static void naive_source(const struct sf_scene *scene, const struct cloud *cloud, const double x[3], const double w[3],
                         double rgb[3])
{
    double scatter[3] = {0}, total = 0, g = scene->medium.g, low[3] = {1e9, 1e9, 1e9}, high[3] = {-1e9, -1e9, -1e9};
    float outward[3], ambient[3];

    for (uint32_t i = 0; i < cloud->count; i++) {
        const struct sf_particle *p = &cloud->list[i];
        const double centre[3] = {p->x, p->y, p->z};
        double life = p->lifetime > 0 ? p->age / p->lifetime : 0;
        bool holds = pow(x[0] - p->x, 2) + pow(x[1] - p->y, 2) + pow(x[2] - p->z, 2) < (double)p->radius * p->radius;

        total += holds ? p->extinction : 0;
        for (int c = 0; c < 3; c++) {
            double tint = 1 + life * (scene->ramp[1].color[c] - 1.0);

            scatter[c] += holds ? p->extinction * tint * scene->medium.albedo[c] : 0;
            low[c] = fmin(low[c], centre[c] - p->radius);
            high[c] = fmax(high[c], centre[c] + p->radius);
        }
    }
    double length = 0;
    for (int c = 0; c < 3; c++)
        length += pow(x[c] - (low[c] + high[c]) / 2, 2);
    for (int c = 0; c < 3; c++)
        outward[c] = (float)((x[c] - (low[c] + high[c]) / 2) / sqrt(length));
    sf_environment_ambient(&scene->environment, outward, ambient);
    for (int c = 0; c < 3; c++)
        rgb[c] = scatter[c] * fmax(0, ambient[c]) + total * scene->medium.emission[c];
    for (uint32_t n = 0; n < scene->light_count && total > 0; n++) {
        const struct sf_light *light = &scene->lights[n];
        double l[3], way, end[3], share = naive_share(light, x, l, &way);

        if (share == 0 || (light->shadows && naive_hidden(scene, x, l, way)))
            continue;
        for (int k = 0; k < 3; k++)
            end[k] = x[k] + fmin(way, 20) * l[k];
        share *= (1 - g * g) / (4 * PI * pow(1 + g * g - 2 * g * (w[0] * l[0] + w[1] * l[1] + w[2] * l[2]), 1.5));
        share *= exp(-naive_depth(cloud, x, end)) * light->intensity;
        for (int c = 0; c < 3; c++)
            rgb[c] += scatter[c] * share * light->color[c];
    }
}

/* Midpoints of equal steps. */
static void naive_ray(const struct sf_scene *scene, const struct cloud *cloud, const double o[3], const double w[3],
                      double to, int steps, double rgb[3])
{
    memset(rgb, 0, 3 * sizeof *rgb);
    for (int i = 0; i < steps; i++) {
        double t = to * (i + 0.5) / steps, x[3], source[3], through;

        for (int k = 0; k < 3; k++)
            x[k] = o[k] + t * w[k];
        through = exp(-naive_depth(cloud, o, x)) * to / steps;
        naive_source(scene, cloud, x, w, source);
        for (int c = 0; c < 3; c++)
            rgb[c] += through * source[c];
    }
}

static const char *const worlds[] = {
    "{\"lights\": [{\"type\": \"directional\", \"direction\": [1, -1, -0.3], \"intensity\": 2}], \"objects\": "
    "[{\"type\": "
    "\"sphere\", \"position\": [-1.5, 1.8, 0.5], \"radius\": 0.5}], \"medium\": {\"g\": 0.4, \"albedo\": [0.9, 0.7, "
    "0.5], "
    "\"emission\": [0.1, 0.02, 0]}, \"ramp\": [{\"at\": 0, \"color\": [1, 1, 1]}, {\"at\": 1, \"color\": [0.2, 0.5, "
    "0.9]}]}",
    "{\"lights\": [{\"type\": \"point\", \"position\": [0.4, 1.9, 0.6], \"intensity\": 3, \"color\": [1, 0.5, 0.2]}, "
    "{\"type\": \"spot\", \"position\": [-2, 2, 1], \"direction\": [2, -2, -1], \"inner\": 10, \"outer\": 25, "
    "\"intensity\": 9}], \"objects\": [{\"type\": \"box\", \"position\": [-0.9, 1.1, 0.4], \"size\": [0.5, 0.3, 0.4], "
    "\"rotation\": [20, 50, -30]}, {\"type\": \"cylinder\", \"position\": [0.5, 1.4, 0.3], \"radius\": 0.2, "
    "\"height\": 0.3, \"rotation\": [70, 10, 20]}, {\"type\": \"plane\"}], \"medium\": {\"g\": -0.3}, \"ramp\": "
    "[{\"at\": 0, \"color\": [1, 1, 1]}, {\"at\": 1, \"color\": [0.9, 0.4, 0.1]}]}",
    "{\"lights\": [{\"type\": \"point\", \"position\": [0.1, 0.2, 0.3], \"intensity\": 1, \"shadows\": false}], "
    "\"objects\": [{\"type\": \"sphere\", \"position\": [0.1, 0.2, 0.3], \"radius\": 0.1}], \"environment\": "
    "{\"type\": \"color\", \"color\": [0.3, 0.2, 0.1]}, \"ramp\": [{\"at\": 0, \"color\": [1, 1, 1]}, {\"at\": 1, "
    "\"color\": [0, 1, 0]}]}",
};

static void test_random_scenes(void **state)
{
    enum { STEPS = 8000 };
    double worst = 0;

    (void)state;
    for (uint32_t world = 0; world < SF_COUNT(worlds); world++) {
        struct sf_scene *scene = parse(worlds[world]);

        for (uint32_t i = 0; i < 9 && world == 0; i++) /* light from all around that differs in every direction */
            for (uint32_t c = 0; c < 3; c++)
                scene->environment.sh[i][c] = (float)(random_of(33, i, c) - 0.3);
        for (uint32_t seed = 0; seed < 3; seed++) {
            struct cloud cloud;

            cloud_random(&cloud, scene, seed == 0 ? 3 : 30, 10 + seed, 0.5, 2);
            struct sf_truth *truth = truth_of(scene, &cloud.medium, 1e-5);
            for (uint32_t ray = 0; ray < 4; ray++) {
                double o[3] = {0, 0, 0}, d[3], rgb[3], to = 4, end[3];

                random_direction(20 + seed, ray, world, d); /* from without, and, ray 3, from within */
                for (int k = 0; k < 3; k++) {
                    o[k] = ray == 3 ? 0.3 - 0.2 * k : -2 * d[k] + 0.4 * (random_of(seed, ray, (uint32_t)k) - 0.5);
                    end[k] = o[k] + to * d[k];
                }
                struct sf_truth_result result = trace(truth, o, d, 0, to);
                naive_ray(scene, &cloud, o, d, to, STEPS, rgb);
                assert_near(result.transmittance, exp(-naive_depth(&cloud, o, end)), 1e-12);
                double scale = fmax(rgb[0], fmax(rgb[1], rgb[2]));
                for (int c = 0; c < 3; c++) {
                    /* What is met by less than a step of the sum at each sphere's edge. */
                    assert_near(result.radiance[c], rgb[c], 1e-3 * scale + 1e-4);
                    worst = fmax(worst, fabs(result.radiance[c] - rgb[c]) / (scale + 0.2));
                }
            }
            sf_truth_destroy(&truth);
            cloud_free(&cloud);
        }
        sf_scene_destroy(&scene);
    }
    print_message("largest difference to %d equal steps: %.2g of (radiance + 0.2)\n", STEPS, worst);
}

static void test_surfaces(void **state)
{
    struct sf_scene *scene = parse(worlds[1]);
    struct sf_truth_surfaces *surfaces = NULL;
    uint32_t met = 0;

    (void)state;
    assert_int_equal(sf_truth_surfaces_create(scene, NULL, &surfaces), SF_OK);
    assert_true(sf_truth_casts(surfaces));
    for (uint32_t ray = 0; ray < 300; ray++) {
        double o[3], d[3], nearest = INFINITY, plane;

        random_direction(31, ray, 0, d);
        for (int k = 0; k < 3; k++) { /* aimed at one of the solids, some from within */
            d[k] *= 1.5;
            o[k] = scene->objects[ray % 2].position[k] + (ray % 7 ? -1.2 * d[k] : 0) +
                   0.3 * (random_of(32, ray, (uint32_t)k) - 0.5);
        }
        for (int i = 0; i < 2; i++)
            nearest = fmin(nearest, naive_change(&scene->objects[i], o, d, 4, 8000));
        bool hidden = sf_truth_hidden(surfaces, o, d, 4);
        assert_true(hidden == (nearest < 4));
        plane = -o[1] / d[1]; /* y = 0, seen from both sides */
        if (plane > 0)
            nearest = fmin(nearest, plane);
        double first = sf_truth_first_surface(surfaces, o, d, 0);
        if (nearest < 4) {
            assert_near(first, nearest, 1e-6);
            met++;
        } else {
            assert_true(first > 4 || isinf(first));
        }
    }
    assert_in_range(met, 150, 299);
    sf_truth_surfaces_destroy(&surfaces);
    sf_truth_surfaces_destroy(&surfaces);
    sf_scene_destroy(&scene);
}

static double determinant(const double a[3], const double b[3], const double c[3])
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/* All triangles in a row, by Cramer's rule; the pyramid stands on y = 0, turned by 40 degrees about y and halved. */
static double naive_mesh(const struct sf_mesh *mesh, const double o[3], const double d[3])
{
    double first = INFINITY, turn = 40 * PI / 180;

    for (uint32_t n = 0; n < mesh->index_count; n += 3) {
        double v[3][3], a[3], b[3], s[3], back[3] = {-d[0], -d[1], -d[2]};

        for (int i = 0; i < 3; i++) {
            const float *from = &mesh->positions[3 * (size_t)mesh->indices[n + (uint32_t)i]];

            v[i][0] = 0.5 * (cos(turn) * from[0] + sin(turn) * from[2]) + 1;
            v[i][1] = 0.5 * from[1];
            v[i][2] = 0.5 * (cos(turn) * from[2] - sin(turn) * from[0]) - 2;
        }
        for (int k = 0; k < 3; k++) {
            a[k] = v[1][k] - v[0][k];
            b[k] = v[2][k] - v[0][k];
            s[k] = o[k] - v[0][k];
        }
        double all = determinant(a, b, back), x = determinant(s, b, back) / all, y = determinant(a, s, back) / all;
        double t = determinant(a, b, s) / all;
        if (x >= 0 && y >= 0 && x + y <= 1 && t >= 0)
            first = fmin(first, t);
    }
    return first;
}

static void test_mesh(void **state)
{
    char text[1200];
    struct sf_truth_surfaces *surfaces = NULL;
    struct sf_scene *scene;
    uint32_t met = 0;

    (void)state;
    snprintf(
        text, sizeof text,
        "{\"objects\": [{\"type\": \"mesh\", \"file\": \"%s\", \"position\": [1, 0, -2], \"rotation\": [0, 40, 0], "
        "\"scale\": 0.5}]}",
        source_path("scenes/assets/pyramid.gltf"));
    scene = parse(text);
    assert_int_equal(sf_truth_surfaces_create(scene, NULL, &surfaces), SF_OK);
    for (uint32_t ray = 0; ray < 2000; ray++) {
        double o[3], d[3], expected, got;

        random_direction(41, ray, 0, d);
        for (int k = 0; k < 3; k++)
            o[k] = (k == 0 ? 1 : k == 2 ? -2 : 0.2) - 2 * d[k] + random_of(42, ray, (uint32_t)k) - 0.5;
        expected = naive_mesh(&scene->meshes[0], o, d);
        got = sf_truth_first_surface(surfaces, o, d, 0);
        assert_true(isinf(expected) == isinf(got));
        assert_true(sf_truth_hidden(surfaces, o, d, INFINITY) == !isinf(expected));
        if (!isinf(expected)) {
            assert_near(got, expected, 1e-9);
            met++;
        }
    }
    assert_in_range(met, 200, 1900);
    sf_truth_surfaces_destroy(&surfaces);
    sf_scene_destroy(&scene);
}

/* The bound of a box is not less than any value in it, and 0 where nothing is. */
static void test_bound(void **state)
{
    struct sf_scene *scene = parse("{}");
    struct cloud cloud;

    (void)state;
    cloud_random(&cloud, scene, 200, 51, 0.2, 4);
    for (uint32_t box = 0; box < 300; box++) {
        double min[3], max[3], bound;

        for (int k = 0; k < 3; k++) {
            min[k] = 2.4 * random_of(52, box, (uint32_t)k) - 1.2;
            max[k] = min[k] + 0.4 * random_of(53, box, (uint32_t)k);
        }
        bound = cloud.medium.bound(cloud.medium.self, min, max);
        for (uint32_t i = 0; i < 200; i++) {
            struct sf_truth_point point;
            double x[3], expected = 0;

            for (int k = 0; k < 3; k++)
                x[k] = min[k] + (max[k] - min[k]) * random_of(54 + box, i, (uint32_t)k);
            for (uint32_t p = 0; p < cloud.count; p++)
                if (pow(x[0] - cloud.list[p].x, 2) + pow(x[1] - cloud.list[p].y, 2) + pow(x[2] - cloud.list[p].z, 2) <
                    (double)cloud.list[p].radius * cloud.list[p].radius)
                    expected += cloud.list[p].extinction;
            cloud.medium.at(cloud.medium.self, x, &point);
            assert_near(point.extinction, expected, 1e-12);
            assert_true(point.extinction <= bound * (1 + 1e-12));
        }
    }
    const double far[3] = {5, 5, 5}, farther[3] = {6, 6, 6};
    assert_true(cloud.medium.bound(cloud.medium.self, far, farther) == 0);
    cloud_free(&cloud);
    sf_scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random_scenes),
        cmocka_unit_test(test_surfaces),
        cmocka_unit_test(test_mesh),
        cmocka_unit_test(test_bound),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
