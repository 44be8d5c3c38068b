#include "render/assemble.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "shared/particle.h"

_Static_assert(sizeof(struct sf_particle) == 64, "std430");
_Static_assert(sizeof(struct sf_particle_counts) == 96, "std430");
_Static_assert(sizeof(struct sf_gpu_light_view) == 96, "std140");
_Static_assert(sizeof(struct sf_flash_push) == 16, "push constants");

/* What a round of passes over the scene's objects writes. */
enum writes { BOTH, DEPTH, COLOR, WRITES };

/* Resources that only this file needs. */
struct parts {
    struct sf_assembly *assembly;
    sf_resource z;
    enum writes writes;
    bool equal; /* the colours of a round are drawn where z is that of the round before */
    uint32_t constants[SF_SHADE_CONSTANTS];
};

static sf_resource import_image(struct sf_graph *graph, const char *name, enum sf_format format, uint32_t width,
                                uint32_t height)
{
    return sf_graph_image(graph, &(struct sf_image_desc){.name = name,
                                                         .format = format,
                                                         .lifetime = SF_IMPORTED,
                                                         .size = {.width = width, .height = height},
                                                         .outside = SF_ACCESS_SAMPLED});
}

static sf_resource import_buffer(struct sf_graph *graph, const char *name, uint64_t bytes, bool history)
{
    return sf_graph_buffer(graph, &(struct sf_buffer_desc){.name = name,
                                                           .lifetime = SF_IMPORTED,
                                                           .bytes = bytes,
                                                           .outside = SF_ACCESS_STORAGE_READ,
                                                           .history = history});
}

static sf_resource upload(struct sf_graph *graph, const char *name, uint64_t bytes)
{
    return sf_graph_buffer(graph, &(struct sf_buffer_desc){.name = name, .lifetime = SF_UPLOAD, .bytes = bytes});
}

static sf_resource frame_image(const struct sf_assembly *assembly, const char *name, enum sf_format format)
{
    return sf_graph_image(assembly->graph,
                          &(struct sf_image_desc){.name = name,
                                                  .format = format,
                                                  .lifetime = SF_TRANSIENT,
                                                  .size = {.width = assembly->width, .height = assembly->height}});
}

/* One texel that stands in where the shader has a sampler and the scene nothing to sample. */
static sf_resource blank(struct sf_assembly *assembly)
{
    if (!assembly->blank)
        assembly->blank = import_image(assembly->graph, "blank", SF_FORMAT_RGBA16F, 1, 1);
    return assembly->blank;
}

static void declare_inputs(struct sf_assembly *assembly, const struct sf_assembly_options *options)
{
    struct sf_graph *graph = assembly->graph;
    struct sf_method_frame *method = &assembly->method;
    const struct sf_scene *scene = assembly->drawn.scene;
    const struct sf_shadow_cells *shadow = &assembly->drawn.shadow;

    method->frame = upload(graph, "frame", sizeof(struct sf_gpu_frame));
    method->objects = assembly->objects_upload =
        upload(graph, "objects", sizeof(struct sf_gpu_object) * SF_FRAME_OBJECTS);
    method->planes = assembly->drawn.list.planes;
    method->solids = assembly->drawn.list.solids;
    method->particles = import_buffer(graph, "particles", options->capacity * sizeof(struct sf_particle), true);
    method->counts = import_buffer(graph, "counts", sizeof(struct sf_particle_counts), false);
    if (shadow->count > 0)
        method->shadow_map =
            import_image(graph, "shadow.map", SF_FORMAT_R32F, shadow->size * shadow->count, shadow->size);
    else
        method->shadow_map = blank(assembly);
    if (sf_scene_shows_picture(scene))
        assembly->environment =
            import_image(graph, "environment", SF_FORMAT_RGBA16F, scene->environment.width, scene->environment.height);
    if (assembly->drawn.list.meshes > 0) {
        assembly->vertices = import_buffer(graph, "mesh.vertices", assembly->drawn.meshes.vertex_bytes, false);
        assembly->indices = import_buffer(graph, "mesh.indices", assembly->drawn.meshes.index_bytes, false);
    }
}

enum { SHADE_USES = 6 };

