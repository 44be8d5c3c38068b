#include "render/drawn.h"

#include <string.h>

bool sf_scene_shows_picture(const struct sf_scene *scene)
{
    return scene->environment.visible && scene->environment.pixels;
}

/* Where each mesh will stand in the buffers that all of them share. */
static void place_meshes(const struct sf_scene *scene, struct sf_mesh_buffers *buffers)
{
    uint32_t vertices = 0, indices = 0;

    for (uint32_t i = 0; i < scene->mesh_count; i++) {
        buffers->first_vertex[i] = vertices;
        buffers->first_index[i] = indices;
        vertices += scene->meshes[i].vertex_count;
        indices += scene->meshes[i].index_count;
    }
    buffers->vertex_bytes = (uint64_t)vertices * 6 * sizeof(float);
    buffers->index_bytes = (uint64_t)indices * sizeof(uint32_t);
}

static void find_constants(struct sf_drawn *drawn)
{
    const struct sf_scene *scene = drawn->scene;
    const struct sf_environment *environment = &scene->environment;
    uint32_t kinds = 0, casts = 0, checkered = 0;

    for (uint32_t i = 0; i < scene->light_count && i < SF_LIGHTS_MAX; i++) {
        kinds |= (uint32_t)scene->lights[i].kind << 2 * i;
        casts |= (uint32_t)scene->lights[i].shadows << i;
    }
    for (uint32_t i = 0; i < scene->object_count; i++)
        checkered |= scene->objects[i].kind == SF_OBJECT_PLANE && scene->objects[i].checker > 0;
    uint32_t shown = !environment->visible                     ? 3
                     : sf_scene_shows_picture(scene)           ? 2
                     : environment->kind == SF_ENVIRONMENT_SKY ? 0
                                                               : 1;
    uint32_t level = !environment->pixels; /* sky and colour are the same all around */
    const uint32_t constants[SF_SHADE_CONSTANTS] = {
        drawn->list.planes, scene->light_count, kinds, sf_shadow_mask(&drawn->shadow), casts, checkered, shown, level};
    memcpy(drawn->constants, constants, sizeof constants);
}

void sf_drawn_fill(const struct sf_scene *scene, struct sf_drawn *drawn)
{
    memset(drawn, 0, sizeof *drawn);
    drawn->scene = scene;
    sf_object_list_fill(scene, &drawn->list);
    for (uint32_t i = 0; i < scene->object_count; i++)
        sf_object_fill(&scene->objects[drawn->list.from[i]], &drawn->objects[i]);
    sf_shadow_fit(scene, &drawn->shadow);
    place_meshes(scene, &drawn->meshes);
    find_constants(drawn);
}

bool sf_drawn_alike(const struct sf_drawn *a, const struct sf_drawn *b)
{
    const struct sf_environment *x = &a->scene->environment, *y = &b->scene->environment;
    const struct sf_shadow_scene meshes[] = {sf_drawn_shadow(a), sf_drawn_shadow(b)};
    uint32_t first = a->list.planes + a->list.solids;

    if (a->scene->method != b->scene->method || a->scene->sim.capacity != b->scene->sim.capacity ||
        a->list.planes != b->list.planes || a->list.solids != b->list.solids || a->list.meshes != b->list.meshes ||
        a->shadow.count != b->shadow.count || (a->shadow.count > 0 && a->shadow.size != b->shadow.size) ||
        memcmp(a->constants, b->constants, sizeof a->constants) != 0)
        return false;
    if (sf_scene_shows_picture(a->scene) && (x->width != y->width || x->height != y->height))
        return false;
    if (a->list.meshes > 0 &&
        (a->meshes.vertex_bytes != b->meshes.vertex_bytes || a->meshes.index_bytes != b->meshes.index_bytes))
        return false;
    for (uint32_t i = 0; i < a->list.meshes; i++)
        if (!sf_shadow_mesh_same(&meshes[0], &meshes[1], first + i))
            return false;
    return true;
}

struct sf_shadow_scene sf_drawn_shadow(const struct sf_drawn *drawn)
{
    return (struct sf_shadow_scene){.scene = drawn->scene,
                                    .cells = &drawn->shadow,
                                    .objects = drawn->objects,
                                    .from = drawn->list.from,
                                    .planes = drawn->list.planes,
                                    .solids = drawn->list.solids,
                                    .meshes = drawn->list.meshes,
                                    .buffers = &drawn->meshes};
}
