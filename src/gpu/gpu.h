/* The device and what lives on it. This header names no Vulkan type: only src/gpu/ includes Vulkan headers. */
#ifndef SF_GPU_GPU_H
#define SF_GPU_GPU_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "graph/plan.h"
#include "sfumato/sfumato.h"

/* ---- devices ---- */

struct sf_gpu_info {
    char name[256];
    char driver[256]; /* driver's name and version */
    char uuid[37];    /* 8-4-4-4-12 lower-case hexadecimal */
    char kind[16];    /* "discrete", "integrated", "virtual", "cpu", "other" */
    uint32_t api_major, api_minor, api_patch;
    uint64_t memory_bytes; /* the largest device-local heap */
    uint32_t subgroup_size;
    uint32_t max_image_side;
    uint64_t max_storage_bytes; /* one binding */
    bool suitable;
    char unsuitable_because[128]; /* what is missing, when not suitable */
};

/* Lists the devices of the machine. *infos is malloc'ed. SF_ERROR_DEVICE when there is no loader or no driver. */
enum sf_status sf_gpu_list(const struct sf_log *log, struct sf_gpu_info **infos, uint32_t *count);

struct sf_gpu_options {
    const char *device;    /* index, UUID, or part of a name (case-insensitive; ambiguous is an error); NULL: discrete,
                              integrated, virtual, cpu */
    bool validate;         /* core and synchronization validation; messages are counted and logged as errors */
    uint64_t budget_bytes; /* device memory that may be allocated; 0: 80% of the device's heap */
    uint64_t timeout_ns;   /* the longest wait for the device; 0: 60 s */
    bool no_cache;         /* neither read nor write the pipeline cache on disk */
    const struct sf_surface_source *surface; /* NULL: nothing will be shown; copied */
};

struct sf_gpu;
enum sf_status sf_gpu_create(const struct sf_gpu_options *options, const struct sf_log *log, struct sf_gpu **gpu);
/* Waits for idle, writes the pipeline cache, frees. */
void sf_gpu_destroy(struct sf_gpu **gpu);
const struct sf_gpu_info *sf_gpu_info(const struct sf_gpu *gpu);
/* Validation messages so far; the text of the first. */
uint32_t sf_gpu_validation_messages(const struct sf_gpu *gpu, const char **first);
/* Device memory allocated now, and the budget. */
void sf_gpu_memory(const struct sf_gpu *gpu, uint64_t *used, uint64_t *budget);

/* Per-device tuning that rooms above read; a software device wants few fat workgroups, a GPU many. */
struct sf_gpu_tuning {
    bool software;
    uint32_t subgroup_size;
    uint32_t workers; /* workgroups that fill the device: cores on a CPU, many on a GPU */
    uint32_t max_group_invocations;
    uint32_t shared_bytes;
    bool int64; /* shaders may have 64-bit integers */
};
const struct sf_gpu_tuning *sf_gpu_tuning(const struct sf_gpu *gpu);

/* ---- objects that outlive a graph: imported by graphs, filled by the CPU once ---- */

struct sf_gpu_buffer;
struct sf_gpu_image;

/* `history`: two copies that graphs which write it flip. Contents: `data` (bytes long, or NULL for zeros) in every
 * copy, waits until it is there. `outside` is the access in which graphs find and leave it. */
enum sf_status sf_gpu_buffer_create(struct sf_gpu *gpu, const char *name, uint64_t bytes, bool history,
                                    enum sf_access outside, const void *data, struct sf_gpu_buffer **buffer);
enum sf_status sf_gpu_buffer_write(struct sf_gpu_buffer *buffer, uint64_t offset, const void *data,
                                   uint64_t bytes); /* waits for idle; all copies */
enum sf_status sf_gpu_buffer_read(struct sf_gpu_buffer *buffer, uint64_t offset, void *data,
                                  uint64_t bytes); /* waits for idle; current copy */
void sf_gpu_buffer_destroy(struct sf_gpu_buffer **buffer);
/* `data`: tightly packed rows, layers in order; never NULL. */
enum sf_status sf_gpu_image_create(struct sf_gpu *gpu, const char *name, enum sf_format format, uint32_t width,
                                   uint32_t height, uint32_t layers, enum sf_access outside, const void *data,
                                   struct sf_gpu_image **image);
/* Of a colour format, for graphs that draw it: `accesses` is a bit set of 1u << enum sf_access. Zeros at first. */
enum sf_status sf_gpu_image_create_target(struct sf_gpu *gpu, const char *name, enum sf_format format, uint32_t width,
                                          uint32_t height, uint32_t accesses, enum sf_access outside,
                                          struct sf_gpu_image **image);
void sf_gpu_image_destroy(struct sf_gpu_image **image);

/* ---- playing graphs ---- */

/* A plan made real: memory, images, pipelines. The plan and its graph must outlive it. */
struct sf_player;
/* The memory function that sf_plan_create wants so that aliasing uses this device's true sizes. `user` is the gpu. */
void sf_gpu_memory_needs(void *user, const struct sf_plan_resource *resource, uint64_t *size, uint64_t *alignment);
enum sf_status sf_player_create(struct sf_gpu *gpu, const struct sf_plan *plan, struct sf_player **player);
void sf_player_destroy(struct sf_player **player); /* waits for idle */
/* Binds imported resources; kept until bound again. */
void sf_player_bind_buffer(struct sf_player *player, sf_resource resource, struct sf_gpu_buffer *buffer);
void sf_player_bind_image(struct sf_player *player, sf_resource resource, struct sf_gpu_image *image);
/* Memory for the next play's contents of an UPLOAD buffer (write only; valid until sf_player_play). Each play wants it
 * anew, and is refused without when the plan uses the buffer. NULL outside a frame, or when memory is out. */
