/* Every parameter of the table as a control: by group, found by a search, marked where it differs from the file. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "view.h"

enum { TEXT_BYTES = 512 };
static const double SLIDER_SPAN = 400; /* wider ranges are dragged, since a slider could not be set finely */
static const float LABEL_SHARE = 0.42f;

/* Case does not matter. */
static bool contains(const char *text, const char *part)
{
    size_t length = strlen(part);

    for (; *text; text++) {
        size_t i = 0;

        while (i < length && text[i] && tolower((unsigned char)text[i]) == tolower((unsigned char)part[i]))
            i++;
        if (i == length)
            return true;
    }
    return length == 0;
}

static bool wanted(const struct sf_view *view, const struct sf_control *control)
{
    return contains(control->path, view->search) || contains(control->doc, view->search);
}

/* "none", "1", "1, 2" or "1, 2, 3". */
static void print_numbers(const double *values, uint32_t count, char *text, size_t room)
{
    if (count == 0)
        snprintf(text, room, "none");
    else if (count == 1)
        snprintf(text, room, "%g", values[0]);
    else if (count == 2)
        snprintf(text, room, "%g, %g", values[0], values[1]);
    else
        snprintf(text, room, "%g, %g, %g", values[0], values[1], values[2]);
}

static void explain(const struct sf_control *control)
{
    char range[96] = "", usual[96] = "required";
    const double *value = control->usual;

    if (!sf_ui_last_hovered()) /* nothing would be shown: no words are made */
        return;
    if (control->kind != SF_CONTROL_CHOICE && control->kind != SF_CONTROL_BOOL && control->numbers > 0)
        snprintf(range, sizeof range, "%g to %g %s\n", control->min, control->max, control->unit);
    if (!control->required && control->kind == SF_CONTROL_CHOICE)
        snprintf(usual, sizeof usual, "%s", control->choices[(int)value[0]]);
    else if (!control->required && control->kind == SF_CONTROL_BOOL)
        snprintf(usual, sizeof usual, "%s", value[0] != 0 ? "on" : "off");
    else if (!control->required)
        print_numbers(value, control->numbers, usual, sizeof usual);
    sf_ui_tooltip("%s\n\n%susual: %s\n--set %s%s%s", control->doc, range, usual, control->path,
                  control->renews[0] ? "\nrenews: " : "", control->renews);
}

/* A change of a px: about a hundredth of the value, never nothing. */
static float drag_speed(const struct sf_control *control)
{
    double size = 0;

    for (uint32_t i = 0; i < control->numbers; i++)
        size = fmax(size, fabs(control->value[i]));
    return (float)fmax(size, fmin(1, (control->max - control->min) * 0.01)) * 0.01f;
}

/* Typed: a float, as ImGui drags, would lose the last digits of a seed. What is no number leaves the value. */
static bool type_whole(struct sf_control *control)
{
    char digits[32], *end;
    bool changed;
    double typed;

    snprintf(digits, sizeof digits, "%.0f", control->value[0]);
    changed = sf_ui_input("##value", "", digits, sizeof digits);
    typed = strtod(digits, &end);
    if (!changed || end == digits || *end || isnan(typed))
        return false;
    control->value[0] = rint(fmin(fmax(typed, control->min), control->max));
    return true;
}

static bool edit_number(struct sf_control *control, const char *format)
{
    bool narrow = control->max - control->min <= SLIDER_SPAN, changed;
    float value = (float)control->value[0];

    if (control->kind == SF_CONTROL_INT && control->max - control->min < 1e6 && control->min >= 0) {
        int whole = (int)control->value[0];

        changed = sf_ui_slider_int("##value", &whole, (int)control->min, (int)control->max, !narrow);
        control->value[0] = whole;
        return changed;
    }
    if (control->kind == SF_CONTROL_INT)
        return type_whole(control);
    if (narrow)
        changed = sf_ui_slider("##value", &value, (float)control->min, (float)control->max, format, false);
    else
        changed =
            sf_ui_drag("##value", &value, 1, drag_speed(control), (float)control->min, (float)control->max, format);
    control->value[0] = (double)value;
    return changed;
}

