/* Properties of plans, over random graphs: no two live transients share a byte; exactly the passes that outputs need
 * are there; the checker finds no hazard in three plays, and finds one as soon as a barrier, or one touch of a barrier,
 * is left out. */
#include "graph_kit.h"
#include "graph_checker.h"

#include "base/hash.h"
#include "base/thread.h"

enum { GRAPHS = 2000, RESOURCES_MAX = 20, PASSES_MAX = 24, USES_MAX = 6 };

/* ---- random graphs, right by construction ---- */

/* What the passes so far did to a copy. */
struct told {
    bool written, unread; /* the last write was not read */
};

struct maker {
    struct sf_graph *graph;
    uint32_t seed, draws;
    uint32_t count;
    uint32_t window; /* passes mostly touch the resources from here on, so that lives are short */
    bool outputs[RESOURCES_MAX + 2];
    struct told told[RESOURCES_MAX + 2];
    struct {
        bool image, paired;
        enum sf_format format;
        enum sf_lifetime lifetime;
        uint32_t side;
        uint64_t bytes;
    } resources[RESOURCES_MAX + 2];
};

static uint32_t draw(struct maker *maker, uint32_t below)
{
    return sf_random_u32(maker->seed, maker->draws++, 0) % below;
}

static uint32_t draw_resource(struct maker *maker)
{
    return draw(maker, 5) ? (maker->window + draw(maker, 4)) % maker->count : draw(maker, maker->count);
}

static void make_resource(struct maker *maker, uint32_t index)
{
    static const enum sf_format formats[] = {SF_FORMAT_RGBA16F, SF_FORMAT_R32F, SF_FORMAT_RGBA32F, SF_FORMAT_D32F};
    static const enum sf_lifetime lifetimes[] = {SF_TRANSIENT, SF_TRANSIENT, SF_TRANSIENT,  SF_TRANSIENT,
                                                 SF_TRANSIENT, SF_TRANSIENT, SF_PERSISTENT, SF_HISTORY,
                                                 SF_IMPORTED,  SF_UPLOAD,    SF_READBACK};
    static const enum sf_access image_outsides[] = {SF_ACCESS_SAMPLED, SF_ACCESS_STORAGE_READ, SF_ACCESS_TRANSFER_READ,
                                                    SF_ACCESS_PRESENT, SF_ACCESS_COLOR};
    static const enum sf_access buffer_outsides[] = {SF_ACCESS_STORAGE_READ, SF_ACCESS_UNIFORM,
                                                     SF_ACCESS_STORAGE_MODIFY, SF_ACCESS_INDIRECT, SF_ACCESS_HOST_READ};
    enum sf_lifetime lifetime = lifetimes[draw(maker, SF_COUNT(lifetimes))];
    enum sf_format format = formats[draw(maker, SF_COUNT(formats))];
    bool image = draw(maker, 5) < 3 && lifetime != SF_UPLOAD && lifetime != SF_READBACK;
    uint32_t side = 16u << draw(maker, 3);
    uint64_t bytes = 64 + 4 * (uint64_t)draw(maker, 20000);
    bool pair = draw(maker, 2);
    char name[16];

    snprintf(name, sizeof name, "r%u", index);
    if (format == SF_FORMAT_D32F && lifetime == SF_IMPORTED)
        format = SF_FORMAT_R32F;
    if (image)
        sf_graph_image(maker->graph,
                       &(struct sf_image_desc){
                           .name = name,
                           .format = format,
                           .lifetime = lifetime,
                           .size = {.width = side, .height = side},
                           .outside = lifetime == SF_IMPORTED ? image_outsides[draw(maker, 5)] : SF_ACCESS_NONE,
                       });
    else
        sf_graph_buffer(maker->graph,
                        &(struct sf_buffer_desc){
                            .name = name,
                            .lifetime = lifetime,
                            .bytes = bytes,
                            .outside = lifetime == SF_IMPORTED ? buffer_outsides[draw(maker, 5)] : SF_ACCESS_NONE,
                            .history = lifetime == SF_IMPORTED && pair,
                        });
    maker->resources[index].image = image;
    maker->resources[index].paired = lifetime == SF_HISTORY || (lifetime == SF_IMPORTED && !image && pair);
    maker->resources[index].format = image ? format : SF_FORMAT_NONE;
    maker->resources[index].lifetime = lifetime;
    maker->resources[index].side = side;
    maker->resources[index].bytes = image ? (uint64_t)side * side * sf_format_bytes(format) : bytes;
}

