/* The panels' controls: ImGui behind ui.h, without a window, moved by a fed mouse and fed keys. */
#include "ui_kit.h"

/* What a test's panel holds, and what became of it in the last frame. */
struct sheet {
    bool check, focus, early, refill, box_open; /* asked for */
    float slider, curved, early_value, values[3], color[3];
    int whole, choice;
    char text[64], search[32];
    bool pressed, slid, chosen, committed, searched, folded, box_shown, canvas_held;
    unsigned commits;
    float button[4], check_place[4], slider_place[4], int_place[4], drag_place[4], choice_place[4], text_place[4];
    float canvas_place[4], early_place[4], section_place[4];
};

static const char *const choices[] = {"thick", "thin", "none", NULL};

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
    sf_ui_small_button("s");
    sf_ui_checkbox("check", &sheet->check);
    sf_ui_last_rectangle(sheet->check_place);
    sf_ui_width(-80);
    sheet->slid = sf_ui_slider("slider", &sheet->slider, 0, 10, "%.2f m", false);
    sf_ui_last_rectangle(sheet->slider_place);
    sf_ui_slider("curved", &sheet->curved, 0.01f, 100, "%.3g", true);
    sf_ui_slider_int("whole", &sheet->whole, 0, 100, false);
    sf_ui_last_rectangle(sheet->int_place);
    sf_ui_width(300);
    sf_ui_drag("drag", sheet->values, 3, 0.1f, -1, 1, "%.3f");
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

/* ---- tests ---- */

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
    for (int wanted = 1; wanted >= 0; wanted--) { /* another, and back */
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_overlay, set_up, tear_down),
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
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
