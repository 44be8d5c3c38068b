/* Pipelines: made once for each distinct key, kept by the device while players use them and for some time after.
 *
 * Conventions of drawing: projection matrices already turn y down (Vulkan's clip space), so viewports are positive.
 * Front faces are counter-clockwise as one sees them on the screen, which is VK_FRONT_FACE_COUNTER_CLOCKWISE: the minus
 * sign in Vulkan's formula for the area allows for y pointing down. Depth is reversed: 1 near, 0 far, cleared to 0,
 * GREATER_OR_EQUAL. */
#include "gpu/vk.h"

#include <stdlib.h>
#include <string.h>
#include "base/thread.h"

enum { BUILD_THREADS_MAX = 8 };

static enum sf_status create_layouts(struct sf_pipeline *pipeline)
{
    struct sf_gpu *gpu = pipeline->gpu;
    const char *pass = pipeline->pass;
    const struct sf_pipeline_key *key = &pipeline->key;
    VkDescriptorSetLayoutBinding bindings[SF_PASS_USES_MAX] = {0};
    VkDescriptorSetLayoutCreateInfo set = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = key->binding_count,
        .pBindings = bindings,
    };
    VkPushConstantRange push = {.stageFlags = pipeline->stages, .size = key->push_bytes};
    VkPipelineLayoutCreateInfo layout = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = 1,
        .pSetLayouts = &pipeline->set_layout,
        .pushConstantRangeCount = key->push_bytes ? 1 : 0,
        .pPushConstantRanges = &push,
    };
    enum sf_status status;

    for (uint32_t i = 0; i < key->binding_count; i++) {
        bindings[i].binding = key->bindings[i].binding;
        bindings[i].descriptorType = key->bindings[i].type;
        bindings[i].descriptorCount = 1;
        bindings[i].stageFlags = pipeline->stages;
        if (key->bindings[i].type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER)
            bindings[i].pImmutableSamplers = &gpu->samplers[key->bindings[i].sampler];
    }
    status = sf_vk_check(gpu, gpu->vk.vkCreateDescriptorSetLayout(gpu->device, &set, NULL, &pipeline->set_layout),
                         "create the set layout of", pass);
    if (status)
        return status;
    sf_vk_name(gpu, VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, SF_VK_HANDLE(pipeline->set_layout), pass);
    status = sf_vk_check(gpu, gpu->vk.vkCreatePipelineLayout(gpu->device, &layout, NULL, &pipeline->layout),
                         "create the pipeline layout of", pass);
    if (!status)
        sf_vk_name(gpu, VK_OBJECT_TYPE_PIPELINE_LAYOUT, SF_VK_HANDLE(pipeline->layout), pass);
    return status;
}

static enum sf_status create_module(const struct sf_pipeline *pipeline, const char *pass,
                                    const struct sf_shader *shader, VkShaderModule *module)
{
    struct sf_gpu *gpu = pipeline->gpu;
    const struct sf_shader *now = sf_shader_now(gpu, shader);
    VkShaderModuleCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
        .codeSize = now->bytes,
        .pCode = now->words,
    };
    enum sf_status status = now == shader ? SF_OK : sf_shader_check(gpu, now, pass, &pipeline->key);

    if (!status)
        status = sf_vk_check(gpu, gpu->vk.vkCreateShaderModule(gpu->device, &info, NULL, module), "create the shader",
                             shader->name);
    if (!status)
        sf_vk_name(gpu, VK_OBJECT_TYPE_SHADER_MODULE, SF_VK_HANDLE(*module), shader->name);
    return status;
}

static VkPipelineColorBlendAttachmentState blend_state(enum sf_blend blend)
{
    static const struct {
        VkBlendFactor source, target;
        VkBlendOp color, alpha;
    } blends[] = {
        [SF_BLEND_NONE] = {VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ZERO, VK_BLEND_OP_ADD, VK_BLEND_OP_ADD},
        [SF_BLEND_MIN_ADD] = {VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE, VK_BLEND_OP_MIN, VK_BLEND_OP_ADD},
        [SF_BLEND_PREMULTIPLIED] = {VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA, VK_BLEND_OP_ADD,
                                    VK_BLEND_OP_ADD},
        [SF_BLEND_ADD] = {VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE, VK_BLEND_OP_ADD, VK_BLEND_OP_ADD},
        /* The factor is the target's colour, whose alpha is the factor of alpha. */
        [SF_BLEND_MULTIPLY] = {VK_BLEND_FACTOR_DST_COLOR, VK_BLEND_FACTOR_ZERO, VK_BLEND_OP_ADD, VK_BLEND_OP_ADD},
    };

    return (VkPipelineColorBlendAttachmentState){
        .blendEnable = blend != SF_BLEND_NONE,
        .srcColorBlendFactor = blends[blend].source,
        .dstColorBlendFactor = blends[blend].target,
        .colorBlendOp = blends[blend].color,
        .srcAlphaBlendFactor = blends[blend].source,
        .dstAlphaBlendFactor = blends[blend].target,
        .alphaBlendOp = blends[blend].alpha,
        .colorWriteMask =
            VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT,
    };
}

