/* sfumato: smoke, fire and clouds in real time with Vulkan. The whole public interface.
 *
 * Objects are opaque; `_create/_load` give one, `_destroy` takes a pointer to the pointer, nulls it, and accepts NULL.
 * Every call that can fail answers an enum sf_status and says why in the log. The library never prints, exits or
 * aborts. Unless said otherwise a device and all that was made with it belong to one thread at a time. Strings given
 * back as `char **` are malloc'ed and the caller's.
 *
 *     struct sf_device *device = NULL;
 *     struct sf_scene *scene = NULL;
 *     struct sf_renderer *renderer = NULL;
 *     struct sf_frame frame;
 *     uint64_t ticket;
 *     sf_device_create(&(struct sf_device_options){0}, &log, &device);
 *     sf_scene_load("scenes/plume.json", NULL, 0, &log, &scene);
 *     sf_renderer_create(device, scene, &(struct sf_renderer_options){.width = 800, .height = 800}, &log, &renderer);
 *     sf_renderer_render(renderer, 48, &ticket);
 *     sf_renderer_wait(renderer, ticket, &frame); // frame.color: half RGBA
 *     sf_renderer_destroy(&renderer);
 *     sf_scene_destroy(&scene);
 *     sf_device_destroy(&device);
 */
#ifndef SFUMATO_H
#define SFUMATO_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "sfumato/log.h"
#include "sfumato/status.h"

#define SF_VERSION "0.1.0"

/* ---- devices ---- */

struct sf_device_info {
    char name[256], driver[256], uuid[37], kind[16];
    uint32_t api_major, api_minor, api_patch;
    uint64_t memory_bytes;
    uint32_t subgroup_size, max_image_side;
    bool suitable;
    char unsuitable_because[128];
};
enum sf_status sf_device_list(const struct sf_log *log, struct sf_device_info **infos, uint32_t *count);

/* How a host's windowing library makes Vulkan surfaces. `create` is called by sf_device_create, and again when a surface
 * is lost: `instance` is the VkInstance, *surface becomes a VkSurfaceKHR, which the device destroys. */
struct sf_surface_source {
    const char *const *extensions; /* of the instance, as the windowing library needs them */
    uint32_t extension_count;
    enum sf_status (*create)(void *user, void *instance, uint64_t *surface);
    void *user;
};

struct sf_device;
struct sf_device_options {
    const char *device;    /* index, UUID or part of a name; NULL: the best one */
    bool validate;         /* Vulkan's validation layer, core and synchronization */
    uint64_t budget_bytes; /* device memory; 0: 80 % of the device's */
    uint64_t timeout_ns;   /* longest wait for the device; 0: 60 s */
    bool no_cache;         /* leave the pipeline cache on disk alone */
    /* Show pictures in a window (sf_window_create): only devices that can are chosen from. NULL: no window. Copied; what
     * it points to must outlive the device. */
    const struct sf_surface_source *surface;
};
enum sf_status sf_device_create(const struct sf_device_options *options, const struct sf_log *log,
                                struct sf_device **device);
void sf_device_destroy(struct sf_device **device);
void sf_device_describe(const struct sf_device *device, struct sf_device_info *info);
uint32_t sf_device_validation_messages(const struct sf_device *device);
void sf_device_memory(const struct sf_device *device, uint64_t *used, uint64_t *budget);

/* ---- shaders at run time ---- */

/* The shaders of the library, "thick/march.comp" and so on, as under glsl/; NULL behind the last. */
const char *sf_shader_name(uint32_t index);
/* Another SPIR-V for the shader of that name (copied): every pipeline that uses it is made anew, and later ones use it.
 * Waits for the device. When it cannot be (SF_ERROR_USAGE: no such shader, not SPIR-V, or of another stage, or with
 * bindings or push constants that its passes do not have; else what the driver says), everything stays as it was.
 * `words` NULL: the library's own again. */
enum sf_status sf_device_set_shader(struct sf_device *device, const char *name, const uint32_t *words, size_t bytes);

/* ---- scenes ---- */

struct sf_scene;
/* `sets`: "group.key=value" strings over the file, such as "thick.steps=24". */
enum sf_status sf_scene_load(const char *path, const char *const *sets, uint32_t set_count, const struct sf_log *log,
                             struct sf_scene **scene);
enum sf_status sf_scene_parse(const char *name, const char *text, size_t bytes, const char *const *sets,
                              uint32_t set_count, const struct sf_log *log, struct sf_scene **scene);
