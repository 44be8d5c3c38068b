/* A frame's graph: scene + method -> passes -> picture -> buffers that the CPU reads. No device is needed to declare it. */
#ifndef SF_RENDER_ASSEMBLE_H
#define SF_RENDER_ASSEMBLE_H

#include "methods/method.h"
#include "render/drawn.h"
#include "render/inspect.h"

struct sf_assembly {
    uint32_t width, height;
    bool float_color;
    struct sf_drawn drawn;
    struct sf_mesh_push mesh_push[SF_OBJECTS_MAX];
    struct sf_flash_push flash;
    uint32_t flash_draw[2]; /* vertices, instances: 0 while nothing flashes */
    struct sf_graph *graph;
    struct sf_plan *plan;
    struct sf_method_frame method;
    void *state; /* the method's */
    sf_resource objects_upload;
    sf_resource environment, blank; /* imported images; 0 when not needed */
    sf_resource vertices, indices;  /* imported; 0 without meshes */
    sf_resource read_color, read_depth, read_counts, read_verdict, read_smoke, read_depths, read_particles,
        read_probe;              /* readback buffers; 0 when not asked for */
    enum sf_format smoke_format; /* of read_smoke: RGBA16F or RGBA32F, as the method has it */
    struct sf_inspected inspected;
};

struct sf_assembly_options {
    uint32_t width, height;
    bool float_color, no_readback;
    bool shown;    /* the picture is drawn into an imported image that rests in SF_ACCESS_SAMPLED; only counts, list
                      and `inspect` come back, unless: */
    bool returned; /* all comes back as well */
    uint32_t aovs;
    bool particles;      /* the list comes back */
    bool probe;          /* what the method samples along one pixel's ray comes back */
    uint32_t capacity;   /* particles in the list */
    const char *inspect; /* an image or buffer of the graph that comes back as well, or NULL */
};
/* Declares and compiles. The scene must outlive it; `memory` may be NULL. */
enum sf_status sf_assembly_create(const struct sf_scene *scene, const struct sf_assembly_options *options,
                                  const struct sf_gpu_tuning *tuning, const struct sf_plan_memory *memory,
                                  const struct sf_log *log, struct sf_assembly **assembly);
void sf_assembly_destroy(struct sf_assembly **assembly);
/* Sets what the frame at the time flashes. */
void sf_assembly_set_time(struct sf_assembly *assembly, double time);
/* Points it at another scene, for which its graph serves as it is (sf_drawn_alike). */
void sf_assembly_set_scene(struct sf_assembly *assembly, const struct sf_drawn *drawn);

#endif
