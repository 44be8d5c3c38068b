/* How values become colours. By themselves ("automatic") ranges go from the least to the greatest value, of those that are
 * below SF_NO_DEPTH in size; values all below 0 (far depths stored as their negatives) go by their size. Red, green and
 * blue are ranged together when they are alike, as those of a picture are, else each for itself: then they are
 * quantities of different kinds. */
#include "looking.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "heat.h"
#include "view.h"

enum { CHANNELS = 4 };
enum { CHECK = 6, MARGIN = 24, GRID_SCALE = 8 }; /* px: of a check; that stay in the place; a texel with a border */
static const float SCALE_MAX = 128, ZOOM_MIN = 0.5f, ZOOM_STEP = 1.25f;
static const float WIDE = 16;     /* greatest over least: from here on logarithms serve better */
static const float ALIKE = 8;     /* greatest values of channels that belong together */
static const float LEAST = 1e-6f; /* of the greatest value: where logarithms begin beside zeros */
static const uint8_t OUTSIDE[3] = {20, 21, 23}, NOTHING[3] = {24, 29, 40};
static const uint8_t UNWRITTEN[2][3] = {{56, 11, 53}, {78, 17, 74}};

/* ---- place ---- */

static float zoom_of(const struct sf_looking *looking)
{
    return looking->zoom > 0 ? looking->zoom : 1;
}

static float fit_of(const struct sf_looking *looking, float width, float height)
{
    if (looking->width == 0 || looking->height == 0)
        return 1;
    return fminf(width / (float)looking->width, height / (float)looking->height);
}

float sf_looking_scale(const struct sf_looking *looking, float width, float height)
{
    return fit_of(looking, width, height) * zoom_of(looking);
}

/* The place's px that texel 0 begins at, along one side. */
static float origin_of(float side, float pan, uint32_t texels, float scale)
{
    return side / 2 + pan - (float)texels * scale / 2;
}

/* The texel at a px, or -1. */
static int64_t texel_at(float at, float origin, float scale, uint32_t texels)
{
    float texel = floorf((at - origin) / scale);

    return texel >= 0 && texel < (float)texels ? (int64_t)texel : -1;
}

bool sf_looking_texel(const struct sf_looking *looking, float width, float height, float x, float y, uint32_t *column,
                      uint32_t *row)
{
    float scale = sf_looking_scale(looking, width, height);
    int64_t at_x = texel_at(x, origin_of(width, looking->pan_x, looking->width, scale), scale, looking->width);
    int64_t at_y = texel_at(y, origin_of(height, looking->pan_y, looking->height, scale), scale, looking->height);

    *column = at_x >= 0 ? (uint32_t)at_x : 0;
    *row = at_y >= 0 ? (uint32_t)at_y : 0;
    return at_x >= 0 && at_y >= 0;
}

void sf_looking_spot(const struct sf_looking *looking, float width, float height, uint32_t column, uint32_t row,
                     float *x, float *y)
{
    float scale = sf_looking_scale(looking, width, height);

    *x = origin_of(width, looking->pan_x, looking->width, scale) + ((float)column + 0.5f) * scale;
    *y = origin_of(height, looking->pan_y, looking->height, scale) + ((float)row + 0.5f) * scale;
}

void sf_looking_pan(struct sf_looking *looking, float width, float height, float dx, float dy)
{
    float scale = sf_looking_scale(looking, width, height);
    float most_x = fmaxf((width + (float)looking->width * scale) / 2 - MARGIN, 0);
    float most_y = fmaxf((height + (float)looking->height * scale) / 2 - MARGIN, 0);

    looking->pan_x = fminf(fmaxf(looking->pan_x + dx, -most_x), most_x);
    looking->pan_y = fminf(fmaxf(looking->pan_y + dy, -most_y), most_y);
}

void sf_looking_zoom(struct sf_looking *looking, float width, float height, float x, float y, float steps)
{
    float before = zoom_of(looking), most = fmaxf(SCALE_MAX / fit_of(looking, width, height), 1);
    float after = fminf(fmaxf(before * powf(ZOOM_STEP, steps), ZOOM_MIN), most);
    float from_x = x - width / 2, from_y = y - height / 2;

    if (fabsf(after - 1) < 1e-3f) /* as many steps back lead to where it fits */
        after = 1;
    looking->zoom = after;
    looking->pan_x = from_x - (from_x - looking->pan_x) * after / before;
    looking->pan_y = from_y - (from_y - looking->pan_y) * after / before;
    sf_looking_pan(looking, width, height, 0, 0);
}

