#include "plot.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "markup.h"

enum {
    WIDTH = 760,
    HEIGHT = 460,
    LEFT = 76,
    RIGHT = 24,
    TOP = 48,
    BOTTOM = 58,
    LETTER = 6, /* px: mean width of a letter of a label */
    LINE = 13,  /* px: its height */
    BOXES_MAX = 512
};

/* Told apart by eyes that do not tell red from green (Okabe and Ito 2008), and by their markers. */
static const char *const colors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#222222"};
enum { COLORS = sizeof colors / sizeof *colors, MARKERS = 4 };

/* Letters stand out from what they lie over. */
static const char halo[] = "stroke=\"#ffffff\" stroke-width=\"3\" stroke-linejoin=\"round\" paint-order=\"stroke\"";

struct box {
    double left, top, right, bottom;
};

struct axes {
    double low[2], high[2]; /* decimal logarithms: x, y */
};

struct drawing {
    const struct sf_plot *plot;
    FILE *stream;
    struct axes axes;
    struct box boxes[BOXES_MAX]; /* taken by markers and labels */
    size_t box_count;
};

const char *sf_plot_color(size_t series)
{
    return colors[series % COLORS];
}

static bool drawn(const struct sf_plot_point *point)
{
    return isfinite(point->x) && isfinite(point->y) && point->x > 0 && point->y > 0;
}

/* ---- axes ---- */

static void include(struct axes *axes, int axis, double value)
{
    axes->low[axis] = fmin(axes->low[axis], log10(value));
    axes->high[axis] = fmax(axes->high[axis], log10(value));
}

/* Around all points and the goal with some room, and never narrower than a third of a decade. */
static struct axes fit(const struct sf_plot *plot)
{
    struct axes axes = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};

    for (size_t i = 0; i < plot->count; i++) {
        if (!drawn(&plot->points[i]))
            continue;
        include(&axes, 0, plot->points[i].x);
        include(&axes, 1, plot->points[i].y);
    }
    if (plot->goal > 0)
        include(&axes, 1, plot->goal);
    for (int i = 0; i < 2; i++) {
        if (!(axes.low[i] <= axes.high[i]))
            axes.low[i] = axes.high[i] = 0;
        double middle = (axes.low[i] + axes.high[i]) / 2, half = fmax(axes.high[i] - middle, 1 / 6.0);

        axes.low[i] = middle - 1.12 * half;
        axes.high[i] = middle + (i == 0 ? 1.25 : 1.12) * half; /* labels stand to the right */
    }
    return axes;
}

static double place_x(const struct axes *axes, double x)
{
    return LEFT + (log10(x) - axes->low[0]) / (axes->high[0] - axes->low[0]) * (WIDTH - LEFT - RIGHT);
}

static double place_y(const struct axes *axes, double y)
{
    return HEIGHT - BOTTOM - (log10(y) - axes->low[1]) / (axes->high[1] - axes->low[1]) * (HEIGHT - TOP - BOTTOM);
}

/* A line across, with the number when `labelled`. */
static void draw_tick(struct drawing *drawing, int axis, double value, bool labelled)
{
    FILE *to = drawing->stream;
    double x = place_x(&drawing->axes, value), y = place_y(&drawing->axes, value);
    const char *color = labelled ? "#d4d4d4" : "#ececec";

    if (axis == 0)
        fprintf(to, "<line x1=\"%.1f\" y1=\"%d\" x2=\"%.1f\" y2=\"%d\" stroke=\"%s\"/>\n", x, TOP, x, HEIGHT - BOTTOM,
                color);
    else
        fprintf(to, "<line x1=\"%d\" y1=\"%.1f\" x2=\"%d\" y2=\"%.1f\" stroke=\"%s\"/>\n", LEFT, y, WIDTH - RIGHT, y,
                color);
    if (!labelled)
        return;
    if (axis == 0)
        fprintf(to, "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%g</text>\n", x, HEIGHT - BOTTOM + 17, value);
    else
        fprintf(to, "<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%g</text>\n", LEFT - 8, y + 4, value);
}

/* Decades; with fewer than three of them 2 and 5 have numbers too, with fewer than one all do. */
static void draw_ticks(struct drawing *drawing, int axis)
{
    double low = drawing->axes.low[axis], high = drawing->axes.high[axis], span = high - low;

    for (int decade = (int)floor(low); decade <= (int)ceil(high); decade++) {
        for (int i = 1; i < 10; i++) {
            double value = i * pow(10, decade), at = log10(value);
            bool labelled = i == 1 || (span < 3 && (i == 2 || i == 5)) || span < 0.9;

            if (at >= low && at <= high && (span < 6 || i == 1))
                draw_tick(drawing, axis, value, labelled);
        }
    }
}

