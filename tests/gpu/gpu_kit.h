/* What the tests of src/gpu share: a log that counts, a device with validation, and short ways to declare graphs. */
#ifndef SF_TESTS_GPU_KIT_H
#define SF_TESTS_GPU_KIT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "gpu/gpu.h"

enum { KIT_SKIP = 77 };

/* The last error, and how many there were: tests of misuse read them, all others want none. */
struct kit_record {
    int errors, warnings;
    char last[1024];
};
static struct kit_record kit_record;

static inline void kit_write(void *user, enum sf_log_level level, const char *message)
{
    struct kit_record *record = user;

    if (level == SF_LOG_ERROR)
        record->errors++;
    if (level == SF_LOG_WARNING)
        record->warnings++;
    if (level <= SF_LOG_WARNING)
        snprintf(record->last, sizeof record->last, "%s", message);
    if (level <= SF_LOG_WARNING && getenv("SF_TEST_VERBOSE"))
        fprintf(stderr, "%s\n", message);
}
static const struct sf_log kit_log = {.write = kit_write, .user = &kit_record, .level = SF_LOG_WARNING};

static inline void kit_forget(void)
{
    memset(&kit_record, 0, sizeof kit_record);
}

/* A device with validation, and the budget given (0: the usual). */
static inline struct sf_gpu *kit_gpu(uint64_t budget)
{
    const struct sf_gpu_options options = {.validate = true, .budget_bytes = budget, .no_cache = true};
    struct sf_gpu *gpu = NULL;

    kit_forget();
    if (sf_gpu_create(&options, &kit_log, &gpu) != SF_OK)
        fail_msg("no device: %s", kit_record.last);
    return gpu;
}

/* Ends a test: no validation message ever, not even while the device goes. */
static inline void kit_finish(struct sf_gpu **gpu)
{
    const char *first = NULL;
    uint32_t messages = sf_gpu_validation_messages(*gpu, &first);

    if (messages)
        fail_msg("%u validation messages, the first: %s", messages, first);
    sf_gpu_destroy(gpu);
    if (kit_record.errors)
        fail_msg("%d errors, the last: %s", kit_record.errors, kit_record.last);
}

/* Whether there is a device to test on, and the layers to test with. */
static inline int kit_probe(void)
{
    const struct sf_gpu_options options = {.validate = true, .no_cache = true};
    struct sf_gpu *gpu = NULL;
    enum sf_status status = sf_gpu_create(&options, &kit_log, &gpu);

    sf_gpu_destroy(&gpu);
    if (status == SF_ERROR_DEVICE)
        fprintf(stderr, "skipped: %s\n", kit_record.last);
    return status == SF_ERROR_DEVICE ? KIT_SKIP : 0;
}

static inline struct sf_graph *kit_graph(const char *name)
{
    struct sf_graph *graph = NULL;

    assert_int_equal(sf_graph_create(name, &kit_log, &graph), SF_OK);
    return graph;
}

/* Compiles and makes real. */
static inline struct sf_player *kit_player(struct sf_gpu *gpu, const struct sf_graph *graph, struct sf_plan **plan)
{
    const struct sf_plan_memory memory = {.needs = sf_gpu_memory_needs, .user = gpu};
    struct sf_player *player = NULL;

    if (sf_plan_create(graph, &memory, &kit_log, plan) != SF_OK || sf_player_create(gpu, *plan, &player) != SF_OK)
        fail_msg("%s", kit_record.last);
    return player;
}

/* One frame with one play, waited for. */
static inline uint64_t kit_play(struct sf_gpu *gpu, struct sf_player *player)
{
    uint64_t serial = 0;

    if (sf_frame_begin(gpu) != SF_OK || sf_player_play(player) != SF_OK || sf_frame_end(gpu, &serial) != SF_OK ||
        sf_frame_wait(gpu, serial) != SF_OK)
        fail_msg("%s", kit_record.last);
    return serial;
}

static inline void kit_drop(struct sf_player **player, struct sf_plan **plan, struct sf_graph **graph)
{
    sf_player_destroy(player);
    sf_plan_destroy(plan);
    sf_graph_destroy(graph);
}

