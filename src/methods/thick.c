/* Thick smoke with volumetric lighting, as passes of the frame's graph.
 *
 * Both the camera and the lights see the smoke through lists: for every tile of 16 x 16 pixels (of the smoke's image, of a
 * light's map) the spheres that its rays may meet. A pixel sums its spheres' chords, so that the optical depth to any
 * point of its ray is known exactly, however many clouds lie behind each other and with the eye in their midst.
 *
 * The lights' part: fit each light's view to the smoke, list, and store of each texel the interval near..far with the
 * optical depth before 8 or more depths within. The camera's part: project, count, list; march, in the smoke's resolution, with
 * the lights' maps giving the way to each light; lay over the scene, with the opacity at the frame's own resolution. */
#include "methods/thick.h"

#include "shared/frame.h"
#include "shared/particle.h"

enum {
    LIST_BYTES_MAX = 64 << 20,
    LIGHT_LIST_BYTES_MAX = 16 << 20,
    TILE_SPHERES_MAX = 64000,      /* lavapipe ends an invocation's loops after 65,535 turns */
    STORAGE_BYTES_MAX = 128 << 20, /* every device lets a shader see that much of a buffer */
};

static uint32_t least(uint64_t a, uint64_t b)
{
    return (uint32_t)(a < b ? a : b);
}

static uint32_t light_tiles(const struct sf_thick *thick)
{
    uint32_t side = sf_divide_up(thick->push.cell_size, SF_THICK_TILE);
    return side * side;
}

void sf_thick_update(const struct sf_method_frame *frame, void *state)
{
    struct sf_thick *thick = state;
    sf_thick_fill(frame, thick);
    uint64_t capacity = thick->push.capacity, tiles = (uint64_t)thick->push.tiles_x * thick->push.tiles_y;
    uint64_t padded = sf_divide_up(thick->push.capacity, SF_THICK_TURN) * SF_THICK_TURN;
    thick->push.list_words = least(tiles * padded, LIST_BYTES_MAX / 4);
    thick->push.light_list =
        least(capacity, LIGHT_LIST_BYTES_MAX / 4 / ((uint64_t)light_tiles(thick) * thick->push.cells));
}

/* Spheres that a subgroup reads together. */
static uint32_t turn_of(const struct sf_method_frame *frame)
{
    return frame->tuning && frame->tuning->subgroup_size < SF_THICK_TURN ? 4 : SF_THICK_TURN;
}

/* Of a texel of the lights' maps; the shader makes 16 at a time. */
static uint32_t slices_of(const struct sf_scene *scene)
{
    return sf_divide_up((uint32_t)scene->thick.light_slices, 16) * 16;
}

/* A buffer that shares its memory with none: synchronization validation does not see that a barrier of one buffer orders
 * reads of another in whose place it stands. */
static sf_resource own_buffer(struct sf_graph *graph, const char *name, uint64_t bytes)
{
    return sf_graph_buffer(graph, &(struct sf_buffer_desc){.name = name, .lifetime = SF_PERSISTENT, .bytes = bytes});
}

