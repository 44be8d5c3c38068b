/* The one table: access x kind of pass -> pipeline stages, memory accesses, image layout. Nothing else in sfumato names
 * a stage.
 *
 * Shader accesses happen in the shader stages of the pass's kind; a raster pass may make them in its vertex or its
 * fragment shader. Everything else has one stage of its own, whatever the pass. */
#include "gpu/vk.h"

static const struct {
    bool by_shader;
    VkPipelineStageFlags2 stages; /* when not by a shader */
    VkAccessFlags2 reads, writes;
} accesses[SF_ACCESS_COUNT] = {
    [SF_ACCESS_NONE] = {false, VK_PIPELINE_STAGE_2_NONE, 0, 0},
    [SF_ACCESS_SAMPLED] = {true, 0, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, 0},
    [SF_ACCESS_UNIFORM] = {true, 0, VK_ACCESS_2_UNIFORM_READ_BIT, 0},
    [SF_ACCESS_STORAGE_READ] = {true, 0, VK_ACCESS_2_SHADER_STORAGE_READ_BIT, 0},
    [SF_ACCESS_STORAGE_WRITE] = {true, 0, 0, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT},
    [SF_ACCESS_STORAGE_MODIFY] = {true, 0, VK_ACCESS_2_SHADER_STORAGE_READ_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT},
    [SF_ACCESS_INDIRECT] = {false, VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT, 0},
    [SF_ACCESS_COLOR] = {false, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT,
                         VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT},
    [SF_ACCESS_DEPTH] = {false,
                         VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
                         VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT},
    [SF_ACCESS_DEPTH_READ] = {false,
                              VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT |
                                  VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
                              VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT, 0},
    [SF_ACCESS_TRANSFER_READ] = {false, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, 0},
    [SF_ACCESS_TRANSFER_WRITE] = {false, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, 0, VK_ACCESS_2_TRANSFER_WRITE_BIT},
    [SF_ACCESS_HOST_READ] = {false, VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT, 0},
    /* The presentation engine is ordered by semaphores, which wait in the stage where colours are written. */
    [SF_ACCESS_PRESENT] = {false, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, 0, 0},
};

struct sf_scope sf_scope_of(struct sf_touch touch)
{
    static const VkPipelineStageFlags2 shaders[] = {
        [SF_PASS_COMPUTE] = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
        [SF_PASS_RASTER] = VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
        [SF_PASS_TRANSFER] = VK_PIPELINE_STAGE_2_NONE, /* no shader runs in a transfer */
    };

    return (struct sf_scope){
        .stages = accesses[touch.access].by_shader ? shaders[touch.kind] : accesses[touch.access].stages,
        .reads = accesses[touch.access].reads,
        .writes = accesses[touch.access].writes,
    };
}

struct sf_scope sf_scope_union(const struct sf_touch *touches, uint32_t count)
{
    struct sf_scope all = {0};

    for (uint32_t i = 0; i < count; i++) {
        struct sf_scope one = sf_scope_of(touches[i]);

        all.stages |= one.stages;
        all.reads |= one.reads;
        all.writes |= one.writes;
    }
    return all;
}

VkImageLayout sf_vk_layout(enum sf_access access, enum sf_format format)
{
    static const VkImageLayout layouts[] = {
        [SF_LAYOUT_NONE] = VK_IMAGE_LAYOUT_UNDEFINED,
        [SF_LAYOUT_GENERAL] = VK_IMAGE_LAYOUT_GENERAL,
        [SF_LAYOUT_SAMPLED] = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
        [SF_LAYOUT_COLOR] = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
        [SF_LAYOUT_DEPTH] = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
        [SF_LAYOUT_DEPTH_READ] = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL,
        [SF_LAYOUT_TRANSFER_READ] = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
        [SF_LAYOUT_TRANSFER_WRITE] = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
        [SF_LAYOUT_PRESENT] = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
    };

    return layouts[sf_access_layout(access, format)];
}
