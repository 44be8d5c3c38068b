/* Misuses of names, resources and uses, one by one. */
#include "graph_misuse.h"

/* ---- names and numbers ---- */

static void no_resource_name(struct parts *p)
{
    kit_buffer(p->graph, NULL, SF_TRANSIENT, 4);
}
static void no_pass_name(struct parts *p)
{
    KIT_COMPUTE(p->graph, "", KIT_USES(WRITE(p->buffer)));
}
static void resource_twice(struct parts *p)
{
    assert_int_equal(kit_buffer(p->graph, "image", SF_TRANSIENT, 4), 0);
}
static void pass_twice(struct parts *p)
{
    KIT_COMPUTE(p->graph, "step", KIT_USES(WRITE(p->buffer)));
}
static void many_uses(struct parts *p)
{
    struct sf_use uses[SF_PASS_USES_MAX + 1] = {{0}};

    KIT_COMPUTE(p->graph, "p", .uses = uses, .use_count = SF_COUNT(uses));
}
static void many_uses_with_indirect(struct parts *p)
{
    struct sf_use uses[SF_PASS_USES_MAX] = {{0}};

    sf_graph_pass(
        p->graph,
        &(struct sf_pass_desc){
            .name = "p", .shader = "a.comp", .uses = uses, .use_count = SF_COUNT(uses), .indirect = p->state});
}
static void many_constants(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES(WRITE(p->buffer)), .constant_count = SF_PASS_CONSTANTS_MAX + 1);
}
static void unknown_resource(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES(WRITE(99)));
}
static void no_resource(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES(WRITE(0)));
}
static void unknown_output(struct parts *p)
{
    sf_graph_output(p->graph, 99);
}
static void unwritten_output(struct parts *p)
{
    sf_graph_output(p->graph, p->image);
}
static void first_error_stays(struct parts *p)
{
    sf_graph_output(p->graph, 99);
    kit_buffer(p->graph, NULL, SF_TRANSIENT, 4);
}

/* ---- resources ---- */

static void image(struct parts *p, struct sf_image_desc desc)
{
    desc.name = "new";
    sf_graph_image(p->graph, &desc);
}
static void no_format(struct parts *p)
{
    image(p, (struct sf_image_desc){.size = {.width = 1, .height = 1}});
}
static void no_size(struct parts *p)
{
    image(p, (struct sf_image_desc){.format = SF_FORMAT_R32F, .size = {.width = 1}});
}
static void huge_size(struct parts *p)
{
    image(p, (struct sf_image_desc){.format = SF_FORMAT_R32F, .size = {.width = 100000, .height = 100000}});
}
static void huge_scale(struct parts *p)
{
    image(p, (struct sf_image_desc){.format = SF_FORMAT_R32F, .size = {.relative_to = p->image, .num = UINT32_MAX}});
}
static void huge_layers(struct parts *p)
{
    image(p, (struct sf_image_desc){.format = SF_FORMAT_R32F, .size = {.width = 1, .height = 1}, .layers = 5000});
}
static void own_size(struct parts *p)
{
    image(p, (struct sf_image_desc){.format = SF_FORMAT_R32F,
                                    .size = {.relative_to = sf_graph_resource_count(p->graph) + 1}});
}
static void unknown_size(struct parts *p)
{
    image(p, (struct sf_image_desc){.format = SF_FORMAT_R32F, .size = {.relative_to = 99}});
}
static void buffer_size(struct parts *p)
{
    image(p, (struct sf_image_desc){.format = SF_FORMAT_R32F, .size = {.relative_to = p->buffer}});
}
static void image_upload(struct parts *p)
{
    image(p,
          (struct sf_image_desc){.format = SF_FORMAT_R32F, .size = {.width = 1, .height = 1}, .lifetime = SF_UPLOAD});
}
static void no_outside(struct parts *p)
{
    image(p,
          (struct sf_image_desc){.format = SF_FORMAT_R32F, .size = {.width = 1, .height = 1}, .lifetime = SF_IMPORTED});
}
static void wrong_outside(struct parts *p)
{
    image(p, (struct sf_image_desc){.format = SF_FORMAT_R32F,
                                    .size = {.width = 1, .height = 1},
                                    .lifetime = SF_IMPORTED,
                                    .outside = SF_ACCESS_UNIFORM});
}
static void needless_outside(struct parts *p)
{
    image(p, (struct sf_image_desc){
                 .format = SF_FORMAT_R32F, .size = {.width = 1, .height = 1}, .outside = SF_ACCESS_SAMPLED});
}
static void bad_lifetime(struct parts *p)
{
    kit_buffer(p->graph, "new", (enum sf_lifetime)77, 4);
}
static void no_bytes(struct parts *p)
{
    kit_buffer(p->graph, "new", SF_TRANSIENT, 0);
}
static void history_flag(struct parts *p)
{
    sf_graph_buffer(p->graph, &(struct sf_buffer_desc){.name = "new", .bytes = 4, .history = true});
}

