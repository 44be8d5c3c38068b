/* What the files of src/gpu share, and nobody else sees: the device with all that hangs on it, and Vulkan's objects
 * with their memory.
 *
 * Device functions are called through gpu->vk, the device's own table; only instance functions are volk's globals.
 * Every VkResult goes through sf_vk_check. One thread at a time uses a device; sf_frame_wait, sf_player_readback and
 * sf_player_times may run beside it. */
#ifndef SF_GPU_VK_H
#define SF_GPU_VK_H

#include <pthread.h>
#include <stdatomic.h>
#include <volk.h>
#include "gpu/gpu.h"
#include "gpu/shaders.h"

enum { SF_FRAMES_IN_FLIGHT = 2, SF_FIRST_MESSAGE_BYTES = 1024 };

/* ---- memory.c ---- */

enum sf_memory_kind {
    SF_MEMORY_DEVICE,   /* fastest for the device */
    SF_MEMORY_UPLOAD,   /* mapped, coherent, written by the CPU */
    SF_MEMORY_READBACK, /* mapped, cached where that can be had, read by the CPU */
};

struct sf_block; /* one vkAllocateMemory, shared by many places */
struct sf_memory {
    struct sf_block **blocks;
    size_t count, capacity;
    uint64_t used, budget; /* bytes */
};
/* A piece of device memory; all zero when there is none. */
struct sf_place {
    struct sf_block *block;
    VkDeviceMemory memory;
    uint64_t offset, size;
    char *mapped; /* NULL: the CPU cannot see it */
};
enum sf_status sf_memory_alloc(struct sf_gpu *gpu, const char *name, const VkMemoryRequirements *needs,
                               enum sf_memory_kind kind, struct sf_place *place);
void sf_memory_free(struct sf_gpu *gpu, struct sf_place *place);
/* Makes what the device wrote visible to the CPU, where the memory does not do so by itself. Any thread. */
enum sf_status sf_memory_invalidate(struct sf_gpu *gpu, const struct sf_place *place, const char *name);
bool sf_memory_type_fits(const struct sf_place *place, uint32_t type_bits);
void sf_memory_finish(struct sf_gpu *gpu);

/* ---- buffer.c, image.c ---- */

struct sf_vk_buffer {
    VkBuffer handle;
    struct sf_place place; /* its own memory, unless it was put into another's */
    uint64_t bytes;        /* as asked for; the Vulkan buffer is rounded up to 16 */
};
VkBufferCreateInfo sf_vk_buffer_info(uint64_t bytes, VkBufferUsageFlags usage);
VkBufferUsageFlags sf_vk_buffer_usage(uint32_t access_bits);
/* With `home`, at home->offset + offset when its memory fits, otherwise (and without) in memory of its own. */
enum sf_status sf_vk_buffer_init(struct sf_gpu *gpu, const char *name, uint64_t bytes, VkBufferUsageFlags usage,
                                 enum sf_memory_kind kind, const struct sf_place *home, uint64_t offset,
                                 struct sf_vk_buffer *buffer);
void sf_vk_buffer_finish(struct sf_gpu *gpu, struct sf_vk_buffer *buffer);

struct sf_vk_image {
    VkImage handle;
    VkImageView view; /* all of it: 2D, or a 2D array when it has several layers */
    struct sf_place place;
    uint32_t width, height, layers;
    enum sf_format format;
    VkImageUsageFlags usage;
};
VkImageCreateInfo sf_vk_image_info(enum sf_format format, uint32_t width, uint32_t height, uint32_t layers,
                                   VkImageUsageFlags usage);
VkImageUsageFlags sf_vk_image_usage(uint32_t access_bits);
VkFormat sf_vk_format(enum sf_format format);
VkImageSubresourceRange sf_vk_image_range(enum sf_format format);
VkImageSubresourceLayers sf_vk_image_layers(enum sf_format format, uint32_t layers);
/* The name of a usage for which the device cannot take an image of that format, or NULL when it can. `blended`,
 * `filtered`: is it? */
const char *sf_vk_image_misfit(const struct sf_gpu *gpu, enum sf_format format, VkImageUsageFlags usage, bool blended,
                               bool filtered);
/* A view of all of the image, whose other fields are filled in. */
enum sf_status sf_vk_image_view_init(struct sf_gpu *gpu, const char *name, struct sf_vk_image *image);
enum sf_status sf_vk_image_init(struct sf_gpu *gpu, const char *name, const VkImageCreateInfo *info,
                                enum sf_format format, const struct sf_place *home, uint64_t offset,
                                struct sf_vk_image *image);
