/* The picture held against the reference: numbers, and the map's scale over the picture. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "heat.h"
#include "looking.h"
#include "panel_draw.h"
#include "view.h"

enum { TEXT_BYTES = 160, SCALE_STEPS = 64, STRIDES = 4 };
static const float BAR_WIDTH = 200; /* px at scale 1 */
static const float CLICK = 4;       /* px: a press that is no drag */

/* ---- asking for it ---- */

static void choose_stride(struct sf_view *view)
{
    static const char *const strides[STRIDES + 1] = {"1/1", "1/2", "1/4", "1/8", NULL};
    uint32_t stride;

    sf_ui_width(4.5f * sf_ui_line());
    if (sf_ui_choice("of each side", &view->against.stride, strides) && view->against.comparison)
        sf_against_begin(view);
    sf_ui_tooltip("The reference of one pixel of each block of so many: a quarter of the sides is a sixteenth of the "
                  "time. The method's picture is not made smaller: its pixel at the same place is compared.");
    stride = 1u << view->against.stride;
    sf_ui_text_color(sf_ui_dim, "%" PRIu32 "x%" PRIu32 " of %" PRIu32 "x%" PRIu32 " pixels, one scattering",
                     (view->options.width + stride - 1) / stride, (view->options.height + stride - 1) / stride,
                     view->options.width, view->options.height);
}

static void draw_state(struct sf_view *view)
{
    struct sf_against *against = &view->against;
    char text[SF_COMPARISON_MESSAGE];
    uint64_t done, total;

    if (against->wanted || against->gone) {
        sf_ui_text_color(sf_ui_dim, against->wanted ? "with the next picture" : "stopping: rows in hand are finished");
        return;
    }
    if (!against->comparison) {
        sf_ui_text_wrapped(sf_ui_dim, against->outdated
                                          ? "What was compared has changed."
                                          : "How far the picture is from the reference, computed on the processor.");
        return;
    }
    switch (sf_comparison_stage(against->comparison)) {
    case SF_COMPARISON_RUNS:
        done = sf_comparison_progress(against->comparison, &total);
        snprintf(text, sizeof text, "row %" PRIu64 " of %" PRIu64, done, total);
        sf_ui_progress(total > 0 ? (float)done / (float)total : 0, text);
        break;
    case SF_COMPARISON_FAILED:
        sf_comparison_message(against->comparison, text);
        sf_ui_text_wrapped(sf_ui_error, text);
        break;
    case SF_COMPARISON_DONE:
    case SF_COMPARISON_STOPPED:
        break;
    }
}

static void draw_asking(struct sf_view *view)
{
    struct sf_against *against = &view->against;
    bool running =
        against->comparison && !against->gone && sf_comparison_stage(against->comparison) == SF_COMPARISON_RUNS;

    if (sf_ui_button(running ? "stop##compare" : "compare now##compare")) {
        if (running)
            sf_against_stop(view);
        else
            sf_against_begin(view);
    }
    sf_ui_tooltip("T. The frame as it is, from here, at full quality, against single scattering computed to a "
                  "tolerance of 1e-4. Whatever changes (scene, eye, frame, size) ends it.");
    sf_ui_same_line(0);
    choose_stride(view);
    draw_state(view);
}

/* ---- what came of it ---- */

static void say(const char *name, bool missed, const char *meaning, const char *text)
{
    sf_ui_text_color(sf_ui_dim, "%s", name);
    sf_ui_tooltip("%s", meaning);
    sf_ui_same_line(7 * sf_ui_line());
    sf_ui_text_color(missed ? sf_ui_warning : sf_ui_plain, "%s", text);
}

static void draw_errors(const struct sf_errors *errors)
{
    unsigned missed = sf_goals_missed(errors);
    char text[TEXT_BYTES];

    snprintf(text, sizeof text, "mean %.3g", errors->transmittance_mean);
    say("transmittance", missed & SF_GOAL_MEAN,
        "Of the difference's size over all pixels. Goals: mean 0.002, max 0.02 (of 1 - alpha, too).", text);
    snprintf(text, sizeof text, "max %.3g at %" PRIu32 ", %" PRIu32, errors->transmittance_max, errors->worst[0],
             errors->worst[1]);
    say("", missed & SF_GOAL_MAX, "The pixel with the greatest difference.", text);
    snprintf(text, sizeof text, "mean %.3g", errors->alpha_mean);
    say("1 - alpha", missed & SF_GOAL_MEAN, "The same of what the picture is laid over the background by.", text);
    snprintf(text, sizeof text, "max %.3g", errors->alpha_max);
    say("", missed & SF_GOAL_MAX, "The same of what the picture is laid over the background by.", text);
    snprintf(text, sizeof text, "%.4g", errors->relative_mse);
    say("relative MSE", missed & SF_GOAL_MSE,
        "Of the radiance: sum of (method - reference)^2 over sum of reference^2. Goal: 0.01.", text);
    snprintf(text, sizeof text, "%+.3g", errors->bias);
    say("bias", false, "Of the radiance: sum of (method - reference) over sum of reference.", text);
    snprintf(text, sizeof text, "%.3g", errors->p99);
    say("p99", false, "99 % of the smoke's pixels are nearer, relative to the reference's root mean square.", text);
    if (errors->not_finite > 0)
        sf_ui_text_color(sf_ui_error, "%zu pixels of the method are no numbers", errors->not_finite);
}

