/* Explicit particles from CSV and PLY: exact values, each fault with its row, speed, noise. */
#include "scratch.h"

#include <math.h>
#include <time.h>
#include "base/file.h"
#include "base/hash.h"
#include "scene/particle_file.h"

struct reading {
    struct sf_arena arena;
    struct sf_listed *list;
    uint32_t count;
    uint64_t hash;
    struct caught caught;
};

static enum sf_status read_bytes(struct reading *reading, const char *name, const void *bytes, size_t size)
{
    struct sf_log log = {caught_write, &reading->caught, SF_LOG_ERROR};

    FILE *file = fopen(name, "wb");

    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    memset(reading, 0, sizeof *reading);
    return sf_particle_file_read(name, &reading->arena, &log, &reading->list, &reading->count, &reading->hash);
}

static void accept(struct reading *reading, const char *name, const void *bytes, size_t size)
{
    if (read_bytes(reading, name, bytes, size) != SF_OK)
        fail_msg("%s", reading->caught.text);
}

static void refuse(const char *name, const void *bytes, size_t size, const char *part)
{
    struct reading reading;

    assert_int_equal(read_bytes(&reading, name, bytes, size), SF_ERROR_SCENE);
    assert_caught(&reading.caught, part);
    sf_arena_finish(&reading.arena);
}

static void refuse_text(const char *name, const char *text, const char *part)
{
    refuse(name, text, strlen(text), part);
}

/* ---- CSV ---- */

#define HEAD "x,y,z,radius,extinction\n"

static void test_csv(void **state)
{
    static const char text[] =
        "\xef\xbb\xbf# a comment\r\n\n radius , extinction,\tx,y,z, vx,vy,vz,age,lifetime,tile,rotation\r\n"
        "0.5,2, 1,2,3, 4,5,6, 0.25,9,3,-1.5\r\n"
        "   # in between\n"
        "1e-1,-1,-1.5e0,.5,3.,0,0,0,0,0,0,0";
    struct reading reading;

    (void)state;
    accept(&reading, "a.CSV", text, sizeof text - 1);
    assert_int_equal(reading.count, 2);
    assert_float_equal(reading.list[0].centre[2], 3, 0);
    assert_float_equal(reading.list[0].velocity[1], 5, 0);
    assert_float_equal(reading.list[0].lifetime, 9, 0);
    assert_float_equal(reading.list[0].tile, 3, 0);
    assert_float_equal(reading.list[0].rotation, -1.5, 0);
    assert_true(reading.list[1].radius == 0.1f && reading.list[1].centre[0] == -1.5f &&
                reading.list[1].extinction == -1);
    sf_arena_finish(&reading.arena);
    accept(&reading, "none.csv", HEAD, strlen(HEAD));
    assert_int_equal(reading.count, 0);
    sf_arena_finish(&reading.arena);
}

static void test_csv_faults(void **state)
{
    (void)state;
    refuse_text("a.csv", "", "a.csv: is empty");
    refuse_text("a.csv", "# only words\n", "a.csv: is empty");
    refuse_text("a.csv", "x,y,z,radius\n", "'extinction' is missing");
    refuse_text("a.csv", "x,y,z,radius,extinction,x\n", "a.csv: line 1: 'x' comes twice");
    refuse_text("a.csv", "x,y,z,radius,extincton\n",
                "a.csv: line 1: unknown name 'extincton', did you mean extinction?");
    refuse_text("a.csv", "x,y,z,radius,extinction,\n", "unknown name ''");
    refuse_text("a.csv", HEAD "0,0,0,1\n", "a.csv: line 2: 4 fields, but the header names 5 columns");
    refuse_text("a.csv", HEAD "0,0,0,1,1,1\n", "a.csv: line 2: more fields than the 5 columns");
    refuse_text("a.csv", HEAD "0,0,0,1,1\n0,0,zero,1,1\n", "a.csv: line 3: z: 'zero' is not a number");
    refuse_text("a.csv", HEAD "0,0,,1,1\n", "a.csv: line 2: z: '' is not a number");
    refuse_text("a.csv", HEAD "0,0,nan,1,1\n", "line 2: z: 'nan' is not a number");
    refuse_text("a.csv", HEAD "0,0,1e999,1,1\n", "line 2: z: '1e999' is not a number");
    refuse_text("a.csv", HEAD "#\n0,0,0,-1,1\n", "a.csv: line 3: radius: -1 is out of range: 0.0001 to 10000 m");
    refuse_text("a.csv", "x,y,z,radius,extinction,tile\n0,0,0,1,1,0.5\n", "line 2: tile is not a whole number");
    refuse_text("a.csv", HEAD "0,0,0,1,1;\n", "'1;' is not a number");
    refuse_text("a.csv", HEAD "\x01\x02,0,0,1,1\n", "'\?\?' is not a number");
}