static bool edit_numbers(struct sf_control *control)
{
    float values[3];
    bool changed;

    for (uint32_t i = 0; i < control->numbers; i++)
        values[i] = (float)control->value[i];
    if (control->kind == SF_CONTROL_COLOR)
        changed = sf_ui_color("##value", values, control->max > 1);
    else
        changed = sf_ui_drag("##value", values, control->numbers, drag_speed(control), (float)control->min,
                             (float)control->max, "%.4g");
    if (control->kind == SF_CONTROL_RANGE && values[0] > values[1]) { /* the one that was moved takes the other along */
        if (values[0] != (float)control->value[0])
            values[1] = values[0];
        else
            values[0] = values[1];
    }
    for (uint32_t i = 0; i < control->numbers; i++)
        control->value[i] = (double)values[i];
    return changed;
}

/* The control itself, over a copy; true when the copy's value is to become the scene's. */
static bool edit(struct sf_control *control, char text[TEXT_BYTES])
{
    bool flag = control->value[0] != 0;
    int choice = (int)control->value[0];
    char format[32];
    bool changed;

    switch (control->kind) {
    case SF_CONTROL_BOOL:
        changed = sf_ui_checkbox("##value", &flag);
        control->value[0] = flag;
        return changed;
    case SF_CONTROL_CHOICE:
        changed = sf_ui_choice("##value", &choice, control->choices);
        control->value[0] = choice;
        return changed;
    case SF_CONTROL_INT:
    case SF_CONTROL_FLOAT:
        /* Units of several kinds of object ("W/m2, W/sr") are left to the tooltip. */
        snprintf(format, sizeof format, strchr(control->unit, ',') ? "%%.4g" : "%%.4g %s", control->unit);
        return edit_number(control, format);
    case SF_CONTROL_TEXT:
        snprintf(text, TEXT_BYTES, "%s", control->text ? control->text : "");
        changed = sf_ui_input("##value", "none", text, TEXT_BYTES);
        control->text = text;
        return changed && text[0];
    default:
        return edit_numbers(control);
    }
}

/* Another type may ask for keys that the one before did not have. */
static void set_type(struct sf_view *view, const struct sf_control *control)
{
    static const struct {
        const char *type, *key, *value;
    } needs[] = {{"directional", "direction", "-0.5,-1,-0.3"},
                 {"spot", "direction", "0,-1,0"},
                 {"spot", "position", "0,3,0"},
                 {"point", "position", "0,3,0"},
                 {"buoyancy", "strength", "0.02"},
                 {"drag", "strength", "1"},
                 {"turbulence", "strength", "1"},
                 {"vortex", "strength", "1"},
                 {"wind", "velocity", "1,0,0"}};
    enum { SETS_MAX = 4 };
    char extra[SETS_MAX][SF_NAME_BYTES * 2], *assignment = sf_control_print(control);
    const char *type = control->choices[(int)control->value[0]], *sets[SETS_MAX] = {assignment};
    uint32_t count = 1;

    if (!assignment)
        return;
    for (size_t i = 0; i < sizeof needs / sizeof needs[0] && count < SETS_MAX; i++) {
        char *to = extra[count];

        snprintf(to, sizeof extra[0], "%s.%s", control->group, needs[i].key);
        if (strcmp(needs[i].type, type) != 0 || sf_model_control(&view->model, to))
            continue;
        snprintf(to, sizeof extra[0], "%s.%s=%s", control->group, needs[i].key, needs[i].value);
        sets[count++] = to;
    }
    sf_model_set_many(&view->model, sets, count);
    view->settle = true;
    free(assignment);
}

