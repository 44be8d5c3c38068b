/* Screenshots and recorded sequences: names, contents, and folders that cannot be. */
#include "../cpu/scratch.h"

#include <pthread.h>
#include <stdbool.h>
#include <time.h>
#include "app/view/shots.h"
#include "output/exr.h"
#include "output/half.h"
#include "output/image.h"

enum { WIDTH = 7, HEIGHT = 5, PIXELS = WIDTH * HEIGHT };

/* The writer's thread says things too. */
static struct {
    pthread_mutex_t lock;
    unsigned errors, infos, debugs;
    bool slow; /* the writer waits here for each file of a sequence */
    char error[2048], info[2048];
} heard = {.lock = PTHREAD_MUTEX_INITIALIZER};

static void hear(void *user, enum sf_log_level level, const char *message)
{
    (void)user;
    pthread_mutex_lock(&heard.lock);
    if (level == SF_LOG_ERROR)
        snprintf(heard.error, sizeof heard.error, "%s", message);
    if (level == SF_LOG_INFO)
        snprintf(heard.info, sizeof heard.info, "%s", message);
    heard.errors += level == SF_LOG_ERROR;
    heard.infos += level == SF_LOG_INFO;
    heard.debugs += level == SF_LOG_DEBUG;
    pthread_mutex_unlock(&heard.lock);
    if (heard.slow && level == SF_LOG_DEBUG)
        nanosleep(&(struct timespec){.tv_nsec = 20000000}, NULL);
}
static const struct sf_log test_log = {.write = hear, .level = SF_LOG_DEBUG};

static struct sf_shots *created(const char *folder)
{
    struct sf_shots *shots = NULL;

    heard.errors = heard.infos = heard.debugs = 0;
    assert_int_equal(sf_shots_create(folder, &test_log, &shots), SF_OK);
    return shots;
}

static uint16_t color[PIXELS * 4];
static float depth[PIXELS];

/* Every pixel of `value`; the same memory again at each call, as a renderer has it. */
static struct sf_frame frame_of(uint32_t number, float value)
{
    struct sf_frame frame = {.frame = number, .width = WIDTH, .height = HEIGHT, .color = color, .depth = depth};

    for (int i = 0; i < PIXELS * 4; i++)
        color[i] = sf_half_from_float(i % 4 == 3 ? 1 : value);
    for (int i = 0; i < PIXELS; i++)
        depth[i] = (float)i;
    return frame;
}

static void take(struct sf_shots *shots, const char *stem, uint32_t number, float value)
{
    struct sf_frame frame = frame_of(number, value);

    assert_int_equal(sf_shots_take(shots, stem, &frame, "linear", 0, 24, 0x1234), SF_OK);
    /* The memory is ours again. */
    frame_of(number, -1);
}

static bool is_there(const char *path)
{
    return access(path, F_OK) == 0;
}

static void assert_pair(const char *base, float value)
{
    char path[256];
    struct sf_image image;
    struct sf_exr exr;
    const float *red, *z;

    snprintf(path, sizeof path, "%s.png", base);
    assert_int_equal(sf_image_read(path, &image, &test_log), SF_OK);
    assert_int_equal(image.width, WIDTH);
    assert_int_equal(image.height, HEIGHT);
    for (int i = 0; i < PIXELS; i++)
        if (image.pixels[4 * i] < value - 0.01f || image.pixels[4 * i] > value + 0.01f)
            fail_msg("%s: %g, not %g", path, (double)image.pixels[4 * i], (double)value);
    sf_image_finish(&image);
    snprintf(path, sizeof path, "%s.exr", base);
    assert_int_equal(sf_exr_read(path, NULL, 0, &exr, &test_log), SF_OK);
    assert_int_equal(exr.width, WIDTH);
    assert_int_equal(exr.height, HEIGHT);
    assert_int_equal(exr.plane_count, 5);
    assert_non_null(red = sf_exr_pixels(&exr, "R"));
    assert_non_null(z = sf_exr_pixels(&exr, "Z"));
    for (int i = 0; i < PIXELS; i++)
        if (red[i] != value || z[i] != (float)i)
            fail_msg("%s: %g and %g, not %g and %d", path, (double)red[i], (double)z[i], (double)value, i);
    assert_string_equal(sf_exr_attribute(&exr, "sfumatoSceneHash")->text, "0000000000001234");
    sf_exr_finish(&exr);
}

static void test_names(void **state)
{
    struct sf_shots *shots = created("deep/er/shots");

    (void)state;
    assert_false(is_there("deep"));
    take(shots, "plume", 48, 0.5f);
    take(shots, "plume", 48, 0.25f);
    take(shots, "plume", 49, 0.75f);
    take(shots, "plume", 12345, 0.125f);
    sf_shots_destroy(&shots);
    assert_null(shots);
    assert_pair("deep/er/shots/plume.0048", 0.5f);
    assert_pair("deep/er/shots/plume.0048-2", 0.25f);
    assert_pair("deep/er/shots/plume.0049", 0.75f);
    assert_pair("deep/er/shots/plume.12345", 0.125f);
    assert_int_equal(scratch_count("deep/er/shots"), 8);
    assert_int_equal(heard.infos, 8);
    assert_string_equal(heard.info, "wrote deep/er/shots/plume.12345.exr");
    assert_int_equal(heard.errors, 0);
    sf_shots_destroy(&shots);
}

