/* src/texture: what is written and read. */
#include "texture_kit.h"

#include "base/file.h"
#include "output/exr.h"
#include "output/half.h"
#include "output/image.h"
#include "output/png.h"
#include "texture/texels.h"
#include "texture/texture.h"

enum { SIDE = 24 };
static const struct sf_exr_options exr_float = {.compression = "zip"}, exr_half = {.compression = "piz", .half = true};

/* 2x2 tiles, one smoke in a cycle of four. */
static struct sf_texture *make(void)
{
    struct sf_texture_options options = kit_options("turbulence", SIDE);

    options.tiles_x = options.tiles_y = 2;
    options.loop = 4;
    return kit_make(&options);
}

static struct sf_texture *load(const char *path, uint32_t tiles, uint32_t needs)
{
    struct sf_texture *texture = NULL;

    if (sf_texture_load(path, tiles, tiles, needs, &log_caught, &texture) != SF_OK)
        fail_msg("%s", caught.text);
    return texture;
}

/* Colours where alpha is above `alpha`, and all other numbers, differ by at most `slack`. */
static void assert_alike(const struct sf_texture *one, const struct sf_texture *other, float alpha, float slack)
{
    struct sf_texture_info a = kit_info(one), b = kit_info(other);

    assert_true(a.width == b.width && a.height == b.height && a.tiles_x == b.tiles_x && a.tiles_y == b.tiles_y);
    for (size_t i = 0; i < (size_t)a.width * a.height * 4; i++) {
        if (i % 4 == 3 || a.color[i | 3] > alpha)
            assert_float_equal(a.color[i], b.color[i], slack);
        assert_float_equal(a.shape[i], b.shape[i], slack);
    }
}

static void test_exr(void **state)
{
    struct sf_texture *texture = make(), *again;
    struct sf_texture_info info;

    (void)state;
    assert_int_equal(sf_texture_write_exr(texture, "a.exr", SF_TEXTURE_ALL, &exr_float, &log_caught), SF_OK);
    again = load("a.exr", 0, SF_TEXTURE_ALL);
    info = kit_info(again);
    assert_true(info.loop == 4 && !info.tileable && info.channels == SF_TEXTURE_ALL);
    assert_alike(texture, again, 0, 1e-6f);
    sf_texture_destroy(&again);
    assert_int_equal(sf_texture_write_exr(texture, "h.exr", SF_TEXTURE_ALL, &exr_half, &log_caught), SF_OK);
    again = load("h.exr", 2, SF_TEXTURE_ALL);
    assert_alike(texture, again, 0.1f, 2e-3f);
    sf_texture_destroy(&again);
    /* The same texture gives the same file. */
    char *bytes[2];
    size_t sizes[2];
    assert_int_equal(sf_texture_write_exr(texture, "b.exr", SF_TEXTURE_ALL, &exr_float, &log_caught), SF_OK);
    for (int i = 0; i < 2; i++)
        assert_int_equal(sf_file_read(i ? "b.exr" : "a.exr", 1 << 24, &log_caught, &bytes[i], &sizes[i]), SF_OK);
    assert_int_equal(sizes[0], sizes[1]);
    assert_memory_equal(bytes[0], bytes[1], sizes[0]);
    free(bytes[0]);
    free(bytes[1]);
    sf_texture_destroy(&texture);
    assert_int_equal(scratch_count("."), 3);
    scratch_empty(".");
}

