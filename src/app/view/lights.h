/* Lights that can be taken hold of in the picture: where their handles are, which one is under the mouse, and what
 * dragging makes of it. Plain mathematics; the drawing is the caller's. */
#ifndef SF_APP_VIEW_LIGHTS_H
#define SF_APP_VIEW_LIGHTS_H

#include <stdbool.h>
#include "sfumato/sfumato.h"

enum { SF_HANDLES_MAX = 16, SF_LIGHT_SETS = 2, SF_LIGHT_SET_BYTES = 128 };
enum sf_handle_kind {
    SF_HANDLE_POSITION, /* point, spot */
    SF_HANDLE_AIM,      /* spot: a point that it shines at, as far from it as the eye's target */
    SF_HANDLE_SUN, /* directional: a point on a sphere about the target, from which it shines. The sphere is inside of
                           the picture */
};
struct sf_handle {
    unsigned light;
    enum sf_handle_kind kind;
    bool visible; /* in front of the eye; else x and y are 0 */
    bool far;     /* on the far side of its sphere (sun, aim): what sf_handle_drag must be told to keep it there */
    float x, y;   /* px of the picture */
    float from_x,
        from_y;      /* px: other end of its line (aim: the lamp; sun: the target), or where that leaves the view */
    double point[3]; /* m */
    float color[3];  /* of the light, brightest part 1 */
};
/* Of all the scene's lights, for a picture of width x height px. Returns how many. */
unsigned sf_handles_find(const struct sf_control *controls, uint32_t control_count, const struct sf_camera_view *view,
                         float width, float height, struct sf_handle handles[SF_HANDLES_MAX]);
/* The nearest visible one within `reach` px of (x, y), or -1. */
int sf_handles_pick(const struct sf_handle *handles, unsigned count, float x, float y, float reach);
/* What the handle's light becomes when the handle is dragged to (x, y): a position in the plane through it that faces the
 * eye; suns go round their sphere and aims round the one about their lamp, on its far side when `far`, and along its rim
 * when (x, y) is beside it. Sets such as "lights.0.position=1,2,3"; returns how many. */
unsigned sf_handle_drag(const struct sf_handle *handle, const struct sf_control *controls, uint32_t control_count,
                        const struct sf_camera_view *view, float width, float height, float x, float y, bool far,
                        char sets[SF_LIGHT_SETS][SF_LIGHT_SET_BYTES]);
/* Turns light number `light` about the target by so many degrees round the vertical (counter-clockwise from above) and
 * up, to a tenth of a degree short of upright: suns their direction, lamps their place, spots both. Sets, as above. */
unsigned sf_light_orbit(unsigned light, double turn, double rise, const struct sf_control *controls,
                        uint32_t control_count, const struct sf_camera_view *view,
                        char sets[SF_LIGHT_SETS][SF_LIGHT_SET_BYTES]);

#endif
