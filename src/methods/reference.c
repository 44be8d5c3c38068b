/* The integral itself, as passes of the frame's graph.
 *
 * With the first play of a picture: the particles as the eye sees them, a list of those that each tile of the frame touches, lists
 * of those that may stand between a piece of a tile and a light, and what of each ray is exact without sampling. With every play: some of the
 * samples of each ray, added up in an image that lasts; and the mean so far over the scene. */
#include "methods/reference.h"

#include <stddef.h>
#include <string.h>
#include "shared/frame.h"
#include "shared/particle.h"

_Static_assert(sizeof(struct sf_reference_push) <= SF_PUSH_BYTES_MAX, "push constants");
_Static_assert(sizeof(struct sf_reference_sphere) == 32, "std430");
_Static_assert(sizeof(struct sf_reference_node) == 32, "std430");
_Static_assert(sizeof(struct sf_reference_verdict) == 32, "std430");
_Static_assert(SF_REFERENCE_RAMP == SF_RAMP_MAX, "shared limits");

/* Entries that all lists together may have: 64 MiB, which every device lets a shader see. */
static const uint64_t ENTRIES_MAX = 16u << 20;
/* Software devices end an invocation's loops after 65,535 turns, all loops counted together. */
enum { TURNS_MAX = 60000, MESH_TURNS_SOFTWARE = 30000, MESH_TURNS_HARDWARE = 1 << 20 };

enum { MESHES_NONE, MESHES_EXACT, MESHES_MAPPED }; /* as glsl/reference/march.comp */

static uint32_t divide_up(uint32_t a, uint32_t b)
{
    return (a + b - 1) / b;
}