static void add_light_map(struct sf_method_frame *frame, struct sf_thick *thick)
{
    struct sf_graph *graph = frame->graph;
    uint32_t tiles = light_tiles(thick), cells = thick->push.cells, slices = slices_of(frame->scene);
    uint64_t texels = (uint64_t)thick->light_blur.width * thick->light_blur.height;
    sf_resource lengths = own_buffer(graph, "light.lengths", 4ull * tiles * cells);
    sf_resource list = own_buffer(graph, "light.list", 4ull * tiles * cells * thick->push.light_list);
    thick->slices = sf_thick_buffer(graph, "light.slices", 4 * texels * slices);
    thick->light_raw =
        sf_thick_image(graph, "light.raw", SF_FORMAT_RGBA32F, thick->light_blur.width, thick->light_blur.height);
    const struct sf_use lists[] = {
        {.resource = frame->particles, .access = SF_ACCESS_STORAGE_READ, .binding = 0},
        {.resource = frame->counts, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = frame->smoke_views, .access = SF_ACCESS_STORAGE_READ, .binding = 2},
        {.resource = lengths, .access = SF_ACCESS_STORAGE_WRITE, .binding = 3},
        {.resource = list, .access = SF_ACCESS_STORAGE_WRITE, .binding = 4},
    };
    sf_thick_pass(frame, thick, lists, SF_COUNT(lists),
                  (struct sf_pass_desc){.name = "thick.light_lists",
                                        .kind = SF_PASS_COMPUTE,
                                        .shader = "thick/light_lists.comp",
                                        .groups = {tiles, cells, 1}});
    const struct sf_use map[] = {
        {.resource = frame->particles, .access = SF_ACCESS_STORAGE_READ, .binding = 0},
        {.resource = frame->counts, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = frame->smoke_views, .access = SF_ACCESS_STORAGE_READ, .binding = 2},
        {.resource = lengths, .access = SF_ACCESS_STORAGE_READ, .binding = 3},
        {.resource = list, .access = SF_ACCESS_STORAGE_READ, .binding = 4},
        {.resource = thick->slices, .access = SF_ACCESS_STORAGE_WRITE, .binding = 5},
        {.resource = thick->light_raw, .access = SF_ACCESS_STORAGE_WRITE, .binding = 6},
    };
    sf_thick_pass(frame, thick, map, SF_COUNT(map),
                  (struct sf_pass_desc){.name = "thick.light_map",
                                        .kind = SF_PASS_COMPUTE,
                                        .shader = "thick/light_map.comp",
                                        .constants = {slices, turn_of(frame)},
                                        .constant_count = 2,
                                        .groups = {tiles, cells, 1}});
}

enum sf_status sf_thick_light(struct sf_method_frame *frame, void *state, const struct sf_log *log)
{
    struct sf_thick *thick = state;
    sf_thick_update(frame, thick);
    uint32_t width = thick->light_blur.width, height = thick->light_blur.height;
    uint64_t bytes = 4ull * width * height * slices_of(frame->scene);

    if (bytes > STORAGE_BYTES_MAX)
        return sf_fail(
            log, SF_ERROR_USAGE,
            "thick: the lights' maps would take %llu MiB, and shaders see %d at most; lower thick.light_size "
            "or thick.light_slices",
            (unsigned long long)(bytes >> 20), STORAGE_BYTES_MAX >> 20);

    sf_thick_fit(frame, thick, true);
    add_light_map(frame, thick);
    frame->smoke_shadows = frame->scene->thick.ground_shadow;
    if (!frame->smoke_shadows)
        return SF_OK;
    /* Surfaces look the whole interval up, filtered: for them the map is blurred. */
    sf_resource half_way = sf_thick_image(frame->graph, "light.half", SF_FORMAT_RGBA32F, width, height);
    frame->smoke_map = sf_thick_image(frame->graph, "light.map", SF_FORMAT_RGBA32F, width, height);
    const sf_resource images[] = {thick->light_raw, half_way, frame->smoke_map};
    static const char *const names[] = {"thick.light_blur_x", "thick.light_blur_y"};
    sf_thick_blur(frame, thick, names, images, false, &thick->light_blur,
                  sf_thick_blur_radius(frame->scene->thick.light_blur));
    return SF_OK;
}

