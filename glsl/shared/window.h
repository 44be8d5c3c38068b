/* How a window's image is drawn: src/render/window_graph.c and glsl/window. */
#ifndef SF_SHARED_WINDOW_H
#define SF_SHARED_WINDOW_H
#include "types.h"

struct sf_window_picture_push {
    SF_VEC4(rect);    /* px of the window: left, top, width, height */
    SF_VEC4(to_clip); /* xy: 2 / the window's size; z: light is multiplied by it (2^exposure); w: px of the
                         window from which on the second picture stands, when there are two */
    SF_UVEC4(size);   /* xy: of the picture, px; zw: unused */
};

struct sf_window_ui_push {
    SF_VEC4(to_clip); /* xy: 2 / the window's size; zw: unused */
};
#endif
