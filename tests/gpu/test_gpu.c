/* The device by itself: choosing one, its memory, its cache on disk, and what it says when things go wrong. */
#include "gpu_kit.h"

#include <sys/stat.h>
#include <unistd.h>
#include "base/file.h"
#include "gpu/fault.h"

static void expect_device(const char *wanted, enum sf_status status, const char *words)
{
    const struct sf_gpu_options options = {.device = wanted, .no_cache = true};
    struct sf_gpu *gpu = NULL;

    kit_forget();
    assert_int_equal(sf_gpu_create(&options, &kit_log, &gpu), status);
    if (words)
        assert_non_null(strstr(kit_record.last, words));
    assert_true((gpu != NULL) == (status == SF_OK));
    sf_gpu_destroy(&gpu);
    assert_null(gpu);
    kit_forget();
}

static void test_choice(void **state)
{
    struct sf_gpu_info *infos = NULL;
    uint32_t count = 0;
    char part[8];

    (void)state;
    assert_int_equal(sf_gpu_list(&kit_log, &infos, &count), SF_OK);
    assert_true(count >= 1);
    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(strlen(infos[i].uuid), 36);
        assert_true(infos[i].suitable == (infos[i].unsuitable_because[0] == '\0'));
    }
    expect_device(NULL, SF_OK, NULL);
    if (count == 1) {
        snprintf(part, sizeof part, "%.4s", infos[0].name);
        part[0] = (char)(part[0] ^ 0x20); /* the other case */
        expect_device("0", SF_OK, NULL);
        expect_device(infos[0].uuid, SF_OK, NULL);
        expect_device(part, SF_OK, NULL);
        expect_device("1", SF_ERROR_DEVICE, "no device number 1");
    }
    expect_device("no such thing", SF_ERROR_DEVICE, infos[0].name);
    expect_device("", SF_ERROR_DEVICE, infos[0].name);
    expect_device("4000000000", SF_ERROR_DEVICE, "4000000000");
    free(infos);
}

static void test_description(void **state)
{
    struct sf_gpu *gpu = kit_gpu(0);
    const struct sf_gpu_info *info = sf_gpu_info(gpu);
    const struct sf_gpu_tuning *tuning = sf_gpu_tuning(gpu);
    uint64_t used, budget;

    (void)state;
    assert_true(info->suitable && info->name[0] && info->driver[0] && info->kind[0]);
    assert_true(info->api_major > 1 || info->api_minor >= 3);
    assert_true(info->max_image_side >= 4096 && info->max_storage_bytes >= 1 << 27);
    assert_true(tuning->software == (strcmp(info->kind, "cpu") == 0));
    assert_true(tuning->subgroup_size >= 1 && tuning->workers >= 1 && tuning->shared_bytes >= 16384);
    sf_gpu_memory(gpu, &used, &budget);
    assert_int_equal(used, 0);
    assert_true(budget == info->memory_bytes / 10 * 8);
    kit_finish(&gpu);
}

/* Surroundings without a driver, and without the layers. */
static void test_surroundings(void **state)
{
    const struct sf_gpu_options options = {.validate = true, .no_cache = true};
    struct sf_gpu_info *infos = NULL;
    struct sf_gpu *gpu = NULL;
    uint32_t count = 1;

    (void)state;
    setenv("VK_DRIVER_FILES", "/nonexistent/driver.json", 1);
    setenv("VK_ICD_FILENAMES", "/nonexistent/driver.json", 1);
    assert_int_equal(sf_gpu_list(&kit_log, &infos, &count), SF_ERROR_DEVICE);
    assert_int_equal(count, 0);
    assert_null(infos);
    assert_non_null(strstr(kit_record.last, "mesa-vulkan-drivers"));
    expect_device(NULL, SF_ERROR_DEVICE, "mesa-vulkan-drivers");
    unsetenv("VK_DRIVER_FILES");
    unsetenv("VK_ICD_FILENAMES");
    setenv("VK_LAYER_PATH", "/nonexistent", 1);
    assert_int_equal(sf_gpu_create(&options, &kit_log, &gpu), SF_ERROR_DEVICE);
    assert_non_null(strstr(kit_record.last, "vulkan-validationlayers"));
    unsetenv("VK_LAYER_PATH");
    kit_forget();
}