static void draw_frame(struct drawing *drawing)
{
    const struct sf_plot *plot = drawing->plot;
    FILE *to = drawing->stream;

    fprintf(to,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" width=\"%d\" height=\"%d\" "
            "font-family=\"sans-serif\" font-size=\"11\" fill=\"#333333\" role=\"img\">\n<title>",
            WIDTH, HEIGHT, WIDTH, HEIGHT);
    sf_markup_text(to, plot->title);
    fprintf(to, "</title>\n<rect width=\"%d\" height=\"%d\" fill=\"#ffffff\"/>\n", WIDTH, HEIGHT);
    draw_ticks(drawing, 0);
    draw_ticks(drawing, 1);
    fprintf(to, "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" fill=\"none\" stroke=\"#888888\"/>\n", LEFT, TOP,
            WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM);
    fprintf(to, "<text x=\"%d\" y=\"20\" font-size=\"14\" font-weight=\"bold\">", LEFT);
    sf_markup_text(to, plot->title);
    fprintf(to, "</text>\n<text x=\"%d\" y=\"%d\" text-anchor=\"middle\" font-size=\"12\">", (LEFT + WIDTH - RIGHT) / 2,
            HEIGHT - 16);
    sf_markup_text(to, plot->x_label);
    fprintf(to, "</text>\n<text transform=\"translate(18 %d) rotate(-90)\" text-anchor=\"middle\" font-size=\"12\">",
            (TOP + HEIGHT - BOTTOM) / 2);
    sf_markup_text(to, plot->y_label);
    fprintf(to, "</text>\n");
}

static void take(struct drawing *drawing, struct box box)
{
    if (drawing->box_count < BOXES_MAX)
        drawing->boxes[drawing->box_count++] = box;
}

static void draw_goal(struct drawing *drawing)
{
    const struct sf_plot *plot = drawing->plot;
    double y = place_y(&drawing->axes, plot->goal);

    if (!(plot->goal > 0))
        return;
    fprintf(drawing->stream,
            "<line x1=\"%d\" y1=\"%.1f\" x2=\"%d\" y2=\"%.1f\" stroke=\"#666666\" stroke-dasharray=\"6 4\"/>\n"
            "<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\" fill=\"#666666\">",
            LEFT, y, WIDTH - RIGHT, y, WIDTH - RIGHT - 6, y - 5);
    sf_markup_text(drawing->stream, plot->goal_label);
    fprintf(drawing->stream, "</text>\n");
    take(drawing, (struct box){WIDTH - RIGHT - 6 - (double)strlen(plot->goal_label) * LETTER, y - 5 - LINE,
                               WIDTH - RIGHT, y + 1});
}

/* ---- points ---- */

static void draw_lines(struct drawing *drawing)
{
    const struct sf_plot *plot = drawing->plot;

    for (size_t i = 1; i < plot->count; i++) {
        const struct sf_plot_point *a = &plot->points[i - 1], *b = &plot->points[i];

        if (a->line == 0 || a->line != b->line || a->series != b->series || !drawn(a) || !drawn(b))
            continue;
        fprintf(drawing->stream,
                "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\" stroke-opacity=\"0.45\"%s/>\n",
                place_x(&drawing->axes, a->x), place_y(&drawing->axes, a->y), place_x(&drawing->axes, b->x),
                place_y(&drawing->axes, b->y), sf_plot_color(a->series),
                a->line % 2 ? "" : " stroke-dasharray=\"2 3\"");
    }
}

static void draw_marker(FILE *to, double x, double y, size_t series, double size)
{
    const char *color = sf_plot_color(series);

    switch (series % MARKERS) {
    case 0:
        fprintf(to, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" fill=\"%s\"/>\n", x, y, size, color);
        break;
    case 1:
        fprintf(to, "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"%s\"/>\n", x - size, y - size,
                2 * size, 2 * size, color);
        break;
    case 2:
        fprintf(to, "<path d=\"M%.1f %.1fL%.1f %.1fL%.1f %.1fZ\" fill=\"%s\"/>\n", x, y - 1.2 * size, x + 1.1 * size,
                y + 0.9 * size, x - 1.1 * size, y + 0.9 * size, color);
        break;
    default:
        fprintf(to, "<path d=\"M%.1f %.1fL%.1f %.1fL%.1f %.1fL%.1f %.1fZ\" fill=\"%s\"/>\n", x, y - 1.3 * size,
                x + 1.3 * size, y, x, y + 1.3 * size, x - 1.3 * size, y, color);
        break;
    }
}

