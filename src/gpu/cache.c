/* The pipeline cache on disk: what the driver compiled last time.
 *
 * The file is a header of ours (magic, size and checksum of the rest), then the driver's own data, which begins with
 * Vulkan's header: the driver's identity. A file that fails either check is ignored with a warning, and written anew at
 * the end. */
#include "gpu/vk.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/file.h"
#include "base/hash.h"

static const char MAGIC[8] = "SFPIPE1";
enum { CACHE_LIMIT = 256 << 20 };

struct header {
    char magic[8];
    uint64_t size, hash;
};

static char *cache_path(const struct sf_gpu *gpu)
{
    char name[64];

    snprintf(name, sizeof name, "pipelines-%s.bin", gpu->info.uuid);
    return sf_cache_path(name);
}

/* Why the file cannot be used, or NULL. */
static const char *refuse(const struct sf_gpu *gpu, const char *data, size_t size)
{
    VkPhysicalDeviceProperties device;
    VkPipelineCacheHeaderVersionOne vulkan;
    struct header header;

    if (size < sizeof header + sizeof vulkan)
        return "it is too short";
    memcpy(&header, data, sizeof header);
    memcpy(&vulkan, data + sizeof header, sizeof vulkan);
    if (memcmp(header.magic, MAGIC, sizeof MAGIC) != 0)
        return "it is not a pipeline cache";
    if (header.size != size - sizeof header)
        return "its size is wrong";
    if (header.hash != sf_hash_bytes(data + sizeof header, header.size, 0))
        return "its checksum is wrong";
    vkGetPhysicalDeviceProperties(gpu->physical, &device);
    if (vulkan.headerVersion != VK_PIPELINE_CACHE_HEADER_VERSION_ONE || vulkan.vendorID != device.vendorID ||
        vulkan.deviceID != device.deviceID ||
        memcmp(vulkan.pipelineCacheUUID, device.pipelineCacheUUID, VK_UUID_SIZE) != 0)
        return "it was made by another driver";
    return NULL;
}

enum sf_status sf_cache_open(struct sf_gpu *gpu)
{
    VkPipelineCacheCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    char *path = gpu->no_cache ? NULL : cache_path(gpu), *data = NULL;
    size_t size = 0;
    enum sf_status status;

    if (path && sf_file_exists(path) && sf_file_read(path, CACHE_LIMIT, NULL, &data, &size) == SF_OK) {
        const char *because = refuse(gpu, data, size);

        if (because) {
            sf_log(gpu->log, SF_LOG_WARNING, "the pipeline cache '%s' is ignored: %s", path, because);
        } else {
            info.pInitialData = data + sizeof(struct header);
            info.initialDataSize = size - sizeof(struct header);
            gpu->cache_hash = sf_hash_bytes(info.pInitialData, info.initialDataSize, 0);
        }
    }
    status = sf_vk_check(gpu, gpu->vk.vkCreatePipelineCache(gpu->device, &info, NULL, &gpu->cache), "create",
                         "pipeline cache");
    free(data);
    free(path);
    return status;
}

/* Losing the cache costs time at the next start and nothing else: failures are warnings. */
static void save(struct sf_gpu *gpu)
{
    struct header header = {.size = 0};
    size_t size = 0;
    char *path = NULL, *data = NULL, *slash;

    if (gpu->vk.vkGetPipelineCacheData(gpu->device, gpu->cache, &size, NULL) != VK_SUCCESS || size == 0)
        return;
    data = malloc(sizeof header + size);
    if (!data || gpu->vk.vkGetPipelineCacheData(gpu->device, gpu->cache, &size, data + sizeof header) != VK_SUCCESS)
        goto done;
    header.size = size;
    header.hash = sf_hash_bytes(data + sizeof header, size, 0);
    memcpy(header.magic, MAGIC, sizeof MAGIC);
    memcpy(data, &header, sizeof header);
    path = cache_path(gpu);
    if (header.hash == gpu->cache_hash || !path)
        goto done;
    slash = strrchr(path, '/');
    *slash = '\0';
    if (sf_folder_create(path, NULL) != SF_OK) {
        sf_log(gpu->log, SF_LOG_WARNING, "the pipeline cache is not kept: cannot make the folder '%s'", path);
        goto done;
    }
    *slash = '/';
    if (sf_file_write(path, data, sizeof header + size, NULL) != SF_OK)
        sf_log(gpu->log, SF_LOG_WARNING, "the pipeline cache is not kept: cannot write '%s'", path);
done:
    free(path);
    free(data);
}

void sf_cache_close(struct sf_gpu *gpu)
{
    if (!gpu->cache || gpu->stuck)
        return;
    if (!gpu->no_cache && atomic_load(&gpu->lost) == SF_OK)
        save(gpu);
    gpu->vk.vkDestroyPipelineCache(gpu->device, gpu->cache, NULL);
    gpu->cache = VK_NULL_HANDLE;
}
