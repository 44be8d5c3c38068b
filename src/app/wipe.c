#include "wipe.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "console.h"

/* Where the pictures go, one after the other, and how. */
struct joint {
    uint32_t width, height, column;
    unsigned char *next;
};

/* A picture of `pixel` bytes a pixel; NULL when either has none. */
static const void *join(struct joint *joint, const void *frame, const void *beside, size_t pixel)
{
    size_t row = joint->width * pixel, part = joint->column * pixel;
    const unsigned char *left = frame, *right = beside;
    unsigned char *to = joint->next;

    if (!left || !right)
        return NULL;
    for (uint32_t y = 0; y < joint->height; y++, left += row, right += row, to += row) {
        memcpy(to, left, part);
        memcpy(to + part, right + part, row - part);
    }
    right = joint->next;
    joint->next = to;
    return right;
}

enum sf_status sf_wipe_join(struct sf_frame *frame, const struct sf_frame *beside, float at, void **room)
{
    enum { PIXEL_MOST = 16 + 16 + 16 }; /* floats: colour, smoke, its depths */
    struct joint joint = {.width = frame->width, .height = frame->height};
    void *grown = realloc(*room, (size_t)frame->width * frame->height * PIXEL_MOST);

    if (!grown)
        return sf_console_fail(SF_ERROR_MEMORY, "frame %u: out of memory", frame->frame);
    *room = joint.next = grown;
    joint.column = (uint32_t)lroundf(fminf(fmaxf(at, 0), 1) * (float)frame->width);
    frame->color = join(&joint, frame->color, beside->color, 8);
    frame->color_float = join(&joint, frame->color_float, beside->color_float, 16);
    frame->smoke = join(&joint, frame->smoke, beside->smoke, 8);
    frame->smoke_float = join(&joint, frame->smoke_float, beside->smoke_float, 16);
    frame->smoke_depths = join(&joint, frame->smoke_depths, beside->smoke_depths, 16);
    return SF_OK;
}
