/* Device memory: blocks from the driver, cut into places.
 *
 * A block is one vkAllocateMemory of one memory type, mapped for good when the CPU can see it. Its free spans are kept
 * sorted by offset and merged; a place is taken from the smallest span that holds it. Buffers and images share blocks:
 * alignments and sizes are rounded up to bufferImageGranularity, so neighbours never disturb each other. Blocks that
 * become empty go back to the driver. The budget counts blocks, since these are what the device gives. */
#include "gpu/vk.h"

#include <stdlib.h>
#include <string.h>

enum { BLOCK_BYTES = 64 << 20 };

struct span {
    uint64_t offset, size;
};
struct sf_block {
    VkDeviceMemory memory;
    uint32_t type;
    uint64_t size;
    char *mapped;
    bool coherent;
    struct span *spans; /* free ones; room for one more than there are places, so that freeing never needs memory */
    size_t span_count, span_capacity, places;
};

static uint64_t align_up(uint64_t value, uint64_t alignment)
{
    return (value + alignment - 1) / alignment * alignment;
}

/* Memory types from best to worst for a kind: every flag of `musts`, then as many of `wishes` as can be had. */
static uint32_t find_type(const struct sf_gpu *gpu, uint32_t type_bits, enum sf_memory_kind kind)
{
    static const struct {
        VkMemoryPropertyFlags musts, wishes;
    } kinds[] = {
        [SF_MEMORY_DEVICE] = {0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT},
        [SF_MEMORY_UPLOAD] = {VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
                              VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT},
        [SF_MEMORY_READBACK] = {VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT, VK_MEMORY_PROPERTY_HOST_CACHED_BIT},
    };
    uint32_t best = UINT32_MAX;

    for (uint32_t i = 0; i < gpu->memory_types.memoryTypeCount; i++) {
        VkMemoryPropertyFlags flags = gpu->memory_types.memoryTypes[i].propertyFlags;

        if (!(type_bits & 1u << i) || (flags & kinds[kind].musts) != kinds[kind].musts ||
            flags & VK_MEMORY_PROPERTY_PROTECTED_BIT)
            continue;
        if ((flags & kinds[kind].wishes) == kinds[kind].wishes)
            return i;
        if (best == UINT32_MAX)
            best = i;
    }
    return best;
}

static void block_destroy(struct sf_gpu *gpu, struct sf_block *block)
{
    if (!block)
        return;
    if (block->memory && !gpu->stuck) {
        gpu->vk.vkFreeMemory(gpu->device, block->memory, NULL); /* unmaps, too */
        gpu->memory.used -= block->size;
    }
    free(block->spans);
    free(block);
}

static VkResult block_allocate(struct sf_gpu *gpu, struct sf_block *block, uint64_t size)
{
    VkMemoryAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
        .allocationSize = size,
        .memoryTypeIndex = block->type,
    };

    block->size = size;
    return gpu->vk.vkAllocateMemory(gpu->device, &info, NULL, &block->memory);
}

/* A new block with room for `least` bytes: BLOCK_BYTES where the budget and the device grant it, else just what is
 * needed. */
static enum sf_status block_create(struct sf_gpu *gpu, const char *name, uint32_t type, uint64_t least,
                                   struct sf_block **out)
{
    struct sf_memory *memory = &gpu->memory;
    uint64_t left = memory->budget > memory->used ? memory->budget - memory->used : 0;
    uint64_t heap = gpu->memory_types.memoryHeaps[gpu->memory_types.memoryTypes[type].heapIndex].size;
    uint64_t size = BLOCK_BYTES;
    VkMemoryPropertyFlags flags = gpu->memory_types.memoryTypes[type].propertyFlags;
    struct sf_block *block;
    enum sf_status status = SF_OK;
    VkResult result;

