/* The viewer's loop. One turn: what happened (events, files), time, panels, input, picture, window. A change made in a turn
 * is in the picture of that turn; when nothing changes the loop sleeps until something does. */
#include "view.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../console.h"
#include "../files.h"
#include "../session.h"
#include "graph_data.h"

static const double WATCH_S = 0.25;     /* how long it sleeps at most, so that edited files are seen */
static const double COMPUTING_S = 0.1;  /* while the reference is, so that its progress is */
static const double MINIMISED_S = 0.5;  /* and while there is nothing to see */
static const uint32_t SIDE_LEAST = 160; /* px of picture beside the panel, or there is no panel */
enum { BARE_PIXELS = 240, TURNS_AWAKE = 3 };

/* ---- messages ---- */

/* Into the picture's corner. Any thread. */
static void add_note(struct sf_view *view, enum sf_log_level level, const char *message)
{
    struct sf_note *note;

    pthread_mutex_lock(&view->notes_lock);
    if (view->note_count == SF_NOTES)
        memmove(&view->notes[0], &view->notes[1], --view->note_count * sizeof view->notes[0]);
    note = &view->notes[view->note_count++];
    note->level = level;
    note->born_ns = sf_now_ns();
    snprintf(note->text, sizeof note->text, "%s", message);
    pthread_mutex_unlock(&view->notes_lock);
}

/* The library's words: what is wrong stands in the picture too. */
static void write_log(void *user, enum sf_log_level level, const char *message)
{
    const struct sf_log *console = sf_console_log();

    console->write(console->user, level, message);
    if (level <= SF_LOG_WARNING)
        add_note(user, level, message);
}

/* Answers to what the person did: they stand there as well. */
static void write_answer(void *user, enum sf_log_level level, const char *message)
{
    const struct sf_log *console = sf_console_log();

    console->write(console->user, level, message);
    if (level <= SF_LOG_INFO)
        add_note(user, level, message);
}

/* ---- places ---- */

static float panel_width(const struct sf_view *view, uint32_t width, uint32_t height)
{
    float panel = view->settings.panel_width * sf_ui_scale();

    if (!view->panels || (float)width < panel + (float)SIDE_LEAST || height < BARE_PIXELS)
        return 0;
    return panel;
}

static float bar_height(const struct sf_view *view, uint32_t width, uint32_t height)
{
    return panel_width(view, width, height) > 0 ? 1.55f * sf_ui_line() : 0;
}

static void place(struct sf_view *view, uint32_t width, uint32_t height)
{
    view->picture[0] = view->picture[1] = 0;
    view->picture[2] = (float)(uint32_t)((float)width - panel_width(view, width, height));
    view->picture[3] = (float)(uint32_t)((float)height - bar_height(view, width, height));
}

/* ---- panels ---- */

static void draw_tabs(struct sf_view *view)
{
    static const struct {
        const char *name;
        void (*draw)(struct sf_view *view);
    } tabs[SF_TABS] = {{"Parameters", sf_panel_parameters}, {"Scene", sf_panel_scene}, {"Images", sf_panel_look},
                       {"Graph", sf_panel_graph},           {"Times", sf_panel_times}, {"Truth", sf_panel_truth}};

    if (!sf_ui_tabs_begin("tabs"))
        return;
    for (int i = 0; i < SF_TABS; i++) {
        if (i == view->tab)
            sf_ui_tab_choose(tabs[i].name);
        if (!sf_ui_tab_begin(tabs[i].name))
            continue;
        tabs[i].draw(view);
        sf_ui_tab_end();
    }
    view->tab = -1;
    sf_ui_tabs_end();
}