void sf_looking_fit(struct sf_looking *looking)
{
    looking->zoom = 1;
    looking->pan_x = looking->pan_y = 0;
}

static const uint64_t HASH_BEGIN = 0xcbf29ce484222325u; /* FNV-1a */

static uint64_t hash_bytes(uint64_t hash, const void *bytes, size_t count)
{
    const uint8_t *byte = bytes;

    for (size_t i = 0; i < count; i++)
        hash = (hash ^ byte[i]) * 0x100000001b3u;
    return hash;
}

/* ---- ranges ---- */

struct extremes {
    float least, greatest, nearest; /* nearest: the smallest above 0; none: SF_NO_DEPTH */
};

static bool counts(float value)
{
    return fabsf(value) < SF_NO_DEPTH; /* false for NaN */
}

static struct extremes extremes_of(const struct sf_looking *looking, uint32_t channel)
{
    struct extremes found = {SF_NO_DEPTH, -SF_NO_DEPTH, SF_NO_DEPTH};
    size_t count = (size_t)looking->width * looking->height;
    const float *value = looking->values + channel;

    for (size_t i = 0; i < count; i++, value += looking->channels)
        if (counts(*value)) {
            found.least = *value < found.least ? *value : found.least;
            found.greatest = *value > found.greatest ? *value : found.greatest;
            found.nearest = *value > 0 && *value < found.nearest ? *value : found.nearest;
        }
    return found;
}

/* range[0] becomes black, range[1] white; the first may be the greater one. */
static void range_of(struct extremes found, bool logarithmic, float range[2])
{
    if (found.least > found.greatest) { /* nothing counts */
        range[0] = 0;
        range[1] = 1;
    } else if (found.greatest < 0) {
        range[0] = found.greatest;
        range[1] = found.least;
    } else {
        range[0] = found.least;
        range[1] = found.greatest;
        if (logarithmic && found.greatest > 0 && found.least <= 0)
            range[0] = fmaxf(found.nearest, found.greatest * LEAST);
    }
    if (range[0] == range[1]) {
        range[0] = logarithmic ? range[1] / 10 : 0;
        range[1] = range[1] != 0 ? range[1] : 1;
    }
}

/* Red, green and blue belong together. */
static bool alike(const struct extremes found[3])
{
    float most = 0, smallest = SF_NO_DEPTH;

    for (int c = 0; c < 3; c++) {
        if (!(found[c].least >= 0) || found[c].least > found[c].greatest)
            return false;
        most = fmaxf(most, found[c].greatest);
        smallest = fminf(smallest, found[c].greatest);
    }
    return most <= ALIKE * smallest;
}

/* Channels that are shown: how many, and the first. */
static uint32_t shown_channels(const struct sf_looking *looking, uint32_t *first)
{
    *first = 0;
    if (looking->channel > 0) {
        *first = (uint32_t)looking->channel <= looking->channels ? (uint32_t)looking->channel - 1 : 0;
        return 1;
    }
    return looking->channels < 3 ? looking->channels : 3;
}

/* Finds the ranges of what is shown, and says the widest in low and high. */
static void find_ranges(struct sf_looking *looking)
{
    struct extremes found[CHANNELS];
    uint32_t first, count = shown_channels(looking, &first);

    if (looking->heat) { /* as far on both sides of 0 */
        looking->high = sf_heat_scale(looking->values, (size_t)looking->width * looking->height);
        looking->low = looking->ranges[0][0] = -looking->high;
        looking->ranges[0][1] = looking->high;
        return;
    }
    for (uint32_t c = 0; c < count; c++)
        found[c] = extremes_of(looking, first + c);
    if (count == 3 && alike(found)) {
        for (uint32_t c = 1; c < count; c++) {
            found[0].least = fminf(found[0].least, found[c].least);
            found[0].greatest = fmaxf(found[0].greatest, found[c].greatest);
            found[0].nearest = fminf(found[0].nearest, found[c].nearest);
        }
        found[1] = found[2] = found[0];
    }
    for (uint32_t c = 0; c < count; c++)
        range_of(found[c], looking->logarithmic, looking->ranges[c]);
    looking->low = looking->ranges[0][0];
    looking->high = looking->ranges[0][1];
    for (uint32_t c = 1; c < count; c++) {
        looking->low = fminf(looking->low, looking->ranges[c][0]);
        looking->high = fmaxf(looking->high, looking->ranges[c][1]);
    }
}