/* The tiles that spheres touch, in order, and the list of each. */
static void add_lists(struct sf_method_frame *frame, struct sf_thick *thick)
{
    struct sf_graph *graph = frame->graph;
    uint64_t tiles = (uint64_t)thick->push.tiles_x * thick->push.tiles_y, capacity = thick->push.capacity;
    sf_resource touching = sf_thick_buffer(graph, "thick.touching", 4 * tiles);
    sf_resource rectangles = sf_thick_buffer(graph, "thick.rectangles", 8 * capacity);
    thick->spheres = sf_thick_buffer(graph, "thick.spheres", sizeof(struct sf_thick_sphere) * (capacity + 1));
    thick->ranges = sf_thick_buffer(graph, "thick.ranges", 8 * tiles);
    thick->list = sf_thick_buffer(graph, "thick.list", 4ull * thick->push.list_words);
    sf_thick_empty(frame, thick, "thick.uncount", touching);
    const struct sf_use project[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = frame->particles, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = frame->counts, .access = SF_ACCESS_STORAGE_READ, .binding = 2},
        {.resource = touching, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 3},
        {.resource = thick->spheres, .access = SF_ACCESS_STORAGE_WRITE, .binding = 4},
        {.resource = rectangles, .access = SF_ACCESS_STORAGE_WRITE, .binding = 5},
    };
    sf_thick_pass(frame, thick, project, SF_COUNT(project),
                  (struct sf_pass_desc){.name = "thick.project",
                                        .kind = SF_PASS_COMPUTE,
                                        .shader = "thick/project.comp",
                                        .indirect = frame->counts,
                                        .indirect_offset = SF_COUNTS_DISPATCH_OFFSET});
    const struct sf_use tile_list[] = {
        {.resource = touching, .access = SF_ACCESS_STORAGE_READ, .binding = 0},
        {.resource = thick->tiles, .access = SF_ACCESS_STORAGE_WRITE, .binding = 1},
        {.resource = thick->args, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 2},
        {.resource = thick->ranges, .access = SF_ACCESS_STORAGE_WRITE, .binding = 3},
        {.resource = frame->counts, .access = SF_ACCESS_STORAGE_READ, .binding = 4},
    };
    sf_thick_pass(
        frame, thick, tile_list, SF_COUNT(tile_list),
        (struct sf_pass_desc){
            .name = "thick.tiles", .kind = SF_PASS_COMPUTE, .shader = "thick/tiles.comp", .groups = {1, 1, 1}});
    const struct sf_use lists[] = {
        {.resource = frame->counts, .access = SF_ACCESS_STORAGE_READ, .binding = 0},
        {.resource = thick->tiles, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = thick->ranges, .access = SF_ACCESS_STORAGE_READ, .binding = 2},
        {.resource = rectangles, .access = SF_ACCESS_STORAGE_READ, .binding = 3},
        {.resource = thick->list, .access = SF_ACCESS_STORAGE_WRITE, .binding = 4},
    };
    sf_thick_pass(frame, thick, lists, SF_COUNT(lists),
                  (struct sf_pass_desc){.name = "thick.lists",
                                        .kind = SF_PASS_COMPUTE,
                                        .shader = "thick/lists.comp",
                                        .indirect = thick->args,
                                        .indirect_offset = SF_THICK_DISPATCH_TILES_OFFSET});
}

static void add_march(struct sf_method_frame *frame, struct sf_thick *thick)
{
    const struct sf_thick_settings *settings = &frame->scene->thick;
    bool positional = sf_thick_positional(frame->scene);
    struct sf_use uses[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = thick->tiles, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = thick->args, .access = SF_ACCESS_UNIFORM, .binding = 2},
        {.resource = frame->smoke_views, .access = SF_ACCESS_UNIFORM, .binding = 3},
        {.resource = thick->light_raw, .access = SF_ACCESS_SAMPLED, .binding = 4},
        {.resource = thick->slices, .access = SF_ACCESS_STORAGE_READ, .binding = 5},
        {.resource = thick->atlas, .access = SF_ACCESS_SAMPLED, .binding = 6},
        {.resource = frame->shadow_map, .access = SF_ACCESS_SAMPLED, .binding = 7},
        {.resource = thick->smoke_depth, .access = SF_ACCESS_SAMPLED, .binding = 8},
        {.resource = thick->smoke, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 9},
        {.resource = thick->spheres, .access = SF_ACCESS_STORAGE_READ, .binding = 10},
        {.resource = thick->ranges, .access = SF_ACCESS_STORAGE_READ, .binding = 11},
        {.resource = thick->list, .access = SF_ACCESS_STORAGE_READ, .binding = 12},
    };
    struct sf_pass_desc march = {.name = "thick.march",
                                 .kind = SF_PASS_COMPUTE,
                                 .shader = "thick/march.comp",
                                 .constants = {(uint32_t)settings->steps, frame->scene->light_count,
                                               settings->scene_shadow, (uint32_t)settings->octaves, positional,
                                               settings->detail > 0, (uint32_t)settings->placement,
                                               frame->scene->ramp_count > 0, slices_of(frame->scene), turn_of(frame)},
                                 .constant_count = 10,
                                 .indirect = thick->args,
                                 .indirect_offset = SF_THICK_DISPATCH_TILES_OFFSET};
    sf_thick_pass(frame, thick, uses, SF_COUNT(uses), march);
    if (!frame->want_probe)
        return;
    march.name = "thick.probe";
    march.shader = "thick/probe.comp";
    sf_thick_probe(frame, thick, uses, SF_COUNT(uses), march);
}

