/* The `view` of each method of billboards, see method.h; the rest of their rows is of billboard.h. */
#ifndef SF_METHODS_SPRITES_H
#define SF_METHODS_SPRITES_H

#include "methods/method.h"

enum sf_status sf_hard_view(struct sf_method_frame *frame, void *state, const struct sf_log *log);
enum sf_status sf_soft_view(struct sf_method_frame *frame, void *state, const struct sf_log *log);
enum sf_status sf_contrast_view(struct sf_method_frame *frame, void *state, const struct sf_log *log);
enum sf_status sf_spherical_view(struct sf_method_frame *frame, void *state, const struct sf_log *log);
enum sf_status sf_average_view(struct sf_method_frame *frame, void *state, const struct sf_log *log);
enum sf_status sf_extent_view(struct sf_method_frame *frame, void *state, const struct sf_log *log);
enum sf_status sf_volumetric_view(struct sf_method_frame *frame, void *state, const struct sf_log *log);
enum sf_status sf_lit_view(struct sf_method_frame *frame, void *state, const struct sf_log *log);
enum sf_status sf_scattering_view(struct sf_method_frame *frame, void *state, const struct sf_log *log);

/* Their `update`, which takes the place of sf_billboard_update. */
void sf_lit_update(const struct sf_method_frame *frame, void *state);
void sf_scattering_update(const struct sf_method_frame *frame, void *state);

#endif
