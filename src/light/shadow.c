#include "light/shadow.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

_Static_assert(sizeof(struct sf_gpu_shadow_cell) == 80, "std140");
_Static_assert(sizeof(struct sf_mesh_push) <= SF_PUSH_BYTES_MAX, "push constants");

enum { CORNERS = 8, CORNERS_MAX = CORNERS * SF_OBJECTS_MAX };
static const double TAN_MAX = 3.7320508; /* tan 75 deg */
static const double PI = 3.14159265358979323846;

/* ---- fitting ---- */

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double to[3])
{
    to[0] = a[1] * b[2] - a[2] * b[1];
    to[1] = a[2] * b[0] - a[0] * b[2];
    to[2] = a[0] * b[1] - a[1] * b[0];
}

static void normalize(double v[3])
{
    double length = sqrt(dot(v, v));

    for (int i = 0; i < 3; i++)
        v[i] /= length;
}

/* v turned by R = Rz Ry Rx, in degrees. */
static void rotate(const float degrees[3], double v[3])
{
    for (int axis = 0; axis < 3; axis++) {
        double angle = degrees[axis] * (PI / 180), c = cos(angle), s = sin(angle);
        int a = (axis + 1) % 3, b = (axis + 2) % 3;
        double x = v[a], y = v[b];
        v[a] = c * x - s * y;
        v[b] = s * x + c * y;
    }
}

/* Least and greatest corner in the object's own space. False for planes. */
static bool object_bounds(const struct sf_scene *scene, const struct sf_object *object, double low[3], double high[3])
{
    const struct sf_mesh *mesh = object->kind == SF_OBJECT_MESH ? &scene->meshes[object->mesh] : NULL;

    for (int i = 0; i < 3; i++) {
        double reach = object->kind == SF_OBJECT_BOX                  ? object->size[i] / 2.0
                       : object->kind == SF_OBJECT_CYLINDER && i == 1 ? object->height / 2.0
                                                                      : (double)object->radius;
        low[i] = mesh ? (double)mesh->min[i] * object->scale : -reach;
        high[i] = mesh ? (double)mesh->max[i] * object->scale : reach;
    }
    return object->kind != SF_OBJECT_PLANE;
}

/* Corners of the boxes around the finite objects, in the world. */
static uint32_t gather_corners(const struct sf_scene *scene, double corners[CORNERS_MAX][3])
{
    uint32_t count = 0;

    for (uint32_t i = 0; i < scene->object_count; i++) {
        const struct sf_object *object = &scene->objects[i];
        double low[3], high[3];
        if (!object_bounds(scene, object, low, high))
            continue;
        for (int corner = 0; corner < CORNERS; corner++, count++) {
            double *at = corners[count];
            for (int axis = 0; axis < 3; axis++)
                at[axis] = corner >> axis & 1 ? high[axis] : low[axis];
            rotate(object->rotation, at);
            for (int axis = 0; axis < 3; axis++)
                at[axis] += object->position[axis];
        }
    }
    return count;
}

struct fit {
    const struct sf_scene *scene;
    const struct sf_light *light;
    double (*corners)[3];
    uint32_t count;
    double share; /* of the cell that the objects may fill: the blur needs a rim */
    double origin[3], right[3], down[3], forward[3];
    double reach, near, far; /* half width in m, or tangent; depths in m */
};

static void fit_axes(struct fit *fit, const double forward[3])
{
    const double world_up[3] = {0, 1, 0}, other[3] = {1, 0, 0};

    memcpy(fit->forward, forward, sizeof fit->forward);
    cross(forward, fabs(forward[1]) < 0.99 ? world_up : other, fit->right);
    normalize(fit->right);
    cross(forward, fit->right, fit->down); /* right x up = -forward, so forward x right points down */
}

/* (right, down, forward) of a point, from the origin. */
static void fit_see(const struct fit *fit, const double point[3], double seen[3])
{
    double from[3] = {point[0] - fit->origin[0], point[1] - fit->origin[1], point[2] - fit->origin[2]};

    seen[0] = dot(from, fit->right);
    seen[1] = dot(from, fit->down);
    seen[2] = dot(from, fit->forward);
}

