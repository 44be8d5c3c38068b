/* What is looked at and how: scene, method, files, camera, lights, window. */
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "view.h"

enum { PATH_BYTES = 1024 };

/* A parameter that has its place here as well. */
static void choose(struct sf_view *view, const char *path, const char *label)
{
    const struct sf_control *control = sf_model_control(&view->model, path);
    struct sf_control copy;
    int choice;

    if (!control || control->kind != SF_CONTROL_CHOICE)
        return;
    copy = *control;
    choice = (int)control->value[0];
    if (!sf_ui_choice(label, &choice, control->choices))
        return;
    copy.value[0] = choice;
    sf_view_apply(view, &copy);
}

static int is_scene(const struct dirent *entry)
{
    const char *dot = strrchr(entry->d_name, '.');

    return dot && dot != entry->d_name && strcmp(dot, ".json") == 0;
}

/* The scenes beside this one. */
static void list_folder(struct sf_view *view)
{
    const char *path = view->model.path, *slash = strrchr(path, '/');
    int length = slash ? (int)(slash - path) : 1;
    char folder[PATH_BYTES], name[PATH_BYTES * 2], open[PATH_BYTES * 2] = "";
    struct dirent **entries;
    int count;

    snprintf(folder, sizeof folder, "%.*s", length, slash ? path : ".");
    count = scandir(folder, &entries, is_scene, alphasort);
    for (int i = 0; i < count; i++) {
        bool here;

        snprintf(name, sizeof name, slash ? "%s/%s" : "%.0s%s", folder, entries[i]->d_name);
        here = strcmp(name, path) == 0;
        if (sf_ui_selectable(entries[i]->d_name, here) && !here)
            snprintf(open, sizeof open, "%s", name);
        free(entries[i]);
    }
    if (count >= 0)
        free(entries);
    if (open[0])
        sf_view_open(view, open);
}

static void list_recent(struct sf_view *view)
{
    char open[PATH_BYTES] = "";

    for (int i = 1; i < SF_RECENT_MAX && view->settings.recent[i]; i++) /* the first one is open */
        if (sf_ui_selectable(view->settings.recent[i], false))
            snprintf(open, sizeof open, "%s", view->settings.recent[i]);
    if (open[0])
        sf_view_open(view, open);
}

static void draw_scene(struct sf_view *view)
{
    sf_ui_text_color(sf_ui_dim, "%s", view->model.path);
    if (view->model.error[0])
        sf_ui_text_wrapped(sf_ui_error, view->model.error);
    choose(view, "method", "method");
    sf_panel_wipe(view);
    if (sf_ui_child_begin("folder", 7 * sf_ui_line()))
        list_folder(view);
    sf_ui_child_end();
    if (view->settings.recent[1] && sf_ui_section("Recent", false))
        list_recent(view);
    if (sf_ui_section("Save and copy", true)) {
        sf_ui_width(-2 * sf_ui_line());
        sf_ui_search("##path", "file", view->save_path, sizeof view->save_path, false);
        sf_ui_same_line(0);
        if (sf_ui_button("save") && view->save_path[0])
            sf_view_save(view, view->save_path);
        sf_ui_tooltip("as a scene: only what differs from the defaults (Ctrl+S)");
        if (sf_ui_button("copy as command line"))
            sf_view_copy_command(view);
        sf_ui_tooltip("the capture of exactly this frame (Ctrl+C)");
    }
}

/* ---- camera ---- */

static void draw_presets(struct sf_view *view)
{
    for (unsigned i = 0; i < SF_RIG_PRESETS; i++) {
        char label[8];

        snprintf(label, sizeof label, "%u", i + 1);
        if (i > 0)
            sf_ui_same_line(0);
        sf_ui_disable(!view->rig.preset_set[i]);
        if (sf_ui_small_button(label) && sf_rig_recall(&view->rig, i))
            sf_view_moved(view);
        sf_ui_enable();
        sf_ui_tooltip("a camera of yours (%u); Ctrl+%u stores this one there", i + 1, i + 1);
    }
}

