/* One draw for the picture and one for the overlay, however many batches it has: an index is uploaded together with the
 * number of its batch, so that the vertex shader can hand the batch's clip rectangle to the fragments. */
#include "render/window_graph.h"

#include <math.h>
#include <string.h>
#include "base/array.h"
#include "base/log.h"

enum { VERTICES_LEAST = 4096, CORNERS_LEAST = 8192, CLIPS_LEAST = 64 }; /* room at first */

_Static_assert(sizeof(struct sf_overlay_vertex) == 20, "five words, as window/ui.vert reads them");
_Static_assert(sizeof(struct sf_window_picture_push) == 48 && sizeof(struct sf_window_ui_push) == 16, "as in GLSL");
_Static_assert(SF_TONE_LINEAR == 0 && SF_TONE_REINHARD == 1 && SF_TONE_ACES == 2 && SF_TONE_NEUTRAL == 3,
               "as in lib/tone.glsl");

/* ---- what a frame wants ---- */

static enum sf_status check_batch(const struct sf_overlay *overlay, uint32_t number, const struct sf_log *log)
{
    const struct sf_overlay_batch *batch = &overlay->batches[number];
    uint32_t largest = 0;

    if (batch->index_count % 3 != 0 || (uint64_t)batch->first_index + batch->index_count > overlay->index_count)
        return sf_fail(log, SF_ERROR_USAGE,
                       "overlay: batch %u draws %u indices from number %u on; they must be triangles, among %u", number,
                       batch->index_count, batch->first_index, overlay->index_count);
    for (uint32_t i = 0; i < batch->index_count; i++) {
        uint32_t index = overlay->indices[batch->first_index + i];

        largest = index > largest ? index : largest;
    }
    if (batch->index_count > 0 && largest >= overlay->vertex_count)
        return sf_fail(log, SF_ERROR_USAGE, "overlay: batch %u draws vertex %u, but there are %u", number, largest,
                       overlay->vertex_count);
    return SF_OK;
}

/* Also counts the corners of all triangles that it draws. */
static enum sf_status check_overlay(const struct sf_overlay *overlay, const struct sf_log *log, uint32_t *corners)
{
    uint64_t count = 0;

    *corners = 0;
    if ((overlay->vertex_count > 0 && !overlay->vertices) || (overlay->index_count > 0 && !overlay->indices) ||
        (overlay->batch_count > 0 && !overlay->batches))
        return sf_fail(log, SF_ERROR_USAGE, "overlay: %u vertices, %u indices or %u batches are said to be at NULL",
                       overlay->vertex_count, overlay->index_count, overlay->batch_count);
    for (uint32_t i = 0; i < overlay->batch_count; i++) {
        enum sf_status status = check_batch(overlay, i, log);

        if (status)
            return status;
        count += overlay->batches[i].index_count;
    }
    if (count > UINT32_MAX)
        return sf_fail(log, SF_ERROR_USAGE, "overlay: its batches draw %llu indices; at most %u can be",
                       (unsigned long long)count, UINT32_MAX);
    *corners = (uint32_t)count;
    return SF_OK;
}

/* By doubling, so that an overlay that grows slowly makes few graphs. */
static uint32_t room_for(uint32_t need, uint32_t before, uint32_t least)
{
    uint32_t room = before > least ? before : least;

    while (room < need)
        room = room > UINT32_MAX / 2 ? UINT32_MAX : 2 * room;
    return room;
}

static enum sf_status want_source(const struct sf_window_input *input, const struct sf_log *log,
                                  struct sf_window_shape *shape)
{
    const struct sf_window_frame *frame = input->frame;
    bool exact;

