/* Thick smoke the thesis's way (Larsson 3.3): the callbacks of the method table's row, see method.h. */
#ifndef SF_METHODS_LARSSON_H
#define SF_METHODS_LARSSON_H

#include "methods/thick_parts.h"

enum sf_status sf_larsson_light(struct sf_method_frame *frame, void *state, const struct sf_log *log);
enum sf_status sf_larsson_view(struct sf_method_frame *frame, void *state, const struct sf_log *log);
void sf_larsson_update(const struct sf_method_frame *frame, void *state);
/* For methods that need of `light` only the smoke's shadow on the scene, if it has one, and thick->args. */
enum sf_status sf_larsson_shadow(struct sf_method_frame *frame, struct sf_thick *thick, const struct sf_log *log);

#endif