static void draw_camera(struct sf_view *view)
{
    static const char *const sides[] = {"front", "back", "left", "right", "top", "bottom"};
    float fov = (float)view->rig.fov;

    sf_ui_text("%s", view->rig.own ? "yours" : "the scene's");
    sf_ui_same_line(0);
    sf_ui_disable(!view->rig.own);
    if (sf_ui_small_button("back to the scene's")) {
        sf_rig_release(&view->rig);
        sf_view_moved(view);
    }
    sf_ui_enable();
    sf_ui_text_color(sf_ui_dim, "eye %.3g %.3g %.3g, target %.3g %.3g %.3g", view->rig.eye[0], view->rig.eye[1],
                     view->rig.eye[2], view->rig.target[0], view->rig.target[1], view->rig.target[2]);
    if (sf_ui_slider("field of view", &fov, 5, 120, "%.0f deg", false)) {
        view->rig.fov = (double)fov;
        view->rig.own = true;
        sf_view_moved(view);
    }
    for (unsigned i = 0; i < sizeof sides / sizeof sides[0]; i++) {
        if (i > 0)
            sf_ui_same_line(0);
        if (sf_ui_small_button(sides[i])) {
            sf_rig_side(&view->rig, (enum sf_rig_side)i);
            sf_view_moved(view);
        }
    }
    draw_presets(view);
}

static void draw_lights(struct sf_view *view)
{
    sf_ui_checkbox("handles in the picture (L)", &view->lights_shown);
    sf_ui_tooltip("drag them with the left button; Shift takes a sun to the far side; arrow keys turn the chosen one");
    for (unsigned i = 0; i < view->model.info.lights; i++) {
        char path[SF_NAME_BYTES], label[SF_NAME_BYTES];
        const struct sf_control *type;

        snprintf(path, sizeof path, "lights.%u.type", i);
        type = sf_model_control(&view->model, path);
        snprintf(label, sizeof label, "%u  %s", i, type ? type->choices[(int)type->value[0]] : "");
        if (sf_ui_selectable(label, view->light == i))
            view->light = i;
    }
}

/* ---- the window ---- */

static void draw_window(struct sf_view *view)
{
    struct sf_window_info info;
    float goal = (float)view->governor.goal_ms;
    int mode = 0;

    sf_window_describe(view->window, &info);
    for (int i = 0; info.present_modes[i]; i++)
        mode = strcmp(info.present_modes[i], info.present_mode) == 0 ? i : mode;
    if (sf_ui_choice("present mode", &mode, info.present_modes))
        sf_view_present_mode(view, info.present_modes[mode]);
    choose(view, "output.tone", "tone");
    sf_ui_checkbox("coarser smoke while the camera moves (O)", &view->governor.on);
    if (view->governor.on && sf_ui_slider("picture's time", &goal, 5, 500, "%.0f ms", true))
        view->governor.goal_ms = (double)goal;
    if (sf_ui_button(sf_screen_fullscreen(view->screen) ? "window" : "full screen"))
        sf_screen_set_fullscreen(view->screen, !sf_screen_fullscreen(view->screen));
    sf_ui_tooltip("F11");
    sf_ui_text_color(sf_ui_dim, "%u x %u px, picture %u x %u, %u images", info.width, info.height, view->options.width,
                     view->options.height, info.images);
}

static void draw_pictures(struct sf_view *view)
{
    bool recording = sf_shots_recording(view->shots);

    if (sf_ui_button("screenshot"))
        sf_view_shot(view);
    sf_ui_tooltip("PNG and EXR into %s/ (P)", view->arguments->folder);
    sf_ui_same_line(0);
    if (sf_ui_button(recording ? "stop" : "record"))
        sf_view_record(view);
    sf_ui_tooltip("every frame from here on, each whole, PNG and EXR (R)");
    if (recording) {
        sf_ui_same_line(0);
        sf_ui_text_color(sf_ui_warning, "%u frames", sf_shots_recorded(view->shots));
    }
}

void sf_panel_scene(struct sf_view *view)
{
    if (sf_ui_child_begin("scene", 0)) {
        draw_scene(view);
        if (sf_ui_section("Pictures", true))
            draw_pictures(view);
        if (sf_ui_section("Camera", true))
            draw_camera(view);
        if (sf_ui_section("Lights", true))
            draw_lights(view);
        if (sf_ui_section("Window", true))
            draw_window(view);
    }
    sf_ui_child_end();
}
