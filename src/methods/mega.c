/* Mega particles (Larsson 3.2): opaque balls, lit after Phong, blurred, and looked up at places moved by a noise.
 *
 * The thesis draws and lights each ball; here the depth test first finds the ball that a pixel sees, and light is
 * computed once a pixel. Tiles, their list and the laying over the scene are thick-larsson's. */
#include "methods/mega.h"

#include <math.h>
#include <stddef.h>
#include "methods/larsson.h"
#include "shared/frame.h"
#include "shared/particle.h"

_Static_assert(sizeof(((struct sf_mega *)0)->push) <= SF_PUSH_BYTES_MAX, "push constants");
_Static_assert(sizeof(struct sf_thick_push) % 16 == 0, "the method's own follow it");
_Static_assert(sizeof(struct sf_mega_ball) == 32, "as GLSL has it");
_Static_assert(offsetof(struct sf_mega, thick) == 0, "the state of the lights' part");

static const float LONGEST = 2.5f; /* displacement, in root mean squares */

/* The largest radius that particles are born with, m. */
static float radius_at_birth(const struct sf_scene *scene)
{
    float largest = 0;

    for (uint32_t i = 0; i < scene->emitter_count; i++) {
        const struct sf_emitter *emitter = &scene->emitters[i];
        if (emitter->kind != SF_EMITTER_LIST)
            largest = fmaxf(largest, emitter->particle_radius[1]);
        for (uint32_t k = 0; k < emitter->list_count; k++)
            largest = fmaxf(largest, emitter->list[k].radius);
    }
    return largest > 0 ? largest : 1;
}

/* Sigma of the blur, in pixels of the smoke's image. */
static float blur_sigma(const struct sf_method_frame *frame)
{
    return frame->scene->mega.blur * (float)frame->height / (float)sf_thick_scale(frame->scene);
}

void sf_mega_update(const struct sf_method_frame *frame, void *state)
{
    struct sf_mega *mega = state;
    const struct sf_mega_settings *settings = &frame->scene->mega;
    float height = (float)frame->height / (float)sf_thick_scale(frame->scene), power = 0;
    float born = radius_at_birth(frame->scene), amplitude = settings->amplitude * height;
    float eddy = settings->scale > 0 ? settings->scale : 2 * born;

    for (int i = 0; i < settings->octaves; i++)
        power += powf(4, -(float)i / 3); /* as sf_curl_noise_octaves weighs them */
    sf_larsson_update(frame, &mega->thick);
    mega->thick.push.reach = sf_thick_blur_radius(blur_sigma(frame));
    sf_thick_blur_weights(blur_sigma(frame), mega->thick.camera_blur.weight);
    mega->push.push = mega->thick.push;
    mega->push.own = (struct sf_mega_push){
        /* Two of the noise's three coordinates, whose squares sum to 1 in the mean. */
        .amplitude = settings->octaves > 0 ? amplitude * sqrtf(1.5f / power) : 0,
        .limit = LONGEST * amplitude,
        .frequency = settings->noise == SF_MEGA_WORLD ? 1 / eddy : 1 / (settings->screen_scale * height),
        .speed = settings->speed,
        .soft = settings->soft > 0 ? settings->soft : born,
        .diffuse = settings->diffuse,
        .specular = settings->specular,
        .shininess = settings->shininess,
    };
}

enum sf_status sf_mega_light(struct sf_method_frame *frame, void *state, const struct sf_log *log)
{
    struct sf_mega *mega = state;

    sf_mega_update(frame, mega);
    return sf_larsson_shadow(frame, &mega->thick, log);
}

/* A pass with the push constants of both. */
static void add_pass(struct sf_method_frame *frame, const struct sf_mega *mega, const struct sf_use *uses,
                     uint32_t use_count, struct sf_pass_desc desc)
{
    desc.uses = uses;
    desc.use_count = use_count;
    desc.push = &mega->push;
    desc.push_bytes = sizeof mega->push;
    sf_graph_pass(frame->graph, &desc);
}