/* Channels and attributes as they are documented. */
static void test_exr_channels(void **state)
{
    static const struct {
        uint32_t channels;
        const char *names;
    } cases[] = {{SF_TEXTURE_ALL, "A B G N.x N.y N.z R height "},
                 {SF_TEXTURE_COLOR | SF_TEXTURE_ALPHA, "A B G R "},
                 {SF_TEXTURE_ALPHA, "A "},
                 {SF_TEXTURE_NORMAL, "N.x N.y N.z "},
                 {SF_TEXTURE_HEIGHT, "height "}};
    struct sf_texture *texture = make();

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char names[64] = "";
        struct sf_exr exr;

        assert_int_equal(sf_texture_write_exr(texture, "a.exr", cases[i].channels, &exr_float, &log_caught), SF_OK);
        assert_int_equal(sf_exr_read("a.exr", NULL, 0, &exr, &log_caught), SF_OK);
        for (size_t p = 0; p < exr.plane_count; p++)
            snprintf(names + strlen(names), sizeof names - strlen(names), "%s ", exr.planes[p].name);
        assert_string_equal(names, cases[i].names);
        assert_string_equal(sf_exr_attribute(&exr, "sfumatoTiles")->text, "2x2");
        assert_string_equal(sf_exr_attribute(&exr, "sfumatoAlpha")->text, "premultiplied");
        assert_int_equal(sf_exr_attribute(&exr, "sfumatoLoop")->integer, 4);
        assert_non_null(strstr(sf_exr_attribute(&exr, "sfumatoTexture")->text, "kind=turbulence tiles=2x2 size=24x24"));
        sf_exr_finish(&exr);
    }
    sf_texture_destroy(&texture);
    scratch_empty(".");
}

static void test_png(void **state)
{
    struct sf_texture *texture = make(), *again;

    (void)state;
    for (unsigned bits = 8; bits <= 16; bits += 8) {
        float step = bits == 8 ? 1.0f / 255 : 1.0f / 65535;

        assert_int_equal(
            sf_texture_write_png(texture, "a.color.png", SF_TEXTURE_COLOR | SF_TEXTURE_ALPHA, bits, &log_caught),
            SF_OK);
        assert_int_equal(
            sf_texture_write_png(texture, "a.normal.png", SF_TEXTURE_NORMAL | SF_TEXTURE_HEIGHT, bits, &log_caught),
            SF_OK);
        again = load("a.color.png", 2, SF_TEXTURE_ALL);
        assert_int_equal(kit_info(again).channels, SF_TEXTURE_ALL);
        assert_alike(texture, again, -1, 2 * step);
        sf_texture_destroy(&again);
    }
    /* Without the second file, and under another name, there is only colour. */
    assert_int_equal(rename("a.color.png", "a.png"), 0);
    again = load("a.png", 2, SF_TEXTURE_COLOR | SF_TEXTURE_ALPHA);
    assert_int_equal(kit_info(again).channels, SF_TEXTURE_COLOR | SF_TEXTURE_ALPHA);
    assert_true(kit_info(again).shape[2] == 1 && kit_info(again).shape[3] == 0);
    sf_texture_destroy(&again);
    assert_int_equal(sf_texture_load("a.png", 2, 2, SF_TEXTURE_HEIGHT, &log_caught, &again), SF_ERROR_IO);
    assert_caught(&caught, "'a.png': it has no height (an atlas holds R, G, B, A, N.x");
    /* One kind alone: normals and grey. */
    struct sf_image image;
    for (uint32_t channel = SF_TEXTURE_ALPHA; channel <= SF_TEXTURE_HEIGHT; channel *= 2) {
        char *data;
        size_t size;

        assert_int_equal(sf_texture_write_png(texture, "b.png", channel, 16, &log_caught), SF_OK);
        assert_int_equal(sf_file_read("b.png", 1 << 24, &log_caught, &data, &size), SF_OK);
        assert_int_equal(sf_png_decode_numbers(data, size, "b.png", &image, &log_caught), SF_OK);
        for (size_t i = 0; i < (size_t)image.width * image.height * 4; i += 4) {
            const float *shape = texture->shape + i;
            float wanted = channel == SF_TEXTURE_ALPHA    ? texture->color[i + 3]
                           : channel == SF_TEXTURE_HEIGHT ? shape[3]
                                                          : 0.5f * shape[1] + 0.5f;

            assert_float_equal(image.pixels[i + 1], wanted, 1e-5);
            assert_true(image.pixels[i + 3] == 1);
        }
        sf_image_finish(&image);
        free(data);
    }
    assert_int_equal(sf_texture_write_png(texture, "c.png", SF_TEXTURE_ALPHA | SF_TEXTURE_HEIGHT, 8, &log_caught),
                     SF_ERROR_USAGE);
    assert_caught(&caught, "a PNG holds colour and alpha, or normal and height, or one of them");
    assert_int_equal(sf_texture_write_png(texture, "c.png", SF_TEXTURE_ALPHA, 12, &log_caught), SF_ERROR_USAGE);
    assert_caught(&caught, "12 bits");
    assert_int_equal(sf_texture_write_exr(texture, "c.exr", 0, &exr_float, &log_caught), SF_ERROR_USAGE);
    assert_caught(&caught, "no channels");
    assert_false(sf_file_exists("c.png") || sf_file_exists("c.exr"));
    sf_texture_destroy(&texture);
    scratch_empty(".");
}

