/* Keys, and the mouse in the picture: eye, lights, time. Called after the panels were drawn, which have the first right
 * to both. */
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../console.h"
#include "view.h"

static const float REACH = 12;    /* px at scale 1: how near a light's handle must be */
static const double KEY_TURN = 3; /* deg a press */

static bool in_picture(const struct sf_view *view, float x, float y)
{
    const float *place = view->picture;

    return x >= place[0] && y >= place[1] && x < place[0] + place[2] && y < place[1] + place[3];
}

/* ---- lights ---- */

static unsigned find_handles(const struct sf_view *view, struct sf_handle handles[SF_HANDLES_MAX])
{
    struct sf_camera_view eye;

    sf_rig_view(&view->rig, &eye);
    return sf_handles_find(view->model.controls, view->model.control_count, &eye, view->picture[2], view->picture[3],
                           handles);
}

static void set_light(struct sf_view *view, char sets[SF_LIGHT_SETS][SF_LIGHT_SET_BYTES], unsigned count)
{
    const char *pointers[SF_LIGHT_SETS];

    for (unsigned i = 0; i < count; i++)
        pointers[i] = sets[i];
    if (count > 0)
        sf_model_set_many(&view->model, pointers, count);
}

static void drag_light(struct sf_view *view, float x, float y)
{
    struct sf_handle handles[SF_HANDLES_MAX];
    unsigned count = find_handles(view, handles);
    char sets[SF_LIGHT_SETS][SF_LIGHT_SET_BYTES];
    struct sf_camera_view eye;

    if (view->handle < 0 || (unsigned)view->handle >= count)
        return;
    sf_rig_view(&view->rig, &eye);
    set_light(view, sets,
              sf_handle_drag(&handles[view->handle], view->model.controls, view->model.control_count, &eye,
                             view->picture[2], view->picture[3], x - view->picture[0], y - view->picture[1],
                             view->handle_far != ((sf_screen_mods(view->screen) & GLFW_MOD_SHIFT) != 0), sets));
}

static void orbit_light(struct sf_view *view, double turn, double rise)
{
    char sets[SF_LIGHT_SETS][SF_LIGHT_SET_BYTES];
    struct sf_camera_view eye;

    if (view->model.info.lights == 0)
        return;
    view->light %= view->model.info.lights;
    sf_rig_view(&view->rig, &eye);
    set_light(view, sets,
              sf_light_orbit(view->light, turn, rise, view->model.controls, view->model.control_count, &eye, sets));
}

static uint32_t handle_color(const struct sf_handle *handle)
{
    uint32_t color = 0xff000000;

    for (int i = 0; i < 3; i++)
        color |= (uint32_t)(255 * sqrtf(handle->color[i])) << 8 * i;
    return color;
}

void sf_input_draw_lights(struct sf_view *view)
{
    struct sf_handle handles[SF_HANDLES_MAX];
    unsigned count = view->lights_shown && !sf_view_looked(view)->values ? find_handles(view, handles) : 0;
    float x0 = view->picture[0], y0 = view->picture[1], radius = 6 * sf_ui_scale();

    if (count == 0)
        return;
    sf_ui_draw_behind();
    sf_ui_draw_clip(x0, y0, view->picture[2], view->picture[3]);
    for (unsigned i = 0; i < count; i++) {
        const struct sf_handle *handle = &handles[i];
        bool chosen = (int)i == view->handle || handle->light == view->light;
        float x = x0 + handle->x, y = y0 + handle->y;

        if (!handle->visible)
            continue;
        if (handle->kind != SF_HANDLE_POSITION)
            sf_ui_draw_line(x, y, x0 + handle->from_x, y0 + handle->from_y, 0x80ffffff, 1);
        sf_ui_draw_circle(x, y, radius, handle_color(handle), handle->kind != SF_HANDLE_AIM);
        sf_ui_draw_circle(x, y, radius + 2, chosen ? sf_ui_accent : 0x80000000, false);
    }
    sf_ui_draw_unclip();
    sf_ui_draw_panel();
}

/* ---- the mouse ---- */

static enum sf_hold press(struct sf_view *view, int button, float x, float y)
{
    int mods = sf_screen_mods(view->screen);

    if (sf_view_looked(view)->values)
        return SF_HOLD_LOOKED;
    if (button == 0 && view->lights_shown) {
        struct sf_handle handles[SF_HANDLES_MAX];
        unsigned count = find_handles(view, handles);

        view->handle =
            sf_handles_pick(handles, count, x - view->picture[0], y - view->picture[1], REACH * sf_ui_scale());
        if (view->handle >= 0) {
            view->light = handles[view->handle].light;
            view->handle_far = handles[view->handle].far;
            return SF_HOLD_LIGHT;
        }
    }
    if (button == 0 && sf_wipe_near(view, x, y))
        return SF_HOLD_WIPE;
    if (button == 2 || (button == 0 && mods & GLFW_MOD_SHIFT))
        return SF_HOLD_PAN;
    return button == 1 ? SF_HOLD_LOOK : SF_HOLD_ORBIT;
}

