/* Effects: a scene's list of them, and the files that they are in. */
#include "scene/effect.h"
#include "scene/table_inner.h"

#define ROWS_CLOCK(S, c, since, long)                                                                                  \
    {ROW_FLOAT("start", S, c.start, 0, 0, 1e5, "s", "when it begins, counted from " since)},                           \
        {ROW_FLOAT("duration", S, c.duration, 0, 0, 1e5, "s", "how long it goes on each time; 0: " long)},             \
        {ROW_FLOAT("every", S, c.every, 0, 0, 1e5, "s", "it begins again after each such time; 0: once")},             \
    {                                                                                                                  \
        ROW_INT("times", S, c.times, 0, 0, 1000000, "", "that it begins, with every; 0: for ever")                     \
    }

static const struct sf_param placed_rows[] = {
    {ROW_STRING("file", struct sf_placed_effect, file, "an effect file, seen from the scene's folder"),
     .required = true, .rebuild = SF_REBUILD_GRAPH},
    {ROW_VEC3("position", struct sf_placed_effect, position, 0, 0, 0, -1e5, 1e5, "m", "where its origin is")},
    {ROW_FLOAT("rotation", struct sf_placed_effect, rotation, 0, -360, 360, "deg", "of all of it about +y")},
    {ROW_FLOAT("scale", struct sf_placed_effect, scale, 1, 1e-3, 1e3, "",
               "multiplies its lengths and speeds, and keeps how opaque and how bright it looks")},
    ROWS_CLOCK(struct sf_placed_effect, clock, "the simulation's beginning", "as the file says"),
};
const struct sf_param_group sf_scene_effect_group =
    GROUP("effect", struct sf_placed_effect, placed_rows, "An effect from a file, somewhere, at some time.");

#define FADING "emitter light flash shake"
static const char *const step_kinds[] = {"emitter", "light", "flash", "shake", "effect", NULL};
static const char *const easings[] = {"linear", "smooth", "in", "out", NULL};
static const struct sf_param step_rows[] = {
    {ROW_ENUM("type", struct sf_step, kind, step_kinds, SF_STEP_EMITTER,
              "particles, a lamp, light over the whole picture, an unsteady camera, or another effect"),
     .required = true},
    ROWS_CLOCK(struct sf_step, clock, "the effect's beginning", "for ever"),
    {ROW_FLOAT("fade_in", struct sf_step, fade_in, 0, 0, 1e5, "s", "in which its strength rises from 0"),
     .only_for = FADING},
    {ROW_FLOAT("fade_out", struct sf_step, fade_out, 0, 0, 1e5, "s", "in which it falls to 0 at the end"),
     .only_for = FADING},
    {ROW_ENUM("easing", struct sf_step, easing, easings, SF_EASING_LINEAR,
              "how both fades go, from 0 to 1: evenly, softly at both ends, slowly at first, quickly at first"),
     .only_for = FADING},
    {.key = "emitter",
     .type = SF_PARAM_OBJECT,
     .offset = offsetof(struct sf_step, emitter),
     .group = &sf_scene_emitter_group,
     .unit = "",
     .doc = "as in a scene, but for type list; strength multiplies its rate",
     .only_for = "emitter",
     .required = true},
    {.key = "light",
     .type = SF_PARAM_OBJECT,
     .offset = offsetof(struct sf_step, light),
     .group = &sf_scene_light_group,
     .unit = "",
     .doc = "as in a scene; strength multiplies its intensity",
     .only_for = "light",
     .required = true},
    {ROW_FLOAT("flicker", struct sf_step, flicker, 0, 0, 1, "", "share of the intensity that comes and goes"),
     .only_for = "light"},
    {ROW_FLOAT("frequency", struct sf_step, frequency, 8, 0, 1000, "1/s", "how often it changes its mind"),
     .only_for = "light shake"},
    {ROW_COLOR("color", struct sf_step, flash.color, 1, 1, 1, 1e3, "", "multiplies the strength"), .only_for = "flash"},
    {ROW_FLOAT("strength", struct sf_step, flash.strength, 1, 0, 1e4, "W/(m2 sr)",
               "radiance added to the whole picture"),
     .only_for = "flash"},
    {ROW_FLOAT("amplitude", struct sf_step, shake.amplitude, 0.02, 0, 1e3, "m",
               "how far the eye moves, at most, to each side, up and down, back and forth"),
     .only_for = "shake"},
    {ROW_FLOAT("angle", struct sf_step, shake.angle, 0.3, 0, 45, "deg",
               "how far it turns, at most: aside, up or down, and about the view"),
     .only_for = "shake"},
    {ROW_STRING("file", struct sf_step, file, "another effect file, seen from this one's folder"), .only_for = "effect",
     .required = true},
    {ROW_VEC3("position", struct sf_step, position, 0, 0, 0, -1e5, 1e5, "m", "where its origin is"),
     .only_for = "effect"},
    {ROW_FLOAT("rotation", struct sf_step, rotation, 0, -360, 360, "deg", "of all of it about +y"),
     .only_for = "effect"},
    {ROW_FLOAT("scale", struct sf_step, scale, 1, 1e-3, 1e3, "", "multiplies its lengths and speeds"),
     .only_for = "effect"},
};
static const struct sf_param_group step_group =
    GROUP("step", struct sf_step, step_rows, "Something that happens in the course of an effect.");

static const struct sf_param effect_rows[] = {
    {ROW_STRING("name", struct sf_effect, name, "what people call it")},
    {ROW_FLOAT("duration", struct sf_effect, duration, 0, 0, 1e5, "s",
               "when it ends, with all that goes on in it; 0: when its steps do")},
    {ROW_BOOL("loop", struct sf_effect, loop, 0, "it begins again at its end, for which it needs a duration")},
    {ROW_LIST("steps", struct sf_effect, steps, step_count, step_group, 1, SF_STEPS_MAX, "what happens"),
     .list_pointer = true, .required = true},
};
const struct sf_param_group sf_effect_group =
    GROUP("effect", struct sf_effect, effect_rows, "The outermost object of an effect file.");
