/* What keys and panels ask for. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../console.h"
#include "view.h"

void sf_view_note(struct sf_view *view, enum sf_log_level level, const char *format, ...)
{
    char text[SF_NOTE_BYTES];
    va_list args;

    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    if (level <= view->answers.level)
        view->answers.write(view->answers.user, level, text);
}

void sf_view_set(struct sf_view *view, const char *assignment)
{
    sf_model_set(&view->model, assignment);
    view->settle = true;
}

void sf_view_reset(struct sf_view *view, const char *path)
{
    sf_model_reset(&view->model, path);
    view->settle = true;
}

void sf_view_apply(struct sf_view *view, const struct sf_control *control)
{
    char *assignment = sf_control_print(control);

    if (assignment)
        sf_view_set(view, assignment);
    free(assignment);
}

void sf_view_moved(struct sf_view *view)
{
    view->moved = view->dirty = true;
}

void sf_view_stem(const struct sf_view *view, char *stem, size_t room)
{
    const char *path = view->model.path, *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');

    snprintf(stem, room, "%.*s", dot && dot > name ? (int)(dot - name) : (int)strlen(name), name);
}

void sf_view_opened(struct sf_view *view)
{
    char stem[SF_NAME_BYTES], title[SF_NAME_BYTES + 16];
    struct sf_camera_view camera;

    /* The mouse may move the eye before the first picture. */
    sf_scene_view(view->model.scene, view->playback.frame / view->model.info.fps, &camera);
    sf_rig_follow(&view->rig, &camera);
    sf_settings_recent(&view->settings, view->model.path);
    sf_view_stem(view, stem, sizeof stem);
    snprintf(title, sizeof title, "sfumato - %s", stem);
    sf_screen_title(view->screen, title);
    snprintf(view->save_path, sizeof view->save_path, "%s-edited.json", stem);
}

void sf_view_open(struct sf_view *view, const char *path)
{
    bool playing = view->playback.playing;

    if (sf_model_replace(&view->model, path))
        return;
    if (sf_shots_recording(view->shots)) /* its frames are of the scene before */
        sf_view_record(view);
    sf_rig_release(&view->rig);
    sf_playback_init(&view->playback, view->model.info.fps);
    view->playback.playing = playing;
    sf_view_opened(view);
    view->dirty = true;
}

void sf_view_seek(struct sf_view *view, uint32_t frame)
{
    sf_playback_seek(&view->playback, frame);
    view->dirty = true;
}

void sf_view_look(struct sf_view *view, const char *name)
{
    struct sf_looking *looking = &view->looking;

    if (strcmp(looking->name, name) == 0)
        return;
    sf_looking_finish(looking);
    *looking = (struct sf_looking){.automatic = true, .high = 1, .zoom = 1};
    snprintf(looking->name, sizeof looking->name, "%s", name);
    view->dirty = true;
}

void sf_view_shot(struct sf_view *view)
{
    if (sf_shots_recording(view->shots)) {
        sf_view_note(view, SF_LOG_INFO, "no screenshot: every picture is being recorded");
        return;
    }
    view->shot = true;
    view->settle = true;
}

void sf_view_record(struct sf_view *view)
{
    char stem[SF_NAME_BYTES];

    if (sf_shots_recording(view->shots)) {
        sf_view_note(view, SF_LOG_INFO, "recorded %u frames", sf_shots_recorded(view->shots));
        sf_shots_stop(view->shots);
    } else {
        sf_view_stem(view, stem, sizeof stem);
        if (sf_shots_record(view->shots, stem))
            return;
        view->playback.playing = true;
    }
    view->dirty = true;
}

/* The camera as sets; how many. */
static unsigned camera_sets(const struct sf_view *view, char sets[SF_RIG_SETS][SF_RIG_SET_BYTES],
                            const char *pointers[SF_RIG_SETS])
{
    unsigned count = sf_rig_sets(&view->rig, sets);

    for (unsigned i = 0; i < count; i++)
        pointers[i] = sets[i];
    return count;
}

void sf_view_save(struct sf_view *view, const char *path)
{
    char sets[SF_RIG_SETS][SF_RIG_SET_BYTES];
    const char *pointers[SF_RIG_SETS];
    unsigned count = camera_sets(view, sets, pointers);

    /* Over a file that we have not written only when asked twice. */
    if (strcmp(path, view->saved_path) != 0 && access(path, F_OK) == 0) {
        snprintf(view->saved_path, sizeof view->saved_path, "%s", path);
        sf_view_note(view, SF_LOG_WARNING, "%s exists: save again to replace it", path);
        return;
    }
    if (!sf_model_save(&view->model, path, pointers, count)) {
        snprintf(view->saved_path, sizeof view->saved_path, "%s", path);
        sf_view_note(view, SF_LOG_INFO, "wrote %s", path);
    }
}

/* The command with what stands right of the line; as it was when memory is out. */
static char *with_beside(const struct sf_view *view, char *command)
{
    size_t length = strlen(command), room = length + SF_NAME_BYTES + 64;
    char *longer = view->beside[0] ? realloc(command, room) : NULL;

    if (longer) /* names of methods mean nothing to a shell */
        snprintf(longer + length, room - length, " --compare %s --wipe %.9g", view->beside, (double)view->wipe.at);
    return longer ? longer : command;
}

void sf_view_copy_command(struct sf_view *view)
{
    char sets[SF_RIG_SETS][SF_RIG_SET_BYTES];
    const char *pointers[SF_RIG_SETS];
    unsigned count = camera_sets(view, sets, pointers);
    char *command = sf_model_command(&view->model, view->playback.frame, view->options.width, view->options.height,
                                     pointers, count);

    if (!command)
        return;
    command = with_beside(view, command);
    sf_screen_copy(view->screen, command);
    sf_view_note(view, SF_LOG_INFO, "copied: %s", command);
    free(command);
}

void sf_view_present_mode(struct sf_view *view, const char *mode)
{
    struct sf_window_options options = {.present_mode = mode};

    sf_screen_size(view->screen, &options.width, &options.height);
    if (!sf_window_set_options(view->window, &options)) {
        snprintf(view->settings.present_mode, sizeof view->settings.present_mode, "%s", mode);
        snprintf(view->remembered_mode, sizeof view->remembered_mode, "%s", mode);
    }
    view->settle = true;
}
