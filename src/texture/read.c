/* Textures from EXR and PNG files. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/file.h"
#include "output/exr.h"
#include "output/png.h"
#include "texture/texture.h"

static const char *const channel_names[8] = {"R", "G", "B", "A", "N.x", "N.y", "N.z", "height"};

/* What is known of a file before its numbers are looked at. */
struct source {
    const char *path;
    uint32_t width, height, tiles_x, tiles_y;
    uint32_t channels; /* that it has */
    const struct sf_log *log;
};

/* ---- checks ---- */

static enum sf_status check_tiles(const struct source *source)
{
    if (source->tiles_x == 0 || source->tiles_y == 0)
        return sf_fail(source->log, SF_ERROR_IO, "cannot read '%s': it does not say how many tiles it has; say it",
                       source->path);
    if (source->width % source->tiles_x != 0 || source->height % source->tiles_y != 0)
        return sf_fail(source->log, SF_ERROR_IO, "cannot read '%s': %ux%u pixels cannot be divided into %ux%u tiles",
                       source->path, (unsigned)source->width, (unsigned)source->height, (unsigned)source->tiles_x,
                       (unsigned)source->tiles_y);
    return SF_OK;
}

static enum sf_status check_channels(const struct source *source, uint32_t needs)
{
    static const char *const names[4] = {"R, G and B", "A", "N.x, N.y and N.z", "height"};

    for (int i = 0; i < 4; i++)
        if (needs & ~source->channels & 1u << i)
            return sf_fail(source->log, SF_ERROR_IO,
                           "cannot read '%s': it has no %s (an atlas holds R, G, B, A, N.x, N.y, N.z, height; sfumato "
                           "texture makes one)",
                           source->path, names[i]);
    if (!(source->channels & SF_TEXTURE_ALL))
        return sf_fail(source->log, SF_ERROR_IO, "cannot read '%s': it has none of R, G, B, A, N.x, N.y, N.z, height",
                       source->path);
    return SF_OK;
}

/* Every number is one and within its range; a little beyond it, as filters leave it, is cut off. */
static enum sf_status check_number(const struct source *source, size_t pixel, int channel, float *number)
{
    static const float slack = 0.01f;
    float least = channel >= 4 && channel < 7 ? -HUGE_VALF : 0, greatest = channel == 3 || channel == 7 ? 1 : HUGE_VALF;
    unsigned x = (unsigned)(pixel % source->width), y = (unsigned)(pixel / source->width);

    if (!isfinite(*number))
        return sf_fail(source->log, SF_ERROR_IO, "cannot read '%s': %s of pixel (%u, %u) is not a number", source->path,
                       channel_names[channel], x, y);
    if (*number < least - slack || *number > greatest + slack)
        return sf_fail(source->log, SF_ERROR_IO, "cannot read '%s': %s of pixel (%u, %u) is %g, and must be %s",
                       source->path, channel_names[channel], x, y, (double)*number,
                       greatest > 1 ? "0 or more" : "from 0 to 1");
    *number = *number < least ? least : *number > greatest ? greatest : *number;
    return SF_OK;
}

static enum sf_status check_numbers(const struct source *source, struct sf_texture *texture)
{
    size_t count = (size_t)source->width * source->height;
    enum sf_status status = SF_OK;

    for (size_t i = 0; i < count; i++) {
        float *color = texture->color + 4 * i, *shape = texture->shape + 4 * i;

        for (int c = 0; c < 4 && !status; c++)
            status = check_number(source, i, c, &color[c]);
        for (int c = 0; c < 4 && !status; c++)
            status = check_number(source, i, 4 + c, &shape[c]);
        if (status)
            return status;
        float length = sqrtf(shape[0] * shape[0] + shape[1] * shape[1] + shape[2] * shape[2]);

        /* Where there is no smoke pictures hold black, or nothing in particular. */
        for (int c = 0; c < 3; c++)
            shape[c] = length > 0.1f && isfinite(length) ? shape[c] / length : c == 2;
    }
    return SF_OK;
}

/* ---- both kinds of file ---- */

/* A texture of the file's size, white, opaque and flat. */
static enum sf_status begin(const struct source *source, struct sf_texture **texture)
{
    size_t count = (size_t)source->width * source->height * 4;

    *texture = sf_texture_alloc(source->width, source->height, source->tiles_x, source->tiles_y);
    if (!*texture)
        return sf_fail(source->log, SF_ERROR_MEMORY, "cannot read '%s': out of memory", source->path);
    for (size_t i = 0; i < count; i += 4) {
        for (size_t c = 0; c < 4; c++)
            (*texture)->color[i + c] = 1;
        (*texture)->shape[i + 2] = 1;
    }
    return SF_OK;
}

static enum sf_status end(struct source *source, uint32_t needs, struct sf_texture *texture)
{
    bool derived = (source->channels & SF_TEXTURE_HEIGHT) && !(source->channels & SF_TEXTURE_NORMAL);
    enum sf_status status = check_numbers(source, texture);

