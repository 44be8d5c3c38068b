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
/* Uploads what the assembly imports, and draws the shadow map. `assets` holds zeros before; finish it also after a failure. */
enum sf_status sf_assets_init(struct sf_gpu *gpu, const struct sf_assembly *assembly, const struct sf_log *log,
                              struct sf_assets *assets);
void sf_assets_bind(struct sf_assets *assets, const struct sf_assembly *assembly, struct sf_player *player);
void sf_assets_finish(struct sf_assets *assets);

#endif
