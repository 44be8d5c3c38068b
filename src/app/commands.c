#include "commands.h"

#include "bench.h"
#include "capture.h"
#include "suite.h"
#include "verify/verify.h"
#include "texture.h"
#if defined(SF_VIEWER)
#include "view/view.h"
#else
#include "console.h"
#endif

#define FIELD(f) offsetof(struct sf_arguments, f)

/* The sides of pictures that some Vulkan device can draw; the device at hand may say less. */
enum { SIDE_MAX = 32768 };

static const char *const types[] = {"half", "float", NULL};
static const char *const compressions[] = {"none", "rle", "zips", "zip", "piz", "pxr24", "b44", NULL};
static const char *const tones[] = {"linear", "reinhard", "aces", "neutral", NULL};
static const char *const graph_formats[] = {"text", "dot", "json", NULL};
static const char *const texture_kinds[] = {"fbm", "turbulence", "cellular", "dispersed", NULL};
static const char *const texture_channels[] = {"all", "color", "alpha", "normal", "height", NULL};
static const char *const texture_bits[] = {"8", "16", NULL};
static const char *const params_formats[] = {"text", "json-schema", "markdown", NULL};

static const struct sf_option common_options[] = {
    {"verbose", 'v', SF_OPTION_COUNT, FIELD(verbose), .doc = "say more; twice: say everything"},
    {"quiet", 'q', SF_OPTION_FLAG, FIELD(quiet), .doc = "say nothing but errors"},
    {"help", 'h', SF_OPTION_FLAG, FIELD(help), .doc = "print this"},
    {.name = NULL}};

static const struct sf_option scene_options[] = {
    {"set", 0, SF_OPTION_LIST, FIELD(sets), .value = "GROUP.KEY=VALUE",
     .doc = "a parameter over the scene's (see sfumato params); repeatable"},
    {"method", 0, SF_OPTION_TEXT, FIELD(method), .value = "NAME", .doc = "draw by another method than the scene's"},
    {.name = NULL}};

static const struct sf_option device_options[] = {
    {"device", 0, SF_OPTION_TEXT, FIELD(device), .value = "DEVICE",
     .doc = "index, UUID or part of the name (see sfumato devices)"},
    {"validate", 0, SF_OPTION_FLAG, FIELD(validate), .doc = "Vulkan's validation layers; a message is an error"},
    {"memory", 0, SF_OPTION_NUMBER, FIELD(memory), .value = "MIB",
     .doc = "device memory that may be used (default: most of it)", .min = 1, .max = 1 << 24},
    {"no-cache", 0, SF_OPTION_FLAG, FIELD(no_cache), .doc = "leave the pipeline cache on disk alone"},
    {.name = NULL}};

static const struct sf_option size_options[] = {{"size", 's', SF_OPTION_SIZE, FIELD(size), .value = "WxH",
                                                 .initial = "800x800", .doc = "pixels of the picture", .min = 1,
                                                 .max = SIDE_MAX},
                                                {.name = NULL}};

static const struct sf_option aov_options[] = {
    {"aovs", 0, SF_OPTION_FLAG, FIELD(aovs), .doc = "also the smoke alone: light, near, far, depth, transmittance"},
    {.name = NULL}};

/* The default compression, measured: a frame of scenes/plume.json of 800x800 takes one thread 32 ms and 1.03 MB by zip,
 * 48 ms and 1.13 MB by zips, 35 ms and 1.37 MB by piz, 9 ms and 3.8 MB by rle, 4 ms and 7.7 MB by none. */