static uint32_t greatest(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

/* ---- plays ---- */

/* Rows of samples in a play. */
static uint32_t rows_of(const struct sf_scene *scene)
{
    return divide_up((uint32_t)scene->reference.batch, SF_REFERENCE_ROW);
}

uint32_t sf_reference_plays(const struct sf_scene *scene)
{
    return divide_up((uint32_t)scene->reference.samples, rows_of(scene) * SF_REFERENCE_ROW);
}

static uint32_t common_divisor(uint32_t a, uint32_t b)
{
    while (b > 0) {
        uint32_t rest = a % b;

        a = b;
        b = rest;
    }
    return a;
}

/* Where play number `play` stands in a picture of `plays`: each once, and wherever one stops, they are spread well (multiples of the
 * golden ratio). */
static uint32_t turn_of(uint32_t play, uint32_t plays)
{
    uint32_t step = (uint32_t)(0.6180339887 * plays);

    while (common_divisor(step, plays) != 1)
        step++;
    return (uint32_t)((plays / 2 + (uint64_t)play * step) % plays);
}

static void set_groups(uint32_t groups[3], bool now, uint32_t x, uint32_t y, uint32_t z)
{
    groups[0] = now ? x : 0;
    groups[1] = now ? y : 0;
    groups[2] = now ? z : 0;
}

static uint32_t meshes_how(const struct sf_scene *scene)
{
    uint32_t triangles = sf_reference_triangles(scene);

    return triangles == 0 ? MESHES_NONE : sf_reference_fits(triangles) ? MESHES_EXACT : MESHES_MAPPED;
}

static uint32_t mesh_turns(const struct sf_method_frame *frame)
{
    return frame->tuning->software ? MESH_TURNS_SOFTWARE : MESH_TURNS_HARDWARE;
}

void sf_reference_update(const struct sf_method_frame *frame, void *state)
{
    struct sf_reference *reference = state;
    const struct sf_scene *scene = frame->scene;
    uint32_t tiles_x = divide_up(frame->width, SF_REFERENCE_TILE),
             tiles_y = divide_up(frame->height, SF_REFERENCE_TILE);
    uint32_t rows = rows_of(scene), plays = sf_reference_plays(scene), samples = plays * rows * SF_REFERENCE_ROW;
    uint32_t slices = samples / (4 * SF_REFERENCE_ROW); /* a row of samples is not longer than a slice */
    bool first = frame->play == 0, unfinished = frame->play < plays;

    slices = slices > SF_REFERENCE_SLICES ? SF_REFERENCE_SLICES : greatest(slices, 1);
    reference->push.tiles_x = tiles_x;
    reference->push.tiles_y = tiles_y;
    reference->push.lists = 1 + scene->light_count * SF_REFERENCE_SLICES;
    reference->push.slices = slices;
    reference->push.samples = samples;
    reference->push.first_row = turn_of(frame->play % plays, plays);
    reference->push.row_stride = plays;
    reference->push.rows = rows;
    reference->push.play = frame->play;
    reference->push.budget = mesh_turns(frame);
    reference->push.ambient = scene->thick.ambient;
    reference->push.shadow_cell = (uint32_t)scene->reference.shadow_size;
    set_groups(reference->fit_groups, first, 1, 1, 1);
    set_groups(reference->shadow_groups, first, divide_up(reference->push.shadow_cell, SF_REFERENCE_TILE),
               divide_up(reference->push.shadow_cell, SF_REFERENCE_TILE), scene->light_count);
    set_groups(reference->spheres_groups, first, divide_up((uint32_t)scene->sim.capacity, 64), 1, 1);
    set_groups(reference->tiles_groups, first, tiles_x, tiles_y, 1);
    set_groups(reference->ways_groups, first, scene->light_count * slices, tiles_x, tiles_y);
    set_groups(reference->depths_groups, first, tiles_x, tiles_y, 1);
    set_groups(reference->march_groups, unfinished, tiles_x, tiles_y, 1);
}

enum sf_status sf_reference_judge(const struct sf_method_frame *frame, const void *data, const struct sf_log *log)
{
    const struct sf_reference_verdict *verdict = data;
    const struct sf_scene *scene = frame->scene;
    uint64_t rows = rows_of(scene), words = divide_up((uint32_t)scene->sim.capacity, 256) * 9;
    uint64_t view = divide_up(verdict->longest_view, SF_REFERENCE_UNROLL),
             way = divide_up(verdict->longest_way, SF_REFERENCE_UNROLL);
    /* Knots, then for each row its weights, and for each light the smoke, the objects and the points of meshes. */
    uint64_t turns = 2 * view + rows * (1 + view + scene->light_count * (1 + way + frame->solids + SF_REFERENCE_ROW));
    uint64_t most = meshes_how(scene) == MESHES_EXACT ? TURNS_MAX - MESH_TURNS_SOFTWARE : TURNS_MAX;

    if (verdict->over > 0)
        return sf_fail(
            log, SF_ERROR_DEVICE,
            "reference: for %u pixels the ways to the lights lead past more of the meshes' triangles than this "
            "device can look at; use a smaller reference.batch (%d now) or simpler meshes",
            verdict->over, scene->reference.batch);
    if (frame->tuning->software && words + verdict->longest_shadow > TURNS_MAX)
        return sf_fail(
            log, SF_ERROR_DEVICE,
            "reference: %u particles stand between a light and one square of its shadow's map, more than a "
            "software device can add up; set reference.ground_shadow to false, or use fewer particles or a GPU",
            verdict->longest_shadow);
    if (frame->tuning->software && (turns > most || verdict->longest_view > TURNS_MAX))
        return sf_fail(
            log, SF_ERROR_DEVICE,
            "reference: %u particles lie behind one tile of the frame, %u on one way to a light, more than a "
            "software device can add up; use a smaller reference.batch (%d now), fewer particles or a GPU",
            verdict->longest_view, verdict->longest_way, scene->reference.batch);
    return SF_OK;
}

/* ---- passes ---- */

static void add_pass(struct sf_method_frame *frame, const struct sf_reference *reference, const struct sf_use *uses,
                     uint32_t use_count, struct sf_pass_desc desc)
{
    desc.uses = uses;
    desc.use_count = use_count;
    desc.push = &reference->push;
    desc.push_bytes = sizeof reference->push;
    sf_graph_pass(frame->graph, &desc);
}

static sf_resource lasting_image(struct sf_method_frame *frame, const char *name)
{
    return sf_graph_image(frame->graph,
                          &(struct sf_image_desc){.name = name,
                                                  .format = SF_FORMAT_RGBA32F,
                                                  .lifetime = SF_PERSISTENT,
                                                  .size = {.width = frame->width, .height = frame->height}});
}

static sf_resource add_buffer(struct sf_method_frame *frame, const char *name, enum sf_lifetime lifetime,
                              uint64_t bytes)
{
    return sf_graph_buffer(frame->graph, &(struct sf_buffer_desc){.name = name, .lifetime = lifetime, .bytes = bytes});
}

static sf_resource import_buffer(struct sf_method_frame *frame, const char *name, uint64_t bytes)
{
    return sf_graph_buffer(
        frame->graph, &(struct sf_buffer_desc){
                          .name = name, .lifetime = SF_IMPORTED, .bytes = bytes, .outside = SF_ACCESS_STORAGE_READ});
}

static void add_resources(struct sf_method_frame *frame, struct sf_reference *reference)
{
    const struct sf_scene *scene = frame->scene;
    uint64_t capacity = (uint64_t)scene->sim.capacity, triangles = sf_reference_triangles(scene);
    uint64_t tiles = (uint64_t)reference->push.tiles_x * reference->push.tiles_y, lists = tiles * reference->push.lists;
    uint64_t entries = lists * capacity < ENTRIES_MAX ? lists * capacity : ENTRIES_MAX;

    triangles = sf_reference_fits((uint32_t)triangles) ? triangles : 0;
    reference->push.entries = (uint32_t)entries;
    reference->spheres =
        add_buffer(frame, "reference.spheres", SF_PERSISTENT, capacity * sizeof(struct sf_reference_sphere));
    reference->rects = add_buffer(frame, "reference.rects", SF_TRANSIENT, capacity * 4 * sizeof(float));
    reference->ranges = add_buffer(frame, "reference.ranges", SF_PERSISTENT, tiles * 2 * sizeof(float));
    reference->lists = add_buffer(frame, "reference.lists", SF_PERSISTENT, lists * 2 * sizeof(uint32_t));
    reference->entries = add_buffer(frame, "reference.entries", SF_PERSISTENT, entries * sizeof(uint32_t));
    reference->verdict = add_buffer(frame, "reference.verdict", SF_PERSISTENT, sizeof(struct sf_reference_verdict));
    reference->depths = lasting_image(frame, "reference.depths");
    reference->sums = lasting_image(frame, "reference.sums");
    reference->ramp = import_buffer(frame, "reference.ramp", SF_REFERENCE_RAMP * 4 * sizeof(float));
    reference->nodes = import_buffer(frame, "reference.nodes", (triangles + 1) * sizeof(struct sf_reference_node));
    reference->corners = import_buffer(frame, "reference.corners", (triangles + 1) * 12 * sizeof(float));
    frame->verdict = reference->verdict;
}

static void add_spheres(struct sf_method_frame *frame, const struct sf_reference *reference)
{
    const struct sf_use uses[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = frame->particles, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = frame->counts, .access = SF_ACCESS_STORAGE_READ, .binding = 2},
        {.resource = reference->ramp, .access = SF_ACCESS_STORAGE_READ, .binding = 3},
        {.resource = reference->spheres, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 4},
        {.resource = reference->rects, .access = SF_ACCESS_STORAGE_WRITE, .binding = 5},
        {.resource = reference->verdict, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 6},
    };

    sf_graph_pass(frame->graph, &(struct sf_pass_desc){.name = "reference.spheres",
                                                       .kind = SF_PASS_COMPUTE,
                                                       .shader = "reference/spheres.comp",
                                                       .uses = uses,
                                                       .use_count = SF_COUNT(uses),
                                                       .groups_live = reference->spheres_groups});
}

