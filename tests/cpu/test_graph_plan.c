/* Small graphs, their plans as golden texts; the checker agrees with each of them, and misses every barrier that is
 * left out. */
#include "graph_kit.h"
#include "graph_checker.h"

#include <jansson.h>

enum { SIDE = 64 };

static void check_hazards(const struct sf_plan *plan, const char *output)
{
    bool outputs[64] = {false};
    char problem[256];
    uint32_t count = checker_barrier_count(plan);

    if (output)
        outputs[sf_graph_find(plan->graph, output) - 1] = true;
    if (!checker_run(plan, outputs, (struct checker_drop){CHECKER_DROP_NONE, CHECKER_DROP_NONE, CHECKER_DROP_NONE},
                     problem))
        fail_msg("%s: %s", plan->name, problem);
    for (uint32_t b = 0; b < count; b++)
        if (checker_run(plan, outputs, (struct checker_drop){b, CHECKER_DROP_NONE, CHECKER_DROP_NONE}, problem))
            fail_msg("%s: nobody misses barrier %u", plan->name, b);
}

static void check_plan(struct sf_graph *graph, const char *output)
{
    struct sf_plan *plan;
    struct sf_text text = {0};
    char name[128];

    if (output)
        sf_graph_output(graph, sf_graph_find(graph, output));
    plan = kit_plan(graph, NULL);
    check_hazards(plan, output);
    sf_plan_print(plan, SF_PLAN_TEXT, &text);
    assert_false(text.failed);
    snprintf(name, sizeof name, "graph_%s.txt", plan->name);
    kit_check_golden(name, text.data);
    sf_text_finish(&text);
    sf_plan_destroy(&plan);
    sf_graph_destroy(&graph);
}

/* A draw, a blur in two directions, a composite: the second blur takes the memory of the draw. */
static struct sf_graph *chain(void)
{
    struct sf_graph *graph = kit_graph("chain");
    sf_resource drawn = kit_image(graph, "drawn", SF_FORMAT_RGBA32F, SF_TRANSIENT, SIDE);
    sf_resource across = kit_image(graph, "blur.across", SF_FORMAT_RGBA32F, SF_TRANSIENT, SIDE);
    sf_resource down = kit_image(graph, "blur.down", SF_FORMAT_RGBA32F, SF_TRANSIENT, SIDE);
    sf_resource frame = kit_image(graph, "frame", SF_FORMAT_RGBA16F, SF_TRANSIENT, SIDE);

    KIT_RASTER(graph, "draw", KIT_USES({.resource = drawn, .access = SF_ACCESS_COLOR, .load = SF_LOAD_CLEAR}),
               .raster = {.blend = {SF_BLEND_MIN_ADD}}, .coverage = 0.25f);
    KIT_COMPUTE(graph, "across",
                KIT_USES({.resource = drawn, .access = SF_ACCESS_SAMPLED},
                         {.resource = across, .access = SF_ACCESS_STORAGE_WRITE, .binding = 1}));
    sf_graph_pass(graph, &(struct sf_pass_desc){
                             .name = "down",
                             .kind = SF_PASS_COMPUTE,
                             .shader = "blur.comp",
                             .domain = down,
                             .local = {8, 12},
                             KIT_USES({.resource = across, .access = SF_ACCESS_SAMPLED},
                                      {.resource = down, .access = SF_ACCESS_STORAGE_WRITE, .binding = 1}),
                         });
    KIT_RASTER(graph, "composite",
               KIT_USES({.resource = frame, .access = SF_ACCESS_COLOR, .load = SF_LOAD_DISCARD},
                        {.resource = down, .access = SF_ACCESS_SAMPLED, .sampler = SF_SAMPLER_LINEAR}));
    return graph;
}

static void test_chain(void **state)
{
    (void)state;
    check_plan(chain(), "frame");
}

