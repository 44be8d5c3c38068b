#include "render/assets.h"

#include <stdlib.h>
#include <string.h>
#include "output/half.h"

/* ---- what would come out the same ---- */

static bool same_mesh(const struct sf_mesh *a, const struct sf_mesh *b)
{
    size_t floats = (size_t)3 * a->vertex_count * sizeof(float);

    return a->vertex_count == b->vertex_count && a->index_count == b->index_count &&
           memcmp(a->positions, b->positions, floats) == 0 && memcmp(a->normals, b->normals, floats) == 0 &&
           memcmp(a->indices, b->indices, a->index_count * sizeof *a->indices) == 0;
}

/* The whole array of them: it is one pair of buffers. */
static bool same_meshes(const struct sf_scene *a, const struct sf_scene *b)
{
    bool same = a->mesh_count == b->mesh_count;

    for (uint32_t i = 0; i < a->mesh_count && same; i++)
        same = same_mesh(&a->meshes[i], &b->meshes[i]);
    return same;
}

static bool same_places(const struct sf_mesh_buffers *a, const struct sf_mesh_buffers *b)
{
    return a->vertex_bytes == b->vertex_bytes && a->index_bytes == b->index_bytes &&
           memcmp(a->first_vertex, b->first_vertex, sizeof a->first_vertex) == 0 &&
           memcmp(a->first_index, b->first_index, sizeof a->first_index) == 0;
}

static bool same_picture(const struct sf_environment *a, const struct sf_environment *b)
{
    return a->pixels && b->pixels && a->width == b->width && a->height == b->height &&
           memcmp(a->pixels, b->pixels, (size_t)3 * a->width * a->height * sizeof *a->pixels) == 0;
}

/* Takes over what serves the scene as it is, so that only the rest is made. */
static void share(const struct sf_drawn *drawn, const struct sf_assets_before *before, struct sf_assets *assets)
{
    const struct sf_scene *scene = drawn->scene, *other = before->drawn->scene;
    const struct sf_assets *from = before->assets;
    const struct sf_assets_before *own = before->method ? before->method : before;

    if (drawn->list.meshes > 0 && from->meshes.vertices && same_places(&drawn->meshes, &from->meshes) &&
        (!before->files || same_meshes(scene, other)))
        assets->meshes = from->meshes;
    if (sf_scene_shows_picture(scene) && from->environment &&
        (!before->files || same_picture(&scene->environment, &other->environment)))
        assets->environment = from->environment;
    assets->blank = from->blank;
    if (assets->row == own->assets->row &&
        (!assets->row->same_assets || assets->row->same_assets(scene, own->drawn->scene)))
        assets->method = own->assets->method;
}

static struct sf_shadow_scene shadow_scene(const struct sf_drawn *drawn, const struct sf_assets *assets)
{
    struct sf_shadow_scene scene = sf_drawn_shadow(drawn);

    scene.buffers = &assets->meshes;
    return scene;
}

/* ---- making ---- */

/* Position and normal side by side, meshes one after the other. */
static enum sf_status upload_meshes(struct sf_gpu *gpu, const struct sf_drawn *drawn, const struct sf_log *log,
                                    struct sf_mesh_buffers *buffers)
{
    const struct sf_scene *scene = drawn->scene;
    float *vertices, *vertex;
    uint32_t *indices;
    enum sf_status status = SF_OK;

    *buffers = drawn->meshes;
    if (buffers->vertex_bytes > sf_gpu_info(gpu)->max_storage_bytes ||
        buffers->index_bytes > sf_gpu_info(gpu)->max_storage_bytes)
        return sf_fail(
            log, SF_ERROR_SCENE,
            "the scene's meshes take %llu bytes of vertices and %llu of indices: this device binds at most %llu",
            (unsigned long long)buffers->vertex_bytes, (unsigned long long)buffers->index_bytes,
            (unsigned long long)sf_gpu_info(gpu)->max_storage_bytes);
    vertices = malloc(buffers->vertex_bytes);
    indices = malloc(buffers->index_bytes);
    if (!vertices || !indices)
        status = sf_fail(log, SF_ERROR_MEMORY, "the scene's meshes: out of memory");
    for (uint32_t i = 0; !status && i < scene->mesh_count; i++) {
        const struct sf_mesh *mesh = &scene->meshes[i];
        vertex = vertices + (size_t)6 * buffers->first_vertex[i];
        for (uint32_t v = 0; v < mesh->vertex_count; v++, vertex += 6) {
            memcpy(vertex, mesh->positions + (size_t)3 * v, 3 * sizeof *vertex);
            memcpy(vertex + 3, mesh->normals + (size_t)3 * v, 3 * sizeof *vertex);
        }
        memcpy(indices + buffers->first_index[i], mesh->indices, mesh->index_count * sizeof *indices);
    }
    if (!status)
        status = sf_gpu_buffer_create(gpu, "mesh.vertices", buffers->vertex_bytes, false, SF_ACCESS_STORAGE_READ,
                                      vertices, &buffers->vertices);
    if (!status)
        status = sf_gpu_buffer_create(gpu, "mesh.indices", buffers->index_bytes, false, SF_ACCESS_STORAGE_READ, indices,
                                      &buffers->indices);
    free(vertices);
    free(indices);
    return status;
}