static void draw_panels(struct sf_view *view, uint32_t width, uint32_t height)
{
    float side = panel_width(view, width, height), bar = bar_height(view, width, height);

    view->against.open = false;
    if (side > 0) {
        if (sf_ui_panel_begin("side", (float)width - side, 0, side, (float)height,
                              SF_UI_FIXED | SF_UI_UNTITLED | SF_UI_SOLID, NULL))
            draw_tabs(view);
        sf_ui_panel_end();
        sf_panel_bar(view, 0, (float)height - bar, (float)width - side, bar);
    }
    sf_input_draw_lights(view);
    sf_wipe_draw(view);
    sf_panel_looked(view);
    sf_panel_truth_over(view);
    sf_panel_notes(view);
    sf_panel_keys(view);
}

/* ---- one turn ---- */

static void watch_files(struct sf_view *view)
{
    bool renewed = false, compiled = false;

    sf_model_watch(&view->model, &renewed);
    if (view->reload)
        sf_reload_poll(view->reload, sf_now_ns(), &compiled);
    view->dirty = view->dirty || compiled;
    view->content += compiled;
    view->settle = view->settle || renewed || compiled;
}

/* Whole frames pass one by one while they are recorded; else by the clock. */
static void pass_time(struct sf_view *view)
{
    uint64_t now = sf_now_ns();

    if (view->seek_total > 0) {
        view->playback.last_ns = now;
        return;
    }
    if (sf_shots_recording(view->shots) && view->playback.playing) {
        view->playback.last_ns = now;
        if (!view->dirty && view->progress >= 1 && view->playback.frame == view->drawn_frame)
            sf_playback_seek(&view->playback, view->playback.frame + 1);
    } else {
        sf_playback_tick(&view->playback, now);
    }
}

static enum sf_status show(struct sf_view *view, const struct sf_overlay *overlay)
{
    struct sf_window_frame frame = {.x = view->picture[0],
                                    .y = view->picture[1],
                                    .width = view->picture[2],
                                    .height = view->picture[3],
                                    .background = {0.08f, 0.08f, 0.08f},
                                    .renderer = view->renderer,
                                    .tone = view->model.info.tone,
                                    .exposure = view->model.info.exposure,
                                    .wipe = view->wipe.at,
                                    .overlay = overlay};
    enum sf_status status;

    frame.pixels = sf_looking_pixels(sf_view_looked(view), (uint32_t)view->picture[2], (uint32_t)view->picture[3],
                                     &frame.pixels_width, &frame.pixels_height);
    status = sf_window_show(view->window, &frame);
    view->counted.shown++;
    if (view->counted.pictures > 0 && !view->counted.said) {
        view->counted.said = true;
        sf_console_say(SF_LOG_INFO, "the first picture after %.2f s",
                       (double)(sf_now_ns() - view->counted.begin_ns) * 1e-9);
    }
    if (view->input_ns) {
        double ms = (double)(sf_now_ns() - view->input_ns) * 1e-6;

        view->counted.inputs++;
        view->counted.input_ms_sum += ms;
        view->counted.input_ms_most = ms > view->counted.input_ms_most ? ms : view->counted.input_ms_most;
        view->input_ns = 0;
    }
    return status;
}

/* How long the loop may sleep. */
static double rest(const struct sf_view *view, unsigned awake, bool minimised)
{
    double due = sf_playback_due(&view->playback, sf_now_ns()), ui = sf_ui_due(), most = WATCH_S;

    if (minimised)
        return MINIMISED_S;
    due = ui < due ? ui : due;
    if (awake > 0 || view->dirty || view->settle || view->shot || view->progress < 1 || view->seek_total > 0 ||
        view->hold == SF_HOLD_LOOK || sf_against_due(view) || sf_picture_pending(view) || view->governor.level > 0)
        return 0;
    if (sf_against_busy(view))
        most = COMPUTING_S;
    return due < most ? due : most;
}

static enum sf_status draw_turn(struct sf_view *view, double seconds)
{
    struct sf_window_options options = {.present_mode = view->settings.present_mode};
    struct sf_key keys[SF_KEYS_MAX];
    unsigned key_count = sf_screen_keys(view->screen, keys);
    struct sf_overlay overlay;
    bool drawn = false;
    enum sf_status status;

