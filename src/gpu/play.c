/* Records a play. All that can fail comes first; recording itself only walks arrays, so a frame holds whole plays or
 * none. */
#include "gpu/player.h"

#include <string.h>
#include "base/thread.h"

/* ---- before recording ---- */

/* The barrier in which the play finds the resource; NULL when there is none. */
static const struct sf_plan_barrier *first_barrier(const struct sf_plan *plan, sf_resource resource)
{
    for (uint32_t i = 0; i < plan->pass_count; i++)
        for (uint32_t j = 0; j < plan->passes[i].barrier_count; j++)
            if (plan->passes[i].barriers[j].resource == resource)
                return &plan->passes[i].barriers[j];
    return NULL;
}

/* An image of the swapchain is there for one frame, and empty at first. */
static enum sf_status check_shown(const struct sf_player *player, const struct sf_object *object)
{
    const struct sf_gpu_image *image = object->bound_image;
    const struct sf_plan *plan = player->plan;
    const struct sf_plan_barrier *barrier = first_barrier(plan, (sf_resource)(object - player->objects) + 1);

    if (image->acquired != atomic_load(&player->gpu->submitted) + 1)
        return sf_fail(player->gpu->log, SF_ERROR_USAGE,
                       "'%s' is played on the image '%s', which was not acquired in this frame", plan->name,
                       image->name);
    if (!image->drawn && barrier && !barrier->discard)
        return sf_fail(player->gpu->log, SF_ERROR_USAGE,
                       "'%s' draws over '%s', which is empty when its frame begins: clear it first", plan->name,
                       object->resource->name);
    return SF_OK;
}

static enum sf_status check_bound(struct sf_player *player, const struct sf_object *object)
{
    const struct sf_plan_resource *resource = object->resource;
    const char *plan = player->plan->name;

    if (resource->image ? !object->bound_image : !object->bound_buffer)
        return sf_fail(player->gpu->log, SF_ERROR_USAGE, "'%s' is played with nothing bound to '%s'", plan,
                       resource->name);
    if (resource->image) {
        const struct sf_vk_image *image = &object->bound_image->image;
        VkImageUsageFlags lacks = sf_vk_image_usage(resource->usage) & ~image->usage;

        if (image->format != resource->format || image->width != resource->width || image->height != resource->height ||
            image->layers != resource->layers)
            return sf_fail(player->gpu->log, SF_ERROR_USAGE,
                           "'%s' wants '%s' as %s, %u x %u x %u; the image '%s' is %s, %u x %u x %u", plan,
                           resource->name, sf_format_name(resource->format), resource->width, resource->height,
                           resource->layers, object->bound_image->name, sf_format_name(image->format), image->width,
                           image->height, image->layers);
        if (lacks || object->bound_image->outside != resource->enters[0])
            return sf_fail(player->gpu->log, SF_ERROR_USAGE,
                           "the image '%s' was not made for what '%s' does with '%s': it rests as %s",
                           object->bound_image->name, plan, resource->name,
                           sf_access_name(object->bound_image->outside));
        return object->bound_image->outside == SF_ACCESS_PRESENT ? check_shown(player, object) : SF_OK;
    }
    if (object->bound_buffer->copies[0].bytes < resource->bytes)
        return sf_fail(player->gpu->log, SF_ERROR_USAGE, "'%s' wants %llu bytes of '%s'; the buffer '%s' has %llu",
                       plan, (unsigned long long)resource->bytes, resource->name, object->bound_buffer->name,
                       (unsigned long long)object->bound_buffer->copies[0].bytes);
    if (object->pair && object->bound_buffer->copy_count < 2)
        return sf_fail(player->gpu->log, SF_ERROR_USAGE, "'%s' wants '%s' as a history; the buffer '%s' has one copy",
                       plan, resource->name, object->bound_buffer->name);
    if (object->bound_buffer->outside != resource->enters[0])
        return sf_fail(player->gpu->log, SF_ERROR_USAGE, "'%s' finds '%s' as %s; the buffer '%s' rests as %s", plan,
                       resource->name, sf_access_name(resource->enters[0]), object->bound_buffer->name,
                       sf_access_name(object->bound_buffer->outside));
    return SF_OK;
}

static enum sf_status check_objects(struct sf_player *player, uint64_t serial)
{
    for (uint32_t i = 0; i < player->object_count; i++) {
        const struct sf_object *object = &player->objects[i];
        enum sf_status status = SF_OK;

        if (!object->resource->used)
            continue;
        if (object->resource->lifetime == SF_IMPORTED)
            status = check_bound(player, object);
        else if (object->resource->lifetime == SF_UPLOAD && object->upload_serial != serial)
            status = sf_fail(player->gpu->log, SF_ERROR_USAGE, "'%s' is played without an upload of '%s'",
                             player->plan->name, object->resource->name);
        if (status)
            return status;
    }
    return SF_OK;
}