/* When something that they follow from has changed. */
static void update_ranges(struct sf_looking *looking)
{
    const uint64_t whole[] = {looking->version, looking->logarithmic, (uint64_t)looking->channel};
    uint64_t hash = hash_bytes(HASH_BEGIN, whole, sizeof whole) | 1; /* 0: never found */

    if (!looking->automatic || looking->ranged == hash)
        return;
    find_ranges(looking);
    looking->ranged = hash;
}

/* ---- colours ---- */

/* A value to 0..255: `low` plus `gain` for each unit, or for each unit of the logarithm of value/low. */
struct map {
    float low, gain;
    bool logarithmic;
};
struct maps {
    struct map map[3];
    uint32_t first, count; /* channels shown */
    bool automatic;
    float heat; /* the end of a heat map's scale; 0: none */
};

static struct map map_of(const float range[2], bool logarithmic)
{
    float low = range[0], high = range[1];

    if (logarithmic && high != 0 && !(low / high > 0)) /* on both sides of zero, or from it */
        low = high * LEAST;
    if (logarithmic && high != 0 && low != high)
        return (struct map){low, 255 / logf(high / low), true};
    return (struct map){low, high != low ? 255 / (high - low) : 3e38f, false};
}

static uint8_t map_value(const struct map *map, float value)
{
    float part;

    if (map->logarithmic)
        part = value / map->low > 0 ? logf(value / map->low) * map->gain : 0;
    else
        part = (value - map->low) * map->gain;
    return part > 0 ? (uint8_t)(part < 255 ? part + 0.5f : 255) : 0; /* NaN: 0 */
}

static struct maps maps_of(const struct sf_looking *looking)
{
    const float given[2] = {looking->low, looking->high};
    struct maps maps = {.automatic = looking->automatic, .heat = looking->heat ? looking->high : 0};

    maps.count = shown_channels(looking, &maps.first);
    for (uint32_t c = 0; c < maps.count; c++)
        maps.map[c] = map_of(looking->automatic ? looking->ranges[c] : given, looking->logarithmic);
    return maps;
}

static void color_of(const struct maps *maps, const float *values, uint8_t rgb[3])
{
    const float *value = values + maps->first;

    if (maps->automatic && !counts(value[0])) {
        memcpy(rgb, NOTHING, 3);
        return;
    }
    if (maps->heat > 0) {
        sf_heat_color(value[0], maps->heat, rgb);
        return;
    }
    rgb[0] = map_value(&maps->map[0], value[0]);
    rgb[1] = maps->count > 1 ? map_value(&maps->map[1], value[1]) : rgb[0];
    rgb[2] = maps->count > 2 ? map_value(&maps->map[2], value[2]) : maps->count > 1 ? 0 : rgb[0];
}

void sf_looking_color(const struct sf_looking *looking, const float *values, uint8_t rgb[3])
{
    struct maps maps = maps_of(looking);

    color_of(&maps, values, rgb);
}

/* ---- pixels ---- */

struct painter {
    const struct sf_looking *looking;
    struct maps maps;
    const int64_t *columns; /* texel of each px of a row, or -1 */
    uint32_t width;
    bool grid;
    bool unwritten; /* the row holds NaN, whose checks differ from row to row */
};

static void put(uint8_t *pixel, const uint8_t rgb[3], bool border)
{
    for (int c = 0; c < 3; c++)
        pixel[c] = border ? (uint8_t)(rgb[c] - rgb[c] / 4 + 14) : rgb[c];
    pixel[3] = 255;
}

static void paint_row(struct painter *painter, int64_t row, bool border, uint32_t y, uint8_t *pixels)
{
    const struct sf_looking *looking = painter->looking;
    const float *values = looking->values + (row >= 0 ? (size_t)row * looking->width * looking->channels : 0);
    int64_t before = -1;
    uint8_t rgb[3] = {0};
    bool written = true;

    painter->unwritten = false;
    for (uint32_t x = 0; x < painter->width; x++, pixels += 4) {
        int64_t column = row >= 0 ? painter->columns[x] : -1;

        if (column < 0) {
            put(pixels, OUTSIDE, false);
            continue;
        }
        if (column != before) {
            const float *texel = values + (size_t)column * looking->channels;
            written = !isnan(texel[painter->maps.first]);
            color_of(&painter->maps, texel, rgb);
        }
        if (!written)
            painter->unwritten = true;
        put(pixels, written ? rgb : UNWRITTEN[(x / CHECK + y / CHECK) & 1],
            painter->grid && (border || column != before));
        before = column;
    }
}

