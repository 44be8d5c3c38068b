/* A pixel's ray: transmittance and radiance on the way, for the reference and the method. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "panel_draw.h"
#include "view.h"

enum { TEXT_BYTES = 160, QUANTITIES = 4 };
static const float PLOT_HEIGHT = 104, AXIS_WIDTH = 58, TEXT_HEIGHT = 14; /* px at scale 1 */
static const uint32_t METHOD_COLOR = 0xff66a0d9u,
                      QUANTITY_COLORS[QUANTITIES] = {0xffdad4ccu, 0xff6a6ae8u, 0xff7fc97fu, 0xffe59a6au};

/* What is known of it: `curve` is the method's, `count` 0 where it has none (yet). */
struct ray {
    struct sf_probe probe;
    const struct sf_probe_point *curve;
    uint32_t count;
};

struct plot {
    float x, y, width, height; /* px */
    float from, to, most;      /* m of view depth; the value on top */
};

static float plot_x(const struct plot *plot, float depth)
{
    float part = plot->to > plot->from ? (depth - plot->from) / (plot->to - plot->from) : 1;

    return plot->x + plot->width * fminf(fmaxf(part, 0), 1);
}

static float plot_y(const struct plot *plot, float value)
{
    return plot->y + plot->height * (1 - fminf(fmaxf(value / plot->most, 0), 1));
}

/* Quantity 0 is transmittance, 1 to 3 are red, green and blue. */
static float quantity(const struct sf_probe_point *point, int which)
{
    return which == 0 ? point->transmittance : point->radiance[which - 1];
}

static void draw_line(const struct plot *plot, const struct sf_probe_point *points, uint32_t count, int which,
                      uint32_t color, float thickness)
{
    for (uint32_t i = 1; i < count; i++)
        sf_ui_draw_line(plot_x(plot, points[i - 1].depth), plot_y(plot, quantity(&points[i - 1], which)),
                        plot_x(plot, points[i].depth), plot_y(plot, quantity(&points[i], which)), color, thickness);
}

/* The reference along the ray, the method's samples, and what it ended with: a line through the plot and a dot at its
 * end. */
static void draw_curve(const struct plot *plot, const struct ray *ray, int which)
{
    const struct sf_probe *probe = &ray->probe;
    float end = which == 0 ? probe->depths[3] : probe->smoke[which - 1], scale = sf_ui_scale();

    if (!probe->empty)
        draw_line(plot, probe->points, SF_PROBE_POINTS, which, QUANTITY_COLORS[which], 1.5f * scale);
    draw_line(plot, ray->curve, ray->count, which, sf_color_faint(METHOD_COLOR, 0.7f), scale);
    for (uint32_t i = 0; i < ray->count; i++)
        sf_ui_draw_circle(plot_x(plot, ray->curve[i].depth), plot_y(plot, quantity(&ray->curve[i], which)),
                          2.5f * scale, QUANTITY_COLORS[which], true);
    if (!isfinite(end))
        return;
    sf_ui_draw_line(plot->x, plot_y(plot, end), plot->x + plot->width, plot_y(plot, end),
                    sf_color_faint(QUANTITY_COLORS[which], 0.35f), 1);
    sf_ui_draw_circle(plot->x + plot->width - 3 * scale, plot_y(plot, end), 3.5f * scale, QUANTITY_COLORS[which], true);
    sf_ui_draw_circle(plot->x + plot->width - 3 * scale, plot_y(plot, end), 4 * scale, METHOD_COLOR, false);
}