/* The map of the smoke's shadow on the scene, for its shading. */
static void add_shadow(struct sf_method_frame *frame, const struct sf_reference *reference)
{
    uint32_t size = reference->push.shadow_cell;

    frame->smoke_views =
        add_buffer(frame, "reference.views", SF_PERSISTENT, SF_FRAME_LIGHTS * sizeof(struct sf_gpu_light_view));
    frame->smoke_map = sf_graph_image(
        frame->graph, &(struct sf_image_desc){.name = "reference.shadow",
                                              .format = SF_FORMAT_RGBA32F,
                                              .lifetime = SF_PERSISTENT,
                                              .size = {.width = size * frame->scene->light_count, .height = size}});
    frame->smoke_shadows = true;
    const struct sf_use fit[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = frame->counts, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = frame->smoke_views, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 2},
    };
    const struct sf_use draw[] = {
        {.resource = frame->particles, .access = SF_ACCESS_STORAGE_READ, .binding = 0},
        {.resource = frame->counts, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = frame->smoke_views, .access = SF_ACCESS_STORAGE_READ, .binding = 2},
        {.resource = reference->verdict, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 3},
        {.resource = frame->smoke_map, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 4},
    };

    add_pass(frame, reference, fit, SF_COUNT(fit),
             (struct sf_pass_desc){.name = "reference.fit",
                                   .kind = SF_PASS_COMPUTE,
                                   .shader = "reference/fit.comp",
                                   .groups_live = reference->fit_groups});
    add_pass(frame, reference, draw, SF_COUNT(draw),
             (struct sf_pass_desc){.name = "reference.shadow",
                                   .kind = SF_PASS_COMPUTE,
                                   .shader = "reference/shadow.comp",
                                   .groups_live = reference->shadow_groups});
}