static bool may_read(const struct maker *maker, uint32_t index)
{
    enum sf_lifetime lifetime = maker->resources[index].lifetime;

    if (lifetime == SF_READBACK)
        return false;
    return maker->told[index].written || lifetime == SF_PERSISTENT || lifetime == SF_IMPORTED || lifetime == SF_UPLOAD;
}

static bool may_overwrite(const struct maker *maker, uint32_t index)
{
    return maker->resources[index].lifetime != SF_UPLOAD && !maker->told[index].unread;
}

static bool is_fill(enum sf_access access)
{
    return access == SF_ACCESS_STORAGE_WRITE || access == SF_ACCESS_TRANSFER_WRITE;
}

/* One random use of a shader pass, or false when the draw does not fit. `taken[i]`: 1 read, 2 written; images by their
 * layout. */
static bool make_use(struct maker *maker, enum sf_pass_kind kind, uint32_t *side, uint32_t number, uint32_t *colors,
                     bool *depth, struct sf_use *uses, struct sf_use *use)
{
    static const enum sf_access accesses[] = {SF_ACCESS_SAMPLED,       SF_ACCESS_UNIFORM,        SF_ACCESS_STORAGE_READ,
                                              SF_ACCESS_STORAGE_WRITE, SF_ACCESS_STORAGE_MODIFY, SF_ACCESS_INDIRECT,
                                              SF_ACCESS_COLOR,         SF_ACCESS_COLOR,          SF_ACCESS_DEPTH,
                                              SF_ACCESS_DEPTH_READ};
    uint32_t index = draw_resource(maker);
    enum sf_access access = accesses[draw(maker, SF_COUNT(accesses))];
    enum sf_format format = maker->resources[index].format;
    bool image = maker->resources[index].image, is_depth = format == SF_FORMAT_D32F;
    bool attaches = access == SF_ACCESS_COLOR || access == SF_ACCESS_DEPTH || access == SF_ACCESS_DEPTH_READ;

    *use = (struct sf_use){.resource = index + 1, .access = access, .binding = number};
    use->previous =
        maker->resources[index].paired && !sf_access_writes(access) && access != SF_ACCESS_INDIRECT && draw(maker, 2);
    use->load = access == SF_ACCESS_COLOR || access == SF_ACCESS_DEPTH ? (enum sf_load)draw(maker, 3) : SF_LOAD_KEEP;
    if (maker->resources[index].lifetime == SF_READBACK)
        return false;
    if (image ? access == SF_ACCESS_UNIFORM || access == SF_ACCESS_INDIRECT : access == SF_ACCESS_SAMPLED || attaches)
        return false;
    if (is_depth ? access == SF_ACCESS_COLOR || sf_access_layout(access, format) == SF_LAYOUT_GENERAL
                 : access == SF_ACCESS_DEPTH || access == SF_ACCESS_DEPTH_READ)
        return false;
    if (attaches && (kind != SF_PASS_RASTER || (*side && *side != maker->resources[index].side)))
        return false;
    if (attaches && (access == SF_ACCESS_COLOR ? *colors == SF_PASS_COLORS_MAX : *depth))
        return false;
    for (uint32_t i = 0; i < number; i++)
        if (uses[i].resource == use->resource && uses[i].previous == use->previous &&
            (sf_access_writes(access) || sf_access_writes(uses[i].access) ||
             sf_access_layout(access, format) != sf_access_layout(uses[i].access, format)))
            return false;
    if (is_fill(access) || use->load != SF_LOAD_KEEP ? !may_overwrite(maker, index)
                                                     : !use->previous && !may_read(maker, index))
        return false;
    if (sf_access_writes(access) && maker->resources[index].lifetime == SF_UPLOAD)
        return false;
    if (attaches)
        *side = maker->resources[index].side;
    if (access == SF_ACCESS_COLOR)
        use->binding = (*colors)++;
    else if (attaches)
        *depth = true;
    return true;
}

