#include "methods/atlas_shape.h"
#include "methods/billboard.h"
#include "methods/sprites.h"

enum sf_status sf_extent_view(struct sf_method_frame *frame, void *state, const struct sf_log *log)
{
    const struct sf_extent_settings *settings = &frame->scene->extent;
    const struct sf_atlas_images images = sf_atlas_declare(frame->graph);
    struct sf_use uses[SF_ATLAS_USES];
    struct sf_billboard_look look = {.name = "extent.draw",
                                     .fragment = "extent/particle.frag",
                                     .whole = true,
                                     .uses = uses,
                                     .use_count = SF_ATLAS_USES,
                                     .constants = {settings->deviation > 0, settings->lighting > 0},
                                     .constant_count = 2};

    sf_atlas_uses(&images, uses);
    return sf_billboard_view(frame, state, &look, log);
}