static void add_lists(struct sf_method_frame *frame, const struct sf_reference *reference)
{
    const struct sf_use tiles[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = frame->counts, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = reference->spheres, .access = SF_ACCESS_STORAGE_READ, .binding = 2},
        {.resource = reference->rects, .access = SF_ACCESS_STORAGE_READ, .binding = 3},
        {.resource = reference->lists, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 4},
        {.resource = reference->entries, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 5},
        {.resource = reference->ranges, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 6},
        {.resource = reference->verdict, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 7},
    };
    const struct sf_use ways[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = frame->counts, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = reference->spheres, .access = SF_ACCESS_STORAGE_READ, .binding = 2},
        {.resource = reference->ranges, .access = SF_ACCESS_STORAGE_READ, .binding = 3},
        {.resource = reference->lists, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 4},
        {.resource = reference->entries, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 5},
        {.resource = reference->verdict, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 6},
    };

    add_pass(frame, reference, tiles, SF_COUNT(tiles),
             (struct sf_pass_desc){.name = "reference.tiles",
                                   .kind = SF_PASS_COMPUTE,
                                   .shader = "reference/tiles.comp",
                                   .groups_live = reference->tiles_groups});
    add_pass(frame, reference, ways, SF_COUNT(ways),
             (struct sf_pass_desc){.name = "reference.ways",
                                   .kind = SF_PASS_COMPUTE,
                                   .shader = "reference/ways.comp",
                                   .groups_live = reference->ways_groups});
}

static void add_depths(struct sf_method_frame *frame, const struct sf_reference *reference)
{
    const struct sf_use uses[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = frame->particles, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = reference->lists, .access = SF_ACCESS_STORAGE_READ, .binding = 2},
        {.resource = reference->entries, .access = SF_ACCESS_STORAGE_READ, .binding = 3},
        {.resource = frame->depth, .access = SF_ACCESS_SAMPLED, .binding = 4},
        {.resource = reference->depths, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 5},
    };

    add_pass(frame, reference, uses, SF_COUNT(uses),
             (struct sf_pass_desc){.name = "reference.depths",
                                   .kind = SF_PASS_COMPUTE,
                                   .shader = "reference/depths.comp",
                                   .groups_live = reference->depths_groups});
}

/* One bit a light: objects cast shadows in it. */
static uint32_t casting(const struct sf_scene *scene)
{
    uint32_t bits = 0;

    for (uint32_t i = 0; i < scene->light_count; i++)
        bits |= (uint32_t)scene->lights[i].shadows << i;
    return bits;
}

static void add_march(struct sf_method_frame *frame, const struct sf_reference *reference)
{
    const struct sf_scene *scene = frame->scene;
    const struct sf_use uses[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = frame->objects, .access = SF_ACCESS_UNIFORM, .binding = 1},
        {.resource = reference->spheres, .access = SF_ACCESS_STORAGE_READ, .binding = 2},
        {.resource = reference->lists, .access = SF_ACCESS_STORAGE_READ, .binding = 3},
        {.resource = reference->entries, .access = SF_ACCESS_STORAGE_READ, .binding = 4},
        {.resource = reference->ranges, .access = SF_ACCESS_STORAGE_READ, .binding = 5},
        {.resource = frame->counts, .access = SF_ACCESS_STORAGE_READ, .binding = 6},
        {.resource = reference->depths, .access = SF_ACCESS_SAMPLED, .binding = 7},
        {.resource = frame->shadow_map, .access = SF_ACCESS_SAMPLED, .binding = 8},
        {.resource = reference->nodes, .access = SF_ACCESS_STORAGE_READ, .binding = 9},
        {.resource = reference->corners, .access = SF_ACCESS_STORAGE_READ, .binding = 10},
        {.resource = reference->verdict, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 11},
        {.resource = reference->sums, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 12},
    };

    add_pass(frame, reference, uses, SF_COUNT(uses),
             (struct sf_pass_desc){
                 .name = "reference.march",
                 .kind = SF_PASS_COMPUTE,
                 .shader = "reference/march.comp",
                 .constants = {scene->light_count, frame->solids, frame->planes, meshes_how(scene), casting(scene)},
                 .constant_count = 5,
                 .groups_live = reference->march_groups});
}

