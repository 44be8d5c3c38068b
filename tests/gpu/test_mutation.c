/* Leaves barriers out, one at a time, and wants each to be missed: by the validation layers, which see the recorded
 * commands, and by the checker of tests/cpu, which sees the plan.
 *
 * The plans are those of every scene in scenes/tiny: the simulation's step, the shadow map, the frame. Each barrier is
 * tried in two ways, the second only when the first shows nothing:
 *
 * - as the program plays them: one frame a submit, transients sharing memory;
 * - two frames a submit, so that the seam between two plays lies within what the layers look at (they do not look
 * across submits), and each transient in memory of its own: to the layers an image and a buffer in the same memory are
 *   strangers, and of a chain of barriers from one to the other they see only parts.
 *
 * What the layers are blind to even so is listed with the reason, which `blind_spot` reads off the plan; a barrier that
 * goes unnoticed without one fails the test. The checker has no such excuse: it must miss every barrier. */
#include "gpu_kit.h"

#include <dirent.h>
#include "../cpu/graph_checker.h"
#include "render/assemble.h"
#include "render/assets.h"
#include "sfumato/sfumato.h"
#include "sim/particles.h"

enum { SIDE = 64, SCENES_MAX = 64, TRIED_MAX = 2048, STEPS = 2, HEALS_MAX = 2, PLANS = 3 };

/* A scene, ready to be played. */
struct stage {
    struct sf_gpu *gpu;
    const struct sf_scene *scene;
    uint32_t plays; /* frames a submit */
    uint32_t number;
    struct sf_particles *particles;
    struct sf_assembly *assembly;
    struct sf_assets assets;
    struct sf_player *player;
    /* the shadow map's; NULL when nothing casts one */
    struct sf_shadow_pushes pushes;
    struct sf_gpu_image *map;
    struct sf_graph *shadow_graph;
    struct sf_plan *shadow_plan;
    struct sf_player *shadow_player;
};

struct target {
    struct sf_player *player;
    const struct sf_plan *plan;
};

/* Over all scenes. */
struct tally {
    uint32_t barriers, repeated, as_played, in_pairs, blind, failed;
    char *tried[TRIED_MAX]; /* a barrier's description, malloc'ed; the same one is tried once */
    uint32_t tried_count;
};

static char software[16]; /* the device's index */

static void must(enum sf_status status)
{
    if (status)
        fail_msg("%s", kit_record.last);
}

/* ---- the stage ---- */

static void open_shadow(struct stage *stage, const struct sf_plan_memory *memory)
{
    struct sf_shadow_scene shadow = sf_drawn_shadow(&stage->assembly->drawn);
    uint32_t width = shadow.cells->size * shadow.cells->count, height = shadow.cells->size;
    float *zeros;

    if (shadow.cells->count == 0)
        return;
    zeros = calloc((size_t)width * height, sizeof *zeros);
    assert_non_null(zeros);
    must(sf_gpu_image_create(stage->gpu, "shadow.map", SF_FORMAT_R32F, width, height, 1, SF_ACCESS_SAMPLED, zeros,
                             &stage->map));
    free(zeros);
    must(sf_shadow_declare(&shadow, &stage->pushes, &kit_log, &stage->shadow_graph));
    must(sf_plan_create(stage->shadow_graph, memory, &kit_log, &stage->shadow_plan));
    must(sf_player_create(stage->gpu, stage->shadow_plan, &stage->shadow_player));
    sf_player_bind_image(stage->shadow_player, sf_graph_find(stage->shadow_graph, "shadow.map"), stage->map);
    if (shadow.meshes > 0) {
        sf_player_bind_buffer(stage->shadow_player, sf_graph_find(stage->shadow_graph, "mesh.vertices"),
                              stage->assets.meshes.vertices);
        sf_player_bind_buffer(stage->shadow_player, sf_graph_find(stage->shadow_graph, "mesh.indices"),
                              stage->assets.meshes.indices);
    }
}