void *sf_player_upload(struct sf_player *player, sf_resource resource);

/* The next play goes on with what the last one began (a picture that takes several plays, each in a frame of its own):
 * results and times go where those of the last one went, which are given up, and its frame is the one to ask for. */
void sf_player_continue(struct sf_player *player);

/* A frame: plays recorded in order into one command buffer and submitted together. Up to 2 frames are in flight: begin
 * waits for the older one. Not thread safe: one thread begins, plays and ends. */
enum sf_status sf_frame_begin(struct sf_gpu *gpu);
/* Records the graph. A player may play several times in one frame. When it fails nothing was recorded, and the frame
 * may go on. */
enum sf_status sf_player_play(struct sf_player *player);
/* Submits; *serial (may be NULL) counts frames from 1. When it fails the frame is lost and the device takes no more
 * work: what the players keep would no longer fit what they recorded. */
enum sf_status sf_frame_end(struct sf_gpu *gpu, uint64_t *serial);
/* Waits (at most the timeout) until that frame is done on the device. SF_ERROR_DEVICE_LOST when it is not. Any thread
 * may call it. */
enum sf_status sf_frame_wait(struct sf_gpu *gpu, uint64_t serial);
enum sf_status sf_gpu_wait_idle(struct sf_gpu *gpu);
/* After sf_frame_wait(serial): the last play's contents of a READBACK buffer in that frame. Valid until `keep` (set
 * with sf_player_set_readback_depth, default 2) further frames have played this player. Mapped, host-cached. NULL when
 * there are none of that frame. Any thread. */
const void *sf_player_readback(struct sf_player *player, sf_resource resource, uint64_t serial);
void sf_player_set_readback_depth(struct sf_player *player, uint32_t frames); /* before the first play */

/* ---- shaders at run time: as sf_device_set_shader; not while a frame is open (SF_ERROR_USAGE) ---- */
enum sf_status sf_gpu_set_shader(struct sf_gpu *gpu, const char *name, const uint32_t *words, size_t bytes);

/* ---- showing: images of the device's surface ---- */

struct sf_swapchain;
enum sf_present_mode {
    SF_PRESENT_FIFO,
    SF_PRESENT_FIFO_RELAXED,
    SF_PRESENT_MAILBOX,
    SF_PRESENT_IMMEDIATE,
    SF_PRESENT_COUNT
};
/* "fifo"; NULL when out of range. */
const char *sf_present_mode_name(enum sf_present_mode mode);
/* Bit set of 1u << mode that the surface has. */
enum sf_status sf_swapchain_modes(struct sf_gpu *gpu, uint32_t *modes);
/* Images of about the size asked for (what the surface allows), SF_FORMAT_BGRA8_UNORM or SF_FORMAT_RGBA8_UNORM. One a
 * device. SF_ERROR_USAGE when the device has no surface or not that mode. A surface of no size gives a swapchain
 * without images: acquire then gives NULL and SF_OK. */
enum sf_status sf_swapchain_create(struct sf_gpu *gpu, uint32_t width, uint32_t height, enum sf_present_mode mode,
                                   struct sf_swapchain **swapchain);
void sf_swapchain_destroy(struct sf_swapchain **swapchain); /* waits for idle */
/* Images anew, of another size or mode, on a new surface when the old one was lost. When the mode is not there
 * (SF_ERROR_USAGE), everything stays; on other failures, and when the new surface is lost again (SF_OK), there are no
 * images until the next renewal. Waits for idle. */
enum sf_status sf_swapchain_renew(struct sf_swapchain *swapchain, uint32_t width, uint32_t height,
                                  enum sf_present_mode mode);
void sf_swapchain_extent(const struct sf_swapchain *swapchain, uint32_t *width, uint32_t *height, uint32_t *images,
                         enum sf_format *format);
/* The image to draw this frame into, between sf_frame_begin and sf_frame_end: imported with outside SF_ACCESS_PRESENT,
 * its old contents gone. sf_frame_end then submits and presents it. *image NULL with SF_OK: the swapchain no longer fits
 * its surface (or the surface is lost, or nothing came free in 1 s): end the frame without it, renew, try again. At most
 * one a frame. The first play that draws it must clear or discard it; when none does, it is shown black. The swapchain
 * cannot be renewed before the frame's end; destroying it before loses the frame, and the device with it. */
enum sf_status sf_swapchain_acquire(struct sf_swapchain *swapchain, struct sf_gpu_image **image);
/* True when the last present said that the images no longer fit well: renew when convenient (a size that has not changed
 * is no reason to try again: lavapipe says so for ever). */
bool sf_swapchain_suboptimal(const struct sf_swapchain *swapchain);

/* ---- timing ---- */

struct sf_pass_time {
    const char *name;
    uint64_t begin_ns, end_ns; /* device clock */
};
/* When on, each pass of the player is surrounded by timestamps. Costs some microseconds a pass. */
void sf_player_set_timing(struct sf_player *player, bool on);
/* After sf_frame_wait: times of the player's passes in that frame, in plan order; a pass begins where the one before
 * ended, so that all add up. Where it played several times, a pass begins as in the first play and lasts as long as in
 * all together (up to 64). Kept as long as readbacks are. SF_ERROR_USAGE when not timed. Any
 * thread. */
enum sf_status sf_player_times(struct sf_player *player, uint64_t serial, const struct sf_pass_time **times,
                               uint32_t *count);
/* CPU nanoseconds that the last sf_player_play took to record. */
uint64_t sf_player_record_ns(const struct sf_player *player);

/* For the mutation test: drop barrier number `barrier` (counted over the plan, final barriers last) when recording;
 * UINT32_MAX drops none. */
void sf_player_drop_barrier(struct sf_player *player, uint32_t barrier);

#endif
