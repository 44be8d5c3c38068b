/* Meshes from OBJ and glTF. */
#include "scene_kit.h"

#include <math.h>
#include "base/file.h"
#include "base/hash.h"
#include "scene/mesh.h"

struct reading {
    struct sf_arena arena;
    struct sf_mesh mesh;
    uint64_t hash;
    struct caught caught;
};

static enum sf_status read_mesh(struct reading *reading, const char *path)
{
    struct sf_log log = {caught_write, &reading->caught, SF_LOG_ERROR};

    memset(reading, 0, sizeof *reading);
    return sf_mesh_read(path, &reading->arena, &log, &reading->mesh, &reading->hash);
}

static enum sf_status read_bytes(struct reading *reading, const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");

    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    return read_mesh(reading, path);
}

static void refuse_mesh(const char *path, const char *text, const char *part)
{
    struct reading reading;

    assert_int_equal(read_bytes(&reading, path, text, strlen(text)), SF_ERROR_SCENE);
    assert_caught(&reading.caught, part);
    sf_arena_finish(&reading.arena);
}

/* Closed and turned outward: the signed volume is what it should be, and so are area, bounds and normals. */
static void check_solid(const struct sf_mesh *mesh, double volume, double area, const double low[3],
                        const double high[3])
{
    double v = 0, a = 0;

    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        const float *p[3], *n[3];
        double u[3], w[3], c[3], facing = 0;

        for (int k = 0; k < 3; k++) {
            assert_true(mesh->indices[i + k] < mesh->vertex_count);
            p[k] = mesh->positions + 3 * mesh->indices[i + k];
            n[k] = mesh->normals + 3 * mesh->indices[i + k];
            assert_float_equal(sqrt(n[k][0] * n[k][0] + n[k][1] * n[k][1] + n[k][2] * n[k][2]), 1, 1e-5);
        }
        for (int k = 0; k < 3; k++) {
            u[k] = p[1][k] - p[0][k];
            w[k] = p[2][k] - p[0][k];
        }
        for (int k = 0; k < 3; k++)
            c[k] = u[(k + 1) % 3] * w[(k + 2) % 3] - u[(k + 2) % 3] * w[(k + 1) % 3];
        v += (p[0][0] * c[0] + p[0][1] * c[1] + p[0][2] * c[2]) / 6;
        a += sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]) / 2;
        for (int k = 0; k < 3; k++)
            facing += c[0] * n[k][0] + c[1] * n[k][1] + c[2] * n[k][2];
        assert_true(facing > 0); /* normals and winding agree */
    }
    assert_float_equal(v, volume, 1e-5);
    assert_float_equal(a, area, 1e-5);
    for (int k = 0; k < 3; k++) {
        assert_float_equal(mesh->min[k], low[k], 1e-6);
        assert_float_equal(mesh->max[k], high[k], 1e-6);
    }
}

static void test_obj(void **state)
{
    const double low[3] = {-0.5, 0, -0.5}, high[3] = {0.5, 1.4, 0.5}, roof = sqrt(0.5);
    struct reading reading;

    (void)state;
    assert_int_equal(read_mesh(&reading, source_path("scenes/assets/house.obj")), SF_OK);
    assert_int_equal(reading.mesh.index_count, 3 * 16); /* five squares, two pentagons */
    /* At edges of 90 degrees vertices stay apart, between the parts of a polygon they are joined. */
    assert_true(reading.mesh.vertex_count >= 10 && reading.mesh.vertex_count <= 30);
    check_solid(&reading.mesh, 0.9 + 0.25, 1 + 2 * 0.9 + 2 * (0.9 + 0.25) + 2 * roof, low, high);
    sf_arena_finish(&reading.arena);
}

static void read_pyramid(char **text)
{
    size_t size;

    assert_int_equal(sf_file_read(source_path("scenes/assets/pyramid.gltf"), 1 << 20, NULL, text, &size), SF_OK);
}