    if (least > gpu->max_allocation)
        return sf_fail(gpu->log, SF_ERROR_MEMORY,
                       "'%s' needs %.1f MiB of device memory in one piece; this device gives at most %.1f MiB", name,
                       (double)least / 1048576, (double)gpu->max_allocation / 1048576);
    if (least > left)
        return sf_fail(gpu->log, SF_ERROR_MEMORY,
                       "'%s' needs %.1f MiB of device memory more, but %.1f MiB of the budget of %.1f MiB are taken",
                       name, (double)least / 1048576, (double)memory->used / 1048576, (double)memory->budget / 1048576);
    if (size > heap / 16)
        size = heap / 16;
    if (size > memory->budget / 8)
        size = memory->budget / 8;
    if (size > gpu->max_allocation)
        size = gpu->max_allocation;
    if (size > left)
        size = left;
    if (size < least)
        size = least;
    block = calloc(1, sizeof *block);
    if (!block || !sf_array_reserve((void **)&memory->blocks, memory->count, &memory->capacity, 1, sizeof block)) {
        free(block);
        return sf_fail(gpu->log, SF_ERROR_MEMORY, "no memory to note the device memory of '%s'", name);
    }
    block->type = type;
    block->coherent = flags & VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    result = block_allocate(gpu, block, size);
    if (result != VK_SUCCESS && size > least)
        result = block_allocate(gpu, block, least);
    if (result == VK_SUCCESS) {
        memory->used += block->size;
        sf_vk_name(gpu, VK_OBJECT_TYPE_DEVICE_MEMORY, SF_VK_HANDLE(block->memory), name);
    }
    status = sf_vk_check(gpu, result, "allocate device memory for", name);
    if (!status && flags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT)
        status = sf_vk_check(
            gpu, gpu->vk.vkMapMemory(gpu->device, block->memory, 0, VK_WHOLE_SIZE, 0, (void **)&block->mapped),
            "map device memory for", name);
    if (!status && !sf_array_reserve((void **)&block->spans, 0, &block->span_capacity, 2, sizeof *block->spans))
        status = sf_fail(gpu->log, SF_ERROR_MEMORY, "no memory to note the device memory of '%s'", name);
    if (status) {
        block_destroy(gpu, block);
        return status;
    }
    block->spans[block->span_count++] = (struct span){0, block->size};
    memory->blocks[memory->count++] = block;
    *out = block;
    return SF_OK;
}

/* The smallest free span in which `size` bytes fit; span_count when there is none. */
static size_t find_span(const struct sf_block *block, uint64_t size, uint64_t alignment)
{
    size_t best = block->span_count;

    for (size_t i = 0; i < block->span_count; i++) {
        const struct span *span = &block->spans[i];
        uint64_t start = align_up(span->offset, alignment);

        if (start + size <= span->offset + span->size &&
            (best == block->span_count || span->size < block->spans[best].size))
            best = i;
    }
    return best;
}

/* Cuts the place out of a span, leaving what is before and behind it. */
static bool take_span(struct sf_block *block, size_t index, uint64_t size, uint64_t alignment, uint64_t *offset)
{
    struct span old = block->spans[index];
    uint64_t start = align_up(old.offset, alignment), end = old.offset + old.size;
    struct span pieces[2];
    size_t count = 0;

    if (!sf_array_reserve((void **)&block->spans, block->places + 1, &block->span_capacity, 2, sizeof *block->spans))
        return false;
    if (start > old.offset)
        pieces[count++] = (struct span){old.offset, start - old.offset};
    if (start + size < end)
        pieces[count++] = (struct span){start + size, end - start - size};
    memmove(block->spans + index + count, block->spans + index + 1,
            (block->span_count - index - 1) * sizeof *block->spans);
    memcpy(block->spans + index, pieces, count * sizeof *pieces);
    block->span_count += count - 1;
    block->places++;
    *offset = start;
    return true;
}