/* Places in memory never overlap, whatever is taken and given back in whatever order, and nothing is left in the end.
 */
static void test_memory(void **state)
{
    enum { BUFFERS = 48, ROUNDS = 200, LARGEST = 8 << 20 };
    struct sf_gpu *gpu = kit_gpu(0);
    struct sf_gpu_buffer *buffers[BUFFERS] = {NULL};
    uint64_t sizes[BUFFERS] = {0}, used;
    uint32_t random = 1;
    char *bytes = malloc(LARGEST), *got = malloc(LARGEST);

    (void)state;
    assert_true(bytes && got);
    for (int round = 0; round < ROUNDS + BUFFERS; round++) {
        int i = round < ROUNDS ? (int)((random = random * 1664525u + 1013904223u) >> 8) % BUFFERS : round - ROUNDS;

        if (buffers[i]) {
            memset(bytes, i + 1, sizes[i]);
            assert_int_equal(sf_gpu_buffer_read(buffers[i], 0, got, sizes[i]), SF_OK);
            assert_memory_equal(got, bytes, sizes[i]);
            sf_gpu_buffer_destroy(&buffers[i]);
        } else if (round < ROUNDS) {
            random = random * 1664525u + 1013904223u;
            sizes[i] = 1 + (random >> 8) % (random & 0x70 ? 5000 : LARGEST);
            memset(bytes, i + 1, sizes[i]);
            assert_int_equal(
                sf_gpu_buffer_create(gpu, "piece", sizes[i], false, SF_ACCESS_STORAGE_READ, bytes, &buffers[i]), SF_OK);
        }
    }
    free(bytes);
    free(got);
    sf_gpu_memory(gpu, &used, NULL);
    assert_int_equal(used, 0);
    kit_finish(&gpu);
}

static void test_budget(void **state)
{
    enum { MIB = 1 << 20 };
    struct sf_gpu *gpu = kit_gpu(24 * MIB);
    struct sf_gpu_buffer *first = NULL, *second = NULL;
    struct sf_graph *graph = kit_graph("large");
    struct sf_plan *plan = NULL;
    struct sf_player *player = NULL;
    uint64_t used, budget;
    sf_resource image = kit_image(graph, "image", SF_FORMAT_RGBA32F, SF_PERSISTENT, 2048, 2048);

    (void)state;
    assert_int_equal(sf_gpu_buffer_create(gpu, "first", 16 * MIB, false, SF_ACCESS_STORAGE_READ, NULL, &first), SF_OK);
    sf_gpu_memory(gpu, &used, &budget);
    assert_true(budget == 24 * MIB && used >= 16 * MIB && used <= budget);
    assert_int_equal(sf_gpu_buffer_create(gpu, "second", 16 * MIB, false, SF_ACCESS_STORAGE_READ, NULL, &second),
                     SF_ERROR_MEMORY);
    assert_null(second);
    assert_non_null(strstr(kit_record.last, "'second'"));
    assert_non_null(strstr(kit_record.last, "budget"));
    kit_fill_image(graph, "fill", image);
    assert_int_equal(
        sf_plan_create(graph, &(struct sf_plan_memory){.needs = sf_gpu_memory_needs, .user = gpu}, &kit_log, &plan),
        SF_OK);
    assert_int_equal(sf_player_create(gpu, plan, &player), SF_ERROR_MEMORY);
    assert_null(player);
    assert_non_null(strstr(kit_record.last, "'image'"));
    sf_gpu_buffer_destroy(&first);
    assert_int_equal(sf_gpu_buffer_create(gpu, "second", 16 * MIB, false, SF_ACCESS_STORAGE_READ, NULL, &second),
                     SF_OK);
    sf_gpu_buffer_destroy(&second);
    kit_forget();
    kit_drop(&player, &plan, &graph);
    kit_finish(&gpu);
}