static VkResult create_graphics(struct sf_gpu *gpu, const VkPipelineShaderStageCreateInfo *stages, uint32_t stage_count,
                                const struct sf_pipeline *pipeline, VkPipeline *handle)
{
    static const VkDynamicState dynamics[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    static const VkCullModeFlags culls[] = {
        [SF_CULL_NONE] = VK_CULL_MODE_NONE,
        [SF_CULL_BACK] = VK_CULL_MODE_BACK_BIT,
        [SF_CULL_FRONT] = VK_CULL_MODE_FRONT_BIT,
    };
    static const VkCompareOp compares[] = {
        [SF_DEPTH_OFF] = VK_COMPARE_OP_ALWAYS,
        [SF_DEPTH_GREATER_EQUAL] = VK_COMPARE_OP_GREATER_OR_EQUAL,
        [SF_DEPTH_ALWAYS] = VK_COMPARE_OP_ALWAYS,
        [SF_DEPTH_EQUAL] = VK_COMPARE_OP_EQUAL,
    };
    const struct sf_pipeline_key *key = &pipeline->key;
    VkPipelineColorBlendAttachmentState blends[SF_PASS_COLORS_MAX];
    VkPipelineRenderingCreateInfo rendering = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
        .colorAttachmentCount = key->color_count,
        .pColorAttachmentFormats = key->colors,
        .depthAttachmentFormat = key->depth,
    };
    VkPipelineVertexInputStateCreateInfo vertices = {.sType =
                                                         VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology =
            key->raster.triangle_strip ? VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP : VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
    };
    VkPipelineViewportStateCreateInfo viewport = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .scissorCount = 1,
    };
    VkPipelineRasterizationStateCreateInfo raster = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
        .polygonMode = VK_POLYGON_MODE_FILL,
        .cullMode = culls[key->raster.cull],
        .frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE,
        .lineWidth = 1,
    };
    VkPipelineMultisampleStateCreateInfo samples = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT,
    };
    VkPipelineDepthStencilStateCreateInfo depth = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = key->raster.depth != SF_DEPTH_OFF,
        .depthWriteEnable = key->raster.depth != SF_DEPTH_OFF && key->depth_writes,
        .depthCompareOp = compares[key->raster.depth],
    };
    VkPipelineColorBlendStateCreateInfo blend = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = key->color_count,
        .pAttachments = blends,
    };
    VkPipelineDynamicStateCreateInfo dynamic = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
        .dynamicStateCount = SF_COUNT(dynamics),
        .pDynamicStates = dynamics,
    };
    VkGraphicsPipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
        .pNext = &rendering,
        .stageCount = stage_count,
        .pStages = stages,
        .pVertexInputState = &vertices,
        .pInputAssemblyState = &assembly,
        .pViewportState = &viewport,
        .pRasterizationState = &raster,
        .pMultisampleState = &samples,
        .pDepthStencilState = &depth,
        .pColorBlendState = &blend,
        .pDynamicState = &dynamic,
        .layout = pipeline->layout,
    };

    for (uint32_t i = 0; i < key->color_count; i++)
        blends[i] = blend_state(key->raster.blend[i]);
    return gpu->vk.vkCreateGraphicsPipelines(gpu->device, gpu->cache, 1, &info, NULL, handle);
}

static enum sf_status create_handle(const struct sf_pipeline *pipeline, VkPipeline *handle)
{
    struct sf_gpu *gpu = pipeline->gpu;
    const struct sf_pipeline_key *key = &pipeline->key;
    const char *pass = pipeline->pass ? pipeline->pass : key->shader->name;
    bool compute = key->bind_point == VK_PIPELINE_BIND_POINT_COMPUTE;
    VkSpecializationMapEntry entries[SF_PASS_CONSTANTS_MAX];
    VkSpecializationInfo constants = {
        .mapEntryCount = key->constant_count,
        .pMapEntries = entries,
        .dataSize = key->constant_count * sizeof key->constants[0],
        .pData = key->constants,
    };
    VkPipelineShaderStageCreateInfo stages[2] = {0};
    uint32_t stage_count = key->fragment ? 2 : 1;
    VkShaderModule modules[2] = {VK_NULL_HANDLE, VK_NULL_HANDLE};
    enum sf_status status = create_module(pipeline, pass, key->shader, &modules[0]);

