/* src/output: tone mapping, PNG and Radiance files, the reader for all kinds. */
#include "scratch.h"

#include <math.h>
#include <png.h>
#include "base/array.h"
#include "base/file.h"
#include "base/hash.h"
#include "output/half.h"
#include "output/hdr.h"
#include "output/image.h"
#include "output/png.h"
#include "output/tone.h"
#include "sfumato/sfumato.h"

static struct caught caught;
static const struct sf_log log_caught = {.write = caught_write, .user = &caught, .level = SF_LOG_DEBUG};

static void test_tone_modes(void **state)
{
    static const struct {
        enum sf_tone_mode mode;
        float exposure, light[3], display[3];
    } cases[] = {
        {SF_TONE_LINEAR, 0, {0.25f, 1.0f, 3.0f}, {0.25f, 1, 1}},
        {SF_TONE_LINEAR, 1, {0.25f, 0.0f, -3.0f}, {0.5f, 0, 0}},
        {SF_TONE_LINEAR, -2, {1, 2, 4}, {0.25f, 0.5f, 1}},
        {SF_TONE_REINHARD, 0, {1, 1, 1}, {0.53125f, 0.53125f, 0.53125f}}, /* (1 + 1/16) / 2 */
        {SF_TONE_REINHARD, 0, {4, 4, 4}, {1, 1, 1}},
        {SF_TONE_ACES, 0, {1, 1, 1}, {0.619115f, 0.619115f, 0.619115f}}, /* the curve at 1, worked in double */
        {SF_TONE_ACES, 0, {1e9f, 1e9f, 1e9f}, {1, 1, 1}},
        {SF_TONE_NEUTRAL, 0, {0.5f, 0.4f, 0.3f}, {0.46f, 0.36f, 0.26f}},    /* only the toe's 0.04 */
        {SF_TONE_NEUTRAL, 0, {0.04f, 0.04f, 0.04f}, {0.01f, 0.01f, 0.01f}}, /* 6.25 x^2 */
        {SF_TONE_NEUTRAL, 0, {1.04f, 1.04f, 1.04f}, {0.88f, 0.88f, 0.88f}}, /* 1 - 0.24^2 / (1 + 0.24 - 0.76) */
    };

    (void)state;
    for (size_t i = 0; i < SF_COUNT(cases); i++) {
        struct sf_tone tone = {.mode = cases[i].mode, .exposure = cases[i].exposure};
        float display[3];

        sf_tone_map(&tone, cases[i].light, display);
        for (int c = 0; c < 3; c++)
            if (fabsf(display[c] - cases[i].display[c]) > 2e-4f)
                fail_msg("%s: %g gives %g, wanted %g", sf_tone_name(tone.mode), cases[i].light[c], display[c],
                         cases[i].display[c]);
    }
}

/* Every mode: black stays black, more light never darkens, all within [0,1], and no light is too strange. */
static void test_tone_sane(void **state)
{
    (void)state;
    for (int mode = SF_TONE_LINEAR; mode <= SF_TONE_NEUTRAL; mode++) {
        struct sf_tone tone = {.mode = (enum sf_tone_mode)mode};
        float display[3], last = 0.0f;
        static const float strange[][3] = {
            {NAN, 1, 1}, {HUGE_VALF, 0, 0}, {-HUGE_VALF, HUGE_VALF, NAN}, {3e38f, 3e38f, 3e38f}};

        for (int i = 0; i < 2000; i++) {
            float grey = 1e-5f * powf(1.012f, (float)i), light[3] = {grey, grey, grey};

            sf_tone_map(&tone, light, display);
            assert_true(display[1] >= last - 1e-6f && display[1] <= 1.0f);
            assert_float_equal(display[0], display[2], 1e-3);
            last = display[1];
        }
        assert_true(last > 0.99f);
        sf_tone_map(&tone, (const float[3]){0, 0, 0}, display);
        assert_true(display[0] < 1e-6f);
        sf_tone_map(&tone, (const float[3]){HUGE_VALF, HUGE_VALF, HUGE_VALF}, display);
        assert_true(display[0] > 0.99f && display[1] > 0.99f && display[2] > 0.99f);
        for (size_t i = 0; i < SF_COUNT(strange); i++) {
            sf_tone_map(&tone, strange[i], display);
            for (int c = 0; c < 3; c++)
                assert_true(display[c] >= 0.0f && display[c] <= 1.0f);
        }
    }
    enum sf_tone_mode mode;
    assert_int_equal(sf_tone_parse("aces", &mode, &log_caught), SF_OK);
    assert_int_equal(mode, SF_TONE_ACES);
    assert_int_equal(sf_tone_parse("agx", &mode, &log_caught), SF_ERROR_USAGE);
    assert_caught(&caught, "unknown tone mapping 'agx': linear,");
}