/* One file of a pair is enough to count on, and stays as it is. */
static void test_never_over(void **state)
{
    struct sf_shots *shots = created("kept");
    char text[8] = "";
    FILE *file;

    (void)state;
    assert_int_equal(mkdir("kept", 0777), 0);
    assert_non_null(file = fopen("kept/a.0001.exr", "w"));
    fputs("mine", file);
    fclose(file);
    assert_int_equal(symlink("nowhere", "kept/a.0001-2.png"), 0);
    take(shots, "a", 1, 0.5f);
    sf_shots_destroy(&shots);
    assert_pair("kept/a.0001-3", 0.5f);
    assert_false(is_there("kept/a.0001.png"));
    assert_false(is_there("kept/a.0001-2.exr"));
    assert_false(is_there("kept/nowhere"));
    assert_non_null(file = fopen("kept/a.0001.exr", "r"));
    assert_non_null(fgets(text, sizeof text, file));
    assert_string_equal(text, "mine");
    fclose(file);
}

static void test_record(void **state)
{
    struct sf_shots *shots = created("films");

    (void)state;
    heard.slow = true;
    assert_false(sf_shots_recording(shots));
    assert_int_equal(mkdir("films", 0777), 0);
    assert_int_equal(mkdir("films/plume-001", 0777), 0);
    assert_int_equal(sf_shots_record(shots, "plume"), SF_OK);
    assert_true(sf_shots_recording(shots));
    assert_int_equal(sf_shots_recorded(shots), 0);
    for (uint32_t i = 0; i < 12; i++) /* more than may wait */
        take(shots, "plume", i, (float)i / 16);
    assert_int_equal(sf_shots_recorded(shots), 12);
    assert_int_equal(sf_shots_record(shots, "plume"), SF_OK);
    assert_int_equal(sf_shots_recorded(shots), 0);
    take(shots, "other", 3, 0.5f);
    take(shots, "other", 3, 0.75f);
    sf_shots_stop(shots);
    assert_false(sf_shots_recording(shots));
    assert_int_equal(sf_shots_recorded(shots), 2);
    take(shots, "plume", 3, 0.25f);
    sf_shots_destroy(&shots);
    heard.slow = false;
    assert_int_equal(scratch_count("films/plume-001"), 0);
    assert_int_equal(scratch_count("films/plume-002"), 24);
    assert_int_equal(scratch_count("films/plume-003"), 4);
    assert_pair("films/plume-002/0011", 11.0f / 16);
    assert_pair("films/plume-003/0003", 0.5f);
    assert_pair("films/plume-003/0003-2", 0.75f);
    assert_pair("films/plume.0003", 0.25f);
    assert_int_equal(heard.debugs, 28);
    assert_int_equal(heard.infos, 4); /* two sequences and a screenshot of two files */
    assert_int_equal(heard.errors, 0);
}

static void test_no_folder(void **state)
{
    struct sf_frame frame = frame_of(1, 0.5f);
    struct sf_shots *shots = created("in-the-way/shots");
    FILE *file;

    (void)state;
    assert_non_null(file = fopen("in-the-way", "w"));
    fclose(file);
    assert_int_equal(sf_shots_take(shots, "a", &frame, "aces", 0, 24, 0), SF_ERROR_IO);
    assert_int_equal(heard.errors, 1);
    assert_string_equal(heard.error, "folder in-the-way/shots: cannot be made: Not a directory");
    assert_int_equal(sf_shots_record(shots, "a"), SF_ERROR_IO);
    assert_int_equal(heard.errors, 2);
    assert_false(sf_shots_recording(shots));
    /* It goes on once there is place. */
    assert_int_equal(remove("in-the-way"), 0);
    take(shots, "a", 1, 0.5f);
    sf_shots_destroy(&shots);
    assert_pair("in-the-way/shots/a.0001", 0.5f);
    assert_int_equal(heard.errors, 2);
}

/* The folder goes while a sequence is recorded: an error for each frame, and nothing worse. */
static void test_folder_goes(void **state)
{
    struct sf_shots *shots = created("gone");

    (void)state;
    assert_int_equal(sf_shots_record(shots, "a"), SF_OK);
    assert_int_equal(rmdir("gone/a-001"), 0);
    take(shots, "a", 1, 0.5f);
    take(shots, "a", 2, 0.5f);
    sf_shots_destroy(&shots);
    assert_int_equal(heard.errors, 2);
    assert_string_equal(heard.error, "gone/a-001/0002.png: cannot be written: No such file or directory");
}

/* A frame that cannot be encoded leaves no file behind. */
static void test_bad_frame(void **state)
{
    struct sf_frame frame = frame_of(1, 0.5f);
    struct sf_shots *shots = created("bad");

    (void)state;
    assert_int_equal(sf_shots_take(shots, "a", &frame, "sepia", 0, 24, 0), SF_OK);
    frame.color = NULL;
    assert_int_equal(sf_shots_take(shots, "b", &frame, "aces", 0, 24, 0), SF_ERROR_INTERNAL);
    sf_shots_destroy(&shots);
    assert_int_equal(heard.errors, 2);
    assert_int_equal(scratch_count("bad"), 1);
    assert_true(is_there("bad/a.0001.exr"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_names),     cmocka_unit_test(test_never_over),  cmocka_unit_test(test_record),
        cmocka_unit_test(test_no_folder), cmocka_unit_test(test_folder_goes), cmocka_unit_test(test_bad_frame),
    };
    return cmocka_run_group_tests(tests, scratch_enter, scratch_leave);
}