/* One result, read by two passes of different kinds: one barrier for both; their results meet again. */
static void test_diamond(void **state)
{
    struct sf_graph *graph = kit_graph("diamond");
    sf_resource source = kit_image(graph, "source", SF_FORMAT_R32F, SF_TRANSIENT, SIDE);
    sf_resource left = kit_buffer(graph, "left", SF_TRANSIENT, 1000);
    sf_resource right = kit_image(graph, "right", SF_FORMAT_R32F, SF_TRANSIENT, SIDE);
    sf_resource joined = kit_buffer(graph, "joined", SF_PERSISTENT, 1000);

    (void)state;
    KIT_COMPUTE(graph, "make", KIT_USES({.resource = source, .access = SF_ACCESS_STORAGE_WRITE}));
    KIT_COMPUTE(graph, "left",
                KIT_USES({.resource = source, .access = SF_ACCESS_SAMPLED},
                         {.resource = left, .access = SF_ACCESS_STORAGE_WRITE, .binding = 1}));
    KIT_RASTER(graph, "right",
               KIT_USES({.resource = source, .access = SF_ACCESS_SAMPLED},
                        {.resource = right, .access = SF_ACCESS_COLOR, .load = SF_LOAD_CLEAR}));
    KIT_COMPUTE(graph, "join",
                KIT_USES({.resource = left, .access = SF_ACCESS_STORAGE_READ},
                         {.resource = right, .access = SF_ACCESS_SAMPLED, .binding = 1},
                         {.resource = joined, .access = SF_ACCESS_STORAGE_WRITE, .binding = 2}));
    check_plan(graph, NULL);
}

/* A fluid's ping-pong: the current copy is made from the previous one, and drawn. */
static void test_history(void **state)
{
    struct sf_graph *graph = kit_graph("history");
    sf_resource smoke = kit_image(graph, "smoke", SF_FORMAT_RGBA16F, SF_HISTORY, SIDE);
    sf_resource frame = kit_image(graph, "frame", SF_FORMAT_RGBA8_UNORM, SF_TRANSIENT, SIDE);

    (void)state;
    KIT_COMPUTE(graph, "advect",
                KIT_USES({.resource = smoke, .access = SF_ACCESS_SAMPLED, .previous = true},
                         {.resource = smoke, .access = SF_ACCESS_STORAGE_WRITE, .binding = 1}));
    KIT_RASTER(graph, "draw",
               KIT_USES({.resource = smoke, .access = SF_ACCESS_SAMPLED},
                        {.resource = frame, .access = SF_ACCESS_COLOR, .load = SF_LOAD_CLEAR}));
    check_plan(graph, "frame");
}

/* Six images in a row, of three sizes: memory is shared by those whose lives do not meet. */
static void test_aliasing(void **state)
{
    struct sf_graph *graph = kit_graph("aliasing");
    sf_resource images[6];
    static const char *const names[6] = {"a", "b", "c", "d", "e", "f"};
    static const uint32_t sides[6] = {64, 128, 64, 64, 128, 32};

    (void)state;
    for (int i = 0; i < 6; i++)
        images[i] = kit_image(graph, names[i], SF_FORMAT_RGBA32F, SF_TRANSIENT, sides[i]);
    KIT_COMPUTE(graph, "make a", KIT_USES({.resource = images[0], .access = SF_ACCESS_STORAGE_WRITE}));
    for (int i = 1; i < 6; i++) {
        char name[] = "make ?";

        name[5] = names[i][0];
        KIT_COMPUTE(graph, name,
                    KIT_USES({.resource = images[i - 1], .access = SF_ACCESS_SAMPLED},
                             {.resource = images[i], .access = SF_ACCESS_STORAGE_WRITE, .binding = 1}));
    }
    check_plan(graph, "f");
}

/* What no output needs is culled, with what it alone needed; a pass to keep is kept with what it reads. */
static void test_culled(void **state)
{
    struct sf_graph *graph = kit_graph("culled");
    sf_resource frame = kit_image(graph, "frame", SF_FORMAT_RGBA8_UNORM, SF_TRANSIENT, SIDE);
    sf_resource debug = kit_image(graph, "debug", SF_FORMAT_RGBA8_UNORM, SF_TRANSIENT, SIDE);
    sf_resource scratch = kit_buffer(graph, "scratch", SF_TRANSIENT, 4096);
    sf_resource trace = kit_buffer(graph, "trace", SF_TRANSIENT, 256);

    (void)state;
    KIT_COMPUTE(graph, "histogram", KIT_USES({.resource = scratch, .access = SF_ACCESS_STORAGE_WRITE}));
    KIT_RASTER(graph, "draw", KIT_USES({.resource = frame, .access = SF_ACCESS_COLOR, .load = SF_LOAD_CLEAR}));
    KIT_COMPUTE(graph, "draw histogram",
                KIT_USES({.resource = scratch, .access = SF_ACCESS_STORAGE_READ},
                         {.resource = debug, .access = SF_ACCESS_STORAGE_WRITE, .binding = 1}));
    KIT_COMPUTE(graph, "trace",
                KIT_USES({.resource = frame, .access = SF_ACCESS_SAMPLED},
                         {.resource = trace, .access = SF_ACCESS_STORAGE_WRITE, .binding = 1}),
                .keep = true);
    check_plan(graph, "frame");
}