static void test_encode(void **state)
{
    struct sf_tone linear = {.mode = SF_TONE_LINEAR};

    (void)state;
    assert_float_equal(sf_srgb_encode(0.5), 0.735357, 1e-6);
    assert_float_equal(sf_srgb_decode(sf_srgb_encode(0.2)), 0.2, 1e-12);
    assert_float_equal(sf_srgb_encode(0.002), 0.02584, 1e-9);
    /* The table against the definition. A value next to a threshold may fall either way: its light is a rounded float.
     */
    for (uint32_t i = 0; i <= 400000; i++) {
        float value = i == 400000 ? 1.0f : sf_random_float(3, i, 0) * (i % 2 ? 1.0f : 0.01f);
        float rgba[4] = {value, value, value, 1.0f};
        uint8_t got[3];
        double exact = sf_srgb_encode(value) * 255.0;

        sf_tone_encode8(&linear, rgba, 1, 3, got);
        if (fabs((double)got[1] - exact) > 0.5 + 1e-5)
            fail_msg("%g gives %u, wanted %g", value, (unsigned)got[1], exact);
    }
    float pixels[] = {0.25f, 0.5f, 0.125f, 0.5f, 3.0f, 2.0f, 1.0f, 0.0f, 0.5f, NAN, -1.0f, 2.0f};
    uint8_t three[9], four[12];
    uint16_t deep[12];
    sf_tone_encode8(&linear, pixels, 3, 3, three);
    sf_tone_encode8(&linear, pixels, 3, 4, four);
    sf_tone_encode16(&linear, pixels, 3, 4, deep);
    const uint8_t want3[] = {137, 188, 99, 255, 255, 255, 188, 0, 0},
                  want4[] = {188, 255, 137, 128, 0, 0, 0, 0, 188, 0, 0, 255};
    assert_memory_equal(three, want3, 9);
    assert_memory_equal(four, want4, 12);
    assert_int_equal(deep[0], 48192); /* 0.735357 * 65535 */
    assert_int_equal(deep[3], 32768);
    assert_int_equal(deep[11], 65535);
}

static bool holds(const char *data, size_t size, const char *part)
{
    for (size_t i = 0; i + strlen(part) <= size; i++)
        if (memcmp(data + i, part, strlen(part)) == 0)
            return true;
    return false;
}

