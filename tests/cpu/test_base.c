/* src/base: log, arrays, files, threads, hashes, suggestions. */
#include "scratch.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include "base/array.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/log.h"
#include "base/suggest.h"
#include "base/thread.h"
#ifdef __linux__
#include <sys/mount.h>
#endif

/* The GLSL file compiled as C: GLSL's names for C's types, and names of its own beside those of hash.h. */
#define uint            uint32_t
#define sf_hash_u32     glsl_hash_u32
#define sf_random_u32   glsl_random_u32
#define sf_random_float glsl_random_float
static uint32_t glsl_hash_u32(uint32_t x);
static uint32_t glsl_random_u32(uint32_t seed, uint32_t id, uint32_t purpose);
static float glsl_random_float(uint32_t seed, uint32_t id, uint32_t purpose);
#include "lib/hash.glsl"
#undef uint
#undef sf_hash_u32
#undef sf_random_u32
#undef sf_random_float

static struct caught caught;
static const struct sf_log log_caught = {.write = caught_write, .user = &caught, .level = SF_LOG_DEBUG};

static void test_status(void **state)
{
    (void)state;
    assert_string_equal(sf_status_name(SF_OK), "ok");
    assert_string_equal(sf_status_name(SF_ERROR_MEMORY), "out of memory");
    assert_string_equal(sf_status_name((enum sf_status)99), "unknown status");
}

static void count_line(void *user, enum sf_log_level level, const char *message)
{
    (void)level;
    (void)message;
    ++*(unsigned *)user;
}

static void test_log(void **state)
{
    unsigned lines = 0;
    struct sf_log quiet = {.write = count_line, .user = &lines, .level = SF_LOG_WARNING},
                  mute = {.level = SF_LOG_DEBUG};
    char longer[3000];

    (void)state;
    sf_log(NULL, SF_LOG_ERROR, "nobody hears %d", 1);
    sf_log(&mute, SF_LOG_ERROR, "nor this");
    sf_log(&quiet, SF_LOG_INFO, "dropped");
    sf_log(&quiet, SF_LOG_WARNING, "kept");
    assert_int_equal(lines, 1);
    assert_int_equal(sf_fail(&log_caught, SF_ERROR_IO, "a\nb\x1b[31m %s", "c"), SF_ERROR_IO);
    assert_caught(&caught, "a b [31m c");
    /* Two-byte characters at odd and at even places: the cut must not split one. */
    for (size_t start = 0; start < 2; start++) {
        memset(longer, 'x', sizeof longer);
        for (size_t i = start; i + 2 < sizeof longer; i += 2)
            memcpy(longer + i, "\xc3\xa9", 2);
        longer[sizeof longer - 1] = '\0';
        sf_fail(&log_caught, SF_ERROR_IO, "%s", longer);
        size_t length = strlen(caught.text);
        assert_in_range(length, 1990, 2000);
        assert_string_equal(caught.text + length - 5, "\xc3\xa9...");
    }
    caught.errors = 0;
}

static void test_array(void **state)
{
    uint32_t *v = NULL;
    size_t n = 0, capacity = 0;

    (void)state;
    for (uint32_t i = 0; i < 1000; i++) {
        assert_true(sf_array_reserve((void **)&v, n, &capacity, 1, sizeof *v));
        v[n++] = i;
    }
    for (uint32_t i = 0; i < 1000; i++)
        assert_int_equal(v[i], i);
    assert_in_range(capacity, 1000, 2048);
    size_t before = capacity;
    assert_false(sf_array_reserve((void **)&v, n, &capacity, SIZE_MAX, sizeof *v));
    assert_false(sf_array_reserve((void **)&v, n, &capacity, SIZE_MAX / 4, sizeof *v));
    assert_int_equal(capacity, before);
    free(v);
}

static void test_arena(void **state)
{
    struct sf_arena arena = {0};
    unsigned char *held[400];

    (void)state;
    for (size_t i = 0; i < 400; i++) {
        size_t size = i % 50 == 49 ? 40000 : i * 7 % 300;

        held[i] = sf_arena_alloc(&arena, size);
        assert_non_null(held[i]);
        assert_int_equal((uintptr_t)held[i] % 16, 0);
        for (size_t k = 0; k < size; k++)
            assert_int_equal(held[i][k], 0);
        memset(held[i], (int)(i & 0xff), size);
    }
    for (size_t i = 0; i < 400; i++)
        for (size_t k = 0, size = i % 50 == 49 ? 40000 : i * 7 % 300; k < size; k++)
            assert_int_equal(held[i][k], i & 0xff);
    assert_string_equal(sf_arena_strdup(&arena, "soft"), "soft");
    assert_string_equal(sf_arena_printf(&arena, "%s/%03d", "smoke", 7), "smoke/007");
    assert_null(sf_arena_alloc(&arena, SIZE_MAX - 8));
    sf_arena_finish(&arena);
    assert_null(arena.blocks);
    sf_arena_finish(&arena);
    sf_arena_finish(NULL);
}