void sf_scene_destroy(struct sf_scene **scene);
struct sf_scene_info {
    const char *path;   /* the scene's, as long as it lives */
    const char *method; /* name */
    uint64_t hash;      /* of scene, sets and named files */
    double fps;
    uint32_t capacity;                                  /* particles */
    uint32_t lights, objects, emitters, forces, meshes; /* lights and emitters of effects among them */
    uint32_t effects, flashes, shakes;
    uint32_t listed;  /* explicit particles */
    float exposure;   /* stops */
    const char *tone; /* name of the tone mapping for 8-bit output */
};
void sf_scene_describe(const struct sf_scene *scene, struct sf_scene_info *info);

/* Writes the scene that sf_scene_parse would make of these arguments as a file: only keys that differ from their
 * defaults (or must be there), comments kept, names of files made to fit the new folder. Checked first; written whole or
 * not at all. */
enum sf_status sf_scene_save(const char *name, const char *text, size_t bytes, const char *const *sets,
                             uint32_t set_count, const char *path, const struct sf_log *log);

/* What an effect file does, for people: a line for each step, in the order of their beginnings, those of effects within
 * it too. Checks it like a scene that has it. SF_ERROR_SCENE, SF_ERROR_IO. *text is malloc'ed. */
enum sf_status sf_effect_print(const char *path, const struct sf_log *log, char **text);

struct sf_camera_view {
    float eye[3], target[3], up[3];
    float fov;       /* deg, vertical */
    float near_clip; /* m */
};
/* The scene's camera at a time in s (frame/fps), shaken by the effects that do. */
void sf_scene_view(const struct sf_scene *scene, double time, struct sf_camera_view *view);

/* ---- the parameter table ---- */

/* As a document: "text", "json-schema" or "markdown"; of effect files "effect-text", "effect-json-schema" or
 * "effect-markdown". */
enum sf_status sf_params_print(const char *format, const struct sf_log *log, char **text);

enum sf_control_kind {
    SF_CONTROL_BOOL,   /* 0 or 1 */
    SF_CONTROL_INT,    /* whole number */
    SF_CONTROL_FLOAT,  /* number */
    SF_CONTROL_VECTOR, /* 3 numbers */
    SF_CONTROL_COLOR,  /* 3 numbers, linear Rec. 709 */
    SF_CONTROL_RANGE,  /* 2 numbers, lower first */
    SF_CONTROL_CHOICE, /* index into `choices` */
    SF_CONTROL_TEXT,   /* `text` */
};
/* A parameter of a scene with its value. */
struct sf_control {
    const char *path;   /* as sets name it: "lights.0.intensity" */
    const char *group;  /* "lights.0"; "" outermost */
    const char *key;    /* "intensity" */
    const char *unit;   /* "m"; "" */
    const char *doc;    /* one line */
    const char *renews; /* what a change makes anew: "", "graph", "simulation" or "files" */
    enum sf_control_kind kind;
    uint32_t numbers;           /* in value: 1 to 3; 0 for SF_CONTROL_TEXT */
    double value[3], usual[3];  /* usual: the default */
    double min, max;            /* inclusive, each number */
    bool required;              /* has no default */
    const char *text;           /* SF_CONTROL_TEXT: may be NULL */
    const char *const *choices; /* NULL-terminated */
};
/* Every parameter that a set can change (elements of lists up to 64 long included), in the table's order; one malloc'ed
 * block with all that it points to, good while the scene lives. */
enum sf_status sf_scene_controls(const struct sf_scene *scene, const struct sf_log *log, struct sf_control **controls,
                                 uint32_t *count);
/* "lights.0.intensity=3.5" for the control's value (or text), so that setting it gives the same bits. malloc'ed; NULL
 * when memory is out. */
char *sf_control_print(const struct sf_control *control);

/* ---- rendering ---- */

