/* What the tests of a window's graph share: it is drawn into an ordinary image, and read back. No window is needed. */
#ifndef SF_TESTS_WINDOW_KIT_H
#define SF_TESTS_WINDOW_KIT_H

#include "gpu_kit.h"
#include "render/window_graph.h"

enum { WIDTH = 90, HEIGHT = 70 }; /* of the image */

struct stage {
    struct sf_gpu *gpu;
    struct sf_window_frame frame;
    struct sf_window_input input;
    struct sf_gpu_image *picture, *font;
    struct sf_window_graph graph;
    sf_resource out;
    const uint8_t *pixels; /* RGBA of the last play */
};

static inline void set_font(struct stage *stage, const uint8_t *coverage, uint32_t width, uint32_t height)
{
    sf_gpu_image_destroy(&stage->font);
    assert_int_equal(sf_gpu_image_create(stage->gpu, "font", SF_FORMAT_R8_UNORM, width, height, 1, SF_ACCESS_SAMPLED,
                                         coverage, &stage->font),
                     SF_OK);
    stage->input.font = stage->font;
    stage->input.font_width = width;
    stage->input.font_height = height;
}

static inline void setup(struct stage *stage)
{
    const uint8_t full = 255;

    *stage = (struct stage){.gpu = kit_gpu(0)};
    stage->frame = (struct sf_window_frame){.background = {51 / 255.0f, 102 / 255.0f, 204 / 255.0f}};
    stage->input.frame = &stage->frame;
    set_font(stage, &full, 1, 1);
}

static inline void finish(struct stage *stage)
{
    sf_window_graph_finish(&stage->graph);
    sf_gpu_image_destroy(&stage->picture);
    sf_gpu_image_destroy(&stage->font);
    kit_finish(&stage->gpu);
}

/* `rgba`: floats, or halves, as a renderer's picture. */
static inline void set_picture(struct stage *stage, const void *rgba, bool floats, uint32_t width, uint32_t height)
{
    sf_gpu_image_destroy(&stage->picture);
    assert_int_equal(sf_gpu_image_create(stage->gpu, "picture", floats ? SF_FORMAT_RGBA32F : SF_FORMAT_RGBA16F, width,
                                         height, 1, SF_ACCESS_SAMPLED, rgba, &stage->picture),
                     SF_OK);
    stage->input.picture = stage->picture;
    stage->input.picture_width = width;
    stage->input.picture_height = height;
    stage->input.float_color = floats;
}

static inline void play(struct stage *stage)
{
    struct sf_window_graph *graph = &stage->graph;
    struct sf_window_shape shape;
    sf_resource target;
    uint64_t serial = 0;

    if (sf_window_shape_of(&stage->input, &graph->shape, &kit_log, &shape) != SF_OK)
        fail_msg("%s", kit_record.last);
    sf_window_graph_finish(graph);
    shape.width = WIDTH;
    shape.height = HEIGHT;
    shape.format = SF_FORMAT_RGBA8_UNORM;
    graph->shape = shape;
    graph->graph = kit_graph("window");
    target = kit_image(graph->graph, "target", shape.format, SF_TRANSIENT, WIDTH, HEIGHT);
    sf_window_graph_declare(graph->graph, &shape, &graph->live, target, &graph->resources);
    stage->out = kit_buffer(graph->graph, "out", SF_READBACK, WIDTH * HEIGHT * 4);
    kit_copy(graph->graph, "read", target, stage->out);
    graph->player = kit_player(stage->gpu, graph->graph, &graph->plan);
    if (sf_frame_begin(stage->gpu) != SF_OK || sf_window_graph_fill(graph, &stage->input, &kit_log) != SF_OK ||
        sf_player_play(graph->player) != SF_OK || sf_frame_end(stage->gpu, &serial) != SF_OK ||
        sf_frame_wait(stage->gpu, serial) != SF_OK)
        fail_msg("%s", kit_record.last);
    stage->pixels = sf_player_readback(graph->player, stage->out, serial);
    assert_non_null(stage->pixels);
}

static inline void assert_pixel(const struct stage *stage, int x, int y, const uint8_t want[3], int tolerance)
{
    const uint8_t *got = stage->pixels + ((size_t)y * WIDTH + (size_t)x) * 4;

    for (int c = 0; c < 3; c++)
        if (abs(got[c] - want[c]) > tolerance)
            fail_msg("pixel %d, %d is %u %u %u and should be %u %u %u", x, y, got[0], got[1], got[2], want[0], want[1],
                     want[2]);
    if (got[3] != 255)
        fail_msg("pixel %d, %d is not opaque: %u", x, y, got[3]);
}

static const uint8_t BACKGROUND[3] = {51, 102, 204};

static inline bool within(int x, int y, int left, int top, int width, int height)
{
    return x >= left && y >= top && x < left + width && y < top + height;
}

#endif