/* Bindings 0-4 of glsl/scene/shade.glsl; the number of uses. */
static uint32_t shade_uses(const struct parts *parts, struct sf_use uses[SHADE_USES])
{
    struct sf_assembly *assembly = parts->assembly;
    const struct sf_method_frame *method = &assembly->method;
    bool smoke = parts->constants[SF_SHADE_CASTS] != 0;
    const struct sf_use all[SHADE_USES - 1] = {
        {.resource = method->frame, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = assembly->objects_upload, .access = SF_ACCESS_UNIFORM, .binding = 1},
        {.resource = method->shadow_map, .access = SF_ACCESS_SAMPLED, .binding = 2},
        {.resource = smoke ? method->smoke_map : blank(assembly),
         .access = SF_ACCESS_SAMPLED,
         .binding = 3,
         .sampler = SF_SAMPLER_LINEAR},
        {.resource = smoke ? method->smoke_views : assembly->objects_upload, .access = SF_ACCESS_UNIFORM, .binding = 4},
    };

    memcpy(uses, all, sizeof all);
    return SHADE_USES - 1;
}

enum { TARGET_USES = 3 };

/* The picture, the linear depth, and (for finite objects) the reversed z; the number of uses. `first`: of the round, so
 * that the targets hold nothing yet. */
static uint32_t target_uses(const struct parts *parts, bool first, bool with_z, bool first_z,
                            struct sf_use uses[TARGET_USES])
{
    const struct sf_method_frame *method = &parts->assembly->method;
    enum sf_load load = first ? SF_LOAD_DISCARD : SF_LOAD_KEEP;
    uint32_t count = 0;

    if (parts->writes != DEPTH)
        uses[count++] = (struct sf_use){.resource = method->color, .access = SF_ACCESS_COLOR, .load = load};
    if (parts->writes != COLOR) {
        uses[count] =
            (struct sf_use){.resource = method->depth, .access = SF_ACCESS_COLOR, .binding = count, .load = load};
        count++;
    }
    if (with_z && parts->equal && parts->writes == COLOR)
        uses[count++] = (struct sf_use){.resource = parts->z, .access = SF_ACCESS_DEPTH_READ};
    else if (with_z)
        uses[count++] = (struct sf_use){
            .resource = parts->z, .access = SF_ACCESS_DEPTH, .load = first_z ? SF_LOAD_CLEAR : SF_LOAD_KEEP};
    return count;
}

static enum sf_depth_test depth_test(const struct parts *parts)
{
    return parts->equal && parts->writes == COLOR ? SF_DEPTH_EQUAL : SF_DEPTH_GREATER_EQUAL;
}

/* A pass over objects of one kind: its name and fragment shader by what the round writes. */
static void declare_objects(const struct parts *parts, const char *const names[2], const char *const fragments[WRITES],
                            struct sf_pass_desc pass)
{
    pass.name = names[parts->writes == DEPTH];
    pass.kind = SF_PASS_RASTER;
    pass.fragment = fragments[parts->writes];
    pass.constant_count = SF_SHADE_CONSTANTS;
    memcpy(pass.constants, parts->constants, sizeof parts->constants);
    sf_graph_pass(parts->assembly->graph, &pass);
}

static void declare_sky(const struct parts *parts)
{
    static const char *const names[] = {"scene.sky", "prepass.sky"};
    static const char *const fragments[WRITES] = {"scene/sky.frag", "scene/sky_depth.frag", "scene/sky_color.frag"};
    struct sf_assembly *assembly = parts->assembly;
    struct sf_use uses[SHADE_USES + TARGET_USES];
    uint32_t count = shade_uses(parts, uses);

    uses[count++] = (struct sf_use){.resource = assembly->environment ? assembly->environment : blank(assembly),
                                    .access = SF_ACCESS_SAMPLED,
                                    .binding = 5,
                                    .sampler = assembly->environment ? SF_SAMPLER_LINEAR_REPEAT : SF_SAMPLER_NEAREST};
    count += target_uses(parts, true, false, false, &uses[count]);
    declare_objects(parts, names, fragments,
                    (struct sf_pass_desc){.shader = "scene/sky.vert",
                                          .uses = uses,
                                          .use_count = count,
                                          .vertices = 4,
                                          .instances = 1,
                                          .raster = {.triangle_strip = true}});
}