enum sf_aov {
    SF_AOV_SMOKE = 1,  /* smoke alone, premultiplied */
    SF_AOV_DEPTHS = 2, /* smoke's near, far, optical depth, transmittance */
};
struct sf_renderer;
struct sf_renderer_options {
    uint32_t width, height; /* px, 1..device's limit */
    bool float_color;       /* color as float; else half */
    uint32_t aovs;          /* enum sf_aov bits */
    bool float_aovs;        /* SF_AOV_SMOKE as float, as fine as the method has it; else half */
    bool timing;            /* timestamps around each pass */
    uint32_t frames_kept;   /* results that may be looked at at once: 1..8; 0 means 2 */
    bool no_readback;       /* nothing comes back but times (for measuring) */
    /* An image or buffer of the frame's graph whose contents at the frame's end come back as well, such as "camera.raw"
     * or "light.map" (sf_graph_print names them all); NULL: none. Copied. An unknown name is SF_ERROR_USAGE. */
    const char *inspect;
    /* The picture stays on the device for sf_window_show; color, depth and smoke do not come back, all else does. */
    bool shown;
    bool returned;  /* with `shown`: color and depth (and what `aovs` asks for) come back all the same */
    bool particles; /* the list of particles comes back too: 64 bytes for each of the scene's sim.capacity */
    /* What the method samples along the ray of one pixel (sf_renderer_set_probe) comes back too, from methods that go
     * along rays: "thick" and "thick-larsson". The picture has the same bits. */
    bool probe;
    /* A method that betters its picture step by step ("reference") gives every one of the steps: sf_renderer_render makes
     * one, and goes on where the last call left the picture unless anything is different now. Else each
     * sf_renderer_render begins anew (or where sf_renderer_refine ended) and makes all of them. */
    bool progressive;
};
/* The scene and device must outlive it. */
enum sf_status sf_renderer_create(struct sf_device *device, const struct sf_scene *scene,
                                  const struct sf_renderer_options *options, const struct sf_log *log,
                                  struct sf_renderer **renderer);
void sf_renderer_destroy(struct sf_renderer **renderer);

/* Takes `scene` in place of the one before. What differs between the two decides what is made anew, as the parameter table
 * says ("renews"), and nothing else is: the simulation goes on unless something of it differs, when it starts again. The
 * pictures that follow have the same bits as those of a renderer made for `scene`. When it fails, the renderer goes on
 * with the old scene; else the old one may be destroyed. Frames that were queued can still be waited for unless the
 * graph was made anew. */
enum sf_status sf_renderer_set_scene(struct sf_renderer *renderer, const struct sf_scene *scene);
/* Other options for the frames that follow; the simulation stays where it is, tickets given before are void. When it
 * fails, everything stays as it was. */
enum sf_status sf_renderer_set_options(struct sf_renderer *renderer, const struct sf_renderer_options *options);
/* The eye of the frames that follow; NULL: the scene's camera. */
void sf_renderer_set_view(struct sf_renderer *renderer, const struct sf_camera_view *view);

/* The pixel whose ray is probed in the frames that follow, row 0 on top; until then, and after a change of size, the one in
 * the middle. SF_ERROR_USAGE: the frame has no such pixel, or the renderer's options are without `probe`. */
enum sf_status sf_renderer_set_probe(struct sf_renderer *renderer, uint32_t x, uint32_t y);

/* A second method's picture of every frame that follows, drawn beside the scene's from the same particles, eye, settings
 * and options: the simulation is stepped once. A picture is the same, bit for bit, as that of a renderer whose scene has
 * the method. NULL: none (at first), and then it costs nothing. The first picture goes on as it was; the second follows
 * sf_renderer_set_scene (which then fails when either cannot be) and sf_renderer_set_options. Tickets given before are
 * void for the second. SF_ERROR_USAGE: no such method; SF_ERROR_MEMORY and what else making a renderer for it may give.
 * When it fails, everything stays as it was. Where the two methods take different numbers of steps (see `progressive`)
 * the one that is finished waits for the other. `inspect`, `particles` and sf_renderer_graph_print are the first's. */
enum sf_status sf_renderer_set_beside(struct sf_renderer *renderer, const char *method);
/* `ticket | SF_BESIDE` names the second method's picture in sf_renderer_wait and sf_renderer_timings (its own passes,
 * without the simulation's). */
#define SF_BESIDE (UINT64_C(1) << 63)

/* Steps the simulation up to just before frame number `frame` (from the start when it lies behind): for long ways, so
 * that a host can show progress. `progress` (may be NULL) is called now and then with steps done and steps to do; false
 * stops with SF_ERROR_INTERRUPTED. */
typedef bool (*sf_progress_fn)(void *user, uint64_t done, uint64_t total);
enum sf_status sf_renderer_seek(struct sf_renderer *renderer, uint32_t frame, sf_progress_fn progress, void *user);
/* All but the last of the steps in which the method makes the picture of frame `frame` ("reference"; others make it in
 * one), so that a host can show progress, as above; sf_renderer_render then makes the last one. */
