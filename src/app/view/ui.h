/* Dear ImGui behind a C interface: what the viewer's panels are drawn with. Lengths are px of the framebuffer; colours
 * are sRGB with straight alpha, 0xAABBGGRR. Labels name a control: unique within their panel; what follows "##" is not
 * shown. One ui at a time, one thread. */
#ifndef SF_APP_VIEW_UI_H
#define SF_APP_VIEW_UI_H

#include <stdbool.h>
#include <stdint.h>
#include "sfumato/sfumato.h"

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define SF_UI_PRINTF(string, first) __attribute__((format(printf, string, first)))
#else
#define SF_UI_PRINTF(string, first)
#endif

struct GLFWwindow;
struct sf_ui;

/* Hooks itself into the window's callbacks (those set before are called on). `scale` is the screen's: 1, 1.5, 2. Without
 * a window (NULL) it is fed by the functions at the end. A second one beside the first is SF_ERROR_USAGE. */
enum sf_status sf_ui_create(struct GLFWwindow *window, float scale, struct sf_ui **ui);
void sf_ui_destroy(struct sf_ui **ui);
/* The font's picture for sf_window_set_font; the ui's own. */
void sf_ui_font(const struct sf_ui *ui, const uint8_t **coverage, uint32_t *width, uint32_t *height);
void sf_ui_begin(struct sf_ui *ui);
/* The triangles of all that was drawn since begin; good until the next end. */
void sf_ui_end(struct sf_ui *ui, struct sf_overlay *overlay);
/* Mouse or keys are for the panels now, not for the picture. Keys are while a field is typed in, a list is open or the
 * panels are walked through by keys (Ctrl+Tab, or Tab out of a field; Escape ends it): a click on a panel leaves them to
 * the picture. */
bool sf_ui_takes_mouse(void);
bool sf_ui_takes_keys(void);
/* Seconds until the panels have something new to show by themselves (a tooltip, a cursor that blinks): draw again then. */
double sf_ui_due(void);
/* Height of a line of controls with the gap below it; the screen's scale, by which lengths of your own go. */
float sf_ui_line(void);
float sf_ui_scale(void);

/* ---- panels ---- */
enum sf_ui_panel_flags {
    SF_UI_FIXED = 1,    /* neither moves nor folds: x, y, width, height are set anew each time */
    SF_UI_CLEAR = 2,    /* no background, no title, does not take the mouse */
    SF_UI_UNTITLED = 4, /* no title bar */
    SF_UI_SOLID = 8,    /* opaque and square: part of the window's frame, not over the picture */
    SF_UI_QUIET = 16,   /* does not take the mouse */
};
/* False when folded or outside; end it in either case. With `open` (may be NULL) it has a cross that clears it. Height 0:
 * as high as its content. */
bool sf_ui_panel_begin(const char *title, float x, float y, float width, float height, unsigned flags, bool *open);
void sf_ui_panel_end(void);
/* A part of a panel that scrolls by itself; height 0: all that is left. End it in either case. */
bool sf_ui_child_begin(const char *name, float height);
void sf_ui_child_end(void);
bool sf_ui_tabs_begin(const char *name);
void sf_ui_tab_choose(const char *label); /* before its begin: opens it */
bool sf_ui_tab_begin(const char *label);  /* end only when true */
void sf_ui_tab_end(void);
void sf_ui_tabs_end(void);
bool sf_ui_section(const char *label, bool open); /* folds; `open` at first. Nothing to end */
/* A box in the middle of the window over everything; false when it is closed. `open` is cleared by Escape, its cross or a
 * click beside it. End only when true. Keys other than Escape still go to the picture. */
bool sf_ui_box_begin(const char *title, bool *open);
void sf_ui_box_end(void);

/* ---- lines ---- */
void sf_ui_same_line(float x); /* 0: after the last thing; else at x from the panel's edge */
void sf_ui_separator(void);
void sf_ui_space(float height);
void sf_ui_width(float width); /* of the next control; below 0: up to that far from the right edge */
float sf_ui_room(void);        /* width that is left in this line */
void sf_ui_id_push(const char *id);
void sf_ui_id_pop(void);
void sf_ui_disable(bool disabled); /* pairs with sf_ui_enable */
void sf_ui_enable(void);

