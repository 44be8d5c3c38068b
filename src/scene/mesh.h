/* Triangle meshes from OBJ and glTF files, by assimp. */
#ifndef SF_SCENE_MESH_H
#define SF_SCENE_MESH_H

#include "scene/scene.h"

#define SF_MESH_TRIANGLES_MAX (16u << 20)

/* Reads the whole file as one mesh in its own units: node transforms applied, polygons cut into triangles, points and
 * lines left out, equal vertices joined. Normals are the file's, of unit length; where any is missing all are made
 * (sf_mesh_make_normals). Arrays are in the arena. *hash is of the geometry. SF_ERROR_SCENE: unsupported ending,
 * missing, corrupt, no triangles, more than SF_MESH_TRIANGLES_MAX, a file of more than 1 GiB; SF_ERROR_MEMORY. The
 * messages begin with the path. mesh->file is left alone. */
enum sf_status sf_mesh_read(const char *path, struct sf_arena *arena, const struct sf_log *log, struct sf_mesh *mesh,
                            uint64_t *hash);

/* Makes all normals anew, splitting vertices at folds of more than 60 degrees. False when memory is out, and then
 * nothing has changed. */
bool sf_mesh_make_normals(struct sf_mesh *mesh, struct sf_arena *arena);

#endif
