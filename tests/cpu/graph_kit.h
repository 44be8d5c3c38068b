/* For the tests of the graph: declaring in few words, catching the log, and comparing with golden texts. */
#ifndef SF_TESTS_GRAPH_KIT_H
#define SF_TESTS_GRAPH_KIT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "base/file.h"
#include "graph/plan.h"

/* Keeps the last message. */
struct kit_log {
    struct sf_log log;
    char message[2048];
    int count;
};

static inline void kit_log_write(void *user, enum sf_log_level level, const char *message)
{
    struct kit_log *kit = user;

    (void)level;
    kit->count++;
    snprintf(kit->message, sizeof kit->message, "%s", message);
}

static inline void kit_log_init(struct kit_log *kit)
{
    *kit = (struct kit_log){.log = {kit_log_write, kit, SF_LOG_DEBUG}};
}

static inline struct sf_graph *kit_graph(const char *name)
{
    struct sf_graph *graph;

    assert_int_equal(sf_graph_create(name, NULL, &graph), SF_OK);
    return graph;
}

static inline sf_resource kit_image(struct sf_graph *graph, const char *name, enum sf_format format,
                                    enum sf_lifetime lifetime, uint32_t side)
{
    return sf_graph_image(graph, &(struct sf_image_desc){
                                     .name = name,
                                     .format = format,
                                     .lifetime = lifetime,
                                     .size = {.width = side, .height = side},
                                 });
}

static inline sf_resource kit_buffer(struct sf_graph *graph, const char *name, enum sf_lifetime lifetime,
                                     uint64_t bytes)
{
    return sf_graph_buffer(graph, &(struct sf_buffer_desc){.name = name, .lifetime = lifetime, .bytes = bytes});
}

#define KIT_USES(...)                                                                                                  \
    .uses = (const struct sf_use[]){__VA_ARGS__}, .use_count = SF_COUNT(((const struct sf_use[]){__VA_ARGS__}))

/* A compute pass of one group, and a full-screen draw; further fields may follow. */
#define KIT_COMPUTE(graph_, name_, ...)                                                                                \
    sf_graph_pass(graph_,                                                                                              \
                  &(struct sf_pass_desc){                                                                              \
                      .name = name_, .kind = SF_PASS_COMPUTE, .shader = "a.comp", .groups = {1, 1, 1}, __VA_ARGS__})
#define KIT_RASTER(graph_, name_, ...)                                                                                 \
    sf_graph_pass(graph_, &(struct sf_pass_desc){.name = name_,                                                        \
                                                 .kind = SF_PASS_RASTER,                                               \
                                                 .shader = "a.vert",                                                   \
                                                 .fragment = "a.frag",                                                 \
                                                 .vertices = 3,                                                        \
                                                 .instances = 1,                                                       \
                                                 __VA_ARGS__})
#define KIT_TRANSFER(graph_, name_, ...)                                                                               \
    sf_graph_pass(graph_, &(struct sf_pass_desc){.name = name_, .kind = SF_PASS_TRANSFER, __VA_ARGS__})

static inline struct sf_plan *kit_plan(const struct sf_graph *graph, const struct sf_plan_memory *memory)
{
    struct kit_log log;
    struct sf_plan *plan;

    kit_log_init(&log);
    if (sf_plan_create(graph, memory, &log.log, &plan) != SF_OK)
        fail_msg("%s", log.message);
    return plan;
}

/* Lines that differ, between the equal ones at the start and at the end. */
static inline void kit_print_diff(const char *expected, const char *actual)
{
    const char *sides[2] = {expected, actual};
    size_t start = 0, tail = 0, lengths[2] = {strlen(expected), strlen(actual)};
    size_t shorter = lengths[0] < lengths[1] ? lengths[0] : lengths[1];

    while (start < shorter && expected[start] == actual[start])
        start++;
    while (start > 0 && expected[start - 1] != '\n')
        start--;
    while (tail < shorter - start && expected[lengths[0] - 1 - tail] == actual[lengths[1] - 1 - tail])
        tail++;
    while (tail > 0 && expected[lengths[0] - tail - 1] != '\n')
        tail--;
    for (int side = 0; side < 2; side++) {
        const char *at = sides[side] + start, *end = sides[side] + lengths[side] - tail;

        while (at < end) {
            size_t line = strcspn(at, "\n");

            print_message("%c %.*s\n", side ? '+' : '-', (int)line, at);
            at += line + (at[line] == '\n');
        }
    }
}

/* Compares with tests/cpu/golden/<name>; SF_UPDATE_GOLDEN=1 in the environment writes it anew. */
static inline void kit_check_golden(const char *name, const char *actual)
{
    const char *root = getenv("SF_SOURCE_ROOT"), *update = getenv("SF_UPDATE_GOLDEN");
    char path[1024], *expected = NULL;
    size_t size;

    assert_non_null(root);
    snprintf(path, sizeof path, "%s/tests/cpu/golden/%s", root, name);
    if (update && !strcmp(update, "1")) {
        assert_int_equal(sf_file_write(path, actual, strlen(actual), NULL), SF_OK);
        return;
    }
    if (sf_file_read(path, 1 << 20, NULL, &expected, &size) != SF_OK)
        fail_msg("%s cannot be read; SF_UPDATE_GOLDEN=1 writes it", path);
    if (strcmp(expected, actual)) {
        print_message("%s: - as it is in the file, + as it was made now\n", path);
        kit_print_diff(expected, actual);
        free(expected);
        fail_msg("%s differs; if the change is wanted, SF_UPDATE_GOLDEN=1 rewrites it", name);
    }
    free(expected);
}

#endif
