/* What the tests of misuse share: a graph that is right, and the run over a table of faults, each added to it alone.
 * The compile must fail with one message that names the graph, the pass or resource, and the remedy. */
#ifndef SF_TESTS_GRAPH_MISUSE_H
#define SF_TESTS_GRAPH_MISUSE_H

#include "graph_kit.h"

enum { SIDE = 64 };

/* A graph that is right by itself, so that each case adds just one fault. */
struct parts {
    struct sf_graph *graph;
    sf_resource image, buffer, depth, state, upload, readback, history, layered;
};

/* Uses: the resource, and further fields. */
#define SAMPLED(...)                                                                                                   \
    {                                                                                                                  \
        __VA_ARGS__, .access = SF_ACCESS_SAMPLED                                                                       \
    }
#define READ(...)                                                                                                      \
    {                                                                                                                  \
        __VA_ARGS__, .access = SF_ACCESS_STORAGE_READ                                                                  \
    }
#define WRITE(...)                                                                                                     \
    {                                                                                                                  \
        __VA_ARGS__, .access = SF_ACCESS_STORAGE_WRITE                                                                 \
    }
#define MODIFY(...)                                                                                                    \
    {                                                                                                                  \
        __VA_ARGS__, .access = SF_ACCESS_STORAGE_MODIFY                                                                \
    }
#define COLOR(...)                                                                                                     \
    {                                                                                                                  \
        __VA_ARGS__, .access = SF_ACCESS_COLOR, .load = SF_LOAD_CLEAR                                                  \
    }
#define DEPTH(...)                                                                                                     \
    {                                                                                                                  \
        __VA_ARGS__, .access = SF_ACCESS_DEPTH, .load = SF_LOAD_CLEAR                                                  \
    }
#define FROM(r)                                                                                                        \
    {                                                                                                                  \
        .resource = r, .access = SF_ACCESS_TRANSFER_READ                                                               \
    }
#define TO(r)                                                                                                          \
    {                                                                                                                  \
        .resource = r, .access = SF_ACCESS_TRANSFER_WRITE                                                              \
    }

static inline struct parts make_parts(void)
{
    struct parts p = {.graph = kit_graph("bad")};

    p.image = kit_image(p.graph, "image", SF_FORMAT_RGBA16F, SF_TRANSIENT, SIDE);
    p.buffer = kit_buffer(p.graph, "buffer", SF_TRANSIENT, 4096);
    p.depth = kit_image(p.graph, "depth", SF_FORMAT_D32F, SF_TRANSIENT, SIDE);
    p.state = kit_buffer(p.graph, "state", SF_PERSISTENT, 64);
    p.upload = kit_buffer(p.graph, "upload", SF_UPLOAD, 64);
    p.readback = kit_buffer(p.graph, "readback", SF_READBACK, 4096);
    p.history = kit_image(p.graph, "history", SF_FORMAT_RGBA16F, SF_HISTORY, SIDE);
    p.layered = sf_graph_image(p.graph, &(struct sf_image_desc){.name = "layered",
                                                                .format = SF_FORMAT_RGBA16F,
                                                                .size = {.width = SIDE, .height = SIDE},
                                                                .layers = 2});
    KIT_COMPUTE(p.graph, "step", KIT_USES(MODIFY(p.state)));
    return p;
}

struct misuse {
    void (*declare)(struct parts *parts);
    const char *who, *why, *remedy; /* parts of the message */
};

static inline void check_misuses(const struct misuse *misuses, size_t count)
{
    int failures = 0;

    for (size_t i = 0; i < count; i++) {
        const struct misuse *misuse = &misuses[i];
        struct parts parts = make_parts();
        struct sf_plan *plan = (struct sf_plan *)&parts; /* must become NULL */
        struct kit_log log;
        enum sf_status status;

        kit_log_init(&log);
        misuse->declare(&parts);
        status = sf_plan_create(parts.graph, NULL, &log.log, &plan);
        if (status != SF_ERROR_INTERNAL || plan || log.count != 1 || !strstr(log.message, "graph 'bad'") ||
            !strstr(log.message, misuse->who) || !strstr(log.message, misuse->why) ||
            !strstr(log.message, misuse->remedy)) {
            print_error("case %zu (%s, %s, %s): status %d, %d messages, '%s'\n", i, misuse->who, misuse->why,
                        misuse->remedy, status, log.count, log.message);
            failures++;
        }
        sf_graph_destroy(&parts.graph);
    }
    assert_int_equal(failures, 0);
}

#endif
