/* What ui.h needs besides Dear ImGui, in C: the triangles of a frame, words with formats, tooltips that wait, fields that
 * commit, the box. And what ui.cpp, which alone sees ImGui, does for these. */
#ifndef SF_APP_VIEW_UI_PARTS_H
#define SF_APP_VIEW_UI_PARTS_H

#include "ui.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- done here (ui_parts.c) ---- */

/* A font file of the usual places that can be read; NULL: none. */
const char *sf_ui_parts_font(void);
extern const uint16_t sf_ui_parts_glyphs[]; /* that it is asked for: first, last, first, last, ..., 0 */
/* Of a thing that ImGui names ("WindowBg"), 0xAABBGGRR; NULL: as ImGui has it. */
const uint32_t *sf_ui_parts_color(const char *name);
/* With each frame. `moved`: the mouse has, or is down. */
void sf_ui_parts_begin(bool moved);
void sf_ui_parts_end(void); /* frees all */
/* Panels have used the keys in this frame, though nothing shows it any more. */
bool sf_ui_parts_used_keys(void);
/* The triangles of a frame: emptied; then for every list of vertices the batches that index it, and the vertices
 * themselves. Arrays are kept for the next frame. When memory is out what does not fit is left out. */
void sf_ui_mesh_clear(float width, float height);
void sf_ui_mesh_batch(const float clip[4], const uint16_t *indices, uint32_t count, uint32_t offset);
void sf_ui_mesh_vertices(const void *vertices, uint32_t count);
void sf_ui_mesh_overlay(struct sf_overlay *overlay);

/* ---- done by ui.cpp ---- */

/* Flags of sf_ui_panel_begin beyond those of ui.h. */
enum {
    SF_UI_SHADE = 256, /* darkens what lies below it */
    SF_UI_BOX = 512,   /* x, y: its middle; as large as its content needs, at most width x height */
};
/* wrap: px from the panel's edge; 0: at its other edge; below 0: never. */
void sf_ui_raw_words(uint32_t color, float wrap, const char *text);
void sf_ui_raw_tooltip(const char *text, float wrap);
bool sf_ui_raw_hovered(void); /* the last thing, disabled or not */
bool sf_ui_raw_panel_clicked(void);
bool sf_ui_raw_tab(const char *label, bool choose);
void sf_ui_raw_choice(const char *label, int *value, const char *const *choices, int count);
/* `whole`: CHANGED by Enter only, else at every sign. LEFT: after a change. */
enum { SF_UI_FIELD_CHANGED = 1, SF_UI_FIELD_ACTIVE = 2, SF_UI_FIELD_LEFT = 4 };
unsigned sf_ui_raw_field(const char *label, const char *hint, char *text, unsigned room, bool whole);
unsigned sf_ui_raw_id(const char *label);
void sf_ui_raw_focus(void); /* on the next control */
void sf_ui_raw_place(float *x, float *y);
void sf_ui_raw_canvas(const char *name, float width, float height);
/* Escape was pressed; `free`: and no control and no list had a use for it. */
bool sf_ui_raw_escape(bool free);
void sf_ui_raw_size(float size[2]); /* of the window */

#ifdef __cplusplus
}
#endif

#endif
