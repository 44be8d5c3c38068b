/* Misuses of a pass's attachments, work and transfers, and of the order of passes, one by one. */
#include "graph_misuse.h"

/* ---- attachments ---- */

static void no_attachment(struct parts *p)
{
    KIT_RASTER(p->graph, "p", KIT_USES(WRITE(p->buffer)));
}
static void unequal_attachments(struct parts *p)
{
    sf_resource small = kit_image(p->graph, "small", SF_FORMAT_R32F, SF_TRANSIENT, SIDE / 2);

    KIT_RASTER(p->graph, "p", KIT_USES(COLOR(p->image), COLOR(small, .binding = 1)));
}
static void layered_attachment(struct parts *p)
{
    KIT_RASTER(p->graph, "p", KIT_USES(COLOR(p->layered)));
}
static void two_depths(struct parts *p)
{
    sf_resource second = kit_image(p->graph, "second", SF_FORMAT_D32F, SF_TRANSIENT, SIDE);

    KIT_RASTER(p->graph, "p", KIT_USES(DEPTH(p->depth), DEPTH(second)), .raster = {.depth = SF_DEPTH_ALWAYS});
}
static void depth_without_test(struct parts *p)
{
    KIT_RASTER(p->graph, "p", KIT_USES(DEPTH(p->depth)));
}
static void test_without_depth(struct parts *p)
{
    KIT_RASTER(p->graph, "p", KIT_USES(COLOR(p->image)), .raster = {.depth = SF_DEPTH_ALWAYS});
}

/* ---- shaders and work ---- */

static void bad_kind(struct parts *p)
{
    sf_graph_pass(p->graph, &(struct sf_pass_desc){.name = "p", .kind = (enum sf_pass_kind)9});
}
static void no_shader(struct parts *p)
{
    sf_graph_pass(p->graph, &(struct sf_pass_desc){.name = "p", .groups = {1, 1, 1}});
}
static void fragment_in_compute(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES(WRITE(p->buffer)), .fragment = "a.frag");
}
static void push_too_long(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES(WRITE(p->buffer)), .push = p, .push_bytes = SF_PUSH_BYTES_MAX + 4);
}
static void push_odd(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES(WRITE(p->buffer)), .push = p, .push_bytes = 3);
}
static void push_nothing(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES(WRITE(p->buffer)), .push_bytes = 4);
}
static void no_work(struct parts *p)
{
    sf_graph_pass(p->graph, &(struct sf_pass_desc){.name = "p", .shader = "a.comp", KIT_USES(WRITE(p->buffer))});
}
static void work_twice(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES(WRITE(p->buffer)), .domain = p->image, .local = {8, 8});
}
static void zero_groups(struct parts *p)
{
    sf_graph_pass(p->graph, &(struct sf_pass_desc){
                                .name = "p", .shader = "a.comp", .groups = {1, 1, 0}, KIT_USES(WRITE(p->buffer))});
}
static void vertices_in_compute(struct parts *p)
{
    sf_graph_pass(p->graph,
                  &(struct sf_pass_desc){.name = "p", .shader = "a.comp", .vertices = 3, KIT_USES(WRITE(p->buffer))});
}
static void groups_in_raster(struct parts *p)
{
    sf_graph_pass(
        p->graph,
        &(struct sf_pass_desc){
            .name = "p", .kind = SF_PASS_RASTER, .shader = "a.vert", .groups = {1, 1, 1}, KIT_USES(COLOR(p->image))});
}
static void no_instances(struct parts *p)
{
    sf_graph_pass(
        p->graph,
        &(struct sf_pass_desc){
            .name = "p", .kind = SF_PASS_RASTER, .shader = "a.vert", .vertices = 3, KIT_USES(COLOR(p->image))});
}
static void domain_buffer(struct parts *p)
{
    sf_graph_pass(
        p->graph,
        &(struct sf_pass_desc){
            .name = "p", .shader = "a.comp", .domain = p->buffer, .local = {8, 8}, KIT_USES(WRITE(p->buffer))});
}
static void domain_local(struct parts *p)
{
    sf_graph_pass(
        p->graph,
        &(struct sf_pass_desc){
            .name = "p", .shader = "a.comp", .domain = p->image, .local = {8, 0}, KIT_USES(WRITE(p->buffer))});
}
static void indirect_unknown(struct parts *p)
{
    sf_graph_pass(p->graph,
                  &(struct sf_pass_desc){.name = "p", .shader = "a.comp", .indirect = 99, KIT_USES(WRITE(p->buffer))});
}
static void indirect_image(struct parts *p)
{
    sf_graph_pass(p->graph, &(struct sf_pass_desc){
                                .name = "p", .shader = "a.comp", .indirect = p->image, KIT_USES(WRITE(p->buffer))});
}
static void indirect_end(struct parts *p)
{
    sf_graph_pass(
        p->graph,
        &(struct sf_pass_desc){
            .name = "p", .shader = "a.comp", .indirect = p->state, .indirect_offset = 56, KIT_USES(WRITE(p->buffer))});
}
static void indirect_odd(struct parts *p)
{
    sf_graph_pass(
        p->graph,
        &(struct sf_pass_desc){
            .name = "p", .shader = "a.comp", .indirect = p->state, .indirect_offset = 2, KIT_USES(WRITE(p->buffer))});
}
static void coverage(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES(WRITE(p->buffer)), .coverage = 1.5f);
}

