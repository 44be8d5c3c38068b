/* A window: its swapchain, kept fitting, and the graph that draws an image of it.
 *
 * An image that cannot be had (the surface has changed, or is lost) means a new swapchain and another try, a few times;
 * then the call gives up without an error, since the next will most likely do. Whatever can fail comes before the image
 * is acquired. */
#include "render/window_graph.h"

#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/log.h"
#include "render/internal.h"

enum { RETRIES = 3, MISSES_MAX = 100 };

_Static_assert(SF_COUNT(((struct sf_window_info *)0)->present_modes) > SF_PRESENT_COUNT,
               "room for every mode and NULL");

struct sf_window {
    struct sf_gpu *gpu;
    const struct sf_log *log;
    struct sf_swapchain *swapchain;
    uint32_t modes; /* bit set that the surface has */
    uint32_t width, height;
    enum sf_present_mode mode;
    bool changed;    /* the swapchain was made for other options */
    bool suboptimal; /* and has been made anew once because of that, with these options */
    uint32_t misses; /* calls in a row that showed nothing */
    uint64_t shown, remade;
    struct sf_gpu_image *font;
    uint32_t font_width, font_height;
    struct sf_window_graph graph;
};

/* ---- options ---- */

static enum sf_status unknown_mode(const struct sf_window *window, const char *name)
{
    struct sf_text text = {0};
    enum sf_status status;

    for (uint32_t i = 0; i < SF_PRESENT_COUNT; i++)
        if (window->modes & 1u << i)
            sf_text_printf(&text, "%s%s", text.data ? ", " : "", sf_present_mode_name((enum sf_present_mode)i));
    status = sf_fail(window->log, SF_ERROR_USAGE, "the window has no present mode '%.64s'; it has: %s", name,
                     text.data && !text.failed ? text.data : "others");
    sf_text_finish(&text);
    return status;
}

static enum sf_status find_mode(const struct sf_window *window, const char *name, enum sf_present_mode *mode)
{
    if (!name)
        name = sf_present_mode_name(SF_PRESENT_FIFO);
    for (uint32_t i = 0; i < SF_PRESENT_COUNT; i++) {
        *mode = (enum sf_present_mode)i;
        if (window->modes & 1u << i && strcmp(name, sf_present_mode_name(*mode)) == 0)
            return SF_OK;
    }
    return unknown_mode(window, name);
}

static enum sf_status create_parts(struct sf_window *window, const struct sf_window_options *options)
{
    static const uint8_t full = 255; /* until there is a font, triangles have their plain colours */
    enum sf_status status = sf_swapchain_modes(window->gpu, &window->modes);

    if (!status)
        status = find_mode(window, options->present_mode, &window->mode);
    if (!status)
        status = sf_window_set_font(window, &full, 1, 1);
    if (!status)
        status = sf_swapchain_create(window->gpu, window->width, window->height, window->mode, &window->swapchain);
    return status;
}

enum sf_status sf_window_create(struct sf_device *device, const struct sf_window_options *options,
                                const struct sf_log *log, struct sf_window **out)
{
    struct sf_window *window = calloc(1, sizeof *window);
    enum sf_status status;

    *out = NULL;
    if (!window)
        return sf_fail(log, SF_ERROR_MEMORY, "window: out of memory");
    window->gpu = device->gpu;
    window->log = log;
    window->width = options->width;
    window->height = options->height;
    status = create_parts(window, options);
    if (status)
        sf_window_destroy(&window);
    *out = window;
    return status;
}

void sf_window_destroy(struct sf_window **out)
{
    struct sf_window *window = out ? *out : NULL;

    if (!window)
        return;
    sf_window_graph_finish(&window->graph);
    sf_gpu_image_destroy(&window->font);
    sf_swapchain_destroy(&window->swapchain);
    free(window);
    *out = NULL;
}

enum sf_status sf_window_set_options(struct sf_window *window, const struct sf_window_options *options)
{
    enum sf_present_mode mode;
    enum sf_status status = find_mode(window, options->present_mode, &mode);

    if (status)
        return status;
    if (options->width != window->width || options->height != window->height || mode != window->mode) {
        window->changed = true;
        window->suboptimal = false;
    }
    window->width = options->width;
    window->height = options->height;
    window->mode = mode;
    return SF_OK;
}