static enum sf_status check_groups(struct sf_player *player)
{
    const uint32_t *most = player->gpu->limits.maxComputeWorkGroupCount;

    for (uint32_t i = 0; i < player->step_count; i++) {
        const struct sf_step *step = &player->steps[i];
        const uint32_t *groups = step->desc->groups_live;

        if (groups && (groups[0] > most[0] || groups[1] > most[1] || groups[2] > most[2]))
            return sf_fail(player->gpu->log, SF_ERROR_USAGE,
                           "the pass '%s' of '%s' has %u x %u x %u groups: this device takes at most %u x %u x %u",
                           step->plan->name, player->plan->name, groups[0], groups[1], groups[2], most[0], most[1],
                           most[2]);
    }
    return SF_OK;
}

/* What was put off until the number of readback slices was settled. */
static enum sf_status first_play(struct sf_player *player)
{
    enum sf_status status = player->played ? SF_OK : sf_player_place_readbacks(player);

    if (status)
        return status;
    player->played = true;
    if (!player->timing || player->timers || player->gpu->timestamp_bits == 0)
        return SF_OK;
    player->timers = sf_arena_alloc(&player->arena, player->depth * sizeof *player->timers);
    if (!player->timers)
        return sf_player_no_memory(player);
    for (uint32_t i = 0; i < player->depth && !status; i++)
        status = sf_timer_init(player->gpu, player->plan, &player->timers[i]);
    if (status) {
        for (uint32_t i = 0; i < player->depth; i++)
            sf_timer_finish(player->gpu, &player->timers[i]);
        player->timers = NULL;
    }
    return status;
}

/* ---- resource and copy -> object of this play ---- */

static struct sf_slot slot_of_buffer(const struct sf_vk_buffer *buffer)
{
    return (struct sf_slot){.buffer = buffer->handle, .bytes = buffer->bytes};
}

static struct sf_slot slot_of_image(const struct sf_vk_image *image)
{
    return (struct sf_slot){.image = image->handle, .view = image->view};
}

static struct sf_slot resolve(const struct sf_object *object, bool previous, uint64_t slice)
{
    const struct sf_plan_resource *resource = object->resource;
    uint32_t copy;

    switch (resource->lifetime) {
    case SF_IMPORTED:
        if (resource->image)
            return slot_of_image(&object->bound_image->image);
        /* Who writes a pair writes the older copy, and reads the newer as `previous`; who does not write reads the
         * newer. */
        copy = object->bound_buffer->latest;
        if (object->pair && (previous ? !object->flips : object->flips))
            copy = 1 - copy;
        return slot_of_buffer(&object->bound_buffer->copies[copy]);
    case SF_UPLOAD:
        return (struct sf_slot){object->upload.buffer, object->upload.offset, resource->bytes, VK_NULL_HANDLE,
                                VK_NULL_HANDLE};
    case SF_READBACK:
        return slot_of_buffer(&object->slices[slice]);
    case SF_TRANSIENT:
    case SF_PERSISTENT:
    case SF_HISTORY:
        break;
    }
    copy = resource->lifetime == SF_HISTORY ? object->current ^ previous : 0;
    return resource->image ? slot_of_image(&object->images[copy]) : slot_of_buffer(&object->buffers[copy]);
}

static void resolve_all(struct sf_player *player, uint64_t slice)
{
    for (uint32_t i = 0; i < player->object_count; i++) {
        const struct sf_object *object = &player->objects[i];

        if (!object->resource->used)
            continue;
        player->slots[2 * i] = resolve(object, false, slice);
        if (object->pair)
            player->slots[2 * i + 1] = resolve(object, true, slice);
        /* A binding sees what was declared, whatever lies behind it. */
        player->slots[2 * i].bytes = player->slots[2 * i + 1].bytes = object->resource->bytes;
    }
}

static void write_descriptors(struct sf_player *player)
{
    for (uint32_t i = 0; i < player->write_count; i++) {
        const struct sf_slot *slot = &player->slots[player->writes[i].slot];

        player->vk_writes[i].dstSet = player->sets[player->writes[i].set];
        player->image_infos[i].imageView = slot->view;
        player->buffer_infos[i] = (VkDescriptorBufferInfo){slot->buffer, slot->offset, slot->bytes};
    }
    if (player->write_count > 0)
        player->gpu->vk.vkUpdateDescriptorSets(player->gpu->device, player->write_count, player->vk_writes, 0, NULL);
}

