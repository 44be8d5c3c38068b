/* The time bar, messages in the picture's corner, and the list of keys. */
#include <stdio.h>
#include <string.h>

#include "../console.h"
#include "view.h"

static void draw_buttons(struct sf_view *view)
{
    struct sf_playback *playback = &view->playback;

    if (sf_ui_button("|<"))
        sf_view_seek(view, 0);
    sf_ui_tooltip("from the beginning (Home)");
    sf_ui_same_line(0);
    if (sf_ui_button("<"))
        sf_playback_step(playback, -1);
    sf_ui_tooltip("a frame back (,): simulates anew");
    sf_ui_same_line(0);
    if (sf_ui_button(playback->playing ? "pause##play" : "play##play"))
        sf_playback_toggle(playback);
    sf_ui_tooltip("Space");
    sf_ui_same_line(0);
    if (sf_ui_button(">"))
        sf_playback_step(playback, 1);
    sf_ui_tooltip("a frame on (.)");
    sf_ui_same_line(0);
}

static void draw_numbers(struct sf_view *view)
{
    const struct sf_stats *stats = &view->stats;
    float fps = stats->wall_median > 0 ? 1000 / stats->wall_median : 0;

    if (view->seek_total > 0) {
        char text[64];

        snprintf(text, sizeof text, "simulating %llu of %llu steps", (unsigned long long)view->seek_done,
                 (unsigned long long)view->seek_total);
        sf_ui_progress((float)view->seek_done / (float)view->seek_total, text);
        return;
    }
    sf_ui_text("%.2f s", view->playback.frame / view->model.info.fps);
    sf_ui_same_line(0);
    if (view->playback.speed != 1) {
        sf_ui_text_color(sf_ui_accent, "x%.4g", view->playback.speed);
        sf_ui_same_line(0);
    }
    if (view->playback.playing && fps > 0)
        sf_ui_text_color(sf_ui_dim, "%u particles  %.0f fps", view->live, (double)fps);
    else
        sf_ui_text_color(sf_ui_dim, "%u particles  %.1f ms", view->live, (double)stats->gpu_median);
    sf_ui_tooltip("live particles (%u births refused by the capacity), pictures a second, the device's time for one",
                  view->dropped);
    if (view->progress < 1) {
        sf_ui_same_line(0);
        sf_ui_text_color(sf_ui_accent, "%.0f %%", (double)(100 * view->progress));
        sf_ui_tooltip("of the picture's samples");
    }
    if (view->governor.level > 0) {
        sf_ui_same_line(0);
        sf_ui_text_color(sf_ui_accent, "coarse");
    }
}

void sf_panel_bar(struct sf_view *view, float x, float y, float width, float height)
{
    struct sf_playback *playback = &view->playback;
    int frame = (int)playback->frame;

    if (sf_ui_panel_begin("bar", x, y, width, height, SF_UI_FIXED | SF_UI_UNTITLED | SF_UI_SOLID, NULL)) {
        draw_buttons(view);
        sf_ui_width(width * 0.38f);
        if (sf_ui_slider_int("##frame", &frame, 0, (int)playback->longest, false))
            sf_view_seek(view, (uint32_t)frame);
        sf_ui_tooltip("frame; the simulation goes there, from its beginning when it lies behind");
        sf_ui_same_line(0);
        draw_numbers(view);
    }
    sf_ui_panel_end();
}

/* ---- messages ---- */

static bool faded(const struct sf_note *note, uint64_t now)
{
    static const double seconds[] = {[SF_LOG_ERROR] = 20, [SF_LOG_WARNING] = 10, [SF_LOG_INFO] = 4};

    return (double)(now - note->born_ns) * 1e-9 > seconds[note->level];
}