/* The count is written by a compute pass; a draw and a dispatch take their arguments from it, and a shader reads it. */
static void test_indirect(void **state)
{
    struct sf_graph *graph = kit_graph("indirect");
    sf_resource counts = kit_buffer(graph, "counts", SF_TRANSIENT, 64);
    sf_resource list = kit_buffer(graph, "list", SF_PERSISTENT, 4096);
    sf_resource frame = kit_image(graph, "frame", SF_FORMAT_RGBA16F, SF_TRANSIENT, SIDE);

    (void)state;
    KIT_TRANSFER(graph, "zero", .transfer = SF_TRANSFER_FILL,
                 KIT_USES({.resource = counts, .access = SF_ACCESS_TRANSFER_WRITE}));
    KIT_COMPUTE(graph, "count",
                KIT_USES({.resource = list, .access = SF_ACCESS_STORAGE_READ},
                         {.resource = counts, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 1}));
    sf_graph_pass(graph, &(struct sf_pass_desc){
                             .name = "move",
                             .kind = SF_PASS_COMPUTE,
                             .shader = "move.comp",
                             .indirect = counts,
                             KIT_USES({.resource = counts, .access = SF_ACCESS_STORAGE_READ},
                                      {.resource = list, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 1}),
                         });
    sf_graph_pass(graph, &(struct sf_pass_desc){
                             .name = "draw",
                             .kind = SF_PASS_RASTER,
                             .shader = "draw.vert",
                             .fragment = "draw.frag",
                             .indirect = counts,
                             .indirect_offset = 16,
                             .raster = {.blend = {SF_BLEND_PREMULTIPLIED}},
                             KIT_USES({.resource = list, .access = SF_ACCESS_STORAGE_READ},
                                      {.resource = frame, .access = SF_ACCESS_COLOR, .load = SF_LOAD_CLEAR}),
                         });
    check_plan(graph, "frame");
}

static void test_readback(void **state)
{
    struct sf_graph *graph = kit_graph("readback");
    sf_resource settings = kit_buffer(graph, "settings", SF_UPLOAD, 256);
    sf_resource frame = kit_image(graph, "frame", SF_FORMAT_RGBA16F, SF_TRANSIENT, SIDE);
    sf_resource pixels = kit_buffer(graph, "pixels", SF_READBACK, SIDE * SIDE * 8);

    (void)state;
    KIT_RASTER(graph, "draw",
               KIT_USES({.resource = settings, .access = SF_ACCESS_UNIFORM},
                        {.resource = frame, .access = SF_ACCESS_COLOR, .load = SF_LOAD_DISCARD}));
    KIT_TRANSFER(graph, "read back",
                 KIT_USES({.resource = frame, .access = SF_ACCESS_TRANSFER_READ},
                          {.resource = pixels, .access = SF_ACCESS_TRANSFER_WRITE}));
    check_plan(graph, NULL);
}