static void draw_control(struct sf_view *view, const struct sf_control *control)
{
    bool changed = sf_model_changed(&view->model, control->path), reset = false, apply;
    float room = sf_ui_room(), rectangle[4];
    struct sf_control copy = *control;
    char text[TEXT_BYTES];

    sf_ui_id_push(control->path);
    if (changed)
        sf_ui_text_color(sf_ui_accent, "%s", control->key);
    else
        sf_ui_text("%s", control->key);
    explain(control);
    sf_ui_same_line(room * LABEL_SHARE);
    sf_ui_width(changed ? -sf_ui_line() * 1.2f : -1);
    apply = edit(&copy, text);
    explain(control);
    sf_ui_last_rectangle(rectangle);
    if (view->arguments->verbose > 1 && view->search[0] && !view->said_place) {
        sf_view_note(view, SF_LOG_DEBUG, "control %s %.0f %.0f %.0f %.0f", control->path, (double)rectangle[0],
                     (double)rectangle[1], (double)rectangle[2], (double)rectangle[3]);
        view->said_place = true;
    }
    if (changed) {
        sf_ui_same_line(0);
        reset = sf_ui_small_button("x");
        sf_ui_tooltip("as in the file");
    }
    sf_ui_id_pop();
    if (reset) /* the controls are made anew: `copy` is stale */
        sf_view_reset(view, control->path);
    if (!apply || reset)
        return;
    if (copy.kind == SF_CONTROL_CHOICE && strcmp(copy.key, "type") == 0)
        set_type(view, &copy);
    else
        sf_view_apply(view, &copy);
}

/* What one turns most stands first: the smoke and how it is drawn, where it comes from, its light; then the stage. */
enum { PLACES = 13 };
static unsigned place_of(const struct sf_control *control)
{
    static const char *const names[PLACES - 1] = {"medium", "ramp",   "thick",  "reference",   "emitters", "forces",
                                                  "sim",    "lights", "shadow", "environment", "output",   "camera"};
    unsigned place = 0;

    while (place < PLACES - 1) {
        size_t length = strlen(names[place]);

        if (strncmp(control->group, names[place], length) == 0 && strchr(".", control->group[length]))
            break;
        place++;
    }
    return place;
}

/* The sections of one place. A change makes the array anew: the rest is drawn of the new one all the same, or the panel
 * would be shorter in this turn, and scroll. */
static void draw_place(struct sf_view *view, unsigned place)
{
    char section[SF_NAME_BYTES] = "", name[SF_NAME_BYTES + 8];
    bool open = false, searching = view->search[0] != '\0';

    for (uint32_t i = 0; i < view->model.control_count; i++) {
        const struct sf_control *control = &view->model.controls[i];

        if (place_of(control) != place || !wanted(view, control))
            continue;
        snprintf(name, SF_NAME_BYTES, "%s", control->group[0] ? control->group : "scene");
        if (strcmp(name, section) != 0) {
            snprintf(section, sizeof section, "%.*s", SF_NAME_BYTES - 1, name);
            /* Opened by a search; closed again after it, since the names differ. */
            snprintf(name, sizeof name, "%s##%s", section, searching ? "found" : "all");
            open = sf_ui_section(name, searching || strcmp(section, "thick") == 0 || strcmp(section, "medium") == 0);
        }
        if (open)
            draw_control(view, control);
    }
}

void sf_panel_parameters(struct sf_view *view)
{
    sf_ui_width(-2.75f * sf_ui_line());
    if (sf_ui_search("##search", "search (Ctrl+F)", view->search, sizeof view->search, view->focus_search))
        view->said_place = false;
    view->focus_search = false;
    sf_ui_same_line(0);
    sf_ui_disable(view->model.set_count == 0);
    if (sf_ui_button("reset all"))
        sf_view_reset(view, NULL);
    sf_ui_enable();
    sf_ui_tooltip("every parameter as in the file (Ctrl+Z)");
    if (sf_ui_child_begin("controls", 0))
        for (unsigned place = 0; place < PLACES; place++)
            draw_place(view, place);
    sf_ui_child_end();
}