static void open_stage(struct stage *stage, struct sf_gpu *gpu, const struct sf_scene *scene, uint32_t plays)
{
    const struct sf_plan_memory memory = {.needs = sf_gpu_memory_needs, .user = gpu, .no_alias = plays > 1};
    struct sf_assembly_options options = {.width = SIDE, .height = SIDE, .aovs = SF_AOV_SMOKE | SF_AOV_DEPTHS};

    *stage = (struct stage){.gpu = gpu, .scene = scene, .plays = plays};
    must(sf_particles_create(gpu, scene, &kit_log, &stage->particles));
    options.capacity = sf_particles_capacity(stage->particles);
    must(sf_assembly_create(scene, &options, sf_gpu_tuning(gpu), &memory, &kit_log, &stage->assembly));
    must(sf_assets_init(gpu, &stage->assembly->drawn, NULL, &kit_log, &stage->assets));
    must(sf_player_create(gpu, stage->assembly->plan, &stage->player));
    sf_assets_bind(&stage->assets, stage->assembly, stage->player);
    sf_player_bind_buffer(stage->player, stage->assembly->method.particles, sf_particles_list(stage->particles));
    sf_player_bind_buffer(stage->player, stage->assembly->method.counts, sf_particles_counts(stage->particles));
    open_shadow(stage, &memory);
}

static void close_stage(struct stage *stage)
{
    sf_player_destroy(&stage->shadow_player);
    sf_plan_destroy(&stage->shadow_plan);
    sf_graph_destroy(&stage->shadow_graph);
    sf_gpu_image_destroy(&stage->map);
    sf_player_destroy(&stage->player);
    sf_assets_finish(&stage->assets);
    sf_assembly_destroy(&stage->assembly);
    sf_particles_destroy(&stage->particles);
}

static void targets_of(const struct stage *stage, struct target targets[PLANS])
{
    targets[0] = (struct target){sf_particles_player(stage->particles), sf_particles_plan(stage->particles)};
    targets[1] = (struct target){stage->shadow_player, stage->shadow_plan};
    targets[2] = (struct target){stage->player, stage->assembly->plan};
}

static void *upload(struct sf_player *player, sf_resource resource)
{
    void *memory = sf_player_upload(player, resource);

    assert_non_null(memory);
    return memory;
}

static void record_shadow(struct stage *stage)
{
    const struct sf_assembly *assembly = stage->assembly;

    if (!stage->shadow_player)
        return;
    memcpy(upload(stage->shadow_player, sf_graph_find(stage->shadow_graph, "shadow.cells")),
           assembly->drawn.shadow.cell, sizeof assembly->drawn.shadow.cell);
    memcpy(upload(stage->shadow_player, sf_graph_find(stage->shadow_graph, "objects")), assembly->drawn.objects,
           sizeof assembly->drawn.objects);
    must(sf_player_play(stage->shadow_player));
}

static void record_picture(struct stage *stage)
{
    struct sf_assembly *assembly = stage->assembly;
    struct sf_gpu_frame frame;

    sf_uniforms_fill(stage->scene, SIDE, SIDE, stage->number, stage->number / (double)stage->scene->sim.fps, &frame);
    sf_shadow_fill(&assembly->drawn.shadow, &frame);
    memcpy(upload(stage->player, assembly->method.frame), &frame, sizeof frame);
    memcpy(upload(stage->player, assembly->objects_upload), assembly->drawn.objects, sizeof assembly->drawn.objects);
    if (stage->assets.row->update)
        stage->assets.row->update(&assembly->method, assembly->state);
    must(sf_player_play(stage->player));
    stage->number++;
}

/* One submit; how many messages came of it. */
static int play(struct stage *stage)
{
    int before = kit_record.errors;
    uint64_t serial;

    must(sf_frame_begin(stage->gpu));
    for (uint32_t i = 0; i < stage->plays; i++) {
        for (uint32_t j = 0; j < STEPS; j++)
            must(sf_particles_step(stage->particles));
        record_shadow(stage);
        record_picture(stage);
    }
    must(sf_frame_end(stage->gpu, &serial));
    must(sf_frame_wait(stage->gpu, serial));
    return kit_record.errors - before;
}

