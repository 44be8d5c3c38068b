/* src/output: halves and OpenEXR files. */
#include "exr_picture.h"

#include <math.h>
#include "base/array.h"
#include "base/file.h"
#include "base/hash.h"
#include "output/exr.h"
#include "output/exr_compress.h"
#include "output/half.h"
#include "output/image.h"
#include "output/tone.h"
#include "sfumato/sfumato.h"

static struct caught caught;
static const struct sf_log log_caught = {.write = caught_write, .user = &caught, .level = SF_LOG_DEBUG};

static float bits_float(uint32_t bits)
{
    float value;

    memcpy(&value, &bits, sizeof value);
    return value;
}

static void test_half(void **state)
{
    static const struct {
        float value;
        uint16_t half;
    } pairs[] = {
        {0.0f, 0},
        {-0.0f, 0x8000},
        {1.0f, 0x3C00},
        {-2.0f, 0xC000},
        {65504.0f, 0x7BFF},
        {65519.996f, 0x7BFF},
        {65520.0f, 0x7BFF}, /* IEEE would round to infinity */
        {1e30f, 0x7BFF},
        {-1e30f, 0xFBFF},
        {HUGE_VALF, 0x7BFF},
        {-HUGE_VALF, 0xFBFF},
        {6.1035156e-5f, 0x0400},   /* the least normal */
        {6.0975552e-5f, 0x03FF},   /* the greatest subnormal */
        {5.9604645e-8f, 0x0001},   /* the least subnormal */
        {2.9802322e-8f, 0x0000},   /* a tie, to even */
        {2.9802326e-8f, 0x0001},   /* just over it */
        {8.9406967e-8f, 0x0002},   /* 1.5 steps: a tie, to even */
        {1.0f + 0x1p-11f, 0x3C00}, /* ties */
        {1.0f + 0x3p-11f, 0x3C02},
        {1e-20f, 0x0000},
    };

    (void)state;
    for (size_t i = 0; i < SF_COUNT(pairs); i++)
        assert_int_equal(sf_half_from_float(pairs[i].value), pairs[i].half);
    assert_true(isnan(sf_half_to_float(sf_half_from_float(NAN))));
    assert_true(isinf(sf_half_to_float(0x7C00)));
    for (uint32_t half = 0; half < 0x10000; half++)
        if ((half & 0x7C00) != 0x7C00)
            assert_int_equal(sf_half_from_float(sf_half_to_float((uint16_t)half)), half);
}

static void test_half_rows(void **state)
{
    enum { COUNT = 4099 };
    float *values = malloc(COUNT * sizeof *values);
    unsigned char fast[2 * COUNT + 1], slow[2 * COUNT + 1];

    (void)state;
    for (uint32_t round = 0; round < 200; round++) {
        size_t stride = round % 5 + 1, count = (COUNT - round % 16) / stride;

        for (uint32_t i = 0; i < COUNT; i++)
            values[i] = bits_float(sf_random_u32(1, i, round));
        memset(fast, 0, sizeof fast);
        memset(slow, 0, sizeof slow);
        sf_half_row(values, stride * sizeof(float), count, fast + 1); /* not aligned */
        sf_half_row_portable(values, stride * sizeof(float), count, slow + 1);
        assert_memory_equal(fast, slow, sizeof fast);
        for (size_t i = 0; i < count; i++)
            assert_int_equal(slow[1 + 2 * i] | slow[2 + 2 * i] << 8, sf_half_from_float(values[i * stride]));
    }
    free(values);
}