/* Copies those that still stand, and forgets the others. */
static unsigned standing(struct sf_view *view, struct sf_note notes[SF_NOTES])
{
    uint64_t now = sf_now_ns();
    unsigned count = 0;

    pthread_mutex_lock(&view->notes_lock);
    for (unsigned i = 0; i < view->note_count; i++)
        if (!faded(&view->notes[i], now))
            view->notes[count++] = view->notes[i];
    view->note_count = count;
    memcpy(notes, view->notes, count * sizeof *notes);
    pthread_mutex_unlock(&view->notes_lock);
    return count;
}

void sf_panel_notes(struct sf_view *view)
{
    static const uint32_t *const colors[] = {
        [SF_LOG_ERROR] = &sf_ui_error, [SF_LOG_WARNING] = &sf_ui_warning, [SF_LOG_INFO] = &sf_ui_plain};
    const char *broken = view->reload ? sf_reload_errors(view->reload) : "";
    struct sf_note notes[SF_NOTES];
    unsigned count = standing(view, notes);
    float margin = 10 * sf_ui_scale(), width = view->picture[2] - 2 * margin;

    if (!view->panels || (count == 0 && !broken[0] && !view->model.error[0]) || width < 20 * margin)
        return;
    if (sf_ui_panel_begin("notes", view->picture[0] + margin, view->picture[1] + margin, width, 0,
                          SF_UI_FIXED | SF_UI_UNTITLED | SF_UI_QUIET, NULL)) {
        if (view->model.error[0]) {
            sf_ui_text_wrapped(sf_ui_error, view->model.error);
            sf_ui_text_wrapped(sf_ui_dim, "the scene goes on as it was; it is read again when the file changes");
        }
        if (broken[0])
            sf_ui_text_wrapped(sf_ui_error, broken);
        for (unsigned i = 0; i < count; i++)
            if (strncmp(notes[i].text, view->model.error, SF_NOTE_BYTES - 1) != 0) /* else it stands there already */
                sf_ui_text_wrapped(*colors[notes[i].level], notes[i].text);
    }
    sf_ui_panel_end();
}

/* ---- keys ---- */

void sf_panel_keys(struct sf_view *view)
{
    static const struct {
        const char *keys, *what;
    } lines[] = {
        {"left drag", "orbit"},
        {"middle drag, Shift+left", "pan"},
        {"wheel", "nearer, further"},
        {"right drag", "look; with W A S D Q E fly, Shift faster"},
        {"F", "frame the smoke"},
        {"C", "the scene's camera"},
        {"1 to 9, Ctrl+1 to 9", "camera: recall, store"},
        {"Shift+1 to 6", "front, back, left, right, top, bottom"},
        {NULL, NULL},
        {"Space", "play, pause"},
        {". and ,", "a frame on, a frame back"},
        {"Home", "from the beginning"},
        {"[ and ]", "slower, faster"},
        {NULL, NULL},
        {"M, Shift+M", "a second method beside this one, the next"},
        {"Shift+left, right", "its line; or drag it"},
        {NULL, NULL},
        {"L", "lights' handles, the next light, none"},
        {"arrow keys", "turn the chosen light"},
        {"O", "coarser smoke while the camera moves"},
        {NULL, NULL},
        {"P", "screenshot, PNG and EXR"},
        {"R", "record a sequence"},
        {"Ctrl+C, Ctrl+S", "copy as command line, save as scene"},
        {"Ctrl+Z", "all parameters as in the file"},
        {"Ctrl+F, /", "search the parameters"},
        {"T", "compare with the reference now"},
        {"Tab, F2 to F7", "panels away and back, their tabs"},
        {"F11", "full screen"},
        {"?, Esc, Ctrl+Q", "this list, back, close"},
    };

    if (!view->keys_shown || !sf_ui_box_begin("Keys", &view->keys_shown))
        return;
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        if (!lines[i].keys) {
            sf_ui_space(sf_ui_line() * 0.4f);
            continue;
        }
        sf_ui_text_color(sf_ui_accent, "%s", lines[i].keys);
        sf_ui_same_line(12 * sf_ui_line());
        sf_ui_text("%s", lines[i].what);
    }
    sf_ui_box_end();
}