static void test_text(void **state)
{
    struct sf_text text = {0};

    (void)state;
    sf_text_append(&text, "");
    assert_string_equal(text.data, "");
    for (int i = 0; i < 100; i++)
        sf_text_printf(&text, "%d,", i);
    sf_text_append(&text, "end");
    assert_int_equal(text.length, strlen(text.data));
    assert_int_equal(text.length, 10 * 2 + 90 * 3 + 3);
    assert_string_equal(text.data + text.length - 7, ",99,end");
    assert_false(text.failed);
    sf_text_finish(&text);
    assert_null(text.data);
    sf_text_finish(NULL);
}

static void assert_file(const char *path, const char *expected)
{
    char *data;
    size_t size;

    assert_int_equal(sf_file_read(path, 1 << 20, NULL, &data, &size), SF_OK);
    assert_int_equal(size, strlen(expected));
    assert_string_equal(data, expected);
    free(data);
}

static void test_file_read(void **state)
{
    char *data = (char *)1;
    size_t size = 1;

    (void)state;
    assert_int_equal(sf_file_write("small", "12345", 5, &log_caught), SF_OK);
    assert_file("small", "12345");
    assert_int_equal(sf_file_read("small", 5, &log_caught, &data, &size), SF_OK);
    free(data);
    assert_int_equal(sf_file_read("small", 4, &log_caught, &data, &size), SF_ERROR_IO);
    assert_caught(&caught, "'small': its 5 bytes are more than the limit of 4");
    assert_null(data);
    assert_int_equal(sf_file_read("absent", 5, &log_caught, &data, &size), SF_ERROR_IO);
    assert_caught(&caught, "'absent': No such file");
    assert_int_equal(sf_file_read(".", 5, &log_caught, &data, &size), SF_ERROR_IO);
    assert_caught(&caught, "it is a folder");
    assert_int_equal(mkfifo("pipe", 0600), 0);
    assert_int_equal(sf_file_read("pipe", 5, &log_caught, &data, &size), SF_ERROR_IO);
    assert_caught(&caught, "it is not a regular file");
    assert_int_equal(sf_file_write("empty", "", 0, &log_caught), SF_OK);
    assert_file("empty", "");
#ifdef __linux__
    /* Says that it has no bytes, and has some. */
    assert_int_equal(sf_file_read("/proc/self/status", 1 << 20, &log_caught, &data, &size), SF_OK);
    assert_true(size > 100 && strlen(data) == size);
    free(data);
    assert_int_equal(sf_file_read("/proc/self/status", 10, &log_caught, &data, &size), SF_ERROR_IO);
    assert_caught(&caught, "larger than the limit of 10");
#endif
}

static void test_file_write(void **state)
{
    struct sf_file_writer writer, other, zeroed = {0};
    unsigned before;

    (void)state;
    assert_int_equal(sf_file_write("kept", "old", 3, &log_caught), SF_OK);
    before = scratch_count(".");
    assert_int_equal(sf_file_writer_open(&writer, "kept", &log_caught), SF_OK);
    assert_int_equal(sf_file_writer_open(&other, "kept", &log_caught), SF_OK);
    assert_int_equal(sf_file_writer_write(&writer, "new!", 4, 0, &log_caught), SF_OK);
    assert_int_equal(sf_file_writer_write(&writer, "est", 3, 3, &log_caught), SF_OK);
    assert_file("kept", "old");
    assert_int_equal(scratch_count("."), before + 2);
    assert_int_equal(sf_file_writer_commit(&writer, &log_caught), SF_OK);
    assert_file("kept", "newest");
    sf_file_writer_abort(&writer);
    sf_file_writer_abort(&other);
    sf_file_writer_abort(&zeroed);
    sf_file_writer_abort(NULL);
    assert_file("kept", "newest");
    assert_int_equal(scratch_count("."), before);
    /* A zeroed writer's descriptor is 0: it must not be closed. */
    assert_true(fcntl(0, F_GETFD) >= 0 || errno == EBADF);

    assert_int_equal(sf_file_write("absent/x", "", 0, &log_caught), SF_ERROR_IO);
    assert_caught(&caught, "'absent/x': its folder does not exist");
    assert_int_equal(sf_file_write("", "", 0, &log_caught), SF_ERROR_IO);
    assert_caught(&caught, "empty name");
    assert_int_equal(mkdir("folder", 0777), 0);
    assert_int_equal(sf_file_write("folder", "", 0, &log_caught), SF_ERROR_IO);
    assert_caught(&caught, "'folder': it is a folder");
    assert_int_equal(sf_file_write("folder/", "", 0, &log_caught), SF_ERROR_IO);
    assert_caught(&caught, "it names a folder");
    assert_int_equal(sf_file_write("/dev/null", "x", 1, &log_caught), SF_ERROR_IO);
    assert_caught(&caught, "not a regular file");
    char longest[256] = "";
    memset(longest, 'n', 255);
    assert_int_equal(sf_file_write(longest, "fits", 4, &log_caught), SF_OK);
    assert_file(longest, "fits");
    assert_int_equal(scratch_count("folder"), 0);
}

