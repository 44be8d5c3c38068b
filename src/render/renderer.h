/* The renderer's insides: renderer.c plays it, results.c hands out what comes back, renderer_parts.c makes and changes it,
 * print.c prints it. */
#ifndef SF_RENDER_RENDERER_H
#define SF_RENDER_RENDERER_H

#include "render/assemble.h"
#include "render/assets.h"
#include "render/internal.h"
#include "sim/particles.h"

enum { SF_FRAMES_KEPT_MAX = 8, SF_TICKETS = 16 };

/* The scene's method and, when asked for, a second one beside it: both draw each frame from the same particles. */
enum { SF_SIDES = 2 };

/* A frame that was queued. */
struct sf_queued {
    uint64_t ticket;
    uint64_t serials[SF_SIDES]; /* the frame of the device that made each side's picture */
    uint32_t number;
    double time;
    struct sf_camera_pose pose;
    uint32_t probe[2];
    uint64_t stepped; /* the frame of the device with which simulation steps went; 0: none */
    float progress[SF_SIDES];
    float world_to_camera[16], world_to_clip[16];
};

/* The frame's graph made real, and what goes with it: all made anew when its shape changes. */
struct sf_stage {
    struct sf_assembly *assembly;
    struct sf_player *player;
    struct sf_pass_timing *timings;       /* room for all passes */
    float *inspected[SF_FRAMES_KEPT_MAX]; /* by ticket; NULL until the first is asked for */
    uint64_t inspected_ticket[SF_FRAMES_KEPT_MAX];
    void *smoke[SF_FRAMES_KEPT_MAX]; /* likewise, when what comes back is not what was asked for */
    uint64_t smoke_ticket[SF_FRAMES_KEPT_MAX];
    struct sf_gpu_image *shown; /* NULL: not asked for */
    uint32_t shown_accesses;    /* that it was made for */
    bool drawn;                 /* it holds a picture */
};

/* How far the picture in hand has come, and what it is of: with anything else it begins anew. */
struct sf_still {
    bool valid;
    uint32_t plays; /* of the method's graph so far */
    uint64_t steps; /* of the simulation */
    uint64_t shaders_set;
    struct sf_gpu_frame frame;
};

/* A method that draws, and all that it alone needs. */
struct sf_side {
    const struct sf_scene *scene; /* the renderer's, or: */
    struct sf_scene *own;         /* a copy that differs in nothing but the method; its pointers are the scene's */
    struct sf_assets assets;      /* of the second side only the method's own; the others are the first's */
    struct sf_stage stage;
    struct sf_still still;
    bool begun;            /* it has been played for the picture in hand */
    uint64_t serial;       /* the frame of the device that played it last */
    uint64_t void_tickets; /* the first ones, whose results are gone */
};

struct sf_renderer {
    struct sf_device *device;
    const struct sf_scene *scene;
    const struct sf_log *log;
    struct sf_renderer_options options; /* `inspect` is our own copy */
    struct sf_camera_pose pose;         /* instead of the scene's camera, when: */
    bool posed;
    uint32_t probe[2]; /* the probed pixel */
    struct sf_particles *particles;
    struct sf_side sides[SF_SIDES]; /* zeros from side_count on */
    uint32_t side_count;
    struct sf_queued coming; /* the picture in hand, which has no ticket yet, when: */
    bool begun;
    struct sf_queued queued[SF_TICKETS]; /* by ticket */
    uint64_t tickets;                    /* given so far */
    uint64_t record_ns;
    uint32_t recorded; /* passes */
};

#endif