static void test_png_round_trip(void **state)
{
    (void)state;
    for (unsigned kind = 0; kind < 4; kind++) {
        enum { WIDTH = 37, HEIGHT = 21, COUNT = WIDTH * HEIGHT };
        unsigned channels = kind % 2 ? 4 : 3, bits = kind / 2 ? 16 : 8;
        uint8_t bytes[COUNT * 4];
        uint16_t words[COUNT * 4];
        struct sf_png_frame frame = {.width = WIDTH, .height = HEIGHT, .channels = channels, .bits = bits};
        struct sf_image image;
        char *first, *second;
        size_t first_size, second_size;

        for (uint32_t i = 0; i < COUNT * 4; i++) {
            words[i] = (uint16_t)sf_random_u32(1, i, 0);
            bytes[i] = (uint8_t)words[i];
        }
        frame.pixels = bits == 8 ? (const void *)bytes : (const void *)words;
        assert_int_equal(sf_png_write("p.png", &frame, &log_caught), SF_OK);
        assert_int_equal(sf_file_read("p.png", SIZE_MAX, &log_caught, &first, &first_size), SF_OK);
        assert_true(holds(first, first_size, "sRGB"));
        assert_int_equal(sf_png_write("p.png", &frame, &log_caught), SF_OK);
        assert_int_equal(sf_file_read("p.png", SIZE_MAX, &log_caught, &second, &second_size), SF_OK);
        assert_int_equal(first_size, second_size);
        assert_memory_equal(first, second, first_size);
        assert_int_equal(sf_image_read("p.png", &image, &log_caught), SF_OK);
        assert_int_equal(image.width, WIDTH);
        assert_int_equal(image.height, HEIGHT);
        for (size_t i = 0; i < COUNT; i++) {
            for (size_t c = 0; c < 4; c++) {
                double value = c >= channels ? 1.0
                               : bits == 8   ? bytes[i * channels + c] / 255.0
                                             : words[i * channels + c] / 65535.0;

                assert_float_equal(image.pixels[4 * i + c], c == 3 ? value : sf_srgb_decode(value), 1e-6);
            }
        }
        sf_image_finish(&image);
        free(first);
        free(second);
    }
    assert_int_equal(caught.errors, 0);
}