static inline sf_resource kit_buffer(struct sf_graph *graph, const char *name, enum sf_lifetime lifetime,
                                     uint64_t bytes)
{
    return sf_graph_buffer(graph, &(struct sf_buffer_desc){.name = name, .lifetime = lifetime, .bytes = bytes});
}

static inline sf_resource kit_image(struct sf_graph *graph, const char *name, enum sf_format format,
                                    enum sf_lifetime lifetime, uint32_t width, uint32_t height)
{
    return sf_graph_image(
        graph, &(struct sf_image_desc){
                   .name = name, .format = format, .lifetime = lifetime, .size = {.width = width, .height = height}});
}

static inline void kit_copy(struct sf_graph *graph, const char *name, sf_resource from, sf_resource to)
{
    const struct sf_use uses[] = {{.resource = from, .access = SF_ACCESS_TRANSFER_READ},
                                  {.resource = to, .access = SF_ACCESS_TRANSFER_WRITE}};

    sf_graph_pass(
        graph, &(struct sf_pass_desc){
                   .name = name, .kind = SF_PASS_TRANSFER, .uses = uses, .use_count = 2, .transfer = SF_TRANSFER_COPY});
}

/* to[i] = from[i] + *addend, over `count` words. */
static inline void kit_add(struct sf_graph *graph, const char *name, sf_resource from, bool previous, sf_resource to,
                           uint32_t count, const uint32_t *addend)
{
    const struct sf_use uses[] = {
        {.resource = from, .access = SF_ACCESS_STORAGE_READ, .binding = 0, .previous = previous},
        {.resource = to, .access = SF_ACCESS_STORAGE_WRITE, .binding = 1},
    };

    sf_graph_pass(graph, &(struct sf_pass_desc){.name = name,
                                                .kind = SF_PASS_COMPUTE,
                                                .uses = uses,
                                                .use_count = 2,
                                                .shader = "test/add.comp",
                                                .push = addend,
                                                .push_bytes = sizeof *addend,
                                                .groups = {(count + 63) / 64, 1, 1}});
}

static inline void kit_fill(struct sf_graph *graph, const char *name, sf_resource buffer, uint32_t word)
{
    const struct sf_use use = {.resource = buffer, .access = SF_ACCESS_TRANSFER_WRITE};

    sf_graph_pass(graph, &(struct sf_pass_desc){.name = name,
                                                .kind = SF_PASS_TRANSFER,
                                                .uses = &use,
                                                .use_count = 1,
                                                .transfer = SF_TRANSFER_FILL,
                                                .fill = word});
}

/* to = from, by way of the sampler: texel by texel, or half a texel to the right. */
static inline void kit_sample(struct sf_graph *graph, const char *name, sf_resource from, bool previous,
                              enum sf_sampler sampler, sf_resource to, uint32_t between)
{
    const struct sf_use uses[] = {
        {.resource = from, .access = SF_ACCESS_SAMPLED, .binding = 0, .previous = previous, .sampler = sampler},
        {.resource = to, .access = SF_ACCESS_STORAGE_WRITE, .binding = 1},
    };

    sf_graph_pass(graph, &(struct sf_pass_desc){.name = name,
                                                .kind = SF_PASS_COMPUTE,
                                                .uses = uses,
                                                .use_count = 2,
                                                .shader = "test/sample.comp",
                                                .constants = {between},
                                                .constant_count = 1,
                                                .domain = to,
                                                .local = {8, 8}});
}

/* x, y, number of the pixel, 1 */
static inline void kit_fill_image(struct sf_graph *graph, const char *name, sf_resource image)
{
    const struct sf_use use = {.resource = image, .access = SF_ACCESS_STORAGE_WRITE, .binding = 0};

    sf_graph_pass(graph, &(struct sf_pass_desc){.name = name,
                                                .kind = SF_PASS_COMPUTE,
                                                .uses = &use,
                                                .use_count = 1,
                                                .shader = "test/fill_image.comp",
                                                .domain = image,
                                                .local = {8, 8}});
}

#endif
