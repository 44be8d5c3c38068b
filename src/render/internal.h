/* What the files of the public interface share. */
#ifndef SF_RENDER_INTERNAL_H
#define SF_RENDER_INTERNAL_H

#include "gpu/gpu.h"
#include "sfumato/sfumato.h"

/* The public device is the room's own behind another name. */
struct sf_device {
    struct sf_gpu *gpu;
    uint64_t shaders_set; /* how often sf_device_set_shader was asked for another */
};

/* The picture that stays on the device (sf_renderer_options.shown), RGBA32F when *float_color, else RGBA16F, of
 * *width x *height px: rests in SF_ACCESS_SAMPLED, the renderer's. NULL before the first picture. */
struct sf_gpu_image *sf_renderer_shown(const struct sf_renderer *renderer, uint32_t *width, uint32_t *height,
                                       bool *float_color);
/* The second method's, of the same size and format. NULL: there is none, or no picture of it yet. */
struct sf_gpu_image *sf_renderer_shown_beside(const struct sf_renderer *renderer);

#endif