/* Plays without that barrier: did the layers say anything? Afterwards all is as it was: an image may have been left in
 * another layout than the plan thinks, which the next play or two mend. */
static bool layers_notice(struct stage *stage, struct sf_player *player, uint32_t barrier)
{
    bool noticed;

    sf_player_drop_barrier(player, barrier);
    noticed = play(stage) > 0;
    sf_player_drop_barrier(player, UINT32_MAX);
    if (!noticed)
        return false;
    for (int heals = 0; play(stage) > 0; heals++)
        if (heals == HEALS_MAX)
            fail_msg("barrier %u left out of one play shows for ever after: %s", barrier, kit_record.last);
    return true;
}

/* ---- a barrier in words, and what the layers cannot see ---- */

static void describe_touches(const struct sf_touch *touches, uint32_t count, char *text, size_t bytes)
{
    size_t used = 0;

    text[0] = '\0';
    for (uint32_t i = 0; i < count && used < bytes; i++)
        used += (size_t)snprintf(text + used, bytes - used, "%s%s.%s", i ? "+" : "", sf_access_name(touches[i].access),
                                 sf_pass_kind_name(touches[i].kind));
}

static void describe(const struct sf_plan *plan, uint32_t number, char text[1024])
{
    const struct sf_plan_barrier *barrier = checker_barrier_at(plan, number);
    uint32_t pass = 0, left = number;
    char before[400], after[400];

    while (pass < plan->pass_count && left >= plan->passes[pass].barrier_count)
        left -= plan->passes[pass++].barrier_count;
    describe_touches(barrier->before, barrier->before_count, before, sizeof before);
    describe_touches(barrier->after, barrier->after_count, after, sizeof after);
    snprintf(text, 1024, "%s: %s: %s%s%s%s -> %s", pass < plan->pass_count ? plan->passes[pass].name : "(end)",
             plan->resources[barrier->resource - 1].name, barrier->previous ? "previous, " : "",
             barrier->discard ? "discard, " : "", barrier->from_before ? "from before, " : "", before, after);
}

typedef bool (*touch_test)(struct sf_touch touch);

static bool all_touches(const struct sf_touch *touches, uint32_t count, touch_test test)
{
    for (uint32_t i = 0; i < count; i++)
        if (!test(touches[i]))
            return false;
    return true;
}

static bool is_attachment(struct sf_touch touch)
{
    return touch.access == SF_ACCESS_COLOR || touch.access == SF_ACCESS_DEPTH || touch.access == SF_ACCESS_DEPTH_READ;
}

static bool is_host(struct sf_touch touch)
{
    return touch.access == SF_ACCESS_HOST_READ;
}

static bool is_read(struct sf_touch touch)
{
    return !sf_access_writes(touch.access);
}

static bool is_read_or_modify(struct sf_touch touch)
{
    return is_read(touch) || touch.access == SF_ACCESS_STORAGE_MODIFY;
}

static bool is_compute_store(struct sf_touch touch)
{
    return touch.kind == SF_PASS_COMPUTE &&
           (touch.access == SF_ACCESS_STORAGE_WRITE || touch.access == SF_ACCESS_STORAGE_MODIFY);
}

/* Why validation (as of 1.3.239) may say nothing when the barrier is missing; NULL when it has no excuse. A change of
 * layout has none: core validation follows those. */
static const char *blind_spot(const struct sf_plan *plan, const struct sf_plan_barrier *barrier)
{
    const struct sf_plan_resource *resource = &plan->resources[barrier->resource - 1];
    const struct sf_touch *before = barrier->before, *after = barrier->after;
    uint32_t befores = barrier->before_count, afters = barrier->after_count;

    if (resource->image &&
        sf_access_layout(before[0].access, resource->format) != sf_access_layout(after[0].access, resource->format))
        return NULL;
    if (all_touches(after, afters, is_host))
        return "the host's reads are not followed";
    if (all_touches(before, befores, is_attachment) && all_touches(after, afters, is_attachment))
        return "the attachments of dynamic rendering are not followed";
    if (all_touches(before, befores, is_compute_store) && all_touches(after, afters, is_compute_store))
        return "of two writes by compute shaders it is not known whether they meet";
    if (all_touches(before, befores, is_read_or_modify) && !all_touches(before, befores, is_read) &&
        all_touches(after, afters, is_read_or_modify))
        return "a shader that changes a buffer by atomics only counts as reading it";
    if (resource->lifetime == SF_IMPORTED && barrier->from_before && all_touches(before, befores, is_read) &&
        all_touches(after, afters, is_compute_store))
        return "whoever gave it back ordered its reads before this stage";
    return NULL;
}