/* ---- recording ---- */

/* A discard may hand over memory that another resource used: its writes are made available by a barrier on all memory. */
static void add_memory_barrier(VkMemoryBarrier2 *memory, const struct sf_scope *before, const struct sf_scope *after)
{
    memory->srcStageMask |= before->stages;
    memory->srcAccessMask |= before->writes;
    memory->dstStageMask |= after->stages;
    memory->dstAccessMask |= after->reads | after->writes;
}

static void record_barriers(struct sf_player *player, VkCommandBuffer commands, const struct sf_plan_barrier *barriers,
                            uint32_t count, uint32_t number)
{
    VkMemoryBarrier2 memory = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    VkDependencyInfo dependency = {
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
        .pMemoryBarriers = &memory,
        .pBufferMemoryBarriers = player->buffer_barriers,
        .pImageMemoryBarriers = player->image_barriers,
    };

    for (uint32_t i = 0; i < count; i++) {
        const struct sf_plan_barrier *barrier = &barriers[i];
        const struct sf_plan_resource *resource = &player->plan->resources[barrier->resource - 1];
        const struct sf_slot *slot = &player->slots[sf_slot_index(barrier->resource, barrier->previous)];
        struct sf_scope before = sf_scope_union(barrier->before, barrier->before_count);
        struct sf_scope after = sf_scope_union(barrier->after, barrier->after_count);

        if (number + i == player->dropped)
            continue;
        if (barrier->discard && before.writes)
            add_memory_barrier(&memory, &before, &after);
        if (resource->image) {
            VkImageLayout old = sf_vk_layout(barrier->before[0].access, resource->format);

            player->image_barriers[dependency.imageMemoryBarrierCount++] = (VkImageMemoryBarrier2){
                .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                .srcStageMask = before.stages,
                .srcAccessMask = before.writes,
                .dstStageMask = after.stages,
                .dstAccessMask = after.reads | after.writes,
                .oldLayout = barrier->discard ? VK_IMAGE_LAYOUT_UNDEFINED : old,
                .newLayout = sf_vk_layout(barrier->after[0].access, resource->format),
                .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                .image = slot->image,
                .subresourceRange = sf_vk_image_range(resource->format),
            };
        } else {
            player->buffer_barriers[dependency.bufferMemoryBarrierCount++] = (VkBufferMemoryBarrier2){
                .sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2,
                .srcStageMask = before.stages,
                .srcAccessMask = before.writes,
                .dstStageMask = after.stages,
                .dstAccessMask = after.reads | after.writes,
                .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                .buffer = slot->buffer,
                .offset = slot->offset,
                .size = slot->bytes,
            };
        }
    }
    dependency.memoryBarrierCount = memory.srcAccessMask ? 1 : 0;
    if (dependency.memoryBarrierCount + dependency.bufferMemoryBarrierCount + dependency.imageMemoryBarrierCount > 0)
        player->gpu->vk.vkCmdPipelineBarrier2(commands, &dependency);
}

static void bind_step(struct sf_player *player, VkCommandBuffer commands, const struct sf_step *step)
{
    struct sf_gpu *gpu = player->gpu;
    const struct sf_pipeline *pipeline = step->pipeline;

    gpu->vk.vkCmdBindPipeline(commands, pipeline->key.bind_point, pipeline->handle);
    if (step->set != SF_NO_SET)
        gpu->vk.vkCmdBindDescriptorSets(commands, pipeline->key.bind_point, pipeline->layout, 0, 1,
                                        &player->sets[step->set], 0, NULL);
    if (step->desc->push_bytes)
        gpu->vk.vkCmdPushConstants(commands, pipeline->layout, pipeline->stages, 0, step->desc->push_bytes,
                                   step->desc->push);
}

static void record_compute(struct sf_player *player, VkCommandBuffer commands, const struct sf_step *step)
{
    struct sf_gpu *gpu = player->gpu;
    const struct sf_pass_desc *desc = step->desc;
    const uint32_t *groups = desc->groups_live ? desc->groups_live : step->plan->groups;

    if (!desc->indirect && (groups[0] == 0 || groups[1] == 0 || groups[2] == 0))
        return;
    bind_step(player, commands, step);
    if (desc->indirect) {
        const struct sf_slot *slot = &player->slots[sf_slot_index(desc->indirect, false)];

        gpu->vk.vkCmdDispatchIndirect(commands, slot->buffer, slot->offset + desc->indirect_offset);
    } else {
        gpu->vk.vkCmdDispatch(commands, groups[0], groups[1], groups[2]);
    }
}