/* Tells of the uses of one pass, all at once. */
static void tell(struct maker *maker, const struct sf_use *uses, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        struct told *told = &maker->told[uses[i].resource - 1];
        bool overwrites = is_fill(uses[i].access) || uses[i].load != SF_LOAD_KEEP;

        if (uses[i].previous)
            continue;
        if (!overwrites)
            told->unread = false;
        if (sf_access_writes(uses[i].access)) {
            told->written = true;
            told->unread = true;
        }
    }
}

static void make_shader_pass(struct maker *maker, const char *name)
{
    enum sf_pass_kind kind = draw(maker, 2) ? SF_PASS_RASTER : SF_PASS_COMPUTE;
    uint32_t wanted = 1 + draw(maker, USES_MAX - 1), count = 0, side = 0, colors = 0;
    struct sf_use uses[USES_MAX];
    struct sf_pass_desc pass = {.name = name, .kind = kind, .shader = "s", .uses = uses, .keep = draw(maker, 10) == 0};
    bool depth = false;

    for (int tries = 0; tries < 60 && count < wanted; tries++)
        if (make_use(maker, kind, &side, count, &colors, &depth, uses, &uses[count]))
            count++;
    if (kind == SF_PASS_RASTER && !side)
        return;
    pass.use_count = count;
    if (kind == SF_PASS_RASTER) {
        pass.vertices = 3;
        pass.instances = 1;
        pass.raster.depth = depth ? SF_DEPTH_GREATER_EQUAL : SF_DEPTH_OFF;
    } else {
        pass.groups[0] = pass.groups[1] = pass.groups[2] = 1;
    }
    tell(maker, uses, count);
    /* Now and then the arguments come from a buffer that the pass already reads, or reads not at all. */
    for (uint32_t index = draw(maker, maker->count); index < maker->count && draw(maker, 3) == 0; index++) {
        bool free_to_read = !maker->resources[index].image && may_read(maker, index);

        for (uint32_t i = 0; i < count; i++)
            free_to_read = free_to_read && !(uses[i].resource == index + 1 && sf_access_writes(uses[i].access));
        if (!free_to_read)
            continue;
        pass.indirect = index + 1;
        pass.vertices = pass.instances = pass.groups[0] = pass.groups[1] = pass.groups[2] = 0;
        tell(maker, &(struct sf_use){.resource = index + 1, .access = SF_ACCESS_INDIRECT}, 1);
        break;
    }
    sf_graph_pass(maker->graph, &pass);
}

static void make_transfer(struct maker *maker, const char *name)
{
    uint32_t to = draw_resource(maker), from = draw_resource(maker);
    struct sf_use uses[2] = {{.resource = from + 1, .access = SF_ACCESS_TRANSFER_READ},
                             {.resource = to + 1, .access = SF_ACCESS_TRANSFER_WRITE}};
    struct sf_pass_desc pass = {.name = name, .kind = SF_PASS_TRANSFER, .uses = uses, .use_count = 2};
    bool images = maker->resources[to].image && maker->resources[from].image;

    if (!may_overwrite(maker, to))
        return;
    if (!maker->resources[to].image && draw(maker, 2)) {
        pass.transfer = SF_TRANSFER_FILL;
        pass.uses = &uses[1];
        pass.use_count = 1;
    } else {
        uses[0].previous = maker->resources[from].paired && draw(maker, 2);
        if ((to == from && !uses[0].previous) || (!uses[0].previous && !may_read(maker, from)))
            return;
        if (maker->resources[from].lifetime == SF_READBACK)
            return;
        if (images && (maker->resources[to].side != maker->resources[from].side ||
                       maker->resources[to].format != maker->resources[from].format))
            return;
        if (maker->resources[to].image ? maker->resources[from].bytes < maker->resources[to].bytes
                                       : maker->resources[from].bytes > maker->resources[to].bytes)
            return;
    }
    tell(maker, pass.uses, pass.use_count);
    sf_graph_pass(maker->graph, &pass);
}

