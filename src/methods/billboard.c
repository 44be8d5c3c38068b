#include "methods/billboard.h"

#include <stddef.h>
#include "methods/larsson.h"
#include "methods/volumetric.h"
#include "shared/frame.h"
#include "shared/particle.h"
#include "shared/volumetric.h"

_Static_assert(sizeof(struct sf_billboard_push) <= SF_PUSH_BYTES_MAX, "push constants");
_Static_assert(sizeof(struct sf_billboard) == 112, "as GLSL has it");
_Static_assert(offsetof(struct sf_billboards, thick) == 0, "the state of the lights' part");

/* The method's settings, as its shader has them. */
static void fill_own(const struct sf_scene *scene, struct sf_billboard_push *push)
{
    float *own = push->own;

    switch ((enum sf_method)scene->method) {
    case SF_METHOD_SOFT:
    case SF_METHOD_CONTRAST:
        own[0] = scene->soft.distance;
        own[1] = scene->soft.power;
        break;
    case SF_METHOD_AVERAGE:
        own[0] = scene->average.depth;
        own[1] = scene->average.plane;
        own[2] = scene->average.opacity;
        break;
    case SF_METHOD_EXTENT:
        own[0] = scene->extent.depth;
        own[1] = scene->extent.opacity;
        own[2] = scene->extent.deviation;
        own[3] = scene->extent.lighting;
        break;
    case SF_METHOD_VOLUMETRIC:
        sf_volumetric_density(scene->volumetric.strength, own);
        own[3] = scene->volumetric.scale / (2 * SF_VOLUMETRIC_CELLS);
        push->more[0][0] = 6.28318531f * scene->volumetric.evolution;
        push->more[0][1] = scene->volumetric.lighting;
        break;
    default:
        break;
    }
}

void sf_billboard_update(const struct sf_method_frame *frame, void *state)
{
    struct sf_billboards *billboards = state;
    const struct sf_billboard_settings *settings = &frame->scene->billboard;
    const struct sf_thick_settings *thick = &frame->scene->thick;
    uint32_t scale = sf_thick_scale(frame->scene);

    sf_larsson_update(frame, &billboards->thick);
    billboards->thick.push.reach = scale > 1; /* of a smoke pixel at the edge, for the upsampling */
    billboards->push = (struct sf_billboard_push){
        .width = sf_divide_up(frame->width, scale),
        .height = sf_divide_up(frame->height, scale),
        .scale = scale,
        .density = settings->density,
        .detail = thick->detail,
        .detail_scale = thick->detail_scale,
        .ambient = thick->ambient,
        .near_fade = settings->near_fade,
    };
    fill_own(frame->scene, &billboards->push);
}

enum sf_status sf_billboard_light(struct sf_method_frame *frame, void *state, const struct sf_log *log)
{
    struct sf_billboards *billboards = state;

    sf_billboard_update(frame, billboards);
    return sf_larsson_shadow(frame, &billboards->thick, log);
}

static void add_pass(struct sf_method_frame *frame, const struct sf_billboards *billboards, const struct sf_use *uses,
                     uint32_t use_count, struct sf_pass_desc desc)
{
    desc.uses = uses;
    desc.use_count = use_count;
    desc.push = &billboards->push;
    desc.push_bytes = sizeof billboards->push;
    sf_graph_pass(frame->graph, &desc);
}

/* The particles back to front, and lit; `others`: not dimmed by themselves. */
static void add_list(struct sf_method_frame *frame, struct sf_billboards *billboards, bool others)
{
    const struct sf_scene *scene = frame->scene;
    uint32_t capacity = (uint32_t)scene->sim.capacity;
    bool narrow = frame->tuning && frame->tuning->subgroup_size < SF_THICK_TURN;

    sf_sort_tune(frame->tuning, capacity, &billboards->sort_tuning);
    sf_resource pairs =
        sf_thick_buffer(frame->graph, "billboard.pairs", sf_sort_bytes(&billboards->sort_tuning, capacity));
    const struct sf_use keys[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = frame->particles, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = frame->counts, .access = SF_ACCESS_STORAGE_READ, .binding = 2},
        {.resource = pairs, .access = SF_ACCESS_STORAGE_WRITE, .binding = 3},
    };
    sf_graph_pass(frame->graph, &(struct sf_pass_desc){.name = "billboard.keys",
                                                       .kind = SF_PASS_COMPUTE,
                                                       .uses = keys,
                                                       .use_count = SF_COUNT(keys),
                                                       .shader = "billboard/keys.comp",
                                                       .indirect = frame->counts,
                                                       .indirect_offset = SF_COUNTS_DISPATCH_OFFSET});
    sf_resource order = sf_sort_declare(frame->graph,
                                        &(struct sf_sort_desc){.name = "billboard.sort",
                                                               .capacity = capacity,
                                                               .pairs = pairs,
                                                               .count = frame->counts,
                                                               .tuning = &billboards->sort_tuning},
                                        &billboards->sort);

    billboards->list =
        sf_thick_buffer(frame->graph, "billboard.list", (uint64_t)capacity * sizeof(struct sf_billboard));
    const struct sf_use shade[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = frame->particles, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = frame->counts, .access = SF_ACCESS_STORAGE_READ, .binding = 2},
        {.resource = order, .access = SF_ACCESS_STORAGE_READ, .binding = 3},
        {.resource = frame->shadow_map, .access = SF_ACCESS_SAMPLED, .binding = 4},
        {.resource = billboards->thick.args, .access = SF_ACCESS_UNIFORM, .binding = 5},
        {.resource = billboards->list, .access = SF_ACCESS_STORAGE_WRITE, .binding = 6},
    };
    add_pass(frame, billboards, shade, SF_COUNT(shade),
             (struct sf_pass_desc){.name = "billboard.shade",
                                   .kind = SF_PASS_COMPUTE,
                                   .shader = "billboard/shade.comp",
                                   .constants = {scene->light_count, scene->billboard.self_shadow,
                                                 scene->thick.scene_shadow, scene->ramp_count > 0,
                                                 narrow ? 4 : SF_THICK_TURN, (uint32_t)scene->thick.octaves, others},
                                   .constant_count = 7,
                                   .indirect = frame->counts,
                                   .indirect_offset = SF_COUNTS_DISPATCH_OFFSET});
}