/* A pass over the tiles in the smoke's image; `constants` from id 4 on. What the upsampling reads beside the tiles was
 * cleared: that is cheaper than tiles that overlap. */
static void add_tile_pass(struct sf_method_frame *frame, const struct sf_mega *mega, const struct sf_use *uses,
                          uint32_t use_count, const uint32_t constants[2], struct sf_pass_desc desc)
{
    desc.kind = SF_PASS_RASTER;
    desc.shader = "thick/tile.vert";
    desc.constants[2] = mega->thick.push.scale;
    desc.constants[4] = constants[0];
    desc.constants[5] = constants[1];
    desc.constant_count = 6;
    desc.indirect = mega->thick.args;
    desc.indirect_offset = SF_THICK_DRAW_TILES_OFFSET;
    desc.raster.triangle_strip = true;
    add_pass(frame, mega, uses, use_count, desc);
}

/* The particles as balls, and the ball that each pixel sees. */
static void add_balls(struct sf_method_frame *frame, struct sf_mega *mega)
{
    uint32_t width = mega->thick.push.width, height = mega->thick.push.height;

    mega->balls =
        sf_thick_buffer(frame->graph, "mega.balls", (uint64_t)frame->scene->sim.capacity * sizeof(struct sf_mega_ball));
    const struct sf_use make[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = frame->particles, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = frame->counts, .access = SF_ACCESS_STORAGE_READ, .binding = 2},
        {.resource = mega->balls, .access = SF_ACCESS_STORAGE_WRITE, .binding = 3},
    };
    sf_graph_pass(frame->graph, &(struct sf_pass_desc){.name = "mega.make",
                                                       .kind = SF_PASS_COMPUTE,
                                                       .uses = make,
                                                       .use_count = SF_COUNT(make),
                                                       .shader = "mega/balls.comp",
                                                       .constants = {frame->scene->ramp_count > 0},
                                                       .constant_count = 1,
                                                       .indirect = frame->counts,
                                                       .indirect_offset = SF_COUNTS_DISPATCH_OFFSET});
    mega->numbers = sf_thick_image(frame->graph, "mega.numbers", SF_FORMAT_R32F, width, height);
    sf_resource z = sf_thick_image(frame->graph, "mega.z", SF_FORMAT_D32F, width, height);
    const struct sf_use draw[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = mega->balls, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = mega->numbers, .access = SF_ACCESS_COLOR, .binding = 0, .load = SF_LOAD_CLEAR, .clear = {-1}},
        {.resource = z, .access = SF_ACCESS_DEPTH, .load = SF_LOAD_CLEAR},
    };
    add_pass(frame, mega, draw, SF_COUNT(draw),
             (struct sf_pass_desc){.name = "mega.draw",
                                   .kind = SF_PASS_RASTER,
                                   .shader = "mega/ball.vert",
                                   .fragment = "mega/ball.frag",
                                   .indirect = frame->counts,
                                   .indirect_offset = SF_COUNTS_DRAW_OFFSET,
                                   .raster = {.depth = SF_DEPTH_GREATER_EQUAL, .triangle_strip = true}});
}