/* Writes `size` bytes with the file size limited to 64 KiB, in a child. Returns the child's verdict: 0 when all was as
 * it should be. */
static int write_over_limit(void)
{
    struct rlimit limit = {.rlim_cur = 65536, .rlim_max = 65536};
    static char bytes[200000];
    unsigned before = scratch_count(".");

    signal(SIGXFSZ, SIG_IGN);
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0)
        return 1;
    if (sf_file_write("big", bytes, sizeof bytes, &log_caught) != SF_ERROR_IO)
        return 2;
    if (caught.errors != 1 || !strstr(caught.text, "'big': File too large"))
        return 3;
    return scratch_count(".") == before ? 0 : 4;
}

static void test_file_limit(void **state)
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

static void test_disk_full(void **state)
{
#ifdef __linux__
    static char bytes[300000];
    const char *home = *state;

    assert_int_equal(mkdir("full", 0700), 0);
    if (mount("none", "full", "tmpfs", 0, "size=128k") != 0)
        skip();
    /* Detached at once: it lives on as the working folder, and is gone however this test ends. */
    assert_int_equal(chdir("full"), 0);
    assert_int_equal(umount2(".", MNT_DETACH), 0);
    assert_int_equal(sf_file_write("kept", "old", 3, &log_caught), SF_OK);
    enum sf_status status = sf_file_write("kept", bytes, sizeof bytes, &log_caught);
    unsigned count = scratch_count(".");
    assert_file("kept", "old");
    assert_int_equal(chdir(home), 0);
    assert_int_equal(status, SF_ERROR_IO);
    assert_caught(&caught, "'kept': No space left on device");
    assert_int_equal(count, 1);
#else
    (void)state;
    skip();
#endif
}

static void test_folders(void **state)
{
    char *path;

    (void)state;
    assert_int_equal(sf_folder_create("a/b//c/", &log_caught), SF_OK);
    assert_int_equal(sf_folder_create("a/b/c", &log_caught), SF_OK);
    assert_true(sf_file_exists("a/b/c"));
    assert_false(sf_file_exists("a/b/d"));
    assert_int_equal(sf_file_write("a/plain", "", 0, &log_caught), SF_OK);
    assert_int_equal(sf_folder_create("a/plain", &log_caught), SF_ERROR_IO);
    assert_caught(&caught, "'a/plain': File exists");
    assert_int_equal(sf_folder_create("a/plain/b", &log_caught), SF_ERROR_IO);
    caught.errors = 0;
    assert_int_equal(sf_folder_create("", &log_caught), SF_ERROR_IO);
    assert_caught(&caught, "empty name");

    setenv("XDG_CACHE_HOME", "/c", 1);
    path = sf_cache_path("pipelines.bin");
    assert_string_equal(path, "/c/sfumato/pipelines.bin");
    free(path);
    setenv("XDG_CACHE_HOME", "relative", 1);
    setenv("HOME", "/home/me", 1);
    path = sf_cache_path("x");
    assert_string_equal(path, "/home/me/.cache/sfumato/x");
    free(path);
    unsetenv("XDG_CACHE_HOME");
    unsetenv("HOME");
    assert_null(sf_cache_path("x"));

    static const char *const beside[][3] = {
        {"scenes/plume.json", "sky.exr", "scenes/sky.exr"},
        {"plume.json", "sky.exr", "sky.exr"},
        {"/a/b.json", "../sky.exr", "/a/../sky.exr"},
        {"/a/b.json", "/sky.exr", "/sky.exr"},
    };
    for (size_t i = 0; i < SF_COUNT(beside); i++) {
        path = sf_path_beside(beside[i][0], beside[i][1]);
        assert_string_equal(path, beside[i][2]);
        free(path);
    }
}

