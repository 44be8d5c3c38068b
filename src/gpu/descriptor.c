/* Descriptor pools of a frame in flight: each play takes all its sets in one call; the frame's next beginning takes
 * everything back. */
#include "gpu/vk.h"

#include <stdlib.h>

static const VkDescriptorType TYPES[SF_DESCRIPTOR_TYPES] = {
    VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
    VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
    VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
    VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
};
enum { POOL_SETS = 256, POOL_TYPES = 1024 };

struct sf_descriptor_pool {
    VkDescriptorPool handle;
    struct sf_descriptor_need size, left;
};

void sf_descriptor_count(struct sf_descriptor_need *need, VkDescriptorType type)
{
    for (int i = 0; i < SF_DESCRIPTOR_TYPES; i++)
        need->types[i] += TYPES[i] == type;
}

/* Takes `need` out of `left` when there is enough. */
static bool take(struct sf_descriptor_need *left, const struct sf_descriptor_need *need)
{
    bool fits = need->sets <= left->sets;

    for (int i = 0; i < SF_DESCRIPTOR_TYPES; i++)
        fits = fits && need->types[i] <= left->types[i];
    if (!fits)
        return false;
    left->sets -= need->sets;
    for (int i = 0; i < SF_DESCRIPTOR_TYPES; i++)
        left->types[i] -= need->types[i];
    return true;
}

static enum sf_status add_pool(struct sf_gpu *gpu, struct sf_descriptor_pools *pools, const char *name,
                               const struct sf_descriptor_need *need)
{
    struct sf_descriptor_pool pool = {.size = {.sets = need->sets > POOL_SETS ? need->sets : POOL_SETS}};
    VkDescriptorPoolSize sizes[SF_DESCRIPTOR_TYPES];
    VkDescriptorPoolCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
        .maxSets = pool.size.sets,
        .poolSizeCount = SF_DESCRIPTOR_TYPES,
        .pPoolSizes = sizes,
    };
    enum sf_status status;

    if (!sf_array_reserve((void **)&pools->pools, pools->count, &pools->capacity, 1, sizeof pool))
        return sf_fail(gpu->log, SF_ERROR_MEMORY, "no memory for the descriptors of '%s'", name);
    for (int i = 0; i < SF_DESCRIPTOR_TYPES; i++) {
        pool.size.types[i] = need->types[i] > POOL_TYPES ? need->types[i] : POOL_TYPES;
        sizes[i] = (VkDescriptorPoolSize){TYPES[i], pool.size.types[i]};
    }
    status = sf_vk_check(gpu, gpu->vk.vkCreateDescriptorPool(gpu->device, &info, NULL, &pool.handle),
                         "create descriptors for", name);
    if (status)
        return status;
    sf_vk_name(gpu, VK_OBJECT_TYPE_DESCRIPTOR_POOL, SF_VK_HANDLE(pool.handle), "frame");
    pool.left = pool.size;
    pools->pools[pools->count++] = pool;
    return SF_OK;
}

enum sf_status sf_descriptor_alloc(struct sf_gpu *gpu, struct sf_descriptor_pools *pools, const char *name,
                                   const struct sf_descriptor_need *need, const VkDescriptorSetLayout *layouts,
                                   VkDescriptorSet *sets)
{
    VkDescriptorSetAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
        .descriptorSetCount = need->sets,
        .pSetLayouts = layouts,
    };
    size_t i = 0;

    if (need->sets == 0)
        return SF_OK;
    while (i < pools->count && !take(&pools->pools[i].left, need))
        i++;
    if (i == pools->count) {
        enum sf_status status = add_pool(gpu, pools, name, need);

        if (status)
            return status;
        take(&pools->pools[i].left, need);
    }
    info.descriptorPool = pools->pools[i].handle;
    return sf_vk_check(gpu, gpu->vk.vkAllocateDescriptorSets(gpu->device, &info, sets), "allocate descriptors for",
                       name);
}

enum sf_status sf_descriptor_reset(struct sf_gpu *gpu, struct sf_descriptor_pools *pools)
{
    enum sf_status status = SF_OK;

    for (size_t i = 0; i < pools->count && !status; i++) {
        pools->pools[i].left = pools->pools[i].size;
        status = sf_vk_check(gpu, gpu->vk.vkResetDescriptorPool(gpu->device, pools->pools[i].handle, 0), "reset",
                             "descriptor pool");
    }
    return status;
}

void sf_descriptor_finish(struct sf_gpu *gpu, struct sf_descriptor_pools *pools)
{
    for (size_t i = 0; i < pools->count && !gpu->stuck; i++)
        gpu->vk.vkDestroyDescriptorPool(gpu->device, pools->pools[i].handle, NULL);
    free(pools->pools);
    *pools = (struct sf_descriptor_pools){0};
}