static void fit_directional(struct fit *fit)
{
    double low[3], high[3], seen[3], forward[3];

    for (int i = 0; i < 3; i++)
        forward[i] = fit->light->direction[i];
    normalize(forward);
    fit_axes(fit, forward);
    for (uint32_t k = 0; k < fit->count; k++) {
        fit_see(fit, fit->corners[k], seen);
        for (int i = 0; i < 3; i++) {
            low[i] = k == 0 ? seen[i] : fmin(low[i], seen[i]);
            high[i] = k == 0 ? seen[i] : fmax(high[i], seen[i]);
        }
    }
    for (int i = 0; i < 3; i++)
        fit->origin[i] = (low[0] + high[0]) / 2 * fit->right[i] + (low[1] + high[1]) / 2 * fit->down[i];
    fit->reach = fmax(fmax(high[0] - low[0], high[1] - low[1]) / 2, 1e-4) / fit->share;
    fit->near = low[2];
    fit->far = high[2];
}

/* Point lights look at the middle of the objects, spots where they point. */
static void fit_perspective(struct fit *fit)
{
    double seen[3], forward[3] = {0}, tangent = 0, near = INFINITY, far = 0;
    bool spot = fit->light->kind == SF_LIGHT_SPOT;

    for (int i = 0; i < 3; i++) {
        fit->origin[i] = fit->light->position[i];
        for (uint32_t k = 0; k < fit->count; k++)
            forward[i] += fit->corners[k][i] / fit->count;
        forward[i] = spot ? (double)fit->light->direction[i] : forward[i] - fit->origin[i];
    }
    if (dot(forward, forward) < 1e-12)
        forward[1] = -1;
    normalize(forward);
    fit_axes(fit, forward);
    for (uint32_t k = 0; k < fit->count; k++) {
        fit_see(fit, fit->corners[k], seen);
        double aside = fmax(fabs(seen[0]), fabs(seen[1]));
        tangent = seen[2] * TAN_MAX > aside ? fmax(tangent, aside / seen[2]) : TAN_MAX;
        near = fmin(near, seen[2]);
        far = fmax(far, seen[2]);
    }
    if (spot)
        tangent = fmin(tangent, tan(fmin(fit->light->outer, 75.0) * (PI / 180)));
    fit->reach = fmin(fmax(tangent, 1e-3) / fit->share, TAN_MAX);
    fit->far = fmax(far, 1e-3);
    fit->near = fmin(fmax(near, fit->far * 0.01), fit->far);
}

/* The planes that face the light and lie behind the objects take part in the blur: their depth must have room, but not so much that the objects'
 * own becomes coarse. */
static void fit_depth(struct fit *fit)
{
    bool perspective = fit->light->kind != SF_LIGHT_DIRECTIONAL;
    double range = fmax(fit->far - fit->near, 1e-3), end = fit->near + range * 1.1, most = fit->near + range * 1.6;

    for (uint32_t i = 0; i < fit->scene->object_count; i++) {
        const struct sf_object *plane = &fit->scene->objects[i];
        if (plane->kind != SF_OBJECT_PLANE)
            continue;
        const double normal[3] = {plane->normal[0], plane->normal[1], plane->normal[2]};
        for (int corner = 0; corner < 4; corner++) {
            double u = corner & 1 ? fit->reach : -fit->reach, v = corner & 2 ? fit->reach : -fit->reach;
            double from[3], ray[3], apart[3];
            for (int k = 0; k < 3; k++) {
                double aside = u * fit->right[k] + v * fit->down[k];
                from[k] = fit->origin[k] + (perspective ? 0 : aside);
                ray[k] = fit->forward[k] + (perspective ? aside : 0);
                apart[k] = plane->position[k] - from[k];
            }
            double slope = dot(normal, ray), t = slope < -1e-6 ? dot(normal, apart) / slope : 0;
            end = fmax(end, t);
        }
    }
    fit->far = fmin(end, most);
    fit->near -= 0.01 * range;
}