void sf_vk_image_finish(struct sf_gpu *gpu, struct sf_vk_image *image);

struct sf_gpu_buffer {
    struct sf_gpu *gpu;
    char *name;
    struct sf_vk_buffer copies[2];
    uint32_t copy_count;
    uint32_t latest; /* the copy that was written last */
    enum sf_access outside;
};
struct sf_gpu_image {
    struct sf_gpu *gpu;
    char *name;
    struct sf_vk_image image;
    enum sf_access outside;
    /* A swapchain's: the frame that may draw into it, and whether it has. */
    uint64_t acquired;
    bool drawn;
};

/* ---- barrier.c: the one table access x kind of pass -> stages, accesses, layout ---- */

VkImageLayout sf_vk_layout(enum sf_access access, enum sf_format format);
struct sf_scope {
    VkPipelineStageFlags2 stages;
    VkAccessFlags2 reads, writes;
};
struct sf_scope sf_scope_of(struct sf_touch touch);
struct sf_scope sf_scope_union(const struct sf_touch *touches, uint32_t count);

/* ---- pipeline.c ---- */

struct sf_pipeline_binding {
    uint32_t binding;
    VkDescriptorType type;
    enum sf_sampler sampler; /* combined image samplers */
};
/* All that tells one pipeline from another; compared as bytes, so it starts as zeros. */
struct sf_pipeline_key {
    const struct sf_shader *shader, *fragment;
    VkPipelineBindPoint bind_point;
    uint32_t constants[SF_PASS_CONSTANTS_MAX], constant_count, push_bytes;
    struct sf_pipeline_binding bindings[SF_PASS_USES_MAX];
    uint32_t binding_count;
    struct sf_raster raster;
    VkFormat colors[SF_PASS_COLORS_MAX], depth;
    uint32_t color_count;
    bool depth_writes;
};
struct sf_pipeline {
    struct sf_pipeline_key key;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkPipeline handle;
    VkShaderStageFlags stages;
    struct sf_gpu *gpu;
    const char *pass;      /* that wanted it first: a name for messages, until it is made */
    uint32_t users;        /* steps of players */
    uint64_t unused_since; /* while there are none: orders those that lost their last */
};
/* Pipelines that the device keeps though no player uses them. A scene with everything in it has less than 30, so what
 * the last two left is found again by somebody who goes to and fro between scenes, or between values of a parameter
 * that is compiled in. Who drags such a parameter through all its values leaves no more than this behind: the largest
 * pipelines hold 1.4 MB each in lavapipe, 90 MB together. */
enum { SF_PIPELINES_UNUSED_MAX = 64 };
/* Pipelines are the device's: players that need the same one share it, and a graph that is built anew finds its old
 * ones. One that was not there before is made by the next sf_pipelines_build, and `pass` must live until then. */
enum sf_status sf_pipeline_request(struct sf_gpu *gpu, const char *pass, const struct sf_pipeline_key *key,
                                   struct sf_pipeline **pipeline);
/* Makes what was requested, on several threads. When one fails, none of the new ones remain. */
enum sf_status sf_pipelines_build(struct sf_gpu *gpu);
/* Between these two, the player's step may use the pipeline, and it stays; NULL is none. */
void sf_pipeline_take(struct sf_pipeline *pipeline);
void sf_pipeline_give_back(struct sf_pipeline *pipeline);
/* Drops the pipelines that have been unused for longest, until SF_PIPELINES_UNUSED_MAX unused ones are left. Only after
 * sf_gpu_settle. */
void sf_pipelines_trim(struct sf_gpu *gpu);
/* Makes the pipelines that use the shader anew, in place, while the device uses none of them; those that no player uses
 * are dropped. When one fails or would not fit, all stay as they are. */
enum sf_status sf_pipelines_remake(struct sf_gpu *gpu, const struct sf_shader *shader);
/* Drops what was requested and not made. */
void sf_pipelines_forget(struct sf_gpu *gpu);
void sf_pipelines_finish(struct sf_gpu *gpu);

/* ---- shader.c ---- */

/* The words to use for a shader of the library: its own, or those that took their place. */
const struct sf_shader *sf_shader_now(const struct sf_gpu *gpu, const struct sf_shader *shader);
/* SF_ERROR_USAGE when the shader's words cannot be used, or not by a pass with a pipeline of that key (NULL: any). */
enum sf_status sf_shader_check(const struct sf_gpu *gpu, const struct sf_shader *shader, const char *pass,
                               const struct sf_pipeline_key *key);
