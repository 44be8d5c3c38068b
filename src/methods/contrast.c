#include "methods/billboard.h"
#include "methods/sprites.h"

enum sf_status sf_contrast_view(struct sf_method_frame *frame, void *state, const struct sf_log *log)
{
    static const struct sf_billboard_look look = {.name = "contrast.draw", .fragment = "contrast/particle.frag"};

    return sf_billboard_view(frame, state, &look, log);
}
