/* For tests: makes Vulkan calls fail from the Nth on, by a shim in the device's dispatch table. (Failing through
 * VkAllocationCallbacks crashes inside some drivers.) */
#ifndef SF_GPU_FAULT_H
#define SF_GPU_FAULT_H

#include <stdbool.h>
#include <stdint.h>

enum sf_fault {
    SF_FAULT_NONE,
    SF_FAULT_MEMORY,  /* vkAllocateMemory: out of device memory */
    SF_FAULT_OBJECT,  /* every creation, allocation or mapping of an object: out of host memory */
    SF_FAULT_SUBMIT,  /* vkQueueSubmit2: device lost */
    SF_FAULT_TIMEOUT, /* vkWaitSemaphores: not done in time */
    /* What a window does to its images. A picture is presented all the same, and then its answer is this one. */
    SF_FAULT_OUT_OF_DATE,  /* vkAcquireNextImageKHR, vkQueuePresentKHR */
    SF_FAULT_SUBOPTIMAL,   /* vkAcquireNextImageKHR (with an image), vkQueuePresentKHR */
    SF_FAULT_SURFACE_LOST, /* vkAcquireNextImageKHR, vkQueuePresentKHR, vkCreateSwapchainKHR */
    SF_FAULT_BUSY,         /* vkAcquireNextImageKHR: no image came free in time */
    SF_FAULT_PRESENT,      /* vkQueuePresentKHR: device lost */
};
/* From call number `n` (from 1) of that kind on, calls fail; SF_FAULT_NONE ends it. Set it before sf_gpu_create, which
 * puts the shim in (another fault may be armed later); one device at a time. Not thread safe. */
void sf_gpu_fail_after(enum sf_fault fault, uint32_t n);
/* Calls of the armed kind so far, and how many objects made through the shim are alive. */
uint32_t sf_gpu_fault_calls(void);
int64_t sf_gpu_fault_alive(void);

struct VolkDeviceTable;
/* Called by sf_gpu_create: wraps the table when a fault has been armed. */
void sf_fault_wrap(struct VolkDeviceTable *table);

#endif
