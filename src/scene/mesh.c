#include "scene/mesh.h"

#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include "base/file.h"
#include "base/hash.h"
#include "params/json.h"
#include "scene/vector.h"

enum { NODE_DEPTH_MAX = 256 };
#define FILE_BYTES_MAX ((off_t)1 << 30)

/* ---- files for assimp: regular ones of bounded size, and no materials ---- */

static size_t file_read(struct aiFile *file, char *data, size_t size, size_t count)
{
    return fread(data, size, count, (FILE *)(void *)file->UserData);
}

static size_t file_write(struct aiFile *file, const char *data, size_t size, size_t count)
{
    (void)file, (void)data, (void)size, (void)count;
    return 0;
}

static size_t file_tell(struct aiFile *file)
{
    off_t at = ftello((FILE *)(void *)file->UserData);

    return at < 0 ? 0 : (size_t)at;
}

static size_t file_size(struct aiFile *file)
{
    struct stat info;

    return fstat(fileno((FILE *)(void *)file->UserData), &info) == 0 ? (size_t)info.st_size : 0;
}

static aiReturn file_seek(struct aiFile *file, size_t offset, enum aiOrigin origin)
{
    int whence = origin == aiOrigin_SET ? SEEK_SET : origin == aiOrigin_CUR ? SEEK_CUR : SEEK_END;

    return fseeko((FILE *)(void *)file->UserData, (off_t)offset, whence) == 0 ? aiReturn_SUCCESS : aiReturn_FAILURE;
}

static void file_flush(struct aiFile *file)
{
    (void)file;
}

static struct aiFile *file_open(struct aiFileIO *io, const char *path, const char *mode)
{
    struct aiFile *file;
    struct stat info;
    FILE *stream;

    (void)io;
    if (mode[0] != 'r' || sf_path_ends(path, ".mtl") || stat(path, &info) != 0 || !S_ISREG(info.st_mode) ||
        info.st_size > FILE_BYTES_MAX)
        return NULL;
    file = calloc(1, sizeof *file);
    stream = file ? fopen(path, "rb") : NULL;
    if (!stream) {
        free(file);
        return NULL;
    }
    *file = (struct aiFile){file_read, file_write, file_tell, file_size, file_seek, file_flush, (char *)(void *)stream};
    return file;
}

static void file_close(struct aiFileIO *io, struct aiFile *file)
{
    (void)io;
    if (file) {
        fclose((FILE *)(void *)file->UserData);
        free(file);
    }
}

/* ---- flattening ---- */

struct flat {
    const char *path;
    const struct sf_log *log;
    const struct aiScene *scene;
    struct sf_mesh *mesh; /* positions NULL: only counting */
    uint64_t vertices, indices;
};

static bool is_used(const struct aiMesh *part)
{
    return (part->mPrimitiveTypes & aiPrimitiveType_TRIANGLE) && part->mVertices && part->mNumFaces;
}

static void transform_point(const struct aiMatrix4x4 *m, const struct aiVector3D *v, float out[3])
{
    out[0] = m->a1 * v->x + m->a2 * v->y + m->a3 * v->z + m->a4;
    out[1] = m->b1 * v->x + m->b2 * v->y + m->b3 * v->z + m->b4;
    out[2] = m->c1 * v->x + m->c2 * v->y + m->c3 * v->z + m->c4;
}

/* By the cofactors of the linear part: the inverse transpose but for a factor, whose sign is right for mirrors too. */
static void transform_normal(const struct aiMatrix4x4 *m, const struct aiVector3D *v, float out[3])
{
    float a[3] = {m->a1, m->b1, m->c1}, b[3] = {m->a2, m->b2, m->c2}, c[3] = {m->a3, m->b3, m->c3}; /* columns */
    float x[3], y[3], z[3];
    double sign;

    sf_cross(b, c, x);
    sf_cross(c, a, y);
    sf_cross(a, b, z);
    sign = sf_dot(a, x) < 0 ? -1 : 1;
    for (int i = 0; i < 3; i++)
        out[i] = (float)(sign * ((double)x[i] * v->x + (double)y[i] * v->y + (double)z[i] * v->z));
}

static bool is_mirror(const struct aiMatrix4x4 *m)
{
    float a[3] = {m->a1, m->b1, m->c1}, b[3] = {m->a2, m->b2, m->c2}, c[3] = {m->a3, m->b3, m->c3}, x[3];

    sf_cross(b, c, x);
    return sf_dot(a, x) < 0;
}