static void add_shade(struct sf_method_frame *frame, struct sf_mega *mega)
{
    struct sf_thick *thick = &mega->thick;
    uint32_t width = thick->push.width, height = thick->push.height;

    thick->raw = sf_thick_image(frame->graph, "mega.raw", SF_FORMAT_RGBA32F, width, height);
    mega->blurred = sf_thick_image(frame->graph, "mega.blurred", SF_FORMAT_RGBA16F, width, height);
    mega->blurred_depth = sf_thick_image(frame->graph, "mega.blurred_depth", SF_FORMAT_R32F, width, height);
    const struct sf_use uses[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = thick->tiles, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = frame->depth, .access = SF_ACCESS_SAMPLED, .binding = 2},
        {.resource = mega->balls, .access = SF_ACCESS_STORAGE_READ, .binding = 3},
        {.resource = mega->numbers, .access = SF_ACCESS_SAMPLED, .binding = 4},
        {.resource = frame->shadow_map, .access = SF_ACCESS_SAMPLED, .binding = 5},
        {.resource = thick->args, .access = SF_ACCESS_STORAGE_READ, .binding = 7},
        {.resource = thick->mask, .access = SF_ACCESS_STORAGE_MODIFY, .binding = 8},
        {.resource = thick->raw, .access = SF_ACCESS_COLOR, .binding = 0, .load = SF_LOAD_DISCARD},
        {.resource = thick->smoke_depth,
         .access = SF_ACCESS_COLOR,
         .binding = 1,
         .load = SF_LOAD_CLEAR,
         .clear = {SF_DEPTH_FAR}},
        {.resource = mega->blurred, .access = SF_ACCESS_COLOR, .binding = 2, .load = SF_LOAD_CLEAR},
        {.resource = mega->blurred_depth, .access = SF_ACCESS_COLOR, .binding = 3, .load = SF_LOAD_CLEAR},
    };
    add_tile_pass(frame, mega, uses, SF_COUNT(uses),
                  (const uint32_t[]){frame->scene->light_count, frame->scene->thick.scene_shadow},
                  (struct sf_pass_desc){.name = "mega.shade", .fragment = "mega/shade.frag"});
}

static void add_blur(struct sf_method_frame *frame, struct sf_mega *mega)
{
    struct sf_thick *thick = &mega->thick;
    uint32_t width = thick->push.width, height = thick->push.height;
    static const char *const names[] = {"mega.blur_x", "mega.blur_y"};
    const sf_resource half_way = sf_thick_image(frame->graph, "mega.half", SF_FORMAT_RGBA16F, width, height);
    const sf_resource half_depth = sf_thick_image(frame->graph, "mega.half_depth", SF_FORMAT_R32F, width, height);
    const sf_resource colors[] = {thick->raw, half_way, mega->blurred};
    const sf_resource depths[] = {thick->raw, half_depth, mega->blurred_depth};

    for (uint32_t vertical = 0; vertical < 2; vertical++) {
        /* The last images stay empty beside the tiles. */
        enum sf_access access = vertical ? SF_ACCESS_STORAGE_MODIFY : SF_ACCESS_STORAGE_WRITE;
        const struct sf_use uses[] = {
            {.resource = colors[vertical], .access = SF_ACCESS_SAMPLED, .binding = 0},
            {.resource = depths[vertical], .access = SF_ACCESS_SAMPLED, .binding = 1},
            {.resource = colors[vertical + 1], .access = access, .binding = 2},
            {.resource = depths[vertical + 1], .access = access, .binding = 3},
            {.resource = thick->tiles, .access = SF_ACCESS_STORAGE_READ, .binding = 4},
            {.resource = thick->mask, .access = SF_ACCESS_STORAGE_READ, .binding = 5},
        };
        sf_graph_pass(frame->graph,
                      &(struct sf_pass_desc){.name = names[vertical],
                                             .kind = SF_PASS_COMPUTE,
                                             .shader = "mega/blur.comp",
                                             .uses = uses,
                                             .use_count = SF_COUNT(uses),
                                             .constants = {vertical, sf_thick_blur_radius(blur_sigma(frame))},
                                             .constant_count = 2,
                                             .push = &thick->camera_blur,
                                             .push_bytes = sizeof thick->camera_blur,
                                             .indirect = thick->args,
                                             .indirect_offset = SF_THICK_DISPATCH_TILES_OFFSET});
    }
}

