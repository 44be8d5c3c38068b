/* The viewer's eye: orbit, pan, dolly and fly; framing; presets; and a way to and fro between it and the scene's own
 * camera. Plain mathematics in double, no window. */
#ifndef SF_APP_VIEW_RIG_H
#define SF_APP_VIEW_RIG_H

#include <stdbool.h>
#include "sfumato/sfumato.h"

enum { SF_RIG_PRESETS = 9 };

struct sf_rig {
    bool own;                        /* the person has moved it; else the scene's camera is followed */
    double eye[3], target[3], up[3]; /* up: unit, and the pole of turning; target is what it orbits */
    double fov, near_clip;           /* deg, m */
    double speed;                    /* m/s of flying; 0: sf_rig_follow chooses one */
    struct sf_camera_view presets[SF_RIG_PRESETS];
    bool preset_set[SF_RIG_PRESETS];
};

/* Takes the scene's camera over, unless the person has moved his own. */
void sf_rig_follow(struct sf_rig *rig, const struct sf_camera_view *scene);
/* Back to the scene's camera. */
void sf_rig_release(struct sf_rig *rig);

/* dx and dy are what the mouse moved in px (to the right, down) over a picture `height` px high. Every movement makes the
 * eye the person's own; one that is nothing, or would leave the 1e5 m that a scene's camera may go to, changes nothing.
 */

/* Turns the scene with the mouse, that is the eye about the target the other way: half a turn for the picture's height.
 * Does not go over the poles. */
void sf_rig_orbit(struct sf_rig *rig, double dx, double dy, double height);
/* Moves eye and target so that the target's plane follows the mouse. */
void sf_rig_pan(struct sf_rig *rig, double dx, double dy, double height);
/* Nearer by steps of a wheel (10 % each); never through the target. */
void sf_rig_dolly(struct sf_rig *rig, double steps);
/* Turns the head the way that the mouse goes, a quarter turn for the picture's height: the target goes round the eye. */
void sf_rig_look(struct sf_rig *rig, double dx, double dy, double height);
/* Flies for `seconds`: right, up (along `up`, not the picture's), forward, times speed. */
void sf_rig_fly(struct sf_rig *rig, double right, double up, double forward, double seconds);
/* Moves so that the box is in the middle and fills the picture, looking the same way. A box with min above max changes
 * nothing and answers false. */
bool sf_rig_frame(struct sf_rig *rig, const float min[3], const float max[3], double aspect);
/* From the front (+z), the back, the left, the right, above, below, at the same distance from the target, with +y up: from
 * above and below a tenth of a degree short of it, with +x to the right. */
enum sf_rig_side { SF_RIG_FRONT, SF_RIG_BACK, SF_RIG_LEFT, SF_RIG_RIGHT, SF_RIG_TOP, SF_RIG_BOTTOM };
void sf_rig_side(struct sf_rig *rig, enum sf_rig_side side);
void sf_rig_store(struct sf_rig *rig, unsigned preset);
bool sf_rig_recall(struct sf_rig *rig, unsigned preset); /* false: none stored */
/* The eye as the renderer takes it: floats, so that the sets of sf_rig_sets give the same bits. */
void sf_rig_view(const struct sf_rig *rig, struct sf_camera_view *view);
/* The sets that make a scene's camera this one: type, eye, target, up, fov, near. Returns how many; none when the scene's
 * camera is followed. Each at most 127 bytes. */
enum { SF_RIG_SETS = 6, SF_RIG_SET_BYTES = 128 };
unsigned sf_rig_sets(const struct sf_rig *rig, char sets[SF_RIG_SETS][SF_RIG_SET_BYTES]);

/* The picture's axes as the renderer makes them of a view: unit vectors to the right, up and forward. */
void sf_view_axes(const struct sf_camera_view *view, double right[3], double above[3], double forward[3]);

#endif