/* ---- files of others ---- */

/* A file of 4x4 pixels with the channels named, all 0.5 but for one number. */
static void write_exr(const char *const *names, size_t count, size_t odd_channel, size_t odd_pixel, float odd,
                      const struct sf_exr_attribute *attribute)
{
    static float planes[8][16];
    struct sf_exr_channel channels[8];
    const struct sf_exr_frame frame = {.width = 4,
                                       .height = 4,
                                       .channels = channels,
                                       .channel_count = count,
                                       .attributes = attribute,
                                       .attribute_count = attribute ? 1 : 0};

    for (size_t c = 0; c < count; c++) {
        for (size_t i = 0; i < 16; i++)
            planes[c][i] = c == odd_channel && i == odd_pixel ? odd : 0.5f;
        channels[c] = (struct sf_exr_channel){names[c], planes[c], 4, 16, SF_EXR_FLOAT, SF_EXR_FLOAT};
    }
    assert_int_equal(sf_exr_write("x.exr", &frame, &log_caught), SF_OK);
}

static void refuse(uint32_t tiles_x, uint32_t tiles_y, uint32_t needs, const char *says)
{
    struct sf_texture *texture = (struct sf_texture *)&caught;

    if (sf_texture_load("x.exr", tiles_x, tiles_y, needs, &log_caught, &texture) != SF_ERROR_IO)
        fail_msg("x.exr is taken, but should be refused: %s", says);
    assert_null(texture);
    assert_caught(&caught, says);
}

