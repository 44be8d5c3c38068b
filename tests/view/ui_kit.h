/* A ui without a window for the tests of the panels' ground, and what every frame's triangles must obey. */
#ifndef SF_TESTS_VIEW_UI_KIT_H
#define SF_TESTS_VIEW_UI_KIT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

#include "app/view/ui_parts.h"

enum { WIDTH = 800, HEIGHT = 600 };

static struct sf_ui *ui;
static struct sf_overlay overlay; /* of the last frame */

static void check_overlay(void)
{
    uint32_t next = 0;

    assert_int_equal(overlay.index_count % 3, 0);
    for (uint32_t i = 0; i < overlay.batch_count; i++) {
        const struct sf_overlay_batch *batch = &overlay.batches[i];

        assert_int_equal(batch->first_index, next);
        assert_true(batch->index_count > 0 && batch->index_count % 3 == 0);
        assert_true(batch->clip[0] >= 0 && batch->clip[1] >= 0 && batch->clip[2] <= WIDTH && batch->clip[3] <= HEIGHT);
        assert_true(batch->clip[0] < batch->clip[2] && batch->clip[1] < batch->clip[3]);
        if (i > 0)
            assert_memory_not_equal(batch->clip, overlay.batches[i - 1].clip, sizeof batch->clip);
        next += batch->index_count;
    }
    assert_int_equal(next, overlay.index_count);
    for (uint32_t i = 0; i < overlay.index_count; i++)
        assert_true(overlay.indices[i] < overlay.vertex_count);
    for (uint32_t i = 0; i < overlay.vertex_count; i++) {
        const struct sf_overlay_vertex *vertex = &overlay.vertices[i];

        assert_true(vertex->u >= 0 && vertex->u <= 1 && vertex->v >= 0 && vertex->v <= 1);
    }
}

static void begin(void)
{
    sf_ui_begin(ui);
}

static void end(void)
{
    sf_ui_end(ui, &overlay);
    check_overlay();
}

static int set_up(void **state)
{
    (void)state;
    assert_int_equal(sf_ui_create(NULL, 1, &ui), SF_OK);
    assert_non_null(ui);
    sf_ui_feed_size(WIDTH, HEIGHT);
    sf_ui_feed_mouse(700, 500, false);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    sf_ui_destroy(&ui);
    assert_null(ui);
    return 0;
}

#endif