/* ---- uses ---- */

static void no_access(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES({.resource = p->buffer}));
}
static void host_access(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES({.resource = p->state, .access = SF_ACCESS_HOST_READ}));
}
static void color_in_compute(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES(COLOR(p->image)));
}
static void storage_in_transfer(struct parts *p)
{
    KIT_TRANSFER(p->graph, "p", KIT_USES(READ(p->state), TO(p->readback)));
}
static void sampled_buffer(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES(SAMPLED(p->state)));
}
static void uniform_image(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES({.resource = p->image, .access = SF_ACCESS_UNIFORM}));
}
static void color_format(struct parts *p)
{
    KIT_RASTER(p->graph, "p", KIT_USES(COLOR(p->depth)));
}
static void depth_format(struct parts *p)
{
    KIT_RASTER(p->graph, "p", KIT_USES(DEPTH(p->image)), .raster = {.depth = SF_DEPTH_ALWAYS});
}
static void storage_format(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES(WRITE(p->depth)));
}
static void filtered_integers(struct parts *p)
{
    sf_resource ids = kit_image(p->graph, "ids", SF_FORMAT_R32_UINT, SF_PERSISTENT, SIDE);

    KIT_COMPUTE(p->graph, "p", KIT_USES(SAMPLED(ids, .sampler = SF_SAMPLER_LINEAR)));
}
static void blended_integers(struct parts *p)
{
    sf_resource ids = kit_image(p->graph, "ids", SF_FORMAT_R32_UINT, SF_PERSISTENT, SIDE);

    KIT_RASTER(p->graph, "p", KIT_USES(COLOR(ids)), .raster = {.blend = {SF_BLEND_ADD}});
}
static void clear_storage(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES(WRITE(p->buffer, .load = SF_LOAD_CLEAR)));
}
static void clear_tested(struct parts *p)
{
    KIT_RASTER(p->graph, "p", KIT_USES({.resource = p->depth, .access = SF_ACCESS_DEPTH_READ, .load = SF_LOAD_CLEAR}));
}
static void bad_sampler(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES(SAMPLED(p->history, .previous = true, .sampler = SF_SAMPLER_COUNT)));
}
static void previous_of_transient(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES(SAMPLED(p->image, .previous = true)));
}
static void write_previous(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES(WRITE(p->history, .previous = true)));
}
static void write_upload(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES(WRITE(p->upload)));
}
static void shader_readback(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES(WRITE(p->readback)));
}
static void read_readback(struct parts *p)
{
    KIT_TRANSFER(p->graph, "p", KIT_USES(FROM(p->readback), TO(p->buffer)));
}
static void color_number(struct parts *p)
{
    KIT_RASTER(p->graph, "p", KIT_USES(COLOR(p->image, .binding = SF_PASS_COLORS_MAX)));
}
static void color_twice(struct parts *p)
{
    KIT_RASTER(p->graph, "p", KIT_USES(COLOR(p->image), COLOR(p->history)));
}
static void color_gap(struct parts *p)
{
    KIT_RASTER(p->graph, "p", KIT_USES(COLOR(p->image), COLOR(p->history, .binding = 2)));
}
static void binding_twice(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES(WRITE(p->buffer), READ(p->state)));
}
static void read_and_write(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES(READ(p->state), WRITE(p->state, .binding = 1)));
}
static void two_layouts(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p",
                KIT_USES(SAMPLED(p->history, .previous = true), READ(p->history, .previous = true, .binding = 1)));
}
static void feedback(struct parts *p)
{
    KIT_RASTER(p->graph, "p", KIT_USES(COLOR(p->image), SAMPLED(p->image)));
}
static void indirect_and_write(struct parts *p)
{
    sf_graph_pass(p->graph, &(struct sf_pass_desc){
                                .name = "p", .shader = "a.comp", .indirect = p->state, KIT_USES(MODIFY(p->state))});
}

