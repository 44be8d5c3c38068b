/* What the files of the public interface share. */
#ifndef SF_RENDER_INTERNAL_H
#define SF_RENDER_INTERNAL_H

#include "gpu/gpu.h"
#include "sfumato/sfumato.h"

/* The public device is the room's own behind another name. */
struct sf_device {
    struct sf_gpu *gpu;
};

#endif