    sf_screen_size(view->screen, &options.width, &options.height);
    status = sf_window_set_options(view->window, &options);
    if (status)
        return status;
    place(view, options.width, options.height);
    pass_time(view);
    view->settle = false;
    sf_input_feed(view, keys, key_count, true);
    sf_ui_begin(view->ui);
    draw_panels(view, options.width, options.height);
    sf_input_take(view, seconds);
    sf_ui_end(view->ui, &overlay);
    sf_input_feed(view, keys, key_count, false);
    sf_against_update(view); /* what was changed in this turn is not shown as compared */
    status = sf_picture_update(view, &drawn);
    if (!status)
        status = show(view, &overlay);
    /* While pictures follow each other two are on their way; the last one is waited for. */
    if (!status)
        status = sf_picture_collect(view, drawn ? SF_FLIGHT - 1 : 0);
    if (!drawn)
        view->landed_ns = 0;
    return status;
}

static bool finished(const struct sf_view *view)
{
    uint32_t last = view->arguments->exit_after;

    return view->closing || sf_screen_closed(view->screen) || sf_interrupted() ||
           (last > 0 && view->counted.shown >= last);
}

static enum sf_status loop(struct sf_view *view)
{
    uint64_t before = sf_now_ns();
    unsigned awake = TURNS_AWAKE;
    bool minimised = false;
    enum sf_status status = SF_OK;

    while (!status && !finished(view)) {
        uint64_t now;
        uint32_t width, height;

        if (sf_screen_poll(view->screen, rest(view, awake, minimised)))
            awake = TURNS_AWAKE; /* hovering and opening take a turn or two to settle */
        view->counted.loops++;
        sf_screen_size(view->screen, &width, &height);
        minimised = width == 0;
        now = sf_now_ns();
        watch_files(view);
        sf_against_update(view);
        if (minimised) {
            view->playback.last_ns = now;
            continue;
        }
        /* Messages fade while nothing else happens. */
        if (awake > 0 || view->note_count > 0 || rest(view, 0, false) <= 0)
            status = draw_turn(view, (double)(now - before) * 1e-9);
        awake -= awake > 0;
        before = now;
    }
    return status;
}

/* ---- beginning and end ---- */

/* Named, or the plume beside us, or the last one that was looked at. */
static const char *first_scene(const struct sf_view *view)
{
    static const char plume[] = "scenes/plume.json";

    if (view->arguments->files.count > 0)
        return view->arguments->files.items[0];
    if (access(plume, R_OK) == 0)
        return plume;
    return view->settings.recent[0];
}

static enum sf_status open_scene(struct sf_view *view)
{
    const struct sf_arguments *arguments = view->arguments;
    const char *path = first_scene(view);
    char **sets;
    uint32_t count;
    enum sf_status status;

    if (!path)
        return sf_console_fail(SF_ERROR_USAGE, "no scene to look at: name one, as in 'sfumato view scenes/plume.json'");
    status = sf_session_sets(arguments, &sets, &count);
    if (status)
        return status;
    view->model.log = &view->log;
    view->model.accept = sf_picture_accept;
    view->model.user = view;
    status = sf_model_open(&view->model, path, (const char *const *)sets, count);
    sf_session_sets_finish(sets, count);
    return status;
}

static void take_settings(struct sf_view *view)
{
    const struct sf_arguments *arguments = view->arguments;
    struct sf_settings *settings = &view->settings;

    sf_settings_load(settings);
    snprintf(view->remembered_mode, sizeof view->remembered_mode, "%s", settings->present_mode);
    if (arguments->size.width > 0) {
        settings->width = arguments->size.width;
        settings->height = arguments->size.height;
    }
    if (arguments->present_mode)
        snprintf(settings->present_mode, sizeof settings->present_mode, "%s", arguments->present_mode);
    view->panels = settings->panel && !arguments->bare;
    view->governor.on = settings->adapt && !arguments->no_adapt;
    view->governor.goal_ms = arguments->goal.given ? arguments->goal.value : (double)settings->goal_ms;
    memcpy(view->rig.presets, settings->presets, sizeof view->rig.presets);
    memcpy(view->rig.preset_set, settings->preset_set, sizeof view->rig.preset_set);
}