enum { DRAW_USES = 12 };

static void add_draw(struct sf_method_frame *frame, struct sf_billboards *billboards,
                     const struct sf_billboard_look *look, struct sf_use target)
{
    bool detail = frame->scene->thick.detail > 0;
    struct sf_use uses[DRAW_USES] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = billboards->list, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = billboards->thick.smoke_depth, .access = SF_ACCESS_SAMPLED, .binding = 2},
        {.resource = billboards->thick.atlas, .access = SF_ACCESS_SAMPLED, .binding = 3},
    };
    uint32_t count = 4;

    for (uint32_t i = 0; i < look->use_count; i++)
        uses[count++] = look->uses[i];
    uses[count++] = target;
    struct sf_pass_desc desc = {
        .name = look->name,
        .kind = SF_PASS_RASTER,
        .shader = "billboard/quad.vert",
        .fragment = look->fragment,
        .constants = {look->whole, detail},
        .constant_count = 2 + look->constant_count,
        .indirect = frame->counts,
        .indirect_offset = SF_COUNTS_DRAW_OFFSET,
        .raster = {.blend = {look->blend ? look->blend : SF_BLEND_PREMULTIPLIED}, .triangle_strip = true}};
    for (uint32_t i = 0; i < look->constant_count; i++)
        desc.constants[2 + i] = look->constants[i];
    add_pass(frame, billboards, uses, count, desc);
}

/* How reduced smoke is taken up, as tile.vert has it, where the tiles are not drawn in two passes. */
static uint32_t whole_choice(const struct sf_scene *scene)
{
    return scene->billboard.upsample == SF_UPSAMPLE_PLAIN ? 3 : 0;
}

static void add_over(struct sf_method_frame *frame, const struct sf_billboards *billboards)
{
    const struct sf_thick_full over = {.names = {"billboard.over", "billboard.over_plain", "billboard.over_cut"},
                                       .fragment = "larsson/over.frag",
                                       .choice = whole_choice(frame->scene)};

    sf_thick_over(frame, &billboards->thick, &over);
}

static void add_aovs(struct sf_method_frame *frame, struct sf_billboards *billboards)
{
    sf_resource extent = sf_thick_image(frame->graph, "smoke.extent", SF_FORMAT_RGBA32F, billboards->push.width,
                                        billboards->push.height);
    const struct sf_billboard_look look = {
        .name = "billboard.depths", .fragment = "billboard/depths.frag", .whole = true, .blend = SF_BLEND_MIN_ADD};

    add_draw(frame, billboards, &look,
             (struct sf_use){.resource = extent,
                             .access = SF_ACCESS_COLOR,
                             .binding = 0,
                             .load = SF_LOAD_CLEAR,
                             .clear = {SF_DEPTH_FAR, SF_DEPTH_FAR, 1, 0}});
    const struct sf_thick_full aovs = {.names = {"billboard.aovs"},
                                       .fragment = "billboard/aovs.frag",
                                       .reads = {{.resource = extent, .access = SF_ACCESS_SAMPLED, .binding = 5}},
                                       .read_count = 1,
                                       .choice = whole_choice(frame->scene)};
    sf_thick_aovs(frame, &billboards->thick, SF_FORMAT_RGBA32F, &aovs);
}

enum sf_status sf_billboard_view(struct sf_method_frame *frame, void *state, const struct sf_billboard_look *look,
                                 const struct sf_log *log)
{
    static const char *const tile_names[] = {"billboard.mark", "billboard.tiles"};
    struct sf_billboards *billboards = state;
    struct sf_thick *thick = &billboards->thick;
    /* A layer more is a rounding more: 32 bits. */
    enum sf_status status = sf_thick_targets(frame, thick, SF_FORMAT_RGBA32F, log);

    if (status)
        return status;
    sf_thick_tiles(frame, thick, tile_names);
    sf_thick_prepare(frame, thick, "billboard.prepare");
    add_list(frame, billboards, look->dims_itself);
    add_draw(frame, billboards, look,
             (struct sf_use){.resource = thick->smoke, .access = SF_ACCESS_COLOR, .binding = 0, .load = SF_LOAD_KEEP});
    add_over(frame, billboards);
    if (frame->want_aovs)
        add_aovs(frame, billboards);
    return SF_OK;
}