void sf_window_describe(const struct sf_window *window, struct sf_window_info *info)
{
    uint32_t count = 0;

    *info = (struct sf_window_info){
        .present_mode = sf_present_mode_name(window->mode), .shown = window->shown, .remade = window->remade};
    sf_swapchain_extent(window->swapchain, &info->width, &info->height, &info->images, NULL);
    for (uint32_t i = 0; i < SF_PRESENT_COUNT; i++)
        if (window->modes & 1u << i)
            info->present_modes[count++] = sf_present_mode_name((enum sf_present_mode)i);
}

enum sf_status sf_window_set_font(struct sf_window *window, const uint8_t *coverage, uint32_t width, uint32_t height)
{
    struct sf_gpu_image *font = NULL;
    enum sf_status status;

    if (!coverage)
        return sf_fail(window->log, SF_ERROR_USAGE, "window: the font's picture of %ux%u is NULL", width, height);
    status = sf_gpu_image_create(window->gpu, "window.font", SF_FORMAT_R8_UNORM, width, height, 1, SF_ACCESS_SAMPLED,
                                 coverage, &font);
    if (status)
        return status;
    sf_gpu_image_destroy(&window->font);
    window->font = font;
    window->font_width = width;
    window->font_height = height;
    return SF_OK;
}

/* ---- showing ---- */

static enum sf_status renew(struct sf_window *window)
{
    enum sf_status status = sf_swapchain_renew(window->swapchain, window->width, window->height, window->mode);

    if (status)
        return status;
    window->changed = false;
    window->remade++;
    return sf_swapchain_modes(window->gpu, &window->modes); /* the surface may be another one now */
}

/* Images as the options want them, as far as is known before one is acquired. Suboptimal ones are made anew once with
 * these options, and then taken as they are; without images there may be some by now. */
static enum sf_status refresh(struct sf_window *window)
{
    bool suboptimal = !window->changed && !window->suboptimal && sf_swapchain_suboptimal(window->swapchain);
    uint32_t images;

    sf_swapchain_extent(window->swapchain, NULL, NULL, &images, NULL);
    if (!window->changed && !suboptimal && images > 0)
        return SF_OK;
    window->suboptimal = window->suboptimal || suboptimal;
    return renew(window);
}

static enum sf_status draw(struct sf_window *window, const struct sf_window_input *input,
                           const struct sf_window_shape *shape, bool *drawn)
{
    struct sf_window_graph *graph = &window->graph;
    struct sf_gpu_image *image = NULL;
    enum sf_status status = sf_window_graph_fit(graph, window->gpu, shape, window->log), ended;

    if (!status)
        status = sf_frame_begin(window->gpu);
    if (status)
        return status;
    status = sf_window_graph_fill(graph, input, window->log);
    if (!status)
        status = sf_swapchain_acquire(window->swapchain, &image);
    if (!status && image) {
        sf_player_bind_image(graph->player, graph->resources.target, image);
        status = sf_player_play(graph->player);
    }
    ended = sf_frame_end(window->gpu, NULL);
    status = status ? status : ended;
    *drawn = image && !status;
    return status;
}

static enum sf_status try_to_draw(struct sf_window *window, const struct sf_window_input *input,
                                  struct sf_window_shape *shape, bool *drawn)
{
    enum sf_status status = refresh(window);

    *drawn = false;
    for (int retry = 0; !status; retry++) {
        uint32_t images;

        sf_swapchain_extent(window->swapchain, &shape->width, &shape->height, &images, &shape->format);
        if (images == 0)
            return SF_OK;
        status = draw(window, input, shape, drawn);
        if (status || *drawn || retry == RETRIES)
            return status;
        status = renew(window);
    }
    return status;
}

enum sf_status sf_window_show(struct sf_window *window, const struct sf_window_frame *frame)
{
    struct sf_window_input input = {
        .frame = frame, .font = window->font, .font_width = window->font_width, .font_height = window->font_height};
    struct sf_window_shape shape;
    bool drawn = false;
    enum sf_status status;

    if (window->width == 0 || window->height == 0)
        return SF_OK;
    if (frame->renderer) {
        input.picture =
            sf_renderer_shown(frame->renderer, &input.picture_width, &input.picture_height, &input.float_color);
        input.beside = sf_renderer_shown_beside(frame->renderer);
    }
    status = sf_window_shape_of(&input, &window->graph.shape, window->log, &shape);
    if (!status)
        status = try_to_draw(window, &input, &shape, &drawn);
    if (status)
        return status;
    window->shown += drawn;
    window->misses = drawn ? 0 : window->misses + 1;
    if (window->misses >= MISSES_MAX)
        return sf_fail(window->log, SF_ERROR_DEVICE, "the window had no image to draw on, %u times in a row",
                       window->misses);
    return SF_OK;
}