enum sf_status sf_renderer_refine(struct sf_renderer *renderer, uint32_t frame, sf_progress_fn progress, void *user);
/* Queues simulation up to and the picture of frame number `frame` (time frame/fps) and returns; *ticket names it. Where
 * the picture takes many steps, it waits for all but the last two. */
enum sf_status sf_renderer_render(struct sf_renderer *renderer, uint32_t frame, uint64_t *ticket);

/* How far the picture that was queued last has come, 0..1; 1: it is finished; of two (sf_renderer_set_beside) the one that
 * has come less far. Below 1 only with `progressive`. */
float sf_renderer_progress(const struct sf_renderer *renderer);

/* A sphere of smoke as the simulation left it for a frame: docs/scene.md, "Particles". */
struct sf_frame_particle {
    float position[3], radius;            /* m */
    float velocity[3];                    /* m/s */
    float extinction;                     /* 1/m, dilution and fades applied */
    float age, lifetime;                  /* s; lifetime 0: does not die */
    float rotation;                       /* rad, of its tile of the atlas */
    float temperature;                    /* K above the air's */
    float birth_radius, birth_extinction; /* m, 1/m */
    uint32_t id;                          /* number of its birth, counted over all emitters */
    uint32_t look; /* bits 0-7 tile of the atlas, 8-15 emitter, bit 16 stands still, bit 17 its tile turns clockwise */
};

/* How far the light has come along a pixel's ray. */
struct sf_probe_point {
    float depth;         /* m of view depth; SF_NO_DEPTH: the ray meets no smoke */
    float transmittance; /* from the eye to here, 0..1 */
    float radiance[3];   /* scattered in and emitted between the eye and here, as it reaches the eye, W/(m2 sr) */
};

struct sf_frame {
    uint32_t frame, width, height;
    double time;                /* s */
    float progress;             /* as sf_renderer_progress, of this picture alone */
    struct sf_camera_view view; /* the eye that it was drawn from */
    const uint16_t *color; /* [height][width][4] linear RGBA half, premultiplied, row 0 on top; NULL when float_color */
    const float *color_float;
    const float *depth;    /* [height][width] m of view depth; SF_NO_DEPTH where nothing is */
    const uint16_t *smoke; /* [height][width][4] half; NULL unless asked for, and when float_aovs */
    const float *smoke_float;
    const float *smoke_depths; /* [height][width][4] near, far, optical depth, transmittance; NULL unless asked for */
    uint32_t live;             /* particles */
    const struct sf_frame_particle *particles; /* [live] in order of birth; NULL unless asked for */
    uint32_t dropped;                          /* births refused by the capacity so far */
    float bounds_min[3], bounds_max[3];        /* m: of the particles' spheres; min above max when there are none */
    /* [inspected_height][inspected_width][inspected_channels]: the image that the options name, as it is at the frame's
     * end, converted to float; NaN where no pass wrote. Array layers stand below each other. NULL unless asked for. */
    const float *inspected;
    uint32_t inspected_width, inspected_height, inspected_channels; /* 1, 2 or 4 channels */
    /* [probe_count] where smoke begins on the ray of pixel probe_at, then behind each of the method's samples the light
     * that is counted up to there; the last is the pixel. Where the method draws smoke coarser than the frame, of the
     * smoke's pixel that covers it. No points: it meets no smoke there. NULL unless asked for, and when the method keeps
     * nothing of the way. */
    const struct sf_probe_point *probe;
    uint32_t probe_count, probe_at[2];
    const uint32_t *inspected_words; /* when the options name a buffer: its first 64 KiB at most; else NULL */
    uint32_t inspected_word_count;
    float world_to_camera[16], world_to_clip[16]; /* row-major; camera: right-handed, -z forward, Vulkan clip space */
};
#define SF_NO_DEPTH 1.0e6f

/* Whether that number is the NaN that stands for "no pass wrote here" in `inspected`, and not one that a pass made. */
bool sf_frame_unwritten(float value);

/* Waits for the frame. Its pointers hold until frames_kept further frames have been queued. SF_ERROR_DEVICE when the
 * method found that the device cannot make the picture right. */
enum sf_status sf_renderer_wait(struct sf_renderer *renderer, uint64_t ticket, struct sf_frame *frame);

