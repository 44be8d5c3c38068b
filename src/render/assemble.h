/* A frame's graph: scene + method -> passes -> picture -> buffers that the CPU reads. No device is needed to declare it. */
#ifndef SF_RENDER_ASSEMBLE_H
#define SF_RENDER_ASSEMBLE_H

#include "light/shadow.h"
#include "methods/method.h"
#include "render/inspect.h"
#include "render/uniforms.h"

struct sf_assembly {
    const struct sf_scene *scene;
    uint32_t width, height;
    bool float_color;
    struct sf_object_list list;
    struct sf_gpu_object objects[SF_FRAME_OBJECTS]; /* in the list's order */
    struct sf_shadow_cells shadow;
    struct sf_mesh_buffers meshes;
    struct sf_mesh_push mesh_push[SF_OBJECTS_MAX];
    struct sf_graph *graph;
    struct sf_plan *plan;
    struct sf_method_frame method;
    void *state; /* the method's */
    sf_resource objects_upload;
    sf_resource environment, blank; /* imported images; 0 when not needed */
    sf_resource vertices, indices;  /* imported; 0 without meshes */
    sf_resource read_color, read_depth, read_counts, read_smoke,
        read_depths; /* readback buffers; 0 when not asked for */
    struct sf_inspected inspected;
};

struct sf_assembly_options {
    uint32_t width, height;
    bool float_color, no_readback;
    uint32_t aovs;
    uint32_t capacity;   /* particles in the list */
    const char *inspect; /* an image of the graph that comes back as well, or NULL */
};
/* Declares and compiles. The scene must outlive it; `memory` may be NULL. */
enum sf_status sf_assembly_create(const struct sf_scene *scene, const struct sf_assembly_options *options,
                                  const struct sf_gpu_tuning *tuning, const struct sf_plan_memory *memory,
                                  const struct sf_log *log, struct sf_assembly **assembly);
void sf_assembly_destroy(struct sf_assembly **assembly);
/* What the shadow map's graph needs of it; points into the assembly. */
struct sf_shadow_scene sf_assembly_shadow(const struct sf_assembly *assembly);
/* The scene's background shows its environment picture. */
bool sf_scene_shows_picture(const struct sf_scene *scene);

#endif