/* Lossy is B44 (halves) and PXR24 (floats): those channels are compared with a relative tolerance. */
static void assert_same(const struct picture *p, const struct sf_exr *exr, float half_error, float float_error)
{
    assert_int_equal(exr->width, p->width);
    assert_int_equal(exr->height, p->height);
    for (size_t i = 0; i < (size_t)p->width * p->height; i++) {
        for (size_t c = 0; c < 4; c++) {
            float want = sf_half_to_float(sf_half_from_float(p->rgba[4 * i + c])),
                  got = sf_exr_pixels(exr, p->channels[c].name)[i];

            if (!(fabsf(want - got) <= half_error))
                fail_msg("%s[%zu] is %g, wanted %g", p->channels[c].name, i, got, want);
        }
        float z = sf_exr_pixels(exr, "Z")[i];
        assert_true(z == p->z[i] || fabsf(z - p->z[i]) <= float_error * z);
        assert_true(fabsf(sf_exr_pixels(exr, "smoke.near")[i] - sf_half_to_float(p->n[i])) <= half_error);
    }
}

static void test_round_trip(void **state)
{
    static const uint32_t sizes[][2] = {{1, 1}, {17, 33}, {3, 200}, {300, 5}, {128, 64}};

    (void)state;
    for (int c = SF_EXR_NONE; c <= SF_EXR_B44; c++) {
        for (size_t s = 0; s < SF_COUNT(sizes); s++) {
            struct picture p;
            struct sf_exr exr;
            unsigned char *data, *again;
            char *file;
            size_t size, again_size, file_size;

            picture_make(&p, sizes[s][0], sizes[s][1], (enum sf_exr_compression)c);
            assert_int_equal(sf_exr_encode(&p.frame, &log_caught, &data, &size), SF_OK);
            assert_int_equal(sf_exr_decode(data, size, "memory", NULL, 0, &exr, &log_caught), SF_OK);
            assert_int_equal(exr.plane_count, 6);
            assert_string_equal(exr.planes[0].name, "A");
            assert_string_equal(exr.planes[5].name, "smoke.near");
            assert_int_equal(exr.planes[4].stored, SF_EXR_FLOAT);
            assert_same(&p, &exr, c == SF_EXR_B44 ? 0.1f : 0.0f, c == SF_EXR_PXR24 ? 1e-4f : 0.0f);
            sf_exr_finish(&exr);
            /* The same bytes again, and in a file. */
            assert_int_equal(sf_exr_encode(&p.frame, &log_caught, &again, &again_size), SF_OK);
            assert_int_equal(sf_exr_write("f.exr", &p.frame, &log_caught), SF_OK);
            assert_int_equal(sf_file_read("f.exr", SIZE_MAX, &log_caught, &file, &file_size), SF_OK);
            assert_int_equal(size, again_size);
            assert_int_equal(size, file_size);
            assert_memory_equal(data, again, size);
            assert_memory_equal(data, file, size);
            free(file);
            free(again);
            free(data);
            picture_free(&p);
        }
    }
    assert_int_equal(caught.errors, 0);
}

/* More than the writer's buffer in one line, and noise that no method makes smaller. */
static void test_incompressible(void **state)
{
    enum { WIDTH = 20000, HEIGHT = 18 };
    float *noise = malloc((size_t)WIDTH * HEIGHT * 4 * sizeof *noise);
    struct sf_exr_channel channels[4];

    (void)state;
    for (uint32_t i = 0; i < WIDTH * HEIGHT * 4; i++)
        noise[i] = bits_float(sf_random_u32(1, i, 2) & 0xBFFFFFFFu);
    for (size_t c = 0; c < 4; c++)
        channels[c] = (struct sf_exr_channel){.name = &"A\0B\0G\0R"[2 * c],
                                              .pixels = noise + c,
                                              .pixel_stride = 16,
                                              .row_stride = 16 * WIDTH,
                                              .source = SF_EXR_FLOAT,
                                              .stored = SF_EXR_FLOAT};
    for (int c = SF_EXR_NONE; c <= SF_EXR_PIZ; c++) {
        struct sf_exr_frame frame = {.width = WIDTH, .height = HEIGHT, .channels = channels, .channel_count = 4};
        struct sf_exr exr;
        struct stat about;

        frame.compression = (enum sf_exr_compression)c;
        assert_int_equal(sf_exr_write("noise.exr", &frame, &log_caught), SF_OK);
        assert_int_equal(stat("noise.exr", &about), 0);
        assert_in_range(about.st_size, WIDTH * HEIGHT * 15, WIDTH * HEIGHT * 16 + 2000);
        assert_int_equal(sf_exr_read("noise.exr", NULL, 0, &exr, &log_caught), SF_OK);
        for (size_t k = 0; k < 4; k++)
            for (size_t i = 0; i < WIDTH * HEIGHT; i++)
                assert_memory_equal(&exr.planes[k].pixels[i], &noise[4 * i + k], 4);
        sf_exr_finish(&exr);
    }
    free(noise);
    assert_int_equal(caught.errors, 0);
}

