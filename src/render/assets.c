#include "render/assets.h"

#include <stdlib.h>
#include <string.h>
#include "output/half.h"

/* Position and normal side by side, meshes one after the other. */
static enum sf_status upload_meshes(struct sf_gpu *gpu, const struct sf_assembly *assembly, const struct sf_log *log,
                                    struct sf_mesh_buffers *buffers)
{
    const struct sf_scene *scene = assembly->scene;
    float *vertices, *vertex;
    uint32_t *indices;
    enum sf_status status = SF_OK;

    *buffers = assembly->meshes;
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

enum sf_status sf_assets_init(struct sf_gpu *gpu, const struct sf_assembly *assembly, const struct sf_log *log,
                              struct sf_assets *assets)
{
    const uint16_t zeros[4] = {0};
    enum sf_status status = SF_OK;

    assets->row = &sf_methods[assembly->scene->method];
    if (assembly->list.meshes > 0)
        status = upload_meshes(gpu, assembly, log, &assets->meshes);
    if (!status && assembly->environment)
        status = upload_environment(gpu, &assembly->scene->environment, log, &assets->environment);
    if (!status && assembly->blank)
        status =
            sf_gpu_image_create(gpu, "blank", SF_FORMAT_RGBA16F, 1, 1, 1, SF_ACCESS_SAMPLED, zeros, &assets->blank);
    if (!status && assembly->shadow.count > 0) {
        struct sf_shadow_scene shadow = sf_assembly_shadow(assembly);
        shadow.buffers = &assets->meshes;
        status = sf_shadow_create(gpu, &shadow, log, &assets->shadow_map);
    }
    if (!status && assets->row->create_assets)
        status = assets->row->create_assets(gpu, assembly->scene, log, &assets->method);
    return status;
}

void sf_assets_bind(struct sf_assets *assets, const struct sf_assembly *assembly, struct sf_player *player)
{
    if (assembly->vertices) {
        sf_player_bind_buffer(player, assembly->vertices, assets->meshes.vertices);
        sf_player_bind_buffer(player, assembly->indices, assets->meshes.indices);
    }
    if (assembly->environment)
        sf_player_bind_image(player, assembly->environment, assets->environment);
    if (assembly->blank)
        sf_player_bind_image(player, assembly->blank, assets->blank);
    if (assembly->shadow.count > 0)
        sf_player_bind_image(player, assembly->method.shadow_map, assets->shadow_map);
    if (assets->row->bind_assets)
        assets->row->bind_assets(assembly->graph, player, assets->method);
}

void sf_assets_finish(struct sf_assets *assets)
{
    if (assets->row && assets->row->destroy_assets)
        assets->row->destroy_assets(&assets->method);
    sf_gpu_buffer_destroy(&assets->meshes.vertices);
    sf_gpu_buffer_destroy(&assets->meshes.indices);
    sf_gpu_image_destroy(&assets->environment);
    sf_gpu_image_destroy(&assets->shadow_map);
    sf_gpu_image_destroy(&assets->blank);
}
