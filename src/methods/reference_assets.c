/* What the reference keeps on the device beside its graph: the ramp's keys, and the triangles of the scene's meshes with a hierarchy of boxes,
 * in the order of a walk that goes into every box (shared/reference.h). */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "methods/reference.h"
#include "truth/bvh.h"

struct assets {
    struct sf_gpu_buffer *ramp, *nodes, *corners;
};

/* 48 bytes a triangle: 128 MiB, as much of a buffer as every device lets a shader see. */
static const uint32_t TRIANGLES_MAX = (1u << 27) / 48 - 1;

uint32_t sf_reference_triangles(const struct sf_scene *scene)
{
    uint32_t count = 0;

    for (uint32_t i = 0; i < scene->object_count; i++) {
        uint32_t more =
            scene->objects[i].kind == SF_OBJECT_MESH ? scene->meshes[scene->objects[i].mesh].index_count / 3 : 0;

        count = more > UINT32_MAX - count ? UINT32_MAX : count + more;
    }
    return count;
}

bool sf_reference_fits(uint32_t triangles)
{
    return triangles <= TRIANGLES_MAX;
}

/* ---- triangles ---- */

static void turn(const float degrees[3], double v[3])
{
    for (int axis = 0; axis < 3; axis++) {
        double angle = degrees[axis] * (3.14159265358979323846 / 180), c = cos(angle), s = sin(angle);
        int a = (axis + 1) % 3, b = (axis + 2) % 3;
        double x = c * v[a] - s * v[b];

        v[b] = s * v[a] + c * v[b];
        v[a] = x;
    }
}

/* The corners of a mesh's triangles, in the world. */
static void place_triangles(const struct sf_scene *scene, const struct sf_object *object, double (*corners)[3][3])
{
    const struct sf_mesh *mesh = &scene->meshes[object->mesh];

    for (uint32_t n = 0; n < mesh->index_count; n++) {
        double *corner = corners[n / 3][n % 3];

        for (int i = 0; i < 3; i++)
            corner[i] = (double)object->scale * mesh->positions[3 * (size_t)mesh->indices[n] + (size_t)i];
        turn(object->rotation, corner);
        for (int i = 0; i < 3; i++)
            corner[i] += object->position[i];
    }
}

static struct sf_bvh_box box_around(double corners[3][3])
{
    double min[3], max[3];

    for (int i = 0; i < 3; i++) {
        min[i] = fmin(corners[0][i], fmin(corners[1][i], corners[2][i]));
        max[i] = fmax(corners[0][i], fmax(corners[1][i], corners[2][i]));
    }
    return sf_bvh_box_of(min, max);
}

/* A corner and the two edges from it, as the shader reads them. */
static void pack_triangle(double corners[3][3], float packed[12])
{
    memset(packed, 0, 12 * sizeof *packed);
    for (int i = 0; i < 3; i++) {
        packed[i] = (float)corners[0][i];
        packed[4 + i] = (float)(corners[1][i] - corners[0][i]);
        packed[8 + i] = (float)(corners[2][i] - corners[0][i]);
    }
}

/* `skip`: the node behind the subtree of number `at`. */
static void pack_nodes(const struct sf_bvh *bvh, uint32_t at, uint32_t skip, struct sf_reference_node *nodes)
{
    const struct sf_bvh_node *from = &bvh->nodes[at];

    nodes[at] = (struct sf_reference_node){.min_x = from->box.min[0],
                                           .min_y = from->box.min[1],
                                           .min_z = from->box.min[2],
                                           .max_x = from->box.max[0],
                                           .max_y = from->box.max[1],
                                           .max_z = from->box.max[2],
                                           .skip = skip,
                                           .leaf = from->count > 0 ? from->first * 8 + from->count : 0};
    if (from->count > 0)
        return;
    pack_nodes(bvh, at + 1, from->first, nodes);
    pack_nodes(bvh, from->first, skip, nodes);
}

/* All triangles of the scene in `nodes` and `packed`, which have room for them. */
static enum sf_status pack_meshes(const struct sf_scene *scene, uint32_t count, struct sf_reference_node *nodes,
                                  float (*packed)[12])
{
    double(*corners)[3][3] = malloc(count * sizeof *corners);
    struct sf_bvh_box *boxes = malloc(count * sizeof *boxes);
    struct sf_bvh bvh = {0};
    enum sf_status status = corners && boxes ? SF_OK : SF_ERROR_MEMORY;
    uint32_t first = 0;

    for (uint32_t i = 0; i < scene->object_count && !status; i++) {
        if (scene->objects[i].kind != SF_OBJECT_MESH)
            continue;
        place_triangles(scene, &scene->objects[i], corners + first);
        first += scene->meshes[scene->objects[i].mesh].index_count / 3;
    }
    for (uint32_t i = 0; i < count && !status; i++)
        boxes[i] = box_around(corners[i]);
    if (!status)
        status = sf_bvh_build(boxes, count, &bvh);
    if (!status)
        pack_nodes(&bvh, 0, bvh.node_count, nodes);
    for (uint32_t i = 0; i < count && !status; i++)
        pack_triangle(corners[bvh.order[i]], packed[i]);
    sf_bvh_finish(&bvh);
    free(boxes);
    free(corners);
    return status;
}

