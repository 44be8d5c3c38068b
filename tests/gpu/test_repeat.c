/* The same scene gives the same bits again: on one thread and on several, in another process with and without caches, a
 * frame alone and within its sequence, after going back in time, and whatever else is asked of the renderer.
 *
 * Each way of rendering is a process of its own (this program, called with `play`), which prints a hash of each frame's
 * colour, depth and counts of particles; the hashes are compared with those of the first. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <cmocka.h>

#include "base/array.h"
#include "base/hash.h"
#include "sfumato/sfumato.h"

enum { SKIP = 77, WIDTH = 72, HEIGHT = 56, FRAMES = 10, RESULTS_MAX = 32, KEPT_MAX = 8 };

/* Frame by frame: what was rendered, in the order asked for. */
struct results {
    uint32_t frame[RESULTS_MAX];
    char hash[RESULTS_MAX][40];
    uint32_t count;
};

/* ---- the process that renders ---- */

static void write_log(void *user, enum sf_log_level level, const char *message)
{
    (void)user;
    (void)level;
    fprintf(stderr, "%s\n", message);
}
static const struct sf_log test_log = {.write = write_log, .level = SF_LOG_WARNING};

/* Not only the hash: the counts say what it is that differs. */
static void print_frame(const struct sf_frame *frame)
{
    size_t pixels = (size_t)frame->width * frame->height;
    uint64_t hash = sf_hash_bytes(frame->color, pixels * 4 * sizeof *frame->color, 1);

    hash = sf_hash_bytes(frame->depth, pixels * sizeof *frame->depth, hash);
    printf("%u %016llx/%u/%u\n", frame->frame, (unsigned long long)hash, frame->live, frame->dropped);
}

static enum sf_status print_oldest(struct sf_renderer *renderer, uint64_t tickets[KEPT_MAX], uint32_t *waiting)
{
    struct sf_frame frame;
    enum sf_status status = sf_renderer_wait(renderer, tickets[0], &frame);

    if (!status)
        print_frame(&frame);
    memmove(tickets, tickets + 1, (KEPT_MAX - 1) * sizeof *tickets);
    --*waiting;
    return status;
}

/* Always as many frames under way as may be. `list`: numbers, each ended by a comma. */
static enum sf_status render_list(struct sf_renderer *renderer, const char *list, uint32_t kept, bool seek)
{
    uint64_t tickets[KEPT_MAX];
    uint32_t waiting = 0;
    enum sf_status status = SF_OK;
    char *end;

    for (const char *at = list; *at && !status; at = end + 1) {
        uint32_t number = (uint32_t)strtoul(at, &end, 10);

        if (end == at || *end != ',')
            return SF_ERROR_USAGE;
        if (waiting == kept)
            status = print_oldest(renderer, tickets, &waiting);
        if (!status && seek)
            status = sf_renderer_seek(renderer, number, NULL, NULL);
        if (!status)
            status = sf_renderer_render(renderer, number, &tickets[waiting++]);
    }
    while (waiting > 0 && !status)
        status = print_oldest(renderer, tickets, &waiting);
    return status;
}

/* `flags`: v validate, a AOVs, t timing, s seek, n no cache of pipelines. */
static enum sf_status render(const char *path, const char *flags, uint32_t kept, const char *list)
{
    const struct sf_device_options device_options = {.validate = strchr(flags, 'v'), .no_cache = strchr(flags, 'n')};
    const struct sf_renderer_options options = {
        .width = WIDTH,
        .height = HEIGHT,
        .frames_kept = kept,
        .timing = strchr(flags, 't'),
        .aovs = strchr(flags, 'a') ? SF_AOV_SMOKE | SF_AOV_DEPTHS : 0,
    };
    struct sf_device *device = NULL;
    struct sf_scene *scene = NULL;
    struct sf_renderer *renderer = NULL;
    enum sf_status status = sf_device_create(&device_options, &test_log, &device);

    if (!status)
        status = sf_scene_load(path, NULL, 0, &test_log, &scene);
    if (!status)
        status = sf_renderer_create(device, scene, &options, &test_log, &renderer);
    if (!status)
        status = render_list(renderer, list, kept, strchr(flags, 's'));
    if (!status && sf_device_validation_messages(device) > 0)
        status = SF_ERROR_INTERNAL;
    sf_renderer_destroy(&renderer);
    sf_scene_destroy(&scene);
    sf_device_destroy(&device);
    return status;
}

/* ---- the process that compares ---- */

static const char *self;
static char cache[] = "/tmp/sfumato-repeat-XXXXXX";

