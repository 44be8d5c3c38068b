/* Exponential shadow maps of the scene's finite objects (METHODS C8), for the scene and for the smoke. Objects do not move, so the maps are
 * drawn once, by a small graph of its own, and every frame samples them.
 *
 * Each shadow-casting light has a cell of the atlas, fitted to the finite objects (a spot's to its cone as well). Texels that no object
 * covers hold the depth of the plane behind, so that the blur makes the right penumbra on the ground. Outside of its cell a light
 * casts no shadow of objects. A point light looks at most 150 degrees wide. */
#ifndef SF_LIGHT_SHADOW_H
#define SF_LIGHT_SHADOW_H

#include "gpu/gpu.h"
#include "scene/scene.h"
#include "shared/frame.h"
#include "shared/shadow.h"

struct sf_shadow_cells {
    uint32_t count;                /* 0: nothing casts, and there is no map */
    uint32_t size;                 /* px: edge of a cell */
    uint32_t light[SF_LIGHTS_MAX]; /* of each cell */
    struct sf_gpu_shadow_cell cell[SF_LIGHTS_MAX];
    float bias[SF_LIGHTS_MAX]; /* in map depth: taken off the receiver's */
};
void sf_shadow_fit(const struct sf_scene *scene, struct sf_shadow_cells *cells);
/* Sets `shadow` and `world_to_map` of the frame's lights. */
void sf_shadow_fill(const struct sf_shadow_cells *cells, struct sf_gpu_frame *frame);
/* One bit a light: it has a cell. */
uint32_t sf_shadow_mask(const struct sf_shadow_cells *cells);

/* The scene's meshes on the device, one after the other, and where each begins. All zero when the scene has none. */
struct sf_mesh_buffers {
    struct sf_gpu_buffer *vertices; /* position and normal, 6 floats a vertex; outside: storage read */
    struct sf_gpu_buffer *indices;  /* of the mesh's own vertices */
    uint64_t vertex_bytes, index_bytes;
    uint32_t first_vertex[SF_MESHES_MAX], first_index[SF_MESHES_MAX];
};

/* What the map's graph needs; `objects` is the list in its order (planes, solids, meshes; shared/frame.h). All must outlive the graph. */
struct sf_shadow_scene {
    const struct sf_scene *scene;
    const struct sf_shadow_cells *cells;
    const struct sf_gpu_object *objects;
    const uint32_t *from; /* of each object: its index in the scene */
    uint32_t planes, solids, meshes;
    const struct sf_mesh_buffers *buffers; /* the counts and bytes at least, for declaring */
};
/* The graph that draws the map, named "shadow". `push` stays the caller's while the graph lives. */
struct sf_shadow_pushes {
    struct sf_shadow_push blur;
    struct sf_mesh_push mesh[SF_OBJECTS_MAX];
};
enum sf_status sf_shadow_declare(const struct sf_shadow_scene *scene, struct sf_shadow_pushes *pushes,
                                 const struct sf_log *log, struct sf_graph **graph);
/* Whether the object of that number, a mesh in both, is the same part of the buffers. */
bool sf_shadow_mesh_same(const struct sf_shadow_scene *a, const struct sf_shadow_scene *b, uint32_t object);
/* Whether the map drawn for one is that of the other, bit for bit. Meshes are the same when they are in the same
 * buffers. */
bool sf_shadow_same(const struct sf_shadow_scene *a, const struct sf_shadow_scene *b);
/* Draws it and waits. The image rests in SF_ACCESS_SAMPLED; the caller destroys it. Not for cells->count 0. */
enum sf_status sf_shadow_create(struct sf_gpu *gpu, const struct sf_shadow_scene *scene, const struct sf_log *log,
                                struct sf_gpu_image **map);

#endif
