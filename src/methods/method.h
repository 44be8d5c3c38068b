/* What a rendering method is: a row of the table. It adds its passes to the frame's graph; adding a method touches
 * nothing else. */
#ifndef SF_METHODS_METHOD_H
#define SF_METHODS_METHOD_H

#include "gpu/gpu.h"
#include "scene/scene.h"

/* What the frame gives a method, and what the method gives back. Resources are of the frame's graph. */
struct sf_method_frame {
    struct sf_graph *graph;
    const struct sf_scene *scene;
    const struct sf_gpu_tuning *tuning;
    uint32_t width, height; /* of the frame */
    sf_resource frame;      /* uniform: struct sf_gpu_frame */
    sf_resource particles;  /* storage: struct sf_particle[] */
    sf_resource counts;     /* storage, indirect: struct sf_particle_counts */
    sf_resource color; /* RGBA16F frame: the shaded scene, premultiplied; alpha is 1 on surfaces and visible background,
                          0 on nothing */
    sf_resource depth; /* R32F frame: linear view depth of the scene, SF_DEPTH_FAR where there is none */
    sf_resource shadow_map;  /* exponential shadow maps of the lights, one cell a light */
    sf_resource objects;     /* uniform: struct sf_gpu_object[SF_FRAME_OBJECTS]: planes, then solids, then meshes */
    uint32_t planes, solids; /* of them; solids are boxes, spheres and cylinders */
    /* For `update`: which play of the picture comes next. 0 begins it anew; behind the last (see `plays`) it is finished,
     * and only drawn again. */
    uint32_t play;
    /* Set by `light`: what the scene's shading reads for the smoke's shadow on it. 0: none. */
    sf_resource smoke_map;   /* RGBA32F, cells side by side, one a light: R near, G far, B coverage, A optical depth */
    bool smoke_shadows;      /* the scene is to be shadowed by what smoke_map holds */
    sf_resource smoke_views; /* storage: struct sf_gpu_light_view[light_count] */
    /* Set by `view` when asked for: planes at the frame's size; 0 when the method has none. */
    bool want_aovs;
    sf_resource aov_radiance; /* RGBA16F: premultiplied smoke alone, A: alpha */
    sf_resource aov_depths;   /* RGBA32F: near, far (m of view depth), optical depth, transmittance */
    sf_resource verdict;      /* buffer for `judge`, which comes back with the frame */
    /* Set by `view` when asked for: a buffer as shared/probe.h has it, with what the method sampled along the ray of the
     * frame's pixel probe_at (`update` finds it there); 0 when the method keeps nothing of the way. Comes back with the
     * frame. */
    bool want_probe;
    uint32_t probe_at[2];
    sf_resource probe;
};

struct sf_method_row {
    const char *name; /* "thick" */
    const char *doc;
    double goal; /* see sf_measure_goal */
    /* Passes before the scene is shaded (what lights see), and after (what the camera sees, composited over `color`).
     * `state` is the method's own memory for push constants, alive as long as the graph. */
    enum sf_status (*light)(struct sf_method_frame *frame, void *state, const struct sf_log *log);
    enum sf_status (*view)(struct sf_method_frame *frame, void *state, const struct sf_log *log);
    /* Renews push constants from the scene's settings before each play. */
    void (*update)(const struct sf_method_frame *frame, void *state);
    size_t state_bytes;
    /* How many plays of its graph bring a picture to its end, each bettering what the one before left in persistent
     * images; NULL: one does. */
    uint32_t (*plays)(const struct sf_scene *scene);
    /* Whether a frame came out as it should, from the method's verdict buffer; else the reason is in the log. NULL: it always
     * does. */
    enum sf_status (*judge)(const struct sf_method_frame *frame, const void *verdict, const struct sf_log *log);
    /* Device objects that outlive a graph (atlas textures): NULL when there are none. */
    enum sf_status (*create_assets)(struct sf_gpu *gpu, const struct sf_scene *scene, const struct sf_log *log,
                                    void **assets);
    void (*destroy_assets)(void **assets);
    bool (*same_assets)(const struct sf_scene *a, const struct sf_scene *b); /* those of one serve the other */
    void (*bind_assets)(const struct sf_graph *graph, struct sf_player *player, void *assets);
};

/* Indexed by enum sf_method. */
extern const struct sf_method_row sf_methods[];
extern const uint32_t sf_method_count;

#endif