struct sf_pass_timing {
    const char *name;                   /* "thick.camera" */
    uint64_t begin_ns, end_ns;          /* device clock */
    uint64_t bytes_read, bytes_written; /* as the graph says */
};
/* After sf_renderer_wait: every pass of that frame in order, simulation first; of a picture of many steps those of the
 * last. *timings stays the renderer's, until the next call. */
enum sf_status sf_renderer_timings(struct sf_renderer *renderer, uint64_t ticket, const struct sf_pass_timing **timings,
                                   uint32_t *count);
/* CPU ns that the last sf_renderer_render took to record its passes, and how many they were. */
uint64_t sf_renderer_record_ns(const struct sf_renderer *renderer, uint32_t *passes);

/* The compiled graphs of a renderer as it is now, in the formats of sf_graph_print. */
enum sf_status sf_renderer_graph_print(const struct sf_renderer *renderer, const char *format, char **text);
/* The frame's compiled graph as "text", "dot" or "json"; needs no device. */
enum sf_status sf_graph_print(const struct sf_scene *scene, uint32_t width, uint32_t height, uint32_t aovs,
                              const char *format, const struct sf_log *log, char **text);

/* ---- the reference: how a frame's smoke should look ---- */

/* The integral of docs/scene.md, "The medium", computed on the CPU in double precision to a stated tolerance: single
 * scattering, with ambient light as the frame's method adds it (thick.ambient). docs/truth.md says how, and how it is known
 * to be right. A reference never changes: any threads may use one at once. */
struct sf_reference;
struct sf_reference_options {
    double tolerance; /* error of a pixel's radiance, relative to its brightest channel ...; 0: 1e-4 */
    double floor;     /* ... or absolute, W/(m2 sr): whichever allows more; 0: 1e-7 */
    unsigned threads; /* 0: one a processor. The same bits with any number */
};
/* For the particles of `frame`, made with sf_renderer_options.particles and drawn from `scene`. Copies all that it needs:
 * frame, renderer and scene may go. SF_ERROR_USAGE: the frame has no particles, or an option is below 0 or not a number;
 * SF_ERROR_SCENE: the scene's method draws a medium that the reference does not know, or a particle has a value that is
 * not finite. */
enum sf_status sf_reference_create(const struct sf_scene *scene, const struct sf_frame *frame,
                                   const struct sf_reference_options *options, const struct sf_log *log,
                                   struct sf_reference **reference);
void sf_reference_destroy(struct sf_reference **reference);
/* Where the scene's settings leave that integral, one to an index, such as "thick.octaves is 3: ..."; NULL behind the last.
 * Good while the reference lives. */
const char *sf_reference_note(const struct sf_reference *reference, uint32_t index);

struct sf_reference_pixel {
    float radiance[3];   /* of the smoke alone, premultiplied: what is behind it shows times `transmittance` */
    float transmittance; /* from the near plane to the first surface */
    float optical_depth;
    float near,
        far;     /* m of view depth: where the ray first enters smoke and last leaves it; SF_NO_DEPTH: it meets none */
    float error; /* estimate, of the radiance's worst channel */
    uint32_t evaluations; /* of what is integrated: what the pixel cost, the same on every machine */
    bool converged;       /* it is within the tolerance */
};
struct sf_reference_picture {
    uint32_t width, height;            /* of `pixels`: the size asked for over the stride, rounded up */
    struct sf_reference_pixel *pixels; /* [height][width], row 0 on top */
    uint32_t unconverged;              /* pixels that are not */
};
/* Every pixel's middle of a picture of width x height, seen from `view` (NULL: the frame's). With a stride above 1 only
 * one pixel of each stride x stride block, counted from the top left: the block's pixel (stride / 2, stride / 2), or the
 * picture's last one where that is outside. `progress` (may be NULL) is called in this thread with rows done and to do;
 * false stops with SF_ERROR_INTERRUPTED. SF_ERROR_INTERNAL when a result is not a number: the message names the pixel. */
enum sf_status sf_reference_render(const struct sf_reference *reference, const struct sf_camera_view *view,
                                   uint32_t width, uint32_t height, uint32_t stride, sf_progress_fn progress,
                                   void *user, struct sf_reference_picture **picture);
void sf_reference_picture_destroy(struct sf_reference_picture **picture);

/* Along the ray of pixel (x, y) of such a picture: `count` points, evenly from where it enters the smoke (or the near
 * plane) to where it last leaves it (or the first surface). */
