/* What comes out of the panels' ground (ImGui behind ui.h): letters, triangles, tooltips, tabs, and who has the mouse. */
#include "ui_kit.h"

#include <time.h>

static void test_life(void **state)
{
    struct sf_ui *second = ui;

    (void)state;
    sf_ui_destroy(&second);
    sf_ui_destroy(&second);
    sf_ui_destroy(NULL);
    assert_int_equal(sf_ui_create(NULL, 0, &second), SF_ERROR_USAGE);
    assert_null(second);
    assert_int_equal(sf_ui_create(NULL, 2, &second), SF_OK);
    assert_int_equal(sf_ui_create(NULL, 1, &ui), SF_ERROR_USAGE);
    assert_true(sf_ui_scale() == 2);
    ui = second;
}

/* The font's picture has empty texels and full ones, and a larger scale gives larger letters. */
static void test_font(void **state)
{
    const uint8_t *coverage;
    uint32_t width, height, full = 0, empty = 0;
    float small, large;

    (void)state;
    sf_ui_font(ui, &coverage, &width, &height);
    assert_true(width > 0 && height > 0);
    for (uint32_t i = 0; i < width * height; i++) {
        full += coverage[i] == 255;
        empty += coverage[i] == 0;
    }
    assert_true(full > 500 && empty > 500);
    begin();
    small = sf_ui_text_width("extinction");
    end();
    sf_ui_destroy(&ui);
    assert_int_equal(sf_ui_create(NULL, 2, &ui), SF_OK);
    sf_ui_feed_size(WIDTH, HEIGHT);
    begin();
    large = sf_ui_text_width("extinction");
    end();
    assert_true(small > 30 && large > 1.8f * small && large < 2.2f * small);
}

/* More vertices than 16-bit indices reach: the last rectangle's corners must still be its own. */
static void test_many(void **state)
{
    const struct sf_overlay_batch *last;
    float right = 0;

    (void)state;
    begin();
    sf_ui_draw_behind();
    for (int i = 0; i < 40000; i++)
        sf_ui_draw_rectangle((float)(i % 700), (float)(i / 700), 1, 1, 0xff0000ff, true);
    sf_ui_draw_rectangle(750, 550, 8, 8, 0xff00ff00, true);
    sf_ui_draw_panel();
    end();
    assert_true(overlay.vertex_count > 160000);
    last = &overlay.batches[overlay.batch_count - 1];
    for (uint32_t i = last->first_index + last->index_count - 6; i < overlay.index_count; i++) {
        const struct sf_overlay_vertex *vertex = &overlay.vertices[overlay.indices[i]];

        assert_int_equal(vertex->color, 0xff00ff00);
        assert_true(vertex->x >= 749 && vertex->y >= 549);
        right = vertex->x > right ? vertex->x : right;
    }
    assert_true(right >= 757 && right <= 759);
}

/* Behind the panels means first; a clip becomes a batch of its own, cut to the window. */
static void test_drawing(void **state)
{
    uint32_t corners = 0;

    (void)state;
    begin();
    assert_true(sf_ui_panel_begin("p", 100, 100, 200, 200, SF_UI_FIXED | SF_UI_UNTITLED, NULL));
    sf_ui_text("above");
    sf_ui_draw_behind();
    sf_ui_draw_clip(-50, 20, 100, 30);
    sf_ui_draw_rectangle(-20, 0, 60, 60, 0x80332211, true);
    sf_ui_draw_unclip();
    sf_ui_draw_panel();
    sf_ui_draw_rectangle(120, 120, 10, 10, 0xff123456, true);
    sf_ui_panel_end();
    end();
    assert_true(overlay.batches[0].clip[0] == 0 && overlay.batches[0].clip[1] == 20);
    assert_true(overlay.batches[0].clip[2] == 50 && overlay.batches[0].clip[3] == 50);
    assert_int_equal(overlay.vertices[overlay.indices[0]].color, 0x80332211);
    for (uint32_t i = 0; i < overlay.index_count; i++)
        corners += overlay.vertices[overlay.indices[i]].color == 0xff123456;
    assert_int_equal(corners, 6); /* those of the second list, not of the first */
}