/* State that was read but never written is written at the end. */
static void write_state(struct maker *maker)
{
    for (uint32_t i = 0; i < maker->count; i++) {
        enum sf_lifetime lifetime = maker->resources[i].lifetime;
        bool is_depth = maker->resources[i].format == SF_FORMAT_D32F;
        struct sf_use use = {.resource = i + 1,
                             .access = is_depth ? SF_ACCESS_DEPTH : SF_ACCESS_STORAGE_WRITE,
                             .load = is_depth ? SF_LOAD_CLEAR : SF_LOAD_KEEP};
        char name[16];

        if (maker->told[i].written || (lifetime != SF_PERSISTENT && lifetime != SF_HISTORY))
            continue;
        snprintf(name, sizeof name, "w%u", i);
        if (is_depth)
            KIT_RASTER(maker->graph, name, .uses = &use, .use_count = 1, .raster = {.depth = SF_DEPTH_ALWAYS});
        else
            KIT_COMPUTE(maker->graph, name, .uses = &use, .use_count = 1);
        tell(maker, &use, 1);
    }
}

static void make_graph(struct maker *maker, uint32_t seed)
{
    uint32_t passes;
    char name[16];

    *maker = (struct maker){.graph = kit_graph("random"), .seed = seed};
    maker->count = 3 + draw(maker, RESOURCES_MAX - 3);
    for (uint32_t i = 0; i < maker->count; i++)
        make_resource(maker, i);
    passes = 2 + draw(maker, PASSES_MAX - 2);
    /* Some draws fit nothing and add no pass. */
    for (uint32_t p = 0; p < passes * 4 && sf_graph_pass_count(maker->graph) < passes; p++) {
        snprintf(name, sizeof name, "p%u", p);
        maker->window = sf_graph_pass_count(maker->graph) * maker->count / passes;
        if (draw(maker, 4))
            make_shader_pass(maker, name);
        else
            make_transfer(maker, name);
    }
    write_state(maker);
    for (uint32_t i = 0; i < maker->count; i++)
        if (maker->told[i].written && draw(maker, 8) == 0) {
            sf_graph_output(maker->graph, i + 1);
            maker->outputs[i] = true;
        }
}

/* ---- properties ---- */

static void odd_needs(void *user, const struct sf_plan_resource *resource, uint64_t *size, uint64_t *alignment)
{
    uint32_t bits = sf_hash_u32((uint32_t)resource->bytes + *(uint32_t *)user);

    assert_true(resource->used);
    assert_true(resource->usage != 0);
    *alignment = UINT64_C(1) << bits % 17;
    *size = resource->bytes + bits % 1000;
}

static void check_memory(const struct sf_plan *plan, bool no_alias)
{
    uint64_t highest = 0, total = 0, crowd = 0;

    for (uint32_t i = 0; i < plan->resource_count; i++) {
        const struct sf_plan_resource *a = &plan->resources[i];

        if (!a->used || a->lifetime != SF_TRANSIENT)
            continue;
        assert_true(a->size >= a->bytes);
        assert_true(a->first <= a->last && a->last < plan->pass_count);
        assert_int_equal(a->offset % a->alignment, 0);
        total += a->size;
        if (a->offset + a->size > highest)
            highest = a->offset + a->size;
        for (uint32_t j = 0; j < i; j++) {
            const struct sf_plan_resource *b = &plan->resources[j];
            bool alive_together = a->first <= b->last && b->first <= a->last;
            bool bytes_shared = a->offset < b->offset + b->size && b->offset < a->offset + a->size;

            if (b->used && b->lifetime == SF_TRANSIENT)
                assert_false(bytes_shared && (alive_together || no_alias));
        }
        if (a->alias_of) {
            const struct sf_plan_resource *b = &plan->resources[a->alias_of - 1];

            assert_true(b->last < a->first);
            assert_true(a->offset < b->offset + b->size && b->offset < a->offset + a->size);
        }
    }
    assert_int_equal(plan->heap_bytes, highest);
    assert_true(plan->unaliased_bytes >= total);
    /* No plan can do with less than the fullest pass holds. */
    for (uint32_t p = 0; p < plan->pass_count; p++) {
        uint64_t held = 0;

        for (uint32_t i = 0; i < plan->resource_count; i++)
            if (plan->resources[i].used && plan->resources[i].lifetime == SF_TRANSIENT &&
                plan->resources[i].first <= p && p <= plan->resources[i].last)
                held += plan->resources[i].size;
        crowd = held > crowd ? held : crowd;
    }
    assert_true(plan->heap_bytes >= crowd);
}