static void add_displace(struct sf_method_frame *frame, struct sf_mega *mega)
{
    const struct sf_mega_settings *settings = &frame->scene->mega;
    struct sf_thick *thick = &mega->thick;
    sf_resource cut = sf_thick_image(frame->graph, "mega.cut", SF_FORMAT_R32F, thick->push.width, thick->push.height);
    const struct sf_use uses[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = thick->tiles, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = mega->blurred, .access = SF_ACCESS_SAMPLED, .binding = 2, .sampler = SF_SAMPLER_LINEAR},
        {.resource = mega->blurred_depth, .access = SF_ACCESS_SAMPLED, .binding = 3},
        {.resource = thick->smoke_depth, .access = SF_ACCESS_SAMPLED, .binding = 4},
        {.resource = thick->args, .access = SF_ACCESS_STORAGE_READ, .binding = 7},
        {.resource = thick->mask, .access = SF_ACCESS_STORAGE_READ, .binding = 8},
        {.resource = thick->smoke, .access = SF_ACCESS_COLOR, .binding = 0, .load = SF_LOAD_CLEAR},
        {.resource = cut, .access = SF_ACCESS_COLOR, .binding = 1, .load = SF_LOAD_CLEAR, .clear = {-SF_DEPTH_FAR}},
    };

    add_tile_pass(frame, mega, uses, SF_COUNT(uses),
                  (const uint32_t[]){settings->noise == SF_MEGA_SCREEN, (uint32_t)settings->octaves},
                  (struct sf_pass_desc){.name = "mega.displace", .fragment = "mega/displace.frag"});
    thick->smoke_depth = cut; /* what the upsampling reads in its place */
}

static void add_aovs(struct sf_method_frame *frame, struct sf_mega *mega)
{
    struct sf_thick *thick = &mega->thick;
    sf_resource extent =
        sf_thick_image(frame->graph, "mega.extent", SF_FORMAT_RGBA32F, thick->push.width, thick->push.height);
    const struct sf_use depths[] = {
        {.resource = frame->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = mega->balls, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = extent,
         .access = SF_ACCESS_COLOR,
         .binding = 0,
         .load = SF_LOAD_CLEAR,
         .clear = {SF_DEPTH_FAR, SF_DEPTH_FAR, 1, 0}},
    };

    add_pass(frame, mega, depths, SF_COUNT(depths),
             (struct sf_pass_desc){.name = "mega.depths",
                                   .kind = SF_PASS_RASTER,
                                   .shader = "mega/ball.vert",
                                   .fragment = "mega/depths.frag",
                                   .indirect = frame->counts,
                                   .indirect_offset = SF_COUNTS_DRAW_OFFSET,
                                   .raster = {.blend = {SF_BLEND_MIN_ADD}, .triangle_strip = true}});
    const struct sf_thick_full aovs = {.names = {"mega.aovs"},
                                       .fragment = "mega/aovs.frag",
                                       .reads = {{.resource = extent, .access = SF_ACCESS_SAMPLED, .binding = 5}},
                                       .read_count = 1};
    sf_thick_aovs(frame, thick, SF_FORMAT_RGBA16F, &aovs);
}

enum sf_status sf_mega_view(struct sf_method_frame *frame, void *state, const struct sf_log *log)
{
    struct sf_mega *mega = state;
    static const char *const tile_names[] = {"mega.mark", "mega.tiles"};
    enum sf_status status = sf_thick_targets(frame, &mega->thick, SF_FORMAT_RGBA16F, log);

    if (status)
        return status;
    sf_thick_tiles(frame, &mega->thick, tile_names);
    add_balls(frame, mega);
    add_shade(frame, mega);
    add_blur(frame, mega);
    add_displace(frame, mega);
    const struct sf_thick_full over = {.names = {"mega.over", "mega.over_plain", "mega.over_cut"},
                                       .fragment = "mega/over.frag"};
    sf_thick_over(frame, &mega->thick, &over);
    if (frame->want_aovs)
        add_aovs(frame, mega);
    return SF_OK;
}