static enum sf_status add_part(struct flat *flat, const struct aiMesh *part, const struct aiMatrix4x4 *to_world)
{
    struct sf_mesh *mesh = flat->mesh;
    bool mirror = is_mirror(to_world);
    uint64_t first = flat->vertices;

    if (!mesh->positions) {
        for (unsigned i = 0; i < part->mNumFaces; i++)
            flat->indices += part->mFaces[i].mNumIndices == 3 ? 3 : 0;
        flat->vertices += part->mNumVertices;
        if (flat->indices / 3 > SF_MESH_TRIANGLES_MAX || flat->vertices > (uint64_t)SF_MESH_TRIANGLES_MAX * 3)
            return sf_fail(flat->log, SF_ERROR_SCENE, "%s: more than %u triangles", flat->path, SF_MESH_TRIANGLES_MAX);
        return SF_OK;
    }
    for (unsigned i = 0; i < part->mNumVertices; i++) {
        float *position = mesh->positions + (first + i) * 3, *normal = mesh->normals + (first + i) * 3;

        transform_point(to_world, &part->mVertices[i], position);
        for (int axis = 0; axis < 3; axis++)
            if (!(fabsf(position[axis]) < 1e6f))
                return sf_fail(flat->log, SF_ERROR_SCENE, "%s: vertex %llu is not within a million units of the origin",
                               flat->path, (unsigned long long)(first + i));
        if (part->mNormals)
            transform_normal(to_world, &part->mNormals[i], normal);
    }
    for (unsigned i = 0; i < part->mNumFaces; i++) {
        const struct aiFace *face = &part->mFaces[i];

        if (face->mNumIndices != 3)
            continue;
        for (unsigned k = 0; k < 3; k++) {
            unsigned index = face->mIndices[mirror ? 2 - k : k];

            if (index >= part->mNumVertices)
                return sf_fail(flat->log, SF_ERROR_SCENE, "%s: a triangle names vertex %u of %u", flat->path, index,
                               part->mNumVertices);
            mesh->indices[flat->indices++] = (uint32_t)(first + index);
        }
    }
    flat->vertices += part->mNumVertices;
    return SF_OK;
}

static enum sf_status add_node(struct flat *flat, const struct aiNode *node, const struct aiMatrix4x4 *parent,
                               int depth)
{
    struct aiMatrix4x4 to_world = *parent;
    enum sf_status status = SF_OK;

    if (depth > NODE_DEPTH_MAX)
        return sf_fail(flat->log, SF_ERROR_SCENE, "%s: nodes are nested more than %d deep", flat->path, NODE_DEPTH_MAX);
    aiMultiplyMatrix4(&to_world, &node->mTransformation);
    for (unsigned i = 0; i < node->mNumMeshes && status == SF_OK; i++)
        if (node->mMeshes[i] < flat->scene->mNumMeshes && is_used(flat->scene->mMeshes[node->mMeshes[i]]))
            status = add_part(flat, flat->scene->mMeshes[node->mMeshes[i]], &to_world);
    for (unsigned i = 0; i < node->mNumChildren && status == SF_OK; i++)
        status = add_node(flat, node->mChildren[i], &to_world, depth + 1);
    return status;
}

/* The file's normals to unit length; all new ones when one has no direction. */
static bool finish_normals(struct sf_mesh *mesh, struct sf_arena *arena)
{
    for (size_t i = 0; i < mesh->vertex_count; i++)
        if (!sf_normalize(mesh->normals + i * 3))
            return sf_mesh_make_normals(mesh, arena);
    return true;
}

static void measure(struct sf_mesh *mesh)
{
    for (int axis = 0; axis < 3; axis++) {
        mesh->min[axis] = FLT_MAX;
        mesh->max[axis] = -FLT_MAX;
    }
    for (size_t i = 0; i < mesh->index_count; i++) {
        const float *position = mesh->positions + (size_t)mesh->indices[i] * 3;

        for (int axis = 0; axis < 3; axis++) {
            mesh->min[axis] = fminf(mesh->min[axis], position[axis]);
            mesh->max[axis] = fmaxf(mesh->max[axis], position[axis]);
        }
    }
}