static void draw_axes(const struct plot *plot)
{
    float scale = sf_ui_scale(), height = TEXT_HEIGHT * scale;
    char text[TEXT_BYTES];

    sf_ui_draw_rectangle(plot->x, plot->y, plot->width, plot->height, 0x60000000, true);
    for (int i = 0; i <= 2; i++) {
        float value = plot->most * (float)i / 2, y = plot_y(plot, value);

        sf_ui_draw_line(plot->x, y, plot->x + plot->width, y, SF_COLOR_SHADE, 1);
        snprintf(text, sizeof text, "%.3g", (double)value);
        sf_draw_text_right(plot->x - 6 * scale, fminf(fmaxf(y - height / 2, plot->y), plot->y + plot->height - height),
                           sf_ui_dim, text);
    }
    snprintf(text, sizeof text, "%.4g m", (double)plot->from);
    sf_ui_draw_text(plot->x, plot->y + plot->height + 2 * scale, sf_ui_dim, text);
    snprintf(text, sizeof text, "%.4g m", (double)plot->to);
    sf_draw_text_right(plot->x + plot->width, plot->y + plot->height + 2 * scale, sf_ui_dim, text);
}

/* Where the method says that smoke begins and ends. */
static void draw_span(const struct plot *plot, const struct sf_probe *probe)
{
    for (int i = 0; i < 2; i++)
        if (probe->depths[i] >= plot->from && probe->depths[i] <= plot->to)
            sf_ui_draw_line(plot_x(plot, probe->depths[i]), plot->y, plot_x(plot, probe->depths[i]),
                            plot->y + plot->height, sf_color_faint(METHOD_COLOR, 0.5f), 1);
}

static int print_point(char *text, size_t room, const char *who, const struct sf_probe_point *point)
{
    return snprintf(text, room, "%s, to %.4g m\ntransmittance %.5f\nradiance %.4g  %.4g  %.4g", who,
                    (double)point->depth, (double)point->transmittance, (double)point->radiance[0],
                    (double)point->radiance[1], (double)point->radiance[2]);
}

/* The values of all curves at the mouse: of the method the last ones before it. */
static void explain_depth(const struct plot *plot, const struct ray *ray, const char *method)
{
    const struct sf_probe_point *points = ray->probe.points, *last = &points[SF_PROBE_POINTS - 1];
    char text[2 * TEXT_BYTES] = "";
    float x, y, part, depth, along;
    uint32_t before = 0;
    int used = 0;

    sf_ui_mouse(&x, &y);
    part = (x - plot->x) / plot->width;
    if (!sf_ui_last_hovered() || part < 0 || part > 1)
        return;
    depth = plot->from + part * (plot->to - plot->from);
    sf_ui_draw_line(x, plot->y, x, plot->y + plot->height, sf_color_faint(sf_ui_dim, 0.5f), 1);
    if (!ray->probe.empty) {
        along = last->depth > points[0].depth ? (depth - points[0].depth) / (last->depth - points[0].depth) : 1;
        used = print_point(text, sizeof text, "reference",
                           &points[(unsigned)(fminf(fmaxf(along, 0), 1) * (SF_PROBE_POINTS - 1) + 0.5f)]);
    }
    while (before + 1 < ray->count && ray->curve[before + 1].depth <= depth)
        before++;
    if (ray->count > 0 && used >= 0 && (size_t)used < sizeof text) {
        if (used > 0)
            text[used++] = '\n';
        print_point(text + used, sizeof text - (size_t)used, method, &ray->curve[before]);
    }
    sf_ui_tooltip("%s", text);
}

/* Where the reference and the method have smoke. */
static void choose_range(const struct ray *ray, struct plot *plot)
{
    plot->from = ray->probe.empty ? ray->curve[0].depth : ray->probe.points[0].depth;
    plot->to = ray->probe.empty ? plot->from : ray->probe.points[SF_PROBE_POINTS - 1].depth;
    if (ray->count == 0)
        return;
    plot->from = fminf(plot->from, ray->curve[0].depth);
    plot->to = fmaxf(plot->to, ray->curve[ray->count - 1].depth);
}