static void test_bad_exr(void **state)
{
    static const char *const all[8] = {"A", "B", "G", "N.x", "N.y", "N.z", "R", "height"};
    static const char *const short_color[] = {"A", "B", "R"}, *const short_normal[] = {"A", "N.y", "N.z"};
    static const char *const others[] = {"Z", "id"};
    struct sf_exr_attribute told = sf_exr_text("sfumatoTiles", "2x2");

    (void)state;
    write_exr(all, 8, 0, 5, NAN, NULL);
    refuse(2, 2, 0, "'x.exr': A of pixel (1, 1) is not a number");
    write_exr(all, 8, 4, 0, INFINITY, NULL);
    refuse(2, 2, 0, "N.y of pixel (0, 0) is not a number");
    write_exr(all, 8, 6, 3, NAN, NULL);
    refuse(2, 2, 0, "R of pixel (3, 0) is not a number");
    write_exr(all, 8, 0, 15, 1.5f, NULL);
    refuse(2, 2, 0, "A of pixel (3, 3) is 1.5, and must be from 0 to 1");
    write_exr(all, 8, 7, 0, -2, NULL);
    refuse(2, 2, 0, "height of pixel (0, 0) is -2, and must be from 0 to 1");
    write_exr(all, 8, 1, 0, -1, NULL);
    refuse(2, 2, 0, "B of pixel (0, 0) is -2, and must be 0 or more");
    write_exr(all, 8, 0, 0, 0.5f, NULL);
    refuse(3, 2, 0, "4x4 pixels cannot be divided into 3x2 tiles");
    refuse(8, 8, 0, "cannot be divided into 8x8 tiles");
    refuse(0, 0, 0, "it does not say how many tiles it has");
    write_exr(all, 8, 0, 0, 0.5f, &told);
    refuse(1, 1, 0, "it has 2x2 tiles, not 1x1");
    told = sf_exr_text("sfumatoTiles", "many");
    write_exr(all, 8, 0, 0, 0.5f, &told);
    refuse(0, 0, 0, "sfumatoTiles is 'many'");
    told = sf_exr_integer("sfumatoLoop", 3);
    write_exr(all, 8, 0, 0, 0.5f, &told);
    refuse(2, 2, 0, "its loop of 3 does not divide its 4 tiles");
    write_exr(short_color, 3, 0, 0, 0.5f, NULL);
    refuse(1, 1, 0, "it has R, but no channel G");
    write_exr(short_normal, 3, 0, 0, 0.5f, NULL);
    refuse(1, 1, 0, "it has N.y, but no channel N.x");
    write_exr(others, 2, 0, 0, 0.5f, NULL);
    refuse(1, 1, 0, "it has none of R, G, B, A");
    write_exr(all, 1, 0, 0, 0.5f, NULL);
    refuse(1, 1, SF_TEXTURE_COLOR, "it has no R, G and B");
    refuse(1, 1, SF_TEXTURE_ALL, "it has no R, G and B");
    refuse(1, 1, SF_TEXTURE_NORMAL, "it has no N.x, N.y and N.z");
    assert_int_equal(sf_file_write("x.exr", "\x89PNG\r\n\x1a\nrest", 12, &log_caught), SF_OK);
    refuse(1, 1, 0, "not a sound PNG file");
    assert_int_equal(sf_file_write("x.exr", "\x76\x2f\x31\x01rest", 8, &log_caught), SF_OK);
    refuse(1, 1, 0, "x.exr");
    assert_int_equal(sf_file_write("x.exr", "JFIF", 4, &log_caught), SF_OK);
    refuse(1, 1, 0, "it is neither EXR nor PNG");
    assert_int_equal(sf_file_write("x.exr", "", 0, &log_caught), SF_OK);
    refuse(1, 1, 0, "it is neither EXR nor PNG");
    unlink("x.exr");
    refuse(1, 1, 0, "x.exr");
    scratch_empty(".");
}

/* Normals that are missing are made from the heights; others are made unit; alpha alone is white. */
static void test_lenient(void **state)
{
    static const char *const height[] = {"A", "height"}, *const normal[] = {"A", "N.x", "N.y", "N.z"};
    struct sf_texture *texture;
    struct sf_texture_info info;

    (void)state;
    write_exr(height, 2, 1, 5, 0.75f, NULL);
    texture = load("x.exr", 1, SF_TEXTURE_NORMAL | SF_TEXTURE_HEIGHT);
    info = kit_info(texture);
    /* Left of a hump of 0.25, half a side (2 texels) to the unit: a slope of 0.25 over two texels, each 0.5. */
    assert_float_equal(kit_texel(&info, info.shape, 0, 0, 1)[0] / kit_texel(&info, info.shape, 0, 0, 1)[2], -0.5, 1e-5);
    assert_float_equal(kit_texel(&info, info.shape, 0, 2, 1)[0] / kit_texel(&info, info.shape, 0, 2, 1)[2], 0.25, 1e-5);
    assert_true(info.color[0] == 1 && info.color[3] == 0.5f);
    sf_texture_destroy(&texture);
    write_exr(normal, 4, 0, 0, 0.5f, NULL);
    texture = load("x.exr", 1, SF_TEXTURE_ALPHA | SF_TEXTURE_NORMAL);
    info = kit_info(texture);
    for (size_t c = 0; c < 3; c++)
        assert_float_equal(info.shape[c], 0.5773503, 1e-6);
    assert_int_equal(info.channels, SF_TEXTURE_ALPHA | SF_TEXTURE_NORMAL);
    sf_texture_destroy(&texture);
    scratch_empty(".");
}

