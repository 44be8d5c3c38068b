/* An atlas, made by all processors. */
#include <stdatomic.h>
#include <stdlib.h>
#include "base/log.h"
#include "base/thread.h"
#include "texture/body.h"
#include "texture/texture.h"

enum { BAND = 16 }; /* rows of a tile that a job makes */

struct work {
    const struct sf_texture_options *options;
    struct sf_texture *texture;
    atomic_bool stopped;
    atomic_uint rows;
};

struct band {
    struct work *work;
    uint32_t tile, first; /* row of the tile */
};

/* What a job needs besides the body. */
struct room {
    struct sf_body_pixel *pixels; /* of a row */
    uint32_t *list;               /* of clones */
};

static void make_row(const struct work *work, const struct sf_body *body, uint32_t tile, uint32_t y,
                     const struct room *room)
{
    const struct sf_texture_options *options = work->options;
    size_t row = (size_t)(tile / options->tiles_x) * options->height + y;
    size_t at = (row * work->texture->info.width + (size_t)(tile % options->tiles_x) * options->width) * 4;
    float *color = work->texture->color + at, *shape = work->texture->shape + at;

    sf_body_look(body, y, room->list, room->pixels);
    for (uint32_t x = 0; x < options->width; x++, color += 4, shape += 4) {
        color[0] = color[1] = color[2] = room->pixels[x].shade;
        color[3] = room->pixels[x].alpha;
        shape[3] = room->pixels[x].height;
    }
}

static enum sf_status make_band(void *user)
{
    const struct band *band = user;
    struct work *work = band->work;
    struct sf_body body;
    enum sf_status status = sf_body_init(work->options, band->tile, &body);
    struct room room = {calloc(work->options->width, sizeof *room.pixels),
                        calloc((size_t)body.clone_count + 1, sizeof *room.list)};

    if (!room.pixels || !room.list)
        status = SF_ERROR_MEMORY;
    for (uint32_t i = 0; i < BAND && band->first + i < work->options->height && !status; i++) {
        if (atomic_load(&work->stopped))
            break;
        make_row(work, &body, band->tile, band->first + i, &room);
        atomic_fetch_add(&work->rows, 1);
    }
    free(room.pixels);
    free(room.list);
    sf_body_finish(&body);
    return status;
}

static enum sf_status make_tiles(struct work *work, sf_progress_fn progress, void *user)
{
    const struct sf_texture_options *options = work->options;
    uint32_t tiles = options->tiles_x * options->tiles_y, bands = (options->height + BAND - 1) / BAND;
    uint64_t total = (uint64_t)tiles * options->height;
    size_t count = (size_t)tiles * bands;
    struct band *list = calloc(count, sizeof *list);
    unsigned threads = options->threads ? options->threads : sf_cpu_count();
    struct sf_pool *pool = NULL;
    enum sf_status status = list ? sf_pool_create(threads, threads, &pool) : SF_ERROR_MEMORY, ended;
    bool going = true;

    for (size_t i = 0; i < count && !status && going; i++) {
        list[i] = (struct band){work, (uint32_t)(i / bands), (uint32_t)(i % bands) * BAND};
        status = sf_pool_push(pool, make_band, &list[i]);
        going = !progress || progress(user, atomic_load(&work->rows), total);
    }
    if (!going || status)
        atomic_store(&work->stopped, true);
    ended = sf_pool_destroy(&pool);
    free(list);
    if (!status)
        status = ended;
    if (!status && going && progress)
        going = progress(user, total, total);
    return status ? status : going ? SF_OK : SF_ERROR_INTERRUPTED;
}

enum sf_status sf_texture_create(const struct sf_texture_options *options, sf_progress_fn progress, void *user,
                                 const struct sf_log *log, struct sf_texture **out)
{
    enum sf_status status = sf_texture_options_check(options, log);
    struct sf_texture *texture;

    *out = NULL;
    if (status)
        return status;
    texture = sf_texture_alloc(options->tiles_x * options->width, options->tiles_y * options->height, options->tiles_x,
                               options->tiles_y);
    if (!texture)
        return sf_fail(log, SF_ERROR_MEMORY, "texture: out of memory");
    texture->info.loop = options->loop;
    texture->info.tileable = options->tileable;
    texture->info.channels = SF_TEXTURE_ALL;
    texture->made = sf_texture_options_print(options);

    struct work work = {.options = options, .texture = texture};

    status = texture->made ? make_tiles(&work, progress, user) : SF_ERROR_MEMORY;
    if (status == SF_ERROR_MEMORY)
        sf_fail(log, status, "texture: out of memory");
    if (status) {
        sf_texture_destroy(&texture);
        return status;
    }
    sf_texture_normals(texture);
    *out = texture;
    return SF_OK;
}
