#include "methods/lit.h"
#include "methods/sprites.h"

void sf_scattering_update(const struct sf_method_frame *frame, void *state)
{
    const struct sf_scattering_settings *scattering = &frame->scene->scattering;
    struct sf_billboards *billboards = state;

    sf_billboard_update(frame, billboards);
    sf_lit_fill(frame->scene, &billboards->push);
    billboards->push.lit[0][1] = scattering->absorption;
    billboards->push.lit[0][2] = scattering->dampening;
    billboards->push.lit[1][0] =
        (float)(scattering->steps_min < scattering->steps ? scattering->steps_min : scattering->steps);
    billboards->push.lit[1][1] = (float)scattering->steps;
}

enum sf_status sf_scattering_view(struct sf_method_frame *frame, void *state, const struct sf_log *log)
{
    const struct sf_billboard_look look = {
        .name = "scattering.draw",
        .fragment = "scattering/particle.frag",
        .constants = {0, 0, 0, frame->scene->scattering.more == SF_SCATTERING_MORE_FACING},
        .constant_count = 4};

    return sf_lit_draw(frame, state, look, true, log);
}