enum sf_status sf_reference_probe(const struct sf_reference *reference, const struct sf_camera_view *view,
                                  uint32_t width, uint32_t height, uint32_t x, uint32_t y,
                                  struct sf_probe_point *points, uint32_t count);

/* Light that is scattered more than once, as the mean of ever more random paths. Light from all around is dimmed by
 * smoke and hidden by objects here, as it is in nature. */
struct sf_reference_estimate {
    uint32_t width, height;
    uint32_t orders; /* scatterings at most; 0: as many as there are */
    uint32_t paths;  /* of each pixel so far */
    float *radiance; /* [height][width][3] of the smoke alone */
    float *error;    /* [height][width][3] standard errors; INFINITY with fewer than two paths */
};
/* Adds `paths` to every pixel. *estimate NULL begins one; else all arguments are those that it began with. The same
 * paths in the same order give the same bits. The reference must outlive it. On failure *estimate is destroyed and NULL. */
enum sf_status sf_reference_scatter(const struct sf_reference *reference, const struct sf_camera_view *view,
                                    uint32_t width, uint32_t height, uint32_t orders, uint32_t paths,
                                    sf_progress_fn progress, void *user, struct sf_reference_estimate **estimate);
void sf_reference_estimate_destroy(struct sf_reference_estimate **estimate);

/* ---- windows: pictures and a user interface on the host's surface ---- */

struct sf_window;
struct sf_window_options {
    uint32_t width, height; /* px of the framebuffer, as the windowing library says; 0: minimised */
    /* "fifo" (waits for the screen), "fifo_relaxed", "mailbox" (newest picture at each refresh), "immediate" (tears).
     * NULL: "fifo". One that the surface does not have is SF_ERROR_USAGE, with those that it has. */
    const char *present_mode;
};
/* The device must have been created with a surface, and outlive it. One window a device. */
enum sf_status sf_window_create(struct sf_device *device, const struct sf_window_options *options,
                                const struct sf_log *log, struct sf_window **window);
void sf_window_destroy(struct sf_window **window);
/* Another size or mode (whatever differs); takes effect with the next sf_window_show. */
enum sf_status sf_window_set_options(struct sf_window *window, const struct sf_window_options *options);
struct sf_window_info {
    uint32_t width, height; /* px of the images shown */
    uint32_t images;
    const char *present_mode;
    const char *present_modes[5]; /* that the surface has; NULL-terminated */
    uint64_t shown;               /* pictures so far */
    uint64_t remade;              /* how often the swapchain was made anew */
};
void sf_window_describe(const struct sf_window *window, struct sf_window_info *info);

/* Triangles over the picture, three indices each, blended in order. */
struct sf_overlay_vertex {
    float x, y;     /* px of the window, y down */
    float u, v;     /* 0..1 in the font's picture */
    uint32_t color; /* sRGB with straight alpha, R in the lowest byte */
};
struct sf_overlay_batch {
    float clip[4]; /* px: left, top, right, bottom */
    uint32_t first_index, index_count;
};
struct sf_overlay {
    const struct sf_overlay_vertex *vertices;
    const uint32_t *indices; /* of vertices */
    const struct sf_overlay_batch *batches;
    uint32_t vertex_count, index_count, batch_count;
};
/* The coverage that vertices' colours are multiplied by, [height][width] 0..255. Copied. */
enum sf_status sf_window_set_font(struct sf_window *window, const uint8_t *coverage, uint32_t width, uint32_t height);

struct sf_window_frame {
    float x, y, width, height;    /* px: where the picture stands */
    float background[3];          /* sRGB 0..1, around it */
    struct sf_renderer *renderer; /* of the same device, made with `shown`: its last picture; NULL: none */
    const char *tone;             /* as in sf_frame_write_png */
    float exposure;               /* stops */
    /* With a second method's picture (sf_renderer_set_beside): share of the width, rounded to whole px, that shows the
     * first method; right of it stands the second. 0..1; without a second one not looked at. */
    float wipe;
    const uint8_t *pixels; /* [pixels_height][pixels_width][4] sRGB, drawn in place of the renderer's; NULL: none */
    uint32_t pixels_width, pixels_height;
    const struct sf_overlay *overlay; /* may be NULL */
};
/* Draws and presents. A minimised window does nothing. A swapchain that is out of date or suboptimal is made anew, a lost
 * surface too, a bounded number of times. The 8-bit values of the picture are those of sf_frame_write_png to within 1
 * when width and height are the renderer's. */