/* Which passes live, said the other way round: forwards, each pass remembers who wrote what it reads; then from the
 * ends back. */
static void check_culling(const struct maker *maker, const struct sf_plan *plan)
{
    enum { MOST = PASSES_MAX + RESOURCES_MAX + 2 };
    static bool needs[MOST][MOST], makers[(RESOURCES_MAX + 2) * 2][MOST];
    bool live[MOST] = {false}, changed = true;
    uint32_t count = sf_graph_pass_count(maker->graph), found = 0;

    memset(needs, 0, sizeof needs);
    memset(makers, 0, sizeof makers);
    for (uint32_t p = 0; p < count; p++) {
        const struct sf_pass_desc *pass = sf_graph_pass_at(maker->graph, p);

        live[p] = pass->keep;
        for (uint32_t u = 0; u <= pass->use_count; u++) {
            struct sf_use use = {.resource = pass->indirect, .access = SF_ACCESS_INDIRECT};
            bool *set, overwrites;

            if (u < pass->use_count)
                use = pass->uses[u];
            else if (!pass->indirect)
                break;
            set = makers[(use.resource - 1) * 2 + use.previous];
            overwrites = is_fill(use.access) || use.load != SF_LOAD_KEEP;
            for (uint32_t w = 0; w < count && !overwrites; w++)
                needs[p][w] = needs[p][w] || set[w];
            if (overwrites)
                memset(set, 0, sizeof makers[0]);
            if (sf_access_writes(use.access))
                set[p] = true;
        }
    }
    for (uint32_t i = 0; i < maker->count; i++)
        for (uint32_t w = 0; w < count; w++)
            if (makers[i * 2][w] && (maker->outputs[i] || maker->resources[i].lifetime != SF_TRANSIENT))
                live[w] = true;
    while (changed) {
        changed = false;
        for (uint32_t p = 0; p < count; p++)
            for (uint32_t w = 0; w < count && live[p]; w++)
                if (needs[p][w] && !live[w])
                    live[w] = changed = true;
    }
    for (uint32_t p = 0; p < count; p++) {
        if (!live[p])
            continue;
        assert_true(found < plan->pass_count);
        assert_int_equal(plan->passes[found++].index, p);
    }
    assert_int_equal(found, plan->pass_count);
    assert_int_equal(plan->culled_count, count - found);
}

static void check_drop(const struct maker *maker, const struct sf_plan *plan, struct checker_drop drop, uint32_t seed,
                       const char *what)
{
    char problem[256];

    if (checker_run(plan, maker->outputs, drop, problem)) {
        struct sf_text text = {0};

        sf_plan_print(plan, SF_PLAN_TEXT, &text);
        fputs(text.data, stdout);
        sf_text_finish(&text);
        fail_msg("seed %u: nobody misses %s of barrier %u of %s", seed, what, drop.barrier,
                 plan->resources[checker_barrier_at(plan, drop.barrier)->resource - 1].name);
    }
}

static uint32_t check_hazards(const struct maker *maker, const struct sf_plan *plan, uint32_t seed)
{
    uint32_t barriers = checker_barrier_count(plan);
    char problem[256];

    if (!checker_run(plan, maker->outputs,
                     (struct checker_drop){CHECKER_DROP_NONE, CHECKER_DROP_NONE, CHECKER_DROP_NONE}, problem)) {
        struct sf_text text = {0};

        sf_plan_print(plan, SF_PLAN_TEXT, &text);
        fputs(text.data, stdout);
        sf_text_finish(&text);
        fail_msg("seed %u: %s", seed, problem);
    }
    for (uint32_t b = 0; b < barriers; b++) {
        const struct sf_plan_barrier *barrier = checker_barrier_at(plan, b);

        check_drop(maker, plan, (struct checker_drop){b, CHECKER_DROP_NONE, CHECKER_DROP_NONE}, seed, "all");
        /* Outside may do any of several touches, which stand for one another; so there only the whole counts. */
        if (plan->resources[barrier->resource - 1].lifetime == SF_IMPORTED)
            continue;
        for (uint32_t i = 0; i < barrier->before_count; i++)
            check_drop(maker, plan, (struct checker_drop){b, i, CHECKER_DROP_NONE}, seed, "a touch before");
        for (uint32_t i = 0; i < barrier->after_count; i++)
            check_drop(maker, plan, (struct checker_drop){b, CHECKER_DROP_NONE, i}, seed, "a touch after");
    }
    return barriers;
}