/* Undoes run lengths and the byte shuffle, by the format's definition. */
static size_t undo_runs(const unsigned char *from, size_t size, unsigned char *to)
{
    size_t at = 0, out = 0;

    while (at < size) {
        int count = from[at] < 128 ? from[at] : from[at] - 256;

        at++;
        for (int i = 0; i < (count < 0 ? -count : count + 1); i++)
            to[out++] = from[count < 0 ? at + (size_t)i : at];
        at += count < 0 ? (size_t)-count : 1;
    }
    for (size_t i = 1; i < out; i++)
        to[i] = (unsigned char)(to[i - 1] + to[i] - 128);
    return out;
}

static void test_runs(void **state)
{
    unsigned char chunk[700], decoded[1400];
    struct sf_exr_compressor *compressor = sf_exr_compressor_create(false, sizeof chunk);

    (void)state;
    assert_non_null(compressor);
    for (uint32_t round = 0; round < 3000; round++) {
        size_t size = sf_random_u32(round, 0, 0) % sizeof chunk + 1, encoded;
        uint32_t spread = 1u << round % 9; /* from runs to noise */
        const unsigned char *bytes;
        unsigned char value = 0;

        for (uint32_t i = 0; i < size; i++) {
            if (sf_random_u32(round, i, 1) % (round % 200 + 1) == 0)
                value = (unsigned char)(sf_random_u32(round, i, 2) % spread);
            chunk[i] = value;
        }
        bytes = sf_exr_compress(compressor, chunk, size, &encoded);
        if (!bytes) {
            assert_int_equal(encoded, size);
            continue;
        }
        assert_true(encoded < size);
        assert_int_equal(undo_runs(bytes, encoded, decoded), size);
        for (size_t i = 0; i < size; i++)
            assert_int_equal(chunk[i], decoded[i % 2 ? (size + 1) / 2 + i / 2 : i / 2]);
    }
    sf_exr_compressor_destroy(&compressor);
    sf_exr_compressor_destroy(&compressor);
    sf_exr_compressor_destroy(NULL);
}

static void test_clamp(void **state)
{
    float values[4] = {HUGE_VALF, -1e9f, 70000.0f, NAN};
    struct sf_exr_channel channels[] = {{.name = "h",
                                         .pixels = values,
                                         .pixel_stride = 4,
                                         .row_stride = 16,
                                         .source = SF_EXR_FLOAT,
                                         .stored = SF_EXR_HALF},
                                        {.name = "f",
                                         .pixels = values,
                                         .pixel_stride = 4,
                                         .row_stride = 16,
                                         .source = SF_EXR_FLOAT,
                                         .stored = SF_EXR_FLOAT}};
    struct sf_exr_frame frame = {
        .width = 4, .height = 1, .channels = channels, .channel_count = 2, .compression = SF_EXR_ZIP};
    unsigned char *data;
    size_t size;
    struct sf_exr exr;

    (void)state;
    assert_int_equal(sf_exr_encode(&frame, &log_caught, &data, &size), SF_OK);
    assert_int_equal(sf_exr_decode(data, size, "m", NULL, 0, &exr, &log_caught), SF_OK);
    const float *h = sf_exr_pixels(&exr, "h"), *f = sf_exr_pixels(&exr, "f");
    assert_true(h[0] == 65504.0f && h[1] == -65504.0f && h[2] == 65504.0f && isnan(h[3]));
    assert_true(f[0] == HUGE_VALF && f[1] == -1e9f && f[2] == 70000.0f && isnan(f[3]));
    sf_exr_finish(&exr);
    free(data);
}