static const struct misuse misuses[] = {
    {no_resource_name, "buffer ''", "no name", "give it a stable one"},
    {no_pass_name, "pass ''", "no name", "give it a stable one"},
    {resource_twice, "'image'", "name is taken", "its own"},
    {pass_twice, "'step'", "name is taken", "its own"},
    {many_uses, "'p'", "SF_PASS_USES_MAX", "split"},
    {many_uses_with_indirect, "'p'", "`indirect` counted", "split"},
    {many_constants, "'p'", "SF_PASS_CONSTANTS_MAX", "`push`"},
    {unknown_resource, "'p'", "unknown resource (number 99)", "pass what"},
    {no_resource, "'p'", "unknown resource (number 0)", "pass what"},
    {unknown_output, "output", "no resource", "pass what"},
    {unwritten_output, "'image'", "no pass writes", "declare the pass"},
    {first_error_stays, "output", "no resource", "pass what"},
    {no_format, "image 'new'", "format", "use one of"},
    {no_size, "image 'new'", "size is zero", "give width"},
    {huge_size, "image 'new'", "too large", "65536"},
    {huge_scale, "image 'new'", "too large", "65536"},
    {huge_layers, "image 'new'", "too large", "2048"},
    {own_size, "image 'new'", "relative to itself", "name another"},
    {unknown_size, "image 'new'", "unknown resource", "declare that image before"},
    {buffer_size, "image 'new'", "relative to a buffer", "name an image"},
    {image_upload, "image 'new'", "only buffers", "copy between"},
    {no_outside, "image 'new'", "`outside` is missing", "say in which"},
    {wrong_outside, "image 'new'", "does not fit", "say in which"},
    {needless_outside, "image 'new'", "not imported", "leave it out"},
    {bad_lifetime, "buffer 'new'", "lifetime", "enum sf_lifetime"},
    {no_bytes, "buffer 'new'", "size", "from 1"},
    {history_flag, "buffer 'new'", "`history` is for imported", "SF_HISTORY"},
    {no_access, "'p'", "wrong usage of 'buffer'", "access none"},
    {host_access, "'p'", "wrong usage of 'state'", "host_read"},
    {color_in_compute, "'p'", "wrong usage of 'image'", "no compute pass"},
    {storage_in_transfer, "'p'", "wrong usage of 'state'", "no transfer pass"},
    {sampled_buffer, "'p'", "wrong usage of 'state'", "a buffer"},
    {uniform_image, "'p'", "wrong usage of 'image'", "an image"},
    {color_format, "'p'", "'depth' as color", "use the access depth"},
    {depth_format, "'p'", "'image' as depth", "d32f"},
    {storage_format, "'p'", "cannot be a storage image", "sample it"},
    {filtered_integers, "'p'", "'ids' linearly", "SF_SAMPLER_NEAREST"},
    {blended_integers, "'p'", "blends into 'ids'", "SF_BLEND_NONE"},
    {clear_storage, "'p'", "`load` is for", "leave it out"},
    {clear_tested, "'p'", "`load` is for", "leave it out"},
    {bad_sampler, "'p'", "sampler", "enumeration"},
    {previous_of_transient, "'p'", "previous copy of 'image'", "SF_HISTORY"},
    {write_previous, "'p'", "read only", "write the current one"},
    {write_upload, "'p'", "writes 'upload'", "transient"},
    {shader_readback, "'p'", "'readback' as storage_write", "copy into it"},
    {read_readback, "'p'", "'readback' as transfer_read", "copy into it"},
    {color_number, "'p'", "number 4 of 'image'", "SF_PASS_COLORS_MAX"},
    {color_twice, "'p'", "attachment 0 is taken twice", "number them"},
    {color_gap, "'p'", "leave a number out", "number them"},
    {binding_twice, "'p'", "binding 0 is taken twice, by 'buffer' and 'state'", "as the shader does"},
    {read_and_write, "'p'", "'state' conflict: storage_read and storage_write", "use storage_modify"},
    {two_layouts, "'p'", "'history' conflict: sampled and storage_read", "use one of them"},
    {feedback, "'p'", "'image' conflict: color and sampled", "another resource"},
    {indirect_and_write, "'p'", "'state' conflict: storage_modify and indirect", "another resource"},
};

static void test_misuses(void **state)
{
    (void)state;
    check_misuses(misuses, SF_COUNT(misuses));
}

/* The graph to which each case adds its fault is right. */
static void test_right(void **state)
{
    struct parts parts = make_parts();
    struct sf_plan *plan = kit_plan(parts.graph, NULL);

    (void)state;
    assert_int_equal(plan->pass_count, 1);
    sf_plan_destroy(&plan);
    sf_graph_destroy(&parts.graph);
}

/* After an error, declarations give 0 and change nothing; a NULL log is silent. */
static void test_after_error(void **state)
{
    struct parts parts = make_parts();
    struct sf_plan *plan;

    (void)state;
    assert_int_equal(kit_buffer(parts.graph, "image", SF_TRANSIENT, 4), 0);
    assert_int_equal(kit_buffer(parts.graph, "fine", SF_TRANSIENT, 4), 0);
    KIT_COMPUTE(parts.graph, "fine", KIT_USES(WRITE(parts.buffer)));
    assert_int_equal(sf_graph_pass_count(parts.graph), 1);
    assert_int_equal(sf_plan_create(parts.graph, NULL, NULL, &plan), SF_ERROR_INTERNAL);
    assert_null(plan);
    sf_graph_destroy(&parts.graph);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_right),
        cmocka_unit_test(test_misuses),
        cmocka_unit_test(test_after_error),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