void sf_shaders_finish(struct sf_gpu *gpu);

/* ---- cache.c ---- */

enum sf_status sf_cache_open(struct sf_gpu *gpu);
void sf_cache_close(struct sf_gpu *gpu);

/* ---- descriptor.c, upload.c: what a frame in flight hands out and takes back when it begins again ---- */

enum { SF_DESCRIPTOR_TYPES = 4 };
struct sf_descriptor_need {
    uint32_t sets, types[SF_DESCRIPTOR_TYPES];
};
void sf_descriptor_count(struct sf_descriptor_need *need, VkDescriptorType type);
struct sf_descriptor_pool;
struct sf_descriptor_pools {
    struct sf_descriptor_pool *pools;
    size_t count, capacity;
};
enum sf_status sf_descriptor_alloc(struct sf_gpu *gpu, struct sf_descriptor_pools *pools, const char *name,
                                   const struct sf_descriptor_need *need, const VkDescriptorSetLayout *layouts,
                                   VkDescriptorSet *sets);
enum sf_status sf_descriptor_reset(struct sf_gpu *gpu, struct sf_descriptor_pools *pools);
void sf_descriptor_finish(struct sf_gpu *gpu, struct sf_descriptor_pools *pools);

struct sf_upload_ring {
    struct sf_vk_buffer *chunks;
    size_t count, capacity;
    size_t current; /* chunk being filled */
    uint64_t fill;  /* bytes of it that are taken */
};
struct sf_upload {
    VkBuffer buffer;
    uint64_t offset;
    void *data;
};
enum sf_status sf_upload_alloc(struct sf_gpu *gpu, struct sf_upload_ring *ring, const char *name, uint64_t bytes,
                               struct sf_upload *upload);
void sf_upload_reset(struct sf_upload_ring *ring);
void sf_upload_finish(struct sf_gpu *gpu, struct sf_upload_ring *ring);

/* ---- frame.c ---- */

struct sf_frame_slot {
    VkCommandPool pool;
    VkCommandBuffer commands;
    struct sf_descriptor_pools descriptors;
    struct sf_upload_ring uploads;
};
enum sf_status sf_frames_init(struct sf_gpu *gpu);
void sf_frames_finish(struct sf_gpu *gpu);
struct sf_frame_slot *sf_frame_slot_now(struct sf_gpu *gpu);
/* The status of the failure after which the device takes no more work; SF_OK while all is well. */
enum sf_status sf_gpu_refuse_lost(struct sf_gpu *gpu);
/* Waits for all submitted work before something that it may use is destroyed. When the device does not answer,
 * gpu->stuck is set and objects are left alone rather than pulled from under it. */
void sf_gpu_settle(struct sf_gpu *gpu);
/* Commands outside of frames: begin, record, then submit and wait. Everything written is visible to all later commands.
 */
enum sf_status sf_setup_begin(struct sf_gpu *gpu, const char *name, VkCommandBuffer *commands);
enum sf_status sf_setup_end(struct sf_gpu *gpu, const char *name);

/* ---- surface.c, swapchain.c ---- */

/* The instance's surface calls: volk's globals are those of the instance that was made last, which may have none. */
struct sf_surface {
    struct sf_surface_source source; /* create NULL: nothing will be shown */
    VkSurfaceKHR handle;
    bool lost; /* to be made anew */
    uint32_t modes;
    VkSurfaceFormatKHR format; /* of the swapchain's images */
    PFN_vkDestroySurfaceKHR destroy;
    PFN_vkGetPhysicalDeviceSurfaceSupportKHR support;
    PFN_vkGetPhysicalDeviceSurfaceCapabilitiesKHR capabilities;
    PFN_vkGetPhysicalDeviceSurfaceFormatsKHR formats;
    PFN_vkGetPhysicalDeviceSurfacePresentModesKHR present_modes;
};
/* Makes the surface, before a device is chosen. Does nothing when gpu->surface has no source. */
enum sf_status sf_surface_init(struct sf_gpu *gpu);
/* Can queues of that family show pictures on the surface? */
bool sf_surface_takes(const struct sf_surface *surface, VkPhysicalDevice physical, uint32_t family);
/* Asks the chosen device what it can do with the surface: modes, format. */
enum sf_status sf_surface_learn(struct sf_gpu *gpu);
/* Another one in place of one that was lost and has no swapchain any more. */
enum sf_status sf_surface_renew(struct sf_gpu *gpu);
void sf_surface_finish(struct sf_gpu *gpu);
VkPresentModeKHR sf_vk_present_mode(enum sf_present_mode mode);

