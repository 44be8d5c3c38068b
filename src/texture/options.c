/* The kinds of texture, what the options may be, and what they are unless told. */
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/suggest.h"
#include "output/image.h"
#include "texture/texture.h"

enum { TILES_MAX = 64, SIDE_MIN = 8, SIDE_MAX = 8192, CLONES_MAX = 2000, CHANGES_MAX = 32 };
static const uint64_t PIXELS_MAX = 1u << 26;

static const struct sf_texture_kind kinds[] = {{"fbm", SF_FIELD_SUM, false},
                                               {"turbulence", SF_FIELD_ABSOLUTE, false},
                                               {"cellular", SF_FIELD_CELLS, false},
                                               {"dispersed", SF_FIELD_ABSOLUTE, true}};

const struct sf_texture_kind *sf_texture_kind_find(const char *name)
{
    for (size_t i = 0; i < SF_COUNT(kinds); i++)
        if (strcmp(kinds[i].name, name) == 0)
            return &kinds[i];
    return NULL;
}

void sf_texture_options_init(struct sf_texture_options *options)
{
    *options = (struct sf_texture_options){
        .kind = "dispersed",
        .tiles_x = 2,
        .tiles_y = 2,
        .width = 256,
        .height = 256,
        .seed = 1,
        .octaves = 5,
        .lacunarity = 2,
        .roughness = 0.5f,
        .scale = 4,
        .ragged = 0.8f,
        .softness = 0.8f,
        .density = 10,
        .mottle = 0.2f,
        .clones = 80,
        .loop = 1,
        .changes = 3,
    };
}

static enum sf_status unknown_kind(const char *name, const struct sf_log *log)
{
    const char *names[SF_COUNT(kinds)], *near;

    for (size_t i = 0; i < SF_COUNT(kinds); i++)
        names[i] = kinds[i].name;
    near = sf_suggest(name, names, SF_COUNT(kinds));
    if (near)
        return sf_fail(log, SF_ERROR_USAGE, "texture: unknown kind '%s', did you mean %s?", name, near);
    return sf_fail(log, SF_ERROR_USAGE, "texture: unknown kind '%s': fbm, turbulence, cellular, dispersed", name);
}

static enum sf_status check_layout(const struct sf_texture_options *options, const struct sf_log *log)
{
    uint64_t width = (uint64_t)options->tiles_x * options->width, height = (uint64_t)options->tiles_y * options->height;

    if (options->loop < 1 || options->tiles_x * options->tiles_y % options->loop != 0)
        return sf_fail(log, SF_ERROR_USAGE, "texture: a loop of %u does not divide the %ux%u tiles",
                       (unsigned)options->loop, (unsigned)options->tiles_x, (unsigned)options->tiles_y);
    if (width > SF_IMAGE_SIDE_MAX || height > SF_IMAGE_SIDE_MAX || width * height > PIXELS_MAX)
        return sf_fail(log, SF_ERROR_USAGE, "texture: %ju x %ju pixels are over the limit of %u a side and %ju in all",
                       (uintmax_t)width, (uintmax_t)height, SF_IMAGE_SIDE_MAX, (uintmax_t)PIXELS_MAX);
    return SF_OK;
}

enum sf_status sf_texture_options_check(const struct sf_texture_options *o, const struct sf_log *log)
{
    const struct {
        const char *name;
        double value, min, max;
    } ranges[] = {
        {"tiles_x", o->tiles_x, 1, TILES_MAX},
        {"tiles_y", o->tiles_y, 1, TILES_MAX},
        {"width", o->width, SIDE_MIN, SIDE_MAX},
        {"height", o->height, SIDE_MIN, SIDE_MAX},
        {"octaves", o->octaves, 1, SF_FIELD_OCTAVES_MAX},
        {"lacunarity", o->lacunarity, 1.2, 4},
        {"roughness", o->roughness, 0, 1},
        {"scale", o->scale, 0.5, 64},
        {"ragged", o->ragged, 0, 2},
        {"softness", o->softness, 0.02, 2},
        {"density", o->density, 0.1, 100},
        {"mottle", o->mottle, 0, 1},
        {"clones", o->clones, 1, CLONES_MAX},
        {"changes", o->changes, 1, CHANGES_MAX},
    };

    if (!sf_texture_kind_find(o->kind))
        return unknown_kind(o->kind, log);
    for (size_t i = 0; i < SF_COUNT(ranges); i++)
        if (!(ranges[i].value >= (float)ranges[i].min && ranges[i].value <= (float)ranges[i].max))
            return sf_fail(log, SF_ERROR_USAGE, "texture: %s is %g, and must be from %g to %g", ranges[i].name,
                           ranges[i].value, ranges[i].min, ranges[i].max);
    return check_layout(o, log);
}

char *sf_texture_options_print(const struct sf_texture_options *o)
{
    struct sf_text text = {0};

    sf_text_printf(&text, "kind=%s tiles=%ux%u size=%ux%u seed=%u octaves=%u lacunarity=%g roughness=%g scale=%g",
                   o->kind, (unsigned)o->tiles_x, (unsigned)o->tiles_y, (unsigned)o->width, (unsigned)o->height,
                   (unsigned)o->seed, (unsigned)o->octaves, (double)o->lacunarity, (double)o->roughness,
                   (double)o->scale);
    sf_text_printf(&text, " ragged=%g softness=%g density=%g mottle=%g", (double)o->ragged, (double)o->softness,
                   (double)o->density, (double)o->mottle);
    if (sf_texture_kind_find(o->kind)->clones)
        sf_text_printf(&text, " clones=%u", (unsigned)o->clones);
    if (o->loop > 1)
        sf_text_printf(&text, " loop=%u changes=%u", (unsigned)o->loop, (unsigned)o->changes);
    if (o->tileable)
        sf_text_append(&text, " tileable");
    if (text.failed)
        sf_text_finish(&text);
    return text.data;
}
