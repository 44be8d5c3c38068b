#include "methods/billboard.h"
#include "methods/sprites.h"

enum sf_status sf_average_view(struct sf_method_frame *frame, void *state, const struct sf_log *log)
{
    static const struct sf_billboard_look look = {
        .name = "average.draw", .fragment = "average/particle.frag", .whole = true};

    return sf_billboard_view(frame, state, &look, log);
}