enum sf_status sf_window_show(struct sf_window *window, const struct sf_window_frame *frame);

/* ---- measuring ---- */

/* What the device can do at most, measured now at the frame's size: medians of `repeats`, ns. */
struct sf_ceilings {
    uint64_t image_copy_ns;   /* transfer copy of one RGBA32F image width x height */
    uint64_t compute_copy_ns; /* the same by imageLoad and imageStore, one pixel a thread, groups of 8x8 */
    uint64_t bytes;           /* read plus written by each */
    double flops;             /* multiply-adds in a compute shader, counted as two, per second */
};
enum sf_status sf_measure_ceilings(struct sf_device *device, uint32_t width, uint32_t height, uint32_t repeats,
                                   const struct sf_log *log, struct sf_ceilings *ceilings);
/* How many of these compute copies a frame of the scene's method is meant to take at most, at 800x800, half resolution
 * and 512 particles; 0: none is set. */
double sf_measure_goal(const struct sf_scene *scene);
struct sf_sort_timing {
    uint64_t gpu_min_ns, gpu_median_ns, cpu_min_ns,
        cpu_median_ns; /* cpu: a comparison sort of the same pairs on one thread */
    bool correct;      /* every timed run equalled the stable reference */
};
enum sf_status sf_measure_sort(struct sf_device *device, uint32_t pairs, uint32_t repeats, const struct sf_log *log,
                               struct sf_sort_timing *timing);

/* ---- pictures: the writers that the program uses; need no device ---- */

struct sf_exr_options {
    const char *compression; /* "none", "rle", "zips", "zip", "piz", "pxr24", "b44" */
    bool half;               /* color and smoke as half, else float; Z is always float */
    double fps;
    const char *scene_hash; /* hexadecimal, may be NULL */
};
/* Layers R,G,B,A, Z and, when the frame has them, smoke.R,G,B,A, smoke.near, smoke.far, smoke.depth, smoke.T. Written
 * whole or not at all. Any thread. */
enum sf_status sf_frame_write_exr(const struct sf_frame *frame, const char *path, const struct sf_exr_options *options,
                                  const struct sf_log *log);
/* 8-bit sRGB; `tone`: "linear", "reinhard", "aces", "neutral"; exposure in stops. Any thread. */
enum sf_status sf_frame_write_png(const struct sf_frame *frame, const char *path, const char *tone, float exposure,
                                  const struct sf_log *log);

/* The inspected image alone. EXR: channels R, G, B, A, as many as it has, as floats. PNG: R, G and B, each mapped for
 * itself from its least to its greatest value (those below SF_NO_DEPTH in size) to 0..255 without gamma; by logarithms
 * where all are positive and the greatest is over 16 times the least; values all below 0 (far depths stored as their
 * negatives) by their size. One channel is grey, two are red and green. Pixels whose first channel holds no value are
 * black. SF_ERROR_USAGE when the frame holds no inspected image. Any thread. */
enum sf_status sf_frame_write_inspected_exr(const struct sf_frame *frame, const char *path,
                                            const struct sf_exr_options *options, const struct sf_log *log);
enum sf_status sf_frame_write_inspected_png(const struct sf_frame *frame, const char *path, const struct sf_log *log);

/* ---- smoke textures ---- */

/* An atlas of smoke for particles: tiles side by side, each with colour, alpha, normal and height. */
struct sf_texture_options {
    /* "fbm", "turbulence", "cellular": noise weighted by the distance to the tile's middle; "dispersed": clones of one
     * puff scattered in a ball. */
    const char *kind;
    uint32_t tiles_x, tiles_y; /* 1..64 each */
    uint32_t width, height;    /* px of one tile: 8..8192 each, and at most 32768 each, 2^26 in all, of the whole */
    uint32_t seed;
    uint32_t octaves; /* 1..10 */
    float lacunarity; /* 1.2..4: frequency of an octave to that of the one before */
    float roughness;  /* 0..1: amplitude likewise */
    float scale;      /* 0.5..64: features of the first octave across the puff */
    float ragged;     /* 0..2: how far the noise moves the outline; 0: a ball */
    float softness;   /* 0.02..2: how slowly the density grows from the outline inwards */
    float density;    /* 0.1..100: optical depth through the middle */
    float mottle;     /* 0..1: how much darker the colour is where the noise is low; 0: white */
    uint32_t clones;  /* 1..2000, of "dispersed" */
    /* Every `loop` tiles are one smoke at so many times of a cycle; divides the number of tiles; 1: each tile is another
     * smoke. */
    uint32_t loop;
    uint32_t changes; /* 1..32: how often the first octave becomes another one in the cycle */
    bool tileable;    /* a layer without end that repeats at the tile's borders, in place of a puff */
    uint32_t threads; /* 0: one a core */
};
/* What the program makes when it is told nothing. */
void sf_texture_options_init(struct sf_texture_options *options);

