/* The panels' ground: ImGui behind ui.h, without a window, and the triangles that come out of it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <cmocka.h>

#include "app/view/ui.h"

enum { WIDTH = 800, HEIGHT = 600 };

static struct sf_ui *ui;
static struct sf_overlay overlay; /* of the last frame */

/* What a test's panel holds, and what became of it in the last frame. */
struct sheet {
    bool pressed, small_pressed, slid, slid_int, dragged, chosen, committed, searched, box_open, box_shown, canvas_held;
    unsigned commits;
    bool check, focus, early, refill, folded;
    float slider, curved, values[3], color[3];
    int whole, choice, tab;
    char text[64], search[32];
    float button[4], slider_place[4], int_place[4], drag_place[4], choice_place[4], text_place[4], search_place[4];
    float canvas_place[4], early_place[4], section_place[4], small_place[4], tab_place[4], check_place[4];
    float early_value;
};

static const char *const choices[] = {"thick", "thin", "none", NULL};

/* ---- the overlay that every frame must give ---- */

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

/* ---- a panel with one of everything ---- */

static void draw_controls(struct sheet *sheet)
{
    if (sheet->early) {
        sf_ui_slider("early", &sheet->early_value, 0, 1, "%.2f", false);
        sf_ui_last_rectangle(sheet->early_place);
    }
    sheet->pressed = sf_ui_button("press");
    sf_ui_last_rectangle(sheet->button);
    sf_ui_same_line(0);
    sheet->small_pressed = sf_ui_small_button("s");
    sf_ui_checkbox("check", &sheet->check);
    sf_ui_last_rectangle(sheet->check_place);
    sf_ui_width(-80);
    sheet->slid = sf_ui_slider("slider", &sheet->slider, 0, 10, "%.2f m", false);
    sf_ui_last_rectangle(sheet->slider_place);
    sf_ui_slider("curved", &sheet->curved, 0.01f, 100, "%.3g", true);
    sheet->slid_int = sf_ui_slider_int("whole", &sheet->whole, 0, 100, false);
    sf_ui_last_rectangle(sheet->int_place);
    sf_ui_width(300);
    sheet->dragged = sf_ui_drag("drag", sheet->values, 3, 0.1f, -1, 1, "%.3f");
    sf_ui_last_rectangle(sheet->drag_place);
    sf_ui_color("color", sheet->color, true);
    sheet->chosen = sf_ui_choice("choice", &sheet->choice, choices);
    sf_ui_last_rectangle(sheet->choice_place);
    if (sheet->refill)
        snprintf(sheet->text, sizeof sheet->text, "model");
    sheet->committed = sf_ui_input("text", NULL, sheet->text, sizeof sheet->text);
    sheet->commits += sheet->committed;
    sf_ui_last_rectangle(sheet->text_place);
    sheet->searched = sf_ui_search("##search", "find", sheet->search, sizeof sheet->search, sheet->focus);
    sf_ui_last_rectangle(sheet->search_place);
    sheet->focus = false;
}

static void draw_rest(struct sheet *sheet)
{
    static const float plot[] = {0, 1, 0.5f, 2};
    float x, y;

    sf_ui_text("%d words", 3);
    sf_ui_text_color(sf_ui_accent, "%s", "±1 m²");
    sf_ui_text_wrapped(sf_ui_warning, "a paragraph that is longer than its line and so goes on in the next one below");
    sf_ui_progress(0.4f, "40 %");
    sf_ui_plot("plot", plot, 4, 1, 0, 2, 30);
    sf_ui_separator();
    sheet->folded = !sf_ui_section("section", true);
    sf_ui_last_rectangle(sheet->section_place);
    sf_ui_id_push("id");
    sf_ui_disable(true);
    sf_ui_button("off");
    sf_ui_enable();
    sf_ui_id_pop();
    sheet->canvas_held = sf_ui_canvas("canvas", 120, 40, &x, &y);
    sf_ui_last_rectangle(sheet->canvas_place);
    sf_ui_draw_clip(x + 10, y, 100, 40);
    sf_ui_draw_line(x, y, x + 120, y + 40, 0xff00ff00, 1);
    sf_ui_draw_circle(x + 60, y + 20, 30, 0xffff0000, false);
    sf_ui_draw_unclip();
    sf_ui_draw_text(x, y, sf_ui_plain, "sign");
    if (sf_ui_child_begin("child", 60))
        for (int i = 0; i < 30; i++)
            sf_ui_selectable(i % 2 ? "odd##" : "even##", i == 1);
    sf_ui_child_end();
}