static bool free_of_others(const struct drawing *drawing, struct box box)
{
    bool inside = box.left >= LEFT && box.right <= WIDTH - RIGHT && box.top >= TOP && box.bottom <= HEIGHT - BOTTOM;

    for (size_t i = 0; i < drawing->box_count && inside; i++) {
        const struct box *other = &drawing->boxes[i];

        inside = box.right <= other->left || box.left >= other->right || box.bottom <= other->top ||
                 box.top >= other->bottom;
    }
    return inside;
}

/* Right of the point, left, above, below, or at one of the corners: the first place that is free. A line leads to one that
 * is farther away. */
static void draw_label(struct drawing *drawing, const struct sf_plot_point *point)
{
    static const double ways[][2] = {{1, 0}, {-1, 0}, {0, -1}, {0, 1}, {1, -1}, {1, 1}, {-1, -1}, {-1, 1}};
    double x = place_x(&drawing->axes, point->x), y = place_y(&drawing->axes, point->y);
    double width = (double)strlen(point->label) * LETTER;

    if (!point->label[0])
        return;
    for (size_t i = 0; i < 5 * sizeof ways / sizeof *ways; i++) {
        const double *way = ways[i % (sizeof ways / sizeof *ways)];
        double far = 1 + (double)(i / (sizeof ways / sizeof *ways));
        double middle_x = x + way[0] * (width / 2 + 8 * far), middle_y = y + way[1] * 13 * far;
        const struct box box = {middle_x - width / 2, middle_y - LINE / 2.0, middle_x + width / 2,
                                middle_y + LINE / 2.0};

        if (!free_of_others(drawing, box))
            continue;
        take(drawing, box);
        if (far > 1)
            fprintf(drawing->stream, "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#aaaaaa\"/>\n", x,
                    y,
                    way[0] > 0   ? box.left
                    : way[0] < 0 ? box.right
                                 : middle_x,
                    way[1] == 0 ? y : middle_y - way[1] * LINE / 2);
        fprintf(drawing->stream, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\" %s>", middle_x, middle_y + 4,
                halo);
        sf_markup_text(drawing->stream, point->label);
        fprintf(drawing->stream, "</text>\n");
        return;
    }
}

static void draw_points(struct drawing *drawing)
{
    const struct sf_plot *plot = drawing->plot;

    for (size_t i = 0; i < plot->count; i++) {
        const struct sf_plot_point *point = &plot->points[i];
        double x = place_x(&drawing->axes, point->x), y = place_y(&drawing->axes, point->y);

        if (!drawn(point))
            continue;
        draw_marker(drawing->stream, x, y, point->series, point->line ? 3.5 : 5.5);
        take(drawing, (struct box){x - 5, y - 5, x + 5, y + 5});
    }
    for (size_t i = 0; i < plot->count; i++)
        if (drawn(&plot->points[i]))
            draw_label(drawing, &plot->points[i]);
}

static void draw_legend(struct drawing *drawing)
{
    double x = LEFT + 6;

    for (size_t i = 0; i < drawing->plot->series_count; i++) {
        draw_marker(drawing->stream, x, 34, i, 4.5);
        fprintf(drawing->stream, "<text x=\"%.1f\" y=\"38\">", x + 10);
        sf_markup_text(drawing->stream, drawing->plot->series[i]);
        fprintf(drawing->stream, "</text>\n");
        x += 30 + (double)strlen(drawing->plot->series[i]) * (LETTER + 0.5);
    }
}

char *sf_plot_svg(const struct sf_plot *plot)
{
    struct drawing *drawing = calloc(1, sizeof *drawing);
    char *text = NULL;
    size_t bytes = 0;

    if (!drawing)
        return NULL;
    drawing->plot = plot;
    drawing->axes = fit(plot);
    drawing->stream = open_memstream(&text, &bytes);
    if (drawing->stream) {
        draw_frame(drawing);
        draw_goal(drawing);
        draw_lines(drawing);
        draw_points(drawing);
        draw_legend(drawing);
        fputs("</svg>\n", drawing->stream);
        if (fclose(drawing->stream) != 0) {
            free(text);
            text = NULL;
        }
    }
    free(drawing);
    return text;
}
