#ifndef SF_APP_VIEW_SURFACE_H
#define SF_APP_VIEW_SURFACE_H

#include "sfumato/sfumato.h"

/* sf_surface_source.create, with the GLFWwindow as `user`. */
enum sf_status sf_surface_create(void *user, void *instance, uint64_t *surface);

#endif
