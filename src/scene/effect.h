/* Effects: what an effect file says, as the rows of scene/table_effects.c read it. They live while a scene is loaded; afterwards there are
 * the emitters, lights, flashes and shakes that scene/effects.c has made of them. */
#ifndef SF_SCENE_EFFECT_H
#define SF_SCENE_EFFECT_H

#include "params/params.h"
#include "scene/scene.h"

enum { SF_STEPS_MAX = 64, SF_EFFECT_DEPTH_MAX = 4 };

enum sf_step_kind { SF_STEP_EMITTER, SF_STEP_LIGHT, SF_STEP_FLASH, SF_STEP_SHAKE, SF_STEP_EFFECT };
struct sf_step {
    int32_t kind;
    struct sf_clock clock; /* on the effect's clock */
    float fade_in, fade_out;
    int32_t easing;
    struct sf_emitter emitter;
    struct sf_light light;
    float flicker, frequency; /* light: share, 1/s; shake: frequency */
    struct sf_flash flash;
    struct sf_shake shake;
    const char *file; /* effect */
    float position[3], rotation, scale;
};

struct sf_effect {
    const char *name;
    float duration; /* s; 0: as long as its steps */
    bool loop;
    struct sf_step *steps;
    uint32_t step_count;
};

/* A whole effect file: struct sf_effect. An element of a scene's effects: struct sf_placed_effect. */
extern const struct sf_param_group sf_effect_group, sf_scene_effect_group;

/* What one key alone cannot say, of the clock and the fades of the object at the pointer `at`. */
struct sf_param_reader;
enum sf_status sf_scene_check_clock(const struct sf_clock *clock, struct sf_param_reader *reader, const char *at);

#endif