static void test_attributes(void **state)
{
    static const struct {
        double fps;
        int32_t n;
        uint32_t d;
    } rates[] = {{24, 24, 1},          {25, 25, 1},   {23.976, 24000, 1001}, {29.97, 30000, 1001},
                 {59.94, 60000, 1001}, {12.5, 25, 2}, {0.1, 1, 10}};
    /* A camera at (1, 2, 5) that looks along -z: half width 1/2 and half height 1/4 at distance 1, near plane at 1. */
    static const float camera[16] = {1, 0, 0, -1, 0, 1, 0, -2, 0, 0, 1, -5, 0, 0, 0, 1};
    static const float clip[16] = {2, 0, 0, -2, 0, -4, 0, 8, 0, 0, 0, 1, 0, 0, -1, 5};
    struct picture p;
    struct sf_exr exr;
    unsigned char *data;
    size_t size;

    (void)state;
    for (size_t i = 0; i < SF_COUNT(rates); i++) {
        struct sf_exr_attribute rate = sf_exr_frames_per_second(rates[i].fps);

        assert_int_equal(rate.integer, rates[i].n);
        assert_int_equal(rate.denominator, rates[i].d);
    }
    struct sf_exr_attribute attributes[] = {
        sf_exr_text("software", "sfumato"),
        sf_exr_text("sfumatoSceneHash", "0123456789abcdef"),
        sf_exr_text("empty", ""),
        sf_exr_number("exposure", -1.5f),
        sf_exr_integer("frame", 42),
        sf_exr_frames_per_second(24),
        sf_exr_rec709(),
        sf_exr_world_to_camera(camera),
        sf_exr_world_to_ndc(clip),
    };
    picture_make(&p, 8, 8, SF_EXR_ZIP);
    p.frame.attributes = attributes;
    p.frame.attribute_count = SF_COUNT(attributes);
    assert_int_equal(sf_exr_encode(&p.frame, &log_caught, &data, &size), SF_OK);
    assert_int_equal(sf_exr_decode(data, size, "m", NULL, 0, &exr, &log_caught), SF_OK);
    for (size_t i = 0; i < SF_COUNT(attributes); i++) {
        const struct sf_exr_attribute *want = &attributes[i], *got = sf_exr_attribute(&exr, want->name);

        assert_non_null(got);
        assert_int_equal(got->kind, want->kind);
        assert_int_equal(got->integer, want->integer);
        assert_memory_equal(got->values, want->values, sizeof got->values);
        if (want->kind == SF_EXR_TEXT)
            assert_string_equal(got->text, want->text);
        if (want->kind == SF_EXR_RATIONAL)
            assert_int_equal(got->denominator, want->denominator);
    }
    assert_null(sf_exr_attribute(&exr, "capDate"));
    /* A point 4 ahead, 1 right and half up: on the picture's middle half. Row vector times matrix. */
    float point[4] = {2, 2.5f, 1, 1}, seen[4] = {0}, ndc[4] = {0};
    for (int row = 0; row < 4; row++) {
        for (int column = 0; column < 4; column++) {
            seen[column] += point[row] * sf_exr_attribute(&exr, "worldToCamera")->values[row * 4 + column];
            ndc[column] += point[row] * sf_exr_attribute(&exr, "worldToNDC")->values[row * 4 + column];
        }
    }
    assert_true(seen[0] == 1.0f && seen[1] == 0.5f && seen[2] == 4.0f && seen[3] == 1.0f);
    assert_true(ndc[3] == 4.0f);
    assert_float_equal(ndc[0] / ndc[3], 0.75, 1e-6);
    assert_float_equal(ndc[1] / ndc[3], 0.25, 1e-6);
    sf_exr_finish(&exr);
    free(data);
    picture_free(&p);
}

