/* Two methods side by side: the scene's left of a line, a second one right of it, from the same particles. */
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../console.h"
#include "view.h"

static const float REACH = 6, GRIP = 10; /* px at scale 1: beside the line; radius of its grip */
static const float KEY_MOVE = 0.02f;     /* of the width, a press */
enum { LABEL_BYTES = 96, LIST_BYTES = 512 };

/* The table's names, and which one is the scene's. */
static const char *const *methods_of(const struct sf_view *view, unsigned *scenes)
{
    const struct sf_control *control = sf_model_control(&view->model, "method");

    *scenes = control ? (unsigned)control->value[0] : 0;
    return control ? control->choices : NULL;
}

static unsigned find(const char *const *methods, const char *name, unsigned *count)
{
    unsigned found = 0;

    for (*count = 0; methods[*count]; ++*count)
        found = strcmp(methods[*count], name) == 0 ? *count : found;
    return found;
}

enum sf_status sf_wipe_open(struct sf_view *view)
{
    const char *name = view->arguments->beside, *nearest;
    char known[LIST_BYTES] = "";
    const char *const *methods;
    unsigned scenes, count = 0;
    size_t used = 0;

    view->wipe.at = view->arguments->wipe.given ? (float)view->arguments->wipe.value : 0.5f;
    methods = name ? methods_of(view, &scenes) : NULL;
    for (; methods && methods[count]; count++) {
        if (strcmp(methods[count], name) == 0) {
            view->wipe.on = true;
            snprintf(view->wipe.method, sizeof view->wipe.method, "%s", name);
            return SF_OK;
        }
        if (used < sizeof known)
            used += (size_t)snprintf(known + used, sizeof known - used, "%s%s", count > 0 ? ", " : "", methods[count]);
    }
    if (!methods)
        return SF_OK;
    nearest = sf_nearest_word(name, methods, count);
    return sf_console_fail(SF_ERROR_USAGE, "--compare %s: no such method%s%s%s (known: %s)", name,
                           nearest ? "; did you mean " : "", nearest ? nearest : "", nearest ? "?" : "", known);
}

/* ---- what is asked for ---- */

void sf_wipe_choose(struct sf_view *view, const char *method)
{
    snprintf(view->wipe.method, sizeof view->wipe.method, "%s", method);
    view->wipe.on = true;
    view->settle = true;
}

void sf_wipe_toggle(struct sf_view *view)
{
    if (view->wipe.on)
        view->wipe.on = false;
    else if (view->wipe.method[0])
        view->wipe.on = true;
    else
        sf_wipe_next(view);
    view->settle = true;
}

void sf_wipe_next(struct sf_view *view)
{
    unsigned scenes, count, at;
    const char *const *methods = methods_of(view, &scenes);

    if (!methods)
        return;
    at = find(methods, view->wipe.method, &count);
    if (!view->wipe.method[0])
        at = scenes + 1 < count ? scenes + 1 : scenes - (scenes > 0); /* its neighbour in the table */
    else if (view->wipe.on)
        at = (at + 1) % count;
    sf_wipe_choose(view, methods[at]);
}

void sf_wipe_give_up(struct sf_view *view)
{
    if (view->wipe.on)
        sf_view_note(view, SF_LOG_WARNING, "the comparison with %s is off", view->wipe.method);
    view->wipe.on = false;
    view->settle = true;
}

/* ---- the line ---- */

bool sf_wipe_seen(const struct sf_view *view)
{
    const struct sf_looking *looked =
        view->against.open && view->against.heat.values ? &view->against.heat : &view->looking;

    return view->beside[0] && !looked->values;
}

/* px of the window. */
static float line_of(const struct sf_view *view)
{
    return view->picture[0] + roundf(view->wipe.at * view->picture[2]);
}

bool sf_wipe_near(const struct sf_view *view, float x, float y)
{
    float scale = sf_ui_scale(), across = fabsf(x - line_of(view));
    float down = y - (view->picture[1] + view->picture[3] / 2);

    return sf_wipe_seen(view) && (across <= REACH * scale || hypotf(across, down) <= GRIP * scale);
}

void sf_wipe_drag(struct sf_view *view, float x)
{
    view->wipe.at = fminf(fmaxf((x - view->picture[0]) / view->picture[2], 0), 1);
    view->settle = true;
}

void sf_wipe_key(struct sf_view *view, bool right)
{
    view->wipe.at = fminf(fmaxf(view->wipe.at + (right ? KEY_MOVE : -KEY_MOVE), 0), 1);
    view->settle = true;
}

/* ---- what is drawn ---- */

static void draw_label(const struct sf_view *view, const char *method, float ms, bool right)
{
    float scale = sf_ui_scale(), margin = 6 * scale, height = sf_ui_line() * 0.75f, width, x;
    float y = view->picture[1] + view->picture[3] - height - 2 * margin;
    char text[LABEL_BYTES];

    if (ms > 0)
        snprintf(text, sizeof text, "%s  %.1f ms", method, (double)ms);
    else
        snprintf(text, sizeof text, "%s", method);
    width = sf_ui_text_width(text) + 2 * margin;
    x = right ? line_of(view) + margin : line_of(view) - margin - width;
    sf_ui_draw_rectangle(x, y, width, height + margin, 0xb0000000, true);
    sf_ui_draw_text(x + margin, y + margin / 2, sf_ui_plain, text);
}

void sf_wipe_draw(struct sf_view *view)
{
    const float *place = view->picture;
    float scale = sf_ui_scale(), x = line_of(view), y = place[1] + place[3] / 2, arm = GRIP * scale;
    bool held = view->hold == SF_HOLD_WIPE;

    if (!sf_wipe_seen(view))
        return;
    sf_ui_draw_behind();
    sf_ui_draw_clip(place[0], place[1], place[2], place[3]);
    sf_ui_draw_line(x, place[1], x, place[1] + place[3], 0x80000000, 3 * scale);
    sf_ui_draw_line(x, place[1], x, place[1] + place[3], held ? sf_ui_accent : 0xffffffff, scale);
    sf_ui_draw_circle(x, y, arm, 0xb0000000, true);
    sf_ui_draw_circle(x, y, arm, held ? sf_ui_accent : 0xffffffff, false);
    for (int side = -1; side <= 1; side += 2) { /* < > */
        float tip = x + (float)side * 0.65f * arm, back = x + (float)side * 0.3f * arm;

        sf_ui_draw_line(tip, y, back, y - 0.35f * arm, 0xffffffff, 1.5f * scale);
        sf_ui_draw_line(tip, y, back, y + 0.35f * arm, 0xffffffff, 1.5f * scale);
    }
    draw_label(view, view->model.info.method, view->wipe.ms[0], false);
    draw_label(view, view->beside, view->wipe.ms[1], true);
    sf_ui_draw_unclip();
    sf_ui_draw_panel();
}

void sf_panel_wipe(struct sf_view *view)
{
    unsigned scenes, count;
    const char *const *methods = methods_of(view, &scenes);
    bool on = view->wipe.on;
    int choice;

    if (sf_ui_checkbox("beside it (M)", &on))
        sf_wipe_toggle(view);
    sf_ui_tooltip("a second method right of a line in the picture; drag it, or Shift and the arrow keys");
    if (!methods || !view->wipe.on)
        return;
    choice = (int)find(methods, view->wipe.method, &count);
    if (sf_ui_choice("second method", &choice, methods))
        sf_wipe_choose(view, methods[choice]);
    sf_ui_tooltip("Shift+M: the next one");
    if (sf_ui_slider("line", &view->wipe.at, 0, 1, "%.2f", false))
        view->settle = true;
}