static void add_over(struct sf_method_frame *frame, const struct sf_reference *reference)
{
    const struct sf_use uses[] = {
        {.resource = reference->sums, .access = SF_ACCESS_SAMPLED, .binding = 0},
        {.resource = reference->depths, .access = SF_ACCESS_SAMPLED, .binding = 1},
        {.resource = frame->color, .access = SF_ACCESS_COLOR, .binding = 0, .load = SF_LOAD_KEEP},
    };

    sf_graph_pass(frame->graph, &(struct sf_pass_desc){.name = "reference.over",
                                                       .kind = SF_PASS_RASTER,
                                                       .shader = "scene/screen.vert",
                                                       .fragment = "reference/over.frag",
                                                       .uses = uses,
                                                       .use_count = SF_COUNT(uses),
                                                       .vertices = 3,
                                                       .instances = 1,
                                                       .raster = {.blend = {SF_BLEND_PREMULTIPLIED}}});
}

static sf_resource aov_image(struct sf_method_frame *frame, const char *name, enum sf_format format)
{
    return sf_graph_image(frame->graph,
                          &(struct sf_image_desc){.name = name,
                                                  .format = format,
                                                  .lifetime = SF_TRANSIENT,
                                                  .size = {.width = frame->width, .height = frame->height}});
}

static void add_aovs(struct sf_method_frame *frame, const struct sf_reference *reference)
{
    frame->aov_radiance = aov_image(frame, "aov.smoke", SF_FORMAT_RGBA16F);
    frame->aov_depths = aov_image(frame, "aov.depths", SF_FORMAT_RGBA32F);
    const struct sf_use uses[] = {
        {.resource = reference->sums, .access = SF_ACCESS_SAMPLED, .binding = 0},
        {.resource = reference->depths, .access = SF_ACCESS_SAMPLED, .binding = 1},
        {.resource = frame->aov_radiance, .access = SF_ACCESS_COLOR, .binding = 0, .load = SF_LOAD_DISCARD},
        {.resource = frame->aov_depths, .access = SF_ACCESS_COLOR, .binding = 1, .load = SF_LOAD_DISCARD},
    };

    sf_graph_pass(frame->graph, &(struct sf_pass_desc){.name = "reference.aovs",
                                                       .kind = SF_PASS_RASTER,
                                                       .shader = "scene/screen.vert",
                                                       .fragment = "reference/over.frag",
                                                       .uses = uses,
                                                       .use_count = SF_COUNT(uses),
                                                       .vertices = 3,
                                                       .instances = 1});
}

enum sf_status sf_reference_light(struct sf_method_frame *frame, void *state, const struct sf_log *log)
{
    struct sf_reference *reference = state;

    (void)log;
    sf_reference_update(frame, reference);
    add_resources(frame, reference);
    add_spheres(frame, reference);
    if (frame->scene->reference.ground_shadow && frame->scene->light_count > 0 && frame->scene->object_count > 0)
        add_shadow(frame, reference);
    return SF_OK;
}

enum sf_status sf_reference_view(struct sf_method_frame *frame, void *state, const struct sf_log *log)
{
    const struct sf_reference *reference = state;

    if (meshes_how(frame->scene) == MESHES_MAPPED)
        sf_log(log, SF_LOG_WARNING,
               "reference: meshes of %u triangles are too many to be looked at one by one: objects cast their shadows "
               "on the smoke "
               "by the lights' shadow maps, which is not exact",
               sf_reference_triangles(frame->scene));
    add_lists(frame, reference);
    add_depths(frame, reference);
    add_march(frame, reference);
    add_over(frame, reference);
    if (frame->want_aovs)
        add_aovs(frame, reference);
    return SF_OK;
}