static void test_wanted(void **state)
{
    static const char *const some[] = {"Z", "R"}, *const none[] = {"R", "mist"};
    struct picture p;
    struct sf_exr exr;

    (void)state;
    picture_make(&p, 20, 20, SF_EXR_PIZ);
    assert_int_equal(sf_exr_write("w.exr", &p.frame, &log_caught), SF_OK);
    assert_int_equal(sf_exr_read("w.exr", some, 2, &exr, &log_caught), SF_OK);
    assert_int_equal(exr.plane_count, 2);
    assert_null(sf_exr_pixels(&exr, "G"));
    assert_true(sf_exr_pixels(&exr, "Z")[0] == p.z[0]);
    sf_exr_finish(&exr);
    sf_exr_finish(NULL);
    assert_int_equal(sf_exr_read("w.exr", none, 2, &exr, &log_caught), SF_ERROR_IO);
    assert_caught(&caught, "'w.exr': it has no channel 'mist'");
    assert_null(exr.planes);
    assert_int_equal(sf_exr_read("absent.exr", NULL, 0, &exr, &log_caught), SF_ERROR_IO);
    assert_caught(&caught, "'absent.exr': No such file");
    assert_int_equal(sf_exr_decode("plain text", 10, "t", NULL, 0, &exr, &log_caught), SF_ERROR_IO);
    assert_caught(&caught, "'t': it is not an OpenEXR file");
    picture_free(&p);
}

static void test_refused(void **state)
{
    enum sf_exr_compression compression = SF_EXR_RLE;
    struct picture p;

    (void)state;
    assert_int_equal(sf_exr_compression_parse("zips", &compression, &log_caught), SF_OK);
    assert_int_equal(compression, SF_EXR_ZIPS);
    assert_string_equal(sf_exr_compression_name(SF_EXR_PXR24), "pxr24");
    assert_int_equal(sf_exr_compression_parse("dwaa", &compression, &log_caught), SF_ERROR_USAGE);
    assert_caught(&caught, "'dwaa' is not available");
    assert_int_equal(sf_exr_compression_parse("lzw", &compression, &log_caught), SF_ERROR_USAGE);
    assert_caught(&caught, "unknown EXR compression 'lzw': none, rle, zips, zip, piz, pxr24 or b44");

    picture_make(&p, 8, 8, SF_EXR_ZIP);
    p.channels[3].name = "R";
    assert_int_equal(sf_exr_write("r.exr", &p.frame, &log_caught), SF_ERROR_USAGE);
    assert_caught(&caught, "channel 'R' comes twice");
    p.channels[3].name = "";
    assert_int_equal(sf_exr_write("r.exr", &p.frame, &log_caught), SF_ERROR_USAGE);
    assert_caught(&caught, "'r.exr'");
    p.channels[3].name = "a.name.of.more.than.thirty.one.bytes";
    assert_int_equal(sf_exr_write("r.exr", &p.frame, &log_caught), SF_ERROR_USAGE);
    assert_caught(&caught, "'r.exr'");
    p.channels[3].name = "A";
    p.frame.width = 0;
    assert_int_equal(sf_exr_write("r.exr", &p.frame, &log_caught), SF_ERROR_USAGE);
    assert_caught(&caught, "0x8 pixels");
    p.frame.width = 8;
    p.frame.channel_count = 0;
    assert_int_equal(sf_exr_write("r.exr", &p.frame, &log_caught), SF_ERROR_USAGE);
    assert_caught(&caught, "0 channels");
    p.frame.channel_count = 6;
    assert_int_equal(sf_exr_write("absent/r.exr", &p.frame, &log_caught), SF_ERROR_IO);
    assert_caught(&caught, "'absent/r.exr': its folder does not exist");
    assert_false(sf_file_exists("r.exr"));
    picture_free(&p);
}