static void run(const char *scene, const char *environment, const char *flags, uint32_t kept, const char *list,
                struct results *results)
{
    const char *root = getenv("SF_SOURCE_ROOT");
    char command[2048], line[128];
    FILE *pipe;
    int status;

    *results = (struct results){0};
    snprintf(command, sizeof command, "XDG_CACHE_HOME='%s' %s exec '%s' play '%s/scenes/tiny/%s.json' '%s' %u %s",
             cache, environment, self, root ? root : ".", scene, flags, kept, list);
    pipe = popen(command, "r");
    assert_non_null(pipe);
    while (fgets(line, sizeof line, pipe) && results->count < RESULTS_MAX) {
        uint32_t n = results->count++;

        if (sscanf(line, "%u %39s", &results->frame[n], results->hash[n]) != 2)
            fail_msg("strange answer: %s", line);
    }
    status = pclose(pipe);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        fail_msg("%s: failed with status %d", command, WIFEXITED(status) ? WEXITSTATUS(status) : -1);
}

static const char sequence[] = "0,1,2,3,4,5,6,7,8,9,";

static const struct variant {
    const char *name, *environment, *flags;
    uint32_t kept;
    const char *list;
    bool always; /* for every scene, not only for the first */
} variants[] = {
    {"again, from the caches", "", "", 2, sequence, false},
    {"without the cache of pipelines", "", "n", 2, sequence, false},
    {"on one thread", "LP_NUM_THREADS=1", "", 2, sequence, true},
    {"on two threads", "LP_NUM_THREADS=2", "", 2, sequence, true},
    {"on three threads", "LP_NUM_THREADS=3", "", 2, sequence, true},
    {"the last frame alone", "", "", 2, "9,", true},
    {"the last frame alone, sought first", "", "s", 2, "9,", false},
    {"some frames only", "", "", 2, "2,3,7,", false},
    {"back in time, and to the same frame again", "", "", 2, "9,3,9,9,0,5,", true},
    {"with validation", "", "v", 2, sequence, false},
    {"with AOVs", "", "a", 2, sequence, false},
    {"timed", "", "t", 2, sequence, false},
    {"all at once, eight frames under way", "", "vat", 8, sequence, false},
    {"one frame at a time", "", "", 1, sequence, false},
};

static void compare(const char *scene, bool all)
{
    struct results reference, found;

    run(scene, "", "", 2, sequence, &reference);
    assert_int_equal(reference.count, FRAMES);
    /* All frames alike would prove nothing. */
    assert_string_not_equal(reference.hash[0], reference.hash[FRAMES - 1]);
    for (size_t v = 0; v < SF_COUNT(variants); v++) {
        const struct variant *variant = &variants[v];
        uint32_t wanted = 0;

        if (!all && !variant->always)
            continue;
        for (const char *at = variant->list; *at; at++)
            wanted += *at == ',';
        run(scene, variant->environment, variant->flags, variant->kept, variant->list, &found);
        assert_int_equal(found.count, wanted);
        for (uint32_t i = 0; i < found.count; i++) {
            assert_true(found.frame[i] < FRAMES);
            if (strcmp(found.hash[i], reference.hash[found.frame[i]]) != 0)
                fail_msg("%s, frame %u, %s: hash/live/dropped %s instead of %s", scene, found.frame[i], variant->name,
                         found.hash[i], reference.hash[found.frame[i]]);
        }
    }
}

/* Every kind of emitter, force, light and object; the camera moves. */
static void test_everything(void **state)
{
    (void)state;
    compare("all", true);
}

/* A long preroll, so that going back costs many steps; meshes. */
static void test_preroll(void **state)
{
    (void)state;
    compare("mesh", false);
}

static int make_cache(void **state)
{
    (void)state;
    return mkdtemp(cache) ? 0 : -1;
}

static int drop_cache(void **state)
{
    char command[64];

    (void)state;
    snprintf(command, sizeof command, "rm -rf '%s'", cache);
    return system(command);
}

static bool has_device(void)
{
    const struct sf_device_options options = {.validate = true, .no_cache = true};
    struct sf_device *device = NULL;
    enum sf_status status = sf_device_create(&options, &test_log, &device);

    sf_device_destroy(&device);
    return status != SF_ERROR_DEVICE;
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_everything), cmocka_unit_test(test_preroll)};

    if (argc == 6 && strcmp(argv[1], "play") == 0)
        return (int)render(argv[2], argv[3], (uint32_t)strtoul(argv[4], NULL, 10), argv[5]);
    self = argv[0];
    if (!has_device())
        return SKIP;
    return cmocka_run_group_tests(tests, make_cache, drop_cache);
}