/* The pyramid with one piece of its text replaced. */
static void with(const char *name, const char *from, const char *to)
{
    char *text = NULL, *found;
    struct sf_text out = {0};

    read_pyramid(&text);
    assert_non_null(found = strstr(text, from));
    *found = '\0';
    sf_text_append(&out, text);
    sf_text_append(&out, to);
    sf_text_append(&out, found + strlen(from));
    assert_false(out.failed);
    assert_int_equal(sf_file_write(name, out.data, out.length, NULL), SF_OK);
    sf_text_finish(&out);
    free(text);
}

static void test_gltf(void **state)
{
    const double low[3] = {-0.5, 0, -0.5}, high[3] = {0.5, 1.2, 0.5}, side = 0.5 * sqrt(1.2 * 1.2 + 0.25);
    struct reading reading;

    (void)state;
    assert_int_equal(read_mesh(&reading, source_path("scenes/assets/pyramid.gltf")), SF_OK);
    assert_int_equal(reading.mesh.index_count, 3 * 6);
    check_solid(&reading.mesh, 1.2 / 3, 1 + 4 * side, low, high); /* upright: the node's turn and scale are in */
    sf_arena_finish(&reading.arena);
    /* A mirror keeps the outside outside. */
    with("mirror.gltf", "\"mesh\": 0", "\"mesh\": 0, \"translation\": [1, 0, 0]");
    with("mirror.gltf", "\"scale\": [\n    1,", "\"scale\": [\n    -1,");
    assert_int_equal(read_mesh(&reading, "mirror.gltf"), SF_OK);
    check_solid(&reading.mesh, 1.2 / 3, 1 + 4 * side, low, high);
    sf_arena_finish(&reading.arena);
}

/* A column of twelve sides is round: folds of 30 degrees are smoothed, those at its ends are not. */
static void test_smoothing(void **state)
{
    enum { SIDES = 12 };
    const double pi = 3.14159265358979323846;
    struct sf_text text = {0};
    struct reading reading;

    (void)state;
    for (int i = 0; i < 2 * SIDES; i++)
        sf_text_printf(&text, "v %.9f %d %.9f\n", cos(2 * pi * (i % SIDES) / SIDES), i / SIDES,
                       -sin(2 * pi * (i % SIDES) / SIDES));
    for (int i = 0; i < SIDES; i++)
        sf_text_printf(&text, "f %d %d %d %d\n", i + 1, (i + 1) % SIDES + 1, (i + 1) % SIDES + SIDES + 1,
                       i + SIDES + 1);
    for (int cap = 0; cap < 2; cap++) {
        sf_text_append(&text, "f");
        for (int i = 0; i < SIDES; i++)
            sf_text_printf(&text, " %d", cap ? i + SIDES + 1 : SIDES - i);
        sf_text_append(&text, "\n");
    }
    assert_int_equal(read_bytes(&reading, "column.obj", text.data, text.length), SF_OK);
    assert_int_equal(reading.mesh.vertex_count, 4 * SIDES);
    for (uint32_t v = 0; v < reading.mesh.vertex_count; v++) {
        const float *n = reading.mesh.normals + 3 * v, *p = reading.mesh.positions + 3 * v;

        if (fabsf(n[1]) < 0.5f) { /* of the sides: straight out */
            assert_float_equal(n[0], p[0], 1e-5);
            assert_float_equal(n[2], p[2], 1e-5);
        } else {
            assert_float_equal(n[1], p[1] > 0.5f ? 1 : -1, 1e-5);
        }
    }
    sf_arena_finish(&reading.arena);
    sf_text_finish(&text);
}