static void store3(float to[4], const double v[3], double w)
{
    for (int i = 0; i < 3; i++)
        to[i] = (float)v[i];
    to[3] = (float)w;
}

static uint32_t blur_radius(float sigma)
{
    return (uint32_t)ceilf(2.5f * sigma);
}

void sf_shadow_fit(const struct sf_scene *scene, struct sf_shadow_cells *cells)
{
    double corners[CORNERS_MAX][3];
    uint32_t count = gather_corners(scene, corners);

    memset(cells, 0, sizeof *cells);
    cells->size = (uint32_t)scene->shadow.map_size;
    for (uint32_t i = 0; i < scene->light_count && count > 0; i++) {
        const struct sf_light *light = &scene->lights[i];
        double rim = (blur_radius(scene->shadow.softness) + 1.0) * 2 / cells->size;
        struct fit fit = {
            .scene = scene, .light = light, .corners = corners, .count = count, .share = fmax(1 - rim, 0.1)};
        if (!light->shadows)
            continue;
        if (light->kind == SF_LIGHT_DIRECTIONAL)
            fit_directional(&fit);
        else
            fit_perspective(&fit);
        fit_depth(&fit);
        struct sf_gpu_shadow_cell *cell = &cells->cell[cells->count];
        bool perspective = light->kind != SF_LIGHT_DIRECTIONAL;
        double range = fit.far - fit.near, texel = 2 * fit.reach * (perspective ? fit.far : 1) / cells->size;
        for (int k = 0; k < 3; k++) {
            fit.right[k] *= fit.reach;
            fit.down[k] *= fit.reach;
        }
        store3(cell->origin, fit.origin, perspective);
        store3(cell->right, fit.right, fit.reach);
        store3(cell->down, fit.down, 0);
        store3(cell->forward, fit.forward, 0);
        cell->range[0] = (float)fit.near;
        cell->range[1] = (float)(1 / range);
        cell->range[2] = scene->shadow.exponent;
        /* Nearest texel: up to half a texel aside, on a surface as steep as 60 degrees. */
        cells->bias[cells->count] = (float)(texel / range);
        cells->light[cells->count++] = i;
    }
}

uint32_t sf_shadow_mask(const struct sf_shadow_cells *cells)
{
    uint32_t mask = 0;

    for (uint32_t i = 0; i < cells->count; i++)
        mask |= 1u << cells->light[i];
    return mask;
}

/* Rows of the matrix: u and v of the cell in 0..1 (times w), depth, w. */
void sf_shadow_fill(const struct sf_shadow_cells *cells, struct sf_gpu_frame *frame)
{
    for (uint32_t i = 0; i < cells->count; i++) {
        const struct sf_gpu_shadow_cell *cell = &cells->cell[i];
        struct sf_gpu_light *light = &frame->lights[cells->light[i]];
        bool perspective = cell->origin[3] > 0;
        double square = (double)cell->right[3] * cell->right[3], rows[4][4] = {{0}};
        for (int k = 0; k < 3; k++) {
            rows[3][k] = perspective ? cell->forward[k] : 0;
            rows[0][k] = 0.5 * cell->right[k] / square + 0.5 * rows[3][k];
            rows[1][k] = 0.5 * cell->down[k] / square + 0.5 * rows[3][k];
            rows[2][k] = (double)cell->forward[k] * cell->range[1];
        }
        for (int row = 0; row < 4; row++) {
            for (int k = 0; k < 3; k++)
                rows[row][3] -= rows[row][k] * cell->origin[k];
        }
        rows[0][3] += perspective ? 0 : 0.5;
        rows[1][3] += perspective ? 0 : 0.5;
        rows[2][3] -= (double)cell->range[0] * cell->range[1] + cells->bias[i];
        rows[3][3] += perspective ? 0 : 1;
        for (int row = 0; row < 4; row++) {
            for (int k = 0; k < 4; k++)
                light->world_to_map[4 * k + row] = (float)rows[row][k];
        }
        light->shadow[0] = 1;
        light->shadow[1] = cell->range[2];
        light->shadow[2] = (float)i;
        light->shadow[3] = 1.0f / (float)cells->count;
    }
}

/* ---- drawing ---- */