static void keep_settings(struct sf_view *view)
{
    struct sf_settings *settings = &view->settings;
    bool fullscreen = sf_screen_fullscreen(view->screen);
    uint32_t width, height;

    if (!fullscreen || !view->arguments->fullscreen)
        settings->fullscreen = fullscreen;
    sf_screen_size(view->screen, &width, &height);
    if (!fullscreen && width > 0) {
        float scale = sf_screen_scale(view->screen);

        settings->width = (uint32_t)((float)width / scale);
        settings->height = (uint32_t)((float)height / scale);
    }
    if (!view->arguments->bare)
        settings->panel = view->panels;
    if (!view->arguments->no_adapt)
        settings->adapt = view->governor.on;
    if (!view->arguments->goal.given)
        settings->goal_ms = (float)view->governor.goal_ms;
    snprintf(settings->present_mode, sizeof settings->present_mode, "%s", view->remembered_mode);
    memcpy(settings->presets, view->rig.presets, sizeof view->rig.presets);
    memcpy(settings->preset_set, view->rig.preset_set, sizeof view->rig.preset_set);
    sf_settings_save(settings);
}

static enum sf_status open_window(struct sf_view *view)
{
    struct sf_window_options options = {.present_mode = view->settings.present_mode};
    const uint8_t *coverage;
    uint32_t width, height;
    enum sf_status status;

    sf_screen_size(view->screen, &options.width, &options.height);
    status = sf_window_create(view->device, &options, &view->log, &view->window);
    if (status == SF_ERROR_USAGE && !view->arguments->present_mode) { /* remembered from another screen */
        snprintf(view->settings.present_mode, sizeof view->settings.present_mode, "fifo");
        status = sf_window_create(view->device, &options, &view->log, &view->window);
    }
    if (!status)
        status = sf_ui_create(sf_screen_window(view->screen), sf_screen_scale(view->screen), &view->ui);
    if (status)
        return status;
    sf_ui_font(view->ui, &coverage, &width, &height);
    return sf_window_set_font(view->window, coverage, width, height);
}

static enum sf_status open_all(struct sf_view *view)
{
    const struct sf_arguments *arguments = view->arguments;
    uint32_t width, height;
    enum sf_status status = open_scene(view);

    if (!status)
        status = sf_wipe_open(view);
    if (!status)
        status = sf_screen_create("sfumato", view->settings.width, view->settings.height,
                                  arguments->fullscreen || view->settings.fullscreen, &view->log, &view->screen);
    if (!status)
        status = sf_session_device(arguments, sf_screen_surface(view->screen), &view->device);
    if (!status)
        status = open_window(view);
    if (!status)
        status = sf_shots_create(arguments->folder, &view->answers, &view->shots);
    if (!status)
        status = sf_reload_create(arguments->shaders, view->device, &view->log, &view->reload);
    if (status)
        return status;
    sf_screen_size(view->screen, &width, &height);
    place(view, width > 0 ? width : view->settings.width, height > 0 ? height : view->settings.height);
    sf_view_look(view, arguments->inspect ? arguments->inspect : "");
    view->looking.zoom = 1;
    view->against.heat = (struct sf_looking){.heat = true, .automatic = true, .zoom = 1};
    view->against.stride = 2;
    view->against.pixel[0] = UINT32_MAX; /* none yet */
    view->handle = view->tab = -1;
    sf_playback_init(&view->playback, view->model.info.fps);
    sf_playback_seek(&view->playback, arguments->first_frame);
    view->playback.playing = !arguments->paused;
    status = sf_picture_open(view);
    if (!status)
        sf_view_opened(view);
    return status;
}

