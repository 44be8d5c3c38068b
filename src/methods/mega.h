/* Mega particles (METHODS B8): the callbacks of the method table's row, see method.h. */
#ifndef SF_METHODS_MEGA_H
#define SF_METHODS_MEGA_H

#include "methods/thick_parts.h"
#include "shared/mega.h"

/* The method's memory. */
struct sf_mega {
    struct sf_thick thick; /* first: the smoke's shadow on the scene is thick-larsson's */
    struct {
        struct sf_thick_push push;
        struct sf_mega_push own;
    } push; /* of the passes that read both */
    sf_resource balls, numbers, blurred, blurred_depth;
};

enum sf_status sf_mega_light(struct sf_method_frame *frame, void *state, const struct sf_log *log);
enum sf_status sf_mega_view(struct sf_method_frame *frame, void *state, const struct sf_log *log);
void sf_mega_update(const struct sf_method_frame *frame, void *state);

#endif
