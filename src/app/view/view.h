/* The viewer's state, and what its files ask of each other. view.c owns the loop: input, time, panels, picture, window.
 * Panels read the state and change it through the functions below, which mark what must be drawn again. */
#ifndef SF_APP_VIEW_VIEW_H
#define SF_APP_VIEW_VIEW_H

#include <pthread.h>

#include "../options.h"
#include "comparison.h"
#include "governor.h"
#include "lights.h"
#include "model.h"
#include "playback.h"
#include "reload.h"
#include "rig.h"
#include "screen.h"
#include "settings.h"
#include "shots.h"
#include "stats.h"
#include "ui.h"

enum { SF_TABS = 6, SF_NOTES = 6, SF_NOTE_BYTES = 512, SF_NAME_BYTES = 64, SF_FLIGHT = 2 };

/* A message that stays in the picture's corner for a while: errors until they are clicked away. */
struct sf_note {
    enum sf_log_level level;
    uint64_t born_ns;
    char text[SF_NOTE_BYTES];
};

/* A picture that was queued. */
struct sf_flight {
    uint64_t ticket;
    float cpu_ms;    /* to record and submit it */
    float record_ms; /* of that: recording its passes */
};

/* The image of the graph that is looked at in place of the picture. */
struct sf_looking {
    char name[SF_NAME_BYTES]; /* "": the picture itself */
    float *values; /* [height][width][channels], a copy of the last frame's; NULL until it comes, or a buffer */
    uint32_t width, height, channels;
    uint32_t *words; /* of a buffer */
    uint32_t word_count;
    uint64_t version; /* counts copies */
    bool automatic;   /* the range follows the values */
    bool logarithmic;
    bool heat;                /* one channel of signed differences, coloured by heat.h; low is -high */
    int channel;              /* 0: all as colours; 1..4: that one as grey */
    float low, high;          /* the range that becomes 0..1; of the widest channel while it is automatic */
    float ranges[3][2];       /* automatic: of the channels shown; */
    uint64_t ranged;          /* and hash of what they were found from */
    uint8_t *pixels;          /* mapped, RGBA */
    uint64_t mapped;          /* hash of what pixels were mapped from */
    float zoom, pan_x, pan_y; /* 1: fits the picture's place; pan in px */
};

/* A second method beside the scene's, right of a line. */
struct sf_wipe {
    bool on;                    /* wanted; sf_view.beside is what there is */
    char method[SF_NAME_BYTES]; /* "": none was chosen yet */
    float at;                   /* of the picture's width: the line */
    float ms[2];                /* the device's time for the last picture of each, without the simulation; 0: unknown */
};

/* What a picture follows from. */
struct sf_subject {
    uint64_t content; /* sf_view.content */
    uint32_t frame, width, height;
    struct sf_camera_view eye;
};

/* Of sf_against.kind: enum sf_difference, and this. */
enum { SF_AGAINST_PICTURE = 2 };

/* What is known of the method's way along the probed ray. */
enum sf_way { SF_WAY_AWAITED, SF_WAY_KNOWN, SF_WAY_NONE /* it keeps nothing of it */ };

/* The frame held against the reference. */
struct sf_against {
    struct sf_comparison *comparison; /* NULL: none */
    struct sf_subject subject;        /* that it is of */
    bool wanted;                      /* one is to begin with the next picture, */
    bool gone;                        /* once this one, of which nothing is shown any more, has stopped */
    bool outdated;                    /* the last one went because something changed */
    uint64_t seen;                    /* its version */
    bool mapped;                      /* it was done, and has been shown */
    struct sf_looking heat;           /* shown in the picture's place while the tab is open and it has values */
    int stride, kind;                 /* choices: log2; enum sf_difference or SF_AGAINST_PICTURE */
    bool open;                        /* the tab */
    bool probe_wanted, pinned;
    uint32_t pixel[2]; /* of the frame: probed */
    enum sf_way way;
    struct sf_probe_point *curve; /* [curve_count] the method's along the ray of pixel curve_at, when it is known */
    uint32_t curve_count, curve_at[2];
    bool pressed; /* the mouse, in the picture, at */
    float pressed_at[2];
};

/* What the mouse, pressed in the picture, is doing. */
enum sf_hold { SF_HOLD_NONE, SF_HOLD_ORBIT, SF_HOLD_PAN, SF_HOLD_LOOK, SF_HOLD_LIGHT, SF_HOLD_LOOKED, SF_HOLD_WIPE };

/* For --report. */
struct sf_view_count {
    uint64_t begin_ns;
    uint64_t loops, pictures, shown; /* shown: windows presented */
    bool said;                       /* how long the first picture took */
    uint64_t inputs;                 /* answered by a picture */
    double input_ms_sum, input_ms_most;
};

struct sf_view {
    const struct sf_arguments *arguments;
    struct sf_log log;              /* to the console; warnings and errors into notes */
    struct sf_log answers;          /* the same, information into notes as well */
    pthread_mutex_t notes_lock;     /* the log may be written to by any thread */
    struct sf_note notes[SF_NOTES]; /* newest last */
    unsigned note_count;