/* The graph's resources that stand for what the caller has. */
struct names {
    sf_resource cells, objects, vertices, indices, depth, half_way, blurred, map;
};

static void declare_resources(struct sf_graph *graph, const struct sf_shadow_scene *scene, struct names *names)
{
    const struct sf_shadow_cells *cells = scene->cells;
    struct sf_image_desc image = {.name = "shadow.first",
                                  .format = SF_FORMAT_R32F,
                                  .lifetime = SF_TRANSIENT,
                                  .size = {.width = cells->size * cells->count, .height = cells->size}};

    names->depth = sf_graph_image(graph, &image);
    image.name = "shadow.half";
    names->half_way = sf_graph_image(graph, &image);
    image.name = "shadow.blurred";
    names->blurred = sf_graph_image(graph, &image);
    image.name = "shadow.map";
    image.lifetime = SF_IMPORTED;
    image.outside = SF_ACCESS_SAMPLED;
    names->map = sf_graph_image(graph, &image);
    struct sf_buffer_desc buffer = {
        .name = "shadow.cells", .lifetime = SF_UPLOAD, .bytes = sizeof(struct sf_gpu_shadow_cell) * SF_FRAME_LIGHTS};
    names->cells = sf_graph_buffer(graph, &buffer);
    buffer.name = "objects";
    buffer.bytes = sizeof(struct sf_gpu_object) * SF_FRAME_OBJECTS;
    names->objects = sf_graph_buffer(graph, &buffer);
    if (scene->meshes == 0)
        return;
    buffer.lifetime = SF_IMPORTED;
    buffer.outside = SF_ACCESS_STORAGE_READ;
    buffer.name = "mesh.vertices";
    buffer.bytes = scene->buffers->vertex_bytes;
    names->vertices = sf_graph_buffer(graph, &buffer);
    buffer.name = "mesh.indices";
    buffer.bytes = scene->buffers->index_bytes;
    names->indices = sf_graph_buffer(graph, &buffer);
}

static void declare_solids(struct sf_graph *graph, const struct sf_shadow_scene *scene, const struct names *names,
                           const struct sf_shadow_pushes *pushes)
{
    const struct sf_use uses[] = {
        {.resource = names->cells, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = names->objects, .access = SF_ACCESS_UNIFORM, .binding = 1},
        {.resource = names->depth, .access = SF_ACCESS_COLOR, .load = SF_LOAD_DISCARD},
    };

    sf_graph_pass(graph, &(struct sf_pass_desc){.name = "shadow.solids",
                                                .kind = SF_PASS_RASTER,
                                                .shader = "scene/screen.vert",
                                                .fragment = "light/shadow.frag",
                                                .uses = uses,
                                                .use_count = 3,
                                                .constants = {scene->planes, scene->solids},
                                                .constant_count = 2,
                                                .push = &pushes->blur,
                                                .push_bytes = sizeof pushes->blur,
                                                .vertices = 3,
                                                .instances = 1});
}

/* The nearest of mesh and what is there, by MIN: larger depths have larger exponentials. */
static void declare_mesh(struct sf_graph *graph, const struct sf_shadow_scene *scene, const struct names *names,
                         uint32_t number, const struct sf_mesh_push *push)
{
    const struct sf_object *object = &scene->scene->objects[scene->from[push->object]];
    char name[32] = "shadow.mesh00";
    const struct sf_use uses[] = {
        {.resource = names->cells, .access = SF_ACCESS_UNIFORM, .binding = 0},
        {.resource = names->objects, .access = SF_ACCESS_UNIFORM, .binding = 1},
        {.resource = names->vertices, .access = SF_ACCESS_STORAGE_READ, .binding = 2},
        {.resource = names->indices, .access = SF_ACCESS_STORAGE_READ, .binding = 3},
        {.resource = names->depth, .access = SF_ACCESS_COLOR, .load = SF_LOAD_KEEP},
    };

    name[11] = (char)('0' + number / 10);
    name[12] = (char)('0' + number % 10);
    sf_graph_pass(graph, &(struct sf_pass_desc){.name = name,
                                                .kind = SF_PASS_RASTER,
                                                .shader = "light/mesh.vert",
                                                .fragment = "light/mesh.frag",
                                                .uses = uses,
                                                .use_count = 5,
                                                .push = push,
                                                .push_bytes = sizeof *push,
                                                .vertices = scene->scene->meshes[object->mesh].index_count,
                                                .instances = scene->cells->count,
                                                .raster = {.blend = {SF_BLEND_MIN_ADD}}});
}