static double seconds(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

/* A million rows, one of them bad; then the same mended: the values are exact and it does not take long. */
static void test_a_million_rows(void **state)
{
    struct sf_text text = {0};
    struct reading reading;
    double before;
    size_t place = 0;

    (void)state;
    sf_text_append(&text, HEAD);
    for (int i = 0; i < SF_PARTICLES_MAX; i++) {
        if (i == 777777)
            place = text.length;
        sf_text_printf(&text, "%d.%03d,-0.%06d,1.25e-1,0.5,%d\n", i % 1000, i % 997, i % 999983, i % 50);
    }
    assert_false(text.failed);
    text.data[place] = 'x';
    refuse("million.csv", text.data, text.length, "million.csv: line 777779: x: 'x77.117' is not a number");
    text.data[place] = '7';
    before = seconds();
    accept(&reading, "million.csv", text.data, text.length);
    before = seconds() - before;
    print_message("1,048,576 rows, %.0f MB: %.2f s\n", (double)text.length / 1e6, before);
    assert_true(before < 2);
    assert_int_equal(reading.count, SF_PARTICLES_MAX);
    assert_true(reading.list[123456].centre[0] == (float)strtod("456.825", NULL));
    assert_true(reading.list[123456].centre[1] == (float)strtod("-0.123456", NULL));
    sf_arena_finish(&reading.arena);
    sf_text_append(&text, "0,0,0,1,1\n");
    refuse("million.csv", text.data, text.length, "more than 1048576 particles");
    sf_text_finish(&text);
}

/* ---- PLY ---- */

#define PLY_HEAD(format, count)                                                                                        \
    "ply\nformat " format " 1.0\ncomment c\nelement vertex " count                                                     \
    "\nproperty float x\nproperty float y\nproperty float z\nproperty float radius\nproperty float extinction\n"

static void test_ply_ascii(void **state)
{
    static const char text[] =
        PLY_HEAD("ascii", "2") "property double age\nelement face 1\nproperty list uchar int vertex_indices\n"
                               "end_header\n1 2 3 0.5 4 0.125\n-1 -2 -3 1 -1 0\n3 0 1 2\n";
    struct reading reading;

    (void)state;
    accept(&reading, "a.ply", text, sizeof text - 1);
    assert_int_equal(reading.count, 2);
    assert_float_equal(reading.list[0].age, 0.125, 0);
    assert_float_equal(reading.list[1].centre[1], -2, 0);
    sf_arena_finish(&reading.arena);
}

static void put(unsigned char **at, const void *value, size_t size)
{
    memcpy(*at, value, size); /* the test's own machine is little-endian */
    *at += size;
}

static size_t binary_ply(unsigned char *bytes, float radius)
{
    static const char head[] =
        "ply\r\nformat binary_little_endian 1.0\r\nelement vertex 2\r\nproperty float64 x\r\nproperty float y\r\n"
        "property int16 z\r\nproperty float32 radius\r\nproperty uint extinction\r\nproperty int8 tile\r\nend_header\n";
    unsigned char *at = bytes;
    double x = 0.1;
    float y = -0.25f;
    int16_t z = -300;
    uint32_t extinction = 7;
    int8_t tile = 2;

    put(&at, head, sizeof head - 1);
    for (int i = 0; i < 2; i++) {
        put(&at, &x, sizeof x);
        put(&at, &y, sizeof y);
        put(&at, &z, sizeof z);
        put(&at, i ? &radius : &(float){1}, sizeof radius);
        put(&at, &extinction, sizeof extinction);
        put(&at, &tile, sizeof tile);
    }
    return (size_t)(at - bytes);
}

static void test_ply_binary(void **state)
{
    unsigned char bytes[512];
    size_t size = binary_ply(bytes, 0.5f);
    struct reading reading;

    (void)state;
    accept(&reading, "b.ply", bytes, size);
    assert_int_equal(reading.count, 2);
    assert_true(reading.list[1].centre[0] == 0.1f && reading.list[1].centre[1] == -0.25f &&
                reading.list[1].centre[2] == -300);
    assert_true(reading.list[1].radius == 0.5f && reading.list[1].extinction == 7 && reading.list[1].tile == 2);
    sf_arena_finish(&reading.arena);
    refuse("b.ply", bytes, size - 1, "is cut short: the header promises 2 vertices, the data end in vertex 1");
    refuse("b.ply", bytes, size + 1, "1 bytes follow the last vertex");
    size = binary_ply(bytes, -1);
    refuse("b.ply", bytes, size, "b.ply: vertex 1: radius: -1 is out of range");
    size = binary_ply(bytes, nanf(""));
    refuse("b.ply", bytes, size, "b.ply: vertex 1: radius: nan is out of range");
    size = binary_ply(bytes, INFINITY);
    refuse("b.ply", bytes, size, "b.ply: vertex 1: radius: inf is out of range");
}

static void test_ply_faults(void **state)
{
    (void)state;
    refuse_text("a.ply", "", "a.ply: line 1: not a PLY file");
    refuse_text("a.ply", "plyx\n", "not a PLY file");
    refuse_text("a.ply", "ply\nformat ascii 1.0\n", "a.ply: line 3: the header has no end_header");
    refuse_text("a.ply", "ply\nformat binary_big_endian 1.0\n", "unsupported format");
    refuse_text("a.ply", "ply\nformat ascii 2.0\n", "unsupported format");
    refuse_text("a.ply", "ply\nelement face 3\n", "the first element must be vertex");
    refuse_text("a.ply", "ply\nproperty float x\n", "a property before any element");
    refuse_text("a.ply", "ply\nelement vertex many\n", "expected: element NAME COUNT");
    refuse_text("a.ply", "ply\nelement vertex 99999999999999999999\n", "more than 1048576 particles");
    refuse_text("a.ply", "ply\nelement vertex 1\nproperty list uchar int x\n", "particles have no lists");
    refuse_text("a.ply", "ply\nelement vertex 1\nproperty half x\n", "unknown type of property");
    refuse_text("a.ply", "ply\nelement vertex 1\nproperty float nx\n", "a.ply: line 3: unknown name 'nx'");
    refuse_text("a.ply", PLY_HEAD("ascii", "1") "property float x\n", "'x' comes twice");
    refuse_text("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n",
                "'y' is missing");
    refuse_text("a.ply", "ply\nformat ascii 1.0\nend_header\n", "'x' is missing");
    refuse_text("a.ply", PLY_HEAD("ascii", "2") "element vertex 2\n", "the element vertex comes twice");
    refuse_text("a.ply", PLY_HEAD("ascii", "2") "end_header\n1 2 3 1 1\n1 2 3 1\n",
                "is cut short: the header promises 2 vertices, the data end in vertex 1");
    refuse_text("a.ply", PLY_HEAD("ascii", "1") "end_header\n1 2 3 1 1 1\n",
                "vertex 0: more numbers than the 5 properties");
    refuse_text("a.ply", PLY_HEAD("ascii", "1") "end_header\n1 2 3 1 1\n5\n", "something follows the last vertex");
    refuse_text("a.ply", PLY_HEAD("ascii", "2") "end_header\n1 2 3 1 1\n1 two 3 1 1\n",
                "a.ply: vertex 1: y: 'two' is not a number");
    refuse_text("a.ply", PLY_HEAD("ascii", "1000000") "end_header\n", "is cut short");
    refuse_text("a.ply", PLY_HEAD("ascii", "0") "end_header\n1", "something follows");
    refuse_text("a.pcd", "x", "unsupported kind of file");
}

static void test_noise(void **state)
{
    static const char csv[] = HEAD "0,1,2,0.5,1\n# a\n3,4,5,1e-1,-1\n";
    static const char ply[] = PLY_HEAD("ascii", "2") "end_header\n1 2 3 1 1\n1 2 3 1 1\n";
    unsigned char binary[512], copy[512];
    size_t sizes[] = {sizeof csv - 1, sizeof ply - 1, binary_ply(binary, 1)};
    const void *wholes[] = {csv, ply, binary};
    struct reading reading;

    (void)state;
    for (uint32_t round = 0; round < 1500; round++) {
        uint32_t which = round % 3, word = sf_random_u32(3, round, 0);
        size_t size = round % 7 ? sizes[which] : word % sizes[which];
        enum sf_status status;

        memcpy(copy, wholes[which], sizes[which]);
        copy[word % sizes[which]] ^= (unsigned char)(1 << (word >> 24) % 8);
        status = read_bytes(&reading, which ? "n.ply" : "n.csv", copy, size);
        if (status != SF_OK && (status != SF_ERROR_SCENE || reading.caught.errors != 1))
            fail_msg("round %u: status %d, %s", round, (int)status, reading.caught.text);
        sf_arena_finish(&reading.arena);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_csv),       cmocka_unit_test(test_csv_faults), cmocka_unit_test(test_a_million_rows),
        cmocka_unit_test(test_ply_ascii), cmocka_unit_test(test_ply_binary), cmocka_unit_test(test_ply_faults),
        cmocka_unit_test(test_noise),
    };
    return cmocka_run_group_tests(tests, scratch_enter, scratch_leave);
}