/* ---- transfers ---- */

static void transfer_shader(struct parts *p)
{
    KIT_TRANSFER(p->graph, "p", KIT_USES(FROM(p->state), TO(p->readback)), .shader = "a.comp");
}
static void copy_order(struct parts *p)
{
    KIT_TRANSFER(p->graph, "p", KIT_USES(TO(p->readback), FROM(p->state)));
}
static void copy_sizes(struct parts *p)
{
    KIT_TRANSFER(p->graph, "p", KIT_USES(FROM(p->history), TO(p->layered)));
}
static void copy_formats(struct parts *p)
{
    sf_resource other = kit_image(p->graph, "other", SF_FORMAT_R32F, SF_TRANSIENT, SIDE);

    KIT_TRANSFER(p->graph, "p", KIT_USES(FROM(p->history), TO(other)));
}
static void copy_depth(struct parts *p)
{
    sf_resource other = kit_image(p->graph, "other", SF_FORMAT_R32F, SF_TRANSIENT, SIDE);

    KIT_TRANSFER(p->graph, "p", KIT_USES(FROM(p->depth), TO(other)));
}
static void copy_small_target(struct parts *p)
{
    KIT_TRANSFER(p->graph, "p", KIT_USES(FROM(p->history), TO(p->readback)));
}
static void front_of_image(struct parts *p)
{
    KIT_TRANSFER(p->graph, "p", KIT_USES(FROM(p->image), TO(p->readback)), .transfer = SF_TRANSFER_FRONT);
}
static void copy_small_source(struct parts *p)
{
    KIT_TRANSFER(p->graph, "p", KIT_USES(FROM(p->upload), TO(p->image)));
}
static void bad_transfer(struct parts *p)
{
    KIT_TRANSFER(p->graph, "p", KIT_USES(TO(p->buffer)), .transfer = (enum sf_transfer)5);
}
static void fill_two(struct parts *p)
{
    KIT_TRANSFER(p->graph, "p", KIT_USES(TO(p->buffer), TO(p->state)), .transfer = SF_TRANSFER_FILL);
}
static void fill_image(struct parts *p)
{
    KIT_TRANSFER(p->graph, "p", KIT_USES(TO(p->image)), .transfer = SF_TRANSFER_FILL);
}
static void fill_odd(struct parts *p)
{
    sf_resource odd = kit_buffer(p->graph, "odd", SF_TRANSIENT, 5);

    KIT_TRANSFER(p->graph, "p", KIT_USES(TO(odd)), .transfer = SF_TRANSFER_FILL);
}

/* ---- order ---- */

static void read_first(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES(SAMPLED(p->image)));
    KIT_COMPUTE(p->graph, "later", KIT_USES(WRITE(p->image)));
}
static void modify_first(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES(MODIFY(p->buffer)));
}
static void keep_first(struct parts *p)
{
    KIT_RASTER(p->graph, "p", KIT_USES({.resource = p->image, .access = SF_ACCESS_COLOR}));
}
static void indirect_first(struct parts *p)
{
    sf_graph_pass(p->graph, &(struct sf_pass_desc){
                                .name = "p", .shader = "a.comp", .indirect = p->buffer, KIT_USES(MODIFY(p->state))});
}
static void read_current_history(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES(SAMPLED(p->history)));
}
static void never_written_history(struct parts *p)
{
    KIT_COMPUTE(p->graph, "p", KIT_USES(SAMPLED(p->history, .previous = true)));
}
static void never_written_state(struct parts *p)
{
    sf_resource zeros = kit_buffer(p->graph, "zeros", SF_PERSISTENT, 4);

    KIT_COMPUTE(p->graph, "p", KIT_USES(READ(zeros)));
}
static void two_writers(struct parts *p)
{
    KIT_COMPUTE(p->graph, "first", KIT_USES(WRITE(p->buffer)));
    KIT_COMPUTE(p->graph, "p", KIT_USES(WRITE(p->buffer)));
}
static void clear_over(struct parts *p)
{
    KIT_COMPUTE(p->graph, "first", KIT_USES(WRITE(p->image)));
    KIT_RASTER(p->graph, "p", KIT_USES(COLOR(p->image)));
}
static void clear_over_modified(struct parts *p)
{
    KIT_COMPUTE(p->graph, "first", KIT_USES(MODIFY(p->state)));
    KIT_COMPUTE(p->graph, "second", KIT_USES(MODIFY(p->state)));
    KIT_TRANSFER(p->graph, "p", KIT_USES(TO(p->state)), .transfer = SF_TRANSFER_FILL);
}