static const struct sf_option capture_options[] = {
    {"output", 'o', SF_OPTION_LIST, FIELD(outputs), .value = "PATTERN",
     .doc = "files, .exr or .png, #### or %04d the frame; repeatable"},
    {"frames", 'f', SF_OPTION_TEXT, FIELD(frames), .value = "LIST", .initial = "0",
     .doc = "frame numbers, such as 1-100x2,150"},
    {"type", 0, SF_OPTION_WORD, FIELD(type), .value = "TYPE", .initial = "half", .doc = "numbers in EXR files",
     .words = types},
    {"compression", 0, SF_OPTION_WORD, FIELD(compression), .value = "NAME", .initial = "zip", .doc = "of EXR files",
     .words = compressions},
    {"tone", 0, SF_OPTION_WORD, FIELD(tone), .value = "NAME", .doc = "mapping for PNG files, not the scene's",
     .words = tones},
    {"exposure", 0, SF_OPTION_REAL, FIELD(exposure), .value = "STOPS", .doc = "for PNG files, not the scene's",
     .min = -32, .max = 32},
    {"inspect", 0, SF_OPTION_TEXT, FIELD(inspect), .value = "IMAGE",
     .doc = "write this image of the frame's graph (see sfumato graph), not the picture"},
    {"compare", 0, SF_OPTION_TEXT, FIELD(beside), .value = "METHOD",
     .doc = "draw right of a line by this method; left by the scene's"},
    {"wipe", 0, SF_OPTION_REAL, FIELD(wipe), .value = "X",
     .doc = "where the second begins, 0 (left) to 1 (default: 0.5)", .min = 0, .max = 1},
    {"overwrite", 0, SF_OPTION_FLAG, FIELD(overwrite), .doc = "replace files that exist"},
    {"skip-existing", 0, SF_OPTION_FLAG, FIELD(skip_existing), .doc = "leave files that exist, and render the others"},
    {"threads", 0, SF_OPTION_NUMBER, FIELD(threads), .value = "N",
     .doc = "that write files (default: one a core, at most 4)", .min = 1, .max = 64},
    {.name = NULL}};

static const struct sf_option view_options[] = {
    {"size", 's', SF_OPTION_SIZE, FIELD(size), .value = "WxH", .doc = "of the window (default: as last time)", .min = 1,
     .max = SIDE_MAX},
    {"frame", 'f', SF_OPTION_NUMBER, FIELD(first_frame), .value = "N", .initial = "0", .doc = "begin there", .min = 0,
     .max = 1000000},
    {"paused", 0, SF_OPTION_FLAG, FIELD(paused), .doc = "begin with time standing still"},
    {"fullscreen", 0, SF_OPTION_FLAG, FIELD(fullscreen), .doc = "fill the screen"},
    {"bare", 0, SF_OPTION_FLAG, FIELD(bare), .doc = "begin without panels (Tab shows them)"},
    {"look", 0, SF_OPTION_TEXT, FIELD(inspect), .value = "IMAGE",
     .doc = "begin with this image or buffer of the frame's graph in the picture's place"},
    {"compare", 0, SF_OPTION_TEXT, FIELD(beside), .value = "METHOD",
     .doc = "begin with this method right of a line (M), beside the scene's"},
    {"wipe", 0, SF_OPTION_REAL, FIELD(wipe), .value = "X",
     .doc = "where the second begins, 0 (left) to 1 (default: 0.5)", .min = 0, .max = 1},
    {"present-mode", 0, SF_OPTION_TEXT, FIELD(present_mode), .value = "NAME",
     .doc = "fifo (waits for the screen), fifo_relaxed, mailbox, immediate"},
    {"goal", 0, SF_OPTION_REAL, FIELD(goal), .value = "MS",
     .doc = "a picture's time while the camera moves; smoke becomes coarser to hold it", .min = 1, .max = 10000},
    {"no-adapt", 0, SF_OPTION_FLAG, FIELD(no_adapt), .doc = "smoke never becomes coarser"},
    {"shots", 0, SF_OPTION_TEXT, FIELD(folder), .value = "FOLDER", .initial = "shots",
     .doc = "for screenshots and recordings"},
    {"shaders", 0, SF_OPTION_TEXT, FIELD(shaders), .value = "FOLDER", .initial = "glsl",
     .doc = "sources that are watched, compiled and taken up"},
    {"exit-after", 0, SF_OPTION_NUMBER, FIELD(exit_after), .value = "N", .doc = "close after N times shown", .min = 1,
     .max = UINT32_MAX},
    {"report", 0, SF_OPTION_TEXT, FIELD(json_file), .value = "FILE",
     .doc = "at the end write counts and times as JSON (- is standard output)"},
    {.name = NULL}};