static void draw_result(struct sf_view *view)
{
    uint32_t unconverged = 0;
    double seconds = 0;
    const struct sf_errors *errors = sf_comparison_errors(view->against.comparison, &unconverged, &seconds);

    if (errors) {
        draw_errors(errors);
        sf_ui_text_color(sf_ui_dim, "%zu pixels, %zu of them smoke, in %.1f s", errors->pixels, errors->smoky, seconds);
        if (unconverged > 0)
            sf_ui_text_color(sf_ui_warning, "%" PRIu32 " pixels of the reference are over its tolerance", unconverged);
    }
    for (uint32_t i = 0; sf_comparison_note(view->against.comparison, i); i++)
        sf_ui_text_wrapped(sf_ui_warning, sf_comparison_note(view->against.comparison, i));
}

static void choose_map(struct sf_view *view)
{
    static const char *const kinds[] = {"radiance", "transmittance", "no map: the picture", NULL};
    struct sf_against *against = &view->against;
    float high = against->heat.high;

    sf_ui_width(sf_ui_room() * 0.55f);
    if (sf_ui_choice("difference", &against->kind, kinds))
        sf_against_show(view);
    sf_ui_tooltip("Method minus reference: red where the method has more, blue where it has less. Of radiance the "
                  "luminance, W/(m2 sr). Violet checks: the method has no number.");
    if (!against->heat.values)
        return;
    sf_ui_checkbox("automatic scale", &against->heat.automatic);
    sf_ui_tooltip("Up to the greatest difference of the map.");
    sf_ui_same_line(0);
    sf_ui_width(sf_ui_room() * 0.6f);
    if (sf_ui_drag("scale", &high, 1, high / 100, 1e-9f, 1e9f, "%.3g") && high > 0) {
        against->heat.automatic = false;
        against->heat.high = high;
        against->heat.low = -high;
    }
    sf_ui_tooltip("The difference that is shown in the brightest red or blue. Drag it, or type it after a double "
                  "click.");
}

void sf_panel_truth(struct sf_view *view)
{
    struct sf_against *against = &view->against;

    against->open = true;
    draw_asking(view);
    if (!against->comparison || against->gone || sf_comparison_stage(against->comparison) == SF_COMPARISON_FAILED)
        return;
    sf_ui_separator();
    if (against->mapped)
        choose_map(view);
    draw_result(view);
    sf_ui_separator();
    sf_panel_probe(view);
}

/* ---- over the picture ---- */

/* The pixel of the frame that the mouse is at; false: at none. */
static bool pixel_at(const struct sf_view *view, const struct sf_looking *heat, float x, float y, uint32_t pixel[2])
{
    const float *place = view->picture;
    uint32_t size[2], compared[2], stride = sf_comparison_stride(view->against.comparison);

    sf_comparison_size(view->against.comparison, size, compared);
    if (x < 0 || y < 0 || x >= place[2] || y >= place[3])
        return false;
    if (heat) {
        if (!sf_looking_texel(heat, place[2], place[3], x, y, &pixel[0], &pixel[1]))
            return false;
        sf_panel_look_mark(view, heat, pixel[0], pixel[1]);
        for (int i = 0; i < 2; i++)
            pixel[i] = sf_errors_pixel(pixel[i], stride, size[i]);
        return true;
    }
    pixel[0] = (uint32_t)(x / place[2] * (float)size[0]);
    pixel[1] = (uint32_t)(y / place[3] * (float)size[1]);
    return pixel[0] < size[0] && pixel[1] < size[1];
}

/* A press that went nowhere. */
static bool clicked(struct sf_against *against, float x, float y, bool inside)
{
    bool let_go = against->pressed && !sf_ui_mouse_down(0);

    if (sf_ui_mouse_clicked(0) && inside) {
        against->pressed = true;
        against->pressed_at[0] = x;
        against->pressed_at[1] = y;
    }
    if (!let_go)
        return false;
    against->pressed = false;
    return inside && fabsf(x - against->pressed_at[0]) + fabsf(y - against->pressed_at[1]) < CLICK * sf_ui_scale();
}