static void test_random(void **state)
{
    uint64_t heap = 0, unaliased = 0;
    uint32_t passes = 0, culled = 0, barriers = 0, uses = 0;

    (void)state;
    for (uint32_t seed = 0; seed < GRAPHS; seed++) {
        struct maker maker;
        struct sf_plan_memory memory = {seed % 3 ? NULL : odd_needs, &seed, seed % 16 == 5};
        struct sf_plan *plan;

        make_graph(&maker, seed);
        plan = kit_plan(maker.graph, &memory);
        check_memory(plan, memory.no_alias);
        check_culling(&maker, plan);
        barriers += check_hazards(&maker, plan, seed);
        heap += plan->heap_bytes;
        unaliased += plan->unaliased_bytes;
        passes += plan->pass_count;
        culled += plan->culled_count;
        for (uint32_t p = 0; p < plan->pass_count; p++)
            uses += plan->passes[p].use_count;
        sf_plan_destroy(&plan);
        sf_graph_destroy(&maker.graph);
    }
    print_message(
        "%d graphs: %u passes, %u culled, %u uses, %u barriers; transient memory %.0f%% of that without sharing\n",
        GRAPHS, passes, culled, uses, barriers, 100.0 * (double)heap / (double)unaliased);
    /* The draw is rich enough to mean something. */
    assert_true(passes > GRAPHS * 4 && culled > GRAPHS / 4 && barriers > passes && heap < unaliased);
}

/* ---- time ---- */

/* Thirty passes, each reading three images of those before, as a frame does. */
static void test_compile_time(void **state)
{
    enum { PASSES = 30, ROUNDS = 200 };
    struct sf_graph *graph = kit_graph("thirty");
    sf_resource images[PASSES];
    char names[PASSES][2][16];
    uint64_t best = UINT64_MAX;

    (void)state;
    for (uint32_t i = 0; i < PASSES; i++) {
        struct sf_use uses[4];
        uint32_t count = 0;

        snprintf(names[i][0], sizeof names[i][0], "image %u", i);
        snprintf(names[i][1], sizeof names[i][1], "pass %u", i);
        images[i] =
            kit_image(graph, names[i][0], SF_FORMAT_RGBA16F, i % 7 ? SF_TRANSIENT : SF_HISTORY, 256 + 64 * (i % 3));
        uses[count++] = (struct sf_use){.resource = images[i], .access = SF_ACCESS_STORAGE_WRITE};
        for (uint32_t back = 1; back <= 3 && back <= i; back++, count++)
            uses[count] = (struct sf_use){.resource = images[i - back], .access = SF_ACCESS_SAMPLED, .binding = back};
        KIT_COMPUTE(graph, names[i][1], .uses = uses, .use_count = count);
    }
    sf_graph_output(graph, images[PASSES - 1]);
    for (int round = 0; round < ROUNDS; round++) {
        uint64_t start = sf_clock_ns(), time;
        struct sf_plan *plan = kit_plan(graph, NULL);

        time = sf_clock_ns() - start;
        best = time < best ? time : best;
        assert_int_equal(plan->pass_count, PASSES);
        sf_plan_destroy(&plan);
    }
    print_message("compiling %d passes takes %.1f microseconds\n", PASSES, (double)best / 1e3);
    assert_true(best < 1000000);
    sf_graph_destroy(&graph);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random),
        cmocka_unit_test(test_compile_time),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