static void declare_planes(const struct parts *parts)
{
    static const char *const names[] = {"scene.planes", "prepass.planes"};
    static const char *const fragments[WRITES] = {"scene/planes.frag", "scene/planes_depth.frag",
                                                  "scene/planes_color.frag"};
    struct sf_use uses[SHADE_USES + TARGET_USES];
    uint32_t count = shade_uses(parts, uses);

    count += target_uses(parts, false, false, false, &uses[count]);
    declare_objects(parts, names, fragments,
                    (struct sf_pass_desc){.shader = "scene/planes.vert",
                                          .uses = uses,
                                          .use_count = count,
                                          .vertices = 4,
                                          .instances = parts->assembly->drawn.list.planes,
                                          .raster = {.triangle_strip = true}});
}

static void declare_solids(const struct parts *parts)
{
    static const char *const names[] = {"scene.solids", "prepass.solids"};
    static const char *const fragments[WRITES] = {"scene/solids.frag", "scene/solids_depth.frag",
                                                  "scene/solids_color.frag"};
    struct sf_use uses[SHADE_USES + TARGET_USES];
    uint32_t count = shade_uses(parts, uses);

    count += target_uses(parts, false, true, true, &uses[count]);
    declare_objects(parts, names, fragments,
                    (struct sf_pass_desc){.shader = "scene/solids.vert",
                                          .uses = uses,
                                          .use_count = count,
                                          .vertices = 36,
                                          .instances = parts->assembly->drawn.list.solids,
                                          .raster = {.cull = SF_CULL_FRONT, .depth = depth_test(parts)}});
}

static void declare_mesh(const struct parts *parts, uint32_t number)
{
    static const char *const fragments[WRITES] = {"scene/mesh.frag", "scene/mesh_depth.frag", "scene/mesh_color.frag"};
    struct sf_assembly *assembly = parts->assembly;
    uint32_t object = assembly->drawn.list.planes + assembly->drawn.list.solids + number;
    uint32_t mesh = assembly->drawn.scene->objects[assembly->drawn.list.from[object]].mesh;
    struct sf_mesh_push *push = &assembly->mesh_push[number];
    struct sf_use uses[SHADE_USES + 1 + TARGET_USES];
    uint32_t count = shade_uses(parts, uses);
    char name[32], before[32];

    *push = (struct sf_mesh_push){.object = object,
                                  .first_index = assembly->drawn.meshes.first_index[mesh],
                                  .first_vertex = assembly->drawn.meshes.first_vertex[mesh]};
    snprintf(name, sizeof name, "scene.mesh%02u", number);
    snprintf(before, sizeof before, "prepass.mesh%02u", number);
    const char *const names[] = {name, before};
    uses[count++] = (struct sf_use){.resource = assembly->vertices, .access = SF_ACCESS_STORAGE_READ, .binding = 5};
    uses[count++] = (struct sf_use){.resource = assembly->indices, .access = SF_ACCESS_STORAGE_READ, .binding = 6};
    count += target_uses(parts, false, true, number == 0 && assembly->drawn.list.solids == 0, &uses[count]);
    declare_objects(parts, names, fragments,
                    (struct sf_pass_desc){.shader = "scene/mesh.vert",
                                          .uses = uses,
                                          .use_count = count,
                                          .push = push,
                                          .push_bytes = sizeof *push,
                                          .vertices = assembly->drawn.scene->meshes[mesh].index_count,
                                          .instances = 1,
                                          .raster = {.depth = depth_test(parts)}});
}

/* All objects once. */
static void declare_round(const struct parts *parts)
{
    const struct sf_assembly *assembly = parts->assembly;

    declare_sky(parts);
    if (assembly->drawn.list.planes > 0)
        declare_planes(parts);
    if (assembly->drawn.list.solids > 0)
        declare_solids(parts);
    for (uint32_t i = 0; i < assembly->drawn.list.meshes; i++)
        declare_mesh(parts, i);
}

