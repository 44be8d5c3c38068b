/* The scene's atlas as the method thick takes it, through the public interface, with validation. */
#include "../cpu/scratch.h"

#include "output/png.h"
#include "sfumato/sfumato.h"

enum { SIDE = 96, PIXELS = SIDE * SIDE };
static struct sf_device *device;

static void write_log(void *user, enum sf_log_level level, const char *message)
{
    (void)user;
    if (level <= SF_LOG_WARNING)
        fprintf(stderr, "%s\n", message);
}
static const struct sf_log test_log = {.write = write_log, .level = SF_LOG_WARNING};

/* Four spheres, one in each quarter of the picture, each with the tile of its number, turned: transmittance. */
static void render(const char *atlas, const char *detail, float transmittance[PIXELS])
{
    static const char *const text =
        "{\"camera\":{\"eye\":[0,0,5],\"target\":[0,0,0],\"fov\":40,\"near\":0.1},\"medium\":{\"extinction\":2},"
        "\"atlas\":%s,\"thick\":{\"resolution\":\"full\",\"detail\":%s},\"sim\":{\"capacity\":8},"
        "\"emitters\":[{\"type\":\"list\",\"still\":true,\"particles\":["
        "{\"centre\":[-0.9,0.9,0],\"radius\":0.7,\"tile\":0,\"rotation\":0.5},"
        "{\"centre\":[0.9,0.9,0],\"radius\":0.7,\"tile\":1,\"rotation\":1.5},"
        "{\"centre\":[-0.9,-0.9,0],\"radius\":0.7,\"tile\":2,\"rotation\":-2},"
        "{\"centre\":[0.9,-0.9,0],\"radius\":0.7,\"tile\":3}]}]}";
    const struct sf_renderer_options options = {.width = SIDE, .height = SIDE, .aovs = SF_AOV_DEPTHS};
    struct sf_renderer *renderer = NULL;
    struct sf_scene *scene = NULL;
    struct sf_frame frame;
    char json[2048];
    uint64_t ticket;

    snprintf(json, sizeof json, text, atlas, detail);
    assert_int_equal(sf_scene_parse("test.json", json, strlen(json), NULL, 0, &test_log, &scene), SF_OK);
    assert_int_equal(sf_renderer_create(device, scene, &options, &test_log, &renderer), SF_OK);
    assert_int_equal(sf_renderer_render(renderer, 0, &ticket), SF_OK);
    assert_int_equal(sf_renderer_wait(renderer, ticket, &frame), SF_OK);
    for (size_t i = 0; i < PIXELS; i++)
        transmittance[i] = frame.smoke_depths[4 * i + 3];
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
    assert_int_equal(sf_device_validation_messages(device), 0);
}

/* An atlas of 2x2 tiles of 8x8 texels, each with its alpha. */
static void write_atlas(const uint8_t alpha[4])
{
    uint8_t pixels[16 * 16 * 4];
    const struct sf_png_frame png = {.width = 16, .height = 16, .channels = 4, .bits = 8, .pixels = pixels};

    memset(pixels, 255, sizeof pixels);
    for (size_t i = 0; i < 16 * 16; i++)
        pixels[4 * i + 3] = alpha[i / 16 / 8 * 2 + i % 16 / 8];
    assert_int_equal(sf_png_write("atlas.png", &png, &test_log), SF_OK);
}

/* How many pixels of a quarter of the picture smoke darkens. */
static unsigned count_smoke(const float *transmittance, unsigned quarter)
{
    unsigned count = 0;

    for (unsigned y = 0; y < SIDE / 2; y++)
        for (unsigned x = 0; x < SIDE / 2; x++)
            count += transmittance[(y + quarter / 2 * (SIDE / 2)) * SIDE + x + quarter % 2 * (SIDE / 2)] < 0.999f;
    return count;
}

#define FILE_ATLAS "{\"type\":\"file\",\"file\":\"atlas.png\"}"

/* Where alpha is 1 nothing is taken away, to the bit; where it is 0, all. Each particle has the tile of its number. */
static void test_alpha(void **state)
{
    static float plain[PIXELS], found[PIXELS];
    static const uint8_t full[4] = {255, 255, 255, 255};

    (void)state;
    render("{}", "0", plain);
    write_atlas(full);
    render(FILE_ATLAS, "1", found);
    assert_memory_equal(plain, found, sizeof plain);
    for (unsigned tile = 0; tile < 4; tile++) {
        uint8_t one[4] = {0};

        one[tile] = 255;
        write_atlas(one);
        render(FILE_ATLAS, "1", found);
        for (unsigned quarter = 0; quarter < 4; quarter++) {
            unsigned smoke = count_smoke(found, quarter);

            /* A sphere's outline is a little wider than its middle plane, and the tile: it may touch the next one. */
            if (quarter != tile ? smoke > 30 : smoke < 400)
                fail_msg("tile %u alone is opaque: quarter %u has smoke in %u pixels", tile, quarter, smoke);
        }
    }
}

/* An atlas that is made is the one that would be written and read; another seed is another atlas, and none is the plain
 * one. */
static void test_made(void **state)
{
    static float made[PIXELS], found[PIXELS];
    const struct sf_exr_options exr = {.compression = "zip"};
    struct sf_texture_options options;
    struct sf_texture *texture = NULL;

    (void)state;
    sf_texture_options_init(&options);
    options.kind = "turbulence";
    options.width = options.height = 32;
    options.seed = 5;
    assert_int_equal(sf_texture_create(&options, NULL, NULL, &test_log, &texture), SF_OK);
    assert_int_equal(sf_texture_write_exr(texture, "atlas.exr", SF_TEXTURE_ALL, &exr, &test_log), SF_OK);
    sf_texture_destroy(&texture);
    render("{\"type\":\"made\",\"kind\":\"turbulence\",\"size\":32,\"seed\":5}", "0.7", made);
    render("{\"type\":\"file\",\"file\":\"atlas.exr\"}", "0.7", found);
    assert_memory_equal(made, found, sizeof made);
    render("{\"type\":\"made\",\"kind\":\"turbulence\",\"size\":32,\"seed\":6}", "0.7", found);
    assert_memory_not_equal(made, found, sizeof made);
    render("{}", "0.7", found);
    assert_memory_not_equal(made, found, sizeof made);
}

static int setup(void **state)
{
    const struct sf_device_options options = {.validate = true};
    enum sf_status status = sf_device_create(&options, &test_log, &device);

    if (status == SF_ERROR_DEVICE)
        exit(77);
    return status ? -1 : scratch_enter(state);
}

static int teardown(void **state)
{
    sf_device_destroy(&device);
    return scratch_leave(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_alpha), cmocka_unit_test(test_made)};

    return cmocka_run_group_tests(tests, setup, teardown);
}