static void expect_refused(struct sf_gpu *gpu, struct sf_graph *graph, const char *words)
{
    const struct sf_plan_memory memory = {.needs = sf_gpu_memory_needs, .user = gpu};
    struct sf_plan *plan = NULL;
    struct sf_player *player = NULL;

    assert_int_equal(sf_plan_create(graph, &memory, &kit_log, &plan), SF_OK);
    assert_int_equal(sf_player_create(gpu, plan, &player), SF_ERROR_USAGE);
    assert_null(player);
    if (!strstr(kit_record.last, words))
        fail_msg("'%s' does not speak of %s", kit_record.last, words);
    kit_forget();
    kit_drop(&player, &plan, &graph);
}

/* More than the device can do is refused with the names of what and of the limit. */
static void test_limits(void **state)
{
    const uint32_t one = 1;
    struct sf_gpu *gpu = kit_gpu(0);
    struct sf_gpu_image *image = NULL;
    struct sf_graph *graph = kit_graph("wide");
    const struct sf_gpu_info *info = sf_gpu_info(gpu);
    uint64_t large = info->max_storage_bytes + 64;
    sf_resource a, b;

    (void)state;
    kit_fill_image(graph, "fill",
                   kit_image(graph, "image", SF_FORMAT_RGBA32F, SF_PERSISTENT, info->max_image_side + 1, 1));
    expect_refused(gpu, graph, "'image'");
    graph = kit_graph("large");
    a = kit_buffer(graph, "a", SF_TRANSIENT, large);
    b = kit_buffer(graph, "b", SF_PERSISTENT, 256);
    kit_fill(graph, "fill", a, 0);
    kit_add(graph, "add", a, false, b, 64, &one);
    expect_refused(gpu, graph, "'a'");
    graph = kit_graph("many");
    a = kit_buffer(graph, "a", SF_TRANSIENT, 256);
    b = kit_buffer(graph, "b", SF_PERSISTENT, 256);
    kit_fill(graph, "fill", a, 0);
    kit_add(graph, "add", a, false, b, UINT32_MAX - 64, &one);
    expect_refused(gpu, graph, "'add'");
    assert_int_equal(sf_gpu_image_create(gpu, "wide", SF_FORMAT_R8_UNORM, info->max_image_side + 1, 1, 1,
                                         SF_ACCESS_SAMPLED, &one, &image),
                     SF_ERROR_USAGE);
    assert_null(image);
    kit_forget();
    kit_finish(&gpu);
}

/* Work that goes through every part once, and lets errors through. */
static enum sf_status exercise(struct sf_gpu *gpu)
{
    static const uint32_t words[64], one = 1;
    const struct sf_plan_memory memory = {.needs = sf_gpu_memory_needs, .user = gpu};
    struct sf_gpu_buffer *buffer = NULL;
    struct sf_gpu_image *image = NULL;
    struct sf_graph *graph = kit_graph("exercise");
    struct sf_plan *plan = NULL;
    struct sf_player *player = NULL;
    uint64_t serial = 0;
    uint32_t got[64];
    sf_resource in, picture, sum, block, kept, shown, out;
    enum sf_status status;