static void declare_scene(struct sf_assembly *assembly, bool shown)
{
    struct parts parts = {.assembly = assembly};
    enum sf_format format = assembly->float_color ? SF_FORMAT_RGBA32F : SF_FORMAT_RGBA16F;
    int32_t prepass = assembly->drawn.scene->surfaces.prepass;

    assembly->method.color = shown ? import_image(assembly->graph, "color", format, assembly->width, assembly->height)
                                   : frame_image(assembly, "color", format);
    assembly->method.depth = frame_image(assembly, "depth", SF_FORMAT_R32F);
    memcpy(parts.constants, assembly->drawn.constants, sizeof parts.constants);
    const struct sf_object_list *list = &assembly->drawn.list;
    bool surfaces = list->planes + list->solids + list->meshes > 0; /* else no shadow is seen, and no map of it made */
    if (!surfaces || !assembly->method.smoke_map || !assembly->method.smoke_shadows)
        parts.constants[SF_SHADE_CASTS] = 0;
    bool with_z = assembly->drawn.list.solids + assembly->drawn.list.meshes > 0;
    if (with_z)
        parts.z = frame_image(assembly, "z", SF_FORMAT_D32F);
    if (prepass != SF_PREPASS_NONE) {
        parts.writes = DEPTH;
        declare_round(&parts);
        parts.writes = COLOR;
        parts.equal = prepass == SF_PREPASS_EQUAL;
        if (with_z && !parts.equal)
            parts.z = frame_image(assembly, "z.again", SF_FORMAT_D32F);
    }
    declare_round(&parts);
}

/* Light over the whole picture, behind all that the method draws. */
static void declare_flash(struct sf_assembly *assembly)
{
    const struct sf_use use = {.resource = assembly->method.color, .access = SF_ACCESS_COLOR, .load = SF_LOAD_KEEP};

    if (assembly->drawn.scene->flash_count == 0)
        return;
    sf_graph_pass(assembly->graph, &(struct sf_pass_desc){.name = "scene.flash",
                                                          .kind = SF_PASS_RASTER,
                                                          .shader = "scene/screen.vert",
                                                          .fragment = "scene/flash.frag",
                                                          .uses = &use,
                                                          .use_count = 1,
                                                          .push = &assembly->flash,
                                                          .push_bytes = sizeof assembly->flash,
                                                          .draw_live = assembly->flash_draw,
                                                          .raster = {.blend = {SF_BLEND_ADD}}});
}

void sf_assembly_set_time(struct sf_assembly *assembly, double time)
{
    float *light = assembly->flash.light;

    sf_scene_flash(assembly->drawn.scene, time, light);
    assembly->flash_draw[0] = light[0] > 0 || light[1] > 0 || light[2] > 0 ? 3 : 0;
    assembly->flash_draw[1] = 1;
}

static sf_resource declare_readback(struct sf_assembly *assembly, const char *name, const char *pass, sf_resource from,
                                    uint64_t bytes)
{
    sf_resource to = sf_graph_buffer(assembly->graph,
                                     &(struct sf_buffer_desc){.name = name, .lifetime = SF_READBACK, .bytes = bytes});
    const struct sf_use uses[] = {{.resource = from, .access = SF_ACCESS_TRANSFER_READ},
                                  {.resource = to, .access = SF_ACCESS_TRANSFER_WRITE}};

    sf_graph_pass(
        assembly->graph,
        &(struct sf_pass_desc){
            .name = pass, .kind = SF_PASS_TRANSFER, .uses = uses, .use_count = 2, .transfer = SF_TRANSFER_COPY});
    return to;
}