static enum sf_status upload_environment(struct sf_gpu *gpu, const struct sf_environment *environment,
                                         const struct sf_log *log, struct sf_gpu_image **image)
{
    size_t pixels = (size_t)environment->width * environment->height;
    uint16_t *halves = malloc(pixels * 4 * sizeof *halves);
    enum sf_status status;

    if (!halves)
        return sf_fail(log, SF_ERROR_MEMORY, "the environment's picture: out of memory");
    for (size_t i = 0; i < pixels; i++) {
        for (size_t c = 0; c < 3; c++)
            halves[4 * i + c] = sf_half_from_float(environment->pixels[3 * i + c]);
        halves[4 * i + 3] = sf_half_from_float(1);
    }
    status = sf_gpu_image_create(gpu, "environment", SF_FORMAT_RGBA16F, environment->width, environment->height, 1,
                                 SF_ACCESS_SAMPLED, halves, image);
    free(halves);
    return status;
}

static enum sf_status draw_shadows(struct sf_gpu *gpu, const struct sf_drawn *drawn,
                                   const struct sf_assets_before *before, const struct sf_log *log,
                                   struct sf_assets *assets)
{
    struct sf_shadow_scene scene = shadow_scene(drawn, assets);

    if (before && before->assets->shadow_map) {
        struct sf_shadow_scene other = shadow_scene(before->drawn, before->assets);

        if (sf_shadow_same(&scene, &other)) {
            assets->shadow_map = before->assets->shadow_map;
            return SF_OK;
        }
    }
    return sf_shadow_create(gpu, &scene, log, &assets->shadow_map);
}

enum sf_status sf_assets_init(struct sf_gpu *gpu, const struct sf_drawn *drawn, const struct sf_assets_before *before,
                              const struct sf_log *log, struct sf_assets *assets)
{
    const uint16_t zeros[4] = {0};
    enum sf_status status = SF_OK;

    assets->row = &sf_methods[drawn->scene->method];
    if (before)
        share(drawn, before, assets);
    if (drawn->list.meshes > 0 && !assets->meshes.vertices)
        status = upload_meshes(gpu, drawn, log, &assets->meshes);
    if (!status && sf_scene_shows_picture(drawn->scene) && !assets->environment)
        status = upload_environment(gpu, &drawn->scene->environment, log, &assets->environment);
    if (!status && !assets->blank)
        status =
            sf_gpu_image_create(gpu, "blank", SF_FORMAT_RGBA16F, 1, 1, 1, SF_ACCESS_SAMPLED, zeros, &assets->blank);
    if (!status && drawn->shadow.count > 0)
        status = draw_shadows(gpu, drawn, before, log, assets);
    if (!status && assets->row->create_assets && !assets->method)
        status = assets->row->create_assets(gpu, drawn->scene, log, &assets->method);
    return status;
}

void sf_assets_bind(const struct sf_assets *assets, const struct sf_assembly *assembly, struct sf_player *player)
{
    if (assembly->vertices) {
        sf_player_bind_buffer(player, assembly->vertices, assets->meshes.vertices);
        sf_player_bind_buffer(player, assembly->indices, assets->meshes.indices);
    }
    if (assembly->environment)
        sf_player_bind_image(player, assembly->environment, assets->environment);
    if (assembly->blank)
        sf_player_bind_image(player, assembly->blank, assets->blank);
    if (assembly->drawn.shadow.count > 0)
        sf_player_bind_image(player, assembly->method.shadow_map, assets->shadow_map);
    if (assets->row->bind_assets)
        assets->row->bind_assets(assembly->graph, player, assets->method);
}

void sf_assets_leave_method(struct sf_assets *assets, const struct sf_assets *others)
{
    if (assets->row && assets->row->destroy_assets && assets->method != others->method)
        assets->row->destroy_assets(&assets->method);
    *assets = (struct sf_assets){0};
}

void sf_assets_leave(struct sf_assets *assets, const struct sf_assets *others)
{
    if (assets->meshes.vertices != others->meshes.vertices)
        sf_gpu_buffer_destroy(&assets->meshes.vertices);
    if (assets->meshes.indices != others->meshes.indices)
        sf_gpu_buffer_destroy(&assets->meshes.indices);
    if (assets->environment != others->environment)
        sf_gpu_image_destroy(&assets->environment);
    if (assets->shadow_map != others->shadow_map)
        sf_gpu_image_destroy(&assets->shadow_map);
    if (assets->blank != others->blank)
        sf_gpu_image_destroy(&assets->blank);
    sf_assets_leave_method(assets, others);
}

void sf_assets_finish(struct sf_assets *assets)
{
    const struct sf_assets none = {0};

    sf_assets_leave(assets, &none);
}
