/* src/output: EXR files in other shapes, without room to write, and damaged. */
#include "exr_picture.h"

#include <openexr.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include "base/array.h"
#include "base/file.h"
#include "output/image.h"

static struct caught caught;
static const struct sf_log log_caught = {.write = caught_write, .user = &caught, .level = SF_LOG_DEBUG};

/* In a child whose files may have 64 KiB, whatever the compression. */
static int write_over_limit(void)
{
    struct rlimit limit = {.rlim_cur = 65536, .rlim_max = 65536};
    unsigned before = scratch_count(".");
    struct picture p;

    signal(SIGXFSZ, SIG_IGN);
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0)
        return 1;
    for (int c = SF_EXR_NONE; c <= SF_EXR_B44; c++) {
        caught.errors = 0;
        picture_make(&p, 400, 300, (enum sf_exr_compression)c);
        for (size_t i = 0; i < 400 * 300 * 4; i++)
            p.rgba[i] = sf_random_float(1, (uint32_t)i, 9);
        if (sf_exr_write("big.exr", &p.frame, &log_caught) != SF_ERROR_IO)
            return 2;
        if (caught.errors != 1 || !strstr(caught.text, "'big.exr': File too large"))
            return 3;
        if (scratch_count(".") != before)
            return 4;
        picture_free(&p);
    }
    return 0;
}

static void test_no_room(void **state)
{
    pid_t child = fork();
    int verdict = -1;

    (void)state;
    if (child == 0)
        _exit(write_over_limit());
    assert_int_equal(waitpid(child, &verdict, 0), child);
    assert_true(WIFEXITED(verdict));
    assert_int_equal(WEXITSTATUS(verdict), 0);
}

/* A tiled file of one float channel "Y", written with the library itself. */
static void write_tiled(const char *path, int32_t width, int32_t height, exr_compression_t compression)
{
    exr_context_t context = NULL;
    int part;
    float tile[16 * 16];

    assert_int_equal(exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, NULL), EXR_ERR_SUCCESS);
    assert_int_equal(exr_add_part(context, "tiles", EXR_STORAGE_TILED, &part), EXR_ERR_SUCCESS);
    assert_int_equal(exr_initialize_required_attr_simple(context, part, width, height, compression), EXR_ERR_SUCCESS);
    assert_int_equal(exr_set_tile_descriptor(context, part, 16, 16, EXR_TILE_ONE_LEVEL, EXR_TILE_ROUND_DOWN),
                     EXR_ERR_SUCCESS);
    assert_int_equal(exr_add_channel(context, part, "Y", EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1),
                     EXR_ERR_SUCCESS);
    assert_int_equal(exr_write_header(context), EXR_ERR_SUCCESS);
    for (int32_t ty = 0; ty * 16 < height; ty++) {
        for (int32_t tx = 0; tx * 16 < width; tx++) {
            exr_encode_pipeline_t pipeline = {0};
            exr_chunk_info_t chunk;

            assert_int_equal(exr_write_tile_chunk_info(context, part, tx, ty, 0, 0, &chunk), EXR_ERR_SUCCESS);
            assert_int_equal(exr_encoding_initialize(context, part, &chunk, &pipeline), EXR_ERR_SUCCESS);
            for (int32_t i = 0; i < 16 * 16; i++)
                tile[i] = (float)(1000 * (ty * 16 + i / 16) + tx * 16 + i % 16);
            pipeline.channels[0].encode_from_ptr = (const uint8_t *)tile;
            pipeline.channels[0].user_pixel_stride = 4;
            pipeline.channels[0].user_line_stride = 64;
            assert_int_equal(exr_encoding_choose_default_routines(context, part, &pipeline), EXR_ERR_SUCCESS);
            assert_int_equal(exr_encoding_run(context, part, &pipeline), EXR_ERR_SUCCESS);
            exr_encoding_destroy(context, &pipeline);
        }
    }
    assert_int_equal(exr_finish(&context), EXR_ERR_SUCCESS);
}