    struct sf_settings settings;
    char remembered_mode[16]; /* present mode for next time: not one that the command line named */
    struct sf_screen *screen;
    struct sf_ui *ui;
    struct sf_device *device;
    struct sf_window *window;
    struct sf_model model;
    struct sf_renderer *renderer;
    struct sf_renderer_options options; /* as the renderer has them, but for `inspect` */
    char inspected[SF_NAME_BYTES];      /* that */
    uint32_t refused[2];                /* a size that could not be had */
    struct sf_scene *coarse;            /* model's with coarser smoke, while governor.level is above 0 */
    struct sf_rig rig;
    struct sf_playback playback;
    struct sf_governor governor;
    struct sf_reload *reload; /* NULL: no sources, no compiler */
    struct sf_shots *shots;
    struct sf_stats stats;

    struct sf_flight flights[SF_FLIGHT];
    unsigned flight_count;
    uint64_t landed_ns; /* when the last one was done; 0: pause */
    uint32_t live, dropped;
    float progress; /* of the picture drawn last; below 1: it is drawn on */
    float bounds_min[3], bounds_max[3];
    uint32_t drawn_frame;           /* of the newest picture */
    uint64_t seek_done, seek_total; /* steps on a long way; total 0: none */

    float picture[4]; /* px: x, y, width, height of the picture's place in the window */
    bool panels, keys_shown, lights_shown;
    bool dirty;  /* the picture must be drawn again */
    bool settle; /* the window must be drawn again, though the picture stays */
    bool closing;
    bool shot;      /* a screenshot is wanted */
    bool shooting;  /* and its picture is being drawn */
    bool comparing; /* the picture that is to be compared is being drawn */
    struct sf_looking looking;
    struct sf_against against;
    struct sf_wipe wipe;
    char beside[SF_NAME_BYTES];      /* the second method that the renderer has; "": none */
    void *joined;                    /* memory for pictures of both */
    struct sf_graph_data *graph;     /* graph_data.h; read off at graph->version; sf_graph_data_destroy at the end */
    char look_search[SF_NAME_BYTES]; /* in the graph's resources */
    int words_as;                    /* of a buffer: 0 what is likely, 1 float, 2 uint, 3 hex */
    enum sf_hold hold;
    int handle;      /* light's handle that is held, or -1 */
    bool handle_far; /* it was on the far side when it was taken */
    unsigned light;  /* selected by keys */
    bool moved;      /* the camera, since the last picture */
    struct sf_view_count counted;
    char search[SF_NAME_BYTES]; /* in the parameters */
    bool focus_search;
    int tab;         /* of the side panel, to be opened now; -1: none */
    bool said_place; /* where the first control found stands, for scripts that drive the mouse */
    char save_path[512];
    char saved_path[512];   /* that may be replaced without asking */
    uint64_t graph_version; /* counts remade graphs: what was read off the old one is stale */
    uint64_t content;       /* counts changes of scene and shaders */
    uint64_t input_ns;      /* when the input that this picture answers came; 0: none */
};

enum sf_status sf_view_run(const struct sf_arguments *arguments);

/* ---- input.c: keys and the mouse in the picture, after the panels have been drawn ---- */
void sf_input_take(struct sf_view *view, double seconds);
/* Shows the panels keys that may have been let go already; after the frame, how they are now. */
void sf_input_feed(const struct sf_view *view, const struct sf_key *keys, unsigned count, bool pressed);
/* Lights' handles over the picture. */
void sf_input_draw_lights(struct sf_view *view);

/* ---- picture.c: the renderer, and what comes back of it ---- */
enum sf_status sf_picture_open(struct sf_view *view);
void sf_picture_close(struct sf_view *view);
/* The model's accept. */
enum sf_status sf_picture_accept(void *user, const struct sf_scene *scene);
/* Brings the renderer to what the view asks for (size, looked-at image, coarseness) and draws a picture when one is due.
 * *drawn: it was queued. Not OK: the device is lost, or a defect. */
enum sf_status sf_picture_update(struct sf_view *view, bool *drawn);
/* Takes up pictures that are done: all but `left` of them are waited for. */
enum sf_status sf_picture_collect(struct sf_view *view, unsigned left);
/* Something of the picture is still on its way. */
bool sf_picture_pending(const struct sf_view *view);

/* ---- against.c: the comparison with the reference ---- */
void sf_against_begin(struct sf_view *view); /* of the picture as it stands; pauses */
void sf_against_stop(struct sf_view *view);  /* and shows the picture again */
/* A picture with the smoke alone and the particles is wanted, for take. */
bool sf_against_due(const struct sf_view *view);
void sf_against_take(struct sf_view *view, const struct sf_frame *frame);
/* Every turn: stops what no longer holds, shows what has come. */
void sf_against_update(struct sf_view *view);
void sf_against_show(struct sf_view *view);  /* after `kind` has changed */
void sf_against_probe(struct sf_view *view); /* both rays of `pixel`: the method's come with a picture */
/* For pictures: whether the method's samples are to come back with them, of which pixel, and taking them. */
bool sf_against_probes(const struct sf_view *view);
void sf_against_aim(struct sf_view *view);
void sf_against_land(struct sf_view *view, const struct sf_frame *frame);
bool sf_against_busy(const struct sf_view *view);
void sf_against_finish(struct sf_view *view);

