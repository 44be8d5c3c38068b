/* Two pictures of one frame as one: the first left of a line, the second right of it. */
#ifndef SF_APP_WIPE_H
#define SF_APP_WIPE_H

#include "sfumato/sfumato.h"

/* Makes `frame` what is seen where `beside`, of the same size and formats, stands from column round(at * width) on, 0 <=
 * at <= 1: colour and smoke (none where one of the two has none); the rest is the same in both. *room, malloc'ed or NULL
 * before, holds what is joined, as long as the frame is looked at; the caller frees it. */
enum sf_status sf_wipe_join(struct sf_frame *frame, const struct sf_frame *beside, float at, void **room);

#endif