static VkRenderingAttachmentInfo attachment(const struct sf_player *player, const struct sf_plan_use *use)
{
    static const VkAttachmentLoadOp loads[] = {
        [SF_LOAD_KEEP] = VK_ATTACHMENT_LOAD_OP_LOAD,
        [SF_LOAD_CLEAR] = VK_ATTACHMENT_LOAD_OP_CLEAR,
        [SF_LOAD_DISCARD] = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
    };
    enum sf_format format = player->plan->resources[use->use.resource - 1].format;
    VkRenderingAttachmentInfo info = {
        .sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
        .imageView = player->slots[sf_slot_index(use->use.resource, use->use.previous)].view,
        .imageLayout = sf_vk_layout(use->use.access, format),
        .loadOp = loads[use->load],
        .storeOp = use->store == SF_STORE_KEEP ? VK_ATTACHMENT_STORE_OP_STORE : VK_ATTACHMENT_STORE_OP_DONT_CARE,
    };

    if (use->use.access == SF_ACCESS_DEPTH_READ)
        info.storeOp = VK_ATTACHMENT_STORE_OP_NONE;
    if (format == SF_FORMAT_D32F)
        info.clearValue.depthStencil.depth = use->use.clear[0];
    else if (format == SF_FORMAT_R32_UINT)
        info.clearValue.color.uint32[0] = (uint32_t)use->use.clear[0];
    else
        memcpy(info.clearValue.color.float32, use->use.clear, sizeof use->use.clear);
    return info;
}

static void record_raster(struct sf_player *player, VkCommandBuffer commands, const struct sf_step *step)
{
    struct sf_gpu *gpu = player->gpu;
    const struct sf_pass_desc *desc = step->desc;
    uint32_t width = step->plan->width, height = step->plan->height;
    uint32_t vertices = desc->draw_live ? desc->draw_live[0] : desc->vertices;
    uint32_t instances = desc->draw_live ? desc->draw_live[1] : desc->instances;
    VkRenderingAttachmentInfo colors[SF_PASS_COLORS_MAX], depth;
    VkRenderingInfo rendering = {
        .sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
        .renderArea = {.extent = {width, height}},
        .layerCount = 1,
        .colorAttachmentCount = step->color_count,
        .pColorAttachments = colors,
        .pDepthAttachment = step->depth ? &depth : NULL,
    };
    VkViewport viewport = {.width = (float)width, .height = (float)height, .maxDepth = 1};

    for (uint32_t i = 0; i < step->color_count; i++)
        colors[i] = attachment(player, step->colors[i]);
    if (step->depth)
        depth = attachment(player, step->depth);
    gpu->vk.vkCmdBeginRendering(commands, &rendering);
    if (desc->indirect || (vertices > 0 && instances > 0)) {
        bind_step(player, commands, step);
        gpu->vk.vkCmdSetViewport(commands, 0, 1, &viewport);
        gpu->vk.vkCmdSetScissor(commands, 0, 1, &rendering.renderArea);
    }
    if (desc->indirect) {
        const struct sf_slot *slot = &player->slots[sf_slot_index(desc->indirect, false)];

        gpu->vk.vkCmdDrawIndirect(commands, slot->buffer, slot->offset + desc->indirect_offset, 1, 0);
    } else if (vertices > 0 && instances > 0) {
        gpu->vk.vkCmdDraw(commands, vertices, instances, 0, 0);
    }
    gpu->vk.vkCmdEndRendering(commands);
}

