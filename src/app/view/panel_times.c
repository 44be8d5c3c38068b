/* What the picture costs: frames as a graph, passes as bars, and how near each comes to what the device can do. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "panel_draw.h"
#include "view.h"

enum { TEXT_BYTES = 128, CEILING_REPEATS = 3 };
static const float GRAPH_HEIGHT = 92, ROW_HEIGHT = 19, TEXT_HEIGHT = 14, AXIS_WIDTH = 52; /* px at scale 1 */

/* ---- frames ---- */

/* Of graphs: 1, 2 or 5 times a power of ten, so that two to five lines stand in `most`. */
static float step_of(float most)
{
    float power = powf(10, floorf(log10f(most)));

    return most / power < 2 ? power / 2 : most / power < 5 ? power : power * 2;
}

/* The greatest value that is no freak. */
static float most_of(const struct sf_stats *stats)
{
    float most = 0, typical = fmaxf(stats->gpu_median, stats->cpu_median);

    for (unsigned i = 0; i < stats->frame_count; i++)
        most = fmaxf(most, fmaxf(stats->gpu_ms[i], stats->cpu_ms[i]));
    return fmaxf(fminf(most, 3 * typical) * 1.12f, 0.1f);
}

struct plot {
    float x, y, width, height, most; /* px; ms */
};

/* The i-th frame's place in a ring, the oldest first. */
static unsigned slot_of(const struct sf_stats *stats, unsigned i)
{
    return (stats->next + SF_STATS_FRAMES - stats->frame_count + i) % SF_STATS_FRAMES;
}

static float plot_x(const struct plot *plot, const struct sf_stats *stats, unsigned i)
{
    return plot->x + plot->width * (float)(SF_STATS_FRAMES - stats->frame_count + i) / (SF_STATS_FRAMES - 1);
}

static void plot_line(const struct plot *plot, const struct sf_stats *stats, const float *ms, uint32_t color)
{
    float before_x = 0, before_y = 0;

    for (unsigned i = 0; i < stats->frame_count; i++) {
        float x = plot_x(plot, stats, i);
        float y = plot->y + plot->height * (1 - fminf(ms[slot_of(stats, i)] / plot->most, 1));

        if (i > 0)
            sf_ui_draw_line(before_x, before_y, x, y, color, 1.25f * sf_ui_scale());
        before_x = x;
        before_y = y;
    }
}

static void draw_frames(const struct sf_stats *stats)
{
    float scale = sf_ui_scale(), margin = AXIS_WIDTH * scale, step, mouse_x, mouse_y;
    struct plot plot = {.width = fmaxf(sf_ui_room() - margin, margin), .height = floorf(GRAPH_HEIGHT * scale)};
    char text[TEXT_BYTES];

    plot.most = most_of(stats);
    step = step_of(plot.most);
    sf_ui_canvas("frames", plot.width + margin, plot.height, &plot.x, &plot.y);
    plot.x += margin;
    sf_ui_draw_rectangle(plot.x, plot.y, plot.width, plot.height, 0x60000000, true);
    for (float ms = step; ms < plot.most; ms += step) {
        float y = floorf(plot.y + plot.height * (1 - ms / plot.most)), text_y = y - TEXT_HEIGHT / 2 * scale;

        sf_ui_draw_line(plot.x, y, plot.x + plot.width, y, SF_COLOR_SHADE, 1);
        snprintf(text, sizeof text, "%g ms", (double)ms);
        sf_draw_text_right(plot.x - 6 * scale, fmaxf(text_y, plot.y), sf_ui_dim, text);
    }
    sf_ui_draw_clip(plot.x, plot.y, plot.width, plot.height);
    plot_line(&plot, stats, stats->cpu_ms, SF_COLOR_HOST);
    plot_line(&plot, stats, stats->gpu_ms, SF_COLOR_DEVICE);
    sf_ui_mouse(&mouse_x, &mouse_y);
    if (sf_ui_last_hovered() && mouse_x >= plot.x && stats->frame_count > 0) {
        float at = (mouse_x - plot.x) / plot.width * (SF_STATS_FRAMES - 1) + 0.5f;
        int frame = (int)at - (int)(SF_STATS_FRAMES - stats->frame_count);

        if (frame >= 0 && frame < (int)stats->frame_count) {
            unsigned slot = slot_of(stats, (unsigned)frame);
            float x = plot_x(&plot, stats, (unsigned)frame);

            sf_ui_draw_line(x, plot.y, x, plot.y + plot.height, sf_color_faint(sf_ui_dim, 0.5f), 1);
            sf_ui_tooltip("GPU %.2f ms\nCPU %.2f ms\n%.2f ms since the picture before", (double)stats->gpu_ms[slot],
                          (double)stats->cpu_ms[slot], (double)stats->wall_ms[slot]);
        }
    }
    sf_ui_draw_unclip();
}