/* Other kinds of PNG, written with the library itself: one row of four pixels. */
static void write_png(const char *path, int bits, int type, double gamma, int interlace, png_const_bytep row)
{
    static const png_color palette[] = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {128, 128, 128}};
    static const png_byte alphas[] = {255, 128};
    FILE *file = fopen(path, "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);

    assert_non_null(file);
    png_init_io(png, file);
    png_set_IHDR(png, info, 4, 1, bits, type, interlace, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (type == PNG_COLOR_TYPE_PALETTE) {
        png_set_PLTE(png, info, palette, 4);
        png_set_tRNS(png, info, alphas, 2, NULL);
    }
    if (gamma > 0)
        png_set_gAMA(png, info, gamma);
    png_write_info(png, info);
    for (int pass = png_set_interlace_handling(png); pass > 0; pass--)
        png_write_row(png, row);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    fclose(file);
}

static void test_png_kinds(void **state)
{
    struct sf_image image;

    (void)state;
    write_png("grey.png", 8, PNG_COLOR_TYPE_GRAY, 0, PNG_INTERLACE_ADAM7, (const png_byte[]){0, 51, 128, 255});
    assert_int_equal(sf_image_read("grey.png", &image, &log_caught), SF_OK);
    assert_float_equal(image.pixels[8], 0.2158605, 1e-6);
    assert_true(image.pixels[8] == image.pixels[10] && image.pixels[11] == 1.0f && image.pixels[12] == 1.0f);
    sf_image_finish(&image);
    write_png("linear.png", 8, PNG_COLOR_TYPE_GRAY, 1.0, PNG_INTERLACE_NONE, (const png_byte[]){0, 51, 128, 255});
    assert_int_equal(sf_image_read("linear.png", &image, &log_caught), SF_OK);
    assert_float_equal(image.pixels[4], 0.2, 1e-6);
    sf_image_finish(&image);
    write_png("gamma.png", 16, PNG_COLOR_TYPE_GRAY_ALPHA, 0.45455, PNG_INTERLACE_NONE,
              (const png_byte[]){128, 0, 64, 0, 255, 255, 0, 0, 0, 0, 255, 255, 1, 0, 255, 255});
    assert_int_equal(sf_image_read("gamma.png", &image, &log_caught), SF_OK);
    assert_float_equal(image.pixels[0], pow(32768 / 65535.0, 2.2), 1e-4);
    assert_float_equal(image.pixels[3], 16384 / 65535.0, 1e-6);
    assert_true(image.pixels[4] == 1.0f && image.pixels[7] == 0.0f);
    sf_image_finish(&image);
    write_png("palette.png", 2, PNG_COLOR_TYPE_PALETTE, 0, PNG_INTERLACE_NONE, (const png_byte[]){0x1B}); /* 0 1 2 3 */
    assert_int_equal(sf_image_read("palette.png", &image, &log_caught), SF_OK);
    assert_true(image.pixels[0] == 1.0f && image.pixels[1] == 0.0f && image.pixels[3] == 1.0f);
    assert_float_equal(image.pixels[7], 128 / 255.0, 1e-4);
    assert_float_equal(image.pixels[13], 0.2158605, 1e-4);
    sf_image_finish(&image);
    assert_int_equal(caught.errors, 0);
}

static void test_png_refused(void **state)
{
    uint8_t pixel[4] = {0};
    struct sf_png_frame frame = {.width = 1, .height = 1, .channels = 2, .bits = 8, .pixels = pixel};

    (void)state;
    assert_int_equal(sf_png_write("q.png", &frame, &log_caught), SF_ERROR_USAGE);
    assert_caught(&caught, "1x1 pixels, 2 channels");
    frame.channels = 3;
    frame.width = 0;
    assert_int_equal(sf_png_write("q.png", &frame, &log_caught), SF_ERROR_USAGE);
    assert_caught(&caught, "0x1 pixels");
    frame.width = 1;
    assert_int_equal(sf_png_write("absent/q.png", &frame, &log_caught), SF_ERROR_IO);
    assert_caught(&caught, "'absent/q.png': its folder does not exist");
#ifdef __linux__
    /* Root writes anywhere by mode bits; the kernel's own folder takes no files. */
    assert_int_equal(sf_png_write("/proc/q.png", &frame, &log_caught), SF_ERROR_IO);
    assert_caught(&caught, "'/proc/q.png'");
#endif
}

static const char HDR_HEADER[] = "#?RADIANCE\n# made by hand\nEXPOSURE=2.0\nFORMAT=32-bit_rle_rgbe\n\n";

/* Header, size line and pixels. Returns the size. */
static size_t hdr_make(char *to, const char *size_line, const void *pixels, size_t bytes)
{
    size_t used = (size_t)sprintf(to, "%s%s\n", HDR_HEADER, size_line);

    memcpy(to + used, pixels, bytes);
    return used + bytes;
}

static void test_hdr(void **state)
{
    /* 2 x 2 plain: mantissas 128 with exponent 129 make (128.5 / 256) * 2 = 1.00390625, and exposure 2 halves it. */
    static const unsigned char plain[] = {128, 64, 0, 129, 1, 2, 3, 0, 9, 9, 9, 128, 255, 255, 255, 255};
    /* 8 x 1: runs of red, literal green, runs of blue, exponents; then 8 x 1 in old runs. */
    static const unsigned char runs[] = {2, 2, 0, 8, 136, 100, 4, 1, 2, 3, 4, 132, 7, 135, 0, 1, 200, 136, 136};
    static const unsigned char old[] = {10, 20, 30, 128, 1, 1, 1, 6, 40, 50, 60, 128};
    char file[512];
    struct sf_image image;
    size_t size;

    (void)state;
    size = hdr_make(file, "-Y 2 +X 2", plain, sizeof plain);
    assert_int_equal(sf_hdr_decode(file, size, "h", &image, &log_caught), SF_OK);
    assert_float_equal(image.pixels[0], 0.501953125, 1e-7);
    assert_float_equal(image.pixels[1], 64.5 / 256, 1e-7);
    assert_true(image.pixels[3] == 1.0f && image.pixels[4] == 0.0f && image.pixels[6] == 0.0f);
    assert_float_equal(image.pixels[12], 255.5 * 0x1p118, 0x1p110);
    sf_image_finish(&image);
    size = hdr_make(file, "+Y 2 +X 2", plain, sizeof plain);
    assert_int_equal(sf_hdr_decode(file, size, "h", &image, &log_caught), SF_OK);
    assert_float_equal(image.pixels[8], 0.501953125, 1e-7);
    sf_image_finish(&image);
    size = hdr_make(file, "-Y 1 +X 8", runs, sizeof runs);
    assert_int_equal(sf_hdr_decode(file, size, "h", &image, &log_caught), SF_OK);
    for (size_t x = 0; x < 8; x++) {
        assert_float_equal(image.pixels[4 * x], 100.5 / 2, 1e-5); /* * 2^(136 - 136) / exposure */
        assert_float_equal(image.pixels[4 * x + 1], (x < 4 ? (double)x + 1.5 : 7.5) / 2, 1e-5);
        assert_float_equal(image.pixels[4 * x + 2], (x < 7 ? 0.5 : 200.5) / 2, 1e-5);
    }
    sf_image_finish(&image);
    size = hdr_make(file, "-Y 1 +X 8", old, sizeof old);
    assert_int_equal(sf_hdr_decode(file, size, "h", &image, &log_caught), SF_OK);
    assert_true(image.pixels[4 * 6 + 1] == image.pixels[1] && image.pixels[4 * 7] > image.pixels[4 * 6]);
    sf_image_finish(&image);
    assert_int_equal(sf_file_write("a.hdr", file, size, &log_caught), SF_OK);
    assert_int_equal(sf_image_read("a.hdr", &image, &log_caught), SF_OK);
    assert_int_equal(image.width, 8);
    sf_image_finish(&image);
    assert_int_equal(caught.errors, 0);
}

static void test_hdr_refused(void **state)
{
    static const char *const bad[][2] = {
        {"#?RADIANCE\n", "header is cut short"},
        {"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\nabcd", "not 32-bit_rle_rgbe"},
        {"#?RADIANCE\n\n-Y 1 +X 1\nabcd", "names no format"},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=0\n\n-Y 1 +X 1\nabcd", "exposure is not a positive"},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=nan\n\n-Y 1 +X 1\nabcd", "exposure is not a positive"},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n+X 1 -Y 1\nabcd", "not of the form"},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 0 +X 1\nabcd", "no pixels"},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 40000 +X 1\nabcd", "over the limit"},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 30000 +X 30000\nabcd", "over the limit"},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 9000 +X 9000\nabcd", "cut short"},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 1\nabcd", "corrupt or cut short"},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 4\n\1\1\1\4abcd", "corrupt or cut short"},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 9\n\2\2\1\1\377abcdefgh", "corrupt or cut short"},
    };
    struct sf_image image;

    (void)state;
    for (size_t i = 0; i < SF_COUNT(bad); i++) {
        assert_int_equal(sf_hdr_decode(bad[i][0], strlen(bad[i][0]), "h", &image, &log_caught), SF_ERROR_IO);
        assert_caught(&caught, bad[i][1]);
        assert_null(image.pixels);
    }
}

