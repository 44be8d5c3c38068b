/* The public interface's devices: src/gpu's, in public clothes. */
#include "render/internal.h"

#include <stdlib.h>
#include <string.h>
#include "base/log.h"
#include "gpu/shaders.h"

static void describe(const struct sf_gpu_info *from, struct sf_device_info *to)
{
    memset(to, 0, sizeof *to);
    memcpy(to->name, from->name, sizeof to->name);
    memcpy(to->driver, from->driver, sizeof to->driver);
    memcpy(to->uuid, from->uuid, sizeof to->uuid);
    memcpy(to->kind, from->kind, sizeof to->kind);
    memcpy(to->unsuitable_because, from->unsuitable_because, sizeof to->unsuitable_because);
    to->api_major = from->api_major;
    to->api_minor = from->api_minor;
    to->api_patch = from->api_patch;
    to->memory_bytes = from->memory_bytes;
    to->subgroup_size = from->subgroup_size;
    to->max_image_side = from->max_image_side;
    to->suitable = from->suitable;
}

_Static_assert(sizeof((struct sf_device_info *)0)->name == sizeof((struct sf_gpu_info *)0)->name &&
                   sizeof((struct sf_device_info *)0)->driver == sizeof((struct sf_gpu_info *)0)->driver &&
                   sizeof((struct sf_device_info *)0)->uuid == sizeof((struct sf_gpu_info *)0)->uuid &&
                   sizeof((struct sf_device_info *)0)->kind == sizeof((struct sf_gpu_info *)0)->kind &&
                   sizeof((struct sf_device_info *)0)->unsuitable_because ==
                       sizeof((struct sf_gpu_info *)0)->unsuitable_because,
               "the two infos agree");

enum sf_status sf_device_list(const struct sf_log *log, struct sf_device_info **infos, uint32_t *count)
{
    struct sf_gpu_info *gpus = NULL;
    enum sf_status status;

    *infos = NULL;
    *count = 0;
    status = sf_gpu_list(log, &gpus, count);
    if (status)
        return status;
    *infos = calloc(*count > 0 ? *count : 1, sizeof **infos);
    if (!*infos)
        status = sf_fail(log, SF_ERROR_MEMORY, "the list of devices: out of memory");
    for (uint32_t i = 0; *infos && i < *count; i++)
        describe(&gpus[i], &(*infos)[i]);
    if (status)
        *count = 0;
    free(gpus);
    return status;
}

enum sf_status sf_device_create(const struct sf_device_options *options, const struct sf_log *log,
                                struct sf_device **device)
{
    const struct sf_gpu_options gpu_options = {.device = options->device,
                                               .validate = options->validate,
                                               .budget_bytes = options->budget_bytes,
                                               .timeout_ns = options->timeout_ns,
                                               .no_cache = options->no_cache,
                                               .surface = options->surface};
    enum sf_status status;

    *device = calloc(1, sizeof **device);
    if (!*device)
        return sf_fail(log, SF_ERROR_MEMORY, "device: out of memory");
    status = sf_gpu_create(&gpu_options, log, &(*device)->gpu);
    if (status)
        sf_device_destroy(device);
    return status;
}

void sf_device_destroy(struct sf_device **device)
{
    if (!device || !*device)
        return;
    sf_gpu_destroy(&(*device)->gpu);
    free(*device);
    *device = NULL;
}

void sf_device_describe(const struct sf_device *device, struct sf_device_info *info)
{
    describe(sf_gpu_info(device->gpu), info);
}

uint32_t sf_device_validation_messages(const struct sf_device *device)
{
    return sf_gpu_validation_messages(device->gpu, NULL);
}

void sf_device_memory(const struct sf_device *device, uint64_t *used, uint64_t *budget)
{
    sf_gpu_memory(device->gpu, used, budget);
}

const char *sf_shader_name(uint32_t index)
{
    uint32_t i = 0;

    while (i < index && sf_shaders[i].name)
        i++;
    return sf_shaders[i].name;
}

enum sf_status sf_device_set_shader(struct sf_device *device, const char *name, const uint32_t *words, size_t bytes)
{
    device->shaders_set++;
    return sf_gpu_set_shader(device->gpu, name, words, bytes);
}