    if (!status && key->fragment)
        status = create_module(pipeline, pass, key->fragment, &modules[1]);
    for (uint32_t i = 0; i < key->constant_count; i++)
        entries[i] = (VkSpecializationMapEntry){i, (uint32_t)(i * sizeof key->constants[0]), sizeof key->constants[0]};
    for (uint32_t i = 0; i < stage_count; i++) {
        stages[i].sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        stages[i].stage = compute  ? VK_SHADER_STAGE_COMPUTE_BIT
                          : i == 0 ? VK_SHADER_STAGE_VERTEX_BIT
                                   : VK_SHADER_STAGE_FRAGMENT_BIT;
        stages[i].module = modules[i];
        stages[i].pName = "main";
        stages[i].pSpecializationInfo = &constants;
    }
    if (!status && compute) {
        VkComputePipelineCreateInfo info = {
            .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
            .stage = stages[0],
            .layout = pipeline->layout,
        };

        status = sf_vk_check(gpu, gpu->vk.vkCreateComputePipelines(gpu->device, gpu->cache, 1, &info, NULL, handle),
                             "create the compute pipeline of", pass);
    } else if (!status) {
        status = sf_vk_check(gpu, create_graphics(gpu, stages, stage_count, pipeline, handle),
                             "create the graphics pipeline of", pass);
    }
    for (uint32_t i = 0; i < 2; i++)
        gpu->vk.vkDestroyShaderModule(gpu->device, modules[i], NULL);
    if (!status)
        sf_vk_name(gpu, VK_OBJECT_TYPE_PIPELINE, SF_VK_HANDLE(*handle), pass);
    return status;
}

static void pipeline_destroy(struct sf_gpu *gpu, struct sf_pipeline *pipeline)
{
    if (!gpu->stuck) {
        gpu->vk.vkDestroyPipeline(gpu->device, pipeline->handle, NULL);
        gpu->vk.vkDestroyPipelineLayout(gpu->device, pipeline->layout, NULL);
        gpu->vk.vkDestroyDescriptorSetLayout(gpu->device, pipeline->set_layout, NULL);
    }
    free(pipeline);
}

enum sf_status sf_pipeline_request(struct sf_gpu *gpu, const char *pass, const struct sf_pipeline_key *key,
                                   struct sf_pipeline **out)
{
    struct sf_pipeline *pipeline;

    for (size_t i = 0; i < gpu->pipeline_count; i++)
        if (memcmp(&gpu->pipelines[i]->key, key, sizeof *key) == 0) {
            *out = gpu->pipelines[i];
            return SF_OK;
        }
    pipeline = calloc(1, sizeof *pipeline);
    if (!pipeline ||
        !sf_array_reserve((void **)&gpu->pipelines, gpu->pipeline_count, &gpu->pipeline_capacity, 1, sizeof pipeline)) {
        free(pipeline);
        return sf_fail(gpu->log, SF_ERROR_MEMORY, "no memory for the pipeline of the pass '%s'", pass);
    }
    memcpy(&pipeline->key, key, sizeof *key);
    pipeline->gpu = gpu;
    pipeline->pass = pass;
    pipeline->stages = key->bind_point == VK_PIPELINE_BIND_POINT_COMPUTE ? VK_SHADER_STAGE_COMPUTE_BIT
                       : key->fragment ? VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT
                                       : VK_SHADER_STAGE_VERTEX_BIT;
    gpu->pipelines[gpu->pipeline_count++] = pipeline;
    *out = pipeline;
    return SF_OK;
}

/* Of those that are made. */
static void drop(struct sf_gpu *gpu, size_t at)
{
    pipeline_destroy(gpu, gpu->pipelines[at]);
    gpu->pipelines_made--;
    gpu->pipeline_count--;
    memmove(&gpu->pipelines[at], &gpu->pipelines[at + 1], (gpu->pipeline_count - at) * sizeof gpu->pipelines[0]);
}

void sf_pipeline_take(struct sf_pipeline *pipeline)
{
    if (pipeline)
        pipeline->users++;
}

void sf_pipeline_give_back(struct sf_pipeline *pipeline)
{
    if (pipeline && --pipeline->users == 0)
        pipeline->unused_since = ++pipeline->gpu->pipelines_left;
}

/* Dropping is safe because only steps of players bind pipelines, and sf_player_destroy settles before it gives its
 * steps' back: the device has done all that was submitted with an unused pipeline. What remains is a frame that is
 * open, whose commands may hold plays of a player that is gone, and a device that does not answer: then nothing is
 * dropped until another player goes. */