/* ---- words ---- */
/* One line, level with the controls beside it and as high; at most 2047 bytes. */
void sf_ui_text(const char *format, ...) SF_UI_PRINTF(1, 2);
void sf_ui_text_color(uint32_t color, const char *format, ...) SF_UI_PRINTF(2, 3);
/* A paragraph, set closer. */
void sf_ui_text_wrapped(uint32_t color, const char *text);
/* Shown while the mouse rests on the last thing. */
void sf_ui_tooltip(const char *format, ...) SF_UI_PRINTF(1, 2);
extern const uint32_t sf_ui_plain, sf_ui_dim, sf_ui_accent, sf_ui_warning, sf_ui_error; /* colours of text */

/* ---- controls: true when the person changed the value ---- */
bool sf_ui_button(const char *label);
bool sf_ui_small_button(const char *label);
bool sf_ui_selectable(const char *label, bool selected);
bool sf_ui_checkbox(const char *label, bool *value);
/* Clamped, typed numbers too (Ctrl and click). Bounds within half of the type's range. */
bool sf_ui_slider(const char *label, float *value, float min, float max, const char *format, bool logarithmic);
bool sf_ui_slider_int(const char *label, int *value, int min, int max, bool logarithmic);
/* Numbers that are dragged sideways or typed after a double click. `speed`: change a px. */
bool sf_ui_drag(const char *label, float *values, unsigned count, float speed, float min, float max,
                const char *format);
bool sf_ui_color(const char *label, float rgb[3], bool hdr);
bool sf_ui_choice(const char *label, int *value, const char *const *choices); /* NULL-terminated */
/* True when Enter is pressed or the field is left after a change; Escape brings back what was there. `text` may be filled
 * anew before each call: while the field is typed in, what was typed prevails. At most 1024 bytes. */
bool sf_ui_input(const char *label, const char *hint, char *text, unsigned room);
/* True at every sign that is typed. */
bool sf_ui_search(const char *label, const char *hint, char *text, unsigned room, bool focus);
void sf_ui_progress(float part, const char *text);
void sf_ui_plot(const char *label, const float *values, unsigned count, unsigned first, float min, float max,
                float height);
/* The rectangle of the last thing: x, y, width, height; is the mouse over it; is it held. */
void sf_ui_last_rectangle(float rectangle[4]);
bool sf_ui_last_hovered(void);
bool sf_ui_last_active(void);

/* ---- drawing ---- */
/* Takes a place of that size in the panel that can be clicked and dragged; *x, *y become its corner. True while held.
 * Drawing after it goes into the panel. */
bool sf_ui_canvas(const char *name, float width, float height, float *x, float *y);
/* Behind all panels, over the picture; until sf_ui_draw_panel. */
void sf_ui_draw_behind(void);
void sf_ui_draw_panel(void);
void sf_ui_draw_clip(float x, float y, float width, float height); /* pairs with unclip */
void sf_ui_draw_unclip(void);
void sf_ui_draw_line(float x0, float y0, float x1, float y1, uint32_t color, float thickness);
void sf_ui_draw_rectangle(float x, float y, float width, float height, uint32_t color, bool filled);
void sf_ui_draw_circle(float x, float y, float radius, uint32_t color, bool filled);
void sf_ui_draw_text(float x, float y, uint32_t color, const char *text);
float sf_ui_text_width(const char *text);

/* ---- the mouse, wherever it is ---- */
void sf_ui_mouse(float *x, float *y);
void sf_ui_mouse_moved(float *dx, float *dy);
float sf_ui_wheel(void);
bool sf_ui_mouse_down(int button); /* 0 left, 1 right, 2 middle */
bool sf_ui_mouse_clicked(int button);
bool sf_ui_mouse_double(int button);

void sf_ui_mouse_sideways(void); /* in this frame its pointer says that it drags to the sides */

/* A key as the window numbers it, before begin, for what was pressed and let go since the last one (ImGui sees only what
 * is held when a frame begins, and slow frames would lose keys); after end, as it is now. */
void sf_ui_feed_key(int key, bool down, bool control, bool shift);

/* ---- without a window: for tests ---- */
void sf_ui_feed_size(uint32_t width, uint32_t height);
void sf_ui_feed_mouse(float x, float y, bool down);
/* Typed in the next frame. Tab, newline, Escape (033) and backspace are pressed as keys. */
void sf_ui_feed_text(const char *text);

#ifdef __cplusplus
}
#endif

#endif