static void declare_blur(struct sf_graph *graph, const struct names *names, const struct sf_shadow_pushes *pushes)
{
    const sf_resource images[] = {names->depth, names->half_way, names->blurred};
    static const char *const pass_names[] = {"shadow.blur_x", "shadow.blur_y"};

    for (uint32_t vertical = 0; vertical < 2; vertical++) {
        const struct sf_use uses[] = {
            {.resource = images[vertical], .access = SF_ACCESS_SAMPLED, .binding = 0},
            {.resource = images[vertical + 1], .access = SF_ACCESS_STORAGE_WRITE, .binding = 1},
        };
        sf_graph_pass(graph, &(struct sf_pass_desc){.name = pass_names[vertical],
                                                    .kind = SF_PASS_COMPUTE,
                                                    .shader = "light/blur.comp",
                                                    .uses = uses,
                                                    .use_count = 2,
                                                    .constants = {vertical},
                                                    .constant_count = 1,
                                                    .push = &pushes->blur,
                                                    .push_bytes = sizeof pushes->blur,
                                                    .domain = images[vertical + 1],
                                                    .local = {16, 16}});
    }
    const struct sf_use uses[] = {{.resource = names->blurred, .access = SF_ACCESS_TRANSFER_READ},
                                  {.resource = names->map, .access = SF_ACCESS_TRANSFER_WRITE}};
    sf_graph_pass(graph, &(struct sf_pass_desc){.name = "shadow.keep",
                                                .kind = SF_PASS_TRANSFER,
                                                .uses = uses,
                                                .use_count = 2,
                                                .transfer = SF_TRANSFER_COPY});
}

enum sf_status sf_shadow_declare(const struct sf_shadow_scene *scene, struct sf_shadow_pushes *pushes,
                                 const struct sf_log *log, struct sf_graph **graph)
{
    struct names names = {0};
    enum sf_status status = sf_graph_create("shadow", log, graph);

    if (status)
        return status;
    pushes->blur = (struct sf_shadow_push){.cell = scene->cells->size,
                                           .cells = scene->cells->count,
                                           .sigma = scene->scene->shadow.softness,
                                           .radius = blur_radius(scene->scene->shadow.softness)};
    declare_resources(*graph, scene, &names);
    declare_solids(*graph, scene, &names, pushes);
    for (uint32_t i = 0; i < scene->meshes; i++) {
        uint32_t object = scene->planes + scene->solids + i, mesh = scene->scene->objects[scene->from[object]].mesh;
        pushes->mesh[i] = (struct sf_mesh_push){.object = object,
                                                .first_index = scene->buffers->first_index[mesh],
                                                .first_vertex = scene->buffers->first_vertex[mesh],
                                                .cells = scene->cells->count};
        declare_mesh(*graph, scene, &names, i, &pushes->mesh[i]);
    }
    declare_blur(*graph, &names, pushes);
    return SF_OK;
}

bool sf_shadow_mesh_same(const struct sf_shadow_scene *a, const struct sf_shadow_scene *b, uint32_t object)
{
    uint32_t i = a->scene->objects[a->from[object]].mesh, j = b->scene->objects[b->from[object]].mesh;

    return a->buffers->first_index[i] == b->buffers->first_index[j] &&
           a->buffers->first_vertex[i] == b->buffers->first_vertex[j] &&
           a->scene->meshes[i].index_count == b->scene->meshes[j].index_count;
}

