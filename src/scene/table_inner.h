/* Shared by the two files of the table: how rows are written, and the groups that one file defines for the other. */
#ifndef SF_SCENE_TABLE_INNER_H
#define SF_SCENE_TABLE_INNER_H

#include "scene/scene.h"
#include "scene/table.h"

/* The first members of a row; designated ones (.only_for and the like) may follow. S: the struct, f: its field. */
#define ROW_BOOL(k, S, f, def, text)                                                                                   \
    .key = k, .type = SF_PARAM_BOOL, .offset = SF_OFFSET(S, f, bool), .value = {def}, .max = 1, .unit = "", .doc = text
#define ROW_INT(k, S, f, def, low, high, u, text)                                                                      \
    .key = k, .type = SF_PARAM_INT, .offset = SF_OFFSET(S, f, int32_t), .value = {def}, .min = low, .max = high,       \
    .unit = u, .doc = text
#define ROW_FLOAT(k, S, f, def, low, high, u, text)                                                                    \
    .key = k, .type = SF_PARAM_FLOAT, .offset = SF_OFFSET(S, f, float), .value = {def}, .min = low, .max = high,       \
    .unit = u, .doc = text
#define ROW_VEC3(k, S, f, x, y, z, low, high, u, text)                                                                 \
    .key = k, .type = SF_PARAM_VEC3, .offset = SF_OFFSET(S, f, sf_param_vec3), .value = {x, y, z}, .min = low,         \
    .max = high, .unit = u, .doc = text
#define ROW_COLOR(k, S, f, x, y, z, high, u, text)                                                                     \
    .key = k, .type = SF_PARAM_COLOR, .offset = SF_OFFSET(S, f, sf_param_vec3), .value = {x, y, z}, .max = high,       \
    .unit = u, .doc = text
#define ROW_RANGE(k, S, f, x, y, low, high, u, text)                                                                   \
    .key = k, .type = SF_PARAM_RANGE, .offset = SF_OFFSET(S, f, sf_param_vec2), .value = {x, y}, .min = low,           \
    .max = high, .unit = u, .doc = text
#define ROW_ENUM(k, S, f, list, def, text)                                                                             \
    .key = k, .type = SF_PARAM_ENUM, .offset = SF_OFFSET(S, f, int32_t), .names = list, .value = {def}, .unit = "",    \
    .doc = text
#define ROW_STRING(k, S, f, text)                                                                                      \
    .key = k, .type = SF_PARAM_STRING, .offset = SF_OFFSET(S, f, sf_param_string), .unit = "", .doc = text
#define ROW_LIST(k, S, f, counter, of, low, high, text)                                                                \
    .key = k, .type = SF_PARAM_LIST, .offset = offsetof(S, f), .count_offset = SF_OFFSET(S, counter, uint32_t),        \
    .group = &of, .list_min = low, .list_max = high, .unit = "", .doc = text
#define GROUP(n, S, list, text)                                                                                        \
    {                                                                                                                  \
        .name = n, .doc = text, .rows = list, .count = SF_COUNT(list), .size = sizeof(S)                               \
    }

extern const struct sf_param_group sf_scene_camera_group, sf_scene_light_group, sf_scene_object_group,
    sf_scene_emitter_group, sf_scene_force_group, sf_scene_effect_group;

#endif