static void declare_outputs(struct sf_assembly *assembly, const struct sf_assembly_options *options)
{
    const struct sf_method_frame *method = &assembly->method;
    uint64_t pixels = (uint64_t)assembly->width * assembly->height;
    bool returned = !options->shown || options->returned;

    if (options->no_readback) {
        sf_graph_output(assembly->graph, method->color);
        sf_graph_output(assembly->graph, method->depth);
        return;
    }
    if (returned) {
        assembly->read_color = declare_readback(assembly, "read.color", "output.color", method->color,
                                                pixels * (assembly->float_color ? 16 : 8));
        assembly->read_depth = declare_readback(assembly, "read.depth", "output.depth", method->depth, pixels * 4);
    }
    assembly->read_counts =
        declare_readback(assembly, "read.counts", "output.counts", method->counts, sizeof(struct sf_particle_counts));
    if (options->particles)
        assembly->read_particles = declare_readback(assembly, "read.particles", "output.particles", method->particles,
                                                    options->capacity * sizeof(struct sf_particle));
    if (method->verdict)
        assembly->read_verdict = declare_readback(assembly, "read.verdict", "output.verdict", method->verdict,
                                                  sf_graph_buffer_at(assembly->graph, method->verdict)->bytes);
    if (method->probe)
        assembly->read_probe = declare_readback(assembly, "read.probe", "output.probe", method->probe,
                                                sf_graph_buffer_at(assembly->graph, method->probe)->bytes);
    if (!returned)
        return;
    if (options->aovs & SF_AOV_SMOKE && method->aov_radiance) {
        assembly->smoke_format = sf_graph_image_at(assembly->graph, method->aov_radiance)->format;
        assembly->read_smoke = declare_readback(assembly, "read.smoke", "output.smoke", method->aov_radiance,
                                                pixels * sf_format_bytes(assembly->smoke_format));
    }
    if (options->aovs & SF_AOV_DEPTHS && method->aov_depths)
        assembly->read_depths =
            declare_readback(assembly, "read.smoke_depths", "output.smoke_depths", method->aov_depths, pixels * 16);
}

static enum sf_status declare(struct sf_assembly *assembly, const struct sf_assembly_options *options,
                              const struct sf_log *log)
{
    const struct sf_method_row *row = &sf_methods[assembly->drawn.scene->method];
    enum sf_status status = sf_graph_create("frame", log, &assembly->graph);

    if (status)
        return status;
    assembly->method.graph = assembly->graph;
    sf_inspect_prepare(assembly->graph, options->inspect);
    declare_inputs(assembly, options);
    if (row->light)
        status = row->light(&assembly->method, assembly->state, log);
    if (status)
        return status;
    declare_scene(assembly, options->shown);
    if (row->view)
        status = row->view(&assembly->method, assembly->state, log);
    if (!status)
        declare_flash(assembly);
    if (!status)
        declare_outputs(assembly, options);
    if (!status && options->inspect)
        status = sf_inspect_declare(assembly->graph, options->inspect, log, &assembly->inspected);
    return status;
}

enum sf_status sf_assembly_create(const struct sf_scene *scene, const struct sf_assembly_options *options,
                                  const struct sf_gpu_tuning *tuning, const struct sf_plan_memory *memory,
                                  const struct sf_log *log, struct sf_assembly **out)
{
    const struct sf_method_row *row = &sf_methods[scene->method];
    struct sf_assembly *assembly = calloc(1, sizeof *assembly);
    void *state = calloc(1, row->state_bytes > 0 ? row->state_bytes : 1);
    enum sf_status status = SF_OK;

    *out = NULL;
    if (!assembly || !state) {
        free(assembly);
        free(state);
        return sf_fail(log, SF_ERROR_MEMORY, "the frame's graph: out of memory");
    }
    assembly->state = state;
    assembly->width = options->width;
    assembly->height = options->height;
    assembly->float_color = options->float_color;
    assembly->method = (struct sf_method_frame){.scene = scene,
                                                .tuning = tuning,
                                                .width = options->width,
                                                .height = options->height,
                                                .want_aovs = options->aovs != 0,
                                                .want_probe = options->probe};
    sf_drawn_fill(scene, &assembly->drawn);
    status = declare(assembly, options, log);
    if (!status)
        status = sf_plan_create(assembly->graph, memory, log, &assembly->plan);
    if (status)
        sf_assembly_destroy(&assembly);
    *out = assembly;
    return status;
}

void sf_assembly_destroy(struct sf_assembly **assembly)
{
    if (!assembly || !*assembly)
        return;
    sf_plan_destroy(&(*assembly)->plan);
    sf_graph_destroy(&(*assembly)->graph);
    free((*assembly)->state);
    free(*assembly);
    *assembly = NULL;
}

void sf_assembly_set_scene(struct sf_assembly *assembly, const struct sf_drawn *drawn)
{
    assembly->drawn = *drawn;
    assembly->method.scene = drawn->scene;
}