static void draw_plot(const char *name, const struct ray *ray, const char *method, int first, int last)
{
    const struct sf_probe *probe = &ray->probe;
    const struct sf_probe_point *end = &probe->points[SF_PROBE_POINTS - 1];
    float scale = sf_ui_scale(), margin = AXIS_WIDTH * scale;
    struct plot plot = {.width = fmaxf(sf_ui_room() - margin - 4 * scale, margin),
                        .height = floorf(PLOT_HEIGHT * scale),
                        .most = first == 0 ? 1 : 1e-6f};

    choose_range(ray, &plot);
    for (int which = first; first > 0 && which <= last; which++)
        plot.most = fmaxf(plot.most, 1.1f * fmaxf(quantity(end, which), probe->smoke[which - 1]));
    sf_ui_canvas(name, plot.width + margin, plot.height + 20 * scale, &plot.x, &plot.y);
    plot.x += margin;
    draw_axes(&plot);
    sf_ui_draw_clip(plot.x, plot.y - 1, plot.width, plot.height + 2);
    draw_span(&plot, probe);
    for (int which = first; which <= last; which++)
        draw_curve(&plot, ray, which);
    explain_depth(&plot, ray, method);
    sf_ui_draw_unclip();
}

/* Both rays of the newest probe; false: there is none. */
static bool find_ray(const struct sf_against *against, struct ray *ray)
{
    *ray = (struct ray){0};
    if (!sf_comparison_probed(against->comparison, &ray->probe))
        return false;
    if (against->way != SF_WAY_KNOWN || against->curve_at[0] != ray->probe.x || against->curve_at[1] != ray->probe.y)
        return true;
    ray->curve = against->curve;
    ray->count = against->curve_count;
    return true;
}

static void say_ends(const struct ray *ray, const char *method, bool radiance)
{
    const struct sf_probe *probe = &ray->probe;
    const struct sf_probe_point *end = &probe->points[SF_PROBE_POINTS - 1];

    if (!radiance) {
        sf_ui_text("transmittance  %.5f   reference %.5f", (double)probe->depths[3], (double)end->transmittance);
        sf_ui_tooltip(
            "Lines: the reference between the eye and a view depth. Small dots: what %s has counted up to each of "
            "its samples. The large dots and the faint lines through them: what it ended with. Upright lines: "
            "where it says that smoke begins and ends.",
            method);
        return;
    }
    sf_ui_text("radiance  %.4g %.4g %.4g", (double)probe->smoke[0], (double)probe->smoke[1], (double)probe->smoke[2]);
    sf_ui_text_color(sf_ui_dim, "reference  %.4g %.4g %.4g", (double)end->radiance[0], (double)end->radiance[1],
                     (double)end->radiance[2]);
    sf_ui_tooltip("Light scattered in and emitted between the eye and a view depth, as it reaches the eye: red, green "
                  "and blue, W/(m2 sr).");
}

void sf_panel_probe(struct sf_view *view)
{
    const struct sf_against *against = &view->against;
    const char *method = view->model.info.method;
    struct ray ray;
    bool any;

    if (!find_ray(against, &ray)) {
        sf_ui_text_wrapped(sf_ui_dim, "Rest on a pixel of the picture to see its ray; a click keeps it.");
        return;
    }
    sf_ui_text_color(sf_ui_accent, "ray of pixel %" PRIu32 ", %" PRIu32 "%s", ray.probe.x, ray.probe.y,
                     against->pinned ? " (kept: click it again)" : "");
    if (ray.probe.failed) {
        sf_ui_text_color(sf_ui_error, "its reference cannot be computed");
        return;
    }
    any = !ray.probe.empty || ray.count > 0;
    say_ends(&ray, method, false);
    if (any)
        draw_plot("transmittance along the ray", &ray, method, 0, 0);
    say_ends(&ray, method, true);
    if (any)
        draw_plot("radiance along the ray", &ray, method, 1, 3);
    if (ray.probe.empty)
        sf_ui_text_color(sf_ui_dim, "for the reference this ray meets no smoke");
    if (against->way == SF_WAY_NONE)
        sf_ui_text_color(sf_ui_dim, "%s keeps nothing of the way: its end alone is shown", method);
}