    shape->source = SF_WINDOW_PIXELS;
    shape->source_width = shape->source_height = 1;
    if (frame->pixels) {
        if (frame->pixels_width == 0 || frame->pixels_height == 0)
            return sf_fail(log, SF_ERROR_USAGE, "window: a picture of %ux%u pixels cannot be shown",
                           frame->pixels_width, frame->pixels_height);
        shape->source_width = frame->pixels_width;
        shape->source_height = frame->pixels_height;
        return SF_OK;
    }
    if (!input->picture)
        return SF_OK;
    if (!frame->tone)
        return sf_fail(log, SF_ERROR_USAGE, "window: a renderer's picture is shown without a tone mapping");
    exact = frame->width == (float)input->picture_width && frame->height == (float)input->picture_height &&
            frame->x == floorf(frame->x) && frame->y == floorf(frame->y);
    shape->source = exact ? SF_WINDOW_EXACT : SF_WINDOW_SCALED;
    shape->source_width = input->picture_width;
    shape->source_height = input->picture_height;
    shape->source_format = input->float_color ? SF_FORMAT_RGBA32F : SF_FORMAT_RGBA16F;
    shape->beside = input->beside != NULL;
    return sf_tone_parse(frame->tone, &shape->tone, log);
}

enum sf_status sf_window_shape_of(const struct sf_window_input *input, const struct sf_window_shape *before,
                                  const struct sf_log *log, struct sf_window_shape *shape)
{
    static const struct sf_overlay nothing;
    const struct sf_overlay *overlay = input->frame->overlay ? input->frame->overlay : &nothing;
    uint32_t corners = 0;
    enum sf_status status;

    memset(shape, 0, sizeof *shape);
    status = want_source(input, log, shape);
    if (!status)
        status = check_overlay(overlay, log, &corners);
    if (status)
        return status;
    for (int i = 0; i < 3; i++)
        shape->background[i] = fminf(fmaxf(input->frame->background[i], 0.0f), 1.0f); /* NaN is 0 */
    shape->font_width = input->font_width;
    shape->font_height = input->font_height;
    shape->vertices = room_for(overlay->vertex_count, before->vertices, VERTICES_LEAST);
    shape->corners = room_for(corners, before->corners, CORNERS_LEAST);
    shape->clips = room_for(overlay->batch_count, before->clips, CLIPS_LEAST);
    return SF_OK;
}

/* ---- passes ---- */

static sf_resource declare_upload(struct sf_graph *graph, const char *name, uint64_t bytes)
{
    return sf_graph_buffer(graph, &(struct sf_buffer_desc){.name = name, .lifetime = SF_UPLOAD, .bytes = bytes});
}

static sf_resource declare_import(struct sf_graph *graph, const char *name, enum sf_format format, uint32_t width,
                                  uint32_t height, enum sf_access outside)
{
    return sf_graph_image(graph, &(struct sf_image_desc){.name = name,
                                                         .format = format,
                                                         .lifetime = SF_IMPORTED,
                                                         .size = {.width = width, .height = height},
                                                         .outside = outside});
}

/* A renderer's picture, sampled. */
static sf_resource declare_source(struct sf_graph *graph, const char *name, const struct sf_window_shape *shape,
                                  uint32_t binding, struct sf_use *use)
{
    sf_resource picture =
        declare_import(graph, name, shape->source_format, shape->source_width, shape->source_height, SF_ACCESS_SAMPLED);

    *use = (struct sf_use){.resource = picture,
                           .access = SF_ACCESS_SAMPLED,
                           .binding = binding,
                           .sampler = shape->source == SF_WINDOW_EXACT ? SF_SAMPLER_NEAREST : SF_SAMPLER_LINEAR};
    return picture;
}

