#include "methods/atlas_shape.h"
#include "methods/lit.h"
#include "methods/sprites.h"

void sf_lit_fill(const struct sf_scene *scene, struct sf_billboard_push *push)
{
    const struct sf_lit_settings *lit = &scene->lit;

    push->own[0] = scene->soft.distance;
    push->own[1] = lit->blend;
    push->own[2] = lit->wrap;
    push->own[3] = lit->translucency;
    push->more[0][0] = lit->relief;
}

void sf_lit_update(const struct sf_method_frame *frame, void *state)
{
    struct sf_billboards *billboards = state;

    sf_billboard_update(frame, billboards);
    sf_lit_fill(frame->scene, &billboards->push);
    billboards->push.more[0][1] = frame->scene->lit.halo;
}

enum sf_status sf_lit_draw(struct sf_method_frame *frame, void *state, struct sf_billboard_look look, bool counted,
                           const struct sf_log *log)
{
    const struct sf_scene *scene = frame->scene;
    struct sf_atlas_images atlas = sf_atlas_declare(frame->graph);
    struct sf_use uses[SF_ATLAS_USES + 1] = {
        [SF_ATLAS_USES] = {.resource = frame->counts, .access = SF_ACCESS_STORAGE_READ, .binding = 7}};

    sf_atlas_uses(&atlas, uses);
    look.dims_itself = true;
    look.uses = uses;
    look.use_count = SF_ATLAS_USES + counted;
    look.constants[0] = scene->light_count;
    for (uint32_t i = 0; i < scene->light_count; i++)
        look.constants[1] |= (uint32_t)scene->lights[i].kind << (2 * i);
    look.constants[2] = scene->lit.ramp == SF_LIT_RAMP_INTENSITY && scene->ramp_count > 0;
    return sf_billboard_view(frame, state, &look, log);
}

enum sf_status sf_lit_view(struct sf_method_frame *frame, void *state, const struct sf_log *log)
{
    const struct sf_billboard_look look = {.name = "lit.draw", .fragment = "lit/particle.frag", .constant_count = 3};

    return sf_lit_draw(frame, state, look, false, log);
}