static void paint(struct painter *painter, uint32_t height, uint8_t *pixels)
{
    const struct sf_looking *looking = painter->looking;
    float scale = sf_looking_scale(looking, (float)painter->width, (float)height);
    float origin = origin_of((float)height, looking->pan_y, looking->height, scale);
    size_t stride = (size_t)painter->width * 4;
    int64_t before = -2;
    bool border_before = false;

    for (uint32_t y = 0; y < height; y++) {
        int64_t row = texel_at((float)y + 0.5f, origin, scale, looking->height);
        bool border = painter->grid && row != before;
        uint8_t *to = pixels + y * stride;

        if (y > 0 && row == before && border == border_before && !painter->unwritten)
            memcpy(to, to - stride, stride);
        else
            paint_row(painter, row, border, y, to);
        before = row;
        border_before = border;
    }
}

/* Of all that the pixels follow from. */
static uint64_t hash_of(const struct sf_looking *looking, uint32_t width, uint32_t height)
{
    const uint64_t whole[] = {
        looking->version, looking->automatic, looking->logarithmic, (uint64_t)looking->channel, width, height};
    const float parts[] = {looking->automatic ? 0 : looking->low, looking->automatic ? 0 : looking->high,
                           zoom_of(looking), looking->pan_x, looking->pan_y};
    uint64_t hash = hash_bytes(HASH_BEGIN, whole, sizeof whole);

    return hash_bytes(hash, parts, sizeof parts) | 1; /* 0: never mapped */
}

static bool remap(struct sf_looking *looking, uint32_t width, uint32_t height)
{
    struct painter painter = {.looking = looking, .width = width};
    float scale = sf_looking_scale(looking, (float)width, (float)height);
    float origin = origin_of((float)width, looking->pan_x, looking->width, scale);
    uint8_t *pixels = realloc(looking->pixels, (size_t)width * height * 4);
    int64_t *columns = malloc(width * sizeof *columns);

    looking->pixels = pixels ? pixels : looking->pixels;
    if (pixels && columns) {
        update_ranges(looking);
        for (uint32_t x = 0; x < width; x++)
            columns[x] = texel_at((float)x + 0.5f, origin, scale, looking->width);
        painter.columns = columns;
        painter.grid = scale >= GRID_SCALE;
        painter.maps = maps_of(looking);
        paint(&painter, height, pixels);
    }
    free(columns);
    return pixels && columns;
}

const uint8_t *sf_looking_pixels(struct sf_looking *looking, uint32_t place_width, uint32_t place_height,
                                 uint32_t *width, uint32_t *height)
{
    uint64_t hash;

    *width = *height = 0;
    if (!looking->values || place_width == 0 || place_height == 0)
        return NULL;
    hash = hash_of(looking, place_width, place_height);
    if (!looking->pixels || looking->mapped != hash) {
        looking->mapped = 0;
        if (!remap(looking, place_width, place_height))
            return NULL;
        looking->mapped = hash;
    }
    *width = place_width;
    *height = place_height;
    return looking->pixels;
}

/* ---- values ---- */

/* A range of many sizes, all above 0, is looked at by logarithms at first. */
static bool wants_logarithms(const struct sf_looking *looking)
{
    struct extremes found = extremes_of(looking, 0);

    return found.least > 0 && found.least <= found.greatest && found.greatest > WIDE * found.least;
}

/* Copies `bytes` bytes into *to, which grows or shrinks; NULL gives none. */
static void copy(void **to, const void *from, size_t bytes)
{
    void *room = from && bytes > 0 ? realloc(*to, bytes) : NULL;

    if (!room) {
        free(*to);
        *to = NULL;
        return;
    }
    *to = memcpy(room, from, bytes);
}

void sf_looking_take(struct sf_looking *looking, const struct sf_frame *frame)
{
    size_t count = (size_t)frame->inspected_width * frame->inspected_height * frame->inspected_channels;
    void *values = looking->values, *words = looking->words;

    copy(&values, frame->inspected, count * sizeof *looking->values);
    copy(&words, frame->inspected_words, frame->inspected_word_count * sizeof *looking->words);
    looking->values = values;
    looking->words = words;
    looking->word_count = words ? frame->inspected_word_count : 0;
    looking->width = values ? frame->inspected_width : 0;
    looking->height = values ? frame->inspected_height : 0;
    looking->channels = values ? frame->inspected_channels : 0;
    if (looking->version++ == 0 && values && looking->automatic && !looking->heat)
        looking->logarithmic = wants_logarithms(looking);
    if (values)
        update_ranges(looking); /* the panels say them before the pixels are made */
}

void sf_looking_finish(struct sf_looking *looking)
{
    free(looking->values);
    free(looking->words);
    free(looking->pixels);
    *looking = (struct sf_looking){0};
}