static void declare_picture(struct sf_graph *graph, const struct sf_window_shape *shape,
                            const struct sf_window_live *live, struct sf_window_resources *resources)
{
    const float *background = shape->background;
    bool pixels = shape->source == SF_WINDOW_PIXELS;
    const char *fragment = pixels ? "window/pixels.frag" : shape->beside ? "window/beside.frag" : "window/picture.frag";
    struct sf_use uses[3] = {{.resource = resources->target,
                              .access = SF_ACCESS_COLOR,
                              .load = SF_LOAD_CLEAR,
                              .clear = {background[0], background[1], background[2], 1.0f}}};

    if (pixels) {
        resources->pixels = declare_upload(graph, "window.pixels",
                                           (uint64_t)shape->source_width * shape->source_height * sizeof(uint32_t));
        uses[1] = (struct sf_use){.resource = resources->pixels, .access = SF_ACCESS_STORAGE_READ, .binding = 0};
    } else {
        resources->picture = declare_source(graph, "window.source", shape, 0, &uses[1]);
    }
    if (shape->beside)
        resources->beside = declare_source(graph, "window.beside", shape, 1, &uses[2]);
    sf_graph_pass(graph, &(struct sf_pass_desc){.name = "window.picture",
                                                .kind = SF_PASS_RASTER,
                                                .uses = uses,
                                                .use_count = shape->beside ? 3 : 2,
                                                .shader = "window/picture.vert",
                                                .fragment = fragment,
                                                .constants = {(uint32_t)shape->tone, shape->source == SF_WINDOW_EXACT},
                                                .constant_count = pixels ? 0 : 2,
                                                .push = &live->picture,
                                                .push_bytes = sizeof live->picture,
                                                .draw_live = live->picture_draw,
                                                .raster = {.triangle_strip = true}});
}

static void declare_ui(struct sf_graph *graph, const struct sf_window_shape *shape, const struct sf_window_live *live,
                       struct sf_window_resources *resources)
{
    resources->vertices =
        declare_upload(graph, "window.vertices", (uint64_t)shape->vertices * sizeof(struct sf_overlay_vertex));
    resources->corners = declare_upload(graph, "window.corners", (uint64_t)shape->corners * 2 * sizeof(uint32_t));
    resources->clips = declare_upload(graph, "window.clips", (uint64_t)shape->clips * 4 * sizeof(float));
    resources->font = declare_import(graph, "window.font", SF_FORMAT_R8_UNORM, shape->font_width, shape->font_height,
                                     SF_ACCESS_SAMPLED);
    const struct sf_use uses[] = {
        {.resource = resources->target, .access = SF_ACCESS_COLOR, .load = SF_LOAD_KEEP},
        {.resource = resources->vertices, .access = SF_ACCESS_STORAGE_READ, .binding = 0},
        {.resource = resources->corners, .access = SF_ACCESS_STORAGE_READ, .binding = 1},
        {.resource = resources->clips, .access = SF_ACCESS_STORAGE_READ, .binding = 2},
        {.resource = resources->font, .access = SF_ACCESS_SAMPLED, .binding = 3, .sampler = SF_SAMPLER_LINEAR},
    };

    sf_graph_pass(graph, &(struct sf_pass_desc){.name = "window.ui",
                                                .kind = SF_PASS_RASTER,
                                                .uses = uses,
                                                .use_count = SF_COUNT(uses),
                                                .shader = "window/ui.vert",
                                                .fragment = "window/ui.frag",
                                                .push = &live->ui,
                                                .push_bytes = sizeof live->ui,
                                                .draw_live = live->ui_draw,
                                                .raster = {.blend = {SF_BLEND_PREMULTIPLIED}}});
}

void sf_window_graph_declare(struct sf_graph *graph, const struct sf_window_shape *shape,
                             const struct sf_window_live *live, sf_resource target,
                             struct sf_window_resources *resources)
{
    *resources = (struct sf_window_resources){.target = target};
    declare_picture(graph, shape, live, resources);
    declare_ui(graph, shape, live, resources);
}

/* ---- a frame's data ---- */

static void fill_picture(struct sf_window_graph *graph, const struct sf_window_input *input, void *pixels)
{
    const struct sf_window_frame *frame = input->frame;
    const struct sf_window_shape *shape = &graph->shape;
    bool there = (frame->pixels || input->picture) && frame->width > 0.0f && frame->height > 0.0f;

    graph->live.picture = (struct sf_window_picture_push){
        .rect = {frame->x, frame->y, frame->width, frame->height},
        .to_clip = {2.0f / (float)shape->width, 2.0f / (float)shape->height, exp2f(frame->exposure),
                    frame->x + roundf(fminf(fmaxf(frame->wipe, 0.0f), 1.0f) * frame->width)},
        .size = {shape->source_width, shape->source_height},
    };
    graph->live.picture_draw[0] = there ? 4 : 0;
    graph->live.picture_draw[1] = 1;
    if (frame->pixels)
        memcpy(pixels, frame->pixels, (size_t)shape->source_width * shape->source_height * sizeof(uint32_t));
}