static const struct sf_option bench_options[] = {
    {"size", 's', SF_OPTION_SIZE, FIELD(size), .value = "WxH",
     .doc = "pixels of the picture [800x800; a suite has its own]", .min = 1, .max = SIDE_MAX},
    {"frames", 'f', SF_OPTION_TEXT, FIELD(frames), .value = "LIST", .initial = "96-127",
     .doc = "frames that are timed"},
    {"warmup", 0, SF_OPTION_NUMBER, FIELD(warmup), .value = "N", .initial = "8",
     .doc = "frames before them that are not", .min = 0, .max = 100000},
    {"repeats", 0, SF_OPTION_NUMBER, FIELD(repeats), .value = "N", .initial = "3", .doc = "how often", .min = 1,
     .max = 100000},
    {"json", 0, SF_OPTION_TEXT, FIELD(json_file), .value = "FILE", .doc = "write a report (- is standard output)"},
    {"csv", 0, SF_OPTION_TEXT, FIELD(csv_file), .value = "FILE", .doc = "write the passes as a table"},
    {"trace", 0, SF_OPTION_TEXT, FIELD(trace_file), .value = "FILE", .doc = "write every pass for chrome://tracing"},
    {"compare", 0, SF_OPTION_TEXT, FIELD(compare_file), .value = "FILE",
     .doc = "print the ratio to an older --json report"},
    {"sort", 0, SF_OPTION_FLAG, FIELD(sort), .doc = "time the particles' sort instead; takes no SCENE"},
    {"suite", 0, SF_OPTION_WORD, FIELD(suite), .value = "NAME", .doc = "a published table, run here; takes no SCENE",
     .words = sf_suite_names},
    {"quick", 0, SF_OPTION_FLAG, FIELD(quick), .doc = "a suite in small pictures, two frames each"},
    {"sizes", 0, SF_OPTION_TEXT, FIELD(sizes), .value = "LIST", .doc = "pairs to sort, such as 16384,65536"},
    {.name = NULL}};

static const struct sf_option verify_options[] = {
    {"methods", 0, SF_OPTION_TEXT, FIELD(methods), .value = "LIST",
     .doc = "with commas between (default: all that draw smoke)"},
    {"settings", 0, SF_OPTION_FLAG, FIELD(settings),
     .doc = "each method also at coarser and finer settings, one changed at a time"},
    {"size", 's', SF_OPTION_SIZE, FIELD(size), .value = "WxH", .initial = "200x200", .doc = "pixels that are compared",
     .min = 1, .max = SIDE_MAX},
    {"frames", 'f', SF_OPTION_TEXT, FIELD(frames), .value = "LIST", .initial = "36",
     .doc = "frames of each scene, such as 24,48"},
    {"output", 'o', SF_OPTION_TEXT, FIELD(folder), .value = "DIR",
     .doc = "make a page there: index.html with pictures, plots, and verify.json"},
    {"overwrite", 0, SF_OPTION_FLAG, FIELD(overwrite), .doc = "replace a page that verify made"},
    {"json", 0, SF_OPTION_FLAG, FIELD(json), .doc = "print JSON in place of the table"},
    {"goals", 0, SF_OPTION_FLAG, FIELD(goals), .doc = "say which rows reach the goals"},
    {"require-goals", 0, SF_OPTION_FLAG, FIELD(require_goals), .doc = "a row that does not is an error"},
    {"tolerance", 0, SF_OPTION_REAL, FIELD(tolerance), .value = "X", .initial = "1e-4",
     .doc = "of the reference's radiance, relative", .min = 1e-9, .max = 0.1},
    {"stride", 0, SF_OPTION_NUMBER, FIELD(stride), .value = "N",
     .doc = "compare one pixel of each NxN (default: all, fewer with many particles)", .min = 1, .max = 1024},
    {"threads", 0, SF_OPTION_NUMBER, FIELD(threads), .value = "N", .doc = "for the reference (default: one a core)",
     .min = 1, .max = 1024},
    {"time-size", 0, SF_OPTION_SIZE, FIELD(time_size), .value = "WxH", .initial = "800x800",
     .doc = "pixels of the frames that are timed", .min = 1, .max = SIDE_MAX},
    {"repeats", 0, SF_OPTION_NUMBER, FIELD(repeats), .value = "N", .initial = "5",
     .doc = "times of each, at most; 0: none", .min = 0, .max = 100000},
    {"set", 0, SF_OPTION_LIST, FIELD(sets), .value = "GROUP.KEY=VALUE",
     .doc = "a parameter over the scenes' (see sfumato params); repeatable"},
    {.name = NULL}};

