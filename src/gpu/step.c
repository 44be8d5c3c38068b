/* Prepares a plan's passes: pipelines, and all descriptor writes and barriers as arrays that a play only has to fill
 * in. */
#include "gpu/player.h"

#include <string.h>

enum sf_status sf_player_no_memory(const struct sf_player *player)
{
    return sf_fail(player->gpu->log, SF_ERROR_MEMORY, "no memory for the player of '%s'", player->plan->name);
}

static bool bound(enum sf_access access)
{
    return access == SF_ACCESS_SAMPLED || access == SF_ACCESS_UNIFORM || access == SF_ACCESS_STORAGE_READ ||
           access == SF_ACCESS_STORAGE_WRITE || access == SF_ACCESS_STORAGE_MODIFY;
}

static VkDescriptorType descriptor_type(enum sf_access access, bool image)
{
    if (access == SF_ACCESS_SAMPLED)
        return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    if (access == SF_ACCESS_UNIFORM)
        return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    return image ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

static enum sf_status find_shader(const struct sf_player *player, const char *pass, const char *name,
                                  const struct sf_shader **shader)
{
    *shader = sf_shader_find(name);
    if (*shader)
        return SF_OK;
    return sf_fail(player->gpu->log, SF_ERROR_INTERNAL,
                   "the pass '%s' of '%s' wants the shader '%s', which is not in the library (is it listed in "
                   "spirv/meson.build?)",
                   pass, player->plan->name, name);
}

/* What the pass asks of the device's limits and optional features. */
static enum sf_status check_pass(const struct sf_player *player, const struct sf_plan_pass *pass,
                                 const struct sf_pass_desc *desc)
{
    const struct sf_gpu *gpu = player->gpu;
    const uint32_t *most = gpu->limits.maxComputeWorkGroupCount;
    bool differ = false, writes = false;

    if (desc->kind == SF_PASS_COMPUTE &&
        (pass->groups[0] > most[0] || pass->groups[1] > most[1] || pass->groups[2] > most[2]))
        return sf_fail(gpu->log, SF_ERROR_USAGE,
                       "the pass '%s' of '%s' would have %u x %u x %u groups: this device takes at most %u x %u x %u",
                       pass->name, player->plan->name, pass->groups[0], pass->groups[1], pass->groups[2], most[0],
                       most[1], most[2]);
    if (desc->kind != SF_PASS_RASTER)
        return SF_OK;
    for (uint32_t i = 0; i < pass->use_count; i++) {
        const struct sf_use *use = &pass->uses[i].use;

        writes = writes || (bound(use->access) && sf_access_writes(use->access));
        if (use->access == SF_ACCESS_COLOR)
            differ = differ || desc->raster.blend[use->binding] != desc->raster.blend[0];
    }
    if (pass->width > gpu->limits.maxFramebufferWidth || pass->height > gpu->limits.maxFramebufferHeight)
        return sf_fail(gpu->log, SF_ERROR_USAGE,
                       "the pass '%s' of '%s' draws %u x %u pixels: this device takes at most %u x %u", pass->name,
                       player->plan->name, pass->width, pass->height, gpu->limits.maxFramebufferWidth,
                       gpu->limits.maxFramebufferHeight);
    if (differ && !gpu->features.independentBlend)
        return sf_fail(gpu->log, SF_ERROR_DEVICE,
                       "the pass '%s' of '%s' blends its attachments in different ways, which this device cannot do",
                       pass->name, player->plan->name);
    if (writes && (!gpu->features.fragmentStoresAndAtomics || !gpu->features.vertexPipelineStoresAndAtomics))
        return sf_fail(gpu->log, SF_ERROR_DEVICE,
                       "the pass '%s' of '%s' stores while it draws, which this device cannot do", pass->name,
                       player->plan->name);
    return SF_OK;
}

/* Attachments of the pass into the step and the pipeline's key. */
static void collect_attachments(const struct sf_player *player, struct sf_step *step, struct sf_pipeline_key *key)
{
    key->raster = step->desc->raster;
    for (uint32_t i = 0; i < step->plan->use_count; i++) {
        const struct sf_plan_use *use = &step->plan->uses[i];
        VkFormat format = use->use.resource ? sf_vk_format(player->plan->resources[use->use.resource - 1].format)
                                            : VK_FORMAT_UNDEFINED;

        if (use->use.access == SF_ACCESS_COLOR) {
            step->colors[use->use.binding] = use;
            key->colors[use->use.binding] = format;
            step->color_count++;
        } else if (use->use.access == SF_ACCESS_DEPTH || use->use.access == SF_ACCESS_DEPTH_READ) {
            step->depth = use;
            key->depth = format;
            key->depth_writes = use->use.access == SF_ACCESS_DEPTH;
        }
    }
    key->color_count = step->color_count;
    for (uint32_t i = step->color_count; i < SF_PASS_COLORS_MAX; i++)
        key->raster.blend[i] = SF_BLEND_NONE; /* so that equal pipelines have equal keys */
}

/* Some devices do not filter 32-bit floats: what is asked to be smooth there is looked up nearest. */
static enum sf_sampler sampler_of(const struct sf_player *player, const struct sf_use *use)
{
    VkFormatFeatureFlags has = player->gpu->formats[player->plan->resources[use->resource - 1].format];
    bool filters = has & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;

    return use->sampler == SF_SAMPLER_LINEAR && !filters ? SF_SAMPLER_NEAREST : use->sampler;
}

/* Bindings in ascending order, so that equal pipelines have equal keys. */
static void collect_bindings(const struct sf_player *player, const struct sf_plan_pass *pass,
                             struct sf_pipeline_key *key)
{
    for (uint32_t i = 0; i < pass->use_count; i++) {
        const struct sf_use *use = &pass->uses[i].use;
        uint32_t at = key->binding_count;

        if (!bound(use->access))
            continue;
        for (; at > 0 && key->bindings[at - 1].binding > use->binding; at--)
            key->bindings[at] = key->bindings[at - 1];
        key->bindings[at].binding = use->binding;
        key->bindings[at].type = descriptor_type(use->access, player->plan->resources[use->resource - 1].image);
        key->bindings[at].sampler = use->access == SF_ACCESS_SAMPLED ? sampler_of(player, use) : SF_SAMPLER_NEAREST;
        key->binding_count++;
    }
}

static enum sf_status prepare_pipeline(struct sf_player *player, struct sf_step *step)
{
    const struct sf_pass_desc *desc = step->desc;
    struct sf_pipeline_key key;
    enum sf_status status;

    memset(&key, 0, sizeof key); /* padding, too */
    status = find_shader(player, step->plan->name, desc->shader, &key.shader);
    if (!status && desc->kind == SF_PASS_RASTER && desc->fragment)
        status = find_shader(player, step->plan->name, desc->fragment, &key.fragment);
    if (status)
        return status;
    key.bind_point = desc->kind == SF_PASS_COMPUTE ? VK_PIPELINE_BIND_POINT_COMPUTE : VK_PIPELINE_BIND_POINT_GRAPHICS;
    memcpy(key.constants, desc->constants, desc->constant_count * sizeof desc->constants[0]);
    key.constant_count = desc->constant_count;
    key.push_bytes = desc->push_bytes;
    collect_bindings(player, step->plan, &key);
    if (desc->kind == SF_PASS_RASTER)
        collect_attachments(player, step, &key);
    return sf_pipeline_request(player->gpu, step->plan->name, &key, &step->pipeline);
}

static void prepare_writes(struct sf_player *player, const struct sf_step *step)
{
    for (uint32_t i = 0; i < step->plan->use_count; i++) {
        const struct sf_use *use = &step->plan->uses[i].use;
        uint32_t w = player->write_count;
        const struct sf_plan_resource *resource;

        if (!bound(use->access))
            continue;
        resource = &player->plan->resources[use->resource - 1];
        player->writes[w] = (struct sf_write){step->set, sf_slot_index(use->resource, use->previous)};
        player->vk_writes[w] = (VkWriteDescriptorSet){
            .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
            .dstBinding = use->binding,
            .descriptorCount = 1,
            .descriptorType = descriptor_type(use->access, resource->image),
            .pImageInfo = &player->image_infos[w],
            .pBufferInfo = &player->buffer_infos[w],
        };
        if (resource->image)
            player->image_infos[w].imageLayout = sf_vk_layout(use->access, resource->format);
        sf_descriptor_count(&player->need, player->vk_writes[w].descriptorType);
        player->write_count++;
    }
}

static enum sf_status allocate_arrays(struct sf_player *player)
{
    const struct sf_plan *plan = player->plan;
    uint32_t uses = 0, longest = plan->final_count;

    for (uint32_t i = 0; i < plan->pass_count; i++) {
        uses += plan->passes[i].use_count;
        if (plan->passes[i].barrier_count > longest)
            longest = plan->passes[i].barrier_count;
    }
#define ARRAY(field, count)                                                                                            \
    ((player->field = sf_arena_alloc(&player->arena, (count + 1) * sizeof *player->field)) != NULL)
    if (!ARRAY(steps, plan->pass_count) || !ARRAY(set_layouts, plan->pass_count) || !ARRAY(sets, plan->pass_count) ||
        !ARRAY(writes, uses) || !ARRAY(vk_writes, uses) || !ARRAY(image_infos, uses) || !ARRAY(buffer_infos, uses) ||
        !ARRAY(image_barriers, longest) || !ARRAY(buffer_barriers, longest))
        return sf_player_no_memory(player);
#undef ARRAY
    return SF_OK;
}

enum sf_status sf_player_prepare(struct sf_player *player)
{
    const struct sf_plan *plan = player->plan;
    uint32_t barriers = 0;
    enum sf_status status = allocate_arrays(player);

    for (uint32_t i = 0; i < plan->pass_count && !status; i++) {
        struct sf_step *step = &player->steps[i];

        step->plan = &plan->passes[i];
        step->desc = sf_graph_pass_at(plan->graph, plan->passes[i].index);
        step->set = SF_NO_SET;
        step->first_barrier = barriers;
        barriers += step->plan->barrier_count;
        player->step_count++;
        if (step->desc->kind == SF_PASS_TRANSFER)
            continue;
        status = check_pass(player, step->plan, step->desc);
        if (!status)
            status = prepare_pipeline(player, step);
        if (!status && step->pipeline->key.binding_count > 0) {
            step->set = player->need.sets++;
            prepare_writes(player, step);
        }
    }
    if (status)
        sf_pipelines_forget(player->gpu);
    else
        status = sf_pipelines_build(player->gpu);
    for (uint32_t i = 0; i < player->step_count; i++) {
        struct sf_step *step = &player->steps[i];

        if (status) {
            step->pipeline = NULL; /* not taken, and a new one is gone */
            continue;
        }
        sf_pipeline_take(step->pipeline);
        if (step->set != SF_NO_SET)
            player->set_layouts[step->set] = step->pipeline->set_layout;
    }
    return status;
}