static void give_span(struct sf_block *block, uint64_t offset, uint64_t size)
{
    size_t i = 0;

    while (i < block->span_count && block->spans[i].offset < offset)
        i++;
    memmove(block->spans + i + 1, block->spans + i, (block->span_count - i) * sizeof *block->spans);
    block->spans[i] = (struct span){offset, size};
    block->span_count++;
    block->places--;
    if (i + 1 < block->span_count && offset + size == block->spans[i + 1].offset) {
        block->spans[i].size += block->spans[i + 1].size;
        memmove(block->spans + i + 1, block->spans + i + 2, (block->span_count - i - 2) * sizeof *block->spans);
        block->span_count--;
    }
    if (i > 0 && block->spans[i - 1].offset + block->spans[i - 1].size == offset) {
        block->spans[i - 1].size += block->spans[i].size;
        memmove(block->spans + i, block->spans + i + 1, (block->span_count - i - 1) * sizeof *block->spans);
        block->span_count--;
    }
}

enum sf_status sf_memory_alloc(struct sf_gpu *gpu, const char *name, const VkMemoryRequirements *needs,
                               enum sf_memory_kind kind, struct sf_place *place)
{
    uint32_t type = find_type(gpu, needs->memoryTypeBits, kind);
    uint64_t alignment = needs->alignment, size = needs->size, grain = gpu->limits.bufferImageGranularity;
    struct sf_block *block = NULL;
    size_t span = 0;

    if (type == UINT32_MAX)
        return sf_fail(gpu->log, SF_ERROR_DEVICE, "the device has no kind of memory that fits '%s'", name);
    if (kind == SF_MEMORY_READBACK && grain < gpu->limits.nonCoherentAtomSize)
        grain = gpu->limits.nonCoherentAtomSize;
    if (grain < 1)
        grain = 1;
    if (alignment < grain)
        alignment = grain; /* both are powers of two */
    size = align_up(size ? size : 1, grain);
    for (size_t i = 0; i < gpu->memory.count && !block; i++) {
        struct sf_block *candidate = gpu->memory.blocks[i];

        if (candidate->type != type)
            continue;
        span = find_span(candidate, size, alignment);
        if (span < candidate->span_count)
            block = candidate;
    }
    if (!block) {
        enum sf_status status = block_create(gpu, name, type, size, &block);

        if (status)
            return status;
        span = 0;
    }
    if (!take_span(block, span, size, alignment, &place->offset)) {
        if (block->places == 0) { /* made just now: it is the last one */
            gpu->memory.count--;
            block_destroy(gpu, block);
        }
        return sf_fail(gpu->log, SF_ERROR_MEMORY, "no memory to note the device memory of '%s'", name);
    }
    place->block = block;
    place->memory = block->memory;
    place->size = size;
    place->mapped = block->mapped ? block->mapped + place->offset : NULL;
    return SF_OK;
}

void sf_memory_free(struct sf_gpu *gpu, struct sf_place *place)
{
    struct sf_memory *memory = &gpu->memory;
    struct sf_block *block = place->block;

    if (!block)
        return;
    give_span(block, place->offset, place->size);
    *place = (struct sf_place){0};
    if (block->places > 0)
        return;
    for (size_t i = 0; i < memory->count; i++)
        if (memory->blocks[i] == block)
            memory->blocks[i] = memory->blocks[--memory->count];
    block_destroy(gpu, block);
}

enum sf_status sf_memory_invalidate(struct sf_gpu *gpu, const struct sf_place *place, const char *name)
{
    VkMappedMemoryRange range = {
        .sType = VK_STRUCTURE_TYPE_MAPPED_MEMORY_RANGE,
        .memory = place->memory,
        .offset = place->offset,
        .size = place->size,
    };

    if (place->block->coherent)
        return SF_OK;
    return sf_vk_check(gpu, gpu->vk.vkInvalidateMappedMemoryRanges(gpu->device, 1, &range), "read back", name);
}

bool sf_memory_type_fits(const struct sf_place *place, uint32_t type_bits)
{
    return place->block && type_bits & 1u << place->block->type;
}

void sf_memory_finish(struct sf_gpu *gpu)
{
    struct sf_memory *memory = &gpu->memory;

    for (size_t i = 0; i < memory->count; i++)
        block_destroy(gpu, memory->blocks[i]);
    free(memory->blocks);
    *memory = (struct sf_memory){.budget = memory->budget};
}