/* ---- the test ---- */

/* True the first time. */
static bool is_new(struct tally *tally, const char *plan, const char *description)
{
    char text[1100];
    char *copy;

    snprintf(text, sizeof text, "%s: %s", plan, description);
    for (uint32_t i = 0; i < tally->tried_count; i++)
        if (strcmp(tally->tried[i], text) == 0)
            return false;
    assert_true(tally->tried_count < TRIED_MAX);
    copy = malloc(strlen(text) + 1);
    assert_non_null(copy);
    tally->tried[tally->tried_count++] = strcpy(copy, text);
    return true;
}

static void try_barrier(struct tally *tally, struct stage stages[2], uint32_t which, uint32_t number,
                        const bool *outputs)
{
    struct target alone[PLANS], pairs[PLANS];
    const struct checker_drop drop = {number, CHECKER_DROP_NONE, CHECKER_DROP_NONE};
    char description[1024], problem[256];
    const char *reason;

    targets_of(&stages[0], alone);
    targets_of(&stages[1], pairs);
    describe(alone[which].plan, number, description);
    tally->barriers++;
    if (checker_run(alone[which].plan, outputs, drop, problem)) {
        printf("    UNNOTICED by the checker: %s\n", description);
        tally->failed++;
    }
    if (!is_new(tally, alone[which].plan->name, description)) {
        tally->repeated++;
        return;
    }
    if (layers_notice(&stages[0], alone[which].player, number)) {
        tally->as_played++;
        return;
    }
    if (layers_notice(&stages[1], pairs[which].player, number)) {
        tally->in_pairs++;
        return;
    }
    /* In pairs and in its own memory it may have another reason than as played. */
    reason = blind_spot(pairs[which].plan, checker_barrier_at(pairs[which].plan, number));
    printf("    %s %s\n        %s\n", reason ? "not seen:" : "UNNOTICED by the layers:", description,
           reason ? reason : "for no known reason");
    if (reason)
        tally->blind++;
    else
        tally->failed++;
}

static void try_plan(struct tally *tally, struct stage stages[2], uint32_t which)
{
    struct target alone[PLANS], pairs[PLANS];
    const struct checker_drop nothing = {CHECKER_DROP_NONE, CHECKER_DROP_NONE, CHECKER_DROP_NONE};
    char problem[256];
    uint32_t count;
    bool *outputs; /* none but those that leave by themselves */

    targets_of(&stages[0], alone);
    targets_of(&stages[1], pairs);
    if (!alone[which].plan)
        return;
    count = checker_barrier_count(alone[which].plan);
    assert_true(count > 0);
    assert_int_equal(count, checker_barrier_count(pairs[which].plan));
    outputs = calloc(alone[which].plan->resource_count, sizeof *outputs);
    assert_non_null(outputs);
    if (!checker_run(alone[which].plan, outputs, nothing, problem))
        fail_msg("the plan '%s' has a hazard: %s", alone[which].plan->name, problem);
    for (uint32_t i = 0; i < count; i++)
        try_barrier(tally, stages, which, i, outputs);
    free(outputs);
}

static void try_scene(struct tally *tally, struct sf_gpu *gpu, const char *path)
{
    struct sf_scene *scene = NULL;
    struct stage *stages = calloc(2, sizeof *stages); /* push constants must stay where they are */

    assert_non_null(stages);
    must(sf_scene_load(path, NULL, 0, &kit_log, &scene));
    for (uint32_t i = 0; i < 2; i++) {
        open_stage(&stages[i], gpu, scene, i + 1);
        for (int j = 0; j < 3; j++)
            if (play(&stages[i]) > 0)
                fail_msg("%s, nothing left out: %s", path, kit_record.last);
    }
    for (uint32_t i = 0; i < PLANS; i++)
        try_plan(tally, stages, i);
    close_stage(&stages[0]);
    close_stage(&stages[1]);
    free(stages);
    sf_scene_destroy(&scene);
}