typedef enum sf_status (*decode_fn)(const void *, size_t, const char *, struct sf_image *, const struct sf_log *);

/* Cut short at many places: an error each time. Bits turned: an answer, and an error exactly when it is not SF_OK. */
static void damage(decode_fn decode, const char *data, size_t size)
{
    char *copy = malloc(size);
    struct sf_image image;

    for (size_t cut = 0; cut < size; cut += size / 200 + 1) {
        memcpy(copy, data, cut);
        assert_int_equal(decode(copy, cut, "cut", &image, &log_caught), SF_ERROR_IO);
        assert_int_equal(caught.errors, 1);
        caught.errors = 0;
    }
    for (uint32_t round = 0; round < 2000; round++) {
        enum sf_status status;

        memcpy(copy, data, size);
        for (uint32_t i = 0; i <= round % 3; i++)
            copy[sf_random_u32(5, round, i) % size] ^= (char)(1u << sf_random_u32(5, round, 9 + i) % 7);
        status = decode(copy, size, "damaged", &image, &log_caught);
        assert_int_equal(caught.errors, status != SF_OK);
        sf_image_finish(&image);
        caught.errors = 0;
    }
    free(copy);
}

static void test_damaged(void **state)
{
    unsigned char pixels[40 * (4 + 4 * 27)];
    char file[8192], *png;
    size_t size, used = 0;
    uint8_t rgb[64 * 48 * 3];
    struct sf_png_frame frame = {.width = 64, .height = 48, .channels = 3, .bits = 8, .pixels = rgb};

    (void)state;
    for (unsigned i = 0; i < sizeof rgb; i++)
        rgb[i] = (uint8_t)(i / 50 + sf_random_u32(1, i, 0) % 8);
    assert_int_equal(sf_png_write("d.png", &frame, &log_caught), SF_OK);
    assert_int_equal(sf_file_read("d.png", SIZE_MAX, &log_caught, &png, &size), SF_OK);
    damage(sf_png_decode, png, size);
    free(png);
    for (unsigned y = 0; y < 40; y++) {
        memcpy(pixels + used, (const unsigned char[]){2, 2, 0, 50}, 4);
        used += 4;
        for (unsigned c = 0; c < 4; c++) {
            pixels[used++] = 128 + 26;
            pixels[used++] = (unsigned char)(y + c);
            pixels[used++] = 22;
            for (unsigned i = 0; i < 22; i++)
                pixels[used++] = (unsigned char)(sf_random_u32(1, y * 4 + c, i));
            pixels[used++] = 128 + 2;
            pixels[used++] = 130;
        }
    }
    size = hdr_make(file, "-Y 40 +X 50", pixels, used);
    damage(sf_hdr_decode, file, size);
}