static void fill_ui(struct sf_window_graph *graph, const struct sf_overlay *overlay, void *vertices, uint32_t *corners,
                    float (*clips)[4])
{
    uint32_t count = 0;

    if (overlay->vertex_count > 0)
        memcpy(vertices, overlay->vertices, (size_t)overlay->vertex_count * sizeof *overlay->vertices);
    for (uint32_t i = 0; i < overlay->batch_count; i++) {
        const struct sf_overlay_batch *batch = &overlay->batches[i];
        const uint32_t *indices = overlay->indices + batch->first_index;

        memcpy(clips[i], batch->clip, sizeof batch->clip);
        for (uint32_t j = 0; j < batch->index_count; j++, count++) {
            corners[2 * (size_t)count] = indices[j];
            corners[2 * (size_t)count + 1] = i;
        }
    }
    graph->live.ui =
        (struct sf_window_ui_push){.to_clip = {2.0f / (float)graph->shape.width, 2.0f / (float)graph->shape.height}};
    graph->live.ui_draw[0] = count;
    graph->live.ui_draw[1] = 1;
}

enum sf_status sf_window_graph_fill(struct sf_window_graph *graph, const struct sf_window_input *input,
                                    const struct sf_log *log)
{
    static const struct sf_overlay nothing;
    const struct sf_window_resources *resources = &graph->resources;
    void *pixels = resources->pixels ? sf_player_upload(graph->player, resources->pixels) : NULL;
    void *vertices = sf_player_upload(graph->player, resources->vertices);
    void *corners = sf_player_upload(graph->player, resources->corners);
    void *clips = sf_player_upload(graph->player, resources->clips);

    if ((resources->pixels && !pixels) || !vertices || !corners || !clips)
        return sf_fail(log, SF_ERROR_MEMORY, "window: no memory for its uploads");
    fill_picture(graph, input, pixels);
    fill_ui(graph, input->frame->overlay ? input->frame->overlay : &nothing, vertices, corners, clips);
    if (resources->picture)
        sf_player_bind_image(graph->player, resources->picture, input->picture);
    if (resources->beside)
        sf_player_bind_image(graph->player, resources->beside, input->beside);
    sf_player_bind_image(graph->player, resources->font, input->font);
    return SF_OK;
}

/* ---- making ---- */

enum sf_status sf_window_graph_fit(struct sf_window_graph *graph, struct sf_gpu *gpu,
                                   const struct sf_window_shape *shape, const struct sf_log *log)
{
    const struct sf_plan_memory memory = {.needs = sf_gpu_memory_needs, .user = gpu};
    enum sf_status status;

    if (graph->player && memcmp(&graph->shape, shape, sizeof *shape) == 0)
        return SF_OK;
    sf_window_graph_finish(graph);
    status = sf_graph_create("window", log, &graph->graph);
    if (status)
        return status;
    graph->shape = *shape;
    sf_window_graph_declare(
        graph->graph, shape, &graph->live,
        declare_import(graph->graph, "window.image", shape->format, shape->width, shape->height, SF_ACCESS_PRESENT),
        &graph->resources);
    status = sf_plan_create(graph->graph, &memory, log, &graph->plan);
    if (!status)
        status = sf_player_create(gpu, graph->plan, &graph->player);
    if (status)
        sf_window_graph_finish(graph);
    return status;
}

void sf_window_graph_finish(struct sf_window_graph *graph)
{
    sf_player_destroy(&graph->player);
    sf_plan_destroy(&graph->plan);
    sf_graph_destroy(&graph->graph);
    *graph = (struct sf_window_graph){0};
}