/* A pair of PNG files that do not belong together. */
static void test_bad_pair(void **state)
{
    struct sf_texture *texture = make(), *again;
    static const uint8_t pixels[4 * 4 * 4];
    const struct sf_png_frame small = {.width = 4, .height = 4, .channels = 4, .bits = 8, .pixels = pixels};

    (void)state;
    assert_int_equal(sf_texture_write_png(texture, "a.color.png", SF_TEXTURE_COLOR | SF_TEXTURE_ALPHA, 8, &log_caught),
                     SF_OK);
    assert_int_equal(sf_png_write("a.normal.png", &small, &log_caught), SF_OK);
    assert_int_equal(sf_texture_load("a.color.png", 2, 2, 0, &log_caught, &again), SF_ERROR_IO);
    assert_caught(&caught, "'a.normal.png': it has 4x4 pixels, but 'a.color.png' has 48x48");
    assert_int_equal(sf_file_write("a.normal.png", "none", 4, &log_caught), SF_OK);
    assert_int_equal(sf_texture_load("a.color.png", 2, 2, 0, &log_caught, &again), SF_ERROR_IO);
    assert_caught(&caught, "'a.normal.png': it is not a PNG file");
    assert_int_equal(sf_texture_load("a.color.png", 0, 0, 0, &log_caught, &again), SF_ERROR_IO);
    assert_caught(&caught, "it does not say how many tiles it has");
    sf_texture_destroy(&texture);
    scratch_empty(".");
}

/* Nothing is left of a file that could not be written, and what was there stays. */
static void test_whole(void **state)
{
    struct sf_texture *texture = make();

    (void)state;
    assert_int_equal(mkdir("folder.exr", 0777), 0);
    assert_int_equal(sf_texture_write_exr(texture, "folder.exr", SF_TEXTURE_ALL, &exr_float, &log_caught), SF_ERROR_IO);
    assert_caught(&caught, "folder.exr");
    assert_int_equal(sf_texture_write_png(texture, "none/a.png", SF_TEXTURE_ALPHA, 8, &log_caught), SF_ERROR_IO);
    assert_caught(&caught, "none/a.png");
    assert_int_equal(scratch_count("."), 1);
    sf_texture_destroy(&texture);
    scratch_empty(".");
}

/* ---- for devices ---- */

/* What a channel of a plane is to be at a texel. */
static double plane_value(const struct sf_texture_info *info, enum sf_texels_plane plane, uint32_t tile, uint32_t x,
                          uint32_t y, size_t c)
{
    const float *texel = kit_texel(info, plane == SF_TEXELS_SHAPE ? info->shape : info->color, tile, x, y);

    return plane == SF_TEXELS_SHAPE || c == 3 ? (double)texel[c] : (double)(texel[c] * texel[3]);
}