static void pause_ms(long ms)
{
    nanosleep(&(struct timespec){.tv_nsec = ms * 1000000 + 100000}, NULL);
}

struct tally {
    atomic_uint done, running, most;
    atomic_bool gate;
    bool fails;
};

static enum sf_status count_job(void *user)
{
    struct tally *tally = user;
    unsigned now = atomic_fetch_add(&tally->running, 1) + 1, most = atomic_load(&tally->most);

    while (now > most && !atomic_compare_exchange_weak(&tally->most, &most, now))
        ;
    while (!atomic_load(&tally->gate))
        pause_ms(0);
    atomic_fetch_sub(&tally->running, 1);
    return atomic_fetch_add(&tally->done, 1) == 4 && tally->fails ? SF_ERROR_IO : SF_OK;
}

static void *open_gate(void *user)
{
    struct tally *tally = user;

    pause_ms(20);
    atomic_store(&tally->gate, true);
    return NULL;
}

static void test_pool(void **state)
{
    struct tally tally = {0};
    struct sf_pool *pool = NULL;
    pthread_t opener;

    (void)state;
    assert_int_equal(sf_pool_create(0, 1, &pool), SF_ERROR_USAGE);
    assert_int_equal(sf_pool_create(1, 0, &pool), SF_ERROR_USAGE);
    assert_null(pool);
    assert_int_equal(sf_pool_destroy(NULL), SF_OK);
    assert_int_equal(sf_pool_destroy(&pool), SF_OK);

    assert_int_equal(sf_pool_create(3, 2, &pool), SF_OK);
    assert_int_equal(sf_pool_wait(pool), SF_OK);
    for (int i = 0; i < 5; i++) /* three run, two wait; none of these may block for ever */
        assert_int_equal(sf_pool_push(pool, count_job, &tally), SF_OK);
    assert_int_equal(atomic_load(&tally.done), 0);
    assert_int_equal(pthread_create(&opener, NULL, open_gate, &tally), 0);
    sf_pool_push(pool, count_job, &tally); /* blocks until the gate is open: the queue is full */
    assert_true(atomic_load(&tally.gate));
    pthread_join(opener, NULL);
    assert_int_equal(sf_pool_wait(pool), SF_OK);
    assert_int_equal(atomic_load(&tally.done), 6);
    assert_int_equal(atomic_load(&tally.most), 3);
    for (int i = 0; i < 500; i++)
        assert_int_equal(sf_pool_push(pool, count_job, &tally), SF_OK);
    assert_int_equal(sf_pool_destroy(&pool), SF_OK); /* does what still waits */
    assert_null(pool);
    assert_int_equal(atomic_load(&tally.done), 506);
}

static void test_pool_failure(void **state)
{
    struct tally tally = {.gate = true, .fails = true};
    struct sf_pool *pool;

    (void)state;
    assert_int_equal(sf_pool_create(1, 4, &pool), SF_OK);
    for (int i = 0; i < 10; i++)
        sf_pool_push(pool, count_job, &tally);
    assert_int_equal(sf_pool_wait(pool), SF_ERROR_IO);
    assert_int_equal(atomic_load(&tally.done), 10); /* those after the failure ran too */
    assert_int_equal(sf_pool_push(pool, count_job, &tally), SF_ERROR_IO);
    assert_int_equal(sf_pool_destroy(&pool), SF_ERROR_IO);
    assert_int_equal(atomic_load(&tally.done), 11);
    assert_true(sf_cpu_count() >= 1);
    uint64_t then = sf_clock_ns();
    pause_ms(1);
    assert_true(sf_clock_ns() - then >= 1000000);
}