    if (derived)
        source->channels |= SF_TEXTURE_NORMAL;
    if (!status)
        status = check_channels(source, needs);
    if (!status && derived)
        sf_texture_normals(texture);
    texture->info.channels = source->channels;
    return status;
}

/* ---- EXR ---- */

/* The tiles that the file tells of, where none are asked for; else they must be the same. */
static enum sf_status told_tiles(struct source *source, const struct sf_exr *exr)
{
    const struct sf_exr_attribute *told = sf_exr_attribute(exr, "sfumatoTiles");
    char *end = NULL;
    unsigned long x, y;

    if (!told || told->kind != SF_EXR_TEXT)
        return SF_OK;
    x = strtoul(told->text, &end, 10);
    y = *end == 'x' ? strtoul(end + 1, &end, 10) : 0;
    if (*end || x < 1 || x > source->width || y < 1 || y > source->height)
        return sf_fail(source->log, SF_ERROR_IO, "cannot read '%s': sfumatoTiles is '%s', and must be as 2x2",
                       source->path, told->text);
    if (source->tiles_x == 0 && source->tiles_y == 0) {
        source->tiles_x = (uint32_t)x;
        source->tiles_y = (uint32_t)y;
    }
    if (source->tiles_x != x || source->tiles_y != y)
        return sf_fail(source->log, SF_ERROR_IO, "cannot read '%s': it has %lux%lu tiles, not %ux%u", source->path, x,
                       y, (unsigned)source->tiles_x, (unsigned)source->tiles_y);
    return SF_OK;
}

/* Whether it repeats, in space and in time. */
static enum sf_status told_repeats(const struct source *source, const struct sf_exr *exr, struct sf_texture_info *info)
{
    const struct sf_exr_attribute *tileable = sf_exr_attribute(exr, "sfumatoTileable"),
                                  *loop = sf_exr_attribute(exr, "sfumatoLoop");
    uint64_t tiles = (uint64_t)info->tiles_x * info->tiles_y;

    info->tileable = tileable && tileable->kind == SF_EXR_INTEGER && tileable->integer == 1;
    if (!loop || loop->kind != SF_EXR_INTEGER)
        return SF_OK;
    if (loop->integer < 1 || tiles % (uint32_t)loop->integer != 0)
        return sf_fail(source->log, SF_ERROR_IO, "cannot read '%s': its loop of %d does not divide its %ju tiles",
                       source->path, (int)loop->integer, (uintmax_t)tiles);
    info->loop = (uint32_t)loop->integer;
    return SF_OK;
}

/* Several channels are there, or none of them. */
static enum sf_status find_planes(struct source *source, const struct sf_exr *exr, const float *planes[8])
{
    static const struct {
        int first, count;
        uint32_t bit;
    } groups[] = {
        {0, 3, SF_TEXTURE_COLOR}, {3, 1, SF_TEXTURE_ALPHA}, {4, 3, SF_TEXTURE_NORMAL}, {7, 1, SF_TEXTURE_HEIGHT}};

    for (int i = 0; i < 8; i++)
        planes[i] = sf_exr_pixels(exr, channel_names[i]);
    for (size_t g = 0; g < sizeof groups / sizeof *groups; g++) {
        const char *missing = NULL;
        int found = 0;

        for (int i = groups[g].first; i < groups[g].first + groups[g].count; i++) {
            found += planes[i] != NULL;
            missing = planes[i] ? missing : channel_names[i];
        }
        if (found > 0 && missing)
            return sf_fail(source->log, SF_ERROR_IO, "cannot read '%s': it has %s, but no channel %s", source->path,
                           channel_names[groups[g].first + (planes[groups[g].first] == NULL)], missing);
        source->channels |= found > 0 ? groups[g].bit : 0;
    }
    return SF_OK;
}

static void take_planes(const struct source *source, const float *const planes[8], struct sf_texture *texture)
{
    size_t count = (size_t)source->width * source->height;

    for (int channel = 0; channel < 8; channel++) {
        float *to = (channel < 4 ? texture->color : texture->shape) + channel % 4;

        for (size_t i = 0; planes[channel] && i < count; i++)
            to[4 * i] = planes[channel][i];
    }
    /* Colour without alpha shows nothing: it is white then, as what is made. */
    for (size_t i = 0; planes[0] && i < count; i++)
        for (size_t c = 0; c < 3; c++) {
            float *color = &texture->color[4 * i + c], alpha = texture->color[4 * i + 3];

            if (isfinite(*color) && alpha > 0)
                *color /= alpha;
            else if (isfinite(*color))
                *color = 1;
        }
}

static enum sf_status read_exr(const void *data, size_t size, struct source *source, uint32_t needs,
                               struct sf_texture **texture)
{
    struct sf_exr exr;
    const float *planes[8];
    enum sf_status status = sf_exr_decode(data, size, source->path, NULL, 0, &exr, source->log);