/* The medians in the colours of their lines, on one line of the panel. */
static void draw_medians(const struct sf_stats *stats)
{
    sf_ui_text_color(SF_COLOR_DEVICE, "GPU %.2f ms", (double)stats->gpu_median);
    sf_ui_tooltip("Median time from the first pass's begin on the device to the last one's end.");
    sf_ui_same_line(0);
    sf_ui_text_color(SF_COLOR_HOST, "CPU %.2f ms", (double)stats->cpu_median);
    sf_ui_tooltip("Median time to record and submit a picture; recording the passes took %.3f ms of the last one.",
                  (double)stats->record_ms);
    if (stats->wall_median <= 0)
        return;
    sf_ui_same_line(0);
    sf_ui_text("%.1f fps", 1000 / (double)stats->wall_median);
    sf_ui_tooltip("Median %.2f ms from picture to picture.", (double)stats->wall_median);
}

/* ---- passes ---- */

/* Columns of the bars, px from the place's left edge. */
struct columns {
    float bars, bars_end, ms_end, share_end;
};

static struct columns columns_of(const struct sf_stats *stats, float width)
{
    float scale = sf_ui_scale();
    struct columns columns = {.bars = 0.42f * width, .share_end = width - 2 * scale};

    columns.ms_end = stats->ceilings.bytes > 0 ? columns.share_end - 52 * scale : columns.share_end;
    columns.bars_end = fmaxf(columns.ms_end - 50 * scale, columns.bars + scale);
    return columns;
}

static void draw_bar(const struct sf_stats_pass *pass, const struct columns *columns, float x, float y, float most)
{
    float scale = sf_ui_scale(), room = columns->bars_end - columns->bars, high = ROW_HEIGHT * scale - 8 * scale;
    float tick = fminf(pass->median / most, 1) * room;

    y += 4 * scale;
    x += columns->bars;
    sf_ui_draw_rectangle(x, y, room, high, SF_COLOR_SHADE, true);
    if (pass->present)
        sf_ui_draw_rectangle(x, y, fmaxf(fminf(pass->last / most, 1) * room, scale), high,
                             sf_color_faint(SF_COLOR_DEVICE, 0.75f), true);
    sf_ui_draw_line(x + tick, y - 2 * scale, x + tick, y + high + 2 * scale, sf_ui_plain, scale);
}

static void draw_row(const struct sf_stats *stats, const struct sf_stats_pass *pass, float x, float y, float width,
                     float most)
{
    struct columns columns = columns_of(stats, width);
    float scale = sf_ui_scale(), share = sf_stats_share(stats, pass);
    float text_y = y + (ROW_HEIGHT - TEXT_HEIGHT) / 2 * scale;
    uint32_t color = pass->present ? sf_ui_plain : sf_color_faint(sf_ui_dim, 0.7f);
    char text[TEXT_BYTES];

    sf_ui_draw_clip(x, y, columns.bars - 4 * scale, ROW_HEIGHT * scale);
    sf_ui_draw_text(x + 8 * scale, text_y, color, pass->name);
    sf_ui_draw_unclip();
    draw_bar(pass, &columns, x, y, most);
    snprintf(text, sizeof text, "%.2f", (double)pass->median);
    sf_draw_text_right(x + columns.ms_end, text_y, color, text);
    if (share <= 0)
        return;
    snprintf(text, sizeof text, "%.0f %%", (double)share * 100);
    sf_draw_text_right(x + columns.share_end, text_y, sf_ui_dim, text);
}

static void draw_subtotal(const struct sf_stats *stats, enum sf_stats_group group, float x, float y, float width)
{
    struct columns columns = columns_of(stats, width);
    float text_y = y + (ROW_HEIGHT - TEXT_HEIGHT) / 2 * sf_ui_scale(), ms = sf_stats_group_ms(stats, group);
    char text[TEXT_BYTES];

    sf_ui_draw_text(x, text_y, sf_ui_accent, sf_stats_group_name(group));
    if (ms > 0) {
        snprintf(text, sizeof text, "%.2f", (double)ms);
        sf_draw_text_right(x + columns.ms_end, text_y, sf_ui_accent, text);
    }
}

static void explain(const struct sf_stats *stats, const struct sf_stats_pass *pass)
{
    const struct sf_ceilings *ceilings = &stats->ceilings;
    double megabytes = (double)pass->bytes * 1e-6, rate = pass->median > 0 ? megabytes / (double)pass->median : 0;
    float share = sf_stats_share(stats, pass);

    if (share > 0)
        sf_ui_tooltip(
            "%s: %.3f ms (median), %.3f ms (last)%s\nIt reads and writes %.2f MB at %.2f GB/s: %.0f %% of what a plain "
            "copy of an image reaches, %.1f GB/s.\nNear 100 %%: it waits for memory, fewer bytes would make it "
            "faster. Far below: it computes, or waits for something else. Above: caches hold what it reads.",
            pass->name, (double)pass->median, (double)pass->last, pass->present ? "" : "; not in the last frame",
            megabytes, rate, (double)share * 100, (double)ceilings->bytes / (double)ceilings->image_copy_ns);
    else
        sf_ui_tooltip("%s: %.3f ms (median), %.3f ms (last)%s\nIt reads and writes %.2f MB at %.2f GB/s.", pass->name,
                      (double)pass->median, (double)pass->last, pass->present ? "" : "; not in the last frame",
                      megabytes, rate);
}