static void test_given_normals_are_kept(void **state)
{
    static const char text[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 3 4\nf 1//1 2//1 3//1\n";
    struct reading reading;

    (void)state;
    assert_int_equal(read_bytes(&reading, "n.obj", text, sizeof text - 1), SF_OK);
    for (uint32_t i = 0; i < reading.mesh.vertex_count; i++) {
        assert_float_equal(reading.mesh.normals[3 * i + 1], 0.6, 1e-6);
        assert_float_equal(reading.mesh.normals[3 * i + 2], 0.8, 1e-6);
    }
    sf_arena_finish(&reading.arena);
}

static void test_faults(void **state)
{
    static const char *const missing = "missing.obj";
    struct reading reading;
    FILE *file;

    (void)state;
    assert_int_equal(read_mesh(&reading, missing), SF_ERROR_SCENE);
    assert_caught(&reading.caught, "missing.obj: no such file");
    refuse_mesh("a.stl", "solid", "a.stl: unsupported kind of file; meshes come from .obj, .gltf or .glb");
    refuse_mesh("a.obj", "", "a.obj: ");
    refuse_mesh("a.obj", "this is not a mesh\n", "a.obj: ");
    refuse_mesh("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "a.obj: ");
    refuse_mesh("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\n", "a.obj: ");
    refuse_mesh("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "a.obj: ");
    refuse_mesh("a.obj", "v 0 0 0\nv 1e30 0 0\nv 0 1 0\nf 1 2 3\n", "a.obj: vertex");
    refuse_mesh("a.gltf", "{}", "a.gltf: not a readable mesh");
    refuse_mesh("a.gltf", "{\"asset\":{\"version\":\"2.0\"}}", "a.gltf: ");
    refuse_mesh("a.glb", "glTF\2\0\0\0", "a.glb: not a readable mesh");
    with("a.gltf", "\"uri\": \"data:", "\"uri\": \"nothing.bin?");
    assert_int_equal(read_mesh(&reading, "a.gltf"), SF_ERROR_SCENE);
    assert_caught(&reading.caught, "a.gltf: not a readable mesh");
    assert_non_null(file = fopen("huge.obj", "w"));
    assert_int_equal(ftruncate(fileno(file), ((off_t)1 << 30) + 1), 0);
    fclose(file);
    assert_int_equal(read_mesh(&reading, "huge.obj"), SF_ERROR_SCENE);
    assert_caught(&reading.caught, "huge.obj: 1073741825 bytes; a mesh file holds at most 1 GiB");
}

static void noise(const char *name, const char *whole, size_t size, uint32_t rounds)
{
    struct reading reading;
    char *copy = malloc(size);

    assert_non_null(copy);
    for (uint32_t round = 0; round < rounds; round++) {
        uint32_t word = sf_random_u32(9, round, 0);
        size_t length = round % 3 ? size : word % size;
        enum sf_status status;

        memcpy(copy, whole, size);
        for (uint32_t k = 0; k <= round % 2; k++)
            copy[sf_random_u32(9, round, k) % size] ^= (char)(1 << (word >> 24) % 8);
        status = read_bytes(&reading, name, copy, length);
        if (status != SF_OK && (status != SF_ERROR_SCENE || reading.caught.errors != 1))
            fail_msg("round %u: status %d, %s", round, (int)status, reading.caught.text);
        for (uint32_t i = 0; status == SF_OK && i < reading.mesh.index_count; i++)
            assert_true(reading.mesh.indices[i] < reading.mesh.vertex_count);
        sf_arena_finish(&reading.arena);
    }
    free(copy);
}

static void test_noise(void **state)
{
    char *text = NULL, *obj = NULL;
    size_t size;

    (void)state;
    read_pyramid(&text);
    noise("noise.gltf", text, strlen(text), 150);
    assert_int_equal(sf_file_read(source_path("scenes/assets/house.obj"), 1 << 20, NULL, &obj, &size), SF_OK);
    noise("noise.obj", obj, size, 150);
    free(obj);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_obj),       cmocka_unit_test(test_gltf),
        cmocka_unit_test(test_smoothing), cmocka_unit_test(test_given_normals_are_kept),
        cmocka_unit_test(test_faults),    cmocka_unit_test(test_noise),
    };
    return cmocka_run_group_tests(tests, scratch_enter, scratch_leave);
}