/* One transient, written first and read last: the next play's first pass waits for this play's last. */
static void test_reuse(void **state)
{
    struct sf_graph *graph = kit_graph("reuse");
    sf_resource keys = kit_buffer(graph, "keys", SF_TRANSIENT, 4096);
    sf_resource sums = kit_buffer(graph, "sums", SF_TRANSIENT, 256);
    sf_resource total = kit_buffer(graph, "total", SF_PERSISTENT, 4);

    (void)state;
    KIT_COMPUTE(graph, "keys", KIT_USES({.resource = keys, .access = SF_ACCESS_STORAGE_WRITE}));
    KIT_COMPUTE(graph, "sums",
                KIT_USES({.resource = keys, .access = SF_ACCESS_STORAGE_READ},
                         {.resource = sums, .access = SF_ACCESS_STORAGE_WRITE, .binding = 1}));
    KIT_COMPUTE(graph, "total",
                KIT_USES({.resource = keys, .access = SF_ACCESS_STORAGE_READ},
                         {.resource = sums, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
                         {.resource = total, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 2}));
    check_plan(graph, NULL);
}

/* A pair of particle lists from outside, a noise image that is only read as outside reads it, and a swapchain image. */
static void test_imported(void **state)
{
    struct sf_graph *graph = kit_graph("imported");
    sf_resource list = sf_graph_buffer(graph, &(struct sf_buffer_desc){.name = "list",
                                                                       .lifetime = SF_IMPORTED,
                                                                       .bytes = 4096,
                                                                       .outside = SF_ACCESS_STORAGE_READ,
                                                                       .history = true});
    sf_resource noise = sf_graph_image(graph, &(struct sf_image_desc){.name = "noise",
                                                                      .format = SF_FORMAT_R8_UNORM,
                                                                      .lifetime = SF_IMPORTED,
                                                                      .size = {.width = 16, .height = 16},
                                                                      .outside = SF_ACCESS_SAMPLED});
    sf_resource frame = sf_graph_image(graph, &(struct sf_image_desc){.name = "frame",
                                                                      .format = SF_FORMAT_RGBA8_SRGB,
                                                                      .lifetime = SF_IMPORTED,
                                                                      .size = {.width = SIDE, .height = SIDE},
                                                                      .outside = SF_ACCESS_PRESENT});

    (void)state;
    KIT_COMPUTE(
        graph, "move",
        KIT_USES({.resource = list, .access = SF_ACCESS_STORAGE_READ, .previous = true},
                 {.resource = list, .access = SF_ACCESS_STORAGE_WRITE, .binding = 1},
                 {.resource = noise, .access = SF_ACCESS_SAMPLED, .binding = 2, .sampler = SF_SAMPLER_LINEAR_REPEAT}));
    KIT_RASTER(graph, "draw",
               KIT_USES({.resource = list, .access = SF_ACCESS_STORAGE_READ},
                        {.resource = frame, .access = SF_ACCESS_COLOR, .load = SF_LOAD_CLEAR}));
    check_plan(graph, NULL);
}

/* Depth is drawn, then tested and sampled in one pass: one read-only layout for both, and for the sampling that
 * follows. */
static void test_depth_read(void **state)
{
    struct sf_graph *graph = kit_graph("depth_read");
    sf_resource depth = kit_image(graph, "depth", SF_FORMAT_D32F, SF_TRANSIENT, SIDE);
    sf_resource color = kit_image(graph, "color", SF_FORMAT_RGBA16F, SF_TRANSIENT, SIDE);
    sf_resource second = kit_image(graph, "depth.second", SF_FORMAT_D32F, SF_TRANSIENT, SIDE);

    (void)state;
    KIT_RASTER(graph, "solid",
               KIT_USES({.resource = depth, .access = SF_ACCESS_DEPTH, .load = SF_LOAD_CLEAR},
                        {.resource = color, .access = SF_ACCESS_COLOR, .load = SF_LOAD_CLEAR}),
               .raster = {.depth = SF_DEPTH_GREATER_EQUAL});
    KIT_RASTER(graph, "soft",
               KIT_USES({.resource = depth, .access = SF_ACCESS_DEPTH_READ},
                        {.resource = depth, .access = SF_ACCESS_SAMPLED},
                        {.resource = color, .access = SF_ACCESS_COLOR}),
               .raster = {.depth = SF_DEPTH_GREATER_EQUAL, .blend = {SF_BLEND_PREMULTIPLIED}});
    KIT_RASTER(graph, "overlay",
               KIT_USES({.resource = depth, .access = SF_ACCESS_SAMPLED},
                        {.resource = second, .access = SF_ACCESS_DEPTH, .load = SF_LOAD_CLEAR},
                        {.resource = color, .access = SF_ACCESS_COLOR}),
               .raster = {.depth = SF_DEPTH_ALWAYS});
    check_plan(graph, "color");
}

/* State that is read, changed, and read again: the read after the change and the first of the next play are one group
 * over the seam. */
static void test_persistent(void **state)
{
    struct sf_graph *graph = kit_graph("persistent");
    sf_resource map = kit_image(graph, "map", SF_FORMAT_R32F, SF_PERSISTENT, SIDE);
    sf_resource out = kit_buffer(graph, "out", SF_READBACK, SIDE * SIDE * 4);
    sf_resource draft = kit_image(graph, "draft", SF_FORMAT_R32F, SF_TRANSIENT, SIDE);

    (void)state;
    KIT_COMPUTE(graph, "look",
                KIT_USES({.resource = map, .access = SF_ACCESS_SAMPLED},
                         {.resource = draft, .access = SF_ACCESS_STORAGE_WRITE, .binding = 1}));
    KIT_COMPUTE(graph, "change",
                KIT_USES({.resource = draft, .access = SF_ACCESS_STORAGE_READ},
                         {.resource = map, .access = SF_ACCESS_STORAGE_WRITE, .binding = 1}));
    KIT_TRANSFER(graph, "copy",
                 KIT_USES({.resource = map, .access = SF_ACCESS_TRANSFER_READ},
                          {.resource = out, .access = SF_ACCESS_TRANSFER_WRITE}));
    KIT_RASTER(graph, "look again",
               KIT_USES({.resource = map, .access = SF_ACCESS_SAMPLED},
                        {.resource = draft, .access = SF_ACCESS_COLOR, .load = SF_LOAD_CLEAR}),
               .keep = true);
    check_plan(graph, NULL);
}

static void test_sizes(void **state)
{
    struct sf_graph *graph = kit_graph("sizes");
    sf_resource full = sf_graph_image(graph, &(struct sf_image_desc){.name = "full",
                                                                     .format = SF_FORMAT_R32F,
                                                                     .lifetime = SF_PERSISTENT,
                                                                     .size = {.width = 801, .height = 1}});
    sf_resource half = sf_graph_image(graph, &(struct sf_image_desc){.name = "half",
                                                                     .format = SF_FORMAT_R32F,
                                                                     .lifetime = SF_PERSISTENT,
                                                                     .size = {.relative_to = full, .den = 2},
                                                                     .layers = 3});
    sf_resource third =
        sf_graph_image(graph, &(struct sf_image_desc){.name = "two thirds of half",
                                                      .format = SF_FORMAT_R32F,
                                                      .lifetime = SF_PERSISTENT,
                                                      .size = {.relative_to = half, .num = 2, .den = 3}});

    (void)state;
    KIT_COMPUTE(graph, "make",
                KIT_USES({.resource = full, .access = SF_ACCESS_STORAGE_WRITE},
                         {.resource = half, .access = SF_ACCESS_STORAGE_WRITE, .binding = 1},
                         {.resource = third, .access = SF_ACCESS_STORAGE_WRITE, .binding = 2}));
    check_plan(graph, NULL);
}

static void test_empty(void **state)
{
    (void)state;
    check_plan(kit_graph("empty"), NULL);
}

static void test_formats(void **state)
{
    struct sf_graph *graph = chain();
    struct sf_plan *plan, *again;
    struct sf_text text = {0};
    json_error_t error;
    json_t *root;

    (void)state;
    sf_graph_output(graph, sf_graph_find(graph, "frame"));
    plan = kit_plan(graph, NULL);
    sf_plan_print(plan, SF_PLAN_DOT, &text);
    kit_check_golden("graph_chain.dot", text.data);
    sf_text_finish(&text);
    sf_plan_print(plan, SF_PLAN_JSON, &text);
    kit_check_golden("graph_chain.json", text.data);
    root = json_loads(text.data, JSON_REJECT_DUPLICATES, &error);
    if (!root)
        fail_msg("line %d: %s", error.line, error.text);
    assert_int_equal(json_array_size(json_object_get(root, "passes")), 4);
    assert_int_equal(json_array_size(json_object_get(root, "resources")), 4);
    assert_int_equal(json_integer_value(json_object_get(json_object_get(root, "memory"), "transient")),
                     plan->heap_bytes);
    json_decref(root);
    /* The same graph gives the same text. */
    again = kit_plan(graph, NULL);
    struct sf_text second = {0};
    sf_plan_print(again, SF_PLAN_JSON, &second);
    assert_string_equal(text.data, second.data);
    sf_text_finish(&second);
    sf_text_finish(&text);
    sf_plan_destroy(&again);
    sf_plan_destroy(&plan);
    sf_graph_destroy(&graph);
}

/* Names with quotes, backslashes and control characters stay whole. */
static void test_odd_names(void **state)
{
    struct sf_graph *graph = kit_graph("a \"graph\"");
    sf_resource odd = kit_buffer(graph, "back\\slash\tand\n\"quotes\"", SF_PERSISTENT, 4);
    struct sf_plan *plan;
    struct sf_text text = {0};
    json_t *root;

    (void)state;
    KIT_COMPUTE(graph, "p\"q\"", KIT_USES({.resource = odd, .access = SF_ACCESS_STORAGE_WRITE}));
    plan = kit_plan(graph, NULL);
    sf_plan_print(plan, SF_PLAN_JSON, &text);
    root = json_loads(text.data, 0, NULL);
    assert_non_null(root);
    assert_string_equal(
        json_string_value(json_object_get(json_array_get(json_object_get(root, "resources"), 0), "name")),
        "back\\slash\tand\n\"quotes\"");
    json_decref(root);
    sf_text_finish(&text);
    sf_plan_destroy(&plan);
    sf_graph_destroy(&graph);
}

/* Each transient by itself, when asked: nothing is shared. */
static void test_no_alias(void **state)
{
    struct sf_graph *graph = chain();
    struct sf_plan *plan;

    (void)state;
    sf_graph_output(graph, sf_graph_find(graph, "frame"));
    plan = kit_plan(graph, &(struct sf_plan_memory){.no_alias = true});
    assert_int_equal(plan->heap_bytes, plan->unaliased_bytes);
    for (uint32_t r = 0; r < plan->resource_count; r++)
        assert_int_equal(plan->resources[r].alias_of, 0);
    check_hazards(plan, "frame");
    sf_plan_destroy(&plan);
    sf_graph_destroy(&graph);
}

static void test_accessors(void **state)
{
    struct sf_graph *graph = chain();
    char name[] = "copied";
    sf_resource copied = kit_buffer(graph, name, SF_TRANSIENT, 4);

    (void)state;
    name[0] = 'X';
    assert_string_equal(sf_graph_name(graph), "chain");
    assert_int_equal(sf_graph_pass_count(graph), 4);
    assert_string_equal(sf_graph_pass_at(graph, 2)->shader, "blur.comp");
    assert_null(sf_graph_pass_at(graph, 4));
    assert_int_equal(sf_graph_resource_count(graph), 5);
    assert_int_equal(sf_graph_find(graph, "copied"), copied);
    assert_int_equal(sf_graph_find(graph, "nobody"), 0);
    assert_string_equal(sf_graph_image_at(graph, 1)->name, "drawn");
    assert_int_equal(sf_graph_image_at(graph, 1)->layers, 1);
    assert_null(sf_graph_buffer_at(graph, 1));
    assert_null(sf_graph_image_at(graph, copied));
    assert_string_equal(sf_graph_buffer_at(graph, copied)->name, "copied");
    assert_null(sf_graph_image_at(graph, 0));
    assert_null(sf_graph_buffer_at(graph, 6));
    sf_graph_destroy(&graph);
    assert_null(graph);
    sf_graph_destroy(&graph);
    sf_graph_destroy(NULL);
    sf_plan_destroy(NULL);
}

static void test_tables(void **state)
{
    (void)state;
    for (enum sf_access access = SF_ACCESS_SAMPLED; access < SF_ACCESS_COUNT; access++) {
        assert_string_not_equal(sf_access_name(access), "none");
        assert_true(sf_access_reads(access) || sf_access_writes(access));
    }
    for (enum sf_format format = SF_FORMAT_R8_UNORM; format < SF_FORMAT_COUNT; format++) {
        assert_string_not_equal(sf_format_name(format), "none");
        assert_true(sf_format_bytes(format) > 0);
    }
    assert_string_equal(sf_access_name(SF_ACCESS_COUNT), "none");
    assert_string_equal(sf_format_name(SF_FORMAT_COUNT), "none");
    assert_int_equal(sf_format_bytes(SF_FORMAT_RGBA32F), 16);
    assert_int_equal(sf_access_layout(SF_ACCESS_SAMPLED, SF_FORMAT_D32F),
                     sf_access_layout(SF_ACCESS_DEPTH_READ, SF_FORMAT_D32F));
    assert_int_not_equal(sf_access_layout(SF_ACCESS_SAMPLED, SF_FORMAT_R32F),
                         sf_access_layout(SF_ACCESS_STORAGE_READ, SF_FORMAT_R32F));
    assert_int_equal(sf_access_layout(SF_ACCESS_STORAGE_READ, SF_FORMAT_NONE), SF_LAYOUT_NONE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_chain),      cmocka_unit_test(test_diamond),    cmocka_unit_test(test_history),
        cmocka_unit_test(test_aliasing),   cmocka_unit_test(test_culled),     cmocka_unit_test(test_indirect),
        cmocka_unit_test(test_readback),   cmocka_unit_test(test_reuse),      cmocka_unit_test(test_imported),
        cmocka_unit_test(test_depth_read), cmocka_unit_test(test_persistent), cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_empty),      cmocka_unit_test(test_formats),    cmocka_unit_test(test_odd_names),
        cmocka_unit_test(test_no_alias),   cmocka_unit_test(test_accessors),  cmocka_unit_test(test_tables),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