/* What the end of a frame waits for and signals when it draws an image of the swapchain; both none otherwise. Without a
 * play that drew it, the image becomes black. */
struct sf_showing {
    VkSemaphore acquired, drawn;
};
struct sf_showing sf_swapchain_close_frame(struct sf_gpu *gpu, VkCommandBuffer commands);
/* Presents what the frame that has just been submitted drew; nothing to do otherwise. */
enum sf_status sf_swapchain_present(struct sf_gpu *gpu);

/* ---- instance.c, error.c, device.c ---- */

/* `surface` NULL: none. */
enum sf_status sf_instance_create(bool validate, const VkDebugUtilsMessengerCreateInfoEXT *messenger,
                                  const struct sf_surface_source *surface, const struct sf_log *log,
                                  VkInstance *instance, bool *debug_utils);
/* Of the device, or of instances when there is none. */
bool sf_has_extension(VkPhysicalDevice physical, const char *name);
/* Fills info (and says what is missing; showing pictures on the surface counts when there is one, which may be NULL).
 * The queue family that can do all, or UINT32_MAX. */
uint32_t sf_physical_describe(VkPhysicalDevice physical, const struct sf_surface *surface, struct sf_gpu_info *info);
enum sf_status sf_physical_choose(VkInstance instance, const char *wanted, const struct sf_surface *surface,
                                  const struct sf_log *log, VkPhysicalDevice *physical, struct sf_gpu_info *info);
enum sf_status sf_physical_list(VkInstance instance, const struct sf_log *log, VkPhysicalDevice **physicals,
                                uint32_t *count);

/* The one place where a VkResult becomes a status. A failure is logged as "cannot <doing> '<what>': <why>"; a lost
 * device is remembered. */
enum sf_status sf_vk_check(struct sf_gpu *gpu, VkResult result, const char *doing, const char *what);
enum sf_status sf_vk_fail(const struct sf_log *log, VkResult result, const char *doing, const char *what);
void sf_vk_name(struct sf_gpu *gpu, VkObjectType type, uint64_t handle, const char *name);

/* A handle as the 64 bits that debug names want; dispatchable ones are pointers, the others may be either. */
#define SF_VK_HANDLE(handle) ((uint64_t)(uintptr_t)(handle))

struct sf_gpu {
    const struct sf_log *log;
    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger;
    bool debug_utils, validate, no_cache;
    VkPhysicalDevice physical;
    VkDevice device;
    struct VolkDeviceTable vk;
    VkQueue queue;
    uint32_t family;

    struct sf_surface surface;
    struct sf_swapchain *swapchain; /* the one that was made for the surface, or NULL */

    struct sf_gpu_info info;
    struct sf_gpu_tuning tuning;
    VkPhysicalDeviceLimits limits;
    uint64_t max_allocation;           /* bytes of one vkAllocateMemory */
    uint32_t timestamp_bits;           /* valid ones; 0: this queue keeps no time */
    VkPhysicalDeviceFeatures features; /* enabled ones */
    VkPhysicalDeviceMemoryProperties memory_types;
    VkFormatFeatureFlags formats[SF_FORMAT_COUNT];

    struct sf_memory memory;
    VkSampler samplers[SF_SAMPLER_COUNT];
    VkPipelineCache cache;
    uint64_t cache_hash; /* of the data on disk */
    struct sf_pipeline **pipelines;
    size_t pipeline_count, pipeline_capacity;
    size_t pipelines_made;     /* the others were requested */
    uint64_t pipelines_left;   /* how often a pipeline lost its last user */
    struct sf_shader *shaders; /* [as sf_shaders] with words where others took the library's place; NULL: nowhere */

    struct sf_frame_slot slots[SF_FRAMES_IN_FLIGHT];
    VkSemaphore timeline;       /* holds the serial of the last frame that is done */
    _Atomic uint64_t submitted; /* serial of the last frame handed to the device */
    uint64_t timeout_ns;
    bool recording;
    VkCommandPool setup_pool;
    VkCommandBuffer setup_commands;
    VkSemaphore setup_timeline;
    uint64_t setup_count;
    atomic_int lost; /* an enum sf_status other than SF_OK: no more frames */
    atomic_bool stuck;

    pthread_mutex_t message_lock;
    uint32_t messages;
    char first_message[SF_FIRST_MESSAGE_BYTES];
};

#endif