    if (status)
        return status;
    source->width = exr.width;
    source->height = exr.height;
    status = sf_image_check_size(source->path, exr.width, exr.height, 8, source->log);
    if (!status)
        status = find_planes(source, &exr, planes);
    if (!status)
        status = told_tiles(source, &exr);
    if (!status)
        status = check_tiles(source);
    if (!status)
        status = begin(source, texture);
    if (!status)
        status = told_repeats(source, &exr, &(*texture)->info);
    if (!status) {
        take_planes(source, planes, *texture);
        status = end(source, needs, *texture);
    }
    sf_exr_finish(&exr);
    return status;
}

/* ---- PNG ---- */

static bool is_png(const char *data, size_t size)
{
    return size >= 8 && memcmp(data, "\x89PNG\r\n\x1a\n", 8) == 0;
}

/* "a.color.png" -> "a.normal.png"; NULL when the name is another, or memory is out. */
static char *sibling(const char *path)
{
    static const char color[] = ".color.png";
    size_t stem = strlen(path), room = stem + 2;
    char *name;

    if (!sf_path_ends(path, color))
        return NULL;
    stem -= sizeof color - 1;
    name = malloc(room);
    if (name)
        snprintf(name, room, "%.*s.normal%s", (int)stem, path, path + stem + 6);
    return name;
}

/* Normals and heights. Pictures without alpha have no heights. */
static enum sf_status read_normals(struct source *source, const char *path, struct sf_texture *texture)
{
    struct sf_image image = {0};
    char *data = NULL;
    size_t size, count = (size_t)source->width * source->height;
    bool heights = false;
    enum sf_status status = sf_file_read(path, SF_IMAGE_FILE_MAX, source->log, &data, &size);

    if (!status && !is_png(data, size))
        status = sf_fail(source->log, SF_ERROR_IO, "cannot read '%s': it is not a PNG file", path);
    if (!status)
        status = sf_png_decode_numbers(data, size, path, &image, source->log);
    free(data);
    if (!status && (image.width != source->width || image.height != source->height))
        status = sf_fail(source->log, SF_ERROR_IO, "cannot read '%s': it has %ux%u pixels, but '%s' has %ux%u", path,
                         (unsigned)image.width, (unsigned)image.height, source->path, (unsigned)source->width,
                         (unsigned)source->height);
    for (size_t i = 0; i < 4 * count && !status; i++)
        heights |= i % 4 == 3 && image.pixels[i] < 1;
    for (size_t i = 0; i < 4 * count && !status; i++)
        texture->shape[i] = i % 4 < 3 ? 2 * image.pixels[i] - 1 : heights ? image.pixels[i] : 0;
    source->channels |= SF_TEXTURE_NORMAL | (heights ? SF_TEXTURE_HEIGHT : 0);
    sf_image_finish(&image);
    return status;
}

static enum sf_status read_png(const void *data, size_t size, struct source *source, uint32_t needs,
                               struct sf_texture **texture)
{
    struct sf_image image;
    char *normals = NULL;
    enum sf_status status = sf_png_decode(data, size, source->path, &image, source->log);

    if (status)
        return status;
    source->width = image.width;
    source->height = image.height;
    source->channels = SF_TEXTURE_COLOR | SF_TEXTURE_ALPHA;
    status = sf_image_check_size(source->path, image.width, image.height, 8, source->log);
    if (!status)
        status = check_tiles(source);
    if (!status)
        status = begin(source, texture);
    if (!status) {
        memcpy((*texture)->color, image.pixels, (size_t)image.width * image.height * 4 * sizeof *image.pixels);
        normals = sibling(source->path);
    }
    if (normals && sf_file_exists(normals))
        status = read_normals(source, normals, *texture);
    if (!status)
        status = end(source, needs, *texture);
    free(normals);
    sf_image_finish(&image);
    return status;
}

enum sf_status sf_texture_load(const char *path, uint32_t tiles_x, uint32_t tiles_y, uint32_t needs,
                               const struct sf_log *log, struct sf_texture **texture)
{
    struct source source = {.path = path, .tiles_x = tiles_x, .tiles_y = tiles_y, .log = log};
    char *data;
    size_t size;
    enum sf_status status = sf_file_read(path, SF_IMAGE_FILE_MAX, log, &data, &size);

    *texture = NULL;
    if (status)
        return status;
    if (size >= 4 && memcmp(data, "\x76\x2f\x31\x01", 4) == 0)
        status = read_exr(data, size, &source, needs, texture);
    else if (is_png(data, size))
        status = read_png(data, size, &source, needs, texture);
    else
        status = sf_fail(log, SF_ERROR_IO, "cannot read '%s': it is neither EXR nor PNG", path);
    free(data);
    if (status)
        sf_texture_destroy(texture);
    return status;
}