static long resident_kib(void)
{
    FILE *file = fopen("/proc/self/statm", "r");
    long pages = 0;

    if (!file)
        return 0;
    if (fscanf(file, "%*s %ld", &pages) != 1)
        pages = 0;
    fclose(file);
    return pages * (sysconf(_SC_PAGESIZE) / 1024);
}

/* For scripts that drive the window: what it did, and what it holds at its end. */
static enum sf_status write_report(const struct sf_view *view)
{
    const struct sf_view_count *counted = &view->counted;
    struct sf_window_info window;
    uint64_t used, budget;
    char text[1024];
    int length;

    sf_window_describe(view->window, &window);
    sf_device_memory(view->device, &used, &budget);
    length = snprintf(text, sizeof text,
                      "{\"pictures\": %" PRIu64 ", \"shown\": %" PRIu64 ", \"loops\": %" PRIu64
                      ", \"seconds\": %.3f, \"frame\": %u, \"live\": %u, \"width\": %u, \"height\": %u, "
                      "\"present_mode\": \"%s\", \"remade\": %" PRIu64 ", \"inputs\": %" PRIu64
                      ", \"input_ms_mean\": %.3f, \"input_ms_most\": %.3f, \"gpu_ms\": %.3f, \"cpu_ms\": %.3f, "
                      "\"device_bytes\": %" PRIu64 ", \"resident_kib\": %ld}\n",
                      counted->pictures, counted->shown, counted->loops,
                      (double)(sf_now_ns() - counted->begin_ns) * 1e-9, view->drawn_frame, view->live, window.width,
                      window.height, window.present_mode, window.remade, counted->inputs,
                      counted->inputs ? counted->input_ms_sum / (double)counted->inputs : 0, counted->input_ms_most,
                      (double)view->stats.gpu_median, (double)view->stats.cpu_median, used, resident_kib());
    return sf_report_write(view->arguments->json_file, text, (size_t)length);
}

static void close_all(struct sf_view *view)
{
    sf_against_finish(view);
    sf_graph_data_destroy(&view->graph);
    sf_looking_finish(&view->looking);
    free(view->joined);
    sf_shots_destroy(&view->shots);
    sf_reload_destroy(&view->reload);
    sf_picture_close(view);
    sf_ui_destroy(&view->ui);
    sf_window_destroy(&view->window);
    sf_device_destroy(&view->device);
    sf_screen_destroy(&view->screen);
    sf_model_finish(&view->model);
    sf_settings_finish(&view->settings);
    pthread_mutex_destroy(&view->notes_lock);
}

enum sf_status sf_view_run(const struct sf_arguments *arguments)
{
    struct sf_view *view = calloc(1, sizeof *view);
    unsigned errors;
    enum sf_status status;

    if (!view || pthread_mutex_init(&view->notes_lock, NULL) != 0) {
        free(view);
        return sf_console_fail(SF_ERROR_MEMORY, "out of memory");
    }
    view->arguments = arguments;
    view->log = (struct sf_log){.write = write_log, .user = view, .level = sf_console_log()->level};
    if (view->log.level < SF_LOG_WARNING)
        view->log.level = SF_LOG_WARNING;
    view->answers = (struct sf_log){.write = write_answer, .user = view, .level = SF_LOG_INFO};
    if (view->log.level > view->answers.level)
        view->answers.level = view->log.level;
    view->counted.begin_ns = sf_now_ns();
    take_settings(view);
    status = open_all(view);
    if (!status) {
        status = loop(view);
        keep_settings(view);
    }
    if (!status && arguments->json_file)
        status = write_report(view);
    if (!status)
        status = sf_session_validated(arguments, view->device);
    if (!status && sf_interrupted())
        status = SF_ERROR_INTERRUPTED;
    errors = sf_console_errors();
    close_all(view);
    free(view);
    /* Objects that were left behind are found when the device goes. */
    if ((!status || status == SF_ERROR_INTERRUPTED) && arguments->validate && sf_console_errors() > errors)
        status = SF_ERROR_INTERNAL;
    return status;
}
