/* What the two methods of lit smoke share (METHODS B9, B10): lit.c and scattering.c. */
#ifndef SF_METHODS_LIT_H
#define SF_METHODS_LIT_H

#include "methods/billboard.h"

/* What both shaders read of the settings. */
void sf_lit_fill(const struct sf_scene *scene, struct sf_billboard_push *push);
/* The `view`, with the atlas's images and the first three of the look's own constants put in; `counted`: it reads how many
 * particles there are. */
enum sf_status sf_lit_draw(struct sf_method_frame *frame, void *state, struct sf_billboard_look look, bool counted,
                           const struct sf_log *log);

#endif