static const struct misuse misuses[] = {
    {no_attachment, "'p'", "no attachment", "give it"},
    {unequal_attachments, "'p'", "'image' is 64 x 64, 'small' is 32 x 32", "make them equal"},
    {layered_attachment, "'p'", "'layered', which has 2 layers", "side by side"},
    {two_depths, "'p'", "2 depth attachments", "one"},
    {depth_without_test, "'p'", "depth test is off", "raster.depth"},
    {test_without_depth, "'p'", "no depth attachment", "SF_DEPTH_OFF"},
    {bad_kind, "'p'", "kind", "enum sf_pass_kind"},
    {no_shader, "'p'", "no shader", "under glsl/"},
    {fragment_in_compute, "'p'", "fragment shader", "leave it out"},
    {push_too_long, "'p'", "132 bytes", "uniform buffer"},
    {push_odd, "'p'", "3 bytes", "words of 4"},
    {push_nothing, "'p'", "do not agree", "both or neither"},
    {no_work, "'p'", "nowhere", "give one of"},
    {work_twice, "'p'", "twice", "give one of"},
    {zero_groups, "'p'", "1 x 1 x 0", "at least 1"},
    {vertices_in_compute, "'p'", "compute pass with vertices", "give groups"},
    {groups_in_raster, "'p'", "raster pass with groups", "give vertices"},
    {no_instances, "'p'", "3 vertices x 0 instances", "at least 1"},
    {domain_buffer, "'p'", "domain is not an image", "sf_graph_image"},
    {domain_local, "'p'", "local is 0", "say how many"},
    {indirect_unknown, "'p'", "`indirect` is an unknown resource", "sf_graph_buffer"},
    {indirect_image, "'p'", "'image': it is an image", "indirect"},
    {indirect_end, "'p'", "do not lie in 'state'", "12 bytes"},
    {indirect_odd, "'p'", "do not lie in 'state'", "multiple of 4"},
    {coverage, "'p'", "coverage", "0..1"},
    {transfer_shader, "'p'", "transfer with a shader", "leave them out"},
    {copy_order, "'p'", "two uses", "transfer_read and then"},
    {copy_sizes, "'p'", "(64 x 64 x 1) to 'layered' (64 x 64 x 2)", "make them equal"},
    {copy_formats, "'p'", "(rgba16f) to 'other' (r32f)", "of one size"},
    {copy_depth, "'p'", "(d32f) to 'other' (r32f)", "depth goes to depth"},
    {copy_small_target, "'p'", "'readback', which is smaller", "at least as large"},
    {front_of_image, "'p'", "the front of 'image'", "SF_TRANSFER_COPY"},
    {copy_small_source, "'p'", "does not hold the whole image", "larger"},
    {bad_transfer, "'p'", "transfer", "enum sf_transfer"},
    {fill_two, "'p'", "fill", "one use"},
    {fill_image, "'p'", "fills 'image'", "only buffers"},
    {fill_odd, "'p'", "fills 'odd'", "multiple of 4"},
    {read_first, "'p'", "reads 'image' before any pass writes it", "earlier"},
    {modify_first, "'p'", "reads 'buffer' before any pass writes it", "fill it first"},
    {keep_first, "'p'", "reads 'image' before any pass writes it", "clear"},
    {indirect_first, "'p'", "reads 'buffer' before any pass writes it (indirect", "earlier"},
    {read_current_history, "'p'", "reads 'history' before any pass writes it", "previous copy"},
    {never_written_history, "'p'", "reads 'history', which no pass ever writes", "import it"},
    {never_written_state, "'p'", "reads 'zeros', which no pass ever writes", "import it"},
    {two_writers, "'buffer' has two writers", "pass 'p' replaces all that pass 'first' wrote", "drop one"},
    {clear_over, "'image' has two writers", "pass 'p' replaces all that pass 'first' wrote", "SF_LOAD_KEEP"},
    {clear_over_modified, "'state' has two writers", "pass 'p' replaces all that pass 'second' wrote", "read between"},
};

static void test_misuses(void **state)
{
    (void)state;
    check_misuses(misuses, SF_COUNT(misuses));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_misuses),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