/* Every group that has passes: a line for it, a row for each. Answers the rows; draws them when `width` is above 0. */
static unsigned walk(const struct sf_stats *stats, float x, float y, float width, float most,
                     const struct sf_stats_pass **hovered)
{
    float row = floorf(ROW_HEIGHT * sf_ui_scale()), mouse_x, mouse_y;
    unsigned rows = 0;

    sf_ui_mouse(&mouse_x, &mouse_y);
    for (enum sf_stats_group group = 0; group < SF_STATS_GROUPS; group++) {
        bool any = false;

        for (unsigned i = 0; i < stats->pass_count; i++) {
            const struct sf_stats_pass *pass = &stats->passes[i];
            float at;

            if (sf_stats_group_of(pass) != group)
                continue;
            if (!any && width > 0)
                draw_subtotal(stats, group, x, y + (float)rows * row, width);
            rows += !any;
            any = true;
            at = y + (float)rows++ * row;
            if (width <= 0)
                continue;
            if (mouse_y >= at && mouse_y < at + row) {
                *hovered = pass;
                if (sf_ui_last_hovered())
                    sf_ui_draw_rectangle(x, at, width, row, SF_COLOR_SHADE, true);
            }
            draw_row(stats, pass, x, at, width, most);
        }
    }
    return rows;
}

static void draw_passes(const struct sf_stats *stats)
{
    const struct sf_stats_pass *hovered = NULL;
    float width = sf_ui_room(), row = floorf(ROW_HEIGHT * sf_ui_scale()), most = 1e-4f, x, y;
    struct columns columns = columns_of(stats, width);
    unsigned rows = walk(stats, 0, 0, 0, 0, NULL);

    for (unsigned i = 0; i < stats->pass_count; i++) /* of medians, so that the ticks stand still */
        most = fmaxf(most, 1.3f * stats->passes[i].median);
    sf_ui_canvas("passes", width, row * (float)(rows + 1), &x, &y);
    sf_ui_draw_text(x + columns.bars, y, sf_ui_dim, "last | median");
    sf_draw_text_right(x + columns.ms_end, y, sf_ui_dim, "ms");
    if (stats->ceilings.bytes > 0)
        sf_draw_text_right(x + columns.share_end, y, sf_ui_dim, "of copy");
    walk(stats, x, y + row, width, most, &hovered);
    if (hovered)
        explain(stats, hovered);
}

/* ---- the panel ---- */

static void measure(struct sf_view *view)
{
    struct sf_ceilings ceilings = {0};

    if (!sf_measure_ceilings(view->device, view->options.width, view->options.height, CEILING_REPEATS, &view->log,
                             &ceilings))
        view->stats.ceilings = ceilings;
    view->landed_ns = 0; /* the pause is none of the picture's */
}

static void draw_buttons(struct sf_view *view)
{
    const struct sf_ceilings *ceilings = &view->stats.ceilings;
    char *text;

    if (sf_ui_button("measure ceilings"))
        measure(view);
    sf_ui_tooltip("What the device can do at most, at the picture's size: takes about a second. Then every pass shows "
                  "what share of a plain copy's speed it reaches.");
    sf_ui_same_line(0);
    if (sf_ui_button("copy as text")) {
        text = sf_stats_print(&view->stats);
        if (text)
            sf_screen_copy(view->screen, text);
        free(text);
    }
    sf_ui_tooltip("The table of passes, to the clipboard.");
    if (ceilings->image_copy_ns > 0 && ceilings->compute_copy_ns > 0)
        sf_ui_text_color(sf_ui_dim, "copy %.1f GB/s, by compute %.1f, %.1f GFLOP/s",
                         (double)ceilings->bytes / (double)ceilings->image_copy_ns,
                         (double)ceilings->bytes / (double)ceilings->compute_copy_ns, ceilings->flops * 1e-9);
}

void sf_panel_times(struct sf_view *view)
{
    const struct sf_stats *stats = &view->stats;

    draw_medians(stats);
    draw_frames(stats);
    if (view->dropped > 0)
        sf_ui_text("%" PRIu32 " live particles, %" PRIu32 " refused", view->live, view->dropped);
    else
        sf_ui_text("%" PRIu32 " live particles", view->live);
    sf_ui_tooltip("Births are refused while the simulation's capacity is full.");
    draw_buttons(view);
    sf_ui_separator();
    draw_passes(stats);
}