/* Defaults and ranges are those of sf_texture_options_init and of struct sf_texture_options. */
static const struct sf_option texture_options[] = {
    {"kind", 0, SF_OPTION_WORD, FIELD(kind), .value = "KIND", .initial = "dispersed", .doc = "of smoke",
     .words = texture_kinds},
    {"tiles", 0, SF_OPTION_GRID, FIELD(tiles), .value = "NxM", .initial = "2x2", .doc = "tiles across and down",
     .min = 1, .max = 64},
    {"size", 's', SF_OPTION_SIZE, FIELD(size), .value = "WxH", .initial = "256x256", .doc = "pixels of a tile",
     .min = 8, .max = 8192},
    {"seed", 0, SF_OPTION_NUMBER, FIELD(seed), .value = "N", .initial = "1", .doc = "another one, other smoke",
     .min = 0, .max = UINT32_MAX},
    {"octaves", 0, SF_OPTION_NUMBER, FIELD(octaves), .value = "N", .initial = "5", .doc = "of noise, 1 to 10", .min = 1,
     .max = 10},
    {"lacunarity", 0, SF_OPTION_REAL, FIELD(lacunarity), .value = "X", .initial = "2",
     .doc = "frequency of an octave to that of the one before", .min = 1.2, .max = 4},
    {"roughness", 0, SF_OPTION_REAL, FIELD(roughness), .value = "X", .initial = "0.5",
     .doc = "amplitude likewise, 0 to 1", .min = 0, .max = 1},
    {"scale", 0, SF_OPTION_REAL, FIELD(scale), .value = "X", .initial = "4",
     .doc = "features of the first octave across the puff", .min = 0.5, .max = 64},
    {"ragged", 0, SF_OPTION_REAL, FIELD(ragged), .value = "X", .initial = "0.8",
     .doc = "how far noise moves the outline, 0 (a ball) to 2", .min = 0, .max = 2},
    {"softness", 0, SF_OPTION_REAL, FIELD(softness), .value = "X", .initial = "0.8",
     .doc = "how slowly it becomes dense from the outline inwards, to 2", .min = 0.02, .max = 2},
    {"density", 0, SF_OPTION_REAL, FIELD(density), .value = "X", .initial = "10",
     .doc = "optical depth through the middle", .min = 0.1, .max = 100},
    {"mottle", 0, SF_OPTION_REAL, FIELD(mottle), .value = "X", .initial = "0.2",
     .doc = "how dark the colour is in the hollows, 0 (white) to 1", .min = 0, .max = 1},
    {"clones", 0, SF_OPTION_NUMBER, FIELD(clones), .value = "N", .initial = "80", .doc = "of the puff, when dispersed",
     .min = 1, .max = 2000},
    {"loop", 0, SF_OPTION_NUMBER, FIELD(loop), .value = "K", .initial = "1",
     .doc = "each K tiles are one smoke at K times of a cycle", .min = 1, .max = 4096},
    {"changes", 0, SF_OPTION_NUMBER, FIELD(changes), .value = "N", .initial = "3",
     .doc = "how often it becomes another one in a cycle", .min = 1, .max = 32},
    {"tileable", 0, SF_OPTION_FLAG, FIELD(tileable), .doc = "a layer that repeats at the tiles' borders, not a puff"},
    {"channels", 0, SF_OPTION_WORD, FIELD(channels), .value = "WHICH", .initial = "all", .doc = "of each file",
     .words = texture_channels},
    {"bits", 0, SF_OPTION_WORD, FIELD(bits), .value = "N", .initial = "8", .doc = "of numbers in PNG files",
     .words = texture_bits},
    {"type", 0, SF_OPTION_WORD, FIELD(type), .value = "TYPE", .initial = "half", .doc = "numbers in EXR files",
     .words = types},
    {"compression", 0, SF_OPTION_WORD, FIELD(compression), .value = "NAME", .initial = "zip", .doc = "of EXR files",
     .words = compressions},
    {"overwrite", 0, SF_OPTION_FLAG, FIELD(overwrite), .doc = "replace files that exist"},
    {"threads", 0, SF_OPTION_NUMBER, FIELD(threads), .value = "N", .doc = "that make it (default: one a core)",
     .min = 1, .max = 64},
    {.name = NULL}};

static const struct sf_option devices_options[] = {{"json", 0, SF_OPTION_FLAG, FIELD(json), .doc = "as JSON"},
                                                   {.name = NULL}};

static const struct sf_option graph_options[] = {{"format", 0, SF_OPTION_WORD, FIELD(format), .value = "FORMAT",
                                                  .initial = "text", .doc = "of the output", .words = graph_formats},
                                                 {.name = NULL}};

static const struct sf_option params_options[] = {
    {"format", 0, SF_OPTION_WORD, FIELD(format), .value = "FORMAT", .initial = "text", .doc = "of the output",
     .words = params_formats},
    {"effects", 0, SF_OPTION_FLAG, FIELD(effects), .doc = "the keys of effect files, not of scenes"},
    {.name = NULL}};