static void take_mouse(struct sf_view *view)
{
    float x, y, dx, dy, wheel = sf_ui_wheel();
    bool down = sf_ui_mouse_down(0) || sf_ui_mouse_down(1) || sf_ui_mouse_down(2);
    double height = view->picture[3];

    sf_ui_mouse(&x, &y);
    sf_ui_mouse_moved(&dx, &dy);
    if (!down) {
        view->hold = SF_HOLD_NONE;
        view->handle = -1;
    }
    for (int button = 0; button < 3 && view->hold == SF_HOLD_NONE; button++)
        if (sf_ui_mouse_clicked(button) && !sf_ui_takes_mouse() && in_picture(view, x, y))
            view->hold = press(view, button, x, y);
    if (view->hold == SF_HOLD_WIPE ||
        (view->hold == SF_HOLD_NONE && !sf_ui_takes_mouse() && in_picture(view, x, y) && sf_wipe_near(view, x, y)))
        sf_ui_mouse_sideways();
    if (wheel != 0 && !sf_ui_takes_mouse() && in_picture(view, x, y) && !sf_view_looked(view)->values) {
        sf_rig_dolly(&view->rig, wheel);
        sf_view_moved(view);
    }
    if (view->hold == SF_HOLD_NONE || (dx == 0 && dy == 0))
        return;
    if (view->hold == SF_HOLD_LIGHT)
        drag_light(view, x, y);
    else if (view->hold == SF_HOLD_WIPE)
        sf_wipe_drag(view, x);
    else if (view->hold == SF_HOLD_ORBIT)
        sf_rig_orbit(&view->rig, dx, dy, height);
    else if (view->hold == SF_HOLD_PAN)
        sf_rig_pan(&view->rig, dx, dy, height);
    else if (view->hold == SF_HOLD_LOOK)
        sf_rig_look(&view->rig, dx, dy, height);
    if (view->hold != SF_HOLD_LIGHT && view->hold != SF_HOLD_LOOKED && view->hold != SF_HOLD_WIPE)
        sf_view_moved(view);
}

/* W A S D Q E while the right button is held. */
static void fly(struct sf_view *view, double seconds)
{
    struct sf_screen *screen = view->screen;
    double right = sf_screen_held(screen, GLFW_KEY_D) - sf_screen_held(screen, GLFW_KEY_A);
    double up = sf_screen_held(screen, GLFW_KEY_E) - sf_screen_held(screen, GLFW_KEY_Q);
    double forward = sf_screen_held(screen, GLFW_KEY_W) - sf_screen_held(screen, GLFW_KEY_S);
    double faster = sf_screen_mods(screen) & GLFW_MOD_SHIFT ? 4 : 1;

    if (view->hold != SF_HOLD_LOOK || (right == 0 && up == 0 && forward == 0))
        return;
    sf_rig_fly(&view->rig, right * faster, up * faster, forward * faster, seconds);
    sf_view_moved(view);
}

/* ---- keys ---- */

static void search(struct sf_view *view)
{
    view->panels = view->focus_search = true;
    view->tab = 0;
}

static void control_key(struct sf_view *view, int key)
{
    if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9) {
        unsigned preset = (unsigned)(key - GLFW_KEY_1);

        sf_rig_store(&view->rig, preset);
        sf_view_note(view, SF_LOG_INFO, "camera %u stored", preset + 1);
        return;
    }
    switch (key) {
    case GLFW_KEY_F:
        search(view);
        break;
    case GLFW_KEY_C:
        sf_view_copy_command(view);
        break;
    case GLFW_KEY_S:
        sf_view_save(view, view->save_path);
        break;
    case GLFW_KEY_Z:
        sf_view_reset(view, NULL);
        break;
    case GLFW_KEY_Q:
        view->closing = true;
        break;
    }
}

static void escape(struct sf_view *view)
{
    if (view->keys_shown)
        view->keys_shown = false;
    else if (view->against.open && (view->against.wanted || view->against.comparison) && !view->against.gone)
        sf_against_stop(view);
    else if (view->looking.name[0])
        sf_view_look(view, "");
    else if (sf_screen_fullscreen(view->screen))
        sf_screen_set_fullscreen(view->screen, false);
}

static void frame_smoke(struct sf_view *view)
{
    double aspect = (double)view->picture[2] / view->picture[3];

    if (sf_rig_frame(&view->rig, view->bounds_min, view->bounds_max, aspect))
        sf_view_moved(view);
    else
        sf_view_note(view, SF_LOG_INFO, "there is no smoke to frame yet");
}

static void digit(struct sf_view *view, int key, int mods)
{
    int number = key - GLFW_KEY_1;

    if (!(mods & GLFW_MOD_SHIFT)) {
        if (sf_rig_recall(&view->rig, (unsigned)number))
            sf_view_moved(view);
    } else if (number <= SF_RIG_BOTTOM) {
        sf_rig_side(&view->rig, (enum sf_rig_side)number);
        sf_view_moved(view);
    }
}