/* The public writer: colour of a rendered frame, as halves or floats. */
static void test_frame_png(void **state)
{
    float color[2 * 3 * 4];
    uint16_t halves[2 * 3 * 4];
    struct sf_frame frame = {.width = 2, .height = 3, .color = halves};
    struct sf_image image;

    (void)state;
    for (size_t i = 0; i < SF_COUNT(color); i++) {
        color[i] = (float)i / 16.0f;
        halves[i] = sf_half_from_float(color[i]);
    }
    for (int floats = 0; floats < 2; floats++) {
        assert_int_equal(sf_frame_write_png(&frame, "frame.png", "linear", -1.0f, &log_caught), SF_OK);
        assert_int_equal(sf_image_read("frame.png", &image, &log_caught), SF_OK);
        assert_int_equal(image.width, 2);
        assert_int_equal(image.height, 3);
        for (size_t i = 0; i < SF_COUNT(color); i++)
            assert_float_equal(image.pixels[i], (i % 4 == 3 ? 1.0f : color[i] / 2), 0.005);
        sf_image_finish(&image);
        frame.color = NULL;
        frame.color_float = color;
    }
    assert_int_equal(sf_frame_write_png(&frame, "frame.png", "sepia", 0, &log_caught), SF_ERROR_USAGE);
    assert_caught(&caught, "unknown tone mapping 'sepia'");
    frame.color_float = NULL;
    assert_int_equal(sf_frame_write_png(&frame, "frame.png", "linear", 0, &log_caught), SF_ERROR_USAGE);
    assert_caught(&caught, "the frame has no colour");
}

static void test_kinds(void **state)
{
    struct sf_image image;

    (void)state;
    assert_int_equal(sf_file_write("text.png", "no picture", 10, &log_caught), SF_OK);
    assert_int_equal(sf_image_read("text.png", &image, &log_caught), SF_ERROR_IO);
    assert_caught(&caught, "'text.png': it is neither EXR nor PNG nor Radiance HDR");
    assert_int_equal(sf_file_write("none.png", "", 0, &log_caught), SF_OK);
    assert_int_equal(sf_image_read("none.png", &image, &log_caught), SF_ERROR_IO);
    assert_caught(&caught, "neither");
    assert_int_equal(sf_image_read("absent.png", &image, &log_caught), SF_ERROR_IO);
    assert_caught(&caught, "No such file");
    assert_int_equal(sf_image_read(".", &image, &log_caught), SF_ERROR_IO);
    assert_caught(&caught, "it is a folder");
    sf_image_finish(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tone_modes), cmocka_unit_test(test_tone_sane),
        cmocka_unit_test(test_encode),     cmocka_unit_test(test_png_round_trip),
        cmocka_unit_test(test_png_kinds),  cmocka_unit_test(test_png_refused),
        cmocka_unit_test(test_hdr),        cmocka_unit_test(test_hdr_refused),
        cmocka_unit_test(test_damaged),    cmocka_unit_test(test_kinds),
        cmocka_unit_test(test_frame_png),
    };

    return cmocka_run_group_tests(tests, scratch_enter, scratch_leave);
}
