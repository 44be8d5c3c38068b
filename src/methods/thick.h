/* Thick smoke with volumetric lighting: the callbacks of the method table's row, see method.h. */
#ifndef SF_METHODS_THICK_H
#define SF_METHODS_THICK_H

#include "methods/thick_parts.h"

enum sf_status sf_thick_light(struct sf_method_frame *frame, void *state, const struct sf_log *log);
enum sf_status sf_thick_view(struct sf_method_frame *frame, void *state, const struct sf_log *log);
void sf_thick_update(const struct sf_method_frame *frame, void *state);

#endif
