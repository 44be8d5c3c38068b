/* What of a scene the frame's graph draws: read off it alone, so that two scenes can be compared. No GPU. */
#ifndef SF_RENDER_DRAWN_H
#define SF_RENDER_DRAWN_H

#include "light/shadow.h"
#include "render/uniforms.h"

enum { SF_SHADE_CONSTANTS = 8 };

struct sf_drawn {
    const struct sf_scene *scene;
    struct sf_object_list list;
    struct sf_gpu_object objects[SF_FRAME_OBJECTS]; /* in the list's order */
    struct sf_shadow_cells shadow;
    struct sf_mesh_buffers meshes; /* where each will stand, and no buffers */
    /* Specialization constants as glsl/scene/shade.glsl numbers them; SF_SHADE_CASTS as if the method gave a map. */
    uint32_t constants[SF_SHADE_CONSTANTS];
};
enum { SF_SHADE_CASTS = 4 };

/* Points into the scene. */
void sf_drawn_fill(const struct sf_scene *scene, struct sf_drawn *drawn);
/* Whether the graph declared for one draws the other as it stands, as far as lists, pictures and the list of particles
 * go; the method's settings aside, for which the parameter table has bits. */
bool sf_drawn_alike(const struct sf_drawn *a, const struct sf_drawn *b);
/* What the shadow map's graph needs of it; points into it. */
struct sf_shadow_scene sf_drawn_shadow(const struct sf_drawn *drawn);
/* The scene's background shows its environment picture. */
bool sf_scene_shows_picture(const struct sf_scene *scene);

#endif