static void choose_pixel(struct sf_view *view, const uint32_t pixel[2], bool click)
{
    struct sf_against *against = &view->against;
    bool same = memcmp(pixel, against->pixel, sizeof against->pixel) == 0;

    if (click)
        against->pinned = !(against->pinned && same);
    if (same || (against->pinned && !click))
        return;
    memcpy(against->pixel, pixel, sizeof against->pixel);
    against->probe_wanted = true;
}

static void mark_pinned(const struct sf_view *view, const struct sf_looking *heat)
{
    const struct sf_against *against = &view->against;
    uint32_t size[2], compared[2], stride = sf_comparison_stride(against->comparison);
    float x, y, radius = 6 * sf_ui_scale();

    if (!against->pinned)
        return;
    sf_comparison_size(against->comparison, size, compared);
    x = ((float)against->pixel[0] + 0.5f) * view->picture[2] / (float)size[0];
    y = ((float)against->pixel[1] + 0.5f) * view->picture[3] / (float)size[1];
    if (heat)
        sf_looking_spot(heat, view->picture[2], view->picture[3], against->pixel[0] / stride,
                        against->pixel[1] / stride, &x, &y);
    sf_ui_draw_circle(view->picture[0] + x, view->picture[1] + y, radius, sf_ui_accent, false);
    sf_ui_draw_circle(view->picture[0] + x, view->picture[1] + y, radius + 1, 0xa0000000, false);
}

/* What is shown, so that nobody takes it for the picture, and what its colours mean. */
static void draw_scale(const struct sf_view *view)
{
    const struct sf_against *against = &view->against;
    float scale = sf_ui_scale(), width = BAR_WIDTH * scale, height = floorf(62 * scale), x, y,
          high = against->heat.high;
    char ends[3][TEXT_BYTES];
    uint8_t rgb[3];

    x = view->picture[0] + 10 * scale;
    y = view->picture[1] + view->picture[3] - height - 10 * scale;
    snprintf(ends[0], TEXT_BYTES, "%.3g", (double)-high);
    snprintf(ends[1], TEXT_BYTES, "0");
    snprintf(ends[2], TEXT_BYTES, "+%.3g", (double)high);
    sf_ui_draw_rectangle(x, y, width + 76 * scale, height, 0xd8151617, true);
    x += 38 * scale;
    sf_ui_draw_text(x, y + 4 * scale, sf_ui_plain,
                    against->kind == SF_DIFFERENCE_RADIANCE ? "radiance: method - reference"
                                                            : "transmittance: method - reference");
    for (int i = 0; i < SCALE_STEPS; i++) {
        sf_heat_color(high * (2 * ((float)i + 0.5f) / SCALE_STEPS - 1), high, rgb);
        sf_ui_draw_rectangle(x + width * (float)i / SCALE_STEPS, y + 25 * scale, width / SCALE_STEPS + 0.5f, 12 * scale,
                             0xff000000u | (uint32_t)rgb[2] << 16 | (uint32_t)rgb[1] << 8 | rgb[0], true);
    }
    for (int i = 0; i < 3; i++)
        sf_ui_draw_text(x + width * (float)i / 2 - sf_ui_text_width(ends[i]) / 2, y + 41 * scale, sf_ui_dim, ends[i]);
}

void sf_panel_truth_over(struct sf_view *view)
{
    struct sf_against *against = &view->against;
    struct sf_looking *heat = against->open && against->heat.values ? &against->heat : NULL;
    float x, y;
    uint32_t pixel[2];
    bool inside, click;

    if (!against->open || !against->comparison || against->gone)
        return;
    sf_ui_mouse(&x, &y);
    x -= view->picture[0];
    y -= view->picture[1];
    inside = x >= 0 && y >= 0 && x < view->picture[2] && y < view->picture[3] && !sf_ui_takes_mouse();
    if (heat)
        sf_panel_look_move(view, heat, x, y, inside);
    click = clicked(against, x, y, inside);
    sf_ui_draw_behind();
    sf_ui_draw_clip(view->picture[0], view->picture[1], view->picture[2], view->picture[3]);
    if (inside && pixel_at(view, heat, x, y, pixel))
        choose_pixel(view, pixel, click);
    mark_pinned(view, heat);
    if (heat)
        draw_scale(view);
    sf_ui_draw_unclip();
    sf_ui_draw_panel();
    if (against->probe_wanted)
        sf_against_probe(view);
    against->probe_wanted = false;
}