struct sf_texture;
/* Needs no device. The same options give the same bits with any number of threads. `progress` (may be NULL) gets rows of
 * pixels; false stops with SF_ERROR_INTERRUPTED. SF_ERROR_USAGE names the option that is out of its range. */
enum sf_status sf_texture_create(const struct sf_texture_options *options, sf_progress_fn progress, void *user,
                                 const struct sf_log *log, struct sf_texture **texture);

enum sf_texture_channels {
    SF_TEXTURE_COLOR = 1,  /* R, G, B: linear Rec. 709 */
    SF_TEXTURE_ALPHA = 2,  /* A */
    SF_TEXTURE_NORMAL = 4, /* N.x, N.y, N.z: to the right, up, to the viewer; unit */
    SF_TEXTURE_HEIGHT = 8, /* height: 0..1 */
    SF_TEXTURE_ALL = 15,
};
/* Reads an atlas of tiles_x by tiles_y tiles, 0 by 0 when the file itself says (EXR files of sf_texture_write_exr do).
 * EXR: channels as above, colour premultiplied. PNG: colour and alpha, not premultiplied; of NAME.color.png the normals
 * and heights are in NAME.normal.png, if it is there. Channels that are not there are white, opaque, flat and 0, but
 * normals are made from heights; SF_ERROR_IO when one of `needs` is among them. SF_ERROR_IO as well: missing, neither EXR
 * nor PNG, corrupt, too large, not to be divided into the tiles, a number that is none or out of its range. */
enum sf_status sf_texture_load(const char *path, uint32_t tiles_x, uint32_t tiles_y, uint32_t needs,
                               const struct sf_log *log, struct sf_texture **texture);
void sf_texture_destroy(struct sf_texture **texture);

struct sf_texture_info {
    uint32_t width, height; /* px of the whole */
    uint32_t tiles_x, tiles_y, loop;
    bool tileable;
    uint32_t channels; /* that were made or read: enum sf_texture_channels bits */
    /* [height][width][4], the texture's, row 0 on top: R, G, B (not premultiplied), A; normal x, y, z, height. A height of
     * 1 is half a tile's shorter side above the tile's plane. */
    const float *color, *shape;
};
void sf_texture_describe(const struct sf_texture *texture, struct sf_texture_info *info);
/* The light that is drawn into the colour: luminance as a linear function of the normal, by least squares weighted with
 * alpha. *slope: the length of that function's gradient over the mean luminance (0: unlit; a white ball lit from the
 * viewer: 1.5). *correlation: 0..1, how much of the luminance's variation that explains. */
void sf_texture_lighting(const struct sf_texture *texture, double *slope, double *correlation);

/* `channels`: enum sf_texture_channels bits. Colour is premultiplied by alpha. Written whole or not at all. */
enum sf_status sf_texture_write_exr(const struct sf_texture *texture, const char *path, uint32_t channels,
                                    const struct sf_exr_options *options, const struct sf_log *log);
/* Colour is sRGB and not premultiplied; the others are numbers without a curve: normals (n + 1) / 2, and height or alpha
 * alone grey. A picture holds colour and alpha, or normal and height (in its alpha), or one of the four; else
 * SF_ERROR_USAGE. `bits`: 8 or 16. Written whole or not at all. */
enum sf_status sf_texture_write_png(const struct sf_texture *texture, const char *path, uint32_t channels,
                                    unsigned bits, const struct sf_log *log);

/* A frame list such as "1-100x2,150": malloc'ed, in order, without repeats. SF_ERROR_USAGE says where it goes wrong. */
enum sf_status sf_frames_parse(const char *text, const struct sf_log *log, uint32_t **frames, size_t *count);
/* "out/a.####.png" or "out/a.%04d.png" with the number put in. SF_ERROR_USAGE when the pattern has no place (or
 * several) and `many`. */
enum sf_status sf_sequence_name(const char *pattern, uint32_t frame, bool many, const struct sf_log *log, char **path);

#endif
