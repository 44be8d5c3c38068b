/* What the viewer remembers from one time to the next: $XDG_CONFIG_HOME/sfumato/view.json (or ~/.config). */
#ifndef SF_APP_VIEW_SETTINGS_H
#define SF_APP_VIEW_SETTINGS_H

#include <stdbool.h>
#include <stdint.h>
#include "rig.h"

enum { SF_RECENT_MAX = 8 };
struct sf_settings {
    uint32_t width, height; /* px of the window */
    bool fullscreen, panel; /* panel: the side panel is shown */
    float panel_width;      /* px at scale 1 */
    char present_mode[16];
    bool adapt; /* coarser smoke while the camera moves */
    float goal_ms;
    char *recent[SF_RECENT_MAX]; /* scenes, newest first; NULL: none */
    struct sf_camera_view presets[SF_RIG_PRESETS];
    bool preset_set[SF_RIG_PRESETS];
};
void sf_settings_default(struct sf_settings *settings);
/* No file, or no home to look for it in: the defaults. A file that is corrupt: the same, with a warning that names it. Keys
 * that are unknown or out of range are passed over with a warning each. Finish in either case. */
void sf_settings_load(struct sf_settings *settings);
/* Written whole or not at all, numbers kept to what can be read again; a folder that is missing is made. A failure is a
 * warning; without a home nothing is written. */
void sf_settings_save(const struct sf_settings *settings);
/* Moves it to the front; a relative path is remembered as a whole one. */
void sf_settings_recent(struct sf_settings *settings, const char *path);
void sf_settings_finish(struct sf_settings *settings);

#endif