/* The public writer: every layer of a rendered frame. */
static void test_frame(void **state)
{
    enum { WIDTH = 5, HEIGHT = 3, COUNT = WIDTH * HEIGHT };
    uint16_t color[COUNT * 4], smoke[COUNT * 4];
    float depth[COUNT], depths[COUNT * 4];
    struct sf_frame frame = {
        .frame = 48, .width = WIDTH, .height = HEIGHT, .color = color, .depth = depth, .smoke = smoke};
    struct sf_exr_options options = {.compression = "zip", .half = true, .fps = 24, .scene_hash = "00ff"};
    struct sf_exr exr;

    (void)state;
    for (size_t i = 0; i < COUNT * 4; i++) {
        color[i] = sf_half_from_float((float)i);
        smoke[i] = sf_half_from_float(-(float)i);
        depths[i] = 1000.0f + (float)i;
        depth[i / 4] = i / 4 == 7 ? SF_NO_DEPTH : (float)i / 3.0f;
    }
    frame.smoke_depths = depths;
    frame.world_to_camera[0] = frame.world_to_clip[0] = 1.0f;
    assert_int_equal(sf_frame_write_exr(&frame, "frame.exr", &options, &log_caught), SF_OK);
    assert_int_equal(sf_exr_read("frame.exr", NULL, 0, &exr, &log_caught), SF_OK);
    assert_int_equal(exr.plane_count, 13);
    for (size_t i = 0; i < COUNT; i++) {
        assert_true(sf_exr_pixels(&exr, "R")[i] == (float)(4 * i) && sf_exr_pixels(&exr, "A")[i] == (float)(4 * i + 3));
        assert_true(sf_exr_pixels(&exr, "Z")[i] == depth[i]);
        assert_true(sf_exr_pixels(&exr, "smoke.G")[i] == -(float)(4 * i + 1));
        assert_true(sf_exr_pixels(&exr, "smoke.near")[i] == depths[4 * i] &&
                    sf_exr_pixels(&exr, "smoke.T")[i] == depths[4 * i + 3]);
    }
    assert_int_equal(exr.planes[0].stored, SF_EXR_HALF);
    assert_int_equal(sf_exr_attribute(&exr, "sfumatoFrame")->integer, 48);
    assert_int_equal(sf_exr_attribute(&exr, "framesPerSecond")->integer, 24);
    assert_string_equal(sf_exr_attribute(&exr, "sfumatoSceneHash")->text, "00ff");
    assert_string_equal(sf_exr_attribute(&exr, "software")->text, "sfumato " SF_VERSION);
    assert_non_null(sf_exr_attribute(&exr, "chromaticities"));
    assert_non_null(sf_exr_attribute(&exr, "worldToNDC"));
    sf_exr_finish(&exr);

    frame.smoke = NULL;
    frame.smoke_depths = NULL;
    options = (struct sf_exr_options){.compression = "none"};
    assert_int_equal(sf_frame_write_exr(&frame, "frame.exr", &options, &log_caught), SF_OK);
    assert_int_equal(sf_exr_read("frame.exr", NULL, 0, &exr, &log_caught), SF_OK);
    assert_int_equal(exr.plane_count, 5);
    assert_int_equal(exr.planes[0].stored, SF_EXR_FLOAT);
    assert_true(sf_exr_pixels(&exr, "G")[2] == 9.0f);
    assert_null(sf_exr_attribute(&exr, "sfumatoSceneHash"));
    sf_exr_finish(&exr);
    options.compression = "dwab";
    assert_int_equal(sf_frame_write_exr(&frame, "frame.exr", &options, &log_caught), SF_ERROR_USAGE);
    assert_caught(&caught, "'dwab' is not available");
}