static int compare_names(const void *left, const void *right)
{
    return strcmp(*(char *const *)left, *(char *const *)right);
}

/* Paths of the scenes in scenes/tiny, in order. */
static uint32_t list_scenes(char *paths[SCENES_MAX])
{
    const char *root = getenv("SF_SOURCE_ROOT");
    char folder[512];
    struct dirent *entry;
    uint32_t count = 0;
    DIR *handle;

    snprintf(folder, sizeof folder, "%s/scenes/tiny", root ? root : ".");
    handle = opendir(folder);
    assert_non_null(handle);
    while ((entry = readdir(handle))) {
        size_t length = strlen(entry->d_name), bytes = sizeof folder + length + 2;

        if (length < 5 || strcmp(entry->d_name + length - 5, ".json") != 0)
            continue;
        assert_true(count < SCENES_MAX);
        paths[count] = malloc(bytes);
        assert_non_null(paths[count]);
        snprintf(paths[count++], bytes, "%s/%s", folder, entry->d_name);
    }
    closedir(handle);
    qsort(paths, count, sizeof *paths, compare_names);
    return count;
}

static void test_every_barrier_is_needed(void **state)
{
    static struct tally tally;
    char *paths[SCENES_MAX];
    uint32_t count = list_scenes(paths);
    const struct sf_gpu_options options = {.device = software, .validate = true, .no_cache = true};
    struct sf_gpu *gpu = NULL;
    int errors;

    (void)state;
    kit_forget();
    must(sf_gpu_create(&options, &kit_log, &gpu));
    assert_true(count > 0);
    for (uint32_t i = 0; i < count; i++) {
        struct tally before = tally;

        printf("  %s\n", paths[i]);
        try_scene(&tally, gpu, paths[i]);
        printf("    %u barriers, %u of them new\n", tally.barriers - before.barriers,
               tally.barriers - before.barriers - (tally.repeated - before.repeated));
        free(paths[i]);
    }
    printf("  %u barriers, %u of them tried in an earlier scene; the layers notice %u as played, %u more in pairs, and "
           "are blind "
           "to %u; %u go unnoticed\n",
           tally.barriers, tally.repeated, tally.as_played, tally.in_pairs, tally.blind, tally.failed);
    for (uint32_t i = 0; i < tally.tried_count; i++)
        free(tally.tried[i]);
    assert_int_equal(tally.failed, 0);
    /* The excuses must stay exceptions. */
    assert_true(tally.blind < tally.as_played + tally.in_pairs);
    errors = kit_record.errors;
    sf_gpu_destroy(&gpu);
    assert_int_equal(kit_record.errors, errors);
}

/* Without a barrier a GPU may read arguments of a dispatch that are not there yet, and hang; a CPU does not. False when
 * there is no such device. */
static bool find_software(void)
{
    struct sf_gpu_info *infos = NULL;
    uint32_t count = 0;
    bool found = false;

    kit_forget();
    sf_gpu_list(&kit_log, &infos, &count);
    for (uint32_t i = 0; i < count && !found; i++) {
        found = infos[i].suitable && strcmp(infos[i].kind, "cpu") == 0;
        snprintf(software, sizeof software, "%u", i);
    }
    free(infos);
    if (!found)
        fprintf(stderr, "skipped: no software device, and barriers are left out on no other\n");
    return found;
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_every_barrier_is_needed)};

    /* The layer falls silent after ten messages of a kind. */
    setenv("VK_LAYER_DUPLICATE_MESSAGE_LIMIT", "1000000", 1);
    if (kit_probe() || !find_software())
        return KIT_SKIP;
    return cmocka_run_group_tests(tests, NULL, NULL);
}