/* Both planes of each tile: at its own size as they are, at half of it means of squares, with normals of unit length. */
static void test_texels(void **state)
{
    struct sf_texture *texture = make();
    struct sf_texture_info info = kit_info(texture);
    uint8_t bytes[SIDE * SIDE * 4];
    uint16_t halves[SIDE * SIDE * 4];

    (void)state;
    for (uint32_t i = 0; i < 2 * 4; i++) {
        enum sf_texels_plane plane = (enum sf_texels_plane)(i % 2);
        uint32_t tile = i / 2;

        sf_texels_rgba8(texture, plane, tile, SIDE, bytes);
        sf_texels_rgba16f(texture, plane, tile, SIDE, halves);
        for (uint32_t k = 0; k < SIDE * SIDE * 4; k++) {
            double wanted = plane_value(&info, plane, tile, k / 4 % SIDE, k / 4 / SIDE, k % 4);

            assert_float_equal(sf_half_to_float(halves[k]), wanted, 1e-3);
            assert_float_equal(bytes[k] / 255.0, plane && k % 4 < 3 ? (127 * wanted + 128) / 255 : wanted, 0.51 / 255);
        }
        sf_texels_rgba16f(texture, plane, tile, SIDE / 2, halves);
        for (uint32_t k = 0; k < SIDE * SIDE / 4; k++) {
            double mean[4] = {0}, length = 1;

            for (uint32_t j = 0; j < 16; j++)
                mean[j % 4] += 0.25 * plane_value(&info, plane, tile, k % (SIDE / 2) * 2 + j / 4 % 2,
                                                  k / (SIDE / 2) * 2 + j / 8, j % 4);
            if (plane == SF_TEXELS_SHAPE)
                length = sqrt(mean[0] * mean[0] + mean[1] * mean[1] + mean[2] * mean[2]);
            for (uint32_t c = 0; c < 4; c++)
                assert_float_equal(sf_half_to_float(halves[4 * k + c]), mean[c] / (c < 3 ? length : 1), 1e-3);
        }
    }
    sf_texture_destroy(&texture);
}

/* One tile's alpha: as it is at its own size, the mean of squares at half of it, and between its texels at twice. */
static void test_tile_alpha(void **state)
{
    struct sf_texture *texture = make();
    struct sf_texture_info info = kit_info(texture);
    uint8_t texels[2 * SIDE * 2 * SIDE];

    (void)state;
    for (uint32_t tile = 0; tile < 4; tile++) {
        sf_texels_tile_alpha(texture, tile, SIDE, 2 * SIDE, texels);
        for (uint32_t y = 0; y < SIDE; y++)
            for (uint32_t x = 0; x < SIDE; x++)
                assert_float_equal(texels[y * 2 * SIDE + x] / 255.0, kit_texel(&info, info.color, tile, x, y)[3],
                                   0.51 / 255);
        sf_texels_tile_alpha(texture, tile, SIDE / 2, SIDE / 2, texels);
        for (uint32_t y = 0; y < SIDE / 2; y++)
            for (uint32_t x = 0; x < SIDE / 2; x++) {
                double sum = 0;

                for (uint32_t i = 0; i < 4; i++)
                    sum += (double)kit_texel(&info, info.color, tile, 2 * x + i % 2, 2 * y + i / 2)[3];
                assert_float_equal(texels[y * SIDE / 2 + x] / 255.0, sum / 4, 0.51 / 255);
            }
        sf_texels_tile_alpha(texture, tile, 2 * SIDE, 2 * SIDE, texels);
        for (uint32_t y = 0; y + 1 < SIDE; y++)
            for (uint32_t x = 0; x < SIDE; x++) {
                double here = kit_texel(&info, info.color, tile, x, y)[3],
                       below = kit_texel(&info, info.color, tile, x, y + 1)[3];
                double left = kit_texel(&info, info.color, tile, x > 0 ? x - 1 : 0, y)[3],
                       left_below = kit_texel(&info, info.color, tile, x > 0 ? x - 1 : 0, y + 1)[3];

                assert_float_equal(texels[(2 * y + 1) * 2 * SIDE + 2 * x] / 255.0,
                                   0.75 * (0.75 * here + 0.25 * below) + 0.25 * (0.75 * left + 0.25 * left_below),
                                   0.51 / 255);
            }
    }
    sf_texture_destroy(&texture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_exr),     cmocka_unit_test(test_exr_channels), cmocka_unit_test(test_png),
        cmocka_unit_test(test_bad_exr), cmocka_unit_test(test_lenient),      cmocka_unit_test(test_bad_pair),
        cmocka_unit_test(test_whole),   cmocka_unit_test(test_texels),       cmocka_unit_test(test_tile_alpha),
    };

    return cmocka_run_group_tests(tests, scratch_enter, scratch_leave);
}