/* The inspected image: channels as they are in EXR; in PNG each over its own range. */
static void test_inspected(void **state)
{
    const float far = SF_NO_DEPTH, none = nanf("");
    const float two[] = {1, -8, 3, -4, none, -6, 2, -4, far, 5, 1.5f, -4};
    const float grey[] = {1, 10, 100, none};
    struct sf_exr_options options = {.compression = "zip", .half = true};
    struct sf_frame frame = {.inspected = two, .inspected_width = 3, .inspected_height = 2, .inspected_channels = 2};
    struct sf_exr exr;
    struct sf_image image;

    (void)state;
    assert_int_equal(sf_frame_write_inspected_exr(&frame, "i.exr", &options, &log_caught), SF_OK);
    assert_int_equal(sf_exr_read("i.exr", NULL, 0, &exr, &log_caught), SF_OK);
    assert_int_equal(exr.plane_count, 2);
    assert_int_equal(exr.width, 3);
    assert_int_equal(exr.planes[0].stored, SF_EXR_FLOAT);
    assert_true(sf_exr_pixels(&exr, "R")[4] == far);
    assert_true(isnan(sf_exr_pixels(&exr, "R")[2]));
    assert_true(sf_exr_pixels(&exr, "G")[1] == -4);
    sf_exr_finish(&exr);

    /* Red 1..3; green by size, 4..8; nothing where red is none or far. */
    assert_int_equal(sf_frame_write_inspected_png(&frame, "i.png", &log_caught), SF_OK);
    assert_int_equal(sf_image_read("i.png", &image, &log_caught), SF_OK);
    const float red[] = {0, 1, 0, 0.5f, 0, 0.25f}, green[] = {1, 0, 0, 0, 0, 0};
    for (int i = 0; i < 6; i++) {
        assert_true(fabs(sf_srgb_encode(image.pixels[4 * i]) - red[i]) < 0.003);
        assert_true(fabs(sf_srgb_encode(image.pixels[4 * i + 1]) - green[i]) < 0.003);
        assert_true(image.pixels[4 * i + 2] == 0);
    }
    sf_image_finish(&image);

    /* One channel is grey; a wide range goes by logarithms. */
    frame = (struct sf_frame){.inspected = grey, .inspected_width = 4, .inspected_height = 1, .inspected_channels = 1};
    assert_int_equal(sf_frame_write_inspected_png(&frame, "i.png", &log_caught), SF_OK);
    assert_int_equal(sf_image_read("i.png", &image, &log_caught), SF_OK);
    for (int c = 0; c < 3; c++) {
        assert_true(image.pixels[c] == 0 && image.pixels[8 + c] == 1 && image.pixels[12 + c] == 0);
        assert_true(fabs(sf_srgb_encode(image.pixels[4 + c]) - 0.5) < 0.003);
    }
    sf_image_finish(&image);

    frame.inspected = NULL;
    assert_int_equal(sf_frame_write_inspected_png(&frame, "n.png", &log_caught), SF_ERROR_USAGE);
    assert_caught(&caught, "n.png");
    assert_int_equal(sf_frame_write_inspected_exr(&frame, "n.exr", &options, &log_caught), SF_ERROR_USAGE);
    assert_caught(&caught, "n.exr");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_half),           cmocka_unit_test(test_half_rows), cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_incompressible), cmocka_unit_test(test_runs),      cmocka_unit_test(test_clamp),
        cmocka_unit_test(test_attributes),     cmocka_unit_test(test_wanted),    cmocka_unit_test(test_refused),
        cmocka_unit_test(test_frame),          cmocka_unit_test(test_inspected),
    };

    return cmocka_run_group_tests(tests, scratch_enter, scratch_leave);
}