static void time_key(struct sf_view *view, int key)
{
    struct sf_playback *playback = &view->playback;

    switch (key) {
    case GLFW_KEY_SPACE:
        sf_playback_toggle(playback);
        break;
    case GLFW_KEY_PERIOD:
        sf_playback_step(playback, 1);
        break;
    case GLFW_KEY_COMMA:
        sf_playback_step(playback, -1);
        break;
    case GLFW_KEY_HOME:
        sf_view_seek(view, 0);
        break;
    case GLFW_KEY_LEFT_BRACKET:
        sf_playback_faster(playback, -1);
        break;
    case GLFW_KEY_RIGHT_BRACKET:
        sf_playback_faster(playback, 1);
        break;
    }
}

static void light_key(struct sf_view *view, int key)
{
    switch (key) {
    case GLFW_KEY_L:
        if (view->lights_shown)
            view->light++;
        if (view->light >= view->model.info.lights) {
            view->light = 0;
            view->lights_shown = false;
        } else {
            view->lights_shown = true;
        }
        break;
    case GLFW_KEY_LEFT:
        orbit_light(view, -KEY_TURN, 0);
        break;
    case GLFW_KEY_RIGHT:
        orbit_light(view, KEY_TURN, 0);
        break;
    case GLFW_KEY_UP:
        orbit_light(view, 0, KEY_TURN);
        break;
    case GLFW_KEY_DOWN:
        orbit_light(view, 0, -KEY_TURN);
        break;
    }
}

static void plain_key(struct sf_view *view, int key, int mods)
{
    switch (key) {
    case GLFW_KEY_TAB:
        view->panels = !view->panels;
        break;
    case GLFW_KEY_F11:
        sf_screen_set_fullscreen(view->screen, !sf_screen_fullscreen(view->screen));
        break;
    case GLFW_KEY_P:
    case GLFW_KEY_F12:
        sf_view_shot(view);
        break;
    case GLFW_KEY_R:
        sf_view_record(view);
        break;
    case GLFW_KEY_T:
        view->tab = SF_TABS - 1;
        view->panels = true;
        sf_against_begin(view);
        break;
    case GLFW_KEY_M:
        if (mods & GLFW_MOD_SHIFT)
            sf_wipe_next(view);
        else
            sf_wipe_toggle(view);
        break;
    case GLFW_KEY_F:
        frame_smoke(view);
        break;
    case GLFW_KEY_C:
        sf_rig_release(&view->rig);
        sf_view_moved(view);
        break;
    case GLFW_KEY_O:
        view->governor.on = !view->governor.on;
        sf_view_note(view, SF_LOG_INFO, "coarser smoke while the camera moves: %s", view->governor.on ? "on" : "off");
        break;
    case GLFW_KEY_SLASH:
        if (mods & GLFW_MOD_SHIFT)
            view->keys_shown = !view->keys_shown;
        else
            search(view);
        break;
    case GLFW_KEY_F1:
        view->keys_shown = !view->keys_shown;
        break;
    default:
        if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9)
            digit(view, key, mods);
        if (key >= GLFW_KEY_F2 && key < GLFW_KEY_F2 + SF_TABS) {
            view->tab = key - GLFW_KEY_F2;
            view->panels = true;
        }
        break;
    }
}

static void take_key(struct sf_view *view, const struct sf_key *key)
{
    if (key->key == GLFW_KEY_ESCAPE) {
        escape(view);
    } else if (key->mods & GLFW_MOD_CONTROL) {
        control_key(view, key->key);
    } else if (view->hold != SF_HOLD_LOOK) { /* else they fly */
        plain_key(view, key->key, key->mods);
        time_key(view, key->key);
        if (key->mods & GLFW_MOD_SHIFT && sf_wipe_seen(view) &&
            (key->key == GLFW_KEY_LEFT || key->key == GLFW_KEY_RIGHT))
            sf_wipe_key(view, key->key == GLFW_KEY_RIGHT);
        else
            light_key(view, key->key);
    }
}

void sf_input_feed(const struct sf_view *view, const struct sf_key *keys, unsigned count, bool pressed)
{
    for (unsigned i = 0; i < count; i++) {
        int mods = pressed ? keys[i].mods : sf_screen_mods(view->screen);

        sf_ui_feed_key(keys[i].key, pressed || sf_screen_held(view->screen, keys[i].key), mods & GLFW_MOD_CONTROL,
                       mods & GLFW_MOD_SHIFT);
    }
}

/* Keys that a field which is typed in has no use for. */
static bool is_command(const struct sf_key *key)
{
    if (key->mods & GLFW_MOD_CONTROL)
        return key->key == GLFW_KEY_Q || key->key == GLFW_KEY_S || key->key == GLFW_KEY_F;
    return key->key >= GLFW_KEY_F1 && key->key <= GLFW_KEY_F12;
}

void sf_input_take(struct sf_view *view, double seconds)
{
    struct sf_key key;
    char *path;

    while (sf_screen_key(view->screen, &key)) {
        view->input_ns = view->input_ns ? view->input_ns : key.born_ns;
        if (!sf_ui_takes_keys() || is_command(&key))
            take_key(view, &key);
    }
    take_mouse(view);
    fly(view, seconds);
    while ((path = sf_screen_dropped(view->screen))) {
        sf_view_open(view, path);
        free(path);
    }
}