void sf_pipelines_trim(struct sf_gpu *gpu)
{
    size_t unused = 0;

    if (gpu->recording || gpu->stuck)
        return;
    for (size_t i = 0; i < gpu->pipelines_made; i++)
        unused += gpu->pipelines[i]->users == 0;
    for (; unused > SF_PIPELINES_UNUSED_MAX; unused--) {
        size_t oldest = SIZE_MAX;

        for (size_t i = 0; i < gpu->pipelines_made; i++)
            if (gpu->pipelines[i]->users == 0 &&
                (oldest == SIZE_MAX || gpu->pipelines[i]->unused_since < gpu->pipelines[oldest]->unused_since))
                oldest = i;
        drop(gpu, oldest);
    }
}

static enum sf_status build(void *user)
{
    struct sf_pipeline *pipeline = user;
    enum sf_status status = create_layouts(pipeline);

    return status ? status : create_handle(pipeline, &pipeline->handle);
}

void sf_pipelines_forget(struct sf_gpu *gpu)
{
    while (gpu->pipeline_count > gpu->pipelines_made)
        pipeline_destroy(gpu, gpu->pipelines[--gpu->pipeline_count]);
}

enum sf_status sf_pipelines_build(struct sf_gpu *gpu)
{
    size_t count = gpu->pipeline_count - gpu->pipelines_made;
    unsigned threads = sf_cpu_count();
    struct sf_pool *pool = NULL;
    enum sf_status status = SF_OK;

    if (threads > count)
        threads = (unsigned)count;
    if (threads > BUILD_THREADS_MAX)
        threads = BUILD_THREADS_MAX;
    if (threads > 1)
        status = sf_pool_create(threads, (unsigned)count, &pool);
    for (size_t i = gpu->pipelines_made; i < gpu->pipeline_count && !status; i++)
        status = pool ? sf_pool_push(pool, build, gpu->pipelines[i]) : build(gpu->pipelines[i]);
    if (pool) {
        enum sf_status last = sf_pool_destroy(&pool);

        status = status ? status : last;
    }
    if (status) {
        sf_pipelines_forget(gpu);
        return status;
    }
    while (gpu->pipelines_made < gpu->pipeline_count)
        gpu->pipelines[gpu->pipelines_made++]->pass = NULL;
    return SF_OK;
}

static bool runs(const struct sf_pipeline *pipeline, const struct sf_shader *shader)
{
    return pipeline->key.shader == shader || pipeline->key.fragment == shader;
}

/* An unused pipeline is not worth compiling, but a shader that does not fit its pass is refused while there is an old
 * one to stay with. */
static enum sf_status remake(const struct sf_pipeline *pipeline, const struct sf_shader *shader, VkPipeline *handle)
{
    const struct sf_shader *now = sf_shader_now(pipeline->gpu, shader);

    if (pipeline->users > 0)
        return create_handle(pipeline, handle);
    return now == shader ? SF_OK : sf_shader_check(pipeline->gpu, now, pipeline->key.shader->name, &pipeline->key);
}

enum sf_status sf_pipelines_remake(struct sf_gpu *gpu, const struct sf_shader *shader)
{
    VkPipeline *handles = calloc(gpu->pipelines_made + 1, sizeof *handles);
    enum sf_status status = SF_OK;

    if (!handles)
        return sf_fail(gpu->log, SF_ERROR_MEMORY, "no memory for the pipelines of the shader '%s'", shader->name);
    for (size_t i = 0; i < gpu->pipelines_made && !status; i++)
        if (runs(gpu->pipelines[i], shader))
            status = remake(gpu->pipelines[i], shader, &handles[i]);
    for (size_t i = gpu->pipelines_made; i-- > 0;) { /* from the back: what is dropped moves those behind it */
        struct sf_pipeline *pipeline = gpu->pipelines[i];
        VkPipeline unwanted = handles[i];

        if (unwanted && !status) {
            unwanted = pipeline->handle;
            pipeline->handle = handles[i];
        }
        gpu->vk.vkDestroyPipeline(gpu->device, unwanted, NULL);
        if (!status && pipeline->users == 0 && runs(pipeline, shader))
            drop(gpu, i);
    }
    free(handles);
    return status;
}

void sf_pipelines_finish(struct sf_gpu *gpu)
{
    for (size_t i = 0; i < gpu->pipeline_count; i++)
        pipeline_destroy(gpu, gpu->pipelines[i]);
    free(gpu->pipelines);
    gpu->pipelines = NULL;
    gpu->pipeline_count = gpu->pipeline_capacity = gpu->pipelines_made = 0;
}