/* Batches: cut to the window, joined when their clips are equal, left out when nothing of them is seen. */
static void test_mesh(void **state)
{
    static const struct sf_overlay_vertex corners[3];
    static const uint16_t indices[] = {0, 1, 2};
    static const float around[] = {-5, 10, 200, 90}, cut[] = {0, 10, 100, 80}, beside[] = {100, 0, 120, 80};
    const struct sf_overlay_batch *batch;

    (void)state;
    sf_ui_mesh_clear(100, 80);
    sf_ui_mesh_batch(around, indices, 3, 0);
    sf_ui_mesh_batch(beside, indices, 3, 0);
    sf_ui_mesh_vertices(corners, 3);
    sf_ui_mesh_batch(cut, indices, 3, 0);
    sf_ui_mesh_batch(cut, indices, 0, 0);
    sf_ui_mesh_vertices(corners, 3);
    sf_ui_mesh_overlay(&overlay);
    assert_int_equal(overlay.batch_count, 1);
    batch = overlay.batches;
    assert_memory_equal(batch->clip, cut, sizeof cut);
    assert_int_equal(batch->index_count, 6);
    assert_int_equal(overlay.vertex_count, 6);
    for (uint32_t i = 0; i < 6; i++)
        assert_int_equal(overlay.indices[i], i);
}

/* ---- tooltips, tabs, flags ---- */

static uint32_t hovered_vertices(unsigned turn_count, struct timespec pause)
{
    for (unsigned i = 0; i < turn_count; i++) {
        begin();
        sf_ui_panel_begin("tips", 0, 0, 200, 100, SF_UI_FIXED, NULL);
        sf_ui_button("thing");
        sf_ui_tooltip("%s", "what it is");
        sf_ui_panel_end();
        end();
        nanosleep(&pause, NULL);
    }
    return overlay.vertex_count;
}

static void test_tooltip(void **state)
{
    const struct timespec none = {0, 0}, rest = {.tv_nsec = 400 * 1000 * 1000};
    uint32_t without, waiting;

    (void)state;
    without = hovered_vertices(3, none);
    assert_true(sf_ui_due() > 1000);
    sf_ui_feed_mouse(20, 30, false);
    hovered_vertices(3, none);
    waiting = hovered_vertices(1, none);
    assert_true(waiting < without + 30); /* the button's colour at most */
    assert_true(sf_ui_due() <= 0.35);
    hovered_vertices(1, rest);
    assert_true(sf_ui_due() == 0);
    assert_true(hovered_vertices(2, none) > waiting + 30);
    sf_ui_feed_mouse(700, 500, false);
    hovered_vertices(2, none);
    assert_true(sf_ui_due() > 1000);
    assert_true(hovered_vertices(1, none) <= waiting);
}

static int draw_tabs(const char *chosen)
{
    static const char *const names[] = {"first", "second", "third"};
    int open = -1;

    begin();
    sf_ui_panel_begin("tabbed", 0, 0, 300, 100, SF_UI_FIXED | SF_UI_SOLID | SF_UI_UNTITLED, NULL);
    assert_true(sf_ui_tabs_begin("tabs"));
    for (int i = 0; i < 3; i++) {
        if (chosen && strcmp(chosen, names[i]) == 0)
            sf_ui_tab_choose(names[i]);
        if (!sf_ui_tab_begin(names[i]))
            continue;
        open = i;
        sf_ui_text("in tab %d", i);
        sf_ui_tab_end();
    }
    sf_ui_tabs_end();
    sf_ui_panel_end();
    end();
    return open;
}

static void test_tabs(void **state)
{
    (void)state;
    draw_tabs(NULL);
    assert_int_equal(draw_tabs(NULL), 0);
    draw_tabs("third");
    draw_tabs(NULL);
    assert_int_equal(draw_tabs(NULL), 2);
}

/* Which panels take the mouse from the picture. */
static void test_flags(void **state)
{
    static const struct {
        unsigned flags;
        bool takes;
    } cases[] = {{0, true},
                 {SF_UI_FIXED | SF_UI_UNTITLED, true},
                 {SF_UI_FIXED | SF_UI_SOLID, true},
                 {SF_UI_FIXED | SF_UI_QUIET, false},
                 {SF_UI_FIXED | SF_UI_CLEAR, false}};

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char title[16];

        snprintf(title, sizeof title, "panel %zu", i);
        sf_ui_feed_mouse(60, 60, false);
        for (int frame = 0; frame < 3; frame++) {
            begin();
            sf_ui_panel_begin(title, 10, 10, 200, frame % 2 ? 0 : 150, cases[i].flags, NULL);
            for (int line = 0; line < 6; line++)
                sf_ui_text("line %d", line);
            sf_ui_panel_end();
            end();
        }
        if (sf_ui_takes_mouse() != cases[i].takes)
            fail_msg("flags %u: the mouse is %s", cases[i].flags, cases[i].takes ? "left" : "taken");
        sf_ui_feed_mouse(700, 500, false);
        for (int frame = 0; frame < 2; frame++) {
            begin();
            end();
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_life, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_font, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_many, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_drawing, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_mesh, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_tooltip, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_tabs, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_flags, set_up, tear_down),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