static void record_transfer(struct sf_player *player, VkCommandBuffer commands, const struct sf_step *step)
{
    const VkImageLayout source_layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                        target_layout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    struct sf_gpu *gpu = player->gpu;
    const struct sf_use *from = &step->plan->uses[0].use, *to = &step->plan->uses[1].use;
    const struct sf_slot *source = &player->slots[sf_slot_index(from->resource, from->previous)], *target;
    const struct sf_plan_resource *a = &player->plan->resources[from->resource - 1], *b, *image;
    VkBufferImageCopy buffer_image;

    if (step->desc->transfer == SF_TRANSFER_FILL) {
        gpu->vk.vkCmdFillBuffer(commands, source->buffer, source->offset, source->bytes / 4 * 4, step->desc->fill);
        return;
    }
    target = &player->slots[sf_slot_index(to->resource, to->previous)];
    b = &player->plan->resources[to->resource - 1];
    if (!a->image && !b->image) {
        VkBufferCopy region = {source->offset, target->offset, a->bytes < b->bytes ? a->bytes : b->bytes};

        gpu->vk.vkCmdCopyBuffer(commands, source->buffer, target->buffer, 1, &region);
        return;
    }
    image = a->image ? a : b;
    if (a->image && b->image) {
        VkImageCopy region = {
            .srcSubresource = sf_vk_image_layers(a->format, a->layers),
            .dstSubresource = sf_vk_image_layers(b->format, b->layers),
            .extent = {a->width, a->height, 1},
        };

        gpu->vk.vkCmdCopyImage(commands, source->image, source_layout, target->image, target_layout, 1, &region);
        return;
    }
    buffer_image = (VkBufferImageCopy){
        .bufferOffset = a->image ? target->offset : source->offset,
        .imageSubresource = sf_vk_image_layers(image->format, image->layers),
        .imageExtent = {image->width, image->height, 1},
    };
    if (a->image)
        gpu->vk.vkCmdCopyImageToBuffer(commands, source->image, source_layout, target->buffer, 1, &buffer_image);
    else
        gpu->vk.vkCmdCopyBufferToImage(commands, source->buffer, target->image, target_layout, 1, &buffer_image);
}

static void record(struct sf_player *player, VkCommandBuffer commands, struct sf_timer *timer, uint64_t serial,
                   bool continued)
{
    struct sf_gpu *gpu = player->gpu;
    uint32_t barriers = 0;

    if (timer)
        sf_timer_start(gpu, commands, timer, serial, continued);
    for (uint32_t i = 0; i < player->step_count; i++) {
        const struct sf_step *step = &player->steps[i];
        VkDebugUtilsLabelEXT label = {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, .pLabelName = step->plan->name};

        if (gpu->debug_utils)
            vkCmdBeginDebugUtilsLabelEXT(commands, &label);
        record_barriers(player, commands, step->plan->barriers, step->plan->barrier_count, step->first_barrier);
        barriers = step->first_barrier + step->plan->barrier_count;
        if (step->desc->kind == SF_PASS_COMPUTE)
            record_compute(player, commands, step);
        else if (step->desc->kind == SF_PASS_RASTER)
            record_raster(player, commands, step);
        else
            record_transfer(player, commands, step);
        if (gpu->debug_utils)
            vkCmdEndDebugUtilsLabelEXT(commands);
        if (timer)
            sf_timer_mark(gpu, commands, timer, i);
    }
    record_barriers(player, commands, player->plan->final_barriers, player->plan->final_count, barriers);
}

/* ---- after recording ---- */

static void finish_play(struct sf_player *player, uint64_t serial)
{
    for (uint32_t i = 0; i < player->object_count; i++) {
        struct sf_object *object = &player->objects[i];

        object->upload_serial = 0; /* the next play wants its own */
        if (!object->resource->used)
            continue;
        if (object->flips && object->bound_buffer)
            object->bound_buffer->latest = 1 - object->bound_buffer->latest;
        else if (object->flips)
            object->current = 1 - object->current;
        if (object->serials)
            object->serials[player->slice] = serial;
        if (object->bound_image)
            object->bound_image->drawn = true;
    }
}

void sf_player_continue(struct sf_player *player)
{
    player->continues = true;
}

enum sf_status sf_player_play(struct sf_player *player)
{
    struct sf_gpu *gpu = player->gpu;
    struct sf_frame_slot *frame = sf_frame_slot_now(gpu);
    uint64_t start = sf_clock_ns(), serial = atomic_load(&gpu->submitted) + 1;
    struct sf_timer *timer = NULL;
    enum sf_status status;
    bool continued = player->continues && player->slice_serial > 0;

    player->continues = false;
    if (!gpu->recording)
        return sf_fail(gpu->log, SF_ERROR_USAGE, "'%s' is played outside of a frame", player->plan->name);
    status = check_objects(player, serial);
    if (!status)
        status = check_groups(player);
    if (!status)
        status = first_play(player);
    if (!status)
        status = sf_descriptor_alloc(gpu, &frame->descriptors, player->plan->name, &player->need, player->set_layouts,
                                     player->sets);
    if (status)
        return status;
    if (serial != player->slice_serial && !continued)
        player->slice = (player->slice + 1) % player->depth;
    player->slice_serial = serial;
    if (player->timing && player->timers)
        timer = &player->timers[player->slice];
    resolve_all(player, player->slice);
    write_descriptors(player);
    record(player, frame->commands, timer, serial, continued);
    finish_play(player, serial);
    player->record_ns = sf_clock_ns() - start;
    return SF_OK;
}
