/* What a call can answer. The values are the program's exit codes, so that one table serves both. */
#ifndef SFUMATO_STATUS_H
#define SFUMATO_STATUS_H

enum sf_status {
    SF_OK = 0,
    SF_ERROR_INTERNAL = 1,      /* a defect of ours: a validation message, a check that failed */
    SF_ERROR_USAGE = 2,         /* an argument or option that cannot be */
    SF_ERROR_SCENE = 3,         /* a scene, or a file that it names, is wrong */
    SF_ERROR_DEVICE = 4,        /* no Vulkan driver, no such device, a feature that is missing */
    SF_ERROR_DEVICE_LOST = 5,   /* the device was lost, or did not answer in time */
    SF_ERROR_MEMORY = 6,        /* host or device memory, or the budget, is used up */
    SF_ERROR_IO = 7,            /* a file could not be read or written */
    SF_ERROR_INTERRUPTED = 130, /* the user asked to stop */
};

/* A short name such as "out of memory"; never NULL. */
const char *sf_status_name(enum sf_status status);

#endif