    in = sf_graph_buffer(
        graph, &(struct sf_buffer_desc){
                   .name = "in", .lifetime = SF_IMPORTED, .bytes = sizeof words, .outside = SF_ACCESS_STORAGE_READ});
    picture = sf_graph_image(graph, &(struct sf_image_desc){.name = "picture",
                                                            .format = SF_FORMAT_RGBA8_UNORM,
                                                            .lifetime = SF_IMPORTED,
                                                            .size = {.width = 4, .height = 4},
                                                            .outside = SF_ACCESS_SAMPLED});
    sum = kit_buffer(graph, "sum", SF_PERSISTENT, sizeof words);
    block = kit_buffer(graph, "block", SF_UPLOAD, sizeof words);
    kept = kit_buffer(graph, "kept", SF_PERSISTENT, sizeof words);
    shown = kit_image(graph, "shown", SF_FORMAT_RGBA32F, SF_TRANSIENT, 4, 4);
    out = kit_buffer(graph, "out", SF_READBACK, 256);
    kit_add(graph, "add", in, false, sum, 64, &one);
    kit_copy(graph, "upload", block, kept);
    kit_sample(graph, "sample", picture, false, SF_SAMPLER_NEAREST, shown, 0);
    kit_copy(graph, "read", shown, out);
    status = sf_gpu_buffer_create(gpu, "in", sizeof words, false, SF_ACCESS_STORAGE_READ, words, &buffer);
    if (!status)
        status = sf_gpu_image_create(gpu, "picture", SF_FORMAT_RGBA8_UNORM, 4, 4, 1, SF_ACCESS_SAMPLED, words, &image);
    if (!status)
        status = sf_plan_create(graph, &memory, &kit_log, &plan);
    if (!status)
        status = sf_player_create(gpu, plan, &player);
    if (!status) {
        sf_player_bind_buffer(player, in, buffer);
        sf_player_bind_image(player, picture, image);
        sf_player_set_timing(player, true);
        status = sf_frame_begin(gpu);
    }
    if (!status && !sf_player_upload(player, block))
        status = SF_ERROR_MEMORY;
    if (!status)
        status = sf_player_play(player);
    if (!status)
        status = sf_frame_end(gpu, &serial);
    if (!status)
        status = sf_frame_wait(gpu, serial);
    if (!status)
        status = sf_gpu_buffer_read(buffer, 0, got, sizeof got);
    kit_drop(&player, &plan, &graph);
    sf_gpu_image_destroy(&image);
    sf_gpu_buffer_destroy(&buffer);
    return status;
}

static enum sf_status exercise_all(bool validate)
{
    /* A small budget makes small blocks, and so several of them. */
    const struct sf_gpu_options options = {.validate = validate, .no_cache = true, .budget_bytes = 4 << 20};
    struct sf_gpu *gpu = NULL;
    enum sf_status status = sf_gpu_create(&options, &kit_log, &gpu);

    if (!status)
        status = exercise(gpu);
    if (gpu && sf_gpu_validation_messages(gpu, NULL))
        fail_msg("%s", kit_record.last);
    sf_gpu_destroy(&gpu);
    return status;
}

/* Lets each call of a kind fail in turn: the right status comes back, and every object goes. */
static void fail_each(enum sf_fault fault, enum sf_status want)
{
    uint32_t calls;

    kit_forget();
    sf_gpu_fail_after(fault, UINT32_MAX);
    assert_int_equal(exercise_all(true), SF_OK);
    calls = sf_gpu_fault_calls();
    assert_true(calls > 0);
    assert_int_equal(kit_record.errors, 0);
    for (uint32_t n = 1; n <= calls; n++) {
        sf_gpu_fail_after(fault, n);
        kit_forget();
        assert_int_equal(exercise_all(false), want);
        assert_int_equal(sf_gpu_fault_alive(), 0);
        assert_true(kit_record.errors >= 1);
    }
    print_message("%u calls failed in turn\n", calls);
    sf_gpu_fail_after(SF_FAULT_NONE, 0);
    kit_forget();
}

static void test_memory_fault(void **state)
{
    (void)state;
    fail_each(SF_FAULT_MEMORY, SF_ERROR_MEMORY);
}

static void test_object_fault(void **state)
{
    (void)state;
    fail_each(SF_FAULT_OBJECT, SF_ERROR_MEMORY);
}

static void test_lost_device(void **state)
{
    (void)state;
    fail_each(SF_FAULT_SUBMIT, SF_ERROR_DEVICE_LOST);
}

