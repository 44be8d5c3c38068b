/* The files that a scene names: meshes, particles, pictures. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/file.h"
#include "base/hash.h"
#include "scene/environment.h"
#include "scene/load.h"
#include "scene/mesh.h"
#include "scene/particle_file.h"

static void listen(void *user, enum sf_log_level level, const char *message)
{
    struct sf_listener *listener = user;

    if (level == SF_LOG_ERROR)
        sf_param_clean(message, listener->error, sizeof listener->error);
    else
        sf_log(listener->reader->log, level, "%s", message);
}

void sf_listener_init(struct sf_listener *listener, const struct sf_param_reader *reader)
{
    *listener = (struct sf_listener){{listen, listener, reader->log ? reader->log->level : SF_LOG_ERROR}, reader, ""};
}

enum sf_status sf_listener_retell(const struct sf_listener *listener, enum sf_status status)
{
    const struct sf_param_reader *reader = listener->reader;

    if (status == SF_OK)
        return SF_OK;
    if (status == SF_ERROR_MEMORY)
        return sf_fail(reader->log, status, "%s: %s: %s", reader->name, reader->pointer, listener->error);
    return sf_param_reader_fail(reader, "%s", listener->error[0] ? listener->error : "cannot be read");
}

static void stir(struct sf_scene *scene, uint64_t hash)
{
    scene->hash = sf_hash_bytes(&hash, sizeof hash, scene->hash);
}

static enum sf_status out_of_memory(const struct sf_param_reader *reader)
{
    return sf_fail(reader->log, SF_ERROR_MEMORY, "%s: out of memory", reader->name);
}

/* The index of the mesh in the file, reading it when it is the first to be asked for. */
static enum sf_status find_mesh(struct sf_scene *scene, const struct sf_param_reader *reader, const char *file,
                                uint32_t *index)
{
    struct sf_listener listener;
    struct sf_mesh *mesh = &scene->meshes[scene->mesh_count];
    enum sf_status status;
    uint64_t hash = 0;
    char *path;

    for (uint32_t i = 0; i < scene->mesh_count; i++) {
        if (strcmp(scene->meshes[i].file, file) == 0) {
            *index = i;
            return SF_OK;
        }
    }
    if (scene->mesh_count == SF_MESHES_MAX)
        return sf_param_reader_fail(reader, "more than %d different mesh files", SF_MESHES_MAX);
    if (!(path = sf_path_beside(scene->path, file)))
        return out_of_memory(reader);
    sf_listener_init(&listener, reader);
    status = sf_listener_retell(&listener, sf_mesh_read(path, &scene->arena, &listener.log, mesh, &hash));
    free(path);
    if (status != SF_OK)
        return status;
    mesh->file = file;
    stir(scene, hash);
    *index = scene->mesh_count++;
    return SF_OK;
}

static enum sf_status load_list(struct sf_scene *scene, const struct sf_param_reader *reader,
                                struct sf_emitter *emitter)
{
    struct sf_listener listener;
    char *path = sf_path_beside(scene->path, emitter->file);
    enum sf_status status;
    uint64_t hash = 0;

    if (!path)
        return out_of_memory(reader);
    sf_listener_init(&listener, reader);
    status = sf_listener_retell(&listener, sf_particle_file_read(path, &scene->arena, &listener.log, &emitter->list,
                                                                 &emitter->list_count, &hash));
    free(path);
    if (status == SF_OK)
        stir(scene, hash);
    return status;
}

static enum sf_status load_environment(struct sf_scene *scene, struct sf_param_reader *reader)
{
    struct sf_environment *environment = &scene->environment;
    struct sf_listener listener;
    bool cube = environment->kind == SF_ENVIRONMENT_CUBE;
    uint32_t count = cube ? 6 : environment->kind == SF_ENVIRONMENT_LATLONG ? 1 : 0, bad = 0;
    char *paths[6] = {NULL};
    enum sf_status status = SF_OK;

    for (uint32_t i = 0; i < count; i++)
        if (!(paths[i] = sf_path_beside(scene->path, cube ? environment->files[i] : environment->file)))
            status = out_of_memory(reader);
    if (count && status == SF_OK) {
        sf_listener_init(&listener, reader);
        status = sf_environment_load(environment, paths, &scene->arena, &listener.log, &bad);
        if (cube)
            sf_param_reader_at(reader, "/environment/files/%u", (unsigned)bad);
        else
            sf_param_reader_at(reader, "/environment/file");
        status = sf_listener_retell(&listener, status);
    }
    for (uint32_t i = 0; i < count; i++)
        free(paths[i]);
    if (status != SF_OK)
        return status;
    if (environment->pixels)
        stir(scene, sf_hash_bytes(environment->pixels,
                                  (size_t)environment->width * environment->height * 3 * sizeof(float), 0));
    sf_environment_project(environment);
    return SF_OK;
}

static enum sf_status load_atlas(struct sf_scene *scene, struct sf_param_reader *reader)
{
    struct sf_atlas *atlas = &scene->atlas;
    struct sf_listener listener;
    struct sf_texture_info info;
    enum sf_status status;
    char *path;

    if (atlas->kind != SF_ATLAS_FILE)
        return SF_OK;
    if (!(path = sf_path_beside(scene->path, atlas->file)))
        return out_of_memory(reader);
    sf_listener_init(&listener, reader);
    sf_param_reader_at(reader, "/atlas/file");
    status = sf_listener_retell(&listener, sf_texture_load(path, (uint32_t)atlas->across, (uint32_t)atlas->down,
                                                           SF_TEXTURE_ALPHA, &listener.log, &atlas->texture));
    free(path);
    if (status != SF_OK)
        return status;
    sf_texture_describe(atlas->texture, &info);
    size_t bytes = (size_t)info.width * info.height * 4 * sizeof(float);
    atlas->hash = sf_hash_bytes(info.shape, bytes, sf_hash_bytes(info.color, bytes, info.width));
    stir(scene, atlas->hash);
    return SF_OK;
}

void sf_scene_atlas_options(const struct sf_atlas *atlas, struct sf_texture_options *options)
{
    static const char *const kinds[] = {"fbm", "turbulence", "cellular", "dispersed"};

    sf_texture_options_init(options);
    options->kind = kinds[atlas->smoke];
    options->tiles_x = (uint32_t)atlas->across;
    options->tiles_y = (uint32_t)atlas->down;
    options->width = options->height = (uint32_t)atlas->size;
    options->seed = (uint32_t)atlas->seed;
}

enum sf_status sf_scene_load_assets(struct sf_scene *scene, struct sf_param_reader *reader)
{
    enum sf_status status = SF_OK;

    for (uint32_t i = 0; i < scene->object_count && status == SF_OK; i++) {
        struct sf_object *object = &scene->objects[i];

        sf_param_reader_at(reader, "/objects/%u/file", (unsigned)i);
        if (object->kind == SF_OBJECT_MESH)
            status = find_mesh(scene, reader, object->file, &object->mesh);
    }
    for (uint32_t i = 0; i < scene->emitter_count && status == SF_OK; i++) {
        struct sf_emitter *emitter = &scene->emitters[i];
        char place[SF_PLACE_BYTES];

        sf_param_reader_at(reader, "%s/file", sf_emitter_place(scene, i, place));
        if (emitter->kind == SF_EMITTER_MESH)
            status = find_mesh(scene, reader, emitter->file, &emitter->mesh);
        else if (emitter->file)
            status = load_list(scene, reader, emitter);
    }
    if (status == SF_OK)
        status = load_atlas(scene, reader);
    return status == SF_OK ? load_environment(scene, reader) : status;
}