static void test_hash_bytes(void **state)
{
    /* Vectors of the XXH64 specification, and of its reference program. */
    static const struct {
        const char *text;
        uint64_t seed, hash;
    } vectors[] = {
        {"", 0, 0xEF46DB3751D8E999u},
        {"a", 0, 0xD24EC4F1A98C6E5Bu},
        {"abc", 0, 0x44BC2CF5AD770999u},
        {"Nobody inspects the spammish repetition", 0, 0xFBCEA83C8A378BF1u},
    };
    unsigned char bytes[64];

    (void)state;
    for (size_t i = 0; i < SF_COUNT(vectors); i++)
        assert_true(sf_hash_bytes(vectors[i].text, strlen(vectors[i].text), vectors[i].seed) == vectors[i].hash);
    for (unsigned i = 0; i < sizeof bytes; i++)
        bytes[i] = (unsigned char)i;
    for (size_t size = 0; size < sizeof bytes; size++) {
        uint64_t hash = sf_hash_bytes(bytes, size, 1);

        assert_true(hash != sf_hash_bytes(bytes, size + 1, 1) && hash != sf_hash_bytes(bytes, size, 2));
        bytes[size / 2] ^= 1;
        assert_true(size == 0 || hash != sf_hash_bytes(bytes, size, 1));
        bytes[size / 2] ^= 1;
    }
}

static void test_random(void **state)
{
    uint32_t all_bits = 0, no_bits = UINT32_MAX;
    double sum = 0, same_purpose = 0;

    (void)state;
    /* As in the paper's own listing. */
    assert_int_equal(sf_hash_u32(0), 129708002u);
    for (uint32_t i = 0; i < 100000; i++) {
        uint32_t seed = i * 2654435761u, purpose = i % 37;
        float f = sf_random_float(seed, i, purpose);

        assert_int_equal(sf_hash_u32(seed), glsl_hash_u32(seed));
        assert_int_equal(sf_random_u32(seed, i, purpose), glsl_random_u32(seed, i, purpose));
        assert_true(f == glsl_random_float(seed, i, purpose));
        assert_true(f >= 0.0f && f < 1.0f);
    }
    for (uint32_t id = 0; id < 100000; id++) {
        float a = sf_random_float(7, id, 0), b = sf_random_float(7, id, 1), c = sf_random_float(7, id + 1, 0);

        sum += a;
        same_purpose += (a - 0.5) * (b - 0.5) + (a - 0.5) * (c - 0.5);
        all_bits |= sf_random_u32(7, id, 0);
        no_bits &= sf_random_u32(7, id, 0);
    }
    /* Means within four standard deviations: 1/sqrt(12 n), and sqrt(2)/(12 sqrt(n)) for the two products. */
    assert_true(sum / 100000 > 0.5 - 0.0037 && sum / 100000 < 0.5 + 0.0037);
    assert_true(same_purpose / 100000 > -0.0015 && same_purpose / 100000 < 0.0015);
    assert_int_equal(all_bits, UINT32_MAX);
    assert_int_equal(no_bits, 0);
    assert_true((float)(UINT32_MAX >> 8) * (1.0f / 16777216.0f) < 1.0f);
}

static void test_suggest(void **state)
{
    static const char *const words[] = {"extinction", NULL, "albedo", "phase", "emitters", "steps", "x"};
    static const char *const pairs[][2] = {
        {"extintion", "extinction"}, {"Albedo", "albedo"},    {"albdeo", "albedo"}, {"fase", NULL}, {"phaze", "phase"},
        {"step", "steps"},           {"setps", "steps"},      {"y", NULL},          {"X", "x"},     {"", NULL},
        {"completely", NULL},        {"emiters", "emitters"},
    };
    char longest[100];

    (void)state;
    for (size_t i = 0; i < SF_COUNT(pairs); i++) {
        const char *found = sf_suggest(pairs[i][0], words, SF_COUNT(words));

        if (!found || !pairs[i][1])
            assert_true(found == pairs[i][1]);
        else
            assert_string_equal(found, pairs[i][1]);
    }
    memset(longest, 'e', 99);
    longest[99] = '\0';
    assert_null(sf_suggest(longest, words, SF_COUNT(words)));
    assert_null(sf_suggest("albedo", words, 0));
    assert_true(sf_suggest("emitters", words, SF_COUNT(words)) == words[4]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_status),     cmocka_unit_test(test_log),        cmocka_unit_test(test_array),
        cmocka_unit_test(test_arena),      cmocka_unit_test(test_text),       cmocka_unit_test(test_file_read),
        cmocka_unit_test(test_file_write), cmocka_unit_test(test_file_limit), cmocka_unit_test(test_disk_full),
        cmocka_unit_test(test_folders),    cmocka_unit_test(test_pool),       cmocka_unit_test(test_pool_failure),
        cmocka_unit_test(test_hash_bytes), cmocka_unit_test(test_random),     cmocka_unit_test(test_suggest),
    };

    return cmocka_run_group_tests(tests, scratch_enter, scratch_leave);
}
