/* The player's life, what is bound to it, and what it gives back. */
#include "gpu/player.h"

#include <stdlib.h>

/* Do the plan's passes write the copy that is not `previous`? */
static bool plan_writes(const struct sf_plan *plan, sf_resource resource)
{
    for (uint32_t i = 0; i < plan->pass_count; i++)
        for (uint32_t j = 0; j < plan->passes[i].use_count; j++) {
            const struct sf_use *use = &plan->passes[i].uses[j].use;

            if (use->resource == resource && !use->previous && sf_access_writes(use->access))
                return true;
        }
    return false;
}

static void describe_object(const struct sf_plan *plan, sf_resource number, struct sf_object *object)
{
    const struct sf_plan_resource *resource = &plan->resources[number - 1];
    const struct sf_buffer_desc *buffer = resource->image ? NULL : sf_graph_buffer_at(plan->graph, number);

    object->resource = resource;
    object->writes = plan_writes(plan, number);
    object->pair = resource->lifetime == SF_HISTORY || (resource->lifetime == SF_IMPORTED && buffer && buffer->history);
    object->flips = object->pair && (resource->lifetime == SF_HISTORY || object->writes);
}

enum sf_status sf_player_create(struct sf_gpu *gpu, const struct sf_plan *plan, struct sf_player **out)
{
    struct sf_player *player = calloc(1, sizeof *player);
    enum sf_status status = SF_OK;

    *out = NULL;
    if (!player)
        return sf_fail(gpu->log, SF_ERROR_MEMORY, "no memory for the player of '%s'", plan->name);
    player->gpu = gpu;
    player->plan = plan;
    player->depth = SF_READBACK_DEPTH;
    player->dropped = UINT32_MAX;
    player->objects = sf_arena_alloc(&player->arena, (plan->resource_count + 1) * sizeof *player->objects);
    player->slots = sf_arena_alloc(&player->arena, (plan->resource_count + 1) * 2 * sizeof *player->slots);
    if (!player->objects || !player->slots) {
        status = sf_player_no_memory(player);
    } else {
        player->object_count = plan->resource_count;
        for (uint32_t i = 0; i < plan->resource_count; i++)
            describe_object(plan, i + 1, &player->objects[i]);
    }
    if (!status)
        status = sf_player_place(player);
    if (!status)
        status = sf_player_prepare(player);
    if (status)
        sf_player_destroy(&player);
    *out = player;
    return status;
}

void sf_player_destroy(struct sf_player **pointer)
{
    struct sf_player *player = pointer ? *pointer : NULL;

    if (!player)
        return;
    sf_gpu_settle(player->gpu);
    for (uint32_t i = 0; player->timers && i < player->depth; i++)
        sf_timer_finish(player->gpu, &player->timers[i]);
    sf_player_unplace(player);
    for (uint32_t i = 0; i < player->step_count; i++)
        sf_pipeline_give_back(player->steps[i].pipeline);
    sf_pipelines_trim(player->gpu);
    sf_arena_finish(&player->arena);
    free(player);
    *pointer = NULL;
}

static struct sf_object *find_object(struct sf_player *player, sf_resource resource, enum sf_lifetime lifetime,
                                     bool image)
{
    struct sf_object *object;

    if (resource == 0 || resource > player->object_count)
        return NULL;
    object = &player->objects[resource - 1];
    return object->resource->lifetime == lifetime && object->resource->image == image ? object : NULL;
}

void sf_player_bind_buffer(struct sf_player *player, sf_resource resource, struct sf_gpu_buffer *buffer)
{
    struct sf_object *object = find_object(player, resource, SF_IMPORTED, false);

    if (object)
        object->bound_buffer = buffer;
}

void sf_player_bind_image(struct sf_player *player, sf_resource resource, struct sf_gpu_image *image)
{
    struct sf_object *object = find_object(player, resource, SF_IMPORTED, true);

    if (object)
        object->bound_image = image;
}

void *sf_player_upload(struct sf_player *player, sf_resource resource)
{
    struct sf_object *object = find_object(player, resource, SF_UPLOAD, false);
    struct sf_gpu *gpu = player->gpu;
    uint64_t serial = atomic_load(&gpu->submitted) + 1;

    if (!object || !gpu->recording)
        return NULL;
    if (object->upload_serial == serial)
        return object->upload.data;
    if (sf_upload_alloc(gpu, &sf_frame_slot_now(gpu)->uploads, object->resource->name, object->resource->bytes,
                        &object->upload) != SF_OK)
        return NULL;
    object->upload_serial = serial;
    return object->upload.data;
}

void sf_player_set_readback_depth(struct sf_player *player, uint32_t frames)
{
    if (!player->played && frames > 0)
        player->depth = frames;
}

const void *sf_player_readback(struct sf_player *player, sf_resource resource, uint64_t serial)
{
    struct sf_object *object = find_object(player, resource, SF_READBACK, false);
    uint32_t slice = 0;

    if (!object || !object->slices || serial == 0)
        return NULL;
    while (slice < player->depth && object->serials[slice] != serial)
        slice++;
    if (slice == player->depth)
        return NULL;
    if (sf_memory_invalidate(player->gpu, &object->slices[slice].place, object->resource->name) != SF_OK)
        return NULL;
    return object->slices[slice].place.mapped;
}

void sf_player_set_timing(struct sf_player *player, bool on)
{
    player->timing = on;
}

enum sf_status sf_player_times(struct sf_player *player, uint64_t serial, const struct sf_pass_time **times,
                               uint32_t *count)
{
    struct sf_timer *timer = NULL;
    const char *name = player->plan->name;
    enum sf_status status;

    *times = NULL;
    *count = 0;
    if (player->gpu->timestamp_bits == 0)
        return sf_fail(player->gpu->log, SF_ERROR_USAGE, "the device keeps no time: the passes of '%s' cannot be timed",
                       name);
    for (uint32_t i = 0; player->timers && serial && i < player->depth; i++)
        if (player->timers[i].serial == serial)
            timer = &player->timers[i];
    if (!timer)
        return sf_fail(player->gpu->log, SF_ERROR_USAGE, "'%s' was not timed in frame %llu, or that is too long ago",
                       name, (unsigned long long)serial);
    status = sf_timer_read(player->gpu, name, timer);
    if (status)
        return status;
    *times = timer->times;
    *count = timer->passes;
    return SF_OK;
}

uint64_t sf_player_record_ns(const struct sf_player *player)
{
    return player->record_ns;
}

void sf_player_drop_barrier(struct sf_player *player, uint32_t barrier)
{
    player->dropped = barrier;
}