static const struct sf_option *const capture_tables[] = {capture_options, size_options,   aov_options, scene_options,
                                                         device_options,  common_options, NULL};
static const struct sf_option *const view_tables[] = {view_options, scene_options, device_options, common_options,
                                                      NULL};
static const struct sf_option *const bench_tables[] = {bench_options,  aov_options,    scene_options,
                                                       device_options, common_options, NULL};
static const struct sf_option *const verify_tables[] = {verify_options, device_options, common_options, NULL};
static const struct sf_option *const texture_tables[] = {texture_options, common_options, NULL};
static const struct sf_option *const devices_tables[] = {devices_options, common_options, NULL};
static const struct sf_option *const graph_tables[] = {graph_options, size_options,   aov_options,
                                                       scene_options, common_options, NULL};
static const struct sf_option *const params_tables[] = {params_options, common_options, NULL};
static const struct sf_option *const check_tables[] = {scene_options, common_options, NULL};

static const struct sf_option *const effect_tables[] = {common_options, NULL};

static const char *const capture_notes[] = {
    "Without -o the files are named after the scene, in the current folder. Ctrl-C finishes the frame in hand.",
    "  sfumato capture scenes/plume.json -o out/plume.####.exr -o out/plume.####.png --frames 0-95", NULL};
static const char *const bench_notes[] = {
    "  sfumato bench scenes/plume.json --set thick.steps=24 --compare before.json",
    "  sfumato bench --suite larsson-table1 --json table1.json", NULL};
static const char *const verify_notes[] = {"Without SCENE: those of scenes/truth, here or beside the program.",
                                           "  sfumato verify scenes/truth/*.json --set thick.steps=32 --goals", NULL};
static const char *const texture_notes[] = {
    "Names end in .exr or .png. With all channels a.png becomes a.color.png and a.normal.png (heights in its alpha).",
    "  sfumato texture out/puffs.exr out/puffs.png --tiles 4x4 -s 128x128 --loop 16", NULL};
static const char *const graph_notes[] = {"  sfumato graph scenes/plume.json --format dot | dot -Tsvg > graph.svg",
                                          NULL};

static const char *const effect_notes[] = {"  sfumato effect scenes/effects/*.json", NULL};

static const char *const view_notes[] = {
    "Without SCENE: scenes/plume.json, or the last one. ? lists the keys, Tab hides the panels.", NULL};

#if !defined(SF_VIEWER)
static enum sf_status sf_view_run(const struct sf_arguments *arguments)
{
    (void)arguments;
    return sf_console_fail(SF_ERROR_USAGE, "this build has no viewer: configure it with meson -Dviewer=enabled");
}
#endif

const struct sf_command sf_commands[] = {
    {"view", "[SCENE]", "Opens a window on a scene, with every knob to turn.", view_notes, view_tables, 0, 1,
     sf_view_run},
    {"capture", "SCENE", "Renders frames of a scene into EXR and PNG files.", capture_notes, capture_tables, 1, 1,
     sf_capture_run},
    {"bench", "[SCENE]", "Times every pass of a scene's frames on the device.", bench_notes, bench_tables, 0, 1,
     sf_bench_run},
    {"verify", "[SCENE...]", "Says how wrong each method is, and how fast.", verify_notes, verify_tables, 0, SIZE_MAX,
     sf_verify_run},
    {"texture", "OUTPUT...", "Makes atlases of smoke for particles: colour, alpha, normals, heights.", texture_notes,
     texture_tables, 1, SF_TEXTURE_OUTPUTS_MAX, sf_texture_run},
    {"devices", "", "Lists the Vulkan devices of this machine.", NULL, devices_tables, 0, 0, sf_devices_run},
    {"graph", "SCENE", "Prints the compiled render graph of a scene's frame; needs no device.", graph_notes,
     graph_tables, 1, 1, sf_graph_run},
    {"params", "", "Prints all parameters: defaults, ranges, units, meanings.", NULL, params_tables, 0, 0,
     sf_params_run},
    {"check", "SCENE...", "Checks scene files and says what is wrong with them.", NULL, check_tables, 1, SIZE_MAX,
     sf_check_run},
    {"effect", "EFFECT...", "Checks effect files and lists what they do, and when.", effect_notes, effect_tables, 1,
     SIZE_MAX, sf_effect_run},
    {.name = NULL}};