static enum sf_status flatten(const char *path, const struct aiScene *scene, struct sf_arena *arena,
                              const struct sf_log *log, struct sf_mesh *mesh)
{
    struct flat flat = {path, log, scene, mesh, 0, 0};
    struct aiMatrix4x4 identity;
    enum sf_status status;

    aiIdentityMatrix4(&identity);
    if (!scene->mRootNode)
        return sf_fail(log, SF_ERROR_SCENE, "%s: holds no triangles", path);
    if ((status = add_node(&flat, scene->mRootNode, &identity, 0)) != SF_OK)
        return status;
    if (flat.indices == 0)
        return sf_fail(log, SF_ERROR_SCENE, "%s: holds no triangles", path);
    mesh->vertex_count = (uint32_t)flat.vertices;
    mesh->index_count = (uint32_t)flat.indices;
    mesh->positions = sf_arena_alloc(arena, flat.vertices * 3 * sizeof(float));
    mesh->normals = sf_arena_alloc(arena, flat.vertices * 3 * sizeof(float));
    mesh->indices = sf_arena_alloc(arena, flat.indices * sizeof(uint32_t));
    if (!mesh->positions || !mesh->normals || !mesh->indices)
        return sf_fail(log, SF_ERROR_MEMORY, "%s: out of memory for %u triangles", path,
                       (unsigned)(mesh->index_count / 3));
    flat.vertices = flat.indices = 0;
    if ((status = add_node(&flat, scene->mRootNode, &identity, 0)) != SF_OK)
        return status;
    if (!finish_normals(mesh, arena))
        return sf_fail(log, SF_ERROR_MEMORY, "%s: out of memory for normals", path);
    measure(mesh);
    return SF_OK;
}

static const struct aiScene *import(const char *path)
{
    const unsigned steps = aiProcess_ValidateDataStructure | aiProcess_RemoveComponent | aiProcess_Triangulate |
                           aiProcess_SortByPType | aiProcess_JoinIdenticalVertices;
    struct aiFileIO io = {file_open, file_close, NULL};
    struct aiPropertyStore *settings = aiCreatePropertyStore();
    const struct aiScene *scene;

    if (!settings)
        return NULL;
    aiSetImportPropertyInteger(settings, AI_CONFIG_PP_RVC_FLAGS,
                               aiComponent_TANGENTS_AND_BITANGENTS | aiComponent_COLORS | aiComponent_TEXCOORDS |
                                   aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS | aiComponent_TEXTURES |
                                   aiComponent_LIGHTS | aiComponent_CAMERAS);
    aiSetImportPropertyInteger(settings, AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    scene = aiImportFileExWithProperties(path, steps, &io, settings);
    aiReleasePropertyStore(settings);
    return scene;
}

enum sf_status sf_mesh_read(const char *path, struct sf_arena *arena, const struct sf_log *log, struct sf_mesh *mesh,
                            uint64_t *hash)
{
    const struct aiScene *scene;
    enum sf_status status;
    struct stat info;
    char reason[160];

    if (!sf_path_ends(path, ".obj") && !sf_path_ends(path, ".gltf") && !sf_path_ends(path, ".glb"))
        return sf_fail(log, SF_ERROR_SCENE, "%s: unsupported kind of file; meshes come from .obj, .gltf or .glb", path);
    if (stat(path, &info) != 0 || !S_ISREG(info.st_mode))
        return sf_fail(log, SF_ERROR_SCENE, "%s: no such file", path);
    if (info.st_size > FILE_BYTES_MAX)
        return sf_fail(log, SF_ERROR_SCENE, "%s: %lld bytes; a mesh file holds at most 1 GiB", path,
                       (long long)info.st_size);
    scene = import(path);
    if (!scene) {
        sf_param_clean(aiGetErrorString(), reason, sizeof reason);
        return sf_fail(log, SF_ERROR_SCENE, "%s: not a readable mesh: %s", path, reason);
    }
    status = flatten(path, scene, arena, log, mesh);
    aiReleaseImport(scene);
    if (status == SF_OK) {
        *hash = sf_hash_bytes(mesh->positions, (size_t)mesh->vertex_count * 3 * sizeof(float), 0);
        *hash = sf_hash_bytes(mesh->normals, (size_t)mesh->vertex_count * 3 * sizeof(float), *hash);
        *hash = sf_hash_bytes(mesh->indices, (size_t)mesh->index_count * sizeof(uint32_t), *hash);
    }
    return status;
}