bool sf_shadow_same(const struct sf_shadow_scene *a, const struct sf_shadow_scene *b)
{
    uint32_t solids = a->planes + a->solids, count = solids + a->meshes;
    bool same = a->planes == b->planes && a->solids == b->solids && a->meshes == b->meshes &&
                a->cells->count == b->cells->count && a->cells->size == b->cells->size &&
                memcmp(a->cells->cell, b->cells->cell, a->cells->count * sizeof a->cells->cell[0]) == 0 &&
                memcmp(&a->scene->shadow.softness, &b->scene->shadow.softness, sizeof(float)) == 0;

    /* Of an object its place and shape; colours and bounce do not show. */
    for (uint32_t i = 0; i < count && same; i++)
        same = memcmp(&a->objects[i], &b->objects[i], offsetof(struct sf_gpu_object, albedo)) == 0 &&
               (i < solids || sf_shadow_mesh_same(a, b, i));
    return same && (a->meshes == 0 ||
                    (a->buffers->vertices == b->buffers->vertices && a->buffers->indices == b->buffers->indices));
}

static enum sf_status play(struct sf_gpu *gpu, const struct sf_shadow_scene *scene, const struct sf_graph *graph,
                           struct sf_player *player, struct sf_gpu_image *map)
{
    uint64_t serial = 0;
    enum sf_status status;

    sf_player_bind_image(player, sf_graph_find(graph, "shadow.map"), map);
    if (scene->meshes > 0) {
        sf_player_bind_buffer(player, sf_graph_find(graph, "mesh.vertices"), scene->buffers->vertices);
        sf_player_bind_buffer(player, sf_graph_find(graph, "mesh.indices"), scene->buffers->indices);
    }
    status = sf_frame_begin(gpu);
    if (status)
        return status;
    void *cells = sf_player_upload(player, sf_graph_find(graph, "shadow.cells"));
    void *objects = sf_player_upload(player, sf_graph_find(graph, "objects"));
    if (cells && objects) {
        memcpy(cells, scene->cells->cell, sizeof scene->cells->cell);
        memcpy(objects, scene->objects, sizeof(struct sf_gpu_object) * SF_FRAME_OBJECTS);
        status = sf_player_play(player);
    } else {
        status = SF_ERROR_MEMORY;
    }
    enum sf_status ended = sf_frame_end(gpu, &serial);
    status = status ? status : ended;
    return status ? status : sf_frame_wait(gpu, serial);
}

enum sf_status sf_shadow_create(struct sf_gpu *gpu, const struct sf_shadow_scene *scene, const struct sf_log *log,
                                struct sf_gpu_image **map)
{
    struct sf_plan_memory memory = {.needs = sf_gpu_memory_needs, .user = gpu};
    struct sf_shadow_pushes *pushes = calloc(1, sizeof *pushes);
    uint32_t width = scene->cells->size * scene->cells->count, height = scene->cells->size;
    struct sf_graph *graph = NULL;
    struct sf_plan *plan = NULL;
    struct sf_player *player = NULL;
    enum sf_status status = SF_OK;

    *map = NULL;
    if (width > sf_gpu_info(gpu)->max_image_side)
        status = sf_fail(
            log, SF_ERROR_SCENE,
            "shadow.map_size %u: the maps of %u lights side by side are wider than the device's limit of %u; lower it",
            scene->cells->size, scene->cells->count, sf_gpu_info(gpu)->max_image_side);
    else if (!pushes)
        status = sf_fail(log, SF_ERROR_MEMORY, "shadow.map: out of memory");
    if (!status)
        status =
            sf_gpu_image_create_target(gpu, "shadow.map", SF_FORMAT_R32F, width, height,
                                       1u << SF_ACCESS_SAMPLED | 1u << SF_ACCESS_TRANSFER_READ, SF_ACCESS_SAMPLED, map);
    if (!status)
        status = sf_shadow_declare(scene, pushes, log, &graph);
    if (!status)
        status = sf_plan_create(graph, &memory, log, &plan);
    if (!status)
        status = sf_player_create(gpu, plan, &player);
    if (!status)
        status = play(gpu, scene, graph, player, *map);
    sf_player_destroy(&player);
    sf_plan_destroy(&plan);
    sf_graph_destroy(&graph);
    free(pushes);
    if (status)
        sf_gpu_image_destroy(map);
    return status;
}
