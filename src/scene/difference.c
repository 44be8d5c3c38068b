#include <string.h>
#include "scene/scene.h"
#include "scene/table.h"

static bool same_bytes(const void *a, const void *b, size_t bytes)
{
    return a == b || (a && b && memcmp(a, b, bytes) == 0);
}

static unsigned mesh_difference(const struct sf_mesh *before, const struct sf_mesh *after)
{
    size_t vertex_bytes = 3 * sizeof(float) * before->vertex_count;

    if (before->vertex_count != after->vertex_count || before->index_count != after->index_count)
        return SF_REBUILD_ASSETS | SF_REBUILD_GRAPH;
    if (!same_bytes(before->positions, after->positions, vertex_bytes) ||
        !same_bytes(before->normals, after->normals, vertex_bytes) ||
        !same_bytes(before->indices, after->indices, before->index_count * sizeof *before->indices))
        return SF_REBUILD_ASSETS;
    return 0;
}

/* Meshes lie one after the other, in the order in which the scene names them: where each begins, and which one an object
 * draws, stands in the graph. */
static unsigned meshes_difference(const struct sf_scene *before, const struct sf_scene *after)
{
    unsigned found = 0;

    if (before->mesh_count != after->mesh_count)
        found |= SF_REBUILD_ASSETS | SF_REBUILD_GRAPH;
    for (uint32_t i = 0; i < before->mesh_count && i < after->mesh_count; i++)
        found |= mesh_difference(&before->meshes[i], &after->meshes[i]);
    for (uint32_t i = 0; i < before->object_count && i < after->object_count; i++)
        if (before->objects[i].mesh != after->objects[i].mesh)
            found |= SF_REBUILD_GRAPH;
    for (uint32_t i = 0; i < before->emitter_count && i < after->emitter_count; i++) {
        const struct sf_emitter *a = &before->emitters[i], *b = &after->emitters[i];

        if (a->kind == SF_EMITTER_MESH && b->kind == SF_EMITTER_MESH &&
            mesh_difference(&before->meshes[a->mesh], &after->meshes[b->mesh]))
            found |= SF_REBUILD_SIM;
    }
    return found;
}

static unsigned picture_difference(const struct sf_environment *before, const struct sf_environment *after)
{
    if (before->width != after->width || before->height != after->height || !before->pixels != !after->pixels)
        return SF_REBUILD_ASSETS | SF_REBUILD_GRAPH;
    if (!same_bytes(before->pixels, after->pixels, (size_t)before->width * before->height * 3 * sizeof(float)))
        return SF_REBUILD_ASSETS;
    return 0;
}

static bool same_timing(const struct sf_timing *a, const struct sf_timing *b)
{
    return same_bytes(a, b, sizeof *a);
}

/* What effect files say, besides what the table's rows do. */
static unsigned effects_difference(const struct sf_scene *before, const struct sf_scene *after)
{
    unsigned found = 0;

    for (uint32_t i = 0; i < before->emitter_count && i < after->emitter_count; i++)
        if (!same_timing(before->emitters[i].timing, after->emitters[i].timing))
            found |= SF_REBUILD_SIM;
    for (uint32_t i = 0; i < before->light_count && i < after->light_count; i++) {
        const struct sf_light *a = &before->lights[i], *b = &after->lights[i];

        if (!same_timing(a->timing, b->timing) || a->flicker != b->flicker || a->frequency != b->frequency)
            found |= SF_REBUILD_READ;
    }
    if (!before->flash_count != !after->flash_count)
        found |= SF_REBUILD_GRAPH;
    if (before->flash_count != after->flash_count || before->shake_count != after->shake_count)
        return found | SF_REBUILD_READ;
    for (uint32_t i = 0; i < before->flash_count; i++)
        if (!same_bytes(before->flashes[i].color, after->flashes[i].color, sizeof after->flashes[i].color) ||
            before->flashes[i].strength != after->flashes[i].strength ||
            !same_timing(before->flashes[i].timing, after->flashes[i].timing))
            found |= SF_REBUILD_READ;
    for (uint32_t i = 0; i < before->shake_count; i++)
        if (before->shakes[i].amplitude != after->shakes[i].amplitude ||
            before->shakes[i].angle != after->shakes[i].angle ||
            before->shakes[i].frequency != after->shakes[i].frequency ||
            !same_timing(before->shakes[i].timing, after->shakes[i].timing))
            found |= SF_REBUILD_READ;
    return found;
}

unsigned sf_scene_difference(const struct sf_scene *before, const struct sf_scene *after)
{
    unsigned found = sf_param_difference(&sf_scene_group, before, after, 0);

    if (before->atlas.hash != after->atlas.hash)
        found |= SF_REBUILD_ASSETS;
    found |= meshes_difference(before, after) | picture_difference(&before->environment, &after->environment);
    found |= effects_difference(before, after);
    return found ? found | SF_REBUILD_READ : 0;
}
