/* A plan made real, as the files of the player share it: place.c gives resources memory, step.c prepares the passes,
 * play.c records them. */
#ifndef SF_GPU_PLAYER_H
#define SF_GPU_PLAYER_H

#include "gpu/timer.h"
#include "gpu/vk.h"

enum { SF_READBACK_DEPTH = 2 };

/* What a (resource, copy) is in the play being recorded. */
struct sf_slot {
    VkBuffer buffer;
    VkDeviceSize offset, bytes;
    VkImage image;
    VkImageView view;
};

/* A resource of the plan. */
struct sf_object {
    const struct sf_plan_resource *resource;
    bool pair;  /* a history, of our own or imported */
    bool flips; /* its copies change places after each play */
    bool writes;
    uint32_t current; /* our own history: the copy that the next play writes */
    struct sf_vk_buffer buffers[2];
    struct sf_vk_image images[2];
    struct sf_gpu_buffer *bound_buffer; /* imported */
    struct sf_gpu_image *bound_image;
    struct sf_upload upload; /* the next play's slice, good in frame upload_serial only */
    uint64_t upload_serial;
    struct sf_vk_buffer *slices; /* readback: one for each of player->depth frames */
    _Atomic uint64_t *serials;   /* the frame that wrote each slice; other threads look for theirs */
};

#define SF_NO_SET UINT32_MAX

/* A pass, prepared so that recording only walks arrays. */
struct sf_step {
    const struct sf_plan_pass *plan;
    const struct sf_pass_desc *desc;
    struct sf_pipeline *pipeline; /* taken, given back when the player goes; NULL: transfer */
    uint32_t set;                 /* index into the play's descriptor sets */
    uint32_t first_barrier;       /* number over the whole plan */
    const struct sf_plan_use *colors[SF_PASS_COLORS_MAX], *depth;
    uint32_t color_count;
};

/* A descriptor write and where its resource comes from. */
struct sf_write {
    uint32_t set, slot;
};

struct sf_player {
    struct sf_gpu *gpu;
    const struct sf_plan *plan;
    struct sf_arena arena;
    struct sf_place heap;      /* the transients' */
    struct sf_object *objects; /* [resource - 1] */
    uint32_t object_count;
    struct sf_slot *slots; /* [2 * (resource - 1) + previous] */
    struct sf_step *steps;
    uint32_t step_count;

    struct sf_descriptor_need need;
    VkDescriptorSetLayout *set_layouts;
    VkDescriptorSet *sets;
    struct sf_write *writes;
    VkWriteDescriptorSet *vk_writes;
    VkDescriptorImageInfo *image_infos; /* one for each write, as buffer_infos */
    VkDescriptorBufferInfo *buffer_infos;
    uint32_t write_count;

    VkImageMemoryBarrier2 *image_barriers; /* room for the longest list of one pass */
    VkBufferMemoryBarrier2 *buffer_barriers;
    uint32_t dropped; /* number of the barrier that is left out */

    uint32_t depth;        /* of readbacks and timers */
    uint32_t slice;        /* of them, that the last play wrote: */
    uint64_t slice_serial; /* in this frame. Frames without a play of this player use up no slice */
    bool played, timing;
    bool continues;          /* the next play uses up no slice */
    struct sf_timer *timers; /* [depth] */
    uint64_t record_ns;
};

static inline uint32_t sf_slot_index(sf_resource resource, bool previous)
{
    return 2 * (resource - 1) + previous;
}

/* place.c */
enum sf_status sf_player_place(struct sf_player *player);
enum sf_status sf_player_place_readbacks(struct sf_player *player);
void sf_player_unplace(struct sf_player *player);
/* step.c */
enum sf_status sf_player_prepare(struct sf_player *player);
enum sf_status sf_player_no_memory(const struct sf_player *player);

#endif