/* A wait that does not end, and what the device says to those who come after. */
static void test_timeout(void **state)
{
    const struct sf_gpu_options options = {.no_cache = true};
    struct sf_gpu *gpu = NULL;
    uint64_t serial;

    (void)state;
    sf_gpu_fail_after(SF_FAULT_TIMEOUT, UINT32_MAX);
    assert_int_equal(sf_gpu_create(&options, &kit_log, &gpu), SF_OK);
    assert_int_equal(exercise(gpu), SF_OK);
    assert_int_equal(sf_frame_begin(gpu), SF_OK);
    assert_int_equal(sf_frame_end(gpu, &serial), SF_OK);
    sf_gpu_fail_after(SF_FAULT_TIMEOUT, 1);
    assert_int_equal(sf_frame_wait(gpu, serial), SF_ERROR_DEVICE_LOST);
    assert_int_equal(sf_frame_begin(gpu), SF_ERROR_DEVICE_LOST);
    assert_int_equal(exercise(gpu), SF_ERROR_DEVICE_LOST);
    sf_gpu_fail_after(SF_FAULT_NONE, 0); /* it answers again: all can be freed */
    sf_gpu_destroy(&gpu);
    assert_int_equal(sf_gpu_fault_alive(), 0);
    kit_forget();
}

static void use_cache(uint32_t warnings)
{
    const struct sf_gpu_options options = {0};
    struct sf_gpu *gpu = NULL;

    kit_forget();
    assert_int_equal(sf_gpu_create(&options, &kit_log, &gpu), SF_OK);
    assert_int_equal(exercise(gpu), SF_OK);
    sf_gpu_destroy(&gpu);
    assert_int_equal(kit_record.errors, 0);
    assert_int_equal(kit_record.warnings, warnings);
}

/* A cache that was cut, spoilt, or made by somebody else is ignored with a warning and replaced. */
static void test_cache(void **state)
{
    char folder[] = "/tmp/sfumato-test-XXXXXX", name[64], *path, *data = NULL, *again = NULL;
    struct sf_gpu_info *infos = NULL;
    uint32_t count;
    size_t size, size_again;

    (void)state;
    assert_non_null(mkdtemp(folder));
    setenv("XDG_CACHE_HOME", folder, 1);
    assert_int_equal(sf_gpu_list(&kit_log, &infos, &count), SF_OK);
    snprintf(name, sizeof name, "pipelines-%s.bin", infos[0].uuid);
    path = sf_cache_path(name);
    if (count > 1)
        skip();
    assert_non_null(strstr(path, folder));
    use_cache(0);
    assert_int_equal(sf_file_read(path, 1 << 28, &kit_log, &data, &size), SF_OK);
    use_cache(0);
    for (size_t at = 0; at < size; at += at < 64 ? 1 : size / 8) {
        data[at] ^= 0x10;
        assert_int_equal(sf_file_write(path, data, size, &kit_log), SF_OK);
        data[at] ^= 0x10;
        use_cache(1);
        assert_non_null(strstr(kit_record.last, path));
    }
    for (size_t length = 0; length < size; length = length * 2 + 1) {
        assert_int_equal(sf_file_write(path, data, length, &kit_log), SF_OK);
        use_cache(1);
    }
    use_cache(0);
    assert_int_equal(sf_file_read(path, 1 << 28, &kit_log, &again, &size_again), SF_OK);
    assert_int_equal(size, size_again);
    free(data);
    free(again);
    unlink(path);
    *strrchr(path, '/') = '\0';
    rmdir(path);
    /* No folder can be made: the cache is not kept, and nothing else happens. */
    assert_int_equal(sf_file_write(path, "", 0, &kit_log), SF_OK);
    use_cache(1);
    unlink(path);
    rmdir(folder);
    free(path);
    free(infos);
    unsetenv("XDG_CACHE_HOME");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_choice),       cmocka_unit_test(test_description),  cmocka_unit_test(test_surroundings),
        cmocka_unit_test(test_memory),       cmocka_unit_test(test_budget),       cmocka_unit_test(test_limits),
        cmocka_unit_test(test_memory_fault), cmocka_unit_test(test_object_fault), cmocka_unit_test(test_lost_device),
        cmocka_unit_test(test_timeout),      cmocka_unit_test(test_cache),
    };
    int skip = kit_probe();

    return skip ? skip : cmocka_run_group_tests(tests, NULL, NULL);
}
