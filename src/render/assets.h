/* Device objects that outlive a frame's graph: meshes, the environment's picture, the shadow map, the method's own. */
#ifndef SF_RENDER_ASSETS_H
#define SF_RENDER_ASSETS_H

#include "render/assemble.h"

struct sf_assets {
    struct sf_mesh_buffers meshes;
    struct sf_gpu_image *environment, *shadow_map, *blank;
    const struct sf_method_row *row;
    void *method;
};

/* What a renderer has already: the scene that it was made for, and whether files of the two scenes may differ. */
struct sf_assets_before {
    const struct sf_assets *assets;
    const struct sf_drawn *drawn;
    bool files;
    const struct sf_assets_before *method; /* that the method's own are taken from; NULL: from these as well */
};
/* Uploads what the scene's graph imports, and draws the shadow map. `assets` holds zeros before; finish it also after a
 * failure. With `before` (may be NULL) it takes part in what would come out the same: then only one of the two may be
 * finished, and the other be left by sf_assets_leave. */
enum sf_status sf_assets_init(struct sf_gpu *gpu, const struct sf_drawn *drawn, const struct sf_assets_before *before,
                              const struct sf_log *log, struct sf_assets *assets);
void sf_assets_bind(const struct sf_assets *assets, const struct sf_assembly *assembly, struct sf_player *player);
/* Destroys what `assets` does not have in common with `others`. */
void sf_assets_leave(struct sf_assets *assets, const struct sf_assets *others);
/* The same where all but the method's own belongs to somebody else. */
void sf_assets_leave_method(struct sf_assets *assets, const struct sf_assets *others);
void sf_assets_finish(struct sf_assets *assets);

#endif