static enum sf_status create_meshes(struct sf_gpu *gpu, const struct sf_scene *scene, const struct sf_log *log,
                                    struct assets *assets)
{
    uint32_t count = sf_reference_fits(sf_reference_triangles(scene)) ? sf_reference_triangles(scene) : 0;
    struct sf_reference_node *nodes = calloc((size_t)count + 1, sizeof *nodes);
    float(*packed)[12] = calloc((size_t)count + 1, sizeof *packed);
    enum sf_status status = nodes && packed ? SF_OK : SF_ERROR_MEMORY;

    if (!status && count > 0)
        status = pack_meshes(scene, count, nodes, packed);
    if (status)
        sf_fail(log, status, "reference: no memory for %u triangles", count);
    if (!status)
        status = sf_gpu_buffer_create(gpu, "reference.nodes", ((uint64_t)count + 1) * sizeof *nodes, false,
                                      SF_ACCESS_STORAGE_READ, nodes, &assets->nodes);
    if (!status)
        status = sf_gpu_buffer_create(gpu, "reference.corners", ((uint64_t)count + 1) * sizeof *packed, false,
                                      SF_ACCESS_STORAGE_READ, packed, &assets->corners);
    free(nodes);
    free(packed);
    return status;
}

/* ---- the ramp ---- */

static enum sf_status create_ramp(struct sf_gpu *gpu, const struct sf_scene *scene, struct assets *assets)
{
    float keys[SF_REFERENCE_RAMP][4];

    for (uint32_t i = 0; i < SF_REFERENCE_RAMP; i++) {
        const struct sf_ramp_key white = {.color = {1, 1, 1}};
        const struct sf_ramp_key *key =
            scene->ramp_count == 0 ? &white : &scene->ramp[i < scene->ramp_count ? i : scene->ramp_count - 1];

        memcpy(keys[i], key->color, sizeof key->color);
        keys[i][3] = key->at;
    }
    return sf_gpu_buffer_create(gpu, "reference.ramp", sizeof keys, false, SF_ACCESS_STORAGE_READ, keys, &assets->ramp);
}

static bool same_ramp(const struct sf_scene *a, const struct sf_scene *b)
{
    return a->ramp_count == b->ramp_count && memcmp(a->ramp, b->ramp, a->ramp_count * sizeof *a->ramp) == 0;
}

/* ---- all ---- */

enum sf_status sf_reference_assets_create(struct sf_gpu *gpu, const struct sf_scene *scene, const struct sf_log *log,
                                          void **out)
{
    struct assets *assets = calloc(1, sizeof *assets);
    enum sf_status status;

    *out = assets;
    if (!assets)
        return sf_fail(log, SF_ERROR_MEMORY, "reference: out of memory");
    status = create_ramp(gpu, scene, assets);
    if (!status)
        status = create_meshes(gpu, scene, log, assets);
    if (status)
        sf_reference_assets_destroy(out);
    return status;
}

void sf_reference_assets_destroy(void **out)
{
    struct assets *assets = out ? *out : NULL;

    if (!assets)
        return;
    sf_gpu_buffer_destroy(&assets->ramp);
    sf_gpu_buffer_destroy(&assets->nodes);
    sf_gpu_buffer_destroy(&assets->corners);
    free(assets);
    *out = NULL;
}

static bool same_mesh(const struct sf_mesh *a, const struct sf_mesh *b)
{
    return a->vertex_count == b->vertex_count && a->index_count == b->index_count &&
           memcmp(a->positions, b->positions, 3 * sizeof *a->positions * a->vertex_count) == 0 &&
           memcmp(a->indices, b->indices, sizeof *a->indices * a->index_count) == 0;
}

bool sf_reference_assets_same(const struct sf_scene *a, const struct sf_scene *b)
{
    bool same = a->object_count == b->object_count && same_ramp(a, b);

    for (uint32_t i = 0; same && i < a->object_count; i++) {
        const struct sf_object *x = &a->objects[i], *y = &b->objects[i];

        same = x->kind == y->kind;
        if (!same || x->kind != SF_OBJECT_MESH)
            continue;
        same = memcmp(x->position, y->position, sizeof x->position) == 0 &&
               memcmp(x->rotation, y->rotation, sizeof x->rotation) == 0 && x->scale == y->scale &&
               same_mesh(&a->meshes[x->mesh], &b->meshes[y->mesh]);
    }
    return same;
}

void sf_reference_assets_bind(const struct sf_graph *graph, struct sf_player *player, void *data)
{
    const struct assets *assets = data;

    sf_player_bind_buffer(player, sf_graph_find(graph, "reference.ramp"), assets->ramp);
    sf_player_bind_buffer(player, sf_graph_find(graph, "reference.nodes"), assets->nodes);
    sf_player_bind_buffer(player, sf_graph_find(graph, "reference.corners"), assets->corners);
}