/* Optical depth of the frame's own pixels; with what is asked for beside the picture, near and far as well. */
static void add_whole(struct sf_method_frame *frame, struct sf_thick *thick)
{
    thick->whole = sf_thick_image(frame->graph, "smoke.whole", frame->want_aovs ? SF_FORMAT_RGBA32F : SF_FORMAT_R32F,
                                  frame->width, frame->height);
    const struct sf_use uses[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = thick->tiles, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = thick->args, .access = SF_ACCESS_UNIFORM, .binding = 2},
        {.resource = frame->depth, .access = SF_ACCESS_SAMPLED, .binding = 3},
        {.resource = thick->atlas, .access = SF_ACCESS_SAMPLED, .binding = 4},
        {.resource = thick->spheres, .access = SF_ACCESS_STORAGE_READ, .binding = 5},
        {.resource = thick->ranges, .access = SF_ACCESS_STORAGE_READ, .binding = 6},
        {.resource = thick->list, .access = SF_ACCESS_STORAGE_READ, .binding = 7},
        {.resource = thick->whole, .access = SF_ACCESS_STORAGE_WRITE, .binding = 8},
        {.resource = thick->mask, .access = SF_ACCESS_STORAGE_READ, .binding = 9},
    };
    sf_thick_pass(
        frame, thick, uses, SF_COUNT(uses),
        (struct sf_pass_desc){.name = "thick.whole",
                              .kind = SF_PASS_COMPUTE,
                              .shader = frame->want_aovs ? "thick/whole_aovs.comp" : "thick/whole.comp",
                              .constants = {thick->push.scale, frame->scene->thick.detail > 0, turn_of(frame)},
                              .constant_count = 3,
                              .indirect = thick->args,
                              .indirect_offset = SF_THICK_DISPATCH_TILES_OFFSET});
}

enum sf_status sf_thick_view(struct sf_method_frame *frame, void *state, const struct sf_log *log)
{
    struct sf_thick *thick = state;
    enum sf_status status = sf_thick_targets(frame, thick, SF_FORMAT_RGBA16F, log);

    if (status)
        return status;
    if (frame->tuning && frame->tuning->software && thick->push.capacity > TILE_SPHERES_MAX)
        sf_log(
            log, SF_LOG_WARNING,
            "thick: on a software device a tile of 16x16 pixels that more than %d particles touch is drawn wrong, and "
            "sim.capacity allows %u",
            TILE_SPHERES_MAX, thick->push.capacity);
    add_lists(frame, thick);
    sf_thick_prepare(frame, thick, "thick.prepare");
    add_march(frame, thick);
    if (thick->push.scale > 1 || frame->want_aovs)
        add_whole(frame, thick);
    const struct sf_use whole = {
        .resource = thick->whole ? thick->whole : thick->smoke_depth, .access = SF_ACCESS_SAMPLED, .binding = 5};
    const struct sf_thick_full over = {.names = {"thick.over", "thick.over_plain", "thick.over_cut"},
                                       .fragment = "thick/over.frag",
                                       .reads = {whole},
                                       .read_count = 1};
    const struct sf_thick_full aovs = {
        .names = {"thick.aovs"}, .fragment = "thick/aovs.frag", .reads = {whole}, .read_count = 1};
    sf_thick_over(frame, thick, &over);
    if (frame->want_aovs)
        sf_thick_aovs(frame, thick, SF_FORMAT_RGBA16F, &aovs);
    return SF_OK;
}