static void test_tiles(void **state)
{
    static const exr_compression_t compressions[] = {EXR_COMPRESSION_NONE, EXR_COMPRESSION_ZIP};

    (void)state;
    for (size_t c = 0; c < SF_COUNT(compressions); c++) {
        struct sf_exr exr;
        struct sf_image image;

        write_tiled("t.exr", 37, 19, compressions[c]);
        assert_int_equal(sf_exr_read("t.exr", NULL, 0, &exr, &log_caught), SF_OK);
        assert_int_equal(exr.width, 37);
        assert_int_equal(exr.height, 19);
        for (size_t i = 0; i < 37 * 19; i++)
            assert_true(exr.planes[0].pixels[i] == (float)(1000 * (i / 37) + i % 37));
        sf_exr_finish(&exr);
        assert_int_equal(sf_image_read("t.exr", &image, &log_caught), SF_OK);
        assert_true(image.pixels[4 * 40] == 1003.0f && image.pixels[4 * 40 + 2] == 1003.0f &&
                    image.pixels[4 * 40 + 3] == 1.0f);
        sf_image_finish(&image);
    }
}

/* Reads damaged bytes: an answer must come, and an error exactly when the answer is not SF_OK. */
static void read_damaged(const unsigned char *data, size_t size)
{
    struct sf_exr exr;
    enum sf_status status;

    caught.errors = 0;
    status = sf_exr_decode(data, size, "damaged", NULL, 0, &exr, &log_caught);
    assert_int_equal(caught.errors, status != SF_OK);
    assert_true(status == SF_OK || status == SF_ERROR_IO || status == SF_ERROR_MEMORY);
    sf_exr_finish(&exr);
    caught.errors = 0;
}

static void damage(const unsigned char *data, size_t size, uint32_t seed)
{
    unsigned char *copy = malloc(size);

    for (size_t cut = 0; cut < size; cut += cut < 600 ? 7 : size / 40 + 1) {
        struct sf_exr exr;

        memcpy(copy, data, cut);
        assert_int_equal(sf_exr_decode(copy, cut, "cut", NULL, 0, &exr, &log_caught), SF_ERROR_IO);
        caught.errors = 0;
    }
    for (uint32_t round = 0; round < 300; round++) {
        /* Half of the rounds damage the header and the table of chunks. */
        size_t reach = round % 2 && size > 700 ? 700 : size;

        memcpy(copy, data, size);
        for (uint32_t i = 0; i <= round % 4; i++)
            copy[sf_random_u32(seed, round, i) % reach] ^=
                (unsigned char)(1u << sf_random_u32(seed, round, 10 + i) % 8);
        read_damaged(copy, size);
    }
    free(copy);
}

static void test_damaged(void **state)
{
    (void)state;
    for (int c = SF_EXR_NONE; c <= SF_EXR_B44; c++) {
        struct picture p;
        unsigned char *data;
        size_t size;

        picture_make(&p, 40, 36, (enum sf_exr_compression)c);
        assert_int_equal(sf_exr_encode(&p.frame, &log_caught, &data, &size), SF_OK);
        damage(data, size, (uint32_t)c);
        free(data);
        picture_free(&p);
    }
    char *tiled;
    size_t size;
    write_tiled("t.exr", 40, 40, EXR_COMPRESSION_ZIP);
    assert_int_equal(sf_file_read("t.exr", SIZE_MAX, &log_caught, &tiled, &size), SF_OK);
    damage((unsigned char *)tiled, size, 77);
    free(tiled);
}

/* An uncompressed chunk that says it is shorter than its pixels: they must not come from memory that nobody filled. */
static void test_short_chunk(void **state)
{
    enum { WIDTH = 16, HEIGHT = 4, LINE = WIDTH * 14 };
    struct picture p;
    unsigned char *data;
    size_t size;
    struct sf_exr exr;

    (void)state;
    picture_make(&p, WIDTH, HEIGHT, SF_EXR_NONE);
    assert_int_equal(sf_exr_encode(&p.frame, &log_caught, &data, &size), SF_OK);
    /* The last line: its number, its size, its pixels. */
    unsigned char *leader = data + size - LINE - 8;
    assert_int_equal(leader[0], HEIGHT - 1);
    assert_int_equal(leader[4], LINE);
    leader[4] = LINE - 2;
    assert_int_equal(sf_exr_decode(data, size, "short", NULL, 0, &exr, &log_caught), SF_ERROR_IO);
    assert_caught(&caught, "'short': not a sound OpenEXR file");
    free(data);
    picture_free(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_no_room),
        cmocka_unit_test(test_tiles),
        cmocka_unit_test(test_short_chunk),
        cmocka_unit_test(test_damaged),
    };

    return cmocka_run_group_tests(tests, scratch_enter, scratch_leave);
}