/* ---- wipe.c: two methods side by side ---- */
enum sf_status sf_wipe_open(struct sf_view *view); /* what the command line says; the model is there */
void sf_wipe_toggle(struct sf_view *view);
void sf_wipe_next(struct sf_view *view); /* another second method; the first time the one behind the scene's */
void sf_wipe_choose(struct sf_view *view, const char *method);
void sf_wipe_give_up(struct sf_view *view);                      /* it cannot be; why has been said */
bool sf_wipe_seen(const struct sf_view *view);                   /* the line is in the picture */
bool sf_wipe_near(const struct sf_view *view, float x, float y); /* px of the window: the mouse can take it */
void sf_wipe_drag(struct sf_view *view, float x);
void sf_wipe_key(struct sf_view *view, bool right);
void sf_wipe_draw(struct sf_view *view);
void sf_panel_wipe(struct sf_view *view); /* in the Scene tab */

/* ---- actions (actions.c); failures have been said through the log ---- */
void sf_view_set(struct sf_view *view, const char *assignment);
void sf_view_apply(struct sf_view *view, const struct sf_control *control); /* a copy with another value */
void sf_view_moved(struct sf_view *view);                                   /* the person has moved the camera */
void sf_view_reset(struct sf_view *view, const char *path);                 /* NULL: everything */
void sf_view_open(struct sf_view *view, const char *path);
void sf_view_seek(struct sf_view *view, uint32_t frame);
void sf_view_look(struct sf_view *view, const char *name); /* an image or buffer of the graph; "": the picture */
void sf_view_shot(struct sf_view *view);
void sf_view_record(struct sf_view *view); /* begins or ends */
void sf_view_save(struct sf_view *view, const char *path);
void sf_view_copy_command(struct sf_view *view); /* to the clipboard */
void sf_view_present_mode(struct sf_view *view, const char *mode);
/* After another scene is in place: title, recent list. */
void sf_view_opened(struct sf_view *view);
/* Its name without folder and ending. */
void sf_view_stem(const struct sf_view *view, char *stem, size_t room);
void sf_view_note(struct sf_view *view, enum sf_log_level level, const char *format, ...);

/* ---- panels: drawn inside of the side panel's tabs, but for the last five ---- */
void sf_panel_parameters(struct sf_view *view); /* panel_parameters.c */
void sf_panel_scene(struct sf_view *view);      /* panel_scene.c: scene, method, files, camera, lights, window */
void sf_panel_look(struct sf_view *view);       /* panel_look.c: resources of the graph */
void sf_panel_graph(struct sf_view *view);      /* panel_graph.c: the graph as a drawing */
void sf_panel_times(struct sf_view *view);      /* panel_times.c */
void sf_panel_truth(struct sf_view *view);      /* panel_truth.c: the comparison with the reference */
void sf_panel_probe(struct sf_view *view);      /* panel_probe.c: a pixel's ray, in the tab above */
void sf_panel_truth_over(struct sf_view *view); /* panel_truth.c: the map's scale, the probe's mouse */
void sf_panel_looked(struct sf_view *view);     /* panel_look.c: read-out over the picture, zoom and pan */
void sf_panel_bar(struct sf_view *view, float x, float y, float width, float height); /* panel_bar.c: time */
void sf_panel_notes(struct sf_view *view);                                            /* panel_bar.c */
void sf_panel_keys(struct sf_view *view);                                             /* panel_bar.c */

/* panel_look.c: zoom and pan by the mouse at (x, y) of the picture's place; a frame about a texel. */
void sf_panel_look_move(const struct sf_view *view, struct sf_looking *looking, float x, float y, bool inside);
void sf_panel_look_mark(const struct sf_view *view, const struct sf_looking *looking, uint32_t column, uint32_t row);

/* What is shown in the picture's place when it has values. */
static inline struct sf_looking *sf_view_looked(struct sf_view *view)
{
    return view->against.open && view->against.heat.values ? &view->against.heat : &view->looking;
}

/* looking.c: the looked-at image as RGBA pixels for sf_window_show, as large as the picture's place in px with zoom and pan
 * in them; mapped anew when something changed. NULL: show the picture. */
const uint8_t *sf_looking_pixels(struct sf_looking *looking, uint32_t place_width, uint32_t place_height,
                                 uint32_t *width, uint32_t *height);
/* Takes over what came back with a frame. */
void sf_looking_take(struct sf_looking *looking, const struct sf_frame *frame);
void sf_looking_finish(struct sf_looking *looking);

#endif
