/* The window of the operating system, by GLFW: size, input, clipboard, full screen, dropped files, and its surface. */
#ifndef SF_APP_VIEW_SCREEN_H
#define SF_APP_VIEW_SCREEN_H

#include <stdbool.h>
#include <stdint.h>
#include "sfumato/sfumato.h"

struct GLFWwindow;
struct sf_screen;

/* SF_ERROR_DEVICE when there is no display, with a hint at `capture`. */
enum sf_status sf_screen_create(const char *title, uint32_t width, uint32_t height, bool fullscreen,
                                const struct sf_log *log, struct sf_screen **screen);
void sf_screen_destroy(struct sf_screen **screen);
struct GLFWwindow *sf_screen_window(struct sf_screen *screen);
const struct sf_surface_source *sf_screen_surface(struct sf_screen *screen);
void sf_screen_title(struct sf_screen *screen, const char *title);

/* Takes in events; waits up to `seconds` for one when there is none. Returns whether anything happened. */
bool sf_screen_poll(struct sf_screen *screen, double seconds);
bool sf_screen_closed(const struct sf_screen *screen); /* the person wants to close it */
void sf_screen_size(const struct sf_screen *screen, uint32_t *width, uint32_t *height); /* px; 0: minimised */
float sf_screen_scale(const struct sf_screen *screen);
bool sf_screen_fullscreen(const struct sf_screen *screen);
void sf_screen_set_fullscreen(struct sf_screen *screen, bool fullscreen);
void sf_screen_copy(struct sf_screen *screen, const char *text);
/* The oldest file that was dropped and not yet taken: malloc'ed; NULL: none. */
char *sf_screen_dropped(struct sf_screen *screen);

/* Keys as GLFW numbers them (GLFW_KEY_*, GLFW_MOD_*). */
struct sf_key {
    int key, mods;
    uint64_t born_ns;
};
enum { SF_KEYS_MAX = 64 };                                        /* that wait to be taken; more are dropped */
bool sf_screen_key(struct sf_screen *screen, struct sf_key *key); /* the oldest press or repeat; false: none */
/* Copies those that wait, without taking them; how many. */
unsigned sf_screen_keys(const struct sf_screen *screen, struct sf_key keys[SF_KEYS_MAX]);
bool sf_screen_held(const struct sf_screen *screen, int key);
int sf_screen_mods(const struct sf_screen *screen); /* held: GLFW_MOD_SHIFT and so on */

#endif