static void draw_sheet(struct sheet *sheet)
{
    if (sf_ui_panel_begin("sheet", 10, 10, 500, 580, SF_UI_FIXED, NULL)) {
        draw_controls(sheet);
        draw_rest(sheet);
    }
    sf_ui_panel_end();
    sheet->box_shown = sf_ui_box_begin("Box", &sheet->box_open);
    if (sheet->box_shown) {
        sf_ui_text("in the box");
        sf_ui_box_end();
    }
}

static void turn(struct sheet *sheet)
{
    begin();
    draw_sheet(sheet);
    end();
}

static void turns(struct sheet *sheet, int count)
{
    while (count-- > 0)
        turn(sheet);
}

/* The mouse goes to a part (0..1) of a rectangle. */
static void point(const float place[4], float part, bool down)
{
    sf_ui_feed_mouse(place[0] + place[2] * part, place[1] + place[3] / 2, down);
}

/* Goes there, presses and lets go; a turn each. */
static void click(struct sheet *sheet, const float place[4], float part)
{
    float kept[4];

    memcpy(kept, place, sizeof kept);
    point(kept, part, false);
    turn(sheet);
    point(kept, part, true);
    turn(sheet);
    point(kept, part, false);
    turn(sheet);
}

static int set_up(void **state)
{
    static const struct sf_ui *const none;

    (void)state;
    assert_int_equal(sf_ui_create(NULL, 1, &ui), SF_OK);
    assert_ptr_not_equal(ui, none);
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

/* ---- tests ---- */

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

/* Everything at once, and no array moves once they are large enough. */
static void test_overlay(void **state)
{
    struct sheet sheet = {0};
    struct sf_overlay settled;

    (void)state;
    turns(&sheet, 4);
    settled = overlay;
    assert_true(overlay.vertex_count > 500 && overlay.batch_count > 3);
    turns(&sheet, 3);
    assert_ptr_equal(overlay.vertices, settled.vertices);
    assert_ptr_equal(overlay.indices, settled.indices);
    assert_ptr_equal(overlay.batches, settled.batches);
    assert_int_equal(overlay.vertex_count, settled.vertex_count);
    assert_int_equal(overlay.index_count, settled.index_count);
    sf_ui_feed_size(0, 0); /* minimised */
    turns(&sheet, 2);
    assert_int_equal(overlay.batch_count, 0);
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

static void test_button(void **state)
{
    struct sheet sheet = {0};
    unsigned presses = 0;

    (void)state;
    turns(&sheet, 3);
    assert_false(sf_ui_takes_mouse()); /* it is over the picture */
    point(sheet.button, 0.5f, false);
    turn(&sheet);
    turn(&sheet);
    assert_true(sf_ui_takes_mouse());
    assert_false(sheet.pressed);
    point(sheet.button, 0.5f, true);
    turn(&sheet);
    presses += sheet.pressed;
    point(sheet.button, 0.5f, false);
    for (int i = 0; i < 3; i++) {
        turn(&sheet);
        presses += sheet.pressed;
    }
    assert_int_equal(presses, 1);
    click(&sheet, sheet.check_place, 0.1f);
    assert_true(sheet.check);
    assert_false(sf_ui_takes_keys()); /* a click leaves them to the picture */
    /* Pressed beside it and dragged over it: nothing, and the mouse stays the picture's. */
    sf_ui_feed_mouse(700, 500, false);
    turn(&sheet);
    sf_ui_feed_mouse(700, 500, true);
    turn(&sheet);
    point(sheet.button, 0.5f, true);
    turns(&sheet, 2);
    assert_false(sf_ui_takes_mouse());
    point(sheet.button, 0.5f, false);
    turn(&sheet);
    assert_false(sheet.pressed);
}

static void test_slider(void **state)
{
    struct sheet sheet = {.curved = 1};
    bool slid = false;

    (void)state;
    turns(&sheet, 3);
    point(sheet.slider_place, 0.02f, false);
    turn(&sheet);
    for (float part = 0.02f; part < 0.4f; part += 0.05f) {
        point(sheet.slider_place, part, true);
        turn(&sheet);
        slid = slid || sheet.slid;
        assert_true(sheet.slid || part < 0.1f);
    }
    assert_true(slid && sheet.slider > 3 && sheet.slider < 6);
    point(sheet.slider_place, 40, true); /* far beyond its end */
    turn(&sheet);
    assert_true(sheet.slider == 10);
    turn(&sheet);
    assert_false(sheet.slid);
    point(sheet.slider_place, 40, false);
    turns(&sheet, 2);
    assert_true(sheet.slider == 10 && sheet.curved == 1 && sheet.whole == 0);
    click(&sheet, sheet.int_place, 0.4f);
    assert_true(sheet.whole > 30 && sheet.whole < 70);
}

/* Dragged sideways, and typed after a double click; clamped both times. */
static void test_drag(void **state)
{
    struct sheet sheet = {0};

    (void)state;
    turns(&sheet, 3);
    point(sheet.drag_place, 0.1f, false);
    turn(&sheet);
    point(sheet.drag_place, 0.1f, true);
    turn(&sheet);
    for (int i = 1; i <= 20; i++) {
        sf_ui_feed_mouse(sheet.drag_place[0] + 20 + (float)i * 3, sheet.drag_place[1] + 5, true);
        turn(&sheet);
    }
    assert_true(sheet.values[0] == 1 && sheet.values[1] == 0);
    sf_ui_feed_mouse(700, 500, false);
    turns(&sheet, 30);
    click(&sheet, sheet.drag_place, 0.5f);
    click(&sheet, sheet.drag_place, 0.5f);
    turn(&sheet);
    assert_true(sf_ui_takes_keys());
    sf_ui_feed_text("-7.5");
    turn(&sheet);
    sf_ui_feed_text("\n");
    turns(&sheet, 2);
    assert_true(sheet.values[1] == -1);
}

static void test_choice(void **state)
{
    struct sheet sheet = {0};
    float entry[4];

    (void)state;
    turns(&sheet, 3);
    for (int wanted = 1; wanted >= 0; wanted--) { /* another; then the other way by keys below */
        bool chosen = false;

        click(&sheet, sheet.choice_place, 0.3f);
        turns(&sheet, 2);
        assert_true(sf_ui_takes_keys()); /* an open list has them */
        memcpy(entry, sheet.choice_place, sizeof entry);
        entry[3] = 0;
        entry[1] += sheet.choice_place[3] + 14 + (float)wanted * 19;
        point(entry, 0.3f, false);
        turn(&sheet);
        point(entry, 0.3f, true);
        turn(&sheet);
        point(entry, 0.3f, false);
        for (int i = 0; i < 2; i++) {
            turn(&sheet);
            chosen = chosen || sheet.chosen;
        }
        assert_int_equal(sheet.choice, wanted);
        assert_true(chosen);
        turns(&sheet, 30); /* so that it is no double click */
    }
    /* The one that is there already is no change. */
    click(&sheet, sheet.choice_place, 0.3f);
    turns(&sheet, 2);
    entry[1] = sheet.choice_place[1] + sheet.choice_place[3] + 14;
    click(&sheet, entry, 0.3f);
    assert_int_equal(sheet.choice, 0);
    assert_false(sheet.chosen);
    turns(&sheet, 2);
    assert_false(sf_ui_takes_keys());
}

static void test_search(void **state)
{
    struct sheet sheet = {0};

    (void)state;
    turns(&sheet, 3);
    sheet.focus = true;
    turns(&sheet, 3);
    assert_true(sf_ui_takes_keys());
    sf_ui_feed_text("a");
    turn(&sheet);
    assert_true(sheet.searched);
    assert_string_equal(sheet.search, "a");
    turn(&sheet);
    assert_false(sheet.searched);
    sf_ui_feed_text("l²b");
    turn(&sheet);
    assert_true(sheet.searched);
    assert_string_equal(sheet.search, "al²b");
    sf_ui_feed_text("\b");
    turn(&sheet);
    assert_string_equal(sheet.search, "al²");
    sf_ui_feed_mouse(700, 500, true);
    turn(&sheet);
    sf_ui_feed_mouse(700, 500, false);
    turns(&sheet, 2);
    assert_false(sf_ui_takes_keys());
}

/* Typed in, then left in each way there is. */
static void type(struct sheet *sheet, const char *text)
{
    sheet->commits = 0;
    turns(sheet, 30);
    click(sheet, sheet->text_place, 0.2f);
    turn(sheet);
    sf_ui_feed_text(text);
    turns(sheet, 2);
    assert_int_equal(sheet->commits, 0);
}

static void test_input(void **state)
{
    struct sheet sheet = {.early = true, .text = "old"};

    (void)state;
    turns(&sheet, 3);
    type(&sheet, "er");
    sf_ui_feed_text("\n");
    turns(&sheet, 3);
    assert_int_equal(sheet.commits, 1);
    assert_string_equal(sheet.text, "older");
    type(&sheet, "!");
    click(&sheet, (const float[4]){700, 500, 10, 10}, 0); /* beside */
    assert_int_equal(sheet.commits, 1);
    assert_string_equal(sheet.text, "older!");
    type(&sheet, "?");
    sf_ui_feed_text("\033");
    turns(&sheet, 3);
    assert_int_equal(sheet.commits, 0);
    assert_string_equal(sheet.text, "older!");
    type(&sheet, ""); /* no change, no commit */
    click(&sheet, (const float[4]){700, 500, 10, 10}, 0);
    assert_int_equal(sheet.commits, 0);
}

/* The caller fills the text anew in each frame, and the mouse goes to a control that was drawn before the field. */
static void test_input_refilled(void **state)
{
    struct sheet sheet = {.early = true, .refill = true};
    char committed[64] = "";

    (void)state;
    turns(&sheet, 3);
    type(&sheet, "led");
    assert_string_equal(sheet.text, "modelled");
    point(sheet.early_place, 0.3f, false);
    turn(&sheet);
    point(sheet.early_place, 0.3f, true);
    for (int i = 0; i < 3; i++) {
        turn(&sheet);
        if (sheet.committed)
            snprintf(committed, sizeof committed, "%s", sheet.text);
    }
    assert_int_equal(sheet.commits, 1);
    assert_string_equal(committed, "modelled");
    turn(&sheet);
    assert_string_equal(sheet.text, "model");
}

static void test_box(void **state)
{
    struct sheet sheet = {.box_open = true};

    (void)state;
    turns(&sheet, 3);
    assert_true(sheet.box_shown);
    assert_true(sf_ui_takes_mouse()); /* though the mouse is not over it */
    assert_false(sf_ui_takes_keys());
    click(&sheet, sheet.button, 0.5f); /* what lies below cannot be had, and the click closes */
    assert_false(sheet.pressed || sheet.box_open);
    turns(&sheet, 2);
    sheet.box_open = true;
    turns(&sheet, 3);
    click(&sheet, (const float[4]){WIDTH / 2, HEIGHT / 2, 1, 1}, 0);
    assert_true(sheet.box_open);
    sf_ui_feed_text("\033");
    turn(&sheet);
    assert_false(sheet.box_open || sheet.box_shown);
    assert_true(sf_ui_takes_keys()); /* this Escape has had its effect */
    turn(&sheet);
    assert_false(sf_ui_takes_keys());
    turns(&sheet, 2);
    click(&sheet, sheet.check_place, 0.1f); /* below is free again */
    assert_true(sheet.check);
}

/* Tab is the picture's key, until a field is typed in: then it goes to the next one. */
static void test_tab_key(void **state)
{
    struct sheet sheet = {.text = "one"};

    (void)state;
    turns(&sheet, 3);
    click(&sheet, sheet.check_place, 0.1f);
    sf_ui_feed_text("\t");
    turns(&sheet, 4);
    assert_false(sf_ui_takes_keys());
    click(&sheet, sheet.text_place, 0.2f);
    turn(&sheet);
    sf_ui_feed_text("\t");
    turns(&sheet, 4);
    sf_ui_feed_text("xyz");
    turns(&sheet, 2);
    assert_string_equal(sheet.text, "one");
    assert_string_equal(sheet.search, "xyz");
}

static void test_canvas_and_section(void **state)
{
    struct sheet sheet = {0};

    (void)state;
    turns(&sheet, 3);
    assert_true(sheet.canvas_place[2] == 120 && sheet.canvas_place[3] == 40);
    point(sheet.canvas_place, 0.5f, false);
    turn(&sheet);
    assert_false(sheet.canvas_held);
    point(sheet.canvas_place, 0.5f, true);
    turn(&sheet);
    assert_true(sheet.canvas_held);
    sf_ui_feed_mouse(700, 500, true);
    turn(&sheet);
    assert_true(sheet.canvas_held);
    sf_ui_feed_mouse(700, 500, false);
    turns(&sheet, 2);
    assert_false(sheet.canvas_held || sheet.folded);
    click(&sheet, sheet.section_place, 0.5f);
    turn(&sheet);
    assert_true(sheet.folded);
}

/* Behind the panels means first; a clip becomes a batch of its own, cut to the window. */
static void test_drawing(void **state)
{
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
    for (uint32_t i = 0; i < overlay.vertex_count; i++)
        if (overlay.vertices[i].color == 0xff123456)
            return;
    fail_msg("the panel's own rectangle was not drawn");
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
        cmocka_unit_test_setup_teardown(test_overlay, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_many, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_button, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_slider, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_drag, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_choice, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_search, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_input, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_input_refilled, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_box, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_tab_key, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_canvas_and_section, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_drawing, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_tooltip, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_tabs, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_flags, set_up, tear_down),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
